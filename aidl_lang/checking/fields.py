"""The fields that every program can name behind a dot, of primitives and boxes, and their types."""

from __future__ import annotations

from collections.abc import Mapping

from aidl_lang.checking.builtins import FINISHES, ROTATION
from aidl_lang.checking.registry import PRIMITIVES
from aidl_lang.checking.types import (
    ANY,
    BoxType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RecordType,
    TextType,
    Type,
)
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.common.names import fold

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


_TYPES: Mapping[str, Type] = {
    **dict.fromkeys(("length", "size"), _LENGTH),
    **dict.fromkeys(("angle", "direction"), _ANGLE),
    "point": _POINT,
}

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
    "along": _fields("", "pitch inset"),
    "grid": _fields("center start", "pitch pitch_x pitch_y"),
    "polar_array": _fields("center", "radius", "start sweep"),
}
"""Fields of a pattern, beside its members."""

OUTLINE = frozenset(
    [
        "corner",
        "corners",
        "segment",
        "segments",
        "edge",
        "edges",
        "point",
        "points",
        "fillet",
        "chamfer",
        "outline",
        "parts",
        "source",
        "member",
        "members",
    ]
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
    "perimeter": _LENGTH,
    "centroid": PointType(),
    "clearance": _LENGTH,
    "bb": BoxType(),
}
"""Types of the results of built-in functions that do not depend on their arguments."""
