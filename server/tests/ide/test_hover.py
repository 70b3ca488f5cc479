"""Hover: what is said of a word, and that the values are those of the solved model."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from aidl_lang.geometry.solved import SolvedGeometry
from aidl_lang.tools.reference.collect import reference
from aidl_server.ide.hover import hover
from aidl_server.ide.workspace import View, look, run
from server.tests.ide.conftest import cursor, seen, solved_at
from tests.compiled import LIGHTER

PLATE = """\
/// A plate with a bolt.
assembly whole {
    /// How wide.
    param width = 60mm in 40..90 step 5
    solid plate {
        body = rectangle(center: origin, width: width, height: 20)
        mark = circle(center: (4, 3), radius: 6)
        grown = circle(center: (9, 9), radius: guess(2))
        constrain { mark.radius == 8; grown.radius == 0.1 + 0.2 }
    }
    hole bolt(size = 4, at_x: length = 2) {
        rim = circle(center: (at_x, 0), radius: size / 2)
    }
    for i in 0..5 { pin[i] = bolt(size: 4 + i) at (10 * i, 0) }
    let third = width / 3
    solid bar { edge = rectangle(center: (0, 50), width: 30, height: 4) }
    constrain {
        bar.above(plate, gap: 2)
        bar.width <= plate.width
        for i in 0..5 { pin[i].center_y == 3 }
    }
    prefer bar.center_x == 1000
    assert third > 3, "wide enough"
}
"""


def solved(text: str = PLATE) -> View:
    return seen(text, solved=True)


def at(marked: str, text: str = PLATE, view: View | None = None) -> str:
    """What is said at the place where the marked words stand in the text."""
    words, offset = cursor(marked)
    assert text.count(words) == 1, words
    found = hover(view or solved(text), text.index(words) + offset)
    return "" if found is None else found.text


# --- Values ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("marked", "line"),
    [
        ("¦width = 60", "width = 60 mm, param"),
        ("width: wi¦dth", "width = 60 mm, param"),
        ("¦mark = ", "mark.radius = 8 mm, had to change from 6"),
        ("grown.¦radius", "grown.radius = 0.3 mm, solved"),
        ("bar.¦width", "bar.width = 30 mm, solved"),
        ("plate.¦width", "plate.width = 60 mm, solved"),
        ("let ¦third", "third = 20 mm, exact (param)"),
        ("¦body = ", "body.height = 20 mm, kept"),
        ("¦body = ", "body.center = (0, 0), exact (in plate)"),
        ("¦pin[i] = ", "pin: 6 members"),
        ("for ¦i in 0..5 { pin[i] =", "i = 0"),
        ("height: ¦20)", "`whole.plate.body.height`: kept, stays 20 mm"),
        ("guess(¦2)", "a first guess, solved to 0.3 mm"),
    ],
)
def test_the_solved_value(marked: str, line: str) -> None:
    assert line in at(marked)


def test_instances_and_turns_list_the_first_few() -> None:
    said = at("¦rim = ")
    assert [f"pin[{i}]: rim.radius = {2 + i / 2:g} mm" in said for i in range(5)] == [True] * 4 + [False]
    assert said.count("size") <= 1
    assert "i = 3: pin[i].center_y = 3 mm" in at("pin[i].¦center_y")


def test_what_can_move_is_free_and_what_cannot_is_not() -> None:
    text = """\
drawing d {
    a = line((0, 0), (30, 4))
    b = circle(center: (50, 9), radius: 3)
    constrain { b.center.y == 4 }
    let far = distance(a.start, a.end)
    assert a.dx > 0 and far > 0 and b.center.x > 0 and b.bottom > 0 and b.left > 0
}
"""
    assert "30 mm, solved" in at("a.¦dx >", text)
    assert "30.2655 mm, solved" in at("f¦ar >", text)
    assert "50 mm, free" in at("b.center.¦x", text)
    assert "1 mm, solved" in at("b.¦bottom", text)
    assert "47 mm, free" in at("b.¦left", text)


def test_constraints_tell_whether_they_hold() -> None:
    assert "This constraint holds." in at("bar.ab¦ove")
    assert "This constraint holds." in at("bar.width ¦<=")
    assert "This constraint holds in all 6 cases." in at("center_y ¦== 3")
    assert "This wish is fulfilled." in at("bar.center_x ¦== 1000")
    failing = (
        "drawing d {\n    a = circle(radius: 3)\n    constrain { a.center.x == 20; a.center.x <= 10 }\n}\n"
    )
    said = at("a.center.x ¦== ", failing) + at("a.center.x ¦<= ", failing)
    assert "does not hold: it is off by" in said
    assert "do not hold together" in said


def test_no_value_of_another_text() -> None:
    view = seen(PLATE)
    assert "mm, " not in at("¦mark = ", view=view)
    broken = PLATE.replace("radius: 6", "radius: nothing")
    wrong = run(look(Path("/project/part.aidl"), broken, view.world), solved())
    said = at("width: wi¦dth", broken, wrong)
    assert "60 mm, param" not in said
    assert "no value" in said
    waiting = look(Path("/project/part.aidl"), PLATE + " ", view.world)
    assert "60 mm, param" not in at("width: wi¦dth", PLATE, waiting)


@pytest.mark.parametrize("path", LIGHTER)
def test_values_are_those_of_the_model(path: Path) -> None:
    """Radii as they are told where circles are made, beside those of the drawing."""
    text = path.read_text("utf-8")
    view = solved_at(path)
    assert view.outcome is not None
    model = view.outcome.model
    assert model is not None
    radii: dict[str, set[str]] = {}
    for structure in model.root.walk():
        for geometry in structure.geometry:
            if isinstance(geometry, SolvedGeometry) and geometry.type == "circle":
                name = geometry.name.partition("[")[0]
                radius = geometry.values["radius"]
                assert isinstance(radius, float)
                radii.setdefault(name, set()).add(f"{round(radius, 4) + 0.0:g}")
    for match in re.finditer(r"(\w+) = circle\(", text):
        said = hover(view, match.start())
        assert said is not None
        told = re.findall(rf"{match[1]}\.radius = ([-\d.]+) mm", said.text)
        assert told, match[0]
        assert {f"{float(t):g}" for t in told} <= radii[match[1]]


# --- Documentation ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("marked", "said"),
    [
        ("assembly w¦hole", "A plate with a bolt."),
        ("¦width = 60", "May be set to 40..90, in steps of 5."),
        ("rect¦angle(center: origin", "rectangle(center: point = (0, 0), width: length, height: length"),
        ("bar.ab¦ove", "above(a: box, b: box, gap: length, align: text"),
        ("¦gap: 2", "`gap` is exact"),
        ("= bo¦lt(", "hole bolt(size = 4, at_x: length = 2)"),
        ("ori¦gin, width: width", "The point (0, 0) of a structure's frame"),
        ("60m¦m", "length: 60 mm"),
        ("ass¦ert", "A check after solving"),
        ("par¦am", "A knob"),
        ("sol¦id bar", "Material"),
    ],
)
def test_documentation(marked: str, said: str) -> None:
    assert said in at(marked)


def test_every_word_of_the_language_is_told_of() -> None:
    for entry in reference().entries.values():
        if entry.sort != "word" or not entry.doc.example or entry.name == "import":
            continue
        view = seen(entry.doc.example)
        spoken = entry.name
        places = [m.start() for m in re.finditer(rf"(?<!\w){re.escape(spoken)}\b", entry.doc.example)]
        said = [h.text for p in places if (h := hover(view, p + spoken.startswith("@"))) is not None]
        if places:
            assert any(entry.doc.line in text for text in said), spoken
