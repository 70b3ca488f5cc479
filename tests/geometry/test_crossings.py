"""Outlines that cross themselves: where, how often, by which segments, and what is not told."""

from __future__ import annotations

from itertools import combinations

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import LineString, Polygon

import aidl_lang
from aidl_lang.common.diagnostics import Diagnostic
from tests.amount import tries

COMB = "path((0, 0), right(40), up(6), zigzag_to((0, 6), height: {}, teeth: 8), close())"
BOW = "polygon([(0, 0), (40, 30), (40, 0), (0, 30)])"


def told(program: str) -> list[Diagnostic]:
    model = aidl_lang.compile(program)
    assert model.ok
    return [d for d in model.diagnostics if d.code == "W0728"]


def test_two_corners_in_the_wrong_order() -> None:
    program = f"solid sail {{ cloth = {BOW} }}"
    (found,) = told(program)
    assert found.message == (
        "`cloth` in solid `sail` crosses itself at (20, 15): `cloth.edges[0]` crosses `cloth.edges[2]`"
    )
    assert found.label == "its parts alternate between filled and open"
    assert found.hints == (
        "look at the order of the points: each must follow the one before it around the outline",
        'if that is meant, say so: `@allow("W0728")` before `cloth`',
    )
    assert found.fix is not None
    assert found.fix.title == "swap the corners (40, 30) and (40, 0)"
    mended = program
    for edit in sorted(found.fix.edits, key=lambda edit: -edit.span.start):
        mended = mended[: edit.span.start] + edit.replacement + mended[edit.span.end :]
    assert told(mended) == []
    assert aidl_lang.compile(mended).measure("sail").area == pytest.approx(1200)
    assert aidl_lang.compile(program).measure("sail").area == pytest.approx(600)


@pytest.mark.parametrize(
    ("step", "amount", "times", "place", "segments"),
    [
        ("zigzag_to((0, 6), height: 12, teeth: 8)", "height", 16, "(1.25, 0)", (0, 17)),
        ("wave_to((0, 6), amplitude: 12, waves: 3)", "amplitude", 6, "(7.804, 0)", (0, 6)),
    ],
)
def test_teeth_on_the_wrong_side(
    step: str, amount: str, times: int, place: str, segments: tuple[int, int]
) -> None:
    (found,) = told(f"solid a {{ comb = path((0, 0), right(40), up(6), {step}, close()) }}")
    one, other = segments
    assert found.message == (
        f"`comb` in solid `a` crosses itself {times} times, first at {place}: "
        f"`comb.segment[{one}]` crosses `comb.segment[{other}]`"
    )
    word = step.partition("(")[0]
    assert (
        found.hints[0]
        == f"`{word}` goes first to the left of its way: turn the sign of `{amount}`, or make it smaller"
    )
    assert found.fix is None


@pytest.mark.parametrize(
    ("outline", "crosses"),
    [
        ("polyline([(0, 0), (40, 30), (40, 0), (0, 30), (0, 0)])", "`o.edges[0]` crosses `o.edges[2]`"),
        (
            "spline([(0, 0), (40, 30), (40, 0), (0, 30)], closed: true)",
            "`o.segment[0]` crosses `o.segment[2]`",
        ),
        ("path((0, 0), bezier_to((60, 40), (-40, 40), (20, 0)), close())", "`o.segment[0]` crosses itself"),
    ],
)
def test_other_ways(outline: str, crosses: str) -> None:
    (found,) = told(f"solid a {{ o = {outline} }}")
    assert found.message.endswith(crosses)
    assert found.fix is None


def test_a_hole_and_a_part_of_an_own_shape() -> None:
    program = f"""
        shape bow() {{ edge = {BOW} }}
        solid plate {{
            sheet = rectangle(center: (20, 15), width: 100, height: 100)
            hole cut {{ o = bow() }}
        }}
        """
    (found,) = told(program)
    assert found.message.startswith("`o.edge` in hole `plate.cut` crosses itself at (20, 15)")


@pytest.mark.parametrize(
    "program",
    [
        "solid a { for i in 0..2 { o[i] = polygon([(i, 0), (i + 8, 8), (i + 8, 0), (i, 8)]) } }",
        f"solid a {{ o = {BOW}; p = copy(o, by: (60, 0)) }}",
        f"@detached solid k() {{ o = {BOW} }}\na = k()\nb = mirror(a, about: y_axis)\nc = k() at (60, 0)",
    ],
)  # fmt: skip
def test_what_is_written_once_is_told_once(program: str) -> None:
    assert len(told(program)) == 1


@pytest.mark.parametrize(
    "program",
    [
        f"drawing a {{ o = {BOW} }}",
        f"solid a {{ o = {COMB.format(-12)} }}",
        f"solid a {{ o = {COMB.format(5)} }}",
        f'solid a {{ @allow("W0728") o = {BOW} }}',
        f"solid a {{ construction o = {BOW}; r = circle(radius: 5) }}",
        'solid a { t = text("8&@%", height: 20) }',
        "solid a { s = star(center: (0, 0), points: 5, outer_radius: 10, inner_radius: 5) }",
        # two corners that touch, a corner on a side, a side there and back
        "solid a { o = polygon([(0, 0), (40, 0), (20, 20), (40, 40), (0, 40), (20, 20)]) }",
        "solid a { o = polygon([(0, 0), (40, 0), (40, 40), (20, 0), (0, 40)]) }",
        "solid a { o = polygon([(0, 0), (40, 0), (40, 20), (60, 20), (40, 20), (40, 40), (0, 40)]) }",
    ],
)  # fmt: skip
def test_what_is_not_told(program: str) -> None:
    assert told(program) == []


def test_no_swap_is_offered_where_none_is_enough() -> None:
    points = "[(0, 10), (6, -8), (-9.5, 3), (9.5, 3), (-6, -8)]"
    (found,) = told(f"solid a {{ pentagram = polygon({points}) }}")
    assert "crosses itself 5 times" in found.message
    assert found.fix is None


POINT = st.tuples(st.integers(-30, 30), st.integers(-30, 30))


def crossings(points: list[tuple[int, int]]) -> int:
    """How many pairs of sides cross, counted by Shapely one by one."""
    sides = [LineString(pair) for pair in zip(points, [*points[1:], points[0]], strict=True)]
    return sum(a.crosses(b) for a, b in combinations(sides, 2))


@tries(60)
@given(st.lists(POINT, min_size=3, max_size=9, unique=True))
def test_a_polygon_is_told_exactly_if_its_outline_is_not_simple(points: list[tuple[int, int]]) -> None:
    ring = LineString([*points, points[0]])
    sides = [LineString(pair) for pair in zip(points, [*points[1:], points[0]], strict=True)]
    touching = [a for a, b in combinations(sides, 2) if a.touches(b) or a.overlaps(b) or a.contains(b)]
    assume(len(touching) == len(points))  # neighbours alone
    assume(Polygon(points).buffer(0).area > 1)
    found = told(f"solid a {{ o = polygon({points}) }}")
    count = crossings(points)
    assert bool(found) == (not ring.is_simple) == (count > 0)
    if count > 1:
        assert f" crosses itself {count} times, first at " in found[0].message
