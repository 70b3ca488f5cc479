"""Types, the rules by which a parameter accepts them, the choice among overloads, and all primitives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import cached_property, lru_cache
from typing import TypeAlias

from aidl_lang.checking.units import ANGLE, AREA, LENGTH, PLAIN, MaybeDimension, describe
from aidl_lang.common import prose
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

# --- The registry of primitives: a record of each kind of point, curve and text that is built in.
#
# The calls of a kind, its fields and their types, which of them are sizes and which turn with the things
# around, the fields that are shown of one and a sample for trying it: all this is read from here, and
# written nowhere else. The formulas of a kind stand in `building.curves`.


@record()
class Primitive:
    """A kind of primitive.

    calls    the parameters of each of its constructors, as in `builtins`
    fields   its fields: `name: point`, `length` (that may be negative), `size` (that may not), `angle`,
             `direction` (an angle that turns with the things around), `KIND[]` for a list
    unlisted fields that messages and completion do not offer, as another says the same
    chief    the fields to show of one that is pointed at; all if it is empty
    sample   the text of one at `({x}, {y})`; "" for a kind that the library alone uses
    """

    kind: str
    calls: tuple[str, ...]
    fields: str
    unlisted: str = ""
    chief: str = ""
    sample: str = ""

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The fields that are offered."""
        return tuple(name for name, _ in _items(self.fields))

    @cached_property
    def types(self) -> Mapping[str, str]:
        """The word for the type of each field, unlisted ones included."""
        return dict([*_items(self.fields), *_items(self.unlisted)])

    @cached_property
    def shown(self) -> tuple[str, ...]:
        """The fields to show of one."""
        return tuple(self.chief.split()) or self.names


def _items(fields: str) -> Iterator[tuple[str, str]]:
    for item in filter(None, fields.split(", ")):
        name, _, word = item.partition(": ")
        yield name, word


_RECORDS = (
    Primitive(
        "point",
        calls=("x: length, y: length", "at: point"),
        fields="x: length, y: length",
        unlisted="at: point, center: point",
        chief="at",
        sample="({x}, {y})",
    ),
    Primitive(
        "line",
        calls=("start: point, end: point", "start: point?, length: length, angle: angle"),
        fields="start: point, end: point, midpoint: point, length: size, angle: direction, dx: length, "
        "dy: length",
        unlisted="center: point",
        chief="start end length angle",
        sample="line(({x}, {y}), ({x} + 12, {y} + 3))",
    ),
    Primitive(
        "arc",
        calls=(
            "center: point, start: point, end: point, clockwise: bool?",
            "start: point, end: point, radius: length, large: bool?, clockwise: bool?",
            "center: point?, radius: length, start_angle: angle, end_angle: angle, clockwise: bool?",
        ),
        fields="center: point, start: point, end: point, midpoint: point, radius: size, diameter: size, "
        "start_angle: direction, end_angle: direction, sweep: angle, length: size",
        chief="center radius start end sweep",
        sample="arc(center: ({x}, {y}), radius: 8, start_angle: 20deg, end_angle: 130deg)",
    ),
    Primitive(
        "circle",
        calls=("center: point?, radius: length", "center: point?, diameter: length"),
        fields="center: point, radius: size, diameter: size",
        chief="center radius",
        sample="circle(center: ({x}, {y}), radius: 6)",
    ),
    Primitive(
        "ellipse",
        calls=("center: point?, rx: length, ry: length, angle: turn?",),
        fields="center: point, rx: size, ry: size, angle: direction",
        sample="ellipse(center: ({x}, {y}), rx: 9, ry: 5)",
    ),
    Primitive(
        "bezier",
        calls=("p0: point, p1: point, p2: point, p3: point",),
        fields="p0: point, p1: point, p2: point, p3: point, start: point, end: point",
        sample="bezier(({x}, {y}), ({x} + 4, {y} + 6), ({x} + 8, {y} - 2), ({x} + 12, {y} + 3))",
    ),
    Primitive(
        "glyphs",
        calls=(
            "text: text, start: point, height: length, angle: angle, align: text, line_spacing: number, "
            "outline: bool, bold: bool, font: text, stencil",
        ),
        fields="start: point, height: size, angle: direction, glyph: glyphs[]",
        chief="start height angle",
    ),
    Primitive(
        "traced",
        calls=("part: text, start: point, unit: length, angle: angle, filled: bool",),
        fields="start: point, unit: size, angle: direction",
    ),
)

PRIMITIVES: Mapping[str, Primitive] = {each.kind: each for each in _RECORDS}

PUBLIC = tuple(kind for kind, each in PRIMITIVES.items() if each.sample)
"""The kinds that programs write."""

DECLARATIONS = tuple(f"{kind}({call})" for kind, each in PRIMITIVES.items() for call in each.calls)


def fields_of(word: str) -> frozenset[str]:
    """Returns the names of all fields of a type, by its word."""
    return frozenset(n for each in PRIMITIVES.values() for n, of in each.types.items() if of == word)


def offered(kind: str) -> tuple[str, ...]:
    """Returns the fields to offer for a kind of primitive; none for a kind that is none."""
    return PRIMITIVES[kind].names if kind in PRIMITIVES else ()


# --- Types, the rules by which a parameter accepts them, and the choice among overloads.
#
# One choice serves the checker, which knows types only, and the interpreter, which takes the types of
# values.


@record()
class AnyType:
    """The type of a value unknown before building: accepted everywhere, checked again when it is there."""

    def __str__(self) -> str:
        return "anything"


@record()
class NumberType:
    """The type of a number; `dimension` is None for a bare one."""

    dimension: MaybeDimension
    whole: bool = False

    def __str__(self) -> str:
        return "whole number" if self.whole else describe(self.dimension)


@record()
class TextType:
    def __str__(self) -> str:
        return "text"


@record()
class TruthType:
    """The type of true and false, and of conditions over unknowns."""

    def __str__(self) -> str:
        return "condition"


@record()
class PointType:
    def __str__(self) -> str:
        return "point"


@record()
class RangeType:
    def __str__(self) -> str:
        return "range"


@record()
class RecordType:
    def __str__(self) -> str:
        return "record"


@record()
class ListType:
    """The type of a list or an array; `length` if it is known."""

    element: Type
    length: int | None = None

    def __str__(self) -> str:
        return f"list of {self.element}s" if not isinstance(self.element, AnyType) else "list"


@record()
class GeometryType:
    """The type of geometry: `kind` is a primitive (`line`, `arc`, …), the name of a shape, or "" for any."""

    kind: str

    def __str__(self) -> str:
        return self.kind or "geometry"


@record()
class StructureType:
    def __str__(self) -> str:
        return "structure"


@record()
class BoxType:
    """The type of the box of a structure, a geometry or a list of them."""

    def __str__(self) -> str:
        return "box"


@record()
class ModuleType:
    """The type of a file's names: no value, so no parameter asks for it."""

    def __str__(self) -> str:
        return "module"


Type: TypeAlias = (
    AnyType
    | NumberType
    | TextType
    | TruthType
    | PointType
    | RangeType
    | RecordType
    | ListType
    | GeometryType
    | StructureType
    | BoxType
    | ModuleType
)

ANY = AnyType()

PARAMETER_TYPES: Mapping[str, Type] = {
    "any": ANY,
    "length": NumberType(LENGTH),
    "angle": NumberType(ANGLE),
    "turn": NumberType(ANGLE),
    "area": NumberType(AREA),
    "number": NumberType(PLAIN),
    "integer": NumberType(PLAIN, whole=True),
    "text": TextType(),
    "string": TextType(),
    "bool": TruthType(),
    "boolean": TruthType(),
    "point": PointType(),
    "list": ListType(ANY),
    "peer": ANY,
    "peers": ListType(ANY),
    "points": ListType(PointType()),
    "record": RecordType(),
    "geometry": GeometryType(""),
    "structure": StructureType(),
    "box": BoxType(),
    **{kind: GeometryType(kind) for kind in PUBLIC if kind != "point"},
}
"""The words that may stand behind `:` in a parameter; the name of a shape may stand there too."""

_BY_SPELLING = {fold(word): each for word, each in PARAMETER_TYPES.items()}

PEERS = ("peer", "peers")
"""Types of parameters whose things, or members of a list, a constraint does not hold by their place."""


def parameter_type(parameter: ast.Parameter, shapes: Iterable[str] = ()) -> Type | None:
    """Returns the type a parameter asks for; None if the word is unknown."""
    return type_named(parameter.type.text, shapes) if parameter.type is not None else ANY


def type_named(word: str, shapes: Iterable[str] = ()) -> Type | None:
    """Returns the type that a word or the name of a shape stands for; None if it is unknown."""
    word = fold(word)
    if (known := _BY_SPELLING.get(word)) is not None:
        return known
    return next((GeometryType(shape) for shape in shapes if fold(shape) == word), None)


def accepts(wanted: Type, given: Type) -> int | None:
    """Returns how far `given` is from the type: 0 exact, more for a conversion, None if it does not fit."""
    if isinstance(wanted, AnyType):
        return 4
    if isinstance(given, AnyType):
        return 3
    if wanted is given:
        return 0
    match wanted:
        case NumberType():
            return _accepts_number(wanted, given)
        case PointType():
            return _accepts_point(given)
        case GeometryType():
            return _accepts_geometry(wanted, given)
        case BoxType():
            return _accepts_box(given)
        case ListType(element):
            if isinstance(given, ListType):
                return 0 if accepts(element, given.element) is not None else None
            return 1 if isinstance(given, RangeType) else None
        case _:
            return 0 if type(wanted) is type(given) else None


def _accepts_number(wanted: NumberType, given: Type) -> int | None:
    if isinstance(given, NumberType):
        if wanted.whole and not given.whole:
            return None
        return 0 if wanted.dimension == given.dimension else 1 if given.dimension is None else None
    # An edge stands for its coordinate.
    return 2 if given == GeometryType("line") and wanted.dimension == LENGTH else None


def _accepts_point(given: Type) -> int | None:
    if isinstance(given, ListType):
        is_pair = given.length in (2, None) and isinstance(given.element, NumberType | AnyType)
        return 2 if is_pair else None
    return 0 if given in (PointType(), GeometryType("point")) else None


def _accepts_geometry(wanted: GeometryType, given: Type) -> int | None:
    if isinstance(given, GeometryType):
        return 0 if wanted.kind == given.kind else 1 if wanted.kind == "" else None
    return 1 if wanted.kind == "" and isinstance(given, PointType) else None


def _accepts_box(given: Type) -> int | None:
    match given:
        case BoxType():
            return 0
        case StructureType() | GeometryType() | PointType():
            return 1
        case ListType(element):
            return None if isinstance(element, NumberType | TextType | TruthType) else 2
        case _:
            return None


@record()
class GivenArgument:
    """An argument of a call for the choice of an overload; `name` is None for a positional one."""

    name: str | None
    type: Type


Given: TypeAlias = Sequence[GivenArgument]


def given_to(call: ast.Call, kinds: Sequence[Type]) -> list[GivenArgument]:
    """Returns the arguments of a call, of these types; what comes before them, as a receiver, has no name."""
    names = [a.name.text if a.name else None for a in call.arguments]
    names = [*[None] * (len(kinds) - len(names)), *names]
    return [GivenArgument(name, kind) for name, kind in zip(names, kinds, strict=True)]


@record(eq=False)
class Signature:
    """A callable: `node` is its definition and `kind` the class of that, both None for a built-in one;
    `standard` ones belong to every program. One that `takes_any` takes every named argument.
    """

    name: str
    parameters: tuple[tuple[str, Type, bool], ...]  # name, type, and whether it has a default
    node: ast.Callable | None = None
    kind: type[ast.Callable] | None = None
    takes_any: bool = False
    standard: bool = False

    @cached_property
    def by_fold(self) -> Mapping[str, str]:
        """Parameter names by their folded spelling."""
        return {fold(name): name for name, _, _ in self.parameters}

    @cached_property
    def gathers(self) -> bool:
        """True if positional arguments are collected: the first parameter is a list."""
        return bool(self.parameters) and isinstance(self.parameters[0][1], ListType)

    @cached_property
    def needed(self) -> int:
        """The number of parameters without a default."""
        return sum(not optional for _, _, optional in self.parameters)

    def may_take(self, positional: int, words: Set[str]) -> bool:
        """Tells whether so many arguments without a name and these (folded) names could fit, whatever their
        types: a quick look that saves matching most overloads.
        """
        if self.takes_any or self.gathers:
            return self.takes_any or words <= self.by_fold.keys()
        count = positional + len(words)
        return self.needed <= count <= len(self.parameters) and words <= self.by_fold.keys()

    def __str__(self) -> str:
        shown = [
            name + ("" if isinstance(kind, AnyType) else f": {kind}") + (" = …" if optional else "")
            for name, kind, optional in self.parameters
        ]
        shown += ["name: value", "…"] if self.takes_any else []
        return f"{self.name}({', '.join(shown)})"


@record()
class ArgumentSource:
    """The origin of an argument: that at `index` in the call, a part of it, or it as x and `other` as y."""

    index: int
    part: int | None = None
    other: int | None = None


@record()
class Binding:
    """The arguments of each parameter: parameter name → indices into the arguments.

    Several indices (or `gathered`) make a list. `positional` are the indices given without a name. `sources`,
    if there are any, are the arguments, made of those of the call.
    """

    signature: Signature
    arguments: Mapping[str, tuple[int, ...]]
    gathered: str | None
    cost: tuple[int, int, int]
    """conversions, bare numbers read as an angle that could be left out, and parameters left out"""
    positional: tuple[int, ...] = ()
    sources: tuple[ArgumentSource, ...] = ()

    @cached_property
    def taken(self) -> tuple[tuple[str, Type, tuple[int, ...]], ...]:
        """The parameters that get arguments: name, type, and the indices of these."""
        given = self.arguments
        return tuple((n, kind, given[n]) for n, kind, _ in self.signature.parameters if n in given)

    def parameter_of(self, index: int) -> str | None:
        """Returns the parameter that gets an argument of the call as a whole."""
        return self._meant.get(index)

    def kind_of(self, index: int) -> Type | None:
        """Returns the type that the parameter asks for which gets an argument of the call as a whole."""
        meant = self.parameter_of(index)
        return next((kind for name, kind, _ in self.taken if name == meant), None)

    @cached_property
    def _meant(self) -> Mapping[int, str]:
        meant: dict[int, str] = {}
        for name, taken in self.arguments.items():
            for place in taken:
                source = self.sources[place] if self.sources else ArgumentSource(place)
                if source == ArgumentSource(source.index):
                    meant.setdefault(source.index, name)
        return meant


@record()
class Mismatch:
    """The reason why a candidate does not fit; `argument` is the index of the argument to blame, if one is;
    `meanings` are the parameters between which its name does not choose; `kinds` are the wanted and the given
    type, if these differ.
    """

    signature: Signature
    problem: str
    argument: int | None = None
    meanings: tuple[str, ...] = ()
    kinds: tuple[Type, Type] | None = None

    @property
    def reason(self) -> str:
        """The reason in words, made when it is read: most mismatches are never reported."""
        if self.kinds is None:
            return self.problem
        wanted, given = self.kinds
        not_whole = isinstance(given, NumberType) and given.dimension in (None, PLAIN)
        is_fraction = not_whole and isinstance(wanted, NumberType) and wanted.whole
        other = "one that may be a fraction" if is_fraction else with_article(given)
        return f"{self.problem} to be {with_article(wanted)}, not {other}"


_GATHERED = 20  # the cost of collecting arguments into a list: an overload that names them comes before


def bind(signature: Signature, given: Given) -> Binding | Mismatch:
    """Matches arguments to the parameters of one callable.

    If the first parameter is a list and the arguments do not fit as they stand, all positional ones are its
    members: `align_left(a, b, c)`, `row(windows, door, gap: 3)`.
    """
    plain = _bind(signature, given, gather=False)
    if isinstance(plain, Binding) or not signature.gathers or not any(g.name is None for g in given):
        return plain
    gathered = _bind(signature, given, gather=True)
    return gathered if isinstance(gathered, Binding) or plain.argument != gathered.argument else plain


def _bind(signature: Signature, given: Given, *, gather: bool) -> Binding | Mismatch:
    positional = [i for i, g in enumerate(given) if g.name is None]
    parameters = signature.parameters
    arguments: dict[str, tuple[int, ...]] = {}
    gathered = parameters[0][0] if gather else None
    if gathered is not None:
        arguments[gathered] = tuple(positional)
    elif len(positional) > len(parameters):
        count = len(parameters)
        reason = f"takes at most {count} argument{'s' * (count != 1)}"
        return Mismatch(signature, reason, positional[count])
    else:
        arguments |= {name: (i,) for (name, _, _), i in zip(parameters, positional, strict=False)}
    for index, argument in enumerate(given):
        if argument.name is None:
            continue
        target = signature.by_fold.get(fold(argument.name))
        if target is None and signature.takes_any:
            target = argument.name
        if target is None:
            return Mismatch(signature, f"has no parameter `{argument.name}`", index)
        if target in arguments:
            return Mismatch(signature, f"gets `{target}` twice", index)
        arguments[target] = (index,)
    return _fitted(Binding(signature, arguments, gathered, (0, 0, 0), tuple(positional)), given)


def _fitted(found: Binding, given: Given) -> Binding | Mismatch:
    """Returns the binding with its distance from the types, or the parameter that gets nothing that fits."""
    signature, arguments, gathered = found.signature, found.arguments, found.gathered
    distance, turned, defaulted = (_GATHERED if gathered is not None else 0), 0, 0
    for name, kind, optional in signature.parameters:
        if name not in arguments:
            if not optional:
                return Mismatch(signature, f"needs `{name}`")
            defaulted += not isinstance(kind, TruthType)  # a flag left out assumes nothing
        elif name != gathered:
            index = arguments[name][0]
            if (step := accepts(kind, given[index].type)) is None:
                return Mismatch(signature, f"needs `{name}`", index, kinds=(kind, given[index].type))
            distance += step
            turned += optional and kind in _TURNS and given[index].type in _BARE
    return Binding(signature, arguments, gathered, (distance, turned, defaulted), found.positional)


_TURNS = (NumberType(ANGLE), NumberType(ANGLE, whole=True))
_BARE = (NumberType(None), NumberType(None, whole=True))


def with_article(kind: object) -> str:
    """Returns `a length`, `an angle`; a word that takes no article as it is."""
    return prose.with_article(kind, ("anything", "geometry", "text"))


@lru_cache(maxsize=256)
def number_type(dimension: MaybeDimension, whole: bool) -> NumberType:
    """Returns the type of a number, made once: types are compared, and looked up, all the time."""
    return NumberType(dimension, whole)


@lru_cache(maxsize=256)
def geometry_type(kind: str) -> GeometryType:
    return GeometryType(kind)
