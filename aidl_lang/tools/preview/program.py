"""The program that is previewed: read from its file, run, tried with other values, and edited in its file.

Everything here takes its time and runs in one thread. A run may raise `cancelling.Cancelled`.
"""

from __future__ import annotations

import base64
import json
from codecs import BOM_UTF8
from collections import defaultdict
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MAX_BYTES
from aidl_lang.export import OFFERED, ExportError, Options
from aidl_lang.geometry.curves import Vec
from aidl_lang.solver.memory import Memory
from aidl_lang.tools.ide.dragging import Dragged, Handle, drag
from aidl_lang.tools.ide.edits import applied
from aidl_lang.tools.ide.preview import Preview, Writer, preview, set_knob, tried, with_handles
from aidl_lang.tools.ide.preview.protocol import Json
from aidl_lang.tools.ide.refusing import CannotError, Refusal
from aidl_lang.tools.ide.semantic_tokens import semantic_tokens
from aidl_lang.tools.ide.view import View, look, run
from aidl_lang.tools.ide.workspace import Workspace

Write = Callable[[Path, bytes], None]
"""Replaces a file in one step. Raises OSError."""


class Program:
    """`version` counts the texts that the file has had."""

    def __init__(self, path: Path, write: Write) -> None:
        self.path, self._write = path, write
        self.version = 0
        self.view: View | None = None
        self._workspace = Workspace()
        self._memory, self._trying = Memory(), Memory()
        self._texts: Mapping[str, str] = {}
        """of the files that the view is made of, by name"""
        self._handles: tuple[Handle, ...] = ()
        self._source: tuple[View, Json] | None = None

    # --- The text

    def refresh(self) -> bool:
        """Run what the files say now; False if that is what was run last. Raises CannotError."""
        text = _text(_read(self.path))
        self._workspace.open[self.path] = text
        view = look(self.path, text, self._workspace.world(self.path))
        texts = {module.source.name: module.source.text for module in view.program.resolution.modules}
        if self.view is not None and texts == self._texts:
            return False
        view = run(view, self.view, self._memory)
        self.view, self._texts = view, texts
        self.version += 1
        return True

    @property
    def current(self) -> View:
        """The view of the text. Raises CannotError."""
        if self.view is None:
            raise CannotError(f"{self.path.name} was not read yet")
        return self.view

    # --- Showing

    def picture(self, view: View, show: Collection[str], *, is_tried: bool = False) -> Preview:
        """A preview with the handles that were known last."""
        return preview(view, show, tried=is_tried, known=self._handles)

    def completed(self, made: Preview) -> Preview:
        """The preview of the text with all of its handles, which take a while."""
        found = with_handles(made, self.current)
        self._handles = found.handles
        return found

    def message(self, view: View, made: Preview) -> str:
        """The message that says a preview."""
        writer = Writer(view)
        data = writer.preview(made, self.version, self._source_of(view, writer))
        return json.dumps({"type": "picture", **data})

    def _source_of(self, view: View, writer: Writer) -> Json:
        """The text beside the picture, which is the same for all that is tried with it."""
        text_view = self.view if self.view is not None and self.view.source is view.source else view
        if self._source is None or self._source[0] is not text_view:
            positions = writer.positions(view.source)
            tokens = [
                (*positions.position(c.span.start), positions.length(c.span.start, c.span.end), c.type)
                for c in semantic_tokens(view)
            ]
            self._source = text_view, {"text": view.source.text, "tokens": tokens}
        return self._source[1]

    def with_knob(self, path: str, value: float | str | bool) -> View:
        """The program as it would be with another value of a param."""
        return tried(self.current, {path: value}, self._trying)

    def dragged(self, handle: str, to: Vec) -> View:
        """The program as it would be with a handle dragged somewhere. Raises CannotError."""
        return self._drag(handle, to).view

    def _drag(self, handle: str, to: Vec) -> Dragged:
        found = drag(self.current, handle, to)
        if isinstance(found, Refusal):
            raise CannotError(found.reason)
        return found

    # --- Editing

    def set_knob(self, path: str, value: float | str | bool) -> None:
        """Write a value of a param into the text. Raises CannotError and RefusalError."""
        self.edit(set_knob(self.current, path, value))

    def drop(self, handle: str, to: Vec) -> None:
        """Write into the text what puts a handle somewhere. Raises CannotError."""
        edits = self._drag(handle, to).edits
        if isinstance(edits, Refusal):
            raise CannotError(edits.reason)
        self.edit(edits)

    def edit(self, edits: Sequence[Edit]) -> None:
        """Carry out edits of the view in its files, whole or not at all each. Raises CannotError."""
        view = self.current
        of_file: dict[SourceFile, list[Edit]] = defaultdict(list)
        for edit in edits:
            of_file[edit.span.source].append(edit)
        changes = []
        for source, own in of_file.items():
            file = None if view.is_library(source) else view.file(source)
            if file is None:
                raise CannotError(f"{source.name} cannot be changed from here")
            changes.append((file, _rewritten(file, source, own)))
        for file, data in changes:
            try:
                self._write(file, data)
            except OSError as reason:
                raise CannotError(f"{file.name} was not written: {_why(reason)}") from None

    def export(self, name: str, show: Collection[str]) -> Json:
        """The message with the file of a format. Raises CannotError."""
        outcome = self.current.outcome
        if name not in OFFERED:
            raise CannotError(f"there is no format {name}")
        if outcome is None or outcome.drawing is None:
            raise CannotError("the program does not draw, so there is nothing to export")
        options = Options(frozenset(show) - {"dimensions"}, dimension="dimensions" in show)
        try:
            made = outcome.exported(f".{name}", options)
        except ExportError as reason:
            hints = reason.diagnostic.hints
            raise CannotError("; ".join([reason.diagnostic.message, *hints[:1]])) from None
        data = base64.b64encode(made.data).decode()
        return {"type": "export", "name": f"{self.path.stem}.{name}", "data": data}


def _read(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except OSError as reason:
        raise CannotError(f"{path.name} cannot be read: {_why(reason)}") from None
    if len(data) > MAX_BYTES:
        raise CannotError(f"{path.name} is too large for a program")
    return data


def _text(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as reason:
        line = data.count(b"\n", 0, reason.start) + 1
        raise CannotError(f"line {line} is not UTF-8 text; the picture is of what was there before") from None


def _rewritten(file: Path, known: SourceFile, edits: Sequence[Edit]) -> bytes:
    """The content of a file after edits of the text that is known of it."""
    data = _read(file)
    text = _text(data)
    mark = BOM_UTF8 if data.startswith(BOM_UTF8) else b""
    known_text = known.text.removeprefix("\ufeff")
    skipped = len(known.text) - len(known_text)
    # What is imported is read with its line ends made one.
    is_converted = text != known_text and text.replace("\r\n", "\n") == known_text
    if text != known_text and not is_converted:
        raise CannotError(f"{file.name} has changed meanwhile; nothing was written")
    after = applied(known.text, edits)[skipped:]
    return mark + (after.replace("\n", "\r\n") if is_converted else after).encode()


def _why(reason: OSError) -> str:
    text = reason.strerror or str(reason)
    return text[:1].lower() + text[1:]
