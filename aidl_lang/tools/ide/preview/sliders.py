"""What stands beside a drawing: the `param`s of a program as sliders, and the problems on it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import Diagnostic, Edit
from aidl_lang.common.source import Span
from aidl_lang.geometry.solved import ConstraintReport
from aidl_lang.syntax import ast
from aidl_lang.tools.agents import workspace
from aidl_lang.tools.agents.workspace import refusal
from aidl_lang.tools.ends import is_whole
from aidl_lang.tools.ide.preview.elements import Conflict, Elements, Party, Places, Problem, Slider
from aidl_lang.tools.ide.workspace import View, edited, hasty

Value: TypeAlias = float | str | bool

_LITERALS = (ast.Number, ast.String, ast.Boolean)
_SLACK = 1e-9
"""Tolerance at the ends of a range, relative to the number."""


def sliders(view: View) -> Iterator[Slider]:
    """Yields the params in order of writing; of a broken text those of the picture, which are read only."""
    outcome, places = view.outcome, Places(view)
    known = outcome.knobs if outcome is not None else ()
    if not known and view.is_stale and view.drawn is not None:
        known = view.drawn.knobs
    for knob in known:
        declared = view.declaration(knob)
        yield Slider(
            knob.path,
            knob.path.rpartition(".")[2],
            _kind(knob),
            knob.value,
            knob.unit,
            knob.low,
            knob.high,
            knob.step if declared is None or knob.step is not None else _step(knob, declared.value),
            knob.choices,
            knob.doc or "",
            declared.value.span if declared is not None else places.now(knob.span),
            declared is not None and _is_literal(declared.value),
        )


def set_knob(view: View, path: str, value: Value) -> list[Edit]:
    """Returns the edits that make a value, or a text's worth, a param's default. Raises RefusalError."""
    knob = _knob(view, path)
    declared = view.declaration(knob)
    if declared is None:
        raise refusal("E0945", f"`{knob.path}` is declared in the library, and cannot be changed there")
    if not _is_literal(declared.value):
        written = declared.value.span.one_line
        raise refusal("E0945", f"`{knob.path}` is worked out, as `{written}`; change what it is made of")
    _require_allowed(knob, _worked_out(knob, value))
    edits = [workspace.edit_at(knob, declared, value)]
    if _is_typed(knob, value):
        _require_sense(view, edits)
    return edits


def worked_out(view: View, values: Mapping[str, Value]) -> dict[str, Value]:
    """Returns values of params with texts for numbers worked out. Raises RefusalError for an invalid one."""
    found = dict(values)
    for path, value in values.items():
        if isinstance(value, str) and _is_typed(knob := _knob(view, path), value):
            found[path] = _worked_out(knob, value)
            _require_allowed(knob, found[path])
    return found


def _knob(view: View, path: str) -> Knob:
    return workspace.find(view.outcome.knobs if view.outcome is not None else (), path)


def _is_typed(knob: Knob, value: Value) -> bool:
    return isinstance(value, str) and _kind(knob) in ("number", "choice") and not isinstance(knob.value, str)


def _worked_out(knob: Knob, value: Value) -> Value:
    return workspace.typed(knob, value).value if isinstance(value, str) and _is_typed(knob, value) else value


def _require_allowed(knob: Knob, value: Value) -> None:
    if _is_allowed(knob, value):
        return
    said = f"{value:.6g}" if isinstance(value, float) else str(value)
    why = "none of its choices"
    if knob.range is not None:
        low, high = knob.range
        why = f"outside its range {low:.6g}..{high:.6g}" + (f" {knob.unit}" if knob.unit else "")
    raise refusal("E0945", f"`{knob.path}` cannot be `{said}`: that is {why}")


def _require_sense(view: View, edits: list[Edit]) -> None:
    """Raises RefusalError if the text could no longer be built, as with a length where a number was."""
    again = edited(view, edits, hasty())
    wrong = next((found for found in again.diagnostics if found.is_error), None)
    if wrong is not None and view.solved is not None and again.solved is None:
        raise refusal("E0945", f"the program cannot be built with this: {wrong.message}")


def _is_literal(node: ast.Expression) -> bool:
    return isinstance(node, _LITERALS) or (isinstance(node, ast.Unary) and _is_literal(node.operand))


def _step(knob: Knob, value: ast.Expression) -> float | None:
    """Returns 1 for a count: a whole number without a unit, with a range from one whole number to another."""
    return 1.0 if is_whole(knob) and value.span.text.isdecimal() else None


def _kind(knob: Knob) -> str:
    if isinstance(knob.value, bool):
        return "truth"
    if knob.choices:
        return "choice"
    return "text" if isinstance(knob.value, str) else "number"


def _is_allowed(knob: Knob, value: Value) -> bool:
    if knob.choices:
        return value in knob.choices
    if not isinstance(value, float | int) or knob.range is None:
        return True  # what does not fit at all is told by what writes it
    low, high = knob.range
    slack = _SLACK * max(1.0, abs(low), abs(high))
    return math.isfinite(value) and low - slack <= value <= high + slack


# --- Problems on the drawing, each with its elements and points.

_QUOTED = re.compile("`([^`]+)`")


def problems(
    view: View, elements: Elements, painting: Sequence[Diagnostic] = (), *, tried: bool = False
) -> Iterator[Problem]:
    """Yields the diagnostics with elements and points; of values that are only tried none has a fix."""
    finder = _Finder(view, elements)
    for found in (*view.diagnostics, *painting):
        yield Problem(
            found.severity.value,
            found.code,
            found.message,
            () if tried and found.fix is not None else found.hints,
            found.span,
            tuple(finder.about(found)),
            tuple(p for p in found.points if all(map(math.isfinite, p))),
            (found.fix,) if found.fix is not None and not tried else (),
        )


def conflicts(view: View, elements: Elements) -> Iterator[Conflict]:
    """Yields the conflicting constraints of a program that does not solve."""
    if view.outcome is None or view.outcome.status == "solved":
        return
    finder = _Finder(view, elements)
    for conflict in view.outcome.conflicts():
        parties = []
        for party in conflict.parties:
            found = tuple(finder.related(party.span, party.path))
            off = party.off if math.isfinite(party.off) else None
            parties.append(Party(party.text, party.span, found, off))
        yield Conflict(conflict.headline, tuple(parties))


class _Finder:
    def __init__(self, view: View, elements: Elements) -> None:
        self.elements = elements
        self.constraints: dict[Span, list[ConstraintReport]] = {}
        model = view.drawn.model if view.drawn is not None else None
        places = Places(view)
        for report in model.constraints if model is not None else ():
            if (span := places.now(report.span)) is not None:
                self.constraints.setdefault(span, []).append(report)

    def about(self, found: Diagnostic) -> list[int]:
        """Returns the elements written, or constrained, in the places that a diagnostic names.

        If several share a place, as the turns of a loop do, only those whose paths the message quotes, before
        it names what is beside them.
        """
        spans = [s for s in (found.span, *(label.span for label in found.secondary)) if s is not None]
        here = [k for span in spans for k in self.elements.written_at(span) or self.related(span)]
        quoted = set(_QUOTED.findall(found.message.partition(";")[0]))
        named = [k for k in here if self.elements.values[k].path in quoted]
        return list(dict.fromkeys(named or here))

    def related(self, span: Span, holder: str | None = None) -> list[int]:
        """Returns the elements that the constraints in a place relate; only those of `holder`, if given."""
        reports = self.constraints.get(span, [])
        paths = [path for r in reports if holder in (None, r.path) for path in r.mentions()]
        return self.elements.all_near(paths)
