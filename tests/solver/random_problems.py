"""Random sketches."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from tests.amount import tries

from .kinds import KINDS, SMOOTH, Kind
from .sketches import Circle, Group, Link, Point, Sketch

GRID = 10.0
"""Points lie on a grid this wide, so that they line up, coincide and are equally far apart by chance."""


def profile(examples: int) -> settings:
    large = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]
    return tries(examples, suppress_health_check=large)


@dataclass(frozen=True)
class Taste:
    """What kinds of sketches are wanted; `noise` is how far each coordinate is written from the solution."""

    kinds: tuple[str, ...] = SMOOTH
    points: tuple[int, int] = (2, 6)
    circles: tuple[int, int] = (0, 2)
    groups: int = 0
    links: tuple[int, int] = (1, 8)
    senses: tuple[str, ...] = ("=",)
    noise: float = 0.5
    size_noise: float = 0.0
    kept: bool = False
    placed: bool = False


def kinds_where(predicate: Callable[[Kind], bool]) -> tuple[str, ...]:
    return tuple(name for name in SMOOTH if predicate(KINDS[name]))


@st.composite
def sketches(draw: st.DrawFn, taste: Taste = Taste()) -> Sketch:
    cell = st.integers(-3, 3).map(lambda i: i * GRID)
    spots = st.tuples(cell, cell)
    off = st.integers(-8, 8).map(lambda i: i / 8 * taste.noise)
    groups: list[Group] = []
    for _ in range(draw(st.integers(0, taste.groups))):
        groups.append(Group(draw(st.integers(0, len(groups))), draw(spots), draw(st.tuples(off, off))))
    group = st.integers(0, len(groups))
    points = tuple(
        Point(draw(spots), draw(st.tuples(off, off)), draw(group))
        for _ in range(draw(st.integers(*taste.points)))
    )
    circles = tuple(
        Circle(
            draw(st.integers(0, len(points) - 1)),
            draw(st.integers(1, 6)) * GRID / 2,
            draw(off) * (taste.size_noise / taste.noise if taste.noise else 0.0),
            taste.kept,
        )
        for _ in range(draw(st.integers(*taste.circles)))
    )
    sketch = Sketch(points, circles, tuple(groups))
    return sketch.with_links(draw(links(sketch, taste)) for _ in range(draw(st.integers(*taste.links))))


@st.composite
def links(draw: st.DrawFn, sketch: Sketch, taste: Taste) -> Link:
    names = [name for name in taste.kinds if sketch.circles or "c" not in KINDS[name].operands]
    name = draw(st.sampled_from(names))
    counts = {"p": len(sketch.points), "c": len(sketch.circles)}
    link = Link(name, tuple(draw(st.integers(0, counts[letter] - 1)) for letter in KINDS[name].operands))
    paths = [list(sketch.path(sketch.points[i].group)) for i in sketch.anchors(link)]
    common = [group for group in paths[0] if all(group in path for path in paths)]
    sense = draw(st.sampled_from(taste.senses))
    return replace(
        link,
        holder=draw(st.sampled_from(common)),
        sense=sense,
        room=0.0 if sense == "=" else draw(st.integers(0, 4)) / 4,
        placed=taste.placed and draw(st.booleans()),
    )
