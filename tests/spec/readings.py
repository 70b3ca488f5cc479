"""Values of a solved model by an expression such as `plate.hole[2].rim.center.x`.

They are read off the exported document by the checker, not by the evaluator of the language, so that the two
check each other. Everything is in the frame of the root; angles are in degrees.
"""

from __future__ import annotations

import json
import re
from typing import Any

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.pipeline import Compiled
from aidl_lang.syntax import ast
from tests.checker.measures import point
from tests.checker.model import Node, UnknownError, angle
from tests.checker.reading import Scope, View
from tests.checker.relations import plain

TOLERANCE = 1e-6


class Missing(Exception):
    """The model has no such value."""


class Reader(View):
    """Evaluates the expressions of `expect` blocks on one compiled program."""

    def __init__(self, compiled: Compiled) -> None:
        if compiled.model is None:
            raise Missing("the program was not solved")
        self.compiled, path = compiled, compiled.model.root.path
        super().__init__(json.loads(compiled.export(".json")), path, {})
        self.scope = Scope(path=path)

    def holds(self, text: str) -> tuple[bool, str]:
        """Whether a comparison holds, and the value on its left as it would be written."""
        match _parsed(text):
            case ast.Comparison((left, right), (operator,)):
                a, b = self.read(left), self.read(right)
            case _:
                raise Missing(f"`{text}` is not a comparison")
        if operator in ("==", "!=") or same(a, b):
            return same(a, b) == ("=" in operator.lstrip("!")), shown(a)
        return (a < b) == operator.startswith("<"), shown(a)

    def shown(self, text: str) -> str:
        """The value of an expression as a spec writes it."""
        return shown(self.read(_parsed(text)))

    def read(self, e: ast.Expression) -> Any:
        try:
            return plain(self.value(e, self.scope))
        except (UnknownError, LookupError, TypeError) as reason:
            raise Missing(str(reason)) from reason

    def member(self, value: Any, name: str) -> Any:
        if name == "rotation" and isinstance(value, Node):
            around = value.parent or value  # what is mirrored has its x turned over
            return float(angle((value.axes[1] - value.origin) / (around.axes[1] - around.origin)))
        return super().member(value, name)

    def call(self, e: ast.Call, scope: Scope) -> Any:
        """Beside the functions of the checker, what is measured on the drawing, and degrees of freedom."""
        name, compiled = e.callee.text, self.compiled
        if name not in ("dof", "area", "perimeter"):
            return super().call(e, scope)
        assert compiled.model is not None
        assert compiled.drawing is not None
        path = self.arguments(e, scope)[0][0].path
        return float(
            compiled.model.mobility().own[path][0]
            if name == "dof"
            else getattr(compiled.drawing.measures[path], name)
        )


def _parsed(text: str) -> ast.Expression:
    """The claim as the language reads it; `at`, which a spec may ask of a point, is a word there."""
    parsed = parse(SourceFile("claim", "let _ = " + re.sub(r"\.at\b", "", text)))
    if parsed.diagnostics:
        raise Missing(parsed.diagnostics[0].message)
    (let,) = parsed.module.statements
    assert isinstance(let, ast.Let)
    return let.value


def same(a: Any, b: Any) -> bool:
    """Equal to 1e-6, relative to what is compared and never less than that in mm."""
    if isinstance(a, str) or isinstance(b, str):
        return bool(a == b)
    return abs(a - b) <= TOLERANCE * max(1.0, abs(a), abs(b))


def shown(value: Any) -> str:
    """As a spec writes it."""
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, float | int):
        return f"{round(value, 6) + 0.0:.10g}"
    x, y = point(value).real, point(value).imag
    return f"({shown(x)}, {shown(y)})"
