"""The picture of a comparison: its areas against booleans of shapely, its marks against what was done."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from svgelements import Close, Line, Move, Path

import aidl_lang
from aidl_lang.export.comparison import Comparison
from aidl_lang.export.comparison.showing import overlay
from aidl_lang.export.marks import Area, Curves, Frame
from aidl_lang.export.svg import to_svg
from tests.amount import tries

SVG = "{http://www.w3.org/2000/svg}"
KINDS = ("both", "before", "after")
STEPS = 256
"""Chords of a round piece: a circle of radius 10 loses 0.008 mm² to them."""


def comparison(before: str, after: str) -> Comparison:
    return aidl_lang.diff(aidl_lang.compile(before), aidl_lang.compile(after))


def groups(found: Comparison) -> dict[str, ElementTree.Element]:
    svg = ElementTree.fromstring(to_svg(overlay(found)))
    return {g.attrib["id"]: g for g in svg.iter(f"{SVG}g") if "id" in g.attrib}


def covered(group: ElementTree.Element) -> shapely.Geometry:
    """What the filled paths of a group cover, read by another reader."""
    loops = [
        shapely.Polygon(_points(Path(subpath)))
        for path in group.iter(f"{SVG}path")
        if path.attrib["fill"] != "none"
        for subpath in Path(path.attrib["d"]).as_subpaths()
    ]
    area: shapely.Geometry = shapely.Polygon()
    for loop in loops:
        area = area.symmetric_difference(loop)
    return area


def _points(path: Path) -> list[tuple[float, float]]:
    """SVG counts y downwards."""
    found: list[tuple[float, float]] = []
    for segment in path:
        if not isinstance(segment, Move):
            steps = 1 if isinstance(segment, Line | Close) else STEPS
            found += [(x, -y) for x, y in segment.npoint(np.arange(1, steps + 1) / steps)]
    return found


def disc(x: float, y: float, r: float) -> shapely.Geometry:
    return shapely.Point(x, y).buffer(r, quad_segs=STEPS)


TEXT = """
assembly t {{
    solid plate {{
        body = rectangle(center: fixed(({x}, {y})), width: 40, height: 20)
        hole eye {{ rim = circle(center: fixed(({x} + 4, {y})), radius: {r}) }}
    }}
    solid knob {{ rim = circle(center: fixed((18, 0)), radius: 9) }}
}}
"""


def material(x: float, y: float, r: float) -> shapely.Geometry:
    plate = shapely.box(x - 20, y - 10, x + 20, y + 10).difference(disc(x + 4, y, r))
    return plate.union(disc(18, 0, 9))


@tries(15)
@given(st.integers(-60, 60), st.integers(-25, 25), st.integers(2, 9))
def test_areas_agree_with_shapely(x: int, y: int, r: int) -> None:
    found = groups(comparison(TEXT.format(x=0, y=0, r=5), TEXT.format(x=x, y=y, r=r)))
    before, after = material(0, 0, 5), material(x, y, r)
    expected = (before & after, before - after, after - before)
    for kind, area in zip(KINDS, expected, strict=True):
        drawn = covered(found[kind])
        assert drawn.symmetric_difference(area).area < 0.1, kind


def test_arrows_lead_from_old_to_new() -> None:
    text = """
    assembly t {{
        solid s {{
            r = square(center: fixed((0, 0)), size: 60)
            hole e {{ c = circle(center: fixed(({x}, 3)), radius: 2) }}
        }}
    }}"""
    moves = {g.name: g for g in overlay(comparison(text.format(x=-9), text.format(x=9))).groups}[
        "moves"
    ].marks
    shaft, head = moves
    assert isinstance(shaft, Curves)
    assert isinstance(head, Area)
    assert shaft.pieces[0].start == pytest.approx((-9, 3))  # type: ignore[union-attr]
    assert head.face.outer.pieces[0].start == pytest.approx((9, 3))  # type: ignore[union-attr]


def test_strokes_of_both_are_grey() -> None:
    text = "drawing d {{ l = line(fixed((0, 0)), fixed((9, 0))) m = line(fixed((0, 5)), fixed(({x}, 5))) }}"
    picture = {g.name: g for g in overlay(comparison(text.format(x=4), text.format(x=8))).groups}
    inks = [m.ink.color for m in picture["after-outlines"].marks if isinstance(m, Curves)]
    assert len(set(inks)) == 2
    assert picture["legend"].marks == ()


def test_plans_and_nothing_at_all() -> None:
    plan = "assembly a {{ solid p {{ todo }} constrain p.width == {w} }}"
    picture = {g.name: g for g in overlay(comparison(plan.format(w=10), plan.format(w=20))).groups}
    assert [type(m) for m in picture["after-outlines"].marks] == [Frame]
    empty = "assembly a { construction c = circle(center: fixed((0, 0)), radius: 1) }"
    assert to_svg(overlay(comparison(empty, empty))).startswith("<?xml")
