"""A new kind of primitive: its record and what its curve is made of are all that the stages need."""

from __future__ import annotations

import json
import subprocess
import sys

from tests.documents import ROOT

NEW = """
import json
from aidl_lang.checking import types as registry

registry.PRIMITIVES = registry.PRIMITIVES | {"bow": registry.Primitive(
    "bow",
    calls=("start: point, end: point, rise: length, turn: angle?",),
    fields="start: point, end: point, rise: size, turn: direction",
    sample="bow(({x}, {y}), ({x} + 9, {y}), rise: 4)",
)}
registry.PUBLIC = (*registry.PUBLIC, "bow")
registry.DECLARATIONS = (*registry.DECLARATIONS, "bow(start: point, end: point, rise: length, turn: angle?)")

from aidl_lang.building import curves
from aidl_lang.building import expression as ex
from aidl_lang.building.curves import clockwise, number, view, xy

def pieces(g, here):
    core = view(g, here)
    start, end, (rise, turn) = xy(core["start"]), xy(core["end"]), (number(core[n]) for n in ("rise", "turn"))
    way = rise * ex.towards(turn + (-90.0 if clockwise(g, here) else 90.0))
    first, second = start + way, end + way
    return ((start, first), (first, second, second, end))

curves.FORMULAS["bow"] = curves.Formulas(pieces=pieces)

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile

found = []
for program in PROGRAMS:
    compiled = pipeline.compile(SourceFile("p.aidl", program))
    told = [f"{d.code} {d.message}" for d in compiled.diagnostics]
    found.append([told, json.loads(compiled.export(".json"))["root"]["geometry"] if compiled.drawing else {}])
print(json.dumps(found))
"""
PROGRAMS = (
    "drawing d { b = bow((0, 0), (9, 0), rise: 4); c = mirror(b, about: y_axis)\n"
    "t = copy(b, angle: 90deg); constrain { b.top == 6; b.end.y == 1; b.start.x == 2 } }",
    "drawing d { b = bow((0, 0), (9, 0), rise: -4) }",
    "solid s { floor = line((0, 0), (9, 0)); b = bow((0, 0.001), (9, 0), rise: 4) }",
)


def test_it_is_solved_copied_and_written_and_messages_speak_of_its_fields() -> None:
    """What is said of each program where there is such a kind, and its geometry."""
    script = NEW.replace("PROGRAMS", repr(PROGRAMS))
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True
    )
    (told, found), (of_negative, _), (of_gap, _) = json.loads(done.stdout)
    assert told == []
    start, end, rise, turn = found["b"]["params"].values()
    assert found["b"]["type"] == "bow"
    assert (start[0], end[1]) == (2, 1)
    assert turn == 0
    parts = found["b"]["parts"]
    assert [part["type"] for part in parts.values()] == ["line", "bezier"]
    assert parts["edge[1]"]["points"][3] == end
    top = start[1] + rise
    assert parts["edge[0]"]["end"] == [start[0], top] == parts["edge[1]"]["points"][0]
    assert found["c"]["params"]["start"] == [-start[0], start[1]]
    assert found["c"]["parts"]["edge[0]"]["end"] == [-start[0], top]
    assert found["t"]["params"]["turn"] == 90

    assert of_negative == ["E0515 the rise of this bow is -4, and sizes are never negative"]
    assert [t for t in of_gap if t.startswith("N0708")] == [
        "N0708 a gap of 0.001 mm between `b.start` and `floor.start` at (0, 0) was closed in solid `s`"
    ]
