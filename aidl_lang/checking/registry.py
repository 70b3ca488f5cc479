"""The registry of primitives: a record of each kind of point, curve and text that is built in.

The calls of a kind, its fields and their types, which of them are sizes and which turn with the things
around, the fields that are shown of one and a sample for trying it: all this is read from here, and written
nowhere else. The formulas of a kind stand in `building.curves`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property

from aidl_lang.common.records import record


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
