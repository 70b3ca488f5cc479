"""What holds for booleans of any regions: laws of area, and outlines that are exact parts of what was drawn.

Places and sizes come from a coarse grid, so that shapes often share edges, touch, coincide or line up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations

import manifold3d
import numpy as np
import pytest
import shapely
from hypothesis import Phase, example, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from aidl_lang.geometry.boolean import common, united, without
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.region import Face, Loop, Region, length
from aidl_lang.geometry.solved import SolvedStructure
from tests.amount import tries
from tests.geometry.models import compound, model, structure

CHORDS = 128
"""Into how many straight lines a curve is cut for the comparison with polygons."""
EXACT = 1e-9
GRID = 1e-9
"""To which Shapely rounds: without, it loses faces whose edges all but coincide."""

WITHOUT_SHRINKING = (Phase.explicit, Phase.generate)
profile = tries(40, phases=WITHOUT_SHRINKING)
"""A few thousand were run by hand."""

Shape = tuple[Piece, ...]
"""A closed outline, counter-clockwise."""


# -- shapes --------------------------------------------------------------------------------------------------


def turned(p: Vec, about: Vec, degrees: float) -> Vec:
    if degrees % 90 == 0:
        c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[int(degrees // 90) % 4]
    else:
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y = p[0] - about[0], p[1] - about[1]
    return about[0] + c * x - s * y, about[1] + s * x + c * y


def polygon(corners: Sequence[Vec]) -> Shape:
    return tuple(Line(p, q) for p, q in zip(corners, [*corners[1:], corners[0]], strict=True))


def rectangle(x: float, y: float, w: float, h: float, degrees: float) -> Shape:
    corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
    return polygon([turned(p, (x, y), degrees) for p in corners])


def disc(x: float, y: float, r: float) -> Shape:
    return (Circle((x, y), r),)


def segment(x: float, y: float, r: float, first: float, sweep: float) -> Shape:
    """An arc and its chord."""
    start, end = (turned((x + r, y), (x, y), a) for a in (first, first + sweep))
    return Arc((x, y), r, start, end, math.radians(sweep)), Line(end, start)


def sector(x: float, y: float, r: float, first: float, sweep: float) -> Shape:
    start, end = (turned((x + r, y), (x, y), a) for a in (first, first + sweep))
    return Line((x, y), start), Arc((x, y), r, start, end, math.radians(sweep)), Line(end, (x, y))


def ellipse(x: float, y: float, rx: float, ry: float, degrees: float) -> Shape:
    return (Ellipse((x, y), rx, ry, math.radians(degrees)),)


def leaf(x: float, y: float, w: float, h: float, lean: float) -> Shape:
    """A Bézier curve above its chord."""
    curve = Bezier((x + w, y), (x + w + lean, y + h), (x - lean, y + h), (x, y))
    return curve, Line((x, y), (x + w, y))


place = st.integers(-8, 8).map(lambda n: n / 2)
size = st.integers(1, 8).map(lambda n: n / 2)
angle = st.sampled_from((0, 0, 0, 90, 30, 45, 180, 270, 17.3))
sweep = st.sampled_from((60, 90, 180, 120, 270, 200.5))
straight_and_round = st.one_of(
    st.builds(rectangle, place, place, size, size, angle),
    st.builds(disc, place, place, size),
    st.builds(segment, place, place, size, angle, sweep),
    st.builds(sector, place, place, size, angle, sweep.filter(lambda s: s != 180)),
)
curved = st.one_of(
    st.builds(ellipse, place, place, size, size, angle),
    st.builds(leaf, place, place, size, size, st.sampled_from((0, 0, 0.5, -0.5))),
)
any_shape = st.one_of(straight_and_round, straight_and_round, curved)
groups = st.lists(straight_and_round, min_size=1, max_size=3)
mixed = st.lists(any_shape, min_size=1, max_size=2)


# -- from outside --------------------------------------------------------------------------------------------


def region_of(shapes: Sequence[Shape]) -> Region:
    region = Region()
    for shape in shapes:
        region = united(region, Region((Face(Loop(shape)),)))
    return region


def tessellated(shape: Shape) -> NDArray[np.float64]:
    ts = np.linspace(0, 1, CHORDS + 1)
    return np.concatenate([p.points(ts[[0, -1]] if isinstance(p, Line) else ts)[:-1] for p in shape])


def error(shapes: Sequence[Shape]) -> float:
    """The most that area can be off between exact shapes and their polygons: chords depart by at most
    |p''| Δt² / 8, along the whole outline.
    """
    total = 0.0
    for piece in (p for shape in shapes for p in shape):
        if isinstance(piece, Line):
            continue
        if isinstance(piece, Bezier):
            control = np.array((piece.p0, piece.p1, piece.p2, piece.p3))
            bend = 6 * float(np.linalg.norm(np.diff(control, 2, axis=0), axis=1).max())
        else:
            radius = piece.radius if isinstance(piece, Arc | Circle) else max(piece.rx, piece.ry)
            bend = radius * (piece.sweep if isinstance(piece, Arc) else math.tau) ** 2
        total += length(piece) * bend / (8 * CHORDS**2)
    return total


def as_shapely(shapes: Sequence[Shape]) -> shapely.Geometry:
    return shapely.unary_union([shapely.Polygon(tessellated(s)) for s in shapes], grid_size=GRID)


def as_manifold(shapes: Sequence[Shape]) -> manifold3d.CrossSection:
    sections = [manifold3d.CrossSection([tessellated(s)], manifold3d.FillRule.NonZero) for s in shapes]
    return manifold3d.CrossSection.batch_boolean(sections, manifold3d.OpType.Add)


def extent(*regions: Region) -> float:
    boxes = [r.box for r in regions if r]
    return max((max(b[2] - b[0], b[3] - b[1]) for b in boxes), default=1.0)


def off_carrier(spots: NDArray[np.float64], curve: Piece) -> NDArray[np.float64]:
    """How far points lie from the endless line, the whole circle or ellipse, or the Bézier curve."""
    if isinstance(curve, Line):
        (x, y), (u, v) = curve.start, curve.end
        dx, dy = (u - x) / math.dist(curve.start, curve.end), (v - y) / math.dist(curve.start, curve.end)
        return np.abs((spots[:, 0] - x) * dy - (spots[:, 1] - y) * dx)
    if isinstance(curve, Arc | Circle):
        return np.abs(np.hypot(*(spots - np.array(curve.center)).T) - curve.radius)
    if isinstance(curve, Ellipse | EllipseArc):
        c, s = math.cos(curve.angle), math.sin(curve.angle)
        x, y = (spots - np.array(curve.center)).T
        return np.abs(np.hypot((c * x + s * y) / curve.rx, (c * y - s * x) / curve.ry) - 1) * curve.rx
    return np.array([_off_bezier(p, curve) for p in spots])


def _off_bezier(p: NDArray[np.float64], curve: Bezier) -> float:
    """By the real roots of (C(t) - p)·C'(t), a polynomial of degree five."""
    p0, p1, p2, p3 = (np.array(q) for q in (curve.p0, curve.p1, curve.p2, curve.p3))
    power = np.stack((p3 - 3 * p2 + 3 * p1 - p0, 3 * (p2 - 2 * p1 + p0), 3 * (p1 - p0), p0 - p))
    slope = np.polyadd(*(np.polymul(power[:, k], np.polyder(power[:, k])) for k in (0, 1)))
    ts = [t.real for t in np.roots(slope) if abs(t.imag) < 1e-6] + [0.0, 1.0]
    return min(float(np.hypot(*(np.polyval(power[:, k], min(1, max(0, t))) for k in (0, 1)))) for t in ts)


def most_pieces(shapes: Sequence[Shape]) -> int:
    """Each piece once, and one more for each end that may come to lie on it or crossing that it may have."""
    inputs = [piece for shape in shapes for piece in shape]

    def meetings(a: Piece, b: Piece) -> int:
        kinds = {type(a), type(b)}
        if kinds <= {Line, Arc, Circle}:
            return 1 if kinds == {Line} else 2
        return 9 if Bezier in kinds else 4

    return len(inputs) + 2 * sum(meetings(a, b) + 2 for a, b in combinations(inputs, 2))


def assert_exact(region: Region, shapes: Sequence[Shape]) -> None:
    """Closed to the last digit, of parts of the input and of no more than it takes."""
    inputs = [piece for shape in shapes for piece in shape]
    size = extent(region)
    ts = np.linspace(0, 1, 9)
    for loop in region.loops:
        assert loop.is_whole or len(loop.pieces) > 1
        for one, after in zip(loop.pieces, loop.pieces[1:] + loop.pieces[:1], strict=True):
            assert loop.is_whole or one.ends[1] == after.ends[0]
            assert length(one) > 1e-6 * size
            same = [c for c in inputs if _is_part_of(one, c)]
            assert same, f"nothing of the kind of {one} was drawn"
            away = min(float(off_carrier(one.points(ts), curve).max()) for curve in same)
            assert away <= EXACT * size, f"{one} is {away} off"
    for face in region.faces:
        assert face.outer.area > 0
        assert all(hole.area < 0 for hole in face.holes)
    assert sum(len(loop.pieces) for loop in region.loops) <= most_pieces(shapes)


def _is_part_of(piece: Piece, curve: Piece) -> bool:
    kinds = ((Line,), (Arc, Circle), (Ellipse, EllipseArc), (Bezier,))
    return any(isinstance(piece, kind) and isinstance(curve, kind) for kind in kinds)


def same_area(a: float, b: float, scale: float) -> bool:
    return abs(a - b) <= EXACT * scale


def form(region: Region) -> tuple[int, int]:
    return len(region.faces), len(region.loops)


# -- laws ----------------------------------------------------------------------------------------------------


def check_laws(one: Sequence[Shape], other: Sequence[Shape]) -> None:
    a, b = region_of(one), region_of(other)
    both, shared, rest = united(a, b), common(a, b), without(a, b)
    scale = a.area + b.area
    assert same_area(both.area + shared.area, scale, scale)
    assert same_area(rest.area + shared.area, a.area, scale)
    assert same_area(united(rest, shared).area, a.area, scale)
    assert same_area(common(rest, b).area, 0, scale)
    for region in (both, shared, rest):
        assert_exact(region, [*one, *other])


def check_polygons(one: Sequence[Shape], other: Sequence[Shape]) -> None:
    a, b = region_of(one), region_of(other)
    slack = error([*one, *other]) + 1e-6 * extent(a, b) * (a.perimeter + b.perimeter)
    p, q = as_shapely(one), as_shapely(other)
    m, n = as_manifold(one), as_manifold(other)
    for region, expected, section in (
        (united(a, b), shapely.union(p, q, grid_size=GRID), m + n),
        (common(a, b), shapely.intersection(p, q, grid_size=GRID), m ^ n),
        (without(a, b), shapely.difference(p, q, grid_size=GRID), m - n),
    ):
        assert abs(region.area - expected.area) <= slack
        assert abs(region.area - section.area()) <= slack


@profile
@given(groups, groups)
def test_areas_add_up(one: list[Shape], other: list[Shape]):
    check_laws(one, other)


@tries(20, phases=WITHOUT_SHRINKING)
@given(mixed, mixed)
@example([leaf(0.5, 1, 1, 1, 0)], [leaf(0.5, 1, 2.5, 1, 0)])  # parts of one Bézier curve, run both ways
@example([ellipse(-3, 4, 3, 2.5, 270)], [disc(-2, 4, 3.5)])  # a touch with all but the same curvature
@example([ellipse(2, 0, 3.5, 2, 30)], [sector(-2, -1.5, 3, 30, 120), ellipse(2, 0, 3.5, 2, 30)])
def test_areas_add_up_with_ellipses_and_bezier_curves(one: list[Shape], other: list[Shape]):
    check_laws(one, other)


@profile
@given(mixed, mixed)
def test_areas_agree_with_polygons(one: list[Shape], other: list[Shape]):
    check_polygons(one, other)


@tries(20, phases=WITHOUT_SHRINKING)
@given(any_shape, any_shape, any_shape)
def test_union_takes_any_order(one: Shape, other: Shape, third: Shape):
    a, b, c = (region_of([s]) for s in (one, other, third))
    scale = a.area + b.area + c.area
    ab, ba = united(a, b), united(b, a)
    assert form(ab) == form(ba)
    assert same_area(ab.area, ba.area, scale)
    left, right = united(ab, c), united(a, united(b, c))
    assert form(left) == form(right)
    assert same_area(left.area, right.area, scale)
    assert form(united(left, left)) == form(left)
    assert same_area(united(left, left).area, left.area, scale)
    assert not without(left, right)


holes_and_islands = st.lists(st.tuples(any_shape, st.lists(any_shape, max_size=1)), max_size=3)


@tries(20, phases=WITHOUT_SHRINKING)
@given(mixed, holes_and_islands)
def test_nested_structures_agree_with_polygons(solid: list[Shape], holes: list[tuple[Shape, list[Shape]]]):
    def part(kind: str, name: str, shapes: Sequence[Shape], *children: SolvedStructure) -> SolvedStructure:
        return structure(kind, name, *(compound(f"g{k}", *s) for k, s in enumerate(shapes)), *children)

    cuts = [
        part("hole", f"h{k}", [rim], *([part("solid", "i", island)] if island else []))
        for k, (rim, island) in enumerate(holes)
    ]
    drawing, _ = draw(model(part("solid", "s", solid, *cuts)))
    found = drawing.regions.get("s", Region())
    islands = [shape for _, island in holes for shape in island]
    everything = [*solid, *(rim for rim, _ in holes), *islands]
    cut = shapely.difference(as_shapely(solid), as_shapely([rim for rim, _ in holes]), grid_size=GRID)
    expected = shapely.union(cut, as_shapely(islands), grid_size=GRID)
    slack = error(everything) + 2e-6 * sum(length(p) for s in everything for p in s) * 20
    assert abs(found.area - expected.area) <= slack
    assert_exact(found, everything)


# -- closed forms --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("r", "q", "d"), [(10, 4, 9), (10, 10, 3), (7.3, 2.1, 8.9), (100, 0.5, 100)])
def test_a_plate_with_a_hole_that_a_second_circle_cuts_into(r: float, q: float, d: float):
    """The two circles cover πr² + πq² less the lens they share."""
    plate = Region((Face(Loop(rectangle(-150, -150, 300, 300, 0))),))
    drilled = without(plate, Region((Face(Loop(disc(0, 0, r))),)))
    cut = without(drilled, Region((Face(Loop(disc(d * 0.6, d * 0.8, q))),)))
    alpha = math.acos((d * d + r * r - q * q) / (2 * d * r))
    beta = math.acos((d * d + q * q - r * r) / (2 * d * q))
    lens = r * r * (alpha - math.sin(2 * alpha) / 2) + q * q * (beta - math.sin(2 * beta) / 2)
    assert cut.area == pytest.approx(300**2 - math.pi * (r * r + q * q) + lens, rel=1e-12)
    (hole,) = cut.faces[0].holes
    assert {(p.radius) for p in hole.pieces if isinstance(p, Arc)} == {r, q}
    assert len(hole.pieces) == 2
