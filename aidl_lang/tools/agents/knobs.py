"""Changes the default of a `param` in the text of a program, and nothing else of it."""

from __future__ import annotations

import math

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
from aidl_lang.tools.agents.quantities import Quantity, quantity
from aidl_lang.tools.agents.workspace import RefusalError, refusal

_OUTSIDE = "E0505"
"""Code for a `param` whose default lies outside its own range."""
_LARGEST = 1e9
_KINDS = {"mm": "a length", "deg": "an angle"}
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
    """Returns the value as the program writes it: a number in the unit that it was given in, or that stands
    there now.
    """
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
    """Returns the number that a text means for a knob, in mm or degrees. Raises RefusalError if it means
    none, or one of another kind.
    """
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
