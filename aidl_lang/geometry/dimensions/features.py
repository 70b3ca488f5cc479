"""Measures of curves and sizes of geometry."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Evaluator, Expression
from aidl_lang.building.model import Geometry, Model, Structure, convert_angle
from aidl_lang.building.state import Scope
from aidl_lang.building.values import ListVal, Num
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Circle, Ellipse, EllipseArc, Line, Piece, Vec, larger_side, meeting
from aidl_lang.geometry.intersect import inside
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness, SolvedGeometry, SolvedStructure

# --- Sizes of what `@clip` takes away: a drawing does not state them.

_SPOTS = 24
_CHORD = 1e-4
_NEAR = 1e-6


def is_clipped(root: SolvedStructure) -> bool:
    return any(s.inside is not None for s in root.walk())


def left_of(sizes: Sequence[Dimension], root: SolvedStructure) -> list[Dimension]:
    """Returns the sizes of which both ends are still there where structures are clipped."""
    clips = [(f"{s.path}.", _seen_in(s.inside)) for s in root.walk() if s.inside is not None]
    own = ((d, [shows for path, shows in clips if f"{d.of}.".startswith(path)]) for d in sizes)
    return [d for d, around in own if all(shows(spots) for shows in around for spots in _ends(d))]


def _seen_in(region: Region) -> Callable[[Sequence[Vec]], bool]:
    """Returns what tells whether a region has one of some places, inside or on its border."""
    size = larger_side(region.box)
    polygons = region.polygons(_CHORD * size)

    def has_one(spots: Sequence[Vec]) -> bool:
        return bool(inside(polygons, np.array(spots)).any()) or any(
            math.dist(c.point(c.nearest(p)), p) <= _NEAR * size for p in spots for c in region.pieces
        )

    return has_one


def _ends(dimension: Dimension) -> Iterator[Sequence[Vec]]:
    """Yields, for each end of a dimension, the places where it may be seen."""
    match dimension:
        case Length(start=start, end=end):
            for (x0, y0), (x1, y1) in ((start[0], start[-1]), (end[0], end[-1])):
                shares = [k / _SPOTS for k in range(_SPOTS + 1)]
                yield [(x0 + t * (x1 - x0), y0 + t * (y1 - y0)) for t in shares]
        case Roundness(curve=curve):
            yield [curve.point(k / _SPOTS) for k in range(_SPOTS + 1)]
        case Opening(corner=corner):
            yield [corner]


# --- Measures of curves: their extent, length and roundness.

X_AXIS, Y_AXIS = (1.0, 0.0), (0.0, 1.0)
_FLAT = 1e-9


def direction(degrees: float) -> Vec:
    level = 90 * round(degrees / 90)
    return ex.exact_turn(level if abs(degrees - level) < 90 * _FLAT else degrees)


def readable(u: Vec) -> Vec:
    """Returns the direction or its opposite: to the right, or upwards; that of an axis is exact."""
    if abs(u[1]) < _FLAT:
        return X_AXIS
    if abs(u[0]) < _FLAT:
        return Y_AXIS
    return u if u[0] > 0 else (-u[0], -u[1])


def dot(p: Vec, q: Vec) -> float:
    return p[0] * q[0] + p[1] * q[1]


def extreme(curves: Iterable[Piece | Vec], u: Vec) -> tuple[Vec, ...]:
    """Returns the points of curves that lie furthest in a direction."""
    spots = [spot for curve in curves for spot in _spots(curve, u)]
    furthest = max(dot(p, u) for p in spots)
    slack = 1e-9 * max(max(map(abs, p)) for p in spots)
    return tuple(dict.fromkeys(p for p in spots if dot(p, u) >= furthest - slack))


def _spots(curve: Piece | Vec, u: Vec) -> Sequence[Vec]:
    """Returns points of a curve of which one is the furthest in a direction."""
    if isinstance(curve, tuple):
        return [curve]
    own = [] if curve.is_closed else list(curve.ends)
    if isinstance(curve, Circle | Arc):
        tip = curve.center[0] + curve.radius * u[0], curve.center[1] + curve.radius * u[1]
        on_it = isinstance(curve, Circle) or curve.locate(tip, 1e-9 * curve.radius) is not None
        return [*own, tip] if on_it else own
    if isinstance(curve, Ellipse | EllipseArc) or u in (X_AXIS, Y_AXIS, (-1.0, 0.0), (0.0, -1.0)):
        own += [curve.point(t) for t in curve.extremes() if 0 <= t <= 1]
    return own


def length_along(curves: Sequence[Piece | Vec], u: Vec) -> Length:
    """Returns the extent of curves along a direction."""
    return length_between(extreme(curves, (-u[0], -u[1])), extreme(curves, u), u)


def length_between(start: Sequence[Vec], end: Sequence[Vec], u: Vec) -> Length:
    """Returns the length along a direction between points of which either side agrees in it."""
    u = readable(u)
    low, high = sorted((tuple(start), tuple(end)), key=lambda points: dot(points[0], u))
    return Length(dot(high[0], u) - dot(low[0], u), "", start=low, end=high, along=u)


def length_of_line(a: Vec, b: Vec) -> Length | None:
    u = unit(a, b)
    return length_between([a], [b], u) if u is not None else None


def unit(a: Vec, b: Vec) -> Vec | None:
    """Returns the direction from one point to another."""
    reach = math.dist(a, b)
    return ((b[0] - a[0]) / reach, (b[1] - a[1]) / reach) if reach else None


def foot(p: Vec, line: Line) -> Vec:
    """Returns the point of an endless line that is nearest to a point."""
    dx, dy = line.way
    square = dx * dx + dy * dy
    t = ((p[0] - line.start[0]) * dx + (p[1] - line.start[1]) * dy) / square if square else 0.0
    return line.start[0] + t * dx, line.start[1] + t * dy


def angle_of(a: Line, b: Line, degrees: float) -> Opening | None:
    """Returns the angle between two lines that is as large as stated, rather between arms that are drawn."""
    corner = meeting(a, b)
    if corner is None:
        return None
    best: tuple[float, Opening] | None = None
    for side_a in (1.0, -1.0):
        for side_b in (1.0, -1.0):
            (from_a, arm_a), (from_b, arm_b) = _arm(a, side_a, corner), _arm(b, side_b, corner)
            opening = (from_b - from_a) % 360
            if opening > 180:
                opening, from_a, arm_a, arm_b = 360 - opening, from_b, arm_b, arm_a
            drawn = min(arm_a[1], 0.0) + min(arm_b[1], 0.0)
            if abs(opening - degrees) < 1e-6 and (best is None or drawn > best[0]):
                made = Opening(opening, "", corner=corner, first=from_a, arms=(arm_a, arm_b))
                best = drawn, made
    return best[1] if best else None


def _arm(line: Line, side: float, corner: Vec) -> tuple[float, tuple[float, float]]:
    """Returns the direction of a line to one side, and the stretch in which it is drawn there."""
    ux, uy = side * line.way[0], side * line.way[1]
    reach = math.hypot(ux, uy)
    u = ux / reach, uy / reach
    along = sorted(dot((p[0] - corner[0], p[1] - corner[1]), u) for p in (line.start, line.end))
    return math.degrees(math.atan2(uy, ux)), (along[0], along[1])


# --- The arrangement of equal holes: the steps of a row or grid, or the circle through their centres.


def pattern_pitches(group: Sequence[Dimension], tolerance: float) -> Iterator[Dimension]:
    """Yields the dimensions that place the members of a group of equal circles, if these are in order."""
    centers = [d.curve.center for d in group if isinstance(d, Roundness) and isinstance(d.curve, Circle)]
    if len(centers) < 2:
        return
    columns, rows = (_levels([c[axis] for c in centers], tolerance) for axis in (0, 1))
    if len(columns) * len(rows) == len(centers):
        for axis, levels in enumerate((columns, rows)):
            steps = [b - a for a, b in pairwise(levels)]
            if steps and max(steps) - min(steps) <= tolerance:
                yield from _steps(centers, levels, axis, tolerance)
        return
    ring = _ring(centers, tolerance)
    if ring is not None:
        yield Roundness(2 * ring.radius, "pattern", f"centres of {group[0].of}", curve=ring)


def _levels(values: Sequence[float], tolerance: float) -> list[float]:
    found: list[float] = []
    for value in sorted(values):
        if not found or value - found[-1] > tolerance:
            found.append(value)
    return found


def _steps(centers: Sequence[Vec], levels: Sequence[float], axis: int, tolerance: float) -> Iterator[Length]:
    for a, b in pairwise(levels):
        start, end = (tuple(c for c in centers if abs(c[axis] - level) <= tolerance) for level in (a, b))
        found = length_between(start, end, (X_AXIS, Y_AXIS)[axis])
        yield replace(found, origin="pattern", group=("steps", axis, *centers[0]))


def _ring(centers: Sequence[Vec], tolerance: float) -> Circle | None:
    if len(centers) < 3:
        return None
    (ax, ay), (bx, by), (cx, cy) = centers[0], centers[len(centers) // 3], centers[2 * len(centers) // 3]
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    twice = 2 * (bx * cy - by * cx)
    if abs(twice) <= tolerance * tolerance:
        return None
    b, c = bx * bx + by * by, cx * cx + cy * cy
    x, y = ax + (cy * b - by * c) / twice, ay + (bx * c - cx * b) / twice
    radius = math.dist((x, y), (ax, ay))
    is_round = all(abs(math.dist((x, y), p) - radius) <= tolerance for p in centers)
    return Circle((x, y), radius) if is_round else None


# --- Sizes of geometry: those that are exact through a `param` or `fixed`, and those written as numbers.
#
# What a size of a compound shape measures is found by its name and value: a radius is that of one of its
# arcs, any other size the length of one of its edges or how far it reaches.

_UPRIGHT = frozenset({"height", "tall", "y"})
_TURNED = 1e-6
_SLACK = 1e-7
_PARALLEL = 1 - 1e-9


def field_sizes(
    model: Model, solved: SolvedStructure, evaluate: Evaluator, names: Mapping[Expression, str]
) -> Iterator[Dimension]:
    """Yields the sizes of all geometry that is drawn; of copies only round ones, to be counted."""
    for structure, read in zip(model.root.walk(), solved.walk(), strict=True):
        checkpoint()
        turned = evaluate(convert_angle(ex.ZERO, structure, model.root))
        known = {g.path: g for g in read.geometry}
        for geometry in structure.own():
            if not geometry.construction and geometry.path in known:
                sized = SizedGeometry(original(geometry), known[geometry.path], turned, evaluate, names)
                is_copy = geometry.source is not None
                yield from (d for d in sized.dimensions() if not is_copy or isinstance(d, Roundness))
        yield from _fillets(structure, read, names)


def original(geometry: Geometry) -> Geometry:
    """Returns the geometry that a copy, or a copy of a copy, was made from."""
    while geometry.source is not None:
        geometry = geometry.source
    return geometry


def origin_of(value: Num, holder: Geometry | None = None) -> str | None:
    """Tells whether a size is exact (`param`) or written (`size`); None if it follows from others."""
    if value.expression.is_constant:
        return "param"
    kept = all(
        u.kept and (holder is None or u.holder is holder or isinstance(u.holder, Structure))
        for u in ex.unknowns([value.expression])
    )
    return "size" if kept else None


@record()
class SizedGeometry:
    """A geometry as it was built (or the source of a copy) and as it was solved."""

    built: Geometry
    solved: SolvedGeometry
    turned: float
    evaluate: Evaluator
    names: Mapping[Expression, str]

    def dimensions(self) -> Iterator[Dimension]:
        found = False
        for name, value in self._values().items():
            if isinstance(value, Num) and (origin := origin_of(value, self.built)) is not None:
                for dimension in self.field(name, self.evaluate(value.expression), value):
                    found = True
                    yield replace(
                        dimension,
                        origin=origin,
                        of=f"{self.solved.path}.{name}",
                        name=self.names.get(value.expression),
                        group=(self.built.span, name),
                    )
        is_by_points = any(isinstance(value, ListVal) for value in self._values().values())
        if not found and self.built.is_compound and is_by_points and self._curves():
            for k in (0, 1):
                reach = length_along(self._curves(), direction(self.turned + 90 * k))
                yield replace(reach, origin="size", of=self.solved.path, group=(self.built.span, k))

    def _values(self) -> Mapping[str, object]:
        if not self.built.is_compound:
            return self.built.fields
        assert isinstance(self.built.scope, Scope)
        return {name: self.built.scope.values[name] for name in self.built.arguments}

    def _curves(self) -> list[Piece]:
        return list(self.solved.curves())

    def field(self, name: str, value: float, written: Num) -> Iterator[Dimension]:
        """Yields the dimension of a field; none if nothing that is drawn has this size."""
        if self.built.type in ("glyphs", "traced") or not math.isfinite(value):
            return
        if written.dimension == ANGLE and (opening := self._angle(name, value, written)) is not None:
            yield opening
        elif written.dimension in (None, LENGTH) and value > 0:
            yield from self.length(name, value)

    def length(self, name: str, value: float) -> Iterator[Dimension]:
        word = name.rpartition("_")[2]
        curve = self.solved.curve
        if isinstance(curve, Ellipse) and name in ("rx", "ry"):
            t = 0.0 if name == "rx" else 0.25
            across = length_of_line(curve.point(t + 0.5), curve.point(t))
            yield from [across] if across else []
        elif "radius" in name or "diameter" in name:
            radius = value / 2 if "diameter" in name else value
            rounds = [c for c in self._curves() if isinstance(c, Circle | Arc)]
            for round_curve in rounds:
                if _same(round_curve.radius, radius):
                    yield round_dimension(round_curve)
        elif (found := self._straight(name, word, value)) is not None:
            yield found

    def _straight(self, name: str, word: str, value: float) -> Length | None:
        """Returns the edge that the name speaks of, else the extent as far, else any edge as long."""
        curves = self._curves()
        lines = [
            (g.name, g.curve) for g in self.solved.walk() if isinstance(g.curve, Line) and not g.construction
        ]
        fitting = [(n, c) for n, c in lines if _same(math.dist(c.start, c.end), value)]
        for part, line in fitting:
            if part == name.rpartition("_")[0] or len(lines) == 1:
                return length_of_line(line.start, line.end)
        angle = self.solved.values.get("angle", self.turned)
        assert isinstance(angle, int | float)
        upright = word in _UPRIGHT
        ways = [direction(angle + 90 * (k + upright)) for k in (0, 1)]
        for _, line in lines[:8]:
            u = unit(line.start, line.end) or ways[0]
            ways += [w for w in (u, (-u[1], u[0])) if all(abs(dot(w, v)) < _PARALLEL for v in ways)]
        for way in ways:
            if curves and _same((reach_along := length_along(curves, way)).value, value):
                return reach_along
        return length_of_line(fitting[0][1].start, fitting[0][1].end) if fitting else None

    def _angle(self, name: str, value: float, written: Num) -> Opening | None:
        """Returns the angle of an edge to the structure's x axis; none for right angles, which are seen."""
        if name != "angle" or abs((value + 45) % 90 - 45) < _TURNED:
            return None
        line = self.solved.curve
        if isinstance(line, Line) and not written.expression.is_constant:
            return None  # that of a line written by its ends
        way = direction(value + self.turned)
        edges = [line] if isinstance(line, Line) else [c for c in self._curves() if isinstance(c, Line)]
        for edge in edges:
            u = unit(edge.start, edge.end)
            if u is not None and abs(dot(u, way)) > _PARALLEL:
                return level_angle(edge, self.turned)
        return None


def level_angle(edge: Line, turned: float) -> Opening | None:
    """Returns the angle of a line to the level through its lower end."""
    low, high = sorted((edge.start, edge.end), key=lambda p: dot(p, direction(turned + 90)))
    ux, uy = direction(turned)
    reach = math.dist(low, high)
    opening = (math.degrees(math.atan2(high[1] - low[1], high[0] - low[0])) - turned) % 360
    step, opening = (1e-9 * reach, opening) if opening <= 90 else (-1e-9 * reach, 180 - opening)
    level = Line(low, (low[0] + step * ux, low[1] + step * uy))
    return angle_of(level, Line(low, high), abs(opening))


def round_dimension(curve: Circle | Arc) -> Roundness:
    whole = isinstance(curve, Circle)
    return Roundness(2 * curve.radius if whole else curve.radius, "", curve=curve)


def _same(a: float, b: float) -> bool:
    return abs(a - b) <= _SLACK * max(abs(a), abs(b))


def _fillets(
    structure: Structure, read: SolvedStructure, names: Mapping[Expression, str]
) -> Iterator[Dimension]:
    """Yields the radii of rounded corners, at the arcs that were drawn for them."""
    arcs = [c for g in read.drawn for c in g.curves() if isinstance(c, Arc)] if read.finishes else []
    for built, done in zip(structure.finishes, read.finishes, strict=False):  # copies have more of them
        origin = origin_of(built.sizes[0]) if built.sizes else None
        if done.kind != "fillet" or origin is None:
            continue
        fitting = [a for a in arcs if _same(a.radius, done.sizes[0])]
        for corner in done.corners if fitting else ():
            arc = min(fitting, key=lambda a: math.dist(a.point(0.5), corner))
            yield replace(
                round_dimension(arc),
                origin=origin,
                of=f"{read.path}: fillet({done.text})",
                name=names.get(built.sizes[0].expression),
                group=(built.span, "fillet"),
            )
