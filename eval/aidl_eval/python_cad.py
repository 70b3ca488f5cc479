"""build123d and CadQuery as languages: Python programs, run by `sandboxed`."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

from aidl_eval import sandboxed
from aidl_eval.rendering import Rendered, RenderedLanguage


@dataclass(frozen=True)
class PythonCad(RenderedLanguage):
    """A language whose programs are Python that imports one library and shows what it draws."""

    name: str
    suffix: str = ".py"
    fences: tuple[str, ...] = ("python", "py")

    def missing(self) -> str | None:
        return sandboxed.missing(self.name, sandboxed.interpreter(self.name))

    def reads(self, text: str) -> bool:
        tree = _parsed(text)
        return tree is not None and any(isinstance(node, (ast.Import, ast.ImportFrom)) for node in tree.body)

    def structures(self, program: str) -> int:
        """Counts the functions that a program defines."""
        tree = _parsed(program)
        return sum(isinstance(node, ast.FunctionDef) for node in ast.walk(tree)) if tree else 0

    def knobs(self, program: str) -> Mapping[str, float]:
        """Returns the names at the top level that are numbers as written, and are given once."""
        tree = _parsed(program)
        return {name: float(value) for name, (value, _) in _constants(tree).items()} if tree else {}

    def run(self, program: str, edits: Sequence[Mapping[str, float]] = ({},)) -> list[Rendered]:
        return sandboxed.run(self.name, [_edited(program, edit) for edit in edits])


def _parsed(program: str) -> ast.Module | None:
    try:
        return ast.parse(program)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _constants(tree: ast.Module) -> dict[str, tuple[int | float, ast.Assign | ast.AnnAssign]]:
    """Returns the numbers at the top level by their names, with the statements that give them."""
    given = list[tuple[str, ast.expr, ast.Assign | ast.AnnAssign]]()
    for node in tree.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                given.append((name, value, node))
            case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
                given.append((name, value, node))
    names = [name for name, _, _ in given]
    found = dict[str, tuple[int | float, ast.Assign | ast.AnnAssign]]()
    for name, value, node in given:
        with suppress(ValueError, TypeError, RecursionError):  # it is no literal
            number = ast.literal_eval(value)
            if type(number) in (int, float) and names.count(name) == 1:
                found[name] = number, node
    return found


def _edited(program: str, edit: Mapping[str, float]) -> str:
    """Returns the program with other values for some of its knobs; whole numbers stay whole."""
    tree = _parsed(program) if edit else None
    if tree is None:
        return program
    for name, (was, node) in _constants(tree).items():
        if name in edit:
            is_whole = isinstance(was, int) and edit[name].is_integer()
            node.value = ast.Constant(int(edit[name]) if is_whole else edit[name])
    return ast.unparse(tree)
