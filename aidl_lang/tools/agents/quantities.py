"""Numbers as people type them, with units, sums and fractions: `12cm`, `80 + 20`, `1/2in`, `3 1/2in`."""

from __future__ import annotations

import re

from aidl_lang import parser, pipeline
from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.syntax import ast

LONGEST = 200
"""Most characters of a number."""
_NONE = "that is not a number"
_NAME = "value"
_UNIT = "|".join(map(re.escape, sorted(UNITS, key=len, reverse=True)))
_APART = re.compile(rf"(?<=[0-9.])\s+(?=(?:{_UNIT})(?![^\W_]))")
"""Blanks between a number and its unit."""
_FRACTION = re.compile(rf"(?<![\w.)])(?:(\d+)\s+)?(\d+)\s*/\s*(\d+)({_UNIT})(?![^\W_])")
_COMMA = re.compile(r"\d+,\d+")
_SUFFIX = re.compile(rf"(?<=[0-9.])(?:{_UNIT})(?![^\W_])")
_ZEROS = {"mm": "0mm", "deg": "0deg"}
"""What only lengths, or only angles, can be added to."""


@record()
class Quantity:
    """A number in mm, in degrees or of nothing.

    unit   `mm`, `deg` or empty
    named  the unit that it was typed in; None if that was none, or several
    """

    value: float
    unit: str
    named: str | None


def quantity(text: str) -> Quantity | str:
    """Returns the number that a text means, as the language works it out; or else why it means none."""
    text = text.strip()
    if not text or len(text) > LONGEST or "\n" in text or "\r" in text:
        return _NONE
    expression = _spelled(text)
    found = {unit: _added(zero, expression) for unit, zero in _ZEROS.items()}
    values = {unit: value for unit, value in found.items() if isinstance(value, float)}
    if not values:
        plain = _added("", expression)
        return plain if isinstance(plain, str) else "that is neither a length, an angle nor a plain number"
    units = set(_SUFFIX.findall(expression))
    unit, value = next(iter(values.items()))
    return Quantity(value, unit if len(values) == 1 else "", units.pop() if len(units) == 1 else None)


def _spelled(text: str) -> str:
    """Returns a text as the language has it. Half an inch is `1/2in` to all who measure in inches, where the
    language would divide by two inches.
    """
    text = text.replace("\u2212", "-")
    if _COMMA.fullmatch(text.lstrip("+-").rstrip("".join(UNITS) + " ")):
        text = text.replace(",", ".")
    return _FRACTION.sub(_fraction, _APART.sub("", text))


def _fraction(found: re.Match[str]) -> str:
    whole, over, under, unit = found.groups(default="0")
    return f"({whole}{unit} + {over}{unit} / {under})"


def _added(zero: str, expression: str) -> float | str:
    """Returns the value of an expression, added to something if that is given; or what is wrong with it."""
    start = f"param {_NAME} = {zero}{' + ' if zero else ''}("
    source = SourceFile("typed", f"{start}{expression})\ndrawing typed {{}}\n")
    known, found = pipeline.knobs(source)
    wrong = [each for each in found if each.is_error]
    if wrong or len(known) != 1 or not _is_alone(source, len(start), len(expression)):
        return _why(wrong)
    value = known[0].value
    return value if isinstance(value, float) else _NONE


def _is_alone(source: SourceFile, start: int, length: int) -> bool:
    """Tells whether what was typed is one expression and nothing beside it."""
    statements = parser.parse(source).module.statements
    value = statements[0].value if isinstance(statements[0], ast.Param) else None
    return len(statements) == 2 and value is not None and value.span.end >= start + length


def _why(wrong: list[Diagnostic]) -> str:
    if not wrong or wrong[0].code.startswith("E01"):  # of syntax: the places are not those of what was typed
        return _NONE
    return wrong[0].message
