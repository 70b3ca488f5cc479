"""What the server keeps in memory: what is of use, however long somebody types; nothing of what is closed."""

from __future__ import annotations

import asyncio
import gc
import json
import weakref
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from aidl_lang.common import names
from aidl_lang.pipeline import Settings
from aidl_server.lsp.running import LIMITS
from aidl_server.lsp.serve import make

PROGRAM = (
    "solid plate {{\n    rim = circle(radius: 5)\n    hole bore {{ edge = circle(radius: 2) }}\n}}\n// {}\n"
)
EDITS = 10
SECONDS = 60


class Local:
    """A server in this process, and all that it has sent."""

    def __init__(self, limits: Settings = LIMITS) -> None:
        self.server = make(limits)
        self.server.start()
        self.server.protocol.set_writer(self, include_headers=False)
        self.sent: list[dict[str, Any]] = []
        self.news = asyncio.Event()
        self.send("initialize", id=1, processId=None, rootUri=None, capabilities={})
        self.send("initialized")

    def write(self, data: bytes) -> None:
        self.sent.append(json.loads(data))
        self.news.set()

    def send(self, method: str, id: int | None = None, **params: Any) -> None:
        message = {"jsonrpc": "2.0", "method": method, "params": params}
        self.server.protocol.receive(json.dumps(message if id is None else {**message, "id": id}).encode())

    def open(self, uri: str, text: str) -> None:
        document = {"uri": uri, "version": 0, "languageId": "aidl", "text": text}
        self.send("textDocument/didOpen", textDocument=document)

    def become(self, uri: str, version: int, text: str) -> None:
        named, changes = {"uri": uri, "version": version}, [{"text": text}]
        self.send("textDocument/didChange", textDocument=named, contentChanges=changes)

    async def heard(self, is_meant: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """The first message of which something holds."""
        async with asyncio.timeout(SECONDS):
            while not (found := list(filter(is_meant, self.sent))):
                self.news.clear()
                await self.news.wait()
        return found[0]

    async def codes(self, version: int) -> list[str]:
        """Those of the diagnostics that are told of the text at a version."""
        told = "textDocument/publishDiagnostics"
        of = await self.heard(lambda m: m.get("method") == told and m["params"]["version"] == version)
        return [each["code"] for each in of["params"]["diagnostics"]]


async def typed(path: Path) -> int:
    """How many models are alive after many edits; after the document was closed there are none."""
    local, uri = Local(), path.as_uri()
    models: weakref.WeakSet[Any] = weakref.WeakSet()
    await asyncio.sleep(0.1)
    while local.server.runner.solving.running:  # what it loads first leaves it no pause
        await asyncio.sleep(0.05)
    local.open(uri, PROGRAM.format(0))
    for version in range(1, EDITS + 1):
        document = local.server.documents.get(uri)
        assert document is not None
        await document.until_solved(document.serial, SECONDS)
        assert document.ran is not None
        outcome = document.ran.view.outcome
        assert outcome is not None
        assert outcome.built is not None
        models.add(outcome.built.root)
        del outcome
        await asyncio.sleep(0.1)  # a pause, in which it tidies up
        if version < EDITS:
            local.become(uri, version, PROGRAM.format(version))
    typing = len(models)
    local.send("textDocument/didClose", textDocument={"uri": uri})
    del document
    async with asyncio.timeout(SECONDS):
        while models:  # a while after, and in a pause
            await asyncio.sleep(0.05)
    local.server.close()
    return typing


def test_models_of_old_texts_and_closed_documents_are_released(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Once all names are known, no edit adds to them, neither its text nor anything else."""
    monkeypatch.setattr("aidl_server.lsp.running._RELEASED", 0.2)
    names.fold.cache_clear()
    try:
        typing = asyncio.run(typed(tmp_path / "a.aidl"))
    finally:
        gc.unfreeze()
    assert typing < EDITS / 2
    known = [text for text in gc.get_referents(names.fold) if isinstance(text, str)]
    assert known
    assert not [text for text in known if "\n" in text]


def test_a_text_that_is_too_long_is_refused_in_words_and_not_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gc.collect", lambda *_: 0)  # of all that the tests have loaded
    limits = replace(LIMITS, text=replace(LIMITS.text, max_characters=99))
    text, uri = "solid a { c = circle(radius: 3) }\n", "untitled:long"

    async def session() -> None:
        local = Local(limits)
        local.open(uri, text * 9)
        local.send("textDocument/semanticTokens/full", id=3, textDocument={"uri": uri})
        assert "E0801" in await local.codes(0)
        assert (await local.heard(lambda message: message.get("id") == 3))["result"] is None
        local.become(uri, 1, text)
        assert await local.codes(1) == []
        local.server.close()

    asyncio.run(session())
