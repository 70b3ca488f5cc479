"""Names and members: bindings read from the place of use, and the fields behind a dot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from aidl_lang.building import boxes, curves, primitives
from aidl_lang.building.boxes import Box
from aidl_lang.building.coerce import as_written, may_read
from aidl_lang.building.lists import entry
from aidl_lang.building.model import Condition, Geometry, Structure
from aidl_lang.building.outlines import finish_size
from aidl_lang.building.params import read_param
from aidl_lang.building.scopes import (
    Binding,
    CopiedBinding,
    LetBinding,
    ParamBinding,
    PassedBinding,
    Scope,
    VarBinding,
)
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.building.templates import read_passed
from aidl_lang.building.turning import unlock
from aidl_lang.building.values import (
    NOTHING,
    Array,
    Exactness,
    ListVal,
    Namespace,
    Nothing,
    Num,
    Pattern,
    PointVal,
    RecordVal,
    Value,
    kind_of,
    members,
)
from aidl_lang.checking.builtins import FINISHES, ROTATION
from aidl_lang.checking.registry import offered
from aidl_lang.checking.synonyms import MEMBERS
from aidl_lang.checking.units import ANGLE
from aidl_lang.common.diagnostics import Edit, Fix, Label
from aidl_lang.common.names import find, fold, nearest
from aidl_lang.common.prose import first_few, ticked
from aidl_lang.syntax import ast


def not_built(it: Interpreter, node: ast.Name, branch: ast.If) -> Value:
    test = branch.test.span.one_line
    it.report(
        "E0514",
        f"`{node.text}` was not built, because of `if {test}`",
        node,
        label="mentioned here",
        hints=[f"mention it only where it is built: under the same `if {test}`"],
        secondary=[Label(branch.test.span, "this branch was not taken")],
    )
    return NOTHING


def read(it: Interpreter, binding: Binding, node: ast.Node, env: Env) -> Value:
    """Returns the value of a name for the expression that reads it."""
    reader = _READERS.get(type(binding))
    return binding if reader is None else reader(it, binding, node, env)  # type: ignore[return-value]


def _read_let(it: Interpreter, let: LetBinding, node: ast.Node, env: Env) -> Value:
    if let.known is not None:
        return let.known
    if (seen := let.seen.get((env.here, env.reach))) is not None:
        return seen
    if let.running:
        it.report("E0207", f"`{node.span.text}` is defined by way of itself", node)
        return NOTHING
    let.running = True
    try:
        value = it.evaluate(let.node, Env(let.scope, env.here, env.reach))
    finally:
        let.running = False
    if is_same_everywhere(value):
        let.known = value
    else:
        let.seen[env.here, env.reach] = value
    return value


def _read_var(it: Interpreter, var: VarBinding, node: ast.Node, env: Env) -> Value:
    reached = may_read(it, var.unknown.owner, node, env)
    return var.value if reached else as_written(var.value)


def _read_copied(it: Interpreter, copied: CopiedBinding, node: ast.Node, env: Env) -> Value:
    source = copied.source
    assert isinstance(source.scope, Scope)
    value = read(it, copied.binding, node, Env(source.scope, source.owner, Reach.OWN))
    return copied.carry(copied.name, value, source.owner)


_READERS: Mapping[type, Callable[..., Value]] = {
    LetBinding: _read_let,
    ParamBinding: lambda it, binding, node, env: read_param(it, binding, node),
    VarBinding: _read_var,
    PassedBinding: lambda it, binding, node, env: read_passed(it, binding, env),
    CopiedBinding: _read_copied,
}
"""Readers of bindings by their class; any other class is a value."""


def is_same_everywhere(value: Value) -> bool:
    """Tells whether a value does not depend on the frame or the reach of the code that reads it."""
    match value:
        case Num(expression=e):
            return e.is_constant
        case PointVal(x, y):
            return x.expression.is_constant and y.expression.is_constant
        case ListVal(items):
            return all(map(is_same_everywhere, items))
        case RecordVal(fields):
            return all(map(is_same_everywhere, fields.values()))
        case Condition() | Box():
            return False
        case _:
            return True


def member(it: Interpreter, value: Value, name: str, node: ast.Member, env: Env) -> Value:
    """Returns `value.name`, as written or by a synonym."""
    for word in (name, *MEMBERS.get(fold(name), ())):
        if (found := _member(it, value, word, node, env)) is not None:
            return found
    _no_member(it, value, name, node)
    return NOTHING


def _member(it: Interpreter, value: Value, name: str, node: ast.Member, env: Env) -> Value | None:
    """Returns a member; None if there is none of that name."""
    found: Value | None = None
    match value:
        case Nothing():
            return NOTHING
        case Pattern(settings=settings) if (key := find(name, settings.fields)) is not None:
            found = curves.field(settings, key, env.here)
            return found if found is None or may_read(it, settings.owner, node, env) else as_written(found)
        case PointVal(x, y):
            found = {"x": x, "y": y}.get(name.casefold())
        case Structure():
            found = _structure_member(it, value, name, node, env)
        case Geometry():
            found = _geometry_member(it, value, name, node, env)
        case Box():
            found = _box_field(it, value, name, node, env)
        case RecordVal():
            return entry(it, value, name, node.name)
        case Namespace():
            key = find(name, value.values)
            found = read(it, value.values[key], node, env) if key else None  # type: ignore[arg-type]
        case ListVal() | Array() if name in ("bb", "box"):
            found = boxes.box_of(value, env.here)
        case ListVal() | Array():
            items = [member(it, item, name, node, env) for item in members(value) or ()]
            return NOTHING if any(isinstance(i, Nothing) for i in items) else ListVal(tuple(items))
    return found if found is not None else finish_size(it, value, name, node, env)


_TURNED = "how a structure is turned is its `rotation`: `part.rotation == 30deg`"


def _no_member(it: Interpreter, value: Value, name: str, node: ast.Member) -> None:
    if it.place(node) is not node.span:
        # The library's expression would mean nothing to an author.
        hints = [_TURNED] if isinstance(value, Structure) and name == "angle" else []
        it.refuse(node, f"{kind_of(value)} has no `{name}`", hints)
        return
    known = member_names(value)
    like = nearest(name, known)
    if (kind := fold(name)) in FINISHES:
        hint = f"it has one once it is finished: `{kind}({node.value.span.text}, 5)`"
    elif like:
        hint = f"did you mean `{like[0]}`?"
    elif known:
        hint = "it has " + first_few(ticked(known), 12, "")
    else:
        hint = "members belong to structures, geometry, boxes and points"
    what = f"`{node.value.span.text}`"
    it.report("E0202", f"{what} has no `{name}` (it is {kind_of(value)})", node.name, hints=[hint])


def member_names(value: Value) -> list[str]:
    """Returns the names that may stand behind a dot, for messages."""
    match value:
        case PointVal():
            return ["x", "y"]
        case Box():
            return list(boxes.FIELDS)
        case Structure():
            return [*value.members, "bb", *boxes.FIELDS]
        case Geometry(scope=Scope() as scope):
            return [*scope.values, "bb", *boxes.FIELDS]
        case Geometry():
            return [*(offered(value.type) or value.fields), "bb", *boxes.FIELDS]
        case _:
            return []


def _structure_member(it: Interpreter, s: Structure, name: str, node: ast.Node, env: Env) -> Value | None:
    assert isinstance(s.scope, Scope)
    if (key := find(name, s.scope.values)) is not None:
        binding = s.scope.values[key]
        value = read(it, binding, node, env)
        # Points kept as they are (`origin`, an argument, a list) are in the structure's own frame.
        is_own = isinstance(binding, PointVal | ListVal | PassedBinding)
        return primitives.translate(key, value, s, env.here) if is_own else value
    if fold(name) == ROTATION and s.parent is not None:
        return _rotation(it, s, s.parent, node, env)
    box = boxes.box_of(s, env.here)
    return _box_field(it, box, name, node, env) if box else None


def _rotation(it: Interpreter, s: Structure, around: Structure, node: ast.Node, env: Env) -> Value:
    """Returns the turn of a structure; a constraint on it lets the structure turn."""
    turn = primitives.translate("angle", Num(s.frame.rotation, ANGLE, Exactness.REFERENCE), around, env.here)
    if not may_read(it, s, node, env):
        return as_written(turn)
    if env.reach is Reach.SUBTREE:
        unlock(s.frame.rotation)
    return turn


def _geometry_member(it: Interpreter, g: Geometry, name: str, node: ast.Node, env: Env) -> Value | None:
    if isinstance(g.scope, Scope):
        if (key := find(name, g.scope.values)) is not None:
            return _shape_member(it, g, key, node, env)
    else:
        fields = dict.fromkeys((*offered(g.type), *g.fields))
        key = find(name, fields) or name
        reached = may_read(it, g.bound_to, node, env)
        value = curves.field(g, key, env.here)
        if value is not None:
            return value if reached else as_written(value)
    box = boxes.box_of(g, env.here)
    return _box_field(it, box, name, node, env) if box else None


def _shape_member(it: Interpreter, g: Geometry, key: str, node: ast.Node, env: Env) -> Value:
    """Returns a part, argument or let of a compound shape: read in its owner's frame, seen from here."""
    assert isinstance(g.scope, Scope)
    value = read(it, g.scope.values[key], node, Env(g.scope, g.owner, Reach.OWN))
    value = primitives.translate(key, value, g.owner, env.here)
    if isinstance(value, Num | PointVal | ListVal) and not is_same_everywhere(value):
        if not may_read(it, g.bound_to, node, env):
            return as_written(value)
        if env.reach is Reach.SUBTREE and isinstance(value, Num) and value.dimension == ANGLE:
            unlock(value.expression)
    return value


_BOX_FIELDS = dict.fromkeys(boxes.FIELDS)


def _box_field(it: Interpreter, box: Box, name: str, node: ast.Node, env: Env) -> Value | None:
    if name.casefold() in ("bb", "box", "boundingbox", "bounding_box"):
        return box
    key = find(name, _BOX_FIELDS)
    if key is None:
        return None
    value = box.field(key)
    if env.reach is Reach.ABOVE:
        if any(isinstance(s, Structure) and env.here.is_within(s) for s in box.sources):
            env = Env(env.scope, env.here, Reach.OWN)  # it follows from what is made here
        else:
            value = _at_once(value)
    if value is not None and env.reach is Reach.OWN and env.here in box.sources:
        return as_written(value) if it.watched else _refuse_own_box(it, node, env)
    owners = (s if isinstance(s, Structure) else getattr(s, "bound_to", None) for s in box.sources)
    reached = all(may_read(it, owner, node, env) for owner in owners if owner is not None)
    return value if reached or value is None else as_written(value)


def _at_once(value: Num | PointVal | None) -> Num | PointVal | None:
    """Returns a side, a measure or a point of a box over the unknowns of what is in it by now."""
    if isinstance(value, Num):
        return replace(value, expression=boxes.spelled_out(value.expression)[0])
    if isinstance(value, PointVal):
        x, y = boxes.spelled_out(value.x.expression, value.y.expression)
        return PointVal(replace(value.x, expression=x), replace(value.y, expression=y))
    return value


def _refuse_own_box(it: Interpreter, node: ast.Node, env: Env) -> Value:
    text, here = node.span.text, env.here.path
    it.report(
        "E0401",
        f"geometry of `{here}` cannot use `{text}`, which follows from the geometry of `{here}`",
        node,
        label="the box that this geometry is in",
        hints=[
            "take the box of a geometry, as `outline.bb`, or write a first guess here and say the relation "
            "as a constraint"
        ],
    )
    return NOTHING


def no_index(it: Interpreter, node: ast.Index, known: list[int], wanted: int) -> Value:
    name = node.value.span.text
    is_run = bool(known) and known[-1] - known[0] == len(known) - 1
    listed = f"{known[0]} to {known[-1]}" if is_run or len(known) > 8 else ", ".join(map(str, known))
    has = f"its indices are {listed}" if known else "it is empty"
    by_place = isinstance(node.index, ast.Number) and 0 <= wanted < len(known)
    meant = f"{known[wanted]}" if by_place else ""
    it.report(
        "E0503",
        f"`{name}` has no member {wanted}: {has}",
        node.index,
        hints=[f"members have the indices they were given: in order, number {wanted} is `{name}[{meant}]`"]
        if by_place
        else (),
        fix=Fix(f"write `{name}[{meant}]`", (Edit(node.index.span, meant),)) if by_place else None,
    )
    return NOTHING
