"""Views of all the programs of a workspace, each remade only when one of its texts has changed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field
from pathlib import Path

from aidl_lang.checking.resolving.drawings import ImportedDrawing, digest
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.common.world import FileError
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.view import View, look
from aidl_lang.tools.ide.workspace import Workspace


@record(frozen=False)
class Project:
    workspace: Workspace
    _views: dict[Path, View] = field(default_factory=dict)

    def view(self, path: Path) -> View | None:
        """Returns the program in a file; None if it cannot be read."""
        try:
            text = self.workspace.text(path)
        except FileError:
            self._views.pop(path, None)
            return None
        known = self._views.get(path)
        if known is None or known.source.text != text or not self._is_fresh(known):
            known = self._views[path] = look(path, text, self.workspace.world(path))
        return known

    def views_with(self, name: str) -> Iterator[View]:
        """Yields the programs in whose text a name occurs, however it is spelled."""
        wanted = fold(name)
        for path in self.workspace.programs():
            try:
                text = self.workspace.text(path)
            except FileError:
                continue  # gone since, or no program; compiling reports that
            if wanted in fold(text) and (view := self.view(path)) is not None:
                yield view

    def _is_fresh(self, view: View) -> bool:
        """True if all that a program imports could be read, and is unchanged."""
        resolution = view.resolution
        imports = (s for m in resolution.modules for s in m.statements if isinstance(s, ast.Import))
        return (
            all(statement in resolution.imports for statement in imports)
            and all(self._says(view, module) for module in resolution.modules if module is not view.module)
            and all(self._holds(view, drawing) for drawing in resolution.drawings.values())
        )

    def _holds(self, view: View, drawing: ImportedDrawing) -> bool:
        try:
            return digest(view.world.read_bytes(drawing.module.source.name)) == drawing.digest
        except FileError:
            return False

    def _says(self, view: View, module: ast.Module) -> bool:
        file = view.file(module.source)
        try:
            return file is not None and self.workspace.text(file) == module.source.text
        except FileError:
            return False
