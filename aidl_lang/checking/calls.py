"""Calls, before anything is built: the overloads that fit, and the facts about the result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang.checking import builtins, units
from aidl_lang.checking.binding import outcomes
from aidl_lang.checking.builtins import COPYING, PATTERNS, is_word
from aidl_lang.checking.facts import CONSTANT, NOTHING_READ, UNKNOWN, Fact, ReadPlace, joined, result
from aidl_lang.checking.habits import check_habits
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import (
    ANY,
    AnyType,
    Binding,
    GeometryType,
    GivenArgument,
    ListType,
    Mismatch,
    NumberType,
    Signature,
    StructureType,
    TextType,
    TruthType,
    Type,
)
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference

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
    given = _given(node, nodes, facts)
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
    return {
        i: a.value.span.text
        for i, a in enumerate(node.arguments)
        if a.value in check.resolution.uses and is_word(a, candidates)
    }


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


def _given(node: ast.Call, nodes: Sequence[ast.Expression], facts: Sequence[Fact]) -> list[GivenArgument]:
    names = [None] * (len(nodes) - len(node.arguments)) + [
        a.name.text if a.name else None for a in node.arguments
    ]
    return [
        GivenArgument(name, _may_be(fact.type, n)) for name, fact, n in zip(names, facts, nodes, strict=True)
    ]


def _may_be(kind: Type, node: ast.Expression) -> Type:
    """Returns the type of a number as whole if only its value can tell whether it is."""
    if (
        isinstance(kind, NumberType)
        and kind.dimension in (None, units.PLAIN)
        and not isinstance(node, ast.Number)
    ):
        return NumberType(kind.dimension, whole=True)
    return kind


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
