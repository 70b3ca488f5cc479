"""Proofs that rows never hold together, and the constraints that a stalled search accuses."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.solver.expression import BRANCHING, Bools, Floats, Op
from aidl_lang.solver.linear import nearest, plainly_hold
from aidl_lang.solver.problem import Relation, Row
from aidl_lang.solver.valuation import (
    Affine,
    Form,
    Valuation,
    add_terms,
    applied,
    branched,
    combined,
    scaled,
)

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import Hierarchy

# --- Proofs that rows never hold together, wherever the free unknowns are and whichever branches they take.
#
# A row is a combination of unknowns and knots (`valuation`). Here a knot is a number of its own, of which
# only bounds are kept that always hold: `max(a, b)` is no less than `a` and no less than `b`, a root is not
# negative. Rows that contradict each other even then are contradictory, and the factors with which they add
# up to an impossibility prove it (Farkas' lemma). The reverse is not true, unless there are no knots.

CANCELLED = 1e-9
"""Part of the slopes added up that rounding may leave of them."""
DECIDED = 10.0
"""Factor by which the sum of the rows must exceed what the tolerances allow."""
FEW = 60
"""Bounds and rows up to which the contradiction is found without loading a library for linear programs."""
SOME = 400
"""Bounds and rows up to which a place is first looked for at which all hold."""
MANY = 8000
"""Bounds and rows beyond which no proof is sought."""


@record()
class _Refutation:
    """Factors of rows, by number; the sum of the rows with them; and whether all of these are equations."""

    factors: Mapping[int, float]
    off: float
    is_even: bool


_NONE = _Refutation({}, 0.0, False)


class Relaxation:
    """Some rows, up to date, with the unknowns `free`, and the bounds of what bends or chooses in them."""

    def __init__(self, values: Valuation, rows: Sequence[Row], free: Iterable[int], tolerance: float) -> None:
        self._values, self._free, self._tolerance = values, frozenset(free), tolerance
        self._forms = values.forms(self._free)
        self._put: dict[int, Form] = {}
        self._parts: dict[int, list[Form]] = {}
        """The operands of knots that are numbers of their own."""
        self._rows = [(self._put_in(self._forms[row.expression]), row) for row in rows]
        self._all = list(range(len(self._rows)))
        self.is_exact = not any(self._knots(form) for form, _ in self._rows)
        """True if the rows are affine, so that they hold together unless that is refuted."""
        self.bends = any(self._forms.knots[slot].op not in BRANCHING for slot in self._parts)
        """True if something in the rows neither is affine nor chooses."""

    @property
    def is_refuted(self) -> bool:
        """True if a proof exists that the rows cannot hold together."""
        return bool(self._refuted(self._all).factors)

    def lack(self) -> float:
        """Returns how far off the sum is that refutes the rows, its greatest factor as 1; 0 if none does."""
        found = self._refuted(self._all)
        return found.off / max(map(abs, found.factors.values()), default=1.0)

    def gaps(self) -> dict[int, float]:
        """Returns the residual of each row where the others hold; empty if inequalities take part."""
        found = self._refuted(self._all)
        return {i: found.off / factor for i, factor in found.factors.items()} if found.is_even else {}

    def _refuted(self, numbers: list[int]) -> _Refutation:
        """Returns factors of some rows, by number, that add up to what cannot be; or none."""
        system = [(form, row.relation is Relation.EQUAL) for form, row in (self._rows[i] for i in numbers)]
        system += [(bound, False) for bound in self._bounds(form for form, _ in system)]
        if len(system) > MANY:
            return _NONE
        jacobian, constant = _arrays([form for form, _ in system])
        if not (np.isfinite(jacobian).all() and np.isfinite(constant).all()):
            return _NONE
        inequality = np.array([not equal for _, equal in system], dtype=np.bool_)
        allowed = np.zeros(len(system))
        allowed[: len(numbers)] = [self._tolerance * self._rows[i][1].scale for i in numbers]
        factors = _contradiction(jacobian, constant, inequality, allowed)
        if factors is None:
            return _NONE
        taking_part = {i: factor for i, factor in zip(numbers, factors.tolist(), strict=False) if factor}
        return _Refutation(taking_part, float(factors @ constant), not factors[inequality].any())

    def smallest(self) -> list[int]:
        """Returns a smallest set of rows that is refuted; empty if the rows are not refuted."""
        found = list(self._refuted(self._all).factors)
        for number in list(found):
            if number in found and (fewer := self._refuted([n for n in found if n != number]).factors):
                found = list(fewer)
        return found

    # -- forms over what is free

    def _put_in(self, form: Form) -> Form:
        """Returns a form with numbers for what is not free, and with knots that are decided replaced."""
        if isinstance(form, float):
            return form
        width = self._forms.width
        if all(slot < width and slot in self._free for slot in form.terms):
            return form
        terms: dict[int, float] = {}
        constant = form.constant
        for slot, slope in form.terms.items():
            inner = self._put.get(slot)
            if inner is None:
                inner = self._put[slot] = self._of_slot(slot)
            if isinstance(inner, float):
                constant += slope * inner
            else:
                add_terms(terms, inner.terms, slope)
                constant += slope * inner.constant
        return Affine(terms, constant) if terms else constant

    def _of_slot(self, slot: int) -> Form:
        itself = Affine({slot: 1.0}, 0.0)
        if slot < self._forms.width:
            return itself if slot in self._free else self._values.unknowns[slot]
        knot = self._forms.knots[slot]
        if self._free.isdisjoint(knot.inputs):
            return self._values.nodes[knot.node]
        parts = [self._put_in(part) for part in knot.parts]
        if knot.op in (Op.MAXIMUM, Op.MINIMUM):
            parts = self._outermost(knot.op, parts)
            if len(parts) == 1:
                return parts[0]
            self._parts[slot] = parts
            return itself
        form = branched(knot.op, parts) if knot.op in BRANCHING else applied(knot.op, parts)
        if form is None:
            self._parts[slot] = parts
            return itself
        return form

    def _outermost(self, op: int, parts: Sequence[Form]) -> list[Form]:
        """Returns the operands of `max` or `min` with nested ones of the same kind opened up, without those
        that never lie further out than another.
        """
        outward = 1.0 if op == Op.MAXIMUM else -1.0
        found: list[Form] = []
        for leaf in (leaf for part in parts for leaf in self._leaves(op, part)):
            if any(_is_never_negative(scaled(combined(o, leaf, -1.0), outward)) for o in found):
                continue
            found = [o for o in found if not _is_never_negative(scaled(combined(leaf, o, -1.0), outward))]
            found.append(leaf)
        return found

    def _leaves(self, op: int, part: Form) -> list[Form]:
        """Returns the operands of the `max` or `min` in `part`, each with what is added; else `part`."""
        knots = self._knots(part)
        if len(knots) != 1 or isinstance(part, float):
            return [part]
        slope = part.terms[knots[0]]
        inner = self._forms.knots[knots[0]].op
        if inner not in (Op.MAXIMUM, Op.MINIMUM) or (inner == op) != (slope > 0.0):
            return [part]
        rest = combined(part, Affine({knots[0]: slope}, 0.0), -1.0)
        return [combined(rest, leaf, slope) for leaf in self._parts[knots[0]]]

    def _knots(self, form: Form) -> list[int]:
        return [slot for slot in form.terms if slot in self._parts] if isinstance(form, Affine) else []

    def _bounds(self, forms: Iterable[Form]) -> list[Form]:
        """Returns forms that are never positive, for the knots in some forms and their parts."""
        found: list[Form] = []
        waiting, known = list(forms), set[int]()
        while waiting:
            for slot in self._knots(waiting.pop()):
                if slot not in known:
                    known.add(slot)
                    fresh = list(self._bounds_of(slot))
                    found += fresh
                    waiting += fresh
        return found

    def _bounds_of(self, slot: int) -> Iterator[Form]:
        parts, itself = self._parts[slot], Affine({slot: 1.0}, 0.0)
        match self._forms.knots[slot].op:
            case Op.MAXIMUM:
                yield from (combined(part, itself, -1.0) for part in parts)
            case Op.MINIMUM:
                yield from (combined(itself, part, -1.0) for part in parts)
            case Op.ABS | Op.HYPOT:
                for part in parts:
                    yield combined(part, itself, -1.0)
                    yield combined(scaled(part, -1.0), itself, -1.0)
            case Op.SQRT | Op.SQUARE:
                yield scaled(itself, -1.0)
            case Op.SIN | Op.COS:
                yield combined(itself, 1.0, -1.0)
                yield combined(scaled(itself, -1.0), 1.0, -1.0)


def _is_never_negative(form: Form) -> bool:
    return isinstance(form, float) and form >= 0.0


def _arrays(forms: Sequence[Form]) -> tuple[Floats, Floats]:
    columns: dict[int, int] = {}
    for form in forms:
        for slot in form.terms if isinstance(form, Affine) else ():
            columns.setdefault(slot, len(columns))
    jacobian, constant = np.zeros((len(forms), len(columns))), np.zeros(len(forms))
    for i, form in enumerate(forms):
        constant[i] = form.constant if isinstance(form, Affine) else form
        for slot, slope in form.terms.items() if isinstance(form, Affine) else ():
            jacobian[i, columns[slot]] = slope
    return jacobian, constant


def _contradiction(jacobian: Floats, constant: Floats, inequality: Bools, allowed: Floats) -> Floats | None:
    """Returns factors with which rows `jacobian @ x + constant`, each 0 or at most 0 within `allowed`,
    contradict each other; None if they are not found, or not beyond doubt.
    """
    flat = ~jacobian.any(axis=1)
    off = flat & (np.where(inequality, constant, np.abs(constant)) > allowed)
    if off.any():
        factors = np.zeros(len(constant))
        worst = int(np.argmax(np.where(off, np.abs(constant), -1.0)))
        factors[worst] = np.sign(constant[worst])
    elif flat.all():
        return None
    else:
        is_small = len(constant) <= FEW
        few = nearest(jacobian, -constant, inequality).contradiction if is_small else None
        found = few if is_small else _many_multipliers(jacobian, constant, inequality)
        if found is None:
            return None
        factors = np.where(np.abs(found) > CANCELLED * np.abs(found).max(initial=0.0), found, 0.0)
        if float(factors @ constant) < 0.0:
            factors = -factors
    left = np.abs(factors @ jacobian)
    is_sum = (left <= CANCELLED * (np.abs(factors) @ np.abs(jacobian)) + 1e-15).all()
    rounding = 1e-12 * float(np.abs(factors) @ np.abs(constant))
    proven = float(factors @ constant) > DECIDED * float(np.abs(factors) @ allowed) + rounding
    return factors if is_sum and proven and (factors[inequality] >= 0.0).all() else None


def _many_multipliers(jacobian: Floats, constant: Floats, inequality: Bools) -> Floats | None:
    """Returns the multipliers for many rows by a linear program: the sum of violations is least."""
    if len(constant) <= SOME and plainly_hold(jacobian, -constant, inequality):
        return None
    from scipy.optimize import linprog
    from scipy.sparse import csr_array, hstack

    length = np.linalg.norm(jacobian, axis=1)
    weight = 1.0 / np.where(length > 0.0, length, 1.0)
    rows, off, unknowns = jacobian * weight[:, None], constant * weight, jacobian.shape[1]
    equal = ~inequality
    lacks = np.eye(len(off))
    sides = hstack([csr_array(rows), csr_array(-lacks), csr_array(lacks[:, equal])], format="csr")
    cost = np.append(np.zeros(unknowns), np.ones(len(off) + int(equal.sum())))
    bounds = [(None, None)] * unknowns + [(0.0, None)] * (len(cost) - unknowns)
    system: dict[str, object] = {}
    if inequality.any():
        system |= {"A_ub": sides[inequality], "b_ub": -off[inequality]}
    if equal.any():
        system |= {"A_eq": sides[equal], "b_eq": -off[equal]}
    found = linprog(cost, bounds=bounds, method="highs", **system)
    if found.status != 0:
        return None
    factors = np.zeros(len(off))
    if inequality.any():
        factors[inequality] = -found.ineqlin.marginals
    if equal.any():
        factors[equal] = -found.eqlin.marginals
    scaled: Floats = factors * weight
    return scaled


# --- The constraints that a stalled search accuses: those whose linearised rows cannot hold together.
#
# Where no step leads on, some combination y of the rows has no slope in any direction, yet is not zero
# there: Jᵀ y = 0, y · r ≠ 0, y >= 0 for inequalities. That is Farkas' proof that the linearised rows
# contradict each other, and the rows with y ≠ 0 are the suspects. They are thinned out until each is needed,
# which makes the proof one of the sparsest (Gleeson and Ryan, Identifying minimally infeasible subsystems of
# inequalities, ORSA Journal on Computing 2, 1990). In an affine problem the suspects are a conflict; in
# others, a good guess.

FAINT = 1e-3
"""Singular values of unit rows that count as none: the search stops near the singular place, not on it."""
SHARE = 1e-6
"""Part of the greatest multiplier below which a row takes no part."""
MOST_ACCUSED = 12
"""Members of a set above which halves of it are tried before single ones."""
FAR = 100.0
"""The longest step that counts as mending rows, in sizes of the rows."""


class Linearised:
    """The rows of constraints at the current values, each divided by its slope.

    jacobian   (r, k) unit rows over the free unknowns; zero rows where nothing free changes a row
    distance   (r,) how far each row is from zero, as the shortest step that would bring it there
    inequality (r,)
    owner      (r,) the constraint of each row
    """

    def __init__(self, hierarchy: Hierarchy, constraints: Sequence[int], free: Iterable[int]) -> None:
        rows, columns = hierarchy.rows(constraints), sorted(free)
        slopes = hierarchy.slopes(constraints, columns)
        self.jacobian = np.nan_to_num(slopes * hierarchy.problem.scale[columns])
        self.distance = np.nan_to_num([hierarchy.values.nodes[row.expression] for row in rows])
        self.inequality = np.array([row.relation is Relation.AT_MOST for row in rows], dtype=np.bool_)
        self.owner = np.array(hierarchy.owners(constraints), dtype=np.intp)
        length = np.linalg.norm(self.jacobian, axis=1)
        size = np.array([row.scale for row in rows])
        flat = length * size <= FAINT * np.abs(self.distance)
        self.jacobian[flat] = 0.0
        length = np.where(flat, 1.0, length)
        self.jacobian /= length[:, None]
        self.distance /= length
        self.reach = FAR * float(size.max(initial=1.0))

    def accused(self) -> list[int]:
        """Returns the constraints in the left null space of the rows that are violated or tight."""
        rows = ~self.inequality | (self.distance > -1e-9 * self.reach)
        jacobian, distance = self.jacobian[rows], self.distance[rows]
        gram = jacobian @ jacobian.T + FAINT**2 * np.eye(len(jacobian))
        multipliers = np.abs(np.linalg.solve(gram, distance))
        part = multipliers > SHARE * multipliers.max(initial=0.0)
        return sorted(set(self.owner[rows][part].tolist()))

    def can_hold(self, constraints: Iterable[int]) -> bool:
        """Tells whether the linearised rows of these constraints hold together within a sensible distance."""
        rows: NDArray[np.bool_] = np.isin(self.owner, list(constraints))
        target: Floats = -self.distance[rows]
        step = nearest(self.jacobian[rows], target, self.inequality[rows])
        return step.feasible and float(np.abs(step.point).max(initial=0.0)) <= self.reach


def suspects(hierarchy: Hierarchy, constraints: Sequence[int], free: Iterable[int]) -> list[int]:
    """Returns constraints whose linearised rows contradict each other, each needed for that; or none."""
    rows = Linearised(hierarchy, constraints, free)
    accused = rows.accused()
    if rows.can_hold(accused):
        return []
    return needed(accused, rows.can_hold)


def needed(failing: Sequence[int], holds: Callable[[list[int]], bool]) -> list[int]:
    """Returns a smallest failing part of a failing set: tries halves, if large, then without each member."""
    found = list(failing)
    if len(found) > MOST_ACCUSED:
        found = _halved([], False, found, holds)
    for index in list(found):
        rest = [other for other in found if other != index]
        if not holds(rest):
            found = rest
    return sorted(found)


def _halved(
    background: list[int], grown: bool, candidates: list[int], holds: Callable[[list[int]], bool]
) -> list[int]:
    """Returns a smallest part of `candidates` that fails together with the `background`, which has `grown`
    since it last held, by QuickXplain (Junker, AAAI 2004): halves are background for one another, so that k
    culprits among n are found in about k log(n / k) trials.
    """
    if grown and not holds(background):
        return []
    if len(candidates) <= 1:
        return candidates
    half = len(candidates) // 2
    first, second = candidates[:half], candidates[half:]
    from_second = _halved(background + first, True, second, holds)
    from_first = _halved(background + from_second, bool(from_second), first, holds)
    return from_first + from_second
