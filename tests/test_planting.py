"""Several conflicts in one drawing are all told, each with its set, and their fixes together solve it."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic, apply_fixes, has_errors
from aidl_lang.common.source import SourceFile


def _sizes(random: Random, r: str, c: str) -> list[str]:
    wide = random.randint(20, 30)
    return [f"{r}.width == {wide}", f"{r}.width == {wide + random.randint(3, 15)}"]


def _bounds(random: Random, r: str, c: str) -> list[str]:
    high = random.randint(20, 30)
    return [f"{r}.height >= {high + random.randint(3, 15)}", f"{r}.height <= {high}"]


def _sums(random: Random, r: str, c: str) -> list[str]:
    wide, left = random.randint(20, 30), random.randint(4, 6)  # so that room is left for a circle
    right = left + 2 * random.randint(1, 3)
    return [
        f"{r}.width == {wide}",
        f"{c}.left == {r}.left + {left}",
        f"{c}.right == {r}.right - {right}",
        f"{c}.radius == {wide + 5}",
    ]


def _ways(random: Random, r: str, c: str) -> list[str]:
    dx, dy = random.choice([(3, 4), (6, 8), (5, 12), (8, 6)])
    return [
        f"{c}.center_x == {r}.center_x + {dx}",
        f"{c}.center_y == {r}.center_y + {dy}",
        f"distance({c}.center, {r}.center) == {dx + dy + random.randint(2, 9)}",
    ]


def _insides(random: Random, r: str, c: str) -> list[str]:
    radius, margin = random.randint(8, 12), random.randint(1, 3)
    return [
        f"inside({c}, {r}, margin: {margin})",
        f"{c}.radius == {radius}",
        f"{r}.height <= {2 * radius + 2 * margin - random.randint(2, 6)}",
    ]


_KINDS: list[Callable[[Random, str, str], list[str]]] = [_sizes, _bounds, _sums, _ways, _insides]


def planted(seed: int, count: int) -> tuple[str, list[frozenset[str]]]:
    """Returns a drawing in one piece with `count` conflicts, a chain of plates, each with a circle, and the
    constraints of each conflict.
    """
    random = Random(seed)
    members = count + random.randint(1, 3)
    bad = sorted(random.sample(range(members), count))
    shapes, stated, conflicts = [], ["r0.left == 0", "r0.bottom == 0"], []
    for i in range(members):
        r, c = f"r{i}", f"c{i}"
        x = 40 * i + random.randint(0, 8)
        shapes += [
            f"{r} = rectangle(center: guess(({x}, 10)), width: guess(25), height: guess(25))",
            f"{c} = circle(center: guess(({x + 1}, 12)), radius: guess(6))",
        ]
        if i:
            stated += [
                f"{r}.left == r{i - 1}.right + {random.randint(2, 9)}",
                f"{r}.bottom == r{i - 1}.bottom",
            ]
        if i in bad:
            conflict = random.choice(_KINDS)(random, r, c)
            conflicts.append(frozenset(conflict))
            stated += conflict
        else:
            stated += [f"{r}.width == {random.randint(20, 30)}", f"{c}.center == {r}.center"]
    random.shuffle(stated)
    lines = "\n".join([*(f"  {s}" for s in shapes), "  constrain {", *(f"    {s}" for s in stated), "  }"])
    return f"drawing chain {{\n{lines}\n}}\n", conflicts


def judged(text: str, conflicts: list[frozenset[str]]) -> tuple[bool, bool, bool]:
    """Returns whether each planted conflict is told, with its constraints and no other; whether each message
    has a fix that resolves its conflict and no other; and whether all fixes together leave no error.
    """
    source = SourceFile("planted.aidl", text)
    compiled = pipeline.compile(source)
    told = [d for d in compiled.diagnostics if d.code == "E0601"]
    sets = _sets(compiled)
    return (
        sorted(sets, key=sorted) == sorted(conflicts, key=sorted),
        len(told) == len(sets) > 0 and all(_fits(source, d, sets) for d in told),
        not has_errors(_after(source, told).diagnostics),
    )


def _sets(compiled: pipeline.Compiled) -> list[frozenset[str]]:
    return [frozenset(party.text for party in c.parties) for c in compiled.conflicts()]


def _after(source: SourceFile, fixes: list[Diagnostic]) -> pipeline.Compiled:
    text, _ = apply_fixes(source, fixes)
    return pipeline.compile(SourceFile(source.name, text))


def _fits(source: SourceFile, told: Diagnostic, before: list[frozenset[str]]) -> bool:
    return told.fix is not None and len(_sets(_after(source, [told]))) == len(before) - 1


@pytest.mark.parametrize(
    ("seed", "count"),
    [(1000, 1), (2003, 2), *(pytest.param(1000 * n, n, marks=pytest.mark.slow) for n in (3, 5))],
)
def test_all_that_is_wrong_is_told_at_once_and_mended(seed: int, count: int) -> None:
    assert judged(*planted(seed, count)) == (True, True, True)


@pytest.mark.slow
@pytest.mark.parametrize("count", range(1, 6))
def test_nearly_all_that_is_planted_is_told_and_mended(count: int) -> None:
    found, _, solved = zip(*(judged(*planted(1000 * count + n, count)) for n in range(50)), strict=True)
    assert sum(found) >= 49
    assert sum(solved) >= 45
