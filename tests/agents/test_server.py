"""The server as clients meet it: a process of its own, asked over pipes or HTTP by the SDK's client."""

from __future__ import annotations

import base64
import io
import json
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import anyio.from_thread
import jsonschema
import pytest
from PIL import Image

from aidl_lang.tools.cli import main
from tests.agents.test_tools import BOLT, IMPORTS, PLATE, TELEPHONE
from tests.cli.conftest import folder as folder
from tests.commands import Aidl, Result
from tests.commands import aidl as aidl
from tests.documents import ROOT
from tests.sweep.here import at_once as at_once

COMMAND = [sys.executable, "-m", "aidl_lang", "mcp"]


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
    mcp = pytest.importorskip("mcp")
    with (
        anyio.from_thread.start_blocking_portal() as portal,
        portal.wrap_async_context_manager(mcp.Client(server, read_timeout_seconds=120)) as client,
    ):
        yield Session(client, portal)


def command(*arguments: str) -> Any:
    return pytest.importorskip("mcp").StdioServerParameters(
        command=COMMAND[0], args=[*COMMAND[1:], *arguments], env={"PYTHONPATH": str(ROOT)}
    )


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    """A server whose root has a bolt in it."""
    root = tmp_path_factory.mktemp("server") / "lib"
    root.mkdir()
    (root / "bolt.aidl").write_text(BOLT)
    with connected(command("--root", str(root))) as session:
        yield session


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


def test_ten_megabytes_are_refused(session: Session) -> None:
    made = session.ask("check", program="// " + "x" * 10_000_000)
    assert made.is_error
    assert "have 10,000,003 characters, more than the 400,000 allowed" in made.content[0].text
    assert not session.ask("check", program=PLATE).is_error


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
    with pytest.raises(pytest.importorskip("mcp").MCPError):
        session("read_resource", uri)


def test_prompts(session: Session) -> None:
    assert [prompt.name for prompt in session("list_prompts").prompts] == ["draw", "mend"]
    message = session("get_prompt", "draw", {"request": "a cup"}).messages[0]
    assert message.content.text.startswith("Draw this with AIDL: a cup\n")


def test_nothing_but_the_protocol_is_on_standard_output() -> None:
    """Also of what the command cannot read; and it ends when its input does."""
    lines = [b"this is no JSON", b'{"jsonrpc": "2.0", "id": 1, "method": "nothing"}', b"[]", b"\xff\xfe"]
    done = subprocess.run(
        COMMAND, input=b"\n".join(lines) + b"\n", capture_output=True, timeout=60, cwd=ROOT, check=True
    )
    assert done.stdout.strip()
    for line in done.stdout.splitlines():
        assert json.loads(line)["jsonrpc"] == "2.0"


@contextmanager
def serving(*arguments: str) -> Iterator[str]:
    """A server over HTTP at the address that it tells."""
    with subprocess.Popen([*COMMAND, *arguments], stderr=subprocess.PIPE, text=True, cwd=ROOT) as process:
        assert process.stderr is not None
        try:
            yield process.stderr.readline().split()[2]
        finally:
            process.send_signal(signal.SIGTERM)
            process.wait(60)


def test_over_http_with_a_token_of_ones_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AIDL_MCP_TOKEN", "our-own-token-for-this")
    with serving("--http", "0") as address:
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/our-own-token-for-this/mcp", address)
        with connected(address) as session:
            assert session.ask("check", program=PLATE).structured_content["ok"]
        assert _status(address, {"Host": "example.com"}) == 421
        assert _status(address, {"Origin": "http://example.com"}) == 403
        host = address.rpartition("/mcp")[0].rpartition("/")[0]
        assert [_status(f"{host}{path}", {}) for path in ("/mcp", "/x/mcp", "/")] == [404, 404, 404]


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
