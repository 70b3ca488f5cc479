"""Conditions, and statements that constrain, kept to be read again in parts and in numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TypeAlias, TypeVar

from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import box_of, boxes_in, source_unknowns, spelled_out
from aidl_lang.building.coerce import as_point, numeric
from aidl_lang.building.expression import Expression, Unknown
from aidl_lang.building.model import Comparison, Condition, Geometry, Part, Structure
from aidl_lang.building.state import Env, Interpreter, Stop
from aidl_lang.building.values import (
    NOTHING,
    Array,
    ListVal,
    Nothing,
    Num,
    PointVal,
    TextVal,
    Value,
    certain,
    leaves,
    members,
    numbers_of,
    type_of,
)
from aidl_lang.checking import rules, units
from aidl_lang.checking.rules import shown
from aidl_lang.checking.symbols import SymbolKind
from aidl_lang.checking.units import ANGLE
from aidl_lang.common.diagnostics import Label
from aidl_lang.common.prose import short
from aidl_lang.common.records import record
from aidl_lang.common.running import limited_to
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

# --- Conditions: comparing values, joining comparisons, and testing whether a condition holds.

T = TypeVar("T")
Evaluate = Callable[[Expression], float]

RELATIONS = ("==", "<=", ">=", "<", ">")
"""Relations that can constrain; `!=` can only be asserted or tested."""

EXACT = 1e-9
"""The part of their size by which constants may differ and still count as equal."""


def compare(
    it: Interpreter,
    relation: str,
    left: Value,
    right: Value,
    node: ast.Node,
    env: Env,
    sides: Sequence[ast.Node],
) -> Value:
    """Returns `left relation right`, a truth if both are constants; of a list it is asked of each member. The
    `sides` are the texts that they come from.
    """

    def incomparable() -> Nothing:
        texts = map(shown, sides)
        return it.misfit(rules.no_comparison(relation, type_of(left), type_of(right), *texts), node)

    if isinstance(left, Nothing) or isinstance(right, Nothing):
        return NOTHING
    if isinstance(left, TextVal | bool) or isinstance(right, TextVal | bool):
        if relation not in ("==", "!=") or type(left) is not type(right):
            return incomparable()
        one, other = (side.value if isinstance(side, TextVal) else side for side in (left, right))
        return (one == other) == (relation == "==")
    if (pairs := _one_by_one(relation, left, right)) is not None:
        every: Value = True
        for first, second in pairs:
            pair = compare(it, relation, first, second, node, env, sides)
            every = conjunction(it, "and", every, pair, node)
        return every
    a, b = (as_point(it, v, n, env) for v, n in zip((left, right), sides, strict=True))
    if a is not None and b is not None:
        return _compare_points(it, relation, a, b, node)
    if a is not None or b is not None:
        return incomparable()
    x, y = (numeric(it, v, n, env) for v, n in zip((left, right), sides, strict=True))
    return compare_numbers(it, relation, x, y, node) if x is not None and y is not None else NOTHING


def _one_by_one(relation: str, left: Value, right: Value) -> list[tuple[Value, Value]] | None:
    """Returns the pairs that a relation with a list in it is asked of: each member and the other side, or
    those of two lists of one length in their order; None where two values compare as they are.
    """
    one, other = (members(side) if isinstance(side, ListVal | Array) else None for side in (left, right))
    if relation == "!=" or (one is None and other is None):
        return None
    if one is not None and other is not None:
        return list(zip(one, other, strict=True)) if len(one) == len(other) else None
    if one is not None:
        return None if _is_pair(one) and _is_point(right) else [(each, right) for each in one]
    assert other is not None
    return None if _is_pair(other) and _is_point(left) else [(left, each) for each in other]


def _is_pair(values: Sequence[Value]) -> bool:
    return len(values) == 2 and all(isinstance(value, Num) for value in values)


def _is_point(value: Value) -> bool:
    return isinstance(value, PointVal) or (isinstance(value, Geometry) and value.type == "point")


def _compare_points(it: Interpreter, relation: str, a: PointVal, b: PointVal, node: ast.Node) -> Value:
    if relation not in ("==", "!="):
        return it.misfit(rules.no_order(relation), node)
    both = conjunction(
        it, "and", compare_numbers(it, "==", a.x, b.x, node), compare_numbers(it, "==", a.y, b.y, node), node
    )
    return both if relation == "==" else negation(it, both, node)


def compare_numbers(it: Interpreter, relation: str, a: Num, b: Num, node: ast.Node) -> Value:
    try:
        dimension = units.add(a.dimension, b.dimension)
    except units.UnequalError as pair:
        return it.misfit(rules.unequal(f"`{relation}` does not compare", *pair.args), node)
    left, right = spelled_out(a.expression, b.expression, equal=relation == "==")
    if left.is_constant and right.is_constant:
        return _relates(relation, left.value, right.value, dimension == ANGLE, EXACT, strict=True)
    boxes, beside = boxes_in(a.expression, b.expression)
    return Condition("and", (Comparison(relation, left, right, dimension, None, boxes, beside),))


def equated(it: Interpreter, pairs: Iterable[tuple[Num, Num]], node: ast.Node) -> tuple[Comparison, ...]:
    """Returns the comparisons that hold numbers equal, pair by pair; none for constants."""
    conditions = (compare_numbers(it, "==", a, b, node) for a, b in pairs)
    return tuple(c for made in conditions if isinstance(made, Condition) for c in made.comparisons())


def _relates(relation: str, a: float, b: float, is_angle: bool, tolerance: float, *, strict: bool) -> bool:
    """Tells whether a relation holds within a tolerance; if `strict`, `<` and `>` do not hold for equals."""
    difference = a - b
    if is_angle and relation in ("==", "!="):
        difference = (difference + 180.0) % 360.0 - 180.0
    near = abs(difference) <= tolerance * max(1.0, abs(a), abs(b))
    if relation in ("==", "!="):
        return near is (relation == "==")
    if near:
        return not strict or relation in ("<=", ">=")
    return difference < 0 if relation in ("<=", "<") else difference > 0


def conjunction(it: Interpreter, operator: str, left: Value, right: Value, node: ast.Node) -> Value:
    """Returns `left and right` or `left or right`, without constants that decide nothing."""
    if isinstance(left, Nothing) or isinstance(right, Nothing):
        return NOTHING
    for side in (left, right):
        if not isinstance(side, bool | Condition):
            return it.misfit(rules.needed("a condition", type_of(side)), node)
    neutral = operator == "and"
    if left is neutral:
        return right
    if right is neutral:
        return left
    if isinstance(left, bool) or isinstance(right, bool):
        return not neutral
    left, right = certain(left, Condition), certain(right, Condition)
    if left.operator == right.operator == operator:
        return Condition(operator, left.parts + right.parts)
    return Condition(operator, (left, right))


def negation(it: Interpreter, value: Value, node: ast.Node) -> Value:
    match value:
        case bool():
            return not value
        case Condition():
            return Condition("not", (value,))
        case Nothing():
            return NOTHING
        case _:
            return it.misfit(rules.needed("a condition", type_of(value)), node)


def all_of(parts: Iterable[Value]) -> Value:
    """Returns the conjunction of conditions; NOTHING if one of them failed."""
    found: list[Part] = []
    for part in parts:
        if isinstance(part, Nothing):
            return NOTHING
        if isinstance(part, Condition):
            found += part.parts if part.operator == "and" else (part,)
        elif part is False:
            found.append(False)
    return Condition("and", tuple(found)) if found else True


def holds(condition: Part, evaluate: Evaluate, tolerance: float, *, strict: bool = False) -> bool:
    """Tells whether a condition is true within a relative tolerance; `strict`: equals are not `<`, `>`."""
    if isinstance(condition, bool):
        return condition
    if isinstance(condition, Comparison):
        a, b = evaluate(condition.left), evaluate(condition.right)
        if not (math.isfinite(a) and math.isfinite(b)):
            return False
        return _relates(condition.relation, a, b, condition.dimension == ANGLE, tolerance, strict=strict)
    parts = (holds(part, evaluate, tolerance, strict=strict) for part in condition.parts)
    match condition.operator:
        case "and":
            return all(parts)
        case "or":
            return any(parts)
        case _:
            return not all(parts)


Parties: TypeAlias = tuple[frozenset[Unknown], ...]


def replace_placed(condition: Condition, placed: frozenset[Unknown], parties: Parties = ()) -> Condition:
    """Returns the same condition, with other unknowns moving first."""
    parts: list[Part] = []
    for part in condition.parts:
        if isinstance(part, Comparison):
            part = replace(part, moved=placed, parties=parties)
        parts.append(replace_placed(part, placed, parties) if isinstance(part, Condition) else part)
    return Condition(condition.operator, tuple(parts))


def value_unknowns(value: Value, here: Structure) -> Iterator[Unknown]:
    """Yields the unknowns that place a value, as seen from a structure."""
    for item in leaves(value):
        if isinstance(item, Num):
            yield from ex.unknowns([item.expression])
        elif (box := box_of(item, here)) is not None:
            for source in box.sources:
                yield from source_unknowns(source, here)


# --- A statement that constrains, kept so that it can be read again, part by part, at its place.


@record(eq=False)
class Wording:
    """A statement that can be read again: `node` as it was written, or a part of it."""

    node: ast.Expression
    it: Interpreter
    env: Env

    def held(self) -> Iterator[str]:
        """Yields the texts of parts of the statement that no solving moves."""
        return self._of_names(lambda node, value: [node.span.text] if _is_exact(value) else [])

    def named(self) -> Iterator[Geometry | Structure]:
        """Yields the geometry and structures that the statement mentions, as far as each name in it leads."""

        def things(node: ast.Node, value: Value | None) -> list[Geometry | Structure]:
            values = () if value is None else (value, *(members(value) or ()))
            return [v for v in values if isinstance(v, Geometry | Structure)]

        return self._of_names(things)

    def _of_names(self, found_in: Callable[[ast.Node, Value | None], list[T]]) -> Iterator[T]:
        """Yields what is found in the longest names of the statement that have something."""
        stack: list[ast.Node] = [self.node]
        while stack:
            node = stack.pop()
            found = (
                found_in(node, self.value(node))
                if isinstance(node, ast.Name | ast.Member | ast.Index)
                else []
            )
            yield from found
            stack.extend([] if found else reversed(list(ast.children(node))))

    def value(self, node: ast.Expression) -> Value | None:
        """Returns the value of a part of the statement at its place; None if that takes too long."""
        it = self.it
        try:
            with limited_to(it.limits.seconds):
                return it.evaluate(node, self.env)
        except Stop:
            return None


def _is_exact(value: Value | None) -> bool:
    if isinstance(value, Geometry):
        return bool(value.fields) and all(map(_is_exact, value.fields.values()))
    numbers = numbers_of(value) if value is not None else ()
    return bool(numbers) and all(n.expression.is_constant for n in numbers)


# --- The comparisons of a statement in numbers, `14 - 11 = 3, which is not >= 4`, and where these come from.

_DIGITS = range(6, 18)
"""Significant digits in which a number is shown: the fewest that tell the two sides apart."""
_GIVEN = 4  # places that are shown at most

_ROUNDED = 1e-4  # relative difference up to which two numbers may be one and its rounding

Stated = tuple[ast.Expression, str, ast.Expression]


def differences(wording: Wording, evaluate: Evaluate, tolerance: float) -> list[str]:
    """Returns a text for each false comparison in a statement; empty if it cannot be read so."""
    if isinstance(wording.node, ast.Membership):
        return _beyond(wording, wording.node, evaluate)
    texts = (_difference(wording, each, evaluate, tolerance) for each in _comparisons(wording.node))
    return [text for text in texts if text]


def rounding(one: float, other: float) -> tuple[str, ...]:
    """Returns hints for two sides that should be equal and differ as a number and its rounding do."""
    size = max(abs(one), abs(other))
    if not 0.0 < abs(one - other) <= _ROUNDED * size:
        return ()
    return (
        f"the sides are {short(abs(one - other))} apart, as a number and its rounding are: work one out from "
        "the other, as in `let b = 2 * a`",
        "or leave this out, if it follows from the rest",
    )


def _beyond(wording: Wording, node: ast.Membership, evaluate: Evaluate) -> list[str]:
    """Returns a text for a false statement that a number is among others."""
    values = _values(_numbers(wording, node.value), evaluate)
    return [f"{_shown(values, _DIGITS[0])} is not in {node.container.span.one_line}"] if values else []


def sides(wording: Wording, evaluate: Evaluate) -> str:
    """Returns the two sides of a statement, `110 and 120`; empty unless it has exactly one comparison."""
    pairs = list(_comparisons(wording.node))
    if len(pairs) != 1:
        return ""
    left, _, right = pairs[0]
    shown = [_values(_numbers(wording, side), evaluate) for side in (left, right)]
    if not all(shown):
        return ""
    one, other = _apart(*shown)
    return f"{one} and {other}"


def givens(wording: Wording) -> tuple[Label, ...]:
    """Returns labels where the named constants of a statement are given, with their values."""
    found: dict[Span, list[str]] = {}
    source = wording.node.span.source
    inside = [wording.node.value] if isinstance(wording.node, ast.Membership) else []
    both = [side for left, _, right in _comparisons(wording.node) for side in (left, right)]
    for side in (*inside, *both):
        for leaf in _leaves(side):
            at, value = _origin(wording, leaf), wording.value(leaf)
            if at is None or at.source is not source:
                continue
            if isinstance(value, Num) and value.expression.is_constant:
                texts = found.setdefault(at, [])
                said = f"`{leaf.span.one_line}` is {_shown((value.value,), 6)}"
                texts += [said] if said not in texts else []
    return tuple(Label(at, ", ".join(texts)) for at, texts in list(found.items())[:_GIVEN])


def _comparisons(node: ast.Expression) -> Iterator[Stated]:
    match node:
        case ast.Comparison(operands=operands, operators=operators):
            yield from zip(operands, operators, operands[1:], strict=False)
        case ast.Binary(operator="and" | "or", left=left, right=right):
            yield from _comparisons(left)
            yield from _comparisons(right)


def _numbers(wording: Wording, node: ast.Expression) -> tuple[Num, ...]:
    """Returns the number of a side, or the two of a point; empty for anything else."""
    value = wording.value(node)
    if isinstance(value, Geometry) and value.type == "point":
        value = as_point(wording.it, value, node, wording.env)
    return numbers_of(value) if value is not None else ()


def _difference(wording: Wording, stated: Stated, evaluate: Evaluate, tolerance: float) -> str:
    """Returns the text for a false comparison; empty for one that holds, or that is not one of numbers."""
    (left, relation, right), pairs = stated, _pairs(wording, stated)
    met = [holds(pair, evaluate, tolerance) for pair in pairs]
    if not pairs or (any(met) if relation == "!=" else all(met)):
        return ""
    x, y = _apart([evaluate(pair.left) for pair in pairs], [evaluate(pair.right) for pair in pairs])
    sums = [_in_numbers(wording, side, evaluate) for side in (left, right)]
    left_side = f"{sums[0]} = {x}, which" if sums[0] else x
    return f"{left_side} is not {relation} {y}" + (f" = {sums[1]}" if sums[1] else "")


def _pairs(wording: Wording, stated: Stated) -> list[Comparison]:
    """Returns the comparisons of numbers that a comparison stands for; empty if they do not go together."""
    relation, pairs = stated[1], list[Comparison]()
    one, other = (_numbers(wording, side) for side in (stated[0], stated[2]))
    for a, b in zip(one, other, strict=True) if len(one) == len(other) else ():
        left, right = spelled_out(a.expression, b.expression, equal=relation == "==")
        try:
            dimension = units.add(a.dimension, b.dimension)
        except ValueError:
            return []
        pairs.append(Comparison(relation, left, right, dimension))
    return pairs


def compared(wording: Wording) -> tuple[Comparison, ...]:
    """Returns the comparisons of numbers that a statement asks to hold together, constants or not; empty if
    it is more than that, or a relation that cannot constrain.
    """
    if any(isinstance(n, ast.Binary) and n.operator == "or" for n in ast.walk(wording.node)):
        return ()
    found: list[Comparison] = []
    for stated in _comparisons(wording.node):
        pairs = _pairs(wording, stated) if stated[1] in RELATIONS else []
        if not pairs:
            return ()
        found += pairs
    return tuple(found)


def _values(numbers: Sequence[Num], evaluate: Evaluate) -> list[float]:
    return [evaluate(spelled_out(n.expression, n.expression, equal=False)[0]) for n in numbers]


def _apart(one: Sequence[float], other: Sequence[float]) -> tuple[str, str]:
    """Returns both in the digits that tell them apart, if they differ."""
    for digits in _DIGITS:
        texts = _shown(one, digits), _shown(other, digits)
        if texts[0] != texts[1]:
            return texts
    return _shown(one, _DIGITS[0]), _shown(other, _DIGITS[0])


def _shown(values: Sequence[float], digits: int) -> str:
    texts = [f"{round(value, digits) + 0.0:.{digits}g}" for value in values]
    return texts[0] if len(texts) == 1 else f"({', '.join(texts)})"


def _in_numbers(wording: Wording, node: ast.Expression, evaluate: Evaluate) -> str:
    """Returns a sum or product with numbers in place of names; empty for anything else."""
    if not _is_calculated(node):
        return ""
    from aidl_lang.syntax.printer import format_expression

    return format_expression(_substituted(wording, node, evaluate))


def _is_calculated(node: ast.Expression) -> bool:
    return isinstance(node, ast.Binary) and node.operator not in ("and", "or")


def _substituted(wording: Wording, node: ast.Expression, evaluate: Evaluate) -> ast.Expression:
    match node:
        case ast.Binary(left=left, right=right) if _is_calculated(node):
            one, other = (_substituted(wording, each, evaluate) for each in (left, right))
            return replace(node, left=one, right=other)
        case ast.Unary(operator="-", operand=operand) if not isinstance(operand, ast.Number):
            return replace(node, operand=_substituted(wording, operand, evaluate))
        case ast.Name():
            symbol = wording.it.program.resolution.uses.get(node)
            if symbol is not None and symbol.kind is SymbolKind.BUILTIN:
                return node
    numbers = _numbers(wording, node)
    if len(numbers) != 1:
        return node
    (value,) = _values(numbers, evaluate)
    number = ast.Number(abs(value), None, _shown((abs(value),), 6), span=node.span)
    return ast.Unary("-", number, span=node.span) if value < 0.0 else number


def _leaves(node: ast.Expression) -> Iterator[ast.Expression]:
    match node:
        case ast.Binary(left=left, right=right):
            yield from _leaves(left)
            yield from _leaves(right)
        case ast.Unary(operand=operand):
            yield from _leaves(operand)
        case ast.Name() | ast.Member() | ast.Index():
            yield node


def _origin(wording: Wording, leaf: ast.Expression) -> Span | None:
    """Returns the place where a name is given its value, or where the thing that has a size is written."""
    if isinstance(leaf, ast.Name):
        symbol = wording.it.program.resolution.uses.get(leaf)
        return symbol.node.span if symbol is not None and symbol.node is not None else None
    while isinstance(leaf, ast.Member | ast.Index):
        leaf = leaf.value
        thing = wording.value(leaf)
        if isinstance(thing, Geometry | Structure):
            return thing.span
    return None
