"""The pages and the WebSocket, by clients that behave and by ones that do not."""

from __future__ import annotations

import asyncio
import json
import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient, WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

from aidl_lang.tools.ide.preview.protocol import Json
from aidl_lang.tools.ide.view import View
from aidl_lang.tools.preview.host import MOST_UNTAKEN, Host, Page
from aidl_lang.tools.preview.program import Program
from aidl_lang.tools.preview.site import MOST_PAGES, PANE, site
from aidl_lang.tools.preview.watching import watch
from aidl_lang.tools.preview.worker import MOST_ORDERS

TOKEN, ADDRESS = "tok-En_123", "127.0.0.1:8123"
TEXT = "param width = 60mm in 20..100\nsolid a { body = rectangle(width: width, height: 20) }\n"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "part.aidl"
    path.write_text(TEXT, "utf-8")
    return path


@pytest.fixture
def program(file: Path) -> Program:
    def write(path: Path, data: bytes) -> None:
        path.write_bytes(data)

    return Program(file, write)


@pytest.fixture
def client(program: Program) -> Iterator[TestClient]:
    app = site(Host(program), TOKEN, [ADDRESS, "localhost:8123"])
    with TestClient(app, base_url=f"http://{ADDRESS}") as client:
        yield client


class Talk:
    """A page that is open."""

    def __init__(self, socket: WebSocketTestSession) -> None:
        self.socket = socket

    def say(self, **message: Any) -> None:
        self.socket.send_text(json.dumps(message))

    def hear(self, **wanted: Any) -> dict[str, Any]:
        """The next message of which this holds."""
        while True:
            message: dict[str, Any] = json.loads(self.socket.receive_text())
            if all(message.get(key) == value for key, value in wanted.items()):
                return message


@contextmanager
def talking(client: TestClient, **headers: str) -> Iterator[Talk]:
    # The client says `testserver` unless it is told.
    with client.websocket_connect(f"/{TOKEN}/socket", headers={"host": ADDRESS, **headers}) as socket:
        yield Talk(socket)


class Links(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []
        self.metas: list[dict[str, str | None]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = dict(attrs)
        if tag == "meta":
            self.metas.append(values)
        for name in ("src", "href"):
            link = values.get(name) or ""
            if link and not link.startswith("#"):
                self.found.append(link)


def test_the_page_and_all_that_it_asks_for(client: TestClient) -> None:
    answer = client.get(f"/{TOKEN}/")
    assert answer.status_code == 200
    assert "{{" not in answer.text
    page = Links()
    page.feed(answer.text)
    scripts = [link for link in page.found if link.endswith(".js")]
    assert scripts
    for link in page.found:
        assert client.get(f"/{TOKEN}/{link}").status_code == 200
    policy = next(m["content"] for m in page.metas if m.get("http-equiv") == "Content-Security-Policy")
    assert "script-src 'self'" in str(policy)
    assert "'unsafe" not in answer.headers["content-security-policy"]
    for module in PANE.glob("*.js"):
        served = client.get(f"/{TOKEN}/pane/{module.name}")
        assert (served.text, served.headers["content-type"]) == (
            module.read_text("utf-8"),
            "text/javascript; charset=utf-8",
        )
        for imported in re.findall(r'^import .* from "\./([\w.]+)"', served.text, re.MULTILINE):
            assert client.get(f"/{TOKEN}/pane/{imported}").status_code == 200


@pytest.mark.parametrize(
    "path",
    [
        "/",
        "/favicon.ico",
        "/wrong/",
        "/tok-En_12/",
        f"/{TOKEN}x/",
        f"/{TOKEN}",
        f"/{TOKEN}/pane/../site.py",
        f"/{TOKEN}/pane/..%2fsite.py",
        f"/{TOKEN}/pane/%2e%2e/site.py",
        f"/{TOKEN}/pane/..%5csite.py",
        f"/{TOKEN}/pane//etc/passwd",
        f"/{TOKEN}/pane/%2fetc%2fpasswd",
        f"/{TOKEN}/pane/protocol.d.ts",
        f"/{TOKEN}/pane/",
        f"/{TOKEN}/pane/main.js%00.css",
    ],
)
def test_there_is_nothing_else(client: TestClient, path: str) -> None:
    assert client.get(path, follow_redirects=False).status_code in (307, 404)
    assert client.get(path).status_code in (404, 200 if path == f"/{TOKEN}" else 404)


@pytest.mark.parametrize(
    "name", ["evil.example", "evil.example:8123", "127.0.0.1", f"{ADDRESS}.evil.example", ""]
)
def test_another_name_is_refused(client: TestClient, name: str) -> None:
    assert client.get(f"/{TOKEN}/", headers={"host": name}).status_code == 421
    with pytest.raises(WebSocketDisconnect), talking(client, host=name):
        pass


@pytest.mark.parametrize(
    "origin",
    [
        "http://evil.example",
        "null",
        f"https://{ADDRESS}",
        "http://127.0.0.1:9",
        f"http://{ADDRESS}.evil.example",
    ],
)
def test_pages_from_elsewhere_are_refused(client: TestClient, origin: str) -> None:
    with pytest.raises(WebSocketDisconnect), talking(client, origin=origin):
        pass
    assert client.get(f"/{TOKEN}/", headers={"origin": origin}).status_code == 403


def test_the_socket_needs_the_token(client: TestClient) -> None:
    with (
        pytest.raises(WebSocketDisconnect),
        client.websocket_connect("/wrong/socket", headers={"host": ADDRESS, "origin": f"http://{ADDRESS}"}),
    ):
        pass


def test_a_page_gets_pictures_and_changes_the_text(client: TestClient, file: Path) -> None:
    with talking(client, origin=f"http://{ADDRESS}") as page:
        page.say(type="ready")
        first = page.hear(type="picture")
        assert first["uri"] == file.as_uri()
        assert first["source"]["text"] == TEXT
        page.say(type="knob", path="width", value=90, final=False)
        attempt = page.hear(type="picture", tried=True)
        assert attempt["box"][2] == pytest.approx(45)
        assert file.read_text("utf-8") == TEXT
        page.say(type="cancel")
        assert page.hear(type="picture", tried=False)["box"][2] == pytest.approx(30)
        page.say(type="knob", path="width", value=80, final=True)
        after = page.hear(type="picture", version=2)
        assert file.read_text("utf-8") == TEXT.replace("60mm", "80mm")
        assert after["source"]["text"] == TEXT.replace("60mm", "80mm")
        assert after["handles"] or page.hear(type="picture", version=2)["handles"]


def test_a_save_elsewhere_is_seen(client: TestClient, file: Path) -> None:
    with talking(client) as page, talking(client) as other:
        for each in (page, other):
            each.say(type="ready")
            each.hear(type="picture", version=1)
        file.write_text(TEXT.replace("height: 20", "height: 2 +"), "utf-8")
        for each in (page, other):
            stale = each.hear(type="picture", stale=True)
            assert stale["svg"] is not None
            assert stale["problems"][0]["severity"] == "error"
        file.write_text(TEXT, "utf-8")
        assert page.hear(type="picture", stale=False)["status"] == "solved"


def test_a_save_before_the_files_are_watched_is_seen(
    program: Program, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    may_watch = threading.Event()

    async def late(*told: Any) -> None:
        await asyncio.to_thread(may_watch.wait, 60)
        await watch(*told)

    monkeypatch.setattr("aidl_lang.tools.preview.site.watch", late)
    app = site(Host(program), TOKEN, [ADDRESS])
    with TestClient(app, base_url=f"http://{ADDRESS}") as client, talking(client) as page:
        page.say(type="ready")
        page.hear(type="picture", version=1)
        file.write_text(TEXT.replace("60mm", "40mm"), "utf-8")
        may_watch.set()
        while page.hear(type="picture")["box"][2] != pytest.approx(20):  # half a file may be seen first
            pass


def test_each_page_has_its_own_layers(client: TestClient) -> None:
    with talking(client) as page, talking(client) as other:
        for each in (page, other):
            each.say(type="ready")
        plain = other.hear(type="picture")["svg"]
        page.say(type="show", layers=["names", "no such layer"])
        while (named := page.hear(type="picture")["svg"]) == plain:
            pass
        assert "show-names" in named
        assert "show-names" not in plain


def test_fixes_are_applied_to_the_text_they_are_of(client: TestClient, file: Path) -> None:
    lines = ("one = line((0, 0), (9, 0))", "two = line((9, 0), (5, 5))", "three = line((5, 5), (1, 2))")
    file.write_text(f"solid a {{ {'; '.join(lines)} }}\n", "utf-8")
    with talking(client) as page:
        page.say(type="ready")
        made = page.hear(type="picture")
        while not any(p["fixes"] for p in made["problems"]):
            made = page.hear(type="picture")
        (index,) = [k for k, p in enumerate(made["problems"]) if p["code"] == "W0702"]
        page.say(type="fix", problem=index, fix=9)
        assert "no such fix" in page.hear(type="error")["message"]
        page.say(type="fix", problem=index, fix=0)
        page.hear(type="picture", version=made["version"] + 1)
        assert "constrain one.start == three.end" in file.read_text("utf-8")


def test_what_cannot_be_done_is_told(client: TestClient) -> None:
    with talking(client) as page:
        page.say(type="ready")
        page.hear(type="picture")
        page.say(type="knob", path="width", value=5000, final=True)
        assert "range" in page.hear(type="error")["message"]
        page.say(type="drag", id="nothing", to=[1, 2], final=False)
        page.hear(type="error")
        page.say(type="export", format="exe")
        assert "format" in page.hear(type="error")["message"]
        page.say(type="export", format="svg")
        assert page.hear(type="export")["name"] == "part.svg"


def test_noise_is_passed_over(client: TestClient) -> None:
    with talking(client) as page:
        for text in ("", "{", "[]", "\0", '{"type":"knob"}', "[" * 60_000):
            page.socket.send_text(text)
        page.say(type="ready")
        assert page.hear(type="picture")["status"] == "solved"


def test_bytes_and_much_end_a_connection(client: TestClient) -> None:
    with talking(client) as page:
        page.socket.send_bytes(b"\xff")
        with pytest.raises(WebSocketDisconnect) as refused:
            page.hear(type="never")
    assert refused.value.reason == "This page sent what is no text."
    with talking(client) as page:
        page.socket.send_text("x" * 70_000)
        with pytest.raises(WebSocketDisconnect) as refused:
            page.hear(type="never")
    assert refused.value.reason == "This page sent a message that is too long."
    with talking(client) as page:
        page.say(type="ready")
        page.hear(type="picture")


def test_only_so_many_pages(client: TestClient) -> None:
    pages = [talking(client) for _ in range(MOST_PAGES)]
    for each in pages:
        each.__enter__()
    with talking(client) as one_more, pytest.raises(WebSocketDisconnect) as refused:
        one_more.hear(type="never")
    assert refused.value.reason == f"{MOST_PAGES} pages show this program already: close one of them."
    pages[0].__exit__(None, None, None)
    with talking(client) as page:
        page.say(type="ready")
        page.hear(type="picture")
    for each in pages[1:]:
        each.__exit__(None, None, None)


def test_many_attempts_end_with_the_last(client: TestClient) -> None:
    with talking(client) as page:
        page.say(type="ready")
        page.hear(type="picture")
        for width in range(20, 101):
            page.say(type="knob", path="width", value=width, final=False)
        while page.hear(type="picture", tried=True)["box"][2] != pytest.approx(50):
            pass


def test_a_page_that_asks_for_too_much_is_told_and_holds_up_no_other(
    client: TestClient, program: Program, monkeypatch: pytest.MonkeyPatch
) -> None:
    is_full, done = threading.Event(), []
    export, with_knob = program.export, program.with_knob

    def slow_export(name: str, show: frozenset[str]) -> Json:
        assert is_full.wait(60)
        done.append(name)
        return export(name, show)

    def noted_knob(path: str, value: float | str | bool) -> View:
        done.append("knob")
        return with_knob(path, value)

    monkeypatch.setattr(program, "export", slow_export)
    monkeypatch.setattr(program, "with_knob", noted_knob)
    with talking(client) as flood, talking(client) as page:
        for _ in range(2 * MOST_ORDERS):
            flood.say(type="export", format="svg")
        assert "more than can be done at once" in flood.hear(type="error")["message"]
        page.say(type="knob", path="width", value=50, final=False)
        is_full.set()
        assert page.hear(type="picture", tried=True)["box"][2] == pytest.approx(25)
        assert done.index("knob") <= 2
        page.say(type="export", format="dxf")
        assert page.hear(type="export")["name"] == "part.dxf"
        flood.hear(type="export")
    with talking(client) as page:
        page.say(type="ready")
        page.hear(type="picture")


def test_a_page_that_takes_nothing_is_not_heard() -> None:
    page = Page()
    for number in range(MOST_UNTAKEN - 1):
        page.tell({"type": "error", "message": str(number)})
        page.tell({"type": "busy"})
    assert page.is_behind
    asked: list[str] = []
    host = Host(Program(Path("none.aidl"), lambda path, data: None))
    host.program.set_knob = lambda path, value: asked.append(path)  # type: ignore[method-assign]
    for _ in range(100):
        host.hear(page, '{"type": "knob", "path": "width", "value": 5, "final": true}')
    messages = [json.loads(text) for _, text in page._waiting]
    assert len(messages) == MOST_UNTAKEN + 1
    assert "more than can be done at once" in messages[-1]["message"]
    assert asked == []


def test_a_file_that_is_gone_for_a_moment(client: TestClient, file: Path) -> None:
    with talking(client) as page:
        page.say(type="ready")
        page.hear(type="picture")
        file.unlink()
        assert "cannot be read" in page.hear(type="error")["message"]
        file.write_text(TEXT.replace("60mm", "40mm"), "utf-8")
        assert page.hear(type="picture", version=2)["box"][2] == pytest.approx(20)
