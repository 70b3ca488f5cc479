"""Numbers of the text that the solver may change, their solved values, and writing these back."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import field, fields, is_dataclass

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Evaluator, Expression, Unknown
from aidl_lang.building.model import Literal
from aidl_lang.checking.units import ANGLE, LENGTH, PLAIN, UNITS
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.prose import shortest
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.solved import SolvedStructure
from aidl_lang.pipeline import Compiled
from aidl_lang.syntax import ast
from aidl_server.ide.references import CannotError, chosen
from aidl_server.ide.workspace import View, edited

# --- Compares the drawings of two outcomes.

SAME = 1e-6
"""Largest difference of two equal drawings, mm."""


def is_same(before: Compiled, after: Compiled, *, slid: bool = False, tolerance: float = SAME) -> bool:
    """Tells whether two outcomes draw the same, name by name; with `slid`, wherever the whole lies."""

    def is_near(a: float, b: float) -> bool:
        return abs(a - b) <= tolerance or (math.isnan(a) and math.isnan(b))

    if before.model is None or after.model is None or before.status != after.status:
        return False
    one, other = (list(_drawn(model.root, slid)) for model in (before.model, after.model))
    return len(one) == len(other) and all(
        name == path and len(a) == len(b) and all(map(is_near, a, b))
        for (name, a), (path, b) in zip(one, other, strict=True)
    )


def _drawn(root: SolvedStructure, slid: bool) -> Iterator[tuple[str, list[float]]]:
    """Yields the path of each thing in a drawing with the numbers that define it."""
    at = (root.box.left, root.box.bottom) if slid and root.box is not None else (0.0, 0.0)
    for structure in root.walk():
        box = structure.box
        corners = [] if box is None else [(box.left, box.bottom), (box.right, box.top)]
        yield structure.path, list(_numbers(corners, at))
        for geometry in structure.drawn:
            for part in geometry.walk():
                place = part.values.get("at") if part.type == "point" else None
                yield f"{part.path}: {part.type}", list(_numbers((part.curve, place), at))


def _numbers(value: object, at: Vec) -> Iterator[float]:
    match value:
        case (float() as x, float() as y):
            yield from (x - at[0], y - at[1])
        case float():
            yield value
        case tuple() | list():
            for item in value:
                yield from _numbers(item, at)
        case _ if is_dataclass(value):
            yield from _numbers([getattr(value, field.name) for field in fields(value)], at)


# --- Numbers of the text that the solver may change, first guesses and kept sizes, with their solved values.

VISIBLE = 1e-4
"""Least difference that is shown, as a share of the number, or of one for smaller ones."""
_SAME = 1e-7
"""The same for places that share a number and count as agreeing."""
_MEASURES = {LENGTH: "mm", ANGLE: "deg"}

Value = Callable[[Expression], float]


@record()
class Guess:
    """A number of the text that is a first guess or a kept size.

    span      the number, with its sign
    written   the number, and what it was `solved` to, both in the `unit` as written (empty: mm or degrees);
              None where places that share it were solved to different numbers
    measure   the unit to tell it in; empty for a plain number
    path      of what it is a number of, at the first place that it is used for
    is_kept   a size, which changes only if the constraints cannot hold otherwise
    is_shared it stands for several things, or might: in a loop, a template, a `let` that is read twice
    uses      what it became, place by place
    """

    span: Span
    written: float
    solved: float | None
    unit: str
    measure: str
    path: str
    is_kept: bool
    is_shared: bool
    uses: tuple[Literal, ...] = field(repr=False)

    @property
    def factor(self) -> float:
        """Millimetres or degrees in one of its unit."""
        return factor(self.unit)

    @property
    def behind(self) -> str:
        """Its measure, as written after a number in a sentence."""
        return f" {self.measure}" if self.measure else ""

    @property
    def unknowns(self) -> frozenset[Unknown]:
        return frozenset(ex.unknowns(use.became for use in self.uses))

    def valued(self, evaluate: Value) -> float | None:
        """Returns the number at other values of the unknowns, in its unit; None if its places differ."""
        return _agreed([evaluate(use.became) / self.factor for use in self.uses])

    def is_off(self, solved: float | None) -> bool:
        """True for a value that differs visibly from the written one."""
        return solved is not None and abs(solved - self.written) > VISIBLE * max(1.0, abs(solved))


def guesses(view: View) -> list[Guess]:
    """Returns the first guesses and kept sizes of the text in order; none before it was solved."""
    solved = view.solved
    if solved is None or not solved.holds:
        return []
    uses: dict[ast.Number | ast.Unary, list[Literal]] = {}
    for use in solved.built.literals:
        if use.node.span.source is view.source and not all(u.exact for u in ex.unknowns([use.became])):
            uses.setdefault(use.node, []).append(use)
    named = set(_read_more_than_once(view)) if uses else set()
    found = (_guess(node, tuple(each), node in named, solved.evaluate) for node, each in uses.items())
    return sorted(found, key=lambda guess: guess.span.start)


def _guess(node: ast.Number | ast.Unary, uses: tuple[Literal, ...], named: bool, evaluate: Value) -> Guess:
    number = node.operand if isinstance(node, ast.Unary) else node
    assert isinstance(number, ast.Number)
    unit = number.unit or ""
    is_negative = isinstance(node, ast.Unary) and node.operator == "-"
    return Guess(
        span=node.span,
        written=-number.value if is_negative else number.value,
        solved=_agreed([evaluate(use.became) / factor(unit) for use in uses]),
        unit=unit,
        measure=unit or _MEASURES.get(uses[0].dimension or PLAIN, ""),
        path=uses[0].path,
        is_kept=all(isinstance(use.became.payload, Unknown) and use.became.payload.kept for use in uses),
        is_shared=named or len(uses) > 1,
        uses=uses,
    )


def factor(unit: str | None) -> float:
    """Returns the millimetres or degrees in one of a unit; 1 without one."""
    return UNITS[unit][0] if unit else 1.0


def _agreed(values: list[float]) -> float | None:
    """Returns the common value; None if values differ or one is no number."""
    first = values[0]
    same = all(abs(value - first) <= _SAME * max(1.0, abs(first)) for value in values)
    return first if same and math.isfinite(first) else None


def _read_more_than_once(view: View) -> Iterator[ast.Node]:
    """Yields the numbers of a name that is read more than once: another use may compute with it."""
    uses = view.resolution.uses
    reads = Counter(symbol for node, symbol in uses.items() if isinstance(node, ast.Name))
    for node in ast.walk(view.module):
        for names, value in _named(view, node):
            if any(reads[uses[name]] > 1 for name in names if name in uses):
                yield from (n for n in ast.walk(value) if isinstance(n, (ast.Number, ast.Unary)))


def _named(view: View, node: ast.Node) -> Iterator[tuple[tuple[ast.Identifier, ...], ast.Expression]]:
    """Yields names with the parts of an expression that they read as it stands."""
    match node:
        case ast.Let(name=name, value=value):
            yield (name,), value
        case ast.Assign(name=name, value=ast.Number() | ast.Unary() | ast.List() as value):
            yield (name,), value
        case (
            ast.For(variables=names, iterable=iterable)
            | ast.ForArguments(variables=names, iterable=iterable)
            | ast.Comprehension(variables=names, iterable=iterable)
        ):
            yield names, iterable
        case ast.FunctionDefinition(parameters=parameters):
            for parameter in parameters:
                if parameter.default is not None:
                    yield (parameter.name,), parameter.default
        case ast.Call() if (signature := chosen(view, node)) is not None:
            if isinstance(signature.node, ast.FunctionDefinition):
                names = tuple(parameter.name for parameter in signature.node.parameters)
                for argument in node.arguments:
                    yield names, argument.value  # any of its parameters may be read more than once


# --- Writes solved values into the text in place of its first guesses, and of sizes that had to change.
#
# Every proposal is tried: the edited text is solved again, and has to draw the same.

_PRECISIONS = (VISIBLE / 2, 1e-9, 0.0)
"""Errors of a number, as shares of it (or of 1), tried in turn; with 0 all digits are written."""
_MOST_TRIES = 8


def can_write_back(view: View, span: Span | None = None, *, sizes: bool = False) -> bool:
    """Tells, without trying, whether there is anything to write."""
    return bool(_targets(view, span, sizes))


def write_back(view: View, span: Span | None = None, *, sizes: bool = False) -> tuple[Edit, ...]:
    """Returns the edits that write solved values as guesses, with `sizes` as sizes. Raises CannotError."""
    targets = _targets(view, span, sizes)
    if not targets:
        what = "kept size had to change" if sizes else "first guess was solved to something else"
        raise CannotError(f"no {what} here")
    for some in (targets, {g: v for g, v in targets.items() if not g.is_shared}):
        if some and (found := _tried(view, some)) is not None:
            return found
    raise CannotError("with the solved values written there, the program would not draw the same")


def number_for(guess: Guess, value: float, precision: float = VISIBLE / 2) -> str:
    """Writes a value as a number of the text, with its unit: the shortest within a share of it."""
    return shortest(value, precision * max(1.0, abs(value))) + guess.unit


def _targets(view: View, span: Span | None, sizes: bool) -> dict[Guess, float]:
    if view.solved is None:
        return {}
    evaluate = view.solved.evaluate
    if not sizes:  # at sizes as written, or else they would be written by the way, as the end of a line is
        evaluate = Evaluator({u: u.guess if u.kept else value for u, value in evaluate.values.items()})
    return {
        guess: value
        for guess in guesses(view)
        if span is None or (span.start <= guess.span.start and guess.span.end <= span.end)
        if (value := guess.valued(evaluate)) is not None and guess.is_off(value)
        if (any(unknown.kept for unknown in guess.unknowns) if sizes else not guess.is_kept)
    }


def _tried(view: View, targets: Mapping[Guess, float]) -> tuple[Edit, ...] | None:
    """Returns the shortest numbers that draw the same.

    If the drawing is free to slide as a whole, it may: a position that the text does not say still begins
    where it did, and draws the rest along. The numbers follow until nothing moves any more.
    """
    assert view.outcome is not None
    order = {guess.span: index for index, guess in enumerate(guesses(view))}
    wanted, level = dict(targets), dict.fromkeys(targets, 0)
    for _ in range(_MOST_TRIES):
        numbers = ((g, number_for(g, value, _PRECISIONS[level[g]])) for g, value in wanted.items())
        edits = tuple(Edit(guess.span, number) for guess, number in numbers)
        again = edited(view, edits)
        assert again.outcome is not None
        is_slid = is_same(view.outcome, again.outcome, slid=True)
        moved = _moved(again, wanted, order)
        if is_slid and (not moved or is_same(view.outcome, again.outcome)):
            before, after = ({d.code for d in each.diagnostics} for each in (view, again))
            return edits if after <= before else None
        finest = 1 if is_slid else len(_PRECISIONS) - 1
        coarse = [guess for guess in moved or wanted if level[guess] < finest]
        if coarse:
            level |= {guess: level[guess] + 1 for guess in coarse}
        elif is_slid:
            wanted |= moved
        else:
            return None
    return None


def _moved(again: View, wanted: Mapping[Guess, float], order: Mapping[Span, int]) -> dict[Guess, float]:
    now = guesses(again)
    if len(now) != len(order):
        return {}
    found: dict[Guess, float] = {}
    for guess, value in wanted.items():
        solved = now[order[guess.span]].solved
        if solved is not None and abs(solved - value) * guess.factor > SAME:
            found[guess] = solved
    return found
