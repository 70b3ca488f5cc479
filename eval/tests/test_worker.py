"""A program that hangs, dies or eats memory is a verdict, and the conversation goes on without it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from aidl_eval.worker import Broken, Remote, Worker
from eval.tests.fakes import Fake, obey


@pytest.fixture(scope="module")
def worker() -> Iterator[Worker]:
    worker = Worker(seconds=60.0)
    yield worker
    worker.stop()


@pytest.mark.parametrize(
    ("program", "reason"),
    [
        ("hang", "it took longer than 0.1 s"),
        ("die", "the process that ran it came to an end"),
        ("raise", "it ended in RuntimeError: no such luck"),
        ("eat", "it took more than 4 GB of memory"),
    ],
)
def test_a_broken_task_says_why_and_the_next_one_runs(
    worker: Worker, program: str, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if program == "hang":
        monkeypatch.setattr(worker, "_seconds", 0.1)
    with pytest.raises(Broken, match=f"^{reason}$"):
        worker.call(obey, program)
    monkeypatch.undo()
    assert worker.call(obey, "well")


def test_a_conversation_survives_what_breaks_its_process(worker: Worker) -> None:
    conversation = Remote.of(Fake(), worker).conversation("before")
    assert conversation.judge("one").missing == ("before", "one")
    broken = conversation.judge("die")
    assert (broken.ok, broken.stage, broken.codes) == (False, "broken", ("broken",))
    assert "the process that ran it came to an end" in broken.feedback
    second = conversation.judge("two")
    assert second.missing == ("before", "one", "two")
    assert broken.weight > second.weight
    assert conversation.finish(second).missing == ("before", "one", "two")
    assert conversation.finish(broken) is broken


def test_conversations_do_not_hear_each_other(worker: Worker) -> None:
    remote = Remote.of(Fake(), worker)
    first, second = remote.conversation(), remote.conversation()
    first.judge("one")
    second.judge("other")
    assert first.judge("two").missing == ("one", "two")
    assert second.judge("last").missing == ("other", "last")
    assert not remote.reads("raise")
