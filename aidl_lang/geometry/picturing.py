"""Makes the drawing of a solution: names with places, regions, and diagnostics."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from aidl_lang.building.model import Model
from aidl_lang.common.diagnostics import Diagnostic, blaming
from aidl_lang.common.running import Stopwatch, working
from aidl_lang.common.source import Span

if TYPE_CHECKING:
    from aidl_lang.building.expression import Evaluator
    from aidl_lang.building.lower import Lowered
    from aidl_lang.geometry.drawing import Drawing, Findings
    from aidl_lang.geometry.solved import Dimension, SolvedModel
    from aidl_lang.solver.analysis import Freedom
    from aidl_lang.solver.problem import Solution

_HEAVY = "most of its curves are made here"


def pictured(
    built: Model, lowered: Lowered, solution: Solution, freedom: Callable[[], Freedom], watch: Stopwatch
) -> tuple[SolvedModel, Evaluator, Drawing, Findings]:
    """Returns the solved model with its evaluator, its drawing, and diagnostics on it."""
    from aidl_lang.geometry.drawing import Findings, draw
    from aidl_lang.geometry.readout import read_out, with_places

    with watch("read out"):
        model, evaluator = read_out(built, lowered, solution, freedom)
    with watch("regions"), blaming(partial(_most_drawn, model), _HEAVY):
        model, notes = with_places(replace(model, size_up=partial(_sizes, built, evaluator)))
        if model.is_unfinished:
            from aidl_lang.geometry.outlines import complete

            model, more = complete(model)
            notes += more
        drawing, found = draw(model)
        if any(s.ground is not None for s in model.root.walk()):
            from aidl_lang.geometry.outlines import on_material

            model = on_material(model, drawing)
            drawing, found = draw(model)

    def everything() -> list[Diagnostic]:
        with watch("notes"), blaming(partial(_most_drawn, model), _HEAVY):
            return [*notes, *found.everything()]

    errors = [*(d for d in notes if d.is_error), *found.errors]
    return model, evaluator, drawing, Findings(errors, everything)


def _sizes(built: Model, evaluator: Evaluator, solved: SolvedModel) -> tuple[Dimension, ...]:
    from aidl_lang.geometry.dimensions import sizes

    with working:
        return sizes(built, solved, evaluator)


def _most_drawn(model: SolvedModel) -> Span | None:
    """Returns the statement of the program that makes more curves than any other."""
    made: Counter[Span] = Counter()
    for structure in model.root.walk():
        for geometry in structure.geometry:
            if geometry.span is not None:
                made[geometry.span] += sum(1 for each in geometry.walk() if each.curve is not None)
    return max(made, key=lambda span: made[span], default=None)
