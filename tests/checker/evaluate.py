"""A small interpreter that computes expressions on the coordinates of a solved model."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, field
from inspect import signature
from typing import Any, TypeVar

from aidl_lang.checking.binding import PARAMETERS
from aidl_lang.syntax import ast
from tests.checker import fields, functions
from tests.checker.binding import chosen, respelled, with_defaults
from tests.checker.boxes import Box, around, extremes, structure_extremes
from tests.checker.tree import Array, Geo, Node, Transform, Vec
from tests.checker.values import (
    Boxed,
    Exact,
    MistakeError,
    Num,
    Point,
    Scope,
    Thunk,
    UnavailableError,
    arithmetic,
    fold,
    marked,
)

T = TypeVar("T")
_UNITS = {None: 1.0, "mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "ft": 304.8}
_WORDS = {"x", "y", "left", "right", "center", "top", "bottom", "middle"}
_WORDED = {"align", "side", "axis", "about", "place"}
_ANGLES = {"deg": 1.0, "°": 1.0, "rad": 180 / math.pi, "turn": 360.0}


@dataclass
class Evaluator:
    """Values as the structure `here` sees them."""

    here: Node
    used_nodes: list[Node] = field(default_factory=list)
    ignored: tuple[Node, ...] = ()
    depth: int = 0

    @property
    def frame(self) -> Transform:
        return self.here.world

    # --- Expressions ---------------------------------------------------------------------------

    def value(self, e: ast.Expression, scope: Scope) -> Any:
        method: Callable[[Any, Scope], Any] = getattr(self, f"_{type(e).__name__.lower()}")
        return method(e, scope)

    def _number(self, e: ast.Number, scope: Scope) -> Num:
        if e.unit in _ANGLES:
            return Num(e.value * _ANGLES[e.unit or ""], is_angle=True)
        return Num(e.value * _UNITS[e.unit])

    def _string(self, e: ast.String, scope: Scope) -> str:
        return e.value

    def _boolean(self, e: ast.Boolean, scope: Scope) -> bool:
        return e.value

    def _name(self, e: ast.Name, scope: Scope) -> Any:
        found = scope.find(e.text)
        if found is not None:
            return self.forced(*found)
        here: Scope | None = scope
        while here is not None and here.node is None:
            here = here.parent
        if here is not None and here.node is not None:
            known = fields.of_structure(self, here.node, e.text)
            if known is not None:
                return known
        if fold(e.text) in ("x", "y"):
            return fold(e.text)
        raise MistakeError(f"no value named {e.text}")

    def forced(self, value: Any, scope: Scope) -> Any:
        if not isinstance(value, Thunk):
            return value
        if value.kind == "let" and scope.is_library:  # the same for all who ask
            scope.names[value.name] = self.value(value.expression, value.scope)
            return scope.names[value.name]
        if value.kind == "let":
            return self.value(value.expression, value.scope)
        node = scope.node
        params = node.entry["params"] if node is not None else {}
        if value.name in params:
            known = params[value.name]
            if isinstance(known, str | bool):
                return known
            is_angle = getattr(self.value(value.expression, value.scope), "is_angle", False)
            return Num(float(known), Exact.PARAM if value.kind == "param" else Exact.REFERENCE, is_angle)
        if value.kind == "param":
            return marked(self.value(value.expression, value.scope), Exact.PARAM)
        raise UnavailableError(f"the document has no value for {value.name}")

    def _point(self, e: ast.Point, scope: Scope) -> Point:
        return Point(self.number(self.value(e.x, scope), 0), self.number(self.value(e.y, scope), 1))

    def _list(self, e: ast.List, scope: Scope) -> list[Any]:
        return [self.value(item, scope) for item in e.items]

    def _range(self, e: ast.Range, scope: Scope) -> list[Num]:
        start, end = (self.number(self.value(x, scope)).value for x in (e.start, e.end))
        step = 1.0 if e.step is None else self.number(self.value(e.step, scope)).value
        count = (end - start) / step
        last = math.ceil(count - 1e-9) - 1 if e.exclusive else math.floor(count + 1e-9)
        return [Num(start + i * step) for i in range(last + 1)]

    def _conditional(self, e: ast.Conditional, scope: Scope) -> Any:
        return self.value(e.then if self.truth(e.test, scope) else e.otherwise, scope)

    def _unary(self, e: ast.Unary, scope: Scope) -> Any:
        if e.operator == "not":
            return not self.truth(e.operand, scope)
        operand = self.plain(self.value(e.operand, scope))
        return arithmetic("*", Num(-1.0), operand) if e.operator == "-" else operand

    def _binary(self, e: ast.Binary, scope: Scope) -> Any:
        if e.operator in ("and", "or"):
            return self.truth(e, scope)
        left, right = self.value(e.left, scope), self.value(e.right, scope)
        if e.operator == "+" and type(left) is type(right) and isinstance(left, str | list):
            return arithmetic("+", left, right)
        return arithmetic(e.operator, self.plain(left), self.plain(right))

    def _comparison(self, e: ast.Comparison, scope: Scope) -> bool:
        return self.truth(e, scope)

    def _membership(self, e: ast.Membership, scope: Scope) -> bool:
        return self.truth(e, scope)

    def _comprehension(self, e: ast.Comprehension, scope: Scope) -> list[Any]:
        inner = [self.bound(e.variables, item, scope) for item in self.items(self.value(e.iterable, scope))]
        return [self.value(e.element, s) for s in inner if e.condition is None or self.truth(e.condition, s)]

    def _forarguments(self, e: ast.ForArguments, scope: Scope) -> list[Any]:
        turns = [self.bound(e.variables, item, scope) for item in self.items(self.value(e.iterable, scope))]
        return [value for turn in turns for value in self._in_block(e.body, turn)]

    def _ifarguments(self, e: ast.IfArguments, scope: Scope) -> list[Any]:
        taken = e.then if self.truth(e.test, scope) else e.otherwise
        return self._in_block(taken, scope) if taken is not None else []

    def _in_block(self, block: ast.ArgumentBlock, scope: Scope) -> list[Any]:
        inner, found = Scope(scope), list[Any]()
        for item in block.items:
            if isinstance(item, ast.Let):
                inner.names[item.name.text] = self.value(item.value, inner)
            else:
                value = self.value(item, inner)
                found += value if isinstance(value, list) else [value]
        return found

    def bound(self, variables: tuple[ast.Identifier, ...], item: Any, scope: Scope) -> Scope:
        names = [v.text for v in variables]
        values = [item] if len(names) == 1 else self.items(item)
        return Scope(scope, dict(zip(names, values, strict=True)))

    # --- Members -------------------------------------------------------------------------------

    def _member(self, e: ast.Member, scope: Scope) -> Any:
        return self.member(self.value(e.value, scope), e.name.text)

    def member(self, value: Any, name: str) -> Any:
        found = fields.member(self, value, name)
        if found is None:
            raise MistakeError(f"{type(value).__name__} {getattr(value, 'path', '')} has no {name}")
        return found

    def _index(self, e: ast.Index, scope: Scope) -> Any:
        value, key = self.value(e.value, scope), self.value(e.index, scope)
        if isinstance(key, str):
            return self.member(value, key)
        index = round(key.value)
        if isinstance(value, Array) and index in value.items:
            return value.items[index]
        return self.items(value)[index]

    def items(self, value: Any) -> list[Any]:
        if isinstance(value, Array):
            return value.list()
        if isinstance(value, list):
            return value
        if isinstance(value, Point):
            return [value.x, value.y]
        raise MistakeError(f"{type(value).__name__} is no list")

    # --- Conversions ---------------------------------------------------------------------------

    def number(self, value: Any, axis: int | None = None) -> Num:
        """A number; an edge is its coordinate here."""
        if isinstance(value, Geo) and value.type == "line":
            return fields.edge(self, value)
        if isinstance(value, Num):
            return value
        raise MistakeError(f"{type(value).__name__} {getattr(value, 'path', '')} is no number")

    def point(self, value: Any) -> Point:
        if isinstance(value, Point):
            return value
        if isinstance(value, list) and len(value) == 2:
            return Point(self.number(value[0]), self.number(value[1]))
        if isinstance(value, Geo) and value.type == "point":
            return fields.seen(self, value.data["at"])
        raise MistakeError(f"{type(value).__name__} {getattr(value, 'path', '')} is no point")

    def plain(self, value: Any) -> Num | Point:
        """What arithmetic works on."""
        if isinstance(value, Point) or (isinstance(value, Geo) and value.type == "point"):
            return self.point(value)
        if isinstance(value, list):
            return self.point(value)
        return self.number(value)

    # --- Boxes ---------------------------------------------------------------------------------

    def box(self, value: Any) -> Box:
        """Measured here and now, without the structures that this comparison ignores."""
        points: list[Vec] = []
        for source in self.sources(value):
            if isinstance(source, Node):
                self.used_nodes.append(source)
                below = [n for n in self.ignored if n is not source and n.within(source)]
                points += structure_extremes(source, self.frame, below)
            elif isinstance(source, Point):
                points.append(source.xy)
            else:
                points += extremes(source, self.frame)
        return around(points)

    def sources(self, value: Any) -> list[Any]:
        if isinstance(value, Boxed):
            return list(value.sources)
        if isinstance(value, Array | list):
            return [s for item in self.items(value) for s in self.sources(item)]
        if isinstance(value, Node | Geo | Point):
            return [value]
        raise MistakeError(f"{type(value).__name__} has no box")

    def together(self, measure: Callable[[], T]) -> T:
        """Evaluate one comparison: a box used with the box of a descendant leaves that descendant out."""
        with self._comparison_of(()) as used:
            found = measure()
        if any(a is not b and a.within(b) for a in used for b in used):
            with self._comparison_of(tuple(used)):
                found = measure()
        return found

    @contextmanager
    def _comparison_of(self, ignored: tuple[Node, ...]) -> Any:
        before = self.used_nodes, self.ignored
        self.used_nodes, self.ignored = [], ignored
        used = self.used_nodes
        try:
            yield used
        finally:
            self.used_nodes, self.ignored = before

    # --- Calls ---------------------------------------------------------------------------------

    def _call(self, e: ast.Call, scope: Scope) -> Any:
        """A function of the program, else one known here, else one that the library defines."""
        positional, named = self.arguments(e, scope)
        name = e.callee.text
        known = functions.FUNCTIONS.get(fold(name)) or functions.FUNCTIONS.get(fold(scope.canonical(name)))
        for candidates in (scope.own(name), [] if known else scope.candidates(name)):
            functions_only = [c for c in candidates if isinstance(c[0], ast.FunctionDefinition)]
            found = self.entered(functions_only, positional, named)
            if found is not None:
                return self.value(found[0].value, found[1])
        if known is None:
            raise MistakeError(f"no function named {name}")
        return known(self, *positional, **self.renamed(known, named))

    def arguments(self, e: ast.Call, scope: Scope) -> tuple[list[Any], dict[str, Any]]:
        positional = [] if e.receiver is None else [self.value(e.receiver, scope)]
        for a in e.arguments:
            if a.name is None:
                value = self.value(a.value, scope)
                positional += value if isinstance(a.value, ast.ForArguments | ast.IfArguments) else [value]
        named = {a.name.text: self._argument(a, scope) for a in e.arguments if a.name is not None}
        return positional, named

    def _argument(self, a: ast.Argument, scope: Scope) -> Any:
        """The value of a named argument; a bare word where a text is wanted is that word."""
        name = fold(a.name.text) if a.name is not None else ""
        takes_text = bool(_WORDED & {name, *PARAMETERS.get(name, ())})
        if takes_text and isinstance(a.value, ast.Name) and a.value.text in _WORDS:
            return a.value.text
        return self.value(a.value, scope)

    def entered(
        self, candidates: list[tuple[Any, Scope]], positional: list[Any], named: dict[str, Any]
    ) -> tuple[Any, Scope] | None:
        """The definition that a call means and the scope of that call; None when the arguments fit none."""
        found = chosen(candidates, positional, named, lambda value: value)
        if found is None:
            return None
        self.depth += 1
        if self.depth > 5000:
            raise MistakeError("calls without end")
        return found[0], with_defaults(self, *found)

    def renamed(self, relation: Callable[..., Any], named: dict[str, Any]) -> dict[str, Any]:
        """Named arguments of a relation or function by the names that it has here."""
        parameters = signature(relation).parameters
        if any(p.kind == p.VAR_KEYWORD for p in parameters.values()):
            return named
        return respelled([n for n in parameters if n != "ev"], named)

    # --- Truth ---------------------------------------------------------------------------------

    def truth(self, e: ast.Expression, scope: Scope) -> bool:
        """Whether a condition holds, to a millionth."""
        if isinstance(e, ast.Binary) and e.operator == "or":
            return self.truth(e.left, scope) or self.truth(e.right, scope)
        if isinstance(e, ast.Unary) and e.operator == "not":
            return not self.truth(e.operand, scope)
        if isinstance(e, ast.Comparison) and "!=" in e.operators:
            a, b = (self.value(o, scope) for o in e.operands)
            return not functions.same(self, a, b)
        from tests.checker.conditions import residuals

        return all(r <= 1e-6 for r in residuals(self, e, scope))
