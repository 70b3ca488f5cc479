"""Colours while building: whether values are one, and the functions that AIDL's own are made of."""

from __future__ import annotations

import re
from collections.abc import Sequence

from aidl_lang.building.coerce import constant
from aidl_lang.building.state import Arguments, Env, Interpreter
from aidl_lang.building.values import NOTHING, ListVal, Num, TextVal, Value, kind_of, number
from aidl_lang.checking.units import PLAIN
from aidl_lang.common.colors import css_color, rgb, similar_colors
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.prose import did_you_mean
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast


def color_of(it: Interpreter, values: Sequence[Value], node: ast.Node) -> str | None:
    """Returns the colour that values stand for, as SVG understands it; None after an error."""
    plain: list[str | float] = []
    for value in values:
        if isinstance(value, Num):
            known = constant(it, value, node, "a colour")
            if known is None:
                return None
            plain.append(known)
        else:
            plain.append(_text(value))
    color = css_color(plain)
    if color is None:
        _unknown(it, plain, node)
    return color


def _text(value: Value) -> str:
    match value:
        case TextVal(text):
            return text
        case bool():
            return str(value).lower()
        case _:
            return kind_of(value)


def _unknown(it: Interpreter, values: Sequence[str | float], node: ast.Node) -> None:
    written = ", ".join(v if isinstance(v, str) else f"{v:g}" for v in values) or "nothing"
    similar = similar_colors(written) if len(values) == 1 else []
    hints = [*did_you_mean(similar), "a colour is a CSS name, `#rrggbb`, or three numbers from 0 to 255"]
    if written.startswith(("rgba(", "hsla(")) or re.fullmatch(r"#(?:[0-9a-fA-F]{4}){1,2}", written):
        hints.append("what shows through a thing is told beside its colour: `@opacity(0.5)`")
    fix = _respelt(it.place(node), written, similar[0]) if similar else None
    it.report("E0525", f"`{written}` is no colour", node, hints=hints, fix=fix)


def _respelt(span: Span | None, written: str, meant: str) -> Fix | None:
    """Returns the fix that writes another name for the one word of a place; None if it is not there once."""
    found = list(re.finditer(rf"(?<![\w-]){re.escape(written)}(?![\w-])", span.text)) if span else []
    if span is None or len(found) != 1:
        return None
    place = Span(span.source, span.start + found[0].start(), span.start + found[0].end())
    return Fix(f"write `{meant}`", (Edit(place, meant),))


def _rgb(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    color = color_of(it, list(a.values()), node)
    return TextVal(color) if color is not None else NOTHING


def _channels(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns red, green and blue of a colour, from 0 to 255."""
    color = color_of(it, [a["color"]], node)
    return ListVal(tuple(number(float(part), PLAIN) for part in rgb(color))) if color is not None else NOTHING


FUNCTIONS = {"rgb": _rgb, "channels": _channels}
