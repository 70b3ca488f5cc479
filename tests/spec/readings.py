"""Values of a solved model by an expression such as `plate.hole[2].rim.center.x`.

Read off the numbers of the solved model and its curves, not by the evaluator of the language, so that the two
check each other. Everything is in the frame of the root; angles are in degrees.
"""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeAlias

from aidl_lang.geometry.curves import Arc, Line, Vec
from aidl_lang.geometry.solved import Box, SolvedGeometry, SolvedStructure
from aidl_lang.pipeline import Compiled


@dataclass(frozen=True)
class Members:
    """What shares a name before its index: `hole` of `hole[0]`, `hole[1]`."""

    name: str
    of: SolvedStructure | SolvedGeometry


Value: TypeAlias = float | str | Vec | Box | Members | SolvedStructure | SolvedGeometry

_ARITHMETIC: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_COMPARISON: dict[type[ast.cmpop], Callable[[float], bool]] = {
    ast.LtE: lambda d: d <= 0,
    ast.GtE: lambda d: d >= 0,
    ast.Lt: lambda d: d < 0,
    ast.Gt: lambda d: d > 0,
}
TOLERANCE = 1e-6


class Missing(Exception):
    """The model has no such value."""


class Reader:
    """Evaluates the expressions of `expect` blocks on one compiled program."""

    def __init__(self, compiled: Compiled) -> None:
        self.compiled = compiled

    def holds(self, text: str) -> tuple[bool, str]:
        """Whether a comparison holds, and the value on its left as it would be written."""
        node = ast.parse(text, mode="eval").body
        if not isinstance(node, ast.Compare) or len(node.ops) != 1:
            raise Missing(f"`{text}` is not a comparison")
        left, right = self.value(node.left), self.value(node.comparators[0])
        relation = type(node.ops[0])
        if relation is ast.Eq:
            return same(left, right), shown(left)
        if relation is ast.NotEq:
            return not same(left, right), shown(left)
        a, b = _number(left), _number(right)
        return _COMPARISON[relation](0.0 if same(a, b) else a - b), shown(left)

    def value(self, node: ast.expr) -> Value:
        match node:
            case ast.Constant(value=value) if isinstance(value, float | int | str):
                return value
            case ast.Name(id=name):
                return self._named(name)
            case ast.Attribute(value=of, attr=name):
                return member(self.value(of), name)
            case ast.Subscript(value=of, slice=index):
                return _indexed(self.value(of), self.value(index))
            case ast.Tuple(elts=[x, y]):
                return _number(self.value(x)), _number(self.value(y))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -_number(self.value(operand))
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _ARITHMETIC:
                return _ARITHMETIC[type(op)](_number(self.value(left)), _number(self.value(right)))
            case ast.Call(func=ast.Name(id=name), args=args):
                return self._call(name, [self.value(a) for a in args])
            case _:
                raise Missing(f"`{ast.unparse(node)}` is nothing that can be read")

    @property
    def root(self) -> SolvedStructure:
        if self.compiled.model is None:
            raise Missing("the program was not solved")
        return self.compiled.model.root

    def _count(self, structure: SolvedStructure) -> int | None:
        return self.compiled.model.mobility().of(structure)[0] if self.compiled.model is not None else None

    def _named(self, name: str) -> Value:
        return self.root if name == self.root.name else member(self.root, name)

    def _call(self, name: str, values: list[Value]) -> float:
        match name, values:
            case "dof", [SolvedStructure() as structure] if (count := self._count(structure)) is not None:
                return count
            case (("area" | "perimeter"), [SolvedStructure() as structure]) if self.compiled.drawing:
                return float(getattr(self.compiled.drawing.measures[structure.path], name))
            case "distance", [a, b]:
                return math.dist(point(a), point(b))
            case "abs", [a]:
                return abs(_number(a))
            case "sqrt", [a]:
                return math.sqrt(_number(a))
            case _:
                raise Missing(f"there is no `{name}` of that")


def member(value: Value, name: str) -> Value:
    """`value.name`"""
    found: Value | None
    match value:
        case SolvedStructure():
            found = _of_structure(value, name)
        case SolvedGeometry():
            found = _of_geometry(value, name)
        case Box():
            found = _of_box(value, name)
        case (float(x), float(y)):
            found = {"x": x, "y": y}.get(name)
        case _:
            found = None
    if found is None:
        raise Missing(f"there is no `{name}` in {_called(value)}")
    return found


def _of_structure(s: SolvedStructure, name: str) -> Value | None:
    if (part := _part(s, name)) is not None:
        return part
    if name in s.params:
        value = s.params[name]
        return value if isinstance(value, str) else float(value)
    if name == "rotation":
        return s.frame.rotation
    return _boxed(s.box, name)


def _of_geometry(g: SolvedGeometry, name: str) -> Value | None:
    if (part := _part(g, name)) is not None:
        return part
    found = g.values.get(name)
    if isinstance(found, tuple) and len(found) == 2:
        return point(found)  # type: ignore[arg-type]
    if isinstance(found, str):
        return found
    if isinstance(found, float | int):
        return float(found)
    if name in ("x", "y") and g.type == "point":
        return point(g)["xy".index(name)]
    derived = _derived(g, name)
    return derived if derived is not None else _boxed(box_of([g]), name)


def _derived(g: SolvedGeometry, name: str) -> Value | None:
    match g.curve:
        case Line(start=(x0, y0), end=(x1, y1)):
            fields: dict[str, Value] = {
                "length": math.hypot(x1 - x0, y1 - y0),
                "angle": math.degrees(math.atan2(y1 - y0, x1 - x0)),
                "midpoint": ((x0 + x1) / 2, (y0 + y1) / 2),
                "dx": x1 - x0,
                "dy": y1 - y0,
            }
            return fields.get(name)
        case Arc(radius=radius, sweep=sweep):
            return {
                "length": radius * abs(sweep),
                "sweep": math.degrees(abs(sweep)),
                "diameter": 2 * radius,
            }.get(name)
        case _ if name == "diameter" and "radius" in g.values:
            return 2 * _number(member(g, "radius"))
        case _:
            return None


def box_of(geometry: Iterable[SolvedGeometry]) -> Box | None:
    """The tight box of the drawn curves."""
    found = [curve.box for g in geometry for curve in g.curves()]
    if not found:
        return None
    left, bottom, right, top = zip(*found, strict=True)
    return Box(min(left), min(bottom), max(right), max(top))


def _boxed(box: Box | None, name: str) -> Value | None:
    if box is None:
        return None
    return box if name == "bb" else _of_box(box, name)


def _of_box(box: Box, name: str) -> Value | None:
    x, y = (box.left + box.right) / 2, (box.bottom + box.top) / 2
    across: dict[str, Value] = {"left": box.left, "right": box.right, "width": box.width, "center_x": x}
    fields: dict[str, Value] = {
        **across,
        "bottom": box.bottom,
        "top": box.top,
        "height": box.height,
        "center_y": y,
        "center": (x, y),
        "top_left": (box.left, box.top),
        "top_right": (box.right, box.top),
        "bottom_left": (box.left, box.bottom),
        "bottom_right": (box.right, box.bottom),
    }
    return fields.get(name)


def _indexed(value: Value, index: Value) -> Value:
    if not isinstance(value, Members):
        raise Missing(f"{_called(value)} has no members by number")
    name = f"{value.name}[{index}]"
    part = _part(value.of, name)
    if part is None:
        raise Missing(f"there is no `{name}`")
    return part


def _part(of: SolvedStructure | SolvedGeometry, name: str) -> Value | None:
    """A part by its name, or the members that share it before their index."""
    parts = _parts(of)
    found = next((part for part in parts if part.name == name), None)
    if found is None and any(part.name.startswith(f"{name}[") for part in parts):
        return Members(name, of)
    return found


def _parts(of: SolvedStructure | SolvedGeometry) -> tuple[SolvedStructure | SolvedGeometry, ...]:
    return (*of.structures, *of.geometry) if isinstance(of, SolvedStructure) else of.parts


def point(value: Value) -> Vec:
    match value:
        case (x, y):
            return float(x), float(y)
        case SolvedGeometry(type="point", values={"at": (x, y)}):
            return float(x), float(y)  # type: ignore[arg-type]
        case _:
            raise Missing(f"{_called(value)} is not a point")


def _number(value: Value) -> float:
    if isinstance(value, float | int):
        return float(value)
    raise Missing(f"{_called(value)} is not a number")


def same(a: Value, b: Value) -> bool:
    """Equal to 1e-6, relative to what is compared and never less than that in mm."""
    if isinstance(a, str) or isinstance(b, str):
        return a == b
    if isinstance(a, float | int) and isinstance(b, float | int):
        return abs(a - b) <= TOLERANCE * max(1.0, abs(a), abs(b))
    return all(same(x, y) for x, y in zip(point(a), point(b), strict=True))


def shown(value: Value) -> str:
    """As a spec writes it."""
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, float | int):
        return f"{round(value, 6) + 0.0:.10g}"
    x, y = point(value)
    return f"({shown(x)}, {shown(y)})"


def _called(value: Value) -> str:
    return f"`{value.path}`" if isinstance(value, SolvedStructure | SolvedGeometry) else str(value)
