"""Calls: the parameters of the chosen definition are bound, and its body is run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from aidl_lang.building.boxes import box_of
from aidl_lang.building.coerce import all_within, as_point, edge_coordinate, items_of, owners_of
from aidl_lang.building.construct import CONSTRUCTORS, construct, positions, refuses_measure, size, turn
from aidl_lang.building.curves import ask_to_turn, is_of_directions
from aidl_lang.building.evaluate import evaluate, truth, turns
from aidl_lang.building.functions import FUNCTIONS
from aidl_lang.building.model import Condition, Geometry, all_parts, reach_of
from aidl_lang.building.outlines import remember, usable
from aidl_lang.building.overloads import CallSite, arranged, candidates_of, no_overload, placing, site_of
from aidl_lang.building.state import (
    Ahead,
    Arguments,
    Candidate,
    Env,
    Interpreter,
    LetBinding,
    ParamBinding,
    Reach,
    Scope,
)
from aidl_lang.building.values import (
    NOTHING,
    Array,
    Instantiation,
    ListVal,
    Namespace,
    Nothing,
    Num,
    PointVal,
    RangeVal,
    RecordVal,
    Value,
    certain,
    members,
    numbers_of,
    spliced,
)
from aidl_lang.building.wording import all_of
from aidl_lang.checking.builtins import COPYING
from aidl_lang.checking.library import signature
from aidl_lang.checking.rules import blocks
from aidl_lang.checking.types import (
    ANY,
    Binding,
    BoxType,
    ListType,
    NumberType,
    PointType,
    Signature,
    TruthType,
    Type,
)
from aidl_lang.syntax import ast


def call(it: Interpreter, node: ast.Call, env: Env) -> Value:
    """Returns the value of `f(…)` or `a.f(…)`."""
    receiver: Value | None = None
    if node.receiver is not None:
        receiver = evaluate(it, node.receiver, env)
        if isinstance(receiver, Nothing):
            return NOTHING
    if not (candidates := candidates_of(it, node, env.scope, receiver)):
        return NOTHING  # reported by the checker, or its file could not be imported
    site = site_of(it, node, candidates)
    around, env = env, _env_of_arguments(site, env)
    given, nodes = _given(it, site, receiver, node, env)
    if Nothing in map(type, given):
        return NOTHING
    if env.reach is not around.reach is Reach.ABOVE and not all_within(it, given, node, env):
        return NOTHING  # it came as an argument of a function
    if site.makes_outline:
        candidates = usable(candidates, given, env)
        site = site_of(it, node, candidates)
    chosen, given = site.reading(given)
    if isinstance(chosen, list):
        no_overload(it, node, chosen, nodes, given)
        return NOTHING
    candidate = candidates[site.signatures.index(chosen.signature)]
    values, nodes = arranged(chosen, given, nodes)
    if (arguments := bound(it, chosen, values, nodes, env)) is None:
        return NOTHING
    if (edit := it.edits.get(node)) is not None:
        arguments = edit(chosen, arguments)
    if not it.enter(node, candidate.signature.node):
        return NOTHING
    try:
        result = invoke(it, candidate, arguments, chosen, values, node, env)
        remember(result, candidate.signature.name, arguments)
        # What is derived may follow what is out of reach; a point or a number that does must not get further.
        return result if not site.derives or all_within(it, (result,), node, around) else NOTHING
    finally:
        it.leave()


def _env_of_arguments(site: CallSite, env: Env) -> Env:
    """Returns the environment of a call's arguments, which may reach further or less far than around it."""
    if env.reach is Reach.OWN and site.instantiates:
        # References passed to a template are tied by its instantiating structure, which may reach further.
        return env.reaching(Reach.SUBTREE)
    if env.reach is Reach.OWN and (site.derives or site.connects):
        return env.reaching(Reach.ABOVE)
    return env.reaching(Reach.OWN) if env.reach is Reach.ABOVE and site.draws and not site.connects else env


def _given(
    it: Interpreter, site: CallSite, receiver: Value | None, node: ast.Call, env: Env
) -> tuple[list[Value], Sequence[ast.Node]]:
    """Returns the arguments of a call, its receiver among them, and the text each comes from."""
    given = [evaluate(it, at, env) if word is None else word for at, word in site.written]
    if receiver is None or node.receiver is None or isinstance(receiver, Namespace):
        return given, site.nodes
    return [receiver, *given], (node.receiver, *site.nodes)


def bound(
    it: Interpreter, binding: Binding, values: Sequence[Value], nodes: Sequence[ast.Node], env: Env
) -> dict[str, Value] | None:
    """Returns parameter → argument, each as the kind of value the parameter asks for; None after an error."""
    result: dict[str, Value] = {}
    signature = binding.signature
    for name, kind, indices in binding.taken:
        if name == binding.gathered:
            result[name] = ListVal(tuple(item for i in indices for item in spliced(values[i])))
            continue
        at = nodes[indices[0]]
        if (value := _as_kind(it, values[indices[0]], kind, at, env)) is None:
            return None
        is_flag = isinstance(kind, TruthType) and (signature.kind is None or name == "rotatable")
        if is_flag and isinstance(value, Condition):  # decides how something is made, so it has to be known
            value = truth(it, value, at)
        if signature.name in COPYING and any(refuses_measure(it, n, at.span) for n in numbers_of(value)):
            return None
        result[name] = value
    if signature.takes_any:
        result |= {name: values[indices[0]] for name, indices in binding.arguments.items()}
    return result


def _as_kind(it: Interpreter, value: Value, kind: Type, node: ast.Node, env: Env) -> Value | None:
    """Returns an argument as the kind of value that its parameter asks for; other kinds stay as they are."""
    match kind:
        case NumberType(dimension=dimension) if isinstance(value, Num):
            same = value.dimension == dimension
            return value if same else Num(value.expression, dimension, value.status)
        case NumberType() if isinstance(value, Geometry):
            return edge_coordinate(it, value, node, env)
        case PointType():
            return as_point(it, value, node, env)
        case BoxType():
            return box_of(value, env.here)
        case ListType(element=PointType()) if (items := members(value)) is not None:
            points = [as_point(it, item, node, env) if isinstance(item, ListVal) else item for item in items]
            return ListVal(tuple(p for p in points if p is not None))
        case ListType() if isinstance(value, Array | RangeVal):
            held = items_of(it, value, node)
            return ListVal(tuple(held)) if held is not None else None
        case _:
            return value


def invoke(
    it: Interpreter,
    candidate: Candidate,
    arguments: Arguments,
    binding: Binding,
    values: Sequence[Value],
    node: ast.Call,
    env: Env,
) -> Value:
    definition = candidate.signature.node
    match definition:
        case None:
            name = candidate.signature.name
            if name in CONSTRUCTORS:
                return construct(it, name, arguments, node, env)
            return FUNCTIONS[name](it, arguments, node, env)
        case ast.FunctionDefinition():
            inner = _inside(it, candidate, arguments, definition.parameters, env)
            return evaluate(it, definition.value, inner)
        case ast.ConstraintDefinition():
            inner = _inside(it, candidate, arguments, definition.parameters, env)
            condition = run_items(it, definition.body, inner)
            if condition is True and binding.gathered and len(values) == len(binding.arguments) == 1:
                _says_nothing(it, node, values[0])
            condition = placing(condition, binding, values, env)
            is_stated = env.reach is Reach.SUBTREE and it.place(node) is node.span  # not by the library
            if is_of_directions(candidate.signature) and is_stated:
                ask_to_turn(condition.comparisons() if isinstance(condition, Condition) else ())
            return condition
        case ast.ShapeDefinition():
            return _shape(it, candidate, arguments, node, env)
        case ast.Structure():
            return Instantiation(candidate.signature, candidate.scope, definition, arguments, node)


def _inside(
    it: Interpreter, candidate: Candidate, arguments: Arguments, parameters: Sequence[ast.Parameter], env: Env
) -> Env:
    """Returns the environment of the body of a definition: its parameters, with what they get."""
    inner = env.within(Scope(candidate.scope))
    for parameter, (name, kind, _) in zip(parameters, candidate.signature.parameters, strict=True):
        value = arguments.get(name)
        inner.scope.values[name] = default_of(it, parameter, kind, inner) if value is None else value
    return inner


def default_of(it: Interpreter, parameter: ast.Parameter, kind: Type, env: Env) -> Value:
    """Returns the default of a parameter that got no argument, in the scope of the definition."""
    if parameter.default is None:
        return NOTHING
    value = evaluate(it, parameter.default, env)
    converted = _as_kind(it, value, kind, parameter.default, env) if not isinstance(value, Nothing) else value
    return converted if converted is not None else NOTHING


def run_items(it: Interpreter, block: ast.Block, env: Env) -> Value:
    """Returns the items of a constraint's body as one condition."""
    scope = env.scope
    named = (s for s in block.statements if isinstance(s, ast.Let | ast.Assign))
    scope.values |= {s.name.text: LetBinding(s.value, scope) for s in named}
    found: list[Value] = []
    for statement in block.statements:
        match statement:
            case ast.ExpressionStatement(value=value):
                found.append(evaluate(it, value, env))
            case ast.Equation():
                if not any(d.code == "N0501" and d.span == statement.span for d in it.diagnostics):
                    it.report("N0501", "`=` inside `constraint` is read as `==`", statement)
                found.append(evaluate(it, statement.meant, env))
            case ast.Constrain(items=items):
                found.append(run_items(it, items, env))
            case ast.For(body=body):
                found += [run_items(it, body, turn) for turn in turns(it, statement, env) or ()]
            case ast.If(test=test, then=then, otherwise=otherwise):
                chosen = then if truth(it, evaluate(it, test, env), test) else otherwise
                if chosen is not None:
                    found.append(run_items(it, chosen, env))
            case ast.Let() | ast.Assign():
                pass
            case _:
                message = "a constraint's body holds conditions, `let`, `for` and `if` only"
                it.report("E0312", message, statement)
    return all_of(found)


def _says_nothing(it: Interpreter, node: ast.Call, only: Value) -> None:
    """Reports a relation of several things that gets one; not of a list of one, since its length may vary."""
    if members(only) is None:
        message = f"`{node.span.one_line}` says nothing: it relates two things or more"
        hint = f"name what it is related to, as in `{node.callee.text}(a, b)`"
        it.report("E0343", message, node, hints=[hint])


def _shape(it: Interpreter, candidate: Candidate, arguments: Arguments, node: ast.Call, env: Env) -> Value:
    definition = certain(candidate.signature.node, ast.ShapeDefinition)
    it.count_entity(node)
    geometry = Geometry(definition.name.text, env.here, it.place(node))
    scope = Scope(candidate.scope, geometry)
    geometry.scope = scope
    geometry.arguments = tuple(name for name, _, _ in candidate.signature.parameters)
    given = dict(arguments)
    pairs = zip(definition.parameters, candidate.signature.parameters, strict=True)
    for parameter, (name, kind, _) in pairs:
        if name not in given:
            scope.values.update(given)  # a default may mention the parameters before it
            given[name] = default_of(it, parameter, kind, env.within(scope))
        if isinstance(given[name], Nothing):
            return NOTHING
    _bind_shape(it, candidate.signature, given, geometry)
    run_block(it, definition.body.statements, Env(scope, env.here))
    _bind_above(it, geometry, given, env)
    return geometry


def _bind_above(it: Interpreter, geometry: Geometry, given: Arguments, env: Env) -> None:
    """Binds a shape, with all its parts, to the structure that holds all that its arguments refer to."""
    if env.reach is not Reach.ABOVE:
        return
    owners = (owner for value in given.values() for owner in owners_of(value, env.here))
    if (reach := reach_of(owners, env.here)) is None:
        return
    for g in (geometry, *all_parts(geometry)):
        g.reach = reach
        it.following.append(g)


def _bind_shape(it: Interpreter, signature: Signature, given: Arguments, geometry: Geometry) -> None:
    """Binds number and point arguments to one unknown each (or what they refer to); the rest is constant."""
    # A point given by itself comes before those in lists: it is where an outline begins.
    order = sorted(given.items(), key=lambda item: not isinstance(item[1], PointVal))
    points = [found for name, value in order for found in _points_in(name, value)]
    placed = positions(it, [p for _, p in points], geometry, [n for n, _ in points])
    moved = dict(zip((n for n, _ in points), placed, strict=True))
    parameters = certain(signature.node, ast.ShapeDefinition).parameters
    for parameter, (name, kind, _) in zip(parameters, signature.parameters, strict=True):
        value = given[name]
        if isinstance(value, Num) and parameter.type and parameter.type.text == "turn":
            value = turn(it, value, geometry, name, rotatable=given.get("rotatable") is True)
        elif isinstance(value, Num):
            value = _bind_number(it, value, kind, name, geometry)
        else:
            value = _bind_inside(it, value, name, moved, geometry)
        certain(geometry.scope, Scope).values[name] = value


def _bind_number(it: Interpreter, value: Num, kind: Type, name: str, geometry: Geometry) -> Num:
    if isinstance(kind, NumberType) and kind.whole:
        return value
    dimension = kind.dimension if isinstance(kind, NumberType) else value.dimension
    bound = size(it, value, geometry, name, dimension)
    payload = bound.expression.payload
    if kind == ANY and value.expression.is_constant and hasattr(payload, "cell"):
        payload.cell = True
    return bound


def _points_in(name: str, value: Value) -> Iterator[tuple[str, PointVal]]:
    """Yields the points of an argument with their paths, those in lists and records too."""
    match value:
        case PointVal():
            yield name, value
        case ListVal(items):
            for i, item in enumerate(items):
                yield from _points_in(f"{name}[{i}]", item)
        case RecordVal(fields):
            for key, item in fields.items():
                yield from _points_in(f"{name}.{key}", item)


def _bind_inside(
    it: Interpreter, value: Value, name: str, moved: Mapping[str, PointVal], geometry: Geometry
) -> Value:
    """Returns an argument that is no number: points as placed, numbers in records (not in lists) as sizes."""
    match value:
        case PointVal():
            return moved[name]
        case ListVal(items) if any(isinstance(i, PointVal | ListVal | RecordVal) for i in items):
            inner = (_bind_inside(it, v, f"{name}[{i}]", moved, geometry) for i, v in enumerate(items))
            return ListVal(tuple(inner))
        case RecordVal(fields):
            bound: dict[str, Value] = {}
            for k, v in fields.items():
                if isinstance(v, Num):
                    bound[k] = _bind_number(it, v, ANY, f"{name}.{k}", geometry)
                else:
                    bound[k] = _bind_inside(it, v, f"{name}.{k}", moved, geometry)
            return RecordVal(bound)
        case _:
            return value


# --- Bodies: the declarations that hold in the whole of one, and its statements one by one.


def run_block(it: Interpreter, statements: Sequence[ast.Statement], env: Env) -> None:
    """Runs the statements of a body. Callables and constants are visible in the whole of it."""
    hoist_callables(it, env.scope, statements)
    hoist_values(env, statements)
    ahead = Ahead(statements, env)
    it.ahead.append(ahead)
    try:
        for ahead.next, statement in enumerate(statements, start=1):
            _execute(it, statement, env)
    finally:
        it.ahead.pop()


def hoist_callables(it: Interpreter, scope: Scope, statements: Iterable[ast.Statement]) -> None:
    for node in statements:
        if isinstance(node, ast.Alias):
            scope.aliases[node.name.text] = node.target.text
        elif ast.is_definition(node):
            if node not in it.signatures:
                it.signatures[node] = signature(node)
            scope.define(Candidate(it.signatures[node], scope))


def hoist_values(env: Env, statements: Iterable[ast.Statement]) -> None:
    scope = env.scope
    for node in statements:
        match node:
            case ast.Let():
                scope.values.setdefault(node.name.text, LetBinding(node.value, scope))
            case ast.Param():
                scope.values.setdefault(node.name.text, ParamBinding(node, scope, env.here))


def _execute(it: Interpreter, node: ast.Statement, env: Env) -> None:
    """Carries out a statement; definitions were hoisted and do nothing here."""
    if (run := it.executors.get(type(node))) is None:
        return
    it.check_time(node)
    try:
        run(it, node, env)
    except RecursionError:
        it.too_deep(node)


def declared_names(block: ast.Block, *, indexed: bool = False) -> Iterator[str]:
    """Yields the names that a block gives to geometry and structures; if `indexed`, those with an index."""
    for node in block.statements:
        match node:
            case ast.Assign() | ast.Structure(parameters=None):
                if node.indices or not indexed:
                    yield node.name.text
            case ast.Var() if not indexed:
                yield node.name.text
            case ast.For() | ast.If():
                for inner in blocks(node):
                    yield from declared_names(inner, indexed=indexed)
