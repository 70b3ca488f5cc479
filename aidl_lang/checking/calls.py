"""Calls, before anything is built: overloads that fit, facts about results, habits of other languages; the
checks of constraints and params.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.checking import builtins, rules
from aidl_lang.checking.binding import outcomes
from aidl_lang.checking.builtins import COPYING, EDITS, FINISHES, MATH, PATTERNS, PRIMITIVE, is_word
from aidl_lang.checking.complaints import meant_outside
from aidl_lang.checking.facts import CONSTANT, NOTHING_READ, UNKNOWN, Fact, Reads, joined, result
from aidl_lang.checking.resolve import made_by
from aidl_lang.checking.rules import place_before, shown
from aidl_lang.checking.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import (
    ANY,
    AnyType,
    Binding,
    GeometryType,
    ListType,
    Mismatch,
    NumberType,
    PointType,
    Signature,
    StructureType,
    TextType,
    TruthType,
    Type,
    given_to,
)
from aidl_lang.checking.units import ANGLE, PLAIN
from aidl_lang.common.diagnostics import Edit, Fix, has_errors
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference

Nodes: TypeAlias = Sequence[ast.Expression]
Facts: TypeAlias = Sequence[Fact]

# --- Calls with another meaning in other languages: squares, angles, corners and flags.


def check_habits(check: Inference, node: ast.Call, nodes: Nodes, fit: Binding) -> None:
    """Notes how a call was read if the same words mean something else in other languages."""
    _check_angles(check, node, nodes, fit)
    _check_corner(check, node, fit)
    if not fit.sources:
        return
    first = len(nodes) - len(node.arguments)
    used = {index for s in fit.sources for index in (s.index, s.other)}
    for index, argument in enumerate(node.arguments, first):
        is_true = isinstance(argument.value, ast.Boolean) and argument.value.value
        if index not in used and not is_true:
            message = f"`{shown(argument)}` says nothing: a `{node.callee.text}` is placed by its centre"
            hint = "to place a corner, constrain it, as in `plate.bottom_left == (0, 0)`"
            check.report("E0347", message, argument, hints=[hint])
    name = fit.signature.name
    if name == "square" and first == 0 and not any(a.name for a in node.arguments[:1]):
        value = node.arguments[0].value
        message = f"`{shown(node)}` is about its centre, here as everywhere"
        hint = "for one that begins at the origin: `constrain s.bottom_left == origin`"
        fix = Fix("name the size", (Edit(place_before(value), "size: "),), is_sure=True)
        check.report("N0502", message, node, hints=[hint], fix=fix)
    pair = next((s for s in fit.sources if s.other is not None and "width" in fit.signature.by_fold), None)
    if pair is not None and pair.other is not None:
        x, y = node.arguments[pair.index - first], node.arguments[pair.other - first]
        point = f"center: ({x.value.span.text}, {y.value.span.text})"
        is_both = pair.other == pair.index + 1
        both = Span(x.span.source, x.span.start, y.span.end)
        message = f"`{shown(x)}` and `{shown(y)}` are read as the centre of the `{node.callee.text}`"
        hint = "to place a corner, constrain it, as in `plate.bottom_left == (0, 0)`"
        written = Fix(f"write `{point}`", (Edit(both, point),), is_sure=True) if is_both else None
        check.report("N0503", message, x, hints=[hint], fix=written)


def _check_corner(check: Inference, node: ast.Call, fit: Binding) -> None:
    """Reports `rectangle(5, 5, 40, 20)`: a corner and a size, or four sides."""
    names = [name for name, _, _ in fit.signature.parameters]
    if fit.signature.name != "rectangle" or len(node.arguments) != 4 or "left" not in names[:1]:
        return
    if any(argument.name is not None for argument in node.arguments):
        return
    x, y, w, h = (shown(argument.value) for argument in node.arguments)
    right = f"left: {x}, bottom: {y}, width: {w}, height: {h}"
    span = Span(node.span.source, node.arguments[0].span.start, node.arguments[-1].span.end)
    message = f"`{shown(node)}` could mean a corner and a size, or four sides"
    hint = "name them: `left`, `bottom` with `width`, `height` or with `right`, `top`"
    fix = Fix(f"write `{right}`", (Edit(span, right),))
    check.report("E0344", message, node, label="say which", hints=[hint], fix=fix)


def check_unused_geometry(check: Inference) -> None:
    """Notes a `let c = circle(…)` that nothing refers to, which draws nothing by itself."""
    resolution = check.resolution
    used = {symbol for node, symbol in resolution.uses.items() if isinstance(node, ast.Name | ast.Member)}
    for symbol in resolution.symbols:
        node, scope = symbol.node, symbol.scope
        if not isinstance(node, ast.Let) or not isinstance(node.value, ast.Call) or symbol in used:
            continue
        if scope is None or not isinstance(scope.owner, ast.Structure | ast.Module):
            continue
        if made_by(node.value, scope) in (SymbolKind.GEOMETRY, SymbolKind.STRUCTURE):
            word = Span(node.span.source, node.span.start, node.name.span.start)
            message = f"`{symbol.name}` is not drawn: nothing refers to it"
            hint = f"`{symbol.name} = {shown(node.value)}` makes it a part of the drawing"
            fix = Fix("leave out `let`", (Edit(word, ""),))
            check.report("N0505", message, node.name, label="`let` only names it", hints=[hint], fix=fix)


def check_unused_params(check: Inference) -> None:
    """Notes a `param` of the program that nothing refers to; not after an error, which may hide a use."""
    resolution = check.resolution
    if has_errors([*resolution.diagnostics, *check.diagnostics]):
        return
    params = [s for s in resolution.symbols if isinstance(s.node, ast.Param)]
    used = {symbol for node, symbol in resolution.uses.items() if isinstance(node, ast.Name | ast.Member)}
    if used.issuperset(params):
        return
    unresolved = {
        node.name.text
        for module in resolution.modules
        for node in ast.walk(module)
        if isinstance(node, ast.Member) and node not in resolution.uses
    }
    for symbol in params:
        assert isinstance(symbol.node, ast.Param)
        is_own = symbol.node.span.source is resolution.main.source
        if is_own and symbol not in used and symbol.name not in unresolved:
            message = f"`{symbol.name}` is used nowhere: setting it changes nothing"
            hint = "use it where its value is meant, or leave it out"
            check.report("W0201", message, symbol.node.name, hints=[hint])


def _check_angles(check: Inference, node: ast.Call, nodes: Nodes, fit: Binding) -> None:
    """Reports numbers of radians read as degrees, and the reverse."""
    called = check.called(node)
    for index, value in enumerate(nodes):
        kind = fit.kind_of(index)
        if isinstance(kind, NumberType) and kind.dimension == ANGLE and check.called(value) == "radians":
            assert isinstance(value, ast.Call)
            inner = value.arguments[0].value
            _not_degrees(check, value, inner, "deg", f"`{shown(value)}` is a plain number")
        elif called in _TRIGONOMETRY and _is_of_module(check, node) and _is_plain(check, value):
            _not_degrees(check, value, value, "rad", f"`{shown(node)}` is read in radians elsewhere")
        elif called == "degrees" and _is_written(check, value):
            message = f"`{shown(node)}` turns radians into an angle"
            _not_degrees(check, node, value, "deg", message, is_sure=False)


_TRIGONOMETRY = ("sin", "cos", "tan")


def _not_degrees(
    check: Inference,
    place: ast.Expression,
    value: ast.Expression,
    unit: str,
    message: str,
    is_sure: bool = True,
) -> None:
    """Reports an angle without its unit: the fix puts the one that is meant behind the number."""
    text = value.span.text
    if check.fact(value).type == NumberType(ANGLE):
        right = text
    elif isinstance(value, ast.Number):
        right = text + unit
    else:
        is_one = isinstance(value, ast.Name | ast.Member | ast.Call)
        right = f"{text} * 1{unit}" if is_one else f"({text}) * 1{unit}"
    message = f"{message}; an angle is written with its unit: `{right}`"
    hint = "a number without a unit is in degrees where an angle is due"
    fix = Fix(f"write `{right}`", (Edit(place.span, right),), is_sure)
    check.report("E0348", message, place, hints=[hint], fix=fix)


def _is_of_module(check: Inference, node: ast.Call) -> bool:
    space = check.namespace(node.receiver)
    return space is not None and space.name in MATH


def _is_written(check: Inference, node: ast.Expression) -> bool:
    """Tells whether a number was written down without a unit, rather than worked out."""
    bare = check.fact(node).bare
    if isinstance(node, ast.Number):
        return not node.unit
    return bare is not None and bare.kind is SymbolKind.PARAM


def _is_plain(check: Inference, node: ast.Expression) -> bool:
    kind = check.fact(node).type
    return isinstance(kind, NumberType) and kind.dimension in (None, PLAIN)


def check_square(check: Inference, node: ast.Expression) -> None:
    """Reports `s = square(10)`, which could be a shape or a number."""
    if check.called(node) != "square" or not isinstance(node, ast.Call) or len(node.arguments) != 1:
        return
    value = node.arguments[0].value
    kind = check.fact(value).type
    text = shown(value)
    if not isinstance(check.fact(node).type, NumberType | AnyType) or node.arguments[0].name is not None:
        return
    if isinstance(kind, NumberType):
        message = f"`{shown(node)}` could mean a square of that size, or the number multiplied by itself"
        hint = f"write `square(size: {text})` for the shape, `{text} ^ 2` for the number"
        fix = Fix("make it the shape", (Edit(place_before(value), "size: "),))
        check.report("E0344", message, node, label="say which", hints=[hint], fix=fix)
    elif isinstance(kind, PointType) or (isinstance(kind, ListType) and kind.length == 2):
        from aidl_lang.checking.misfits import two_sizes

        two_sizes(check, node, node.arguments[0])


_SAME_AS_ARGUMENT = frozenset({"fixed", "guess", "written", "abs", "min", "max"})
_BUILD_TIME = frozenset({"floor", "ceil", "round"})


def call(check: Inference, node: ast.Call) -> Fact:
    """Returns the fact of `f(…)` or `a.f(…)`."""
    nodes = arguments(check, node)
    facts = [check.fact(n) for n in nodes]
    reads = frozenset().union(*(f.reads for f in facts)) if facts else NOTHING_READ
    if (candidates := check.resolution.candidates.get(node)) is None:
        return Fact(reads=reads)
    given = given_to(node, [_may_be(f.type, n) for f, n in zip(facts, nodes, strict=True)])
    found = outcomes(candidates, given)
    fits = [o for o in found if isinstance(o, Binding)]
    if not fits and (words := _words(check, node, candidates)):
        first = len(nodes) - len(node.arguments)
        worded = [replace(g, type=TextType()) if i - first in words else g for i, g in enumerate(given)]
        if fits := [o for o in outcomes(candidates, worded) if isinstance(o, Binding)]:
            facts = [Fact(TextType()) if i - first in words else f for i, f in enumerate(facts)]
            for index, word in words.items():
                check.resolution.uses[node.arguments[index].value] = Symbol(word, SymbolKind.WORD)
    if not fits:
        from aidl_lang.checking.misfits import no_overload

        no_overload(check, node, nodes, given, [o for o in found if isinstance(o, Mismatch)])
        return UNKNOWN
    fits.sort(key=lambda b: b.cost)
    check.fits[node] = fits
    check_habits(check, node, nodes, fits[0])
    _serve(check, fits, nodes, facts)
    _spell(check, node, nodes, fits)
    if (subject := next((i for i in range(len(facts)) if fits[0].parameter_of(i) == "x"), 0)) > 0:
        facts = [facts[subject], *facts]  # `mirror(about: axis, x: a)` has the type of `a`
    if len(fits) > 1 and any(isinstance(f.type, AnyType) for f in facts):
        return reduce(joined, [_result(check, fit.signature, nodes, facts, reads) for fit in fits])
    chosen = fits[0].signature
    if chosen.node is not None and (symbol := check.resolution.of_definition.get(chosen.node)) is not None:
        check.resolution.uses[node] = symbol
    return _result(check, chosen, nodes, facts, reads)


def _words(check: Inference, node: ast.Call, candidates: Sequence[Signature]) -> dict[int, str]:
    """Returns the arguments, by index, that are names in reach and could be words for an option as well."""
    named = ((i, a) for i, a in enumerate(node.arguments) if a.value in check.resolution.uses)
    return {i: a.value.span.text for i, a in named if is_word(a, candidates)}


def arguments(check: Inference, node: ast.Call) -> list[ast.Expression]:
    """Returns the arguments of a call, the receiver first."""
    nodes = [argument.value for argument in node.arguments]
    if node.receiver is None or check.namespace(node.receiver) is not None:
        return nodes
    return [node.receiver, *nodes]


def _spell(check: Inference, node: ast.Call, nodes: Nodes, fits: Sequence[Binding]) -> None:
    for index, argument in enumerate(node.arguments, len(nodes) - len(node.arguments)):
        meant = parameter_of(index, fits) if argument.name is not None else None
        if meant is not None and argument.name is not None and meant != argument.name.text:
            check.resolution.canonical[argument.name] = meant


def _may_be(kind: Type, node: ast.Expression) -> Type:
    """Returns the type of a number as whole if only its value can tell whether it is."""
    if isinstance(node, ast.Number) or not isinstance(kind, NumberType):
        return kind
    return kind if kind.dimension not in (None, PLAIN) else NumberType(kind.dimension, whole=True)


def _serve(check: Inference, fits: Sequence[Binding], nodes: Nodes, facts: Facts) -> None:
    """Notes the dimension in which bare names are used, if all overloads agree on it."""
    for index, fact in enumerate(facts):
        if fact.bare is None:
            continue
        kinds = [fit.kind_of(index) for fit in fits]
        wanted = {kind.dimension if isinstance(kind, NumberType) else None for kind in kinds}
        if len(wanted) == 1:
            check.serves(fact, wanted.pop(), nodes[index])


def _result(check: Inference, signature: Signature, nodes: Nodes, facts: Facts, reads: Reads) -> Fact:
    match signature.node:
        case None:
            return _built_in(check, signature.name, nodes, facts, reads)
        case ast.FunctionDefinition() as definition:
            return _function(check, definition, reads)
        case ast.ShapeDefinition() as definition:
            return Fact(GeometryType(definition.name.text), reads, definition)
        case ast.ConstraintDefinition():
            return Fact(TruthType(), reads)
        case definition:
            return Fact(StructureType(), NOTHING_READ, definition)


def _function(check: Inference, definition: ast.FunctionDefinition, reads: Reads) -> Fact:
    """Returns the fact of a function's expression, which reads what the expression and its arguments read."""
    if definition in check.running:
        return UNKNOWN
    check.running.add(definition)
    try:
        fact, reads_arguments = result(check, definition)
    finally:
        check.running.discard(definition)
    return replace(fact, reads=fact.reads | reads if reads_arguments else fact.reads, bare=None)


def _built_in(check: Inference, name: str, nodes: Nodes, facts: Facts, reads: Reads) -> Fact:
    if name in CONSTANT:
        reads = NOTHING_READ
    if name in _BUILD_TIME:
        for n in nodes:
            check.known(n, f"the argument of `{name}`")
        return Fact(ANY)
    if name in _SAME_AS_ARGUMENT:
        kinds = {f.type.element if isinstance(f.type, ListType) else f.type for f in facts}
        kind = kinds.pop() if len(kinds) == 1 else ANY
        one = len(facts) == 1
        return Fact(kind, reads, facts[0].of if one else None, bare=facts[0].bare if one else None)
    if name in COPYING:
        return replace(facts[0], reads=reads, place=None, bare=None)
    if name in PATTERNS:
        listed = replace(facts[0], reads=reads, place=None).listed(2 if name == "grid" else 1)
        return replace(listed, pattern=name)
    return Fact(builtins.RESULTS.get(name, ANY), reads)


def parameter_of(index: int, fits: Sequence[Binding]) -> str | None:
    """Returns the parameter that gets an argument, if all fitting overloads agree on it."""
    found = {fit.parameter_of(index) for fit in fits}
    return found.pop() if len(found) == 1 else None


_OPERATIONS = EDITS | FINISHES
"""Calls that are statements of their own: they edit the drawing, and are no conditions."""


def check_operation(infer: Inference, node: ast.Expression) -> bool:
    """Checks the arguments of an operation on geometry. Returns whether the statement is one."""
    if infer.called(node) not in _OPERATIONS:
        return False
    infer.fact(node)
    return True


def operation(infer: Inference, node: ast.Expression) -> str | None:
    """Returns the name of the operation that an expression calls; None for anything else."""
    name = infer.called(node)
    return name if name in _OPERATIONS and not isinstance(infer.fact(node).type, TruthType) else None


# --- The checks of constraints, of constants defined by way of themselves, and of params that count.


def find_cycles(infer: Inference) -> None:
    """Reports every circle of params and lets once, at the use that closes it.

    A depth-first search in text order, with a stack of its own since chains may be long.
    """
    graph = _dependences(infer)
    done: set[Symbol] = set()
    for start in graph:
        trail = [(start, iter(graph[start]))]
        places = {start: 0}
        while trail and start not in done:
            symbol, rest = trail[-1]
            target, name = next(rest, (None, None))
            if target is None or name is None:
                done.add(symbol)
                del places[symbol]
                trail.pop()
            elif target in places:
                _report(infer, [s for s, _ in trail[places[target] :]], name)
            elif target in graph and target not in done:
                places[target] = len(trail)
                trail.append((target, iter(graph[target])))


def _dependences(infer: Inference) -> dict[Symbol, list[tuple[Symbol, ast.Name]]]:
    """Returns for each param or let, but for arrays, the symbols that its value names, and where."""
    uses = infer.resolution.uses
    return {
        symbol: [
            (uses[name], name)
            for node in symbol.nodes
            if isinstance(node, ast.Let | ast.Assign | ast.Param)
            for name in ast.walk(node.value)
            if isinstance(name, ast.Name) and name in uses
        ]
        for symbol in infer.resolution.symbols
        if symbol.kind in (SymbolKind.LET, SymbolKind.PARAM) and not symbol.is_array
    }


def _report(infer: Inference, circle: list[Symbol], name: ast.Name) -> None:
    first = circle[0]
    way = f": {' → '.join(s.name for s in [*circle, first])}" if len(circle) > 1 else ""
    outside = meant_outside(first, name) if not way else None
    hint, fix = outside or ("one of them needs a value that does not depend on the others", None)
    infer.report("E0207", f"`{first.name}` is defined by way of itself{way}", name, hints=[hint], fix=fix)


# --- Params that count something: the number of an array, the end of a range that is counted through.


def counting_params(check: Inference) -> frozenset[ast.Param]:
    """Returns the params of a checked program of which only whole numbers make sense: those that come to
    where a whole number is asked for, by themselves, in sums and products, by way of a `let` or an argument.
    """
    resolution = check.resolution
    if not any(isinstance(s.node, ast.Param) for s in resolution.symbols):
        return frozenset()
    nodes = [node for module in resolution.modules for node in ast.walk(module)]
    asked = [(node, False) for node in _asked(check, nodes)]
    asked += [(end, True) for node in nodes if (end := _last(node)) is not None]
    found: set[ast.Param] = set()
    seen: set[ast.Node] = set()
    while asked:
        node, may_measure = asked.pop()
        for name in _factors(node):
            symbol = resolution.uses.get(name)
            if symbol is None or symbol.node is None or (may_measure and check.is_measured(symbol)):
                continue
            if isinstance(symbol.node, ast.Param):
                found.add(symbol.node)
            elif symbol.node not in seen:
                seen.add(symbol.node)
                if isinstance(symbol.node, ast.Let):
                    asked.append((symbol.node.value, may_measure))
                elif symbol.kind is SymbolKind.ARGUMENT:
                    asked += [(given, may_measure) for given in _given(check, symbol.node)]
    return frozenset(found)


def _asked(check: Inference, nodes: list[ast.Node]) -> Iterator[ast.Expression]:
    """Yields the expressions where nothing but a whole number is taken: indices, and arguments that are."""
    for node in nodes:
        if isinstance(node, ast.Index):
            yield node.index
        elif isinstance(node, ast.Call) and node in check.fits:
            for index, value in enumerate(arguments(check, node)):
                kinds = [kind for fit in check.fits[node] if (kind := fit.kind_of(index)) is not None]
                if kinds and all(isinstance(k, NumberType) and k.whole for k in kinds):
                    yield value


def _last(node: ast.Node) -> ast.Expression | None:
    """Returns the end of a range that is counted through from a whole number, in steps of one."""
    if isinstance(node, ast.For | ast.Comprehension):
        match node.iterable:
            case ast.Range(ast.Number(value, None), end, _, None) if value.is_integer():
                return end
    return None


def _factors(node: ast.Node) -> Iterator[ast.Node]:
    """Yields the names that an expression is a sum or a product of; it is whole if they are."""
    match node:
        case ast.Name() | ast.Member():
            yield node
        case ast.Unary(_, operand):
            yield from _factors(operand)
        case ast.Binary("+" | "-" | "*", left, right):
            for side in (left, right):
                yield from _factors(side)
        case ast.Conditional(_, then, otherwise):
            for side in (then, otherwise):
                yield from _factors(side)


def _given(check: Inference, parameter: ast.Node) -> Iterator[ast.Expression]:
    """Yields what calls give to a parameter of a definition of the program."""
    assert isinstance(parameter, ast.Parameter)
    for call, fits in check.fits.items():
        for fit in fits:
            if fit.signature.node is not None and parameter in ast.children(fit.signature.node):
                given = arguments(check, call)
                yield from (v for i, v in enumerate(given) if fit.parameter_of(i) == parameter.name.text)


# --- The checks of constraints: which expressions can constrain, and which stand in the place of one.


def check_empty(infer: Inference, node: ast.Constrain) -> None:
    """Reports a `constrain { }` without anything in it."""
    if not node.items.statements and not node.items.span.text.strip("{} \t\r\n"):
        fix = Fix("remove it", (Edit(node.span.with_separator, ""),), is_sure=True)
        infer.report("W0202", "this `constrain` holds nothing", node, fix=fix)


def check_item(infer: Inference, node: ast.Expression) -> None:
    """Reports an operation among constraints, where nothing is made and nothing edited."""
    if (name := operation(infer, node)) is not None:
        text, fix = shown(node), None
        hints = [f"`{text}` is a statement of its own, outside `constrain`"]
        if name == "rotate":
            said = _turned(infer, node)
            fix = Fix(f"write `{said}`", (Edit(node.span, said),), is_sure=True) if said else None
            example = "" if said else ": `a.angle == 30deg`, for a structure `a.rotation == 30deg`"
            hints = [f"how a thing is turned is an equation too{example}"]
        elif name in EDITS:
            hints = [
                "where a thing has to be says a relation: `a.left == b.right`, `a.above(b)`, "
                "`coincident(a.end, b.start)`",
                f"outside `constrain`, `{text}` changes what was written, and `name = {text}` makes a copy; "
                "a structure is placed by `at`",
            ]
        message = f"`{name}` constrains nothing: it changes what is drawn"
        infer.report("E0352", message, node, hints=hints, fix=fix)
        return
    check_condition(infer, node, may_make=False)


def _turned(infer: Inference, node: ast.Expression) -> str | None:
    """Returns the equation that `rotate(r, 30)` among constraints means; None for what has no angle."""
    given = arguments(infer, node) if isinstance(node, ast.Call) else []
    if len(given) not in (2, 3):
        return None
    thing, angle, *about = given
    if about and shown(about[0]) != f"{shown(thing)}.center":
        return None
    fact, field = infer.fact(thing), "angle"
    if isinstance(fact.type, StructureType):
        field = "rotation"
    elif not isinstance(fact.type, GeometryType) or not (
        infer.resolution.scope_of(fact.of).values if fact.of else PRIMITIVE.get(fact.type.kind, {})
    ).get(field):
        return None
    unit = "deg" if isinstance(angle, ast.Number) and not angle.unit else ""
    return f"{shown(thing)}.{field} == {shown(angle)}{unit}"


def check_condition(infer: Inference, node: ast.Expression, may_make: bool = True) -> None:
    """Reports an expression that cannot constrain anything; `may_make`: with a name it would be geometry."""
    fact = infer.fact(node)
    if isinstance(fact.type, TruthType):
        _check_logic(infer, node)
        return
    if isinstance(node, ast.Call):
        if infer.called(node) == "fixed":
            return  # holds a thing where it was written
        scope = infer.resolution.scopes[infer.homes[-1]]
        if made_by(node, scope) is not SymbolKind.LET:
            _needs_name(infer, node, may_make)
            return
    if isinstance(fact.type, AnyType):
        return
    infer.misfit(rules.no_condition(shown(node), fact.type), node)


def _needs_name(infer: Inference, node: ast.Call, may_make: bool) -> None:
    kind = node.callee.text
    taken = {symbol.name for symbol in infer.resolution.symbols}
    number = next(n for n in range(1, len(taken) + 2) if f"{kind}_{n}" not in taken)
    name = f"{kind}_{number}"
    remedy = "give it a name" if may_make else "make it outside `constrain`"
    message = f"this `{kind}` has no name, so nothing could refer to it"
    hint = f"{remedy}: `{name} = {shown(node)}`"
    edit = Edit(place_before(node), f"{name} = ")
    fix = Fix(f"name it `{name}`", (edit,), is_sure=True) if may_make else None
    infer.report("E0323", message, node, label="made and lost", hints=[hint], fix=fix)


def _check_logic(infer: Inference, node: ast.Expression) -> None:
    """Reports `or`, `not` and `!=` over unknowns, which leave no equation; not those over constants."""
    match node:
        case ast.Binary(operator="and", left=left, right=right):
            _check_logic(infer, left)
            _check_logic(infer, right)
        case ast.Binary(operator="or", left=left, right=right) if infer.fact(node).reads:
            hint = (
                f"constrain the one you mean, as in `constrain {shown(left)}`, or let an `if` over "
                "constants choose; `assert` takes `or`"
            )
            fix = Fix("constrain the first of them", (Edit(node.span, left.span.text),))
            infer.misfit(rules.no_equation("or", hint), node, fix)
        case ast.Unary(operator="not", operand=operand) if infer.fact(node).reads:
            hint = f"constrain what shall hold instead; `assert not {shown(operand)}` checks it"
            infer.misfit(rules.no_equation("not", hint), node)
        case ast.Comparison(operators=operators) if "!=" in operators and infer.fact(node).reads:
            hint = "say on which side, with `<=` or `>=` and a distance, or `assert` it"
            infer.misfit(rules.no_equation("!=", hint), node)
