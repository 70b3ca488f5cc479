"""Walls and gaps against numbers worked out by hand, and Shapely."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Polygon

from aidl_lang.geometry.curves import Bezier, Circle, Ellipse, Line, Vec
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from aidl_lang.geometry.walls import Widths, thin_wall, widths
from tests.amount import tries
from tests.geometry.models import arc, circle, compound, polygon, primitive, rectangle, structure
from tests.geometry.test_regions import region_of, shapely_of


def hole(shape: SolvedGeometry) -> SolvedStructure:
    return structure("hole", f"hole_{shape.name}", shape)


def lengths(found: Widths) -> tuple[float | None, float | None]:
    return found.wall and found.wall.length, found.gap and found.gap.length


def pairs(*corners: Vec) -> list[Line]:
    return list(itertools.starmap(Line, itertools.pairwise(corners)))


def ring(*corners: Vec) -> Loop:
    return Loop(tuple(pairs(*corners, corners[0])))


def check_places(region: Region, found: Widths) -> None:
    """Each chord has the length of the way between its ends, and these lie on the outline."""
    pieces = [piece for loop in region.loops for piece in loop.pieces]
    for chord in found:
        if chord is not None:
            assert math.dist(chord.a, chord.b) == pytest.approx(chord.length, rel=1e-9, abs=1e-12)
            for end in (chord.a, chord.b):
                assert min(math.dist(p.point(p.nearest(end)), end) for p in pieces) < 1e-6


COMB = [(0, 0), (50, 0), (50, 20), (40, 20), (40, 10), (33, 10), (33, 20), (20, 20), (20, 10), (15, 10)]
COMB += [(15, 20), (0, 20)]
DOVETAIL = [(0, 0), (20, 0), (20, 8), (13, 8), (14, 3), (6, 3), (7, 8), (0, 8)]
SLOT = (Line((0, -2), (20, -2)), arc((20, 0), 2, -90, 90), Line((20, 2), (0, 2)), arc((0, 0), 2, 90, 270))
PLATE = rectangle("r", 0, 0, 80, 50)


BY_HAND = {
    "rectangle": (50, None, PLATE),
    "circle": (20, None, circle("c", 0, 0, 10)),
    "ring": (2, 16, circle("c", 3, 4, 10), hole(circle("d", 3, 4, 8))),
    "eccentric ring": (1, 16, circle("c", 0, 0, 10), hole(circle("d", 1, 0, 8))),
    "hole near an edge": (3, 10, PLATE, hole(circle("d", 40, 8, 5))),
    "slot in a plate": (20, 4, PLATE, hole(rectangle("d", 20, 20, 60, 24))),
    "two holes": (1, 10, PLATE, hole(circle("d", 20, 25, 5)), hole(circle("e", 31, 25, 5))),
    "L-profile": (8, None, polygon("l", (0, 0), (50, 0), (50, 10), (8, 10), (8, 60), (0, 60))),
    "comb": (10, 5, polygon("c", *COMB)),
    "triangle": (5 * 3**0.5, None, polygon("t", (0, 0), (10, 0), (5, 5 * 3**0.5))),
    "rounded bar": (4, None, compound("s", *SLOT)),
    "cut-off corner": (48, None, PLATE, hole(compound("s", *SLOT))),
    "half disc": (10, None, compound("h", arc((0, 0), 10, 0, 180), Line((-10, 0), (10, 0)))),
    "quarter disc": (10, None, compound("h", arc((0, 0), 10, 0, 90), *pairs((0, 10), (0, 0), (10, 0)))),
    "taper": (2, None, polygon("t", (0, 0), (50, 9), (50, 11), (0, 20))),
    "dovetail slot": (3, 6, polygon("d", *DOVETAIL)),
    "ellipse": (6, None, primitive("e", Ellipse((1, 2), 5, 3, 0.4))),
    "ellipse in a plate": (3, 10, PLATE, hole(primitive("e", Ellipse((40, 8), 9, 5, 0)))),
    "dome": (6, None, compound("d", Bezier((0, 0), (0, 8), (10, 8), (10, 0)), Line((10, 0), (0, 0)))),
    "inscribed circle": (0, ..., rectangle("r", -5, -5, 5, 5), hole(circle("c", 0, 0, 5))),
    "hole that touches the edge": (0, ..., PLATE, hole(circle("c", 5, 25, 5))),
    "holes that touch": (0, ..., PLATE, hole(circle("c", 20, 25, 5)), hole(circle("d", 30, 25, 5))),
    "corner to corner": (0, ..., rectangle("r", 0, 0, 5, 5), rectangle("s", 5, 5, 9, 9)),
    "ellipse that touches": (0, ..., PLATE, hole(primitive("e", Ellipse((5, 25), 5, 3, 0)))),
}
"""The wall and the gap of some shapes; where they touch, the gap may be anything."""


@pytest.mark.parametrize("name", BY_HAND)
def test_by_hand(name: str):
    wall, gap, *members = BY_HAND[name]
    region = region_of(*members)
    found = widths(region)
    if wall:
        check_thin(region, found)
    check_places(region, found)
    assert found.wall.length == pytest.approx(wall, rel=1e-9)
    if gap is not ...:
        assert (found.gap and found.gap.length) == (gap and pytest.approx(gap, rel=1e-9))


def check_thin(region: Region, found: Widths) -> None:
    """The wall is told where it is below what is asked for, and only there."""
    wall = found.wall
    if wall is not None:
        thin = thin_wall(region, 1.01 * wall.length)
        assert thin.length == pytest.approx(wall.length)
    assert thin_wall(region, 0.99 * wall.length if wall is not None else 1.0) is None


def test_the_place_is_shown_in_the_middle_of_where_sides_face_each_other():
    wall, _ = widths(region_of(PLATE))
    assert sorted((wall.a, wall.b)) == [(40, 0), (40, 50)]
    wall, _ = widths(region_of(PLATE, hole(circle("d", 40, 8, 5))))
    assert sorted((wall.a, wall.b)) == [pytest.approx((40, 0)), pytest.approx((40, 3))]


def test_nothing_has_no_walls():
    assert widths(Region()) == Widths(None, None)


@pytest.mark.parametrize(("scale", "shift"), [(1e-3, 0.0), (1e6, 0.0), (1.0, 1e5)])
def test_size_and_place_do_not_matter(scale: float, shift: float):
    found = widths(Region((Face(ring(*((scale * x + shift, scale * y + shift) for x, y in COMB))),)))
    assert lengths(found) == pytest.approx((10 * scale, 5 * scale), rel=1e-9)


def test_thousands_of_holes():
    n, side = 50, 151
    holes = [Loop((Circle((3 * i + 2, 3 * j + 2), 1.0),), True) for i in range(n) for j in range(n)]
    holes[25 * 50 + 25] = Loop((Circle((3 * 25 + 2.25, 3 * 25 + 2), 1.0),), True)
    found = widths(Region((Face(ring((0, 0), (side, 0), (side, side), (0, side)), tuple(holes)),)))
    assert lengths(found) == pytest.approx((0.75, 2.0))


@pytest.mark.parametrize("count", [2000, 2001])
def test_a_polygon_of_many_sides(count: int):
    angles = [2 * math.pi * k / count for k in range(count)]
    found = widths(Region((Face(ring(*((10 * math.cos(a), 10 * math.sin(a)) for a in angles))),)))
    wide = 20 * math.cos(math.pi / count) if count % 2 == 0 else 10 * (1 + math.cos(math.pi / count))
    assert lengths(found) == (pytest.approx(wide, rel=1e-12), None)


# --- From outside --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["comb", "wrench", "ring"])
def test_a_wall_is_where_a_shape_falls_apart_when_it_is_eroded(name: str):
    """Below half the wall erosion keeps the pieces and holes there are, above it they change."""
    shapes = {
        "comb": [polygon("h", (0, 0), (30, 0), (30, 20), (18, 20), (16, 11), (14, 20), (0, 20), (0, 10))],
        "wrench": [
            circle("a", -40, 0, 15),
            rectangle("r", -40, -4, 40, 4),
            circle("b", 40, 0, 11),
            hole(circle("d", -40, 0, 6)),
        ],
        "ring": [circle("a", 0, 0, 20), hole(primitive("e", Ellipse((3, 1), 14, 9, 0.3)))],
    }
    region = region_of(*shapes[name])
    wall, _ = widths(region)
    whole = shapely_of(region)

    def topology(depth: float) -> tuple[int, int]:
        left = whole.buffer(-depth, quad_segs=64)
        parts = list(getattr(left, "geoms", [left]))
        return len(parts), sum(len(p.interiors) for p in parts)

    assert topology(0.499 * wall.length) == topology(0)
    assert topology(0.501 * wall.length) != topology(0)


@st.composite
def plates(draw: st.DrawFn) -> list[SolvedGeometry | SolvedStructure]:
    """A plate with up to eight holes of all kinds on a coarse grid, so that they keep apart."""
    cells = draw(st.lists(st.integers(0, 11), min_size=1, max_size=8, unique=True))
    holes = []
    for k in cells:
        x = 20.0 * (k % 4) + 10 + draw(st.floats(-2, 2))
        y = 20.0 * (k // 4) + 10 + draw(st.floats(-2, 2))
        a, b = draw(st.floats(0.5, 7)), draw(st.floats(0.5, 7))
        turn = draw(st.floats(0, 3))
        c, s = math.cos(turn), math.sin(turn)
        corners = [(a * u / 1.5, b * v / 1.5) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        shape = draw(st.sampled_from(["circle", "box", "ellipse"]))
        if shape == "circle":
            geometry = circle("g", x, y, a)
        elif shape == "box":
            geometry = polygon("g", *((x + c * u - s * v, y + s * u + c * v) for u, v in corners))
        else:
            geometry = primitive("g", Ellipse((x, y), a, b, turn))
        holes.append(hole(replace(geometry, name=f"g{k}")))
    return [rectangle("r", 0, 0, 80, 60), *holes]


@tries(30)
@given(plates())
def test_walls_of_plates_are_the_distances_between_their_rings(
    members: list[SolvedGeometry | SolvedStructure],
):
    region = region_of(*members)
    found = widths(region)
    check_places(region, found)
    whole = shapely_of(region)
    rings = [whole.exterior, *whole.interiors]
    near = min(a.distance(b) for a, b in itertools.combinations(rings, 2))
    check_thin(region, found)
    assert found.wall.length == pytest.approx(near, abs=2e-4)
    across = min(_least_width(Polygon(ring)) for ring in whole.interiors)
    assert found.gap.length == pytest.approx(across, rel=1e-4)


def _least_width(shape: Polygon) -> float:
    """Of a convex shape: the least of its extents at right angles to one of its sides."""
    corners = np.array(shape.exterior.coords)
    along = np.diff(corners, axis=0)
    across = np.stack((-along[:, 1], along[:, 0]), axis=1) / np.hypot(along[:, 0], along[:, 1])[:, None]
    return float(np.ptp(corners @ across[:: max(1, len(across) // 400)].T, axis=0).min())
