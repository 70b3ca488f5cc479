"""Outlines that cross themselves are told exactly then, by Shapely; `spec/crossings.md` has the words."""

from __future__ import annotations

from itertools import combinations

from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import LineString, Polygon

import aidl_lang
from aidl_lang.common.diagnostics import Diagnostic
from tests.amount import tries


def told(program: str) -> list[Diagnostic]:
    model = aidl_lang.compile(program)
    assert model.ok
    return [d for d in model.diagnostics if d.code == "W0728"]


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
