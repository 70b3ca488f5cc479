"""What pages are given their turns for, and what is left out; the server is one that a test answers for."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import pytest

from aidl_server.preview.host import MOST_ORDERS, MOST_UNTAKEN, Host, Page

_numbers = itertools.count(1)


class Desk(Host):
    """A host whose server answers when it is told to."""

    def __init__(self) -> None:
        super().__init__(Path("/none.aidl"), lambda path, data: None)
        self.received: list[dict[str, Any]] = []

    def _receive(self, message: dict[str, Any]) -> None:
        self.received.append(message)

    def ask(self, page: Page, method: str, name: str = "") -> int:
        number = next(_numbers)
        self.hear(page, json.dumps({"id": number, "method": method, "params": {"name": name}}))
        return number

    @property
    def asked(self) -> list[str]:
        """What the server was asked, by the names that the tests gave."""
        return [m["params"]["name"] for m in self.received if "name" in m["params"]]

    def answer(self, name: str) -> None:
        number = next(m["id"] for m in self.received if m["params"].get("name") == name)
        self._heard({"jsonrpc": "2.0", "id": number, "result": name})


@pytest.fixture
def desk() -> Desk:
    return Desk()


def said(page: Page) -> list[dict[str, Any]]:
    return [json.loads(text) for _, text in page._waiting]


def test_of_attempts_only_the_newest_of_each_page_is_made(desk: Desk) -> None:
    a, b = desk.join(), desk.join()
    desk.ask(a, "aidl/try", "first")
    left_out = [desk.ask(a, "aidl/try", f"a{number}") for number in range(5)]
    desk.ask(b, "aidl/try", "b0")
    assert desk.asked == ["first", "b0"]
    desk.answer("first")
    assert desk.asked == ["first", "b0", "a4"]
    codes = {m["id"]: m["error"]["code"] for m in said(a) if "error" in m}
    assert codes == dict.fromkeys(left_out[:-1], -32800)


def test_a_page_cannot_speak_for_another(desk: Desk) -> None:
    a, b = desk.join(), desk.join()
    desk.hear(a, json.dumps({"id": 1, "method": "aidl/preview", "params": {"viewer": b.name}}))
    assert [m["params"]["viewer"] for m in desk.received] == [a.name]


def test_a_page_that_takes_nothing_is_not_heard(desk: Desk) -> None:
    page = desk.join()
    for number in range(MOST_UNTAKEN - 1):
        page.tell(str(number))
        page.post({"method": "aidl/busy"})
    assert page.is_behind
    for _ in range(100):
        desk.ask(page, "aidl/setKnob", "knob")
    messages = said(page)
    assert len(messages) == MOST_UNTAKEN + 1
    assert "more than can be done at once" in messages[-1]["params"]["message"]
    assert desk.asked == []


def test_of_a_page_that_went_the_edits_are_carried_out(desk: Desk) -> None:
    for number in range(MOST_ORDERS + 3):
        page = desk.join()
        desk.ask(page, "aidl/export", f"running{number}")
        desk.ask(page, "aidl/export", f"export{number}")
        desk.ask(page, "aidl/setKnob", f"edit{number}")
        desk.ask(page, "aidl/try", f"attempt{number}")
        desk.ask(page, "aidl/try", f"late{number}")
        desk.leave(page)
        desk.answer(f"attempt{number}")
    edits = [f"edit{number}" for number in range(MOST_ORDERS + 1)]
    for name in edits:
        desk.answer(name)
    asked = [name for name in desk.asked if name.startswith(("edit", "export", "late"))]
    assert asked == edits
    assert desk.pages == []
