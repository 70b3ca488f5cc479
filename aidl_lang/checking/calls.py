"""Calls, before anything is built: overloads that fit, facts about results, habits of other languages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang.checking import builtins, units
from aidl_lang.checking.binding import outcomes
from aidl_lang.checking.builtins import COPYING, EDITS, FINISHES, MATH, PATTERNS, is_word
from aidl_lang.checking.facts import CONSTANT, NOTHING_READ, UNKNOWN, Fact, ReadPlace, joined, result
from aidl_lang.checking.resolve import made_by
from aidl_lang.checking.rules import shown
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


# --- Calls with another meaning in other languages: squares, angles, corners and flags.


def check_habits(check: Inference, node: ast.Call, nodes: Sequence[ast.Expression], fit: Binding) -> None:
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
        fix = Fix("name the size", (Edit(_before(value), "size: "),), is_sure=True)
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


def _check_angles(check: Inference, node: ast.Call, nodes: Sequence[ast.Expression], fit: Binding) -> None:
    """Reports numbers of radians read as degrees, and the reverse."""
    called = _called(check, node)
    wanted = {name: kind for name, kind, _ in fit.signature.parameters}
    for index, value in enumerate(nodes):
        kind = wanted.get(fit.parameter_of(index) or "")
        if isinstance(kind, NumberType) and kind.dimension == ANGLE and _called(check, value) == "radians":
            assert isinstance(value, ast.Call)
            inner = value.arguments[0].value
            _not_degrees(check, value, inner, "deg", f"`{shown(value)}` is a plain number")
        elif called in _TRIGONOMETRY and _is_module(check, node) and _is_plain(check, value):
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


def _called(check: Inference, node: ast.Expression) -> str | None:
    return check.called(node) if isinstance(node, ast.Call) else None


def _is_module(check: Inference, node: ast.Call) -> bool:
    receiver = node.receiver
    symbol = check.resolution.uses.get(receiver) if isinstance(receiver, ast.Name) else None
    return symbol is not None and symbol.kind is SymbolKind.NAMESPACE and symbol.name in MATH


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
    if _called(check, node) != "square" or not isinstance(node, ast.Call) or len(node.arguments) != 1:
        return
    value = node.arguments[0].value
    kind = check.fact(value).type
    text = shown(value)
    if not isinstance(check.fact(node).type, NumberType | AnyType) or node.arguments[0].name is not None:
        return
    if isinstance(kind, NumberType):
        message = f"`{shown(node)}` could mean a square of that size, or the number multiplied by itself"
        hint = f"write `square(size: {text})` for the shape, `{text} ^ 2` for the number"
        fix = Fix("make it the shape", (Edit(_before(value), "size: "),))
        check.report("E0344", message, node, label="say which", hints=[hint], fix=fix)
    elif isinstance(kind, PointType) or (isinstance(kind, ListType) and kind.length == 2):
        from aidl_lang.checking.misfits import two_sizes

        two_sizes(check, node, node.arguments[0])


def _before(node: ast.Node) -> Span:
    return Span(node.span.source, node.span.start, node.span.start)


_SAME_AS_ARGUMENT = frozenset({"fixed", "guess", "written", "abs", "min", "max"})
_BUILD_TIME = frozenset({"floor", "ceil", "round"})


def call(check: Inference, node: ast.Call) -> Fact:
    """Returns the fact of `f(…)` or `a.f(…)`."""
    nodes = arguments(check, node)
    facts = [check.fact(n) for n in nodes]
    reads = frozenset().union(*(f.reads for f in facts)) if facts else NOTHING_READ
    candidates = check.resolution.candidates.get(node)
    if candidates is None:
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
        results = [_result(check, fit.signature, nodes, facts, reads) for fit in fits]
        result = results[0]
        for other in results[1:]:
            result = joined(result, other)
        return result
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
    receiver = node.receiver
    if receiver is None:
        return nodes
    if isinstance(receiver, ast.Name):
        symbol = check.resolution.uses.get(receiver)
        if symbol is not None and symbol.kind is SymbolKind.NAMESPACE:
            return nodes
    return [receiver, *nodes]


def _spell(
    check: Inference, node: ast.Call, nodes: Sequence[ast.Expression], fits: Sequence[Binding]
) -> None:
    """Notes the parameters that argument names stand for."""
    for index, argument in enumerate(node.arguments, len(nodes) - len(node.arguments)):
        meant = parameter_of(index, fits) if argument.name is not None else None
        if meant is not None and argument.name is not None and meant != argument.name.text:
            check.resolution.canonical[argument.name] = meant


def _may_be(kind: Type, node: ast.Expression) -> Type:
    """Returns the type of a number as whole if only its value can tell whether it is."""
    if isinstance(node, ast.Number) or not isinstance(kind, NumberType):
        return kind
    if kind.dimension not in (None, PLAIN):
        return kind
    return NumberType(kind.dimension, whole=True)


def _serve(
    check: Inference, fits: Sequence[Binding], nodes: Sequence[ast.Expression], facts: Sequence[Fact]
) -> None:
    """Notes the dimension in which bare names are used, if all overloads agree on it."""
    for index, fact in enumerate(facts):
        if fact.bare is None:
            continue
        wanted = {_dimension_for(fit, index) for fit in fits}
        if len(wanted) == 1:
            check.serves(fact, wanted.pop(), nodes[index])


def _dimension_for(fit: Binding, index: int) -> units.MaybeDimension:
    taken = fit.parameter_of(index)
    for name, kind, _ in fit.signature.parameters:
        if name == taken and isinstance(kind, NumberType):
            return kind.dimension
    return None


def _result(
    check: Inference,
    signature: Signature,
    nodes: Sequence[ast.Expression],
    facts: Sequence[Fact],
    reads: frozenset[ReadPlace],
) -> Fact:
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


def _function(check: Inference, definition: ast.FunctionDefinition, reads: frozenset[ReadPlace]) -> Fact:
    """Returns the fact of a function's expression, which reads what the expression and its arguments read."""
    if definition in check.running:
        return UNKNOWN
    check.running.add(definition)
    try:
        fact, reads_arguments = result(check, definition)
    finally:
        check.running.discard(definition)
    return replace(fact, reads=fact.reads | reads if reads_arguments else fact.reads, bare=None)


def _built_in(
    check: Inference,
    name: str,
    nodes: Sequence[ast.Expression],
    facts: Sequence[Fact],
    reads: frozenset[ReadPlace],
) -> Fact:
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
    if not isinstance(node, ast.Call) or infer.called(node) not in _OPERATIONS:
        return False
    infer.fact(node)
    return True


def operation(infer: Inference, node: ast.Expression) -> str | None:
    """Returns the name of the operation that an expression calls; None for anything else."""
    if not isinstance(node, ast.Call) or isinstance(infer.fact(node).type, TruthType):
        return None
    return name if (name := infer.called(node)) in _OPERATIONS else None
