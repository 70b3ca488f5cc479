"""Editability: sets the knobs of a program to other values, and counts the results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

from aidl_eval.regions import Regions, of_drawing
from aidl_eval.rendering import RenderedLanguage, as_written
from aidl_eval.requirements import Prompt, Status, examine_regions
from aidl_lang import SourceFile, pipeline
from aidl_lang.building.model import Knob
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.ends import Value, allowed, rounded
from aidl_lang.tools.llm.aidl import Aidl
from aidl_lang.tools.llm.messages import Language

SHARES = (-0.25, -0.1, 0.1, 0.25)
"""Changes of a number, as shares of its value."""
_KNOBS = 25
"""Most knobs of a program that are tried."""
_ASSERTION = "E0604"


class EditOutcome(StrEnum):
    """The result of an edit."""

    KEPT = "kept"
    ASSERTION = "assertion"  # all solves, but an assert of the program speaks against the value
    CHANGED = "changed"  # a size that is written elsewhere had to give way
    BROKEN = "broken"  # it does not solve, or is wrong
    EMPTY = "empty"  # nothing is drawn any more


@dataclass(frozen=True)
class Edit:
    knob: str
    value: Value
    outcome: EditOutcome
    holds: bool = False
    """The program still is valid, and draws what meets each requirement on geometry that was met before."""


@dataclass(frozen=True)
class Edits:
    """`narrowed` counts edits cut short by a range or a step, `skipped` the knobs without an edit."""

    knobs: int
    edits: tuple[Edit, ...]
    narrowed: int = 0
    skipped: int = 0


def compiled(language: Language, source: SourceFile, params: Mapping[str, Value] | None = None) -> Compiled:
    """Compiles a program in its subset of the language."""
    assert isinstance(language, Aidl)
    return pipeline.compile(source, params=params, settings=pipeline.Settings.of(language.variant))


def of_aidl(language: Language, source: SourceFile, prompt: Prompt) -> Edits:
    """Edits the `param`s of a valid program."""
    before = compiled(language, source)
    changed, met = _changed(before), _met(prompt, _drawn(before))
    edits, narrowed, skipped = list[Edit](), 0, max(0, len(before.knobs) - _KNOBS)
    for knob in before.knobs[:_KNOBS]:
        values, cut = turned(knob)
        narrowed += cut
        skipped += not values
        for value in values:
            after = compiled(language, source, {knob.path: value})
            outcome = _outcome(after, changed)
            is_valid = outcome in (EditOutcome.KEPT, EditOutcome.CHANGED)
            holds = is_valid and met <= _met(prompt, _drawn(after))
            edits.append(Edit(knob.path, value, outcome, holds))
    return Edits(len(before.knobs), tuple(edits), narrowed, skipped)


def of_rendered(language: RenderedLanguage, program: str, prompt: Prompt) -> Edits:
    """Edits the numbers of a valid program in another language."""
    knobs = language.knobs(program)
    tried = [
        (name, value)
        for name, written in list(knobs.items())[:_KNOBS]
        for value in dict.fromkeys(_whole(aim, written) for aim in _numbers(written))
        if value != written
    ]
    met = _met(prompt, as_written(language, program).regions)
    after = language.run(program, [{name: value} for name, value in tried]) if tried else []
    edits = [
        Edit(
            name,
            value,
            EditOutcome.KEPT if rendered.ok else EditOutcome.EMPTY,
            rendered.ok and met <= _met(prompt, rendered.regions),
        )
        for (name, value), rendered in zip(tried, after, strict=True)
    ]
    return Edits(len(knobs), tuple(edits), 0, max(0, len(knobs) - _KNOBS))


def _drawn(compiled: Compiled) -> Regions:
    assert compiled.model is not None
    assert compiled.drawing is not None
    return of_drawing(compiled.model, compiled.drawing)


def _met(prompt: Prompt, drawn: Regions) -> frozenset[str]:
    return frozenset(r.text for r in examine_regions(prompt, drawn) if r.status is Status.MET)


def turned(knob: Knob) -> tuple[list[Value], int]:
    """Returns the values to try, and how many of the intended ones the range, the step or the choices cut
    short. A text without choices has none.
    """
    if knob.choices:
        others: list[Value] = [choice for choice in knob.choices if choice != knob.value][: len(SHARES)]
        return others, 0
    if isinstance(knob.value, bool):
        return [not knob.value], 0
    if isinstance(knob.value, str):
        return [], 0
    aims = list(_numbers(float(knob.value)))
    values = [allowed(knob, _whole(aim, float(knob.value)) if knob.unit == "" else aim) for aim in aims]
    cut = sum(abs(value - aim) > 1e-9 * abs(aim) for value, aim in zip(values, aims, strict=True))
    return [value for value in dict.fromkeys(values) if value != knob.value], cut


def _numbers(value: float) -> Iterator[float]:
    """Yields values around one; a zero has no share of itself and is left alone."""
    if value:
        yield from (rounded(value * (1 + share)) for share in SHARES)


def _whole(aim: float, written: float) -> float:
    """Keeps a value whole if the written number, maybe a count, is whole."""
    return float(round(aim)) if written.is_integer() else aim


def _outcome(after: Compiled, before: Sequence[str]) -> EditOutcome:
    errors = {d.code for d in after.diagnostics if d.is_error}
    if after.status != "solved" or errors - {_ASSERTION} or after.model is None or after.drawing is None:
        return EditOutcome.BROKEN
    if not all(report.satisfied or report.soft for report in after.model.constraints):
        return EditOutcome.BROKEN
    if set(_changed(after)) - set(before):
        return EditOutcome.CHANGED
    if not (after.drawing.bodies or after.drawing.strokes):
        return EditOutcome.EMPTY
    return EditOutcome.ASSERTION if errors else EditOutcome.KEPT


def _changed(compiled: Compiled) -> tuple[str, ...]:
    return tuple(change.path for change in compiled.model.changed) if compiled.model else ()
