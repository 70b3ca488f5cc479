"""The values that expressions of the language have while a program is built."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import IntEnum
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Expression, Place
from aidl_lang.checking.types import (
    ANY,
    ListType,
    ModuleType,
    PointType,
    RangeType,
    RecordType,
    Signature,
    StructureType,
    TextType,
    TruthType,
    Type,
    number_type,
    with_article,
)
from aidl_lang.checking.units import LENGTH, PLAIN, MaybeDimension
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.building.boxes import Box
    from aidl_lang.building.curves import Motion
    from aidl_lang.building.model import Condition, Geometry, Structure
    from aidl_lang.building.state import Scope

T = TypeVar("T")


class Exactness(IntEnum):
    """The exactness that a number is meant to have, weakest first; it travels with the value."""

    GUESS = 0
    NUMBER = 1
    PARAM = 2
    FIXED = 3
    REFERENCE = 4


@record(slots=True)
class Num:
    """A number: mm, degrees or their products."""

    expression: Expression
    dimension: MaybeDimension = None
    status: Exactness = Exactness.NUMBER

    @property
    def value(self) -> float:
        """The value at the first guesses."""
        return self.expression.value

    @property
    def is_whole(self) -> bool:
        value = self.expression.value  # maybe not a number
        return self.dimension in (None, PLAIN) and abs(value) < 1e15 and value == int(value)

    @property
    def value_type(self) -> Type:
        return number_type(self.dimension, self.is_whole)


@record(slots=True)
class PointVal:
    """A point: coordinates in the frame of the structure that asks."""

    value_type = PointType()

    x: Num
    y: Num

    @property
    def place(self) -> Place:
        return Place(self.x.expression, self.y.expression)


@record(slots=True)
class TextVal:
    value_type = TextType()
    value: str


@record(slots=True)
class RangeVal:
    value_type = RangeType()
    start: Num
    end: Num
    exclusive: bool
    step: Num | None = None


class _Holding:
    """A value that holds others: `weight` of them, counted with those inside and as often as they are met, on
    `depth` levels. `kind` is its type, once that has been worked out.
    """

    __slots__ = ("depth", "kind", "weight")

    weight: int
    depth: int
    kind: Type | None

    def _weigh(self, held: Iterable[Value]) -> None:
        weight, depth = 0, 0
        for value in held:
            if isinstance(value, _Holding):
                weight += value.weight
                depth = max(depth, value.depth)
            else:
                weight += 1
        self.weight, self.depth, self.kind = max(weight, 1), depth + 1, None

    def is_of(self, kind: Type) -> Type:
        """Keeps the type."""
        self.kind = kind
        return kind


@record(slots=True)
class ListVal(_Holding):
    items: tuple[Value, ...]

    def __post_init__(self) -> None:
        self._weigh(self.items)

    @property
    def value_type(self) -> Type:
        return self.kind or self.is_of(_list_type(self.items))


@record(slots=True)
class RecordVal(_Holding):
    """Values under names of their own: `record(clearance: 3.4, tap: 2.5)`."""

    value_type = RecordType()

    fields: Mapping[str, Value]

    def __post_init__(self) -> None:
        self._weigh(self.fields.values())


@record(eq=False)
class Instantiation:
    """A call of a template, waiting for the name it is assigned to. `scope` is the one that its body sees."""

    value_type = StructureType()

    signature: Signature
    scope: Scope | None
    definition: ast.Structure
    arguments: Mapping[str, Value]
    node: ast.Call


@record(slots=True)
class Nothing:
    """The value of an expression with a reported error; whatever it touches is nothing too."""


class Array:
    """Members declared one by one under whole-number indices, possibly sparse; read in index order."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.members: dict[tuple[int, ...], Value] = {}

    def items(self) -> list[Value]:
        """Returns the members in index order; of a many-index array its rows."""
        firsts = sorted({index[0] for index in self.members})
        return [self.members[(i,)] if (i,) in self.members else self.row(i) for i in firsts]

    @property
    def value_type(self) -> Type:
        return _list_type(self.items())

    def row(self, index: int) -> Array:
        """Returns the members of a many-index array whose first index is `index`, none or more."""
        row = Array(f"{self.name}[{index}]")
        row.members = {key[1:]: v for key, v in self.members.items() if key[0] == index and len(key) > 1}
        return row


class Pattern(Array):
    """Members laid out by a rule; `settings` holds its centre, pitch and the like, which have names too."""

    def __init__(self, name: str, settings: Geometry) -> None:
        super().__init__(name)
        self.settings = settings


@record(eq=False)
class StructureCopy:
    """A structure yet to be made as a copy of another, waiting for the name it is assigned to.

    source  a structure, or a template to instantiate
    motion  its placement, in the frame of the structure that holds it
    node    the call that asks for it
    is_laid the motion alone places the instance of a template
    """

    source: Structure | Instantiation
    motion: Motion
    node: ast.Call
    is_laid: bool = False


@record(eq=False)
class Namespace:
    """The names that `import "p" as name` brings."""

    value_type = ModuleType()

    values: Mapping[str, object]


NOTHING = Nothing()
_TRUTH = TruthType()

if TYPE_CHECKING:
    Value: TypeAlias = (
        Num
        | PointVal
        | TextVal
        | bool
        | Condition
        | RangeVal
        | ListVal
        | RecordVal
        | Array
        | Geometry
        | Structure
        | Box
        | Namespace
        | Instantiation
        | StructureCopy
        | Nothing
    )
else:
    Value = object


def number(value: float, dimension: MaybeDimension = None, status: Exactness = Exactness.NUMBER) -> Num:
    return Num(ex.constant(value), dimension, status)


def length(expression: Expression, status: Exactness = Exactness.REFERENCE) -> Num:
    return Num(expression, LENGTH, status)


def point(x: Expression, y: Expression, status: Exactness = Exactness.REFERENCE) -> PointVal:
    return PointVal(Num(x, LENGTH, status), Num(y, LENGTH, status))


def certain(value: object, kind: type[T]) -> T:
    """Returns a value of which it is known, as from the choice of an overload, that it is of a kind."""
    assert isinstance(value, kind)
    return value


def numbers_of(value: Value) -> tuple[Num, ...]:
    """Returns a number, or both coordinates of a point; none for anything else."""
    return (value,) if isinstance(value, Num) else (value.x, value.y) if isinstance(value, PointVal) else ()


def with_numbers(value: Value, change: Callable[[Num], Num]) -> Value:
    """Returns a number, or a point or a list with the numbers in it, changed; anything else as it is."""
    match value:
        case Num():
            return change(value)
        case PointVal(x, y):
            return PointVal(change(x), change(y))
        case ListVal(items):
            return ListVal(tuple([with_numbers(item, change) for item in items]))
        case _:
            return value


def members(value: Value) -> Sequence[Value] | None:
    """Returns the items of a list or an array; None for anything else."""
    match value:
        case ListVal(items):
            return items
        case Array():
            return value.items()
        case _:
            return None


def spliced(value: Value) -> Sequence[Value]:
    """Returns the members of a list, or the thing alone."""
    items = members(value)
    return items if items is not None else [value]


def each_of(value: Value, kind: type[T]) -> Iterator[T]:
    """Yields the things of a kind in a value or a list of values; nothing if there is anything else in it."""
    if isinstance(value, kind):
        yield value
    elif (items := members(value)) is not None:
        found = [list(each_of(item, kind)) for item in items]
        yield from (thing for things in found for thing in things if all(found))


def leaves(value: Value) -> Iterator[Value]:
    """Yields a value, or what a list or an array holds, at any depth."""
    if (items := members(value)) is None:
        yield value
    else:
        for item in items:
            yield from leaves(item)


def holds(value: Value, kind: type) -> bool:
    """Tells whether a value is of a kind, or a list with something of it."""
    return any(isinstance(item, kind) for item in leaves(value))


def type_of(value: Value) -> Type:
    """Returns the type by which overloads are chosen; ANY for what has none yet."""
    kind: Type = _TRUTH if isinstance(value, bool) else getattr(value, "value_type", ANY)
    return kind


def _list_type(items: Sequence[Value]) -> Type:
    kinds = iter(items)
    first = type_of(next(kinds, NOTHING))
    same = all(kind is first or kind == first for kind in map(type_of, kinds))
    return ListType(first if same else ANY, len(items))


def kind_of(value: Value) -> str:
    """Returns the kind of a value for messages: `a length`, `an angle`, `a structure`."""
    return with_article(type_of(value))
