"""Drawings of other programs as files of definitions: a shape for the whole of one, and for each name in it.

They are written in AIDL, on what the library has for the purpose, so that a drawing is called, measured,
completed and explained as any shape is. What they say is no text of the author's: like the library's it is
not looked through for mistakes, and places in it are told as those of the call.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import replace

from aidl_lang.checking.library import signature
from aidl_lang.checking.resolving.symbols import SymbolScope
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.drawings import WHOLE
from aidl_lang.common.drawings.drawing import DrawingError, OutlineFile, Trace, outlines
from aidl_lang.common.prose import rough
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast


@record(eq=False)
class ImportedDrawing:
    """A drawing that a program imports: its outlines, and the definitions that stand for them."""

    outlines: OutlineFile
    module: ast.Module
    digest: bytes

    def scope(self, library: SymbolScope) -> SymbolScope:
        """Returns the names that it defines."""
        scope = SymbolScope(self.module, library, (self.module,))
        for node in self.module.statements:
            assert isinstance(node, ast.ShapeDefinition)
            scope.callables.setdefault(node.name.text, []).append(signature(node))
        return scope

    def remarks(self, at: ast.Node) -> Iterator[Diagnostic]:
        """Yields what there is to be told of the file, at the place where it is imported."""
        for remark in self.outlines.remarks:
            yield Diagnostic(remark.code, remark.message, at.span, hints=remark.hints)


def digest(data: bytes) -> bytes:
    """Returns what tells the contents of a file from all others."""
    return hashlib.sha256(data).digest()


def nameless(statement: ast.Import, name: str) -> Diagnostic:
    """Returns the diagnostic on a drawing that is imported without a name."""
    span = statement.path.span
    edit = Edit(Span(span.source, span.end, span.end), f" as {name}")
    return Diagnostic(
        "E0361",
        f"`{statement.path.value}` is a drawing, and is imported under a name",
        statement.span,
        "nothing says how it is called here",
        hints=(f"then `{name}()` is all of it, and `{name}.part()` what is called `part` in it",),
        fix=Fix(f"call it `{name}`", (edit,), is_sure=True),
    )


def read(path: str, data: bytes) -> ImportedDrawing:
    """Returns a drawing file. Raises DrawingError."""
    found = outlines(path, data)
    from aidl_lang.parser import parse

    parsed = parse(SourceFile(path, " ".join(_definitions(found))))
    assert not parsed.diagnostics
    statements = (
        replace(s, doc=_doc(path, found, s.name.text)) if isinstance(s, ast.ShapeDefinition) else s
        for s in parsed.module.statements
    )
    return ImportedDrawing(found, replace(parsed.module, statements=tuple(statements)), digest(data))


def refused(error: DrawingError, node: ast.Node) -> Diagnostic:
    return Diagnostic(error.code, error.message, node.span, hints=error.hints)


def _doc(path: str, found: OutlineFile, name: str) -> str:
    trace = found.trace(name)
    left, bottom, right, top = trace.box
    size = f"{rough(right - left)} × {rough(top - bottom)} mm"
    return f"All outlines of {path}: {size}." if trace is found.whole else f"{name} of {path}: {size}."


_OPTIONS = "angle: turn = 0deg, filled: bool = false, rotatable: bool = false"


def _definitions(found: OutlineFile) -> Iterator[str]:
    """Yields the text of the shapes: by the origin of the file, and by the middle of the outlines, with a
    scale, a width or a height.
    """
    for name, trace in ((WHOLE, found.whole), *found.parts.items()):
        inner = _inner(found, trace)
        left, bottom, right, top = trace.box
        width, height = right - left, top - bottom
        middle = f"({(left + right) / 2!r}mm * scale, {(bottom + top) / 2!r}mm * scale)"
        from_start = f"let center = start + turned({middle}, angle)"
        from_center = f"let start = center - turned({middle}, angle)"
        sizes = f"let width = {width!r}mm * scale let height = {height!r}mm * scale"
        ways = [
            ("start: point = (0, 0), scale: number = 1", from_start, sizes),
            ("center: point, scale: number = 1", from_center, sizes),
        ]
        if width > 0.0:
            size = f"let scale = width / {width!r}mm let height = {height!r}mm * scale"
            ways.append(("center: point = (0, 0), width: length", from_center, size))
        if height > 0.0:
            size = f"let scale = height / {height!r}mm let width = {width!r}mm * scale"
            ways.append(("center: point = (0, 0), height: length", from_center, size))
        for parameters, place, size in ways:
            yield (
                f"shape {name}({parameters}, {_OPTIONS}) {{ {size} {place} "
                f'art = traced("{name}", start, scale * 1mm, angle, filled) {inner} }}'
            )


def _inner(found: OutlineFile, trace: Trace) -> str:
    """Returns the text of the names within a part: of those that have some of its elements and no others."""
    own = set(trace.elements)
    names = (
        name
        for name, part in found.parts.items()
        if part is not trace and own.issuperset(part.elements) and name != trace.name
    )
    return " ".join(f'let {name} = traced_part(art, "{name}")' for name in names)
