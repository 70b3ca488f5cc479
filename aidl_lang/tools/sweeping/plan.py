"""The variants of a sweep in their order: a grid, the rows of a table, values drawn at random, or products of
these.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import prod

from aidl_lang.building.model import Knob
from aidl_lang.common.records import record
from aidl_lang.tools.sweeping.axes import MOST, Axis, Span, Value, spelled, wrong


@record()
class Variant:
    """One setting of the params of a program.

    number  from 1, in the order of the sweep
    values  what is set, by path
    labels  other fields of its row in a table
    """

    number: int
    values: Mapping[str, Value]
    labels: Mapping[str, str]

    def params(self, knobs: Mapping[str, Knob]) -> dict[str, Value]:
        """Returns the values as they are handed to the program."""
        return {path: spelled(knobs.get(path), given) for path, given in self.values.items()}


@record()
class Rows:
    """The rows of a table. `labels` are the columns that are no params."""

    params: tuple[str, ...]
    labels: tuple[str, ...]
    values: tuple[Mapping[str, Value], ...]
    labelled: tuple[Mapping[str, str], ...]


@record()
class Plan:
    """The variants of a sweep.

    axes    params with their values, the last of which changes quickest
    drawn   how many variants are drawn at random, and the seed. A value depends on the seed, its param and
            its
            number alone, so that a wider sweep begins with the same variants
    """

    knobs: Mapping[str, Knob]
    axes: tuple[Axis, ...]
    rows: Rows | None = None
    drawn: tuple[int, int] | None = None

    @property
    def paths(self) -> tuple[str, ...]:
        """Returns the params that are set."""
        return (*(self.rows.params if self.rows else ()), *(axis.path for axis in self.axes))

    @property
    def labels(self) -> tuple[str, ...]:
        """Returns the other columns of the table."""
        return self.rows.labels if self.rows else ()

    def __len__(self) -> int:
        if self.drawn is not None:
            return self.drawn[0]
        return (len(self.rows.values) if self.rows else 1) * prod(len(axis.values) for axis in self.axes)

    def __iter__(self) -> Iterator[Variant]:
        if self.drawn is not None:
            yield from self._drawn(*self.drawn)
            return
        rows: Sequence[tuple[Mapping[str, Value], Mapping[str, str]]] = [({}, {})]
        if self.rows is not None:
            rows = list(zip(self.rows.values, self.rows.labelled, strict=True))
        number = 0
        for values, labels in rows:
            for chosen in product(*(axis.values for axis in self.axes)):
                number += 1
                paths = (axis.path for axis in self.axes)
                yield Variant(number, {**values, **dict(zip(paths, chosen, strict=True))}, labels)

    def _drawn(self, count: int, seed: int) -> Iterator[Variant]:
        for number in range(1, count + 1):
            values = {
                axis.path: _draw(axis, random.Random(f"{seed} {axis.path} {number}")) for axis in self.axes
            }
            yield Variant(number, values, {})


def _draw(axis: Axis, chance: random.Random) -> Value:
    span = axis.span
    if span is None:
        return axis.values[chance.randrange(len(axis.values))]
    if span.step:
        return float(f"{span.low + span.step * chance.randint(0, span.steps):.12g}")
    return float(f"{chance.uniform(span.low, span.high):.9g}")


def planned(
    knobs: Sequence[Knob],
    axes: Sequence[Axis],
    rows: Rows | None = None,
    drawn: tuple[int, int] | None = None,
) -> Plan:
    """Returns the plan of a sweep. Raises AidlError if there is nothing to vary, or too much."""
    if drawn is not None:
        if rows is not None:
            raise wrong(
                "a table says all variants, so none can be drawn at random",
                "leave out the table, or `--random`",
            )
        axes = [*axes, *_free(knobs, {axis.path for axis in axes})]
    plan = Plan({knob.path: knob for knob in knobs}, tuple(axes), rows, drawn)
    seen: set[str] = set()
    for path in plan.paths:
        if path in seen:
            raise wrong(f"`{path}` is set twice", "give all its values at once: `a,b,c`")
        seen.add(path)
    if not seen:
        raise wrong("nothing is varied")
    if not 1 <= len(plan) <= MOST:
        raise wrong(
            f"{len(plan)} variants are too many; a sweep has up to {MOST}", "sweep a part of them at a time"
        )
    return plan


def _free(knobs: Sequence[Knob], set_already: set[str]) -> Iterator[Axis]:
    """Yields the params that can be drawn: those with choices or a range."""
    for knob in knobs:
        if knob.path in set_already:
            continue
        if knob.choices:
            yield Axis(knob.path, tuple(knob.choices))
        elif isinstance(knob.value, bool):
            yield Axis(knob.path, (False, True))
        elif knob.low is not None and knob.high is not None:
            yield Axis(knob.path, (), Span(knob.low, knob.high, knob.step))
