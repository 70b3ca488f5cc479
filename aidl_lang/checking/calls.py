"""Calls, before anything is built: whether an overload fits, and what is known of the result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang import ast, units
from aidl_lang.checking import fields
from aidl_lang.checking.facts import NOTHING_READ, UNKNOWN, Fact, Place, joined
from aidl_lang.diagnostics import Edit, Fix
from aidl_lang.names import fold, nearest
from aidl_lang.resolving.symbols import SymbolKind
from aidl_lang.types import (
    ANY,
    AnyType,
    Binding,
    GeometryType,
    Given,
    ListType,
    Mismatch,
    NumberType,
    Signature,
    StructureType,
    TruthType,
    Type,
    bind,
)

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference

_SAME_AS_ARGUMENT = frozenset({"fixed", "guess", "written", "abs", "min", "max"})
_BUILD_TIME = frozenset({"floor", "ceil", "round"})
_CONSTANT = frozenset({"len", "written"})
"""What gives constants even of unknowns."""


def call(check: Inference, node: ast.Call) -> Fact:
    """The fact of `f(…)` or `a.f(…)`."""
    nodes = arguments(check, node)
    facts = [check.fact(n) for n in nodes]
    reads = frozenset().union(*(f.reads for f in facts)) if facts else NOTHING_READ
    candidates = check.resolution.candidates.get(node)
    if candidates is None:
        return Fact(reads=reads)
    given = _given(node, nodes, facts)
    outcomes = [bind(candidate, given) for candidate in candidates]
    fits = [o for o in outcomes if isinstance(o, Binding)]
    if not fits:
        _no_overload(check, node, nodes, given, [o for o in outcomes if isinstance(o, Mismatch)])
        return UNKNOWN
    fits.sort(key=lambda b: b.cost)
    _serve(check, fits, nodes, facts)
    if len(fits) > 1 and any(isinstance(f.type, AnyType) for f in facts):
        results = [_result(check, fit.signature, nodes, facts, reads) for fit in fits]
        result = results[0]
        for other in results[1:]:
            result = joined(result, other)
        return result
    chosen = fits[0].signature
    for name in (a.name for a in node.arguments if a.name is not None):
        if (spelling := chosen.by_fold.get(fold(name.text), name.text)) != name.text:
            check.resolution.canonical[name] = spelling
    if chosen.node is not None and (symbol := check.resolution.of_definition.get(chosen.node)) is not None:
        check.resolution.uses[node] = symbol
    return _result(check, chosen, nodes, facts, reads)


def arguments(check: Inference, node: ast.Call) -> list[ast.Expression]:
    """What a call is given, the receiver first."""
    nodes = [argument.value for argument in node.arguments]
    receiver = node.receiver
    if receiver is None:
        return nodes
    if isinstance(receiver, ast.Name):
        symbol = check.resolution.uses.get(receiver)
        if symbol is not None and symbol.kind is SymbolKind.NAMESPACE:
            return nodes
    return [receiver, *nodes]


def _given(node: ast.Call, nodes: Sequence[ast.Expression], facts: Sequence[Fact]) -> list[Given]:
    names = [None] * (len(nodes) - len(node.arguments)) + [
        a.name.text if a.name else None for a in node.arguments
    ]
    return [Given(name, _may_be(fact.type, n)) for name, fact, n in zip(names, facts, nodes, strict=True)]


def _may_be(kind: Type, node: ast.Expression) -> Type:
    """A number of which only its value will tell whether it is whole may be whole."""
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
    """Note which dimension bare names are used in, where all overloads agree on it."""
    for index, fact in enumerate(facts):
        if fact.bare is None:
            continue
        wanted = {_dimension_for(fit, index) for fit in fits}
        if len(wanted) == 1:
            check.serves(fact, wanted.pop(), nodes[index])


def _dimension_for(fit: Binding, index: int) -> units.MaybeDimension:
    for name, kind, _ in fit.signature.parameters:
        if index in fit.arguments.get(name, ()) and isinstance(kind, NumberType):
            return kind.dimension
    return None


def _result(
    check: Inference,
    signature: Signature,
    nodes: Sequence[ast.Expression],
    facts: Sequence[Fact],
    reads: frozenset[Place],
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


def _function(check: Inference, definition: ast.FunctionDefinition, reads: frozenset[Place]) -> Fact:
    """A function gives what its expression gives; it reads what its arguments and its expression read."""
    if definition in check.running:
        return UNKNOWN
    check.running.add(definition)
    before = check.homes
    scope = check.resolution.scope_of(definition)
    check.homes = scope.homes
    try:
        fact = check.fact(definition.value)
    finally:
        check.homes = before
        check.running.discard(definition)
    return replace(fact, reads=fact.reads | reads, bare=None)


def _built_in(
    check: Inference,
    name: str,
    nodes: Sequence[ast.Expression],
    facts: Sequence[Fact],
    reads: frozenset[Place],
) -> Fact:
    if name in _CONSTANT:
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
    return Fact(fields.RESULTS.get(name, ANY), reads)


# --- What to say of a call that no overload fits ----------------------------------------------------


def _no_overload(
    check: Inference,
    node: ast.Call,
    nodes: Sequence[ast.Expression],
    given: Sequence[Given],
    misses: Sequence[Mismatch],
) -> None:
    name = node.callee.text
    check.rejected.append(node)
    if _unknown_parameter(check, node, misses):
        return
    if _not_together(check, node, misses):
        return
    closest = max(misses, key=lambda m: _closeness(m, given))
    at: ast.Node = node.callee
    if closest.argument is not None and closest.argument < len(nodes):
        at = nodes[closest.argument]
    also = [m.signature for m in misses if m is not closest]
    hints = [f"it is called as `{closest.signature}`"]
    hints += [f"or as `{signature}`" for signature in also[:4]]
    check.report("E0311", f"`{name}` {closest.reason}", at, label=f"in this call of `{name}`", hints=hints)


def _not_together(check: Inference, node: ast.Call, misses: Sequence[Mismatch]) -> bool:
    """Report named arguments that are known to some overloads, but never all to one; whether that is so."""
    written = [a.name for a in node.arguments if a.name is not None]
    if len(written) < 2 or any(all(fold(n.text) in m.signature.by_fold for n in written) for m in misses):
        return False
    name = node.callee.text
    check.report(
        "E0311",
        f"`{name}` does not take {' and '.join(f'`{n.text}`' for n in written)} together",
        written[-1],
        label=f"in this call of `{name}`",
        hints=[f"it is called as `{m.signature}`" for m in misses[:5]],
    )
    return True


def _closeness(miss: Mismatch, given: Sequence[Given]) -> tuple[int, int, int]:
    """How near a candidate comes: named arguments that it knows, then the number of its parameters."""
    names = {fold(name) for name, _, _ in miss.signature.parameters}
    known = sum(1 for g in given if g.name is not None and fold(g.name) in names)
    room = -abs(len(miss.signature.parameters) - len(given))
    return known, int(miss.argument is not None), room


def _unknown_parameter(check: Inference, node: ast.Call, misses: Sequence[Mismatch]) -> bool:
    """Report argument names that no overload knows; whether there is one."""
    names = list(dict.fromkeys(name for m in misses for name, _, _ in m.signature.parameters))
    folded = {fold(name) for name in names}
    wrong = [a.name for a in node.arguments if a.name is not None and fold(a.name.text) not in folded]
    taken = {fold(a.name.text) for a in node.arguments if a.name is not None}
    for identifier in wrong:
        like = nearest(identifier.text, [n for n in names if fold(n) not in taken])
        free = ", ".join(f"`{n}`" for n in names)
        check.report(
            "E0324",
            f"`{node.callee.text}` has no parameter `{identifier.text}`"
            + (f"; did you mean `{like[0]}`?" if like else ""),
            identifier,
            hints=() if like else (f"its parameters are {free}" if names else "it takes no arguments",),
            fix=Fix(f"write `{like[0]}`", (Edit(identifier.span, like[0]),)) if like else None,
        )
    return bool(wrong)


def parameter_of(node: ast.Call, index: int, fits: Sequence[Binding]) -> str | None:
    """The parameter that gets an argument, if all fitting overloads agree on it."""
    found = {next((name for name, places in fit.arguments.items() if index in places), None) for fit in fits}
    return found.pop() if len(found) == 1 else None
