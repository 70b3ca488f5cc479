"""Links to imported files."""

from __future__ import annotations

from pathlib import Path

from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.view import View


@record()
class Link:
    """The place of a file's name, without its quotes, and the file."""

    span: Span
    path: Path


def links(view: View) -> list[Link]:
    """Returns the links in order of writing; none for a file that cannot be read."""
    found = []
    for statement in view.module.statements:
        target = view.resolution.imports.get(statement) if isinstance(statement, ast.Import) else None
        if isinstance(statement, ast.Import) and target is not None:
            path, span = view.file(target.source), statement.path.span
            if path is not None:
                found.append(Link(view.span(span.start + 1, span.end - 1), path))
    return found
