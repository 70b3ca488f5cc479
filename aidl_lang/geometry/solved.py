"""The solved model in numbers: what regions, exporters and readers of the API see.

Coordinates are in the root frame, lengths in mm, angles in degrees counter-clockwise.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import TypeAlias

from aidl_lang.common.prose import rough
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.curves import FIELDS, Arc, Bezier, Bounds, Circle, Piece, Vec, union_bounds
from aidl_lang.geometry.region import Region
from aidl_lang.syntax import ast

Scalar: TypeAlias = float | int | bool | str
Values: TypeAlias = dict[str, Scalar | Vec | tuple[Vec, ...]]


@record()
class Box:
    left: float
    bottom: float
    right: float
    top: float

    @property
    def width(self) -> float:
        return self.right - self.left

    @property
    def height(self) -> float:
        return self.top - self.bottom

    @property
    def bounds(self) -> Bounds:
        return self.left, self.bottom, self.right, self.top

    @staticmethod
    def around(
        curves: Iterable[Piece], structures: Iterable[SolvedStructure], more: Iterable[Bounds] = ()
    ) -> Box | None:
        """Returns the box of some curves, of what is material of some structures, and of some more."""
        boxes = [*more, *(curve.box for curve in curves)]
        boxes += [s.box.bounds for s in structures if s.box is not None and s.kind != "hole"]
        return Box(*union_bounds(boxes)) if boxes else None


@record()
class Frame:
    """Position and rotation relative to the parent; a mirrored frame reflects x before it turns."""

    x: float
    y: float
    rotation: float
    mirrored: bool = False


@record()
class Recipe:
    """The derivation of an outline from other curves (see `model.Recipe`); `outlines` works it out."""

    kind: str
    operands: tuple[tuple[SolvedGeometry, ...], ...]
    numbers: Mapping[str, float]
    words: Mapping[str, str]


@record()
class Finish:
    """A fillet or chamfer: of the corner `at`, or of all corners of the geometry at the paths `of`.

    `corners` are the places where it was carried out, `literal` tells the number that its size is written as,
    where nothing else depends on it. Without `sizes` it is as large as fits, the same at all corners of a
    `run` of a statement.
    """

    kind: str
    of: tuple[str, ...]
    at: Vec | None
    sizes: tuple[float, ...]
    text: str
    span: Span
    corners: tuple[Vec, ...] = ()
    run: int = 0
    literal: Callable[[], ast.Number | None] = field(default=lambda: None, compare=False, repr=False)


@record()
class SolvedGeometry:
    """A named geometry. `name` carries its index (`dot[3]`), `path` is the dotted path from the root.

    values  the fields of section 11 for a primitive (`start`, `end`, `center`, `radius`, `at`, `points`, …),
            the number and point parameters for a compound shape
    curve   the curve of a primitive; None for points and compound shapes
    parts   the named parts of a compound shape
    recipe  how the curves of an outline come from others
    source  the path of what it is a copy of
    attributes  name → argument values as written: `note`, and in a drawing `color`
    piece_of  the path of the primitive that is made of it: it has no name by itself
    filled    it is a letter that a drawing fills
    stroked   it is a letter of strokes, which encloses nothing
    """

    name: str
    path: str
    type: str
    values: Values
    curve: Piece | None
    parts: tuple[SolvedGeometry, ...]
    construction: bool
    span: Span | None
    recipe: Recipe | None = None
    source: str | None = None
    attributes: dict[str, tuple[Scalar, ...]] = field(default_factory=dict)
    piece_of: str | None = None
    filled: bool = False
    stroked: bool = False

    def walk(self) -> Iterator[SolvedGeometry]:
        """Yields this geometry and all its parts."""
        yield self
        for part in self.parts:
            yield from part.walk()

    def leaves(self) -> Iterator[SolvedGeometry]:
        """Yields the primitives with drawn curves in order of writing; none of construction geometry."""
        if self.construction:
            return
        if self.curve is not None:
            yield self
        for part in self.parts:
            yield from part.leaves()

    def curves(self) -> Iterator[Piece]:
        """Yields these curves."""
        return (leaf.curve for leaf in self.leaves() if leaf.curve is not None)


Leaves: TypeAlias = Sequence[tuple[SolvedGeometry, Piece]]
"""Primitives that are drawn, with their curves."""


@record()
class SolvedStructure:
    """A solved structure. `box` is None if there is nothing to bound. `orientation` is its own, or that of
    what is around it. `attributes`: name → argument values as written (`color`, `layer`, `thickness`,
    `elevation`, `material`, `quantity`, `detached`, `note`, …). `is_empty`: no geometry of its own and no
    children, so that `box` is that of the plan. `clip`: the geometry that all in it is drawn inside of;
    `inside` is what it encloses, as far as that lies in those around it, once it is worked out. `ground`: the
    path of the solid on whose material alone a drawing is drawn.
    """

    name: str
    path: str
    kind: str
    orientation: str
    frame: Frame
    attributes: dict[str, tuple[Scalar, ...]]
    params: dict[str, Scalar]
    geometry: tuple[SolvedGeometry, ...]
    structures: tuple[SolvedStructure, ...]
    box: Box | None
    is_empty: bool
    span: Span | None
    doc: str | None = None
    finishes: tuple[Finish, ...] = ()
    finished: tuple[SolvedGeometry, ...] | None = None
    clip: tuple[SolvedGeometry, ...] = ()
    inside: Region | None = None
    ground: str | None = None

    @property
    def drawn(self) -> tuple[SolvedGeometry, ...]:
        """The geometry as it is drawn: with its corners finished, that of drawings clipped."""
        return self.geometry if self.finished is None else self.finished

    def walk(self) -> Iterator[SolvedStructure]:
        """Yields this structure and all below it, parents first, in order of writing."""
        yield self
        for child in self.structures:
            yield from child.walk()

    def walk_geometry(self) -> Iterator[SolvedGeometry]:
        """Yields the geometry of this structure and of all below it, each followed by its parts."""
        return (part for s in self.walk() for geometry in s.geometry for part in geometry.walk())

    def find(self, path: str) -> SolvedStructure | None:
        return next((s for s in self.walk() if s.path == path), None)


@record()
class ConstraintReport:
    """A constraint as written, the structure that holds it, and its violation. `mentions` finds the paths of
    the geometry and structures whose unknowns it relates; `exact`: it is made of equations alone.
    """

    path: str
    text: str
    span: Span
    residual: float
    satisfied: bool
    mentions: Callable[[], tuple[str, ...]] = field(repr=False, compare=False)
    soft: bool = False
    exact: bool = False


@record()
class Change:
    """A kept size that had to change. `description`: its name for people; `is_size`: no angle or offset;
    `because`: the constraints, as written, that ask for it.
    """

    path: str
    written: float
    solved: float
    span: Span | None
    description: str = ""
    is_size: bool = True
    because: tuple[str, ...] = ()


@record()
class Motion:
    """A way in which something can still move.

    kind    `slide`, `turn`, `grow`, `change` (a single parameter) or `together` (anything else); `place`
            where the whole drawing does it
    things  paths of what moves, the outermost that move as a whole
    words   what they can do, as `slide along x`
    moves   parameters that take part, by path: how much each changes, relative to one another
    against the path of what is related to the things and does not go along; "" for nothing
    """

    kind: str
    things: tuple[str, ...]
    words: str
    moves: Mapping[str, float] = field(repr=False)
    against: str = ""


@record()
class Reading:
    """The meaning in which an ambiguous call was read, judged by its first guesses."""

    span: Span
    text: str


@record()
class Dimension:
    """A measure that a drawing of the model should state.

    value   mm or degrees, as it came out
    origin  where it comes from: `param` for an exact size (through a param or `fixed`), `constraint`, `size`
            for one written as a number, `overall`, `pattern` for how equal holes stand to each other,
            `hand` for one that the program asks for by `dimension(…)`, `derived` for one that was missing
    of      the path of what it is a size of, or the constraint as written
    name    the param that it is, where it is one and nothing else
    group   equal dimensions of one group are shown once, with their number
    offset  of its line from what it measures, to the right or upwards, mm; None where it is placed freely
    limits  the lower and upper deviation that are allowed, mm or degrees
    fit     the tolerance class that they come from, where it is one
    label   stands in place of the value of something round: a thread, how a hole is sunk
    remark  stands behind it
    is_auxiliary    it follows from others and stands in brackets
    """

    value: float
    origin: str
    of: str = ""
    name: str | None = None
    group: object = None
    offset: float | None = None
    limits: tuple[float, float] | None = None
    fit: str = ""
    label: str = ""
    remark: str = ""
    is_auxiliary: bool = False

    @property
    def kind(self) -> str:
        """`horizontal`, `vertical`, `aligned`, `radius`, `diameter` or `angle`."""
        raise NotImplementedError


@record()
class Length(Dimension):
    """A length along `along` (a unit vector) from any of the points `start` to any of the points `end`."""

    start: tuple[Vec, ...] = ()
    end: tuple[Vec, ...] = ()
    along: Vec = (1.0, 0.0)

    @property
    def kind(self) -> str:
        return {(1.0, 0.0): "horizontal", (0.0, 1.0): "vertical"}.get(self.along, "aligned")


@record()
class Roundness(Dimension):
    """The diameter of a circle, or the radius of an arc."""

    curve: Circle | Arc = field(default_factory=lambda: Circle((0.0, 0.0), 0.0))

    @property
    def kind(self) -> str:
        return "diameter" if isinstance(self.curve, Circle) else "radius"


@record()
class Opening(Dimension):
    """An angle at `corner`, counter-clockwise from the direction `first` by `value` degrees. The arms are
    there from and to these distances from the corner.
    """

    corner: Vec = (0.0, 0.0)
    first: float = 0.0
    arms: tuple[tuple[float, float], tuple[float, float]] = ((0.0, 0.0), (0.0, 0.0))

    @property
    def kind(self) -> str:
        return "angle"


@record()
class Mobility:
    """What can still move.

    degrees   of freedom of the whole; None if they could not be counted
    free      paths of the parameters that can
    floating  structures that no constraint ties to what is around them, and that are where they were guessed
    own       by the path of a structure its degrees of freedom, and the state of its constraints: `fully`,
              `under`, `over`, `contradictory` or `unknown`
    ways      works out independent ways to move, the simplest that were found; the first hundreds of a large
              model. Last come those in which the whole drawing moves as one.
    """

    degrees: int | None = 0
    free: tuple[str, ...] = ()
    floating: tuple[str, ...] = ()
    own: Mapping[str, tuple[int | None, str]] = field(default_factory=dict)
    ways: Callable[[], tuple[Motion, ...]] = field(default=tuple, repr=False, compare=False)

    def of(self, structure: SolvedStructure) -> tuple[int | None, str]:
        """Returns what `own` has of a structure."""
        return self.own.get(structure.path, (0, "unknown"))


def _unsized(model: SolvedModel) -> tuple[Dimension, ...]:
    return ()


@record()
class SolvedModel:
    status: str
    root: SolvedStructure
    constraints: tuple[ConstraintReport, ...] = ()
    changed: tuple[Change, ...] = ()
    readings: tuple[Reading, ...] = ()
    mobility: Callable[[], Mobility] = field(default=Mobility, repr=False, compare=False)
    size_up: Callable[[SolvedModel], tuple[Dimension, ...]] = field(
        default=_unsized, repr=False, compare=False
    )
    """what `sizes` is made by"""

    def __getstate__(self) -> dict[str, object]:
        """Returns what a pickle keeps: what is worked out on demand is worked out now."""
        return vars(self) | {"sizes": self.sizes, "size_up": _unsized}

    @property
    def is_unfinished(self) -> bool:
        """True if there is something to derive, to finish or to clip (see `geometry.outlines`)."""
        return any(s.finishes or s.clip for s in self.root.walk()) or any(
            g.recipe for g in self.root.walk_geometry()
        )

    @property
    def degrees(self) -> int | None:
        return self.mobility().degrees

    @property
    def ways(self) -> tuple[Motion, ...]:
        return self.mobility().ways()

    @property
    def motions(self) -> tuple[Motion, ...]:
        """The ways in which something moves against the rest, the most interesting first."""
        return tuple(way for way in self.ways if way.kind != "place")

    @cached_property
    def sizes(self) -> tuple[Dimension, ...]:
        """The sizes that the program states, the more important first (see `dimensions`)."""
        return self.size_up(self)


# --- Curves that were worked out as geometry of a solved model.


def as_geometry(name: str, of: SolvedGeometry, curve: Piece, around: str = "") -> SolvedGeometry:
    """Returns a curve as a geometry: a part of another, or beside it in a structure."""
    kind, values = described(curve)
    path = f"{around or of.path}.{name}"
    return SolvedGeometry(name, path, kind, values, curve, (), False, of.span)


def edges_of(of: SolvedGeometry, curves: Iterable[Piece]) -> tuple[SolvedGeometry, ...]:
    """Returns curves as the parts of a geometry."""
    return tuple(as_geometry(f"edges[{k}]", of, curve) for k, curve in enumerate(curves))


def described(curve: Piece) -> tuple[str, Values]:
    """Returns the type and the fields of a curve."""
    if isinstance(curve, Bezier):
        return curve.kind, {"points": (curve.p0, curve.p1, curve.p2, curve.p3)}
    values: Values = {}
    for name in FIELDS[type(curve)]:
        value = getattr(curve, name)
        if name == "sweep":
            values["clockwise"] = value < 0
        elif name != "first":
            values[name] = math.degrees(value) if name == "angle" else value
    return curve.kind, values


def at(p: Vec) -> str:
    """Returns a place as messages have it."""
    return f"({rough(p[0])}, {rough(p[1])})"
