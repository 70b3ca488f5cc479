"""The twenty planted flips of `benchmarks.ranges` in other solvers: how many they pass over in silence.

    .peers/bin/python -m benchmarks.ranges_peers      in the environment that `solver/install_peers.py` makes

Each sketch is solved at equal steps over the range of its param: from the guesses as drawn, and from the
solution of the step before. It flips if what is drawn lies on one side at some values, and on the other at
others, though the solver says each time that all is well.
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from benchmarks.solver.contestant import Contestant, UnsupportedError
from benchmarks.solver.peers.planegcs import PlaneGCS
from benchmarks.solver.peers.solvespace import PythonSolveSpace
from benchmarks.solver.sketch import Sketch

BARS = ((12.3, 40), (30, 35), (33.7, 50), (41, 44), (8.9, 61))
LEANS = (0, 11, -17.5, 24)
WHEELS = ((14.0, 9), (22.2, 15), (37.5, 4), (5.5, 3))
BALLS = ((30, 6), (41.7, 10), (25, 4), (36, 15))
SPOTS = ((19, 12), (28.4, 5), (7.7, 9))
"""Where each flips, and a length of it."""

_WELL = frozenset({"OKAY", "Success", "Converged"})
"""What the solvers say of a result with which nothing is wrong."""
_EXACT = 1e-4
"""How far from both sides a solution is of neither, mm."""
_X: dict[str, Any] = {"t": "fix_x", "p": 2}


@dataclass(frozen=True)
class Flip:
    """A sketch with one number that is varied.

    at      returns the sketch at a value of the param, with its guesses as drawn
    side    returns on which side the solution lies, by its points and radii; about 0 where there is none
    """

    low: float
    high: float
    at: Callable[[float], Sketch]
    side: Callable[[float, list[float]], float]


def flips() -> Iterator[Flip]:
    for place, long in BARS:
        yield Flip(0, 50, partial(_bars, place, long), _above)
    for place in LEANS:
        yield Flip(-60, 60, partial(_lean, place), partial(_sense, place))
    for place, radius in WHEELS:
        yield Flip(0, 45, partial(_wheel, place, radius), _above)
    for place, radius in BALLS:
        yield Flip(20, 50, partial(_balls, place, radius), lambda big, x: math.hypot(x[2], x[3]) - big)
    for place, far in SPOTS:
        yield Flip(0, 40, partial(_spot, place, far), _above)


def _above(high: float, x: list[float]) -> float:
    return x[5] - high


def _sense(place: float, lean: float, x: list[float]) -> float:
    return math.sin(math.radians(lean - place)) * x[5]


def _fixed(point: int, x: float, y: float) -> dict[str, Any]:
    return {"t": "fixed", "p": point, "x": x, "y": y}


def _bars(place: float, long: float, high: float) -> Sketch:
    held = [_fixed(0, 0, high), _fixed(1, 60, high)]
    lengths = [{"t": "distance", "a": k, "b": 2, "v": long} for k in (0, 1)]
    return Sketch([[0, high], [60, high], [31, place]], [[0, 2], [1, 2]], [], [], [*held, *lengths])


def _lean(place: float, lean: float) -> Sketch:
    tip = [40 * math.cos(math.radians(50)), 40 * math.sin(math.radians(50))]
    held = [_fixed(0, 0, 0), _fixed(1, 80, 0), {"t": "distance", "a": 0, "b": 2, "v": 40}]
    stated = {"t": "angle", "l": 0, "m": 1, "v": lean - place, "mode": "signed"}
    return Sketch([[0, 0], [80, 0], tip], [[0, 1], [0, 2]], [], [], [*held, stated])


def _wheel(place: float, radius: float, high: float) -> Sketch:
    held = [_fixed(0, 0, high), _fixed(1, 80, high), {"t": "radius", "k": ("c", 0), "v": radius}]
    stated = {"t": "tangent_line", "l": 0, "k": ("c", 0)}
    return Sketch(
        [[0, high], [80, high], [30, place]], [[0, 1]], [[2, radius]], [], [*held, {**_X, "v": 30}, stated]
    )


def _balls(place: float, radius: float, big: float) -> Sketch:
    sizes = [{"t": "radius", "k": ("c", k), "v": size} for k, size in enumerate((big, radius))]
    held = [_fixed(0, 0, 0), {"t": "fix_y", "p": 1, "v": 0}, *sizes]
    stated = {"t": "tangent_curves", "k": ("c", 0), "k2": ("c", 1)}
    return Sketch([[0, 0], [place, 0]], [], [[0, big], [1, radius]], [], [*held, stated])


def _spot(place: float, far: float, high: float) -> Sketch:
    held = [_fixed(0, 0, high), _fixed(1, 80, high), {**_X, "v": 30}]
    stated = {"t": "point_line_distance", "p": 2, "l": 0, "v": far, "signed": True}
    return Sketch([[0, high], [80, high], [30, place]], [[0, 1]], [], [], [*held, stated])


def fate(peer: Contestant, flip: Flip, steps: int, *, follows: bool) -> str:
    """Returns what becomes of a sketch on the way of its param."""
    sides = set[bool]()
    start: list[float] | None = None
    for k in range(steps + 1):
        value = flip.low + (flip.high - flip.low) * (k + 0.37) / (steps + 1)  # beside the places themselves
        sketch = flip.at(value)
        if follows and start is not None:
            places = [start[2 * i : 2 * i + 2] for i in range(len(sketch.points))]
            sketch = replace(sketch, points=places)
        if isinstance(peer, PlaneGCS):  # its distances have no sign; those of SolveSpace keep theirs
            stated = [{name: c[name] for name in c if name != "signed"} for c in sketch.constraints]
            sketch = replace(sketch, constraints=stated)
        try:
            built = peer.build(sketch)
        except UnsupportedError:
            return "cannot be stated"
        said = peer.solve(built)
        start = peer.read(built)
        if said not in _WELL:
            return f"is told: {said}"
        side = flip.side(value, start)
        if abs(side) > _EXACT:
            sides.add(side > 0)
    return "flips in silence" if len(sides) == 2 else "keeps its side"


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--steps", type=int, default=200)
    steps = parser.parse_args().steps
    for kind in (PythonSolveSpace, PlaneGCS):
        for follows in (False, True):
            fates = [fate(kind(), flip, steps, follows=follows) for flip in flips()]
            start = "the step before" if follows else "the guess"
            told = ", ".join(f"{count} {what}" for what, count in Counter(fates).most_common())
            print(f"{kind.__name__} {kind.version}, {steps} steps, each from {start}: {told}", flush=True)


if __name__ == "__main__":
    main()
