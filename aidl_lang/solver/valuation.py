"""The values of the unknowns and of the tape's nodes, and these nodes as forms.

A form is a combination of unknowns and of knots; a knot is an operation that bends or chooses. Most of what a
drawing says is affine: a corner is a centre and half a width, seen from a frame that is moved. All this is
worked out once for a solve, with all positions free and sizes as they are; what an attempt holds fast besides
is put in later (`freezing`), and only knots are looked at again then. What two nodes have in common cancels,
so that a frame which moves both moves nothing in their difference.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TypeAlias

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.array_program import CANCELLED, ArrayFreezing, Schedule
from aidl_lang.solver.expression import BRANCHING, PARTIALS, VALUE, Bools, Floats, Ints, Op, Tape, below
from aidl_lang.solver.linear import Sparse, marked, starts_of

Compiled: TypeAlias = "tuple[Callable[..., float], int | tuple[int, ...], int, int]"
"""Function, first operand (all of them for more than two), second operand or -1, result."""

CONES = 64
"""The most cones that are remembered."""


class Valuation:
    """The values of all unknowns, and of those nodes that were brought up to date.

    unknowns (n,) current values; change them only through `assign`
    nodes    (m,) value of each tape node as of the last `refresh` that covered it
    kept     the unknowns that are sizes, which seldom change: what hangs on these alone is evaluated once
    """

    def __init__(
        self,
        tape: Tape,
        initial: Sequence[float],
        kept: frozenset[int] = frozenset(),
        nodes: Sequence[float] | None = None,
    ) -> None:
        """`nodes` are the values of all nodes at `initial`, if they are known."""
        self.tape, self.kept = tape, kept
        self.unknowns = [float(value) for value in initial]
        self.nodes: list[float] = tape.constants.tolist() if nodes is None else list(nodes)
        self._code: list[Compiled | None] = [None] * len(tape)
        self._fresh: set[int] = set()
        """Nodes that are up to date, with everything below them."""
        self._settled: set[int] = set()
        """Nodes that hang on sizes alone and are up to date, with everything below them."""
        self._cones: dict[tuple[int, ...], Cone] = {}
        self._forms: dict[frozenset[int], Forms] = {}
        self._still: dict[frozenset[int], bytes] = {}
        if nodes is not None:
            self._settled.update(node for node, is_still in enumerate(self.still()) if is_still)

    def forms(self, free: frozenset[int]) -> Forms:
        """Returns the forms of the nodes if of the kept sizes only those in `free` may change."""
        sizes = self.kept & free
        found = self._forms.get(sizes)
        if found is None or not found.is_fresh:
            found = self._forms[sizes] = Forms(self, sizes)
        return found

    def still(self, sizes: frozenset[int] = frozenset()) -> bytes:
        """Returns for each node whether it hangs on kept sizes alone, none of `sizes` among them."""
        found = self._still.get(sizes)
        if found is None:
            held = marked(list(self.kept - sizes), len(self.unknowns))
            found = self._still[sizes] = (~self.schedule.varying(~held)).tobytes()
        return found

    @cached_property
    def schedule(self) -> Schedule:
        return Schedule(self.tape)

    def assign(self, values: Iterable[tuple[int, float]]) -> None:
        unknowns = self.unknowns
        for unknown, value in values:
            if unknowns[unknown] != value:
                unknowns[unknown] = value
                self._fresh.clear()
                if unknown in self.kept:
                    self._settled.clear()

    def cone(self, roots: Iterable[int]) -> Cone:
        """Returns everything below the roots, ready to be refreshed."""
        wanted = tuple(roots)
        found = self._cones.get(wanted)
        if found is None:
            if len(self._cones) >= CONES:
                self._cones.clear()
            ops, operands, still = self.tape.op_list, self.tape.operand_lists, self.still()
            nodes = below(self.tape, wanted, still)
            moving = [node for node in nodes if not still[node]]
            inputs = [(node, operands[node][0]) for node in moving if ops[node] == Op.UNKNOWN]
            code = [self._compiled(node) for node in moving if ops[node] > Op.UNKNOWN]
            ends = [node for node in nodes if still[node] and ops[node] != Op.CONSTANT]
            found = self._cones[wanted] = Cone(wanted, inputs, code, ends)
        return found

    def _compiled(self, node: int) -> Compiled:
        code = self._code[node]
        if code is None:
            tape = self.tape
            code = self._code[node] = compiled(tape.op_list[node], node, tape.operand_lists[node])
        return code

    def update(self, roots: Sequence[int]) -> None:
        """Brings these nodes up to date, unless they are."""
        if not self._fresh.issuperset(roots):
            self.refresh(self.cone(roots))

    def refresh(self, cone: Cone) -> None:
        """Brings the nodes of a cone up to date, unless they are."""
        if self._fresh.issuperset(cone.roots):
            return
        nodes, unknowns = self.nodes, self.unknowns
        for node, unknown in cone.inputs:
            nodes[node] = unknowns[unknown]
        if not self._settled.issuperset(cone.still):
            self.settle(cone.still)
        run(cone.code, nodes)
        self._fresh.update(cone.roots)

    def settle(self, roots: Sequence[int]) -> None:
        """Brings nodes that hang on sizes alone up to date, unless they are."""
        ops, operands, settled = self.tape.op_list, self.tape.operand_lists, self._settled
        stack, missing = [root for root in roots if root not in settled], list[int]()
        while stack:
            node = stack.pop()
            if node not in settled:
                settled.add(node)
                missing.append(node)
                if ops[node] > Op.UNKNOWN:
                    stack += operands[node]
                elif ops[node] == Op.UNKNOWN:
                    self.nodes[node] = self.unknowns[operands[node][0]]
        run([self._compiled(node) for node in sorted(missing) if ops[node] > Op.UNKNOWN], self.nodes)


@record()
class Cone:
    """The nodes below some roots.

    roots     the nodes asked for
    inputs    (node, unknown) for each unknown below them
    code      the operations that bring the other nodes up to date
    still     the nodes at which this ends, as they hang on sizes alone
    """

    roots: tuple[int, ...]
    inputs: list[tuple[int, int]]
    code: list[Compiled]
    still: list[int]


def compiled(op: int, out: int, operands: tuple[int, ...]) -> Compiled:
    if len(operands) > 2:
        return VALUE[op], operands, -1, out
    return VALUE[op], operands[0], operands[-1], out


def run(code: list[Compiled], values: list[float]) -> None:
    """Evaluates straight-line code on `values` in place."""
    for function, a, b, out in code:
        if b >= 0:
            values[out] = function(values[a], values[b])  # type: ignore[index]
        else:
            values[out] = function(*[values[i] for i in a])  # type: ignore[union-attr]


# -- forms


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
    """The forms of a tape's nodes with all kept sizes but `sizes` at their values, found as asked for.

    The slot of an unknown is its index, that of a knot at node m is m more than there are unknowns.
    """

    def __init__(self, values: Valuation, sizes: frozenset[int]) -> None:
        self.width = len(values.unknowns)
        self.knots: dict[int, Knot] = {}
        self._values, self._still = values, values.still(sizes)
        self._found: dict[int, Form] = {}
        self._read = {unknown: values.unknowns[unknown] for unknown in values.kept - sizes}

    @property
    def is_fresh(self) -> bool:
        """True if all unknowns that were taken to be held are where they were."""
        return all(self._values.unknowns[unknown] == value for unknown, value in self._read.items())

    def __getitem__(self, node: int) -> Form:
        found = self._found.get(node)
        return self._find(node) if found is None else found

    def below(self, form: Form) -> list[int]:
        """Returns the slots of the knots in a form."""
        width = self.width
        return [] if isinstance(form, float) else [slot for slot in form.terms if slot >= width]

    def _find(self, root: int) -> Form:
        values, still, found = self._values, self._still, self._found
        ops, operands = values.tape.op_list, values.tape.operand_lists
        missing, stack = {root}, [root]
        while stack:
            node = stack.pop()
            if still[node]:
                values.settle([node])
                found[node] = values.nodes[node]
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
        return VALUE[op](*numbers) if len(numbers) > 1 else VALUE[op](numbers[0], numbers[0])
    if op == Op.MUL and numbers and math.isfinite(numbers[0]):
        return scaled(last if isinstance(first, float) else first, numbers[0])
    if op == Op.DIV and isinstance(last, float) and last != 0.0 and math.isfinite(1.0 / last):
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


# --- Gradients of many nodes at one place, as sparse matrices; these in their connected parts.
#
# They are accumulated forward as dictionaries, which for a drawing is quickest; for large models in reverse
# for all roots together, by the programs on arrays that solve them. Newton's method, which comes back to the
# same rows again and again, does not use this.

Gradient: TypeAlias = dict[int, float]
"""Partial derivative by unknown; unknowns that are missing have none."""

FEW = 3000
"""Number of nodes up to which dictionaries are quicker than arrays."""
MANY = 100
"""Nodes to a root above which the whole tape is not evaluated."""
STEEPEST = 1e100
"""Slopes above this are left by overflow."""
NARROW = 50
"""Nodes to a level up to which dictionaries are quicker, as in chains of things that hang on each other."""
FLAT = 1e-9
"""Slopes below this count as zero: coordinates that cancel, as in the width of a box."""
LARGE = 300
"""Rows or columns of a part from which on sparse elimination is quicker."""


def gradients(
    values: Valuation, roots: Iterable[int], among: Sequence[bool] | None = None, ends: bytes | None = None
) -> dict[int, Gradient]:
    """Returns the gradient of each root at the current node values, which must be up to date; by the unknowns
    `among`, if these are given, and without what is below nodes marked as `ends`.
    """
    wanted = list(roots)
    tape, nodes = values.tape, values.nodes
    ops, operands = tape.op_list, tape.operand_lists
    found: dict[int, Gradient] = {}
    sloping: dict[int, list[tuple[int, float]]] = {}
    stack = list(wanted)
    while stack:
        node = stack[-1]
        if node in found:
            stack.pop()
            continue
        op, args = ops[node], operands[node]
        if ends is not None and ends[node]:
            found[node] = {}
            continue
        if op <= Op.UNKNOWN:
            is_free = op == Op.UNKNOWN and (among is None or among[args[0]])
            found[node] = {args[0]: 1.0} if is_free else {}
            continue
        terms = sloping.get(node)
        if terms is None:  # the branches that are not taken are not looked at
            padded = args if len(args) > 1 else args * 2
            slopes = zip(args, PARTIALS[op](*[nodes[a] for a in padded], nodes[node]), strict=False)
            terms = sloping[node] = [(a, slope) for a, slope in slopes if slope != 0.0]
        if missing := [a for a, _ in terms if a not in found]:
            stack += missing
        else:
            found[node] = _combined([(found[a], slope) for a, slope in terms if found[a]])
    return {root: found[root] for root in wanted}


def _combined(terms: Sequence[tuple[Gradient, float]]) -> Gradient:
    """Returns a sum of gradients times their factors; one that stays as it is is shared."""
    if len(terms) == 1 and terms[0][1] == 1.0:
        return terms[0][0]
    total: Gradient = {}
    for gradient, slope in terms:
        for unknown, derivative in gradient.items():
            total[unknown] = total.get(unknown, 0.0) + slope * derivative
    return total


def linearise(tape: Tape, at: Floats, roots: Ints, among: Bools | None = None) -> tuple[Floats, Sparse]:
    """Returns the values (r,) of `roots` at the unknowns `at` (n,), and their finite partial derivatives; by
    the unknowns `among` (n,) only, if these are given.

    Unknowns without influence on a root have no entry; entries that cancel may be zeros, and products that
    overflow count as none.
    """
    wanted = roots.tolist()
    height = int(tape.levels.max(initial=0)) + 1
    if len(tape) <= max(FEW, NARROW * height) or len(wanted) * MANY < len(tape):
        known = Valuation(tape, at.tolist())
        known.update(wanted)
        found = gradients(known, wanted, None if among is None else among.tolist())
        values = np.array([known.nodes[root] for root in wanted])
        columns = np.array([unknown for root in wanted for unknown in found[root]], dtype=np.intp)
        slopes = np.array([slope for root in wanted for slope in found[root].values()])
        counts = np.array([len(found[root]) for root in wanted], dtype=np.intp)
        matrix = Sparse(starts_of(counts), columns, slopes)
    else:
        schedule = Schedule(tape)
        nodes = schedule.evaluate(at)
        free = np.ones(len(at), dtype=np.bool_) if among is None else among
        freezing = ArrayFreezing(schedule, nodes, free)
        counts = np.zeros(len(roots), dtype=np.intp)
        varying = np.flatnonzero(freezing.varies(roots))
        program = freezing.program(roots[varying])
        counts[varying] = np.diff(program.indptr)
        values, columns = nodes[roots], program.columns[program.indices]
        matrix = Sparse(starts_of(counts), columns, program.entries())
    sensible = np.abs(matrix.entries) < STEEPEST  # not for those that are not numbers
    return values, replace(matrix, entries=np.where(sensible, matrix.entries, 0.0))


# -- connected parts


def components(a: Ints, b: Ints, count: int) -> Ints:
    """Returns the component of each of `count` vertices, numbered from 0; edges (e,) link `a` and `b`."""
    lowest = connected(a, b, count)
    return (np.cumsum(lowest == np.arange(count)) - 1)[lowest]


def connected(a: Ints, b: Ints, count: int) -> Ints:
    """Returns the least vertex of the component of each of `count` vertices; edges (e,) link `a` and `b`."""
    lowest = np.arange(count)
    while True:
        below, above = np.minimum(lowest[a], lowest[b]), np.maximum(lowest[a], lowest[b])
        if (below == above).all():
            return lowest
        np.minimum.at(lowest, above, below)
        while (lowest != (lower := lowest[lowest])).any():
            lowest = lower


class Sorted:
    """Things sorted by the part they belong to: `of[first[p] : first[p] + count[p]]` are those of part p."""

    def __init__(self, part: Ints, parts: int) -> None:
        self.part = part
        self.of = np.argsort(part, kind="stable")
        self.count = np.bincount(part[part >= 0], minlength=parts)
        self.first = np.cumsum(self.count) - self.count + np.count_nonzero(part < 0)
        self.place = np.empty(len(part), dtype=np.intp)
        """The number of each within its part."""
        self.place[self.of] = np.arange(len(part)) - np.append(self.first, 0)[part][self.of]

    def members(self, part: int) -> Ints:
        return self.of[self.first[part] : self.first[part] + self.count[part]]
