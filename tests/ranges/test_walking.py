"""Params walked over their ranges: what changes kind, where, and what is of one kind throughout."""

from __future__ import annotations

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.ends import SweepJob, allowed
from aidl_lang.tools.ranges import Walk, has_way, ranges, sentences, walking
from aidl_lang.tools.ranges.looks import differences, look
from aidl_lang.tools.ranges.walking import Remedy, walked
from tests.documents import ROOT
from tests.sweep.here import at_once as at_once


def walk(text: str) -> Walk:
    """Returns the walk of the only param of a program."""
    job = SweepJob("it.aidl", text, None, pipeline.Settings())
    compiled = pipeline.compile(SourceFile(job.name, text))
    assert compiled.ok, compiled.diagnostics
    (knob,) = compiled.knobs
    return walked(job, knob)


def edited(text: str, remedy: Remedy) -> str:
    start, end, new = remedy.edit
    return text[:start] + new + text[end:]


ARM = """\
drawing d {
    param lean = 30deg in -60deg..60deg
    ground = line(fixed((0, 0)), fixed((80, 0)))
    arm = line(ground.start, length: 40, angle: guess(50deg))
    constrain { angle(arm, ground) == lean }
}
"""


def test_an_angle_that_is_read_in_another_sense_is_told_and_stated() -> None:
    (turn,) = walk(ARM).turns
    assert (turn.changes[0].kind, turn.changes[0].line) == ("reading", 5)
    assert turn.before == pytest.approx(0.0, abs=0.12 * 1.01)
    stated, ended = turn.remedies
    assert "angle(arm, ground, lean, ccw: false)" in (text := edited(ARM, stated))
    assert not walk(text).turns
    assert not walk(edited(ARM, ended)).turns


def test_a_solution_that_is_another_one_is_a_jump() -> None:
    text = """\
drawing d {
    param high = 10 in 0..50
    a = fixed((0, high))
    b = fixed((60, high))
    tip = guess((31, 30))
    left = line(a, tip)
    right = line(b, tip)
    constrain { left.length == 40; right.length == 40 }
}
"""
    (turn,) = walk(text).turns
    assert turn.changes[0].kind == "jump"
    assert "though the solution before still holds" in turn.changes[0].text
    assert turn.before < 30.5
    assert turn.after > 29.5
    assert turn.after - turn.before <= 0.0501


def test_holes_that_meet_and_holes_at_the_edge_are_told_by_name() -> None:
    text = """\
solid plate {
    param apart = 30mm in 5mm..90mm
    body = rectangle(center: origin, width: 80, height: 50)
    hole a { rim = circle(center: (-apart / 2, 0), radius: 8) }
    hole b { rim = circle(center: (apart / 2, 0), radius: 8) }
}
"""
    found = walk(text)
    first, last = found.turns
    assert [first.after, last.after] == pytest.approx([16, 64], abs=0.1)
    assert first.changes[0].text == (
        "the openings of `plate` go from 2 to 1: `plate.a.rim`, `plate.b.rim` run into each other"
    )
    assert last.changes[0].text == (
        "the openings of `plate` go from 2 to 0: `plate.a.rim`, `plate.b.rim` break through its edge"
    )


def test_a_hole_that_crosses_another_between_two_steps_is_found() -> None:
    text = """\
solid plate {
    param way = 0mm in 0mm..1000mm
    body = rectangle(center: (500, 0), width: 1200, height: 60)
    hole a { rim = circle(center: (way, 0), radius: 4) }
    hole b { rim = circle(center: (637, 0), radius: 4) }
}
"""
    (meets, alone) = walk(text).turns
    assert [meets.after, alone.after] == pytest.approx([629, 645], abs=1.1)


def test_time_that_is_over_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(walking, "_MOST", 4)
    found = walk(ARM)
    assert (found.ok, found.stopped) == (False, "4 values were tried")
    assert list(sentences(found)) == ["`lean` was not walked to its ends: 4 values were tried"]


@pytest.mark.usefixtures("at_once")
def test_params_are_walked_side_by_side_and_what_is_left_is_counted() -> None:
    text = ARM.replace("length: 40", "length: long").replace(
        "    ground", "    param long = 40 in 30..50\n    ground"
    )
    compiled = pipeline.compile(SourceFile("it.aidl", text))
    job = SweepJob("it.aidl", text, None, pipeline.Settings())
    found = ranges(job, compiled.knobs)
    assert [(each.knob.path, len(each.turns)) for each in found.walks] == [("lean", 1), ("long", 0)]
    none = ranges(job, compiled.knobs, seconds=0.0)
    assert ([k.path for k in none.left], none.ok) == (["lean", "long"], False)


@pytest.mark.parametrize("name", [pytest.param("workshop/linkage", marks=pytest.mark.slow), "hanger"])
def test_each_value_is_as_if_it_were_compiled_alone(name: str) -> None:
    text = (ROOT / "examples" / f"{name}.aidl").read_text("utf-8")
    source = SourceFile("it.aidl", text)
    compiling = walking._compiling(SweepJob("it.aidl", text, None, pipeline.Settings()), source)
    for knob in [k for k in pipeline.compile(source).knobs if has_way(k)][:2]:
        low, high = knob.range or (0.0, 1.0)
        for share in (0.1, 0.5, 0.51):
            value = allowed(knob, low + share * (high - low))
            kept = look(compiling(((knob.path, value),)), value)
            alone = look(pipeline.compile(source, params={knob.path: value}), value)
            assert kept.is_solved
            assert not differences(kept, alone)
            assert kept.places == alone.places
            assert abs(kept.spots - alone.spots).max() < 1e-6


def test_a_jump_at_the_end_of_a_range_is_looked_at_within_it() -> None:
    text = """\
drawing d {
    param high = 10 in 0..30.01
    tip = guess((31, 30))
    left = line(fixed((0, high)), tip)
    right = line(fixed((60, high)), tip)
    constrain { left.length == 40; right.length == 40 }
}
"""
    (turn,) = walk(text).turns
    assert turn.changes[0].kind == "jump"
    assert turn.before <= 30 <= turn.after
