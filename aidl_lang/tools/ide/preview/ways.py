"""The remaining motions as arrows and arcs on the drawing.

A motion of the model gives the velocity of each unknown. The velocities of points follow by changing the
unknowns a very little and evaluating their places again.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence

from aidl_lang.building.expression import Evaluator, Expression, Unknown, add, sub
from aidl_lang.building.lower import seen
from aidl_lang.building.model import Model, Structure, convert
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.solved import Motion
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.ide.preview.elements import Elements, box_of
from aidl_lang.tools.ide.preview.values import Arrow, Turn, Way

MOST = 40
"""Most motions shown."""
MOST_THINGS = 8
"""Most things of one motion with arrows of their own."""
MOST_POINTS = 40
"""Most points of a thing used for its motion."""
LENGTH = 0.14
"""Length of an arrow, relative to the drawing."""
_ARC = 70.0
"""Sweep of the arc for a turn about a near place, degrees."""
_NUDGE = 1e-6
"""Change of the fastest unknown, relative to the drawing."""
_SLOW = 1e-3
"""Part of the greatest speed below which a point counts as still."""


def ways(outcome: Compiled, elements: Elements) -> Iterator[Way]:
    """Yields the motions of a solved model."""
    model = outcome.model
    if model is None or outcome.built is None or outcome.evaluate is None or outcome.drawing is None:
        return
    motions = model.motions[:MOST]
    if not motions:
        return
    flow = _Flow(outcome.built, outcome.evaluate, outcome.drawing.size)
    for motion in motions:
        things = list(_things(flow, motion, elements))
        fastest = max((math.hypot(*v) for thing in things for v in thing.velocities), default=0.0)
        yield Way(
            _words(motion, elements),
            tuple(elements.all_near(motion.things)),
            tuple(arrow for thing in things for arrow in thing.arrows(motion.kind, _SLOW * fastest)),
            tuple(turn for thing in things for turn in thing.turns(motion.kind)),
        )


def _words(motion: Motion, elements: Elements) -> str:
    """Describes a motion of elements, with the name of the moving point or number of an element."""
    if len(motion.things) != 1 or (number := elements.near(motion.things[0])) is None:
        return motion.words
    inside = motion.things[0].removeprefix(elements.values[number].path).removeprefix(".")
    if not inside:
        return motion.words
    return f"{motion.words} its {inside}" if motion.kind == "change" else f"{motion.words} at its {inside}"


class _Flow:
    """The points of a model with their paths and velocities."""

    def __init__(self, model: Model, evaluate: Evaluator, size: float) -> None:
        self.size = size
        self._model, self._evaluate = model, evaluate
        self._points = [(p, s, x, y) for s in model.root.walk() for p, x, y in _points(s)]
        self._in_root: dict[int, tuple[Expression, Expression]] = {}
        self._unknowns: dict[str, list[Unknown]] = defaultdict(list)
        for unknown in model.unknowns:
            self._unknowns[unknown.path].append(unknown)

    def nudged(self, motion: Motion) -> Evaluator | None:
        """Returns an evaluator of the model after a very little of a motion."""
        fastest = max((abs(rate) for rate in motion.moves.values()), default=0.0)
        if not fastest or not math.isfinite(fastest):
            return None
        step = _NUDGE * self.size / fastest
        values = dict(self._evaluate.values)
        for path, rate in motion.moves.items():
            for unknown in self._unknowns[path]:
                values[unknown] = values.get(unknown, unknown.guess) + step * rate
        return Evaluator(values, self._evaluate.measure)

    def moving(self, nudged: Evaluator, thing: str) -> list[tuple[Vec, Vec]]:
        """Returns points of the thing at a path with their velocities; some of very many."""
        inside = f"{thing}."
        found = [k for k, (path, *_) in enumerate(self._points) if path == thing or path.startswith(inside)]
        moving = []
        for k in found[:: len(found) // MOST_POINTS + 1]:
            x, y = (self._evaluate(e) for e in self._at(k))
            u, v = (nudged(e) for e in self._at(k))
            if all(map(math.isfinite, (x, y, u, v))):
                moving.append(((x, y), (u - x, v - y)))
        return moving

    def _at(self, k: int) -> tuple[Expression, Expression]:
        """Returns a point in the frame of the root."""
        if k not in self._in_root:
            _, structure, x, y = self._points[k]
            self._in_root[k] = convert(x, y, structure, self._model.root)
        return self._in_root[k]


def _points(structure: Structure) -> Iterator[tuple[str, Expression, Expression]]:
    """Yields points of a structure's own geometry, in its frame, and two on each circle."""
    center: tuple[str, Expression, Expression] | None = None
    for _, path, numbers in seen(structure):
        if len(numbers) == 2:
            yield path, *numbers
        holder, _, name = path.rpartition(".")
        if name == "center" and len(numbers) == 2:
            center = holder, *numbers
        elif name == "radius" and center is not None and center[0] == holder:
            _, x, y = center
            yield path, add(x, numbers[0]), y
            yield path, sub(x, numbers[0]), y


@record()
class _Thing:
    """Moving points of one thing with a box. `velocity` is their mean; `spin` radians, about the `middle`, in
    the same time.
    """

    box: Bounds
    places: Sequence[Vec]
    velocities: Sequence[Vec]
    size: float

    @property
    def center(self) -> Vec:
        return (self.box[0] + self.box[2]) / 2, (self.box[1] + self.box[3]) / 2

    @property
    def middle(self) -> Vec:
        return _mean(self.places)

    @property
    def velocity(self) -> Vec:
        return _mean(self.velocities)

    @property
    def spin(self) -> float:
        x, y = self.middle
        u, v = self.velocity
        turning = spread = 0.0
        for (px, py), (vx, vy) in zip(self.places, self.velocities, strict=True):
            turning += (px - x) * (vy - v) - (py - y) * (vx - u)
            spread += (px - x) ** 2 + (py - y) ** 2
        return turning / spread if spread > 1e-12 * self.size**2 else 0.0

    @property
    def is_turning(self) -> bool:
        """True if it turns rather than shifts."""
        reach = math.hypot(self.box[2] - self.box[0], self.box[3] - self.box[1]) / 2
        return abs(self.spin) * reach > math.hypot(*self.velocity)

    def arrows(self, kind: str, slow: float) -> Iterator[Arrow]:
        """Yields one arrow for a slide; for growth, arrows from its ends outwards. Points slower than `slow`
        stand still.
        """
        if kind == "turn" or (kind == "together" and self.is_turning):
            return
        if kind in ("slide", "together") and math.hypot(*self.velocity) > slow:
            yield self._arrow(self.center, self.velocity)
            return
        moving = sorted(
            zip(self.velocities, self.places, strict=True), key=lambda each: -math.hypot(*each[0])
        )
        if not moving or math.hypot(*moving[0][0]) <= slow:
            return
        (first, at), others = moving[0], moving[1:]
        yield self._arrow(at, first)
        for velocity, place in others:
            if _dot(velocity, first) < -0.5 * math.hypot(*velocity) * math.hypot(*first) < 0:
                yield self._arrow(place, velocity)
                return

    def turns(self, kind: str) -> Iterator[Turn]:
        spin = self.spin
        if not spin or not (kind == "turn" or (kind == "together" and self.is_turning)):
            return
        (x, y), (u, v) = self.middle, self.velocity
        pole = x - v / spin, y + u / spin
        away = self.center[0] - pole[0], self.center[1] - pole[1]
        reach = max(self.box[2] - self.box[0], self.box[3] - self.box[1]) / 2
        distance = math.hypot(*away)
        if distance <= reach:  # about a place in it: around all of it
            radius, sweep, towards = max(0.7 * reach, 0.05 * self.size), _ARC, 90.0
        else:
            radius, sweep = distance, min(_ARC, math.degrees(1.5 * LENGTH * self.size / distance))
            towards = math.degrees(math.atan2(away[1], away[0]))
        sweep = math.copysign(sweep, spin)
        yield Turn(pole, radius, towards - sweep / 2, sweep)

    def _arrow(self, at: Vec, velocity: Vec) -> Arrow:
        speed = math.hypot(*velocity)
        length = LENGTH * self.size / speed
        return Arrow(at, (at[0] + length * velocity[0], at[1] + length * velocity[1]))


def _things(flow: _Flow, motion: Motion, elements: Elements) -> Iterator[_Thing]:
    """Yields the things that move in a motion, if they have points and a place."""
    nudged = flow.nudged(motion)
    if nudged is None:
        return
    for path in motion.things[:MOST_THINGS]:
        moving = flow.moving(nudged, path)
        number = elements.number.get(path)  # else it is a point, or a number, of something
        if not moving and (number := elements.near(path)) is not None:
            moving = flow.moving(nudged, elements.values[number].path)
        if moving:
            box = box_of(elements.drawn[number].model) if number is not None else None
            places, velocities = [place for place, _ in moving], [velocity for _, velocity in moving]
            box = box or union_bounds([(*place, *place) for place in places])
            yield _Thing(box, places, velocities, flow.size)


def _mean(vectors: Sequence[Vec]) -> Vec:
    return sum(v[0] for v in vectors) / len(vectors), sum(v[1] for v in vectors) / len(vectors)


def _dot(a: Vec, b: Vec) -> float:
    return a[0] * b[0] + a[1] * b[1]
