"""The run of a sweep: what is kept is taken, the rest is computed by an engine, and each outcome is handed
over as it comes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from aidl_lang.common.crew import Broke, Crew
from aidl_lang.common.processes import Engine
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.tools.sweeping import keeping
from aidl_lang.tools.sweeping.bundle import Bundle, Gathering, digest_of, patience
from aidl_lang.tools.sweeping.faults import Fault, limit_fault
from aidl_lang.tools.sweeping.keeping import Store
from aidl_lang.tools.sweeping.outcome import Outcome
from aidl_lang.tools.sweeping.plan import Plan, Variant
from aidl_lang.tools.sweeping.working import Making, variant

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
