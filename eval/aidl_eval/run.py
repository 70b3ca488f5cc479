"""Running a plan: threads wait for the model, processes compile, and the main thread alone writes."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime

from aidl_eval import measures, store
from aidl_eval.plan import Job, Plan
from aidl_eval.store import Record, Store
from aidl_eval.worker import Broken, Remote, Worker
from aidl_lang import Diagnostic
from aidl_lang.tools.llm.generation import Task, generate
from aidl_lang.tools.llm.messages import Message, Provider, Reply, Sampling

Ask = Callable[[Job], Provider]
PATIENCE = 5
"""Consecutive failures to reach the model after which no more requests are made."""


@dataclass(frozen=True)
class Done:
    """A finished job with its picture; `failure` tells why the conversation broke off, if it did."""

    job: Job
    record: Record
    png: bytes | None = None
    failure: Diagnostic | None = None


@dataclass(frozen=True)
class Timed:
    """A provider whose replies carry their seconds and their day (UTC). Repeats and pauses count."""

    provider: Provider
    name: str
    takes_seeds: bool
    takes_grammars: bool

    @classmethod
    def of(cls, provider: Provider) -> Timed:
        return cls(provider, provider.name, provider.takes_seeds, provider.takes_grammars)

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        begun = time.monotonic()
        reply = self.provider.reply(messages, sampling, hear)
        today = datetime.now(UTC).date().isoformat()
        return replace(reply, seconds=round(time.monotonic() - begun, 3), date=today)


def run(
    plan: Plan,
    ask: Ask | None,
    kept: Store,
    threads: int,
    seconds: float,
    listen: Callable[[Done, int, int], None],
) -> tuple[int, Diagnostic | None]:
    """Does the open jobs of a plan, each with the provider that `ask` gives; without it only outdated
    measures are taken again. `listen` is told of each, with its number of how many. Returns how many were not
    begun, or failed to reach the model, and why the last of these did.

    An interrupt leaves everything that was finished.
    """
    todo = list(_to_do(plan, kept, may_ask=ask is not None))
    waiting = queue.SimpleQueue[tuple[Job, Record | None]]()
    results = queue.SimpleQueue[Done | BaseException]()
    is_over = threading.Event()
    for item in todo:
        waiting.put(item)

    def serve(worker: Worker) -> None:
        """Takes jobs until there are none left, or the worker is stopped."""
        try:
            while not is_over.is_set():
                results.put(_worked(plan, ask, worker, *waiting.get_nowait()))
        except (queue.Empty, CancelledError):
            return
        except BaseException as bug:  # noqa: BLE001 (raised again by the main thread)
            results.put(bug)

    workers = [Worker(seconds) for _ in range(min(threads, len(todo)))]
    left, in_a_row, last = len(todo), 0, None
    try:
        for worker in workers:
            threading.Thread(target=serve, args=(worker,), daemon=True).start()
        for number in range(1, len(todo) + 1):
            done = results.get()
            if isinstance(done, BaseException):
                raise done
            kept.keep(done.job, done.record, done.png)
            if done.failure is None:
                left, in_a_row = left - 1, 0
            else:
                in_a_row, last = in_a_row + 1, done.failure
            listen(done, number, len(todo))
            if in_a_row == PATIENCE:
                break
    finally:
        is_over.set()
        for worker in workers:
            worker.stop()
    return left, last


def _to_do(plan: Plan, kept: Store, may_ask: bool) -> Iterator[tuple[Job, Record | None]]:
    """Yields jobs without a complete record, with the conversation if only measures are missing."""
    for job in plan.jobs:
        record = kept.record(job)
        if record is None or "failure" in record:
            if may_ask:
                yield job, None
        elif record["ok"] and record.get("measured") != store.measured_with(plan.prompt(job)):
            yield job, record


def _worked(plan: Plan, ask: Ask | None, worker: Worker, job: Job, record: Record | None) -> Done:
    prompt = plan.prompt(job)
    if record is None:
        assert ask is not None
        language = Remote.of(plan.language(job.variant), worker)
        generation = generate(Task(prompt.text), ask(job), language, plan.sampled(job))
        if generation.failure is not None:
            return Done(job, store.failed(job, generation.failure), failure=generation.failure)
        record = store.recorded(job, prompt, generation)
    if not record["ok"]:
        return Done(job, record)
    measured = {**record, "measured": store.measured_with(prompt), "unmeasured": {}}
    png = None
    try:
        png, found = worker.call(measures.draw, job.variant, record["program"], prompt)
        measured |= found
    except Broken as reason:
        measured["unmeasured"]["drawing"] = str(reason)
    try:
        edits = worker.call(measures.edit, job.variant, record["program"], prompt)
        measured["edits"] = asdict(edits)
    except Broken as reason:
        measured["unmeasured"]["editability"] = str(reason)
    return Done(job, measured, png)
