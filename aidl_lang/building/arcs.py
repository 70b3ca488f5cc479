"""Arcs given by three points without names: centre, start and end, with a warning if they hardly can be."""

from __future__ import annotations

import math
from collections.abc import Mapping

from aidl_lang.building.state import Interpreter
from aidl_lang.building.values import PointVal, Value
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

ROUND = 0.01
"""The part of the larger one by which the distances of start and end from the centre may differ without a
warning."""

_CODE = "W0503"

_BY_CENTER = ("center", "start", "end")
_BY_MIDDLE = ("start", "mid", "end")

_HINT = "name them: `center`, `start` and `end`, or `start`, `mid` and `end`"


def check_bare_points(it: Interpreter, node: ast.Call, arguments: Mapping[str, Value]) -> None:
    """Warns of an arc whose unnamed first point is taken as its centre, if that is not as far from both."""
    if any(a.name is not None and a.name.text == "center" for a in node.arguments):
        return
    a, b, c = (arguments.get(name) for name in _BY_CENTER)
    if not (isinstance(a, PointVal) and isinstance(b, PointVal) and isinstance(c, PointVal)):
        return
    start, end, across = _apart(a, b), _apart(a, c), _apart(b, c)
    if not differ(start, end) > ROUND:
        return
    if any(d.code == _CODE and d.span == it.place(node) for d in it.diagnostics):
        return  # reported in an earlier turn of a loop
    is_through = differ(start, across) <= differ(start, end)
    is_plain = _is_plain(node)
    meant, other = (_BY_MIDDLE, _BY_CENTER) if is_through else (_BY_CENTER, _BY_MIDDLE)
    it.report(
        _CODE,
        f"the points of `{node.callee.text}` are centre, start and end, and here the start is {start:g} "
        f"from the centre and the end {end:g}",
        node,
        hints=[f"or write `{_named(node, other)}` if that is meant" if is_plain else _HINT],
        fix=_fix(node, meant) if is_plain else None,
    )


def _apart(a: PointVal, b: PointVal) -> float:
    return math.hypot(b.x.value - a.x.value, b.y.value - a.y.value)


def differ(a: float, b: float) -> float:
    """Returns the part of the larger one by which two distances differ."""
    return abs(a - b) / max(a, b) if max(a, b) > 0 else 0.0


def _is_plain(node: ast.Call) -> bool:
    """Tells whether the three points are the first arguments of the call, all without a name."""
    points = node.arguments[:3]
    return node.receiver is None and len(points) == 3 and all(p.name is None for p in points)


def _named(node: ast.Call, names: tuple[str, ...]) -> str:
    inside = ", ".join(f"{n}: {a.span.one_line}" for n, a in zip(names, node.arguments, strict=False))
    return f"{node.callee.text}({inside})"


def _fix(node: ast.Call, names: tuple[str, ...]) -> Fix:
    places = [Span(a.span.source, a.span.start, a.span.start) for a in node.arguments[:3]]
    edits = tuple(Edit(at, f"{name}: ") for at, name in zip(places, names, strict=True))
    return Fix(f"name them `{names[0]}`, `{names[1]}` and `{names[2]}`", edits)
