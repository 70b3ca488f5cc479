"""A sweep from its plan to its outputs, and the same as Python has it: an iterator of results."""

from __future__ import annotations

import shlex
import time
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import partial
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from aidl_lang import pipeline
from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import AidlError, has_errors
from aidl_lang.common.processes import Broke, Crew, Engine, Guarded, count
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld, World
from aidl_lang.export.job import Options, require
from aidl_lang.pipeline import Settings
from aidl_lang.tools.sweeping import keeping
from aidl_lang.tools.sweeping.bundle import (
    BROKEN,
    Bundle,
    Fault,
    Gathering,
    Outcome,
    digest_of,
    fault,
    patience,
)
from aidl_lang.tools.sweeping.keeping import Store
from aidl_lang.tools.sweeping.outputs import TABLES, Columns, Drawings, Outputs, Row, in_order, turns, write
from aidl_lang.tools.sweeping.outputs import outputs as sorted_outputs
from aidl_lang.tools.sweeping.outputs import to_arrow as as_arrow
from aidl_lang.tools.sweeping.plan import (
    Axis,
    Plan,
    Value,
    Variant,
    axis,
    from_values,
    knob_named,
    planned,
    read_table,
    refused,
    shown,
    spelled,
)
from aidl_lang.tools.sweeping.working import Making, variant

if TYPE_CHECKING:
    import pyarrow


# --- How a sweep begins on the command line and in Python: the program, and the engine by name.

LOCAL = "local"
_WORKING = "aidl_lang.tools.sweeping.working"
_WARM = "aidl_lang.tools.sweeping.warm"


def opened(
    source: SourceFile, world: World | None, settings: pipeline.Settings
) -> tuple[Bundle, Gathering, tuple[Knob, ...]]:
    """Returns a program as it travels, files it may ask for, its params. Raises AidlError if wrong."""
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
    from aidl_lang.common.processes import Cluster

    if jobs is not None:
        message = "the workers of a cluster are as many as it has"
        raise refused("E0976", message, "leave out the number of jobs")
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
    return repr(given) if isinstance(given, float) and not given.is_integer() else shown(given)


def joined(words: Sequence[str]) -> str:
    """Returns words as a shell reads them; `$'…'` for characters that a terminal does not show."""
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


# --- A sweep, for the command and as Python has it: an iterator of results, which is a table as well. What is
# kept is taken, the rest is computed, and outputs are written.

_PAUSE = 0.2
"""Seconds after which the run looks whether it is still wanted."""
_ROUNDS = 100
"""How often a variant may ask for further files."""
_Done = tuple[Variant, Outcome, bool]
"""A variant with its outcome, and True if nothing was computed for it."""


def _broken(broke: Broke) -> Outcome:
    why = f"compiling ended in {type(broke.error).__name__}: {str(broke.error)[:200]}"
    return Outcome("broken", False, (Fault("E0603", why if broke.limit is None else BROKEN[broke.limit]),))


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


@record(frozen=False, eq=False)
class Sweep:
    """The variants of a program. Iterating over it runs it, and yields a result for each variant as it comes;
    a second time it yields what is known, and goes on where the first was left.

    A result has `number`, `params`, `ok`, `status`, `measures`, `message`, `files` and `command`; its
    `outcome` has the rest.
    """

    job: Job
    start: Callable[[], Engine]
    """Starts what compiles, once a result is asked for."""
    listen: Callable[[Progress], None] = lambda progress: None
    rows: list[Row] = field(default_factory=list)
    failed: int = 0
    kept: int = 0
    renamed: int = 0
    seconds: float = 0.0
    was_stopped: bool = False
    given_again: int = 0
    """How many variants were begun once more, because what compiled them was gone."""
    stale: list[str] = field(default_factory=list)
    """Files of earlier runs that stand where failing variants have none to write."""
    unfinished: Path | None = None
    """The folder of what is done, if the sweep is not over."""

    def __post_init__(self) -> None:
        job = self.job
        pixels = PICTURE if job.outputs.sheets else 0
        self._making = replace(job.making, suffixes=job.outputs.suffixes, picture=pixels)
        self._seconds = job.seconds or patience(job.bundle.settings, 2 + len(self._making.suffixes))
        self._bundle = job.bundle
        self._store: Store | None = None
        self._crew: Crew[int, Outcome] | None = None
        self._open: dict[int, Variant] = {}
        self._rounds: dict[int, int] = {}
        self._running = self._rows()

    @classmethod
    def begun(
        cls,
        source: SourceFile,
        world: World | None,
        params: Mapping[str, object],
        asked: tuple[Options, str | None, bool],
        settings: Settings | None,
        *,
        outputs: Sequence[str],
        table: str | Path | None,
        drawn: tuple[int, int] | None,
        on: tuple[str, int | None],
        **how: Any,
    ) -> Sweep:
        """Returns a sweep that is about to run; `how` has fields of the `Job`. Raises AidlError."""
        bundle, gathering, knobs = opened(source, world, settings or Settings())
        axes = [_axis(name, values, knobs, is_drawn=drawn is not None) for name, values in params.items()]
        rows = None if table is None else read_table(Path(table), knobs, gathering.reads)
        plan = planned(knobs, axes, rows, drawn)

        def command(variant: Variant, name: str) -> str:
            return reproducing(source.name, plan, variant, name)

        options, fallback, best_effort = asked
        making = Making(options=options, best_effort=best_effort)
        wanted = sorted_outputs(outputs, plan, gathering.reads, fallback)
        job = Job(plan, bundle, gathering, making, wanted, command, **how)
        return cls(job, partial(engine, *on, len(plan), wanted.names))

    def __len__(self) -> int:
        """The number of variants."""
        return len(self.job.plan)

    def __iter__(self) -> Iterator[Row]:
        place = 0
        while place < len(self.rows) or next(self._running, None) is not None:
            yield self.rows[place]
            place += 1

    def close(self) -> None:
        """Gives up what is not done. With outputs or a cache, what is done is kept."""
        if self._crew is not None:
            self._running.close()

    def __enter__(self) -> Sweep:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def is_complete(self) -> bool:
        return len(self.rows) == len(self)

    @property
    def results(self) -> list[Row]:
        """All results in the order of the variants; runs the sweep to its end."""
        return in_order(list(self))

    @property
    def turns(self) -> list[str]:
        """A sentence for each two results that are neighbours in one param, and of different kind."""
        return list(turns(self.results))

    @property
    def failures(self) -> list[Row]:
        """The results that are not `ok`."""
        return [row for row in self.results if not row.ok]

    def to_arrow(self) -> pyarrow.Table:
        """Returns the results as a table of Arrow. Raises AidlError without the package `pyarrow`."""
        return as_arrow(Columns(self.job.plan, self.job.timings), self.results)

    def to_pandas(self) -> Any:
        """Returns the results as a data frame of pandas. Raises AidlError without the packages."""
        require("pandas", "a data frame", "parquet")
        return self.to_arrow().to_pandas()

    def __repr__(self) -> str:
        return f"<aidl_lang.Sweep {len(self.rows)} of {len(self)} variants>"

    # --- The run --------------------------------------------------------------------------------

    def _rows(self) -> Generator[Row, None, None]:
        """Runs the sweep. Whatever ends it, what is done is kept where there are outputs; tables last."""
        engine, job = self.start(), self.job
        began, self._crew = time.monotonic(), Crew(engine)
        try:
            drawings = Drawings(job.outputs, job.plan, job.world.reads)
            self._store, own = self._opened()
            self.renamed, self.unfinished = drawings.renamed, own
            for done in self._run(self._crew):
                if done is not None:
                    self.rows.append(self._row(*done, drawings))
                self._tell(engine, self._crew)
                if done is None:
                    continue
                row = self.rows[-1]
                yield row
                if job.stops_on_error and not row.ok:
                    self.was_stopped = not self.is_complete
                    break
        finally:
            self.seconds = time.monotonic() - began
            engine.close()
            if self._store is not None:
                self._store.close()
        self._write_tables()
        if self.is_complete:
            self.unfinished = None
            if own is not None:
                keeping.remove(own)

    def _run(self, crew: Crew[int, Outcome]) -> Iterator[_Done | None]:
        """Yields what is done; None now and then while there is nothing new."""
        waiting = iter(self.job.plan)
        is_over = False
        try:
            while not is_over or crew:
                checkpoint()
                while not is_over and crew.has_room:
                    if (each := next(waiting, None)) is None:
                        is_over = True
                    elif kept := self._store and self._store.get(self._key(each), self._digest):
                        yield each, kept, True
                    else:
                        self._give(crew, each)
                if not crew:
                    continue
                came = crew.came(_PAUSE)
                if not came:
                    yield None
                for number, found in came:
                    if (done := self._came(crew, number, found)) is not None:
                        yield done
        finally:
            crew.cancel()

    def _key(self, each: Variant) -> str:
        return keeping.key(self._bundle, each.params(self.job.plan.knobs), self._making)

    def _digest(self, path: str) -> str:
        files = self.job.world.files
        self.job.world.gather([path])
        return digest_of(files[path]) if path in files else "no such path"

    def _give(self, crew: Crew[int, Outcome], each: Variant) -> None:
        files = self.job.world.files
        if len(files) > len(self._bundle.files):
            self._bundle = replace(self._bundle, files=dict(files))
        self._open[each.number] = each
        params = each.params(self.job.plan.knobs)
        crew.give(each.number, self._seconds, variant, self._bundle, params, self._making)

    def _came(self, crew: Crew[int, Outcome], number: int, found: Outcome | Broke) -> _Done | None:
        """Returns a variant that is done; None if it goes round once more, with the files it asked for."""
        each = self._open.pop(number)
        outcome = found if isinstance(found, Outcome) else _broken(found)
        if outcome.missing:
            self._rounds[number] = self._rounds.get(number, 0) + 1
            self.job.world.gather(outcome.missing)
            if self._rounds[number] < _ROUNDS:
                self._give(crew, each)
                return None
            outcome = Outcome("broken", False, (Fault("E0603", "the program asks for ever new files"),))
        if self._store is not None and outcome.status != "broken":
            reads = {path: digest_of(content) for path, content in self._bundle.files.items()}
            self._store.put(self._key(each), outcome, reads)
        return each, outcome, False

    def _opened(self) -> tuple[Store | None, Path | None]:
        """Returns the cache, and its folder if it is of this sweep alone."""
        if self.job.cache:
            return Store(Path(self.job.cache), self.job.cache_size), None
        if (own := self.job.outputs.keep(self.job.bundle.name)) is None:
            return None, None
        if not self.job.resumes:
            keeping.remove(own)
        return Store(own, None), own

    def _row(self, each: Variant, outcome: Outcome, was_kept: bool, drawings: Drawings) -> Row:
        written: list[str] = []
        try:
            written = drawings.write(each, outcome)
        except AidlError as reason:
            told = tuple(map(fault, reason.diagnostics))
            outcome = replace(outcome, ok=False, faults=(*told, *outcome.faults))
        if not written:
            self.stale += drawings.stale(each)
        self.failed += not outcome.ok
        self.kept += was_kept
        names = written or drawings.names(each)
        command = self.job.command(each, names[0] if names else "")
        return Row(each, replace(outcome, files={}), tuple(written), command)

    def _tell(self, engine: Engine, crew: Crew[int, Outcome]) -> None:
        self.given_again = crew.given_again
        counts = len(self), len(self.rows), self.failed, self.kept
        running = tuple(self._open[number] for number in crew.running)
        self.listen(Progress(*counts, running, engine.places, self.given_again))

    def _write_tables(self) -> None:
        rows, columns = in_order(self.rows), Columns(self.job.plan, self.job.timings)
        for name in self.job.outputs.tables:
            write(name, TABLES[Path(name).suffix.lower()](columns, rows))
        for name in self.job.outputs.sheets:
            from aidl_lang.tools.sweeping.sheet import contact_sheet

            write(name, contact_sheet(Path(name).suffix.lower(), self.job.bundle.name, columns, rows))


def _axis(name: str, values: object, knobs: Sequence[Knob], *, is_drawn: bool) -> Axis:
    """Reads the values of a param: as the command line has them, if they are a text and the param is none."""
    if isinstance(values, str) and not isinstance(knob_named(name, knobs).value, str):
        return axis(name, values, knobs, is_drawn=is_drawn)
    return from_values(name, values, knobs)
