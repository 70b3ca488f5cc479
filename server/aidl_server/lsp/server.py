"""The server: keeps open documents, has them checked and run, and passes questions on."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Awaitable, Callable, Coroutine, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import cattrs
from lsprotocol import types
from lsprotocol.converters import get_converter
from pygls import exceptions
from pygls.capabilities import get_capability
from pygls.lsp.server import LanguageServer
from pygls.protocol import (
    JsonRPCNotification,
    JsonRPCProtocol,
    JsonRPCRequestMessage,
    JsonRPCResponseMessage,
    LanguageServerProtocol,
    lsp_method,
)

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.records import record
from aidl_lang.pipeline import Settings as Limits
from aidl_lang.version import __version__
from aidl_server.ide.workspace import Project, Unit, View, Workspace
from aidl_server.lsp import documents
from aidl_server.lsp.running import LIMITS, Lane, Runner

# --- The protocol's own part: pygls, made robust against hostile or hasty clients.
#
# pygls splits lines where the protocol does not, ends the process by itself, and leaves requests that it
# cannot read without an answer; this does otherwise.


def converter() -> cattrs.Converter:
    """Returns a reader of messages. Parameters of our own methods stay plain dictionaries."""
    made = get_converter()
    made.register_structure_hook(
        JsonRPCRequestMessage,
        lambda m, _: JsonRPCRequestMessage(m["id"], m["method"], m["jsonrpc"], m.get("params")),
    )
    made.register_structure_hook(
        JsonRPCNotification, lambda m, _: JsonRPCNotification(m["method"], m["jsonrpc"], m.get("params"))
    )
    made.register_structure_hook(
        JsonRPCResponseMessage, lambda m, _: JsonRPCResponseMessage(m["id"], m["jsonrpc"], m.get("result"))
    )
    return made


log = logging.getLogger(__name__)


class Protocol(LanguageServerProtocol):
    """`exit_code` is that of the process, once the client has asked it to end."""

    _server: Server

    def __init__(self, server: Server, converter: cattrs.Converter) -> None:
        super().__init__(server, converter)
        self.exit_code: int | None = None
        self._is_initialized = False

    def receive(self, body: bytes) -> None:
        """Handles a message. A request that cannot be read is refused."""
        try:
            data = json.loads(body)
        except (ValueError, RecursionError):
            self._refuse(None, exceptions.JsonRpcParseError())
            return
        if not isinstance(data, dict) or data.get("jsonrpc") != JsonRPCProtocol.VERSION:
            self._refuse(None, exceptions.JsonRpcInvalidRequest())
            return
        if "id" in data and ("method" not in data or "error" in data) and not self._has_asked(data["id"]):
            log.warning("an answer to what was not asked: %r", data["id"])
            return
        asked = data.get("id") if "method" in data else None
        try:
            method: Any = data.get("method")
            if asked is not None:
                if method == types.INITIALIZE:
                    if self._is_initialized:
                        raise exceptions.JsonRpcInvalidRequest("the server is initialized already")
                elif not self._is_initialized:
                    raise exceptions.JsonRpcServerNotInitialized()
                elif self._shutdown:
                    raise exceptions.JsonRpcInvalidRequest("the server is shutting down")
            elif method not in (None, types.EXIT) and not self._is_initialized:
                return  # the protocol has notifications dropped until then
            message = self.structure_message(data)
            self._is_initialized |= asked is not None and method == types.INITIALIZE
        except exceptions.JsonRpcException as trouble:
            log.warning("a message that cannot be understood: %s", trouble)
            if isinstance(asked, int | str):
                self._refuse(asked, trouble)
            return
        self.handle_message(message)

    def _has_asked(self, number: object) -> bool:
        """Tells whether the server asked by this number; pygls has the client's in the same table."""
        return isinstance(number, str) and number in self._result_types

    def _refuse(self, asked: int | str | None, trouble: exceptions.JsonRpcException) -> None:
        error = {"code": trouble.code, "message": trouble.message}
        self._send_data({"jsonrpc": self.VERSION, "id": asked, "error": error})

    def tell(self, method: str, params: dict[str, Any]) -> None:
        """Sends a notification of our own, which is plain data already."""
        self._send_data({"jsonrpc": self.VERSION, "method": method, "params": params})

    @lsp_method(types.EXIT)
    def lsp_exit(self, *_: object) -> None:  # type: ignore[override]  # there is no handler to go on with
        self.exit_code = 0 if self._shutdown else 1

    @lsp_method(types.TEXT_DOCUMENT_DID_OPEN)
    def lsp_text_document__did_open(self, params: types.DidOpenTextDocumentParams) -> None:
        self._server.opened(params.text_document)

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> None:
        self._server.changed(params)

    @lsp_method(types.TEXT_DOCUMENT_DID_CLOSE)
    def lsp_text_document__did_close(self, params: types.DidCloseTextDocumentParams) -> None:
        self._server.closed(params.text_document.uri)


T = TypeVar("T")
Answer = Callable[["Asked", Any], T]
Apply = Callable[["Asked", Sequence[Edit], str], Awaitable[str]]
"""Makes edits of a program under a title; returns why it cannot, or ""."""


@record()
class Asked:
    """The data from which a question is answered, away from the loop."""

    document: documents.Document
    known: documents.VersionedView
    convert: documents.Converter
    settings: documents.Settings
    project: Project
    can: Callable[[str], bool]
    """tells whether the client has a capability"""

    @property
    def uri(self) -> str:
        return self.document.uri

    @property
    def view(self) -> View:
        return self.known.view


class Server(LanguageServer):
    """`start` is called once, in the loop that serves it; `apply` stands in for a client that edits."""

    protocol: Protocol

    def __init__(self, limits: Limits = LIMITS, apply: Apply | None = None) -> None:
        super().__init__("aidl", __version__, protocol_cls=Protocol, converter_factory=converter)
        self.limits, self.apply = limits, apply or self._ask_to_apply
        self.documents = documents.Documents()
        self.open_files = Workspace()
        self.project = Project(self.open_files)
        self.settings = documents.Settings()
        self.answers = Lane("answering")
        self.searches = Lane("searching")
        self.sweeps = Lane("sweeping")
        self.on_solved: list[Callable[[documents.Document, documents.VersionedView], None]] = []
        self.runner: Runner
        self._has_told_of_crash = False
        self._background: set[asyncio.Task[None]] = set()

    def start(self) -> None:
        self.runner = Runner(self, asyncio.get_running_loop())

    def close(self) -> None:
        self.runner.close()
        for answers in (self.answers, self.searches, self.sweeps):
            answers.close()

    def can(self, capability: str) -> bool:
        """Tells whether the client has a capability, as `workspace.workspace_edit.document_changes`."""
        return bool(get_capability(self.client_capabilities, capability, False))

    @property
    def unit(self) -> Unit:
        return Unit(self.workspace.position_encoding or Unit.UTF_16)

    def refresh_hints(self) -> None:
        """Makes the client ask again for hints and lenses."""
        if self.can("workspace.inlay_hint.refresh_support"):
            self.workspace_inlay_hint_refresh(None)
        if self.can("workspace.code_lens.refresh_support"):
            self.workspace_code_lens_refresh(None)

    def in_background(self, work: Coroutine[Any, Any, None]) -> None:
        """Runs a coroutine on the loop. A crash is reported as one of the threads' is."""
        task = asyncio.get_running_loop().create_task(work)
        self._background.add(task)
        task.add_done_callback(self._ended)

    def _ended(self, task: asyncio.Task[None]) -> None:
        self._background.discard(task)
        if not task.cancelled() and (error := task.exception()) is not None:
            self.crashed(error)

    # --- Documents ------------------------------------------------------------------------------

    def opened(self, item: types.TextDocumentItem) -> None:
        if (known := self.documents.get(item.uri)) is not None:
            self.closed(known.uri)  # opened twice, against the rules; the newer text counts
        document = self.documents.open(item)
        self._keep_text(document.path, document.text)
        self.runner.renew(document, active=True)

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        document = self.documents.get(params.text_document.uri)
        if document is None:
            log.warning("a change of %s, which is not open", params.text_document.uri)
            return
        document.version = params.text_document.version
        document.apply(params.content_changes, self.unit)
        self._keep_text(document.path, document.text)
        self.runner.renew(document, active=True)

    def closed(self, uri: str) -> None:
        document = self.documents.close(uri)
        if document is None:
            return
        self.runner.forget(document)
        others = self.documents.at(document.path)
        self._keep_text(document.path, others[-1].text if others else None)
        for file in document.told[1]:
            self._tell_diagnostics(file)

    def _keep_text(self, path: Path, text: str | None) -> None:
        """Sets the text of a file; None for the one on disk. Others may be reading the table."""
        texts = {file: each for file, each in self.open_files.open.items() if file != path}
        self.open_files.open = texts if text is None else {**texts, path: text}
        self.runner.renew_dependents(path)

    # --- What comes of them ---------------------------------------------------------------------

    def took_long(self, document: documents.Document) -> None:
        """Takes note that the results of checking are all that is known for now."""
        if document.newest is not None:
            self._publish(document, document.newest)

    def solved(self, document: documents.Document) -> None:
        """Takes note of a new outcome. The client asks for hints again where it had them before."""
        ran = document.ran
        if ran is None:
            return
        self._publish(document, ran)
        version, serial = document.hinted or (None, None)
        if version == ran.version and serial != ran.serial:
            self.refresh_hints()
        for listener in self.on_solved:
            listener(document, ran)

    def crashed(self, error: BaseException) -> None:
        """Takes note of work that ended with an unexpected error."""
        log.error("work on a program crashed", exc_info=error)
        if not self._has_told_of_crash:
            self._has_told_of_crash = True
            message = f"aidl: something went wrong that should not ({type(error).__name__}); see the log"
            self.window_show_message(types.ShowMessageParams(types.MessageType.Error, message))

    def report_server_error(self, error: Exception, source: object) -> None:
        # of a request the client hears anyway; a refusal of one that is sent as a notification is no crash
        is_refusal = "pygls.exceptions." in str(error)
        if source is not exceptions.FeatureRequestError and not is_refusal:
            self.crashed(error)

    def _publish(self, document: documents.Document, known: documents.VersionedView) -> None:
        """Replaces the diagnostics of a program; does nothing if those before were of a newer text."""
        last, before = document.told
        if known.serial < last:
            return
        convert = self.converter(known.view, document.uri)
        by_uri: dict[str, list[types.Diagnostic]] = {document.uri: []}
        for uri, diagnostic in documents.converted(known.view.diagnostics, convert, document.uri):
            by_uri.setdefault(uri, []).append(diagnostic)
        document.told = known.serial, by_uri
        self._tell_diagnostics(document.uri, known.version)
        for uri in before | by_uri:
            if uri != document.uri and before.get(uri) != by_uri.get(uri):
                self._tell_diagnostics(uri)

    def _tell_diagnostics(self, uri: str, version: int | None = None) -> None:
        """Tells those that all open programs have in a file."""
        said = [each for document in self.documents for each in document.told[1].get(uri, ())]
        unique = {(repr(each.range), each.code, each.message): each for each in said}
        self.text_document_publish_diagnostics(
            types.PublishDiagnosticsParams(uri, list(unique.values()), version)
        )

    # --- Questions ------------------------------------------------------------------------------

    def converter(self, view: View, own: str = "") -> documents.Converter:
        """Returns the converter for the view of a document, or of another file."""
        has_versions = self.can("workspace.workspace_edit.document_changes")
        versions = {each.path: each.version for each in self.documents} if has_versions else None
        return documents.Converter(
            view, own or self.documents.uri_of(view.path), self.documents, self.unit, versions
        )

    def document(self, uri: object) -> documents.Document:
        """Returns an open document. Raises JsonRpcInvalidParams."""
        document = self.documents.get(uri) if isinstance(uri, str) else None
        if document is None:
            raise exceptions.JsonRpcInvalidParams("this document is not open")
        return document

    async def solved_text(
        self, uri: object, seconds: float, version: int | None = None
    ) -> tuple[documents.Document, documents.VersionedView]:
        """Returns a document as its text, or a version of it, was run. Raises JsonRpcContentModified if that
        is gone.
        """
        document = self.document(uri)
        await document.until_solved(document.serial, seconds)
        known = document.ran
        if known is None or known.version != document.version or version not in (None, known.version):
            raise exceptions.JsonRpcContentModified("the text has changed")
        return document, known

    async def asked(self, document: documents.Document, patience: float = 0.0) -> Asked | None:
        """Returns the data of the present text or a newer one, solved if in time; None if it is too long."""
        serial = document.serial
        await document.until_seen(serial)
        if patience:
            await document.until_solved(serial, patience)
        if document.newest is None or not document.is_open:
            return None
        if len(document.newest.view.source.text) > self.limits.text.max_characters:
            return None
        return self.asked_now(document, document.newest)

    def asked_now(self, document: documents.Document, known: documents.VersionedView) -> Asked:
        convert = self.converter(known.view, document.uri)
        return Asked(document, known, convert, self.settings, self.project, self.can)

    async def _ask_to_apply(self, asked: Asked, edits: Sequence[Edit], label: str) -> str:
        params = types.ApplyWorkspaceEditParams(asked.convert.change(edits), label)
        answer = await self.workspace_apply_edit_async(params)
        return "" if answer.applied else answer.failure_reason or "the editor did not change the text"

    def answers_to(
        self,
        method: str,
        options: object = None,
        *,
        patience: float = 0.0,
        edits: bool = False,
        searches: bool = False,
    ) -> Callable[[Answer[T]], Answer[T]]:
        """Registers a function as the answer to a request about a document, away from the loop.

        patience   seconds to wait for the outcome of the text
        edits      whether the answer changes the text, and is of no use to a text that has changed
        searches   whether other programs are looked at, which may take long
        """
        answers = self.searches if searches else self.answers

        def register(function: Answer[T]) -> Answer[T]:
            async def handler(params: Any) -> T | None:
                document = self.documents.get(params.text_document.uri)
                asked = await self.asked(document, patience) if document is not None else None
                if document is None or asked is None:
                    return None
                answer = await answers.ask(partial(function, asked, params))
                if edits and document.version != asked.known.version:
                    raise exceptions.JsonRpcContentModified()
                return answer

            self.feature(method, options)(handler)
            return function

        return register
