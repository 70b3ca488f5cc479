"""The structure tree that a program describes, before it is solved.

A structure has a frame, a sketch (geometry and parameters), children and constraints (paper, appendix A).
Expressions in a geometry are in the frame of the structure that owns it; those in a constraint are in the
frame of the structure that holds it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field, replace
from functools import cached_property, reduce
from typing import TYPE_CHECKING, ClassVar, TypeAlias

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Expression, Place, Unknown
from aidl_lang.building.values import Num, PointVal, leaves
from aidl_lang.checking.types import StructureType, TruthType, Type, fields_of, geometry_type
from aidl_lang.checking.units import MaybeDimension
from aidl_lang.common.lettering import Glyph, silhouette
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.building.state import Scope
    from aidl_lang.building.values import Value
    from aidl_lang.building.wording import Wording
    from aidl_lang.common.drawings import Trace
    from aidl_lang.common.font_files import Curve

SIZES = fields_of("size") | {"width", "thickness", "fillet", "chamfer"}
"""Names of sizes, which are never negative."""

_SIZE_WORDS = SIZES | {"size", "side", "flats"}


def is_size(name: str) -> bool:
    """Tells whether a name is a size by its last word: `radius`, `inner_radius`, `top_width`."""
    return name.rpartition("_")[2] in _SIZE_WORDS


@record(frozen=False, eq=False)
class Frame:
    """Position and rotation relative to the parent; a mirrored frame reflects x before it turns."""

    x: Expression = ex.ZERO
    y: Expression = ex.ZERO
    rotation: Expression = ex.ZERO
    mirrored: bool = False

    @property
    def is_level(self) -> bool:
        """True if it is exactly not turned, as most are."""
        return self.rotation.is_constant and self.rotation.value == 0.0

    @property
    def origin(self) -> Place:
        return Place(self.x, self.y)

    def outward(self, at: Place) -> Place:
        """Converts a place in this frame to that in the parent's."""
        return self.origin + self.turn(at)

    def inward(self, at: Place) -> Place:
        """Converts a place in the parent's frame to that in this one."""
        way = at - self.origin
        if not self.is_level:
            c, s = ex.towards(self.rotation)
            way = Place(c * way.x + s * way.y, c * way.y - s * way.x)
        return way.turned_over if self.mirrored else way

    def turn(self, way: Place) -> Place:
        way = way.turned_over if self.mirrored else way
        return way if self.is_level else way.turned(ex.towards(self.rotation))


@record(frozen=False, eq=False)
class Geometry:
    """A primitive (see `checking.types`) or a compound shape.

    fields     the numbers and points that define a primitive
    scope      names of a compound shape: its parts, arguments and lets (see scopes)
    arguments  names of the arguments of a compound shape
    parts      named geometry inside a compound shape, in order of writing
    clockwise  the sense of an arc; any other curve is turned over: a text reads in a mirror
    source     the geometry it is a copy of
    known_as   the copy of a nameless geometry, by which it is known
    reach      the structure that holds both, if it is derived of geometry outside of its owner
    glyphs     for a text, its characters in units of its height
    trace      for a drawing of another program, its outlines in millimetres of the file
    filled     a drawing fills what it encloses, as it does letters
    bridge     for a text to be cut, how wide the bridges to what its letters enclose are: a length, or as a
               plain number a share of its height
    recipe     the way its curves come from other outlines after solving
    finishes   sizes of the fillets and chamfers of its corners: `fillet` of a point or a whole outline,
               `end.fillet` of the end of a curve
    attributes  its own: `note`, and in a drawing `color`
    """

    type: str
    owner: Structure
    span: Span | None
    fields: dict[str, Value] = field(default_factory=dict)
    parts: dict[str, Value] = field(default_factory=dict)
    scope: Scope | None = None
    arguments: tuple[str, ...] = ()
    clockwise: bool = False
    glyphs: tuple[Glyph, ...] = ()
    trace: Trace | None = None
    filled: bool = False
    bridge: Num | None = None
    name: str | None = None
    container: Geometry | Structure | None = None
    construction: bool = False
    source: Geometry | None = None
    known_as: Geometry | None = None
    reach: Structure | None = None
    recipe: Recipe | None = None
    finishes: dict[str, Num] = field(default_factory=dict)
    attributes: dict[str, tuple[Value, ...]] = field(default_factory=dict)
    views: dict[Structure, dict[str, Value]] = field(default_factory=dict, repr=False)
    turns: dict[Structure, tuple[Expression, Expression]] = field(default_factory=dict, repr=False)

    @cached_property
    def silhouette(self) -> tuple[Curve, ...]:
        """The silhouette of a text or a drawing in its own units (see `lettering.silhouette`)."""
        if self.trace is not None:
            return self.trace.silhouette
        return silhouette([curve for glyph in self.glyphs for curve in glyph.curves])

    @property
    def value_type(self) -> Type:
        return geometry_type(self.type)

    @property
    def bound_to(self) -> Structure:
        """The structure whose unknowns it depends on, which alone (and those around it) may constrain it."""
        return self.reach or self.owner

    @property
    def is_nameless(self) -> bool:
        return self.name is None and (self.known_as is None or self.known_as.is_nameless)

    @property
    def is_guide(self) -> bool:
        """True if it, or what it is a part of, is construction geometry."""
        return self.construction or (isinstance(self.container, Geometry) and self.container.is_guide)

    @property
    def path(self) -> str:
        if self.name is None and self.known_as is not None:
            return self.known_as.path
        container = self.container or self.owner
        return f"{container.path}.{self.name or self.type}"

    @property
    def is_compound(self) -> bool:
        return self.scope is not None

    @property
    def is_drawn_later(self) -> bool:
        """True if its curves are worked out after solving; geometry that the library makes has its own."""
        return self.recipe is not None and self.recipe.kind == self.type

    def primitives(self, *, even_construction: bool = False) -> Iterator[Geometry]:
        """Yields the primitives that are drawn, in order of writing; construction geometry only if asked."""
        if self.construction and not even_construction:
            return
        if not self.is_compound:
            yield self
        for part in own_geometry(self.parts, self):
            yield from part.primitives()


@record(eq=False)
class Recipe:
    """The way in which the curves of an outline come from others, by exact geometry after solving.

    kind      one of `builtins.OUTLINES`
    operands  each some geometry that is one outline together
    numbers   its distance, thickness or width
    words     the styles of its corners, joints and ends
    """

    kind: str
    operands: tuple[tuple[Geometry, ...], ...]
    numbers: Mapping[str, Num] = field(default_factory=dict)
    words: Mapping[str, str] = field(default_factory=dict)

    @property
    def sources(self) -> tuple[Geometry, ...]:
        """The geometry that it is made of, each once."""
        return tuple(dict.fromkeys(g for group in self.operands for g in group))

    def made_of(self, copy: Callable[[Geometry], Geometry], measure: Callable[[Num], Num]) -> Recipe:
        """Returns the same recipe for copies of its operands."""
        operands = tuple(tuple(map(copy, group)) for group in self.operands)
        return replace(self, operands=operands, numbers={n: measure(v) for n, v in self.numbers.items()})


@record(eq=False)
class Finish:
    """A fillet or chamfer, which is applied after solving.

    of     the geometry whose corner it is; empty for a bare point
    at     the corner, in the frame of the structure that lists it; None for all corners of `of`
    sizes  radius, or one distance or two; none for the largest that fits
    text   the corner as it was written
    run    the same for those that one run of a statement makes
    """

    kind: str
    of: tuple[Geometry, ...]
    at: PointVal | None
    sizes: tuple[Num, ...]
    text: str
    span: Span
    run: int = 0


@record()
class Measurement:
    """A number that only the finished drawing has: area, perimeter, clearance, overlaps (1 or 0), or a side
    of the box of an outline made of others, in the frame of `here`.
    """

    kind: str
    of: tuple[Structure | Geometry, ...]
    here: Structure | None = None


@record(frozen=False, eq=False)
class Structure:
    """
    members     everything that has a name in it: geometry, arrays, children, numbers
    geometry    what it draws itself; children: structures directly inside
    plan        the box of its own that an empty structure has: left, bottom, width, height
    source      the structure it is a copy of
    extents     sides of its box that were worked out, and `interior` the unknowns that place what is in it,
                once it is complete (see boxes)
    converted   places in it as other structures see them (see `convert`)
    scope       the names its body sees (see interp)
    finishes    fillets and chamfers of its geometry
    clip        the outline that all in it is drawn inside of; empty for none
    ground      the solid on whose material alone all in a drawing is drawn
    """

    value_type = StructureType()
    kind: str
    name: str
    parent: Structure | None
    span: Span | None
    frame: Frame = field(default_factory=Frame)
    attributes: dict[str, tuple[Value, ...]] = field(default_factory=dict)
    members: dict[str, Value] = field(default_factory=dict)
    geometry: dict[str, Value] = field(default_factory=dict)
    children: list[Structure] = field(default_factory=list)
    scope: Scope | None = None
    plan: tuple[Expression, Expression, Expression, Expression] | None = None
    source: Structure | None = None
    extents: dict[object, Expression] = field(default_factory=dict, repr=False)
    interior: tuple[Unknown, ...] | None = field(default=None, repr=False)
    converted: dict[tuple[Place, Structure], Place] = field(default_factory=dict, repr=False)
    finishes: list[Finish] = field(default_factory=list)
    clip: tuple[Geometry, ...] = ()
    ground: Structure | None = None
    doc: str | None = None
    is_complete: bool = False
    is_nameless: ClassVar[bool] = False

    @property
    def path(self) -> str:
        return f"{self.parent.path}.{self.name}" if self.parent and self.parent.name else self.name

    @property
    def is_empty(self) -> bool:
        return not self.geometry and not self.children

    def walk(self) -> Iterator[Structure]:
        stack = [self]
        while stack:
            yield (top := stack.pop())
            stack.extend(reversed(top.children))

    def own(self) -> Iterable[Geometry]:
        """Returns the named geometry of this structure itself, in order of writing."""
        return self._own if self.is_complete else own_geometry(self.geometry, self)

    @cached_property
    def _own(self) -> tuple[Geometry, ...]:
        return tuple(own_geometry(self.geometry, self))

    def drawn(self) -> Iterable[Geometry]:
        """Returns the primitives of its own that are drawn, in order of writing."""
        return self._drawn if self.is_complete else (p for g in self.own() for p in g.primitives())

    @cached_property
    def _drawn(self) -> tuple[Geometry, ...]:
        return tuple(p for g in self._own for p in g.primitives())

    def is_within(self, other: Structure) -> bool:
        """Tells whether this structure is `other` or lies below it."""
        return other in chain(self)


Holder = Geometry | Structure
"""What numbers belong to."""


def own_geometry(named: dict[str, Value], container: Geometry | Structure) -> Iterator[Geometry]:
    """Returns the geometry among named values that belongs to the container, members of arrays and lists
    included; each once, however many names it has.
    """
    held = (item for value in named.values() for item in leaves(value))
    own = (item for item in held if isinstance(item, Geometry) and item.container is container)
    return iter(dict.fromkeys(own))


def all_parts(g: Geometry) -> Iterator[Geometry]:
    """Yields the named geometry inside a compound shape, at any depth."""
    for part in own_geometry(g.parts, g):
        yield part
        yield from all_parts(part)


def chain(structure: Structure, up_to: Structure | None = None) -> list[Structure]:
    """Returns the structure and its ancestors, innermost first; with `up_to`, those below that one."""
    found: list[Structure] = []
    here: Structure | None = structure
    while here is not None and here is not up_to:
        found.append(here)
        here = here.parent
    return found


def common_ancestor(a: Structure, b: Structure) -> Structure:
    above = set(chain(a))
    return next(s for s in chain(b) if s in above)


def reach_of(owners: Iterable[Structure], here: Structure) -> Structure | None:
    """Returns the nearest structure around `here` and the owners of something's sources; None for `here`."""
    reach = reduce(common_ancestor, owners, here)
    return reach if reach is not here else None


def convert(at: Place, source: Structure, target: Structure) -> Place:
    """Converts a place in the frame of `source` to `target`'s; equal ones to the same expressions."""
    if source is target:
        return at
    key = at, target
    if (known := source.converted.get(key)) is not None:
        return known
    meeting = common_ancestor(source, target)
    for structure in chain(source, meeting):
        at = structure.frame.outward(at)
    for structure in reversed(chain(target, meeting)):
        at = structure.frame.inward(at)
    source.converted[key] = at
    return at


def convert_point(point: PointVal, source: Structure, target: Structure) -> PointVal:
    if source is target:
        return point
    x, y = convert(Place(point.x.expression, point.y.expression), source, target)
    status = max(point.x.status, point.y.status)
    return PointVal(Num(x, point.x.dimension, status), Num(y, point.y.dimension, status))


def convert_angle(angle: Expression, source: Structure, target: Structure) -> Expression:
    """Converts a direction in degrees in the frame of `source` to that of `target`."""
    meeting = common_ancestor(source, target)
    for frame in (s.frame for s in chain(source, meeting)):
        angle = _mirrored(angle, frame) + frame.rotation
    for frame in (s.frame for s in reversed(chain(target, meeting))):
        angle = _mirrored(angle - frame.rotation, frame)
    return angle


def _mirrored(angle: Expression, frame: Frame) -> Expression:
    return 180.0 - angle if frame.mirrored else angle


@record(eq=False)
class Comparison:
    """`left REL right`, REL one of `== != <= >= < >`, with boxes spelled out.

    moved    the unknowns that may move first if a call decides that; else those of the left side
    parties  of a call over equals (`row`, `symmetric`, `same_width`, a list that is aligned) the unknowns
             that place each of them, in the order of the arguments: none is held by its place. Once the whole
             program is known, `moved` is what they have but for the anchor (see `interp`)
    boxes    the structures whose boxes it mentions, each with the sides of it
    beside   the unknowns it mentions beside these; None if it mentions no structure's box
    """

    relation: str
    left: Expression
    right: Expression
    dimension: MaybeDimension
    moved: frozenset[Unknown] | None = None
    boxes: Mapping[Structure, frozenset[str]] = field(default_factory=dict)
    beside: frozenset[Unknown] | None = None
    parties: tuple[frozenset[Unknown], ...] = ()

    @property
    def placed(self) -> frozenset[Unknown]:
        """The unknowns that may move first to satisfy it; the rest is held until that is not enough."""
        if self.moved is not None:
            return self.moved
        return frozenset(ex.unknowns([self.left])) or frozenset(ex.unknowns([self.right]))

    @property
    def spoken_of(self) -> Iterable[Unknown]:
        """The unknowns that it mentions by themselves, and not only as contents of a structure's box."""
        return ex.unknowns([self.left, self.right]) if self.beside is None else self.beside


Part: TypeAlias = "Condition | Comparison | bool"
"""A part of a condition."""


@record(eq=False)
class Condition:
    """A condition over unknowns: a comparison, or `and`, `or`, `not` of conditions."""

    value_type = TruthType()

    operator: str
    parts: tuple[Part, ...]

    def comparisons(self) -> Iterator[Comparison]:
        for part in self.parts:
            if isinstance(part, Comparison):
                yield part
            elif isinstance(part, Condition):
                yield from part.comparisons()


@record(eq=False)
class Constraint:
    """One constraint as its author sees it. `weight` is None for a hard one."""

    holder: Structure
    comparisons: tuple[Comparison, ...]
    text: str
    span: Span
    weight: float | None = None
    label: str = ""  # loop variables at the place, as `i = 3`
    wording: Wording | None = field(default=None, repr=False)
    """the statement, to be read in other words (see building.wording); None for what was not stated"""
    is_inherent: bool = False
    """a demand of a shape on itself: nobody stated it for the structure that the shape is in"""

    @property
    def node(self) -> ast.Expression | None:
        """The statement, if it is all that is written at its place; else None."""
        wording = self.wording
        return wording.node if wording is not None and wording.node.span == self.span else None

    @cached_property
    def mentions(self) -> tuple[str, ...]:
        """The paths of the geometry and structures whose unknowns it relates."""
        both = (e for c in self.comparisons for e in (c.left, c.right))
        return tuple(sorted({u.holder.path for u in ex.unknowns(both)}))


@record(eq=False)
class Assertion:
    holder: Structure
    condition: Condition | bool
    message: str | None
    text: str
    span: Span
    label: str = ""
    shape: str = ""  # the shape that demands this of its arguments
    wording: Wording | None = field(default=None, repr=False)
    """the condition, to be read again in parts (see building.wording)"""
    outline: Geometry | None = None  # the outline whose box a constraint foresaw to be as this asks
    is_followed: bool = False
    """the members of a pattern are where they are on a curve that was solved to another form"""
    extent: float = 0.0
    """the length of a text along a curve, in heights of a capital, which the curve is to have room for"""


def told(stated: Constraint | Assertion) -> str:
    """Returns what was stated for a sentence, and in which turn of a loop."""
    return f"`{stated.text}` [{stated.label}]" if stated.label else f"`{stated.text}`"


@record(eq=False)
class Literal:
    """A number that stands in the text, and the expression that the solver finds in its place.

    node    the number, with its sign if there is one
    became  the expression whose solved value is read, in the frame that the number is written in
    holder  the thing that it is a number of, `field` its name there (`end.x`)
    dimension of that field, also if the number is bare; None if nothing gives one
    """

    node: ast.Number | ast.Unary
    became: Expression
    holder: Geometry | Structure
    field: str
    dimension: MaybeDimension

    @property
    def path(self) -> str:
        return f"{self.holder.path}.{self.field}"


@record()
class Knob:
    """A `param` as seen from outside: a value that `-D path=value` or a slider sets."""

    path: str
    value: float | str | bool
    low: float | None
    high: float | None
    choices: tuple[float | str | bool, ...]
    step: float | None
    unit: str
    doc: str | None
    span: Span | None = field(default=None, compare=False)

    @property
    def range(self) -> tuple[float, float] | None:
        """The least and the greatest value, if it has a range."""
        return None if self.low is None or self.high is None else (self.low, self.high)


@record(frozen=False, eq=False)
class Model:
    """
    unknowns    in order of creation
    readings    choices among the meanings of ambiguous calls, by place, for the report
    literals    numbers of the text, and of the library's, that are first guesses or kept sizes; one for each
                use
    by_hand     dimensions that the program asks for, which constrain nothing
    """

    root: Structure
    constraints: list[Constraint] = field(default_factory=list)
    assertions: list[Assertion] = field(default_factory=list)
    unknowns: list[Unknown] = field(default_factory=list)
    knobs: list[Knob] = field(default_factory=list)
    readings: list[tuple[Span, str]] = field(default_factory=list)
    literals: list[Literal] = field(default_factory=list)
    by_hand: list[Constraint] = field(default_factory=list)
