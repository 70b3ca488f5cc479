"""Drags a point of the drawing: the points that can move, the new drawing, and the edits of the text."""

from __future__ import annotations

import math
from collections.abc import Iterator
from collections.abc import Set as AbstractSet
from dataclasses import field, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from aidl_lang import pipeline
from aidl_lang.building.expression import Evaluator, Unknown
from aidl_lang.building.lower import Lowered, lower
from aidl_lang.building.model import Model
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.drawing_time import TooLongError
from aidl_lang.common.prose import first_few, shortest, ticked
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Vec
from aidl_lang.pipeline import Compiled
from aidl_lang.solver import Settings, Solution, Status, solve
from aidl_lang.tools.ide.dragging.by_params import moved_by_params, turned
from aidl_lang.tools.ide.dragging.mobility import (
    AXES,
    Grip,
    Way,
    Ways,
    belongs,
    grips,
    is_somewhere,
    movable,
    pull,
    values_at,
    ways,
)
from aidl_lang.tools.ide.guesses import Guess, guesses, is_same
from aidl_lang.tools.ide.references import Refusal
from aidl_lang.tools.ide.workspace import View, edited, hasty

# --- Pulls a point of a solved model towards a place with as little other motion as possible.

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
        group=np.zeros(len(at), dtype=np.intp),
        frame_of=np.full(len(at), -1),
        parent=np.array([-1]),
        holder=np.zeros_like(problem.holder),
        named=False,
        standing=_are(lowered, frozenset()),
        spanned=_are(lowered, frozenset()),
        thing=np.zeros(len(at), dtype=np.intp),
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


# A point moves by what the text leaves open, in this order: first guesses, as the points of a sketch do; its
# own sizes; a `param`; and the place of the drawing as a whole, by first guesses again.

STEP = 0.1
"""Step to which dragging rounds the numbers it writes, mm."""
MOST_HANDLES = 60
_MOST_GRIPS = 400
"""Most points considered; of a larger model the outermost ones."""
_FARTHEST = 1e6
"""Farthest place from the origin to which a point may be dragged, mm."""
_FINE = 1e-6
_PROBE = 3.0
"""How far the drawing is moved to see whether it stays there, mm."""
_NAMED = 2
"""Most params that a hint names."""


@record()
class Handle:
    """A point that can be dragged.

    at     in the root's frame, mm
    moves  what changes in the text: `guess`, `size` or `param`
    """

    id: str
    path: str
    at: Vec
    moves: str
    hint: str


@record()
class Dragged:
    """A dragged point: `view` is the program meanwhile, `at` the point's place; `edits` take longer."""

    view: View
    at: Vec
    _origin: View = field(repr=False)
    _grip: Grip = field(repr=False)
    _step: float = field(repr=False)
    _settled: tuple[Edit, ...] | None = field(default=None, repr=False)

    @cached_property
    def edits(self) -> tuple[Edit, ...] | Refusal:
        """Returns the edits that keep the point there: only the numbers that changed."""
        if self._settled is not None:
            return self._settled
        return _edits(self._origin, self)


def handles(view: View, *, params: bool = True) -> list[Handle]:
    """Returns the points that can be dragged; without `params`, only those found without further runs."""
    found = [*_by_numbers(view)]
    if params and view.outcome is not None and view.outcome.built is not None:
        taken = {handle.id for handle in found if not _is_slide(view, handle.id)}
        known = moved_by_params(view, _grips(view))
        by_param = [
            Handle(grip.id, grip.path, at, "param", _by_param(grip, known[grip.id]))
            for grip, at in _places(view)
            if grip.id in known and grip.id not in taken
        ]
        found = [h for h in found if h.id not in known or h.id in taken] + by_param
        found = [h for h in found if not _is_slide(view, h.id) or h.moves == "param" or _slides(view, h.id)]
    return _outermost(view, found)


def drag(view: View, handle: str, to: Vec, step: float = STEP) -> Dragged | Refusal:
    """Returns the program with a point dragged as near to a place as it can come."""
    if not (is_somewhere(to) and max(abs(to[0]), abs(to[1])) <= _FARTHEST):
        return Refusal("that place is too far away")
    if not (math.isfinite(step) and step > 0):
        return Refusal("the step is a length")
    found = next((h for h in handles(view) if h.id == handle), None)
    grip = next((g for g in _grips(view) if g.id == handle), None)
    if found is None or grip is None:
        return Refusal("there is nothing to drag by this name")
    if found.moves == "param":
        turn = turned(view, grip, to, step)
        if isinstance(turn, Refusal):
            return turn
        shown, at, edits = turn
        return Dragged(shown, at, view, grip, step, edits)
    return _pulled(view, grip, to, step)


def _grips_of(view: View) -> dict[str, Grip]:
    return {grip.id: grip for grip in _grips(view)}


@lru_cache(maxsize=4)
def _grips(view: View) -> tuple[Grip, ...]:
    outcome = view.outcome
    if outcome is None or outcome.built is None or outcome.status != "solved" or view.is_stale:
        return ()
    written = _written(view)
    found = [grip for grip in grips(outcome.built) if not grip.is_frame or grip.frame & written]
    return tuple(sorted(found, key=lambda grip: grip.depth)[:_MOST_GRIPS])


def _places(view: View) -> Iterator[tuple[Grip, Vec]]:
    outcome = view.outcome
    if outcome is not None and outcome.evaluate is not None:
        for grip in _grips(view):
            at = grip.at(outcome.evaluate)
            if is_somewhere(at):
                yield grip, at


@lru_cache(maxsize=4)
def _ways(view: View) -> Ways:
    outcome = view.outcome
    if outcome is None or outcome.built is None or outcome.evaluate is None:
        return Ways()
    found = [grip for grip, _ in _places(view)]
    return ways(outcome.built, found, outcome.evaluate, _written(view), _movable(view))


@lru_cache(maxsize=4)
def _editable(view: View) -> tuple[Guess, ...]:
    return tuple(guess for guess in guesses(view) if not guess.is_shared)


@lru_cache(maxsize=4)
def _written(view: View) -> frozenset[Unknown]:
    return frozenset(u for guess in _editable(view) for u in guess.unknowns)


@lru_cache(maxsize=4)
def _movable(view: View) -> frozenset[Unknown]:
    outcome = view.outcome
    if outcome is None or outcome.built is None or outcome.evaluate is None:
        return frozenset()
    return movable(outcome.built, outcome.evaluate, _written(view))


def _by_numbers(view: View) -> Iterator[Handle]:
    known = _ways(view)
    for grip, at in _places(view):
        name = _name(grip)
        if grip.id in known.own:
            yield Handle(grip.id, grip.path, at, "guess", f"{name}: drag to move")
        elif grip.id in known.sizes:
            yield Handle(grip.id, grip.path, at, "size", f"{name}: drag to change its size")
        elif grip.id in known.whole:
            yield Handle(grip.id, grip.path, at, "guess", f"{name}: drag to move the drawing")


def _is_slide(view: View, handle: str) -> bool:
    """True for a point that moves only with everything else."""
    known = _ways(view)
    return handle in known.whole and handle not in known.own and handle not in known.sizes


def _slides(view: View, handle: str) -> bool:
    """Tells whether numbers of the text hold the whole drawing: often the solver puts it back anyway."""
    return _can_slide(view, _ways(view).whole[handle].directions)


@lru_cache(maxsize=16)
def _can_slide(view: View, directions: tuple[Vec, ...]) -> bool:
    """Tries it with one of the points that move along some directions: all of them move alike."""
    known = _ways(view)
    for grip, (x, y) in _places(view):
        way = known.whole.get(grip.id)
        if way is None or way.directions != directions or not _is_slide(view, grip.id):
            continue
        dx, dy = (sum(each) * _PROBE for each in zip(*directions, strict=True))
        dragged = _pulled(view, grip, (x + dx, y + dy), STEP)
        return isinstance(dragged, Dragged) and not isinstance(dragged.edits, Refusal)
    return False


def _outermost(view: View, found: list[Handle]) -> list[Handle]:
    """Returns one handle for each place, those of outer things first, and far ones before near ones."""
    outcome = view.outcome
    if outcome is None or outcome.model is None:
        return []
    depth = {grip.id: grip.depth for grip in _grips(view)}
    box = outcome.model.root.box
    middle = ((box.left + box.right) / 2, (box.bottom + box.top) / 2) if box is not None else (0.0, 0.0)
    kinds = ("guess", "size", "param")
    slides = {handle.id for handle in found if _is_slide(view, handle.id)}

    def order(handle: Handle) -> tuple[float, ...]:
        return handle.id in slides, kinds.index(handle.moves), depth[handle.id]

    places: dict[tuple[float, float], Handle] = {}
    for handle in sorted(found, key=order):
        places.setdefault((round(handle.at[0], 5) + 0.0, round(handle.at[1], 5) + 0.0), handle)
    kept = sorted(places.values(), key=lambda h: (depth[h.id], -math.dist(h.at, middle)))
    return kept[:MOST_HANDLES]


def _name(grip: Grip) -> str:
    path = grip.path.partition(".")[2] or grip.path
    return f"{path}.{grip.name}" if grip.name else path


def _by_param(grip: Grip, params: tuple[str, ...]) -> str:
    return f"{_name(grip)}: drag to change {first_few(ticked(params), _NAMED, ' or others', ' or ')}"


def _pulled(view: View, grip: Grip, to: Vec, step: float) -> Dragged | Refusal:
    outcome, known = view.outcome, _ways(view)
    way = known.own.get(grip.id) or known.sizes.get(grip.id) or known.whole.get(grip.id)
    if outcome is None or way is None:
        return Refusal("there is nothing to drag")
    by_sizes = grip.id in known.sizes and grip.id not in known.own
    written = _written(view)
    sizes = frozenset(u for u in written if by_sizes and u.kept and belongs(u, grip.thing))
    pin = _grips_of(view).get(way.pin or "")
    try:
        found = pulled(outcome, Pull(grip, way, pin, written, _movable(view), sizes), to)
    except TooLongError as reason:
        return Refusal(str(reason))
    if found is None:
        return Refusal(f"`{_name(grip)}` cannot go there: the constraints would not hold")
    shown, at = found
    return Dragged(replace(view, outcome=shown, drawn=shown), at, view, grip, step)


def _edits(view: View, dragged: Dragged) -> tuple[Edit, ...] | Refusal:
    shown = dragged.view.outcome
    assert shown is not None
    changed = _changed(view, shown)
    if not changed:
        return Refusal("no number of the text would change by it")
    everything = [
        (g, v)
        for g in _editable(view)
        if shown.evaluate is not None and (v := g.valued(shown.evaluate)) is not None
    ]
    for numbers in (changed, everything):
        for step in (dragged._step, _FINE):
            edits = tuple(_written_as(view, numbers, step))
            if edits and _comes_to(view, edits, dragged, 2 * max(step, _FINE * 10)):
                return edits
    return Refusal("no numbers in the text would hold it there")


def _changed(view: View, shown: Compiled) -> list[tuple[Guess, float]]:
    assert view.outcome is not None
    assert view.outcome.evaluate is not None
    assert shown.evaluate is not None
    found = []
    for guess in _editable(view):
        before, after = guess.valued(view.outcome.evaluate), guess.valued(shown.evaluate)
        if before is not None and after is not None and abs(after - before) * guess.factor > _FINE:
            found.append((guess, after))
    return found


def _written_as(view: View, numbers: list[tuple[Guess, float]], step: float) -> Iterator[Edit]:
    for guess, value in numbers:
        text = shortest(value, step / 2 / guess.factor) + guess.unit
        if text != guess.span.text:
            yield Edit(guess.span, text)


def _comes_to(view: View, edits: tuple[Edit, ...], dragged: Dragged, tolerance: float) -> bool:
    """Tells whether the edited text solves with the point as shown, and with no further errors."""
    again = edited(view, edits, hasty())
    assert again.outcome is not None
    assert view.outcome is not None
    grip = _grips_of(again).get(dragged._grip.id)
    if grip is None or again.outcome.evaluate is None:
        return False
    errors = {d.code for d in again.outcome.errors}
    shown = dragged.view.outcome
    known = (*view.outcome.errors, *(shown.errors if shown is not None else ()))
    if not errors <= {d.code for d in known}:
        return False
    if math.dist(grip.at(again.outcome.evaluate), dragged.at) <= tolerance:
        return True
    # A drawing that the text does not place may move as a whole.
    is_same_shape = shown is not None and is_same(shown, again.outcome, slid=True, tolerance=tolerance)
    return is_same_shape and not _is_slide(view, grip.id)


__all__ = ["MOST_HANDLES", "Dragged", "Handle", "drag", "grips", "handles", "is_somewhere"]
