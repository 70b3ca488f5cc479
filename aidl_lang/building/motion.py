"""Motions of the plane that keep shapes, over expressions, and what waits for a constraint to turn."""

from __future__ import annotations

from collections.abc import Iterable

from aidl_lang.building import expression as ex
from aidl_lang.building.curves import direction, xy
from aidl_lang.building.expression import Expression
from aidl_lang.building.model import Comparison, Frame
from aidl_lang.building.values import Num, PointVal
from aidl_lang.checking.types import Signature
from aidl_lang.checking.units import MaybeDimension
from aidl_lang.common.records import record

# --- Motions of the plane that keep shapes: moved, turned, mirrored and scaled, over expressions.

Place = tuple[Expression, Expression]

NOWHERE: Place = (ex.ZERO, ex.ZERO)
_HALF_TURN = ex.constant(180.0)


@record()
class Motion:
    """p ↦ to + scale · turned(p - about), where a mirrored motion reflects x before it turns.

    about, to  coordinates in mm in the frame of one structure; `turn` in degrees; cos, sin of it
    """

    about: Place = NOWHERE
    to: Place = NOWHERE
    turn: Expression = ex.ZERO
    cos: Expression = ex.ONE
    sin: Expression = ex.ZERO
    scale: Expression = ex.ONE
    mirrored: bool = False

    def place(self, x: Expression, y: Expression) -> Place:
        u, v = self._from(x, self.about[0]), self._from(y, self.about[1])
        if self.mirrored:
            u = ex.apply("neg", u)
        s, t = ex.turned(self.cos, self.sin, u, v)
        return ex.add(self.to[0], ex.mul(self.scale, s)), ex.add(self.to[1], ex.mul(self.scale, t))

    @staticmethod
    def _from(a: Expression, b: Expression) -> Expression:
        """Returns the difference of two coordinates; exactly 0 for a coordinate and itself."""
        return ex.ZERO if a is b else ex.sub(a, b)

    def point(self, p: PointVal) -> PointVal:
        x, y = self.place(*xy(p))
        return PointVal(Num(x, p.x.dimension, p.x.status), Num(y, p.y.dimension, p.y.status))

    def direction(self, angle: Expression) -> Expression:
        """Returns a direction in degrees, seen after the motion."""
        if self.mirrored:
            return _in_turn(ex.sub(ex.add(self.turn, _HALF_TURN), angle))
        return _in_turn(ex.add(angle, self.turn))

    def measure(self, value: Expression, dimension: MaybeDimension) -> Expression:
        """Returns a length, an area and the like after the motion: only the scale changes it."""
        for _ in range(dimension.length if dimension else 0):
            value = ex.mul(self.scale, value)
        return value

    def frame(self, frame: Frame) -> Frame:
        """Returns the frame of a moved structure; the scale applies to its contents."""
        x, y = self.place(frame.x, frame.y)
        turned = ex.sub if self.mirrored else ex.add
        return Frame(x, y, _in_turn(turned(self.turn, frame.rotation)), frame.mirrored != self.mirrored)

    @property
    def parts(self) -> tuple[Expression, ...]:
        """The numbers that define it."""
        return (*self.about, *self.to, self.turn, self.cos, self.sin, self.scale)

    @property
    def is_still(self) -> bool:
        """True if it moves nothing."""
        if self.mirrored or not all(p.is_constant for p in self.parts):
            return False
        stays = [a.value for a in self.about] == [a.value for a in self.to]
        return stays and self.turn.value % 360.0 == 0.0 and self.scale.value == 1.0


STILL = Motion()
"""The motion that leaves everything where it is."""


def _in_turn(angle: Expression) -> Expression:
    """Returns an angle as one between -180 (left out) and 180 as written."""
    turns = ex.constant(360.0 * ((180.0 - angle.value) // 360.0))
    return ex.add(angle, turns)


def opposite(angle: Expression) -> Expression:
    """Returns the opposite direction."""
    return _in_turn(ex.add(angle, _HALF_TURN))


def translation(by: Place) -> Motion:
    return Motion(to=by)


def turned(angle: Expression, about: Place = NOWHERE, to: Place | None = None) -> Motion:
    return Motion(about, to or about, angle, ex.cos(angle), ex.sin(angle))


def mirrored_at_point(about: Place) -> Motion:
    return turned(_HALF_TURN, about)


def mirrored_at_line(start: PointVal, end: PointVal) -> Motion:
    """Returns the reflection about the endless line through two points.

    About a line of direction φ it is the reflection of x, then the turn by 2φ + 180°.
    """
    at = xy(start)
    (ax, ay), (bx, by) = at, xy(end)
    turn = _in_turn(ex.add(ex.mul(ex.constant(2.0), direction(start, end)), _HALF_TURN))
    if turn.is_constant:
        return Motion(at, at, turn, ex.cos(turn), ex.sin(turn), mirrored=True)
    dx, dy = ex.sub(bx, ax), ex.sub(by, ay)
    xx, yy, xy_ = ex.apply("square", dx), ex.apply("square", dy), ex.mul(dx, dy)
    whole = ex.add(xx, yy)
    cos = ex.div(ex.sub(yy, xx), whole)
    sin = ex.div(ex.mul(ex.constant(-2.0), xy_), whole)
    return Motion(at, at, turn, cos, sin, mirrored=True)


def after(first: Motion, second: Motion) -> Motion:
    """Returns one motion followed by another."""
    way = ex.sub if second.mirrored else ex.add
    turn = _in_turn(way(second.turn, first.turn))
    to, scale = second.place(*first.to), ex.mul(second.scale, first.scale)
    is_mirrored = first.mirrored != second.mirrored
    return Motion(first.about, to, turn, ex.cos(turn), ex.sin(turn), scale, is_mirrored)


def of_frame(frame: Frame) -> Motion:
    """Returns the motion from the coordinates of a frame to those of the frame around it."""
    turn = frame.rotation
    return Motion(NOWHERE, (frame.x, frame.y), turn, ex.cos(turn), ex.sin(turn), mirrored=frame.mirrored)


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
