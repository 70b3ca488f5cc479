"""Second moments of area against closed forms, and against fine polygons."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, inward
from aidl_lang.geometry.region import Face, Loop, Region, measure
from aidl_lang.geometry.survey import Inertia, inertia
from tests.amount import tries


def of(region: Region | Loop) -> Inertia:
    region = region if isinstance(region, Region) else Region((Face(region),))
    return inertia(region, measure(region).centroid)


def numbers(found: Inertia) -> tuple[float, float, float]:
    return found.xx, found.yy, found.xy


def test_ellipse_and_its_halves():
    whole = of(Loop((Ellipse((1, 2), 5, 3, 0.4),)))
    principal = (math.pi * 3 * 125 / 4, math.pi * 27 * 5 / 4)
    assert whole.principal == pytest.approx(principal)
    assert whole.angle == pytest.approx(math.degrees(0.4) - 90)  # the longer axis has the smaller moment
    start, end = (6.0, 2.0), (-4.0, 2.0)
    half = EllipseArc((1, 2), 5, 3, 0, start, end, 0, math.pi)
    found = of(Loop((half, Line(end, start))))
    assert numbers(found) == pytest.approx(
        (27 * 5 * (math.pi / 8 - 8 / (9 * math.pi)), math.pi * 3 * 125 / 8, 0), abs=1e-10
    )


def test_area_below_a_cubic():
    """A Bézier curve that is y = x³ − x² + 1 over 0..1: ∫∫ x² is 1/6 − 1/5 + 1/3, and so on."""
    curve = Bezier((1, 1), (2 / 3, 2 / 3), (1 / 3, 1), (0, 1))
    assert curve.point(0.5)[1] == pytest.approx(1 / 8 - 1 / 4 + 1)
    loop = Loop((Line((0, 0), (1, 0)), Line((1, 0), (1, 1)), curve, Line((0, 1), (0, 0))))
    m, found = measure(Region((Face(loop),))), of(loop)
    x, y = m.centroid
    cubed = np.polynomial.Polynomial((1, 0, -1, 1)) ** 3
    about_axes = (
        float(cubed.integ()(1)) / 3,
        1 / 6 - 1 / 5 + 1 / 3,
        float((np.polynomial.Polynomial((0, 0.5)) * np.polynomial.Polynomial((1, 0, -1, 1)) ** 2).integ()(1)),
    )
    expected = np.array(about_axes) - m.area * np.array((y * y, x * x, x * y))
    assert numbers(found) == pytest.approx(expected, rel=1e-12)


def test_a_shallow_arc_of_a_large_circle_loses_nothing():
    """A strip 1 wide and 2 high whose right side bulges by a micrometre: that of the rectangle, nearly."""
    radius = 1e6
    half = math.asin(1 / radius)
    center = (1 - radius * math.cos(half), 0.0)
    bulge = Arc(center, radius, (1, -1), (1, 1), 2 * half)
    loop = Loop((Line((0, -1), (1, -1)), bulge, Line((1, 1), (0, 1)), Line((0, 1), (0, -1))))
    assert numbers(of(loop)) == pytest.approx((2 / 3, 1 / 6, 0), rel=1e-5, abs=1e-9)


SQUARE = ((0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5))


@pytest.mark.parametrize("distance", [3.0, 1e6])
def test_faces_that_lie_apart_go_by_the_parallel_axis_theorem(distance: float):
    edges = [[Line((x + p, q), (x - q, p)) for p, q in SQUARE] for x in (-distance, distance)]
    found = of(Region(tuple(Face(Loop(tuple(square))) for square in edges)))
    assert found.yy == pytest.approx(2 / 12 + 2 * distance**2, rel=1e-12)
    assert found.xx == pytest.approx(2 / 12, rel=1e-6)


# --- Random outlines -----------------------------------------------------------------------------

angles = st.floats(-3, 3)


@st.composite
def outlines(draw: st.DrawFn) -> Region:
    """A plate of lines, an arc, a Bézier curve and a piece of an ellipse, with two holes."""
    w, h = draw(st.floats(20, 60)), draw(st.floats(20, 60))
    sweep = draw(st.floats(10, 170))
    r = h / 2 / math.sin(math.radians(sweep / 2))
    center = w - r * math.cos(math.radians(sweep / 2)), h / 2
    right = Arc(center, r, (w, 0), (w, h), math.radians(sweep))
    lift = draw(st.floats(-5, 15))
    top = Bezier((w, h), (w * 0.7, h + lift), (w * 0.2, h - 3), (0, h))
    left = EllipseArc((0, h / 2), draw(st.floats(1, 8)), h / 2, 0, (0, h), (0, 0), math.pi / 2, math.pi)
    holes = (
        Loop((Circle((w * 0.3, h * 0.4), draw(st.floats(0.5, 4))),), reversed=True),
        Loop((Ellipse((w * 0.7, h * 0.4), 4, draw(st.floats(0.5, 3)), draw(angles)),), reversed=True),
    )
    return Region((Face(Loop((Line((0, 0), (w, 0)), right, top, left)), holes),))


def by_polygons(region: Region, count: int = 3000) -> NDArray[np.float64]:
    """Area, first and second moments about the origin of fine polygons: sums over triangles."""
    total = np.zeros(6)
    for loop in region.loops:
        rows = np.concatenate([piece.points(np.linspace(0, 1, count + 1))[:-1] for piece in loop.pieces])
        (x, y), (u, v) = rows.T, np.roll(rows, -1, axis=0).T
        a = (x * v - u * y) / 2
        sums = (
            a,
            a * (x + u) / 3,
            a * (y + v) / 3,
            a * (y * y + y * v + v * v) / 6,
            a * (x * x + x * u + u * u) / 6,
            a * (2 * x * y + 2 * u * v + x * v + u * y) / 12,
        )
        total += (-1 if loop.reversed else 1) * np.array([s.sum() for s in sums])
    return total


@tries(40)
@given(outlines())
def test_random_outlines_as_fine_polygons(region: Region):
    area, mx, my, xx, yy, xy = by_polygons(region)
    expected = xx - my * my / area, yy - mx * mx / area, xy - mx * my / area
    found = of(region)
    assert numbers(found) == pytest.approx(expected, rel=1e-5, abs=1e-5 * found.polar)


@tries(40)
@given(outlines(), angles, st.floats(-1e3, 1e3), st.booleans())
def test_a_moved_and_mirrored_outline_has_the_same_moments(
    region: Region, turn: float, away: float, mirrored: bool
):
    """Principal moments stay, the axis turns along, and a mirror image has the opposite product."""
    degrees = math.degrees(turn)

    def moved(loop: Loop) -> Loop:
        pieces = tuple(inward(p, (away, -away), degrees, mirrored) for p in loop.pieces)
        whole = mirrored and not loop.is_whole  # whole circles count as counter-clockwise in any frame
        return Loop(pieces, loop.reversed ^ whole)

    there = Region(tuple(Face(moved(f.outer), tuple(map(moved, f.holes))) for f in region.faces))
    here, found = of(region), of(there)
    assert found.polar == pytest.approx(here.polar, rel=1e-9)
    assert found.principal == pytest.approx(here.principal, rel=1e-9)
    difference = (here.xx - here.yy) / 2, -here.xy
    size, axis = math.hypot(*difference), math.atan2(difference[1], difference[0])
    axis = -(axis - 2 * turn) if mirrored else axis - 2 * turn
    expected = size * math.cos(axis), size * math.sin(axis)
    assert ((found.xx - found.yy) / 2, -found.xy) == pytest.approx(expected, abs=1e-9 * here.polar)
