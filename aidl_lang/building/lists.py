"""Lists, ranges, records and texts: the functions that make and join them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from aidl_lang.building.coerce import constant
from aidl_lang.building.state import Arguments, Env, Function, Interpreter
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    ListVal,
    Num,
    RangeVal,
    RecordVal,
    TextVal,
    Value,
    kind_of,
    members,
    number,
)
from aidl_lang.common.names import find, nearest
from aidl_lang.common.prose import first_few, ticked
from aidl_lang.syntax import ast


def run(it: Interpreter, value: RangeVal, node: ast.Node) -> list[Value] | None:
    """Returns the numbers of a range in order; None after an error. An empty range is empty."""
    parts = [n for n in (value.start, value.end, value.step) if n is not None]
    known = [constant(it, n, node, "the ends of a range that is run through") for n in parts]
    if None in known:
        return None
    start, end, step = [*(k for k in known if k is not None), 1.0][:3]
    if step == 0:
        it.report("E0504", "a range with a step of 0 never ends", node, hints=["count up or down: `step 5`"])
        return None
    turns = (end - start) / step
    tolerance = min(1e-9 * max(1.0, abs(start / step), abs(end / step)), 0.01)
    count = math.ceil(turns - tolerance) if value.exclusive else math.floor(turns + tolerance) + 1
    if count > it.limits.items:
        it.report("E0805", f"this range has {count} members; at most {it.limits.items} are allowed", node)
        return None
    status = min(max(n.status for n in parts), Exactness.NUMBER)
    return [number(start + i * step, value.start.dimension, status) for i in range(max(count, 0))]


def items_of(it: Interpreter, value: Value, node: ast.Node) -> Sequence[Value] | None:
    """Returns the members of a list, an array or a range; None for anything else, or after an error."""
    return run(it, value, node) if isinstance(value, RangeVal) else members(value)


def entry(it: Interpreter, value: RecordVal, name: str, node: ast.Node) -> Value:
    """Returns a field of a record by its name, in any spelling that `find` accepts."""
    key = find(name, value.fields)
    if key is None:
        like = nearest(name, value.fields)
        known = first_few(ticked(value.fields), 12, "")
        hint = f"did you mean `{like[0]}`?" if like else f"it has {known}" if known else "it is empty"
        it.report("E0202", f"this record has no `{name}`", node, hints=[hint])
        return NOTHING
    return value.fields[key]


def joined(left: Value, right: Value) -> Value | None:
    """Returns `left + right` of two texts or two lists; None if they are neither."""
    if isinstance(left, TextVal) and isinstance(right, TextVal):
        return TextVal(left.value + right.value)
    a, b = members(left), members(right)
    return ListVal((*a, *b)) if a is not None and b is not None else None


def shown(value: Value) -> str | None:
    """Returns a number, text or truth as a reader writes it: in mm and degrees, without a unit."""
    match value:
        case Num():
            return f"{value.value:.10g}"
        case TextVal(text):
            return text
        case bool():
            return "true" if value else "false"
        case _:
            return None


def _str(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    value = a["value"]
    if isinstance(value, Num) and constant(it, value, node, "a number that becomes a text") is None:
        return NOTHING
    text = shown(value)
    if text is None:
        it.report("E0302", f"`str` writes numbers, texts and truth values, not {kind_of(value)}", node)
        return NOTHING
    return TextVal(text)


def _range(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the numbers of a range as in Python: without the end, and one number alone is the end."""
    start, end, step = a.get("start", number(0.0)), a["end"], a.get("step")
    assert isinstance(start, Num)
    assert isinstance(end, Num)
    assert step is None or isinstance(step, Num)
    items = run(it, RangeVal(start, end, exclusive=True, step=step), node)
    return ListVal(tuple(items)) if items is not None else NOTHING


def _enumerate(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    items = members(a["values"]) or ()
    return ListVal(tuple(ListVal((number(float(i)), item)) for i, item in enumerate(items)))


def _zip(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns pairs of members with the same place; reports lists of different lengths."""
    lists = [members(value) or () for value in a.values()]
    lengths = [len(items) for items in lists]
    if len(set(lengths)) > 1:
        told = " and ".join(str(n) for n in lengths)
        it.report("E0304", f"`zip` pairs lists of one length, and these have {told} members", node)
        return NOTHING
    return ListVal(tuple(ListVal(pair) for pair in zip(*lists, strict=True)))


FUNCTIONS: dict[str, Function] = {
    "record": lambda it, a, node, env: RecordVal(a),
    "str": _str,
    "range": _range,
    "enumerate": _enumerate,
    "zip": _zip,
    "reversed": lambda it, a, node, env: ListVal(tuple(reversed(members(a["values"]) or ()))),
}
