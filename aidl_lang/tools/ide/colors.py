"""The colours in `@color(…)`, and other colours written in their place."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.checking.builtins import ATTRIBUTES
from aidl_lang.checking.resolving.symbols import word_meant
from aidl_lang.common.colors import COLOR_NAMES, css_color, rgb
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.view import View


@record()
class Color:
    """The place of a colour in the text, and its red, green and blue from 0 to 255."""

    span: Span
    rgb: tuple[int, int, int]


def colors(view: View) -> list[Color]:
    """Returns the literal colours of a text, in its order."""
    found = []
    for node in ast.walk(view.module):
        if isinstance(node, ast.Attribute) and word_meant(node.name.text, ATTRIBUTES) in ("color", "colour"):
            values = [_literal(argument.value) for argument in node.arguments]
            color = css_color(values) if values and None not in values else None
            if color is not None:
                span = node.arguments[0].value.span.to(node.arguments[-1].value.span)
                found.append(Color(span, rgb(color)))
    return found


def spellings(view: View, span: Span, color: tuple[int, int, int]) -> list[str]:
    """Returns the spellings of a colour at a place: its name if it has one, `#rrggbb`, and three numbers if
    the place has three now.
    """
    names = sorted(name for name in COLOR_NAMES if rgb(name) == color)
    written = [f'"{name}"' for name in names[:1]] + ['"#{:02x}{:02x}{:02x}"'.format(*color)]
    now = view.source.text[span.start : span.end]
    return [", ".join(map(str, color)), *written] if "," in now else written


def _literal(node: ast.Expression) -> object:
    """Returns the value of an argument, a bare word being a text; None for an expression that must be
    evaluated.
    """
    match node:
        case ast.String(value) | ast.Number(value, None, _) | ast.Name(value):
            return value
        case _:
            return None


def as_bytes(parts: Sequence[float]) -> tuple[int, int, int]:
    """Converts red, green and blue from 0 to 1 → from 0 to 255."""
    red, green, blue = (round(255 * min(max(part, 0.0), 1.0)) for part in parts)
    return red, green, blue
