"""Sixty programs with one planted change of kind each, and how many of them `aidl check --range` finds.

    python -m benchmarks.ranges [--quiet FILE …]

The place of each change follows from geometry alone. A change is found if a turn of the walk lies within a
thousandth of the range from it, and a turn is false if it lies at no place that the program was made for.
With `--quiet`, other programs are walked, and what is told of them is printed. Seconds are those of the
processor.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from aidl_lang import pipeline
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld
from aidl_lang.tools.ends import SweepJob
from aidl_lang.tools.ranges import Turn, Walk, has_way, sentences
from aidl_lang.tools.ranges.walking import walked
from benchmarks.ranges_peers import BALLS, BARS, LEANS, SPOTS, WHEELS


@record()
class Planted:
    """A program whose only param changes the kind at a known value, and may do so again `later`."""

    name: str
    kinds: frozenset[str]
    text: str
    place: float
    later: float = math.inf


def flips() -> Iterator[Planted]:
    """Yields programs in which another solution is taken: a guess comes to lie on the other side."""
    kinds = frozenset({"jump", "reading"})
    for place, long in BARS:
        yield Planted(
            "two bars",
            kinds,
            f"""drawing d {{
    param high = 2 in 0..50
    tip = guess((31, {place}))
    left = line(fixed((0, high)), tip)
    right = line(fixed((60, high)), tip)
    constrain {{ left.length == {long}; right.length == {long} }}
}}""",
            place,
        )
    for place in LEANS:
        yield Planted(
            "angle",
            kinds,
            f"""drawing d {{
    param lean = 50deg in -60deg..60deg
    ground = line(fixed((0, 0)), fixed((80, 0)))
    arm = line(ground.start, length: 40, angle: guess(50deg))
    constrain {{ angle(arm, ground) == lean - {place}deg }}
}}""",
            place,
        )
    for place, radius in WHEELS:
        yield Planted(
            "circle at a line",
            kinds,
            f"""drawing d {{
    param high = 1 in 0..45
    ground = line(fixed((0, high)), fixed((80, high)))
    wheel = circle(center: guess((30, {place})), radius: {radius})
    constrain {{ tangent(wheel, ground) }}
}}""",
            place,
        )
    for place, radius in BALLS:
        yield Planted(
            "circle at a circle",
            kinds,
            f"""drawing d {{
    param big = 21 in 20..50
    wheel = circle(center: fixed((0, 0)), radius: fixed(big))
    ball = circle(center: guess(({place}, 0)), radius: fixed({radius}))
    constrain {{ ball.center.y == 0; tangent(ball, wheel) }}
}}""",
            place,
        )
    for place, far in SPOTS:
        yield Planted(
            "distance from a line",
            kinds,
            f"""drawing d {{
    param high = 1 in 0..40
    ground = line(fixed((0, high)), fixed((80, high)))
    spot = guess((30, {place}))
    mark = circle(center: spot, radius: 1)
    constrain {{ distance(spot, ground) == {far} }}
}}""",
            place,
        )


def topologies() -> Iterator[Planted]:
    """Yields programs in which openings, pieces or outlines change."""
    openings, pieces = frozenset({"openings"}), frozenset({"pieces", "openings", "warning"})
    for radius, wide in ((3.0, 80), (7.5, 100), (2.2, 61), (10, 90), (5, 74)):
        yield Planted(
            "hole at the edge",
            openings,
            f"""solid plate {{
    param way = 0 in 0..{wide / 2 + 4}
    body = rectangle(center: origin, width: {wide}, height: 50)
    hole bore {{ rim = circle(center: (way, 0), radius: {radius}) }}
}}""",
            wide / 2 - radius,
            wide / 2 + radius,
        )
    for radius, far in ((6, 30), (4.4, 25), (8, 44), (3, 20), (9.1, 31)):
        yield Planted(
            "holes that meet",
            openings,
            f"""solid plate {{
    param apart = {far} in 1..{far + 8}
    body = rectangle(center: origin, width: 120, height: 60)
    hole a {{ rim = circle(center: (-apart / 2, 0), radius: {radius}) }}
    hole b {{ rim = circle(center: (apart / 2, 0), radius: {radius}) }}
}}""",
            2 * radius,
        )
    for radius, broad in ((4, 20), (6.3, 12), (2, 31)):
        yield Planted(
            "hole at a window",
            openings,
            f"""solid plate {{
    param way = 55 in 5..60
    body = rectangle(center: origin, width: 160, height: 60)
    hole window {{ pane = rectangle(center: origin, width: {broad}, height: 30) }}
    hole bore {{ rim = circle(center: (way, 0), radius: {radius}) }}
}}""",
            broad / 2 + radius,
            broad / 2 - radius,
        )
    for high, most in ((40.0, 55), (31, 33), (52.5, 90), (26, 40)):
        yield Planted(
            "plate in two",
            pieces,
            f"""solid plate {{
    param cut = 10 in 5..{most}
    body = rectangle(center: origin, width: 100, height: {high})
    hole slit {{ saw = rectangle(center: origin, width: 8, height: cut) }}
}}""",
            high,
        )
    for x, low in ((30, 10), (45, 18), (22, 4)):
        yield Planted(
            "outline across itself",
            frozenset({"warning", "edge", "pieces"}),
            f"""solid plate {{
    param tip = 50 in -30..60
    body = polygon((0, 0), (80, {low}), (80, 60), ({x}, tip), (0, 60))
}}""",
            low * x / 80,
        )


def contacts() -> Iterator[Planted]:
    """Yields programs in which parts begin to overlap or let go."""
    kinds = frozenset({"contact", "warning"})
    for gap, most in ((20, 40), (7.5, 30), (33.3, 40), (12, 14), (3, 50), (26, 27)):
        yield Planted(
            "blocks",
            kinds,
            f"""@allow("W0705")
assembly pair {{
    param shift = 0 in 0..{most}
    solid a {{ body = rectangle(center: fixed((shift, 0)), width: 40, height: 20) }}
    solid b {{ body = rectangle(center: fixed(({40 + gap}, 0)), width: 40, height: 20) }}
}}""",
            gap,
        )
    for a, b in ((10, 20), (12.5, 8), (31, 6), (15, 15), (4, 9), (22, 25)):
        yield Planted(
            "discs",
            kinds,
            f"""@allow("W0705")
assembly pair {{
    param apart = {a + b + 9} in {(a + b) / 2}..{a + b + 10}
    solid a {{ body = circle(center: fixed((0, 0)), radius: {a}) }}
    solid b {{ body = circle(center: fixed((0.6 * apart, 0.8 * apart)), radius: {b}) }}
}}""",
            a + b,
        )
    for place in (10, 21.4, 6, 29):
        yield Planted(
            "a block that stays",
            kinds,
            f"""assembly pair {{
    param way = 1 in 0..35
    solid a {{ body = rectangle(center: fixed((0, 0)), width: 40, height: 20) }}
    solid b {{ body = rectangle(center: fixed((40 + max(0, way - {place}), 0)), width: 40, height: 20) }}
}}""",
            place,
        )
    for thick, place in ((3, 15), (6, 24.6), (4, 8), (5, 33)):
        yield Planted(
            "plates that cross",
            kinds,
            f"""@thickness({thick}mm)
assembly pair {{
    param way = 1 in 0..45
    solid a {{ body = rectangle(center: fixed((0, 0)), width: 40, height: 20) }}
    solid b {{ body = rectangle(center: fixed(({40 - place} + way, 0)), width: 40, height: 20) }}
}}""",
            place,
        )


def planted() -> list[Planted]:
    return [*flips(), *topologies(), *contacts()]


def walk_of(text: str, name: str = "it.aidl") -> tuple[list[Walk], float]:
    """Walks each param of a program; returns the seconds of the processor too."""
    world = DiskWorld(Path(name).parent)
    job = SweepJob(name, text, world, pipeline.Settings())
    compiled = pipeline.compile(SourceFile(name, text), world)
    if not compiled.ok:
        raise ValueError([d.message for d in compiled.diagnostics])
    start = time.process_time()
    walks = [walked(job, knob, math.inf) for knob in compiled.knobs if has_way(knob)]
    return walks, time.process_time() - start


def judged(case: Planted, walk: Walk) -> tuple[bool, int]:
    """Tells whether the change is told at its place, and how many turns are false."""
    low, high = walk.knob.range or (0.0, 0.0)
    slack = 1.1e-3 * (high - low)

    def is_at(turn: Turn, place: float) -> bool:
        return min(turn.before, turn.after) - slack <= place <= max(turn.before, turn.after) + slack

    kinds = {c.kind for turn in walk.turns if is_at(turn, case.place) for c in turn.changes}
    false = [t for t in walk.turns if not (is_at(t, case.place) or is_at(t, case.later))]
    return bool(case.kinds & kinds), len(false)


def main() -> None:
    if sys.argv[1:2] == ["--quiet"]:
        for name in sys.argv[2:]:
            walks, seconds = walk_of(Path(name).read_text("utf-8"), name)
            told = [text for walk in walks for text in sentences(walk)]
            tried, each = sum(len(walk.tried) for walk in walks), seconds / max(1, len(walks))
            print(f"{Path(name).stem:28} {len(walks)} params, {tried:4} values, {each:5.1f} s each")
            print(*(f"    {text}" for text in told), sep="\n", end="\n" * bool(told), flush=True)
        return
    for family in (flips, topologies, contacts):
        cases, found, false, seconds = list(family()), 0, 0, 0.0
        for case in cases:
            (walk,), took = walk_of(case.text)
            is_found, others = judged(case, walk)
            found, false, seconds = found + is_found, false + others, seconds + took
            if others or not is_found:
                print(f"{case.name} at {case.place}:", *sentences(walk), sep="\n    ")
        told_of = f"{found} of {len(cases)} found, {false} false"
        print(f"{family.__name__:12} {told_of}, {seconds / len(cases):.2f} s each")


if __name__ == "__main__":
    main()
