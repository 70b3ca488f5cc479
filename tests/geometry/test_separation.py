"""Pairs of curves that are told apart are held against the search for crossings, which finds none in them."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, Line, Piece, Vec, ends, locate
from aidl_lang.geometry.intersect import Table, intersections
from aidl_lang.geometry.network import Hulls

TOLERANCE = 1e-5

# Coarse coordinates, so that curves often touch, share ends or lie on each other.
spots = st.tuples(*[st.integers(-6, 6).map(float)] * 2)
radii = st.integers(1, 5).map(float)
bends = st.sampled_from([math.pi / 2, math.pi, -math.pi / 2, 1.0, -3.0])


def arc_between(start: Vec, end: Vec, sweep: float) -> Arc:
    """From point to point, bent by so much."""
    (x, y), (u, v) = start, end
    far = 1 / (2 * math.tan(sweep / 2))
    center = (x + u) / 2 - (v - y) * far, (y + v) / 2 + (u - x) * far
    return Arc(center, math.dist(center, start), start, end, sweep)


@st.composite
def curves_from(draw: st.DrawFn, start: Vec) -> Piece:
    end = draw(spots.filter(lambda p: p != start))
    return draw(
        st.one_of(
            st.just(Line(start, end)),
            st.builds(arc_between, st.just(start), st.just(end), bends),
            st.builds(Bezier, st.just(start), spots, spots, st.just(end)),
        )
    )


@st.composite
def drawings(draw: st.DrawFn) -> list[Piece]:
    """A chain of curves, each from the end of the one before it, and some that are closed."""
    chain: list[Piece] = []
    at = draw(spots)
    for _ in range(draw(st.integers(1, 4))):
        chain.append(draw(curves_from(at)))
        at = ends(chain[-1])[1]
    closed = st.one_of(
        st.builds(Circle, spots, radii), st.builds(Ellipse, spots, radii, radii, st.sampled_from([0.0, 0.5]))
    )
    return chain + draw(st.lists(closed, max_size=2))


def may_meet(curves: list[Piece]) -> dict[tuple[int, int], bool]:
    """Whether each pair may meet in more than a shared end."""
    places = sorted({p for curve in curves for p in ends(curve)})
    nodes = np.array([[places.index(p) for p in ends(curve)] for curve in curves])
    pairs = list(combinations(range(len(curves)), 2))
    rows = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    hulls = Hulls(Table(curves), TOLERANCE)
    found = {(i, j) for i, j in hulls.meeting(rows, nodes, np.array(places)).tolist()}
    return {pair: pair in found for pair in pairs}


@given(drawings())
def test_curves_told_apart_have_only_shared_ends_in_common(curves: list[Piece]):
    for (i, j), is_open in may_meet(curves).items():
        a, b = curves[i], curves[j]
        shared = set(ends(a)) & set(ends(b))
        if not is_open:
            spots = [p for _, _, p in intersections(a, b, TOLERANCE)]
            spots += [p for p in ends(a) if locate(b, p, TOLERANCE) is not None]
            spots += [p for p in ends(b) if locate(a, p, TOLERANCE) is not None]
            assert all(any(math.dist(p, q) <= 2 * TOLERANCE for q in shared) for p in spots)
