"""Regions against closed forms and against Shapely on a fine tessellation."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Polygon

from aidl_lang.geometry.curves import Bezier, Circle, Ellipse, Line
from aidl_lang.geometry.drawing import Drawing, draw
from aidl_lang.geometry.region import Loop, Region, measure
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from tests.amount import tries
from tests.geometry.models import arc, circle, compound, model, primitive, rectangle, structure


def drawn(root: SolvedStructure) -> Drawing:
    return draw(model(root))[0]


def codes(root: SolvedStructure) -> list[str]:
    return [d.code for d in draw(model(root))[1].everything()]


def region_of(*members: SolvedGeometry | SolvedStructure) -> Region:
    return drawn(structure("solid", "s", *members)).regions.get("s", Region())


def pieces(region: Region, kind: type) -> list[object]:
    return [p for loop in region.loops for p in loop.pieces if isinstance(p, kind)]


def flattened(loop: Loop, count: int = 400) -> Polygon:
    rows = [p.points(np.linspace(0, 1, 2 if isinstance(p, Line) else count))[:-1] for p in loop.pieces]
    return Polygon(np.concatenate(rows))


FINE = 2000
"""Chords for each curve."""


def shapely_of(region: Region) -> shapely.Geometry:
    faces = [
        flattened(f.outer, FINE).difference(shapely.unary_union([flattened(h, FINE) for h in f.holes]))
        for f in region.faces
    ]
    return shapely.unary_union(faces)


def assert_closed(region: Region) -> None:
    for loop in region.loops:
        if not loop.is_whole:
            for one, after in zip(loop.pieces, loop.pieces[1:] + loop.pieces[:1], strict=True):
                assert one.ends[1] == after.ends[0]


def hole(shape: SolvedGeometry) -> SolvedStructure:
    return structure("hole", f"hole_{shape.name}", shape)


DOME = compound("dome", Bezier((0, 0), (0, 8), (10, 8), (10, 0)), Line((10, 0), (0, 0)))
WEDGE = compound("wedge", Line((0, 0), (5, 0)), arc((0, 0), 5, 0, 90), Line((0, 5), (0, 0)))
CHAIN = [
    primitive("bottom", Line((0, 0), (10, 0))),
    primitive("right", Line((10 + 4e-6, 6), (10, 4e-6))),
    primitive("top", arc((5, 6), 5, 0, 180)),
    primitive("left", Line((0, 6), (0, 0))),
]
CLOSED_FORMS = {
    "half a dome": (24, "Bezier Line Line", DOME, hole(rectangle("r", 5, -1, 20, 20))),
    "half an ellipse": (
        6 * math.pi,
        "EllipseArc Line",
        primitive("e", Ellipse((0, 0), 6, 2, 0)),
        hole(rectangle("r", 0, -9, 9, 9)),
    ),
    "inscribed circle": (100 - 25 * math.pi, "", rectangle("r", -5, -5, 5, 5), hole(circle("c", 0, 0, 5))),
    "circle that touches": (19 * math.pi, "Circle Circle", circle("a", 0, 0, 10), hole(circle("b", 1, 0, 9))),
    "sector of a disc": (0.75 * 25 * math.pi, "Arc Line Line", circle("disc", 0, 0, 5), hole(WEDGE)),
    "gaps below the tolerance": (60 + 12.5 * math.pi, "Arc Line Line Line", *CHAIN),
    "far from the origin": (
        6 - math.pi / 4,
        "",
        rectangle("r", 1e6, 1e6, 1e6 + 3, 1e6 + 2),
        hole(circle("c", 1e6 + 1, 1e6 + 1, 0.5)),
    ),
    "very small": (
        6e-8 - math.pi * 25e-10,
        "",
        rectangle("r", 0, 0, 3e-4, 2e-4),
        hole(circle("c", 1e-4, 1e-4, 5e-5)),
    ),
}
"""The area of some regions, and the kinds of their pieces where they are but few."""


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_areas_have_their_closed_form(name: str):
    area, kinds, *members = CLOSED_FORMS[name]
    region = region_of(*members)
    assert measure(region).area == pytest.approx(area, rel=1e-5 if "gaps" in name else 1e-8)
    assert_closed(region)
    if kinds:
        assert sorted(type(p).__name__ for p in region.pieces) == kinds.split()


def test_circles_that_touch_are_told_nothing():
    assert not codes(structure("solid", "s", circle("a", 0, 0, 5), circle("b", 10, 0, 5)))


# -- holes and islands ---------------------------------------------------------------------------------------


def test_an_assembly_keeps_bodies_apart_and_its_hole_cuts_all():
    hole = structure("hole", "h", rectangle("slit", -20, -1, 20, 1))
    drawing = drawn(
        structure(
            "assembly",
            "a",
            rectangle("own", -9, -3, -5, 3),
            structure("solid", "b", rectangle("r", -2, -3, 2, 3)),
            structure("solid", "c", rectangle("r", 5, -3, 9, 3)),
            hole,
        )
    )
    assert [b.path for b in drawing.bodies] == ["a", "a.b", "a.c"]
    assert [drawing.measures[b.path].area for b in drawing.bodies] == pytest.approx([16, 16, 16])
    assert all(len(b.region.faces) == 2 for b in drawing.bodies)


# -- properties ----------------------------------------------------------------------------------------------

coordinate = st.floats(-50, 50).map(lambda v: round(v, 2))


@tries(30)
@given(st.permutations(range(4)), coordinate, coordinate, st.floats(0, 6))
def test_measures_do_not_depend_on_order_or_place(order: list[int], x: float, y: float, turn: float):
    corners = [(0.0, 0.0), (20.0, 0.0), (20.0, 8.0), (0.0, 8.0)]
    c, s = math.cos(turn), math.sin(turn)
    moved = [(x + c * p - s * q, y + s * p + c * q) for p, q in corners]
    sides = [primitive(f"l{i}", Line(moved[i], moved[(i + 1) % 4])) for i in range(4)]
    m = measure(region_of(*(sides[i] for i in order)))
    assert m.area == pytest.approx(160)
    assert m.centroid == pytest.approx((x + 10 * c - 4 * s, y + 10 * s + 4 * c), abs=1e-9)


@pytest.mark.parametrize("turn", range(7))
def test_circles_closer_than_their_chords(turn: float):
    """An eccentric ring whose narrowest place is a hundred-thousandth of its size."""
    gap, off = 0.0842, 0.084
    hole = circle("c", off * math.cos(turn), off * math.sin(turn), 12 - gap)
    region = region_of(circle("a", 0, 0, 12), structure("hole", "h", hole))
    assert [type(p) for loop in region.loops for p in loop.pieces] == [Circle, Circle]
