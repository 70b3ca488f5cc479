"""What joins two parts is where these come to be, and as large as it says; fasteners keep their inset."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import aidl_lang
from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from tests.amount import tries

JOINED = """assembly t {{
    solid a {{ body = circle(center: fixed(({x}, {y})), radius: 3) }}
    solid b {{ body = circle(radius: 3) }}
    constrain b.body.center == a.body.center + polar({reach}, {angle}deg)
    solid v {{ v = {call} }}
}}"""
SPOTS = st.integers(-60, 60)
REACHES = st.integers(70, 150)
ANGLES = st.integers(0, 359)


def joined(call: str, x: int, y: int, reach: int, angle: int) -> aidl_lang.Model:
    """Two discs, the second of which the solver brings to its place, and what joins them."""
    model = aidl_lang.compile(JOINED.format(x=x, y=y, reach=reach, angle=angle, call=call))
    assert model.ok, model.diagnostics
    return model


@tries(40)
@given(SPOTS, SPOTS, REACHES, ANGLES, st.integers(4, 20), st.integers(2, 4))
def test_a_link_is_a_bar_with_round_ends_and_eyes(
    x: int, y: int, reach: int, angle: int, width: int, eyes: int
) -> None:
    model = joined(f"link(a.body.center, b.body.center, {width}, eyes: {eyes})", x, y, reach, angle)
    whole = reach * width + math.pi * width**2 / 4 - eyes * math.pi * width**2 / 16
    assert model.measure("t.v").area == pytest.approx(whole, rel=1e-9)
    middle = np.array([x, y]) + reach / 2 * np.array(turned(angle))
    assert model.measure("t.v").centroid == pytest.approx(middle.tolist(), abs=1e-7)


@tries(40)
@given(SPOTS, SPOTS, REACHES, ANGLES, st.integers(6, 20), st.floats(0.1, 0.9), st.integers(30, 45))
def test_a_ram_is_a_barrel_and_a_rod_with_eyes(
    x: int, y: int, reach: int, angle: int, barrel: int, share: float, length: int
) -> None:
    rod = round(share * barrel, 2)
    assume(length < reach - (barrel + rod) / 4 - 1)
    call = f"ram(a.body.center, b.body.center, barrel: {barrel}, rod: {rod}, length: {length})"
    model = joined(call, x, y, reach, angle)
    eye, lip = (barrel + rod) / 4, barrel / 5
    half = math.asin(rod / 2 / eye)
    tube = math.pi * barrel**2 / 8 + length * barrel + lip * 0.16 * barrel
    head = math.pi * eye**2 - eye**2 * (half - math.sin(half) * math.cos(half))
    stick = (reach - length - eye * math.cos(half)) * rod
    bores = 2 * math.pi * rod**2 / 16
    assert model.measure("t.v").area == pytest.approx(tube + head + stick - bores, rel=1e-9)


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
@tries(20)
@given(st.integers(60, 90), st.integers(40, 60), st.integers(3, 15), st.integers(1, 10), st.integers(7, 30))
def test_rivets_are_their_inset_within_an_outline(
    kind: str, w: int, h: int, r: int, inset: int, n: int
) -> None:
    call = OUTLINES[kind].format(w=w, h=h, r=r)
    text = f"solid s {{ way = {call}\n construction dot = rivets(way, n: {n}, inset: {inset}, diameter: 1) }}"
    compiled = pipeline.compile(SourceFile("test.aidl", text))
    assert not compiled.errors
    assert compiled.model is not None
    found = {g.name: g for s in compiled.model.root.walk() for g in s.geometry}
    rim = np.concatenate([c.points(np.linspace(0, 1, 4001)) for c in found["way"].curves()])
    away = [
        float(np.hypot(*(rim - np.asarray(found[f"dot[{k}]"].values["center"])).T).min()) for k in range(n)
    ]
    assert f"dot[{n}]" not in found
    short = [a for a in away if a < inset - 1e-3]
    beyond = [a for a in away if a > inset * math.sqrt(2) + 1e-3]
    assert short == beyond == []
    if kind in ("rectangle", "circle", "slot", "tapered", "backwards"):
        assert away == pytest.approx([inset] * n, abs=1e-3)


def turned(angle: float) -> tuple[float, float]:
    return math.cos(math.radians(angle)), math.sin(math.radians(angle))
