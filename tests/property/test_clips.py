"""What holds for all that is clipped: it is what it was, cut off at the outline, as Shapely cuts it."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import Phase, given
from hypothesis import strategies as st

from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.region import Region
from tests.amount import tries
from tests.compiled import compiled
from tests.geometry.test_regions import shapely_of

CLOSE = 0.01
"""Relative to the size of what is compared."""
SHAPES = (
    "circle(center: {at}, radius: 13)",
    "rectangle(center: {at}, width: 30, height: 17)",
    "rectangle(center: {at}, width: 24, height: 19, angle: 20deg)",
    "rounded_rectangle(center: {at}, width: 34, height: 18, radius: 5)",
    "star(center: {at}, outer_radius: 19, inner_radius: 8, points: 5)",
    "ring(center: {at}, outer_radius: 18, inner_radius: 9)",
    "ellipse(center: {at}, rx: 19, ry: 8, angle: 15deg)",
    "slot(center: {at}, length: 34, width: 12)",
)

places = st.tuples(st.integers(-20, 20), st.integers(-20, 20))
shapes = st.builds(lambda shape, at: shape.format(at=at), st.sampled_from(SHAPES), places)
outlines = st.builds(
    lambda shape, at: shape.format(at=at),
    st.sampled_from([s for s in SHAPES if "ring" not in s]),
    st.tuples(st.integers(-6, 6), st.integers(-6, 6)),
)
lines = st.tuples(places, places).filter(lambda ends: ends[0] != ends[1])
profile = tries(16, phases=(Phase.explicit, Phase.generate))


def drawing_of(text: str) -> Drawing:
    found = compiled(text)
    assert {d.code for d in found.errors} <= {"E0339"}
    return found.drawing


def pane_of(shape: str) -> shapely.Geometry:
    return shapely_of(drawing_of(f"solid pane {{ rim = {shape} }}").regions["pane"])


def ink_of(drawing: Drawing) -> shapely.Geometry:
    return shapely.unary_union(
        [shapely.LineString(p.points(np.linspace(0, 1, 400))) for s in drawing.strokes for p in s.pieces]
    )


def program(window: str, clip: str, one: str, hole: str, other: str, line: object, drawn: str) -> str:
    start, end = line
    return f"""
    assembly view {{
        construction window = {window}
        {clip} assembly scene {{
            solid one {{ rim = {one} hole gap {{ rim = {hole} }} }}
            solid other {{ rim = {other} }}
            drawing ink {{ way = line({start}, {end}) rim = {drawn} }}
        }}
        twin = mirror(scene, about: line((0, 60), (100, 70)))
    }}"""


@profile
@given(outlines, shapes, shapes, shapes, lines, shapes)
def test_what_is_clipped_is_what_it_was_inside_the_outline(
    window: str, one: str, hole: str, other: str, line: object, drawn: str
):
    whole = drawing_of(program(window, "", one, hole, other, line, drawn))
    clipped = drawing_of(program(window, "@clip(window)", one, hole, other, line, drawn))
    pane = pane_of(window)
    for name in ("one", "other"):
        path = f"view.scene.{name}"
        expected = shapely_of(whole.regions.get(path, Region())).intersection(pane)
        found = shapely_of(clipped.regions.get(path, Region()))
        assert found.symmetric_difference(expected).area <= CLOSE * pane.area
        own, twin = (clipped.regions.get(f"view.{of}.{name}", Region()).area for of in ("scene", "twin"))
        assert twin == pytest.approx(own, rel=1e-6, abs=1e-6)
    ink, all_ink = ink_of(clipped), ink_of(whole)
    own = all_ink.intersection(pane)
    assert own.difference(ink.buffer(0.05)).length <= CLOSE * pane.length
    near = ink.intersection(shapely.box(-60, -60, 60, 55))
    assert near.difference(pane.buffer(0.05)).length <= CLOSE * pane.length
    assert near.difference(all_ink.buffer(0.05)).length <= CLOSE * pane.length


@profile
@given(outlines, shapes, shapes)
def test_an_outline_in_another_leaves_what_lies_in_both(outer: str, inner: str, one: str):
    drawing = drawing_of(f"""
    assembly view {{
        construction outer = {outer}
        construction inner = {inner}
        @clip(outer) assembly a {{ @clip(inner) solid b {{ rim = {one} }} }}
    }}""")
    panes = [pane_of(shape) for shape in (outer, inner, one)]
    expected = panes[0].intersection(panes[1]).intersection(panes[2])
    found = shapely_of(drawing.regions.get("view.a.b", Region()))
    assert found.symmetric_difference(expected).area <= CLOSE * panes[0].area
