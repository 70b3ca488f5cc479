"""The files that a program imports, each read and parsed once.

A path is relative to the file that imports it, ends in `.aidl`, and may not leave the project, which is the
folder of the program and all below it. Drawings of other programs, `.svg` and `.dxf`, are read as files of
definitions (see `drawings`). No other file is read, as diagnostics on a file quote it. Mistakes inside an
imported file are reported at their place there.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import field, replace
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from aidl_lang.checking.resolving.cuts import with_placed_cuts
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.drawings import is_drawing
from aidl_lang.common.files import PROGRAM
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import FileError, ReadFailure, World, relative_to
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.resolving.drawings import ImportedDrawing

SUFFIX = PROGRAM
MAX_FILES = 200
MAX_CHARACTERS = 2_000_000
"""Characters of all imported programs together."""
MAX_BYTES = 20_000_000
"""Bytes of all imported drawings together."""


@record(frozen=False)
class ImportedModules:
    """The files of a program.

    modules  every file once, those that are imported before those that import them; the program is the last
    targets  import statements → the file they bring; without those that failed
    drawings  the files among these that are drawings of other programs
    """

    modules: tuple[ast.Module, ...] = ()
    targets: dict[ast.Import, ast.Module] = field(default_factory=dict)
    drawings: dict[ast.Module, ImportedDrawing] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)


def load_imports(main: ast.Module, world: World | None) -> ImportedModules:
    """Reads the files that a program imports, directly or by way of others."""
    loader = _Loader(world)
    loader.visit(main, PurePosixPath(main.source.name.replace("\\", "/")).name)
    loader.result.modules = tuple(loader.order)
    return loader.result


class _Loader:
    def __init__(self, world: World | None) -> None:
        self.world = world
        self.result = ImportedModules()
        self.order: list[ast.Module] = []
        self.known: dict[str, ast.Module] = {}
        self.open: list[str] = []
        self.characters = self.bytes = 0

    def visit(self, module: ast.Module, path: str) -> None:
        """Loads the imports of a file, then counts the file itself."""
        self.known[path] = module
        self.open.append(path)
        for statement in module.statements:
            if isinstance(statement, ast.Import):
                self._import(statement, path)
        self.open.pop()
        self.order.append(module)

    def _import(self, statement: ast.Import, importer: str) -> None:
        written = statement.path.value
        try:
            path = relative_to(written, importer)
        except FileError:
            self._report(
                "E0212",
                f"`{written}` lies outside the project",
                statement.path,
                "a program imports only from its own folder and the folders below it",
            )
            return
        if path in self.open:
            chain = " → ".join([*self.open[self.open.index(path) :], path])
            self._report(
                "E0211",
                f"files import each other in a circle: {chain}",
                statement.path,
                "move what both need into a file of its own, which imports neither",
            )
            return
        module = self.known.get(path) or self._read(statement, path)
        if module is not None:
            self.result.targets[statement] = module

    def _read(self, statement: ast.Import, path: str) -> ast.Module | None:
        if len(self.known) > MAX_FILES or len(self.open) > MAX_FILES // 4:
            self._report("E0804", f"a program may import at most {MAX_FILES} files", statement.path)
            return None
        if is_drawing(path):
            return self._drawing(statement, path)
        text = self._text(statement, path)
        if text is None:
            return None
        self.characters += len(text)
        if self.characters > MAX_CHARACTERS:
            limit = f"{MAX_CHARACTERS:,} characters"
            self._report("E0804", f"what a program imports may have at most {limit}", statement.path)
            return None
        from aidl_lang.parser import parse

        parsed = parse(SourceFile(path, text))
        module, misplaced = with_inner_imports(with_placed_cuts(parsed.module))
        self.result.diagnostics += parsed.diagnostics + misplaced
        self.visit(module, path)
        return module

    def _drawing(self, statement: ast.Import, path: str) -> ast.Module | None:
        from aidl_lang.checking.resolving import drawings
        from aidl_lang.common.drawings.drawing import DrawingError

        if statement.alias is None and not statement.names:
            name = re.sub(r"\W+", "_", PurePosixPath(path).stem).strip("_")
            self.result.diagnostics.append(
                drawings.nameless(statement, name if name.isidentifier() else "art")
            )
            return None
        if self.world is None:
            self._unread(statement)
            return None
        try:
            data = self.world.read_bytes(path)
            self.bytes += len(data)
            if self.bytes > MAX_BYTES:
                limit = f"{MAX_BYTES // 1_000_000} MB"
                self._report(
                    "E0804", f"drawings that a program imports may have at most {limit}", statement.path
                )
                return None
            found = drawings.read(path, data)
        except FileError as error:
            hint = "paths are relative to the file that imports"
            self._report("E0210", f"`{path}` cannot be imported: {error.reason}", statement.path, hint)
            return None
        except DrawingError as error:
            self.result.diagnostics.append(drawings.refused(error, statement.path))
            return None
        self.known[path] = found.module
        self.result.drawings[found.module] = found
        self.result.diagnostics += found.remarks(statement.path)
        return found.module

    def _unread(self, statement: ast.Import) -> None:
        message = f"`{statement.path.value}` cannot be imported: only this text is at hand"
        self._report("E0210", message, statement.path)

    def _text(self, statement: ast.Import, path: str) -> str | None:
        written = statement.path.value
        if self.world is None:
            self._unread(statement)
            return None
        if PurePosixPath(path).suffix != SUFFIX:
            hints = (
                f"programs end in `{SUFFIX}`: `{written}{SUFFIX}`",
                "drawings of other programs end in `.svg` or `.dxf`"
                if PurePosixPath(path).suffix
                else "the library needs no import",
            )
            message = f"`{path}` cannot be imported: its name does not end in `{SUFFIX}`"
            self._report("E0210", message, statement.path, *hints)
            return None
        try:
            return self.world.read(path)
        except FileError as error:
            hint = "paths are relative to the file that imports"
            if error.reason is ReadFailure.NOT_A_PROGRAM:
                hint = f"`aidl check {path}` tells what is wrong in it"
            self._report("E0210", f"`{path}` cannot be imported: {error.reason}", statement.path, hint)
            return None

    def _report(self, code: str, message: str, node: ast.Node, *hints: str) -> None:
        self.result.diagnostics.append(Diagnostic(code, message, node.span, hints=hints))


def with_inner_imports(module: ast.Module) -> tuple[ast.Module, list[Diagnostic]]:
    """Returns a file with the imports of its blocks moved before its statements, and E0353 for each."""
    top = [s for s in module.statements if isinstance(s, ast.Import)]
    if module.source.text.count("import") == len(top):
        return module, []
    inner = list(_imports(s for s in module.statements if not isinstance(s, ast.Import)))
    end = top[-1].span.end if top else 0
    place = Span(module.source, end, end)
    found = [
        _misplaced(node, Edit(place, f"\n{node.span.text}" if top else f"{node.span.text}\n"))
        for node in inner
    ]
    return replace(module, statements=(*inner, *module.statements)), found


def _imports(nodes: Iterator[ast.Node]) -> Iterator[ast.Import]:
    for node in nodes:
        if isinstance(node, ast.Import):
            yield node
        elif isinstance(node, ast.Block | ast.Callable | ast.For | ast.If):
            yield from _imports(ast.children(node))


def _misplaced(node: ast.Import, insertion: Edit) -> Diagnostic:
    return Diagnostic(
        "E0353",
        "an import stands at the top of the file",
        node.span,
        "what it brings is known in the whole file",
        fix=Fix("move it to the top", (Edit(node.span.with_separator, ""), insertion), is_sure=True),
    )
