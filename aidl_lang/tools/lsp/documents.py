"""The open texts of the editor, each with its newest views."""

from __future__ import annotations

import asyncio
import os
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import field
from pathlib import Path
from urllib.parse import quote, unquote, urlsplit

from lsprotocol import types
from pygls import uris

from aidl_lang.common.records import record
from aidl_lang.solver.memory import Memory
from aidl_lang.tools.ide.positions import Positions, Unit
from aidl_lang.tools.ide.workspace import View

_HALVES = re.compile("[\ud800-\udfff]")
"""Surrogate halves of characters, which JSON can hold and no text may."""


@record(eq=False)
class _Waiting:
    is_there: Callable[[], bool]
    ready: asyncio.Future[None]


@record(eq=False)
class VersionedView:
    """A view with the version and the serial of its text."""

    view: View
    version: int
    serial: int


@record(frozen=False, eq=False)
class Document:
    """An open document.

    uri       as the client writes it
    version   as the client counts it
    serial    grows with every change of the text, and of a text that it stands on
    newest    the newest view that was made
    ran       the newest view with an outcome
    seen      the serial of the last checked text, even if checking failed
    solved    the serial of the last run text
    memory    of the solver, from run to run
    editing   held by an edit that is asked for beside the text
    """

    uri: str
    path: Path
    version: int
    text: str
    serial: int = 0
    newest: VersionedView | None = None
    ran: VersionedView | None = None
    seen: int = -1
    solved: int = -1
    was_given_up: bool = False
    is_open: bool = True
    memory: Memory = field(default_factory=Memory)
    editing: asyncio.Lock = field(default_factory=asyncio.Lock)
    _waiting: list[_Waiting] = field(default_factory=list)

    async def until_seen(self, serial: int) -> None:
        """Returns when the text at a serial, or a newer one, was looked at, or when it is closed."""
        await self._until(lambda: self.seen >= serial, None)

    async def until_solved(self, serial: int, seconds: float) -> None:
        """Returns when the text at a serial, or a newer one, was run; when it is closed; or after a time."""
        await self._until(lambda: self.solved >= serial, seconds)

    async def _until(self, is_there: Callable[[], bool], seconds: float | None) -> None:
        if self.is_open and not is_there():
            waiting = _Waiting(is_there, asyncio.get_running_loop().create_future())
            self._waiting.append(waiting)
            await asyncio.wait([waiting.ready], timeout=seconds)

    def tell(self) -> None:
        """Wakes those who wait for the present state."""
        for waiting in list(self._waiting):
            if waiting.is_there() or not self.is_open:
                self._waiting.remove(waiting)
                waiting.ready.set_result(None)

    def apply(self, changes: Sequence[types.TextDocumentContentChangeEvent], unit: Unit) -> None:
        """Changes the text. Ranges that do not exist mean the nearest that do."""
        for change in changes:
            text = _HALVES.sub("\ufffd", change.text)
            if isinstance(change, types.TextDocumentContentChangePartial):
                positions = Positions(self.text, unit)
                start = positions.offset(change.range.start.line, change.range.start.character)
                end = positions.offset(change.range.end.line, change.range.end.character)
                start, end = min(start, end), max(start, end)
                text = self.text[:start] + text + self.text[end:]
            self.text = text


class Documents:
    """The open documents, by their URIs. Two URIs may mean one file.

    Other threads may ask while the loop's thread opens and closes.
    """

    def __init__(self) -> None:
        self._by_uri: dict[str, Document] = {}

    def __iter__(self) -> Iterator[Document]:
        return iter(self._by_uri.values())

    def get(self, uri: str) -> Document | None:
        return self._by_uri.get(unquote(uri))

    def open(self, item: types.TextDocumentItem) -> Document:
        text = _HALVES.sub("\ufffd", item.text)
        document = Document(item.uri, path_of(item.uri), item.version, text)
        self._by_uri = {**self._by_uri, unquote(item.uri): document}
        return document

    def close(self, uri: str) -> Document | None:
        document = self.get(uri)
        if document is not None:
            self._by_uri = {key: each for key, each in self._by_uri.items() if each is not document}
            document.is_open = False
            document.tell()
        return document

    def at(self, path: Path) -> list[Document]:
        """Returns the documents of a file."""
        return [document for document in self._by_uri.values() if document.path == path]

    def uri_of(self, path: Path) -> str:
        """Returns the URI of a file, as the client writes it for an open one."""
        return next((document.uri for document in self.at(path)), "") or path.as_uri()


def path_of(uri: str) -> Path:
    """Returns the file of a URI, links resolved. A URI outside any disk gets a path without a file."""
    try:
        file = uris.to_fs_path(uri)
        parts = urlsplit(uri)
    except ValueError:  # no URI at all
        return _nowhere("unknown", quote(uri, safe=""))
    if file is not None and os.path.isabs(file) and "\0" not in file:
        return Path(os.path.realpath(file))
    return _nowhere(parts.scheme, unquote(f"{parts.netloc}/{parts.path}"))


def _nowhere(scheme: str, name: str) -> Path:
    name = re.sub(r"[\0-\x1f]", "_", name)
    return Path(os.path.normpath(f"{os.path.abspath(os.sep)}{scheme}:/{name}"))
