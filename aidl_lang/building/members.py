"""Names and members: bindings read from the place of use, and the fields behind a dot; params."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace

from aidl_lang.building import boxes, curves
from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import Box
from aidl_lang.building.coerce import as_written, constant, entry, may_read
from aidl_lang.building.construct import positions, refuses_measure
from aidl_lang.building.curves import unlock
from aidl_lang.building.model import Condition, Constraint, Geometry, Knob, Structure, convert_point
from aidl_lang.building.outlines import finish_size
from aidl_lang.building.state import (
    CopiedBinding,
    Env,
    Interpreter,
    LetBinding,
    NameBinding,
    ParamBinding,
    PassedBinding,
    Reach,
    Scope,
    VarBinding,
)
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
    RangeVal,
    RecordVal,
    TextVal,
    Value,
    certain,
    kind_of,
    members,
    number,
    numbers_of,
    type_of,
    with_numbers,
)
from aidl_lang.building.wording import equated
from aidl_lang.checking import rules, units
from aidl_lang.checking.binding import MEMBERS
from aidl_lang.checking.builtins import FINISHES, ROTATION
from aidl_lang.checking.types import offered
from aidl_lang.checking.units import ANGLE, UNITS
from aidl_lang.common.diagnostics import Edit, Fix, Label
from aidl_lang.common.names import find, fold, nearest
from aidl_lang.common.prose import did_you_mean, first_few, literal, ticked
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

# --- Templates: the results of their calls, and their arguments inside.
#
# A number argument keeps its status; one that is literal is a single unknown inside the instance. A
# reference becomes an unknown of every structure that uses it, tied by an equality that the instantiating
# structure holds.


def passed(
    it: Interpreter, name: str, value: Value, instance: Structure, holder: Structure, node: ast.Node
) -> Value | PassedBinding:
    """Returns the binding of an instance's parameter."""
    if (thing := _drawn(value)) is not None:
        message = f"a template takes numbers, points, texts and lists, and `{name}` is given {kind_of(thing)}"
        hint = f"pass one of its points or sizes, or constrain `{instance.name}` from outside"
        it.report("E0313", message, node, hints=[hint])
    if isinstance(value, Num | PointVal) or (isinstance(value, ListVal) and _refers(value)):
        return PassedBinding(name, value, instance, holder, node)
    return value


def _drawn(value: Value) -> Geometry | Structure | None:
    if isinstance(value, Geometry | Structure):
        return value
    held = value.fields.values() if isinstance(value, RecordVal) else members(value) or ()
    return next((thing for item in held if (thing := _drawn(item)) is not None), None)


def read_passed(it: Interpreter, binding: PassedBinding, env: Env) -> Value:
    """Returns an argument as the structure that reads it has it."""
    here = env.here if env.here.is_within(binding.instance) else binding.instance
    if (known := binding.tied.get(here)) is None:
        known = binding.tied[here] = _tie(it, binding, here)
    return known


def _tie(it: Interpreter, binding: PassedBinding, here: Structure) -> Value:
    match binding.value:
        case Num(status=Exactness.REFERENCE) as number:
            refuses_measure(it, number, binding.node.span)
            made = it.unknown(number.value, here, binding.name, dimension=number.dimension)
            own = Num(made, number.dimension, Exactness.REFERENCE)
            _hold_equal(it, binding, [(own, number)])
            return own
        case Num(status=Exactness.NUMBER) as number if here is binding.instance:
            name, dimension = binding.name, number.dimension
            made = it.unknown(number.value, here, name, dimension=dimension, kept=True, cell=True)
            it.became(number, made, here, name, dimension)
            return Num(made, dimension, Exactness.NUMBER)
        case PointVal() as point if here is not binding.instance and not _refers(point):
            return point
        case PointVal() as point:
            own_point = _own_point(it, binding, point, here)
            if _refers(point):
                outside = convert_point(own_point, here, binding.holder)
                pairs = [(outside.x, point.x), (outside.y, point.y)]
                _hold_equal(it, binding, [p for p in pairs if p[1].status is Exactness.REFERENCE])
            return own_point
        case ListVal(items):
            bindings = (replace(binding, name=f"{binding.name}[{i}]", value=v) for i, v in enumerate(items))
            return ListVal(tuple(_tie(it, b, here) if _refers(b.value) else b.value for b in bindings))
        case value:
            return value


def _refers(value: Value) -> bool:
    if isinstance(value, ListVal):
        return any(map(_refers, value.items))
    return any(n.status is Exactness.REFERENCE for n in numbers_of(value))


def _own_point(it: Interpreter, binding: PassedBinding, point: PointVal, here: Structure) -> PointVal:
    """Makes a point of the instance where, in its frame, the argument is at the first guesses."""
    if _refers(point):
        written = certain(as_written(point), PointVal)
        point = certain(as_written(convert_point(written, binding.holder, here)), PointVal)
    return positions(it, [point], here, [binding.name])[0]


def _hold_equal(it: Interpreter, binding: PassedBinding, pairs: list[tuple[Num, Num]]) -> None:
    comparisons, span = equated(it, pairs, binding.node), it.place(binding.node)
    if comparisons and span is not None:
        text = f"{binding.instance.name}.{binding.name} == {span.text}"
        it.add_constraint(Constraint(binding.holder, comparisons, text, span))


def not_built(it: Interpreter, node: ast.Name, branch: ast.If) -> Value:
    test = branch.test.span.one_line
    message = f"`{node.text}` was not built, because of `if {test}`"
    hint = f"mention it only where it is built: under the same `if {test}`"
    other = Label(branch.test.span, "this branch was not taken")
    return it.report("E0514", message, node, label="mentioned here", hints=[hint], secondary=[other])


def read(it: Interpreter, binding: NameBinding, node: ast.Node, env: Env) -> Value:
    """Returns the value of a name for the expression that reads it."""
    reader = _READERS.get(type(binding))
    return binding if reader is None else reader(it, binding, node, env)  # type: ignore[return-value]


def _read_let(it: Interpreter, let: LetBinding, node: ast.Node, env: Env) -> Value:
    if let.known is not None:
        return let.known
    if (seen := let.seen.get((env.here, env.reach))) is not None:
        return seen
    if let.running:
        return it.report("E0207", f"`{node.span.text}` is defined by way of itself", node)
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
    value = read(it, copied.binding, node, Env(certain(source.scope, Scope), source.owner))
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
        case Num() | PointVal():
            return all(n.expression.is_constant for n in numbers_of(value))
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
    names = certain(s.scope, Scope).values
    if (key := find(name, names)) is not None:
        binding = names[key]
        value = read(it, binding, node, env)
        # Points kept as they are (`origin`, an argument, a list) are in the structure's own frame.
        is_own = isinstance(binding, PointVal | ListVal | PassedBinding)
        return curves.translate(key, value, s, env.here) if is_own else value
    if fold(name) == ROTATION and s.parent is not None:
        return _rotation(it, s, s.parent, node, env)
    box = boxes.box_of(s, env.here)
    return _box_field(it, box, name, node, env) if box else None


def _rotation(it: Interpreter, s: Structure, around: Structure, node: ast.Node, env: Env) -> Value:
    turn = curves.translate("angle", Num(s.frame.rotation, ANGLE, Exactness.REFERENCE), around, env.here)
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
        if (value := curves.field(g, key, env.here)) is not None:
            return value if reached else as_written(value)
    box = boxes.box_of(g, env.here)
    return _box_field(it, box, name, node, env) if box else None


def _shape_member(it: Interpreter, g: Geometry, key: str, node: ast.Node, env: Env) -> Value:
    """Returns a part, argument or let of a compound shape: read in its owner's frame, seen from here."""
    scope = certain(g.scope, Scope)
    value = read(it, scope.values[key], node, Env(scope, g.owner))
    value = curves.translate(key, value, g.owner, env.here)
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
    value: Value | None = box.field(key) if key is not None else None
    if value is None:
        return None
    if env.reach is Reach.ABOVE:
        if any(isinstance(s, Structure) and env.here.is_within(s) for s in box.sources):
            env = Env(env.scope, env.here)  # it follows from what is made here
        else:
            # over the unknowns of what is in it by now
            value = with_numbers(value, lambda n: replace(n, expression=boxes.spelled_out(n.expression)[0]))
    if env.reach is Reach.OWN and env.here in box.sources:
        return as_written(value) if it.watched else _refuse_own_box(it, node, env)
    owners = (s if isinstance(s, Structure) else getattr(s, "bound_to", None) for s in box.sources)
    reached = all(may_read(it, owner, node, env) for owner in owners if owner is not None)
    return value if reached else as_written(value)


def _refuse_own_box(it: Interpreter, node: ast.Node, env: Env) -> Value:
    text, here = node.span.text, env.here.path
    message = f"geometry of `{here}` cannot use `{text}`, which follows from the geometry of `{here}`"
    guess = "write a first guess here and say the relation as a constraint"
    hint = f"take the box of a geometry, as `outline.bb`, or {guess}"
    return it.report("E0401", message, node, label="the box that this geometry is in", hints=[hint])


def no_index(it: Interpreter, node: ast.Index, known: list[int], wanted: int) -> Value:
    name = node.value.span.text
    is_run = bool(known) and known[-1] - known[0] == len(known) - 1
    listed = f"{known[0]} to {known[-1]}" if is_run or len(known) > 8 else ", ".join(map(str, known))
    has = f"its indices are {listed}" if known else "it is empty"
    by_place = isinstance(node.index, ast.Number) and 0 <= wanted < len(known)
    meant = f"{known[wanted]}" if by_place else ""
    hint = f"members have the indices they were given: in order, number {wanted} is `{name}[{meant}]`"
    fix = Fix(f"write `{name}[{meant}]`", (Edit(node.index.span, meant),)) if by_place else None
    message, hints = f"`{name}` has no member {wanted}: {has}", [hint] if by_place else ()
    return it.report("E0503", message, node.index, hints=hints, fix=fix)


# --- Knobs: a `param` with its range, its value from the program or from outside.

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-z]*)\s*")
_RANGE_SLACK = 1e-9
_UNITS: dict[units.MaybeDimension, str] = {units.ANGLE: "deg", units.LENGTH: "mm"}


def knob_path(structure: Structure, name: str) -> str:
    """Returns the path by which a param is set from outside: from the root, without the root's own name."""
    below = structure.path.partition(".")[2] if structure.parent is not None else ""
    return f"{below}.{name}" if below else name


def read_param(it: Interpreter, binding: ParamBinding, node: ast.Node) -> Value:
    """Returns the value of a knob: evaluated, checked against its range and registered on first use."""
    if binding.known is None:
        if binding.running:
            return it.report("E0207", f"param `{binding.node.name.text}` is defined by way of itself", node)
        binding.running = True
        binding.known = _evaluate(it, binding)
        binding.running = False
    return binding.known


def _evaluate(it: Interpreter, binding: ParamBinding) -> Value:
    node = binding.node
    env = Env(binding.scope, binding.structure)
    written = it.evaluate(node.value, env)
    if isinstance(written, Num):
        known = constant(it, written, node.value, "the value of a `param`")
        written = number(known, written.dimension) if known is not None else NOTHING
    elif not isinstance(written, TextVal | bool | Nothing):
        it.report("E0314", f"a `param` is a number, a text or true/false, not {kind_of(written)}", node.value)
        return NOTHING
    domain = it.evaluate(node.domain, env) if node.domain is not None else None
    step = it.evaluate(node.step, env) if node.step is not None else None
    if isinstance(written, Nothing) or isinstance(domain, Nothing):
        return NOTHING
    low, high, choices = _domain(it, domain, node)
    path = knob_path(binding.structure, node.name.text)
    value = _from_outside(it, path, written)
    counts = node in it.program.counts and _is_whole(written)
    if counts and not _is_whole(value):
        message = f"`{path}` is {literal(_plain(value))} as set from outside, and it counts something"
        it.report("E0909", message, node.name, label="a whole number", hints=["give a whole number"])
        value = written
    if counts and low is not None and high is not None:
        low, high = math.ceil(low), math.floor(high)
    where = "written" if value is written else "set from outside"
    if not _is_allowed(value, low, high, choices):
        words = " or ".join(map(literal, choices))
        allowed = words if low is None or high is None else f"{low:g}..{high:g}"
        code = "E0505" if value is written else "E0909"
        message = f"`{path}` is {literal(_plain(value))} as {where}, outside its range {allowed}"
        place, fix = (node.value, _unit_of_range(node)) if value is written else (node.name, None)
        hint = f"give a value in {allowed}, or widen the range of the `param`"
        it.report(code, message, place, label=f"allowed: {allowed}", hints=[hint], fix=fix)
    unit = _UNITS.get(value.dimension, "") if isinstance(value, Num) else ""
    pace = step.value if isinstance(step, Num) else 1.0 if counts and not choices else None
    it.knobs.append(Knob(path, _plain(value), low, high, choices, pace, unit, node.doc, node.span))
    return Num(value.expression, value.dimension, Exactness.PARAM) if isinstance(value, Num) else value


def _is_whole(value: Value) -> bool:
    return isinstance(value, Num) and value.dimension is None and value.value.is_integer()


def _unit_of_range(node: ast.Param) -> Fix | None:
    """Returns the fix that writes `8m in 6..14` as `8m in 6m..14m`; None if the range would not hold."""
    match node.value, node.domain:
        case ast.Number(unit=str() as unit), ast.Range(
            ast.Number(unit=None) as low, ast.Number(unit=None) as high
        ):
            if low.value <= node.value.value <= high.value:
                ends = [Span(end.span.source, end.span.end, end.span.end) for end in (low, high)]
                return Fix(f"write the range in {unit} too", tuple(Edit(end, unit) for end in ends))
    return None


def _plain(value: Value) -> float | str | bool:
    if isinstance(value, Num | TextVal):
        return value.value
    assert isinstance(value, bool)
    return value


def _domain(
    it: Interpreter, domain: Value | None, node: ast.Param
) -> tuple[float | None, float | None, tuple[float | str | bool, ...]]:
    if domain is None:
        return None, None, ()
    if isinstance(domain, RangeVal):
        return domain.start.value, domain.end.value, ()
    items = members(domain)
    if items is None or not all(isinstance(i, Num | TextVal | bool) for i in items):
        if node.domain is not None:
            it.misfit(rules.no_domain(type_of(domain)), node.domain)
        return None, None, ()
    return None, None, tuple(_plain(i) for i in items)


def _is_allowed(
    value: Value, low: float | None, high: float | None, choices: tuple[float | str | bool, ...]
) -> bool:
    if choices:
        return _plain(value) in choices
    if low is None or high is None:
        return True
    slack = _RANGE_SLACK * max(1.0, abs(low), abs(high))
    return isinstance(value, Num) and low - slack <= value.value <= high + slack


def _from_outside(it: Interpreter, path: str, written: Value) -> Value:
    """Returns the value set for a path with `-D path=value` or `compile(params=…)`, else the written one."""
    names = {fold(path), fold(f"{it.root.name if it.root else ''}.{path}")}
    key = next((key for key in it.overrides if fold(key.strip()) in names), None)
    if key is None:
        return written
    it.used_overrides.add(key)
    given = it.overrides[key]
    if (value := _parse(given, written)) is None:
        other = "true or false" if isinstance(written, bool) else "a number"
        kind = "a text" if isinstance(written, TextVal) else other
        it.report("E0910", f"`{key}={given}` does not fit: `{path}` is {kind}", None)
        return written
    return value


def _parse(given: str | float | bool, written: Value) -> Value | None:
    match written:
        case TextVal():
            return TextVal(_unquoted(given.strip())) if isinstance(given, str) else None
        case bool():
            word = str(given).strip().casefold()
            return {"true": True, "false": False, "1": True, "0": False}.get(word)
        case Num(dimension=dimension):
            if isinstance(given, bool):
                return None
            if isinstance(given, int | float):
                return number(float(given), dimension) if ex.is_number(given) else None
            if (matched := _NUMBER.fullmatch(given)) is None:
                return None
            factor, unit = UNITS.get(matched[2], (1.0, None))
            if matched[2] and (unit is None or dimension not in (None, unit)):
                return None
            value = float(matched[1]) * factor
            return number(value, dimension) if ex.is_number(value) else None
        case _:
            return None


def _unquoted(text: str) -> str:
    """Returns a text without the quotes around it; one that it has on one side alone is a part of it."""
    is_quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "\"'"
    return text[1:-1] if is_quoted else text


def report_unused(it: Interpreter) -> None:
    """Reports values set from outside that no param takes."""
    paths = [knob.path for knob in it.knobs]
    for key in it.overrides:
        if key not in it.used_overrides:
            like = nearest(key, paths)
            hints = did_you_mean(like[:1])
            known = first_few(ticked(paths), 12, "") or "none"
            hints.append(f"params of this program: {known}")
            it.report("E0911", f"there is no param `{key}`", None, hints=hints)
