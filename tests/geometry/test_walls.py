"""Walls and gaps against numbers worked out by hand, and Shapely."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Polygon

from aidl_lang.geometry.curves import Bezier, Circle, Ellipse, Line
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from aidl_lang.geometry.walls import Widths, thin_wall, widths
from tests.amount import tries
from tests.geometry.models import arc, circle, compound, polygon, primitive, rectangle, structure
from tests.geometry.test_regions import region_of, shapely_of


def hole(name: str, shape: SolvedGeometry) -> SolvedStructure:
    return structure("hole", name, shape)


def lengths(found: Widths) -> tuple[float | None, float | None]:
    return found.wall and found.wall.length, found.gap and found.gap.length


def same(found: float | None, expected: float | None, rel: float = 1e-9) -> bool:
    if found is None or expected is None:
        return found is expected
    return found == pytest.approx(expected, rel=rel)


def check_places(region: Region, found: Widths) -> None:
    """Each chord has the length of the way between its ends, and these lie on the outline."""
    pieces = [piece for loop in region.loops for piece in loop.pieces]
    for chord in found:
        if chord is not None:
            assert math.dist(chord.a, chord.b) == pytest.approx(chord.length, rel=1e-9, abs=1e-12)
            for end in (chord.a, chord.b):
                assert min(math.dist(p.point(p.nearest(end)), end) for p in pieces) < 1e-6


COMB = (
    (0, 0),
    (50, 0),
    (50, 20),
    (40, 20),
    (40, 10),
    (33, 10),
    (33, 20),
    (20, 20),
    (20, 10),
    (15, 10),
    (15, 20),
)
SLOT = (Line((0, -2), (20, -2)), arc((20, 0), 2, -90, 90), Line((20, 2), (0, 2)), arc((0, 0), 2, 90, 270))
PLATE = rectangle("r", 0, 0, 80, 50)


@pytest.mark.parametrize(
    ("members", "wall", "gap"),
    [
        pytest.param([PLATE], 50, None, id="rectangle"),
        pytest.param([circle("c", 0, 0, 10)], 20, None, id="circle"),
        pytest.param([circle("c", 3, 4, 10), hole("h", circle("d", 3, 4, 8))], 2, 16, id="ring"),
        pytest.param([circle("c", 0, 0, 10), hole("h", circle("d", 1, 0, 8))], 1, 16, id="eccentric ring"),
        pytest.param([PLATE, hole("h", circle("d", 40, 8, 5))], 3, 10, id="hole near an edge"),
        pytest.param([PLATE, hole("h", rectangle("d", 20, 20, 60, 24))], 20, 4, id="slot in a plate"),
        pytest.param(
            [PLATE, hole("h", circle("d", 20, 25, 5)), hole("g", circle("e", 31, 25, 5))],
            1,
            10,
            id="two holes",
        ),
        pytest.param(
            [polygon("l", (0, 0), (50, 0), (50, 10), (8, 10), (8, 60), (0, 60))], 8, None, id="L-profile"
        ),
        pytest.param([polygon("c", *COMB, (0, 20))], 10, 5, id="comb"),
        pytest.param(
            [polygon("t", (0, 0), (10, 0), (5, 5 * math.sqrt(3)))], 5 * math.sqrt(3), None, id="triangle"
        ),
        pytest.param([compound("s", *SLOT)], 4, None, id="rounded bar"),
        pytest.param([PLATE, hole("h", compound("s", *SLOT))], 48, None, id="cut-off corner"),
        pytest.param(
            [compound("h", arc((0, 0), 10, 0, 180), Line((-10, 0), (10, 0)))], 10, None, id="half disc"
        ),
        pytest.param(
            [compound("h", arc((0, 0), 10, 0, 90), Line((0, 10), (0, 0)), Line((0, 0), (10, 0)))],
            10,
            None,
            id="quarter disc",
        ),
        pytest.param([polygon("t", (0, 0), (50, 9), (50, 11), (0, 20))], 2, None, id="taper"),
        pytest.param(
            [polygon("d", (0, 0), (20, 0), (20, 8), (13, 8), (14, 3), (6, 3), (7, 8), (0, 8))],
            3,
            6,
            id="dovetail slot",
        ),
        pytest.param([primitive("e", Ellipse((1, 2), 5, 3, 0.4))], 6, None, id="ellipse"),
        pytest.param(
            [PLATE, hole("h", primitive("e", Ellipse((40, 8), 9, 5, 0)))], 3, 10, id="ellipse in a plate"
        ),
        pytest.param(
            [compound("d", Bezier((0, 0), (0, 8), (10, 8), (10, 0)), Line((10, 0), (0, 0)))],
            6,
            None,
            id="dome",
        ),
    ],
)
def test_by_hand(members: list[SolvedGeometry | SolvedStructure], wall: float, gap: float | None):
    region = region_of(*members)
    found = widths(region)
    check_thin(region, found)
    assert same(lengths(found)[0], wall), found
    assert same(lengths(found)[1], gap), found
    check_places(region, found)


def check_thin(region: Region, found: Widths) -> None:
    """The wall is told where it is below what is asked for, and only there."""
    wall = found.wall
    if wall is not None:
        thin = thin_wall(region, 1.01 * wall.length)
        assert thin is not None
        assert thin.length == pytest.approx(wall.length)
    assert thin_wall(region, 0.99 * wall.length if wall is not None else 1.0) is None


def test_the_place_is_shown_in_the_middle_of_where_sides_face_each_other():
    wall, _ = widths(region_of(PLATE))
    assert wall is not None
    assert sorted((wall.a, wall.b)) == [(40, 0), (40, 50)]
    wall, gap = widths(region_of(PLATE, hole("h", circle("d", 40, 8, 5))))
    assert wall is not None
    assert gap is not None
    assert sorted((wall.a, wall.b)) == [pytest.approx((40, 0)), pytest.approx((40, 3))]


@pytest.mark.parametrize(
    "members",
    [
        pytest.param([rectangle("r", -5, -5, 5, 5), hole("h", circle("c", 0, 0, 5))], id="inscribed circle"),
        pytest.param([PLATE, hole("h", circle("c", 5, 25, 5))], id="hole that touches the edge"),
        pytest.param(
            [PLATE, hole("h", circle("c", 20, 25, 5)), hole("g", circle("d", 30, 25, 5))], id="holes"
        ),
        pytest.param([rectangle("r", 0, 0, 5, 5), rectangle("s", 5, 5, 9, 9)], id="corner to corner"),
        pytest.param([PLATE, hole("h", primitive("e", Ellipse((5, 25), 5, 3, 0)))], id="ellipse"),
    ],
)
def test_what_hangs_together_by_a_point_has_a_wall_of_nothing(
    members: list[SolvedGeometry | SolvedStructure],
):
    wall, _ = widths(region_of(*members))
    assert wall is not None
    assert wall.length == 0


def test_nothing_has_no_walls():
    assert widths(Region()) == Widths(None, None)


@pytest.mark.parametrize(("scale", "shift"), [(1e-3, 0.0), (1e6, 0.0), (1.0, 1e5)])
def test_size_and_place_do_not_matter(scale: float, shift: float):
    corners = [(scale * x + shift, scale * y + shift) for x, y in (*COMB, (0, 20))]
    lines = (Line(p, q) for p, q in itertools.pairwise([*corners, corners[0]]))
    found = widths(Region((Face(Loop(tuple(lines))),)))
    assert lengths(found) == pytest.approx((10 * scale, 5 * scale), rel=1e-9)


def test_ten_thousand_holes():
    n, side = 100, 301
    corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
    outer = Loop(tuple(Line(p, q) for p, q in itertools.pairwise([*corners, corners[0]])))
    holes = [Loop((Circle((3 * i + 2, 3 * j + 2), 1.0),), True) for i in range(n) for j in range(n)]
    holes[5050] = Loop((Circle((3 * 50 + 2.25, 3 * 50 + 2), 1.0),), True)
    found = widths(Region((Face(outer, tuple(holes)),)))
    assert lengths(found) == pytest.approx((0.75, 2.0))


@pytest.mark.parametrize("count", [2000, 2001])
def test_a_polygon_of_many_sides(count: int):
    angles = [2 * math.pi * k / count for k in range(count + 1)]
    corners = [(10 * math.cos(a), 10 * math.sin(a)) for a in angles]
    corners[-1] = corners[0]
    found = widths(Region((Face(Loop(tuple(Line(p, q) for p, q in itertools.pairwise(corners)))),)))
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
            hole("h", circle("d", -40, 0, 6)),
        ],
        "ring": [circle("a", 0, 0, 20), hole("h", primitive("e", Ellipse((3, 1), 14, 9, 0.3)))],
    }
    region = region_of(*shapes[name])
    wall, _ = widths(region)
    assert wall is not None
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
        holes.append(hole(f"h{k}", geometry))
    return [rectangle("r", 0, 0, 80, 60), *holes]


@tries(60)
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
    assert found.wall is not None
    check_thin(region, found)
    assert found.wall.length == pytest.approx(near, abs=2e-4)
    across = min(_least_width(Polygon(ring)) for ring in whole.interiors)
    assert found.gap is not None
    assert found.gap.length == pytest.approx(across, rel=1e-4)


def _least_width(shape: Polygon) -> float:
    """Of a convex shape: the least of its extents at right angles to one of its sides."""
    corners = np.array(shape.exterior.coords)
    along = np.diff(corners, axis=0)
    across = np.stack((-along[:, 1], along[:, 0]), axis=1) / np.hypot(along[:, 0], along[:, 1])[:, None]
    return float(np.ptp(corners @ across[:: max(1, len(across) // 400)].T, axis=0).min())
