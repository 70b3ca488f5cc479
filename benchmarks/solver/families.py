"""Families of sketches of any size: as many equations as unknowns, a known solution, a start that is off.

    chain   rectangles in a row, each aligned with the one before and 3 mm from it
    grid    circles of one radius, 10 mm apart
    truss   triangles given by the lengths of their sides alone

The noise moves each coordinate of the solution by up to `noise` times the family's feature size, evenly
distributed, and multiplies each radius by 1 ± noise. Points that are fixed start where they are fixed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.solver.sketch import Constraint, Floats, Sketch

NOISE = 0.1


@dataclass(frozen=True)
class Family:
    """`make` takes a size; n unknowns need about `size_for(n)`."""

    make: Callable[[int], tuple[Sketch, float]]
    size_for: Callable[[int], int]

    def sketch(self, size: int, seed: int = 1, noise: float = NOISE) -> tuple[Sketch, Floats]:
        """A sketch of this size, and its solution."""
        sketch, feature = self.make(size)
        solution = sketch.start
        random = np.random.default_rng(seed)
        places = np.array(sketch.points)
        shifts = random.uniform(-1.0, 1.0, places.shape) * noise * feature
        shifts[[c["p"] for c in sketch.constraints if c["t"] == "fixed"]] = 0.0
        sketch.points[:] = (places + shifts).tolist()
        for circle, change in zip(
            sketch.circles, random.uniform(-1.0, 1.0, len(sketch.circles)), strict=True
        ):
            circle[1] *= 1.0 + float(change) * noise
        return sketch, solution


class _Draft:
    def __init__(self) -> None:
        self.points: list[list[float]] = []
        self.lines: list[list[int]] = []
        self.circles: list[list[float]] = []
        self.constraints: list[Constraint] = []

    def point(self, x: float, y: float) -> int:
        self.points.append([float(x), float(y)])
        return len(self.points) - 1

    def line(self, a: int, b: int) -> None:
        self.lines.append([a, b])

    def say(self, kind: str, **fields: object) -> None:
        self.constraints.append({"t": kind, **fields})

    def sketch(self, name: str) -> Sketch:
        return Sketch(self.points, self.lines, self.circles, [], self.constraints, {}, name)


def _chain(size: int) -> tuple[Sketch, float]:
    draft, x = _Draft(), 0.0
    for i in range(size):
        width, height = 10.0 + i % 5, 6.0 + i % 3
        a, b = draft.point(x, 0.0), draft.point(x + width, 0.0)
        c, d = draft.point(x + width, height), draft.point(x, height)
        for start, end in ((a, b), (b, c), (c, d), (d, a)):
            draft.line(start, end)
        draft.say("horizontal", a=a, b=b)
        draft.say("vertical", a=b, b=c)
        draft.say("horizontal", a=d, b=c)
        draft.say("vertical", a=a, b=d)
        draft.say("distance", a=a, b=b, v=width)
        draft.say("distance", a=a, b=d, v=height)
        if i == 0:
            draft.say("fixed", p=a, x=0.0, y=0.0)
        else:
            draft.say("horizontal", a=a - 3, b=a)
            draft.say("hdist", a=a - 3, b=a, v=3.0)
        x += width + 3.0
    return draft.sketch(f"chain-{size}"), 6.0


def _grid(size: int) -> tuple[Sketch, float]:
    draft = _Draft()
    for row in range(size):
        for column in range(size):
            here = draft.point(10.0 * column, 10.0 * row)
            draft.circles.append([here, 4.0])
            if here == 0:
                draft.say("fixed", p=0, x=0.0, y=0.0)
                draft.say("radius", k=["c", 0], v=4.0)
                continue
            before = here - 1 if column else here - size
            draft.say("equal_radius", k=["c", before], k2=["c", here])
            draft.say("horizontal" if column else "vertical", a=before, b=here)
            draft.say("distance", a=before, b=here, v=10.0)
    return draft.sketch(f"grid-{size}"), 10.0


def _truss(size: int) -> tuple[Sketch, float]:
    draft = _Draft()
    for i in range(size + 2):
        draft.point(5.0 * i, 8.0 * (i % 2))
        for j in range(max(i - 2, 0), i):
            draft.line(j, i)
            draft.say("distance", a=j, b=i, v=math.dist(draft.points[j], draft.points[i]))
    draft.say("vdist", a=0, b=1, v=8.0)
    draft.constraints.insert(0, {"t": "fixed", "p": 0, "x": 0.0, "y": 0.0})
    return draft.sketch(f"truss-{size}"), 8.0


FAMILIES = {
    "chain": Family(_chain, lambda n: max(round(n / 8), 1)),
    "grid": Family(_grid, lambda n: max(round(math.sqrt(n / 3)), 1)),
    "truss": Family(_truss, lambda n: max(round(n / 2) - 2, 1)),
}

SIZES = (10, 100, 1_000, 10_000, 100_000)
"""Unknowns, about, with which everyone is measured."""
