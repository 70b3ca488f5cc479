"""The built-in functions: arithmetic that AIDL cannot express, marks of exactness, measurements, colours."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from functools import partial

from aidl_lang.building import coerce, copies, patterns
from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import spelled_out
from aidl_lang.building.coerce import as_point, as_text, as_written, constant, look, numeric
from aidl_lang.building.construct import part as traced_part
from aidl_lang.building.construct import typeset
from aidl_lang.building.curves import xy
from aidl_lang.building.expression import DEGREE, Expression
from aidl_lang.building.measured import FORMULAS, OTHERWISE, centroid, formula
from aidl_lang.building.model import Assertion, Condition, Geometry, Measurement, Structure
from aidl_lang.building.outlines import OPERATIONS
from aidl_lang.building.patterns import lettered
from aidl_lang.building.state import Arguments, Env, Function, Interpreter, Reach, Scope
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    ListVal,
    Num,
    PointVal,
    RangeVal,
    RecordVal,
    TextVal,
    Value,
    certain,
    kind_of,
    members,
    number,
    point,
    with_numbers,
)
from aidl_lang.building.wording import compare_numbers
from aidl_lang.checking import rules, units
from aidl_lang.checking.units import ANGLE, AREA, LENGTH, PLAIN, Dimension, MaybeDimension
from aidl_lang.common.colors import css_color, rgb, similar_colors
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.lettering import box_around
from aidl_lang.common.names import find, nearest
from aidl_lang.common.prose import did_you_mean
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

# --- Questions about shapes that the library cannot answer in AIDL: sizes, corners, a way to refuse.

_NONE = ListVal(())


def _sizes(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the lengths among a compound shape's parameters, in their order; none for anything else."""
    shape = a["of"]
    if not isinstance(shape, Geometry) or not isinstance(shape.scope, Scope):
        return _NONE
    found = (shape.scope.values.get(name) for name in shape.arguments)
    return ListVal(tuple(v for v in found if isinstance(v, Num) and v.dimension == LENGTH))


def _convex_corners(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the corners of a shape of straight edges, in order, if it is convex as written; none otherwise.

    Corners that were given one by one may become something else while solving, so they do not count.
    """
    shape = a["of"]
    if not isinstance(shape, Geometry) or not isinstance(shape.scope, Scope):
        return _NONE
    edges = [part for part in shape.primitives() if part.type != "point"]
    given_one_by_one = any(isinstance(shape.scope.values.get(n), ListVal) for n in shape.arguments)
    if given_one_by_one or any(edge.type != "line" for edge in edges):
        return _NONE
    starts, ends = ([look(it, edge, node, env)[name] for edge in edges] for name in ("start", "end"))
    at = [xy(p).written for p in starts]
    closed = all(
        math.dist(xy(p).written, q) < 1e-9 * math.dist(at[0], q) + 1e-9
        for p, q in zip(ends, _next(at), strict=True)
    )
    return ListVal(tuple(starts)) if closed and _is_convex(at) else _NONE


def _is_convex(corners: Sequence[tuple[float, float]]) -> bool:
    """Tells whether all corners turn to the same side, and together once around."""
    ways = [(q[0] - p[0], q[1] - p[1]) for p, q in zip(corners, _next(corners), strict=True)]
    turns = [
        math.atan2(v[0] * w[1] - v[1] * w[0], v[0] * w[0] + v[1] * w[1])
        for v, w in zip(ways, _next(ways), strict=True)
    ]
    return len(turns) > 2 and abs(abs(sum(turns)) - math.tau) < 1e-6 and (min(turns) > 0 or max(turns) < 0)


def _next(items: Sequence[tuple[float, float]]) -> Sequence[tuple[float, float]]:
    return [*items[1:], *items[:1]]


def _refuse(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    return it.refuse(node, certain(a["why"], TextVal).value)


# --- Colours while building: whether values are one, and the functions that AIDL's own are made of.


def color_of(it: Interpreter, values: Sequence[Value], node: ast.Node) -> str | None:
    """Returns the colour that values stand for, as SVG understands it; None after an error."""
    plain: list[str | float] = []
    for value in values:
        if isinstance(value, Num):
            if (known := constant(it, value, node, "a colour")) is None:
                return None
            plain.append(known)
        else:
            text = as_text(value)
            plain.append(text if text is not None else kind_of(value))
    if (color := css_color(plain)) is None:
        _unknown(it, plain, node)
    return color


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
    color = color_of(it, [a["color"]], node)
    return ListVal(tuple(number(float(part), PLAIN) for part in rgb(color))) if color is not None else NOTHING


def _checked(it: Interpreter, result: Num, node: ast.Node) -> Value:
    if result.expression.is_constant and not ex.is_number(result.value):
        return it.report(
            "E0504", f"`{node.span.text}` has no value", node, label="outside the range of this function"
        )
    return result


def _of_one(
    op: Callable[[Expression], Expression],
    dimension: Callable[[MaybeDimension], MaybeDimension],
    name: str = "value",
) -> Function:
    def function(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
        if (value := numeric(it, a[name], node, env)) is None:
            return NOTHING
        try:
            result = dimension(value.dimension)
        except ValueError as reason:
            return it.report("E0308", f"`{node.callee.text}` has no meaning here: a {reason}", node)
        return _checked(it, Num(op(value.expression), result, value.status), node)

    return function


def _of_angle(op: Callable[[Expression], Expression]) -> Function:
    return _of_one(op, lambda _: PLAIN, "angle")


def _to_angle(op: str) -> Function:
    degrees = ex.constant(1 / DEGREE)
    return _of_one(lambda value: ex.apply(op, value) * degrees, lambda _: ANGLE)


def _atan2(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    if (found := _all_numbers(it, (a["y"], a["x"]), node, env)) is None:
        return NOTHING
    y, x = found
    return Num(ex.atan2(y.expression, x.expression), ANGLE, max(x.status, y.status))


def _hypot(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    both = _all_numbers(it, (a["a"], a["b"]), node, env)
    if both is None or (kind := _common(it, both, node)) is None:
        return NOTHING
    return _checked(it, Num(ex.apply("hypot", *[n.expression for n in both]), *kind), node)


def _numbers(it: Interpreter, a: Arguments, name: str, node: ast.Call, env: Env) -> list[Num] | None:
    if (items := members(a[name])) is None:
        it.report("E0302", f"`{node.callee.text}` wants numbers or a list of them", node)
        return None
    return _all_numbers(it, items, node, env)


def _all_numbers(it: Interpreter, values: Sequence[Value], node: ast.Call, env: Env) -> list[Num] | None:
    found = [numeric(it, value, node, env) for value in values]
    return None if None in found else [n for n in found if n is not None]


def _common(it: Interpreter, values: list[Num], node: ast.Call) -> tuple[MaybeDimension, Exactness] | None:
    dimension: MaybeDimension = None
    try:
        for value in values:
            dimension = units.add(dimension, value.dimension)
    except units.UnequalError as pair:
        it.misfit(rules.unequal(f"`{node.callee.text}` does not join", *pair.args), node)
        return None
    return dimension, max((v.status for v in values), default=Exactness.NUMBER)


def _extreme(op: str) -> Function:
    def function(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
        if (values := _numbers(it, a, "values", node, env)) == []:
            return it.report("E0504", f"`{node.callee.text}` of nothing has no value", node)
        if values is None or (kind := _common(it, values, node)) is None:
            return NOTHING
        return Num(ex.apply(op, *[v.expression for v in values]), *kind)

    return function


def _sum(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    items = members(a["values"])
    if items and all(isinstance(i, PointVal) for i in items):
        x = [i.x for i in items if isinstance(i, PointVal)]
        y = [i.y for i in items if isinstance(i, PointVal)]
        sums = [_checked(it, _total(each, LENGTH), node) for each in (x, y)]
        return PointVal(*sums) if all(isinstance(s, Num) for s in sums) else NOTHING  # type: ignore[arg-type]
    values = _numbers(it, a, "values", node, env)
    if values is None or (kind := _common(it, values, node)) is None:
        return NOTHING
    return _checked(it, _total(values, kind[0]), node)


def _total(values: list[Num], dimension: MaybeDimension) -> Num:
    total, status = ex.ZERO, Exactness.NUMBER
    for value in values:
        total, status = total + value.expression, max(status, value.status)
    return Num(total, dimension, status)


def _rounded(function: Callable[[float], float]) -> Function:
    def rounded(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
        what, value = f"what `{node.callee.text}` rounds", numeric(it, a["value"], node, env)
        if value is None or (known := constant(it, value, node, what)) is None:
            return NOTHING
        if not ex.is_number(known):
            return _checked(it, number(known), node)
        # 2.9999999999999996 is 3 that went through arithmetic.
        near = round(known)
        result = near if abs(known - near) < 1e-9 * max(1.0, abs(known)) else function(known)
        return number(float(result), value.dimension, value.status)

    return rounded


def _len(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    values = a["values"]
    if isinstance(values, TextVal):
        return number(float(len(values.value)))
    items = coerce.items_of(it, values, node)
    if items is None and not isinstance(values, RangeVal):
        what = f"the members of a list or the letters of a text, and this is {kind_of(values)}"
        it.report("E0302", f"`len` counts {what}", node)
    return number(float(len(items))) if items is not None else NOTHING


def _choice(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    word = certain(a["word"], TextVal)
    words = dict.fromkeys(w.value for w in members(a["words"]) or () if isinstance(w, TextVal))
    meant = find(word.value, words) or find(_SAME_WORD.get(word.value, ""), words)
    if meant is None:
        hints = did_you_mean(f'"{like}"' for like in nearest(word.value, words))
        allowed = ", ".join(f'`"{w}"`' for w in words)
        message = f'"{word.value}" is not one of the words that are meant here'
        return it.report("E0516", message, node, hints=[*hints, f"it is one of {allowed}"])
    return TextVal(meant)


_SAME_WORD = {"middle": "center", "centre": "center", "horizontal": "x", "vertical": "y"}


def _mark(status: Exactness) -> Function:
    """Makes `fixed(x)` or `guess(x)`: the value with another status, points and lists by member."""

    def function(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
        value = a["value"]
        value = as_point(it, value, node, env) or value if isinstance(value, Geometry) else value
        if isinstance(value, Num | PointVal | ListVal):
            value = as_written(value) if status is Exactness.GUESS else value
            return with_numbers(value, lambda n: Num(n.expression, n.dimension, status))
        message = f"`{node.callee.text}` marks a number or a point, and this is {kind_of(value)}"
        hint = "to hold a geometry where it was written: `constrain fixed(…)`"
        return it.report("E0310", message, node, hints=[hint])

    return function


def _nearest(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the candidate nearest to a value as written, or if asked one further off, which is reported."""
    value = numeric(it, a["value"], node, env)
    candidates = _numbers(it, a, "candidates", node, env)
    if value is None or not candidates:
        return NOTHING
    (target,) = spelled_out(value.expression)
    is_angle = value.dimension == ANGLE

    def away(candidate: Num) -> float:
        difference = candidate.value - target.value
        return abs((difference + 180) % 360 - 180) if is_angle else abs(difference)

    is_told = it.call_sites and (span := it.place(node)) is not None and len(candidates) > 1
    rank = it.turned.get(len(it.readings), 0) if is_told else 0
    chosen = sorted(candidates, key=away)[rank % len(candidates)]
    if is_told:
        assert span is not None
        it.readings.append(
            (span, f"taken as {chosen.value:.6g} ({candidates.index(chosen) + 1} of {len(candidates)})")
        )
    return chosen


def _where(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns one of two numbers by the sign of a third, which the solver may decide."""
    found = _all_numbers(it, (a["value"], a["positive"], a["negative"]), node, env)
    if found is None or (kind := _common(it, found[1:], node)) is None:
        return NOTHING
    status = max(n.status for n in found)
    return Num(ex.apply("select", *[n.expression for n in found]), kind[0], status)


def _shown(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns a measure, negative in an overlap for the solver to get out of it; for a reader 0: no room."""
    value = numeric(it, a["value"], node, env)
    if value is None or env.reach is not Reach.READ:
        return value if value is not None else NOTHING
    return Num(ex.apply("maximum", value.expression, ex.ZERO), value.dimension, value.status)


_YES = number(1.0, PLAIN)


def _measure(kind: str, dimension: Dimension) -> Function:
    def function(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
        of = tuple(v for v in a.values() if isinstance(v, Structure | Geometry))
        if len(of) != len(a):
            wrong = next(v for v in a.values() if not isinstance(v, Structure | Geometry))
            it.report("E0310", f"`{kind}` measures structures and geometry, not {kind_of(wrong)}", node)
            return NOTHING
        measured = Num(ex.measure(Measurement(kind, of)), dimension, Exactness.REFERENCE)
        return compare_numbers(it, "==", measured, _YES, node) if kind == "overlaps" else measured

    return function


def _centroid(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    of = a["of"]
    found = centroid(of, env.here) if isinstance(of, Geometry) else None
    if found is None or not isinstance(of, Geometry):
        return it.report("E0512", f"`{node.span.one_line}` has no formula", node, hints=[FORMULAS])
    where, area = it.place(node) or node.span, Measurement("area", (of,))
    if not any(known.span == where for known in it.assertions):
        foreseen = formula(area)
        assert foreseen is not None
        size = Num(ex.apply("abs", foreseen), AREA)  # it may turn over
        drawn = certain(compare_numbers(it, "==", size, Num(ex.measure(area), AREA), node), Condition)
        it.assertions.append(Assertion(env.here, drawn, OTHERWISE, node.span.one_line, where))
    return point(*found)


def _ink(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the box of the letters around the start of the first line, in heights of a capital."""
    if not (glyphs := typeset(it, a)):
        return NOTHING
    sides = zip(("left", "bottom", "right", "top"), box_around(glyphs), strict=True)
    return RecordVal({name: number(value) for name, value in sides})


FUNCTIONS: dict[str, Function] = {
    "sin": _of_angle(ex.sin),
    "cos": _of_angle(ex.cos),
    "tan": _of_angle(lambda angle: ex.apply("tan", angle * DEGREE)),
    "asin": _to_angle("asin"),
    "acos": _to_angle("acos"),
    "atan": _of_one(lambda value: ex.atan2(value, ex.ONE), lambda _: ANGLE),
    "atan2": _atan2,
    "sqrt": _of_one(partial(ex.apply, "sqrt"), lambda d: units.power(d, 0.5)),
    "abs": _of_one(partial(ex.apply, "abs"), lambda d: d),
    "square": _of_one(partial(ex.apply, "square"), lambda d: units.multiply(d, d)),
    "hypot": _hypot,
    "min": _extreme("minimum"),
    "max": _extreme("maximum"),
    "sum": _sum,
    "floor": _rounded(math.floor),
    "ceil": _rounded(math.ceil),
    "round": _rounded(lambda value: math.floor(value + 0.5)),
    "len": _len,
    **coerce.FUNCTIONS,
    "choice": _choice,
    "rgb": _rgb,
    "channels": _channels,
    "ink": _ink,
    "lettered": lettered,
    "traced_part": traced_part,
    "fixed": _mark(Exactness.FIXED),
    "guess": _mark(Exactness.GUESS),
    "written": lambda it, a, node, env: as_written(a["value"]),
    "nearest": _nearest,
    "where": _where,
    "shown": _shown,
    "sizes": _sizes,
    "convex_corners": _convex_corners,
    "refuse": _refuse,
    **OPERATIONS,
    **copies.FUNCTIONS,
    **patterns.FUNCTIONS,
    "area": _measure("area", AREA),
    "perimeter": _measure("perimeter", LENGTH),
    "centroid": _centroid,
    "outline_clearance": _measure("clearance", LENGTH),
    "overlaps": _measure("overlaps", PLAIN),
}
