"""The picture beside the text, for clients that show it: requests of our own, all below `aidl/`."""

from __future__ import annotations

import asyncio
import base64
import io
import zipfile
from collections.abc import Awaitable, Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, TypeAlias, TypeVar

from pygls.exceptions import (
    JsonRpcException,
    JsonRpcInvalidParams,
    JsonRpcRequestCancelled,
)

from aidl_lang.checking import units
from aidl_lang.common.diagnostics import AidlError, Diagnostic, Edit
from aidl_lang.common.records import record
from aidl_lang.common.running import Cancelled
from aidl_lang.export import FORMATS, OFFERED
from aidl_lang.export.job import Exported, ExportError, Options, file_names
from aidl_lang.export.marks import THEMES
from aidl_lang.export.profiles import PROFILES
from aidl_server.ide.dragging import drag, handles
from aidl_server.ide.preview import layered, preview, tried
from aidl_server.ide.preview.elements import Preview, Writer, set_knob, worked_out
from aidl_server.ide.references import CannotError
from aidl_server.ide.workspace import View
from aidl_server.lsp import documents
from aidl_server.lsp.running import FAILED
from aidl_server.lsp.server import Asked, Server

# --- What a dialog for exports offers: the formats, and one table of options, each with what it does.
#
# An option of the command becomes one of the dialog by a line of `OPTIONS`.


@record()
class Option:
    """An option of the dialog, under its name among those of an export.

    label    what stands before its field
    hint     an example, shown in the empty field
    read     returns the value for what was given, which is not empty. Raises ValueError
    choices  what may be given; empty for what is typed
    of       what formats that have it do, a field of theirs
    """

    name: str
    label: str
    hint: str
    read: Callable[[str], object]
    choices: tuple[str, ...] = ()
    of: str = "cuts"


_NESTING = 5.0
"""Seconds for packing parts by their outlines."""
_PACKED = {"boxes": None, "outlines": _NESTING}

OPTIONS = (
    Option("sheet", "Sheet", "600x400, a3", units.size),
    Option("spacing", "Spacing", "3mm", units.length),
    Option("nest", "Packed by", "boxes", _PACKED.__getitem__, tuple(_PACKED)),
    Option("kerf", "Kerf", "0.15mm", units.length),
    Option("profile", "Profile", "plain", PROFILES.__getitem__, tuple(PROFILES)),
    Option("theme", "Theme", "colour", str, THEMES, "tiles"),
    Option("tile", "Pages", "a4", units.size, of="tiles"),
)


def offered() -> dict[str, Any]:
    """Returns the formats, and the options with the formats that have each, as JSON."""
    return {
        "formats": [{"name": name, "label": label} for name, label in OFFERED.items()],
        "options": [
            {
                "name": option.name,
                "label": option.label,
                "hint": option.hint,
                "choices": option.choices,
                "formats": [name for name in OFFERED if getattr(FORMATS[f".{name}"], option.of)],
            }
            for option in OPTIONS
        ],
    }


def changed(options: Options, given: Mapping[str, str]) -> Options:
    """Returns options with what was given in the dialog. Raises ValueError."""
    known = {option.name: option for option in OPTIONS}
    read = {}
    for name, text in given.items():
        if name not in known:
            raise ValueError(f"there is no option `{name}`")
        option, text = known[name], text.strip()
        if text and option.choices and text not in option.choices:
            raise ValueError(f"{option.label.lower()} is one of {', '.join(option.choices)}, not `{text}`")
        if text:
            read[name] = option.read(text)
    return replace(options, **read)  # type: ignore[arg-type]  # each is of the kind that its name has


def packed(stem: str, suffix: str, made: Exported) -> tuple[str, bytes]:
    """Returns the name and the content of what is saved: the file, or an archive of several."""
    if not made.further:
        return stem + suffix, made.data
    archive = io.BytesIO()
    contents = (made.data, *made.further)
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as writing:
        for name, data in zip(file_names(stem + suffix, len(contents)), contents, strict=True):
            writing.writestr(zipfile.ZipInfo(name), data)
    return f"{stem}-{suffix[1:]}.zip", archive.getvalue()


# --- Pictures of the shown documents: made after each run, and sent; and what is asked for beside them.

_PAUSE = 0.25
"""Seconds without a change before handles are searched, which takes as long as a run."""
_LONGEST_WAIT = 30.0
"""Most seconds to wait for an outcome: longer than a run may take."""

Json: TypeAlias = dict[str, Any]
T = TypeVar("T")


def register_preview(server: Server) -> None:
    pictures = _Pictures(server)
    _answer(server, "aidl/preview", documents.Show, pictures.show)
    _answer(server, "aidl/previewClose", documents.OfDocument, pictures.close)
    _answer(server, "aidl/try", documents.Try, pictures.attempt)
    _answer(server, "aidl/setKnob", documents.SetKnob, pictures.set_knob)
    _answer(server, "aidl/drag", documents.Drag, pictures.drag)
    _answer(server, "aidl/fix", documents.ApplyFix, pictures.fix)
    _answer(server, "aidl/export", documents.Export, pictures.export)
    _answer(server, "aidl/exports", documents.OfDocument, pictures.exports)


def _answer(server: Server, method: str, kind: type[T], answer: Callable[[T], Awaitable[Any]]) -> None:
    async def handler(params: Any) -> Any:  # pygls takes no parameter that is typed as `object`
        return await answer(documents.read(params, kind))

    server.feature(method)(handler)


class _Pictures:
    """Viewers of documents are told after each run; handles take longer to find, and follow."""

    def __init__(self, server: Server) -> None:
        self.server = server
        server.on_solved.append(self._solved)

    async def show(self, given: documents.Show) -> Json | None:
        """Shows a document from now on."""
        document = self.server.document(given.uri)
        document.asked[given.viewer] += 1
        document.viewers[given.viewer] = frozenset(given.show)
        self.server.runner.active = document
        await document.until_solved(document.serial, _LONGEST_WAIT)
        return await self._picture(document, given.viewer, object())

    async def close(self, given: documents.OfDocument) -> None:
        """Stops telling a viewer of a document."""
        document = self.server.documents.get(given.uri)
        if document is not None:
            document.asked[given.viewer] += 1
            document.viewers.pop(given.viewer, None)
            if not document.viewers:
                document.pictures = {}

    def _solved(self, document: documents.Document, known: documents.VersionedView) -> None:
        outcome = known.view.outcome
        assert outcome is not None
        severities = [diagnostic.severity.value for diagnostic in outcome.diagnostics]
        status = {
            "uri": document.uri,
            "version": known.version,
            "status": outcome.status,
            "degrees": outcome.model.degrees if outcome.model is not None else None,
            "seconds": sum(outcome.timings.values()),
            "problems": {"errors": severities.count("error"), "warnings": severities.count("warning")},
        }
        self.server.protocol.tell("aidl/status", status)
        for look, viewers in document.looks().items():
            self.server.in_background(self._send(document, look, viewers))

    async def _send(self, document: documents.Document, look: documents.Look, viewers: Sequence[str]) -> None:
        if (message := await self._picture(document, viewers[0], (document, look))) is not None:
            self._tell(viewers, message)

    def _tell(self, viewers: Iterable[str], message: Json) -> None:
        for viewer in viewers:
            self.server.protocol.tell("aidl/previewChanged", {"viewer": viewer, **message})

    async def _picture(self, document: documents.Document, viewer: str, key: Hashable) -> Json | None:
        """Returns the message for the newest run; None without one. Handles follow."""
        known = document.ran
        if known is None or not document.is_open:
            return None
        asked = self.server.asked_now(document, known)
        look = document.viewers.get(viewer, frozenset())
        work = partial(preview, known.view, look, known=document.handles)
        made = await self._made(("picture", key), document, work)
        if made is None:
            return None
        if document.viewers and document.ran is known:
            kept = {each: of for each, of in document.pictures.items() if of[0] is known}
            document.pictures = {**kept, look: (known, made)}
            self.server.in_background(self._complete(asked, made))
        return _written(asked, made, known.view)

    async def _complete(self, asked: Asked, made: Preview) -> None:
        """Finds the handles, and sends the picture again if they are new."""
        document, view = asked.document, asked.view
        await asyncio.sleep(_PAUSE)
        if document.ran is not asked.known or not document.viewers:
            return
        found = await self._made(("handles", document), document, lambda: tuple(handles(view)), first=False)
        if found is None or document.ran is not asked.known:
            return
        document.handles = found
        for look, viewers in document.looks().items():
            known, before = document.pictures.get(look, (None, made))
            if known is asked.known and before.handles != found:
                self._tell(viewers, _written(asked, replace(before, handles=found), view))

    async def _made(
        self, key: Hashable, document: documents.Document, function: Callable[[], T], *, first: bool = True
    ) -> T | None:
        """Returns a result from the solving thread; None if the document changed, or a newer asked."""
        serial = document.serial

        def is_unwanted() -> bool:
            return not document.is_open or not (first or document.serial == serial)

        try:
            return await self.server.runner.work(key, function, is_unwanted, first=first)
        except Cancelled:
            return None

    async def attempt(self, given: documents.Try) -> Json:
        """Returns the picture with other values of params, or with a point dragged; writes nothing."""
        viewer = given.viewer
        asked_before = self.server.document(given.uri).asked[viewer]
        asked = await self._asked(given)
        document = asked.document

        def view() -> View:
            if given.drag is not None:
                return drag(asked.view, given.drag.id, given.drag.to).view
            values, limits = worked_out(asked.view, given.knobs), self.server.limits
            return tried(asked.view, values, document.memory, limits, rests=given.rests)

        def picture() -> Json:
            shown, layers = view(), document.viewers.get(viewer, frozenset())
            return _written(asked, preview(shown, layers, tried=True, known=document.handles), shown)

        def is_outdated() -> bool:
            return document.asked[viewer] != asked_before

        try:
            return await self._work(("try", given.uri, viewer), asked, picture, is_outdated)
        except (AidlError, CannotError) as reason:
            raise JsonRpcException(_why(reason), FAILED) from None

    async def set_knob(self, given: documents.SetKnob) -> Json:
        edits = partial(set_knob, path=given.path, value=given.value)
        return await self._edit(given, edits, f"Set {given.path}")

    async def drag(self, given: documents.Drag) -> Json:
        return await self._edit(given, lambda view: drag(view, given.id, given.to).edits, "Drag")

    async def fix(self, given: documents.ApplyFix) -> Json:
        asked = await self._asked(given)
        found = asked.view.diagnostics
        fix = found[given.problem].fix if 0 <= given.problem < len(found) and given.fix == 0 else None
        if fix is None:
            return _not_applied("there is no such fix")
        return await self._apply(asked, fix.edits, fix.title)

    async def export(self, given: documents.Export) -> Json:
        suffix = f".{given.format}"
        if suffix not in FORMATS:
            raise JsonRpcInvalidParams(f"there is no format `{suffix}`")
        document = self.server.document(given.uri)
        await document.until_solved(document.serial, _LONGEST_WAIT)
        solved = document.ran.view.solved if document.ran is not None else None
        if solved is None:
            raise JsonRpcException("the program does not draw, so there is nothing to export", FAILED)
        try:
            options = changed(layered(given.show), given.options)
            made = await self.server.searches.ask(lambda: solved.outcome.exported(suffix, options))
        except ExportError as reason:
            raise JsonRpcException(_worded(reason.diagnostic), FAILED) from None
        except ValueError as reason:
            raise JsonRpcException(str(reason), FAILED) from None
        name, data = packed(document.path.stem, suffix, made)
        notes = [_worded(note) for note in made.notes]
        return {"name": name, "data": base64.b64encode(data).decode("ascii"), "notes": notes}

    async def exports(self, given: documents.OfDocument) -> Json:
        return offered()

    async def _asked(self, given: documents.OfVersion | documents.ApplyFix) -> Asked:
        return self.server.asked_now(*await self.server.solved_text(given.uri, _LONGEST_WAIT, given.version))

    async def _work(
        self,
        key: tuple[str, ...],
        asked: Asked,
        function: Callable[[], T],
        is_outdated: Callable[[], bool] = lambda: False,
    ) -> T:
        """Runs a function in the solving thread, unless the text changes or a newer request has the key."""
        document = asked.document

        def is_unwanted() -> bool:
            return document.version != asked.known.version or not document.is_open or is_outdated()

        try:
            return await self.server.runner.work(key, function, is_unwanted)
        except Cancelled:
            raise JsonRpcRequestCancelled("there is something newer") from None

    async def _edit(
        self, given: documents.OfVersion, edits: Callable[[View], Sequence[Edit]], label: str
    ) -> Json:
        """Makes one edit of a document after the other: each on the text that the one before made."""
        document = self.server.document(given.uri)
        document.asked[given.viewer] += 1
        async with document.editing:
            asked = await self._asked(given)
            try:
                made = await self._work(("edit", given.uri), asked, lambda: edits(asked.view))
            except (AidlError, CannotError) as reason:
                return _not_applied(_why(reason))
            return await self._apply(asked, made, label)

    async def _apply(self, asked: Asked, edits: Sequence[Edit], label: str) -> Json:
        reason = await self.server.apply(asked, edits, label)
        return _not_applied(reason) if reason else {"applied": True}


def _written(asked: Asked, made: Preview, view: View) -> Json:
    return Writer(view, asked.convert.uri_of).preview(made, asked.known.version)


def _worded(diagnostic: Diagnostic) -> str:
    return "; ".join([diagnostic.message, *diagnostic.hints[:1]])


def _why(reason: AidlError | CannotError) -> str:
    return _worded(reason.diagnostic) if isinstance(reason, AidlError) else str(reason)


def _not_applied(reason: str) -> Json:
    return {"applied": False, "reason": reason}
