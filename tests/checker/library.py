"""What the library calls by name: its tables, functions and templates, read as any program is read.

Relations, measures and geometry have a meaning of their own in this package; what stands here is data (the
sizes of screws and motors), what names mean the same, and the bodies of templates and shapes.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from tests.checker.values import Scope, Thunk, fold

FOLDER = Path(__file__).resolve().parents[2] / "stdlib"


@cache
def modules() -> tuple[ast.Module, ...]:
    files = sorted(FOLDER.glob("*.aidl"))
    return tuple(parse(SourceFile(f.name, f.read_text("utf-8"))).module for f in files)


@cache
def scope() -> Scope:
    """The outermost names, constants among them, which all programs share."""
    found = Scope(None, is_library=True)
    for statement in (s for module in modules() for s in module.statements):
        match statement:
            case ast.Let(name, value):
                found.names[name.text] = Thunk(value, found, "let", name.text)
            case ast.Alias(name, target):
                found.aliases[fold(name.text)] = target.text
            case ast.FunctionDefinition() | ast.ShapeDefinition():
                found.functions.setdefault(fold(statement.name.text), []).append((statement, found))
            case ast.Structure() if statement.parameters is not None:
                found.functions.setdefault(fold(statement.name.text), []).append((statement, found))
    return found


def public(kind: type, *files: str) -> set[str]:
    """The names with definitions of a kind whose first one is documented; of some files, or of all."""
    first: dict[str, bool] = {}
    found: set[str] = set()
    for module in modules():
        for statement in module.statements:
            if isinstance(statement, ast.FunctionDefinition | ast.ShapeDefinition | ast.ConstraintDefinition):
                name = statement.name.text
                first.setdefault(name, statement.doc is not None)
                is_asked = not files or module.source.name.removesuffix(".aidl") in files
                if isinstance(statement, kind) and first[name] and is_asked:
                    found.add(name)
    return found
