"""The built-in names, on which the standard library itself stands: parameters, and fields of primitives."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from aidl_lang.checking.binding import PARAMETERS
from aidl_lang.checking.types import (
    ANY,
    DECLARATIONS,
    PARAMETER_TYPES,
    PRIMITIVES,
    BoxType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RecordType,
    Signature,
    TextType,
    Type,
)
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.common.names import fold
from aidl_lang.syntax import ast


def word_set(*lines: str) -> frozenset[str]:
    """Returns the words of some lines."""
    return frozenset(word for line in lines for word in line.split())


# --- The fields that every program can name behind a dot, of primitives and boxes, and their types.

FINISHES = frozenset({"fillet", "chamfer"})
"""Statements that change the corners of outlines after solving."""

ROTATION = "rotation"
"""The field of a structure that is its turn against the one around it."""

_LENGTH, _ANGLE, _POINT = NumberType(LENGTH), NumberType(ANGLE), PointType()


def _fields(points: str = "", lengths: str = "", angles: str = "") -> dict[str, Type]:
    return {
        **dict.fromkeys(points.split(), _POINT),
        **dict.fromkeys(lengths.split(), _LENGTH),
        **dict.fromkeys(angles.split(), _ANGLE),
    }


def _type(word: str) -> Type:
    kind = word.removesuffix("[]")
    return ListType(GeometryType(kind)) if kind != word else _TYPES[word]


_TYPES: Mapping[str, Type] = {**PARAMETER_TYPES, "size": _LENGTH, "direction": _ANGLE}

PRIMITIVE: Mapping[str, Mapping[str, Type]] = {
    kind: {name: _type(word) for name, word in each.types.items()} for kind, each in PRIMITIVES.items()
}

BOX: Mapping[str, Type] = _fields(
    "center top_left top_right bottom_left bottom_right top_center bottom_center left_center right_center",
    "left right top bottom width height center_x center_y",
)

STRUCTURE: Mapping[str, Type] = {
    "origin": _POINT,
    "x_axis": GeometryType("line"),
    "y_axis": GeometryType("line"),
    ROTATION: _ANGLE,
}

PATTERN: Mapping[str, Mapping[str, Type]] = {
    "linear_array": _fields("center start", "pitch", "angle"),
    "along": _fields("", "pitch inset margin"),
    "grid": _fields("center start", "pitch pitch_x pitch_y"),
    "polar_array": _fields("center", "radius", "start sweep"),
}
"""Fields of a pattern, beside its members."""

OUTLINE = word_set(
    "corner corners segment segments edge edges point points fillet",
    "chamfer outline parts source member members",
)
"""Names that operations give to shapes beside those of their definitions; only the builder knows which."""


FINISH: Mapping[str, Type] = dict.fromkeys(sorted(FINISHES), _LENGTH)
"""The sizes of finished corners: of a point, the end of a curve, or a whole outline."""


def is_box_name(name: str) -> bool:
    return fold(name) in ("bb", "box", "boundingbox")


RESULTS: Mapping[str, Type] = {
    **dict.fromkeys(("sin", "cos", "tan"), NumberType(None)),
    **dict.fromkeys(("asin", "acos", "atan", "atan2"), _ANGLE),
    **dict.fromkeys(("floor", "ceil", "round", "abs", "min", "max", "sum"), ANY),
    "len": NumberType(None, whole=True),
    "record": RecordType(),
    "ink": RecordType(),
    "traced_part": GeometryType("traced"),
    **dict.fromkeys(("str", "choice", "rgb"), TextType()),
    **dict.fromkeys(("range", "enumerate", "zip", "reversed"), ListType(ANY)),
    "channels": ListType(NumberType(None)),
    **{kind: GeometryType(kind) for kind in PRIMITIVES},
    "area": NumberType(None),
    **dict.fromkeys(("centroid", "point_at"), _POINT),
    **dict.fromkeys(("perimeter", "way_between"), _LENGTH),
    "clearance": _LENGTH,
    "bb": BoxType(),
}
"""Types of the results of built-in functions that do not depend on their arguments."""


# Everything that AIDL can say is written in AIDL in `stdlib/`; this table holds what it cannot: the
# functions of a number, the primitives (from their registry), the marks of exactness, and measurements of
# the finished drawing.

_DECLARATIONS = """
sin(angle: angle)
cos(angle: angle)
tan(angle: angle)
asin(value: number)
acos(value: number)
atan(value: number)
atan2(y, x)
sqrt(value)
abs(value)
square(value)
hypot(a, b)
min(values: list)
max(values: list)
sum(values: list)
floor(value)
ceil(value)
round(value)
len(values)
record(**)
str(value)
range(end: number)
range(start: number, end: number, step: number?)
enumerate(values: list)
zip(a: list, b: list)
zip(a: list, b: list, c: list)
reversed(values: list)
choice(word: text, words: list)
rgb(red: number, green: number, blue: number)
channels(color: text)
fixed(value)
guess(value)
written(value)
nearest(value, candidates: list)
ink(text: text, align: text, line_spacing: number, bold: bool, font: text)
lettered(text: text, curve, height: length, align: text, line_spacing: number, inside, \
outline: bool, bold: bool, font: text, stencil)
traced_part(of: geometry, part: text)
where(value, positive, negative)
shown(value)
sizes(of)
convex_corners(of)
refuse(why: text)
offset(of, distance: length, corners: text?)
shell(of, thickness: length, corners: text?)
thick(of, width: length, caps: text?, joins: text?)
hull(of: list)
union(of: list)
intersect(of: list)
difference(of: list)
cut(of: list)
cut(of, by)
clip(of, by)
tiled(of, within, by: point, row: point?, angle: angle?, start: text?, whole: bool?, width: length?)
fillet(of, radius: length)
fillet(of, radius: text)
chamfer(of, size: length, second: length?)
chamfer(of, distance: length, second: length?)
chamfer(of, size: text)
chamfer(of, distance: text)
mirror(x, about)
copy(x, by: point?, angle: angle?, about: point?, scale: number?)
copy(x, angle: angle?, scale: number?, center: point)
move(x, by: point)
move(x, dx: length, dy: length?)
move(x, dx: length?, dy: length)
translate(x, by: point)
translate(x, dx: length, dy: length?)
translate(x, dx: length?, dy: length)
rotate(x, angle: angle, about: point?)
scale(x, factor: number, about: point?)
linear_array(x, n: integer, pitch: length, angle: angle?, center: point?, start: point?)
linear_array(x, n: integer, by: point, center: point?, start: point?)
grid(x, columns: integer, rows: integer, pitch: length, center: point?, start: point?)
grid(x, columns: integer, rows: integer, pitch_x: length, pitch_y: length, center: point?, start: point?)
along(x, curve, n: integer, inset: length?, turn: bool?, margin: length?)
along(x, curve, pitch: length, inset: length?, turn: bool?, margin: length?)
polar_array(x, n: integer, radius: length?, center: point?, start: angle?, sweep: angle?, turn: bool?)
point_at(curve, at: length)
point_at(curve, at: length, axis: text, last)
way_between(a: point, b: point, curve)
area(of)
perimeter(of)
centroid(of)
outline_clearance(a, b)
overlaps(a, b)
"""


def _signature(declaration: str) -> Signature:
    """Reads `name(parameter: type, optional: type?)`; `name(**)` takes arguments of any name."""
    name, _, inside = declaration.rstrip(")").partition("(")
    if inside == "**":
        return Signature(name, (), takes_any=True, standard=True)
    parameters = []
    for item in inside.split(", "):
        word, _, kind = item.partition(": ")
        parameters.append((word, PARAMETER_TYPES[kind.rstrip("?") or "any"], kind.endswith("?")))
    return Signature(name, tuple(parameters), standard=True)


def _table() -> dict[str, tuple[Signature, ...]]:
    table: dict[str, list[Signature]] = {}
    for line in (*DECLARATIONS, *filter(None, _DECLARATIONS.split("\n"))):
        signature = _signature(line)
        table.setdefault(signature.name, []).append(signature)
    return {name: tuple(signatures) for name, signatures in table.items()}


SIGNATURES: Mapping[str, tuple[Signature, ...]] = _table()

OUTLINES = word_set("offset shell thick hull union intersect difference cut clip tiled")
"""Operations that make an outline of others by exact geometry, after solving."""

EDITS = frozenset({"move", "translate", "rotate", "scale"})
"""Statements that change what was written; as expressions they make copies."""

PATTERNS = frozenset({"along", "linear_array", "grid", "polar_array"})
"""Operations that make members of an array."""

CUTS = word_set(
    "clearance_hole through_hole tap_hole tapped_hole counterbore countersink",
    "hex_pocket nut_trap nut_pocket bearing_seat",
)
"""Ready-made cuts of the library: holes in a solid or an assembly, outlines elsewhere."""

FILLINGS = word_set(
    "hatching crosshatch bricks tiles shingles planks ribs knurling dots",
    "scales threads mesh honeycomb wood_grain slats checkers rays",
)
"""Patterns of the library that fill an outline: each is made by `tiled`."""

COPYING = frozenset({"mirror", "copy"}) | EDITS
"""Operations whose results are their operands, elsewhere."""

DERIVING = COPYING | OUTLINES | FILLINGS
"""Operations that make new geometry, or a new structure, of one that is there, an ancestor's included."""

FOLLOWED = {"text": ("along", "fit")}
"""Arguments by which a shape follows geometry that is there, an ancestor's included."""

CONNECTING = word_set(
    "coil spring chain cord wire hose hose_way ray_lines strip ram link hinge bracket fitted_text"
)
"""Shapes of the library that follow points, an ancestor's included, and hold no equations."""

WORDS = word_set(
    "x y left right center top bottom middle horizontal vertical both",
    "sharp miter round butt square here corner max close medium loose tabs notches ink baseline line",
    "hex socket pan countersunk lines teeth none",
)
"""Words that may stand bare as an argument, as in `axis: x` and `align: left`."""


EVERYWHERE = ("self", "origin", "x_axis", "y_axis")
"""Names that every structure has."""

MATH = ("math", "np", "numpy")
"""Modules of other languages whose functions are known here by the same names: `math.sqrt(2)`, `np.pi`."""

ATTRIBUTES = (
    *"orientation elevation color colour layer thickness depth material quantity detached rigid note".split(),
    *"stroke dash opacity shade shadow edges halo behind in_front clip".split(),
    *"title author number revision thread tolerance finish".split(),
    ast.ALLOW,
)
"""Names that may stand behind `@` before a definition; `colour` is another spelling of `color`."""

STACKING = (BEHIND, IN_FRONT) = ("behind", "in_front")
"""Attributes whose arguments are names of structures beside the one that they stand before."""

CLIP = "clip"
"""The attribute whose argument is the outline that a structure is clipped to."""

NAMING = frozenset((*STACKING, CLIP))
"""Attributes whose arguments are names of structures or geometry, read when these are there."""

WORDED = frozenset(
    {"orientation", "color", "colour", "layer", "material", "note", "stroke", "shade", "edges"}
)
"""Attributes whose argument may be a bare word, as in `@orientation(front)` and `@color(red)`."""


def is_word(argument: ast.Argument, candidates: Iterable[Signature]) -> bool:
    """Tells whether a bare name is a word itself: given by name to a parameter that takes a text."""
    if argument.name is None or not isinstance(argument.value, ast.Name) or argument.value.text not in WORDS:
        return False
    word = fold(argument.name.text)
    wanted = {word, *map(fold, PARAMETERS.get(word, ()))}
    parameters = (each for candidate in candidates for each in candidate.parameters)
    return any(fold(name) in wanted and isinstance(kind, TextType) for name, kind, _ in parameters)
