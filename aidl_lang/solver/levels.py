"""All groups of one depth at once: the first stages of `hierarchy` for models of many parts.

Groups of one depth have nothing in common that either could move, so what is done for one can be done for all
in the same sweep over arrays: which constraints are violated, what becomes free, the systems that follow and
their solution. A part for which the plain course fails is left untouched for `hierarchy`, which knows more
ways; whether a result counts is decided by the original expressions in either case. So is a part in which
more moved than its rows ask for, unless it is so large that the nearest point has to do.

Systems of equal shape are stacked: their matrices become one array, and a step is taken for all of them in
the time that a few would need one by one. It is the method of `newton`, cut down to the plain course: full
steps that bring what they promise, then the polishing. A system for which that is not enough is left as it
was, for the careful method to take up. Inequalities in it are those that shall hold with equality; the
result counts only if their multipliers say that they push.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver import newton
from aidl_lang.solver.array_program import ArrayFreezing, ArrayProgram, Schedule
from aidl_lang.solver.branches import TIGHTER, Metric
from aidl_lang.solver.expression import Bools, Floats, Ints
from aidl_lang.solver.hierarchy import riding_depths
from aidl_lang.solver.linear import each_once, marked, places, stacked_least_norm
from aidl_lang.solver.loosening import DEPTHS, MOST, STILL, Tier, stage_name, tiers_at
from aidl_lang.solver.newton import GAIN, POLISHED, Clock, End, System
from aidl_lang.solver.problem import Problem, Settings, StageReport, depths, violations
from aidl_lang.solver.valuation import Sorted, components

ROUNDS = 4
"""Rounds of taking up inequalities that came to be violated."""
STACKED = 4096
"""Entries of a Jacobian up to which systems are stacked; larger ones are solved one by one."""
STEPS = 80
"""Evaluations of all stacked systems, at the most."""
PULLING = 1e-9
"""Part of the greatest multiplier by which another may have the wrong sign through rounding."""
STANDING = 2 * DEPTHS + 1
"""The first tier whose members give way only if they have to, and are reported then."""


class Levels:
    """A solve of a problem, depth by depth. `x` (n,) are the values, which are moved in place."""

    def __init__(self, problem: Problem, x: Floats, settings: Settings, clock: Clock, metric: Metric) -> None:
        self.problem, self.settings, self.clock, self.metric = problem, settings, clock, metric
        self.schedule = Schedule(problem.tape)
        self.x = x
        depth = depths(problem.parent)
        self._holder_depth = depth[problem.holder]
        self._unknown_depth = depth[problem.group]
        self._rides = riding_depths(problem, depth)
        self._has_things = bool(problem.thing.any())
        self._hard = np.isnan(problem.weight)
        self.binding = self._hard.copy()
        """The hard constraints that have not been given up."""
        self._pairs = self._incidence()
        self.constraints, self.unknowns = (n.astype(np.intp) for n in np.divmod(self._pairs, len(x)))
        """Pairs of a constraint and an unknown in it, by constraint."""
        self._evaluated: tuple[Floats, Floats] | None = None

    def _incidence(self) -> Ints:
        """Returns pairs of a constraint and an unknown in it, ascending: n times the one plus the other."""
        problem = self.problem
        everything = np.ones(len(problem.initial), dtype=np.bool_)
        freezing = ArrayFreezing(self.schedule, problem.tape.constants, everything, choosing=False)
        self._everything = freezing if freezing.knows_all_values else None
        """The rows with all unknowns free, for stages that free all; None if values have a part in it."""
        rows = np.flatnonzero(freezing.varies(problem.rows.expression))
        row, unknown = freezing.pattern(problem.rows.expression[rows])
        key = problem.rows.constraint[rows[row]].astype(np.int64) * len(everything) + unknown
        return each_once(key)

    def nodes(self) -> Floats:
        """Returns the value (m,) of each node of the tape at `x`."""
        if self._evaluated is None or not np.array_equal(self._evaluated[0], self.x):
            self._evaluated = self.x.copy(), self.schedule.evaluate(self.x)
        return self._evaluated[1]

    # -- one depth

    def solve(self, depth: int, known: Bools) -> Iterator[tuple[Tier, StageReport]]:
        """Solves the groups at `depth` as far as it can, except those `known` (g,); yields its stages, for
        each part that they decided.
        """
        problem = self.problem
        holds = self._all(self._holding(self.nodes()))
        active = self.binding & (self._holder_depth >= depth)
        held = active & (self._holder_depth == depth) & ~known[problem.holder]
        violated = held & ~holds
        if not violated.any():
            return
        of_constraint, of_unknown = self._parts(active)
        parts = int(max(of_constraint.max(), of_unknown.max(initial=0))) + 1
        left = marked(of_constraint[violated], parts)
        tier = self._tiers(depth, held)
        pairs = active[self.constraints] & left[of_constraint[self.constraints]]
        mentioned = marked(self.unknowns[pairs], len(problem.initial))
        group_of = np.zeros(len(left), dtype=np.intp)
        group_of[of_constraint[held]] = problem.holder[held]
        tried = np.zeros(len(left), dtype=np.intp)
        for code in sorted(set(tier[mentioned & (tier < STANDING)].tolist())):
            hopeful = left & self._promising(violated, of_constraint, tier <= code, len(left))
            scope, free = self._scope(active, held & hopeful[of_constraint], tier <= code)
            count = np.bincount(of_unknown[free], minlength=len(left))
            hopeful &= count > tried
            scope &= hopeful[of_constraint]
            free &= hopeful[of_unknown]
            if not hopeful.any():
                continue
            tried = np.maximum(tried, count)
            rows = np.flatnonzero(scope[problem.rows.constraint])
            part = of_constraint[problem.rows.constraint[rows]]
            solved, hopeless = self._attempt(rows, part, free, hopeful, of_unknown)
            left &= ~hopeful | hopeless
            decided = np.flatnonzero(hopeful & (solved | hopeless))
            considered = np.bincount(part, minlength=len(left))
            tier_of = divmod(code, DEPTHS)
            columns = (column[decided].tolist() for column in (group_of, count, considered, solved))
            for group, *result in zip(*columns, strict=True):
                yield tier_of, StageReport(group, stage_name(tier_of), *result)
            if not left.any() or self.clock.expired:
                return

    def unsolved(self, depth: int) -> Ints:
        """Returns the groups at `depth` with a hard constraint that does not hold."""
        holds = self._all(self._holding(self.nodes()))
        found: Ints = self.problem.holder[self.binding & (self._holder_depth == depth) & ~holds]
        return found

    def _holding(self, nodes: Floats) -> Bools:
        return violations(self.problem, nodes) <= self.settings.tolerance * self.problem.rows.scale

    def _all(self, holding: Bools) -> Bools:
        return ~marked(self.problem.rows.constraint[~holding], len(self.problem.holder))

    # -- parts and scopes

    def _parts(self, active: Bools) -> tuple[Ints, Ints]:
        """Returns the connected part, by active constraints, of each constraint and of each unknown."""
        count = len(active)
        pairs = np.flatnonzero(active[self.constraints])
        labels = components(self.constraints[pairs], self.unknowns[pairs] + count, count + len(self.x))
        return labels[:count], labels[count:]

    def _tiers(self, depth: int, held: Bools) -> Ints:
        """Returns the tier (see `loosening`) of each unknown (n,) below a group at `depth`, as one number."""
        problem = self.problem
        pairs = problem.placed[:, held[problem.placed[0]]]
        width = len(self.x)
        placed = np.full(width, -1)
        if pairs.size and len(self._pairs):
            wanted = pairs[0].astype(np.int64) * width + pairs[1]
            nearest = np.minimum(np.searchsorted(self._pairs, wanted), len(self._pairs) - 1)
            placed[pairs[1, self._pairs[nearest] == wanted]] = 0
        return tiers_at(depth, problem, self._unknown_depth, self._rides, placed)

    def _promising(self, violated: Bools, of_constraint: Ints, free: Bools, parts: int) -> Bools:
        """Returns the mask of parts (p,) that have something free in every violated constraint."""
        reachable = marked(self.constraints[free[self.unknowns]], len(violated))
        return ~marked(of_constraint[violated & ~reachable], parts)

    def _scope(self, active: Bools, seeds: Bools, allowed: Bools) -> tuple[Bools, Bools]:
        """Returns the closure of the seeds: the constraints, and the free unknowns that they mention, with
        all constraints on these, and so on.
        """
        pairs = np.flatnonzero(active[self.constraints] & allowed[self.unknowns])
        constraints, unknowns = self.constraints[pairs], self.unknowns[pairs]
        scope, free = seeds.copy(), np.zeros(len(allowed), dtype=np.bool_)
        size = -1
        while size != (size := int(np.count_nonzero(scope))):
            free[unknowns[scope[constraints]]] = True
            scope[constraints[free[unknowns]]] = True
        return scope, free

    # -- one stage

    def _attempt(
        self, rows: Ints, part: Ints, free: Bools, hopeful: Bools, of_unknown: Ints
    ) -> tuple[Bools, Bools]:
        """Solves the rows (k,) of the parts (k,) with the unknowns `free` (n,). Returns the parts (p,) that
        succeed and are moved, and those that certainly cannot.
        """
        problem = self.problem
        nodes = self.nodes()
        holding = self._holding(nodes)[rows]
        freezing = self._everything
        if freezing is None or not free[self.unknowns].all():
            freezing = ArrayFreezing(self.schedule, nodes, free)
        considered = ~problem.rows.at_most[rows]  # and those that turn out to be violated without them
        varying = freezing.varies(problem.rows.expression[rows])
        left, solved = hopeful.copy(), np.zeros(len(hopeful), dtype=np.bool_)
        hopeless = marked(part[~varying & ~holding], len(hopeful))
        left &= ~hopeless
        for _ in range(ROUNDS):
            if not left.any() or self.clock.expired:
                break
            chosen, x = np.flatnonzero(considered & varying & left[part]), self.x
            if len(chosen):
                x, failed, contrary = self._solve_rows(freezing, rows[chosen], part[chosen], len(left))
                hopeless |= left & contrary
                left &= ~failed
            reached = self.schedule.evaluate(x)
            holds = self._holding(reached)[rows]
            unmet = marked(part[~holds], len(left))
            accepted = left & ~unmet
            accepted &= ~self._leaves_a_choice(x, free, of_unknown, part[considered & varying], len(left))
            moved = free & accepted[of_unknown]
            self.x[moved] = x[moved]
            if np.array_equal(self.x, x):
                self._evaluated = self.x.copy(), reached
            solved |= accepted
            left &= unmet
            fresh = ~holds & ~considered
            left &= marked(part[fresh], len(left))
            considered |= fresh
        return solved, hopeless

    def _leaves_a_choice(self, x: Floats, free: Bools, of_unknown: Ints, part: Ints, parts: int) -> Bools:
        """Returns the mask of parts (p,) that moved more unknowns than they have rows and are small enough to
        find out which unknowns can be held; `part` (k,) is the part of each row. The last parts may be
        without unknowns.
        """
        moved = free & (np.abs(x - self.x) > STILL * self.metric.scale)
        movers = np.bincount(of_unknown[moved], minlength=parts)
        rows = np.bincount(part, minlength=parts)
        found: Bools = (movers > rows) & (movers <= MOST) & self._has_things
        return found

    def _solve_rows(
        self, freezing: ArrayFreezing, rows: Ints, part: Ints, parts: int
    ) -> tuple[Floats, Bools, Bools]:
        """Returns the values (n,) that satisfy the rows, the parts in which some row could not be satisfied,
        and the parts in which some row certainly cannot be.
        """
        program, listed = freezing.program(self.problem.rows.expression[rows]), self.problem.rows
        height, width = program.shape
        labels = components(program.entry_rows, program.indices + height, height + width)
        count = int(labels.max(initial=-1)) + 1
        of_row, of_column = Sorted(labels[:height], count), Sorted(labels[height:], count)
        wanted = of_row.count * of_column.count <= STACKED
        x = self.x.copy()
        solved, hopeless = np.zeros((2, count), dtype=np.bool_)
        if wanted.any():
            reached, solved, hopeless = self._solve_stacked(program, rows, of_row, of_column, wanted)
            x[program.columns] = np.where(solved[of_column.part], reached, x[program.columns])
        elif bool((of_row.count == of_column.count).all()) and count > 1:
            # Systems that leave no choice may be solved as one.
            solved[:] = self._solve_alone(program, rows, x) is End.CONVERGED
        choosy = marked(of_row.part[listed.at_most[rows]], count)  # which of them bind is to be searched for
        for system in np.flatnonzero((~wanted | choosy) & ~solved & ~hopeless).tolist():
            members = np.sort(of_row.members(system))
            whole = len(members) == len(rows)
            alone = program if whole else freezing.program(listed.expression[rows[members]])
            end = self._solve_alone(alone, rows[members], x)
            solved[system] = end is End.CONVERGED
            hopeless[system] = end is End.INFEASIBLE and bool(alone.plain.all())
        failed, contrary = part[~solved[of_row.part]], part[hopeless[of_row.part]]
        return x, marked(failed, parts), marked(contrary, parts)

    def _solve_stacked(
        self, program: ArrayProgram, rows: Ints, of_row: Sorted, of_column: Sorted, wanted: Bools
    ) -> tuple[Floats, Bools, Bools]:
        """Returns the values (k,) of all columns, the mask of the wanted systems that were solved (values of
        others mean nothing), and the mask of those whose linear equations contradict each other in any
        branch.
        """
        metric, columns = self.metric, program.columns
        origin, scale, row_scale = self.x[columns], metric.scale[columns], self.problem.rows.scale[rows]
        longest = metric.longest[columns] / scale
        stacks = list(_stacks(program, of_row, of_column, wanted, self.problem.rows.at_most[rows]))
        x = origin.copy()
        entries: Floats | None = None
        for _ in range(STEPS):
            if all(stack.settled for stack in stacks) or self.clock.expired:
                break
            residuals = program.residuals(x) / row_scale
            if entries is None or not program.linear:
                entries = program.entries() * scale[program.indices] / row_scale[program.entry_rows]
            for stack in stacks:
                if not stack.settled:
                    stack.advance(residuals, entries, TIGHTER * self.settings.tolerance, longest)
                    x[stack.columns] = origin[stack.columns] + scale[stack.columns] * stack.z
        solved, hopeless = np.zeros((2, len(wanted)), dtype=np.bool_)
        for stack in stacks:
            solved[stack.systems] = stack.done
            hopeless[stack.systems] = stack.out_of_reach
        if hopeless.any():
            hopeless[of_row.part[~program.plain]] = False
        return x, solved, hopeless

    def _solve_alone(self, program: ArrayProgram, rows: Ints, x: Floats) -> End:
        columns, metric = program.columns, self.metric.of(program.columns)
        scales, at_most = (metric.scale, self.problem.rows.scale[rows]), self.problem.rows.at_most[rows]
        system = System(program, x[columns], *scales, at_most, metric.longest, metric.unit)
        tolerance, iterations = TIGHTER * self.settings.tolerance, self.settings.iterations
        outcome = newton.solve(system, tolerance, iterations, self.clock, restarts=0)
        if outcome.converged:
            x[columns] += metric.scale * outcome.z
        return outcome.end


def _stacks(
    program: ArrayProgram, of_row: Sorted, of_column: Sorted, wanted: Bools, at_most: Bools
) -> Iterator[_Stack]:
    entry_system = of_row.part[program.entry_rows]
    bent = marked(of_row.part[~program.affine], len(wanted))
    shape = of_row.count * (int(of_column.count.max(initial=0)) + 1) + of_column.count
    shape[~wanted] = -1
    for code in sorted(set(shape[wanted].tolist())):
        members = np.flatnonzero(shape == code)
        m, k = int(of_row.count[members[0]]), int(of_column.count[members[0]])
        place = places(members, len(wanted))
        entries = np.flatnonzero(place[entry_system] >= 0)
        at = place[entry_system[entries]] * m + of_row.place[program.entry_rows[entries]]
        rows = of_row.of[of_row.first[members][:, None] + np.arange(m)]
        yield _Stack(
            members,
            rows,
            of_column.of[of_column.first[members][:, None] + np.arange(k)],
            entries,
            at * k + of_column.place[program.indices[entries]],
            at_most[rows],
            bent[members],
        )


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
        self.done, self.failed, self.out_of_reach, self.polishing = np.zeros((4, count), dtype=np.bool_)
        self.promised = np.full(count, np.inf)
        """The greatest sum of squared residuals allowed after the last step."""
        self.before: tuple[Floats, Floats] | None = None
        """The start of the last polishing step, and the step."""

    @property
    def settled(self) -> bool:
        return bool((self.done | self.failed).all())

    def advance(self, residuals: Floats, entries: Floats, tolerance: float, limit: Floats) -> None:
        """Takes one step of each unsettled system, from the residuals and derivatives at its place."""
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
            point, outside = stacked_least_norm(jacobian, wanted, moving)
            feasible = ~outside.any(axis=1)
            # This is a proof by Farkas' lemma if the part out of reach pulls at no inequality.
            pulls = (np.where(self.at_most, outside, 0.0) > 0.0).any(axis=1)
            self.out_of_reach |= moving & ~feasible & ~pulls
            self.failed |= moving & ~feasible
            moving &= feasible
            self._approach(moving & ~self.polishing, point, squares, limit)
            self._polish(moving & self.polishing, point, jacobian)

    def _approach(self, which: Bools, step: Floats, squares: Floats, limit: Floats) -> None:
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
