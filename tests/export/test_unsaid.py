"""What a program says is in the file, or a note tells that the format has no place for it."""

from __future__ import annotations

from functools import cache

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.export.job import Exported, Options
from aidl_lang.export.profiles import PROFILES

PLATE = """\
@thickness(6mm) @color("teal") {said}
solid plate {{
    body = rectangle(center: origin, width: 60, height: 30)
    knob = circle(center: fixed((30, 0)), radius: 8)
    {depth} hole seat {{ rim = circle(center: fixed((-15, 0)), radius: 5) }}
    drawing mark {{ line = line(fixed((-5, -10)), fixed((20, 10))) }}
}}
"""
LOOKS = ("@stroke(1mm)", "@dash(3, 1)", "@opacity(0.5)", "@shade(round)", "@edges(seams)", "@stroke(none)")
DEPTHS = ("@depth(2mm)", "@depth(2mm, 90deg)")
FILES = (".svg", ".pdf", ".png", ".dxf", ".step", ".stl", ".3mf", "cutter.svg", "cutter.dxf")


@cache
def written(said: str, name: str) -> Exported:
    text = PLATE.format(said="", depth=said) if said in DEPTHS else PLATE.format(said=said, depth="")
    made = pipeline.compile(SourceFile("plate.aidl", text))
    assert made.ok
    cutter, _, suffix = name.rpartition(".")
    return made.exported(f".{suffix}", Options(profile=PROFILES["lightburn"] if cutter else None, pixels=400))


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("said", [*LOOKS, *DEPTHS])
def test_it_is_in_the_file_or_told(said: str, name: str) -> None:
    told = {note.code for note in written(said, name).notes}
    is_there = written(said, name).data != written("", name).data
    if said in DEPTHS:
        assert is_there
        assert ("N0756" in told) == (name.endswith(".dxf") or name.startswith("cutter"))
    else:
        assert is_there or "N0741" in told


def test_the_colour_of_an_area_with_an_outline_of_its_own_is_told_too() -> None:
    text = """
    @color("blue") @thickness(2mm) solid s {
        body = rectangle(center: fixed((0, 0)), width: 40, height: 20)
        @color("gold") @stroke(1mm) disc = circle(center: fixed((5, 0)), radius: 4)
    }
    """
    made = pipeline.compile(SourceFile("s.aidl", text)).exported(".3mf", Options())
    (note,) = [n for n in made.notes if n.code == "N0741"]
    assert note.message.startswith("`@stroke` and `@color(…)` count for nothing in this file")
