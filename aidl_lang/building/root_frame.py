"""Places of structures in the frame of the root, in numbers of any kind.

`model.convert` does the same with expressions, from any frame to any other. The drawing is wanted in the
frame of the root: the numbers that are read off a solution, and those that the solver observes.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import field
from typing import Generic, NamedTuple, Protocol, TypeVar

from aidl_lang.building.expression import Expression
from aidl_lang.building.model import Structure
from aidl_lang.common.records import record

N = TypeVar("N")


class Arithmetic(Protocol[N]):
    """The arithmetic of numbers of one kind."""

    def add(self, a: N, b: N, /) -> N: ...

    def sub(self, a: N, b: N, /) -> N: ...

    def mul(self, a: N, b: N, /) -> N: ...

    def neg(self, a: N, /) -> N: ...


class _Floats:
    """The arithmetic of plain numbers."""

    add = staticmethod(operator.add)
    sub = staticmethod(operator.sub)
    mul = staticmethod(operator.mul)
    neg = staticmethod(operator.neg)


FLOATS: Arithmetic[float] = _Floats()


class _Step(NamedTuple, Generic[N]):
    """The frame of a structure in its parent's; `turn` is its cosine and sine, None if exactly level."""

    x: N
    y: N
    turn: tuple[N, N] | None
    mirrored: bool


@record(frozen=False)
class Placing(Generic[N]):
    """A converter of points to the frame of the root. `number` evaluates an expression, `arithmetic` computes
    with the results.
    """

    number: Callable[[Expression], N]
    arithmetic: Arithmetic[N]
    _ways: dict[Structure, tuple[_Step[N], ...]] = field(default_factory=dict)

    def __call__(self, x: N, y: N, owner: Structure) -> tuple[N, N]:
        """Returns a point in the frame of `owner`, as the root sees it."""
        way = self._ways.get(owner)
        if way is None:
            way = self._way(owner)
        if not way:
            return x, y
        add, sub, mul = self.arithmetic.add, self.arithmetic.sub, self.arithmetic.mul
        for step in way:
            if step.mirrored:
                x = self.arithmetic.neg(x)
            if step.turn is not None:
                c, s = step.turn
                x, y = sub(mul(c, x), mul(s, y)), add(mul(s, x), mul(c, y))
            x, y = add(step.x, x), add(step.y, y)
        return x, y

    def _way(self, s: Structure) -> tuple[_Step[N], ...]:
        if (known := self._ways.get(s)) is None:
            known = () if s.parent is None else (self._step(s), *self._way(s.parent))
            self._ways[s] = known
        return known

    def _step(self, s: Structure) -> _Step[N]:
        frame, number, turn = s.frame, self.number, None
        if not frame.is_level:
            cosine, sine = frame.cos_sin()
            turn = number(cosine), number(sine)
        return _Step(number(frame.x), number(frame.y), turn, frame.mirrored)
