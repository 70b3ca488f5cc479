"""The result of compiling a program, and the ways to write, measure and compare it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from typing import TYPE_CHECKING

from aidl_lang.building.model import Knob, Model
from aidl_lang.common.diagnostics import AidlError, Diagnostic, within
from aidl_lang.common.records import record
from aidl_lang.common.running import Later
from aidl_lang.common.source import Span

if TYPE_CHECKING:
    from aidl_lang.building.expression import Evaluator
    from aidl_lang.checking.symbols import Allowance
    from aidl_lang.explaining.failures import Conflict
    from aidl_lang.export import Exporter
    from aidl_lang.export.comparison import Comparison
    from aidl_lang.export.drafting import Draft
    from aidl_lang.export.job import Exported, Options, Progress
    from aidl_lang.geometry.drawing import Drawing
    from aidl_lang.geometry.solved import SolvedModel
    from aidl_lang.geometry.survey import Part, Survey
    from aidl_lang.interp import Asked
    from aidl_lang.solver.problem import StageReport


def _never(span: Span) -> bool:
    return False


_LEFT_BEHIND = {"conflicts": tuple, "follows": _never, "built": None, "evaluate": None, "on_drawing": list}


@record()
class Facts:
    """What there is to tell of a program; `standing` are diagnostics that do not depend on exact places."""

    diagnostics: list[Diagnostic]
    standing: tuple[Diagnostic, ...] = ()


@record(frozen=False)
class Compiled:
    """The result of compiling a program. `model` and `drawing` are None if it is wrong before solving.

    find  works out what there is to tell; it is called at once if there are errors
    """

    status: str
    find: Later[Facts] = field(repr=False)
    timings: dict[str, float]
    knobs: tuple[Knob, ...] = ()
    model: SolvedModel | None = None
    drawing: Drawing | None = None
    show: frozenset[str] = field(default_factory=frozenset)
    stages: tuple[tuple[str, StageReport], ...] = ()
    """The attempts of the solver, in order: the path of a structure, and one stage for it."""
    conflicts: Callable[[], tuple[Conflict, ...]] = field(default=tuple, repr=False)
    """Works out, for a program that does not solve, the constraints that contradict each other."""
    follows: Callable[[Span], bool] = field(default=_never, repr=False)
    """Tells, for a program that solves, whether the constraint at a place follows from the rest."""
    built: Model | None = field(default=None, repr=False)
    """The structure tree with its expressions, whose solved values `evaluate` gives."""
    evaluate: Evaluator | None = field(default=None, repr=False)
    on_drawing: Callable[[], list[Diagnostic]] = field(default=list, repr=False)
    limit: float = math.inf
    """Seconds of the processor's time for each thing that is done with the drawing."""
    asked: Asked | None = field(default=None, repr=False)
    allowances: tuple[Allowance, ...] = ()

    def __getstate__(self) -> dict[str, object]:
        """Returns all but what works on the problem behind the solution, which a pickle does without."""
        return {name: value for name, value in vars(self).items() if name not in _LEFT_BEHIND}

    def __setstate__(self, state: dict[str, object]) -> None:
        vars(self).update(_LEFT_BEHIND)
        vars(self).update(state)

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What there is to tell, worked out when it is read."""
        return self.find().diagnostics

    @property
    def errors(self) -> list[Diagnostic]:
        """Those of the diagnostics that are errors, for which nothing is worked out."""
        return [d for d in self.find.known.diagnostics if d.is_error] if self.find.known else []

    @property
    def ok(self) -> bool:
        return self.status == "solved" and not self.errors

    def exported(self, suffix: str, options: Options | None = None) -> Exported:
        """Returns the drawing in the format of a file suffix (`.svg`), with the notes on writing it.

        Raises KeyError for an unknown suffix, `ExportError` if the format cannot hold the drawing, and
        AidlError if there is nothing to export.
        """
        return self.exporting(options)(suffix)

    def exporting(
        self, options: Options | None = None, progress: Progress = lambda done, count: None
    ) -> Exporter:
        """Returns `exported` for several formats with the same options; what they share is made once."""
        from aidl_lang.export import Exporter
        from aidl_lang.export.job import Job, Options

        job = Job(*self._finished, lambda: self.diagnostics, options or Options(self.show))
        return Exporter(job, progress, self.limit, self.audible)

    def drafted(self, suffixes: Sequence[str], draft: Draft, options: Options) -> list[Exported]:
        """Returns the drawing sheets in each of some formats of pictures. Raises as `exported` does."""
        from aidl_lang.export import rendered
        from aidl_lang.export.drafting import drafted
        from aidl_lang.export.job import Job

        job = Job(*self._finished, options=options)
        with within(self.limit, "drawing"):
            pages = drafted(job, draft)
            return [rendered(pages, suffix, options, job.model.root.path) for suffix in suffixes]

    def export(self, suffix: str, options: Options | None = None) -> bytes:
        """Returns the content of the file alone (see `exported`)."""
        return self.exported(suffix, options).data

    def surveyed(self, paths: Sequence[str] = (), densities: Mapping[str, float] | None = None) -> Survey:
        """Measures the whole, and the parts at some paths or else each body.

        Raises NothingThereError for a path at which nothing covers an area, TooLongError, and AidlError if
        there is nothing to measure.
        """
        from aidl_lang.geometry.survey import survey

        with within(self.limit, "measuring"):
            found = survey(*self._finished, paths, densities)
        return replace(found, notes=self.audible(found.notes))

    def measured(self, path: str | None = None, densities: Mapping[str, float] | None = None) -> Part:
        """Measures the part at a path, or the whole. Raises as `surveyed` does."""
        from aidl_lang.geometry.survey import measured

        with within(self.limit, "measuring"):
            return measured(*self._finished, path, densities)

    def compared(self, after: Compiled) -> Comparison:
        """Compares with a later version. Raises TooLongError, and AidlError if there is no drawing."""
        from aidl_lang.export.comparison import Version, compare

        with within(self.limit, "comparing"):
            return compare(Version(*self._finished), Version(*after._finished))

    def audible(self, notes: Sequence[Diagnostic]) -> tuple[Diagnostic, ...]:
        """Returns the notes on a use of the drawing that the program does not want unsaid."""
        if not self.allowances:
            return tuple(notes)
        from aidl_lang.checking.symbols import audible

        return tuple(audible(notes, self.allowances))

    @property
    def _finished(self) -> tuple[SolvedModel, Drawing]:
        if self.model is None or self.drawing is None:
            raise self.refused("the program is wrong, so there is no drawing")
        return self.model, self.drawing

    def refused(self, what: str) -> AidlError:
        """Returns what to raise, with the errors, if something cannot be done for them."""
        return AidlError(*self.errors, message=": ".join([what, *(d.message for d in self.errors[:1])]))
