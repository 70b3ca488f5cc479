"""Inlay hints: the solved values of first guesses, the chosen meaning of an ambiguous call, and values of
`param`s that were set from outside.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum

from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.names import fold
from aidl_lang.common.numbers import fixed
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.solved import Scalar
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.guesses import Guess, guesses
from aidl_lang.tools.ide.view import View
from aidl_lang.tools.ide.writing_back import number_for

_DECIMALS = 3
_ARROW = "→"


class InlayKind(StrEnum):
    SOLVED = "what a number was solved to"
    READING = "how an ambiguous call was taken"
    PARAM = "what a param was set to from outside"


@record()
class Inlay:
    """A hint shown at an offset; `edits` write it into the text, if that can be done."""

    offset: int
    text: str
    kind: InlayKind
    tooltip: str
    edits: tuple[Edit, ...] = ()


def inlays(view: View, span: Span | None = None) -> list[Inlay]:
    """Returns the hints in a part of the text, or in all of it; none while another text is drawn."""
    if view.outcome is None or view.outcome.model is None or view.is_stale:
        return []
    found = [*_solved(view), *_readings(view), *_set_from_outside(view)]
    wanted = (i for i in found if span is None or span.start <= i.offset <= span.end)
    return sorted(wanted, key=lambda inlay: inlay.offset)


def _solved(view: View) -> Iterator[Inlay]:
    for guess in guesses(view):
        if guess.solved is None or not guess.is_off(guess.solved):
            continue
        text = f"{_ARROW} {_shown(guess.solved)}{guess.behind}"
        edits = () if guess.is_shared else (Edit(guess.span, number_for(guess, guess.solved)),)
        yield Inlay(guess.span.end, text, InlayKind.SOLVED, _told(guess), edits)


def _told(guess: Guess) -> str:
    kind = "a size that had to change" if guess.is_kept else "a first guess"
    many = f", and of {len(guess.uses) - 1} more" if len(guess.uses) > 1 else ""
    written, solved = _shown(guess.written), fixed(guess.solved or 0.0)
    return f"`{guess.path}`{many}: {kind}, written as {written} and solved to {solved}{guess.behind}"


def _readings(view: View) -> Iterator[Inlay]:
    assert view.outcome is not None
    assert view.outcome.model is not None
    for reading in view.outcome.model.readings:
        if reading.span.source is view.source:
            about = (
                f"`{reading.span.one_line}` has several meanings. By what is written it is {reading.text}."
            )
            yield Inlay(reading.span.end, reading.text, InlayKind.READING, about)


def _set_from_outside(view: View) -> Iterator[Inlay]:
    """Yields the `param` values given to a run, if they differ from the text."""
    assert view.outcome is not None
    given = {fold(name.strip()) for name in view.params or ()}
    values = {node.span: node.value for node in ast.walk(view.module) if isinstance(node, ast.Param)}
    for knob in view.outcome.knobs if given else ():
        value = values.get(knob.span) if knob.span is not None else None
        root = view.outcome.model.root.path if view.outcome.model is not None else ""
        if value is None or given.isdisjoint({fold(knob.path), fold(f"{root}.{knob.path}")}):
            continue
        if _as_written(value) != knob.value:
            unit = f" {knob.unit}" if knob.unit else ""
            text = f"{_ARROW} {_shown(knob.value)}{unit}"
            yield Inlay(value.span.end, text, InlayKind.PARAM, f"`{knob.path}` is set from outside")


def _as_written(node: ast.Expression) -> Scalar | None:
    """Returns the value of a literal; None for any other expression."""
    match node:
        case ast.String(value=value) | ast.Boolean(value=value):
            return value
        case ast.Number(value=value, unit=unit):
            return value * (UNITS[unit][0] if unit else 1.0)
        case ast.Unary(operator="-", operand=ast.Number(value=value, unit=unit)):
            return -value * (UNITS[unit][0] if unit else 1.0)
        case _:
            return None


def _shown(value: Scalar) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return f'"{value}"'
        case _:
            return fixed(value, _DECIMALS)
