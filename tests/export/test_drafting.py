"""Drawing sheets: true to scale, everything in the frame, nothing over another, enough to make it from."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import combinations
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld
from aidl_lang.export.dimension_marks import DIGIT, Block
from aidl_lang.export.drafting import Draft, drafted
from aidl_lang.export.drafting.tables import SCALES, STANDARDS, papers
from aidl_lang.export.job import Job
from aidl_lang.export.marks import Area, Curves, Group, Mark, Picture, Text
from aidl_lang.geometry.curves import Bounds, Circle, union_bounds
from tests.compiled import lighter
from tests.documents import ROOT

CAPITAL = 0.73
WORKSHOP = sorted((ROOT / "examples" / "workshop").glob("*.aidl"))
ASSEMBLY = """
@title("Shelf")
@material("oak")
assembly shelf {
    for i in 0..1 {
        @thickness(18mm) solid side[i] at fixed((300 * i, 0)) { body = rectangle(width: 18, height: 200) }
    }
    @thickness(12mm) solid board {
        body = rectangle(center: fixed((150, 0)), width: 282, height: 40)
        hole eye { rim = circle(center: fixed((150, 5)), radius: 4) }
    }
    @orientation(front) @thickness(6mm) @material("plywood") solid back {
        body = rectangle(center: fixed((150, -160)), width: 282, height: 80)
    }
}
"""

PANEL = """
solid panel {
    body = rectangle(width: 120, height: 80)
    let low = [(-50, -30), (3, -17), (29, -5), (52, -28), (44, -9)]
    let spots = [low[0], (-31, 12), (-12, 25), low[1], (17, 30), low[2], (41, 21), low[3], low[4]]
    for i, p in enumerate(spots) { hole h[i] { rim = circle(center: fixed(p), diameter: 4 + (i % 2)) } }
}
"""


@cache
def compiled(text: str) -> pipeline.Compiled:
    """What comes of a program that may import what lies beside those of the workshop."""
    return pipeline.compile(SourceFile("<text>", text), DiskWorld(ROOT / "examples" / "workshop"))


@cache
def pages(text: str, **draft: object) -> list[Picture]:
    found = compiled(text)
    assert found.ok
    assert found.model is not None
    assert found.drawing is not None
    return drafted(Job(found.model, found.drawing), Draft(**draft))  # type: ignore[arg-type]


def texts(page: Picture) -> list[Text]:
    return [m for g in page.groups for m in g.marks if isinstance(m, Text)]


def words(page: Picture) -> list[str]:
    return [t.text for t in texts(page)]


def dimension_groups(page: Picture) -> list[Group]:
    return [g for g in page.groups if g.attributes.get("class") == "dimension"]


def values(page: Picture) -> set[str]:
    return {m.text for g in dimension_groups(page) for m in g.marks if isinstance(m, Text)}


def block(text: Text) -> Block:
    half = DIGIT * text.size * len(text.text) / 2
    return Block(text.at, text.angle, (-half, 0.0, half, CAPITAL * text.size))


DEAR = {"pi_case", "name_sign"}
"""Slower than all others together."""


@pytest.mark.parametrize(
    "of", [*lighter([*WORKSHOP, ROOT / "examples/motor_bracket.aidl"], DEAR), ASSEMBLY, PANEL]
)
def test_a_sheet_can_be_read(of: Path | str):
    """Letters are as high on paper whatever the scale, all is within the frame, no value lies on another."""
    text = of if isinstance(of, str) else of.read_text("utf-8")
    for draft in ({}, {"scale": (1, 5), "paper": "a3"}) if text in (ASSEMBLY, PANEL) else ({},):
        for page in pages(text, **draft):
            heights = {round(t.size * CAPITAL, 3) for t in texts(page)}
            assert heights
            assert all(2.5 <= height <= 3.5 for height in heights)
    for page in pages(text):
        (frame,) = next(g for g in page.groups if g.name == "frame").marks
        left, bottom, right, top = union_bounds(boxes_of(frame))
        for group in page.groups:
            for x0, y0, x1, y1 in (box for mark in group.marks for box in boxes_of(mark)):
                assert left - 1e-6 <= x0 <= x1 <= right + 1e-6, group.name
                assert bottom - 1e-6 <= y0 <= y1 <= top + 1e-6, group.name
        found = [m for g in dimension_groups(page) for m in g.marks if isinstance(m, Text)]
        assert found
        assert not [(a.text, b.text) for a, b in combinations(found, 2) if block(a).overlaps(block(b))]


def boxes_of(mark: Mark) -> list[Bounds]:
    if isinstance(mark, Text):
        return [block(mark).box if mark.angle else mark.box]
    if isinstance(mark, Area):
        return [p.box for loop in mark.face.loops for p in loop.pieces]
    assert isinstance(mark, Curves)
    return [p.box for p in mark.pieces]


def test_outlines_are_true_to_scale():
    text = "solid plate { body = rectangle(width: 100, height: 50) hole e { c = circle(radius: 10) } }"
    for scale in ((1, 1), (1, 2), (2, 1)):
        (page,) = pages(text, scale=scale, paper="a2")
        (outline,) = next(g for g in page.groups if g.name.endswith("outline")).marks
        assert isinstance(outline, Area)
        (hole,) = outline.face.holes
        assert isinstance(hole.pieces[0], Circle)
        assert hole.pieces[0].radius == pytest.approx(10 * scale[0] / scale[1])
        assert f"{scale[0]}:{scale[1]}" in words(page)
        assert {"100", "50", "⌀20"} <= values(page)


def test_the_scale_is_the_largest_that_fits():
    found = {}
    for width in (8, 30, 150, 600, 3000):
        (page,) = pages(f"solid s {{ r = rectangle(width: {width}, height: {width / 2}) }}", paper="a4")
        found[width] = next(w for w in words(page) if ":" in w)
    assert found == {8: "10:1", 30: "5:1", 150: "1:1", 600: "1:5", 3000: "1:20"}


def test_scales_are_those_of_the_standard():
    ratios = [f"{a}:{b}" for a, b in SCALES]
    assert ratios[:7] == ["50:1", "20:1", "10:1", "5:1", "2:1", "1:1", "1:2"]
    assert ratios[-1] == "1:10000"


def test_paper_by_fit_and_by_word():
    small, long = (
        "solid s { r = rectangle(width: 60, height: 90) }",
        "solid s { r = rectangle(width: 200, height: 80) }",
    )
    assert pages(small)[0].box == (0, 0, 210, 297)
    assert pages(long)[0].box[2] > pages(long)[0].box[3]
    assert pages(small, paper="a3", is_landscape=False)[0].box == (0, 0, 297, 420)
    assert pages(small, standard="ansi")[0].box == (0, 0, 215.9, 279.4)
    assert [p.label for p in papers(STANDARDS["iso"], None, True)] == ["A4", "A3", "A2", "A1", "A0"]


def test_the_title_block_tells_what_the_program_tells():
    text = '@title("Cover") @number("C-1") @revision("B") @author("Ann") @material("PMMA") @thickness(3mm)\n'
    (page,) = pages(text + "solid s { r = rectangle(width: 60, height: 90) }", date="2020-02-02")
    assert {"Cover", "C-1", "B", "Ann", "PMMA", "3 mm", "2020-02-02", "A4", "2:1", "1 of 1"} <= set(
        words(page)
    )
    (page,) = pages("/// A plate: it holds.\nsolid s { r = rectangle(width: 60, height: 90) }")
    assert "A plate" in words(page)
    (page,) = pages("solid cover_plate { r = rectangle(width: 60, height: 90) }")
    assert "Cover plate" in words(page)


def test_an_assembly_has_a_list_of_parts_views_and_a_sheet_for_each_part():
    found = pages(ASSEMBLY)
    assert [w for page in found for w in words(page) if " of " in w] == [f"{n} of 4" for n in (1, 2, 3, 4)]
    whole = words(found[0])
    assert {"Seen from the top", "Seen from the front", "Shelf"} <= set(whole)
    assert {"side", "board", "back", "2", "oak", "plywood", "18 × 200 × 18", "282 × 80 × 6"} <= set(whole)
    assert "Shelf: Side (2×)" in words(found[1])
    assert values(found[1]) == {"18", "200"}
    assert values(found[2]) == {"282", "40", "⌀8", "25"}
    assert values(found[3]) == {"282", "80"}


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("fence_bracket", "120, 150, 40, 40, 20, 14, 45, 2× 24, 9, R8, 10, 20, 60, 40, 4× ⌀5.5"),
        ("flange", "⌀140, ⌀44, ⌀100, 6× ⌀14"),
    ],
)
def test_it_can_be_made_from_its_sheet(name: str, wanted: str):
    (page,) = pages((ROOT / "examples" / "workshop" / f"{name}.aidl").read_text("utf-8"))
    said = [m.text for g in dimension_groups(page) for m in g.marks if isinstance(m, Text)]
    assert sorted(said) == sorted(wanted.split(", "))


@pytest.mark.parametrize(
    ("body", "wanted"),
    [
        # Nothing but a literal tells where the hole is.
        ("b = rectangle(width: 80, height: 50) hole e { c = circle(center: (-10, 5), radius: 4) }", {"30"}),
        # Symmetric: from hole to hole, not from the edge.
        (
            "b = rectangle(width: 80, height: 50)\n"
            "for s in [-1, 1] { hole e[s] { c = circle(center: fixed((25 * s, 0)), radius: 4) } }",
            {"50", "2× ⌀8"},
        ),
        # A step: neither of its edges is a size of the shape.
        ("b = polygon([(0, 0), (60, 0), (60, 20), (35, 20), (35, 45), (0, 45)])", {"60", "45", "35", "20"}),
        # Holes at unequal steps on a circle are placed one by one.
        (
            "b = circle(radius: 50)\nfor i, a in enumerate([0, 50, 200]) {"
            " hole e[i] { c = circle(center: fixed(polar(30, a * 1deg)), radius: 4) } }",
            {"3× ⌀8", "⌀100"},
        ),
        # A slanted edge: both its ends.
        ("b = polygon([(0, 0), (60, 0), (40, 30), (0, 30)])", {"60", "30", "40"}),
    ],
)
def test_what_the_program_does_not_state_is_added(body: str, wanted: set[str]):
    (page,) = pages(f"solid s {{ {body} }}")
    assert wanted <= values(page)


def test_the_values_are_those_of_the_solved_model():
    (page,) = pages((ROOT / "examples" / "motor_bracket.aidl").read_text("utf-8"))
    for group in dimension_groups(page):
        said = next(m.text for m in group.marks if isinstance(m, Text)).split("× ")[-1].strip("⌀R°")
        assert float(said) == pytest.approx(float(group.attributes["data-value"]), abs=0.0051)


BY_HAND = """
solid plate {
    body = rectangle(width: 80, height: 50)
    hole eye { rim = circle(center: (-15, 5), diameter: 20) }
    hole pin { rim = circle(center: (20, 5), diameter: 6) }
    dimension(body.left, eye.rim.center, offset: 40, tolerance: 0.1)
    dimension(eye.rim, fit: "H7")
    dimension(eye.rim.center, pin.rim.center, offset: -38, tolerance: 0.05)
    dimension(body.bottom, body.top, offset: 12, fit: "h9")
}
"""


def test_dimensions_by_hand_take_the_place_of_others():
    (page,) = pages(BY_HAND)
    assert values(page) == {
        *("25 ±0.1", "⌀20 H7 (+0.021/0)", "35 ±0.05", "50 h9 (0/-0.062)", "80", "30", "⌀6"),
    }


def test_dimensions_by_hand_stand_where_they_are_asked_for():
    (page,) = pages(BY_HAND, scale=(1, 1))
    (outline,) = next(g for g in page.groups if g.name.endswith("outline")).marks
    _, _, right, top = union_bounds(boxes_of(outline))

    def line_of(words: str) -> tuple[float, float, float, float]:
        group = next(
            g for g in dimension_groups(page) if any(words == getattr(m, "text", "") for m in g.marks)
        )
        mark = next(m for m in group.marks if isinstance(m, Curves) and m.role == "dimension")
        return mark.pieces[0].box

    assert line_of("50 h9 (0/-0.062)")[0] == pytest.approx(right + 12)
    # From the upper end of the edge.
    assert line_of("25 ±0.1")[1] == pytest.approx(top + 40)
    assert line_of("35 ±0.05")[1] == pytest.approx(top - 20 - 38)


def test_many_holes_are_told_in_a_table():
    (page,) = pages(PANEL)
    assert values(page) == {"120", "80"}
    table = next(g for g in page.groups if g.name == "holes")
    cells = [m.text for m in table.marks if isinstance(m, Text)]
    assert cells[:12] == ["Hole", "X", "Y", "⌀"] * 3
    rows = sorted(tuple(cells[k : k + 4]) for k in range(12, len(cells), 4))
    assert rows == [
        *(("A1", "10", "10", "⌀4"), ("A2", "48", "65", "⌀4"), ("A3", "77", "70", "⌀4")),
        *(("A4", "101", "61", "⌀4"), ("A5", "104", "31", "⌀4")),
        *(("B1", "29", "52", "⌀5"), ("B2", "63", "23", "⌀5"), ("B3", "89", "35", "⌀5")),
        ("B4", "112", "12", "⌀5"),
    ]
    signs = next(g for g in page.groups if g.attributes.get("class") == "holes")
    assert {row[0] for row in rows} | {"X", "Y"} == {m.text for m in signs.marks if isinstance(m, Text)}


def test_parts_bear_the_numbers_of_the_list():
    (first, *_) = pages(ASSEMBLY)
    items = [g for g in first.groups if g.attributes.get("class") == "item"]
    assert [m.text for g in items for m in g.marks if isinstance(m, Text)] == ["1", "2", "3"]


def test_a_free_outline_is_told_as_such():
    (page,) = pages("solid s { e = ellipse(rx: 30, ry: 20) }")
    assert "Outline not dimensioned: as in the file" in words(page)


SAID = """
@tolerance("ISO 2768-mK") @finish("Ra 3.2") @note("Break all edges") @thickness(8mm)
solid plate {
    body = rectangle(width: 100, height: 60)
    t1 = tap_hole("m6") at (-35, 15)
    t2 = tap_hole("m6") at (35, 15)
    @note("reamed") hole odd { rim = circle(center: fixed((20, -11)), diameter: 5) }
    @thread("M8x1") hole fine { rim = circle(center: fixed((0, -11)), diameter: 7) }
    @note("file by hand") hole win { w = slot(center: fixed((-5, 8)), length: 30, width: 8) }
    @note("this is more than has a place beside a hole") hole lo {
        rim = circle(center: fixed((-30, -11)), diameter: 9)
    }
    dimension(lo.rim, fit: "H7")
}
"""


def test_what_is_said_of_holes_and_parts_stands_on_the_sheet():
    (page,) = pages(SAID)
    assert {"2× M6", "⌀5 reamed", "M8x1", "⌀9 H7 (+0.015/0) note 1"} <= values(page)
    assert not [said for said in values(page) if said.startswith(("⌀7", "3×"))]
    assert {"General tolerances: ISO 2768-mK", "Surface: Ra 3.2", "Break all edges", "file by hand"} <= set(
        words(page)
    )
    assert "Note 1: this is more than has a place beside a hole" in words(page)


@pytest.mark.parametrize(("depth", "wanted"), [((2.0,), "⌀8, 2 deep"), ((2.0, 90.0), "⌀8 × 90° countersunk")])
def test_how_a_hole_is_sunk_stands_behind_its_diameter(depth: tuple[float, ...], wanted: str):
    found = compiled("solid s { b = rectangle(width: 40, height: 30) hole e { c = circle(radius: 4) } }")
    assert found.model is not None
    assert found.drawing is not None
    root = found.model.root
    holes = tuple(replace(h, attributes=h.attributes | {"depth": depth}) for h in root.structures)
    model = replace(found.model, root=replace(root, structures=holes))
    (page,) = drafted(Job(model, found.drawing), Draft())
    assert wanted in values(page)
