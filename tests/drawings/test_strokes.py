"""Affine maps of curves and how far they reach, against points of the curves."""

from __future__ import annotations

import math

import numpy as np
from fontTools.misc.transform import Transform
from hypothesis import assume, given
from hypothesis import strategies as st

from aidl_lang.common.drawings import Bow, Stroke, as_curves, bow, box, furthest, mapped
from aidl_lang.geometry.curves import Arc, Circle, Ellipse, EllipseArc, Line, Piece
from aidl_lang.geometry.faces import curve_of
from tests.amount import tries

coordinates = st.floats(-100, 100, allow_nan=False)
places = st.tuples(coordinates, coordinates)
factors = st.floats(-3, 3, allow_nan=False)
matrices = st.builds(Transform, factors, factors, factors, factors, coordinates, coordinates)
PARAMETERS = np.linspace(0, 1, 401)


def turned(center: tuple[float, float], rx: float, ry: float, turn: float, first: float, sweep: float) -> Bow:
    c, s = math.cos(turn), math.sin(turn)
    return bow(center, (rx * c, rx * s), (-ry * s, ry * c), first, sweep)


radii = st.floats(0.5, 40, allow_nan=False)
turns = st.floats(-7, 7, allow_nan=False)
sweeps = st.floats(0.2, 6.2).flatmap(lambda s: st.sampled_from([s, -s]))
bows = st.builds(turned, places, radii, radii, turns, turns, sweeps)
strokes = st.one_of(st.tuples(places, places), st.tuples(places, places, places, places), bows)


def sampled(stroke: Stroke) -> np.ndarray:
    """Points of a stroke, by its definition alone."""
    if isinstance(stroke, Bow):
        return np.array([stroke.at(stroke.first + t * stroke.sweep) for t in PARAMETERS])
    t = PARAMETERS[:, None]
    if len(stroke) == 2:
        return (1 - t) * np.array(stroke[0]) + t * np.array(stroke[1])
    a, b, c, d = (np.array(p) for p in stroke)
    return (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t * t * c + t**3 * d


def image(p: np.ndarray, matrix: Transform) -> np.ndarray:
    a, b, c, d, e, f = matrix
    return p @ np.array([[a, b], [c, d]]) + np.array([e, f])


@tries(150)
@given(strokes, matrices)
def test_the_image_of_a_curve_is_the_curve_of_the_images(stroke: Stroke, matrix: Transform):
    assert np.allclose(sampled(mapped(stroke, matrix)), image(sampled(stroke), matrix), atol=1e-9)


@tries(100)
@given(strokes, matrices, matrices)
def test_two_maps_are_one_product(stroke: Stroke, outer: Transform, inner: Transform):
    one, two = mapped(mapped(stroke, inner), outer), mapped(stroke, outer.transform(inner))
    assert np.allclose(sampled(one), sampled(two), atol=1e-8)


@tries(150)
@given(strokes, st.floats(0, 7))
def test_nothing_reaches_further_and_something_as_far(stroke: Stroke, angle: float):
    way = math.cos(angle), math.sin(angle)
    found = float((sampled(stroke) @ np.array(way)).max())
    reach = furthest([stroke], way)
    assert reach >= found - 1e-9
    assert reach <= found + 0.02  # between two of the points


@tries(200)
@given(bows, matrices)
def test_a_mapped_arc_is_the_exact_curve_in_place(stroke: Bow, matrix: Transform):
    a, b, c, d, _, _ = matrix
    assume(abs(a * d - b * c) > 0.05)
    there = mapped(stroke, matrix)
    curve = curve_of(there)
    assert isinstance(curve, Arc | EllipseArc)
    assert np.allclose(curve.points(PARAMETERS), sampled(there), atol=1e-6)
    assert np.allclose(curve.box, box([there]), atol=1e-6)


def test_circles_stay_circles_under_similarities_alone():
    circle = bow((1.0, 2.0), (5.0, 0.0), (0.0, 5.0))
    there = mapped(circle, Transform(0.6, 0.8, -0.8, 0.6, 3.0, 4.0))
    assert curve_of(there) == Circle((3.0 + 0.6 - 1.6, 4.0 + 0.8 + 1.2), 5.0)
    assert isinstance(curve_of(mapped(circle, Transform(1.0, 0.0, 0.0, 1.01, 0.0, 0.0))), Ellipse)
    skewed: Piece = curve_of(mapped(circle, Transform(1.0, 0.0, 1.0, 1.0, 0.0, 0.0)))
    assert isinstance(skewed, Ellipse)
    assert math.isclose(skewed.rx * skewed.ry, 25.0, rel_tol=1e-12)


def test_an_arc_pressed_flat_is_a_line():
    assert isinstance(curve_of(mapped(turned((0, 0), 5, 5, 0, 0, 2), Transform(1, 0, 0, 0, 0, 0))), Line)


@tries(60)
@given(bows)
def test_cubics_follow_an_arc(stroke: Bow):
    for k, (start, one, two, end) in enumerate(as_curves(stroke)):
        count = len(as_curves(stroke))
        t = stroke.first + stroke.sweep * (k + 0.5) / count
        middle = [(p + 3 * q + 3 * r + s) / 8 for p, q, r, s in zip(start, one, two, end, strict=True)]
        assert math.dist(middle, stroke.at(t)) < 1e-6
