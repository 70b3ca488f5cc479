"""The syntax tree: frozen nodes with spans, and trees as plain data."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import field
from typing import Any, TypeAlias, TypeGuard, dataclass_transform

from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span

# Nodes compare and hash by identity, so that passes can keep tables keyed by node; `same` compares two trees
# by content, leaving places and comments aside.


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
class _Recorded:
    """What makes a record of each class of nodes."""

    def __init_subclass__(cls) -> None:
        record(eq=False, repr=False)(cls)


class Node(_Recorded):
    span: Span = field(kw_only=True)


class Identifier(Node):
    """A name at the place where it is written (a definition, a member, an argument's name)."""

    text: str


class Number(Node):
    """`value` is the number as written, without its unit applied; `text` its digits, for the printer."""

    value: float
    unit: str | None
    text: str


class String(Node):
    value: str


class Boolean(Node):
    value: bool


class Name(Node):
    text: str


class Member(Node):
    """`value.name`"""

    value: Expression
    name: Identifier


class Index(Node):
    """`value[index]`"""

    value: Expression
    index: Expression


class Argument(Node):
    name: Identifier | None
    value: Expression


class Call(Node):
    """`callee(…)`, or `receiver.callee(…)`, which is the same call with the receiver as first argument."""

    callee: Identifier
    receiver: Expression | None
    arguments: tuple[Argument, ...]


class Point(Node):
    """`(x, y)`"""

    x: Expression
    y: Expression


class List(Node):
    """`[a, b, …]`; with two numbers where a point is expected it is a point."""

    items: tuple[Expression, ...]


class Comprehension(Node):
    """`[element for variable in iterable if condition]`. A further `for` in the brackets is the element of
    the one before it, and `is_joined`: its members are members of the whole.
    """

    element: Expression
    variables: tuple[Identifier, ...]
    iterable: Expression
    condition: Expression | None
    is_joined: bool = False

    @property
    def innermost(self) -> Comprehension:
        """The last `for` in the brackets, whose element is that of the whole."""
        inner = self
        while isinstance(inner.element, Comprehension) and inner.element.is_joined:
            inner = inner.element
        return inner


class ArgumentBlock(Node):
    """`{ arguments }` in a call; the names that its `let`s give are its own."""

    items: tuple[Let | Expression, ...]


class ForArguments(Node):
    """`for variable in iterable { arguments }` among the arguments of a call."""

    variables: tuple[Identifier, ...]
    iterable: Expression
    body: ArgumentBlock


class IfArguments(Node):
    """`if test { arguments } else { arguments }` among the arguments of a call; `else if` holds one more."""

    test: Expression
    then: ArgumentBlock
    otherwise: ArgumentBlock | None


class Unary(Node):
    """`operator` is `-`, `+` or `not`."""

    operator: str
    operand: Expression


class Binary(Node):
    """`operator` is one of `+ - * / % ^ and or`."""

    operator: str
    left: Expression
    right: Expression


class Comparison(Node):
    """A chain `a <= b < c`: one operand more than operators (`== != <= >= < >`)."""

    operands: tuple[Expression, ...]
    operators: tuple[str, ...]


class Membership(Node):
    """`value in range`"""

    value: Expression
    container: Expression


class Range(Node):
    """`start..end` (both ends) or `start..<end` (without the last); for a `for` it may have a `step`."""

    start: Expression
    end: Expression
    exclusive: bool
    step: Expression | None = None


class Conditional(Node):
    """`if test then a else b`, also written `a if test else b`."""

    test: Expression
    then: Expression
    otherwise: Expression


Expression: TypeAlias = (
    Number | String | Boolean | Name | Member | Index | Call | Point | List | Comprehension | ForArguments
    | IfArguments | Unary | Binary | Comparison | Membership | Range | Conditional
)  # fmt: skip


class Parameter(Node):
    """A parameter of a template, shape, constraint or function: `name: type = default`."""

    name: Identifier
    type: Identifier | None
    default: Expression | None


class Placement(Node):
    """`at POINT` and `rotated ANGLE`, each at most once."""

    at: Expression | None
    rotated: Expression | None


ALLOW = "allow"
"""The attribute that silences notes and warnings, which may stand before any statement."""


class Attribute(Node):
    """`@name(arguments)`"""

    name: Identifier
    arguments: tuple[Argument, ...]


class Allowing(Node):
    """A statement before which no attributes stand but `@allow(…)`."""

    allowing: tuple[Attribute, ...] = field(default=(), kw_only=True)


class Block(Node):
    """`{ statements }`"""

    statements: tuple[Statement, ...]


class Structure(Node):
    """`KIND NAME[index] { … }`; with `parameters` (even an empty list) it is a template.

    `kind` is canonical (assembly, solid, hole, drawing), `kind_word` as written (`part`, `cut`, …).
    """

    kind: str
    kind_word: Identifier
    name: Identifier
    indices: tuple[Expression, ...]
    parameters: tuple[Parameter, ...] | None
    placement: Placement | None
    attributes: tuple[Attribute, ...]
    body: Block
    doc: str | None


class Param(Allowing):
    """`param name = value in domain step step`"""

    name: Identifier
    value: Expression
    domain: Expression | None
    step: Expression | None
    doc: str | None


class Var(Allowing):
    name: Identifier
    value: Expression
    doc: str | None


class Let(Allowing):
    name: Identifier
    value: Expression
    doc: str | None


class Assign(Node):
    """`name[index] = value at … rotated …`, or `construction name = value`."""

    name: Identifier
    indices: tuple[Expression, ...]
    value: Expression
    placement: Placement | None
    construction: bool
    attributes: tuple[Attribute, ...]
    doc: str | None


class ExpressionStatement(Allowing):
    """A bare expression: a constraint without its keyword, or an operation such as `rotate(r, 30deg)`."""

    value: Expression


class Constrain(Allowing):
    """`constrain EXPR` (one item, no block) or `constrain { … }`.

    Items are ExpressionStatement, Equation (`a.x = b`, understood as `==`), Assign, For, If, Let, Prefer.
    """

    items: Block
    braces: bool


class Equation(Allowing):
    """`left = right` inside `constrain`, which means `==`."""

    left: Expression
    right: Expression

    @property
    def meant(self) -> Comparison:
        return Comparison((self.left, self.right), ("==",), span=self.span)


class Prefer(Allowing):
    value: Expression
    weight: Expression | None


class Assert(Allowing):
    test: Expression
    message: Expression | None


class For(Allowing):
    variables: tuple[Identifier, ...]
    iterable: Expression
    body: Block


class If(Allowing):
    """`otherwise` is a Block; `else if` is a block that holds one If."""

    test: Expression
    then: Block
    otherwise: Block | None


class Import(Allowing):
    """`import "path"`, `import "path" as alias`, `import a, b from "path"` (`names`)."""

    path: String
    alias: Identifier | None
    names: tuple[Identifier, ...]


class FunctionDefinition(Allowing):
    """`fn name(parameters) = value`"""

    name: Identifier
    parameters: tuple[Parameter, ...]
    value: Expression
    doc: str | None


class ShapeDefinition(Allowing):
    """`shape name(parameters) { … }`"""

    name: Identifier
    parameters: tuple[Parameter, ...]
    body: Block
    doc: str | None


class ConstraintDefinition(Allowing):
    """`constraint name(parameters) { … }`; the items of the body are those of `constrain`."""

    name: Identifier
    parameters: tuple[Parameter, ...]
    body: Block
    doc: str | None


class Alias(Allowing):
    """`alias name = target`"""

    name: Identifier
    target: Identifier
    doc: str | None


class Todo(Allowing):
    """`todo`: a body that its author knows is still to be filled in."""


Statement: TypeAlias = (
    Structure | Param | Var | Let | Assign | ExpressionStatement | Constrain | Equation | Prefer | Assert
    | For | If | Import | FunctionDefinition | ShapeDefinition | ConstraintDefinition | Alias | Todo
)  # fmt: skip

DEFINITIONS = (Import, Param, Let, Alias, FunctionDefinition, ShapeDefinition, ConstraintDefinition, Todo)
"""Statements that may stand beside the one structure of a file without making an assembly around both."""

Callable: TypeAlias = FunctionDefinition | ShapeDefinition | ConstraintDefinition | Structure


def is_definition(node: Node) -> TypeGuard[Callable]:
    """Tells whether a node is a function, shape, constraint or template, which is called."""
    return node.parameters is not None if isinstance(node, Structure) else isinstance(node, Callable)


@record()
class Comment:
    """A comment with its delimiters, kept for the printer."""

    span: Span = field(repr=False)
    text: str


class Module(Node):
    """A whole file. `comments` are all comments in text order, `///` ones included."""

    source: SourceFile
    statements: tuple[Statement, ...]
    comments: tuple[Comment, ...]


def attributes(node: Structure | Assign | Allowing) -> tuple[Attribute, ...]:
    """Returns the attributes before a statement."""
    return node.attributes if isinstance(node, Structure | Assign) else node.allowing


def children(node: Node) -> Iterator[Node]:
    """Yields the nodes directly below one, in text order of their fields."""
    names: tuple[str, ...] = node.__match_args__  # every field but the span and `allowing`
    for name in names:
        value = getattr(node, name)
        if isinstance(value, Node):
            yield value
        elif type(value) is tuple:
            for item in value:
                if isinstance(item, Node):
                    yield item


def walk(node: Node) -> Iterator[Node]:
    """Yields a node and all nodes below it, parents first."""
    stack = [node]
    while stack:
        yield (top := stack.pop())
        stack.extend(reversed(list(children(top))))


def same(a: object, b: object) -> bool:
    """Tells whether two trees have the same content, spans, comments and source aside."""
    if isinstance(a, Node) and isinstance(b, Node):
        return type(a) is type(b) and all(
            same(getattr(a, f.name), getattr(b, f.name))
            for f in dataclasses.fields(a)
            if f.name not in ("span", "comments", "source")
        )
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(same, a, b))
    return a == b


# --- Syntax trees as plain data, which JSON keeps: numbers, texts, lists, None.
#
# A node is `[number of its class, start, end, fields …]`, a tuple `[0, items …]`; everything else stands for
# itself. The numbers are those of this version's classes, so data goes with the code that made it.

_TUPLE = 0
_CLASSES: tuple[Any, ...] = (
    tuple,
    *(kind for kind in list(globals().values()) if isinstance(kind, type) and issubclass(kind, Node)),
)
_NUMBERS = {kind: number for number, kind in enumerate(_CLASSES)}


def encoded(value: object) -> object:
    """Returns a tree as data, without its text. Raises TypeError for a value that no tree has."""
    if isinstance(value, Node):
        names: tuple[str, ...] = value.__match_args__  # every field but the span
        fields = [encoded(getattr(value, name)) for name in names]
        return [_NUMBERS[type(value)], value.span.start, value.span.end, *fields]
    if isinstance(value, tuple):
        return [_TUPLE, *map(encoded, value)]
    if value is None or isinstance(value, str | bool | int | float):
        return value
    raise TypeError(f"{type(value).__name__} is no part of a syntax tree")


def decoded(data: Any, source: SourceFile) -> Any:
    """Returns the tree that `encoded` made into data, in the text it was parsed from."""
    if type(data) is not list:
        return data
    number = data[0]
    if number == _TUPLE:
        return tuple([decoded(item, source) for item in data[1:]])
    fields = [decoded(item, source) if type(item) is list else item for item in data[3:]]
    return _CLASSES[number](*fields, span=Span(source, data[1], data[2]))
