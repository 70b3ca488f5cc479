"""The expressions of the syntax tree; `tree.Builder` adds the statements."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import Token

_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "0": "\0"}
_UNITS = ("turn", "deg", "rad", "mm", "cm", "in", "ft", "m", "°")


def makes(kind: type[ast.Node], *first: object) -> Callable[..., Any]:
    """Returns a method that makes a node of what a rule has, behind some fields that are always the same."""
    return lambda self, at, *parts: kind(*first, *parts, span=at)


def under(word: str) -> Callable[..., tuple[str, Any]]:
    """Returns a method that hands on what a rule has under a word."""
    return lambda self, at, value: (word, value)


def handed_on(self: ExpressionBuilder, at: Span, value: Any) -> Any:
    return value


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

    def name(self, at: Span, token: Token) -> ast.Name:
        return ast.Name(token.text, span=at)

    def number(self, at: Span, token: Token) -> ast.Number:
        digits, unit = number_parts(token.text)
        return ast.Number(float(digits), unit, digits, span=at)

    def string(self, at: Span, token: Token) -> ast.String:
        return ast.String(string_value(token.text), span=at)

    true, false = makes(ast.Boolean, True), makes(ast.Boolean, False)
    point = makes(ast.Point)

    def list(self, at: Span, *items: Any) -> ast.List | ast.Comprehension:
        if items and isinstance(items[0], _Generator):
            return items[0].comprehension(at)
        return ast.List(items, span=at)

    # --- Places and calls ---

    def member(self, at: Span, value: ast.Expression, name: Token) -> ast.Member:
        return ast.Member(value, self.identifier(name), span=at)

    def index_of(self, at: Span, value: ast.Expression, *indices: ast.Expression) -> ast.Index:
        """Builds `a[i, j]` as `a[i][j]`."""
        for index in indices[:-1]:
            value = ast.Index(value, index, span=at)
        return ast.Index(value, indices[-1], span=at)

    def call(self, at: Span, callee: Token, arguments: Any = ()) -> ast.Call:
        return ast.Call(self.identifier(callee), None, arguments_of(arguments), span=at)

    def method(self, at: Span, receiver: ast.Expression, callee: Token, arguments: Any = ()) -> ast.Call:
        return ast.Call(self.identifier(callee), receiver, arguments_of(arguments), span=at)

    def arguments(self, at: Span, *items: Any) -> tuple[ast.Argument, ...]:
        return tuple(
            item if isinstance(item, ast.Argument) else ast.Argument(None, item, span=item.span)
            for item in items
        )

    argument = makes(ast.Argument, None)

    def named_argument(self, at: Span, name: Token, value: ast.Expression) -> ast.Argument:
        return ast.Argument(self.identifier(name), value, span=at)

    # --- Blocks of arguments ---

    def argument_block(self, at: Span, *items: ast.Let | ast.Expression) -> ast.ArgumentBlock:
        return ast.ArgumentBlock(items, span=at)

    def for_arguments(
        self, at: Span, variables: tuple[ast.Identifier, ...], iterable: ast.Expression, *rest: Any
    ) -> ast.ForArguments:
        """Builds `for x in a, y in b { … }` as one loop in another."""
        body = rest[-1]
        if len(rest) > 1:
            body = ast.ArgumentBlock((self.for_arguments(at, *rest),), span=body.span)
        return ast.ForArguments(variables, iterable, body, span=at)

    def if_arguments(
        self,
        at: Span,
        test: ast.Expression,
        then: ast.ArgumentBlock,
        other: ast.ArgumentBlock | ast.IfArguments | None = None,
    ) -> ast.IfArguments:
        if isinstance(other, ast.IfArguments):
            other = ast.ArgumentBlock((other,), span=other.span)
        return ast.IfArguments(test, then, other, span=at)

    # --- Operators ---

    def comparison_operator(self, at: Span, token: Token) -> str:
        return token.text

    add_operator = multiply_operator = comparison_operator

    def binary(self, at: Span, left: ast.Expression, operator: str, right: ast.Expression) -> ast.Binary:
        return ast.Binary(operator, left, right, span=at)

    power = makes(ast.Binary, "^")
    conjunction = makes(ast.Binary, "and")
    disjunction = makes(ast.Binary, "or")
    sign = makes(ast.Unary)
    negated = makes(ast.Unary, "not")

    def comparison(self, at: Span, *parts: Any) -> ast.Comparison:
        return ast.Comparison(parts[::2], parts[1::2], span=at)

    membership = makes(ast.Membership)

    def not_membership(self, at: Span, value: ast.Expression, container: ast.Expression) -> Any:
        return self.negated(at, self.membership(at, value, container))

    def range(
        self,
        at: Span,
        first: ast.Expression,
        last: ast.Expression,
        step: ast.Expression | None = None,
        *,
        exclusive: bool = False,
    ) -> ast.Range:
        return ast.Range(first, last, exclusive, step, span=at)

    def exclusive_range(self, at: Span, *parts: ast.Expression) -> ast.Range:
        return self.range(at, *parts, exclusive=True)

    # --- Comprehensions ---

    def variables(self, at: Span, *names: Token) -> tuple[ast.Identifier, ...]:
        return tuple(map(self.identifier, names))

    filter = default = handed_on

    def generator_clause(self, at: Span, *parts: Any) -> tuple[int, tuple[Any, ...]]:
        return at.start, parts

    def generator(
        self, at: Span, element: ast.Expression, *clauses: tuple[int, tuple[Any, ...]]
    ) -> _Generator:
        """Builds `a for i in b for j in c` as the list for `i` of the members of the lists for `j`."""
        loops = []
        for begin, (*both, last) in clauses:
            condition = last if len(both) % 2 == 0 else None
            names = both if condition is not None else [*both, last]
            for k in range(0, len(names), 2):
                is_last = k + 2 == len(names)
                loops.append((begin, names[k], names[k + 1], condition if is_last else None))
        for begin, variables, iterable, condition in reversed(loops[1:]):
            span = self.span(begin, at.end)
            element = ast.Comprehension(element, variables, iterable, condition, True, span=span)
        _, variables, iterable, condition = loops[0]
        return _Generator(element, variables, iterable, condition, at)


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
