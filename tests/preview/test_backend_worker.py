"""What the worker does first, what it gives up, and what it leaves out."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from functools import partial

from aidl_lang.common.cancelling import Cancelled, checkpoint
from aidl_lang.tools.preview.worker import MOST_ORDERS, Job, Worker

PATIENCE = 20.0


class Log:
    """What was done, in order, and jobs that write it."""

    def __init__(self) -> None:
        self.done: list[str] = []
        self.started, self.released = threading.Event(), threading.Event()

    def job(
        self, name: str, *, waits: bool = False, fails: BaseException | None = None, lasts: bool = False
    ) -> Job:
        def do() -> Callable[[], None]:
            if waits:
                self.started.set()
                while not self.released.wait(0.001):
                    checkpoint()
            if fails is not None:
                raise fails
            return partial(self.done.append, name)

        return Job(do, partial(self.done.append, f"busy {name}"), self._failed(name), lasts)

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
        worker.order("a", log.job("order", waits=True))
        await log.until_started()
        worker.refresh()
        await log.until("text")

    assert [name for name in working(test) if not name.startswith("busy")] == ["order: Cancelled", "text"]


def test_an_attempt_that_a_new_text_gives_up_is_made_again() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.attempt("a", log.job("attempt", waits=True))
        await log.until_started()
        worker.refresh()
        await log.until("text")
        log.released.set()
        await log.until("attempt")

    assert done(working(test)) == ["text", "attempt"]


def test_an_order_outdoes_an_attempt_but_no_order() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.attempt("a", log.job("attempt", waits=True))
        await log.until_started()
        log.started.clear()
        worker.order("a", log.job("one", waits=True))
        await log.until_started()
        worker.attempt("a", log.job("late"))
        worker.order("a", log.job("two"))
        worker.ask("a")
        log.released.set()
        await log.until("late", "text")

    found = [name for name in working(test) if not name.startswith("busy")]
    assert found == ["attempt: Cancelled", "one", "two", "text", "late"]


def done(found: list[str]) -> list[str]:
    """Without what was told of waiting."""
    return [name for name in found if not name.startswith("busy")]


def test_pages_have_turns() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.order("a", log.job("first", waits=True))
        await log.until_started()
        for number in range(4):
            worker.order("a", log.job(f"a{number}"))
        worker.order("b", log.job("b0"))
        worker.order("b", log.job("b1"))
        worker.attempt("c", log.job("c"))
        worker.ask("d")
        log.released.set()
        await log.until("a3", "b1", "c", "text")

    assert done(working(test)) == ["first", "a0", "b0", "c", "text", "a1", "b1", "a2", "a3"]


def test_who_goes_on_ordering_holds_up_nobody() -> None:
    async def test(log: Log, worker: Worker) -> None:
        def again(name: str) -> Job:
            return Job(lambda: lambda: more(name), lambda: None, lambda error: None)

        def more(name: str) -> None:
            log.done.append(name)
            worker.order("a", again(name))
            worker.ask("a")

        worker.order("a", again("flood"))
        await log.until("flood")
        for name in ("attempt", "order"):
            (worker.attempt if name == "attempt" else worker.order)("b", log.job(name))
            await log.until(name)
        worker.later(log.job("never"))

    found = working(test)
    assert "never" not in found
    assert 0 < found.index("attempt") < found.index("order")


def test_an_attempt_goes_on_whatever_other_pages_want() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.attempt("a", log.job("attempt", waits=True))
        await log.until_started()
        worker.order("b", log.job("order"))
        worker.ask("b")
        log.released.set()
        await log.until("text")

    assert done(working(test)) == ["attempt", "order", "text"]


def test_only_so_many_orders_wait_for_a_page() -> None:
    taken: list[bool] = []

    async def test(log: Log, worker: Worker) -> None:
        worker.order("a", log.job("first", waits=True))
        await log.until_started()
        taken.extend(worker.order("a", log.job(str(number))) for number in range(MOST_ORDERS + 2))
        taken.append(worker.order("b", log.job("other")))
        log.released.set()
        await log.until(str(MOST_ORDERS - 1), "other")

    found = done(working(test))
    assert taken == [True] * MOST_ORDERS + [False, False, True]
    assert set(found) == {"first", "other", *map(str, range(MOST_ORDERS))}


def test_of_a_page_that_went_what_is_to_last_is_done() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.order("a", log.job("first", waits=True))
        await log.until_started()
        for page in range(MOST_ORDERS + 3):
            worker.order(page, log.job(f"export {page}"))
            worker.order(page, log.job(f"edit {page}", lasts=True))
            worker.attempt(page, log.job(f"attempt {page}"))
            worker.leave(page)
        worker.order("b", log.job("other"))
        worker.later(log.job("all"))
        log.released.set()
        await log.until("all")

    edits = [f"edit {page}" for page in range(MOST_ORDERS)]
    assert done(working(test)) == ["first", edits[0], "other", *edits[1:], "all"]


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
        worker.order("a", log.job("bad", fails=ZeroDivisionError()))
        worker.order("a", log.job("given up", fails=Cancelled()))
        worker.order("a", log.job("good"))
        await log.until("good")

    assert working(test) == ["bad: ZeroDivisionError", "given up: Cancelled", "good"]


def test_what_takes_long_is_told() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.order("a", log.job("slow", waits=True))
        await log.until("busy slow")

    assert working(test) == ["busy slow"]


def test_an_end_gives_up_what_runs() -> None:
    async def test(log: Log, worker: Worker) -> None:
        worker.order("a", log.job("endless", waits=True))
        await log.until_started()

    before = threading.active_count()
    working(test)
    for thread in threading.enumerate():
        if thread.name.startswith("preview"):
            thread.join(PATIENCE)
    assert threading.active_count() <= before
