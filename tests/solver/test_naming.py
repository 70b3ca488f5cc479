"""What constraints name: the boxes of structures, what lies in them, and what rides along."""

from __future__ import annotations

import pytest

from aidl_lang import pipeline
from aidl_lang.building.lower import lower
from aidl_lang.common.source import SourceFile
from aidl_lang.interp import interpret
from aidl_lang.solver.riding import naming

PROGRAM = """
assembly top {
    solid wall { edge = rectangle(center: (0, 0), width: 50, height: 10) }
    assembly par {
        solid a {
            body = rectangle(center: (0, 0), width: 20, height: 10)
            drawing lips { upper = line(start: fixed((-3, 1)), end: fixed((3, 1))) }
        }
        solid b { body = circle(center: (30, 0), radius: 4) }
    }
    constrain { CONSTRAIN }
}
"""
ALL = "wall par par.a par.a.lips par.b"


def named(constraints: str) -> tuple[str, str]:
    """The frames that are named, and the structures of which something is named."""
    text = PROGRAM.replace("CONSTRAIN", constraints)
    program, _ = pipeline.front(SourceFile("test.aidl", text))
    lowered = lower(interpret(program).model)
    found = naming(lowered.problem)
    groups = [path.removeprefix("top").removeprefix(".") for path in lowered.groups]
    return tuple(
        " ".join(path for path, flag in zip(groups, flags, strict=True) if flag and path)
        for flags in (found.frames, found.inside)
    )  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("constraints", "frames", "inside"),
    [
        ("", "", ""),
        ("par.above(wall, gap: 3)", "wall par", ""),
        ("par.a.left_of(wall, gap: 3)", "wall par par.a", ""),
        ("par.a.body.center == wall.edge.top_left", "wall par par.a", "wall par.a"),
        ("par.top == par.b.top", "par par.b", ""),
        ("align_left([par.a, par.b], wall)", "wall par par.a par.b", ""),
        ("align_left([par.a, par.b.body], wall)", "wall par par.a par.b", "par.b"),
        ("contains(wall, par.a.lips)", "wall par par.a par.a.lips", ""),
        ("par.b.body.radius == 5", "par par.b", "par.b"),
        ("width <= 200", "", ""),
        ("prefer par.center_x == 3", "par", ""),
    ],
)
def test_what_a_constraint_names(constraints: str, frames: str, inside: str) -> None:
    assert named(constraints) == (frames, inside)


@pytest.mark.parametrize(
    "own",
    [
        "slot(center: (3, 4), length: 20, width: 5)",
        "arc(center: (0, 0), radius: 3, start_angle: 0, end_angle: 90)",
    ],
)
def test_what_a_shape_asks_of_itself_names_nothing(own: str) -> None:
    text = f"assembly top {{ drawing part {{ own = {own} }} solid other {{ c = circle(radius: 3) }} }}"
    program, _ = pipeline.front(SourceFile("test.aidl", text))
    found = naming(lower(interpret(program).model).problem)
    assert found.frames.tolist() == [False, False, False]
    assert found.inside.tolist() == [True, False, False]


def test_a_constraint_of_its_own_names_what_a_structure_draws_and_not_its_frame() -> None:
    part = "c = circle(center: (1, 2), radius: 3) constrain { c.center.x == 4; height <= 9 }"
    text = f"assembly top {{ solid part {{ {part} }} }}"
    program, _ = pipeline.front(SourceFile("test.aidl", text))
    found = naming(lower(interpret(program).model).problem)
    assert found.frames.tolist() == [False, False]
    assert found.inside.tolist() == [True, True]


def test_to_name_one_of_a_pattern_is_to_name_the_frame_that_places_all() -> None:
    text = """assembly top {
        template solid lug() { c = circle(center: origin, radius: 3) }
        lugs = linear_array(lug(), n: 3, pitch: 20)
        solid other { c = circle(center: (0, 40), radius: 3) }
        constrain lugs[2].below(other, gap: 5)
    }"""
    program, _ = pipeline.front(SourceFile("test.aidl", text))
    lowered = lower(interpret(program).model)
    found = naming(lowered.problem)
    moved = {int(g) for g in lowered.problem.frame_of if g >= 0}
    assert all(found.frames[g] for g in moved)
    assert lowered.groups[min(moved)] == "top.lugs[0]"
