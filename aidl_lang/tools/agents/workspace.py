"""A program given as text: the files that it may import, limits, and changes of its params."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import field
from pathlib import Path

from aidl_lang import parser, pipeline
from aidl_lang.building.model import Knob
from aidl_lang.building.state import BuildingLimits
from aidl_lang.checking.units import UNITS
from aidl_lang.common import names
from aidl_lang.common.diagnostics import AidlError, Diagnostic, Edit
from aidl_lang.common.prose import did_you_mean, first_few, ticked
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import DiskWorld, FileError, MemoryWorld, World, normalize
from aidl_lang.parser import TextLimits
from aidl_lang.pipeline import Compiled, Settings
from aidl_lang.solver.problem import Settings as SolverSettings
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import string_text
from aidl_lang.tools.discretion import Programs, Reader

PROGRAM = "program.aidl"
"""The name of the program in diagnostics."""


class RefusalError(AidlError):
    """Raised for a call that cannot be answered; the diagnostics give the reason and a remedy."""


def refusal(code: str, message: str, *hints: str) -> RefusalError:
    return RefusalError(Diagnostic(code, message, hints=hints))


@record()
class Limits:
    """Limits for programs that nobody has read.

    characters  of the program and of all files given with it
    files       given with it
    text        characters of the model, and of all exports
    pixels      larger side of the picture
    """

    characters: int = 400_000
    files: int = 100
    text: int = 60_000
    pixels: int = 1_000
    settings: Settings = Settings(
        TextLimits(max_characters=400_000),
        BuildingLimits(entities=12_000, constraints=20_000, turns=100_000, seconds=8.0),
        SolverSettings(tolerance=1e-10, seconds=12.0),
    )


@record()
class Surroundings:
    """The files visible to a program: those given with it, then the programs below a folder."""

    given: MemoryWorld
    disk: World | None = None

    def read(self, path: str) -> str:
        return self._holder(path).read(path)

    def read_bytes(self, path: str) -> bytes:
        return self._holder(path).read_bytes(path)

    def _holder(self, path: str) -> World:
        return self.given if self.disk is None or normalize(path) in self.given.files else self.disk

    def reader(self, source: SourceFile) -> Reader:
        """Returns the author of the program and of the files given with it."""
        return Reader({**self.given.files, source.name: source.text})


@record()
class Workspace:
    """`root` is the folder whose files may be imported; without one, only given files can be."""

    root: Path | None = None
    limits: Limits = field(default_factory=Limits)

    def open(self, program: str, files: Mapping[str, str] | None) -> tuple[SourceFile, Surroundings]:
        """Returns the program as a source, with its surroundings. Raises RefusalError."""
        files = files or {}
        self._measure(program, files)
        try:
            given = MemoryWorld(files)
        except FileError as error:
            message = f"the file name `{error.path[:200]}` cannot be used: {error.reason}"
            hint = "name files as the program imports them, as `parts/bolt.aidl`"
            raise refusal("E0944", message, hint) from None
        disk = None if self.root is None else Programs(DiskWorld(self.root))
        return SourceFile(PROGRAM, program.removeprefix("\ufeff")), Surroundings(given, disk)

    def _measure(self, program: str, files: Mapping[str, str]) -> None:
        characters, most = len(program) + sum(map(len, files.values())), self.limits.characters
        if characters > most:
            many = f"the program and its files have {characters:,} characters, more than the {most:,} allowed"
            raise refusal("E0944", many, "say what repeats with `for` and with templates")
        if len(files) > self.limits.files:
            many = f"{len(files):,} files were given, more than the {self.limits.files:,} allowed"
            raise refusal("E0944", many, "give only those that the program imports")


# --- Numbers as people type them, with units, sums and fractions: `12cm`, `80 + 20`, `1/2in`, `3 1/2in`.

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
    text = text.replace("\u2212", "-")
    if _COMMA.fullmatch(text.lstrip("+-").rstrip("".join(UNITS) + " ")):
        text = text.replace(",", ".")
    expression = _FRACTION.sub(_fraction, _APART.sub("", text))
    found = {unit: _added(zero, expression) for unit, zero in _ZEROS.items()}
    values = {unit: value for unit, value in found.items() if isinstance(value, float)}
    if not values:
        plain = _added("", expression)
        return plain if isinstance(plain, str) else "that is neither a length, an angle nor a plain number"
    units = set(_SUFFIX.findall(expression))
    unit, value = next(iter(values.items()))
    return Quantity(value, unit if len(values) == 1 else "", units.pop() if len(units) == 1 else None)


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
        # of syntax, the places are not those of what was typed
        return _NONE if not wrong or wrong[0].code.startswith("E01") else wrong[0].message
    value = known[0].value
    return value if isinstance(value, float) else _NONE


def _is_alone(source: SourceFile, start: int, length: int) -> bool:
    statements = parser.parse(source).module.statements
    value = statements[0].value if isinstance(statements[0], ast.Param) else None
    return len(statements) == 2 and value is not None and value.span.end >= start + length


# --- Changes the default of a `param` in the text of a program, and nothing else of it.

_OUTSIDE = "E0505"
"""Code for a `param` whose default lies outside its own range."""
_LARGEST = 1e9
_KINDS = {"mm": "a length", "deg": "an angle"}
_NAMED = 12


def edit_of(knob: Knob, source: SourceFile, value: float | str | bool) -> Edit:
    """Returns the edit that makes a value the default. Raises RefusalError for an invalid one."""
    if knob.span is None or knob.span.source is not source:
        where = f"`{knob.span.source.name}`" if knob.span else "another file"
        raise refusal(
            "E0945", f"`{knob.path}` is declared in {where}", "edit that file as a program of its own"
        )
    # The tree that the program was built from is not kept.
    found = (n for n in ast.walk(parser.parse(source).module) if isinstance(n, ast.Param))
    start = knob.span.start
    return edit_at(knob, next(n for n in found if n.span.start == start), value)


def edit_at(knob: Knob, declared: ast.Param, value: float | str | bool) -> Edit:
    """Does the same for a known declaration."""
    return Edit(declared.value.span, _written(knob, declared.value, value))


def find(known: tuple[Knob, ...], name: str) -> Knob:
    """Returns the knob of a name or path, with or without that of the root. Raises RefusalError."""
    by_path = {knob.path: knob for knob in known}
    for wanted in (name, name.partition(".")[2]):
        if (path := names.find(wanted, by_path)) is not None:
            return by_path[path]
    near = did_you_mean(names.nearest(name, by_path))
    there = f"params of this program: {first_few(ticked(by_path), _NAMED) or 'none'}"
    raise refusal("E0945", f"there is no param `{name}`", *near, there)


def require_in_range(compiled: Compiled, span: Span) -> None:
    """Raises RefusalError if a new default, at a place in the changed program, lies outside its range."""
    for d in compiled.diagnostics:
        at = d.span
        if d.code == _OUTSIDE and at and at.source is span.source and at.start == span.start:
            raise RefusalError(Diagnostic("E0945", d.message, hints=d.hints))


def _written(knob: Knob, now: ast.Expression, value: float | str | bool) -> str:
    """Returns the value as the program writes it: in the unit given, else in the one that stands there."""
    if isinstance(knob.value, bool):
        if not isinstance(value, bool):
            raise _misfit(knob, value, "true or false")
        return str(value).lower()
    if isinstance(knob.value, str):
        if not isinstance(value, str):
            raise _misfit(knob, value, "a text")
        return string_text(value)
    if isinstance(value, bool):
        raise _misfit(knob, value, "a number")
    unit = now.unit if isinstance(now, ast.Number) else knob.unit or None
    if isinstance(value, str):
        found = typed(knob, value)
        value, unit = found.value, found.named or unit
    if not math.isfinite(value) or abs(value) > _LARGEST:
        raise _misfit(knob, value, "a number")
    factor = UNITS[unit][0] if unit else 1.0
    return f"{value / factor:.12g}{unit or ''}"


def typed(knob: Knob, text: str) -> Quantity:
    """Returns the number, in mm or degrees, that a text means for a knob. Raises RefusalError."""
    found = quantity(text)
    if isinstance(found, str):
        why = found
    elif found.unit and knob.unit and found.unit != knob.unit:
        why = f"that is {_KINDS[found.unit]}, and it is {_KINDS[knob.unit]}"
    elif abs(found.value) > _LARGEST:
        why = f"numbers go up to {_LARGEST:g}"
    else:
        return found
    raise refusal("E0945", f"`{text.strip()[:100]}` does not fit `{knob.path}`: {why}")


def _misfit(knob: Knob, value: object, wanted: str) -> RefusalError:
    said = f"`{value:g}`" if isinstance(value, float) else f"`{str(value)[:100]}`"
    return refusal("E0945", f"{said} does not fit: `{knob.path}` is {wanted}")
