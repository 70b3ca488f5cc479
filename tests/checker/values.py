"""Numbers and points that remember how exactly they were meant, and the scopes that names are found in."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cache
from typing import Any

from tests.checker.tree import Node


class Exact(IntEnum):
    """How strongly a written value binds; of mixed operands the strongest counts."""

    GUESS = 0
    NUMBER = 1
    PARAM = 2
    FIXED = 3
    REFERENCE = 4


@dataclass(frozen=True)
class Num:
    """Lengths in mm, angles in degrees."""

    value: float
    exact: Exact = Exact.NUMBER
    is_angle: bool = False


@dataclass(frozen=True)
class Point:
    x: Num
    y: Num

    @property
    def xy(self) -> tuple[float, float]:
        return self.x.value, self.y.value


@dataclass(frozen=True)
class Boxed:
    """The common box of some structures, geometry and points, not yet measured."""

    sources: tuple[Any, ...]


class UnavailableError(Exception):
    """The document does not say what is needed (the value of a `var`, the area of a region)."""


class MistakeError(Exception):
    """The program does something the checker does not know."""


def reference(value: float, *, is_angle: bool = False) -> Num:
    return Num(float(value), Exact.REFERENCE, is_angle)


def point_at(p: tuple[float, float]) -> Point:
    return Point(reference(p[0]), reference(p[1]))


_ARITHMETIC: dict[str, Callable[[float, float], float]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "%": lambda a, b: a % b,
    "^": lambda a, b: a**b,
}


def arithmetic(operator: str, a: Any, b: Any) -> Any:
    """Numbers with numbers, points with points and with numbers; `+` joins texts and lists."""
    if operator == "+" and type(a) is type(b) and isinstance(a, str | list):
        return a + b
    if isinstance(a, Num) and isinstance(b, Num):
        try:
            value = _ARITHMETIC[operator](a.value, b.value)
        except (ArithmeticError, ValueError):
            value = math.nan
        is_angle = a.is_angle or b.is_angle
        if operator == "/" and a.is_angle and b.is_angle:
            is_angle = False
        return Num(value, max(a.exact, b.exact), is_angle)
    if isinstance(a, Point) and isinstance(b, Point) and operator in "+-":
        return Point(arithmetic(operator, a.x, b.x), arithmetic(operator, a.y, b.y))
    if isinstance(a, Point) and isinstance(b, Num) and operator in "*/":
        return Point(arithmetic(operator, a.x, b), arithmetic(operator, a.y, b))
    if isinstance(a, Num) and isinstance(b, Point) and operator == "*":
        return Point(arithmetic("*", a, b.x), arithmetic("*", a, b.y))
    raise MistakeError(f"{type(a).__name__} {operator} {type(b).__name__}")


def marked(value: Any, exact: Exact) -> Any:
    """The same value with another exactness."""
    match value:
        case Num():
            return Num(value.value, exact, value.is_angle)
        case Point():
            return Point(marked(value.x, exact), marked(value.y, exact))
        case list():
            return [marked(v, exact) for v in value]
        case _:
            return value


@cache
def fold(name: str) -> str:
    """Spellings that mean the same name."""
    return name.replace("_", "").lower()


@dataclass
class Scope:
    """Names seen at a place. A value may be a `Thunk`. `node` is set for the scope of a structure's body.

    `functions` and `aliases` are by folded names.
    """

    parent: Scope | None
    names: dict[str, Any] = field(default_factory=dict)
    node: Node | None = None
    functions: dict[str, list[tuple[Any, Scope]]] = field(default_factory=dict)
    aliases: dict[str, str] = field(default_factory=dict)
    is_library: bool = False

    def find(self, name: str) -> tuple[Any, Scope] | None:
        """A value and the scope that has it; as written, then without regard to case and underscores."""
        for is_exact in (True, False):
            for here in self.chain():
                for names in here._layers():
                    if name in names:
                        return names[name], here
                    if not is_exact:
                        for known, value in names.items():
                            if fold(known) == fold(name):
                                return value, here
        return None

    def chain(self) -> Iterator[Scope]:
        """This scope and those around it, innermost first."""
        here: Scope | None = self
        while here is not None:
            yield here
            here = here.parent

    def _layers(self) -> tuple[dict[str, Any], ...]:
        """A structure's members come before other names, its own name and `self` after them."""
        if self.node is None:
            return (self.names,)
        own = {self.node.name.partition("[")[0]: self.node, "self": self.node}
        return self.node.members(), self.names, own

    def candidates(self, name: str) -> list[tuple[Any, Scope]]:
        """Callables of a name that a program defines, innermost first, and then those of the library."""
        wanted = fold(self.canonical(name))
        return [c for here in self.chain() for c in here.functions.get(wanted, ())]

    def own(self, name: str) -> list[tuple[Any, Scope]]:
        """The candidates that a program defines itself."""
        return [c for c in self.candidates(name) if not c[1].is_library]

    def canonical(self, name: str) -> str:
        for here in self.chain():
            if not here.is_library and fold(name) in here.functions:
                return name
            target = here.aliases.get(fold(name))
            if target is not None:
                return self.canonical(target) if fold(target) != fold(name) else target
        return name


@dataclass(frozen=True)
class Thunk:
    """An expression that is evaluated where its name is used. `kind` is `let`, `param` or `var`."""

    expression: Any
    scope: Scope
    kind: str = "let"
    name: str = ""
