"""Nodes of a tape as combinations of unknowns and of knots; a knot is an operation that bends or chooses.

Most of what a drawing says is affine: a corner is a centre and half a width, seen from a frame that is moved.
All this is worked out once for a solve, with all positions free and sizes as they are; what an attempt holds
fast besides is put in later (`freezing`), and only knots are looked at again then. What two nodes have in
common cancels, so that a frame which moves both moves nothing in their difference.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TypeAlias

from aidl_lang.common.records import record
from aidl_lang.solver.array_program import CANCELLED
from aidl_lang.solver.expression import Tape
from aidl_lang.solver.operations import BRANCHING, VALUE, Op


@record(slots=True)
class Affine:
    """A combination of slots: the sum of `slope * value`, and a number."""

    terms: Mapping[int, float]
    constant: float


Form: TypeAlias = "float | Affine"
"""A node as its value if it depends on nothing, else as a combination of slots."""


@record(slots=True)
class Knot:
    """An operation that is not affine in its operands.

    node   of the tape
    parts  the forms of its operands
    below  the slots of the knots in these
    inputs the unknowns that it depends on
    """

    node: int
    op: int
    parts: tuple[Form, ...]
    below: tuple[int, ...]
    inputs: frozenset[int]


class Forms:
    """The forms of a tape's nodes with the unknowns `held` at their values, found as they are asked for.
    `value_of` gives the value of a node that hangs on these alone, or None.

    The slot of an unknown is its index, that of a knot at node m is m more than there are unknowns.
    """

    def __init__(
        self,
        tape: Tape,
        unknowns: Sequence[float],
        held: Collection[int],
        value_of: Callable[[int], float | None],
    ) -> None:
        self.width = len(unknowns)
        self.knots: dict[int, Knot] = {}
        self._tape, self._unknowns = tape, unknowns
        self._found: dict[int, Form] = {}
        self._value_of = value_of
        self._read = {unknown: unknowns[unknown] for unknown in held}

    @property
    def is_fresh(self) -> bool:
        """True if all unknowns that were taken to be held are where they were."""
        return all(self._unknowns[unknown] == value for unknown, value in self._read.items())

    def __getitem__(self, node: int) -> Form:
        found = self._found.get(node)
        return self._find(node) if found is None else found

    def below(self, form: Form) -> list[int]:
        """Returns the slots of the knots in a form."""
        width = self.width
        return [] if isinstance(form, float) else [slot for slot in form.terms if slot >= width]

    def _find(self, root: int) -> Form:
        ops, operands, found = self._tape.op_list, self._tape.operand_lists, self._found
        missing, stack = {root}, [root]
        while stack:
            node = stack.pop()
            value = self._value_of(node)
            if value is not None:
                found[node] = value
                missing.discard(node)
            elif ops[node] > Op.UNKNOWN:
                for operand in operands[node]:
                    if operand not in found and operand not in missing:
                        missing.add(operand)
                        stack.append(operand)
        for node in sorted(missing):
            if ops[node] > Op.UNKNOWN:
                found[node] = self._place(node, ops[node], tuple([found[a] for a in operands[node]]))
            else:
                found[node] = Affine({operands[node][0]: 1.0}, 0.0)
        return found[root]

    def _place(self, node: int, op: int, parts: tuple[Form, ...]) -> Form:
        form = branched(op, parts) if op in BRANCHING else applied(op, parts)
        if form is not None:
            return form
        below = [slot for part in parts for slot in self.below(part)]
        slots = [slot for part in parts if isinstance(part, Affine) for slot in part.terms]
        plain = [slot for slot in slots if slot < self.width]
        inputs = frozenset(plain).union(*(self.knots[slot].inputs for slot in below))
        slot = self.width + node
        self.knots[slot] = Knot(node, op, parts, tuple(dict.fromkeys(below)), inputs)
        return Affine({slot: 1.0}, 0.0)


# -- algebra


def combined(a: Form, b: Form, sign: float) -> Form:
    """Returns `a + sign * b`; slopes that cancel vanish."""
    if isinstance(b, float):
        return a + sign * b if isinstance(a, float) else Affine(a.terms, a.constant + sign * b)
    if isinstance(a, float):
        return Affine({slot: sign * slope for slot, slope in b.terms.items()}, a + sign * b.constant)
    terms = dict(a.terms)
    add_terms(terms, b.terms, sign)
    constant = a.constant + sign * b.constant
    return Affine(terms, constant) if terms else constant


def add_terms(terms: dict[int, float], others: Mapping[int, float], factor: float) -> None:
    """Adds slopes, times a factor, to `terms`; those that cancel vanish."""
    for slot, slope in others.items():
        known = terms.get(slot)
        if known is None:
            terms[slot] = factor * slope
        elif abs(total := known + factor * slope) > CANCELLED * (abs(known) + abs(factor * slope)):
            terms[slot] = total
        else:
            del terms[slot]


def scaled(form: Form, factor: float) -> Form:
    if isinstance(form, float):
        return form * factor
    if factor == 0.0:
        return 0.0
    return Affine({slot: slope * factor for slot, slope in form.terms.items()}, form.constant * factor)


def applied(op: int, parts: Sequence[Form]) -> Form | None:
    """Returns the form of an operation without branches; None if it is not affine."""
    first, last = parts[0], parts[-1]
    if op == Op.ADD:
        return combined(first, last, 1.0)
    if op == Op.SUB:
        return combined(first, last, -1.0)
    if op == Op.NEG:
        return scaled(first, -1.0)
    numbers = [part for part in parts if isinstance(part, float)]
    if len(numbers) == len(parts):
        return evaluate(op, numbers)
    if op == Op.MUL and numbers and _is_finite(numbers[0]):
        return scaled(last if isinstance(first, float) else first, numbers[0])
    if op == Op.DIV and isinstance(last, float) and last != 0.0 and _is_finite(1.0 / last):
        return scaled(first, 1.0 / last)
    return None


def branched(op: int, parts: Sequence[Form]) -> Form | None:
    """Returns the form of a branching operation if nothing is left to choose, else None."""
    first = parts[0]
    if op == Op.SELECT:
        if isinstance(first, float):
            return parts[1 if first >= 0.0 else 2]
        alike = combined(parts[1], parts[2], -1.0)
        return parts[1] if alike == 0.0 else None
    if op == Op.ABS:
        return abs(first) if isinstance(first, float) else None
    ahead = combined(first, parts[1], -1.0)
    if not isinstance(ahead, float):
        return None
    if ahead != ahead:
        return ahead
    return parts[0] if (ahead <= 0.0) == (op == Op.MINIMUM) else parts[1]


def evaluate(op: int, operands: Sequence[float]) -> float:
    """Returns the value of one operation on numbers."""
    return VALUE[op](*operands) if len(operands) > 1 else VALUE[op](operands[0], operands[0])


def _is_finite(number: float) -> bool:
    return number - number == 0.0
