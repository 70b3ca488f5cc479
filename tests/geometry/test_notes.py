"""Warnings about curves, holes and parts."""

from __future__ import annotations

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic, apply_fixes
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.geometry.curves import Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedStructure
from tests.geometry.models import arc, circle, compound, model, primitive, rectangle, structure


def notes(root: SolvedStructure) -> list[Diagnostic]:
    return draw(model(root))[1].everything()


def only(root: SolvedStructure) -> Diagnostic:
    (note,) = notes(root)
    return note


def span_of(source: SourceFile, text: str) -> Span:
    start = source.text.index(text)
    return Span(source, start, start + len(text))


def test_a_loop_inside_another_adds_nothing():
    note = only(structure("solid", "s", rectangle("plate", 0, 0, 10, 10), circle("bore", 5, 5, 2)))
    assert note.code == "W0701"
    assert note.message == "`bore` lies inside `plate` and adds nothing to `s`"
    assert "hole bore_hole { bore = … }" in note.hints[0]


def test_the_fix_makes_the_inner_loop_a_hole():
    source = SourceFile(
        "x.aidl", "solid s {\n    plate = square(10)\n    bore = circle(center: (5, 5), radius: 2)\n}\n"
    )
    bore = circle("bore", 5, 5, 2)
    bore = primitive("bore", bore.curve, span=span_of(source, "bore = circle(center: (5, 5), radius: 2)"))
    note = only(structure("solid", "s", rectangle("plate", 0, 0, 10, 10), bore))
    text, count = apply_fixes(source, [note])
    assert count == 1
    assert "    hole bore_hole { bore = circle(center: (5, 5), radius: 2) }\n" in text


def test_no_fix_where_something_else_speaks_of_the_loop():
    text = "solid s {\n bore = circle(center: (5, 5), radius: 2)\n constrain bore.radius == 2\n}\n"
    source = SourceFile("x.aidl", text)
    bore = primitive(
        "bore", circle("", 5, 5, 2).curve, span=span_of(source, "bore = circle(center: (5, 5), radius: 2)")
    )
    assert only(structure("solid", "s", rectangle("plate", 0, 0, 10, 10), bore)).fix is None


def test_of_two_equal_loops_the_later_one_is_reported():
    note = only(structure("solid", "s", circle("a", 0, 0, 1), circle("b", 0, 0, 1)))
    assert note.message.startswith("`b` lies inside `a`")


def test_an_open_outline_names_its_ends_and_the_gap():
    lines = [Line((0, 0), (10, 0)), Line((10, 0), (10, 8)), Line((10, 8), (0, 0.5))]
    root = structure("solid", "s", *(primitive(f"l{i}", line) for i, line in enumerate(lines)))
    note = only(root)
    assert note.code == "W0702"
    assert "the end at (0, 0) is 0.5 mm away from (0, 0.5)" in note.message
    assert "`constrain l0.start == l2.end`" in note.hints[0]
    assert [s.role for s in draw(model(root))[0].strokes] == ["open"] * 3


def test_what_another_structure_draws_there_does_not_count():
    lines = [primitive("a", Line((0, 0), (10, 0))), primitive("b", Line((10, 0), (0, 0.5)))]
    other = structure("solid", "other", rectangle("r", -5, -5, 0, 0))
    found = notes(structure("assembly", "all", structure("solid", "s", *lines), other))
    assert "the end at (0, 0) is 0.5 mm away from (0, 0.5)" in next(
        n.message for n in found if n.code == "W0702"
    )


def test_the_fix_joins_the_ends():
    source = SourceFile("x.aidl", "solid s {\n    a = line((0, 0), (4, 0))\n    b = arc(…)\n}\n")
    root = structure(
        "solid",
        "s",
        primitive("a", Line((0, 0), (4, 0))),
        primitive("b", arc((2, 0), 2, 0, 170)),
        span=Span(source, 0, len(source.text) - 1),
    )
    text, _ = apply_fixes(source, notes(root))
    assert text.endswith("    b = arc(…)\n    constrain a.start == b.end\n}\n")


def test_a_line_alone_has_no_fix():
    note = only(structure("solid", "s", circle("c", 0, 0, 9), primitive("l", Line((-1, 0), (1, 0)))))
    assert note.code == "W0702"
    assert note.fix is None


def test_open_curves_in_an_assembly_are_no_mistake():
    assert notes(structure("assembly", "s", primitive("l", Line((-1, 0), (1, 0))))) == []


def test_a_hole_that_removes_nothing():
    root = structure("solid", "s", circle("c", 0, 0, 2), structure("hole", "h", circle("c", 9, 0, 2)))
    note = only(root)
    assert (note.code, note.message) == ("W0703", "hole `s.h` removes nothing from solid `s`")
    assert "the hole spans (7, -2) to (11, 2), `s` spans" in note.hints[0]


def test_a_hole_at_the_root_cuts_nothing_and_is_outlined():
    drawing, found = draw(model(structure("hole", "h", circle("c", 0, 0, 2))))
    assert [n.code for n in found.everything()] == ["W0703"]
    assert [s.role for s in drawing.strokes] == ["hole"]


def test_a_hole_that_an_island_fills_again():
    pin = structure("solid", "pin", circle("c", 0, 0, 1))
    root = structure("solid", "s", circle("c", 0, 0, 5), structure("hole", "h", circle("c", 0, 0, 1), pin))
    assert only(root).message == "hole `s.h` is filled again by `s.h.pin` in solid `s`"


def test_a_hole_that_a_sibling_of_its_holder_fills_again():
    plate = structure("solid", "plate", circle("c", 0, 0, 5), structure("hole", "h", circle("c", 0, 0, 1)))
    cover = structure("solid", "cover", rectangle("r", -2, -2, 2, 2))
    note = only(structure("solid", "s", plate, cover))
    assert (note.code, "by `s.cover`" in note.message) == ("W0704", True)
    assert "move the hole up" in note.hints[0]
    assert notes(structure("assembly", "a", plate, cover)) == []


def test_a_detached_part():
    parts = [structure("solid", n, rectangle("r", x, 0, x + 2, 2)) for n, x in (("a", 0), ("b", 2), ("c", 9))]
    note = only(structure("assembly", "all", *parts))
    assert (note.code, note.message) == (
        "W0705",
        "`all.c` touches no other part; the nearest, `all.b`, is 5 mm away",
    )


def test_detached_parts_of_one_statement_are_one_note():
    source = SourceFile("x.aidl", "solid dot[i] { … }")
    span = Span(source, 0, len(source.text))
    dots = [structure("solid", f"d{i}", circle("c", 9 * i, 0, 1), span=span) for i in range(6)]
    note = only(structure("assembly", "all", *dots))
    assert (note.code, note.message) == (
        "W0705",
        "`all.d0`, `all.d1`, `all.d2` and 3 more touch no other part; "
        "the nearest to `all.d0`, `all.d1`, is 7 mm away",
    )


def test_detached_on_purpose():
    a = structure("solid", "a", circle("c", 0, 0, 1))
    b = structure("solid", "b", circle("c", 9, 0, 1), detached=())
    assert notes(structure("assembly", "all", a, b)) == []  # there is nothing that a should touch
    assert notes(structure("assembly", "all", a, b, detached=())) == []


def test_the_fix_marks_the_part():
    source = SourceFile("x.aidl", "assembly m {\n solid a { c = circle(radius: 1) }\n}")
    a = structure(
        "solid", "a", circle("c", 0, 0, 1), span=span_of(source, "solid a { c = circle(radius: 1) }")
    )
    b, c = (structure("solid", name, circle("c", 9, y, 1)) for name, y in (("b", 0), ("c", 1)))
    text, _ = apply_fixes(source, notes(structure("assembly", "m", a, b, c)))
    assert "@detached solid a {" in text


PIN = "solid pin(r: length) { c = circle(radius: r) }\n"


@pytest.mark.parametrize(
    "lonely",
    [
        "solid b { c = circle(center: (50, 0), radius: 1) }",
        '@color("red") solid b { c = circle(center: (50, 0), radius: 1) }',
        "@detached(false) solid b { c = circle(center: (50, 0), radius: 1) }",
        "for i in 1..3 { solid b[i] { c = circle(center: (50 * i, 0), radius: 1) } }",
        "b = pin(r: 2) at (50, 0)",
        "assembly b { solid c { d = circle(center: (50, 0), radius: 1) } }",
    ],
)
def test_the_fix_of_a_detached_part_needs_no_trial(lonely):
    text = (
        PIN
        + "solid a { c = circle(radius: 1) }\nsolid e { c = circle(center: (2, 0), radius: 1) }\n"
        + lonely
    )
    source = SourceFile("x.aidl", text)
    found = pipeline.compile(source).diagnostics
    assert {d.code for d in found} == {"W0705"}
    mended, _ = apply_fixes(source, [d for d in found if d.code == "W0705"])
    after = pipeline.compile(SourceFile("x.aidl", mended)).diagnostics
    assert [d.code for d in after] == ["W0705" for d in found if d.fix is None]


@pytest.mark.parametrize(
    "shape", [circle("c", 0, 0, 0.0), circle("c", float("nan"), 0, 1), primitive("c", Line((1, 1), (1, 1)))]
)
def test_what_has_no_extent_is_not_drawn(shape):
    drawing, found = draw(model(structure("solid", "s", shape)))
    assert [n.code for n in found.everything()] == ["W0706"]
    assert not drawing.bodies


def test_nothing_at_all():
    drawing, found = draw(model(structure("assembly", "a")))
    assert (drawing.bodies, drawing.box, found.everything()) == ((), (0, 0, 0, 0), [])


def test_free_loops_inside_a_shape_are_reported_together():
    square = [Line((2, 2), (3, 2)), Line((3, 2), (3, 3)), Line((3, 3), (2, 2))]
    root = structure(
        "solid",
        "s",
        rectangle("r", 0, 0, 9, 9),
        *(primitive(n, s) for n, s in zip("abc", square, strict=True)),
    )
    assert only(root).message == "`a`, `b` and `c` lie inside `r` and add nothing to `s`"


def test_an_open_compound_shape_is_one_warning():
    polyline = compound("p", Line((0, 0), (5, 0)), Line((5, 0), (5, 5)), type_="polyline")
    note = only(structure("solid", "s", polyline))
    assert note.code == "W0702"
    assert note.message.startswith("`p` encloses nothing")
