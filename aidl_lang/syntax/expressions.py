"""The expressions of the syntax tree; `tree.Builder` adds the statements."""

from __future__ import annotations

from typing import Any

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import Token

_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "0": "\0"}
_UNITS = ("turn", "deg", "rad", "mm", "cm", "in", "ft", "m", "°")


class ExpressionBuilder:
    """Builder of expression nodes, with a method for each rule of the grammar that makes one."""

    def __init__(self, source: SourceFile, docs: dict[int, str]) -> None:
        self.source = source
        self.docs = docs
        self.diagnostics: list[Diagnostic] = []

    def span(self, start: int, end: int) -> Span:
        return Span(self.source, start, end)

    def identifier(self, token: Token) -> ast.Identifier:
        text = token.text[:-1] if token.kind == "CALL" else token.text
        return ast.Identifier(text, span=Span(self.source, token.start, token.start + len(text)))

    # --- Names and literals ---

    def name(self, start: int, end: int, token: Token) -> ast.Name:
        return ast.Name(token.text, span=Span(self.source, start, end))

    def number(self, start: int, end: int, token: Token) -> ast.Number:
        digits, unit = number_parts(token.text)
        return ast.Number(float(digits), unit, digits, span=Span(self.source, start, end))

    def string(self, start: int, end: int, token: Token) -> ast.String:
        return ast.String(string_value(token.text), span=Span(self.source, start, end))

    def true(self, start: int, end: int) -> ast.Boolean:
        return ast.Boolean(True, span=Span(self.source, start, end))

    def false(self, start: int, end: int) -> ast.Boolean:
        return ast.Boolean(False, span=Span(self.source, start, end))

    def point(self, start: int, end: int, x: ast.Expression, y: ast.Expression) -> ast.Point:
        return ast.Point(x, y, span=Span(self.source, start, end))

    def list(self, start: int, end: int, *items: Any) -> ast.List | ast.Comprehension:
        if items and isinstance(items[0], _Generator):
            return items[0].comprehension(self.span(start, end))
        return ast.List(items, span=Span(self.source, start, end))

    # --- Places and calls ---

    def member(self, start: int, end: int, value: ast.Expression, name: Token) -> ast.Member:
        return ast.Member(value, self.identifier(name), span=Span(self.source, start, end))

    def index_of(self, start: int, end: int, value: ast.Expression, *indices: ast.Expression) -> ast.Index:
        """Builds `a[i, j]` as `a[i][j]`."""
        span = Span(self.source, start, end)
        for index in indices[:-1]:
            value = ast.Index(value, index, span=span)
        return ast.Index(value, indices[-1], span=span)

    def call(self, start: int, end: int, callee: Token, arguments: Any = ()) -> ast.Call:
        return ast.Call(
            self.identifier(callee), None, arguments_of(arguments), span=Span(self.source, start, end)
        )

    def method(
        self, start: int, end: int, receiver: ast.Expression, callee: Token, arguments: Any = ()
    ) -> ast.Call:
        return ast.Call(
            self.identifier(callee), receiver, arguments_of(arguments), span=self.span(start, end)
        )

    def arguments(self, start: int, end: int, *items: Any) -> tuple[ast.Argument, ...]:
        return tuple(
            item if isinstance(item, ast.Argument) else ast.Argument(None, item, span=item.span)
            for item in items
        )

    def argument(self, start: int, end: int, value: ast.Expression) -> ast.Argument:
        return ast.Argument(None, value, span=Span(self.source, start, end))

    def named_argument(self, start: int, end: int, name: Token, value: ast.Expression) -> ast.Argument:
        return ast.Argument(self.identifier(name), value, span=Span(self.source, start, end))

    # --- Blocks of arguments ---

    def argument_block(self, start: int, end: int, *items: ast.Let | ast.Expression) -> ast.ArgumentBlock:
        return ast.ArgumentBlock(items, span=self.span(start, end))

    def for_arguments(
        self,
        start: int,
        end: int,
        variables: tuple[ast.Identifier, ...],
        iterable: ast.Expression,
        *rest: Any,
    ) -> ast.ForArguments:
        """Builds `for x in a, y in b { … }` as one loop in another."""
        span, body = self.span(start, end), rest[-1]
        if len(rest) > 1:
            body = ast.ArgumentBlock((self.for_arguments(start, end, *rest),), span=body.span)
        return ast.ForArguments(variables, iterable, body, span=span)

    def if_arguments(
        self,
        start: int,
        end: int,
        test: ast.Expression,
        then: ast.ArgumentBlock,
        other: ast.ArgumentBlock | ast.IfArguments | None = None,
    ) -> ast.IfArguments:
        if isinstance(other, ast.IfArguments):
            other = ast.ArgumentBlock((other,), span=other.span)
        return ast.IfArguments(test, then, other, span=self.span(start, end))

    # --- Operators ---

    def comparison_operator(self, start: int, end: int, token: Token) -> str:
        return token.text

    add_operator = multiply_operator = comparison_operator

    def binary(
        self, start: int, end: int, left: ast.Expression, operator: str, right: ast.Expression
    ) -> ast.Binary:
        return ast.Binary(operator, left, right, span=Span(self.source, start, end))

    def power(self, start: int, end: int, left: ast.Expression, right: ast.Expression) -> ast.Binary:
        return ast.Binary("^", left, right, span=Span(self.source, start, end))

    def conjunction(self, start: int, end: int, left: ast.Expression, right: ast.Expression) -> ast.Binary:
        return ast.Binary("and", left, right, span=Span(self.source, start, end))

    def disjunction(self, start: int, end: int, left: ast.Expression, right: ast.Expression) -> ast.Binary:
        return ast.Binary("or", left, right, span=Span(self.source, start, end))

    def sign(self, start: int, end: int, operator: str, operand: ast.Expression) -> ast.Unary:
        return ast.Unary(operator, operand, span=Span(self.source, start, end))

    def negated(self, start: int, end: int, operand: ast.Expression) -> ast.Unary:
        return ast.Unary("not", operand, span=Span(self.source, start, end))

    def comparison(self, start: int, end: int, *parts: Any) -> ast.Comparison:
        return ast.Comparison(parts[::2], parts[1::2], span=Span(self.source, start, end))

    def membership(
        self, start: int, end: int, value: ast.Expression, container: ast.Expression
    ) -> ast.Membership:
        return ast.Membership(value, container, span=Span(self.source, start, end))

    def not_membership(
        self, start: int, end: int, value: ast.Expression, container: ast.Expression
    ) -> ast.Unary:
        return self.negated(start, end, self.membership(start, end, value, container))

    def range(
        self,
        start: int,
        end: int,
        first: ast.Expression,
        last: ast.Expression,
        step: ast.Expression | None = None,
        *,
        exclusive: bool = False,
    ) -> ast.Range:
        return ast.Range(first, last, exclusive, step, span=Span(self.source, start, end))

    def exclusive_range(self, start: int, end: int, *parts: ast.Expression) -> ast.Range:
        return self.range(start, end, *parts, exclusive=True)

    # --- Comprehensions ---

    def variables(self, start: int, end: int, *names: Token) -> tuple[ast.Identifier, ...]:
        return tuple(map(self.identifier, names))

    def filter(self, start: int, end: int, test: ast.Expression) -> ast.Expression:
        return test

    def generator_clause(self, start: int, end: int, *parts: Any) -> tuple[int, tuple[Any, ...]]:
        return start, parts

    def generator(
        self, start: int, end: int, element: ast.Expression, *clauses: tuple[int, tuple[Any, ...]]
    ) -> _Generator:
        """Builds `a for i in b for j in c` as the list for `i` of the members of the lists for `j`."""
        loops = []
        for at, (*both, last) in clauses:
            condition = last if len(both) % 2 == 0 else None
            names = both if condition is not None else [*both, last]
            for k in range(0, len(names), 2):
                is_last = k + 2 == len(names)
                loops.append((at, names[k], names[k + 1], condition if is_last else None))
        for at, variables, iterable, condition in reversed(loops[1:]):
            span = self.span(at, end)
            element = ast.Comprehension(element, variables, iterable, condition, True, span=span)
        _, variables, iterable, condition = loops[0]
        return _Generator(element, variables, iterable, condition, self.span(start, end))


class _Generator:
    """`element for variables in iterable if condition`, not yet known to stand in brackets or in a call."""

    def __init__(
        self,
        element: ast.Expression,
        variables: tuple[ast.Identifier, ...],
        iterable: ast.Expression,
        condition: ast.Expression | None,
        span: Span,
    ) -> None:
        self.parts = (element, variables, iterable, condition)
        self.span = span

    def comprehension(self, span: Span) -> ast.Comprehension:
        return ast.Comprehension(*self.parts, span=span)


def arguments_of(value: Any) -> tuple[ast.Argument, ...]:
    """Returns the arguments of a call; its only one may be a bare comprehension: `sum(a for a in b)`."""
    if isinstance(value, _Generator):
        return (ast.Argument(None, value.comprehension(value.span), span=value.span),)
    return tuple(value)


def number_parts(text: str) -> tuple[str, str | None]:
    """Returns digits and unit of a number as written; `°` is `deg`."""
    for unit in _UNITS:
        if text.endswith(unit):
            return text[: -len(unit)], "deg" if unit == "°" else unit
    return text, None


def string_value(text: str) -> str:
    """Returns the value of a string token, without its quotes and escapes."""
    inner = text[1:-1]
    if "\\" not in inner:
        return inner
    out: list[str] = []
    chars = iter(inner)
    for char in chars:
        if char == "\\":
            escaped = next(chars)
            char = _ESCAPES.get(escaped, escaped)
        out.append(char)
    return "".join(out)
