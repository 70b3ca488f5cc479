"""A small language for writing problems in tests: numbers, unknowns and groups with operators."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from aidl_lang.solver import Constraint, Problem, Relation, Row
from aidl_lang.solver.expression import TapeBuilder
from aidl_lang.solver.problem import constraint_arrays


def call(method: str, *operands: E | float, step: int = 1) -> E:
    """What a method of the builder makes of operands, the first an expression; with step -1 from the last."""
    builder = operands[0].builder
    nodes = [e.node if isinstance(e, E) else builder.constant(e) for e in operands[::step]]
    return E(builder, getattr(builder, method)(*nodes))


def _by(method: str, step: int = 1) -> Callable[..., E]:
    return lambda *operands: call(method, *operands, step=step)


@dataclass(frozen=True)
class E:
    """A node of the tape of `builder`."""

    builder: TapeBuilder
    node: int

    __add__, __radd__ = _by("add"), _by("add", -1)
    __sub__, __rsub__ = _by("sub"), _by("sub", -1)
    __mul__, __rmul__ = _by("mul"), _by("mul", -1)
    __truediv__, __rtruediv__ = _by("div"), _by("div", -1)
    __mod__, __pow__, __neg__, __abs__ = _by("mod"), _by("power"), _by("neg"), _by("abs")


class Model:
    """Collects a problem; unknowns are made in the order of their indices."""

    def __init__(self) -> None:
        self.builder = TapeBuilder()
        self.initial: list[float] = []
        self.scale: list[float] = []
        self.kept: list[bool] = []
        self.group_of: list[int] = []
        self.frame_of: list[int] = []
        self.parent: list[int] = [-1]
        self.constraints: list[Constraint] = []
        self.observables: list[tuple[int, int]] = []

    def group(self, parent: int = 0) -> int:
        self.parent.append(parent)
        return len(self.parent) - 1

    def unknown(
        self,
        initial: float,
        group: int = 0,
        kept: bool = False,
        frame: int = -1,
        scale: float = 1.0,
        visible: bool = False,
    ) -> E:
        self.initial.append(initial)
        self.scale.append(scale)
        self.kept.append(kept)
        self.group_of.append(group)
        self.frame_of.append(frame)
        expression = E(self.builder, self.builder.unknown(len(self.initial) - 1))
        if visible:
            self.observe(group, expression)
        return expression

    def point(self, x: float, y: float, group: int = 0, visible: bool = True) -> tuple[E, E]:
        return self.unknown(x, group, visible=visible), self.unknown(y, group, visible=visible)

    def frame(self, child: int, x: float = 0.0, y: float = 0.0) -> tuple[E, E]:
        parent = self.parent[child]
        return self.unknown(x, parent, frame=child), self.unknown(y, parent, frame=child)

    def observe(self, group: int, *expressions: E) -> None:
        self.observables.extend((group, e.node) for e in expressions)

    def index(self, unknown: E) -> int:
        return next(i for i in range(len(self.initial)) if self.builder.unknown(i) == unknown.node)

    def equal(self, *residuals: E, group: int = 0, placed: Iterable[E] = (), **options: float) -> int:
        return self._add(Relation.EQUAL, residuals, group, placed, **options)

    def at_most(self, *residuals: E, group: int = 0, placed: Iterable[E] = (), **options: float) -> int:
        return self._add(Relation.AT_MOST, residuals, group, placed, **options)

    def _add(
        self,
        relation: Relation,
        residuals: tuple[E, ...],
        group: int,
        placed: Iterable[E],
        weight: float | None = None,
        scale: float = 1.0,
    ) -> int:
        rows = tuple(Row(e.node, relation, scale) for e in residuals)
        indices = frozenset(self.index(e) for e in placed)
        self.constraints.append(Constraint(group, rows, indices, weight))
        return len(self.constraints) - 1

    def problem(self) -> Problem:
        return Problem(
            tape=self.builder.finish(),
            initial=np.array(self.initial, dtype=np.float64),
            scale=np.array(self.scale, dtype=np.float64),
            kept=np.array(self.kept, dtype=np.bool_),
            group=np.array(self.group_of, dtype=np.int64),
            frame_of=np.array(self.frame_of, dtype=np.int64),
            parent=np.array(self.parent, dtype=np.int64),
            **constraint_arrays(self.constraints),
            observables=tuple(self.observables),
        )


def distance(a: tuple[E, E], b: tuple[E, E]) -> E:
    return call("hypot", a[0] - b[0], a[1] - b[1])
