"""Patterns against closed forms, and against copies that Shapely cuts one by one."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import affinity

from aidl_lang.geometry.boolean import clipped_each
from aidl_lang.geometry.curves import Circle, Line, Piece, Vec
from aidl_lang.geometry.region import Face, Loop, Region, length
from aidl_lang.geometry.tiling import (
    MOST,
    Lattice,
    TooManyCopiesError,
    tiled_areas,
    tiled_bars,
    tiled_strokes,
)
from tests.amount import tries
from tests.geometry.test_outlines import polygon, stars

_REACH = 50
"""Copies either way that are tried one by one; stars lie within 50 mm."""


def rectangle(width: float, height: float) -> Region:
    return polygon([(0, 0), (width, 0), (width, height), (0, height)])


def disc(radius: float, center: Vec = (0, 0)) -> Region:
    return Region((Face(Loop((Circle(center, radius),))),))


def total(curves: Sequence[Piece]) -> float:
    return sum(length(c) for c in curves)


def places(lattice: Lattice, size: float) -> list[Vec]:
    """The ways of all copies that may come within `size` of the origin, however the lattice is said."""
    (a, b), (c, d) = lattice.step, lattice.row or (0.0, 0.0)
    rows = range(-_REACH, _REACH + 1) if lattice.row else range(1)
    ways = [(i * a + j * c, i * b + j * d) for i in range(-_REACH, _REACH + 1) for j in rows]
    return [w for w in ways if math.hypot(*w) <= size]


lattices = st.builds(
    lambda size, lean, row: Lattice((size, 0.0), (lean * size, row * size)),
    st.floats(9, 20),
    st.floats(-0.5, 0.5),
    st.floats(0.6, 1.4),
)


# --- Single curves -----------------------------------------------------------------------------------


spots = st.tuples(st.floats(-40, 40), st.floats(-40, 40))


@given(stars(), spots, spots)
def test_a_line_is_cut_as_shapely_cuts_it(corners: list[Vec], start: Vec, end: Vec) -> None:
    """Also one with both ends inside that leaves the star in between."""
    line = shapely.LineString([start, end])
    if line.length < 1:
        return
    (one,) = clipped_each([Line(start, end)], polygon(corners))
    assert total(one.inner) == pytest.approx(line.intersection(shapely.Polygon(corners)).length, abs=1e-3)


# --- Areas -------------------------------------------------------------------------------------------


@tries(40)
@given(stars(), lattices, st.floats(1, 8))
def test_areas_are_those_of_copies_cut_one_by_one(corners: list[Vec], lattice: Lattice, size: float) -> None:
    """Squares that overlap or not, in a star."""
    cell, star = shapely.box(0, 0, size, size), shapely.Polygon(corners)
    copies = [affinity.translate(cell, *way) for way in places(lattice, 80)]
    wanted = shapely.unary_union(copies).intersection(star)
    found = tiled_areas(rectangle(size, size), polygon(corners), lattice, whole=False)
    assert found.area == pytest.approx(wanted.area, abs=1e-5)
    whole = tiled_areas(rectangle(size, size), polygon(corners), lattice, whole=True)
    inside = [c for c in copies if star.covers(c)]
    near = [c for c in copies if star.buffer(1e-6).covers(c)]
    low, high = (shapely.unary_union(some).area for some in (inside, near))
    assert low - 1e-5 <= whole.area <= high + 1e-5


def test_areas_that_overlap_are_one() -> None:
    """Discs of radius 6, 10 apart, as far as they lie in a strip through their centres."""
    strip = polygon([(-5, -1), (95, -1), (95, 1), (-5, 1)])
    found = tiled_areas(disc(6), strip, Lattice((10, 0)), whole=False)
    assert found.area == pytest.approx(200, rel=1e-9)
    assert len(found.faces) == 1


def test_a_copy_about_a_hole_is_not_whole() -> None:
    plate = Region((Face(Loop((Circle((0, 0), 30),)), (Loop((Circle((0, 0), 1),), reversed=True),)),))
    found = tiled_areas(disc(3), plate, Lattice((10, 0), (0, 10)), whole=True)
    centres = [(10 * i, 10 * j) for i in range(-3, 4) for j in range(-3, 4)]
    assert len(found.faces) == sum(0 < math.hypot(*c) <= 27 for c in centres)


# --- Strokes -----------------------------------------------------------------------------------------


@tries(40)
@given(stars(), lattices, st.floats(1, 8), st.floats(1, 8))
def test_strokes_are_those_of_copies_cut_one_by_one(
    corners: list[Vec], lattice: Lattice, width: float, height: float
) -> None:
    star = shapely.Polygon(corners)
    stroke = shapely.LineString([(0, 0), (width, height)])
    copies = [affinity.translate(stroke, *way) for way in places(lattice, 80)]
    found = tiled_strokes([Line((0, 0), (width, height))], polygon(corners), lattice, whole=False)
    assert total(found) == pytest.approx(sum(star.intersection(c).length for c in copies), abs=1e-4)
    assert all(star.buffer(1e-6).covers(shapely.LineString([c.start, c.end])) for c in found)


@given(stars(), st.floats(2, 10), st.floats(-3, 3))
def test_lines_run_on_from_copy_to_copy(corners: list[Vec], pitch: float, angle: float) -> None:
    """Hatching has the length of lines right through, and as few pieces as those are cut to."""
    x, y = pitch * math.cos(angle), pitch * math.sin(angle)
    star = shapely.Polygon(corners)
    count = math.ceil(150 / pitch)
    through = [
        shapely.LineString([(-k * y - 20 * x, k * x - 20 * y), (-k * y + 20 * x, k * x + 20 * y)])
        for k in range(-count, count + 1)
    ]
    long = [affinity.scale(line, 10, 10) for line in through]
    parts = [star.intersection(line) for line in long]
    found = tiled_strokes([Line((0, 0), (x, y))], polygon(corners), Lattice((x, y), (-y, x)), whole=False)
    assert total(found) == pytest.approx(sum(p.length for p in parts), abs=1e-4)
    pieces = sum(len(shapely.get_parts(p)) for p in parts if p.length > 1e-3)
    assert len(found) - pieces <= sum(length(c) <= 2e-3 for c in found)


def test_bars_have_the_area_of_their_closed_form() -> None:
    """Nets leave squares: of each pitch² cell (pitch − width)² is open."""
    cell = [Line((0, 0), (5, 0)), Line((0, 0), (0, 5))]
    found = tiled_bars(cell, rectangle(50, 30), Lattice((5, 0), (0, 5)), 1)
    assert found.area == pytest.approx(1500 - 60 * 16, rel=1e-9)
    assert len(found.faces) == 1
    assert len(found.faces[0].holes) == 60


# --- Limits ------------------------------------------------------------------------------------------


def test_ten_thousand_copies_are_made_and_no_more() -> None:
    found = tiled_areas(disc(0.4), rectangle(99, 99), Lattice((1, 0), (0, 1)), whole=True)
    assert len(found.faces) == 98 * 98
    with pytest.raises(TooManyCopiesError) as many:
        tiled_areas(disc(0.4), rectangle(200, 99), Lattice((1, 0), (0, 1)), whole=True)
    assert many.value.args[0] > MOST


@pytest.mark.parametrize("row", [(2.0, 0.0), (0.0, 0.0)])
def test_steps_along_one_line_are_no_lattice(row: Vec) -> None:
    assert not Lattice((5, 0), row).is_possible
    assert not Lattice((0, 0)).is_possible
    assert Lattice((5, 0), (1, 1)).is_possible
