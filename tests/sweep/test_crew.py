"""Calls on an engine: one that hangs, dies or eats memory takes nothing along, and bad luck is made good
once.
"""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from concurrent.futures import Future
from pathlib import Path

import pytest

from aidl_lang.common.processes import Broke, Crew, Guarded, Limit


def obey(word: str, folder: str) -> str:
    with open(Path(folder, word), "a") as file:
        file.write("x")
    times = len(Path(folder, word).read_text())
    if word == "hang":
        time.sleep(60)
    if word == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if word == "raise":
        raise ValueError("no such luck")
    return f"{word} {times}"


@pytest.fixture(scope="module")
def engine() -> Iterator[Guarded]:
    engine = Guarded(2, "aidl_lang.common.processes")
    yield engine
    engine.close()


def test_what_is_given_up_ends(engine: Guarded, tmp_path: Path) -> None:
    crew: Crew[str, str] = Crew(engine)
    assert crew.has_room
    for k in range(4):
        crew.give(f"hang{k}", 60.0, obey, "hang", str(tmp_path))
    assert not crew.has_room
    crew.cancel()
    crew.give("after", 30.0, obey, "after", str(tmp_path))
    assert dict(crew.came(20)) == {"after": "after 1"}


class Deaf:
    """An engine that never answers."""

    places = 2

    def submit(self, seconds: float, task: object, *arguments: object) -> Future[str]:
        return Future()

    def close(self) -> None:
        pass


def test_what_is_never_answered_is_begun_again_and_given_up() -> None:
    crew: Crew[int, str] = Crew(Deaf())
    for k in range(3):
        crew.give(k, 0.02, str)
    found: dict[int, str | Broke] = {}
    while crew:
        found |= dict(crew.came())
    limits = [each.limit for each in found.values() if isinstance(each, Broke)]
    assert limits == [Limit.TIME] * 3
    assert crew.given_again == 9
