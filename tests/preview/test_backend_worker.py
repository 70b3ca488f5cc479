"""What the worker does first, what it gives up, and what it leaves out."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from functools import partial

from aidl_lang.cancelling import Cancelled, checkpoint
from aidl_lang.preview.worker import Job, Worker

PATIENCE = 20.0


class Log:
    """What was done, in order, and jobs that write it."""

    def __init__(self) -> None:
        self.done: list[str] = []
        self.started, self.released = threading.Event(), threading.Event()

    def job(self, name: str, *, waits: bool = False, fails: BaseException | None = None) -> Job:
        def do() -> Callable[[], None]:
            if waits:
                self.started.set()
                while not self.released.wait(0.001):
                    checkpoint()
            if fails is not None:
                raise fails
            return partial(self.done.append, name)

        return Job(do, partial(self.done.append, f"busy {name}"), self._failed(name))

    def _failed(self, name: str) -> Callable[[BaseException], None]:
        return lambda error: self.done.append(f"{name}: {type(error).__name__}")

    async def until(self, *names: str) -> None:
        async with asyncio.timeout(PATIENCE):
            while not set(names) <= set(self.done):
                await asyncio.sleep(0.001)

    async def until_started(self) -> None:
        assert await asyncio.to_thread(self.started.wait, PATIENCE)


def working(test: Callable[[Log, Worker], object]) -> list[str]:
    """What was done while a test had a worker."""
    log = Log()

    async def run() -> None:
        worker = Worker(log.job("text"))
        task = asyncio.create_task(worker.run())
        try:
            await test(log, worker)
        finally:
            log.released.set()
            task.cancel()
            await asyncio.wait([task])

    asyncio.run(run())
    return log.done


def test_of_attempts_only_the_newest_of_each_page_is_carried_out() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.attempt("a", log.job("first", waits=True))
        await log.until_started()
        for number in range(9):
            worker.attempt("a", log.job(f"a{number}"))
            worker.attempt("b", log.job(f"b{number}"))
        log.released.set()
        await log.until("a8", "b8")

    assert [name for name in working(test) if not name.startswith("busy")] == ["first", "a8", "b8"]


def test_a_new_text_gives_up_what_runs() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.order(log.job("order", waits=True))
        await log.until_started()
        worker.refresh()
        await log.until("text")

    assert [name for name in working(test) if not name.startswith("busy")] == ["order: Cancelled", "text"]


def test_an_order_outdoes_an_attempt_but_no_order() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.attempt("a", log.job("attempt", waits=True))
        await log.until_started()
        log.started.clear()
        worker.order(log.job("one", waits=True))
        await log.until_started()
        worker.attempt("a", log.job("late"))
        worker.order(log.job("two"))
        worker.ask()
        log.released.set()
        await log.until("late", "text")

    found = [name for name in working(test) if not name.startswith("busy")]
    assert found == ["attempt: Cancelled", "one", "two", "text", "late"]


def test_what_nobody_waits_for_gives_way_and_comes_back() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.later(log.job("idle", waits=True))
        await log.until_started()
        worker.attempt("a", log.job("attempt"))
        await log.until("attempt")
        log.released.set()
        await log.until("idle")

    assert [name for name in working(test) if not name.startswith("busy")] == ["attempt", "idle"]


def test_a_failure_is_told_and_the_rest_goes_on() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.order(log.job("bad", fails=ZeroDivisionError()))
        worker.order(log.job("given up", fails=Cancelled()))
        worker.order(log.job("good"))
        await log.until("good")

    assert working(test) == ["bad: ZeroDivisionError", "given up: Cancelled", "good"]


def test_what_takes_long_is_told() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.order(log.job("slow", waits=True))
        await log.until("busy slow")

    assert working(test) == ["busy slow"]


def test_an_end_gives_up_what_runs() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.order(log.job("endless", waits=True))
        await log.until_started()

    before = threading.active_count()
    working(test)
    for thread in threading.enumerate():
        if thread.name.startswith("preview"):
            thread.join(PATIENCE)
    assert threading.active_count() <= before
