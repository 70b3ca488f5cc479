"""SVG as a language: what is filled and stroked becomes regions, and what cannot be read is told."""

from __future__ import annotations

import math

import pytest

from aidl_eval.svg import Svg, render

pytestmark = pytest.mark.skipif(Svg().missing() is not None, reason=str(Svg().missing()))


LINE = '<path d="{}" fill="none" stroke="red" stroke-width="2" {}/>'
"""A line two wide."""


def drawing(inner: str, root: str = "") -> str:
    return f'<svg xmlns="http://www.w3.org/2000/svg" {root}>{inner}</svg>'


@pytest.mark.parametrize(
    ("inner", "covered", "box"),
    [
        ('<rect x="1" y="2" width="30" height="20"/>', 600, (1, -22, 31, -2)),
        ('<circle cx="5" cy="5" r="5"/>', 25 * math.pi, (0, -10, 10, 0)),
        ('<g transform="translate(10 0) scale(2)"><rect width="3" height="4"/></g>', 48, (10, -8, 16, 0)),
        ('<path fill-rule="evenodd" d="M0 0H10V10H0Z M2 2H8V8H2Z"/>', 64, (0, -10, 10, 0)),
        ('<path d="M0 0H10V10H0Z M2 2H8V8H2Z"/>', 100, (0, -10, 10, 0)),
        (LINE.format("M0 0H10", ""), 20, (0, -1, 10, 1)),
        (LINE.format("M0 0H10", 'stroke-linecap="round"'), 20 + math.pi, (-1, -1, 11, 1)),
        (LINE.format("M0 0H10", 'style="stroke-linecap:square"'), 24, (-1, -1, 11, 1)),
        (LINE.format("M0 0H10V10", ""), 39 + math.pi / 4, (0, -10, 11, 1)),
        (LINE.format("M0 0H10V-10", ""), 39 + math.pi / 4, (0, -1, 11, 10)),
        (LINE.format("M0 0H10V10H0Z", ""), 140 - 64 + math.pi, (-1, -11, 11, 1)),
        ('<circle r="10" fill="none" stroke="red" stroke-width="2"/>', 40 * math.pi, (-11, -11, 11, 11)),
        ('<defs><rect id="a" width="2" height="2"/></defs><use href="#a" x="5"/>', 4, (5, -2, 7, 0)),
        ('<rect width="2" height="2"/><rect width="9" height="9" display="none"/>', 4, (0, -2, 2, 0)),
        ('<rect width="2" height="2"/><rect width="9" height="9" fill="none"/>', 4, (0, -2, 2, 0)),
    ],
)
def test_what_is_painted_is_an_area(inner: str, covered: float, box: tuple[float, ...]) -> None:
    drawn = render(drawing(inner))
    assert drawn.errors == ()
    assert drawn.regions.whole.area == pytest.approx(covered, rel=0.01)
    assert drawn.regions.whole.box == pytest.approx(box, abs=0.02)


def test_parts_have_their_order() -> None:
    drawn = render(drawing('<rect width="9" height="9" fill="navy"/><g fill="#f00"><circle r="3"/></g>'))
    seen = [region.area for region in drawn.regions.visible]
    assert seen == pytest.approx([81 - 9 * math.pi / 4, 9 * math.pi], rel=0.01)


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("<svg", "error: it is not well-formed XML: unclosed token: line 1, column 0"),
        ("<html/>", "error: the outermost element must be `svg`"),
        (drawing(""), "error: nothing is drawn"),
        (drawing('<rect width="0" height="4"/>'), "error: nothing is drawn"),
        (
            '<!DOCTYPE svg [<!ENTITY a "b">]><svg/>',
            "error: entities and document types are not read: write everything out",
        ),
        (
            drawing('<path d="M0 0 L1e999 0 L5 5 Z"/>'),
            "error: it cannot be read as SVG: a coordinate is not a finite number, or too large",
        ),
    ],
)
def test_what_cannot_be_read_is_told(text: str, error: str) -> None:
    assert render(text).errors == (error,)


USES = "".join(f'<g id="a{n + 1}">' + 5 * f'<use href="#a{n}"/>' + "</g>" for n in range(6))
LINK = 'xmlns:xlink="http://www.w3.org/1999/xlink"'


@pytest.mark.parametrize(
    ("text", "error"),
    [
        (
            drawing(f'<defs><rect id="a0" width="1" height="1"/>{USES}</defs>'),
            "there are more than 4000 elements",
        ),
        (drawing('<rect width="1" height="1"/>' * 5000), "there are more than 4000 elements"),
        (drawing("<a/>" * 1_000_000), "the program has more than 2000000 characters"),
        (drawing('<g id="a"><use href="#a"/></g>'), "a `use` repeats what it is in itself"),
        (drawing('<g id="a"><use xlink:href="#a"/></g>', LINK), "a `use` repeats what it is in itself"),
        (drawing("<g>" * 20_000 + "</g>" * 20_000), "elements are nested too deep"),
        (drawing('<path d="M0 0' + " l1 1 1-1" * 6000 + 'z"/>'), "outlines have more than 20000 numbers"),
        (drawing('<polygon points="' + "0,1.5e3 " * 10_001 + '"/>'), "outlines have more than 20000 numbers"),
        (
            drawing('<path d="M0 0 A 1e-300 1e300 0 1 1 5 5z"/>'),
            "it cannot be read as SVG: float division by zero",
        ),
        (
            drawing('<rect width="' + "9" * 5000 + '" height="1"/>'),
            "it cannot be read as SVG: a coordinate is not",
        ),
        (
            drawing('<rect width="1" height="1" transform="scale(1e308) scale(1e308)"/>'),
            "it cannot be read as SVG",
        ),
        ("<!DOCTYPE x SYSTEM 'file:///etc/passwd'><svg/>", "entities and document types are not read"),
        (drawing("&#x0;"), "it is not well-formed XML"),
    ],
)
def test_what_is_too_much_is_told(text: str, error: str) -> None:
    (said,) = render(text).errors
    assert said.startswith(f"error: {error}")


def test_links_lead_nowhere() -> None:
    linked = (
        '<use href="file:///etc/passwd#a"/><rect width="2" height="2" fill="url(http://example.com/#a)"/>'
    )
    style = '<style>@import url("http://example.com/a.css");</style><rect width="1" height="1"/>'
    drawn = render(drawing(linked + style))
    assert (drawn.errors, len(drawn.regions.parts)) == ((), 2)


def test_what_is_left_out_is_told() -> None:
    drawn = render(drawing('<rect width="1" height="1"/><text>hi</text><image href="/etc/passwd"/>'))
    assert drawn.warnings == tuple(
        f"warning: `{name}` is left out: only filled and stroked shapes are drawn"
        for name in ("text", "image")
    )


def test_a_conversation_goes_as_in_other_languages() -> None:
    conversation = Svg().conversation()
    wrong = conversation.judge("<html/>")
    assert (wrong.ok, wrong.stage) == (False, "render")
    assert wrong.feedback == (
        "error: the outermost element must be `svg`\n\n"
        "Mend this without leaving out any part of the drawing, and "
        "answer with the whole program in one block that opens with ```svg."
    )
    assert conversation.judge(drawing('<rect width="1" height="1"/>')).feedback == ""
    assert Svg().knobs(drawing("")) == {}
    assert Svg().structures(drawing("<g><g/></g>")) == 2
