"""The host in the worker, in this Python: what it tells the page of a program."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from aidl_web.inside import hosting, platform

PLATE = "solid plate {\n    param width = 80 in 40..160\n    body = rectangle(width: width, height: 40)\n}\n"
Json = dict[str, Any]


class Page:
    """What stands for the page: keeps what it is told, and asks."""

    def __init__(self) -> None:
        self.messages: list[Json] = []
        self.kept: list[tuple[str, str]] = []
        self.uris: list[str] = []
        self.wanted = 0
        self.desk: hosting.Desk

    def opened(self, uri: str) -> None:
        self.uris.append(uri)

    def say(self, message: str) -> None:
        self.messages.append(json.loads(message))

    def keep(self, name: str, text: str) -> None:
        self.kept.append((name, text))

    async def scipy(self) -> None:
        self.wanted += 1

    def ask(self, number: int, method: str, **params: Any) -> None:
        given = {"uri": self.uris[-1], **params}
        self.desk.hear(json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": given}))

    async def answer(self, number: int) -> Json:
        return await self.found(lambda each: each.get("id") == number)

    async def found(self, is_meant: Callable[[Json], bool]) -> Json:
        for _ in range(3000):
            for message in self.messages:
                if is_meant(message):
                    return message
            await asyncio.sleep(0.01)
        raise AssertionError("it did not come")


Work = Callable[[Page], Awaitable[None]]
Play = Callable[[Work], None]


@pytest.fixture
def play(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Play:
    """Has work done with a page."""
    monkeypatch.setattr(hosting, "FOLDER", tmp_path / "programs")
    monkeypatch.setattr(hosting, "make_room", lambda: None)

    async def run(work: Work) -> None:
        page = Page()
        page.desk = hosting.Desk(page)
        try:
            await work(page)
        finally:
            page.desk.close()

    return lambda work: asyncio.run(run(work))


def test_what_is_typed_is_kept_at_once(play: Play) -> None:
    async def work(page: Page) -> None:
        await page.desk.open("plate.aidl", PLATE, {})
        page.ask(1, "aidl/preview", show=[])
        assert "<svg" in (await page.answer(1))["result"]["svg"]
        place = {"line": 1, "character": 18}
        change = {"start": place, "end": {**place, "character": 20}, "text": "90"}
        page.ask(2, "aidl/type", version=1, changes=[change])
        assert (await page.answer(2))["result"]["applied"]
        assert page.kept[-1] == ("plate.aidl", PLATE.replace("80", "90"))
        told = await page.found(
            lambda each: each.get("method") == "aidl/text" and each["params"]["version"] == 2
        )
        assert told["params"]["saved"]
        page.ask(3, "aidl/setKnob", path="width", value=100)
        assert (await page.answer(3))["result"] == {"applied": True}
        assert "width = 100 in" in page.kept[-1][1]
        page.ask(4, "aidl/undo")
        assert (await page.answer(4))["result"]["applied"]
        assert "width = 90 in" in page.kept[-1][1]

    play(work)


def test_another_program_takes_the_place(play: Play) -> None:
    async def work(page: Page) -> None:
        rim = b"solid rim(size = 5) { edge = circle(radius: size) }\n"
        await page.desk.open("plate.aidl", PLATE, {})
        hook = 'import "rim.aidl"\nassembly hook { a = rim(size: 7) }\n'
        await page.desk.open("../hook.aidl", hook, {"x/rim.aidl": rim})
        assert page.uris[-1].endswith("/programs/hook.aidl")
        page.ask(1, "aidl/preview", show=[])
        shown = (await page.answer(1))["result"]
        assert (shown["uri"], shown["status"]) == (page.uris[-1], "solved")
        assert not any(each.get("method") == "exit" for each in page.messages)

    play(work)


def test_a_program_that_was_stopped_runs_once_it_is_changed(play: Play) -> None:
    async def work(page: Page) -> None:
        await page.desk.open("plate.aidl", PLATE, {}, True)
        page.ask(1, "aidl/preview", show=[])
        blank = (await page.answer(1))["result"]
        assert (blank["svg"], blank["status"]) == (None, "Stopped")
        page.ask(2, "aidl/export", format="svg")
        assert (await page.answer(2))["error"]["message"] == "this was stopped"
        place = {"line": 4, "character": 0}
        page.ask(3, "aidl/type", version=1, changes=[{"start": place, "end": place, "text": "\n"}])
        shown = await page.found(lambda each: each.get("method") == "aidl/previewChanged")
        assert "<svg" in shown["params"]["svg"]

    play(work)


def test_a_large_program_has_scipy_fetched_once(play: Play) -> None:
    async def work(page: Page) -> None:
        await page.desk.open("plate.aidl", PLATE, {})
        page.ask(1, "aidl/preview", show=[])
        await page.answer(1)
        host = page.desk.host
        assert host is not None
        for _ in range(2):
            host.server.crashed(ModuleNotFoundError("no scipy", name="scipy.sparse"))
        told = await page.found(lambda each: each.get("method") == "window/showMessage")
        assert "ModuleNotFoundError" in told["params"]["message"]
        assert page.wanted == 1

    play(work)


def test_turns_do_work_one_after_the_other() -> None:
    async def run() -> None:
        told: list[object] = []
        platform.Turns.busy = told.append
        turns = platform.Turns(max_workers=1)
        first, second, third = (
            turns.submit(work) for work in (lambda: told.append("a"), lambda: 1 // 0, int)
        )
        assert told == []
        third.cancel()
        assert await asyncio.wrap_future(first) is None
        with pytest.raises(ZeroDivisionError):
            await asyncio.wrap_future(second)
        assert told == [True, "a", False, True, False]
        last = turns.submit(int)
        turns.shutdown(cancel_futures=True)
        assert last.cancelled()
        with pytest.raises(RuntimeError, match="after shutdown"):
            turns.submit(int)

    asyncio.run(run())
