"""Running a plan: threads wait for the model, processes compile, and the main thread alone writes."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from dataclasses import asdict, dataclass, field

from aidl_eval import measures, store
from aidl_eval.plan import Job, Plan
from aidl_eval.recordings import Replay
from aidl_eval.store import Record, Store
from aidl_eval.worker import SECONDS, Broken, Remote, Worker
from aidl_lang import Diagnostic
from aidl_lang.tools.llm.generation import Task, generate
from aidl_lang.tools.llm.messages import Provider

PATIENCE = 5
"""Consecutive failures to reach the model after which no more requests are made."""


@dataclass(frozen=True)
class Done:
    """A finished job, with its number of how many."""

    job: Job
    record: Record
    number: int
    count: int
    failure: Diagnostic | None = None


@dataclass(frozen=True)
class RunSummary:
    """Counts of a run. `left` jobs were not begun, or failed to reach the model."""

    done: int
    kept: int
    left: int
    failure: Diagnostic | None


@dataclass(frozen=True)
class _Result:
    job: Job
    record: Record
    png: bytes | None = None
    neutral: bytes | None = None
    failure: Diagnostic | None = None
    bug: BaseException | None = None


@dataclass
class _Crew:
    """The data that threads share."""

    plan: Plan
    provider: Provider | Replay | None
    waiting: queue.SimpleQueue[tuple[Job, Record | None]] = field(default_factory=queue.SimpleQueue)
    results: queue.SimpleQueue[_Result] = field(default_factory=queue.SimpleQueue)
    is_over: threading.Event = field(default_factory=threading.Event)


def run(
    plan: Plan,
    provider: Provider | Replay | None,
    kept: Store,
    threads: int = 4,
    seconds: float = SECONDS,
    listen: Callable[[Done], None] = lambda done: None,
) -> RunSummary:
    """Does the open jobs of a plan. Without a provider only outdated measures are taken again.

    An interrupt leaves everything that was finished.
    """
    todo = list(_to_do(plan, kept, may_ask=provider is not None))
    crew = _Crew(plan, provider)
    for item in todo:
        crew.waiting.put(item)
    workers = [Worker(seconds) for _ in range(min(threads, len(todo)))]
    try:
        for worker in workers:
            threading.Thread(target=_serve, args=(crew, worker), daemon=True).start()
        done, failure = _gather(crew, kept, len(todo), listen)
    finally:
        crew.is_over.set()
        for worker in workers:
            worker.stop()
    return RunSummary(done, sum(1 for _ in plan.jobs()) - len(todo), len(todo) - done, failure)


def _to_do(plan: Plan, kept: Store, may_ask: bool) -> Iterator[tuple[Job, Record | None]]:
    """Yields jobs without a complete record, with the conversation if only measures are missing."""
    for job in plan.jobs():
        record = kept.record(job)
        if record is None or "failure" in record:
            if may_ask:
                yield job, None
        elif record["ok"] and record.get("measured") != store.measured_with(plan.prompt(job)):
            yield job, record


def _gather(
    crew: _Crew, kept: Store, count: int, listen: Callable[[Done], None]
) -> tuple[int, Diagnostic | None]:
    done = number = in_a_row = 0
    last: Diagnostic | None = None
    while number < count and in_a_row < PATIENCE:
        result = crew.results.get()
        number += 1
        if result.bug is not None:
            raise result.bug
        kept.keep(result.job, result.record, result.png, result.neutral)
        if result.failure is None:
            done, in_a_row = done + 1, 0
        else:
            in_a_row, last = in_a_row + 1, result.failure
        listen(Done(result.job, result.record, number, count, result.failure))
    return done, last


def _serve(crew: _Crew, worker: Worker) -> None:
    """Takes jobs until there are none left."""
    while not crew.is_over.is_set():
        try:
            job, record = crew.waiting.get_nowait()
        except queue.Empty:
            return
        try:
            crew.results.put(_worked(crew, worker, job, record))
        except CancelledError:
            return  # the worker was stopped
        except BaseException as bug:  # noqa: BLE001 (raised again by the main thread)
            crew.results.put(_Result(job, {}, bug=bug))
            return


def _worked(crew: _Crew, worker: Worker, job: Job, record: Record | None) -> _Result:
    prompt = crew.plan.prompt(job)
    if record is None:
        assert crew.provider is not None
        language = Remote(crew.plan.language(job.variant), worker)
        task, settings = Task(prompt.text), crew.plan.sampled(job)
        provider = crew.provider.of(job) if isinstance(crew.provider, Replay) else crew.provider
        generation = generate(task, provider, language, settings)
        if generation.failure is not None:
            return _Result(job, store.failed(job, generation.failure), failure=generation.failure)
        record = store.recorded(job, prompt, generation)
    if not record["ok"]:
        return _Result(job, record)
    measured = {**record, "measured": store.measured_with(prompt), "unmeasured": {}}
    png = neutral = None
    try:
        drawn = worker.call(measures.draw, job.variant, record["program"], prompt)
        png, neutral = drawn.png, drawn.neutral
        measured["numbers"] = dict(drawn.numbers)
        measured["requirements"] = [asdict(result) for result in drawn.requirements]
    except Broken as reason:
        measured["unmeasured"]["drawing"] = str(reason)
    try:
        edits = worker.call(measures.edit, job.variant, record["program"], prompt)
        measured["edits"] = asdict(edits)
    except Broken as reason:
        measured["unmeasured"]["editability"] = str(reason)
    return _Result(job, measured, png, neutral)
