"""Pulls a point of a solved model towards a place with as little other motion as possible."""

from __future__ import annotations

from collections.abc import Set as AbstractSet
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from aidl_lang import pipeline
from aidl_lang.building.expression import Evaluator, Unknown
from aidl_lang.building.lower import Lowered, lower
from aidl_lang.building.model import Model
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Vec
from aidl_lang.pipeline import Compiled
from aidl_lang.solver import Settings, Solution, Status, solve
from aidl_lang.tools.ide.dragging.grips import Grip, is_somewhere
from aidl_lang.tools.ide.dragging.mobility import AXES, Way, pull, values_at

_WEIGHT = 1e4
"""Weight of the wish that moves the point, beside the preferences of the program."""
_DEAR = 1e-3
"""Ratio of changes that count alike: of a number that only follows, and of one that is pulled."""
_CHANGED = 1e-9
_THERE = 1e-6
_SETTINGS = Settings(tolerance=1e-10, seconds=1.0, explain=False)


@record()
class Pull:
    """The drag of one point, and the numbers that may change by it.

    way      how the point can go, and `pin` the point that stays meanwhile
    written  numbers in the text; `movable` those and what follows them
    sizes    kept sizes that are to change; positions then only follow
    """

    grip: Grip
    way: Way
    pin: Grip | None
    written: AbstractSet[Unknown]
    movable: AbstractSet[Unknown]
    sizes: AbstractSet[Unknown]


def pulled(outcome: Compiled, pull: Pull, to: Vec) -> tuple[Compiled, Vec] | None:
    """Returns the outcome with the point as near to a place as it can come, and its place; None if the
    constraints do not hold then. Unknowns without a number in the text move only if nothing else will do.
    Raises TooLongError.
    """
    if outcome.built is None or outcome.evaluate is None:
        return None
    lowered = lower(_wishing(outcome.built, outcome.evaluate, pull, to))

    def off(found: tuple[Solution, Vec]) -> float:
        x, y = found[1][0] - to[0], found[1][1] - to[1]
        return max(abs(u * x + v * y) for u, v in pull.way.directions)

    found: list[tuple[Solution, Vec]] = []
    for loose in (pull.written, pull.movable):
        if (each := _solved(lowered, outcome.evaluate, pull, loose)) is not None:
            found.append(each)
            if off(each) <= _THERE:
                break
    best = min(found, key=lambda each: round(off(each), 6), default=None)
    return (pipeline.redrawn(outcome, lowered, best[0]), best[1]) if best is not None else None


def _wishing(model: Model, evaluate: Evaluator, by: Pull, to: Vec) -> Model:
    """Returns the model with the wish that moves the point, and the pin that holds another."""
    more = [pull(model, by.grip, by.way.directions, to, _WEIGHT)]
    if by.pin is not None:
        more.append(pull(model, by.pin, AXES, by.pin.at(evaluate), None))
    return replace(model, constraints=[*model.constraints, *more])


def _solved(
    lowered: Lowered, evaluate: Evaluator, by: Pull, loose: AbstractSet[Unknown]
) -> tuple[Solution, Vec] | None:
    """Returns the nearest solution that changes only `loose` unknowns and the sizes to change, and the
    point's place. All is solved at once, since it all holds as it is.
    """
    problem, at = lowered.problem, values_at(lowered, evaluate)
    resized, said = _are(lowered, by.sizes), _are(lowered, by.written) & ~problem.kept
    free = resized | (_are(lowered, loose) & ~problem.kept)
    leads = resized if by.sizes else said
    flat = replace(
        problem,
        initial=at,
        scale=np.where(leads, 1.0, _DEAR) * problem.scale,
        kept=~free,
        group=np.zeros(len(at), dtype=np.int64),
        frame_of=np.full(len(at), -1),
        parent=np.array([-1]),
        holder=np.zeros_like(problem.holder),
        named=False,
        standing=_are(lowered, frozenset()),
        spanned=_are(lowered, frozenset()),
        thing=np.zeros(len(at), dtype=np.int64),
        observables=(),
    )
    solution = solve(flat, _SETTINGS)
    place = by.grip.at(Evaluator(dict(zip(lowered.unknowns, solution.values.tolist(), strict=True))))
    if solution.status is not Status.SOLVED or not is_somewhere(place):
        return None
    guessed = np.array([u.guess for u in lowered.unknowns])
    changed = problem.kept & (np.abs(solution.values - guessed) > _CHANGED * problem.scale)
    return replace(solution, changed=tuple(np.flatnonzero(changed).tolist())), place


def _are(lowered: Lowered, unknowns: AbstractSet[Unknown]) -> NDArray[np.bool_]:
    return np.array([u in unknowns for u in lowered.unknowns], dtype=np.bool_)
