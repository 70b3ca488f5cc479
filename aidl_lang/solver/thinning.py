"""Moves as few things as can be found, rather than all a little.

The nearest point at which some rows hold spreads a change over everything that is free. Where that leaves a
choice, the columns of the linearised rows are looked through from what is cheapest to move to what is
dearest, and only those are kept that reach further than the ones before them (a basis, as in the simplex
method). What the rows need is then a combination of these columns, and things without a share in it are held.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from aidl_lang.solver.freezing import Freezer
from aidl_lang.solver.operations import Floats
from aidl_lang.solver.problem import Relation

if TYPE_CHECKING:
    from aidl_lang.solver.branches import Verdict
    from aidl_lang.solver.hierarchy import Hierarchy
    from aidl_lang.solver.tiers import Scope

STILL = 1e-9
"""Moves below this, in units of the unknown's scale, count as none."""
TIGHT = 10.0
"""Factor of its tolerance within which an inequality is on its bound."""
INDEPENDENT = 1e-7
"""Least part of a column that other columns leave if it reaches further than they do."""
REACHED = 1e-6
"""Part of a change within which two changes are the same."""
ASTRAY = 0.2
"""Part of the way promised by slopes by which what bends may end elsewhere."""
FURTHER = 2.4
"""Factor of the way to the nearest point that something in curved rows may go so that other things can
stay.
"""
MANY = 400
"""The most moved unknowns that are thinned; above, the nearest point is kept."""

Rank: TypeAlias = "Callable[[int], tuple[int, ...]]"
"""The cost class of moving an unknown: a greater one is dearer."""


def thin(hierarchy: Hierarchy, scope: Scope, before: dict[int, float], rank: Rank) -> None:
    """Holds unknowns of `scope` that need not move. `before` are their values before a move to the current
    ones, which satisfy its constraints.
    """
    moved = _moved(hierarchy, before)
    if len({int(hierarchy.problem.thing[unknown]) for unknown in moved}) < 2 or len(moved) > MANY:
        return
    needed, expected = _needed(hierarchy, scope, moved, rank)
    if len(needed) == len(moved):
        return
    reached = hierarchy.save(scope.free)
    hierarchy.values.assign(before.items())
    verdict: Verdict = hierarchy.attempt(replace(scope, free=frozenset(needed)), 0)
    # A part that can stay is worth a long way of something within another.
    spared = any(hierarchy.problem.frame_of[unknown] >= 0 for unknown in moved.keys() - needed)
    furthest = np.inf if spared else FURTHER * max(map(abs, moved.values()))
    if not verdict.satisfied or not _as_expected(_moved(hierarchy, before), furthest, expected):
        hierarchy.values.assign(reached.items())


def _as_expected(moved: dict[int, float], furthest: float, expected: dict[int, float]) -> bool:
    """Tells whether unknowns in curved rows moved about as far as the slopes promised, not through a singular
    place, and no unknown further than `furthest`.
    """
    if expected and max(map(abs, moved.values()), default=0.0) > furthest:
        return False
    off = sum((moved.get(unknown, 0.0) - step) ** 2 for unknown, step in expected.items())
    return off <= ASTRAY**2 * sum(step * step for step in expected.values())


def _moved(hierarchy: Hierarchy, before: dict[int, float]) -> dict[int, float]:
    """Returns the move of each unknown that moved, in units of its scale."""
    scale, unknowns = hierarchy.problem.scale, hierarchy.values.unknowns
    found = {u: float((unknowns[u] - x) / scale[u]) for u, x in before.items()}
    return {u: step for u, step in found.items() if abs(step) > STILL}


def _needed(
    hierarchy: Hierarchy, scope: Scope, moved: dict[int, float], rank: Rank
) -> tuple[set[int], dict[int, float]]:
    """Returns a sufficient set of the unknowns that moved, and the moves that the slopes promise to those of
    them in curved rows.
    """
    tolerance, values = hierarchy.settings.tolerance, hierarchy.values
    rows = hierarchy.rows(scope.constraints)
    hierarchy.refresh(scope.constraints)
    roots = [
        row.expression
        for row in rows
        if row.relation is Relation.EQUAL or values.nodes[row.expression] > -TIGHT * tolerance * row.scale
    ]
    thing = hierarchy.problem.thing
    needed: set[int] = set()
    expected: dict[int, float] = {}
    for program in Freezer(values, moved).freeze(roots).programs:
        columns = [int(unknown) for unknown in program.columns]
        steps = np.array([moved[unknown] for unknown in columns])
        program.residuals(np.array([values.unknowns[unknown] for unknown in columns]))
        matrix = program.jacobian(np.ones(len(program.rows)), hierarchy.problem.scale[columns])
        if not isinstance(matrix, np.ndarray):  # large, and left as it is
            needed.update(columns)
            continue
        things: dict[int, list[int]] = {}
        for column, unknown in enumerate(columns):
            things.setdefault(int(thing[unknown]), []).append(column)
        dearness = {
            number: (
                max(rank(columns[i]) for i in members),
                -round(float(np.abs(steps[members]).max()), 6),
                min(hierarchy.name(columns[i]) for i in members),
                members,
            )
            for number, members in things.items()
        }
        order = [column for number in sorted(things, key=dearness.__getitem__) for column in things[number]]
        share = _combination(matrix, matrix @ steps, order)
        chosen = [i for members in things.values() if any(share[i] for i in members) for i in members]
        if len(chosen) == len(columns):  # nothing can stay as a whole
            chosen = [i for members in things.values() for i in _tied(matrix, share, members)]
        needed.update(columns[i] for i in chosen)
        if chosen and not program.linear:
            found = np.linalg.lstsq(matrix[:, chosen], matrix @ steps, rcond=None)[0]
            expected.update(zip((columns[i] for i in chosen), found.tolist(), strict=True))
    return needed, expected


def _tied(matrix: Floats, share: list[bool], members: list[int]) -> list[int]:
    """Returns the columns of a thing that have a share, and those that a row ties to one of them; a
    coordinate that the others do not depend on can stay by itself.
    """
    slopes = np.abs(matrix)
    sloping = slopes > REACHED * slopes.max(axis=1, initial=0.0, keepdims=True)
    moving = sloping[:, [i for i in members if share[i]]].any(axis=1)
    return [i for i in members if share[i] or bool((sloping[:, i] & moving).any())]


def _combination(matrix: Floats, target: Floats, order: list[int]) -> list[bool]:
    """Returns the mask of columns (k,) of a matrix (r, k) that have a share in a combination that gives
    `target` (r,), using up those first that come first in `order`.
    """
    used: list[int] = []
    directions = np.zeros((0, len(target)))
    rest, size = target.copy(), float(np.abs(target).max(initial=0.0))
    for column in order:
        if float(np.abs(rest).max(initial=0.0)) <= REACHED * size:
            break
        vector = matrix[:, column]
        length = float(np.linalg.norm(vector))
        for _ in range(2):  # twice is enough (Giraud, Langou, Rozloznik, doi:10.1016/j.camwa.2005.08.009)
            vector = vector - directions.T @ (directions @ vector)
        if (left := float(np.linalg.norm(vector))) > INDEPENDENT * length > 0.0:
            used.append(column)
            directions = np.vstack((directions, vector / left))
            rest = rest - directions[-1] * float(directions[-1] @ rest)
    found = [False] * matrix.shape[1]
    if used:
        factors = np.linalg.lstsq(matrix[:, used], target, rcond=None)[0]
        for column, factor in zip(used, factors.tolist(), strict=True):
            found[column] = abs(factor) > REACHED * float(np.abs(factors).max())
    return found
