"""Fillets, offsets, strokes and hulls against closed forms and against Shapely on a fine tessellation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, assume, given
from hypothesis import strategies as st

from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, Line, Piece, Vec, inward, union_bounds
from aidl_lang.geometry.finishing import Work, corners_of, finish, fitted, sized
from aidl_lang.geometry.offsets import hull, offset, thick
from aidl_lang.geometry.region import Face, Loop, Region, length
from tests.amount import tries
from tests.geometry.models import arc
from tests.geometry.test_regions import assert_closed, pieces

FINE = 256
"""Segments of a quarter of a circle in Shapely."""


def polygon(corners: Sequence[Vec]) -> Region:
    lines = [Line(p, q) for p, q in zip(corners, [*corners[1:], corners[0]], strict=True)]
    return Region((Face(Loop(tuple(lines))),))


def rounded(curves: Sequence[Piece], kind: str, size: float) -> list[Piece]:
    """All corners finished; a chain that is closed stays closed."""
    result = finish(curves, [Work(kind, c, (size, size)) for c in corners_of(curves, 1e-6)])
    assert not result.failures
    return [c for c in result.curves if c is not None] + [f.piece for f in result.finished]


def enclosed(curves: Sequence[Piece]) -> float:
    """The area inside curves that make one chain, by a fine tessellation."""
    lines = [shapely.LineString(np.round(c.points(np.linspace(0, 1, 2001)), 9)) for c in curves]
    (face,) = shapely.get_parts(shapely.polygonize(lines))
    return float(face.area)


radii = st.floats(0.35, 1.0)


@st.composite
def stars(draw: st.DrawFn) -> list[Vec]:
    """The corners of a simple polygon about the origin, within 50 mm."""
    reach = draw(st.lists(radii, min_size=3, max_size=12))
    turn = 2 * math.pi / len(reach)
    return [
        (50 * r * math.cos(turn * k + 0.1), 50 * r * math.sin(turn * k + 0.1)) for k, r in enumerate(reach)
    ]


# --- Fillets and chamfers ----------------------------------------------------------------------------


BOWS = [arc((3, 4), 10, *ends) for ends in ((0, 200), (200, 0), (30, -120))]
FREE = [
    Bezier((0, 0), (15, -10), (30, 15), (40, 0)),
    Line((40, 0), (40, 30)),
    Bezier((40, 30), (20, 20), (10, 40), (0, 0)),
]


@pytest.mark.parametrize("curves", [*([bow, Line(bow.end, bow.start)] for bow in BOWS), FREE])
@pytest.mark.parametrize("r", [0.3, 2.0])
def test_fillets_are_tangent(curves: list[Piece], r: float) -> None:
    """Whichever way the curves run: directions agree at both touches, which are `r` from the centre."""
    made = finish(curves, [Work("fillet", c, (r, r)) for c in corners_of(curves, 1e-6)])
    assert len(made.finished) == len(curves)
    for f in made.finished:
        for t, arm, cut in zip((0.0, 1.0), f.work.corner.arms, f.cuts, strict=True):
            (ax, ay), (bx, by) = f.piece.direction(t), arm.curve.direction(cut)
            assert ax * by - ay * bx == pytest.approx(0, abs=1e-9)
            assert arm.curve.point(cut) == pytest.approx(f.piece.ends[int(t)], abs=1e-9)
            assert math.dist(arm.curve.point(cut), f.piece.center) == pytest.approx(r, abs=1e-9)


@tries(40)
@given(stars(), st.floats(0.2, 0.9))
def test_polygons_round_off_at_both_kinds_of_corners(corners: list[Vec], share: float) -> None:
    """Each corner of angle α changes the area by r² (cot(α/2) - (π - α)/2), towards the material or away."""
    sides = polygon(corners).faces[0].outer.pieces
    found = corners_of(sides, 1e-6)
    room = min(length(c) for c in sides) / 2
    r = share * room * min(math.tan(abs(c.turn) / 2) for c in found)
    expected = shapely.Polygon(corners).area
    for c in found:
        a, sign = abs(c.turn), math.copysign(1, c.turn)
        # The arm that arrives comes first; the other lies to its right at a convex corner of this sense.
        expected += sign * r * r * (1 / math.tan(a / 2) - (math.pi - a) / 2)
    assert enclosed(rounded(sides, "fillet", r)) == pytest.approx(expected, rel=1e-5)


# --- Offsets -----------------------------------------------------------------------------------------


@tries(60)
@given(stars(), st.floats(0.2, 25), st.booleans())
def test_offset_of_polygons_against_shapely(corners: list[Vec], distance: float, inwards: bool) -> None:
    d = -distance if inwards else distance
    ours, theirs = (
        offset(polygon(corners), d, sharp=False),
        shapely.Polygon(corners).buffer(d, quad_segs=FINE),
    )
    assert ours.area == pytest.approx(theirs.area, abs=0.02)
    # Parts that just touch, or just do not, are told apart by less than the error of a circle of chords.
    near = [shapely.Polygon(corners).buffer(d + by, quad_segs=FINE) for by in (-2e-3, 0.0, 2e-3)]
    counts = [len(shapely.get_parts(each)) for each in near]
    assert len(ours.faces) in counts or abs(theirs.area - ours.area) < 1e-3
    assert_closed(ours)
    assert all(isinstance(p, Line | Arc | Circle) for loop in ours.loops for p in loop.pieces)


@given(st.floats(10, 30), st.floats(10, 30), st.floats(0.1, 20))
def test_offset_of_a_convex_polygon_has_its_closed_form(a: float, b: float, d: float) -> None:
    """A + P d + π d² with round corners; of a right triangle with sharp ones it is similar."""
    triangle = polygon([(0, 0), (a, 0), (0, b)])
    c = math.hypot(a, b)
    grown = offset(triangle, d, sharp=False)
    assert grown.area == pytest.approx(a * b / 2 + (a + b + c) * d + math.pi * d * d)
    assert grown.perimeter == pytest.approx(a + b + c + 2 * math.pi * d)
    inradius = a * b / (a + b + c)
    assert offset(triangle, d).area == pytest.approx(a * b / 2 * ((inradius + d) / inradius) ** 2)


@pytest.mark.parametrize(
    "d", [6.0, -6.0, *(pytest.param(d, marks=pytest.mark.slow) for d in (-2.0, -14.0, -19.0))]
)
def test_offset_of_an_ellipse_keeps_its_distance(d: float) -> None:
    """Also where it bends closer than the distance (the least radius of curvature is 13.3)."""
    ellipse = Region((Face(Loop((Ellipse((3, 1), 30, 20, 0.4),))),))
    ours = offset(ellipse, d)
    outline = shapely.LinearRing(Ellipse((3, 1), 30, 20, 0.4).points(np.linspace(0, 1, 8001)[:-1]))
    for p in (q for loop in ours.loops for piece in loop.pieces for q in piece.points(np.linspace(0, 1, 41))):
        assert outline.distance(shapely.Point(p)) == pytest.approx(abs(d), abs=1e-3)
    theirs = shapely.Polygon(outline).buffer(d, quad_segs=FINE)
    assert ours.area == pytest.approx(theirs.area, rel=2e-5, abs=0.01)


@tries(40)
@given(stars())
def test_the_largest_fillet_of_a_polygon(corners: list[Vec]) -> None:
    """Two tangents share each edge: the least of edge / (cot half one angle + cot half the other)."""
    lines = [Line(p, q) for p, q in zip(corners, [*corners[1:], corners[0]], strict=True)]
    works = [Work("fillet", c, (0.0, 0.0)) for c in corners_of(lines, 1e-6)]
    assume(len(works) == len(lines))
    shares = {c.corner.at: 1 / math.tan(abs(c.corner.turn) / 2) for c in works}
    most = min(math.dist(p, q) / (shares[p] + shares[q]) for p, q in (line.ends for line in lines))
    made = fitted(lines, works, [1] * len(works), 100.0)
    assert made[0].sizes[0] == pytest.approx(most, rel=1e-6)
    assert not finish(lines, made).failures
    larger = [sized(w, w.sizes[0] * (1 + 1e-6)) for w in made]
    assert finish(lines, larger).failures


# --- Strokes -------------------------------------------------------------------------------------------


@tries(40, suppress_health_check=[HealthCheck.filter_too_much])
@given(
    st.lists(st.tuples(st.floats(-40, 40), st.floats(-40, 40)), min_size=2, max_size=6, unique=True),
    st.floats(0.5, 20),
    st.sampled_from(["round", "butt", "square"]),
)
def test_strokes_against_shapely(way: list[Vec], width: float, caps: str) -> None:
    # Where a leg is shorter than the pen is wide, Shapely lets the joint stand out over a flat end.
    shortest = 1 if caps == "round" else width
    assume(all(math.dist(p, q) > shortest for k, p in enumerate(way) for q in way[:k]))
    lines = [Line(p, q) for p, q in pairwise(way)]
    theirs = shapely.LineString(way).buffer(
        width / 2, quad_segs=FINE, cap_style={"butt": "flat"}.get(caps, caps)
    )
    ours = thick(lines, width, caps)
    assert ours.area == pytest.approx(theirs.area, abs=0.02)
    assert_closed(ours)


def test_stroke_of_an_arc_wider_than_its_radius() -> None:
    """Without caps it is half a disc of radius 5."""
    bow = [arc((0, 0), 2, 0, 180)]
    assert thick(bow, 6, "butt").area == pytest.approx(math.pi * 25 / 2)
    theirs = shapely.LineString(bow[0].points(np.linspace(0, 1, 4001))).buffer(3, quad_segs=FINE)
    assert thick(bow, 6).area == pytest.approx(theirs.area, rel=1e-4)


@pytest.mark.parametrize(
    "curve",
    [
        Ellipse((3, 1), 33, 20, 0.35),
        Bezier((0, 0), (10, 40), (50, 30), (60, 3)),
        Bezier((0, 0), (70, 50), (-30, 50), (40, 0)),
    ],
)
def test_stroke_of_a_free_curve_has_its_box_moved_out(curve: Piece) -> None:
    """Parallel curves are fitted, yet true where they are level or upright."""
    fine = curve.points(np.linspace(0, 1, 400_001))
    ours = thick([curve], 5).faces[0].outer.pieces
    theirs = [*(fine.min(axis=0) - 2.5), *(fine.max(axis=0) + 2.5)]
    assert union_bounds([p.box for p in ours]) == pytest.approx(tuple(theirs), abs=1e-8)


# --- Hulls and clips -----------------------------------------------------------------------------------

places = st.tuples(st.floats(-20, 20), st.floats(-20, 20))
curves = st.one_of(
    st.builds(Circle, places, st.floats(0.5, 8)),
    st.builds(arc, places, st.floats(0.5, 8), st.floats(0, 350), st.floats(0, 350)).filter(
        lambda a: abs(a.sweep) > 0.05
    ),
    st.builds(Line, places, places),
    st.builds(Bezier, places, places, places, places),
    st.builds(Ellipse, places, st.floats(0.5, 9), st.floats(0.5, 9), st.floats(0, 3)),
)


@tries(60)
@given(st.lists(curves, min_size=2, max_size=6))
def test_hulls_against_shapely(drawn: list[Piece]) -> None:
    # Of a line its ends, and no two points that all but coincide: among such GEOS loses corners.
    counts = [2 if isinstance(c, Line) else 2001 for c in drawn]
    spots = np.concatenate([c.points(np.linspace(0, 1, n)) for c, n in zip(drawn, counts, strict=True)])
    theirs = shapely.convex_hull(shapely.MultiPoint(np.unique(np.round(spots, 5), axis=0)))
    ours = hull(drawn)
    assert ours.area == pytest.approx(theirs.area, rel=1e-4, abs=5e-3)
    assert_closed(ours)


@given(st.floats(1, 10), st.floats(1, 10), st.floats(12, 40))
def test_hull_of_two_circles_has_its_closed_form(a: float, b: float, d: float) -> None:
    """Two tangents of length √(d² - (a - b)²), and the arcs on the far sides."""
    ours = hull([Circle((0, 0), a), Circle((d, 0), b)])
    tangent, lean = math.sqrt(d * d - (a - b) ** 2), math.asin((a - b) / d)
    expected = (a + b) * tangent + a * a * (math.pi / 2 + lean) + b * b * (math.pi / 2 - lean)
    assert ours.area == pytest.approx(expected, rel=1e-12)
    assert len(pieces(ours, Arc)) == 2


# --- Frames --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize(
    "curve",
    [
        Line((1, 2), (5, 3)),
        arc((1, 2), 3, 20, 250),
        Circle((1, 2), 3),
        Ellipse((1, 2), 5, 2, 0.3),
        Bezier((0, 0), (3, 9), (8, -4), (9, 2)),
    ],
)
def test_curves_in_another_frame(curve: Piece, mirrored: bool) -> None:
    """The points of the curve in the frame are those of the curve, one by one turned and reflected back."""
    ts = np.linspace(0, 1, 4001)
    (x, y), c, s = (curve.points(ts) - (7, -2)).T, math.cos(0.7), math.sin(0.7)
    expected = shapely.LineString(
        np.stack(((-1 if mirrored else 1) * (c * x + s * y), c * y - s * x), axis=1)
    )
    ours = inward(curve, (7, -2), math.degrees(0.7), mirrored).points(np.linspace(0, 1, 200))
    assert max(expected.distance(shapely.Point(p)) for p in ours) < 1e-5
