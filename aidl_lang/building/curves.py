"""The primitives before they are solved: what defines them, their pieces, and how far they reach; motions."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Expression, Place
from aidl_lang.building.model import (
    Comparison,
    Frame,
    Geometry,
    Structure,
    chain,
    common_ancestor,
    convert_angle,
    convert_point,
    own_geometry,
)
from aidl_lang.building.values import Exactness, ListVal, Num, PointVal, certain, length, numbers_of, point
from aidl_lang.checking.types import Signature, fields_of
from aidl_lang.checking.units import ANGLE, MaybeDimension
from aidl_lang.common.lettering import box_around
from aidl_lang.common.records import record

if TYPE_CHECKING:
    from aidl_lang.building.values import Value
    from aidl_lang.common.font_files import Vec

# --- The numbers and points that define a primitive, seen from any structure (language reference: geometry).
#
# A primitive stores what defines it in the frame of its owner; `view` converts that to the frame of the
# structure that asks, and everything else a primitive is asked for follows from the view (see `curves`).

DIRECTIONS = fields_of("direction")
"""Fields that are directions: they turn with the frame they are seen from."""


def translate(name: str, value: Value, owner: Structure, here: Structure) -> Value:
    """Returns a value of the frame of `owner` as `here` sees it, in lists too: points and directions turn."""
    if owner is here:
        return value
    if isinstance(value, PointVal):
        return convert_point(value, owner, here)
    if isinstance(value, ListVal):
        return ListVal(tuple(translate(name, item, owner, here) for item in value.items))
    if isinstance(value, Num) and name in DIRECTIONS:
        return Num(convert_angle(value.expression, owner, here), ANGLE, value.status)
    return value


def is_reflected(owner: Structure, here: Structure) -> bool:
    """Tells whether an odd number of mirrored frames lies between the two."""
    if owner is here:
        return False
    meeting = common_ancestor(owner, here)
    return sum(s.frame.mirrored for start in (owner, here) for s in chain(start, meeting)) % 2 == 1


def view(geometry: Geometry, here: Structure) -> dict[str, Value]:
    """Returns the numbers and points that define a primitive, in the frame of `here`."""
    if geometry.owner is here:
        return geometry.fields
    if (known := geometry.views.get(here)) is None:
        known = {n: translate(n, v, geometry.owner, here) for n, v in geometry.fields.items()}
        geometry.views[here] = known
    return known


def clockwise(geometry: Geometry, here: Structure) -> bool:
    """Returns the sense of an arc as `here` sees it."""
    return geometry.clockwise != is_reflected(geometry.owner, here)


def xy(value: Value) -> Place:
    return certain(value, PointVal).place


def number(value: Value) -> Expression:
    return certain(value, Num).expression


def direction(a: Value, b: Value) -> Expression:
    """Returns the direction from one point to another in degrees."""
    return (xy(b) - xy(a)).direction


def distance(a: Value, b: Value) -> Expression:
    return (xy(b) - xy(a)).length


def sweep(core: Mapping[str, Value], is_clockwise: bool) -> Expression:
    """Returns the degrees from the start of an arc to its end, in its own sense; 0 to 360."""
    start, end = direction(core["center"], core["start"]), direction(core["center"], core["end"])
    turn = start - end if is_clockwise else end - start
    return ex.apply("mod", turn, ex.constant(360.0))


def polar(center: Value, radius: Expression, angle: Expression) -> PointVal:
    return point(*(xy(center) + radius * ex.towards(angle)))


def on_text(geometry: Geometry, here: Structure) -> Callable[[Vec], Place]:
    """Returns a function from units of the height of a text, or of a drawing, to the frame of `here`."""
    core = view(geometry, here)
    height = number(core["height" if geometry.trace is None else "unit"])
    start, along = xy(core["start"]), height * ex.towards(number(core["angle"]))
    up = -1.0 if clockwise(geometry, here) else 1.0
    return lambda p: start + Place(ex.constant(p[0]), ex.constant(up * p[1])).turned(along)


def defining(geometry: Geometry, here: Structure) -> list[Expression]:
    """Returns every number that defines a geometry, compound ones through their parts and arguments."""
    found: list[Expression] = []
    for value in view(geometry, here).values():
        found += [n.expression for n in numbers_of(value)]
    for part in own_geometry(geometry.parts, geometry):
        found += defining(part, here)
    return found


# --- Curves of the primitives in numbers that are not solved yet: their fields, their pieces, and how far
# they reach.
#
# A curve of straight lines and cubics gives these (`pieces`), and its box, its ends and its outline follow;
# any other gives its reach, and `geometry.picturing` makes it of its numbers.

Piece: TypeAlias = tuple[Place, ...]
"""The two ends of a straight line, or the four control points of a cubic."""


@record()
class Formulas:
    """The formulas of one kind of primitive, in the numbers that define it, as a structure sees it.

    field    a field by its name, beside those numbers; None if there is none
    pieces   the pieces of its curve, each from where the one before ends; what is left of a direction is
             right of it if the primitive is `clockwise`, turned over
    reach    candidates for its furthest coordinate towards a side, if it has no pieces
    """

    field: Callable[[str, Geometry, Structure], Value | None] = lambda name, g, here: None
    pieces: Callable[[Geometry, Structure], Sequence[Piece]] | None = None
    reach: Callable[[Geometry, Structure, str], Iterator[Expression]] = lambda g, here, side: iter(())


def field(g: Geometry, name: str, here: Structure) -> Value | None:
    """Returns a field of a primitive as `here` sees it; None if it has none of that name."""
    core = view(g, here)
    if name in core:
        return core[name]
    if (formulas := FORMULAS.get(g.type)) is None:
        return None
    if formulas.pieces is not None and name in ("start", "end"):
        at = 0 if name == "start" else -1
        return point(*formulas.pieces(g, here)[at][at])
    return formulas.field(name, g, here)


def pieces(g: Geometry, here: Structure) -> Sequence[Piece]:
    """Returns the pieces of a primitive's curve; none if it is neither lines nor cubics."""
    formulas = FORMULAS.get(g.type)
    return formulas.pieces(g, here) if formulas is not None and formulas.pieces is not None else ()


def reach(g: Geometry, here: Structure, side: str) -> Iterable[Expression]:
    """Returns candidates for the furthest coordinate of a primitive towards a side; none for a point."""
    formulas = FORMULAS[g.type]
    if formulas.pieces is None:
        return formulas.reach(g, here, side)
    return _reach_of(formulas.pieces(g, here), side)


class Towards(NamedTuple):
    """A side of a box: its axis, what lies further out by a length, and the further one of coordinates."""

    axis: int
    outwards: Callable[[Expression, Expression], Expression]
    further: str


_SIDES = {
    "left": Towards(0, operator.sub, "minimum"),
    "right": Towards(0, operator.add, "maximum"),
    "bottom": Towards(1, operator.sub, "minimum"),
    "top": Towards(1, operator.add, "maximum"),
}
towards = _SIDES.__getitem__


def _reach_of(of: Iterable[Piece], side: str) -> list[Expression]:
    axis, outwards, _ = towards(side)
    found: list[Expression] = []
    for piece in of:
        along = [p[axis] for p in piece]
        found += [_cubic_extreme(along, outwards is operator.add)] if len(along) == 4 else along
    return found


def _point(name: str, g: Geometry, here: Structure) -> Value | None:
    at = certain(view(g, here)["at"], PointVal)
    fields: dict[str, Value] = {"x": at.x, "y": at.y, "center": at}
    return fields.get(name)


def _straight(g: Geometry, here: Structure) -> tuple[Piece]:
    core = view(g, here)
    return ((xy(core["start"]), xy(core["end"])),)


def _line(name: str, g: Geometry, here: Structure) -> Value | None:
    core = view(g, here)
    start, end = core["start"], core["end"]
    match name:
        case "midpoint" | "center":
            x, y = xy(start) + xy(end)
            return point(x * 0.5, y * 0.5)
        case "length":
            return length(distance(start, end))
        case "angle":
            return _angle(direction(start, end))
        case "dx":
            return length(xy(end).x - xy(start).x)
        case "dy":
            return length(xy(end).y - xy(start).y)
        case _:
            return None


def _angle(expression: Expression) -> Num:
    return Num(expression, ANGLE, Exactness.REFERENCE)


def _cubic(g: Geometry, here: Structure) -> tuple[Piece]:
    core = view(g, here)
    return (tuple(xy(core[name]) for name in ("p0", "p1", "p2", "p3")),)


def _cubic_extreme(controls: Sequence[Expression], positive: bool) -> Expression:
    if positive:
        return ex.apply("cubic_max", *controls)
    return -ex.apply("cubic_max", *[-c for c in controls])


def _round(name: str, g: Geometry, here: Structure) -> Value | None:
    return length(number(view(g, here)["radius"]) * 2.0) if name == "diameter" else None


def _circle_reach(g: Geometry, here: Structure, side: str) -> Iterator[Expression]:
    core, (axis, outwards, _) = view(g, here), towards(side)
    yield outwards(xy(core["center"])[axis], number(core["radius"]))


def _arc(name: str, g: Geometry, here: Structure) -> Value | None:
    core, is_clockwise = view(g, here), clockwise(g, here)
    match name:
        case "start_angle":
            return _angle(direction(core["center"], core["start"]))
        case "end_angle":
            return _angle(direction(core["center"], core["end"]))
        case "sweep":
            return _angle(sweep(core, is_clockwise))
        case "length":
            turn = sweep(core, is_clockwise) * ex.DEGREE
            return length(number(core["radius"]) * turn)
        case "midpoint":
            middle = sweep(core, is_clockwise) * 0.5
            start = direction(core["center"], core["start"])
            angle = start - middle if is_clockwise else start + middle
            return polar(core["center"], number(core["radius"]), angle)
        case _:
            return _round(name, g, here)


_TOWARDS = {"right": 0.0, "top": 90.0, "left": 180.0, "bottom": 270.0}


def _arc_reach(arc: Geometry, here: Structure, side: str) -> Iterator[Expression]:
    """Yields the quadrant point if the arc passes through it, else the further end."""
    core, (axis, outwards, further) = view(arc, here), towards(side)
    first, turn = _turn(arc, here)
    passes = turn - ex.apply("mod", _TOWARDS[side] - first, ex.constant(360.0))
    quadrant = outwards(xy(core["center"])[axis], number(core["radius"]))
    ends = ex.apply(further, xy(core["start"])[axis], xy(core["end"])[axis])
    yield ex.apply("select", passes, quadrant, ends)


def _turn(arc: Geometry, here: Structure) -> tuple[Expression, Expression]:
    """Returns the direction where an arc begins and its sweep, counter-clockwise, the same for all sides."""
    if (known := arc.turns.get(here)) is None:
        core, is_clockwise = view(arc, here), clockwise(arc, here)
        first = direction(core["center"], core["end" if is_clockwise else "start"])
        known = arc.turns[here] = first, sweep(core, is_clockwise)
    return known


def _ellipse_reach(g: Geometry, here: Structure, side: str) -> Iterator[Expression]:
    """Yields centre plus or minus sqrt((rx cos)^2 + (ry sin)^2), the half-width of a turned ellipse."""
    core, (axis, outwards, _) = view(g, here), towards(side)
    cos, sin = ex.towards(number(core["angle"]))
    along, across = (sin, cos) if axis else (cos, sin)
    half_width = Place(number(core["rx"]) * along, number(core["ry"]) * across).length
    yield outwards(xy(core["center"])[axis], half_width)


def _characters(name: str, g: Geometry, here: Structure) -> Value | None:
    """Returns `glyph`: each character of a text, to be measured. It is drawn with the others."""
    if name != "glyph":
        return None
    named = {f"glyph[{i}]": (glyph,) for i, glyph in enumerate(g.glyphs)}
    return ListVal(tuple(replace(g, glyphs=one, name=n, container=g, views={}) for n, one in named.items()))


def _text_reach(text: Geometry, here: Structure, side: str) -> Iterator[Expression]:
    """Yields, for a text square to the axes, the corners of its ink; for a turned one, the point of its
    silhouette that reaches furthest, or all of it if its turn is not known.
    """
    if not text.glyphs:
        return
    at, angle = on_text(text, here), number(view(text, here)["angle"])
    if angle.is_constant and angle.value % 90.0 == 0.0:
        left, bottom, right, top = box_around(text.glyphs)
        for corner in ((left, bottom), (right, bottom), (left, top), (right, top)):
            yield at(corner)[towards(side).axis]
        return
    reaching = _reach_of((tuple(map(at, piece)) for piece in text.silhouette), side)
    if angle.is_constant:
        furthest = max if towards(side).further == "maximum" else min
        yield furthest(reaching, key=lambda reach: reach.value)
    else:
        yield from reaching


def _trace_reach(g: Geometry, here: Structure, side: str) -> Iterator[Expression]:
    """Yields how far a drawing reaches: a multiple of its unit if its turn is known, else its silhouette."""
    core, (axis, outwards, _) = view(g, here), towards(side)
    angle = number(core["angle"])
    if not angle.is_constant:
        at = on_text(g, here)
        yield from _reach_of((tuple(map(at, piece)) for piece in g.silhouette), side)
        return
    assert g.trace is not None
    # The direction of the side as the drawing sees it: turned back, and over if it is mirrored.
    c, s = ex.exact_turn(angle.value)
    across, up = (s, c) if axis else (c, -s)
    sense = 1.0 if outwards is operator.add else -1.0
    over = -1.0 if clockwise(g, here) else 1.0
    reach = sense * g.trace.furthest((sense * across, sense * over * up))
    yield xy(core["start"])[axis] + number(core["unit"]) * reach


FORMULAS: dict[str, Formulas] = {
    "point": Formulas(_point),
    "line": Formulas(_line, _straight),
    "arc": Formulas(_arc, reach=_arc_reach),
    "circle": Formulas(_round, reach=_circle_reach),
    "ellipse": Formulas(reach=_ellipse_reach),
    "bezier": Formulas(pieces=_cubic),
    "glyphs": Formulas(_characters, reach=_text_reach),
    "traced": Formulas(reach=_trace_reach),
}
"""The formulas of each kind in the registry."""


@lru_cache(maxsize=8)
def gauss(count: int) -> tuple[tuple[float, float], ...]:
    """Returns nodes and weights over 0..1."""
    import numpy as np

    nodes, weights = np.polynomial.legendre.leggauss(count)
    return tuple((float(x + 1) / 2, float(w) / 2) for x, w in zip(nodes, weights, strict=True))


# --- Motions of the plane that keep shapes: moved, turned, mirrored and scaled, over expressions.

NOWHERE = Place(ex.ZERO, ex.ZERO)


@record()
class Motion:
    """p ↦ to + scale · turned(p - about), where a mirrored motion reflects x before it turns.

    about, to  places in the frame of one structure; `turn` in degrees; `facing` its cosine and sine
    """

    about: Place = NOWHERE
    to: Place = NOWHERE
    turn: Expression = ex.ZERO
    facing: Place = Place(ex.ONE, ex.ZERO)
    scale: Expression = ex.ONE
    mirrored: bool = False

    def place(self, at: Place) -> Place:
        way = Place(*(ex.ZERO if a is b else a - b for a, b in zip(at, self.about, strict=True)))
        way = way.turned_over if self.mirrored else way
        return self.to + self.scale * way.turned(self.facing)

    def point(self, p: PointVal) -> PointVal:
        x, y = self.place(p.place)
        return PointVal(Num(x, p.x.dimension, p.x.status), Num(y, p.y.dimension, p.y.status))

    def direction(self, angle: Expression) -> Expression:
        """Returns a direction in degrees, seen after the motion."""
        return _in_turn(self.turn + 180.0 - angle) if self.mirrored else _in_turn(angle + self.turn)

    def measure(self, value: Expression, dimension: MaybeDimension) -> Expression:
        """Returns a length, an area and the like after the motion: only the scale changes it."""
        for _ in range(dimension.length if dimension else 0):
            value = self.scale * value
        return value

    def frame(self, frame: Frame) -> Frame:
        """Returns the frame of a moved structure; the scale applies to its contents."""
        turn = self.turn - frame.rotation if self.mirrored else self.turn + frame.rotation
        return Frame(*self.place(frame.origin), _in_turn(turn), frame.mirrored != self.mirrored)

    @property
    def parts(self) -> tuple[Expression, ...]:
        """The numbers that define it."""
        return (*self.about, *self.to, self.turn, *self.facing, self.scale)

    @property
    def is_still(self) -> bool:
        """True if it moves nothing."""
        if self.mirrored or not all(p.is_constant for p in self.parts):
            return False
        return (
            self.about.written == self.to.written
            and self.turn.value % 360.0 == 0.0
            and self.scale.value == 1.0
        )


STILL = Motion()
"""The motion that leaves everything where it is."""


def _in_turn(angle: Expression) -> Expression:
    """Returns an angle as one between -180 (left out) and 180 as written."""
    return angle + 360.0 * ((180.0 - angle.value) // 360.0)


def opposite(angle: Expression) -> Expression:
    """Returns the opposite direction."""
    return _in_turn(angle + 180.0)


def translation(by: Place) -> Motion:
    return Motion(to=by)


def turned(angle: Expression, about: Place = NOWHERE, to: Place | None = None) -> Motion:
    return Motion(about, to or about, angle, ex.towards(angle))


def mirrored_at_point(about: Place) -> Motion:
    return turned(ex.constant(180.0), about)


def mirrored_at_line(start: PointVal, end: PointVal) -> Motion:
    """Returns the reflection about the endless line through two points.

    About a line of direction φ it is the reflection of x, then the turn by 2φ + 180°.
    """
    at, way = start.place, end.place - start.place
    turn = _in_turn(2.0 * way.direction + 180.0)
    if turn.is_constant:
        return Motion(at, at, turn, ex.towards(turn), mirrored=True)
    xx, yy = ex.apply("square", way.x), ex.apply("square", way.y)
    cos, sin = (yy - xx) / (xx + yy), -2.0 * (way.x * way.y) / (xx + yy)
    return Motion(at, at, turn, Place(cos, sin), mirrored=True)


def after(first: Motion, second: Motion) -> Motion:
    """Returns one motion followed by another."""
    turn = _in_turn(second.turn - first.turn if second.mirrored else second.turn + first.turn)
    is_mirrored = first.mirrored != second.mirrored
    scale = second.scale * first.scale
    return Motion(first.about, second.place(first.to), turn, ex.towards(turn), scale, is_mirrored)


def of_frame(frame: Frame) -> Motion:
    """Returns the motion from the coordinates of a frame to those of the frame around it."""
    turn = frame.rotation
    return Motion(NOWHERE, frame.origin, turn, ex.towards(turn), mirrored=frame.mirrored)


# --- Shapes and structures that are level until a constraint asks them to turn.

_OF_DIRECTIONS = frozenset({"parallel", "perpendicular", "angle", "collinear"})
"""Constraints on the directions of lines, which may be edges of shapes."""

_SMALL = 1e-9


def unlock(*of: Expression) -> None:
    """Frees unknowns that were exact only because nothing asked them to turn."""
    for unknown in ex.unknowns(of):
        unknown.exact &= not unknown.locked


def is_of_directions(definition: Signature) -> bool:
    """Tells whether a constraint is about the directions of lines, which may be edges."""
    return definition.standard and definition.name in _OF_DIRECTIONS


def ask_to_turn(comparisons: Iterable[Comparison]) -> None:
    """Lets shapes turn whose edges a constraint gives a direction: those that it places, and one that it
    holds only if nothing else could give way. Two that are level both stay so.
    """
    for comparison in comparisons:
        found = list(ex.unknowns([comparison.left, comparison.right]))
        level = [u for u in found if u.locked and u.exact]
        shapes = {u.holder for u in level}
        others = [u for u in found if u.holder not in shapes]
        if not others and abs(comparison.left.value - comparison.right.value) < _SMALL:
            continue
        placed = [u for u in level if u in comparison.placed]
        for unknown in placed or ([] if others else level):
            unknown.exact = False
