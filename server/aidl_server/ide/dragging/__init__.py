"""Drags a point of the drawing: the points that can move, the new drawing, and the edits of the text."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import field, replace
from functools import cached_property, lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from aidl_lang import pipeline
from aidl_lang.building.expression import Evaluator, Unknown
from aidl_lang.building.lower import Lowered, lower
from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import Edit, TooLongError
from aidl_lang.common.names import fold
from aidl_lang.common.prose import first_few, shortest, ticked
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Vec
from aidl_lang.pipeline import Compiled
from aidl_lang.solver import Settings, Solution, Status, solve
from aidl_lang.syntax import ast
from aidl_lang.tools.agents.workspace import RefusalError, edit_at
from aidl_server.ide.dragging import mobility
from aidl_server.ide.dragging.mobility import AXES, Grip, Ways, is_somewhere
from aidl_server.ide.guesses import Guess, guesses, is_same
from aidl_server.ide.references import CannotError
from aidl_server.ide.workspace import Solved, View, edited, hasty, run

# --- Points that follow a `param`: found by turning each param a little; the values wanted by secants.

MOST_KNOBS = 12
_SECONDS = 0.6
"""Time for trying all params once; the rest are not used for dragging."""
_NUDGE = 1e-3
"""Change of a param that shows what follows it, as a share of its range or value."""
_FOLLOWS = 1e-2
"""Least motion of a point that follows a param, mm per unit."""
_LAZY = 0.1
"""Motion per unit, mm, at which a param is preferred half as much as one with a large effect."""
_ROUNDS = 5
_BESIDE = 0.3
"""Sine of the least angle between the ways of two params that count as different."""


def turned(view: View, grip: str, to: Vec, step: float) -> tuple[View, Vec, tuple[Edit, ...]]:
    """Returns the program with one or two params changed, the point, and the edits of their defaults."""
    tries = _tries(view)
    values = tries.values(grip, to, step)
    shown = tries.run(values)
    at = _places(shown).get(grip)
    if at is None:
        raise CannotError("the program does not solve with the param turned that far")
    known = ((tries.knobs[path], value) for path, value in values.items())
    found = ((knob, _declaration(view, knob), value) for knob, value in known if value != knob.value)
    try:
        edits = tuple(edit_at(knob, node, value) for knob, node, value in found if node is not None)
    except RefusalError as refused:
        raise CannotError(refused.diagnostics[0].message) from None
    return shown, at, edits


@lru_cache(maxsize=4)
def slopes(view: View) -> Mapping[str, Mapping[str, Vec]]:
    """Returns for each point the params that it follows, with its velocity per unit of each."""
    before, found = _places(view), dict[str, dict[str, Vec]]()
    until = time.monotonic() + _SECONDS
    numeric = (knob for knob in view.knobs if isinstance(knob.value, float) and not knob.choices)
    inside = (knob for knob in numeric if fold(knob.path) not in view.set_outside)
    written = [knob for knob in inside if _declaration(view, knob) is not None]
    for knob in written[:MOST_KNOBS] if before else ():
        if time.monotonic() > until:
            break
        nudge = _nudge(knob)
        params = {**(view.params or {}), knob.path: float(knob.value) + nudge}
        if (placed := pipeline.placed(view.program, params)) is None:
            continue
        for grip in mobility.grips(placed[0]):
            if grip.id in before:
                x, y = ((b - a) / nudge for a, b in zip(before[grip.id], grip.at(placed[1]), strict=True))
                if is_somewhere((x, y)) and math.hypot(x, y) > _FOLLOWS:
                    found.setdefault(grip.id, {})[knob.path] = x, y
    return found


def _declaration(view: View, knob: Knob) -> ast.Param | None:
    node = view.declaration(knob)
    if node is None or node.span.source is not view.source:
        return None
    number = node.value.operand if isinstance(node.value, ast.Unary) else node.value
    return node if isinstance(number, ast.Number) else None


def _nudge(knob: Knob) -> float:
    value = float(knob.value)
    if knob.range is None:
        return knob.step or _NUDGE * max(1.0, abs(value))
    low, high = knob.range
    nudge = knob.step or _NUDGE * (high - low) or _NUDGE
    return nudge if value + nudge <= high else -nudge


def _places(view: View) -> dict[str, Vec]:
    """Returns all points; none of a program that does not solve."""
    solved = view.solved
    if solved is None or not solved.holds:
        return {}
    return {grip.id: grip.at(solved.evaluate) for grip in mobility.grips(solved.built)}


class _Tries:
    """Runs of a view with other params. A drag begins each step where the one before has ended."""

    def __init__(self, view: View) -> None:
        self.view = view
        self.knobs = {knob.path: knob for knob in reversed(view.knobs)}
        self._shown: tuple[Mapping[str, float], View] = {}, view
        self._ended: dict[tuple[str, ...], Mapping[str, float]] = {}
        """the last values, by the point and the params that it followed"""

    def run(self, values: Mapping[str, float]) -> View:
        changed = {path: value for path, value in values.items() if value != self.knobs[path].value}
        if changed != self._shown[0]:
            params = {**(self.view.params or {}), **changed}
            self._shown = changed, run(self.view, self.view, params=params, settings=hasty())
        return self._shown[1]

    def values(self, grip: str, to: Vec, step: float) -> dict[str, float]:
        """Returns the values of one or two params that bring a point nearest to a place."""
        at = _places(self.view).get(grip)
        paths = list(self._leading(grip, at, to)) if at is not None else []
        if at is None or not paths:
            return {}
        knobs = [self.knobs[path] for path in paths]
        values = np.array([float(knob.value) for knob in knobs])
        slope = np.array([slopes(self.view)[grip][path] for path in paths]).T
        last = self._ended.get((grip, *paths))
        if last is not None and (there := _places(self.run(last)).get(grip)) is not None:
            values, at = np.array([last[path] for path in paths]), there
        for _ in range(_ROUNDS):
            off = np.subtract(to, at)
            change = np.linalg.lstsq(slope, off, rcond=None)[0]
            if np.linalg.norm(slope @ change) <= step:
                break
            fine = step / np.maximum(np.linalg.norm(slope, axis=0), _FOLLOWS)
            aims = zip(knobs, (values + change).tolist(), fine.tolist(), strict=True)
            aimed = np.array([_rounded(knob, _clamped(knob, value), by) for knob, value, by in aims])
            if (aimed == values).all():
                break
            there = _places(self.run(dict(zip(paths, aimed.tolist(), strict=True)))).get(grip)
            if there is None:
                break
            gone = aimed - values
            slope = slope + np.outer(np.subtract(there, at) - slope @ gone, gone) / (gone @ gone)
            values, at = aimed, there
        self._ended[grip, *paths] = dict(zip(paths, values.tolist(), strict=True))
        return dict(self._ended[grip, *paths])

    def _leading(self, grip: str, at: Vec, to: Vec) -> Iterator[str]:
        """Yields the params that can move a point most, the second in another direction than the first."""
        ways, wanted = slopes(self.view).get(grip, {}), (to[0] - at[0], to[1] - at[1])
        by_promise = sorted(ways, key=lambda path: -_promise(self.knobs[path], wanted, ways[path]))
        for path in by_promise[:1]:
            yield path
            yield from [other for other in by_promise if _is_beside(ways[other], ways[path])][:1]


_tries = lru_cache(maxsize=4)(_Tries)


def _promise(knob: Knob, wanted: Vec, way: Vec) -> float:
    """Returns how far a param could move a point along a way in its range, weighted by effect per unit."""
    slope, along, value = math.hypot(*way), _along(wanted, way), float(knob.value)
    room = abs(_clamped(knob, value + along / slope) - value) * slope
    return min(abs(along), room) * slope / (slope + _LAZY)


def _clamped(knob: Knob, value: float) -> float:
    low, high = knob.range or (-math.inf, math.inf)
    return min(max(value, low), high)


def _rounded(knob: Knob, value: float, tolerance: float) -> float:
    """Rounds a value to the steps of a param, or to few digits; keeps the ends of its range."""
    if value in (knob.low, knob.high):
        return value
    if knob.step:
        start = knob.low or 0.0
        value = start + round((value - start) / knob.step) * knob.step
        return _clamped(knob, float(shortest(value, 1e-9)))
    return _clamped(knob, float(shortest(value, abs(tolerance) / 2)))


def _along(v: Vec, way: Vec) -> float:
    return (v[0] * way[0] + v[1] * way[1]) / math.hypot(*way)


def _is_beside(a: Vec, b: Vec) -> bool:
    return abs(a[0] * b[1] - a[1] * b[0]) > _BESIDE * math.hypot(*a) * math.hypot(*b)


_WEIGHT = 1e4
"""Weight of the wish that moves the point, beside the preferences of the program."""
_DEAR = 1e-3
"""Ratio of changes that count alike: of a number that only follows, and of one that is pulled."""
_CHANGED = 1e-9
_THERE = 1e-6
_SETTINGS = Settings(tolerance=1e-10, seconds=1.0, explain=False)


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
_DOES = {
    "own": ("guess", "move"),
    "size": ("size", "change its size"),
    "whole": ("guess", "move the drawing"),
}
"""What changes in the text where a point has a way by numbers, and what dragging it does."""


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
    _find: Callable[[], tuple[Edit, ...]] = field(repr=False)

    @cached_property
    def edits(self) -> tuple[Edit, ...]:
        """Returns the edits that keep the point there: only the numbers that changed. Raises CannotError."""
        return self._find()


@record(eq=False)
class _Hold(Solved):
    """What can be taken hold of in a solved view, and the numbers that move it."""

    view: View
    _tried: dict[tuple[Vec, ...], bool] = field(default_factory=dict)

    @cached_property
    def editable(self) -> list[Guess]:
        return [guess for guess in guesses(self.view) if not guess.is_shared]

    @cached_property
    def written(self) -> frozenset[Unknown]:
        return frozenset(u for guess in self.editable for u in guess.unknowns)

    @cached_property
    def movable(self) -> frozenset[Unknown]:
        return mobility.movable(self.built, self.evaluate, self.written)

    @cached_property
    def grips(self) -> dict[str, Grip]:
        found = [grip for grip in mobility.grips(self.built) if grip.may_move(self.written)]
        return {grip.id: grip for grip in sorted(found, key=lambda grip: grip.depth)[:_MOST_GRIPS]}

    @cached_property
    def places(self) -> list[tuple[Grip, Vec]]:
        placed = ((grip, grip.at(self.evaluate)) for grip in self.grips.values())
        return [(grip, at) for grip, at in placed if is_somewhere(at)]

    @cached_property
    def ways(self) -> Ways:
        found = [grip for grip, _ in self.places]
        return mobility.ways(self.built, found, self.evaluate, self.written, self.movable)

    def is_slide(self, handle: str) -> bool:
        """True for a point that moves only with everything else."""
        return handle in self.ways and self.ways[handle].by == "whole"

    def slides(self, grip: Grip, at: Vec) -> bool:
        """Tells whether numbers of the text hold the whole drawing: often the solver puts it back anyway. It
        is tried with one of the points that move along the same directions.
        """
        directions = self.ways[grip.id].directions
        if directions not in self._tried:
            dx, dy = (sum(each) * _PROBE for each in zip(*directions, strict=True))
            try:
                edits = _pulled(self, grip, (at[0] + dx, at[1] + dy), STEP).edits
            except CannotError:
                edits = ()
            self._tried[directions] = bool(edits)
        return self._tried[directions]


@lru_cache(maxsize=4)
def _hold(view: View) -> _Hold | None:
    return _Hold(**vars(view.solved), view=view) if view.solved is not None and view.solved.holds else None


def handles(view: View) -> list[Handle]:
    """Returns the points that can be dragged."""
    hold = _hold(view)
    return [] if hold is None else _outermost(hold, _found(hold, slopes(view)))


def _found(hold: _Hold, known: Mapping[str, Iterable[str]]) -> Iterator[Handle]:
    """Yields them as they are written; `known` are the params that each follows."""
    for grip, at in hold.places:
        way = hold.ways.get(grip.id)
        if grip.id in known and (way is None or way.by == "whole"):
            names = ticked(path.rpartition(".")[2] for path in known[grip.id])
            moves, does = "param", f"change {first_few(names, _NAMED, ' or others', ' or ')}"
        elif way is not None and (way.by != "whole" or hold.slides(grip, at)):
            moves, does = _DOES[way.by]
        else:
            continue
        yield Handle(grip.id, grip.path, at, moves, f"{_name(grip)}: drag to {does}")


def drag(view: View, handle: str, to: Vec, step: float = STEP) -> Dragged:
    """Returns the program with a point dragged as near to a place as it can come. Raises CannotError."""
    if not (is_somewhere(to) and max(abs(to[0]), abs(to[1])) <= _FARTHEST):
        raise CannotError("that place is too far away")
    if not (math.isfinite(step) and step > 0):
        raise CannotError("the step is a length")
    hold = _hold(view)
    found = next((h for h in handles(view) if h.id == handle), None)
    if hold is None or found is None:
        raise CannotError("there is nothing to drag by this name")
    grip = hold.grips[handle]
    if found.moves != "param":
        return _pulled(hold, grip, to, step)
    shown, at, edits = turned(view, handle, to, step)
    return Dragged(shown, at, lambda: edits)


def _outermost(hold: _Hold, found: Iterable[Handle]) -> list[Handle]:
    """Returns one handle for each place, those of outer things first, and far ones before near ones."""
    depth = {grip.id: grip.depth for grip in hold.grips.values()}
    box = hold.model.root.box
    middle = ((box.left + box.right) / 2, (box.bottom + box.top) / 2) if box is not None else (0.0, 0.0)
    kinds = ("guess", "size", "param")

    def order(handle: Handle) -> tuple[float, ...]:
        return hold.is_slide(handle.id), kinds.index(handle.moves), depth[handle.id]

    places: dict[tuple[float, float], Handle] = {}
    for handle in sorted(found, key=order):
        places.setdefault((round(handle.at[0], 5) + 0.0, round(handle.at[1], 5) + 0.0), handle)
    kept = sorted(places.values(), key=lambda h: (depth[h.id], -math.dist(h.at, middle)))
    return kept[:MOST_HANDLES]


def _name(grip: Grip) -> str:
    path = grip.path.partition(".")[2] or grip.path
    return f"{path}.{grip.name}" if grip.name else path


# --- Pulls a point towards a place with as little other motion as possible.


def _pulled(hold: _Hold, grip: Grip, to: Vec, step: float) -> Dragged:
    """Returns the program with the point as near to a place as it can come. Unknowns without a number in the
    text move only if nothing else will do.
    """
    way = hold.ways.get(grip.id)
    if way is None:
        raise CannotError("there is nothing to drag")
    of_thing = (u for u in hold.written if u.kept and mobility.belongs(u, grip.thing))
    sizes = frozenset(of_thing if way.by == "size" else ())
    more = [mobility.pull(hold.built, grip, way.directions, to, _WEIGHT)]
    if (pin := hold.grips.get(way.pin or "")) is not None:  # a point that stays meanwhile
        more.append(mobility.pull(hold.built, pin, AXES, pin.at(hold.evaluate), None))
    lowered = lower(replace(hold.built, constraints=[*hold.built.constraints, *more]))

    def off(found: tuple[Solution[Lowered], Vec]) -> float:
        x, y = found[1][0] - to[0], found[1][1] - to[1]
        return max(abs(u * x + v * y) for u, v in way.directions)

    found: list[tuple[Solution[Lowered], Vec]] = []
    for loose in (hold.written, hold.movable):
        if (each := _solved(hold, lowered, grip, sizes, loose)) is not None:
            found.append(each)
            if off(each) <= _THERE:
                break
    if not found:
        raise CannotError(f"`{_name(grip)}` cannot go there: the constraints would not hold")
    solution, at = min(found, key=lambda each: round(off(each), 6))
    try:
        shown = pipeline.redrawn(hold.outcome, solution)
    except TooLongError as reason:
        raise CannotError(str(reason)) from None
    dragged = replace(hold.view, outcome=shown, drawn=shown)
    return Dragged(dragged, at, partial(_edits, hold, grip, at, step, dragged))


def _solved(
    hold: _Hold, lowered: Lowered, grip: Grip, sizes: AbstractSet[Unknown], loose: AbstractSet[Unknown]
) -> tuple[Solution[Lowered], Vec] | None:
    """Returns the nearest solution that changes only `loose` unknowns and the sizes to change, and the
    point's place. All is solved at once, since it all holds as it is. With sizes, positions only follow.
    """
    at = mobility.values_at(lowered, hold.evaluate)
    resized, said = _are(lowered, sizes), _are(lowered, hold.written) & ~lowered.kept
    free = resized | (_are(lowered, loose) & ~lowered.kept)
    flat = replace(
        lowered,
        initial=at,
        scale=np.where(resized if sizes else said, 1.0, _DEAR) * lowered.scale,
        kept=~free,
        group=np.zeros(len(at), dtype=np.intp),
        frame_of=np.full(len(at), -1),
        parent=np.array([-1]),
        holder=np.zeros_like(lowered.holder),
        named=False,
        standing=_are(lowered, frozenset()),
        spanned=_are(lowered, frozenset()),
        thing=np.zeros(len(at), dtype=np.intp),
        observables=(),
    )
    solution = solve(flat, _SETTINGS)
    place = grip.at(Evaluator(lowered.by_unknown(solution.values)))
    if solution.status is not Status.SOLVED or not is_somewhere(place):
        return None
    guessed = np.array([u.guess for u in lowered.unknowns])
    changed = lowered.kept & (np.abs(solution.values - guessed) > _CHANGED * lowered.scale)
    return replace(solution, problem=lowered, changed=tuple(np.flatnonzero(changed).tolist())), place


def _are(lowered: Lowered, unknowns: AbstractSet[Unknown]) -> NDArray[np.bool_]:
    return np.array([u in unknowns for u in lowered.unknowns], dtype=np.bool_)


# --- Writes it into the text.


def _edits(hold: _Hold, grip: Grip, at: Vec, step: float, dragged: View) -> tuple[Edit, ...]:
    """Returns the fewest and shortest numbers that place a point as the dragged program shows it."""
    shown = dragged.solved
    assert shown is not None
    everything = [(g, v) for g in hold.editable if (v := g.valued(shown.evaluate)) is not None]
    changed = [
        (guess, after)
        for guess, after in everything
        if (before := guess.valued(hold.evaluate)) is not None and abs(after - before) * guess.factor > _FINE
    ]
    if not changed:
        raise CannotError("no number of the text would change by it")
    for numbers in (changed, everything):
        for fineness in (step, _FINE):
            texts = ((g, shortest(value, fineness / 2 / g.factor) + g.unit) for g, value in numbers)
            edits = tuple(Edit(g.span, text) for g, text in texts if text != g.span.text)
            if edits and _comes_to(hold, edits, grip, at, shown.outcome, 2 * max(fineness, _FINE * 10)):
                return edits
    raise CannotError("no numbers in the text would hold it there")


def _comes_to(
    hold: _Hold, edits: tuple[Edit, ...], grip: Grip, at: Vec, shown: Compiled, tolerance: float
) -> bool:
    """Tells whether the edited text solves with the point as shown, and with no further errors."""
    again = _hold(edited(hold.view, edits, hasty()))
    if again is None or (there := again.grips.get(grip.id)) is None:
        return False
    known = {d.code for d in (*hold.outcome.errors, *shown.errors)}
    if not {d.code for d in again.outcome.errors} <= known:
        return False
    if math.dist(there.at(again.evaluate), at) <= tolerance:
        return True
    # A drawing that the text does not place may move as a whole.
    is_same_shape = is_same(shown, again.outcome, slid=True, tolerance=tolerance)
    return is_same_shape and not hold.is_slide(grip.id)
