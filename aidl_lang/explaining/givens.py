"""The numbers that have a share in constraints: those written in them, and exact ones behind names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from enum import Enum

from aidl_lang.building.model import is_size
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

_MOST = 12
"""The most exact numbers behind the names mentioned; nearer ones first."""
_FACTORING = ("*", "/", "%", "^")
_BY_DEFINITION = frozenset({SymbolKind.FUNCTION, SymbolKind.SHAPE, SymbolKind.CONSTRAINT, SymbolKind.ALIAS})
"""Kinds of symbols that belong to the vocabulary rather than to the drawing."""


class Sign(Enum):
    """The values possible for a number that is not negative as it is written."""

    ANY = "a coordinate"
    NOT_NEGATIVE = "a gap, a margin, or what is added"
    POSITIVE = "a size"


@record()
class Dial:
    """A number of the text.

    place      where it stands, with its sign
    value      in the `unit` in which it is written (empty: mm, degrees or none)
    name       of the `param` or `let` that it is the value of
    is_exact   nothing but the text changes it, and it stands in none of the constraints
    is_factor  it multiplies or divides
    sign       what it may be
    is_rough   a number of many digits in its place would not be what anyone means
    """

    place: Span
    value: float
    unit: str
    name: str = ""
    is_exact: bool = False
    is_factor: bool = False
    sign: Sign = Sign.NOT_NEGATIVE
    is_rough: bool = False

    def may_be(self, value: float) -> bool:
        """Tells whether its author can have meant a value: none whose sign reverses the meaning."""
        if self.value < 0.0 or self.sign is Sign.ANY:
            return True
        return value > 0.0 if self.sign is Sign.POSITIVE else value >= 0.0


def written_numbers(node: ast.Expression) -> list[Dial]:
    """Returns the numbers written in a statement, the last first: those that count among its arguments and
    its comparisons. Indices are left out: they say which thing is meant.
    """
    found: list[Dial] = []
    stack: list[ast.Node] = [node]
    while stack:
        match stack.pop():
            case ast.Number() | ast.Unary(operator="-", operand=ast.Number()) as literal:
                found.append(_dial(literal))
            case ast.Binary() as operation:
                sides = operation.right, operation.left
                found += _among(sides, Sign.NOT_NEGATIVE, stack, operation.operator)
            case ast.Index(value=inner):
                stack.append(inner)
            case ast.Comparison(operands=operands):
                sized = any(isinstance(o, ast.Member) and is_size(o.name.text) for o in operands)
                found += _among(operands, Sign.POSITIVE if sized else Sign.ANY, stack)
            case ast.Point(x=x, y=y):
                found += (replace(dial, is_rough=True) for dial in _among((x, y), Sign.ANY, stack))
            case other:
                stack.extend(ast.children(other))
    return sorted(found, key=lambda dial: -dial.place.start)


def _among(
    nodes: Iterable[ast.Node], sign: Sign, further: list[ast.Node], operator: str = ""
) -> Iterator[Dial]:
    """Yields the literals among the operands of an operator; appends the other operands to `further`."""
    for node in nodes:
        if _is_literal(node):
            yield replace(_dial(node), sign=sign, is_factor=operator in _FACTORING)
        else:
            further.append(node)


def exact_numbers(nodes: Iterable[ast.Node], uses: Mapping[ast.Node, Symbol]) -> list[Dial]:
    """Returns the exact numbers behind the names in some nodes: values of `param`s and `let`s, and of
    `fixed(…)`, in the definitions mentioned and in those that these mention in turn; zeros, which mostly say
    where to begin, come last.
    """
    found: dict[Span, Dial] = {}
    waiting, seen = list(nodes), set[ast.Node]()
    while waiting and len(found) < _MOST:
        here, waiting = waiting, []
        for node in here:
            for part in ast.walk(node):
                if isinstance(part, ast.Call) and fold(part.callee.text) == "fixed":
                    for argument in part.arguments:
                        for dial in written_numbers(argument.value):
                            found.setdefault(dial.place, _exact(dial))
                symbol = uses.get(part)
                if symbol is None or symbol.node is None or symbol.node in seen:
                    continue
                if symbol.kind in _BY_DEFINITION or symbol.node.span.source is not node.span.source:
                    continue
                seen.add(symbol.node)
                if isinstance(symbol.node, ast.Param | ast.Let) and _is_literal(symbol.node.value):
                    dial = _dial(symbol.node.value)
                    found.setdefault(dial.place, _exact(dial, symbol.name))
                else:
                    waiting.append(symbol.node)
    return sorted(found.values(), key=lambda dial: dial.value == 0.0)[:_MOST]


def _exact(dial: Dial, name: str = "") -> Dial:
    is_size = not name and not dial.is_rough and dial.unit != "deg"
    sign = Sign.POSITIVE if is_size and dial.sign is Sign.NOT_NEGATIVE else dial.sign
    return replace(dial, name=name, is_exact=True, is_rough=not name, sign=sign)


def _is_literal(node: ast.Node) -> bool:
    return isinstance(node, ast.Number) or (
        isinstance(node, ast.Unary) and node.operator == "-" and isinstance(node.operand, ast.Number)
    )


def _dial(literal: ast.Node) -> Dial:
    number = literal.operand if isinstance(literal, ast.Unary) else literal
    assert isinstance(number, ast.Number)
    value = -number.value if isinstance(literal, ast.Unary) else number.value
    return Dial(literal.span, value, number.unit or "")
