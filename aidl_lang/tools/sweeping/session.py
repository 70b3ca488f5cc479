"""A sweep from its beginning to its outputs: what is kept is taken, the rest is computed and written."""

from __future__ import annotations

import shlex
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import field, replace
from pathlib import Path, PurePath

from aidl_lang import pipeline
from aidl_lang.building.model import Knob
from aidl_lang.common.crew import Broke, Crew
from aidl_lang.common.diagnostics import AidlError, Diagnostic, has_errors
from aidl_lang.common.processes import Engine, Guarded, count
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.tools.sweeping import keeping
from aidl_lang.tools.sweeping.bundle import (
    Bundle,
    Fault,
    Gathering,
    Outcome,
    digest_of,
    fault,
    limit_fault,
    patience,
)
from aidl_lang.tools.sweeping.keeping import Store
from aidl_lang.tools.sweeping.outputs import Drawings, Outputs, write
from aidl_lang.tools.sweeping.plan import Plan, Value, Variant, spelled
from aidl_lang.tools.sweeping.rows import TABLES, Columns, Row, in_order
from aidl_lang.tools.sweeping.working import Making, variant

# --- The beginnings of a sweep that the command line and Python have in common: the program, and the engine
# by name.

LOCAL = "local"
_WORKING = "aidl_lang.tools.sweeping.working"
_WARM = "aidl_lang.tools.sweeping.warm"


def opened(
    source: SourceFile, world: World | None, settings: pipeline.Settings
) -> tuple[Bundle, Gathering, tuple[Knob, ...]]:
    """Returns a program as it travels, the files that it may ask for, and its params. Raises AidlError for a
    program that is wrong as written.
    """
    from aidl_lang.common.world import MemoryWorld

    gathering = Gathering(world or MemoryWorld({}))
    knobs, found = pipeline.knobs(source, gathering, settings)
    if has_errors(found):
        raise AidlError(*(d for d in found if d.is_error))
    return Bundle(source.name, source.text, dict(gathering.files), settings), gathering, knobs


_PACKAGES = {".dxf": "ezdxf", ".pdf": "reportlab.pdfgen.canvas", ".png": "resvg_py"}
"""Packages that take long to load, by what is written with them."""


def preloads(names: Sequence[str]) -> list[str]:
    """Returns the modules that workers load at the start, for outputs of some names."""
    suffixes = {PurePath(name).suffix.lower() for name in names}
    if suffixes & {".html", ".pdf", ".png"}:
        suffixes.add(".png")  # the pictures on a sheet
    return [_WORKING, _WARM, *(package for suffix, package in _PACKAGES.items() if suffix in suffixes)]


def engine(
    name: str, jobs: int | None = None, most: int | None = None, outputs: Sequence[str] = ()
) -> Engine:
    """Returns an engine: `local` for processes of this machine, or the address of a scheduler of Dask. `jobs`
    says how many processes, `most` how many there is work for, `outputs` what they write. Raises AidlError.
    """
    if name == LOCAL:
        wanted = jobs or count()
        return Guarded(max(1, min(wanted, most or wanted)), preloads(outputs))
    from aidl_lang.common.crew import Cluster

    if jobs is not None:
        message = "the workers of a cluster are as many as it has"
        raise AidlError(Diagnostic("E0976", message, hints=("leave out the number of jobs",)))
    return Cluster(name, _WORKING)


def reproducing(
    program: str,
    plan: Plan,
    variant: Variant,
    name: str,
    options: Sequence[str] = (),
    *,
    verb: str = "compile",
) -> str:
    """Returns the command that makes one variant alone, for a POSIX shell."""
    words = ["aidl", verb, f"./{program}" if program.startswith("-") else program]
    for path, given in variant.values.items():
        words += ["-D", f"{path}={_written(spelled(plan.knobs.get(path), given))}"]
    words += options
    return joined([*words, "-o", name] if name else [*words, "-o", "variant.svg"])


def _written(given: Value) -> str:
    from aidl_lang.tools.sweeping.plan import shown

    return repr(given) if isinstance(given, float) and not given.is_integer() else shown(given)


def joined(words: Sequence[str]) -> str:
    """Returns words as a shell reads them; one with characters that a terminal does not show is written
    `$'…'`.
    """
    return " ".join(shlex.quote(word) if word.isprintable() else _escaped(word) for word in words)


def _escaped(word: str) -> str:
    def one(character: str) -> str:
        if character in "'\\":
            return f"\\{character}"
        if character.isprintable():
            return character
        return "".join(f"\\x{byte:02x}" for byte in character.encode("utf-8", "surrogateescape"))

    # bash takes as many hexadecimal digits after \x as there are, at most two
    return "$'" + "".join(map(one, word)) + "'"


# --- The run of a sweep: what is kept is taken, the rest is computed by an engine, and each outcome is
# handed over as it comes.

_PAUSE = 0.2
"""Seconds after which the run looks whether it is still wanted."""
_ROUNDS = 100
"""How often a variant may ask for further files."""


@record()
class Done:
    """A variant with its outcome; `was_kept` if nothing was computed for it."""

    variant: Variant
    outcome: Outcome
    was_kept: bool


class Run:
    """Yields the variants of a plan with their outcomes, as they come. One run at a time."""

    def __init__(
        self,
        plan: Plan,
        bundle: Bundle,
        world: Gathering,
        making: Making,
        engine: Engine,
        store: Store | None = None,
        seconds: float | None = None,
    ) -> None:
        """Begins a run; `seconds` are for one variant, where it is not to be what a compile may take."""
        self.plan, self.making, self.engine, self.store = plan, making, engine, store
        self._bundle, self._world = bundle, world
        self._seconds = seconds or patience(bundle.settings, 2 + len(making.suffixes))
        self._crew: Crew[int, Outcome] = Crew(engine)
        self._open: dict[int, Variant] = {}
        self._rounds: dict[int, int] = {}

    @property
    def running(self) -> list[Variant]:
        """The variants that are likely compiled now."""
        return [self._open[number] for number in self._crew.running]

    @property
    def given_again(self) -> int:
        """How many variants were begun once more, because what compiled them was gone."""
        return self._crew.given_again

    def __iter__(self) -> Iterator[Done | None]:
        """Yields what is done; None now and then while there is nothing new."""
        waiting = iter(self.plan)
        is_over = False
        try:
            while not is_over or self._crew:
                checkpoint()
                while not is_over and self._crew.has_room:
                    if (each := next(waiting, None)) is None:
                        is_over = True
                    elif (kept := self._kept(each)) is not None:
                        yield Done(each, kept, was_kept=True)
                    else:
                        self._give(each)
                if not self._crew:
                    continue
                came = self._crew.came(_PAUSE)
                if not came:
                    yield None
                for number, found in came:
                    if (done := self._came(number, found)) is not None:
                        yield done
        finally:
            self._crew.cancel()

    def _kept(self, each: Variant) -> Outcome | None:
        if self.store is None:
            return None
        return self.store.get(self._key(each), self._digest)

    def _key(self, each: Variant) -> str:
        return keeping.key(self._bundle, each.params(self.plan.knobs), self.making)

    def _digest(self, path: str) -> str:
        self._world.gather([path])
        return digest_of(self._world.files[path]) if path in self._world.files else "no such path"

    def _give(self, each: Variant) -> None:
        if len(self._world.files) > len(self._bundle.files):
            self._bundle = replace(self._bundle, files=dict(self._world.files))
        self._open[each.number] = each
        self._crew.give(
            each.number, self._seconds, variant, self._bundle, each.params(self.plan.knobs), self.making
        )

    def _came(self, number: int, found: Outcome | Broke) -> Done | None:
        """Returns a variant that is done; None if it goes round once more, with the files it asked for."""
        each = self._open.pop(number)
        outcome = found if isinstance(found, Outcome) else _broken(found)
        if outcome.missing:
            self._rounds[number] = self._rounds.get(number, 0) + 1
            self._world.gather(outcome.missing)
            if self._rounds[number] < _ROUNDS:
                self._give(each)
                return None
            outcome = Outcome("broken", False, (Fault("E0603", "the program asks for ever new files"),))
        if self.store is not None and outcome.status != "broken":
            reads = {path: digest_of(content) for path, content in self._bundle.files.items()}
            self.store.put(self._key(each), outcome, reads)
        return Done(each, outcome, was_kept=False)


def _broken(broke: Broke) -> Outcome:
    """Returns the outcome of a variant that met a limit, or a bug."""
    if broke.limit is not None:
        return Outcome("broken", False, (limit_fault(broke.limit),))
    message = f"compiling ended in {type(broke.error).__name__}: {str(broke.error)[:200]}"
    return Outcome("broken", False, (Fault("E0603", message),))


# --- A sweep from its plan to its outputs: runs it, writes drawings as they come and tables at the end, and
# keeps what is done so that it can go on.

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
