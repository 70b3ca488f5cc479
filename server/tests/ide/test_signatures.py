"""Signature help: the call around a place, its overloads, and the parameter that is being given."""

from __future__ import annotations

import pytest

from aidl_server.ide.signatures import SignatureHelp, signature_help
from server.tests.ide.conftest import cursor, seen

TEXT = """\
/// Twice, and a little more, `more` being how much.
fn twice(x: length, more = 1) = 2 * x + more
solid a {
    c = circle(radius: 3)
    b = rectangle(width: 3, height: 4)
    %s
    d = circle(radius: 4)
}
"""


def helped(marked: str) -> SignatureHelp | None:
    text, offset = cursor(TEXT.replace("%s", marked))
    return signature_help(seen(text), offset)


def active(marked: str) -> tuple[str, str | None]:
    found = helped(marked)
    assert found is not None
    overload = found.overloads[found.active]
    parameter = overload.parameters[overload.active] if overload.active is not None else None
    return overload.label, overload.label[slice(*parameter.place)] if parameter else None


@pytest.mark.parametrize(
    ("marked", "name", "parameter"),
    [
        ("x = circle(¦", "circle", "center: point = (0, 0)"),
        ("x = circle(¦)", "circle", "center: point = (0, 0)"),
        ("x = circle(5¦)", "circle", "radius: length"),
        ("x = circle(center: (0, ¦", "circle", "center: point = (0, 0)"),
        ("x = circle(center: (0, 0), diameter: ¦", "circle", "diameter: length"),
        ("x = rectangle(width: 3, height: ¦4)", "rectangle", "height: length"),
        ("constrain c.above(¦", "above", "b: box"),
        ("constrain { c.above(b, gap: ¦) }", "above", "gap: length"),
        ("constrain { c.above(b, at_least: 3¦) }", "above", "at_least: length = 0"),
        ("constrain row(c, b, ¦", "row", "things: peers"),
        ("constrain row(c, b, pitch: ¦", "row", "pitch: length"),
        ("let t = twice(3, ¦)", "twice", "more = 1"),
        ("let t = twice(more: ¦)", "twice", "more = 1"),
        ("let t = sin(twice(¦", "twice", "x: length"),
        ("let t = sin(twice(3) + ¦", "sin", "angle: angle"),
        ("x = arc((0, 0), (1, 1), radius: ¦", "arc", "radius: length"),
        ('x = text("¦", height: 3)', "text", "text"),
    ],
)
def test_the_active_parameter(marked: str, name: str, parameter: str) -> None:
    label, shown = active(marked)
    assert label.startswith(f"{name}(")
    assert shown == parameter


@pytest.mark.parametrize(
    "marked", ["¦", "x = circle¦(3)", "x = circle(3)¦", "x = (3, ¦)", "// circle(¦", "x = nothing(¦"]
)
def test_no_call_around(marked: str) -> None:
    assert helped(marked) is None


def test_all_overloads_are_shown_and_the_helpers_of_the_library_are_not() -> None:
    found = helped("x = circle(¦")
    assert found is not None
    assert [o.label for o in found.overloads] == [
        "circle(center: point = (0, 0), radius: length)",
        "circle(center: point = (0, 0), diameter: length)",
        "circle(a: point, b: point, c: point)",
    ]
    rectangles = helped("x = rectangle(¦")
    assert rectangles is not None
    assert not any("anchor" in o.label for o in rectangles.overloads)


def test_what_the_comments_say() -> None:
    found = helped("let t = twice(3, ¦)")
    assert found is not None
    (overload,) = found.overloads
    assert overload.about.startswith("Twice, and a little more")
    assert "how much" in overload.parameters[1].about
    above = helped("constrain c.above(b, ¦")
    assert above is not None
    assert above.overloads[0].parameters[2].about == "`gap` is exact"
