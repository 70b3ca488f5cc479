"""Bodies laid flat on sheets: all of them, apart, inside, moved rigidly, each stock by itself."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Polygon, box

from aidl_lang.geometry.curves import Circle, Line, Piece
from aidl_lang.geometry.drawing import Body, Drawing, draw
from aidl_lang.geometry.sheets import Layout, laid_out
from aidl_lang.geometry.solved import SolvedStructure
from tests.amount import tries
from tests.geometry.models import arc, circle, compound, model, polygon, primitive, rectangle, structure


def drawing_of(*members: SolvedStructure) -> Drawing:
    return draw(model(structure("assembly", "part", *members)))[0]


def shape(body: Body) -> Polygon:
    """Close to the body: its vertices lie on the outline."""
    (face,) = body.region.faces
    outer, *holes = face.polygons(1e-3)
    return Polygon(outer, holes)


def numbers(pieces: Iterable[Piece]) -> list[complex]:
    """Points that tell where curves lie: ends and middles, centres of circles."""
    of = ([p.center] if isinstance(p, Circle) else [*p.ends, p.point(0.5)] for p in pieces)
    return [complex(*spot) for spots in of for spot in spots]


def motion(before: list[complex], after: list[complex]) -> tuple[complex, complex]:
    """The factor and the shift of z → factor z + shift, which is checked to be the motion of all points."""
    spread = max(abs(z - before[0]) for z in before)
    far = next(k for k, z in enumerate(before) if abs(z - before[0]) == spread)
    factor = (after[far] - after[0]) / (before[far] - before[0]) if spread else 1
    shift = after[0] - factor * before[0]
    assert all(abs(factor * z + shift - w) < 1e-9 for z, w in zip(before, after, strict=True))
    return factor, shift


def check(drawing: Drawing, layout: Layout, sheet: tuple[float, float], spacing: float) -> None:
    """Every body is there once, as it was, inside its sheet and apart from all others."""
    assert sorted(b.path for d in layout.sheets for b in d.bodies) == sorted(b.path for b in drawing.bodies)
    before = {body.path: body for body in drawing.bodies}
    inside = box(spacing - 1e-6, spacing - 1e-6, sheet[0] - spacing + 1e-6, sheet[1] - spacing + 1e-6)
    for laid in layout.sheets:
        assert laid.box == (0, 0, *sheet)
        shapes = [shape(body) for body in laid.bodies]
        assert all(inside.covers(s) for s in shapes)
        assert all(a.distance(b) >= spacing - 1e-6 for a, b in combinations(shapes, 2))
        assert len({(b.style.material, b.style.thickness) for b in laid.bodies}) == 1
        for body in laid.bodies:
            old, new = before[body.path].region.pieces, body.region.pieces
            assert list(map(type, old)) == list(map(type, new))
            factor, _ = motion(numbers(old), numbers(new))
            assert min(abs(factor - 1j**k) for k in range(4)) < 1e-9  # turned by quarters; no mirror
            assert body.region.area == pytest.approx(before[body.path].region.area, rel=1e-12)


@st.composite
def parts(draw: st.DrawFn) -> SolvedStructure:
    w, h = draw(st.floats(2, 60)), draw(st.floats(2, 60))
    x, y = draw(st.floats(-500, 500)), draw(st.floats(-500, 500))
    outline = draw(
        st.sampled_from(
            [
                [(0, 0), (w, 0), (w, h), (0, h)],
                [(0, 0), (w, 0), (w / 3, h)],
                [(0, 0), (w, 0), (w, h / 3), (w / 4, h / 3), (w / 4, h), (0, h)],
                "circle",
                "tongue",
            ]
        )
    )
    if outline == "circle":
        geometry = circle("g", x, y, w / 2)
    elif outline == "tongue":
        tip = arc((x + w, y + h / 2), h / 2, -90, 90)
        low, high = Line((x, y), tip.start), Line(tip.end, (x, y + h))
        geometry = compound("g", low, tip, high, Line(high.end, low.start))
    else:
        geometry = polygon("g", *((x + u, y + v) for u, v in outline))
    stock = {"material": [None, "birch", "steel"], "thickness": [None, 3.0]}
    looks = {key: (value,) for key, values in stock.items() if (value := draw(st.sampled_from(values)))}
    return structure("solid", "s", geometry, **looks)


@tries(60)
@given(st.lists(parts(), min_size=1, max_size=12), st.floats(0, 8), st.booleans())
def test_any_parts_lie_apart_and_inside(members, spacing, tall):
    drawing = drawing_of(*(replace(m, name=f"s{k}") for k, m in enumerate(members)))
    sheet = (110.0, 150.0) if tall else (150.0, 110.0)
    layout = laid_out(drawing, sheet, spacing)
    assert layout == laid_out(drawing, sheet, spacing)
    if layout.oversize:
        sizes = {b.path: (b.box[2] - b.box[0], b.box[3] - b.box[1]) for b in drawing.bodies}
        room = min(sheet) - 2 * spacing, max(sheet) - 2 * spacing
        large = [p for p, (w, h) in sizes.items() if min(w, h) > room[0] or max(w, h) > room[1]]
        assert [path for path, _ in layout.oversize] == large
    else:
        check(drawing, layout, sheet, spacing)


def plate(name: str, w: float, h: float, x: float = 0, **looks) -> SolvedStructure:
    return structure("solid", name, rectangle("r", x, 0, x + w, h), **looks)


def test_parts_are_turned_where_it_helps_and_not_otherwise():
    def factors(layout: Layout, drawing: Drawing) -> list[complex]:
        before = {body.path: numbers(body.region.pieces) for body in drawing.bodies}
        laid = (body for sheet in layout.sheets for body in sheet.bodies)
        found = (motion(before[body.path], numbers(body.region.pieces))[0] for body in laid)
        return [complex(round(f.real), round(f.imag)) for f in found]

    long = drawing_of(plate("a", 90, 30))
    assert factors(laid_out(long, (50, 100), 2), long) == [1j]
    pair = drawing_of(plate("a", 90, 20), plate("b", 20, 90, 200))
    assert factors(laid_out(pair, (130, 130), 5), pair) == [1, 1]
    tight = laid_out(pair, (100, 60), 5)  # one above the other, both lying
    assert len(tight.sheets) == 1
    assert sorted(factors(tight, pair), key=str) == sorted([1, 1j], key=str)


def line(name: str, x0: float, y0: float, x1: float, y1: float) -> SolvedStructure:
    return structure("drawing", name, primitive("l", Line((x0, y0), (x1, y1))))


def test_a_drawing_inside_a_part_moves_with_it_whole():
    held = structure("solid", "s", rectangle("r", 0, 0, 90, 20), line("mark", 10, 5, 100, 15))
    drawing = drawing_of(held, plate("other", 30, 30, 95))
    layout = laid_out(drawing, (40, 200), 5)
    assert layout.strays == ()
    (laid,) = (d for d in layout.sheets if any(b.path == "part.s" for b in d.bodies))
    body = next(b for b in laid.bodies if b.path == "part.s")
    (stroke,) = laid.strokes
    moved = motion(numbers(drawing.bodies[0].region.pieces), numbers(body.region.pieces))
    assert moved[0] == pytest.approx(1j)
    along = motion(numbers(drawing.strokes[0].pieces), numbers(stroke.pieces))
    assert along == pytest.approx(moved)
    # It runs 10 mm over the edge, so the sheet keeps that much free.
    assert max(z.imag for z in numbers(stroke.pieces)) <= 195


def test_a_drawing_over_several_parts_is_cut_where_they_end():
    a, b = plate("a", 40, 20), plate("b", 30, 20, 60)
    drawing = drawing_of(a, b, line("across", -10, 5, 100, 5))
    layout = laid_out(drawing, (100, 100), 5)
    lengths = sorted(math.dist(*p.ends) for d in layout.sheets for s in d.strokes for p in s.pieces)
    assert lengths == pytest.approx([30, 40])
    (stray,) = layout.strays
    assert stray.geometry == "part.across.l"
    off = sorted(tuple(sorted(x for x, _ in p.ends)) for p in stray.pieces)
    assert off == [pytest.approx(r) for r in ((-10, 0), (40, 60), (90, 100))]


def test_of_overlapping_parts_the_one_that_has_most_is_engraved():
    # 30 mm of the line lie on a, all 50 on b; drawn first or last makes no difference.
    a, b = plate("a", 30, 20), plate("b", 80, 20)
    for members in ((a, b), (b, a)):
        drawing = drawing_of(*members, line("l", 5, 5, 55, 5))
        layout = laid_out(drawing, (200, 100), 5)
        (laid,) = layout.sheets
        (stroke,) = laid.strokes
        (piece,) = stroke.pieces
        wide = next(body for body in laid.bodies if body.path == "part.b")
        assert math.dist(*piece.ends) == pytest.approx(50)
        assert piece.ends[0][0] - wide.box[0] == pytest.approx(5)
        assert layout.strays == ()


@tries(4)
@given(st.lists(parts(), min_size=2, max_size=8), st.floats(0, 8))
def test_any_parts_packed_by_outlines_lie_apart_and_inside(members, spacing):
    """All of one stock, since each takes a second."""
    drawing = drawing_of(*(replace(m, name=f"s{k}", attributes={}) for k, m in enumerate(members)))
    sheet = (150.0, 110.0)
    by_boxes, layout = laid_out(drawing, sheet, spacing), laid_out(drawing, sheet, spacing, nest=0.5)
    assert layout.oversize == by_boxes.oversize
    if not layout.oversize:
        check(drawing, layout, sheet, spacing)
        assert len(layout.sheets) <= len(by_boxes.sheets)


def test_outlines_interlock_where_boxes_cannot():
    ell = [(0, 0), (50, 0), (50, 10), (10, 10), (10, 50), (0, 50)]
    ells = [structure("solid", f"p{k}", polygon("g", *((x + 60 * k, y) for x, y in ell))) for k in range(2)]
    drawing = drawing_of(*ells)
    assert len(laid_out(drawing, (80, 80), 2).sheets) == 2
    layout = laid_out(drawing, (80, 80), 2, nest=1)
    assert len(layout.sheets) == 1
    check(drawing, layout, (80, 80), 2)


def test_a_part_as_large_as_the_sheet_is_packed_by_its_box():
    drawing = drawing_of(plate("a", 594, 394), plate("b", 20, 20, 700))
    layout = laid_out(drawing, (600, 400), 3, nest=0.5)
    assert len(layout.sheets) == 2
    check(drawing, layout, (600, 400), 3)
