"""Statements that constrain, kept so that they can be read again in other words and in numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields, replace
from typing import TypeVar

from aidl_lang.building.boxes import spelled_out
from aidl_lang.building.coerce import as_point
from aidl_lang.building.conditions import RELATIONS, holds
from aidl_lang.building.expression import Expression
from aidl_lang.building.model import Comparison, Condition, Geometry, Structure
from aidl_lang.building.state import Env, Interpreter, Stop
from aidl_lang.building.values import Num, PointVal, Value, members
from aidl_lang.checking import units
from aidl_lang.checking.symbols import SymbolKind
from aidl_lang.common.diagnostics import Label
from aidl_lang.common.prose import short
from aidl_lang.common.records import record
from aidl_lang.common.running import limited_to
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

# --- A statement that constrains, kept so that it can be read again in other words at its place.
#
# Messages about conflicts try other numbers in it: only the definitions themselves, a user's as well as the
# library's, decide what a number does to the equations.

_Tree = TypeVar("_Tree", bound=ast.Node)

Read = Callable[[Interpreter, ast.Expression, Env], Value]
"""Evaluates a statement in an environment."""


@record(eq=False)
class Wording:
    """A statement that can be read again: `node` as it was written; `read` evaluates one in its stead."""

    node: ast.Expression
    it: Interpreter
    env: Env
    read: Read

    def comparisons(self, node: ast.Expression) -> tuple[Comparison, ...]:
        """Returns the comparisons that `node` would state here; none if senseless or decided already."""
        value = self.value(node)
        return tuple(value.comparisons()) if isinstance(value, Condition) else ()

    def dials(self) -> Iterator[tuple[ast.Expression, float]]:
        """Yields the literals and the names of constants in the statement with their values, in mm or
        degrees; a literal with its sign. Indices are left out: they choose a thing.
        """
        stack: list[ast.Node] = [self.node]
        while stack:
            match stack.pop():
                case (ast.Number() | ast.Unary(operator="-", operand=ast.Number()) | ast.Name()) as node:
                    value = self.value(node)
                    if isinstance(value, Num) and value.expression.is_constant:
                        yield node, value.value
                case ast.Index(value=inner):
                    stack.append(inner)
                case other:
                    stack.extend(reversed(list(ast.children(other))))

    def held(self) -> Iterator[str]:
        """Yields the texts of parts of the statement that no solving moves."""
        stack: list[ast.Node] = [self.node]
        while stack:
            node = stack.pop()
            if isinstance(node, ast.Name | ast.Member | ast.Index) and _is_exact(self.value(node)):
                yield node.span.text
            else:
                stack.extend(reversed(list(ast.children(node))))

    def named(self) -> Iterator[Geometry | Structure]:
        """Yields the geometry and structures that the statement mentions, as far as each name in it leads."""
        stack: list[ast.Node] = [self.node]
        while stack:
            node = stack.pop()
            if isinstance(node, ast.Name | ast.Member | ast.Index):
                value = self.value(node)
                values = () if value is None else (value, *(members(value) or ()))
                found = [v for v in values if isinstance(v, Geometry | Structure)]
                yield from found
                if found:
                    continue
            stack.extend(reversed(list(ast.children(node))))

    def param(self, name: ast.Expression) -> ast.Param | None:
        """Returns the declaration of a `param` that nothing but this name reads; None for other names."""
        uses = self.it.program.resolution.uses
        symbol = uses.get(name)
        readers = [node for node, other in uses.items() if other is symbol and isinstance(node, ast.Name)]
        return symbol.node if symbol and len(readers) == 1 and isinstance(symbol.node, ast.Param) else None

    def value(self, node: ast.Expression) -> Value | None:
        """Returns the value of a part of the statement at its place; None if that takes too long."""
        it = self.it
        try:
            with limited_to(it.limits.seconds):
                return self.read(it, node, self.env)
        except Stop:
            return None


def _is_exact(value: Value | None) -> bool:
    match value:
        case Num(expression=e):
            return e.is_constant
        case PointVal(x, y):
            return x.expression.is_constant and y.expression.is_constant
        case Geometry(fields=defining):
            return bool(defining) and all(map(_is_exact, defining.values()))
    return False


def replaced(node: _Tree, old: ast.Node, new: ast.Node) -> _Tree:
    """Returns the tree with one node below `node` exchanged."""
    changed: dict[str, object] = {}
    for field in fields(node):
        value = getattr(node, field.name)
        if value is old:
            changed[field.name] = new
        elif isinstance(value, ast.Node) and (inner := replaced(value, old, new)) is not value:
            changed[field.name] = inner
        elif isinstance(value, tuple):
            items = tuple(
                new if v is old else replaced(v, old, new) if isinstance(v, ast.Node) else v for v in value
            )
            if any(a is not b for a, b in zip(items, value, strict=True)):
                changed[field.name] = items
    return replace(node, **changed) if changed else node  # type: ignore[arg-type]


# --- The comparisons of a statement in numbers, `14 - 11 = 3, which is not >= 4`, and where these come from.

_DIGITS = range(6, 18)
"""Significant digits in which a number is shown: the fewest that tell the two sides apart."""
_GIVEN = 4
"""Places that are shown at most."""

_ROUNDED = 1e-4
"""Relative difference up to which two numbers may be one and its rounding."""

Evaluate = Callable[[Expression], float]
Side = tuple[ast.Expression, tuple[Num, ...]]


def differences(wording: Wording, evaluate: Evaluate, tolerance: float) -> list[str]:
    """Returns a text for each false comparison in a statement; empty if it cannot be read so."""
    if isinstance(wording.node, ast.Membership):
        return _beyond(wording, wording.node, evaluate)
    found = []
    for left, relation, right in _comparisons(wording.node):
        one, other = (left, _numbers(wording, left)), (right, _numbers(wording, right))
        if one[1] and len(one[1]) == len(other[1]):
            text = _difference(wording, one, relation, other, evaluate, tolerance)
            found += [text] if text else []
    return found


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


def _comparisons(node: ast.Expression) -> Iterator[tuple[ast.Expression, str, ast.Expression]]:
    match node:
        case ast.Comparison(operands=operands, operators=operators):
            yield from zip(operands, operators, operands[1:], strict=False)
        case ast.Binary(operator="and" | "or", left=left, right=right):
            yield from _comparisons(left)
            yield from _comparisons(right)


def _numbers(wording: Wording, node: ast.Expression) -> tuple[Num, ...]:
    """Returns the number of a side, or the two of a point; empty for anything else."""
    value = wording.value(node)
    if isinstance(value, Num):
        return (value,)
    is_place = isinstance(value, PointVal) or (isinstance(value, Geometry) and value.type == "point")
    point = as_point(wording.it, value, node, wording.env) if value is not None and is_place else None
    return (point.x, point.y) if point is not None else ()


def _difference(
    wording: Wording, one: Side, relation: str, other: Side, evaluate: Evaluate, tolerance: float
) -> str:
    """Returns the text for a false comparison; empty for one that holds."""
    pairs = _pairs(one, relation, other)
    if not pairs:
        return ""
    met = [holds(pair, evaluate, tolerance) for pair in pairs]
    if any(met) if relation == "!=" else all(met):
        return ""
    x, y = _apart([evaluate(pair.left) for pair in pairs], [evaluate(pair.right) for pair in pairs])
    sums = [_in_numbers(wording, node, evaluate) for node, _ in (one, other)]
    left_side = f"{sums[0]} = {x}, which" if sums[0] else x
    return f"{left_side} is not {relation} {y}" + (f" = {sums[1]}" if sums[1] else "")


def _pairs(one: Side, relation: str, other: Side) -> list[Comparison]:
    """Returns the comparisons of numbers that a comparison stands for; empty if they do not go together."""
    pairs = []
    for a, b in zip(one[1], other[1], strict=True):
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
    for left, relation, right in _comparisons(wording.node):
        one, other = (left, _numbers(wording, left)), (right, _numbers(wording, right))
        is_known = relation in RELATIONS and one[1] and len(one[1]) == len(other[1])
        pairs = _pairs(one, relation, other) if is_known else []
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
    from aidl_lang.syntax.expression_printer import format_expression

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
        case ast.Name() if _is_of_the_language(wording, node):
            return node
    numbers = _numbers(wording, node)
    if len(numbers) != 1:
        return node
    (value,) = _values(numbers, evaluate)
    number = ast.Number(abs(value), None, _shown((abs(value),), 6), span=node.span)
    return ast.Unary("-", number, span=node.span) if value < 0.0 else number


def _is_of_the_language(wording: Wording, node: ast.Name) -> bool:
    symbol = wording.it.program.resolution.uses.get(node)
    return symbol is not None and symbol.kind is SymbolKind.BUILTIN


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
