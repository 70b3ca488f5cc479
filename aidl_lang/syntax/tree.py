"""The builder of nodes: for each rule of the grammar the parser calls the method with its name.

Every method takes the place of the rule in the text and the values of its symbols. It reports mistakes that
the grammar cannot exclude (a second `at`, an unknown kind), beside a node that keeps what was meant.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.names import fold, is_slip, nearest
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import FOREIGN_WORDS, KIND_OF_WORD, KINDS, Token, kind_of

_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "0": "\0"}
_UNITS = ("turn", "deg", "rad", "mm", "cm", "in", "ft", "m", "°")


def makes(kind: type[ast.Node], *first: object) -> Callable[..., Any]:
    """Returns a method that makes a node of what a rule has, behind some fields that are always the same."""
    return lambda self, at, *parts: kind(*first, *parts, span=at)


def under(word: str) -> Callable[..., tuple[str, Any]]:
    """Returns a method that hands on what a rule has under a word."""
    return lambda self, at, value: (word, value)


def handed_on(self: Builder, at: Span, value: Any) -> Any:
    return value


def gives(kind: type[ast.Var | ast.Let]) -> Callable[..., Any]:
    """Returns a method that makes what gives a name a value, and the `if` behind it."""

    def make(self: Builder, at: Span, name: Token, value: Any) -> Any:
        parts = self.docs.get(at.start), self.identifier(name)
        return self._ending_in(at, value, lambda v, span: kind(parts[1], v, parts[0], span=span))

    return make


def defines(kind: type[ast.ShapeDefinition | ast.ConstraintDefinition]) -> Callable[..., Any]:
    """Returns a method that makes a definition with a body."""

    def make(self: Builder, at: Span, name: Token, *parts: Any) -> Any:
        parameters = parts[0] if len(parts) > 1 else ()
        return kind(self.identifier(name), parameters, parts[-1], self.docs.get(at.start), span=at)

    return make


def repeats(kind: type[ast.For | ast.ForArguments], block: Callable[..., Any]) -> Callable[..., Any]:
    """Returns a method that makes a loop; `for x in a, y in b { … }` is one loop in another."""

    def make(self: Builder, at: Span, variables: Any, iterable: ast.Expression, *rest: Any) -> Any:
        body = rest[-1]
        if len(rest) > 1:
            body = block((make(self, at, *rest),), span=body.span)
        return kind(variables, iterable, body, span=at)

    return make


def chooses(kind: type[ast.If | ast.IfArguments], block: Callable[..., Any]) -> Callable[..., Any]:
    """Returns a method that makes an `if`; behind `else` another one stands in a block of its own."""

    def make(self: Builder, at: Span, test: ast.Expression, then: Any, other: Any = None) -> Any:
        if isinstance(other, kind):
            other = block((other,), span=other.span)
        return kind(test, then, other, span=at)

    return make


class Builder:
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
            return ast.Comprehension(*items[0].parts, span=at)
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

    for_arguments = repeats(ast.ForArguments, ast.ArgumentBlock)
    if_arguments = chooses(ast.IfArguments, ast.ArgumentBlock)

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
        return _Generator((element, *loops[0][1:]), at)

    # --- Files and blocks ---

    def block(self, at: Span, *statements: ast.Statement) -> ast.Block:
        return ast.Block(statements, span=at)

    def module(self, at: Span, *items: Any) -> tuple[Any, ...]:
        return items

    parameters = module

    # --- Structures and geometry ---

    def structure(self, at: Span, *parts: Any, is_template: bool = False) -> ast.Structure:
        attributes, (kind, name, *rest) = _split(parts)
        lists = [part for part in rest if isinstance(part, tuple)]
        parameters = next(iter(lists), ()) if is_template else None
        indices = () if is_template else tuple(index for _, values in lists for index in values)
        placement = next((p for p in rest if isinstance(p, ast.Placement)), None)
        word = self.identifier(kind)
        meant = kind_of(word.text) or self._unknown_kind(word)
        head = meant, word, self.identifier(name), indices, parameters, placement, attributes
        return ast.Structure(*head, rest[-1], self.docs.get(at.start), span=at)

    def template(self, at: Span, *parts: Any) -> ast.Structure:
        return self.structure(at, *parts, is_template=True)

    def _unknown_kind(self, word: ast.Identifier) -> str:
        """Reports a word that is no kind. Returns the nearest kind, which is assumed."""
        if foreign := FOREIGN_WORDS.get(word.text.lower()):
            fix = Fix(f"write `{foreign[1]}`", (Edit(word.span, foreign[1]),)) if foreign[1] else None
            message = f"there is no `{word.text}`: {foreign[0]}"
            self.diagnostics.append(Diagnostic("E0113", message, word.span, fix=fix))
            return "solid"
        near = nearest(word.text, KIND_OF_WORD)
        guess = KIND_OF_WORD[near[0]] if near else "solid"
        canonical = near[0] if near and near[0] in KINDS else guess
        is_sure = bool(near) and is_slip(word.text, near[0])
        message = f"`{word.text}` is not a kind of structure"
        label = "kinds are assembly, solid, hole and drawing"
        hint = "write what it is: `solid` for material, `hole` for what is cut away"
        found = Diagnostic("E0115", message, word.span, label, hints=(hint,))
        if near:
            fix = Fix(f"write `{canonical}`", (Edit(word.span, canonical),), is_sure)
            found = replace(found, message=f"{message}; did you mean `{canonical}`?", hints=(), fix=fix)
        self.diagnostics.append(found)
        return guess

    def attribute(self, at: Span, name: Token, arguments: Any = ()) -> ast.Attribute:
        return ast.Attribute(self.identifier(name), arguments_of(arguments), span=at)

    def allowed(self, at: Span, *parts: Any) -> Any:
        """Returns the statements behind `@allow`, which is said of the first of them."""
        attributes, (first, *others) = _split(parts)
        for attribute in attributes:
            if fold(attribute.name.text) != ast.ALLOW:
                word = self.source.text[first.span.start : first.span.end].split(None, 1)[0]
                self.diagnostics.append(out_of_place(attribute.span, f"`{word}`"))
        doc = {"doc": self.docs.get(at.start)} if hasattr(first, "doc") else {}
        span = self.span(at.start, first.span.end)
        return [replace(first, allowing=(*attributes, *first.allowing), span=span, **doc), *others]

    at = under("at")
    rotated = under("rotated")

    def placement(self, at: Span, *parts: tuple[str, ast.Expression]) -> ast.Placement:
        by_word = dict(parts)
        return ast.Placement(by_word.get("at"), by_word.get("rotated"), span=at)

    def index(self, at: Span, *values: ast.Expression) -> tuple[str, tuple[ast.Expression, ...]]:
        return "index", values

    def parameter(self, at: Span, name: Token, *parts: Any) -> ast.Parameter:
        kind = next((p for p in parts if isinstance(p, ast.Identifier)), None)
        default = parts[-1] if parts and not isinstance(parts[-1], ast.Identifier) else None
        return ast.Parameter(self.identifier(name), kind, default, span=at)

    def parameter_type(self, at: Span, name: Token) -> ast.Identifier:
        return self.identifier(name)

    def construction(self, at: Span) -> bool:
        return True

    def assign(self, at: Span, *parts: Any) -> Any:
        attributes, rest = _split(parts)
        construction = rest[0] is True
        target, value = rest[1:3] if construction else rest[:2]
        placement = rest[-1] if isinstance(rest[-1], ast.Placement) else None
        indices: list[ast.Expression] = []
        while isinstance(target, ast.Index):
            indices.insert(0, target.index)
            target = target.value
        name = ast.Identifier(target.text, span=target.span)
        doc = self.docs.get(at.start)

        def make(value: ast.Expression, span: Span) -> ast.Assign:
            rest = placement, construction, attributes, doc
            return ast.Assign(name, tuple(indices), value, *rest, span=span)

        return self._ending_in(at, value, make)

    def _ending_in(
        self, at: Span, value: ast.Expression | ThenIf, make: Callable[[Any, Span], ast.Statement]
    ) -> Any:
        """Builds the statement that ends in `value`, and the `if` after it if there is one."""
        if isinstance(value, ThenIf):
            return [make(value.value, self.span(at.start, value.value.span.end)), value.following]
        return make(value, at)

    # --- Values ---

    def param(self, at: Span, name: Token, value: ast.Expression, *parts: Any) -> ast.Param:
        by_word = dict(parts)
        return ast.Param(
            self.identifier(name),
            value,
            by_word.get("in"),
            by_word.get("step"),
            self.docs.get(at.start),
            span=at,
        )

    domain = under("in")
    step = under("step")

    var, let = gives(ast.Var), gives(ast.Let)

    def function(self, at: Span, name: Token, *parts: Any) -> Any:
        doc, parameters = self.docs.get(at.start), parts[0] if len(parts) > 1 else ()

        def make(value: ast.Expression, span: Span) -> ast.FunctionDefinition:
            return ast.FunctionDefinition(self.identifier(name), parameters, value, doc, span=span)

        return self._ending_in(at, parts[-1], make)

    def alias(self, at: Span, name: Token, target: Token) -> ast.Alias:
        return ast.Alias(self.identifier(name), self.identifier(target), self.docs.get(at.start), span=at)

    shape, constraint = defines(ast.ShapeDefinition), defines(ast.ConstraintDefinition)

    def import_(
        self, at: Span, path: Token, alias: Token | None = None, names: Sequence[Token] = ()
    ) -> ast.Import:
        text = self.string(self.span(path.start, path.end), path)
        called = None if alias is None else self.identifier(alias)
        return ast.Import(text, called, tuple(map(self.identifier, names)), span=at)

    import_as = import_

    def import_names(self, at: Span, *parts: Token) -> ast.Import:
        return self.import_(at, parts[-1], None, parts[:-1])

    todo = makes(ast.Todo)

    # --- Constraints ---

    def constrain(self, at: Span, value: Any) -> Any:
        if isinstance(value, ast.For | ast.If):
            value = ast.Block((value,), span=value.span)
        if isinstance(value, ast.Block):
            return ast.Constrain(value, True, span=at)

        def make(item: Any, span: Span) -> ast.Constrain:
            if not isinstance(item, ast.Equation):
                item = ast.ExpressionStatement(item, span=item.span)
            return ast.Constrain(ast.Block((item,), span=item.span), False, span=span)

        return self._ending_in(at, value, make)

    def item_constrain(self, at: Span, value: Any) -> Any:
        """Returns the items of a `constrain` inside `constrain`, which adds nothing."""
        made = self.constrain(at, value)
        statements: list[ast.Statement] = []
        for statement in made if isinstance(made, list) else [made]:
            statements += statement.items.statements if isinstance(statement, ast.Constrain) else [statement]
        return statements

    equation = makes(ast.Equation)

    def prefer(
        self, at: Span, value: ast.Expression, weight: tuple[str, ast.Expression] | None = None
    ) -> ast.Prefer:
        return ast.Prefer(value, weight[1] if weight else None, span=at)

    weight = under("weight")

    def assert_(self, at: Span, test: ast.Expression, message: ast.Expression | None = None) -> ast.Assert:
        if message is None and isinstance(test, ast.Point):  # `assert(a.width > 3, "too narrow")`
            return ast.Assert(test.x, test.y, span=at)
        return ast.Assert(test, message, span=at)

    expression_statement = makes(ast.ExpressionStatement)

    # --- Control ---

    for_, if_ = repeats(ast.For, ast.Block), chooses(ast.If, ast.Block)

    def interrupted(self, at: Span, value: ast.Expression, word: Token, *choice: Any) -> ThenIf:
        """Builds an expression, and the `if` statement that begins with `word`."""
        return ThenIf(value, self.if_(self.span(word.start, at.end), *choice))

    def interrupted_argument(self, at: Span, value: ast.Expression, word: Token, *choice: Any) -> ThenIf:
        """Builds an argument, and the block that begins with `word`."""
        return ThenIf(value, self.if_arguments(self.span(word.start, at.end), *choice))

    def conditional(self, at: Span, test: ast.Expression, then: ast.Expression, otherwise: Any) -> Any:
        if isinstance(otherwise, ThenIf):
            shorter = self.span(at.start, otherwise.value.span.end)
            value = self.conditional(shorter, test, then, otherwise.value)
            return ThenIf(value, otherwise.following)
        return ast.Conditional(test, then, otherwise, span=at)

    def conditional_after(self, at: Span, then: ast.Expression, test: ast.Expression, other: Any) -> Any:
        return self.conditional(at, test, then, other)


@record()
class _Generator:
    """`element for variables in iterable if condition`, not yet known to stand in brackets or in a call."""

    parts: tuple[ast.Expression, tuple[ast.Identifier, ...], ast.Expression, ast.Expression | None]
    span: Span


def arguments_of(value: Any) -> tuple[ast.Argument, ...]:
    """Returns the arguments of a call; its only one may be a bare comprehension: `sum(a for a in b)`."""
    if isinstance(value, _Generator):
        comprehension = ast.Comprehension(*value.parts, span=value.span)
        return (ast.Argument(None, comprehension, span=value.span),)
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


@record()
class ThenIf:
    """The expression at the end of a statement and the `if` that follows it."""

    value: ast.Expression
    following: ast.If | ast.IfArguments


def out_of_place(attribute: Span, before: str) -> Diagnostic:
    """Returns what is said of an attribute before something that takes none, or no other than `@allow`."""
    message = f"an attribute stands before a structure or a geometry, not before {before}"
    hint = 'write it in front of the definition it is about: `@color("red") solid a { … }`'
    return Diagnostic("E0119", message, attribute, hints=(hint,))


def _split(parts: tuple[Any, ...]) -> tuple[tuple[ast.Attribute, ...], list[Any]]:
    return (
        tuple(p for p in parts if isinstance(p, ast.Attribute)),
        [p for p in parts if not isinstance(p, ast.Attribute)],
    )
