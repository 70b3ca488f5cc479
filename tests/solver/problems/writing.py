"""Writes any problem as JSON, in the form that `form` reads.

What is read again is the same problem, solved to the same values, to the last digit: operations come onto the
new tape in the order that they have, as do the operands of `min` and `max`. An operation is written in the
place where it is used if it is used once, and if it keeps its turn when it is read there; otherwise a `let`
names it before that. A number or an unknown is made by its first mention, and takes a `let` only where this
would be late.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import count, islice

import numpy as np

from aidl_lang.solver.operations import Op
from aidl_lang.solver.problem import Constraint, Problem, Relation
from tests.solver.problems.members import as_not_negative, as_number, as_positive
from tests.solver.problems.notation import (
    FUNCTIONS,
    NAME,
    PRODUCTS,
    RESERVED,
    SUMS,
    FormError,
    quoted,
    within,
)

ROOT = "root"
"""The name of group 0."""
LONG = 100
"""Characters of an expression above which it gets a name, and of a name above which it gets another."""

SUM, PRODUCT, SIGNED, POWER, ATOM = range(5)
"""Firmness of expressions: one that is weaker than its place asks for is put in parentheses."""

_INFIX = {
    **{op: (sign, SUM) for sign, op in SUMS.items()},
    **{op: (sign, PRODUCT) for sign, op in PRODUCTS.items()},
}
EXTREMA = frozenset({Op.MINIMUM, Op.MAXIMUM})
"""Operations that take, of equal operands, the one that is first on the tape."""
_NAMES = {op: name for name, op in FUNCTIONS.items()}


def dump(problem: Problem, about: str = "", tags: Sequence[str] = ()) -> dict[str, object]:
    """Returns `problem` as a JSON document, its constraints with `tags` if there are any.

    Replaces names that the form does not allow, or that stand for several unknowns. Raises `FormError` for
    numbers that are not finite or too large, and for frames not owned by the group above theirs.
    """
    early: set[int] = set()
    while True:
        writing = _Writing(problem, frozenset(early))
        document = writing.document(about, tags or [""] * len(problem.holder))
        if writing.late <= early:
            return document
        early |= writing.late


class _Writing:
    """A pass over a problem. `early` are the leaves to be named, `late` those that turn out to need it."""

    def __init__(self, problem: Problem, early: frozenset[int]) -> None:
        self.problem, self.early = problem, early
        self.late: set[int] = set()
        self.names = _names(problem)
        self.groups = [ROOT, *(f"group{g}" for g in range(1, len(problem.parent)))]
        roots = [row.expression for c in problem.constraints for row in c.rows]
        self.uses = _uses(problem, [*roots, *(node for _, node in problem.observables)])
        self.unmade = sorted(self.uses, reverse=True)
        self.made: dict[int, int] = {}
        """Nodes that are on the new tape when the next text is read, and when they came."""
        self.pending: dict[int, None] = {}
        """Operations that are not written yet, in order."""
        self.text: dict[int, tuple[str, int]] = {}
        self.sides: dict[int, tuple[str, str]] = {}
        """Both sides of each difference that has no name."""
        self.fresh = (name for i in count(1) if (name := f"t{i}") not in self.names)

    def document(self, about: str, tags: Sequence[str]) -> dict[str, object]:
        problem = self.problem
        parents = zip(self.groups[1:], problem.parent[1:].tolist(), strict=True)
        return {
            "about": about,
            "groups": {name: self.groups[parent] for name, parent in parents},
            "unknowns": {name: self._unknown(i) for i, name in enumerate(self.names)},
            "constraints": [self._constraint(*c) for c in zip(problem.constraints, tags, strict=True)],
            "observed": [self._observable(group, node) for group, node in problem.observables],
            **({"named": True} if problem.named else {}),
        }

    def _unknown(self, i: int) -> object:
        problem = self.problem
        owner, frame_of = int(problem.group[i]), int(problem.frame_of[i])
        longest = np.inf if problem.longest is None else float(problem.longest[i])
        with within(f"unknown {quoted(self.names[i])}"):
            if frame_of >= 0 and problem.parent[frame_of] != owner:
                raise FormError("frame: not owned by the group above that which it moves")
            return _entry(
                "guess",
                guess=as_number(float(problem.initial[i])),
                scale=_unless(1.0, as_positive(float(problem.scale[i]))),
                kept=bool(problem.kept[i]) or None,
                group=self.groups[owner] if owner and frame_of < 0 else None,
                frame=self.groups[frame_of] if frame_of >= 0 else None,
                longest=None if longest == np.inf else as_positive(longest),
                standing=bool(problem.standing[i]) or None,
                spanned=bool(problem.spanned[i]) or None,
                thing=int(problem.thing[i]) or None,
            )

    def _constraint(self, constraint: Constraint, tag: str) -> object:
        lets = self._make([row.expression for row in constraint.rows])
        rows = [self._row(row.expression, row.relation) for row in constraint.rows]
        scales = [as_positive(row.scale) for row in constraint.rows]
        return _entry(
            "is",
            tag=tag or None,
            let=lets or None,
            **{"is": rows if len(rows) != 1 else rows[0]},
            group=self.groups[constraint.group] if constraint.group else None,
            placed=[self.names[unknown] for unknown in sorted(constraint.placed)] or None,
            weight=None if constraint.weight is None else as_not_negative(constraint.weight),
            whole=[self.groups[group] for group in sorted(constraint.whole)] or None,
            inside=[self.groups[group] for group in sorted(constraint.inside)] or None,
            scale=_unless(1.0, scales[0]) if len(set(scales)) == 1 else scales or None,
        )

    def _observable(self, group: int, node: int) -> object:
        lets = self._make([node])
        return _entry(
            "is", let=lets or None, **{"is": self.text[node][0]}, group=self.groups[group] if group else None
        )

    # -- expressions

    def _row(self, node: int, relation: Relation) -> str:
        sign = "==" if relation is Relation.EQUAL else "<="
        left, right = self.sides.get(node) or (self.text[node][0], "0")
        return f"{left} {sign} {right}"

    def _make(self, roots: Sequence[int]) -> dict[str, str]:
        """Makes all nodes up to the roots; returns the lets that must be written before the roots."""
        lets: dict[str, str] = {}
        while self.unmade and self.unmade[-1] <= max(roots, default=-1):
            self._compose(self.unmade.pop(), lets)
        self._write(roots, lets)
        self._name(self.pending, lets)
        return lets

    def _compose(self, node: int, lets: dict[str, str]) -> None:
        tape = self.problem.tape
        op, operands = tape.op_list[node], tape.operand_lists[node]
        if op in (Op.CONSTANT, Op.UNKNOWN):
            self.text[node] = self._leaf(node)
            if node in self.early:
                self._name([*self.pending, node], lets)
            return
        if op in EXTREMA:
            self._check_turn(*operands)
        self._write(operands, lets)
        self.text[node] = self._joined(op, operands)
        if op == Op.SUB:
            self.sides[node] = self.text[operands[0]][0], self.text[operands[1]][0]
        self.pending[node] = None
        if self.uses[node] > 1 or len(self.text[node][0]) > LONG:
            self._name(self.pending, lets)

    def _write(self, operands: Iterable[int], lets: dict[str, str]) -> None:
        """Writes operands side by side; names them first if their turn was not just now."""
        wanted = [operand for operand in dict.fromkeys(operands) if operand in self.pending]
        if list(islice(reversed(self.pending), len(wanted))) != wanted[::-1]:
            self._name(self.pending, lets)
        for operand in operands:
            self.pending.pop(operand, None)
            self.made.setdefault(operand, len(self.made))

    def _check_turn(self, first: int, second: int) -> None:
        """Marks a leaf that comes first but would be made later, so that it gets a name."""
        is_leaf, latest = self.problem.tape.op_list[first] <= Op.UNKNOWN, len(self.made)
        if is_leaf and self.made.get(second, latest) < self.made.get(first, latest):
            self.late.add(first)

    def _name(self, nodes: Iterable[int], lets: dict[str, str]) -> None:
        for node in nodes:
            name = next(self.fresh)
            lets[name], self.text[node] = self.text[node][0], (name, ATOM)
            self.sides.pop(node, None)
            self.made.setdefault(node, len(self.made))
        self.pending.clear()

    def _leaf(self, node: int) -> tuple[str, int]:
        tape = self.problem.tape
        if tape.op_list[node] == Op.UNKNOWN:
            return self.names[tape.operand_lists[node][0]], ATOM
        with within(f"node {node}"):
            value = as_number(float(tape.constants[node]))
        return repr(value).removesuffix(".0"), SIGNED if value < 0.0 else ATOM

    def _joined(self, op: int, operands: tuple[int, ...]) -> tuple[str, int]:
        """Returns an operation as text, and the firmness of its outermost operator."""
        if op in _INFIX:
            sign, level = _INFIX[op]
            return f"{self._at(level, operands[0])} {sign} {self._at(level + 1, operands[1])}", level
        if op == Op.POWER:
            return f"{self._at(ATOM, operands[0])} ^ {self._at(SIGNED, operands[1])}", POWER
        if op == Op.NEG:
            return f"-{self._at(SIGNED, operands[0])}", SIGNED
        return f"{_NAMES[op]}({', '.join(self.text[operand][0] for operand in operands)})", ATOM

    def _at(self, level: int, node: int) -> str:
        text, firmness = self.text[node]
        return text if firmness >= level else f"({text})"


def _entry(main: str, **members: object) -> object:
    """Returns the members that are not None; the value of `main` if it is the only one."""
    given = {name: value for name, value in members.items() if value is not None}
    return given[main] if given.keys() == {main} else given


def _unless(default: float, value: float) -> float | None:
    return None if value == default else value


def _names(problem: Problem) -> list[str]:
    """Returns a name for each unknown, its own if possible."""
    given = problem.names or [""] * len(problem.initial)
    times = Counter(given)
    taken = {
        name
        for name in given
        if times[name] == 1 and len(name) <= LONG and NAME.fullmatch(name) and name not in RESERVED
    }
    fresh = (name for i in count() if (name := f"u{i}") not in taken)
    return [name if name in taken else next(fresh) for name in given]


def _uses(problem: Problem, roots: Sequence[int]) -> Counter[int]:
    """Counts the uses of each node below the roots, by other nodes and as a root."""
    ops, operands = problem.tape.op_list, problem.tape.operand_lists
    uses = Counter(roots)
    stack = list(uses)
    while stack:
        node = stack.pop()
        if ops[node] > Op.UNKNOWN:
            stack.extend(operand for operand in dict.fromkeys(operands[node]) if operand not in uses)
            uses.update(operands[node])
    return uses
