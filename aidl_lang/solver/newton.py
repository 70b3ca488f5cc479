"""The smallest change that satisfies one system of rows.

Unknowns are measured from where they were, in units of their scales: z = (x - x0) / scale, and the solution
sought is the feasible z nearest to 0. First a damped Newton method reaches a feasible point by shortest
steps; then the point is polished: z is replaced by the projection of 0 onto the rows linearised at z until it
stays (the first-order conditions of the nearest point), sped up by Anderson's method. An affine system needs
one projection and no more. (Nocedal and Wright, Numerical Optimization, chapters 10, 11, 18; Walker and Ni,
Anderson acceleration for fixed-point iterations, doi:10.1137/10078356X.)
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import field
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.solver.expression import Floats
from aidl_lang.solver.linear import DampedSteps, Matrix, nearest

if TYPE_CHECKING:
    from aidl_lang.solver.freezing import AnyProgram

GAIN = 0.1
"""A step must bring this part of the decrease that the linearised rows promise."""
STILL = 1e-11
"""Steps shorter than this (scaled units, relative to the size of z) are no progress."""
FLAT = 1e-11
"""Slopes below this (relative to those that the residuals could give) lead nowhere."""
ROUNDED = 1e-14
"""A violation, in units of its row, that is rounding alone."""
TINY = 1e-200
"""Squares of slopes below this count as zero."""
POLISHED = 1e-10
POLISHING_STEPS = 40
MEMORY = 5
RESTARTS = (1e-3, 0.03, 0.3, 1.0, 3.0)
"""Sizes of the perturbations tried from a singular start, relative to the greatest residual."""
STEPS_ROUND = 3.0
"""Longest steps that turn a direction round: one is a sixth of a turn."""
TURNED = 4
"""The most directions that are turned round, one after another, after a search failed."""
COSTLY = 40_000
"""Entries of the Jacobian above which only one restart is tried."""
GOLDEN = 0.6180339887498949
SILVER = 0.4142135623730951
STALLED = 0.99
PATIENCE = 6
"""A search ends when `PATIENCE` steps together do not bring the residuals below `STALLED` times theirs."""


class End(Enum):
    CONVERGED = "converged"
    INFEASIBLE = "infeasible"
    """No step brings the rows closer to zero: they contradict each other, at least nearby."""
    CONTRARY = "contrary"
    """The system converged, but the original expressions do not hold there."""
    EXHAUSTED = "exhausted"
    """The iteration limit or the time limit came first."""


@record()
class NewtonResult:
    """`z` (k,) is the solution, or the best point reached; `violation` its greatest scaled violation.

    `contradiction` (r,), of affine rows that have no solution: factors, the greatest of them 1 or -1, with
    which the sum of the rows is the same everywhere, though it would have to vanish.
    """

    z: Floats
    end: End
    violation: float
    contradiction: Floats | None = None

    @property
    def converged(self) -> bool:
        return self.end is End.CONVERGED


@record(frozen=False)
class Clock:
    """The time of one solve: of this thread on the processor, whatever else the machine works on."""

    seconds: float
    start: float = field(default_factory=time.thread_time)

    @property
    def expired(self) -> bool:
        checkpoint()
        return time.thread_time() - self.start > self.seconds

    @property
    def left(self) -> float:
        return self.seconds - (time.thread_time() - self.start)


class System:
    """The rows of a program, scaled, as functions of scaled displacements.

    origin     (k,) where z = 0 is
    scale      (k,) unit of each unknown
    row_scale  (r,) unit of each row
    inequality (r,) True for `<= 0`
    longest    (k,) the largest change in one step
    unit       (k,) unit of each unknown without regard to what is kept
    softness   (r,) None, or the unit of a slack that is added to each row; 0 for hard rows. The slacks are
               further unknowns of the system, behind the others: dear ones, which is what makes a row soft.
    """

    def __init__(
        self,
        program: AnyProgram,
        origin: Floats,
        scale: Floats,
        row_scale: Floats,
        inequality: NDArray[np.bool_],
        longest: Floats,
        unit: Floats,
        softness: Floats | None = None,
    ) -> None:
        slacks = 0 if softness is None else int(np.count_nonzero(softness > 0.0))
        self.longest = np.append(longest / scale, np.full(slacks, np.inf))
        self.stretch = np.append(unit / scale, np.ones(slacks))
        self.program, self.origin, self.scale, self.inequality = program, origin, scale, inequality
        self.linear = program.linear
        self._has_inequalities = bool(inequality.any())
        self._per_row = 1.0 / row_scale
        self._slack = None if softness is None else np.diag(softness)[:, softness > 0.0]
        self._constant_jacobian: Matrix | None = None

    @property
    def size(self) -> int:
        return len(self.origin) + (0 if self._slack is None else self._slack.shape[1])

    def residuals(self, z: Floats) -> Floats:
        k = len(self.origin)
        rows = self.program.residuals(self.origin + self.scale * z[:k]) * self._per_row
        return rows if self._slack is None else rows - self._slack @ z[k:]

    def jacobian(self) -> Matrix:
        """Returns the scaled Jacobian at the place where `residuals` was last evaluated."""
        if self._constant_jacobian is not None:
            return self._constant_jacobian
        matrix = self.program.jacobian(self._per_row, self.scale)
        if self._slack is not None:
            slack = -self._slack
            matrix = np.hstack((matrix, slack)) if isinstance(matrix, np.ndarray) else matrix.beside(slack)
        if self.linear:
            self._constant_jacobian = matrix
        return matrix

    def violations(self, residuals: Floats) -> Floats:
        """Returns the violation of each row: its residual, for an inequality only if positive."""
        if not self._has_inequalities:
            return residuals
        return np.where(self.inequality, np.maximum(residuals, 0.0), residuals)


def solve(
    system: System,
    tolerance: float,
    iterations: int,
    clock: Clock,
    start: Floats | None = None,
    restarts: int = 1,
) -> NewtonResult:
    """Returns the feasible point nearest to z = 0, searched from `start` (default 0). Tries up to `restarts`
    perturbed starts if the search ends at a singular place.
    """
    solver = _Newton(system, tolerance, iterations, clock)
    best = solver.run(np.zeros(system.size) if start is None else start)
    if best.converged or (system.linear and best.end is End.INFEASIBLE):
        return best
    if len(system.origin) * len(system.inequality) > COSTLY:
        restarts = min(restarts, 1)
    for turn, amplitude in enumerate(RESTARTS[:restarts]):
        if clock.expired:
            break
        again = solver.run(perturbation(system.size, turn) * amplitude * solver.reach * system.stretch)
        if again.converged:
            return again
        if again.violation < 0.99 * best.violation:
            best = again
    for start_at in _turned(system) if restarts else ():
        if clock.expired:
            break
        again = solver.run(start_at)
        if again.converged:
            return again
    return best


def _turned(system: System) -> Iterator[Floats]:
    """Yields starts at which one of the directions among the unknowns is turned round: on the way there a
    length would have to shrink to nothing, and no search goes on from that.
    """
    turning = np.flatnonzero(np.isfinite(system.longest))
    for at in turning[:TURNED].tolist():
        start = np.zeros(system.size)
        start[at] = STEPS_ROUND * system.longest[at]
        yield start


def perturbation(size: int, turn: int = 0) -> Floats:
    """Returns a direction in which no two unknowns move alike: multiples of the golden ratio modulo 1."""
    phases = np.arange(1, size + 1) * GOLDEN + turn * SILVER
    direction: Floats = 2.0 * np.mod(phases, 1.0) - 1.0
    return direction


class _Newton:
    def __init__(self, system: System, tolerance: float, iterations: int, clock: Clock) -> None:
        self.system, self.tolerance, self.iterations, self.clock = system, tolerance, iterations, clock
        self.reach = 1.0
        """Size of the residuals at the first start: the unit of perturbations."""
        self._isolated: Matrix | None = None
        """The Jacobian of the last step if it left no choice, so that the solution is the only one nearby."""

    def run(self, start: Floats) -> NewtonResult:
        system = self.system
        if system.linear:
            projected = self._project()
            return self._refine(projected) if projected.converged else projected
        reached = self._approach(start, self.iterations)
        if not reached.converged:
            return reached
        return self._refine(self._polish(reached) if self._isolated is None else reached)

    def _refine(self, found: NewtonResult) -> NewtonResult:
        """Takes a step for the last digits: the tolerance says when to stop, not how exact a drawing is."""
        system = self.system
        if found.violation <= ROUNDED:
            return found
        residuals = system.residuals(found.z)
        # At an isolated solution the derivatives of the last step, whose factors are known, are good enough.
        jacobian = system.jacobian() if self._isolated is None else self._isolated
        step = nearest(jacobian, -residuals, system.inequality)
        if not step.feasible:
            return found
        z = found.z + step.point
        violation = self._greatest(system.residuals(z))
        return NewtonResult(z, found.end, violation) if violation < found.violation else found

    def _project(self) -> NewtonResult:
        """Solves an affine system by one projection, and another for the rounding of the first."""
        system = self.system
        z = np.zeros(system.size)
        for _ in range(2):
            residuals = system.residuals(z)
            violation = self._greatest(residuals)
            if violation <= self.tolerance:
                return NewtonResult(z, End.CONVERGED, violation)
            if not np.isfinite(violation):
                return NewtonResult(z, End.INFEASIBLE, violation)
            if self.clock.expired:
                return NewtonResult(z, End.EXHAUSTED, violation)
            jacobian = system.jacobian()
            found = nearest(jacobian, jacobian @ z - residuals, system.inequality)
            z = found.point
            if found.contradiction is not None:
                violation = self._greatest(system.residuals(z))
                return NewtonResult(z, End.INFEASIBLE, violation, found.contradiction)
        violation = self._greatest(system.residuals(z))
        holds = violation <= self.tolerance
        return NewtonResult(z, End.CONVERGED if holds else End.INFEASIBLE, violation)

    def _greatest(self, residuals: Floats) -> float:
        violation = float(np.abs(self.system.violations(residuals)).max(initial=0.0))
        return violation if np.isfinite(violation) else np.inf

    # -- reaching a feasible point

    def _approach(self, start: Floats, iterations: int) -> NewtonResult:
        """Takes damped Newton steps from `start`, each the shortest that satisfies the linearised rows."""
        system = self.system
        z = start
        residuals = system.residuals(z)
        violation = self._greatest(residuals)
        if violation < np.inf:
            self.reach = min(max(violation, 1e-2), 1e4)
        self._isolated = None
        damping = 0.0
        norms: list[float] = []
        for _ in range(iterations):
            if violation <= self.tolerance:
                return NewtonResult(z, End.CONVERGED, violation)
            norms.append(float(np.linalg.norm(system.violations(residuals))))
            if violation == np.inf or (len(norms) > PATIENCE and norms[-1] > STALLED * norms[-1 - PATIENCE]):
                return NewtonResult(z, End.INFEASIBLE, violation)
            if self.clock.expired:
                break
            found = self._step(z, residuals, damping)
            if found is None:
                return NewtonResult(z, End.INFEASIBLE, violation)
            z, residuals, damping = found
            violation = self._greatest(residuals)
        converged = violation <= self.tolerance
        return NewtonResult(z, End.CONVERGED if converged else End.EXHAUSTED, violation)

    def _step(self, z: Floats, residuals: Floats, damping: float) -> tuple[Floats, Floats, float] | None:
        """Returns the next point, its residuals and the damping to go on with; None if no step leads down."""
        system = self.system
        jacobian = system.jacobian()
        merit = _squares(system.violations(residuals))
        if damping == 0.0:
            shortest = nearest(jacobian, -residuals, system.inequality)
            self._isolated = jacobian if shortest.unique else None
            if shortest.feasible:
                step, share = self._bounded(shortest.point)
                left = (1.0 - share) ** 2 * merit
                if taken := self._try(z, step, merit, left):
                    return *taken, 0.0
        self._isolated = None
        rows = ~system.inequality | (residuals > 0.0)
        damped = DampedSteps(jacobian[rows], residuals[rows])
        largest = damped.largest
        # Written so that it ends with what overflows or vanishes as well.
        if not FLAT * np.sqrt(largest * merit) < damped.slope < np.inf or not TINY < largest < np.inf:
            return None
        mu = max(damping, 1e-12) * largest
        while mu <= 1e8 * largest:
            step, _ = self._bounded(damped.step(mu))
            predicted = _squares(residuals[rows] + jacobian[rows] @ step)
            if np.abs(step).max() <= STILL * (1.0 + np.abs(z).max()) or merit - predicted <= 1e-14 * merit:
                return None
            if taken := self._try(z, step, merit, predicted):
                return *taken, (mu / largest / 10.0 if mu > 1e-7 * largest else 0.0)
            mu = max(10.0 * mu, 1e-4 * largest)
        return None

    def _bounded(self, step: Floats) -> tuple[Floats, float]:
        """Returns the step, or its greatest share that moves no unknown too far at once, and that share."""
        excess = float((np.abs(step) / self.system.longest).max(initial=0.0))
        return (step, 1.0) if excess <= 1.0 else (step / excess, 1.0 / excess)

    def _try(self, z: Floats, step: Floats, merit: float, predicted: float) -> tuple[Floats, Floats] | None:
        trial = z + step
        residuals = self.system.residuals(trial)
        reached = _squares(self.system.violations(residuals))
        if merit - reached >= GAIN * (merit - predicted):  # False if not a number
            return trial, residuals
        return None

    # -- polishing

    def _polish(self, feasible: NewtonResult) -> NewtonResult:
        """Moves from a feasible point to the nearest one; returns it as it is if that cannot be reached."""
        system = self.system
        z, best, history = feasible.z, feasible, _Anderson()
        relaxation, shortest = 1.0, np.inf
        for _ in range(POLISHING_STEPS):
            if self.clock.expired:
                break
            residuals = system.residuals(z)
            if not np.isfinite(residuals).all():
                break
            jacobian = system.jacobian()
            projected = nearest(jacobian, jacobian @ z - residuals, system.inequality)
            if not projected.feasible:
                break
            step = projected.point - z
            length = float(np.abs(step).max(initial=0.0))
            if length <= POLISHED * (1.0 + float(np.abs(z).max(initial=0.0))):
                z = projected.point
                break
            if length > 0.9 * shortest:
                relaxation = max(0.5 * relaxation, 1.0 / 32.0)
            shortest = min(shortest, length)
            z = history.next(z, relaxation * step)
        polished = self._approach(z, 8)
        if polished.converged and _squares(polished.z) <= _squares(best.z) * (1.0 + 1e-9) + 1e-18:
            return polished
        return best


class _Anderson:
    """Anderson acceleration: combines the last points so that their steps cancel best."""

    def __init__(self) -> None:
        self._points: list[Floats] = []
        self._steps: list[Floats] = []

    def next(self, z: Floats, step: Floats) -> Floats:
        self._points = [*self._points[-MEMORY:], z]
        self._steps = [*self._steps[-MEMORY:], step]
        if len(self._points) == 1:
            return z + step
        d_points = np.diff(np.array(self._points), axis=0).T
        d_steps = np.diff(np.array(self._steps), axis=0).T
        mix = np.linalg.lstsq(d_steps, step, rcond=1e-10)[0]
        return z + step - (d_points + d_steps) @ mix


def _squares(vector: Floats) -> float:
    return float(vector @ vector)
