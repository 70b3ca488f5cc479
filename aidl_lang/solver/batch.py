"""Newton's method on many small systems at once, each of them on its own.

Systems of equal shape are stacked: their matrices become one array, and a step is taken for all of them in
the time that a few would need one by one. It is the method of `newton`, cut down to the plain course: full
steps that bring what they promise, then the polishing. A system for which that is not enough is left as it
was, for the careful method to take up. Inequalities given here are those that shall hold with equality; the
result counts only if their multipliers say that they push.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.array_program import ArrayProgram
from aidl_lang.solver.dense import CONSISTENT, INDEPENDENT, NOISE, RANK
from aidl_lang.solver.newton import GAIN, POLISHED, Clock
from aidl_lang.solver.operations import Bools, Floats, Ints

STEPS = 80
"""Evaluations of all systems, at the most."""
PULLING = 1e-9
"""Part of the greatest multiplier by which another may have the wrong sign through rounding."""


@record()
class Scaling:
    """Units of a program: origin, scale (k,), longest (k,) or None of its columns; row_scale (r,) of its
    rows.
    """

    origin: Floats
    scale: Floats
    row_scale: Floats
    longest: Floats | None


@record()
class Systems:
    """The division of a program into systems: the system of each row (r,) and of each column (k,), the
    systems that are `wanted`, and `square` if each has as many rows as columns.
    """

    of_row: Ints
    of_column: Ints
    wanted: Bools
    square: bool


def solve(
    program: ArrayProgram,
    systems: Systems,
    scaling: Scaling,
    at_most: Bools,
    tolerance: float,
    clock: Clock,
) -> tuple[Floats, Bools, Bools]:
    """Returns the values (k,) of all columns, the mask of systems that were solved (values of others mean
    nothing), and the mask of those whose linear equations contradict each other in any branch.
    """
    stacks = list(_stacks(program, systems, at_most))
    x = scaling.origin.copy()
    entries: Floats | None = None
    for _ in range(STEPS):
        if all(stack.settled for stack in stacks) or clock.expired:
            break
        residuals = program.residuals(x) / scaling.row_scale
        if entries is None or not program.linear:
            entries = program.entries() * scaling.scale[program.indices]
            entries /= scaling.row_scale[program.entry_rows]
        for stack in stacks:
            if not stack.settled:
                limit = None if scaling.longest is None else scaling.longest / scaling.scale
                stack.advance(residuals, entries, tolerance, limit)
                x[stack.columns] = scaling.origin[stack.columns] + scaling.scale[stack.columns] * stack.z
    solved, hopeless = np.zeros((2, len(systems.wanted)), dtype=np.bool_)
    for stack in stacks:
        solved[stack.systems] = stack.done
        hopeless[stack.systems] = stack.out_of_reach
    if hopeless.any():
        hopeless[systems.of_row[~program.plain]] = False
    return x, solved, hopeless


def _stacks(program: ArrayProgram, systems: Systems, at_most: Bools) -> Iterator[_Stack]:
    """Yields the wanted systems stacked by shape."""
    count = len(systems.wanted)
    rows_of = np.bincount(systems.of_row, minlength=count)
    columns_of = np.bincount(systems.of_column, minlength=count)
    row_order, row_rank = _ranks(systems.of_row, rows_of)
    column_order, column_rank = _ranks(systems.of_column, columns_of)
    first_row, first_column = np.cumsum(rows_of) - rows_of, np.cumsum(columns_of) - columns_of
    entry_system = systems.of_row[program.entry_rows]
    bent = np.zeros(count, dtype=np.bool_)
    bent[systems.of_row[~program.affine]] = True
    shape = rows_of * (int(columns_of.max(initial=0)) + 1) + columns_of
    shape[~systems.wanted] = -1
    for code in sorted(set(shape[systems.wanted].tolist())):
        members = np.flatnonzero(shape == code)
        m, k = int(rows_of[members[0]]), int(columns_of[members[0]])
        place = np.full(count, -1)
        place[members] = np.arange(len(members))
        entries = np.flatnonzero(place[entry_system] >= 0)
        at = place[entry_system[entries]] * m + row_rank[program.entry_rows[entries]]
        rows = row_order[first_row[members][:, None] + np.arange(m)]
        yield _Stack(
            members,
            rows,
            column_order[first_column[members][:, None] + np.arange(k)],
            entries,
            at * k + column_rank[program.indices[entries]],
            at_most[rows],
            bent[members],
        )


def _ranks(of: Ints, counts: Ints) -> tuple[Ints, Ints]:
    """Returns the members in order of their systems, and the place of each within its system."""
    order = np.argsort(of, kind="stable")
    rank = np.empty(len(of), dtype=np.int64)
    rank[order] = np.arange(len(of)) - np.repeat(np.cumsum(counts) - counts, counts)
    return order, rank


@record(frozen=False)
class _Stack:
    """b systems of m rows and k columns.

    systems (b,); rows (b, m), columns (b, k) of the program; entries (e,) of its Jacobian, and their places
    (e,) in (b, m, k); at_most (b, m); curved (b,) whether the nearest point has to be searched for
    """

    systems: Ints
    rows: Ints
    columns: Ints
    entries: Ints
    places: Ints
    at_most: Bools
    curved: Bools
    z: Floats = field(init=False)
    done: Bools = field(init=False)

    def __post_init__(self) -> None:
        count = len(self.systems)
        self.z = np.zeros(self.columns.shape)
        self.done = np.zeros(count, dtype=np.bool_)
        self.failed = np.zeros(count, dtype=np.bool_)
        self.out_of_reach = np.zeros(count, dtype=np.bool_)
        self.polishing = np.zeros(count, dtype=np.bool_)
        self.promised = np.full(count, np.inf)
        """The greatest sum of squared residuals allowed after the last step."""
        self.before: tuple[Floats, Floats] | None = None
        """The start of the last polishing step, and the step."""

    @property
    def settled(self) -> bool:
        return bool((self.done | self.failed).all())

    def advance(self, residuals: Floats, entries: Floats, tolerance: float, limit: Floats | None) -> None:
        """Takes one step of each system that is not settled, from the residuals and derivatives at its
        place.
        """
        b, m = self.rows.shape
        k = self.columns.shape[1]
        jacobian = np.zeros(b * m * k)
        jacobian[self.places] = entries[self.entries]
        jacobian = jacobian.reshape(b, m, k)
        r = residuals[self.rows]
        with np.errstate(all="ignore"):
            squares = np.einsum("bm,bm->b", r, r)
            met = np.abs(r).max(axis=1) <= tolerance
            self.failed |= ~self.done & ~(squares <= self.promised) & ~met
            reached = ~self.failed & ~self.done & met & ~self.polishing
            ready = reached & ~self.curved
            if self.at_most.any() and ready.any():
                ready &= self._push(jacobian)
            self.done |= ready
            self.polishing |= reached & self.curved
            moving = ~(self.done | self.failed)
            if not moving.any():
                return
            wanted = np.where(self.polishing[:, None], np.einsum("bmk,bk->bm", jacobian, self.z) - r, -r)
            point, outside = least_norm(jacobian, wanted, moving)
            feasible = ~outside.any(axis=1)
            # This is a proof by Farkas' lemma if the part out of reach pulls at no inequality.
            pulls = (np.where(self.at_most, outside, 0.0) > 0.0).any(axis=1)
            self.out_of_reach |= moving & ~feasible & ~pulls
            self.failed |= moving & ~feasible
            moving &= feasible
            self._approach(moving & ~self.polishing, point, squares, limit)
            self._polish(moving & self.polishing, point, jacobian)

    def _approach(self, which: Bools, step: Floats, squares: Floats, limit: Floats | None) -> None:
        if limit is not None:
            excess = (np.abs(step) / limit[self.columns]).max(axis=1)
            self.failed |= which & (excess > 1.0)
        self.z = np.where(which[:, None], self.z + step, self.z)
        self.promised = np.where(which, (1.0 - GAIN) * squares, self.promised)

    def _polish(self, which: Bools, point: Floats, jacobian: Floats) -> None:
        """Steps towards the projection of the origin, by Anderson's method of memory one."""
        step = np.where(which[:, None], point - self.z, 0.0)
        size = 1.0 + np.abs(self.z).max(axis=1)
        still = which & (np.abs(step).max(axis=1) <= POLISHED * size)
        self.promised[which] = np.inf
        target = self.z + step
        if self.before is not None:
            last, last_step = self.before
            change = step - last_step
            length = np.einsum("bk,bk->b", change, change)
            mix = np.where(length > 0.0, np.einsum("bk,bk->b", change, step) / length, 0.0)
            mix = np.where(np.abs(mix) < 1e3, mix, 0.0)
            known = which & ~still & (np.abs(last_step).max(axis=1) > 0.0)
            mixed = target - mix[:, None] * (self.z - last + change)
            target = np.where(known[:, None], mixed, target)
        self.before = self.z, step
        self.z = np.where(which[:, None], target, self.z)
        if still.any():
            pushing = self._push(jacobian) if self.at_most.any() else still
            self.done |= still & pushing
            self.failed |= still & ~pushing

    def _push(self, jacobian: Floats) -> Bools:
        """Returns the mask of systems whose inequalities all push against the nearest point; fails the
        others, in which some inequality is not met with equality.
        """
        multipliers = -np.einsum("bkm,bk->bm", np.linalg.pinv(jacobian), self.z)
        slack = PULLING * (1.0 + np.abs(multipliers).max(axis=1))
        pushing: Bools = (np.where(self.at_most, multipliers, 0.0) >= -slack[:, None]).all(axis=1)
        self.failed |= ~pushing & ~self.done
        return pushing


def least_norm(jacobian: Floats, y: Floats, which: Bools) -> tuple[Floats, Floats]:
    """Returns the shortest z (b, k) with J z = y for J (b, m, k), y (b, m), and the part of y that is out of
    reach (b, m).

    Only the systems in `which` (b,) are solved. If J or y is not finite, all of y is out of reach.
    """
    b, m, k = jacobian.shape
    point = np.zeros((b, k))
    outside = np.zeros((b, m))
    chosen = np.flatnonzero(which)
    j, right = jacobian[chosen], y[chosen]
    lengths = np.sqrt(np.einsum("bmk,bmk->bm", j, j))
    clear = (lengths > 0.0).all(axis=1)
    if m > k:
        clear[:] = False
    if clear.any():
        unit = j[clear] / lengths[clear][:, :, None]
        target = right[clear] / lengths[clear]
        gram = unit @ unit.transpose(0, 2, 1)
        pivots = np.linalg.cholesky(gram + 1e-12 * np.eye(m)).diagonal(axis1=1, axis2=2).min(axis=1)
        trusted = pivots > INDEPENDENT
        unit, gram, target = unit[trusted], gram[trusted], target[trusted]
        first = np.linalg.solve(gram, target[:, :, None])
        found = first + np.linalg.solve(gram, target[:, :, None] - gram @ first)
        clear[clear] = trusted
        at = chosen[clear]
        point[at] = (unit.transpose(0, 2, 1) @ found)[:, :, 0]
    finite = np.isfinite(j).all(axis=(1, 2)) & np.isfinite(right).all(axis=1)
    outside[chosen[~finite]] = np.inf
    doubtful = np.flatnonzero(~clear & finite)
    if len(doubtful):
        u, sigma, vt = np.linalg.svd(j[doubtful], full_matrices=False)
        kept = sigma > RANK * sigma[:, :1]
        target = right[doubtful]
        inner = np.where(kept, np.einsum("bmr,bm->br", u, target), 0.0)
        rest = target - np.einsum("bmr,br->bm", u, inner)
        size = np.abs(target).max(axis=1, keepdims=True)
        at = chosen[doubtful]
        scaled = np.where(kept, inner / np.where(kept, sigma, 1.0), 0.0)
        point[at] = np.einsum("br,brk->bk", scaled, vt)
        worst = np.abs(rest).max(axis=1, keepdims=True)
        outside[at] = np.where(worst > np.maximum(CONSISTENT * size, NOISE), rest, 0.0)
    return point, outside
