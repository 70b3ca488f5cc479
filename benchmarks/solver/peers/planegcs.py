"""The peer planegcs: the solver of FreeCAD's Sketcher."""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.metadata import version
from typing import Any

from benchmarks.solver.contestant import Contestant, UnsupportedError
from benchmarks.solver.sketch import LINES, POINTS, Constraint, Sketch


@dataclass
class _PlaneSketch:
    """Handles of what was built, by kind and index."""

    system: Any
    sketch: Sketch
    points: list[Any] = field(default_factory=list)
    lines: list[Any] = field(default_factory=list)
    circles: list[Any] = field(default_factory=list)
    radii: list[Any] = field(default_factory=list)
    arcs: list[Any] = field(default_factory=list)

    def curve(self, curve: tuple[str, int]) -> Any:
        kind, index = curve
        return self.circles[index] if kind == "c" else self.arcs[index]

    def operand(self, constraint: Constraint, name: str) -> Any:
        value = constraint[name]
        if name in POINTS:
            return self.points[value]
        return self.lines[value] if name in LINES else self.curve(value)


_PLANE = {
    "coincident": ("coincident", "a", "b"),
    "horizontal": ("horizontal_points", "a", "b"),
    "vertical": ("vertical_points", "a", "b"),
    "parallel": ("parallel", "l", "m"),
    "perpendicular": ("perpendicular", "l", "m"),
    "equal_length": ("equal_length", "l", "m"),
    "point_on_line": ("point_on_line", "p", "l"),
    "symmetric": ("symmetric_line", "a", "b", "l"),
}
"""Type: the method and its operands."""

_PLANE_CURVES = {
    "equal_radius": {"cc": "equal_radius_cc", "aa": "equal_radius_aa", "ca": "equal_radius_ca"},
    "tangent_curves": {"cc": "tangent_circle_circle", "aa": "tangent_arc_arc", "ca": "tangent_circle_arc"},
    "tangent_line": {"c": "tangent_line_circle", "a": "tangent_line_arc"},
    "point_on_circle": {"c": "point_on_circle", "a": "point_on_arc"},
    "radius": {"c": "set_circle_radius", "a": "set_arc_radius"},
}
"""Type: the method for circles, arcs and pairs of them."""


class PlaneGCS(Contestant):
    """FreeCAD's solver with its default algorithm."""

    def __init__(self) -> None:
        self._module: Any = importlib.import_module("planegcs")
        PlaneGCS.version = version("planegcs")

    def build(self, sketch: Sketch) -> _PlaneSketch:
        system = self._module.Sketch()
        made = _PlaneSketch(system, sketch)
        made.points = [system.add_point(x, y) for x, y in sketch.points]
        made.lines = [system.add_line(made.points[a], made.points[b]) for a, b in sketch.lines]
        made.radii = [system.add_param(radius) for _, radius in sketch.circles]
        made.circles = [
            system.add_circle(made.points[centre], radius)
            for (centre, _), radius in zip(sketch.circles, made.radii, strict=True)
        ]
        made.arcs = [self._arc(made, *arc) for arc in sketch.arcs]
        for constraint in sketch.constraints:
            self._state(made, constraint)
        return made

    def _arc(self, made: _PlaneSketch, centre: int, start: int, end: int) -> Any:
        (cx, cy), *ends = (made.sketch.points[i] for i in (centre, start, end))
        first, last = (math.atan2(y - cy, x - cx) for x, y in ends)
        if last <= first:
            last += 2.0 * math.pi
        radius = math.dist((cx, cy), ends[0])
        numbers = [made.system.add_param(value) for value in (radius, first, last)]
        return made.system.add_arc(*(made.points[i] for i in (centre, start, end)), *numbers)

    def _state(self, made: _PlaneSketch, c: Constraint) -> None:
        system, kind = made.system, c["t"]
        if kind in _PLANE:
            method, *names = _PLANE[kind]
            getattr(system, method)(*(made.operand(c, name) for name in names))
        elif kind in _PLANE_CURVES:
            self._state_curves(made, c)
        elif kind in _PLANE_NUMBERS:
            _PLANE_NUMBERS[kind](made, c)
        elif kind in ("tangent_at_end", "tangent_arcs_at_ends"):
            self._state_tangency(made, c)
        else:
            raise UnsupportedError(kind)

    def _state_curves(self, made: _PlaneSketch, c: Constraint) -> None:
        curves = sorted((c[name] for name in ("k", "k2") if name in c), key=lambda k: k[0] != "c")
        method = _PLANE_CURVES[c["t"]]["".join(kind for kind, _ in curves)]
        others = [made.operand(c, name) for name in ("p", "l") if name in c]
        values = [c["v"]] if "v" in c else []
        getattr(made.system, method)(*others, *map(made.curve, curves), *values)

    def _state_tangency(self, made: _PlaneSketch, c: Constraint) -> None:
        """At a shared end by the angle between the curves there, 0 or half a turn, whichever is nearer."""
        arc = made.arcs[c["arc"]]
        other = made.lines[c["l"]] if "l" in c else made.arcs[c["arc2"]]
        at = made.points[made.sketch.arcs[c["arc"]][2 if c["end"] else 1]]
        angle = made.system.calculate_angle_via_point(arc, other, at)
        made.system.set_angle_via_point(arc, other, at, round(angle / math.pi) * math.pi)

    def solve(self, built: _PlaneSketch) -> str:
        return str(built.system.solve(self._module.Algorithm.DogLeg)).rpartition(".")[2]

    def read(self, built: _PlaneSketch) -> list[float]:
        places = [value for point in built.points for value in built.system.get_point(point)]
        return places + [built.system.get_param(radius) for radius in built.radii]


def _plane_difference(made: _PlaneSketch, c: Constraint, axis: int) -> None:
    a, b = (made.system.get_point_param_ids(made.points[c[name]])[axis] for name in ("a", "b"))
    made.system.difference(a, b, made.system.add_fixed_param(c["v"]))


def _plane_angle(made: _PlaneSketch, c: Constraint) -> None:
    is_right = c.get("mode") == "cos" and _turns_right(made.sketch, c["l"], c["m"])
    angle = math.radians(-c["v"] if is_right else c["v"])
    made.system.set_l2l_angle(made.lines[c["l"]], made.lines[c["m"]], angle)


def _plane_offset(made: _PlaneSketch, c: Constraint) -> None:
    """Its distances have no sign: the side is that of the start."""
    (ax, ay), (bx, by) = (made.sketch.points[end] for end in made.sketch.lines[c["l"]])
    px, py = made.sketch.points[c["p"]]
    side = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
    if c.get("signed") and side * c["v"] < 0.0:
        raise UnsupportedError("point_line_distance on the other side")
    made.system.set_p2l_distance(made.points[c["p"]], made.lines[c["l"]], abs(c["v"]))


def _plane_midpoint(made: _PlaneSketch, c: Constraint) -> None:
    a, b = (made.points[end] for end in made.sketch.lines[c["l"]])
    made.system.symmetric_point(a, b, made.points[c["p"]])


_PLANE_NUMBERS: dict[str, Callable[[_PlaneSketch, Constraint], object]] = {
    "fixed": lambda made, c: made.system.fix_point(made.points[c["p"]], c["x"], c["y"]),
    "fix_x": lambda made, c: made.system.coordinate_x(
        made.points[c["p"]], made.system.add_fixed_param(c["v"])
    ),
    "fix_y": lambda made, c: made.system.coordinate_y(
        made.points[c["p"]], made.system.add_fixed_param(c["v"])
    ),
    "hdist": lambda made, c: _plane_difference(made, c, 0),
    "vdist": lambda made, c: _plane_difference(made, c, 1),
    "distance": lambda made, c: made.system.set_p2p_distance(
        made.points[c["a"]], made.points[c["b"]], c["v"]
    ),
    "point_line_distance": _plane_offset,
    "angle": _plane_angle,
    "midpoint": _plane_midpoint,
    "arc_length": lambda made, c: made.system.set_arc_length(made.arcs[c["arc"]], c["v"]),
}
"""Type: how it is stated with its numbers."""


def _turns_right(sketch: Sketch, line: int, to: int) -> bool:
    (ux, uy), (vx, vy) = (
        [sketch.points[b][i] - sketch.points[a][i] for i in (0, 1)]
        for a, b in (sketch.lines[i] for i in (line, to))
    )
    return bool(ux * vy < uy * vx)
