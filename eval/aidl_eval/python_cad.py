"""build123d and CadQuery as languages: Python programs, run by `sandboxed`."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
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
        return {name: value for name, value, _, _ in _constants(program)}

    def run(self, program: str, edits: Sequence[Mapping[str, float]] = ({},)) -> list[Rendered]:
        return sandboxed.run(self.name, [_edited(program, edit) for edit in edits])


def _parsed(program: str) -> ast.Module | None:
    try:
        return ast.parse(program)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _constants(program: str) -> Iterator[tuple[str, float, int, int]]:
    """Yields name, value, and where the value stands in the program's UTF-8 text."""
    tree = _parsed(program)
    starts = [0]
    for line in program.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    given = [_assigned(node) for node in tree.body] if tree else []
    names = [name for name, _ in filter(None, given)]
    for name, value in filter(None, given):
        sign, bare = 1, value
        if isinstance(value, ast.UnaryOp) and isinstance(value.op, ast.USub):
            sign, bare = -1, value.operand
        is_number = isinstance(bare, ast.Constant) and type(bare.value) in (int, float)
        if is_number and names.count(name) == 1:
            assert value.end_lineno is not None
            assert value.end_col_offset is not None
            start = starts[value.lineno - 1] + value.col_offset
            end = starts[value.end_lineno - 1] + value.end_col_offset
            yield name, sign * float(bare.value), start, end  # type: ignore[attr-defined]


def _assigned(node: ast.stmt) -> tuple[str, ast.expr] | None:
    match node:
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            return name, value
        case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
            return name, value
        case _:
            return None


def _edited(program: str, edit: Mapping[str, float]) -> str:
    """Returns the program with other values for some of its knobs; whole numbers stay whole."""
    text = program.encode()
    for name, _, start, end in sorted(_constants(program), key=lambda found: -found[2]) if edit else ():
        if name in edit:
            value, was = edit[name], text[start:end].decode()
            is_whole = was.lstrip("-").isdecimal() and float(value).is_integer()
            text = text[:start] + (str(int(value)) if is_whole else repr(float(value))).encode() + text[end:]
    return text.decode()
