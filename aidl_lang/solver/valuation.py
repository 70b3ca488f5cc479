"""The values of the unknowns and of the tape's nodes, brought up to date a cone at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import TypeAlias

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.array_program import Schedule
from aidl_lang.solver.expression import Tape, below
from aidl_lang.solver.forms import Forms
from aidl_lang.solver.operations import VALUE, Op

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
            found = self._forms[sizes] = Forms(
                self.tape, self.unknowns, self.kept - sizes, self._value_of(sizes)
            )
        return found

    def _value_of(self, sizes: frozenset[int]) -> Callable[[int], float | None]:
        """Returns a function that gives the value of a node which hangs on kept sizes alone, none of `sizes`
        among them; None for others.
        """
        still = self.still(sizes)

        def value(node: int) -> float | None:
            if not still[node]:
                return None
            self._settle([node])
            return self.nodes[node]

        return value

    def still(self, sizes: frozenset[int] = frozenset()) -> bytes:
        """Returns for each node whether it hangs on kept sizes alone, none of `sizes` among them."""
        found = self._still.get(sizes)
        if found is None:
            held = np.zeros(len(self.unknowns), dtype=np.bool_)
            held[list(self.kept - sizes)] = True
            found = self._still[sizes] = self.schedule.above(held)
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
            found = self._cones[wanted] = self._find_cone(wanted)
        return found

    def _find_cone(self, roots: tuple[int, ...]) -> Cone:
        ops, operands, still = self.tape.op_list, self.tape.operand_lists, self.still()
        nodes = below(self.tape, roots, still)
        inputs = [(node, operands[node][0]) for node in nodes if ops[node] == Op.UNKNOWN and not still[node]]
        code = [self._compiled(node) for node in nodes if ops[node] > Op.UNKNOWN and not still[node]]
        return Cone(roots, inputs, code, [node for node in nodes if still[node] and ops[node] != Op.CONSTANT])

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
            self._settle(cone.still)
        run(cone.code, nodes)
        self._fresh.update(cone.roots)

    def _settle(self, roots: Sequence[int]) -> None:
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
