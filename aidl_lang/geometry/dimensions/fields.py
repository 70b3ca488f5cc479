"""Sizes of geometry: those that are exact through a `param` or `fixed`, and those written as numbers.

What a size of a compound shape measures is found by its name and value: a radius is that of one of its arcs,
any other size the length of one of its edges or how far it reaches.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Evaluator, Expression
from aidl_lang.building.model import Geometry, Model, Structure, convert_angle
from aidl_lang.building.state import Scope
from aidl_lang.building.values import ListVal, Num
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Arc, Circle, Ellipse, Line, Piece
from aidl_lang.geometry.dimensions.features import (
    angle_of,
    direction,
    dot,
    length_along,
    length_of_line,
    unit,
)
from aidl_lang.geometry.evaluate import point
from aidl_lang.geometry.solved import (
    Dimension,
    Length,
    Roundness,
    SolvedGeometry,
    SolvedModel,
    SolvedStructure,
)

_UPRIGHT = frozenset({"height", "tall", "y"})
_TURNED = 1e-6
_SLACK = 1e-7
_PARALLEL = 1 - 1e-9


def field_sizes(
    model: Model, solved: SolvedModel, evaluate: Evaluator, names: Mapping[Expression, str]
) -> Iterator[Dimension]:
    """Yields the sizes of all geometry that is drawn; of copies only round ones, to be counted."""
    for structure, read in zip(model.root.walk(), solved.root.walk(), strict=True):
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
    """Tells whether a size is exact (`param`) or written as a number (`size`), maybe as the argument of a
    template; None if it follows from others.
    """
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
        for name, value in self._numbers():
            origin = origin_of(value, self.built)
            if origin is not None:
                for dimension in self.field(name, self.evaluate(value.expression), value):
                    found = True
                    yield self._said(dimension, name, value, origin)
        if not found and self._is_listed():
            for k in (0, 1):
                reach = length_along(self._curves(), direction(self.turned + 90 * k))
                yield replace(reach, origin="size", of=self.solved.path, group=(self.built.span, k))

    def _numbers(self) -> Iterator[tuple[str, Num]]:
        if self.built.is_compound:
            assert isinstance(self.built.scope, Scope)
            values = {name: self.built.scope.values[name] for name in self.built.arguments}
        else:
            values = dict(self.built.fields)
        for name, value in values.items():
            if isinstance(value, Num):
                yield name, value

    def _is_listed(self) -> bool:
        """Tells whether the outline is given by its points."""
        if not self.built.is_compound or not self._curves():
            return False
        assert isinstance(self.built.scope, Scope)
        return any(isinstance(self.built.scope.values[name], ListVal) for name in self.built.arguments)

    def _curves(self) -> list[Piece]:
        return list(self.solved.curves())

    def _said(self, dimension: Dimension, name: str, value: Num, origin: str) -> Dimension:
        return replace(
            dimension,
            origin=origin,
            of=f"{self.solved.path}.{name}",
            name=self.names.get(value.expression),
            group=(self.built.span, name),
        )

    def field(self, name: str, value: float, written: Num) -> Iterator[Dimension]:
        """Yields the dimension of a field; none if nothing that is drawn has this size."""
        if self.built.type in ("glyphs", "traced") or not math.isfinite(value):
            return
        if written.dimension == ANGLE:
            yield from self._angle(name, value, written)
        elif written.dimension in (None, LENGTH) and value > 0:
            yield from self.length(name, value)

    def length(self, name: str, value: float) -> Iterator[Dimension]:
        word = name.rpartition("_")[2]
        curve = self.solved.curve
        if isinstance(curve, Ellipse) and name in ("rx", "ry"):
            t = 0.0 if name == "rx" else 0.25
            across = length_of_line(point(curve, t + 0.5), point(curve, t))
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
        """Returns the edge that the name speaks of, else the way the shape reaches as far, else any edge as
        long.
        """
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

    def _angle(self, name: str, value: float, written: Num) -> Iterator[Dimension]:
        """Yields the angle of an edge to the x axis of its structure; none for right angles, which can be
        seen.
        """
        if name != "angle" or abs((value + 45) % 90 - 45) < _TURNED:
            return
        line = self.solved.curve
        if isinstance(line, Line) and not written.expression.is_constant:
            return  # that of a line written by its ends
        way = direction(value + self.turned)
        edges = [line] if isinstance(line, Line) else [c for c in self._curves() if isinstance(c, Line)]
        for edge in edges:
            u = unit(edge.start, edge.end)
            if u is not None and abs(dot(u, way)) > _PARALLEL:
                yield from level_angle(edge, self.turned)
                return


def level_angle(edge: Line, turned: float) -> Iterator[Dimension]:
    """Yields the angle of a line to the level through its lower end."""
    low, high = sorted((edge.start, edge.end), key=lambda p: dot(p, direction(turned + 90)))
    ux, uy = direction(turned)
    reach = math.dist(low, high)
    opening = (math.degrees(math.atan2(high[1] - low[1], high[0] - low[0])) - turned) % 360
    step, opening = (1e-9 * reach, opening) if opening <= 90 else (-1e-9 * reach, 180 - opening)
    level = Line(low, (low[0] + step * ux, low[1] + step * uy))
    found = angle_of(level, Line(low, high), abs(opening))
    if found is not None:
        yield found


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
            arc = min(fitting, key=lambda a: math.dist(point(a, 0.5), corner))
            yield replace(
                round_dimension(arc),
                origin=origin,
                of=f"{read.path}: fillet({done.text})",
                name=names.get(built.sizes[0].expression),
                group=(built.span, "fillet"),
            )
