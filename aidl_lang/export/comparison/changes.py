"""The result of a comparison as data. Lengths in mm, areas in mm², angles in degrees."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, field, replace
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.prose import rounded
from aidl_lang.common.records import record
from aidl_lang.export.json import Json, contact
from aidl_lang.geometry.boolean import Contact
from aidl_lang.geometry.curves import FIELDS, Arc, Circle, Ellipse, Vec
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.solved import Scalar, SolvedGeometry, SolvedModel

# --- Rigid motions of the plane, and finding the one between two poses.

Points = NDArray[np.float64]
_SAME_ANGLE = 1e-4
"""Degrees by which the axes of an ellipse may differ."""


@record(slots=True)
class Move:
    """A rigid motion: reflects x if `mirrored`, turns by `turn` degrees, then shifts by (dx, dy) mm."""

    dx: float = 0.0
    dy: float = 0.0
    turn: float = 0.0
    mirrored: bool = False

    def __call__(self, p: Vec) -> Vec:
        x, y = self.all(np.array([p]))[0]
        return float(x), float(y)

    def all(self, points: Points) -> Points:
        """Returns the images of many points, shape (n, 2)."""
        if not (self.turn or self.mirrored):
            shifted: Points = points + np.array((self.dx, self.dy))
            return shifted
        c, s = math.cos(math.radians(self.turn)), math.sin(math.radians(self.turn))
        x = -points[:, 0] if self.mirrored else points[:, 0]
        y = points[:, 1]
        return np.stack((c * x - s * y + self.dx, s * x + c * y + self.dy), axis=1)

    @property
    def fixed_point(self) -> Vec:
        """The point about which it turns, if that is what it does."""
        # (1 - R) p = d, and (1 - R) is 2 sin(turn/2) times a turn by (turn - 180)/2.
        half = math.radians(self.turn) / 2
        k = 1 / (2 * math.tan(half))
        return self.dx / 2 - k * self.dy, self.dy / 2 + k * self.dx


STILL = Move()


@record()
class Pose:
    """The positions of a thing, before and after.

    tolerance  how far a place may be off, mm
    points     shape (2, n, 2)
    axes       directions of ellipses in degrees, alike modulo 180, shape (2, m)
    congruent  whether sizes without a place (radii) agree and every part has its counterpart
    centers    the centre before and after of a shape that has one, whatever became of the rest
    """

    tolerance: float
    points: Points = field(default_factory=lambda: np.zeros((2, 0, 2)))
    axes: NDArray[np.float64] = field(default_factory=lambda: np.zeros((2, 0)))
    congruent: bool = True
    centers: Points | None = None

    @classmethod
    def joined(cls, poses: Iterable[Pose], tolerance: float) -> Pose:
        all_ = [cls(tolerance), *poses]
        return cls(
            tolerance,
            np.concatenate([p.points for p in all_], axis=1),
            np.concatenate([p.axes for p in all_], axis=1),
            all(p.congruent for p in all_),
        )

    def fits(self, move: Move) -> bool:
        """True if everything moved by `move`."""
        before, after = self.points
        if not self.congruent or not bool(np.all(np.abs(move.all(before) - after) <= self.tolerance)):
            return False
        first, last = self.axes
        turned = (-first + 180 if move.mirrored else first) + move.turn
        return bool(np.all(np.abs((turned - last + 90) % 180 - 90) <= _SAME_ANGLE))

    def follows(self, move: Move) -> bool:
        """True if it moved by `move`; of a thing that changed its shape, if its centre did."""
        if self.centers is None or self.whole is not None:
            return self.fits(move)
        return bool(np.all(np.abs(move.all(self.centers[0]) - self.centers[1]) <= self.tolerance))

    def move(self, expected: Move = STILL) -> Move | None:
        """Returns the motion of all points, if there is one: `expected` if that fits, else the simplest."""
        if not self.congruent:
            return None
        return next((m for m in self._candidates(expected) if self.fits(m)), None)

    @cached_property
    def whole(self) -> Move | None:
        """The simplest motion of all its points, if there is one."""
        return self.move()

    def shift(self) -> Move | None:
        """The motion of the whole, else of the centre."""
        if self.centers is None or self.whole is not None:
            return self.whole
        return self._clean(Move(*(self.centers[1] - self.centers[0])[0]))

    def _candidates(self, expected: Move) -> Iterator[Move]:
        yield expected
        yield STILL
        before, after = self.points
        if not len(before):
            return
        p, q = before[0], after[0]
        yield self._clean(Move(*(q - p)))
        arms = before - p
        far = int(np.argmax(np.hypot(*arms.T)))
        (x, y), (u, v) = arms[far], after[far] - q
        for mirrored in (False, True):
            if math.hypot(x, y) > self.tolerance:
                turn = math.degrees(math.atan2(v, u) - math.atan2(y, -x if mirrored else x))
            elif self.axes.size:
                turn = self.axes[1][0] - (180 - self.axes[0][0] if mirrored else self.axes[0][0])
                turn = (turn + 90) % 180 - 90
            else:
                return
            about = Move(turn=180 - (180 - float(turn)) % 360, mirrored=mirrored)
            yield self._clean(replace(about, dx=q[0] - about(p)[0], dy=q[1] - about(p)[1]))

    def _clean(self, move: Move) -> Move:
        """Returns the motion without shifts that are rounding."""
        dx, dy = (0.0 if abs(d) <= self.tolerance else float(d) for d in (move.dx, move.dy))
        return replace(move, dx=dx, dy=dy)


def pose_of(before: SolvedGeometry, after: SolvedGeometry, tolerance: float) -> Pose:
    """Returns the pose of two geometries; not congruent if they differ in kind, in parts or in radii."""
    both = list(zip(before.walk(), after.walk(), strict=False))
    centers = [g.values.get("center") for g in (before, after)]
    known = np.array(centers, dtype=np.float64).reshape(2, 1, 2) if all(centers) else None
    if not all(_are_congruent(a, b, tolerance) for a, b in both):
        return Pose(tolerance, congruent=False, centers=known)
    places = [pair for a, b in both for pair in zip(_places(a), _places(b), strict=True)]
    axes = [
        (math.degrees(a.curve.angle), math.degrees(b.curve.angle))
        for a, b in both
        if isinstance(a.curve, Ellipse) and isinstance(b.curve, Ellipse)
        if abs(a.curve.rx - a.curve.ry) > tolerance
    ]
    return Pose(
        tolerance,
        np.array(places, dtype=np.float64).reshape(-1, 2, 2).transpose(1, 0, 2),
        np.array(axes, dtype=np.float64).reshape(-1, 2).T,
        centers=known,
    )


def _are_congruent(a: SolvedGeometry, b: SolvedGeometry, tolerance: float) -> bool:
    """Tells whether two geometries, their parts aside, agree in kind, in parts and in radii."""
    if a.type != b.type or [p.name for p in a.parts] != [p.name for p in b.parts]:
        return False
    if type(a.curve) is not type(b.curve) or len(_places(a)) != len(_places(b)):
        return False
    return all(abs(r - s) <= tolerance for r, s in zip(_radii(a), _radii(b), strict=True))


def _places(g: SolvedGeometry) -> list[Vec]:
    """Returns points that fix where a primitive is and its direction; of an arc its middle, too."""
    if g.curve is None:
        at = g.values.get("at")
        return [] if at is None else [at]  # type: ignore[list-item]
    found = [getattr(g.curve, name) for name in FIELDS[type(g.curve)]]
    middle = [g.curve.point(0.5)] if isinstance(g.curve, Arc) else []
    return [each for each in found if isinstance(each, tuple)] + middle


def _radii(g: SolvedGeometry) -> tuple[float, ...]:
    match g.curve:
        case Circle(_, radius):
            return (abs(radius),)
        case Ellipse(_, rx, ry):
            return abs(rx), abs(ry)
        case _:
            return ()


# Of two values the first is from before, the second from after; None stands for nothing.

Value: TypeAlias = Scalar | Vec | tuple[Scalar, ...] | None
Fields: TypeAlias = Mapping[str, tuple[Value, Value]]
Sort: TypeAlias = Literal["changed", "appeared", "vanished"]


@record()
class Version:
    """One side of a comparison: a solved model and its drawing."""

    model: SolvedModel
    drawing: Drawing


@record()
class GeometryChange:
    """The change of a named geometry: of `fields` if it did not move as a whole."""

    name: str
    type: str
    sort: Sort = "changed"
    was: str | None = None
    move: Move | None = None
    fields: Fields = field(default_factory=dict)
    is_outline_changed: bool = False


@record()
class StructureChange:
    """The change of a structure.

    path      after; before for one that vanished
    was       its path before, if it was found by its shape under another name or elsewhere in the tree
    move      its motion as a whole; None if it stayed, or went with its parent
    middle    the middle of its box before; after for one that appeared
    sizes     width and height of its box; area, perimeter and centroid of its region
    settings  attributes as `@name`, finished corners as `fillet of NAME`, and `kind`
    """

    path: str
    kind: str
    sort: Sort = "changed"
    was: str | None = None
    move: Move | None = None
    middle: Vec | None = None
    sizes: Fields = field(default_factory=dict)
    params: Fields = field(default_factory=dict)
    settings: Fields = field(default_factory=dict)
    geometry: tuple[GeometryChange, ...] = ()

    @property
    def is_one(self) -> bool:
        """True if anything changed."""
        told = (self.was, self.move, self.sizes, self.params, self.settings, self.geometry)
        return self.sort != "changed" or any(told)


@record()
class ContactChange:
    """The contact of two bodies before and after, named by their paths after; None for bodies far apart."""

    a: str
    b: str
    before: Contact | None
    after: Contact | None


@record()
class Comparison:
    """The differences between two versions, in order of writing.

    freed, held  parameters that can move now and could not before, and the reverse, by their paths
    size         of the larger drawing, mm; `tolerance` is 1e-6 of it
    """

    before: Version
    after: Version
    structures: tuple[StructureChange, ...]
    contacts: tuple[ContactChange, ...]
    freed: tuple[str, ...]
    held: tuple[str, ...]
    size: float

    @property
    def status(self) -> tuple[str, str]:
        return self.before.model.status, self.after.model.status

    @property
    def degrees(self) -> tuple[int | None, int | None]:
        """Returns the degrees of freedom before and after."""
        return self.before.model.degrees, self.after.model.degrees

    @property
    def is_equal(self) -> bool:
        """True if the versions do not differ."""
        same = self.status[0] == self.status[1] and self.degrees[0] == self.degrees[1]
        return same and not (self.structures or self.contacts or self.freed or self.held)

    def __str__(self) -> str:
        from aidl_lang.export.comparison.showing import text

        return text(self)

    def to_dict(self) -> Json:
        """Returns plain dicts and lists, numbers to 12 digits; of a pair the first is from before."""
        document: Json = rounded(
            {
                "aidl_diff": VERSION,
                "units": "mm",
                "equal": self.is_equal,
                "status": self.status,
                "dof": self.degrees,
                "freed": self.freed,
                "held": self.held,
                "structures": [_structure(s) for s in self.structures],
                "contacts": [
                    {"a": c.a, "b": c.b, "before": _lie(c.before), "after": _lie(c.after)}
                    for c in self.contacts
                ],
            }
        )
        return document


# --- A comparison as plain dicts and lists, for programs.

VERSION = 1


def _structure(s: StructureChange) -> Json:
    entry: Json = {"path": s.path, "kind": s.kind, "change": s.sort}
    entry |= _went(s.was, s.move)
    fields = {"sizes": s.sizes, "params": s.params, "settings": s.settings}
    entry |= {name: found for name, found in fields.items() if found}
    if s.geometry:
        entry["geometry"] = [_geometry(g) for g in s.geometry]
    return entry


def _geometry(g: GeometryChange) -> Json:
    entry: Json = {"name": g.name, "type": g.type, "change": g.sort} | _went(g.was, g.move)
    if g.fields:
        entry["fields"] = g.fields
    if g.is_outline_changed:
        entry["outline"] = "changed"
    return entry


def _went(was: str | None, move: Move | None) -> Json:
    entry: Json = {} if was is None else {"was": was}
    if move is not None:
        entry["move"] = asdict(move)
    return entry


def _lie(pair: Contact | None) -> Json | None:
    return None if pair is None else contact(pair, ("relation", "gap", "area"))
