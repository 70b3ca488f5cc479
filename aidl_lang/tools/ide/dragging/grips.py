"""The points of a drawing that somebody may want to take hold of."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import field

from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import box_of, spelled_out
from aidl_lang.building.expression import Evaluator, Expression, Unknown
from aidl_lang.building.model import Geometry, Model, Structure, convert, own_geometry
from aidl_lang.building.primitives import xy
from aidl_lang.building.scopes import Scope
from aidl_lang.building.values import PointVal, Value
from aidl_lang.checking.registry import PRIMITIVES
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Vec

MOST_PARTS = 16
"""Points of one shape; of a shape with more, only those that it is made by."""


@record()
class Grip:
    """A point of a model.

    id     its key, also in a later model
    path   of its thing, `name` its name there (`top.start`); empty for the thing itself
    x, y   in the frame of the root
    thing  the outermost geometry, or the structure that the point stands for
    depth  how deep inside shapes and structures it lies
    """

    id: str
    path: str
    name: str
    x: Expression
    y: Expression
    thing: Geometry | Structure = field(repr=False)
    depth: int

    @property
    def is_frame(self) -> bool:
        """True for the grip of a structure, which goes where its frame goes."""
        return isinstance(self.thing, Structure)

    @property
    def frame(self) -> frozenset[Unknown]:
        """The unknowns of the frame of a structure."""
        if not isinstance(self.thing, Structure):
            return frozenset()
        return frozenset(ex.unknowns([self.thing.frame.x, self.thing.frame.y]))

    def at(self, evaluate: Evaluator) -> Vec:
        return evaluate(self.x), evaluate(self.y)


def grips(model: Model) -> Iterator[Grip]:
    """All points of a model by which it might be moved, in order of writing; none of copies."""
    for depth, structure in _structures(model.root, 0):
        if structure.parent is not None:
            yield from _of_structure(model, structure, depth)
        for geometry in structure.own():
            if geometry.source is None and not geometry.construction:
                yield from _of_geometry(model, geometry, depth)


def _structures(structure: Structure, depth: int) -> Iterator[tuple[int, Structure]]:
    if structure.source is None:
        yield depth, structure
        for child in structure.children:
            yield from _structures(child, depth + 1)


def _of_structure(model: Model, structure: Structure, depth: int) -> Iterator[Grip]:
    """A structure by the middle of its box."""
    box = box_of(structure, model.root)
    middle = box.field("center") if box is not None else None
    if isinstance(middle, PointVal):
        x, y = spelled_out(*xy(middle))
        yield Grip(f"{structure.path} at", structure.path, "", x, y, structure, depth)


def _of_geometry(model: Model, geometry: Geometry, depth: int) -> Iterator[Grip]:
    made_by = list(_arguments(geometry))
    inside = list(_inside(geometry, ""))
    named = made_by + (inside if len(inside) <= MOST_PARTS else [])
    for name, place in named:
        x, y = convert(*xy(place), geometry.owner, model.root)
        at = f"{geometry.path}.{name}" if name else geometry.path
        if not (x.is_open or y.is_open):
            yield Grip(at, geometry.path, name, x, y, geometry, depth + name.count("."))


def _arguments(geometry: Geometry) -> Iterator[tuple[str, PointVal]]:
    """The points that a compound shape is made by."""
    if isinstance(geometry.scope, Scope):
        for name in geometry.arguments:
            value = geometry.scope.values.get(name)
            if isinstance(value, PointVal):
                yield name, value


def _inside(geometry: Geometry, prefix: str) -> Iterator[tuple[str, PointVal]]:
    """The points of a primitive, and of the parts of a shape: named ones before the ends of edges."""
    for name in PRIMITIVES[geometry.type].types if geometry.type in PRIMITIVES else ():
        value: Value | None = geometry.fields.get(name)
        if isinstance(value, PointVal):
            yield f"{prefix}{name}" if geometry.type != "point" else prefix.removesuffix("."), value
    parts = [part for part in own_geometry(geometry.parts, geometry) if not part.construction]
    seen: set[tuple[Expression, Expression]] = set()
    for part in sorted(parts, key=lambda p: p.type != "point"):
        for name, value in _inside(part, f"{prefix}{part.name or part.type}."):
            if xy(value) not in seen:  # neighbouring edges share their corners
                seen.add(xy(value))
                yield name, value


def is_somewhere(at: Vec) -> bool:
    return math.isfinite(at[0]) and math.isfinite(at[1])
