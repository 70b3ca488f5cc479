"""Changes the default of a `param` in the text of a program, and nothing else of it."""

from __future__ import annotations

import math
import re

from aidl_lang import parser
from aidl_lang.building.model import Knob
from aidl_lang.checking.units import UNITS
from aidl_lang.common import names
from aidl_lang.common.diagnostics import Diagnostic, Edit
from aidl_lang.common.prose import did_you_mean, first_few, ticked
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.pipeline import Compiled
from aidl_lang.syntax import ast
from aidl_lang.syntax.expression_printer import string_text
from aidl_lang.tools.agents.workspace import RefusalError, refusal

_OUTSIDE = "E0505"
"""Code for a `param` whose default lies outside its own range."""
_LARGEST = 1e9
_QUANTITY = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-z]*)")
_NAMED = 12


def edit_of(knob: Knob, source: SourceFile, value: float | str | bool) -> Edit:
    """Returns the edit that makes a value the default. Raises RefusalError for an invalid one."""
    return edit_at(knob, _declaration(knob, source), value)


def edit_at(knob: Knob, declared: ast.Param, value: float | str | bool) -> Edit:
    """Does the same for a known declaration."""
    return Edit(declared.value.span, _written(knob, declared.value, value))


def find(known: tuple[Knob, ...], name: str) -> Knob:
    """Returns the knob of a name or path, with or without that of the root. Raises RefusalError."""
    by_path = {knob.path: knob for knob in known}
    for wanted in (name, name.partition(".")[2]):
        if (path := names.find(wanted, by_path)) is not None:
            return by_path[path]
    near = [hint for path in names.nearest(name, by_path) for hint in did_you_mean([path])]
    raise refusal(
        "E0945",
        f"there is no param `{name}`",
        *near,
        f"params of this program: {first_few(ticked(by_path), _NAMED) or 'none'}",
    )


def require_in_range(compiled: Compiled, span: Span) -> None:
    """Raises RefusalError if a new default, at a place in the changed program, lies outside its range."""
    for d in compiled.diagnostics:
        at = d.span
        if d.code == _OUTSIDE and at and at.source is span.source and at.start == span.start:
            raise RefusalError(Diagnostic("E0945", d.message, hints=d.hints))


def _declaration(knob: Knob, source: SourceFile) -> ast.Param:
    if knob.span is None or knob.span.source is not source:
        where = f"`{knob.span.source.name}`" if knob.span else "another file"
        raise refusal(
            "E0945", f"`{knob.path}` is declared in {where}", "edit that file as a program of its own"
        )
    # The tree that the program was built from is not kept.
    found = (n for n in ast.walk(parser.parse(source).module) if isinstance(n, ast.Param))
    start = knob.span.start
    return next(n for n in found if n.span.start == start)


def _written(knob: Knob, now: ast.Expression, value: float | str | bool) -> str:
    """Returns the value as the program writes it: a number in the unit that stands there now."""
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
    if isinstance(value, str):
        return _quantity(knob, value)
    if not math.isfinite(value) or abs(value) > _LARGEST:
        raise _misfit(knob, value, "a number")
    unit = now.unit if isinstance(now, ast.Number) else knob.unit or None
    factor = UNITS[unit][0] if unit else 1.0
    return f"{value / factor:.12g}{unit or ''}"


def _quantity(knob: Knob, value: str) -> str:
    """Parses a number given as text, as `20cm`."""
    found = _QUANTITY.fullmatch(value.strip())
    if found is None or (found[2] and found[2] not in UNITS) or not abs(float(found[1])) <= _LARGEST:
        raise _misfit(knob, value, f"a number, with a unit or without: {', '.join(UNITS)}")
    return found[1] + found[2]


def _misfit(knob: Knob, value: object, wanted: str) -> RefusalError:
    said = f"`{value:g}`" if isinstance(value, float) else f"`{str(value)[:100]}`"
    return refusal("E0945", f"{said} does not fit: `{knob.path}` is {wanted}")
