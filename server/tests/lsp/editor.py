"""An editor as the server meets it: pytest-lsp's client, which keeps texts and changes them when asked."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest_lsp
from lsprotocol import types
from pytest_lsp.client import DEFAULT_CLIENT_FEATURES, LanguageClient, register_lsp_features

from aidl_server.lsp.server import converter
from tests.documents import ROOT

COMMAND = [sys.executable, "-m", "aidl_lang", "lsp"]
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (ROOT, ROOT / "server")))}
TELEPHONE = ROOT / "examples" / "telephone.aidl"
SECONDS = 60
"""Longer than anything here takes on a busy machine."""


def place(text: str, offset: int) -> types.Position:
    """Counted as UTF-16 is: two bytes for a unit."""
    before = text[:offset].split("\n")
    return types.Position(len(before) - 1, len(before[-1].encode("utf-16-le")) // 2)


def stretch(text: str, start: int, end: int) -> types.Range:
    return types.Range(place(text, start), place(text, end))


def offset(text: str, position: types.Position) -> int:
    lines = text.split("\n")
    line = lines[position.line].encode("utf-16-le")[: 2 * position.character]
    return sum(len(each) + 1 for each in lines[: position.line]) + len(line.decode("utf-16-le"))


def edited(text: str, edits: Any) -> str:
    """The text after edits of the protocol."""
    spans = [(offset(text, e.range.start), offset(text, e.range.end), e.new_text) for e in edits]
    for start, end, new in sorted(spans, reverse=True, key=lambda span: span[:2]):
        text = text[:start] + new + text[end:]
    return text


class Editor(LanguageClient):
    """`told` are all diagnostics in the order in which they came, `pictures` all previews, `texts` what is
    open, by URI, and `versions` theirs.
    """

    def __init__(self) -> None:
        super().__init__(converter_factory=converter, configuration={"": {"aidl": {}}})
        self.told: list[types.PublishDiagnosticsParams] = []
        self.pictures: list[dict[str, Any]] = []
        self.statuses: list[dict[str, Any]] = []
        self.refreshed: list[str] = []
        self.registered: list[types.Registration] = []
        self.texts: dict[str, str] = {}
        self.versions: dict[str, int] = {}
        self.news = asyncio.Event()

    def open(self, uri: str | Path, text: str | None = None) -> str:
        if isinstance(uri, Path):
            text = uri.read_text("utf-8") if text is None else text
            uri = uri.as_uri()
        assert text is not None
        self.told = [told for told in self.told if told.uri != uri]  # versions begin anew
        for news in (self.pictures, self.statuses):
            news[:] = [each for each in news if each["uri"] != uri]
        self.texts[uri], self.versions[uri] = text, 1
        item = types.TextDocumentItem(uri, "aidl", 1, text)
        self.text_document_did_open(types.DidOpenTextDocumentParams(item))
        return uri

    def change(self, uri: str, start: int, end: int, new: str) -> int:
        """Replace a piece of a text. The version afterwards."""
        text = self.texts[uri]
        where = stretch(text, start, end)
        self.texts[uri] = text[:start] + new + text[end:]
        self.versions[uri] += 1
        document = types.VersionedTextDocumentIdentifier(self.versions[uri], uri)
        change = types.TextDocumentContentChangePartial(where, new)
        self.text_document_did_change(types.DidChangeTextDocumentParams(document, [change]))
        return self.versions[uri]

    def replace(self, uri: str, old: str, new: str) -> int:
        """Change the first place where something stands."""
        start = self.texts[uri].index(old)
        return self.change(uri, start, start + len(old), new)

    def become(self, uri: str, text: str) -> int:
        """Another text altogether."""
        return self.change(uri, 0, len(self.texts[uri]), text)

    def close(self, uri: str) -> None:
        del self.texts[uri], self.versions[uri]
        self.text_document_did_close(types.DidCloseTextDocumentParams(self.document(uri)))

    async def until(self, condition: Callable[[], Any]) -> Any:
        """What a condition gives once it holds."""
        async with asyncio.timeout(SECONDS):
            while not (found := condition()):
                self.news.clear()
                await self.news.wait()
        return found

    async def found(self, uri: str) -> list[types.Diagnostic]:
        """The diagnostics of the text as it is now."""
        version = self.versions[uri]
        last = await self.until(
            lambda: next((t for t in reversed(self.told) if t.uri == uri and t.version == version), None)
        )
        return list(last.diagnostics)

    async def status(self, uri: str) -> dict[str, Any]:
        """What came of the text as it is now."""
        return await self._of_now(self.statuses, uri)

    async def picture(self, uri: str) -> dict[str, Any]:
        """The picture that came after the text as it is now was run; it has to be shown."""
        return await self._of_now(self.pictures, uri)

    async def _of_now(self, news: list[dict[str, Any]], uri: str) -> dict[str, Any]:
        wanted = uri, self.versions[uri]
        return await self.until(lambda: next((n for n in news if (n["uri"], n["version"]) == wanted), None))

    async def query(self, method: str, where: str | dict[str, Any], **params: Any) -> Any:
        """A question about a text, or about a place in it (see `at`)."""
        where = where if isinstance(where, dict) else {"text_document": self.document(where)}
        made = types.METHOD_TO_TYPES[f"textDocument/{method}"][2](**where, **params)
        return await self.protocol.send_request_async(f"textDocument/{method}", made)

    async def ask(self, method: str, **params: Any) -> Any:
        """A request of our own."""
        async with asyncio.timeout(SECONDS):
            return await self.protocol.send_request_async(method, params)

    def document(self, uri: str) -> types.TextDocumentIdentifier:
        return types.TextDocumentIdentifier(uri)

    def at(self, uri: str, text: str, inside: int = 0) -> dict[str, Any]:
        """Document and position of the first place where something stands, some characters further on."""
        offset = self.texts[uri].index(text) + inside
        return {"text_document": self.document(uri), "position": place(self.texts[uri], offset)}

    def apply(self, edit: types.WorkspaceEdit) -> bool:
        """Change the open texts, unless an edit is of another version."""
        changes = edit.document_changes or []
        assert all(isinstance(each, types.TextDocumentEdit) for each in changes)
        if any(c.text_document.version != self.versions.get(c.text_document.uri) for c in changes):
            return False
        for each in changes:
            self.become(each.text_document.uri, edited(self.texts[each.text_document.uri], each.edits))
        return True


CAPABILITIES = converter().structure(
    {
        "general": {"positionEncodings": ["utf-16"]},
        "workspace": {
            **dict.fromkeys(("applyEdit", "configuration", "workspaceFolders"), True),
            "workspaceEdit": {"documentChanges": True},
            "didChangeWatchedFiles": {"dynamicRegistration": True},
            "inlayHint": {"refreshSupport": True},
            "codeLens": {"refreshSupport": True},
        },
        "textDocument": {
            "completion": {"completionItem": {"snippetSupport": True, "documentationFormat": ["markdown"]}},
            "hover": {"contentFormat": ["markdown"]},
            "documentSymbol": {"hierarchicalDocumentSymbolSupport": True},
            "rename": {"prepareSupport": True},
            "codeAction": {"resolveSupport": {"properties": ["edit"]}},
        },
    },
    types.ClientCapabilities,
)


def make() -> Editor:
    editor = Editor()
    heard = {
        types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS: lambda params: editor.told.append(params),
        "aidl/previewChanged": lambda params: editor.pictures.append(params),
        "aidl/status": lambda params: editor.statuses.append(params),
        types.WORKSPACE_INLAY_HINT_REFRESH: lambda params: editor.refreshed.append("hints"),
        types.WORKSPACE_CODE_LENS_REFRESH: lambda params: editor.refreshed.append("lenses"),
        types.CLIENT_REGISTER_CAPABILITY: lambda params: editor.registered.extend(params.registrations),
        types.WORKSPACE_APPLY_EDIT: lambda params: types.ApplyWorkspaceEditResult(editor.apply(params.edit)),
        types.WINDOW_SHOW_MESSAGE: lambda params: editor.messages.append(params),
    }

    def waking(hear: Callable[[Any], Any]) -> Callable[[Any], Any]:
        def handler(params: Any) -> Any:
            answer = hear(params)
            editor.news.set()
            return answer

        return handler

    features = {method: waking(hear) for method, hear in heard.items()}
    for method, feature in DEFAULT_CLIENT_FEATURES.items():
        if method not in features:
            editor.feature(method)(feature)
    register_lsp_features(editor, features)
    return editor


async def greet(editor: Editor, folder: Path) -> None:
    folders = [types.WorkspaceFolder(folder.as_uri(), folder.name)]
    await editor.initialize_session(
        types.InitializeParams(capabilities=CAPABILITIES, workspace_folders=folders)
    )


CONFIG = pytest_lsp.ClientServerConfig(COMMAND, client_factory=make, server_env=ENVIRONMENT)
