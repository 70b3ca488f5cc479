"""The peer SolveSpace, through two packages."""

from __future__ import annotations

import importlib
from abc import abstractmethod
from dataclasses import dataclass, field
from importlib.metadata import version
from typing import Any

from benchmarks.solver.contestant import Contestant, UnsupportedError
from benchmarks.solver.sketch import LINES, POINTS, Constraint, Sketch

_SPACE = {
    "coincident": ("POINTS_COINCIDENT", "a", "b"),
    "horizontal": ("HORIZONTAL", "a", "b"),
    "vertical": ("VERTICAL", "a", "b"),
    "distance": ("PT_PT_DISTANCE", "a", "b"),
    "parallel": ("PARALLEL", "l", "m"),
    "perpendicular": ("PERPENDICULAR", "l", "m"),
    "equal_length": ("EQUAL_LENGTH_LINES", "l", "m"),
    "length_ratio": ("LENGTH_RATIO", "l", "m"),
    "length_diff": ("LENGTH_DIFFERENCE", "l", "m"),
    "angle": ("ANGLE", "l", "m"),
    "point_on_line": ("PT_ON_LINE", "p", "l"),
    "midpoint": ("AT_MIDPOINT", "p", "l"),
    "symmetric": ("SYMMETRIC_LINE", "a", "b", "l"),
    "symmetric_h": ("SYMMETRIC_HORIZ", "a", "b"),
    "symmetric_v": ("SYMMETRIC_VERT", "a", "b"),
    "radius": ("DIAMETER", "k"),
    "equal_radius": ("EQUAL_RADIUS", "k", "k2"),
    "point_on_circle": ("PT_ON_CIRCLE", "p", "k"),
    "tangent_at_end": ("ARC_LINE_TANGENT", "arc", "l"),
    "tangent_arcs_at_ends": ("CURVE_CURVE_TANGENT", "arc", "arc2"),
    "equal_line_arc_len": ("EQUAL_LINE_ARC_LEN", "l", "arc"),
    "equal_angle": ("EQUAL_ANGLE", "l", "m", "l2", "m2"),
    "eq_pt_line_dist": ("EQ_PT_LN_DISTANCES", "p", "p2", "l", "l2"),
    "eq_len_pt_line_dist": ("EQ_LEN_PT_LINE_D", "p", "l", "m"),
}
"""Type: the name of the constraint and its operands; points and curves have slots of their own."""


@dataclass
class _SpaceSketch:
    """Handles of what was built. `axes` are the origin, the x axis and the y axis.

    `upright` and `level` are lines that are vertical or horizontal, by each of their ends.
    """

    system: Any
    sketch: Sketch
    workplane: Any
    axes: tuple[Any, Any, Any]
    points: list[Any]
    lines: list[Any] = field(default_factory=list)
    radii: list[Any] = field(default_factory=list)
    circles: list[Any] = field(default_factory=list)
    arcs: list[Any] = field(default_factory=list)
    upright: dict[int, int] = field(default_factory=dict)
    level: dict[int, int] = field(default_factory=dict)

    def operand(self, constraint: Constraint, name: str) -> Any:
        value = constraint[name]
        if name in POINTS:
            return self.points[value]
        if name in LINES:
            return self.lines[value]
        if name.startswith("arc"):
            return self.arcs[value]
        kind, index = value
        return self.circles[index] if kind == "c" else self.arcs[index]


class _SolveSpace(Contestant):
    """What the two bindings have in common."""

    _kinds: Any

    @abstractmethod
    def _begin(self, sketch: Sketch) -> _SpaceSketch:
        """The plane and the points."""

    @abstractmethod
    def _add_geometry(self, made: _SpaceSketch) -> None:
        """Lines, radii, circles and arcs."""

    @abstractmethod
    def _add(
        self,
        made: _SpaceSketch,
        kind: Any,
        v: float,
        points: list[Any],
        entities: list[Any],
        flags: list[int],
    ) -> None:
        """One constraint: up to two points, four entities, two flags."""

    def build(self, sketch: Sketch) -> _SpaceSketch:
        made = self._begin(sketch)
        self._add_geometry(made)
        made.upright = _lines_with_ends(sketch, "vertical")
        made.level = _lines_with_ends(sketch, "horizontal")
        for constraint in sketch.constraints:
            self._state(made, constraint)
        return made

    def _state(self, made: _SpaceSketch, c: Constraint) -> None:
        kind = c["t"]
        if kind in _SPACE:
            name, *operands = _SPACE[kind]
            points = [made.operand(c, operand) for operand in operands if operand in POINTS]
            entities = [made.operand(c, operand) for operand in operands if operand not in POINTS]
            flags = [int(bool(c.get(flag))) for flag in ("end", "end2", "flip") if flag in c]
            v = 2.0 * c["v"] if kind == "radius" else abs(c.get("v", 0.0))
            self._add(made, getattr(self._kinds, name), v, points, entities, flags)
        elif kind == "fixed" and [c["x"], c["y"]] == made.sketch.points[c["p"]]:
            self._add(made, self._kinds.WHERE_DRAGGED, 0.0, [made.points[c["p"]]], [], [])
        elif kind in ("fixed", "fix_x", "fix_y"):
            for axis, name in enumerate(("x", "y")):
                if kind in ("fixed", "fix_" + name):
                    self._project(
                        made, made.axes[0], made.points[c["p"]], axis, c[name if kind == "fixed" else "v"]
                    )
        elif kind in ("hdist", "vdist"):
            self._state_difference(made, c)
        elif kind == "point_line_distance":
            # Positive to the right of the line, for SolveSpace.
            is_left = c.get("signed") or _is_left(made.sketch, c["p"], c["l"])
            v = -c["v"] if is_left else c["v"]
            self._add(made, self._kinds.PT_LINE_DISTANCE, v, [made.points[c["p"]]], [made.lines[c["l"]]], [])
        else:
            raise UnsupportedError(kind)

    def _project(self, made: _SpaceSketch, a: Any, b: Any, axis: int, v: float) -> None:
        """`b` lies further than `a` along an axis by this much."""
        self._add(made, self._kinds.PROJ_PT_DISTANCE, v, [b, a], [made.axes[1 + axis]], [])

    def _state_difference(self, made: _SpaceSketch, c: Constraint) -> None:
        """As the distance from an upright or level line through one of the points, if there is one: projected
        distances are expressions in space, and many times slower.
        """
        axis = 0 if c["t"] == "hdist" else 1
        crossing = made.upright if axis == 0 else made.level
        for base, other, v in ((c["a"], c["b"], c["v"]), (c["b"], c["a"], -c["v"])):
            if base in crossing:
                line = crossing[base]
                start, end = (made.sketch.points[i] for i in made.sketch.lines[line])
                is_forward = end[1 - axis] > start[1 - axis]  # then x grows to its right, y to its left
                v = v if is_forward == (axis == 0) else -v
                self._add(made, self._kinds.PT_LINE_DISTANCE, v, [made.points[other]], [made.lines[line]], [])
                return
        self._project(made, made.points[c["a"]], made.points[c["b"]], axis, c["v"])


def _lines_with_ends(sketch: Sketch, kind: str) -> dict[int, int]:
    """Lines whose ends are constrained to be level or upright, by each end."""
    pairs = {frozenset((c["a"], c["b"])) for c in sketch.constraints if c["t"] == kind}
    found: dict[int, int] = {}
    for line, ends in enumerate(sketch.lines):
        if frozenset(ends) in pairs:
            for end in ends:
                found.setdefault(end, line)
    return found


class PythonSolveSpace(_SolveSpace):
    """SolveSpace through the package python-solvespace."""

    def __init__(self) -> None:
        self._module: Any = importlib.import_module("python_solvespace")
        self._kinds = self._module.Constraint
        PythonSolveSpace.version = version("python-solvespace")

    def _begin(self, sketch: Sketch) -> _SpaceSketch:
        system = self._module.SolverSystem()
        system.set_group(1)
        plane = system.create_2d_base()
        origin, right, up = (system.add_point_2d(x, y, plane) for x, y in ((0, 0), (1, 0), (0, 1)))
        axes = (origin, system.add_line_2d(origin, right, plane), system.add_line_2d(origin, up, plane))
        self._normal = system.add_normal_3d(*self._module.make_quaternion(1, 0, 0, 0, 1, 0))
        system.set_group(2)
        points = [system.add_point_2d(x, y, plane) for x, y in sketch.points]
        return _SpaceSketch(system, sketch, plane, axes, points)

    def _add_geometry(self, made: _SpaceSketch) -> None:
        system, plane, points = made.system, made.workplane, made.points
        made.lines = [system.add_line_2d(points[a], points[b], plane) for a, b in made.sketch.lines]
        made.radii = [system.add_distance(radius, plane) for _, radius in made.sketch.circles]
        made.circles = [
            system.add_circle(self._normal, points[centre], radius, plane)
            for (centre, _), radius in zip(made.sketch.circles, made.radii, strict=True)
        ]
        made.arcs = [
            system.add_arc(self._normal, *(points[i] for i in arc), plane) for arc in made.sketch.arcs
        ]

    def _add(
        self,
        made: _SpaceSketch,
        kind: Any,
        v: float,
        points: list[Any],
        entities: list[Any],
        flags: list[int],
    ) -> None:
        none = self._module.Entity.NONE
        padded = [*points, none, none][:2] + [*entities, none, none, none, none][:4]
        made.system.add_constraint(int(kind), made.workplane, v, *padded, *[*flags, 0, 0][:2])

    def solve(self, built: _SpaceSketch) -> str:
        return str(built.system.solve().name)

    def read(self, built: _SpaceSketch) -> list[float]:
        system = built.system
        return [v for entity in (*built.points, *built.radii) for v in system.params(entity.params)]


class Slvs(_SolveSpace):
    """SolveSpace through its own package slvs, whose sketch is global."""

    def __init__(self) -> None:
        self._module: Any = importlib.import_module("slvs")
        self._kinds = self._module.ConstraintType
        Slvs.version = version("slvs").removeprefix("v")

    def _begin(self, sketch: Sketch) -> _SpaceSketch:
        module = self._module
        module.clear_sketch()
        plane = module.add_base_2d(1)
        origin, right, up = (module.add_point_2d(1, x, y, plane) for x, y in ((0, 0), (1, 0), (0, 1)))
        axes = (origin, module.add_line_2d(1, origin, right, plane), module.add_line_2d(1, origin, up, plane))
        self._normal = module.add_normal_3d(1, *module.make_quaternion(1, 0, 0, 0, 1, 0))
        points = [module.add_point_2d(2, x, y, plane) for x, y in sketch.points]
        return _SpaceSketch(module, sketch, plane, axes, points)

    def _add_geometry(self, made: _SpaceSketch) -> None:
        module, plane, points = self._module, made.workplane, made.points
        made.lines = [module.add_line_2d(2, points[a], points[b], plane) for a, b in made.sketch.lines]
        made.radii = [module.add_distance(2, radius, plane) for _, radius in made.sketch.circles]
        made.circles = [
            module.add_circle(2, self._normal, points[centre], radius, plane)
            for (centre, _), radius in zip(made.sketch.circles, made.radii, strict=True)
        ]
        made.arcs = [
            module.add_arc(2, self._normal, *(points[i] for i in arc), plane) for arc in made.sketch.arcs
        ]

    def _add(
        self,
        made: _SpaceSketch,
        kind: Any,
        v: float,
        points: list[Any],
        entities: list[Any],
        flags: list[int],
    ) -> None:
        none = self._module.E_NONE
        padded = [*points, none, none][:2] + [*entities, none, none, none, none][:4]
        self._module.add_constraint(2, kind, made.workplane, v, *padded, *[*flags, 0, 0][:2])

    def solve(self, built: _SpaceSketch) -> str:
        result = self._module.solve_sketch(2, False)["result"]
        return str(self._module.ResultFlag(result).name)

    def read(self, built: _SpaceSketch) -> list[float]:
        value = self._module.get_param_value
        places = [value(point["param"][i]) for point in built.points for i in (0, 1)]
        return places + [value(radius["param"][0]) for radius in built.radii]


def _is_left(sketch: Sketch, point: int, line: int) -> bool:
    """Whether a point is first guessed to the left of a line."""
    (ax, ay), (bx, by) = (sketch.points[end] for end in sketch.lines[line])
    px, py = sketch.points[point]
    return (bx - ax) * (py - ay) > (by - ay) * (px - ax)
