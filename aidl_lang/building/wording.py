"""A statement that constrains, kept so that it can be read again in other words at its place.

Messages about conflicts try other numbers in it: only the definitions themselves, a user's as well as the
library's, decide what a number does to the equations.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from typing import TypeVar

from aidl_lang.building.model import Comparison, Condition, Geometry, Structure
from aidl_lang.building.state import Env, Interpreter, Stop
from aidl_lang.building.values import Num, PointVal, Value, members
from aidl_lang.common.records import record
from aidl_lang.common.running import limited_to
from aidl_lang.syntax import ast

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
