"""The server as clients meet it: asked by the SDK's client, over HTTP, and over pipes byte by byte."""

from __future__ import annotations

import base64
import io
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import Any

import anyio.from_thread
import jsonschema
import pytest
from PIL import Image

from aidl_lang.tools.agents.calling import Workers
from aidl_lang.tools.agents.tools import Tools
from aidl_lang.tools.agents.workspace import Workspace
from aidl_lang.tools.cli import main
from tests.agents.test_tools import BOLT, IMPORTS, PLATE, TELEPHONE
from tests.cli.conftest import folder as folder
from tests.commands import Aidl, Result
from tests.commands import aidl as aidl
from tests.documents import ROOT
from tests.sweep.here import at_once as at_once

mcp = pytest.importorskip("mcp")


class Session:
    """A client that is connected, asked from outside of its event loop."""

    def __init__(self, client: Any, portal: Any) -> None:
        self.client, self.portal = client, portal

    def __call__(self, method: str, *arguments: Any) -> Any:
        return self.portal.call(getattr(self.client, method), *arguments)

    def ask(self, name: str, /, **arguments: Any) -> Any:
        return self("call_tool", name, arguments)


@contextmanager
def connected(server: Any) -> Iterator[Session]:
    with (
        anyio.from_thread.start_blocking_portal() as portal,
        portal.wrap_async_context_manager(mcp.Client(server, read_timeout_seconds=120)) as client,
    ):
        yield Session(client, portal)


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a bolt in it."""
    root = tmp_path_factory.mktemp("server") / "lib"
    root.mkdir()
    (root / "bolt.aidl").write_text(BOLT)
    return root


@pytest.fixture(scope="module")
def session(root: Path) -> Iterator[Session]:
    from aidl_lang.tools.agents.server import Server

    workers = Workers(Tools(Workspace(root)))
    with connected(Server(workers)) as session:
        yield session
    workers.close()


def test_bad_program_is_checked(session: Session) -> None:
    made = session.ask("check", program="solid a { b = circle(raduis: 3) }")
    assert not made.is_error
    assert made.structured_content["fixed_program"] == "solid a { b = circle(radius: 3) }"
    assert made.content[0].text.startswith("error E0324 line 1")


def test_good_program_is_drawn(session: Session) -> None:
    made = session.ask("compile", program=TELEPHONE, formats=["png", "model"])
    text, picture = made.content
    assert text.text.startswith("solved: every constraint and assertion holds")
    assert picture.mime_type == "image/png"
    with Image.open(io.BytesIO(base64.b64decode(picture.data))) as image:
        assert image.format == "PNG"
        assert len(image.convert("RGB").getcolors(1 << 24) or []) > 3
    schema = json.loads((ROOT / "docs" / "model.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator(schema).validate(made.structured_content["model"])


def test_call_that_cannot_be_answered_is_an_error_of_the_tool(session: Session) -> None:
    for name, arguments in (
        ("compile", {"program": 3}),
        ("nothing", {}),
        ("compile", {}),
        ("measure", {"program": PLATE, "path": "x"}),
    ):
        made = session.ask(name, **arguments)
        assert made.is_error
        assert re.match(r"error E09\d\d: ", made.content[0].text)
        assert made.structured_content is None


def test_imports_cannot_leave_the_root(session: Session) -> None:
    inside = session.ask("check", program=IMPORTS.replace("lib/", ""))
    outside = session.ask("check", program=IMPORTS.replace("lib/", "../lib/"))
    assert inside.structured_content["ok"]
    assert not outside.structured_content["ok"]
    assert "lies outside the project" in outside.content[0].text


def test_texts_to_read(session: Session) -> None:
    uris = [str(resource.uri) for resource in session("list_resources").resources]
    assert {"aidl://guide", "aidl://examples/telephone", "aidl://model.schema.json"} <= set(uris)
    for uri in (*uris, "aidl://diagnostics/E0301", "aidl://reference/rectangle"):
        assert session("read_resource", uri).contents[0].text.strip()
    assert session("read_resource", "aidl://examples/telephone").contents[0].text == TELEPHONE


@pytest.mark.parametrize(
    "uri",
    ["aidl://diagnostics/E9999", "aidl://reference/qqqq", "aidl://examples/..%2F..%2FREADME", "aidl://x"],
)
def test_texts_that_there_are_not(session: Session, uri: str) -> None:
    with pytest.raises(mcp.MCPError):
        session("read_resource", uri)


def test_prompts(session: Session) -> None:
    assert [prompt.name for prompt in session("list_prompts").prompts] == ["draw", "mend"]
    message = session("get_prompt", "draw", {"request": "a cup"}).messages[0]
    assert message.content.text.startswith("Draw this with AIDL: a cup\n")


def test_nothing_but_the_protocol_is_on_standard_output(root: Path) -> None:
    """Also of what the command cannot read, or is too long; and it ends when its input does."""
    known = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "a", "version": "1"}}
    messages: list[dict[str, Any]] = [
        {"id": 1, "method": "nothing"},
        {"id": 2, "method": "initialize", "params": known},
        {"method": "notifications/initialized"},
    ]
    for number, program in enumerate(("// " + "x" * 10_000_000, IMPORTS.replace("lib/", "")), 3):
        call = {"name": "check", "arguments": {"program": program}}
        messages.append({"id": number, "method": "tools/call", "params": call})
    lines = [json.dumps({"jsonrpc": "2.0", **message}).encode() for message in messages]
    command = [sys.executable, "-m", "aidl_lang", "mcp", "--root", str(root)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=ROOT) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(b"\n".join([b"this is no JSON", b"[]", b"\xff\xfe", *lines, b""]))
        process.stdin.flush()
        told: dict[object, dict[str, Any]] = {}
        while not {3, 4} <= told.keys():
            message = json.loads(process.stdout.readline())
            assert message["jsonrpc"] == "2.0"
            told[message.get("id")] = message
        rest, _ = process.communicate(timeout=60)
    assert (process.returncode, rest) == (0, b"")
    refused, made = told[3]["result"], told[4]["result"]
    assert refused["isError"]
    assert "have 10,000,003 characters, more than the 400,000 allowed" in refused["content"][0]["text"]
    assert made["structuredContent"]["ok"]


def test_over_http_with_a_token_of_ones_own(monkeypatch: pytest.MonkeyPatch) -> None:
    import uvicorn

    made: SimpleQueue[uvicorn.Server] = SimpleQueue()
    said: SimpleQueue[str] = SimpleQueue()
    run = uvicorn.Server.run
    monkeypatch.setattr(uvicorn.Server, "run", lambda self, **given: (made.put(self), run(self, **given)))
    monkeypatch.setattr("aidl_lang.tools.cli.serving.say", said.put)
    monkeypatch.setenv("AIDL_MCP_TOKEN", "our-own-token-for-this")
    thread = Thread(target=main, args=(["mcp", "--http", "0"],))
    thread.start()
    server, address = made.get(timeout=60), said.get().split()[2]
    try:
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/our-own-token-for-this/mcp", address)
        with connected(address) as session:
            assert session.ask("check", program=PLATE).structured_content["ok"]
        assert _status(address, {"Host": "example.com"}) == 421
        assert _status(address, {"Origin": "http://example.com"}) == 403
        host = address.rpartition("/mcp")[0].rpartition("/")[0]
        assert [_status(f"{host}{path}", {}) for path in ("/mcp", "/x/mcp", "/")] == [404, 404, 404]
    finally:
        server.should_exit = True
        thread.join(60)


def test_without_one_the_address_is_a_secret(monkeypatch: pytest.MonkeyPatch) -> None:
    paths: list[str] = []

    def serve(root: object, listener: Any, path: str) -> None:
        listener.close()
        paths.append(path)

    monkeypatch.setattr("aidl_lang.tools.agents.server.serve", serve)
    assert [main(["mcp", "--http", "0"]) for _ in range(2)] == [0, 0]
    assert paths[0] != paths[1]
    assert all(re.fullmatch(r"/[\w-]{32}/mcp", path) for path in paths)


def _status(address: str, headers: dict[str, str]) -> int:
    """What a request that a web page could send is answered with."""
    from urllib.error import HTTPError
    from urllib.request import Request, urlopen

    known = {"Content-Type": "application/json", "Accept": "application/json, text/event-stream"}
    with pytest.raises(HTTPError) as error:
        urlopen(Request(address, b"{}", {**known, **headers}), timeout=30)
    error.value.close()
    return error.value.code


# --- What keeps it from starting -------------------------------------------------------------------


def test_packages_that_are_missing(aidl: Aidl, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "aidl_lang.tools.cli.serving.find_spec", lambda name: None if name == "mcp" else object()
    )
    told = "error[E0942]: the server needs `mcp`, not installed here\n"
    assert aidl("mcp") == Result(2, "", told + "  = hint: pip install 'aidl-lang[mcp]'\n")


def test_token_that_is_none(aidl: Aidl, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AIDL_MCP_TOKEN", "../short")
    told = "error[E0942]: AIDL_MCP_TOKEN is no token\n"
    hint = "  = hint: it has 16 letters, digits, `-` and `_`, or more\n"
    assert aidl("mcp", "--http", "0") == Result(2, "", told + hint)
