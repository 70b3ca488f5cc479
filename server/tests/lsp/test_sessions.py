"""How a session begins and ends, over pipes and over a socket; clients that break the rules."""

from __future__ import annotations

import asyncio
import json
import os
import socket
import subprocess
import threading
from collections.abc import Callable
from typing import Any

import pytest

from aidl_lang.tools.cli import main
from aidl_server.lsp import serve
from server.tests.lsp.editor import COMMAND, ENVIRONMENT
from server.tests.lsp.test_in_flight import SLOW

SECONDS = 60


class Wire:
    """A client that says what it is told to, byte for byte."""

    def __init__(self, incoming: Any, outgoing: Any) -> None:
        self.incoming, self.outgoing = incoming, outgoing

    def send(self, **message: Any) -> None:
        self.write(json.dumps({"jsonrpc": "2.0", **message}).encode())

    def write(self, body: bytes) -> None:
        self.raw(b"Content-Length: %d\r\n\r\n" % len(body) + body)

    def raw(self, data: bytes) -> None:
        self.outgoing.write(data)
        self.outgoing.flush()

    def close(self) -> None:
        self.outgoing.close()

    def read(self) -> dict[str, Any]:
        length = 0
        while line := self.incoming.readline().strip():
            name, _, value = line.partition(b":")
            length = int(value) if name.lower() == b"content-length" else length
        return json.loads(self.incoming.read(length))

    def answer(self, number: object) -> dict[str, Any]:
        while (message := self.read()).get("id") != number or "method" in message:
            pass
        return message

    def greet(self, **capabilities: Any) -> None:
        params = {"processId": None, "rootUri": None, "capabilities": capabilities}
        self.send(id=0, method="initialize", params=params)
        assert "result" in self.answer(0)
        self.send(method="initialized", params={})

    def open(self, text: str, uri: str = "untitled:a") -> None:
        document = {"uri": uri, "languageId": "aidl", "version": 1, "text": text}
        self.send(method="textDocument/didOpen", params={"textDocument": document})

    def diagnostics(self, uri: str) -> list[dict[str, Any]]:
        """What is told next of a text."""
        while (told := self.read().get("params", {})).get("uri") != uri or "diagnostics" not in told:
            pass
        return told["diagnostics"]


def served(talk: Callable[[Wire], None]) -> int:
    """The exit code of a server in this process that a client talks to over pipes."""
    (incoming, told), (said, outgoing) = os.pipe(), os.pipe()
    watchdog = threading.Timer(SECONDS, os.close, (outgoing,))  # ends what waits for an answer in vain

    async def session() -> int:
        with open(said, "rb") as hearing, open(told, "wb") as saying:
            serving = asyncio.create_task(serve.serve_pipes(incoming, outgoing))
            await asyncio.to_thread(talk, Wire(hearing, saying))
            return await serving

    watchdog.start()
    try:
        return asyncio.run(session())
    finally:
        watchdog.cancel()


def break_rules(wire: Wire) -> None:
    wire.send(id=1, method="textDocument/hover", params={})
    assert wire.answer(1)["error"]["code"] == -32002
    wire.greet()
    wire.send(
        id="again", method="initialize", params={"processId": None, "rootUri": None, "capabilities": {}}
    )
    assert wire.answer("again")["error"]["code"] == -32600
    wire.raw(b"garbage\r\n\r\n\x00\xff\n" + b"x" * 200_000 + b"\n")
    wire.raw(b"content-length:abc\r\n\r\n")
    for body in (b"no json", b"\xff\xfe", b"[" * 100_000, b'"text"', b"{}", b'{"jsonrpc": "1.0", "id": 4}'):
        wire.write(body)
        assert wire.answer(None)["error"]["code"] in (-32700, -32600)
    wire.send(id=5, method="textDocument/definition", params={"textDocument": 3})
    assert wire.answer(5)["error"]["code"] == -32602
    wire.send(id=6, method="textDocument/definition", params={"position": {"line": -1, "character": 1e99}})
    assert "error" in wire.answer(6)
    wire.send(id=7, method="no/such/method", params=None)
    assert wire.answer(7)["error"]["code"] == -32601
    wire.send(id=[8], method="textDocument/hover")
    wire.send(method="textDocument/didChange", params={"textDocument": {}})
    wire.send(method="$/cancelRequest", params={"id": "never"})
    wire.send(id=99, result={"surprise": True})
    wire.open("solid a { b = circle(raduis: 3) }", "http://[not a uri")
    assert [d["code"] for d in wire.diagnostics("http://[not a uri")] == ["E0324"]
    wire.open(SLOW)
    wire.diagnostics("untitled:a")  # of what was found without running it: by now it is being run
    wire.send(id=10, method="aidl/preview", params={"uri": "untitled:a", "show": []})
    wire.send(id=11, method="shutdown")
    assert wire.answer(11)["result"] is None
    wire.send(id=12, method="shutdown")
    assert wire.answer(12)["error"]["code"] == -32600
    wire.send(method="exit")


def test_rules_are_kept_where_clients_break_them(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gc.collect", lambda *_: 0)  # of all that the tests have loaded
    assert served(break_rules) == 0
    assert not [record for record in caplog.records if record.exc_info and serve._is_news(record)]


@pytest.mark.parametrize("leave", [Wire.close, lambda wire: wire.send(method="exit")])
def test_leaving_without_a_word(leave: Callable[[Wire], None]) -> None:
    def talk(wire: Wire) -> None:
        wire.greet()
        wire.open(SLOW)
        leave(wire)

    assert served(talk) == 1


def test_a_client_on_a_socket_that_counts_in_bytes_and_leaves() -> None:
    process = subprocess.Popen([*COMMAND, "--tcp", "127.0.0.1:0"], stderr=subprocess.PIPE, env=ENVIRONMENT)
    with process:
        address, _, words = process.stderr.readline().decode().partition(": ")
        assert words == "waiting for a client\n"
        host, port = address.rsplit(":", 1)
        with socket.create_connection((host, int(port)), SECONDS) as connection:
            stream = connection.makefile("rwb")
            wire = Wire(stream, stream)
            wire.greet(general={"positionEncodings": ["utf-8"]})
            text = "solid a { /* 🚀ü */ b = circle(raduis: 3) }"
            wire.open(text)
            (wrong,) = wire.diagnostics("untitled:a")
            character = len(text[: text.index("raduis")].encode())
            assert wrong["range"]["start"] == {"line": 0, "character": character}
            wire.open(SLOW, "untitled:slow")
            assert wire.diagnostics("untitled:slow") == []  # of what was found without running it
            stream.close()
        assert process.wait(SECONDS) == 1  # while it is being run
        assert b"Traceback" not in process.stderr.read()


def test_an_address_that_cannot_be_served(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        assert main(["lsp", "--tcp", f"127.0.0.1:{taken.getsockname()[1]}"]) == 2
    assert "E0954" in capsys.readouterr().err
    for wrong in ("8000", "here:", "here:99999"):
        with pytest.raises(SystemExit):
            main(["lsp", "--tcp", wrong])


def test_nothing_but_the_protocol_is_on_standard_output() -> None:
    kept = [os.dup(stream) for stream in range(3)]
    (incoming, told), (said, outgoing), (stray, error) = (os.pipe() for _ in range(3))
    try:
        for stream, of in enumerate((incoming, outgoing, error)):
            os.dup2(of, stream)
        claimed, claimed_out = serve.claim_standard_streams()
        os.write(1, b"stray")
        os.write(told, b"said")
        os.write(claimed_out, os.read(claimed, 99))
        assert (os.read(said, 99), os.read(stray, 99), os.read(0, 99)) == (b"said", b"stray", b"")
    finally:
        for stream, of in enumerate(kept):
            os.dup2(of, stream)
        for of in (*kept, incoming, told, said, outgoing, stray, error, claimed, claimed_out):
            os.close(of)
