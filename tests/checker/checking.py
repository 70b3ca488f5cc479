"""The check itself: a program's text and the JSON of its solved model → what does not hold."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from tests.checker import boxes
from tests.checker.conditions import residuals
from tests.checker.copies import away
from tests.checker.definitions import expected, frame
from tests.checker.evaluate import Evaluator
from tests.checker.fields import compound
from tests.checker.program import Program, stated, walk
from tests.checker.tree import Geo, Node, Transform, read
from tests.checker.values import Point, Scope, UnavailableError, fold

TOLERANCE = 1e-6


@dataclass(frozen=True)
class Finding:
    """One thing that was checked. `residual` is None where the document does not say enough."""

    kind: str
    path: str
    text: str
    line: int
    residual: float | None

    @property
    def holds(self) -> bool:
        return self.residual is not None and self.residual < TOLERANCE

    def __str__(self) -> str:
        return f"{self.kind} {self.path}:{self.line}: {self.text}: {self.residual}"


def check(text: str, document: dict[str, Any]) -> list[Finding]:
    """Everything that the program says of the document, each with its residual."""
    module = parse(SourceFile("checked", text)).module
    root = read(document)
    program = walk(module, root)
    changed = [c["path"] for c in document["changed"]]
    return [
        *_constraints(program),
        *_assertions(program),
        *_definitions(program, changed),
        *_copies(program, changed),
        *_arcs(root, {geo.path: task.statement.span.line for task, geo in program.definitions}),
        *_params(root),
        *_boxes(root),
    ]


def broken(text: str, document: dict[str, Any]) -> list[Finding]:
    """What does not hold."""
    return [f for f in check(text, document) if f.residual is not None and not f.holds]


def _worst(values: list[float]) -> float:
    """The largest; what is not a number counts as infinite."""
    return max((math.inf if math.isnan(v) else v for v in values), default=0.0)


def _constraints(program: Program) -> Iterator[Finding]:
    for task in program.constraints:
        for expression, scope in stated(task):
            yield _evaluated("constraint", task.node, expression, scope)


def _assertions(program: Program) -> Iterator[Finding]:
    for task in program.assertions:
        test = task.statement.test
        try:
            holds = Evaluator(task.node).truth(test, task.scope)
        except UnavailableError:  # the drawing is measured by tests of its own
            continue
        yield Finding("assertion", task.node.path, test.span.text, test.span.line, 0.0 if holds else math.inf)


def _evaluated(kind: str, node: Node, e: ast.Expression, scope: Scope) -> Finding:
    try:
        residual: float | None = _worst(residuals(Evaluator(node), e, scope))
    except UnavailableError:
        residual = None
    return Finding(kind, node.path, e.span.text, e.span.line, residual)


def _definitions(program: Program, changed: list[str]) -> Iterator[Finding]:
    for task, geo in program.definitions:
        s = task.statement
        try:
            found = expected(Evaluator(task.node), s, geo, task.scope, changed)
        except UnavailableError:
            yield Finding("definition", geo.path, s.value.span.text, s.span.line, None)
            continue
        for e in found:
            yield Finding("definition", f"{geo.path}.{e.name}", s.value.span.text, s.span.line, e.residual)
    for task, child in program.placements:
        try:
            found = list(frame(Evaluator(task.node), child, task.statement, task.scope))
        except UnavailableError:
            found = []
        for e in found:
            yield Finding("frame", f"{child.path}.{e.name}", child.name, 0, e.residual)


def _copies(program: Program, changed: list[str]) -> Iterator[Finding]:
    """Copies lie where their sources go, the members of patterns at equal steps."""
    for task, made, image in program.copies:
        s = task.statement
        residual = away(task.node.world, made, image)
        yield Finding("copy", image.path, s.value.span.text, s.span.line, residual)
    for task, pattern in program.patterns:
        s = task.statement
        residual = _worst(list(pattern.residuals(Evaluator(task.node), changed)))
        yield Finding("pattern", f"{task.node.path}.{s.name.text}", s.value.span.text, s.span.line, residual)


def _arcs(root: Node, lines: dict[str, int]) -> Iterator[Finding]:
    """Both ends of an arc lie on its circle."""
    for node in root.walk():
        for geo in node.geometry.values():
            for curve in _all(geo):
                if curve.type == "arc":
                    center, radius = curve.data["center"], curve.data["radius"]
                    away = [abs(math.dist(center, curve.data[e]) - radius) for e in ("start", "end")]
                    line = lines.get(geo.path, 0)
                    yield Finding("arc", curve.path, "equal radii", line, _worst(away))


def _params(root: Node) -> Iterator[Finding]:
    """The numbers told of a compound shape are those of its parts."""
    ev = Evaluator(root)
    for node in root.walk():
        for geo in node.geometry.values():
            for name, told in geo.data.get("params", {}).items():
                derived = compound(ev, geo, fold(name))
                if isinstance(derived, Point):
                    yield Finding("params", geo.path, name, 0, math.dist(derived.xy, told))
                elif derived is not None and name != "angle":
                    yield Finding("params", geo.path, name, 0, abs(derived.value - told))


def _all(geo: Geo) -> Iterator[Geo]:
    yield geo
    for part in geo.parts.values():
        yield from _all(part)


def _boxes(root: Node) -> Iterator[Finding]:
    """The `bb` of each structure is its box in the frame of the root."""
    for node in root.walk():
        bb = node.entry["bb"]
        if bb is None or node.is_empty:
            continue
        box = boxes.around(boxes.structure_extremes(node, Transform()))
        away = [abs(getattr(box, side) - bb[side]) for side in ("left", "right", "top", "bottom")]
        yield Finding("box", node.path, "bb", 0, _worst(away))
