"""Members along curves stand at equal lengths of them, by the lengths of fine chords; what joins two parts is
where these come to be, and as large as it says; fasteners keep their inset.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

import aidl_lang
from aidl_lang.geometry.solved import SolvedGeometry
from tests.amount import tries
from tests.compiled import compiled

FINE = 20_001


def solved(text: str) -> dict[str, SolvedGeometry]:
    found = compiled(text)
    assert not found.errors
    return {g.name: g for s in found.model.root.walk() for g in s.geometry}


def chords(way: SolvedGeometry) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points of a curve, and its length up to each."""
    spots = np.concatenate([c.points(np.linspace(0, 1, FINE)) for c in way.curves()])
    return spots, np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(spots, axis=0).T))])


def ways(found: dict[str, SolvedGeometry], count: int) -> tuple[list[float], float]:
    """The lengths of the curve at which the members stand, and that of the whole."""
    spots, lengths = chords(found["way"])
    at = []
    for k in range(count):
        (circle,) = found[f"dot[{k}]"].curves()
        away = np.hypot(*(spots - circle.center).T)
        assert away.min() < 1e-4 * lengths[-1]
        at.append(float(lengths[away.argmin()]))
    return at, float(lengths[-1])


BEND = "bezier((0, 0), (10, 60), (50, -20), (80, 30))"
OPEN = [
    BEND,
    "bezier((0, 0), (0, 0), (50, 90), (80, 30))",
    "bezier((0, 0), (90, 50), (-10, 50), (80, 0))",
    "spline([(0, 0), (30, -20), (60, 10), (65, 40)])",
    "wave((0, 0), (90, 10), 8, waves: 3)",
    "spiral(start_radius: 5, end_radius: 30, turns: 3)",
    "path((0, 0), line_to(30, 0), bezier_to((40, 0), (40, 20), (60, -10)), arc_to((80, -10), radius: 12))",
    "cord((0, 0), (60, 20), sag: 25)",
]


@pytest.mark.parametrize("curve", OPEN)
def test_members_stand_at_equal_lengths(curve: str) -> None:
    found = solved(f"drawing d {{ way = {curve}; dot = along(circle(radius: 1), way, n: 9) }}")
    at, whole = ways(found, 9)
    assert at == pytest.approx([whole * k / 8 for k in range(9)], abs=2e-4 * whole)


@pytest.mark.parametrize(
    "curve",
    ["ellipse(rx: 40, ry: 12, angle: 20deg)", "spline([(0, 0), (30, 40), (60, 5), (80, 50)], closed: true)"],
)
def test_closed_curves_have_no_last_member_on_the_first(curve: str) -> None:
    found = solved(f"drawing d {{ way = {curve}; dot = along(circle(radius: 1), way, pitch: 7) }}")
    count = round(chords(found["way"])[1][-1] / 7)
    assert f"dot[{count}]" not in found
    at, whole = ways(found, count)
    assert [b - a for a, b in pairwise(at)] == pytest.approx([whole / count] * (count - 1), rel=2e-3)


def test_members_follow_a_curve_that_bends() -> None:
    """The places at the first guesses are followed by Newton's method."""
    text = """drawing d {
        way = bezier(guess((0, 0)), guess((10, 40)), guess((50, 40)), guess((60, 0)))
        dot = along(circle(radius: 1), way, n: 7, inset: 5)
        constrain { way.p0 == (0, 0); way.p1 == (12, 46); way.p2 == (48, 36); way.p3 == (64, 3) }
    }"""
    at, whole = ways(solved(text), 7)
    assert at == pytest.approx([5 + (whole - 10) * k / 6 for k in range(7)], abs=3e-4 * whole)


@pytest.mark.parametrize("is_upright", [False, True])
def test_members_turn_with_the_curve_or_stay_upright(is_upright: bool) -> None:
    more = ", turn: false" if is_upright else ""
    found = solved(f"drawing d {{ way = {BEND}; bar = along(line((0, 0), (2, 0)), way, n: 5{more}) }}")
    spots, lengths = chords(found["way"])
    for k in range(5):
        start, end = (np.array(found[f"bar[{k}]"].values[name]) for name in ("start", "end"))
        i = min(max(int(np.searchsorted(lengths, lengths[-1] * k / 4)), 1), len(spots) - 2)
        ahead = np.array([1, 0]) if is_upright else spots[i + 1] - spots[i - 1]
        assert (end - start).tolist() == pytest.approx((2 * ahead / np.hypot(*ahead)).tolist(), abs=1e-3)


# --- What joins two parts ------------------------------------------------------------------------------

JOINED = """assembly t {{
    solid a {{ body = circle(center: fixed(({x}, {y})), radius: 3) }}
    solid b {{ body = circle(radius: 3) }}
    constrain b.body.center == a.body.center + polar({reach}, {angle}deg)
    solid v {{ v = {call} }}
}}"""
PLACES = {"x": st.integers(-60, 60), "y": st.integers(-60, 60), "angle": st.integers(0, 359)}


def joined(call: str, **places: int) -> aidl_lang.Model:
    """Two discs, the second of which the solver brings to its place, and what joins them."""
    model = aidl_lang.compile(JOINED.format(call=call, **places))
    assert model.ok, model.diagnostics
    return model


@tries(40)
@given(st.fixed_dictionaries(PLACES), st.integers(70, 150), st.integers(4, 20), st.integers(2, 4))
def test_a_link_is_a_bar_with_round_ends_and_eyes(
    places: dict[str, int], reach: int, width: int, eyes: int
) -> None:
    call = f"link(a.body.center, b.body.center, {width}, eyes: {eyes})"
    found = joined(call, reach=reach, **places).measure("t.v")
    whole = reach * width + math.pi * width**2 / 4 - eyes * math.pi * width**2 / 16
    assert found.area == pytest.approx(whole, rel=1e-9)
    turn = math.radians(places["angle"])
    middle = places["x"] + reach / 2 * math.cos(turn), places["y"] + reach / 2 * math.sin(turn)
    assert found.centroid == pytest.approx(middle, abs=1e-7)


@tries(40)
@given(
    st.fixed_dictionaries(PLACES),
    st.integers(70, 150),
    st.integers(6, 20),
    st.floats(0.1, 0.9),
    st.integers(30, 45),
)
def test_a_ram_is_a_barrel_and_a_rod_with_eyes(
    places: dict[str, int], reach: int, barrel: int, share: float, length: int
) -> None:
    rod = round(share * barrel, 2)
    assume(length < reach - (barrel + rod) / 4 - 1)
    call = f"ram(a.body.center, b.body.center, barrel: {barrel}, rod: {rod}, length: {length})"
    eye, lip = (barrel + rod) / 4, barrel / 5
    half = math.asin(rod / 2 / eye)
    tube = math.pi * barrel**2 / 8 + length * barrel + lip * 0.16 * barrel
    head = math.pi * eye**2 - eye**2 * (half - math.sin(half) * math.cos(half))
    stick = (reach - length - eye * math.cos(half)) * rod
    bores = 2 * math.pi * rod**2 / 16
    found = joined(call, reach=reach, **places).measure("t.v")
    assert found.area == pytest.approx(tube + head + stick - bores, rel=1e-9)


OUTLINES = {
    "rectangle": "rectangle(width: {w}, height: {h})",
    "round corners": "rounded_rectangle(width: {w}, height: {h}, radius: {r})",
    "slot": "slot(length: {w} + 60, width: {h})",
    "circle": "circle(radius: {h})",
    "notched": "l_shape(width: {w}, height: {h}, thickness: 24)",
    "tapered": "polygon((0, 0), ({w}, 3), ({w} - 10, {h}), (5, {h} + 9))",
    "backwards": "polygon((5, {h} + 9), ({w} - 10, {h}), ({w}, 3), (0, 0))",
}


@pytest.mark.parametrize("kind", OUTLINES)
@tries(12)
@given(st.integers(60, 90), st.integers(40, 60), st.integers(3, 15), st.integers(1, 10), st.integers(7, 30))
def test_rivets_are_their_inset_within_an_outline(
    kind: str, w: int, h: int, r: int, inset: int, n: int
) -> None:
    way, rivets = OUTLINES[kind].format(w=w, h=h, r=r), f"rivets(way, n: {n}, inset: {inset}, diameter: 1)"
    found = solved(f"solid s {{ way = {way}\n construction dot = {rivets} }}")
    rim = np.concatenate([c.points(np.linspace(0, 1, 4001)) for c in found["way"].curves()])
    centers = [np.asarray(found[f"dot[{k}]"].values["center"]) for k in range(n)]
    away = [float(np.hypot(*(rim - center).T).min()) for center in centers]
    assert f"dot[{n}]" not in found
    assert inset - 1e-3 <= min(away) <= max(away) <= inset * math.sqrt(2) + 1e-3
    if kind in ("rectangle", "circle", "slot", "tapered", "backwards"):
        assert away == pytest.approx([inset] * n, abs=1e-3)
