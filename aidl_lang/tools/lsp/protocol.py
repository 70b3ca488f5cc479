"""The protocol's own part: pygls, made robust against hostile or hasty clients.

pygls splits lines where the protocol does not, ends the process by itself, and leaves requests that it cannot
read without an answer; this does otherwise.
"""

from __future__ import annotations

import json
import logging
from typing import TYPE_CHECKING, Any

from cattrs import Converter
from lsprotocol import types
from lsprotocol.converters import get_converter
from pygls import exceptions
from pygls.protocol import (
    JsonRPCNotification,
    JsonRPCProtocol,
    JsonRPCRequestMessage,
    JsonRPCResponseMessage,
    LanguageServerProtocol,
    lsp_method,
)

if TYPE_CHECKING:
    from aidl_lang.tools.lsp.server import Server


def converter() -> Converter:
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

    def __init__(self, server: Server, converter: Converter) -> None:
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
                self._require_time(method)
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
        """Tells whether a request of the server has this number. pygls keeps those of the client in the same
        table, and would take an answer to one of those for its outcome.
        """
        return isinstance(number, str) and number in self._result_types

    def _require_time(self, method: str) -> None:
        if method == types.INITIALIZE:
            if self._is_initialized:
                raise exceptions.JsonRpcInvalidRequest("the server is initialized already")
        elif not self._is_initialized:
            raise exceptions.JsonRpcServerNotInitialized()
        elif self._shutdown:
            raise exceptions.JsonRpcInvalidRequest("the server is shutting down")

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
