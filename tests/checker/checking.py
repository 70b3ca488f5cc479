"""The check itself: a program's text and the JSON of its solved model → what does not hold."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from tests.checker.measures import of_shape
from tests.checker.model import Node, UnknownError, around, fold
from tests.checker.reading import Program

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
    program = Program(document).read(parse(SourceFile("checked", text)).module)
    return [*_stated(program), *_arcs(program.root), *_params(program.root), *_boxes(program.root)]


def broken(text: str, document: dict[str, Any]) -> list[Finding]:
    """What does not hold."""
    return [f for f in check(text, document) if f.residual is not None and not f.holds]


def _worst(values: list[float]) -> float:
    """The largest; what is not a number counts as infinite."""
    return max((math.inf if math.isnan(v) else v for v in values), default=0.0)


def _stated(program: Program) -> Iterator[Finding]:
    for task in program.tasks:
        view, s = program.view(task.path), task.statement
        kind = "assertion" if isinstance(s, ast.Assert) else "constraint"
        body = ast.Block((s,), span=s.span) if isinstance(s, ast.Constrain) else s
        said = [(s.test, task.scope)] if isinstance(s, ast.Assert) else view.expressions(body, task.scope)
        for e, scope in said:
            try:
                if kind == "constraint":
                    residual: float | None = _worst(view.residuals(e, scope))
                else:
                    residual = 0.0 if view.truth(e, scope) else math.inf
            except UnknownError:
                residual = None
            yield Finding(kind, task.path, e.span.text, e.span.line, residual)


def _arcs(root: Node) -> Iterator[Finding]:
    """Both ends of an arc lie on its circle."""
    for node in root.walk():
        for curve in (c for geo in node.geometry.values() for c in geo.all() if c.type == "arc"):
            away = [abs(abs(curve["center"] - curve[e]) - curve["radius"]) for e in ("start", "end")]
            yield Finding("arc", curve.path, "equal radii", 0, _worst(away))


def _params(root: Node) -> Iterator[Finding]:
    """The numbers told of a compound shape are those of its parts."""
    for node in root.walk():
        for geo in node.geometry.values():
            told = {n: v for n, v in geo.data.items() if geo.parts and n != "angle"}
            for name, value in told.items():
                derived = of_shape(geo, fold(name))
                if derived is not None:
                    yield Finding("params", geo.path, name, 0, abs(derived - value))


def _boxes(root: Node) -> Iterator[Finding]:
    """The `bb` of each structure is its box in the frame of the root."""
    for node in root.walk():
        if node.bb is not None:
            box = around(node.extremes([]))
            away = [abs(getattr(box, side) - node.bb[side]) for side in ("left", "right", "top", "bottom")]
            yield Finding("box", node.path, "bb", 0, _worst(away))
