"""Fillets and chamfers as large as fits: the sizes that `max` stands for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from aidl_lang.common.running import checkpoint
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.finishing import Work, finish, largest

_DOUBLINGS = 40
_SAME = 1e-8
_NOTHING = 1e-6
_MORE = 1e-6
"""A size that may not grow by this share does not grow."""


def fitted(curves: Sequence[Piece], works: Sequence[Work], runs: Sequence[int], extent: float) -> list[Work]:
    """Returns works with sizes: all of a run have the largest that fits, 0 if none does; those of run 0 have
    one already. Runs grow together, and each until one of its corners has no more room.
    """
    sizes: dict[int, float] = {}
    while growing := sorted({run for run in runs if run and run not in sizes}):
        trial = partial(_fit, curves, works, runs, sizes)
        size = _largest(partial(_level, trial, growing), extent)
        level = dict.fromkeys(growing, size)
        larger = max(size * (1 + _MORE), 2 * _NOTHING * extent)
        stuck = [run for run in growing if not trial(level | {run: larger}, [run])]
        sizes |= dict.fromkeys(stuck or growing, size)
    return _sized(works, runs, sizes)


def _level(fits: Callable[[dict[int, float], list[int]], bool], runs: list[int], size: float) -> bool:
    """Tells whether runs fit that all have one size."""
    return fits(dict.fromkeys(runs, size), runs)


def _sized(works: Sequence[Work], runs: Sequence[int], sizes: Mapping[int, float]) -> list[Work]:
    return [
        replace(work, sizes=(sizes[run], sizes[run])) if run else work
        for work, run in zip(works, runs, strict=True)
    ]


def _fit(
    curves: Sequence[Piece],
    works: Sequence[Work],
    runs: Sequence[int],
    known: Mapping[int, float],
    tried: Mapping[int, float],
    asked: Iterable[int],
) -> bool:
    """Tells whether nothing of the runs that are asked for fails or runs into another."""
    checkpoint()
    sized = [
        (w, r) for w, r in zip(_sized(works, runs, {**known, **tried}), runs, strict=True) if w.sizes[0] > 0
    ]
    asked_for = set(asked)
    own = {id(work) for work, run in sized if run in asked_for}
    failures = finish(curves, [work for work, _ in sized]).failures
    return not any(id(f.work) in own or id(f.other) in own for f in failures)


def _largest(fits: Callable[[float], bool], extent: float) -> float:
    """Returns the largest size that fits, by doubling and halving: a short number if it is one."""
    high = extent
    for _ in range(_DOUBLINGS):
        if not fits(high):
            break
        high *= 2
    found = largest(fits, high)
    if found <= _NOTHING * extent:
        return 0.0
    short = float(f"{found:.6g}")
    return short if abs(short - found) <= _SAME * found and fits(short) else found
