"""Expressions over unknowns: a program's arithmetic on numbers that a solver has to find.

An expression is an immutable node of a shared graph. Each carries the value it has at the first guesses, so
that branches and readings can be chosen by what was written. Arithmetic over constants is folded, hence an
expression is constant exactly when `op == "constant"`. Angles inside this graph are radians only between a
trigonometric node and its argument; every number of the language is in millimetres or degrees.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, TypeVar

from aidl_lang.common.records import record

if TYPE_CHECKING:
    from aidl_lang.building.boxes import Side
    from aidl_lang.building.model import Geometry, Structure

T = TypeVar("T")

DEGREE = math.pi / 180.0

LARGEST = 1e30
"""The largest number of a program: squares and cubes of such numbers, and their sums, are still finite."""


def is_number(value: float) -> bool:
    """Tells whether a program may work with a value: not with NaN, infinity, or numbers beyond LARGEST."""
    return abs(value) <= LARGEST


_WAYS = {"length": "distance", "angle": "direction", "dx": "horizontal distance", "dy": "vertical distance"}


@record(frozen=False, eq=False)
class Unknown:
    """A number that the solver finds.

    guess     the first guess: what was written
    kept      a size: changes only if the constraints cannot hold otherwise
    holder    the geometry or structure it belongs to, `field` its name there (`center.x`)
    owner     the structure that owns it
    angular   counts in degrees
    frame_of  for a coordinate of a frame, the structure that frame places
    cell      stands for a number argument, and may still be read as a constant while building
    exact     a constant after all: read while building, or locked and named by no constraint
    outline   a side of the box of an empty structure
    locked    an angle that stays as written until a constraint asks it to turn
    since     for the way to a literal point, the name of the one before it
    implied   follows from literal points, and no number was written for it
    """

    guess: float
    owner: Structure
    holder: Geometry | Structure
    field: str
    kept: bool = False
    angular: bool = False
    frame_of: Structure | None = None
    cell: bool = False
    exact: bool = False
    locked: bool = False
    outline: bool = False
    since: str = ""
    implied: bool = False

    @property
    def path(self) -> str:
        return f"{self.holder.path}.{self.field}"

    @property
    def is_size(self) -> bool:
        """True if half of it is another size: not for an angle, nor a coordinate of the way to a point."""
        is_offset = bool(self.since) and self.field.endswith((".dx", ".dy"))
        return not self.angular and not (is_offset and "_to." not in self.field)

    @property
    def description(self) -> str:
        """Its description for people, as not every unknown has a name in the program."""
        if self.since:
            target, _, measure = self.path.rpartition(".")
            if target.endswith("_to"):  # the library's name for the point where a size ends
                return f"`{target.removesuffix('_to')}`"
            return f"the {_WAYS[measure]} from `{self.holder.path}.{self.since}` to `{target}`"
        if self.holder.is_nameless:
            return f"`{self.field}` of a {self.holder.path.rpartition('.')[2]} in `{self.owner.path}`"
        return quoted(self.path)


def quoted(path: str) -> str:
    """Returns a path for people: no program can name the nameless parts of an outline made of others."""
    outline, is_source, rest = path.partition(".source[")
    if not is_source:
        return f"`{path}`"
    number, _, inside = rest.partition("]")
    of = f"`{inside[1:]}` of " if inside else ""
    return f"{of}nameless outline {int(number) + 1} in `{outline}`"


@record(frozen=False, eq=False, slots=True)
class Expression:
    """A node of an expression graph. `payload` is an `Unknown`, the side of a box, or a measurement for the
    ops that need one, and for a constant written as a number in the text, its place; `is_open` marks a graph
    with a side or a measurement in it, so that no other is searched for them.
    """

    op: str
    args: tuple[Expression, ...]
    value: float
    is_open: bool = False
    payload: Any = None

    @property
    def is_constant(self) -> bool:
        return self.op == "constant"

    def __add__(self, other: Expression | float) -> Expression:
        if not isinstance(other, Expression):
            other = constant(other)
        if other.op == "constant":
            if self.op == "constant":
                return Expression("constant", (), self.value + other.value)
            if other.value == 0.0:
                return self
        elif self.op == "constant" and self.value == 0.0:
            return other
        return Expression("add", (self, other), self.value + other.value, self.is_open or other.is_open)

    def __sub__(self, other: Expression | float) -> Expression:
        if not isinstance(other, Expression):
            other = constant(other)
        if other.op == "constant":
            if self.op == "constant":
                return Expression("constant", (), self.value - other.value)
            if other.value == 0.0:
                return self
        return Expression("sub", (self, other), self.value - other.value, self.is_open or other.is_open)

    def __mul__(self, other: Expression | float) -> Expression:
        if not isinstance(other, Expression):
            if isinstance(other, Place):
                return NotImplemented
            other = constant(other)
        if self.op == "constant":
            if other.op == "constant":
                return Expression("constant", (), self.value * other.value)
            factor, rest = self.value, other
        else:
            factor, rest = (other.value, self) if other.op == "constant" else (math.nan, self)
        if factor == 1.0:
            return rest
        if factor == 0.0:
            return ZERO
        return Expression("mul", (self, other), self.value * other.value, self.is_open or other.is_open)

    def __truediv__(self, other: Expression | float) -> Expression:
        if not isinstance(other, Expression):
            other = constant(other)
        value = EVALUATE["div"](self.value, other.value)
        if other.op == "constant":
            if self.op == "constant":
                return Expression("constant", (), value)
            if other.value == 1.0:
                return self
        return Expression("div", (self, other), value, self.is_open or other.is_open)

    def __radd__(self, other: float) -> Expression:
        return constant(other) + self

    def __rsub__(self, other: float) -> Expression:
        return constant(other) - self

    def __rmul__(self, other: float) -> Expression:
        return constant(other) * self

    def __rtruediv__(self, other: float) -> Expression:
        return constant(other) / self

    def __neg__(self) -> Expression:
        return apply("neg", self)


def constant(value: float) -> Expression:
    return Expression("constant", (), float(value))


class Place(NamedTuple):
    """A point of the plane, or a way in it."""

    x: Expression
    y: Expression

    def __add__(self, other: Place) -> Place:  # type: ignore[override]
        return Place(self.x + other.x, self.y + other.y)

    def __sub__(self, other: Place) -> Place:
        return Place(self.x - other.x, self.y - other.y)

    def __rmul__(self, factor: Expression | float) -> Place:  # type: ignore[override]
        return Place(factor * self.x, factor * self.y)

    @property
    def turned_over(self) -> Place:
        """It reflected at the vertical axis."""
        return Place(-self.x, self.y)

    def turned(self, by: Place) -> Place:
        """Returns it turned by an angle, of which `by` are the cosine and the sine."""
        return Place(by.x * self.x - by.y * self.y, by.y * self.x + by.x * self.y)

    @property
    def direction(self) -> Expression:
        """The direction of a way in degrees."""
        return atan2(self.y, self.x)

    @property
    def length(self) -> Expression:
        return apply("hypot", self.x, self.y)

    @property
    def written(self) -> tuple[float, float]:
        """Where it is at the first guesses."""
        return self.x.value, self.y.value


def literal(value: float, written: object) -> Expression:
    """Returns a constant that is `written` as a number in the text; results computed from it are not."""
    return Expression("constant", (), value, payload=written)


ZERO = constant(0.0)
ONE = constant(1.0)


def unknown(source: Unknown) -> Expression:
    return Expression("unknown", (), source.guess, payload=source)


def lazy(source: Side) -> Expression:
    """Returns a side of a box that is spelled out only when the comparison it stands in is known."""
    return Expression("lazy", (), source.value, is_open=True, payload=source)


def measure(source: object) -> Expression:
    """Returns a number that only the finished drawing has; it has no value before."""
    return Expression("measure", (), math.nan, is_open=True, payload=source)


def _safe(function: Callable[..., float]) -> Callable[..., float]:
    """Wraps arithmetic to return nan for a number that does not exist, as the solver's does."""

    def evaluate(*args: float) -> float:
        try:
            result = function(*args)
        except (ValueError, ZeroDivisionError, OverflowError):
            return math.nan
        return result if isinstance(result, float | int) else math.nan

    return evaluate


def _cubic_max(p0: float, p1: float, p2: float, p3: float) -> float:
    """Returns the largest value of a cubic in Bernstein form over 0 <= t <= 1."""
    a, b, c = -p0 + 3 * p1 - 3 * p2 + p3, 2 * (p0 - 2 * p1 + p2), p1 - p0
    roots: list[float] = []
    if abs(a) > 1e-12 * (abs(b) + abs(c) + 1e-300):
        discriminant = b * b - 4 * a * c
        if discriminant >= 0:
            root = math.sqrt(discriminant)
            q = -0.5 * (b + math.copysign(root, b))
            roots = [q / a, c / q if q else 0.0]
    elif b:
        roots = [-c / b]

    def at(t: float) -> float:
        s = 1 - t
        return s * s * s * p0 + 3 * s * s * t * p1 + 3 * s * t * t * p2 + t * t * t * p3

    return max([p0, p3, *(at(t) for t in roots if 0 < t < 1)])


EVALUATE: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "neg": lambda a: -a,
    "div": _safe(lambda a, b: a / b),
    "power": _safe(lambda a, b: a**b),
    "sin": _safe(math.sin),
    "cos": _safe(math.cos),
    "tan": _safe(math.tan),
    "asin": _safe(math.asin),
    "acos": _safe(math.acos),
    "atan2": math.atan2,
    "sqrt": _safe(math.sqrt),
    "abs": abs,
    "square": lambda a: a * a,
    "hypot": math.hypot,
    "minimum": lambda *args: min(args),
    "maximum": lambda *args: max(args),
    "mod": _safe(lambda a, b: a - b * math.floor(a / b)),
    "select": lambda c, a, b: a if c >= 0 else b,
    "cubic_max": _cubic_max,
}
"""The meaning of each op; the solver's tape has the same ops under the same names."""


def apply(op: str, *args: Expression) -> Expression:
    """Returns a node, folded if all arguments are constants or if it changes nothing."""
    if (folded := _FOLDED.get(op)) is not None:
        return folded(*args)
    value = EVALUATE[op](*[a.value for a in args])
    for arg in args:
        if arg.op != "constant":
            return Expression(op, args, value, True in [a.is_open for a in args])
    return Expression("constant", (), value)


_FOLDED: dict[str, Callable[..., Expression]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
}
"""The operations of most nodes, each with its own folding."""


def sin(degrees: Expression) -> Expression:
    if degrees.is_constant:
        return constant(exact_turn(degrees.value)[1])
    return apply("sin", degrees * DEGREE)


def cos(degrees: Expression) -> Expression:
    if degrees.is_constant:
        return constant(exact_turn(degrees.value)[0])
    return apply("cos", degrees * DEGREE)


def atan2(y: Expression, x: Expression) -> Expression:
    """Returns the direction of (x, y) in degrees."""
    return apply("atan2", y, x) * (1.0 / DEGREE)


def towards(degrees: Expression) -> Place:
    """Returns the way of length 1 in a direction: the cosine and the sine of it."""
    return Place(cos(degrees), sin(degrees))


def exact_turn(degrees: float) -> tuple[float, float]:
    """Returns cosine and sine, exact at multiples of a right angle."""
    quarter = degrees / 90.0
    if not math.isfinite(quarter):
        return math.nan, math.nan
    if quarter == round(quarter):
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(quarter) % 4]
    return math.cos(degrees * DEGREE), math.sin(degrees * DEGREE)


def nodes(roots: Iterable[Expression], *, only_open: bool = False) -> Iterator[Expression]:
    """Yields every node below the roots once, arguments first; or the open ones, the top of each graph."""
    seen: set[Expression] = set()
    for root in roots:
        stack = [(root, False)]
        while stack:
            node, done = stack.pop()
            if done:
                yield node
            elif node not in seen:
                seen.add(node)
                if node.args:
                    stack.append((node, True))
                    stack.extend((a, False) for a in node.args if a not in seen and a.is_open >= only_open)
                else:
                    yield node


def unknowns(roots: Iterable[Expression]) -> Iterator[Unknown]:
    """Yields the unknowns that the roots depend on, in the order of `nodes`."""
    seen: set[Expression] = set()
    for root in roots:
        stack = [root] if root.op != "constant" else []
        while stack:
            node = stack.pop()
            if node in seen:
                continue
            seen.add(node)
            if node.op == "unknown":
                yield node.payload
            elif node.op == "lazy":
                yield from node.payload.unknowns()
            else:
                stack.extend(node.args)


Leaf: TypeAlias = Callable[[Expression], T]
Operations: TypeAlias = Mapping[str, Callable[..., T]]


def folded(root: Expression, known: dict[Expression, T], make: Operations[T], leaf: Leaf[T]) -> T:
    """Returns what an expression comes to: each node below it is worked out once, and then `known`."""
    stack = [root]
    while stack:
        node = stack[-1]
        if node in known:
            pass
        elif args := node.args:
            if missing := [a for a in args if a not in known]:
                stack += missing
                continue
            known[node] = make[node.op](*[known[a] for a in args])
        elif node.op == "lazy":
            inner: Expression = node.payload.spelled_out
            if inner not in known:
                stack.append(inner)
                continue
            known[node] = known[inner]
        else:
            known[node] = leaf(node)
        stack.pop()
    return known[root]


@record(frozen=False)
class Evaluator:
    """An evaluator of expressions at given values of the unknowns, each node once.

    `measure` evaluates nodes that only the finished drawing can (areas, clearances).
    """

    values: Mapping[Unknown, float]
    measure: Callable[[object], float] | None = None
    _memo: dict[Expression, float] = field(default_factory=dict)

    def __call__(self, root: Expression) -> float:
        return folded(root, self._memo, EVALUATE, self._leaf)

    def _leaf(self, node: Expression) -> float:
        if node.op == "unknown":
            return self.values.get(node.payload, node.payload.guess)
        if node.op == "measure":
            return self.measure(node.payload) if self.measure else math.nan
        return node.value
