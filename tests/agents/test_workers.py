"""What programs cannot do to the process that serves them."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from aidl_lang.common.processes import MEMORY
from aidl_lang.common.records import record
from aidl_lang.tools.agents.calling import Workers
from aidl_lang.tools.agents.results import Page
from aidl_lang.tools.agents.tools import Tools


@record()
class Broken(Tools):
    """Fails in the ways that a program might."""

    def explain(self, name: str) -> Page:
        match name:
            case "hang":
                time.sleep(600)
            case _ if name.startswith("/"):  # tells by a file that it has begun
                Path(name).touch()
                time.sleep(600)
            case "end":
                os._exit(3)
            case "devour":
                bytearray(2 * MEMORY)
        return Page(name, name, text=name)


@pytest.fixture
def workers() -> Iterator[Workers]:
    made = Workers(Broken(), seconds=15.0)
    yield made
    made.close()


def test_calls_that_break_are_given_up_and_others_answered(workers: Workers) -> None:
    workers.seconds = 0.5
    hang = asyncio.run(workers.answer("explain", {"name": "hang"}))
    assert hang.text == (
        "error E0943: the call took longer than 0.5 s and was given up\n"
        "  hint: ask for less: fewer parts, smaller arrays, no outlines worked out of many others"
    )
    workers.seconds = 60.0
    end, fine = asyncio.run(_both(workers, "end", "fine"))
    assert end.startswith("error E0943: the call ended the process that worked on it and was given up")
    assert fine == "fine"
    devour, fine = asyncio.run(_both(workers, "devour", "fine"))
    assert devour.startswith("error E0943: the call needs more memory than there is for it and was given up")
    assert fine == "fine"


async def _both(workers: Workers, *names: str) -> list[str]:
    made = await asyncio.gather(*(workers.answer("explain", {"name": name}) for name in names))
    assert [m.is_error for m in made] == [name != "fine" for name in names]
    return [m.text for m in made]


def test_call_that_is_cancelled_ends_its_process(workers: Workers, tmp_path: Path) -> None:
    """One that hangs leaves a process for others; but two would leave none for the third."""
    workers.seconds = 600.0

    async def cancelled() -> None:
        calls = []
        for name in "ab":
            fine = await asyncio.wait_for(workers.answer("explain", {"name": "fine"}), 60.0)
            assert fine.text == "fine"
            begun = tmp_path / name
            calls.append(asyncio.create_task(workers.answer("explain", {"name": str(begun)})))
            while not begun.exists():
                await asyncio.sleep(0.02)
        for call in calls:
            call.cancel()
        fine = await asyncio.wait_for(workers.answer("explain", {"name": "fine"}), 60.0)
        assert fine.text == "fine"

    asyncio.run(cancelled())
