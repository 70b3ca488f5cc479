"""The variants of a sweep in their order, and the values of each param as they are written."""

from __future__ import annotations

import csv
import math
import random
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from math import prod
from pathlib import Path
from typing import TypeAlias

from aidl_lang.building.model import Knob
from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.names import fold, nearest
from aidl_lang.common.prose import did_you_mean, first_few, named, ticked
from aidl_lang.common.records import record
from aidl_lang.common.world import Reads

Value: TypeAlias = float | str | bool

MOST = 1_000_000
"""Most variants of a sweep."""
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*[a-z]*"
_RANGE = re.compile(
    rf"\s*(?P<low>{_NUMBER})\s*\.\.\s*(?P<high>{_NUMBER}?)\s*"
    rf"(?:/\s*(?P<count>\d+)|step\s+(?P<step>{_NUMBER}))?\s*"
)
_SLACK = 1e-9
_BOOLEANS = {"true": True, "false": False, "1": True, "0": False}
_EXAMPLES = (
    "values are a list (`60,80,100`), so many of a range (`60..200/8`), or a range in steps "
    "(`60..200 step 20`)"
)


@record()
class Span:
    """A range that values are drawn from at random."""

    low: float
    high: float
    step: float | None

    @property
    def steps(self) -> int:
        return math.floor((self.high - self.low) / self.step * (1 + 1e-12) + _SLACK) if self.step else 0


@record()
class Axis:
    """A param with the values that it takes; `span` is their range, if it was written as one."""

    path: str
    values: tuple[Value, ...]
    span: Span | None = None


def refused(code: str, message: str, *hints: str) -> AidlError:
    return AidlError(Diagnostic(code, message, hints=hints))


def wrong(message: str, *hints: str) -> AidlError:
    """Returns the error for values that cannot be swept."""
    return refused("E0971", message, *(hints or (_EXAMPLES,)))


def knob_named(name: str, knobs: Sequence[Knob]) -> Knob:
    """Returns the param that a name means, however it is spelled. Raises AidlError."""
    wanted = fold(name.strip())
    for knob in knobs:
        if fold(knob.path) == wanted:
            return knob
    paths = [knob.path for knob in knobs]
    known = first_few(ticked(paths), 12, "") or "none"
    near = did_you_mean(nearest(name, paths)[:1])
    raise refused("E0911", f"there is no param `{name}`", *near, f"params of this program: {known}")


def axis(name: str, written: str, knobs: Sequence[Knob], *, is_drawn: bool = False) -> Axis:
    """Reads a param's values as written. A range of one that `is_drawn` needs no number. Raises AidlError."""
    knob = knob_named(name, knobs)
    if written.strip() == "*":
        return _all_of(knob)
    if isinstance(knob.value, float | int) and not isinstance(knob.value, bool) and ".." in written:
        return _ranged(knob, written, is_drawn=is_drawn)
    return Axis(knob.path, tuple(value(knob, each) for each in _listed(knob, written)))


def from_values(name: str, values: object, knobs: Sequence[Knob]) -> Axis:
    """Reads the values of a param as Python has them: one, or an iterable of them. Raises AidlError."""
    knob = knob_named(name, knobs)
    several = [values] if isinstance(values, str | bytes) or not isinstance(values, Iterable) else values
    found: list[Value] = []
    for each in several:
        plain = each.item() if hasattr(each, "item") else each
        if not isinstance(plain, str | bool | int | float):
            raise wrong(f"`{knob.path}` takes numbers, texts and booleans, not `{type(each).__name__}`")
        if len(found) == MOST:
            raise wrong(f"`{knob.path}` has more than {MOST} values", "sweep a part of them at a time")
        found.append(value(knob, plain))
    if not found:
        raise wrong(f"there are no values for `{knob.path}`")
    return Axis(knob.path, tuple(found))


def value(knob: Knob, given: Value) -> Value:
    """Returns a value of a param: a text as it stands, a number as such if it has no unit of its own."""
    if isinstance(knob.value, str):
        return given if isinstance(given, str) else str(given)
    if isinstance(knob.value, bool):
        word = shown(given).strip()
        return _BOOLEANS.get(word.casefold(), word)
    return _number(str(given).strip()) if isinstance(given, bool | str) else float(given)


def _number(text: str) -> Value:
    try:
        found = float(text)
    except ValueError:
        return text  # with a unit, or no number, which the program tells of
    return found if math.isfinite(found) else text


def spelled(knob: Knob | None, given: Value) -> Value:
    """Returns a value as it is handed to a program, which takes quotes and spaces around a text away."""
    is_text = knob is None or isinstance(knob.value, str)
    return f'"{given}"' if is_text and isinstance(given, str) else given


def _all_of(knob: Knob) -> Axis:
    if choices := _choices(knob):
        return Axis(knob.path, choices)
    if knob.low is not None and knob.high is not None and knob.step:
        return Axis(knob.path, tuple(_steps(knob, knob.low, knob.high, knob.step)))
    raise wrong(f"`{knob.path}` has no choices and no range with a step, so `*` says nothing")


def _choices(knob: Knob) -> tuple[Value, ...]:
    return knob.choices or ((False, True) if isinstance(knob.value, bool) else ())


def _listed(knob: Knob, written: str) -> list[str]:
    """Returns the items of a list; quotes keep commas and spaces."""
    try:
        (row,) = csv.reader([written], skipinitialspace=True, strict=True)
    except (csv.Error, ValueError):
        raise wrong(f"`{written}` is no list of values for `{knob.path}`: a quote has no end") from None
    items = [item if '"' in written else item.strip() for item in row]
    if not isinstance(knob.value, str) and any(not item.strip() for item in items):
        raise wrong(f"`{written}` leaves a value of `{knob.path}` out")
    if not items:
        raise wrong(f"there are no values for `{knob.path}`")
    return items


def _ranged(knob: Knob, written: str, *, is_drawn: bool) -> Axis:
    found = _RANGE.fullmatch(written)
    if found is None or not found["high"]:
        raise wrong(f"`{written}` is no range for `{knob.path}`")
    low, high = (_measure(knob, found[end]) for end in ("low", "high"))
    if low > high:
        turned = f"write `{found['high']}..{found['low']}`"
        raise wrong(f"the range `{written}` of `{knob.path}` runs backwards", turned)
    step = _measure(knob, found["step"]) if found["step"] else knob.step
    if is_drawn:
        return Axis(knob.path, (), Span(low, high, step))
    if found["count"]:
        return Axis(knob.path, tuple(_evenly(low, high, int(found["count"]), written)))
    if step is None:
        hint = f"write `{written.strip()}/8` for eight of them, or `{written.strip()} step 5`"
        raise wrong(f"`{written}` does not say how many values `{knob.path}` takes", hint)
    return Axis(knob.path, tuple(_steps(knob, low, high, step)))


def _measure(knob: Knob, text: str) -> float:
    """Returns a number with its unit, in mm or degrees."""
    number = text.rstrip("abcdefghijklmnopqrstuvwxyz ")
    unit = text[len(number) :].strip()
    factor = 1.0
    if unit:
        if unit not in UNITS:
            raise wrong(
                f"`{text}` of `{knob.path}` has no unit that there is", f"units are {', '.join(UNITS)}"
            )
        factor = UNITS[unit][0]
    measured = float(number) * factor
    if not math.isfinite(measured):
        raise wrong(f"`{text}` is too large for `{knob.path}`")
    return measured


def _evenly(low: float, high: float, count: int, written: str) -> list[Value]:
    if not 1 <= count <= MOST:
        raise wrong(f"`{written}` asks for {count} values; a sweep has 1 to {MOST}")
    if count == 1:
        return [low]
    return [_short(low + (high - low) * k / (count - 1)) for k in range(count)]


def _steps(knob: Knob, low: float, high: float, step: float) -> list[Value]:
    if not step > 0:
        raise wrong(f"the step of `{knob.path}` is not above 0")
    count = Span(low, high, step).steps
    if count >= MOST:
        raise wrong(f"`{knob.path}` would take {count + 1} values; a sweep has 1 to {MOST}")
    return [_short(low + step * k) for k in range(count + 1)]


def _short(number: float) -> float:
    return float(f"{number:.12g}")


def shown(given: Value) -> str:
    """Returns a value as it is shown: 80, round, true."""
    if isinstance(given, bool):
        return str(given).lower()
    return given if isinstance(given, str) else f"{given:.12g}"


def labels(values: Mapping[str, Value]) -> str:
    """Returns the values of a variant in a line: `width=80 style=round`."""
    return " ".join(f"{path}={shown(given)}" for path, given in values.items())


# --- The variants in their order: a grid, the rows of a table, values drawn at random, or their products.


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
    """The rows of a table: the values of its params in each, and its other columns, the `labels`."""

    params: tuple[str, ...]
    labels: tuple[str, ...]
    rows: tuple[tuple[Mapping[str, Value], Mapping[str, str]], ...]


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
        return (*(self.rows.params if self.rows else ()), *(axis.path for axis in self.axes))

    @property
    def labels(self) -> tuple[str, ...]:
        """Returns the other columns of the table."""
        return self.rows.labels if self.rows else ()

    def __len__(self) -> int:
        if self.drawn is not None:
            return self.drawn[0]
        return (len(self.rows.rows) if self.rows else 1) * prod(len(axis.values) for axis in self.axes)

    def __iter__(self) -> Iterator[Variant]:
        if self.drawn is not None:
            yield from self._drawn(*self.drawn)
            return
        paths = [axis.path for axis in self.axes]
        rows = self.rows.rows if self.rows is not None else [({}, {})]
        grid = ((row, chosen) for row in rows for chosen in product(*(axis.values for axis in self.axes)))
        for number, ((values, labels), chosen) in enumerate(grid, 1):
            yield Variant(number, {**values, **dict(zip(paths, chosen, strict=True))}, labels)

    def _drawn(self, count: int, seed: int) -> Iterator[Variant]:
        for number in range(1, count + 1):
            chances = ((axis, random.Random(f"{seed} {axis.path} {number}")) for axis in self.axes)
            yield Variant(number, {axis.path: _draw(axis, chance) for axis, chance in chances}, {})


def _draw(axis: Axis, chance: random.Random) -> Value:
    span = axis.span
    if span is None:
        return axis.values[chance.randrange(len(axis.values))]
    if span.step:
        return _short(span.low + span.step * chance.randint(0, span.steps))
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
            hint = "leave out the table, or `--random`"
            raise wrong("a table says all variants, so none can be drawn at random", hint)
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
        if choices := _choices(knob):
            yield Axis(knob.path, choices)
        elif knob.low is not None and knob.high is not None:
            yield Axis(knob.path, (), Span(knob.low, knob.high, knob.step))


# --- Reads a table whose rows are variants: its columns are params, and whatever else an order has.

_MOST_BYTES = 500_000_000
_LONGEST_CELL = 1_000_000
_wrong = partial(refused, "E0972")
_SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "bars"}


def read_table(path: Path, knobs: Sequence[Knob], reads: Reads) -> Rows:
    """Returns the rows of a CSV file. An empty cell leaves its param as written. Raises AidlError."""
    rows = _cells(path, reads)
    try:
        _, head = next(rows)
    except StopIteration:
        raise _wrong(f"`{path}` is empty", "its first line names the params") from None
    if len(head) == 1 and (others := [name for mark, name in _SEPARATORS.items() if mark in head[0]]):
        hint = "save it with commas as separators, and numbers with points: `12.5`"
        raise _wrong(f"the cells of `{path}` are separated by {others[0]}, not by commas", hint)
    columns = _columns(path, head, knobs)
    params = [(k, knob) for k, knob in enumerate(columns) if knob is not None]
    labels = [(k, name.strip()) for k, name in enumerate(head) if columns[k] is None]
    found: list[tuple[dict[str, Value], dict[str, str]]] = []
    for line, row in rows:
        if not any(row):
            continue
        if len(row) != len(head):
            raise _wrong(f"line {line} of `{path}` has {len(row)} cells, its first line {len(head)}")
        if len(found) == MOST:
            raise _wrong(f"`{path}` has more than {MOST} rows", "sweep a part of them at a time")
        values = {knob.path: value(knob, row[k]) for k, knob in params if row[k]}
        found.append((values, {name: row[k] for k, name in labels}))
    if not found:
        raise _wrong(f"`{path}` has no rows below its first line")
    return Rows(tuple(knob.path for _, knob in params), tuple(name for _, name in labels), tuple(found))


def _cells(path: Path, reads: Reads) -> Iterator[tuple[int, list[str]]]:
    try:
        text = reads.contents(path, _MOST_BYTES).decode("utf-8-sig")
    except FileNotFoundError:
        raise _wrong(f"there is no file `{path}`") from None
    except OSError as error:
        raise _wrong(f"`{path}` cannot be read: {(error.strerror or str(error)).lower()}") from None
    except UnicodeDecodeError as error:
        raise _wrong(f"`{path}` is not UTF-8 text (byte {error.start})", "save it as CSV in UTF-8") from None
    csv.field_size_limit(_LONGEST_CELL)
    reader = csv.reader(text.splitlines(keepends=True), strict=True)
    try:
        for row in reader:
            yield reader.line_num, row
    except csv.Error as error:
        raise _wrong(f"line {reader.line_num} of `{path}` is no CSV: {error}") from None


def _columns(path: Path, head: Sequence[str], knobs: Sequence[Knob]) -> list[Knob | None]:
    by_name = {fold(knob.path): knob for knob in knobs}
    paths = [knob.path for knob in knobs]
    found: list[Knob | None] = []
    seen: set[str] = set()
    for name in map(str.strip, head):
        if not name:
            raise _wrong(f"a column of `{path}` has no name", "its first line names the params")
        if fold(name) in seen:
            raise _wrong(f"`{path}` has two columns `{name}`")
        seen.add(fold(name))
        knob = by_name.get(fold(name))
        if knob is None and (near := nearest(name, paths)):
            raise _wrong(
                f"`{path}` has a column `{name}`, and there is no such param", *did_you_mean(near[:1])
            )
        found.append(knob)
    if not any(found):
        known = first_few(ticked(paths), 12) or "none"
        raise _wrong(
            f"no column of `{path}` is a param: it has {named(head)}", f"params of this program: {known}"
        )
    return found
