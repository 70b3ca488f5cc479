"""A sweep from its plan to its outputs: runs it, writes drawings as they come and tables at the end, and
keeps what is done so that it can go on.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import field, replace
from pathlib import Path

from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.processes import Engine
from aidl_lang.common.records import record
from aidl_lang.tools.sweeping import keeping
from aidl_lang.tools.sweeping.bundle import Bundle, Gathering
from aidl_lang.tools.sweeping.faults import fault
from aidl_lang.tools.sweeping.keeping import Store
from aidl_lang.tools.sweeping.outputs import Drawings, Outputs, write
from aidl_lang.tools.sweeping.plan import Plan, Variant
from aidl_lang.tools.sweeping.rows import Columns, Row, in_order
from aidl_lang.tools.sweeping.running import Done, Run
from aidl_lang.tools.sweeping.tables import TABLES
from aidl_lang.tools.sweeping.working import Making

PICTURE = 320
"""Pixels of a picture on a contact sheet."""


@record()
class Job:
    """A sweep to be done.

    command   returns the words that make a drawing of a variant alone, under a name
    cache     the folder of outcomes that stays; "" for none
    seconds   that a variant may take; None for what a compile may
    resumes   whether what an earlier run has done is taken
    """

    plan: Plan
    bundle: Bundle
    world: Gathering
    making: Making
    outputs: Outputs = Outputs()
    command: Callable[[Variant, str], str] = lambda variant, name: ""
    cache: str = ""
    cache_size: int = keeping.SIZE
    resumes: bool = False
    stops_on_error: bool = False
    timings: bool = True
    seconds: float | None = None


@record()
class Progress:
    """How far a sweep is. `running` are the variants that are compiled now, `places` how many can be."""

    count: int
    done: int
    failed: int
    kept: int
    running: tuple[Variant, ...]
    places: int
    given_again: int


@record(frozen=False)
class Session:
    """One run of a sweep. Iterate over it to run it; each row is yielded as it comes."""

    job: Job
    engine: Engine
    listen: Callable[[Progress], None] = lambda progress: None
    rows: list[Row] = field(default_factory=list)
    failed: int = 0
    kept: int = 0
    renamed: int = 0
    given_again: int = 0
    seconds: float = 0.0
    was_stopped: bool = False
    stale: list[str] = field(default_factory=list)
    """Files of earlier runs that stand where failing variants have none to write."""
    unfinished: Path | None = None
    """The folder of what is done, if the sweep is not over."""

    @property
    def is_complete(self) -> bool:
        return len(self.rows) == len(self.job.plan)

    def __iter__(self) -> Iterator[Row]:
        """Runs the sweep. Whatever ends it, what is done by then is kept where there are outputs; tables are
        written once it is over.
        """
        start = time.monotonic()
        job = self.job
        with ExitStack() as stack:
            drawings = Drawings(job.outputs, job.plan, job.world.reads)
            store, own = self._store()
            if store is not None:
                stack.callback(store.close)
            self.renamed, self.unfinished = drawings.renamed, own
            run = Run(job.plan, job.bundle, job.world, self._making, self.engine, store, job.seconds)
            try:
                for done in run:
                    if done is not None:
                        row = self._row(done, drawings)
                        self.rows.append(row)
                        self._tell(run)
                        yield row
                        if job.stops_on_error and not row.ok:
                            self.was_stopped = not self.is_complete
                            break
                    else:
                        self._tell(run)
            finally:
                self.given_again, self.seconds = run.given_again, time.monotonic() - start
        self._write_tables()
        if self.is_complete:
            self.unfinished = None
            if own is not None:
                keeping.remove(own)

    @property
    def _making(self) -> Making:
        pixels = PICTURE if self.job.outputs.sheets else 0
        return replace(self.job.making, suffixes=self.job.outputs.suffixes, picture=pixels)

    def _store(self) -> tuple[Store | None, Path | None]:
        """Returns the cache, and its folder if it is of this sweep alone."""
        if self.job.cache:
            return Store(Path(self.job.cache), self.job.cache_size), None
        if (own := self.job.outputs.keep(self.job.bundle.name)) is None:
            return None, None
        if not self.job.resumes:
            keeping.remove(own)
        return Store(own, None), own

    def _row(self, done: Done, drawings: Drawings) -> Row:
        outcome, written = done.outcome, []
        try:
            written = drawings.write(done.variant, outcome)
        except AidlError as reason:
            told = tuple(map(fault, reason.diagnostics))
            outcome = replace(outcome, ok=False, faults=(*told, *outcome.faults))
        if not written:
            self.stale += drawings.stale(done.variant)
        self.failed += not outcome.ok
        self.kept += done.was_kept
        light = replace(outcome, files={})
        names = written or drawings.names(done.variant)
        return Row(
            done.variant,
            light,
            tuple(written),
            self.job.command(done.variant, names[0] if names else ""),
            done.was_kept,
        )

    def _tell(self, run: Run) -> None:
        progress = Progress(
            len(self.job.plan),
            len(self.rows),
            self.failed,
            self.kept,
            tuple(run.running),
            self.engine.places,
            run.given_again,
        )
        self.listen(progress)

    def _write_tables(self) -> None:
        rows, columns = in_order(self.rows), Columns(self.job.plan, self.job.timings)
        for name in self.job.outputs.tables:
            write(name, TABLES[Path(name).suffix.lower()](columns, rows))
        for name in self.job.outputs.sheets:
            from aidl_lang.tools.sweeping.sheet import contact_sheet

            write(name, contact_sheet(Path(name).suffix.lower(), self.job.bundle.name, columns, rows))
