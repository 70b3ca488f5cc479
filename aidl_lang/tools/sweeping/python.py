"""A sweep as Python has it: an iterator of results, which is a table as well."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from aidl_lang.building.model import Knob
from aidl_lang.common.processes import Engine
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.pipeline import Settings
from aidl_lang.tools.sweeping.outputs import outputs as sorted_outputs
from aidl_lang.tools.sweeping.plan import Axis, Variant, axis, from_values, knob_named, planned, read_table
from aidl_lang.tools.sweeping.rows import Columns, Row, in_order
from aidl_lang.tools.sweeping.session import Job, Session, opened, reproducing
from aidl_lang.tools.sweeping.session import engine as engine_named
from aidl_lang.tools.sweeping.working import Making

if TYPE_CHECKING:
    import pyarrow

    from aidl_lang.tools.cli.options import Asked


class Sweep:
    """The variants of a program. Iterating over it runs it, and yields a result for each variant as it comes;
    a second time it yields what is known, and goes on where the first was left.

    A result has `number`, `params`, `ok`, `status`, `measures`, `message`, `files` and `command`; its
    `outcome` has the rest.
    """

    def __init__(self, job: Job, engine: tuple[str, int | None]) -> None:
        self._job, self._engine = job, engine
        self._session: Session | None = None
        self._running: Iterator[Row] | None = None

    @classmethod
    def begun(
        cls,
        source: SourceFile,
        world: World | None,
        params: Mapping[str, object],
        asked: Asked,
        settings: Settings | None,
        *,
        outputs: Sequence[str],
        table: str | Path | None,
        drawn: tuple[int, int] | None,
        engine: tuple[str, int | None],
        **how: Any,
    ) -> Sweep:
        """Returns a sweep that is about to run; `how` has fields of the `Job`. Raises AidlError."""
        bundle, gathering, knobs = opened(source, world, settings or Settings())
        axes = [_axis(name, values, knobs, is_drawn=drawn is not None) for name, values in params.items()]
        rows = None if table is None else read_table(Path(table), knobs, gathering.reads)
        plan = planned(knobs, axes, rows, drawn)

        def command(variant: Variant, name: str) -> str:
            return reproducing(source.name, plan, variant, name)

        making = Making(options=asked.options, best_effort=asked.best_effort)
        wanted = sorted_outputs(outputs, plan, gathering.reads, asked.format)
        return cls(Job(plan, bundle, gathering, making, wanted, command, **how), engine)

    def __len__(self) -> int:
        """The number of variants."""
        return len(self._job.plan)

    def __iter__(self) -> Iterator[Row]:
        place = 0
        while True:
            known = self._session.rows if self._session is not None else []
            if place < len(known):
                yield known[place]
                place += 1
            elif not self._step():
                return

    def _step(self) -> bool:
        """Has one more result come in; False if there is none."""
        if self._running is None:
            if self._session is not None:
                return False
            self._running = self._rows()
        if next(self._running, None) is None:
            self._running = None
            return False
        return True

    def _rows(self) -> Iterator[Row]:
        workers: Engine = engine_named(*self._engine, len(self._job.plan), self._job.outputs.names)
        self._session = Session(self._job, workers)
        try:
            yield from self._session
        finally:
            workers.close()

    def close(self) -> None:
        """Gives up what is not done. With outputs or a cache, what is done is kept."""
        if self._running is not None:
            self._running.close()  # type: ignore[attr-defined]
            self._running = None

    def __enter__(self) -> Sweep:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def results(self) -> list[Row]:
        """All results in the order of the variants; runs the sweep to its end."""
        return in_order(list(self))

    @property
    def failures(self) -> list[Row]:
        """The results that are not `ok`."""
        return [row for row in self.results if not row.ok]

    def to_arrow(self) -> pyarrow.Table:
        """Returns the results as a table of Arrow. Raises AidlError without the package `pyarrow`."""
        from aidl_lang.tools.sweeping.rows import to_arrow

        return to_arrow(Columns(self._job.plan, self._job.timings), self.results)

    def to_pandas(self) -> Any:
        """Returns the results as a data frame of pandas. Raises AidlError without the packages."""
        from aidl_lang.export import require

        require("pandas", "a data frame", "parquet")
        return self.to_arrow().to_pandas()

    def __repr__(self) -> str:
        done = len(self._session.rows) if self._session is not None else 0
        return f"<aidl_lang.Sweep {done} of {len(self)} variants>"


def _axis(name: str, values: object, knobs: Sequence[Knob], *, is_drawn: bool) -> Axis:
    """Reads the values of a param: as the command line has them, if they are a text and the param is none."""
    if isinstance(values, str) and not isinstance(knob_named(name, knobs).value, str):
        return axis(name, values, knobs, is_drawn=is_drawn)
    return from_values(name, values, knobs)
