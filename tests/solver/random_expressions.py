"""Random expressions of every operation, with operands as unkind as they come."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hypothesis import strategies as st

from aidl_lang.solver import Problem

from .build import E, Model

ARITY = {
    "add": 2, "sub": 2, "mul": 2, "div": 2, "neg": 1, "power": 2, "sin": 1, "cos": 1, "tan": 1, "asin": 1,
    "acos": 1, "atan2": 2, "sqrt": 1, "abs": 1, "square": 1, "hypot": 2, "minimum": 2, "maximum": 2, "mod": 2,
    "select": 3, "cubic_max": 4,
}  # fmt: skip

PLAIN = st.floats(-4.0, 4.0).map(lambda v: round(v, 3))
EDGES = [0.0, -0.0, 1.0, -1.0, 1e-320, -1e-160, 1e-9, 1e9, 1e154, -1e200, 1e308, -1e308]
HOSTILE = st.one_of(PLAIN, st.sampled_from(EDGES))
WORST = st.one_of(HOSTILE, st.sampled_from([math.inf, -math.inf, math.nan]))


@dataclass(frozen=True)
class Tangle:
    """
    initial   of the unknowns; every second one is in a child of the root, if `nested`
    constants come next
    steps     operations on what came before, by number
    rows      what is a constraint by itself: the number of a value, and whether it is `=`, `<=`, or a
              preference `~`
    """

    initial: tuple[float, ...]
    constants: tuple[float, ...]
    steps: tuple[tuple[str, tuple[int, ...]], ...]
    rows: tuple[tuple[int, str], ...] = ()
    nested: bool = False
    kept: int = 0
    """How many unknowns are kept sizes."""

    def model(self) -> tuple[Model, list[E]]:
        m = Model()
        group = m.group() if self.nested else 0
        found = [
            m.unknown(value, group=group if i % 2 else 0, kept=i < self.kept, visible=True)
            for i, value in enumerate(self.initial)
        ]
        found.extend(E(m.builder, m.builder.constant(value)) for value in self.constants)
        for method, operands in self.steps:
            nodes = [found[i].node for i in operands]
            found.append(E(m.builder, getattr(m.builder, method)(*nodes)))
        for number, sense in self.rows:
            (m.at_most if sense == "<=" else m.equal)(found[number], weight=1.0 if sense == "~" else None)
        return m, found

    def problem(self) -> Problem:
        return self.model()[0].problem()


@st.composite
def tangles(draw: st.DrawFn, numbers: st.SearchStrategy[float], rows: int = 0) -> Tangle:
    initial = tuple(draw(st.lists(numbers, min_size=1, max_size=4)))
    constants = tuple(draw(st.lists(numbers, max_size=3)))
    steps: list[tuple[str, tuple[int, ...]]] = []
    for _ in range(draw(st.integers(1, 8))):
        method, last = draw(st.sampled_from(sorted(ARITY))), len(initial) + len(constants) + len(steps) - 1
        steps.append((method, tuple(draw(st.integers(0, last)) for _ in range(ARITY[method]))))
    total = len(initial) + len(constants) + len(steps)
    chosen = st.tuples(st.integers(0, total - 1), st.sampled_from(["=", "<=", "~"]))
    return Tangle(
        initial,
        constants,
        tuple(steps),
        tuple(draw(st.lists(chosen, min_size=min(rows, 1), max_size=rows))),
        rows > 0 and draw(st.booleans()),
        draw(st.integers(0, len(initial))) if rows else 0,
    )
