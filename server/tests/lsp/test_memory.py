"""What the server keeps in memory: what is of use, however long somebody types; nothing of what is closed."""

from __future__ import annotations

import asyncio
import gc
import json
import weakref
from pathlib import Path
from typing import Any

from aidl_lang.common import names
from aidl_server.lsp.serve import make

PROGRAM = (
    "solid plate {{\n    rim = circle(radius: 5)\n    hole bore {{ edge = circle(radius: 2) }}\n}}\n// {}\n"
)
EDITS = 20


class Local:
    """A server in this process, and all that it has sent."""

    def __init__(self) -> None:
        self.server = make()
        self.server.start()
        self.server.protocol.set_writer(self, include_headers=False)
        self.sent: list[dict[str, Any]] = []
        self.send("initialize", id=1, processId=None, rootUri=None, capabilities={})
        self.send("initialized")

    def write(self, data: bytes) -> None:
        self.sent.append(json.loads(data))

    def send(self, method: str, id: int | None = None, **params: Any) -> None:
        message = {"jsonrpc": "2.0", "method": method, "params": params}
        self.server.protocol.receive(json.dumps(message if id is None else {**message, "id": id}).encode())

    def open(self, uri: str, text: str) -> None:
        document = {"uri": uri, "version": 0, "languageId": "aidl", "text": text}
        self.send("textDocument/didOpen", textDocument=document)


async def typed(path: Path) -> tuple[int, int]:
    """How many models are alive after many edits, and after the document was closed."""
    local, uri = Local(), path.as_uri()
    models: weakref.WeakSet[Any] = weakref.WeakSet()
    local.open(uri, PROGRAM.format(0))
    for version in range(1, EDITS):
        document = local.server.documents.get(uri)
        assert document is not None
        await document.until_solved(document.serial, 60)
        assert document.ran is not None
        outcome = document.ran.view.outcome
        assert outcome is not None
        assert outcome.built is not None
        models.add(outcome.built.root)
        del outcome
        await asyncio.sleep(0.1)  # a pause, in which it tidies up
        named, changes = {"uri": uri, "version": version}, [{"text": PROGRAM.format(version)}]
        local.send("textDocument/didChange", textDocument=named, contentChanges=changes)
    typing = len(models)
    local.send("textDocument/didClose", textDocument={"uri": uri})
    del document
    await asyncio.sleep(2)
    closed = len(models)
    local.server.close()
    return typing, closed


def test_models_of_old_texts_and_closed_documents_are_released(tmp_path: Path) -> None:
    """Once all names are known, no edit adds to them, neither its text nor anything else."""
    names.fold.cache_clear()
    try:
        typing, closed = asyncio.run(typed(tmp_path / "a.aidl"))
    finally:
        gc.unfreeze()
    assert typing < EDITS / 2
    assert closed == 0
    known = [text for text in gc.get_referents(names.fold) if isinstance(text, str)]
    assert known
    assert not [text for text in known if "\n" in text]


def test_nothing_is_asked_of_a_text_that_is_no_program(tmp_path: Path) -> None:
    async def asked() -> object:
        local, uri = Local(), (tmp_path / "a.aidl").as_uri()
        local.open(uri, "solid a { c = circle(radius: 3) }\n" * 100_000)
        local.send("textDocument/semanticTokens/full", id=3, textDocument={"uri": uri})
        told: list[Any] = []
        while not told or not any(a.get("id") == 3 for a in local.sent):
            await asyncio.sleep(0.05)
            told = [a for a in local.sent if a.get("method") == "textDocument/publishDiagnostics"]
        local.server.close()
        assert "E0801" in [d["code"] for a in told for d in a["params"]["diagnostics"]]
        return next(a["result"] for a in local.sent if a.get("id") == 3)

    assert asyncio.run(asked()) is None
