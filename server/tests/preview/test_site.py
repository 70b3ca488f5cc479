"""The pages and the WebSocket, by clients that behave and by ones that do not."""

from __future__ import annotations

import asyncio
import re
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from aidl_server.preview.files import watch
from aidl_server.preview.host import LONGEST, MOST_ORDERS
from aidl_server.preview.local import PANE
from aidl_server.preview.site import MOST_PAGES
from server.tests.preview.talking import ADDRESS, CHANGED, TEXT, TOKEN, Talk, serving, talking

_ERROR = "window/showMessage"


@dataclass(frozen=True)
class Site:
    """A program that is served."""

    client: TestClient
    file: Path

    def talking(self, **headers: str) -> Any:
        """A page that is open."""
        return talking(self.client, self.file, **headers)


@pytest.fixture
def site(file: Path) -> Iterator[Site]:
    with serving(file) as client:
        yield Site(client, file)


@pytest.fixture(scope="module")
def still(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """One that no test changes, for many."""
    file = tmp_path_factory.mktemp("still") / "part.aidl"
    file.write_text(TEXT, "utf-8")
    with serving(file) as client:
        yield Site(client, file)


def test_the_page_and_all_that_it_asks_for(still: Site) -> None:
    def get(path: str) -> Any:
        answer = still.client.get(f"/{TOKEN}/{path}")
        assert answer.status_code == 200
        return answer

    page = get("")
    assert "{{" not in page.text
    links = re.findall(r'(?:src|href)="([^"#]+)"', page.text)
    assert any(link.endswith(".js") for link in links)
    for link in links:
        get(link)
    assert re.search(
        r'<meta http-equiv="Content-Security-Policy" content="[^"]*script-src \S*self', page.text
    )
    assert "'unsafe" not in page.headers["content-security-policy"]
    for module in PANE.glob("*.js"):
        served = get(f"pane/{module.name}")
        assert served.text == module.read_text("utf-8")
        assert served.headers["content-type"] == "text/javascript; charset=utf-8"
        for imported in re.findall(r'^import .* from "\./([\w.]+)"', served.text, re.MULTILINE):
            get(f"pane/{imported}")


NOTHING = f"""
    / /favicon.ico /wrong/ /tok-En_12/ /{TOKEN}x/ /{TOKEN} /{TOKEN}/pane/../site.py /{TOKEN}/pane/..%2fsite.py
    /{TOKEN}/pane/%2e%2e/site.py /{TOKEN}/pane/..%5csite.py /{TOKEN}/pane//etc/passwd
    /{TOKEN}/pane/%2fetc%2fpasswd /{TOKEN}/pane/protocol.d.ts /{TOKEN}/pane/ /{TOKEN}/pane/main.js%00.css
"""


@pytest.mark.parametrize("path", NOTHING.split())
def test_there_is_nothing_else(still: Site, path: str) -> None:
    assert still.client.get(path, follow_redirects=False).status_code in (307, 404)
    assert still.client.get(path).status_code in (404, 200 if path == f"/{TOKEN}" else 404)


@pytest.mark.parametrize(
    "name", ["evil.example", "evil.example:8123", "127.0.0.1", f"{ADDRESS}.evil.example", ""]
)
def test_another_name_is_refused(still: Site, name: str) -> None:
    assert still.client.get(f"/{TOKEN}/", headers={"host": name}).status_code == 421
    with pytest.raises(WebSocketDisconnect), still.talking(host=name):
        pass


FOREIGN = "http://evil.example", "null", "http://127.0.0.1:9"


@pytest.mark.parametrize("origin", [*FOREIGN, f"https://{ADDRESS}", f"http://{ADDRESS}.evil.example"])
def test_pages_from_elsewhere_are_refused(still: Site, origin: str) -> None:
    with pytest.raises(WebSocketDisconnect), still.talking(origin=origin):
        pass
    assert still.client.get(f"/{TOKEN}/", headers={"origin": origin}).status_code == 403


def test_the_socket_needs_the_token(still: Site) -> None:
    with (
        pytest.raises(WebSocketDisconnect),
        still.client.websocket_connect(
            "/wrong/socket", headers={"host": ADDRESS, "origin": f"http://{ADDRESS}"}
        ),
    ):
        pass


def test_a_page_gets_pictures_and_changes_the_text(site: Site) -> None:
    with site.talking(origin=f"http://{ADDRESS}") as page:
        first = page.preview()
        assert first["uri"] == site.file.as_uri()
        assert page.text() == {
            "version": 1,
            "text": TEXT,
            "saved": True,
            "contested": False,
            "undo": None,
            "redo": None,
        }
        attempt = page.answer("aidl/try", knobs={"width": 90})
        assert attempt["tried"]
        assert attempt["box"][2] == pytest.approx(45)
        assert site.file.read_text("utf-8") == TEXT
        assert page.preview()["box"][2] == pytest.approx(30)
        assert page.answer("aidl/setKnob", path="width", value=80) == {"applied": True}
        assert site.file.read_text("utf-8") == TEXT.replace("60mm", "80mm")
        assert page.text()["text"] == TEXT.replace("60mm", "80mm")
        after = page.told(CHANGED, version=2)
        assert after["handles"] or page.told(CHANGED, version=2)["handles"]


def test_a_save_before_the_files_are_watched_is_seen(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    may_watch = threading.Event()

    async def late(*told: Any) -> None:
        await asyncio.to_thread(may_watch.wait, 60)
        await watch(*told)

    monkeypatch.setattr("aidl_server.preview.site.watch", late)
    with serving(file) as client, talking(client, file) as page:
        assert page.preview()["version"] == 1
        file.write_text(TEXT.replace("60mm", "40mm"), "utf-8")
        may_watch.set()
        while page.told(CHANGED)["box"][2] != pytest.approx(20):  # half a file may be seen first
            pass


def test_fixes_are_applied_to_the_text_they_are_of(site: Site) -> None:
    lines = ("one = line((0, 0), (9, 0))", "two = line((9, 0), (5, 5))", "three = line((5, 5), (1, 2))")
    site.file.write_text(f"solid a {{ {'; '.join(lines)} }}\n", "utf-8")
    with site.talking() as page:
        made = page.preview()
        while not any(p["fixes"] for p in made["problems"]):
            made = page.preview()
        (index,) = [k for k, p in enumerate(made["problems"]) if p["code"] == "W0702"]
        of = {"version": made["version"], "problem": index}
        assert page.answer("aidl/fix", **of, fix=9) == {"applied": False, "reason": "there is no such fix"}
        assert page.answer("aidl/fix", **of, fix=0) == {"applied": True}
        page.told(CHANGED, version=made["version"] + 1)
        assert "constrain one.start == three.end" in site.file.read_text("utf-8")
        assert page.answer("aidl/fix", **of, fix=0)["error"]["message"] == "the text has changed"


def test_dragging_nowhere_is_refused(still: Site) -> None:
    with still.talking() as page:
        page.preview()
        for handle, to in (("a.body.top_right", (1e300, 0.0)), ("a.body", (float("nan"), 0.0)), ("", (1, 2))):
            assert page.answer("aidl/try", drag={"id": handle, "to": to})["error"]["message"]
            done = page.answer("aidl/drag", id=handle, to=to)
            assert "error" in done or done["reason"]
    assert still.file.read_text("utf-8") == TEXT


def test_noise_is_passed_over(still: Site) -> None:
    noise = ["", "null", "7", "{", "[]", "\0", "[" * 60_000, '{"a":' * 10_000]
    noise += ['{"id":1}', '{"method":"aidl/try"}', '{"id":true,"method":"x"}']
    noise += ['{"id":"1","method":"aidl/preview"}']
    with still.talking() as page:
        for text in noise:
            page.socket.send_text(text)
        assert page.preview()["status"] == "solved"


def test_hostile_questions_are_refused(still: Site) -> None:
    questions: list[tuple[str, dict[str, Any]]] = [
        ("aidl/preview", {"show": "names"}),
        ("aidl/preview", {"show": [1]}),
        ("aidl/preview", {"uri": "file:///etc/passwd"}),
        ("aidl/setKnob", {"path": "width"}),
        ("aidl/setKnob", {"path": "width", "value": None}),
        ("aidl/setKnob", {"path": "width", "value": {}}),
        ("aidl/setKnob", {"path": "width", "value": float("nan")}),
        ("aidl/setKnob", {"path": "width", "value": float("inf")}),
        ("aidl/setKnob", {"path": "width", "value": 10**4000}),
        ("aidl/setKnob", {"path": "a" * 20_000, "value": 1}),
        ("aidl/drag", {"id": "p", "to": [1]}),
        ("aidl/drag", {"id": "p", "to": [1, "2"]}),
        ("aidl/drag", {"id": "p", "to": [1, True]}),
        ("aidl/drag", {"id": "p", "to": [float("inf"), 1]}),
        ("aidl/fix", {"version": 1, "problem": "0", "fix": 0}),
        ("aidl/fix", {"problem": 0, "fix": 0}),
        ("aidl/export", {"format": "../../etc/passwd"}),
        ("aidl/previewClose", {}),
        ("textDocument/didChange", {}),
        ("workspace/executeCommand", {"command": "aidl.applyFixes"}),
        ("shutdown", {}),
    ]
    with still.talking() as page:
        for method, params in questions:
            assert page.answer(method, **params)["error"]["message"], (method, params)
        assert page.preview()["status"] == "solved"
    assert still.file.read_text("utf-8") == TEXT


def test_bytes_and_much_end_a_connection(still: Site) -> None:
    with still.talking() as page:
        page.socket.send_bytes(b"\xff")
        with pytest.raises(WebSocketDisconnect) as refused:
            page.told("never")
    assert refused.value.reason == "This page sent what is no text."
    with still.talking() as page:
        page.socket.send_text("x" * (LONGEST + 1))
        with pytest.raises(WebSocketDisconnect) as refused:
            page.told("never")
    assert refused.value.reason == "This page sent a message that is too long."
    with still.talking() as page:
        assert page.preview()


def test_only_so_many_pages(site: Site) -> None:
    open_pages = [site.talking() for _ in range(MOST_PAGES)]
    for each in open_pages:
        each.__enter__()
    with site.talking() as one_more, pytest.raises(WebSocketDisconnect) as refused:
        one_more.told("never")
    assert refused.value.reason == f"{MOST_PAGES} pages show this program already: close one of them."
    open_pages[0].__exit__(None, None, None)
    with site.talking() as page:
        assert page.preview()
    for each in open_pages[1:]:
        each.__exit__(None, None, None)


def test_a_page_that_asks_for_too_much_is_told_and_holds_up_no_other(site: Site) -> None:
    with site.talking() as flood, site.talking() as page:
        asked = [flood.ask("aidl/export", format="png") for _ in range(4 * MOST_ORDERS)]  # takes long enough
        assert page.answer("aidl/try", knobs={"width": 50})["box"][2] == pytest.approx(25)
        assert page.answer("aidl/export", format="dxf")["name"] == "part.dxf"
        assert flood.answered(asked[0])["name"] == "part.png"
        assert "more than can be done at once" in str(_said(flood))
    with site.talking() as page:
        assert page.preview()


def _said(flood: Talk) -> list[dict[str, Any]]:
    """What a page has heard and hears until it is told of too much."""
    while not any("more than can be done at once" in str(each) for each in flood.heard):
        flood.heard.append(flood._next())
    return flood.heard


def test_what_is_no_text_leaves_the_picture(site: Site) -> None:
    with site.talking() as page:
        before = page.preview()
        site.file.write_bytes(b"\xff\xfe\x00")
        while "UTF-8" not in page.told(_ERROR)["message"]:
            pass
        assert page.preview()["svg"] == before["svg"]
