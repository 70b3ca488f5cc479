"""Calls: a definition is chosen among the overloads of a name, its parameters are bound, its body is run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from aidl_lang.building.boxes import box_of
from aidl_lang.building.coerce import all_within, as_point, edge_coordinate, items_of, owners_of
from aidl_lang.building.construct import CONSTRUCTORS, construct, positions, refuses_measure, size, turn
from aidl_lang.building.curves import ask_to_turn, is_of_directions
from aidl_lang.building.evaluate import evaluate, run_block, stated, truth
from aidl_lang.building.functions import FUNCTIONS
from aidl_lang.building.model import Condition, Geometry, all_parts, reach_of
from aidl_lang.building.outlines import remember, usable
from aidl_lang.building.state import Arguments, Candidate, Env, Interpreter, Reach, Scope
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
    TextVal,
    Value,
    certain,
    kind_of,
    length,
    members,
    numbers_of,
    spliced,
    type_of,
)
from aidl_lang.building.wording import all_of, replace_placed, value_unknowns
from aidl_lang.checking.binding import select
from aidl_lang.checking.builtins import (
    CONNECTING,
    COPYING,
    CUTS,
    DERIVING,
    FOLLOWED,
    OUTLINES,
    PATTERNS,
    is_word,
)
from aidl_lang.checking.imports import meant
from aidl_lang.checking.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import (
    ANY,
    PEERS,
    PUBLIC,
    ArgumentSource,
    Binding,
    BoxType,
    GeometryType,
    ListType,
    Mismatch,
    NumberType,
    PointType,
    Signature,
    StructureType,
    TruthType,
    Type,
    given_to,
    with_article,
)
from aidl_lang.common.names import fold
from aidl_lang.syntax import ast

# --- Calls: the parameters of the chosen definition are bound, and its body is run.


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
            is_of_one = binding.gathered and len(values) == len(binding.arguments) == 1
            if (
                condition is True and is_of_one and members(values[0]) is None
            ):  # the length of a list may vary
                message = f"`{node.span.one_line}` says nothing: it relates two things or more"
                hint = f"name what it is related to, as in `{node.callee.text}(a, b)`"
                it.report("E0343", message, node, hints=[hint])
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
    found: list[Value] = []
    for node, place in stated(it, block.statements, env):
        match node:
            case ast.ExpressionStatement(value=value):
                found.append(evaluate(it, value, place))
            case ast.Equation():
                it.report("N0501", "`=` inside `constraint` is read as `==`", node, once=True)
                found.append(evaluate(it, node.meant, place))
            case _:
                message = "a constraint's body holds conditions, `let`, `for` and `if` only"
                it.report("E0312", message, node)
    return all_of(found)


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


# --- Arguments arranged for a binding: a pair taken apart, two coordinates made one point.


def arranged(
    binding: Binding, values: Sequence[Value], nodes: Sequence[ast.Node]
) -> tuple[Sequence[Value], Sequence[ast.Node]]:
    """Returns the values that a binding refers to by index, and the text each comes from."""
    if not binding.sources:
        return values, nodes
    return [_value(s, values) for s in binding.sources], [nodes[s.index] for s in binding.sources]


def _value(source: ArgumentSource, values: Sequence[Value]) -> Value:
    value = values[source.index]
    if source.other is not None:
        x, y = value, values[source.other]
        if isinstance(x, Num) and isinstance(y, Num):
            return PointVal(length(x.expression, x.status), length(y.expression, y.status))
        return NOTHING
    match value:
        case PointVal(x, y) if source.part is not None:
            return (x, y)[source.part]
        case ListVal(items) if source.part is not None:
            return items[source.part]
        case _:
            return value


# --- The roles of a call's arguments: those it places and those it holds.
#
# A relation that puts one thing where another is (`above(a, b)`, `centered_in(a, b)`) holds the other. One
# over equals holds nobody by its place: the parameter type `peer` says so of one thing, and `peers` of a
# list, in the library as in a program. A list that is given as one counts as equals, too:
# `align_left(slits)`.


def placing(condition: Value, binding: Binding, values: Sequence[Value], env: Env) -> Value:
    """Returns the condition of a call with the unknowns it places. The last positional argument is held on
    the first try and those before it are placed; equals are parties of one rank. A definition that only calls
    another leaves the choice to that one (`contains` holds its first), unless it gathered the arguments that
    it passes on.
    """
    if not isinstance(condition, Condition):
        return condition
    definition = certain(binding.signature.node, ast.ConstraintDefinition)
    if equals := _equals(definition, binding, values):
        parties = tuple(frozenset(value_unknowns(value, env.here)) for value in equals)
        every = frozenset().union(*parties)
        return replace_placed(condition, every, () if _is_given_a_place(definition, binding) else parties)
    positional = [values[i] for i in binding.positional]
    if _delegates(definition) and not (binding.gathered and len(positional) > 1):
        return condition
    if len(positional) > 2 and isinstance(positional[-1], Num) and not isinstance(positional[-2], Num):
        positional.pop()  # the value that a measure is set to
    flat = [item for value in positional for item in spliced(value)] if binding.gathered else positional
    placed = flat[:-1] if len(flat) > 1 else flat
    unknowns = frozenset(u for value in placed for u in value_unknowns(value, env.here))
    return replace_placed(condition, unknowns) if unknowns else condition


def _equals(definition: ast.ConstraintDefinition, binding: Binding, values: Sequence[Value]) -> list[Value]:
    """Returns the things of one rank in a call, in the order of its arguments; none if it holds one."""
    given = binding.arguments
    peers = (p for p in definition.parameters if p.type is not None and fold(p.type.text) in PEERS)
    declared = [values[i] for parameter in peers for i in given.get(parameter.name.text, ())]
    if not declared and binding.signature.gathers and len(binding.positional) == 1:
        (only,) = given.get(binding.signature.parameters[0][0], (None,))
        declared = [values[only]] if only is not None and members(values[only]) is not None else []
    return [item for value in declared for item in spliced(value)]


def _is_given_a_place(definition: ast.ConstraintDefinition, binding: Binding) -> bool:
    """Tells whether another thing decides the place of a list, as in `spread(list, inside: box)`: then all
    are placed and there is no anchor among them.
    """
    related = {name for name, kind, _ in binding.taken if isinstance(kind, _PLACES)}
    word = definition.parameters[0].type
    return word is not None and fold(word.text) == "peers" and bool(related)


_PLACES = BoxType | PointType | GeometryType | StructureType


def _delegates(definition: ast.ConstraintDefinition) -> bool:
    only = definition.body.statements[0] if len(definition.body.statements) == 1 else None
    return isinstance(only, ast.ExpressionStatement) and isinstance(only.value, ast.Call)


# --- The choice of a definition for a call, among the overloads of its name.

_DRAWING = PATTERNS.union(PUBLIC)


class CallSite:
    """A call in the text, with what follows from the overloads of its name.

    nodes          its arguments
    written        each of them with the text it is if it is a bare word
    doubtful       the arguments, by index, that are such words and names in reach as well
    instantiates   whether an overload is a template
    makes_outline  whether the overloads are those of an outline made of others
    derives        whether they derive for good: an outline of others, or a copy
    connects       whether they follow points that may be those of other structures
    draws          whether one of them makes geometry that the solver may move
    """

    def __init__(self, node: ast.Call, signatures: list[Signature], names: Mapping[ast.Node, Symbol]) -> None:
        self.node = node
        self.signatures = signatures
        self.nodes = tuple(a.value for a in node.arguments)
        words = [i for i, a in enumerate(node.arguments) if is_word(a, signatures)]
        known = {i: names.get(self.nodes[i]) for i in words}
        self.doubtful = [i for i, s in known.items() if s is not None and s.kind is not SymbolKind.WORD]
        self.written = tuple(
            (n, TextVal(n.span.text) if i in words and i not in self.doubtful else None)
            for i, n in enumerate(self.nodes)
        )
        self.instantiates = any(s.kind is ast.Structure for s in signatures)
        self.makes_outline = bool(signatures) and signatures[0].name in OUTLINES
        self.derives = bool(signatures) and signatures[0].name in DERIVING
        self.connects = bool(signatures) and all(s.standard and s.name in CONNECTING for s in signatures)
        self.draws = any(s.kind is ast.ShapeDefinition or s.name in _DRAWING for s in signatures)
        if signatures and (followed := FOLLOWED.get(signatures[0].name)) is not None:
            self.derives = any(a.name is not None and fold(a.name.text) in followed for a in node.arguments)
        self._meanings: dict[tuple[Type, ...], Binding | list[Mismatch]] = {}

    def meaning(self, values: Sequence[Value]) -> Binding | list[Mismatch]:
        """Returns the overload that is meant. Types decide, so a choice holds whenever they come again."""
        kinds = tuple(map(type_of, values))
        if (known := self._meanings.get(kinds)) is None:
            if len(self._meanings) >= _MOST_MEANINGS:
                self._meanings.clear()
            known = self._meanings[kinds] = select(self.signatures, given_to(self.node, kinds))
        return known

    def reading(self, values: list[Value]) -> tuple[Binding | list[Mismatch], list[Value]]:
        """Returns the overload that is meant, and the arguments; a name in reach is an option at worst."""
        chosen = self.meaning(values)
        if isinstance(chosen, list) and self.doubtful:
            before = len(values) - len(self.nodes)
            worded = list(values)
            for index in self.doubtful:
                worded[before + index] = TextVal(self.nodes[index].span.text)
            if isinstance(other := self.meaning(worded), Binding):
                return other, worded
        return chosen, values


def site_of(it: Interpreter, node: ast.Call, candidates: Sequence[Candidate]) -> CallSite:
    """Returns the site of a call for overloads of its name; a body that runs again defines them anew."""
    before, known = it.sites.get(node, (None, None))
    if known is not None and before is candidates:
        return known
    signatures = [c.signature for c in candidates]
    if known is None or known.signatures != signatures:
        is_standard = node.span.source in it.library_sources and all(s.standard for s in signatures)
        if is_standard:
            known = _standard_site(node, tuple(signatures))
        else:
            known = CallSite(node, signatures, it.program.resolution.uses)
    it.sites[node] = candidates, known
    return known


@lru_cache(maxsize=4096)
def _standard_site(node: ast.Call, signatures: tuple[Signature, ...]) -> CallSite:
    return CallSite(node, list(signatures), {})


_MOST_MEANINGS = 100  # of one call; lists of every length are types of their own


def candidates_of(it: Interpreter, node: ast.Call, scope: Scope, receiver: Value | None) -> list[Candidate]:
    """Returns the callables that a call may mean at its place."""
    if isinstance(receiver, Namespace):
        inner = receiver.values.get("")
        return inner.candidates(it.spelled(node.callee)) if isinstance(inner, Scope) else []
    found = scope.candidates(it.spelled(node.callee))
    if not found or found[0].signature.name not in CUTS:
        return found
    of_context = it.program.resolution.candidates.get(node)
    signatures = [c.signature for c in found]
    wanted = meant(signatures, of_context is not None and any(s.kind is ast.Structure for s in of_context))
    return found if wanted is signatures else [c for c in found if c.signature in wanted]


def no_overload(
    it: Interpreter,
    node: ast.Call,
    misses: Sequence[Mismatch],
    nodes: Sequence[ast.Node],
    values: Sequence[Value],
) -> None:
    name = node.callee.text
    if it.place(node) is not node.span:
        # An error in the library on a pair of things is reported at the author's call, in the author's words.
        things = [v for v in values if not isinstance(v, TextVal | bool)]
        pairs = [[of for _, of, _ in m.signature.parameters] for m in misses]
        known = dict.fromkeys(" and ".join(map(with_article, of[:2])) for of in pairs if ANY not in of)
        hints = [f"it takes {', '.join(list(known)[:8])}"] if known else []
        it.refuse(node, f"it does not go with {' and '.join(map(kind_of, things))}", hints)
        return
    closest = max(misses, key=lambda m: m.argument is not None)
    at = nodes[closest.argument] if len(misses) == 1 and closest.argument is not None else node
    if len(misses) == 1:
        message, hints = f"`{name}` {closest.reason}", [f"it is called as `{closest.signature}`"]
    else:
        message = f"no `{name}` takes these arguments"
        hints = [f"`{m.signature}`: {m.reason}" for m in misses]
    it.report("E0311", message, at, hints=hints)
