"""The choice of a definition for a call, and the roles of its arguments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

from aidl_lang.building.model import Condition
from aidl_lang.building.state import Candidate, Env, Interpreter, Scope
from aidl_lang.building.values import (
    NOTHING,
    ListVal,
    Namespace,
    Num,
    PointVal,
    TextVal,
    Value,
    certain,
    kind_of,
    length,
    members,
    spliced,
    type_of,
)
from aidl_lang.building.wording import replace_placed, value_unknowns
from aidl_lang.checking.binding import select
from aidl_lang.checking.builtins import CONNECTING, CUTS, DERIVING, FOLLOWED, OUTLINES, PATTERNS, is_word
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
    Mismatch,
    PointType,
    Signature,
    StructureType,
    Type,
    given_to,
    with_article,
)
from aidl_lang.common.names import fold
from aidl_lang.syntax import ast

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
    """Tells whether a definition consists of one call, which then decides."""
    match definition.body.statements:
        case (ast.ExpressionStatement(value=ast.Call()),):
            return True
        case _:
            return False


# --- The choice of a definition for a call, among the overloads of its name.

_NO_NAMES: Mapping[ast.Node, Symbol] = {}
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

    def __init__(
        self, node: ast.Call, signatures: list[Signature], names: Mapping[ast.Node, Symbol] = _NO_NAMES
    ) -> None:
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
        self._last: tuple[tuple[Type, ...] | None, Binding | list[Mismatch]] = (None, [])

    def meaning(self, values: Sequence[Value]) -> Binding | list[Mismatch]:
        """Returns the overload that is meant. Types decide, so a choice holds whenever they come again."""
        kinds = tuple(map(type_of, values))
        before, found = self._last
        if kinds == before:  # usually so, and types are slow to hash
            return found
        if (known := self._meanings.get(kinds)) is None:
            if len(self._meanings) >= _MOST_MEANINGS:
                self._meanings.clear()
            known = self._meanings[kinds] = select(self.signatures, given_to(self.node, kinds))
        self._last = kinds, known
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
    """Returns the site of a call within the library, which is the same for all programs."""
    return CallSite(node, list(signatures))


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
