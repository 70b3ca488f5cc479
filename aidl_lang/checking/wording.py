"""The words of the checker for types and for program text."""

from __future__ import annotations

from aidl_lang.checking.fields import BOX
from aidl_lang.checking.types import (
    AnyType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    StructureType,
    Type,
)
from aidl_lang.common.prose import with_article
from aidl_lang.syntax import ast

_LONGEST = 40


def a(kind: Type) -> str:
    """Returns a type with its article."""
    word = "thing" if isinstance(kind, AnyType) else str(kind)
    if isinstance(kind, NumberType) and kind.whole:
        word = "number" if kind.dimension is None else "whole number"
    return with_article(f"number in {word}" if word.startswith(("mm", "deg")) else word)


def shown(node: ast.Node) -> str:
    """Returns the text of an expression on one line, shortened if it is long."""
    text = node.span.one_line
    return text if len(text) <= _LONGEST else text[: _LONGEST - 1] + "…"


def in_box(kind: Type, text: str, other: Type) -> str | None:
    """Returns the text of a side or corner of a box that a part hides by its name, if that would compare with
    the other side: `table.bb.top` for `table.top`.
    """
    whole, _, name = text.rpartition(".")
    is_hiding = whole and isinstance(kind, GeometryType) and type(BOX.get(name)) is type(other)
    return f"{whole}.bb.{name}" if is_hiding else None


def comparison_hint(x: Type, y: Type, left: str, right: str) -> str:
    """Returns the hint for a comparison of things that have no order or equality."""
    if isinstance(x, ListType) or isinstance(y, ListType):
        return "compare their members one by one, in a `for`"
    for kind, text, other in ((x, left, y), (y, right, x)):
        if isinstance(kind, PointType) and isinstance(other, NumberType):
            return f"points compare with points; of one coordinate say `{text}.x` or `{text}.y`"
        if boxed := in_box(kind, text, other):
            return f"`{text}` is a part of that name; the side or corner of the box is `{boxed}`"
    kinds = GeometryType | StructureType
    if isinstance(x, kinds) and isinstance(y, kinds):
        return f"say what shall agree: `{left}.center == {right}.center`, `equal({left}, {right})`, …"
    return "numbers compare with numbers and points with points: name a field, as in `.width` or `.center`"
