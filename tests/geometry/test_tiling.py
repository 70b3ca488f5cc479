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
from aidl_lang.geometry.curves import Arc, Circle, Line, Piece, Vec
from aidl_lang.geometry.region import Face, Loop, Region, area, length
from aidl_lang.geometry.tiling import (
    MOST,
    Lattice,
    TooManyCopiesError,
    tiled_areas,
    tiled_bars,
    tiled_strokes,
)
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


def test_a_line_that_leaves_and_comes_back_has_a_gap() -> None:
    notched = polygon([(0, 0), (30, 0), (30, 20), (20, 20), (20, 10), (10, 10), (10, 20), (0, 20)])
    (one,) = clipped_each([Line((5, 15), (25, 15))], notched)
    assert [(p.start, p.end) for p in one.inner if isinstance(p, Line)] == [
        ((5, 15), (10, 15)),
        ((20, 15), (25, 15)),
    ]


# --- Areas -------------------------------------------------------------------------------------------


@given(stars(), lattices, st.floats(1, 8))
def test_areas_are_those_of_copies_cut_one_by_one(corners: list[Vec], lattice: Lattice, size: float) -> None:
    """Squares that overlap or not, in a star."""
    cell, star = shapely.box(0, 0, size, size), shapely.Polygon(corners)
    copies = [affinity.translate(cell, *way) for way in places(lattice, 80)]
    wanted = shapely.unary_union(copies).intersection(star)
    found = tiled_areas(rectangle(size, size), polygon(corners), lattice, whole=False)
    assert area(found) == pytest.approx(wanted.area, abs=1e-5)
    whole = tiled_areas(rectangle(size, size), polygon(corners), lattice, whole=True)
    inside = [c for c in copies if star.covers(c)]
    near = [c for c in copies if star.buffer(1e-6).covers(c)]
    low, high = (shapely.unary_union(some).area for some in (inside, near))
    assert low - 1e-5 <= area(whole) <= high + 1e-5


def test_areas_that_overlap_are_one() -> None:
    """Discs of radius 6, 10 apart, as far as they lie in a strip through their centres."""
    strip = polygon([(-5, -1), (95, -1), (95, 1), (-5, 1)])
    found = tiled_areas(disc(6), strip, Lattice((10, 0)), whole=False)
    assert area(found) == pytest.approx(200, rel=1e-9)
    assert len(found.faces) == 1


def test_squares_that_touch_leave_nothing_between_them() -> None:
    found = tiled_areas(rectangle(5, 5), rectangle(50, 30), Lattice((5, 0), (0, 5)), whole=False)
    assert area(found) == pytest.approx(1500, rel=1e-9)
    assert len(found.faces) == 1


def test_whole_copies_may_touch_the_border() -> None:
    found = tiled_areas(rectangle(4, 4), rectangle(49, 29), Lattice((5, 0), (0, 5)), whole=True)
    assert len(found.faces) == 10 * 6


def test_a_copy_about_a_hole_is_not_whole() -> None:
    plate = Region((Face(Loop((Circle((0, 0), 30),)), (Loop((Circle((0, 0), 1),), reversed=True),)),))
    found = tiled_areas(disc(3), plate, Lattice((10, 0), (0, 10)), whole=True)
    centres = [(10 * i, 10 * j) for i in range(-3, 4) for j in range(-3, 4)]
    assert len(found.faces) == sum(0 < math.hypot(*c) <= 27 for c in centres)


def test_discs_stay_circles_and_are_cut_to_arcs() -> None:
    found = tiled_areas(disc(2), rectangle(20, 20), Lattice((10, 0), (0, 10)), whole=False)
    assert area(found) == pytest.approx(4 * math.pi * (1 + 4 / 2 + 4 / 4), rel=1e-12)
    kinds = [type(p) for face in found.faces for p in face.outer.pieces]
    assert (kinds.count(Circle), kinds.count(Arc)) == (1, 8)


def test_mirrored_frames_begin_in_their_own_corner() -> None:
    """In a frame with x to the left and y up the first corner is the lower right one."""
    points = [(0, 0), (-1, 0), (0, 1), (-1, 0), (-4, 0), (0, 4)]
    lattice = Lattice.through(points, rectangle(30, 20), "corner")  # type: ignore[arg-type]
    assert lattice.offset == pytest.approx((30, 0))


@given(st.floats(-3, 3), st.floats(-40, 40), st.floats(-40, 40))
def test_a_pattern_in_the_middle_turns_and_moves_with_its_outline(angle: float, x: float, y: float) -> None:
    """About the middle of a disc a pattern that is turned has the same area."""
    cos, sin = math.cos(angle), math.sin(angle)

    def at(u: float, v: float) -> Vec:
        return cos * u - sin * v, sin * u + cos * v

    points = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), at(1, 0), at(7, 0), at(2, 6)]
    cover = disc(31, (x, y))
    lattice = Lattice.through(points, cover, "center")
    cell = rectangle(3, 2).mapped(lattice.turned)
    plain = Lattice((7, 0), (2, 6))
    wanted = tiled_areas(rectangle(3, 2), disc(31), plain, whole=False)
    assert area(tiled_areas(cell, cover, lattice, whole=False)) == pytest.approx(area(wanted), rel=1e-6)


# --- Strokes -----------------------------------------------------------------------------------------


@given(stars(), lattices, st.floats(1, 8), st.floats(1, 8))
def test_strokes_are_those_of_copies_cut_one_by_one(
    corners: list[Vec], lattice: Lattice, width: float, height: float
) -> None:
    star = shapely.Polygon(corners)
    stroke = shapely.LineString([(0, 0), (width, height)])
    copies = [affinity.translate(stroke, *way) for way in places(lattice, 80)]
    found = tiled_strokes([Line((0, 0), (width, height))], polygon(corners), lattice, whole=False)
    assert total(found) == pytest.approx(sum(star.intersection(c).length for c in copies), abs=1e-4)
    assert all(star.buffer(1e-6).covers(shapely.LineString([c.start, c.end])) for c in found)  # type: ignore[union-attr]


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


def test_arcs_stay_arcs() -> None:
    """Half circles in rows over a disc, as the edges of scales."""
    half = Arc((0, 0), 2, (-2, 0), (2, 0), math.pi)
    found = tiled_strokes([half], disc(20), Lattice((4, 0), (2, 2)), whole=False)
    assert {type(c) for c in found} == {Arc}
    assert all(c.radius == pytest.approx(2) for c in found if isinstance(c, Arc))


def test_what_runs_along_the_border_is_left_out() -> None:
    """Ten squares by six: nine lines between columns and five between rows."""
    cell = [Line((0, 0), (5, 0)), Line((0, 0), (0, 5))]
    found = tiled_strokes(cell, rectangle(50, 30), Lattice((5, 0), (0, 5)), whole=False)
    assert len(found) == 9 + 5
    assert total(found) == pytest.approx(9 * 30 + 5 * 50)


def test_strokes_are_not_cut_where_they_cross_each_other() -> None:
    both = clipped_each([Line((-1, 5), (11, 5)), Line((5, -1), (5, 9))], rectangle(10, 10))
    assert [[type(p) for p in one.inner] for one in both] == [[Line], [Line]]
    assert [one.is_whole for one in both] == [False, False]


def test_a_circle_is_cut_where_it_leaves() -> None:
    """A circle about the corner of a square has a quarter inside."""
    (one,) = clipped_each([Circle((0, 0), 4)], rectangle(10, 10))
    assert total(one.inner) == pytest.approx(2 * math.pi)
    (inner,) = clipped_each([Circle((5, 5), 4)], rectangle(10, 10))
    assert inner.is_whole
    assert inner.inner == (Circle((5, 5), 4),)


def test_bars_have_the_area_of_their_closed_form() -> None:
    """Nets leave squares: of each pitch² cell (pitch − width)² is open."""
    cell = [Line((0, 0), (5, 0)), Line((0, 0), (0, 5))]
    found = tiled_bars(cell, rectangle(50, 30), Lattice((5, 0), (0, 5)), 1)
    assert area(found) == pytest.approx(1500 - 60 * 16, rel=1e-9)
    assert len(found.faces) == 1
    assert len(found.faces[0].holes) == 60


# --- Limits ------------------------------------------------------------------------------------------


def test_ten_thousand_copies_are_made_and_no_more() -> None:
    found = tiled_areas(disc(0.4), rectangle(99, 99), Lattice((1, 0), (0, 1)), whole=True)
    assert len(found.faces) == 98 * 98
    with pytest.raises(TooManyCopiesError) as many:
        tiled_areas(disc(0.4), rectangle(200, 99), Lattice((1, 0), (0, 1)), whole=True)
    assert many.value.count > MOST


@pytest.mark.parametrize("row", [(2.0, 0.0), (0.0, 0.0)])
def test_steps_along_one_line_are_no_lattice(row: Vec) -> None:
    assert not Lattice((5, 0), row).is_possible
    assert not Lattice((0, 0)).is_possible
    assert Lattice((5, 0), (1, 1)).is_possible
