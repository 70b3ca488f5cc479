"""Lengths and angles that constraints state: `distance(a, b) == 18`, `plate.width == 80`,
`hole.left == plate.left + 5`, `above(a, b, gap: 2)`.

A statement is read by its words; its two ends are then found on what is drawn. What does not measure as
stated (a constraint that does not hold) gives no dimension.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from aidl_lang.building.boxes import Box, spelled_out
from aidl_lang.building.curves import NOWHERE
from aidl_lang.building.expression import ONE, ZERO, Evaluator, Expression, Place, constant
from aidl_lang.building.impose import axis_of, measured, options
from aidl_lang.building.model import Constraint, Geometry, Model, Structure, convert, convert_angle
from aidl_lang.building.values import NOTHING, Array, ListVal, Num, PointVal, TextVal, Value, members
from aidl_lang.building.wording import Wording
from aidl_lang.common.materials import limits as fit_limits
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import NO_LENGTH, Arc, Circle, Line, Piece, Vec, meeting, turn_between
from aidl_lang.geometry.dimensions import features
from aidl_lang.geometry.solved import Dimension, Length, Roundness, SolvedGeometry, SolvedStructure
from aidl_lang.syntax import ast

_AXIS = {"left": 0, "right": 0, "center_x": 0, "x": 0, "bottom": 1, "top": 1, "center_y": 1, "y": 1}
_FACING = {
    "above": ("bottom", "top"),
    "below": ("top", "bottom"),
    "left_of": ("right", "left"),
    "right_of": ("left", "right"),
}
_MEASURES = frozenset(
    {"distance", "horizontal_distance", "vertical_distance", "angle", "length", "radius", "diameter"}
)
_SIZES = frozenset({"length", "radius", "diameter", "width", "height", "angle"})
_SLACK = 1e-6


def stated_lengths(model: Model, scene: Scene) -> Iterator[Dimension]:
    """Yields the dimensions that the constraints of the author measure, in order of writing."""
    for constraint in model.constraints:
        checkpoint()
        if constraint.weight is None and constraint.wording is not None:
            yield from _Statement(scene, constraint, constraint.wording).dimensions()


def by_hand(model: Model, scene: Scene) -> Iterator[Dimension]:
    """Yields the dimensions that the program asks for, in order of writing."""
    for asked in model.by_hand:
        checkpoint()
        assert asked.wording is not None
        yield from _Statement(scene, asked, asked.wording).asked_for()


class Scene:
    """The solved structures and geometry by path."""

    def __init__(
        self, model: Model, solved: SolvedStructure, evaluate: Evaluator, names: Mapping[Expression, str]
    ) -> None:
        self.root, self.evaluate, self.names = model.root, evaluate, names
        self.structures: dict[str, SolvedStructure] = {s.path: s for s in solved.walk()}
        self.geometry: dict[str, SolvedGeometry] = {
            g.path: g for s in self.structures.values() for own in s.geometry for g in own.walk()
        }

    def curves(self, value: object) -> list[Piece | Vec]:
        """Returns the curves and points inside the box of a value, in coordinates of the root."""
        match value:
            case Geometry(type="point") if value.path in self.geometry:
                return [at for at in [self.geometry[value.path].values["at"]] if isinstance(at, tuple)]  # type: ignore[misc]
            case Geometry() if value.path in self.geometry:
                return list(self.geometry[value.path].curves())
            case Structure() if value.path in self.structures:
                return list(_outlines(self.structures[value.path]))
            case Box():
                return [c for source in value.sources for c in self.curves(source)]
            case ListVal() | Array():
                return [c for item in members(value) or () for c in self.curves(item)]
            case _:
                return []


def _outlines(structure: SolvedStructure) -> Iterator[Piece]:
    """Yields the curves inside the box of a structure, without those of its holes."""
    for geometry in structure.geometry:
        yield from geometry.curves()
    for child in structure.structures:
        if child.kind != "hole":
            yield from _outlines(child)


@record()
class _Statement:
    scene: Scene
    constraint: Constraint
    wording: Wording

    def dimensions(self) -> Iterator[Dimension]:
        for k, (found, value) in enumerate(self._read()):
            if _agrees(found, abs(value.value)):
                yield replace(
                    found,
                    origin="constraint",
                    of=self.constraint.text,
                    name=self.scene.names.get(value.expression),
                    group=(self.constraint.span, k),
                )

    def asked_for(self) -> Iterator[Dimension]:
        """Yields the dimension of `dimension(a, b, …)`."""
        node = self.wording.node
        assert isinstance(node, ast.Call)
        things = measured(node)
        said = {name: self.wording.value(value) for name, value in options(node).items()}
        offset, tolerance, fit = (said.get(name) for name in ("offset", "tolerance", "fit"))
        found = self._alone(things[0]) if len(things) == 1 else self._from_to(*things[:2])
        if found is None or not found.value > NO_LENGTH:
            return
        limits, named = None, ""
        if isinstance(tolerance, Num) and tolerance.value > 0:
            limits = (-tolerance.value, tolerance.value)
        if isinstance(fit, TextVal) and fit.value:
            limits, named = fit_limits(fit.value, found.value), fit.value
        yield replace(
            found,
            origin="hand",
            of=self.constraint.text,
            group=(self.constraint.span, self.constraint.label),
            offset=offset.value if isinstance(offset, Num) and offset.value else None,
            limits=limits,
            fit=named,
        )

    def _alone(self, node: ast.Expression) -> Dimension | None:
        curve = self._curve(node)
        if isinstance(curve, Circle | Arc):
            return features.round_dimension(curve)
        return features.length_of_line(curve.start, curve.end) if isinstance(curve, Line) else None

    def _from_to(self, a: ast.Expression, b: ast.Expression) -> Dimension | None:
        """Returns the distance of two things: along the axis of a coordinate or of an edge that is level or
        upright, at a right angle to a slanted edge; the angle of two edges that are not parallel.
        """
        lines = [line for node in (a, b) if (line := self._line(node)) is not None]
        if len(lines) == 2 and meeting(*lines) is not None:
            turn = turn_between(lines[0].way, lines[1].way)
            return features.angle_of(lines[0], lines[1], abs(math.degrees(turn)))
        axis = next((k for node in (a, b) if (k := self._axis(node)) is not None), None)
        if axis is None:
            return self._distance("distance", a, b)
        ends = [self._at_axis(node, axis) for node in (a, b)]
        return features.length_between(ends[0], ends[1], self._way(axis)) if all(ends) else None

    def _axis(self, node: ast.Expression) -> int | None:
        """Returns the axis along which something has a coordinate of its own: 0 for an upright edge."""
        if (line := self._line(node)) is not None:
            across = [abs(features.dot(line.way, self._way(k))) for k in (0, 1)]
            flat = _SLACK * math.dist(line.start, line.end)
            return next((k for k in (0, 1) if across[k] <= flat), None)
        value = self.wording.value(node)
        return axis_of(node, value) if value is not None else None

    def _at_axis(self, node: ast.Expression, axis: int) -> tuple[Vec, ...]:
        """Returns points whose coordinate along an axis is that of something."""
        if self._axis(node) == axis and (found := self._coordinate(node)) is not None:
            return found[1]
        if isinstance(node, ast.Member) and axis_of(node, self.wording.value(node) or NOTHING) == axis:
            p = self._point(node.value)
        else:
            p = self._point(node)
        return (p,) if p is not None else ()

    def _read(self) -> Iterator[tuple[Dimension, Num]]:
        match self.wording.node:
            case ast.Comparison(operands=(left, right), operators=("==",)):
                for node, other in ((left, right), (right, left)):
                    value = self._constant(other)
                    if isinstance(value, Num) and (found := self._measured(node, value)) is not None:
                        yield found, value
                        return
                yield from self._offset(left, right)
            case ast.Call() as call:
                yield from self._call(call)

    # --- Measures ----------------------------------------------------------------------------------

    def _measured(self, node: ast.Expression, value: Num) -> Dimension | None:
        """Returns the dimension that `node == value` measures."""
        match node:
            case ast.Call() if all(a.name is None for a in node.arguments):
                return self._by_call(self._callee(node), self._positional(node), abs(value.value))
            case ast.Member(value=of, name=word) if word.text in _SIZES:
                return self._size(of, word.text, abs(value.value))
        return None

    def _call(self, call: ast.Call) -> Iterator[tuple[Dimension, Num]]:
        """Yields a relation, or a measure that is called with its value."""
        name, given = self._callee(call), self._positional(call)
        named = {a.name.text: a.value for a in call.arguments if a.name is not None}
        if name in _FACING and len(given) == 2 and "gap" in named:
            gap = self._constant(named["gap"])
            sides = [self._side(n, side) for n, side in zip(given, _FACING[name], strict=True)]
            if isinstance(gap, Num) and all(sides):
                yield features.length_between(sides[0], sides[1], self._way(_AXIS[_FACING[name][0]])), gap
        elif name in _MEASURES and given:
            said = named.get("value") or given[-1]
            value = self._constant(said)
            if isinstance(value, Num) and set(named) <= {"value", "ccw"}:
                rest = given if "value" in named else given[:-1]
                if (found := self._by_call(name, rest, abs(value.value))) is not None:
                    yield found, value

    def _by_call(self, name: str, given: Sequence[ast.Expression], value: float) -> Dimension | None:
        if name == "angle":
            return self._angle(given, value)
        if name in ("length", "radius", "diameter") and len(given) == 1:
            return self._size(given[0], name, value)
        return self._distance(name, *given) if name in _MEASURES and len(given) == 2 else None

    def _distance(self, name: str, a: ast.Expression, b: ast.Expression) -> Length | None:
        if name != "distance":
            p, q = self._point(a), self._point(b)
            along = self._way(int(name.startswith("vertical")))
            return features.length_between([p], [q], along) if p and q else None
        line_a, line_b = self._line(a), self._line(b)
        line = line_a or line_b
        if line is None:
            p, q = self._point(a), self._point(b)
        else:
            p = self._point(b if line_a else a) if not (line_a and line_b) else (line_b or line).point(0.5)
            q = features.foot(p, line) if p is not None else None
        return features.length_of_line(p, q) if p is not None and q is not None else None

    def _angle(self, given: Sequence[ast.Expression], value: float) -> Dimension | None:
        lines = [self._line(n) for n in given]
        if len(given) == 3:
            a, corner, b = (self._point(n) for n in given)
            lines = [Line(corner, a), Line(corner, b)] if a and corner and b else []
        if len(lines) == 2 and lines[0] and lines[1]:
            return features.angle_of(lines[0], lines[1], min(value % 360, -value % 360))
        return features.level_angle(lines[0], self._turned()) if len(lines) == 1 and lines[0] else None

    def _size(self, node: ast.Expression, name: str, value: float) -> Dimension | None:
        thing = self.wording.value(node)
        solved = self.scene.geometry.get(thing.path) if isinstance(thing, Geometry) else None
        curve = self._curve(node)
        if isinstance(curve, Circle | Arc) and name in ("radius", "diameter"):
            return features.round_dimension(curve)
        if isinstance(curve, Line) and name == "length":
            return features.length_of_line(curve.start, curve.end)
        if isinstance(curve, Line) and name == "angle":
            return features.level_angle(curve, self._turned())
        if solved is not None and isinstance(thing, Geometry) and thing.is_compound and name != "angle":
            known = self._turned(), self.scene.evaluate, self.scene.names
            return next(features.SizedGeometry(thing, solved, *known).length(name, value), None)
        if name in ("width", "height") and (curves := self.scene.curves(thing)):
            return features.length_along(curves, self._way(int(name == "height")))
        return None

    # --- Offsets -----------------------------------------------------------------------------------

    def _offset(self, left: ast.Expression, right: ast.Expression) -> Iterator[tuple[Dimension, Num]]:
        """Yields the lengths in `a.left == b.right + 5` or `a.center == b.center + (3, 4)`."""
        terms = [*self._terms(left, 1), *self._terms(right, -1)]
        places = [(sign, node) for sign, node, value in terms if value is None]
        if len(places) != 2 or places[0][0] == places[1][0]:
            return
        offsets = [(-sign, value) for sign, _, value in terms if value is not None]
        if len(offsets) != 1:
            # If there are several numbers, none is stated: only their sum is measured.
            offsets = [(1, total)] if (total := _total(offsets)) is not None else []
        for _, offset in offsets:
            yield from self._between(places[0][1], places[1][1], offset)

    def _between(
        self, a: ast.Expression, b: ast.Expression, offset: Num | PointVal
    ) -> Iterator[tuple[Dimension, Num]]:
        if isinstance(offset, PointVal):
            p, q = self._point(a), self._point(b)
            if p and q:
                for axis, number in enumerate((offset.x, offset.y)):
                    yield features.length_between([p], [q], self._way(axis)), number
            return
        one, other = self._coordinate(a), self._coordinate(b)
        if one is not None and other is not None and one[0] == other[0]:
            yield features.length_between(one[1], other[1], self._way(one[0])), offset

    def _terms(
        self, node: ast.Expression, sign: int
    ) -> Iterator[tuple[int, ast.Expression, Num | PointVal | None]]:
        """Yields the signed terms of a sum, with their values where these are constant."""
        match node:
            case ast.Binary(operator="+" | "-" as operator, left=left, right=right):
                yield from self._terms(left, sign)
                yield from self._terms(right, sign if operator == "+" else -sign)
            case _:
                yield sign, node, None if self._is_place(node) else self._constant(node)

    def _is_place(self, node: ast.Expression) -> bool:
        """Tells whether a term is a point or coordinate of something, which may well be fixed."""
        if not isinstance(node, ast.Member):
            return False
        is_of_thing = isinstance(self.wording.value(node.value), Geometry | Structure | Box)
        return (is_of_thing and node.name.text not in _SIZES) or self._is_place(node.value)

    def _coordinate(self, node: ast.Expression) -> tuple[int, tuple[Vec, ...]] | None:
        """Returns a place along an axis of the holder: the axis, and points at that place."""
        match node:
            case ast.Member(value=of, name=word) if word.text in _AXIS:
                points = self._side(of, word.text)
                return (_AXIS[word.text], points) if points else None
        line = self._line(node)
        if line is None:
            return None
        is_upright = abs(features.dot(line.way, self._way(0)))
        return int(is_upright > 1e-6 * math.dist(line.start, line.end)), (line.start, line.end)

    def _side(self, node: ast.Expression, side: str) -> tuple[Vec, ...]:
        """Returns the points of a thing on one side of its box, or its middle."""
        curves = self.scene.curves(self.wording.value(node))
        u, v = self._way(_AXIS[side])
        if side in ("x", "y", "center_x", "center_y"):
            p = self._point(node)
            if p is None:
                return ()
            # Rather the tip of a thing than its middle, where there is nothing to be seen.
            tips = [*features.extreme(curves, (-v, u)), *features.extreme(curves, (v, -u))] if curves else []
            ways = ((q, features.dot((q[0] - p[0], q[1] - p[1]), (u, v))) for q in tips)
            return (*(q for q, away in ways if abs(away) < 1e-9 * math.hypot(*p)), p)
        return features.extreme(curves, (u, v) if side in ("right", "top") else (-u, -v)) if curves else ()

    # --- Values ------------------------------------------------------------------------------------

    def _constant(self, node: ast.Expression) -> Num | PointVal | None:
        """Returns the value of an expression that does not depend on the solver; None for others."""
        value = self.wording.value(node)
        match value:
            case Num(expression=e) if e.is_constant:
                return value
            case PointVal(x, y) if x.expression.is_constant and y.expression.is_constant:
                return value
            case _:
                return None

    def _point(self, node: ast.Expression) -> Vec | None:
        """Returns a point, or the middle of a thing, in coordinates of the root."""
        value: Value | None = self.wording.value(node)
        if isinstance(value, Geometry) and value.type == "point":
            value = value.fields["at"]
        elif isinstance(value, Geometry | Structure | Box):
            if isinstance(value, Geometry) and value.type == "line":
                return None
            center = ast.Identifier("center", span=node.span)
            value = self.wording.value(ast.Member(node, center, span=node.span))
        return self._at(value) if isinstance(value, PointVal) else None

    def _at(self, p: PointVal) -> Vec:
        here = self.constraint.holder
        x, y = spelled_out(*convert(p.place, here, self.scene.root))
        return self.scene.evaluate(x), self.scene.evaluate(y)

    def _curve(self, node: ast.Expression) -> Piece | None:
        value = self.wording.value(node)
        solved = self.scene.geometry.get(value.path) if isinstance(value, Geometry) else None
        return solved.curve if solved is not None else None

    def _line(self, node: ast.Expression) -> Line | None:
        return curve if isinstance(curve := self._curve(node), Line) else None

    def _turned(self) -> float:
        return self.scene.evaluate(convert_angle(ZERO, self.constraint.holder, self.scene.root))

    def _way(self, axis: int) -> Vec:
        """Returns the direction of an axis of the holder in coordinates of the root."""
        here, root = self.constraint.holder, self.scene.root
        unit = Place(ONE, ZERO) if axis == 0 else Place(ZERO, ONE)
        (x0, y0), (x1, y1) = (map(self.scene.evaluate, convert(p, here, root)) for p in (NOWHERE, unit))
        return x1 - x0, y1 - y0

    def _callee(self, call: ast.Call) -> str:
        return self.wording.it.program.resolution.canonical.get(call.callee, call.callee.text)

    def _positional(self, call: ast.Call) -> list[ast.Expression]:
        receiver = [call.receiver] if call.receiver is not None else []
        return [*receiver, *(a.value for a in call.arguments if a.name is None)]


def _agrees(found: Dimension, value: float) -> bool:
    """Tells whether a dimension has the stated value; a round one by its radius or its diameter."""
    sizes = [found.value]
    if isinstance(found, Roundness):
        sizes = [found.curve.radius, 2 * found.curve.radius]
    return any(abs(size - value) <= _SLACK * max(1.0, value) for size in sizes)


def _total(offsets: Sequence[tuple[int, Num | PointVal]]) -> Num | PointVal | None:
    numbers = [(sign, v) for sign, v in offsets if isinstance(v, Num)]
    if len(numbers) == len(offsets) and numbers:
        total = sum(sign * v.value for sign, v in numbers)
        return Num(constant(total), numbers[0][1].dimension)
    points = [(sign, v) for sign, v in offsets if isinstance(v, PointVal)]
    if len(points) == len(offsets) and points:
        x, y = (_total([(sign, getattr(v, axis)) for sign, v in points]) for axis in "xy")
        return PointVal(x, y) if isinstance(x, Num) and isinstance(y, Num) else None
    return None
