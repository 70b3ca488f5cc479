"""Coercions of values to the kind that is expected, and the functions that make lists, records and texts."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import SIDES, Box
from aidl_lang.building.curves import view, xy
from aidl_lang.building.model import Geometry, Structure, common_ancestor
from aidl_lang.building.state import Arguments, Env, Function, Interpreter, Reach
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    ListVal,
    Nothing,
    Num,
    PointVal,
    RangeVal,
    RecordVal,
    TextVal,
    Value,
    certain,
    kind_of,
    length,
    members,
    number,
    numbers_of,
    type_of,
    with_numbers,
)
from aidl_lang.checking import rules
from aidl_lang.checking.rules import place_before, shown
from aidl_lang.checking.units import LENGTH, PLAIN
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.names import find, nearest
from aidl_lang.common.prose import did_you_mean, first_few, ticked
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

# --- Coercions of values to the kind that is expected, and checks of what may be read from where.
#
# Each returns None after reporting a value that does not fit, unless it says otherwise.


def as_written(value: Value) -> Value:
    """Returns a value out of reach as the numbers it has at the first guesses."""
    return with_numbers(value, _guessed)


def _guessed(value: Num) -> Num:
    expression = value.expression
    return Num(expression if expression.is_constant else ex.constant(expression.value), value.dimension)


def may_read(it: Interpreter, owner: Structure, node: ast.Node, env: Env) -> bool:
    """Tells whether the unknowns of `owner` are within reach here; reports them if not."""
    if env.reach in (Reach.READ, Reach.ABOVE) or (owner is env.here):
        return True
    if env.reach is Reach.SUBTREE and owner.is_within(env.here):
        return True
    if not it.watched:
        kind = "geometry" if env.reach is Reach.OWN else "a constraint"
        allowed = "its own structure" if env.reach is Reach.OWN else "the structure that holds it"
        code, name = "E0401" if env.reach is Reach.OWN else "E0402", node.span.text
        message = f"{kind} of `{env.here.path}` cannot use `{name}`, which belongs to `{owner.path}`"
        hint = f"write a first guess here and a constraint in `{common_ancestor(owner, env.here).path}`"
        it.report(code, message, node, label=f"outside {allowed}", hints=[hint])
    return False


def owners_of(value: Value, here: Structure) -> Iterator[Structure]:
    """Yields the structures other than `here` whose unknowns a number, a point or a holder of these needs."""
    for n in numbers_of(value):
        yield from (u.owner for u in ex.unknowns([n.expression]) if u.owner is not here)
    for item in value.fields.values() if isinstance(value, RecordVal) else members(value) or ():
        yield from owners_of(item, here)


def all_within(it: Interpreter, values: Iterable[Value], node: ast.Node, env: Env) -> bool:
    """Tells whether the unknowns of all numbers and points are within reach here; reports them if not."""
    owners = dict.fromkeys(owner for value in values for owner in owners_of(value, env.here))
    return all(may_read(it, owner, node, env) for owner in owners)


def look(it: Interpreter, geometry: Geometry, node: ast.Node, env: Env) -> dict[str, Value]:
    """Returns the numbers and points that define a primitive, in the frame of the structure that asks."""
    core = view(geometry, env.here)
    if may_read(it, geometry.bound_to, node, env):
        return core
    return {name: as_written(value) for name, value in core.items()}


def numeric(it: Interpreter, value: Value, node: ast.Node, env: Env) -> Num | None:
    """Returns a value as a number; None after an error, which has been reported."""
    if isinstance(value, Num):
        return value
    if isinstance(value, Geometry) and value.type == "line":
        return edge_coordinate(it, value, node, env)
    if not isinstance(value, Nothing):
        it.misfit(rules.needed("a number", type_of(value)), node)
    return None


def coordinate(it: Interpreter, value: Value, node: ast.Node, env: Env) -> Num | None:
    """Returns a number as a coordinate; an edge of an axis-aligned shape stands for its own."""
    if (found := numeric(it, value, node, env)) is None:
        return None
    if found.dimension not in (None, PLAIN, LENGTH):
        it.misfit(rules.no_coordinate(shown(node), type_of(found)), node)
        return None
    return length(found.expression, found.status)


def edge_coordinate(it: Interpreter, edge: Geometry, node: ast.Node, env: Env) -> Num | None:
    """Returns the coordinate that an edge parallel to an axis of the holder's frame stands for. One named as
    a side of its shape that does not lie as its name says where it was drawn (slanted, or a level `left`)
    stands for that side of the shape's box.
    """
    core = look(it, edge, node, env)
    x, y = xy(core["start"])
    axis = _axis(core)
    if isinstance(node, ast.Member) and node.name.text in SIDES and isinstance(edge.container, Geometry):
        side = node.name.text
        as_drawn = _axis(view(edge, edge.owner))
        if not axis or as_drawn != ("x" if side in ("left", "right") else "y"):
            return length(Box((edge.container,), env.here).side(side))
    if axis:
        return length(x if axis == "x" else y)
    message = f"`{node.span.text}` is not parallel to an axis, so it stands for no coordinate"
    hint = "name a side of the box (`.bb.left`) or a point of the edge (`.start.x`, `.midpoint.y`)"
    it.report("E0303", message, node, label="a slanted edge", fix=_side_of_box(node), hints=[hint])
    return None


def _axis(core: Mapping[str, Value]) -> str:
    """Returns the coordinate that is one along a whole edge, `x` or `y`; empty if it is slanted."""
    (x0, y0), (x1, y1) = xy(core["start"]), xy(core["end"])
    dx, dy = abs(x1.value - x0.value), abs(y1.value - y0.value)
    tolerance = 1e-9 * max(dx, dy, 1e-300)
    return "x" if dx <= tolerance < dy else "y" if dy <= tolerance < dx else ""


def _side_of_box(node: ast.Node) -> Fix | None:
    """Returns the fix `plate.left` → `plate.bb.left`; None for other names."""
    if not isinstance(node, ast.Member) or node.name.text not in SIDES:
        return None
    return Fix("take the side of the box", (Edit(place_before(node.name), "bb."),))


def as_point(it: Interpreter, value: Value, node: ast.Node, env: Env) -> PointVal | None:
    """Returns a value as a point; None if it is none (nothing is reported)."""
    match value:
        case PointVal():
            return value
        case Geometry(type="point"):
            at = look(it, value, node, env)["at"]
            return at if isinstance(at, PointVal) else None
        case ListVal((Num() as x, Num() as y)):
            return PointVal(length(x.expression, x.status), length(y.expression, y.status))
        case _:
            return None


def constant(it: Interpreter, value: Num, node: ast.Node, what: str) -> float | None:
    """Returns the value of a number that has to be known while building; None after an error.

    A number argument that is read so becomes a constant for good.
    """
    if value.expression.is_constant:
        return value.value
    found = list(ex.unknowns([value.expression]))
    if all(u.cell or u.exact for u in found):
        for u in found:
            u.exact = True
        return value.value
    it.misfit(rules.unknown_yet(what, shown(node)), node)
    return None


def whole(it: Interpreter, value: Value, node: ast.Node, what: str) -> int | None:
    """Returns a whole number known while building; None after an error."""
    if isinstance(value, Nothing):
        return None
    if not isinstance(value, Num):
        it.misfit(rules.no_whole_number(what, type_of(value)), node)
        return None
    if (known := constant(it, value, node, what)) is None:
        return None
    if abs(known - round(known)) > 1e-9 * max(1.0, abs(known)) or not math.isfinite(known):
        it.misfit(rules.fraction(what, f"{known:g}"), node, _numbered(it, node))
        return None
    return round(known)


def _numbered(it: Interpreter, node: ast.Node) -> Fix | None:
    """Returns the edits that have a loop count its turns, for an index that is its variable; else None."""
    symbol = it.program.resolution.uses.get(node)
    loop = symbol.node if symbol is not None else None
    if not isinstance(loop, ast.For) or len(loop.variables) > 1 or isinstance(loop.iterable, ast.Range):
        return None
    taken = set(re.findall(r"\w+", loop.span.source.text))
    count = next((name for name in ("i", "j", "k", "n", "number") if name not in taken), None)
    if count is None:
        return None
    variable, through = loop.variables[0], loop.iterable.span
    indices = [
        index
        for found in ast.walk(loop.body)
        for index in (*getattr(found, "indices", ()), getattr(found, "index", None))
        if isinstance(index, ast.Name) and it.program.resolution.uses.get(index) is symbol
    ]
    start, end = through.start, through.end
    texts = {variable.span.start: f"{count}, ", start: "enumerate(", end: ")"}
    edits = [Edit(Span(through.source, at, at), text) for at, text in texts.items()]
    edits += [Edit(index.span, count) for index in indices]
    told = f"for {count}, {variable.text} in enumerate({shown(loop.iterable)})"
    return Fix(f"count the turns: `{told}`, and `[{count}]`", tuple(edits), is_sure=True)


# --- Lists, ranges, records and texts: the functions that make and join them.


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
    if (key := find(name, value.fields)) is None:
        known = first_few(ticked(value.fields), 12, "")
        hints = did_you_mean(nearest(name, value.fields)) or [f"it has {known}" if known else "it is empty"]
        return it.report("E0202", f"this record has no `{name}`", node, hints=hints)
    return value.fields[key]


def joined(left: Value, right: Value) -> Value | None:
    """Returns `left + right` of two texts or two lists; None if they are neither."""
    if isinstance(left, TextVal) and isinstance(right, TextVal):
        return TextVal(left.value + right.value)
    a, b = members(left), members(right)
    return ListVal((*a, *b)) if a is not None and b is not None else None


def as_text(value: Value) -> str | None:
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
    if (text := as_text(value)) is None:
        return it.report("E0302", f"`str` writes numbers, texts and truth values, not {kind_of(value)}", node)
    return TextVal(text)


def _range(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the numbers of a range as in Python: without the end, and one number alone is the end."""
    start, end = certain(a.get("start", number(0.0)), Num), certain(a["end"], Num)
    step = certain(a["step"], Num) if "step" in a else None
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
        return it.report("E0304", f"`zip` pairs lists of one length, and these have {told} members", node)
    return ListVal(tuple(ListVal(pair) for pair in zip(*lists, strict=True)))


FUNCTIONS: dict[str, Function] = {
    "record": lambda it, a, node, env: RecordVal(a),
    "str": _str,
    "range": _range,
    "enumerate": _enumerate,
    "zip": _zip,
    "reversed": lambda it, a, node, env: ListVal(tuple(reversed(members(a["values"]) or ()))),
}
