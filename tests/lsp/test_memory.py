"""What the server keeps in memory: what is of use, however long somebody types; nothing of what is closed."""

from __future__ import annotations

import asyncio
import gc
import json
import weakref
from pathlib import Path
from typing import Any

import pytest

from aidl_lang.common import names
from aidl_lang.tools.lsp import running
from aidl_lang.tools.lsp.serve import make

PROGRAM = (
    "solid plate {{\n    rim = circle(radius: 5)\n    hole bore {{ edge = circle(radius: 2) }}\n}}\n// {}\n"
)
EDITS = 20


class Nobody:
    def write(self, data: bytes) -> None:
        """Takes what the server sends."""


async def typed(path: Path) -> tuple[int, int]:
    """How many models are alive after many edits, and after the document was closed."""
    server = make()
    server.start()
    server.protocol.set_writer(Nobody(), include_headers=False)

    def send(method: str, params: Any, **more: Any) -> None:
        message = {"jsonrpc": "2.0", "method": method, "params": params, **more}
        server.protocol.receive(json.dumps(message).encode())

    models: weakref.WeakSet[Any] = weakref.WeakSet()

    def alive() -> int:
        return len(models)

    named = {"uri": path.as_uri(), "version": 0}
    send("initialize", {"processId": None, "rootUri": None, "capabilities": {}}, id=1)
    send("initialized", {})
    send("textDocument/didOpen", {"textDocument": {**named, "languageId": "aidl", "text": PROGRAM.format(0)}})
    for version in range(1, EDITS):
        document = server.documents.get(path.as_uri())
        assert document is not None
        await document.until_solved(document.serial, 60)
        assert document.ran is not None
        outcome = document.ran.view.outcome
        assert outcome is not None
        assert outcome.built is not None
        models.add(outcome.built.root)
        del outcome
        await asyncio.sleep(0.1)  # a pause, in which it tidies up
        change = {
            "textDocument": {**named, "version": version},
            "contentChanges": [{"text": PROGRAM.format(version)}],
        }
        send("textDocument/didChange", change)
    typing = alive()
    send("textDocument/didClose", {"textDocument": {"uri": path.as_uri()}})
    del document
    await asyncio.sleep(2)
    closed = alive()
    server.close()
    return typing, closed


def test_models_of_old_texts_and_closed_documents_are_released(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on a machine where collections take long. Once all names are known, no edit adds to them, neither
    its text nor anything else.
    """
    monkeypatch.setattr(running, "_LONG", 0.0)
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
        server = make()
        server.start()
        answers: list[Any] = []
        server.protocol.set_writer(
            type("Kept", (), {"write": lambda self, data: answers.append(json.loads(data))})(),
            include_headers=False,
        )
        uri = (tmp_path / "a.aidl").as_uri()
        text = "solid a { c = circle(radius: 3) }\n" * 100_000
        for number, (method, params) in enumerate(
            {
                "initialize": {"processId": None, "rootUri": None, "capabilities": {}},
                "initialized": {},
                "textDocument/didOpen": {
                    "textDocument": {"uri": uri, "version": 0, "languageId": "aidl", "text": text}
                },
                "textDocument/semanticTokens/full": {"textDocument": {"uri": uri}},
            }.items()
        ):
            message = {"jsonrpc": "2.0", "method": method, "params": params}
            if number in (0, 3):
                message["id"] = number
            server.protocol.receive(json.dumps(message).encode())
        published = "textDocument/publishDiagnostics"
        while not (
            (found := [a for a in answers if a.get("id") == 3])
            and any(a.get("method") == published for a in answers)
        ):
            await asyncio.sleep(0.05)
        told = [
            d
            for a in answers
            if a.get("method") == "textDocument/publishDiagnostics"
            for d in a["params"]["diagnostics"]
        ]
        server.close()
        assert any(d["code"] == "E0801" for d in told)
        return found[0]["result"]

    assert asyncio.run(asked()) is None
