"""The open texts of the editor, each with its newest views, and what is said and asked of them."""

from __future__ import annotations

import asyncio
import os
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any, TypeAlias, TypeVar, get_args
from urllib.parse import quote, unquote, urlsplit

import attrs
import cattrs
from lsprotocol import types
from pygls import uris
from pygls.exceptions import JsonRpcInvalidParams

from aidl_lang.common.diagnostics import Diagnostic, Edit, Label, Severity
from aidl_lang.common.records import record
from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.solver.hierarchy import Memory
from aidl_server.ide.completion import Completion
from aidl_server.ide.dragging import Handle
from aidl_server.ide.lenses import Found
from aidl_server.ide.preview.elements import Preview
from aidl_server.ide.workspace import Positions, Unit, View


def whole(text: str) -> str:
    """Returns a text without surrogate halves of characters, which JSON can hold and no text may."""
    return re.sub("[\ud800-\udfff]", "\ufffd", text)


Look: TypeAlias = frozenset[str]
"""The layers over a picture."""


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
    viewers   those who see it, each with the layers over its picture
    handles   the draggable points found last
    pictures  those made last, each of a run
    asked     how often a viewer asked for what outdates its tries
    told      the diagnostics published of it, by file, and their serial
    hinted    the version that hints were given for, and the serial of its outcome
    tried     what came of trying its params, and the version that was tried
    listed    its last list of completions, and how many there were
    colored   its last semantic tokens
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
    viewers: dict[str, Look] = field(default_factory=dict)
    handles: tuple[Handle, ...] = ()
    pictures: dict[Look, tuple[VersionedView, Preview]] = field(default_factory=dict)
    asked: Counter[str] = field(default_factory=Counter)
    told: tuple[int, dict[str, list[types.Diagnostic]]] = (-1, {})
    hinted: tuple[int, int | None] | None = None
    tried: tuple[int, Found] | None = None
    listed: tuple[int, list[Completion]] = (0, [])
    colored: types.SemanticTokens | None = None
    _waiting: list[tuple[Callable[[], bool], asyncio.Future[None]]] = field(default_factory=list)

    async def until_seen(self, serial: int) -> None:
        """Returns when the text at a serial, or a newer one, was looked at, or when it is closed."""
        await self._until(lambda: self.seen >= serial, None)

    async def until_solved(self, serial: int, seconds: float) -> None:
        """Returns when the text at a serial, or a newer one, was run; when it is closed; or after a time."""
        await self._until(lambda: self.solved >= serial, seconds)

    async def _until(self, is_there: Callable[[], bool], seconds: float | None) -> None:
        if self.is_open and not is_there():
            ready: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            self._waiting.append((is_there, ready))
            await asyncio.wait([ready], timeout=seconds)

    def looks(self) -> dict[Look, list[str]]:
        """Returns the viewers grouped by the picture they see."""
        return {
            look: [viewer for viewer, wanted in self.viewers.items() if wanted == look]
            for look in self.viewers.values()
        }

    def tell(self) -> None:
        """Wakes those who wait for the present state."""
        for waiting in list(self._waiting):
            is_there, ready = waiting
            if is_there() or not self.is_open:
                self._waiting.remove(waiting)
                ready.set_result(None)

    def apply(self, changes: Sequence[types.TextDocumentContentChangeEvent], unit: Unit) -> None:
        """Changes the text. Ranges that do not exist mean the nearest that do."""
        for change in changes:
            text = whole(change.text)
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
        document = Document(item.uri, path_of(item.uri), item.version, whole(item.text))
        self._by_uri = {**self._by_uri, unquote(item.uri): document}
        return document

    def close(self, uri: str) -> Document | None:
        document = self.get(uri)
        if document is not None:
            self._by_uri = {key: each for key, each in self._by_uri.items() if each is not document}
            document.is_open = False
            document.viewers.clear()
            document.tell()
        return document

    def at(self, path: Path) -> list[Document]:
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


# --- Values of the server made those of the protocol, and settings read from it.

LONGEST_DELAY = 5_000


@record()
class Settings:
    """The settings of a user.

    solved_values  inlay hints for the solved values of first guesses
    readings       inlay hints for chosen readings of ambiguous constraints
    lenses         code lenses on structures
    delay          seconds after a change before the program is run
    """

    solved_values: bool = True
    readings: bool = True
    lenses: bool = True
    delay: float = 0.0

    @classmethod
    def read(cls, said: object) -> Settings:
        """Reads nested objects as `{"inlayHints": {"readings": false}}`; invalid values count as absent."""
        delay = _value(said, "run.delay")
        is_number = isinstance(delay, int | float) and not isinstance(delay, bool)
        return cls(
            solved_values=_value(said, "inlayHints.solvedValues") is not False,
            readings=_value(said, "inlayHints.readings") is not False,
            lenses=_value(said, "codeLens.enabled") is not False,
            delay=min(max(float(delay), 0.0), LONGEST_DELAY) / 1000 if is_number else 0.0,
        )


def _value(said: object, path: str) -> Any:
    for name in path.split("."):
        if not isinstance(said, Mapping):
            return None
        said = said.get(name)
    return said


START = types.Range(types.Position(0, 0), types.Position(0, 0))


@record(eq=False)
class Converter:
    """Converts for the view of the document `own`; `versions` are those of the open files at that time, None
    for a client that knows of none.
    """

    view: View
    own: str
    documents: Documents
    unit: Unit
    versions: Mapping[Path, int] | None
    _positions: dict[SourceFile, Positions] = field(default_factory=dict)

    def _of(self, source: SourceFile) -> Positions:
        if source not in self._positions:
            self._positions[source] = Positions(source.text, self.unit)
        return self._positions[source]

    def position(self, source: SourceFile, offset: int) -> types.Position:
        return types.Position(*self._of(source).position(offset))

    def range(self, span: Span) -> types.Range:
        of = self._of(span.source)
        return types.Range(types.Position(*of.position(span.start)), types.Position(*of.position(span.end)))

    def offset(self, position: types.Position) -> int:
        """Returns the offset of a position in the text of the view."""
        return self._of(self.view.source).offset(position.line, position.character)

    def span(self, wanted: types.Range) -> Span:
        """Returns the span of a range in the text of the view."""
        start, end = sorted((self.offset(wanted.start), self.offset(wanted.end)))
        return self.view.span(start, end)

    def uri(self, source: SourceFile) -> str | None:
        """Returns the URI of a source; None for one without a file."""
        path = self.view.file(source)
        return None if path is None else self.uri_of(path)

    def uri_of(self, path: Path) -> str:
        """Returns the URI of a file; of two that mean the file of the document, its own."""
        return self.own if path == self.view.path else self.documents.uri_of(path)

    def location(self, span: Span) -> types.Location | None:
        uri = self.uri(span.source)
        return None if uri is None else types.Location(uri, self.range(span))

    def edits(self, edits: Iterable[Edit]) -> list[types.TextEdit]:
        return [types.TextEdit(self.range(edit.span), edit.replacement) for edit in edits]

    def change(self, edits: Iterable[Edit]) -> types.WorkspaceEdit:
        """Returns edits of the program, without those that are in no file."""
        found: dict[Path, list[Edit]] = {}
        for edit in edits:
            if (path := self.view.file(edit.span.source)) is not None:
                found.setdefault(path, []).append(edit)
        return self.changes(found)

    def changes(self, edits: Mapping[Path, Sequence[Edit]]) -> types.WorkspaceEdit:
        """Returns edits by file; where the client knows of versions, with the version they are made for."""
        made = {path: self.edits(each) for path, each in edits.items()}
        if self.versions is None:
            return types.WorkspaceEdit(changes={self.uri_of(path): each for path, each in made.items()})
        named = types.OptionalVersionedTextDocumentIdentifier
        files = ((named(self.uri_of(p), self.versions.get(p)), each) for p, each in made.items())
        return types.WorkspaceEdit(document_changes=[types.TextDocumentEdit(*each) for each in files])


# --- Diagnostics as the client has them.

SOURCE = "aidl"
_SEVERITY = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.NOTE: types.DiagnosticSeverity.Information,
}
_UNNECESSARY = frozenset({"W0201", "W0202", "W0502", "W0701", "W0703"})
"""Codes of unnecessary text, which editors show faint."""


def converted(
    found: Iterable[Diagnostic], convert: Converter, own: str
) -> Iterator[tuple[str, types.Diagnostic]]:
    """Yields diagnostics with the URI that shows each; those of no file of the user's begin `own`."""
    for diagnostic in found:
        span, code = diagnostic.span, diagnostic.code
        if span is None or convert.view.is_library(span.source) or (uri := convert.uri(span.source)) is None:
            uri, place = own, START
        else:
            place = convert.range(span)
        yield (
            uri,
            types.Diagnostic(
                range=place,
                message="\n".join([diagnostic.message, *(f"hint: {hint}" for hint in diagnostic.hints)]),
                severity=_SEVERITY[diagnostic.severity],
                code=code,
                code_description=types.CodeDescription(resource(f"docs/diagnostics/{code}.md").as_uri()),
                source=SOURCE,
                tags=[types.DiagnosticTag.Unnecessary] if code in _UNNECESSARY else None,
                related_information=list(_related(diagnostic, convert)) or None,
            ),
        )


def _related(diagnostic: Diagnostic, convert: Converter) -> Iterator[types.DiagnosticRelatedInformation]:
    own = [Label(diagnostic.span, diagnostic.label)] if diagnostic.span and diagnostic.label else []
    for label in (*own, *diagnostic.secondary):
        if (place := convert.location(label.span)) is not None:
            yield types.DiagnosticRelatedInformation(place, label.text or diagnostic.message)


# --- Parameters of our own requests. Clients may send anything: values of other types are refused.

Value: TypeAlias = float | str | bool
Texts: TypeAlias = tuple[str, ...]
Values: TypeAlias = dict[str, Value]
Words: TypeAlias = dict[str, str]
Point: TypeAlias = tuple[float, float]
T = TypeVar("T")

_LONGEST = 8_000
"""Most characters of a name or a URI."""


@attrs.frozen(kw_only=True)
class OfDocument:
    """Parameters about an open document.

    uri     of the document
    viewer  the asking viewer of the document, as the client calls it
    """

    uri: str
    viewer: str = ""


@attrs.frozen(kw_only=True)
class Show(OfDocument):
    """The picture to show: `show` are the layers over the drawing."""

    show: Texts = ()


@attrs.frozen(kw_only=True)
class OfVersion(OfDocument):
    """`version` is that of the meant text; None: the text as it is."""

    version: int | None = None


@attrs.frozen(kw_only=True)
class DraggedPoint:
    id: str
    to: Point


@attrs.frozen(kw_only=True)
class Try(OfVersion):
    """`rests` tells that nothing newer is on the way: what is wrong is then explained."""

    knobs: Values = attrs.field(factory=dict)
    drag: DraggedPoint | None = None
    rests: bool = False


@attrs.frozen(kw_only=True)
class SetKnob(OfVersion):
    path: str
    value: Value


@attrs.frozen(kw_only=True)
class Drag(OfVersion):
    """The parameters for leaving a point where it was dragged."""

    id: str
    to: Point


@attrs.frozen(kw_only=True)
class ApplyFix(OfDocument):
    """A fix of a problem of the picture of a version, both by number."""

    version: int
    problem: int
    fix: int


@attrs.frozen(kw_only=True)
class Export(OfDocument):
    """`options` are those of a dialog, as they were typed (see `exports`)."""

    format: str
    show: Texts = ()
    options: Words = attrs.field(factory=dict)


@attrs.frozen(kw_only=True)
class EntryRequest:
    """The entry of a list of completions that is to be described."""

    uri: str
    list: int
    entry: int


@attrs.frozen(kw_only=True)
class ActionRequest:
    """The code action that is to be carried out."""

    uri: str
    version: int
    kind: str
    start: int
    end: int


def read(params: object, kind: type[T]) -> T:
    """Returns the parameters in plain data; null values count as absent. Raises JsonRpcInvalidParams."""
    if not isinstance(params, Mapping):
        raise JsonRpcInvalidParams("the parameters are no object")
    try:
        return _converter.structure({k: v for k, v in params.items() if v is not None}, kind)
    except cattrs.ClassValidationError as error:
        raise JsonRpcInvalidParams("; ".join(cattrs.transform_error(error))) from None


def _plain(value: Any, kind: Any) -> Any:
    """Returns plain data that is of a kind as it is: the library itself takes `"3"` for a number."""
    kinds, is_number = get_args(kind), type(value) in (int, float)
    if kind == Value:
        return _plain(value, float if is_number else type(value))
    if kind in (Values, Words) and isinstance(value, Mapping):
        return {_plain(name, str): _plain(each, kinds[1]) for name, each in value.items()}
    if kind in (Texts, Point) and isinstance(value, list) and (... in kinds or len(value) == len(kinds)):
        return tuple(_plain(each, kinds[0]) for each in value)
    if (
        (kind is str and isinstance(value, str) and len(value) <= _LONGEST)
        or (kind is float and is_number and abs(value) <= 1e300)
        or (kind in (bool, int) and type(value) is kind)
    ):
        return kind(value)
    raise ValueError


_converter = cattrs.Converter()
for _kind in (str, bool, int, float):
    _converter.register_structure_hook(_kind, _plain)
_converter.register_structure_hook_func((Value, Values, Words, Texts, Point).__contains__, _plain)
