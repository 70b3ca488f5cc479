"""What is left to move, and what was said twice: degrees of freedom, free unknowns, redundant constraints.

A motion is a direction in the null space of the Jacobian of the equations that hold, over all unknowns that
are not kept sizes. Only what can be seen counts: degrees of freedom are the rank of the observables'
Jacobian on that space, so that a frame and its contents moving against each other do not count. An
inequality takes no freedom away. A frame that no constraint mentions stays where it was written.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

import numpy as np

from aidl_lang.solver.dense import independent_rows, null_space, row_space
from aidl_lang.solver.gradients import gradients
from aidl_lang.solver.operations import Floats
from aidl_lang.solver.problem import Problem, Relation
from aidl_lang.solver.valuation import Valuation

NOTHING = 1e-7
"""Components of unit vectors that count as zero."""
DEPENDENT = 1e-6
"""Part of a row that may be left when what it has in common with others is taken away."""


@dataclass(frozen=True)
class Freedom:
    """See the fields of the same names in `Solution`."""

    degrees: int | None
    group_degrees: tuple[int, ...] | None
    free: tuple[int, ...]
    redundant: tuple[int, ...]


UNCOUNTED = Freedom(None, None, (), ())


@dataclass(frozen=True)
class _Block:
    """Equations that share no unknown with others: their scaled Jacobian (r, k), and whose rows they are."""

    jacobian: Floats
    columns: list[int]
    owners: list[int]


def degrees_of_freedom(
    problem: Problem, values: Valuation, satisfied: Sequence[bool], mentioned: AbstractSet[int]
) -> Freedom:
    """Counts at the current values, with the equations of satisfied hard constraints.

    `mentioned` are the unknowns that occur in any constraint.
    """
    blocks = _equations(problem, values, satisfied)
    motions = _motions(blocks, _movable(problem, mentioned), len(problem.initial))
    visible = _observables(problem, values) @ motions
    groups = np.array([group for group, _ in problem.observables], dtype=np.int64)
    basis = row_space(visible)
    seen = motions @ basis
    return Freedom(
        degrees=basis.shape[1],
        group_degrees=tuple(_rank(visible[groups == group]) for group in range(len(problem.parent))),
        free=tuple(np.flatnonzero(np.abs(seen).max(axis=1, initial=0.0) > NOTHING).tolist()),
        redundant=tuple(sorted(index for block in blocks for index in _redundant(block))),
    )


def _equations(problem: Problem, values: Valuation, satisfied: Sequence[bool]) -> list[_Block]:
    """The equations in blocks that share no unknown; those that depend on none are left out."""
    rows = [
        (index, row)
        for index, constraint in enumerate(problem.constraints)
        if constraint.weight is None and satisfied[index]
        for row in constraint.rows
        if row.relation is Relation.EQUAL
    ]
    found = gradients(values, [row.expression for _, row in rows])
    blocks = []
    for members in components([found[row.expression] for _, row in rows]):
        columns = sorted({unknown for i in members for unknown in found[rows[i][1].expression]})
        column = {unknown: k for k, unknown in enumerate(columns)}
        jacobian = np.zeros((len(members), len(columns)))
        for r, i in enumerate(members):
            for unknown, derivative in found[rows[i][1].expression].items():
                jacobian[r, column[unknown]] = derivative / rows[i][1].scale
        blocks.append(_Block(jacobian * problem.scale[columns], columns, [rows[i][0] for i in members]))
    return blocks


def components(sets: Sequence[Iterable[int]]) -> list[list[int]]:
    """Indices of the sets in groups connected by common elements; empty sets belong to none."""
    leader: dict[int, int] = {}

    def find(element: int) -> int:
        while (above := leader.setdefault(element, element)) != element:
            leader[element] = element = leader[above]
        return element

    firsts: list[tuple[int, int]] = []
    for index, elements in enumerate(sets):
        first = None
        for element in elements:
            if first is None:
                first = element
                firsts.append((index, element))
            leader[find(element)] = find(first)
    groups: dict[int, list[int]] = {}
    for index, element in firsts:
        groups.setdefault(find(element), []).append(index)
    return list(groups.values())


def _movable(problem: Problem, mentioned: AbstractSet[int]) -> list[int]:
    """The unknowns that are not kept, but for frames that no constraint mentions."""
    frame, kept = problem.frame_of.tolist(), problem.kept.tolist()
    return [
        unknown
        for unknown in range(len(problem.initial))
        if not kept[unknown] and (frame[unknown] < 0 or unknown in mentioned)
    ]


def _motions(blocks: Iterable[_Block], movable: Sequence[int], unknowns: int) -> Floats:
    """An orthonormal basis (n, d) of the directions that leave every equation as it is."""
    rest = set(movable)
    pieces: list[tuple[list[int], Floats]] = []
    for block in blocks:
        within = [i for i, unknown in enumerate(block.columns) if unknown in rest]
        columns = [block.columns[i] for i in within]
        rest.difference_update(columns)
        if columns:
            pieces.append((columns, null_space(block.jacobian[:, within])))
    loose = sorted(rest)
    pieces.append((loose, np.eye(len(loose))))
    motions = np.zeros((unknowns, sum(piece.shape[1] for _, piece in pieces)))
    at = 0
    for columns, piece in pieces:
        motions[columns, at : at + piece.shape[1]] = piece
        at += piece.shape[1]
    return motions


def _observables(problem: Problem, values: Valuation) -> Floats:
    """The Jacobian (o, n) of the observables over all unknowns, scaled."""
    roots = [node for _, node in problem.observables]
    values.refresh(values.cone(roots))
    found = gradients(values, roots)
    jacobian = np.zeros((len(roots), len(problem.initial)))
    for i, root in enumerate(roots):
        for unknown, derivative in found[root].items():
            jacobian[i, unknown] = derivative
    return np.nan_to_num(jacobian * problem.scale)


def _rank(matrix: Floats) -> int:
    touched = np.abs(matrix).max(axis=0, initial=0.0) > NOTHING
    return int(row_space(matrix[:, touched]).shape[1])


def _redundant(block: _Block) -> list[int]:
    """Constraints all of whose rows depend on rows of those before: Gram and Schmidt, in order."""
    if independent_rows(block.jacobian):
        return []
    basis = np.zeros((0, block.jacobian.shape[1]))
    independent: dict[int, bool] = {}
    for owner, row in sorted(zip(block.owners, block.jacobian, strict=True), key=lambda pair: pair[0]):
        length = float(np.linalg.norm(row))
        independent.setdefault(owner, False)
        if length <= NOTHING:
            independent[owner] = True  # singular here: that says nothing about the constraint
            continue
        rest = row / length
        for _ in range(2):
            rest = rest - basis.T @ (basis @ rest)
        if (size := float(np.linalg.norm(rest))) > DEPENDENT:
            basis = np.vstack((basis, rest / size))
            independent[owner] = True
    return [owner for owner, counts in independent.items() if not counts]
