"""What a constraint in a conflict would have to say for the others to hold: another number in it.

The solver says where the others hold and by how much the constraint is off there. How far a number of the
statement would have to be turned follows from reading the statement again with another one in its place; it
counts only if the statement then holds.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from aidl_lang import ast
from aidl_lang.building.wording import Wording, replaced
from aidl_lang.diagnostics import Edit, Fix
from aidl_lang.expression import Evaluator, Unknown
from aidl_lang.model import SIZES, Comparison, Constraint
from aidl_lang.names import fold
from aidl_lang.solver.solution import Fit
from aidl_lang.source import Span
from aidl_lang.units import ANGLE, UNITS

_NUDGE = 1e-3
"""How far a number is turned to see what it does."""
_HOLDS = 1e-7
"""How far a constraint may be off, relative to the size of the drawing, and still be said to fit."""
_NEAR, _MEANT = 1e-8, 4
"""How near, relatively, a number lies to a shorter one that is meant, and the decimals of such a one."""
_FAR = 10.0
"""A number so many times as large, and beyond the drawing as well, is not what anyone means."""
_COARSE = 1e-2
"""Part of a change that may be added to make the number short, where there is a choice."""
_OPPOSITES = {"leftof": "right_of", "rightof": "left_of", "above": "below", "below": "above"}


@dataclass(frozen=True)
class Remedy:
    """
    written   the literals, the name of a constant, or that of a relation, in whose place something else
              would fit
    fitting   what would, as an author would write it, to six digits
    exact     the same for each that is written, with as many digits as it takes
    choice    `at most `, `at least ` or nothing, where nothing else would fit
    ambiguous whether the statement has other numbers
    """

    written: tuple[ast.Node, ...]
    fitting: str
    exact: tuple[str, ...]
    choice: str = ""
    ambiguous: bool = False

    @property
    def is_relation(self) -> bool:
        return isinstance(self.written[0], ast.Identifier)

    @property
    def is_literal(self) -> bool:
        """Whether it is written in the statement itself."""
        return not isinstance(self.written[0], ast.Name)

    @property
    def text(self) -> str:
        """`6 would fit`; where it is not clear for what, ``6 instead of `w` would fit``."""
        unclear = self.ambiguous or not self.is_literal
        instead = f" instead of `{self.written[0].span.text}`" if unclear else ""
        return f"{self.choice}{self.fitting}{instead} would fit"


def short(value: float) -> str:
    """A number to six digits."""
    return f"{round(value, 6) + 0.0:.6g}"


def remedy(
    wording: Wording, fit: Fit, values: Mapping[Unknown, float], size: float, *, vanishing: bool
) -> Remedy | None:
    """The number that would fit in a statement; None if no number alone would mend it.

    `values` are those at which the others hold, `size` is the extent of the drawing in mm. With `vanishing`
    the conflict is about a size that would have to vanish: then there is nothing to say but that a sign is
    wrong.
    """
    found = _Search(wording, fit, values, size).found()
    if found is not None and vanishing and not found.written[0].span.text.startswith("-"):
        found = None
    return found or _opposite(wording, fit, values, size)


def _opposite(wording: Wording, fit: Fit, values: Mapping[Unknown, float], size: float) -> Remedy | None:
    """The relation to the other side, if that is where the others put it."""
    call = wording.node
    other = _OPPOSITES.get(fold(call.callee.text)) if isinstance(call, ast.Call) else None
    if other is None or not isinstance(call, ast.Call):
        return None
    turned = replaced(call, call.callee, replace(call.callee, text=other))
    search = _Search(wording, fit, values, size)
    return Remedy((call.callee,), f"`{other}`", (other,)) if search.fits(turned) else None


class _Search:
    def __init__(self, wording: Wording, fit: Fit, values: Mapping[Unknown, float], size: float) -> None:
        self.wording, self.fit, self.values, self.size = wording, fit, values, size
        self.tolerance = _HOLDS * max(size, 1.0)
        self.dials = list(wording.dials())
        self.now = self._rows([])

    def found(self) -> Remedy | None:
        """Literals rather than names, the last rather than the first; then the two numbers of a point."""
        order = sorted(self.dials, key=lambda dial: (isinstance(dial[0], ast.Name), -dial[0].span.start))
        return next(filter(None, (self._turned(*dial) for dial in order)), None) or self._point()

    def _turned(self, dial: ast.Expression, value: float) -> Remedy | None:
        target, other, relation = self._target(dial, value) or (math.nan, math.nan, "")
        farthest = max(_FAR * abs(value), 2.0 * self.size)
        if not abs(target - value) <= farthest or not self._holds([(dial, target)]):
            return None
        choice = ""
        if relation == "==" and abs(other - target) > _COARSE * abs(target - value):
            choice = "at most " if other < target else "at least "
        number = _shortened(target, other, _COARSE * abs(target - value))
        if value < 0.0 <= target <= -value and choice == "at least ":
            target, number, choice = -value, -value, ""  # the sign was wrong
        elif target < 0.0 <= value and not _may_be_negative(self.wording.node, dial):
            return None
        numbers = [node for node, _ in self.dials if not isinstance(node, ast.Name)]
        return Remedy((dial,), _shown(dial, target), (_text(dial, number),), choice, len(numbers) > 1)

    def _target(self, dial: ast.Expression, value: float) -> tuple[float, float, str] | None:
        """Where the number would have to be, where if this constraint had no say, and by which relation."""
        nudged = self._rows([(dial, value + _NUDGE)])
        regardless = self.fit.regardless
        if not len(nudged) == len(self.now) == len(regardless):
            return None
        wanted: list[tuple[float, float, str]] = []
        for (relation, residual), (_, moved), free in zip(self.now, nudged, regardless, strict=True):
            if (abs(residual) if relation == "==" else residual) <= self.tolerance:
                continue
            slope = (moved - residual) / _NUDGE
            is_factor = abs(abs(slope) - 1.0) > _NUDGE and not _is_direct(self.wording.node, dial)
            if abs(slope) < _NUDGE or is_factor:
                return None
            wanted.append((value - residual / slope, value - free / slope, relation))
        return self._farthest(wanted, value)

    def _farthest(
        self, wanted: Sequence[tuple[float, float, str]], value: float
    ) -> tuple[float, float, str] | None:
        """The one farthest from a value. Of several that agree, one to the side that most would go to if they
        had no say; where neither side has more of them, no side.
        """
        reach = max((abs(target - value) for target, _, _ in wanted), default=0.0)
        alike = [each for each in wanted if abs(each[0] - value) >= reach - self.tolerance]
        if not alike:
            return None
        below = [each for each in alike if each[1] < each[0] - self.tolerance]
        above = [each for each in alike if each[1] > each[0] + self.tolerance]
        if len(below) == len(above) and below:
            target, _, relation = alike[0]
            return target, target, relation
        return (max(below, above, key=len) or alike)[0]

    def _point(self) -> Remedy | None:
        """Both numbers of a point that a coincidence names."""
        values = dict(self.dials)
        node = next((n for n in ast.walk(self.wording.node) if isinstance(n, ast.Point)), None)
        parts = (node.x, node.y) if node is not None else ()
        if [relation for relation, _ in self.now] != ["==", "=="] or len(parts) != 2:
            return None
        if not all(part in values and not isinstance(part, ast.Name) for part in parts):
            return None
        targets = [values[part] + residual for part, (_, residual) in zip(parts, self.now, strict=True)]
        turned = list(zip(parts, targets, strict=True))
        if not self._holds(turned):
            return None
        shown = ", ".join(_shown(part, target) for part, target in turned)
        return Remedy(parts, f"({shown})", tuple(_text(p, _shortened(t, t, 0.0)) for p, t in turned))

    def _rows(self, turned: Sequence[tuple[ast.Expression, float]]) -> list[tuple[str, float]]:
        """Relation (`==` or `<=`) and residual of each comparison, with other numbers in the statement."""
        node = self.wording.node
        for dial, value in turned:
            node = replaced(node, dial, ast.Number(value / _factor(dial), _unit(dial), "", span=dial.span))
        return self._read(node)

    def _read(self, node: ast.Expression) -> list[tuple[str, float]]:
        evaluate = Evaluator(self.values)
        return [_residual(comparison, evaluate) for comparison in self.wording.comparisons(node)]

    def _holds(self, turned: Sequence[tuple[ast.Expression, float]]) -> bool:
        return self._is_met(self._rows(turned))

    def fits(self, node: ast.Expression) -> bool:
        """Whether another statement holds where the others do."""
        return self._is_met(self._read(node))

    def _is_met(self, rows: Sequence[tuple[str, float]]) -> bool:
        return bool(rows) and max(abs(r) if sign == "==" else r for sign, r in rows) <= self.tolerance


def _residual(comparison: Comparison, evaluate: Evaluator) -> tuple[str, float]:
    """Zero where it holds; for an inequality, positive where it does not."""
    difference = evaluate(comparison.left) - evaluate(comparison.right)
    if comparison.relation != "==":
        return "<=", -difference if comparison.relation.startswith(">") else difference
    return "==", (difference + 180.0) % 360.0 - 180.0 if comparison.dimension == ANGLE else difference


def _is_direct(statement: ast.Node, dial: ast.Node) -> bool:
    """Whether the number is compared as it stands, or is an argument of the relation that is stated."""
    match statement:
        case ast.Comparison(operands=operands):
            return dial in operands
        case ast.Membership(container=ast.Range(start=start, end=end)):
            return dial in (start, end)
        case ast.Call(arguments=arguments):
            return any(argument.value is dial for argument in arguments)
    return False


def _may_be_negative(statement: ast.Node, dial: ast.Node) -> bool:
    """No gap, margin or size may, nor what has a name; a coordinate may that is compared or in a point."""
    if isinstance(dial, ast.Name):
        return False
    match statement:
        case ast.Comparison(operands=operands) if dial in operands:
            return not any(isinstance(o, ast.Member) and o.name.text in SIZES for o in operands)
    return any(isinstance(node, ast.Point) and dial in (node.x, node.y) for node in ast.walk(statement))


def _shortened(target: float, other: float, slack: float) -> float:
    """A short number at `target` or, by no more than `slack`, on the side of `other`."""
    slack = min(slack, abs(other - target))
    for digits in range(8):
        nearest = round(target, digits)
        if digits <= _MEANT and abs(nearest - target) <= _NEAR * max(1.0, abs(target)):
            return nearest
        step = 10.0**-digits
        beyond = round((math.floor if other < target else math.ceil)(target / step) * step, digits)
        if abs(beyond - target) <= slack:
            return beyond
    return target


def _unit(dial: ast.Expression) -> str | None:
    literal = dial.operand if isinstance(dial, ast.Unary) else dial
    return literal.unit if isinstance(literal, ast.Number) else None


def _factor(dial: ast.Expression) -> float:
    return UNITS[unit][0] if (unit := _unit(dial)) else 1.0


def _shown(dial: ast.Expression, value: float) -> str:
    """A value in mm or degrees as it would stand in place of the literal, to six digits."""
    return f"{short(value / _factor(dial))}{_unit(dial) or ''}"


def _text(dial: ast.Expression, value: float) -> str:
    """The same with all the digits that there are."""
    return f"{value / _factor(dial) + 0.0:.13g}{_unit(dial) or ''}"


# --- Edits -----------------------------------------------------------------------------------------


def rewritten(wording: Wording, found: Remedy) -> Fix | None:
    """Writes what would fit: in the statement itself, or in the declaration of a `param` read only there."""
    if found.is_literal:
        edits = tuple(Edit(n.span, text) for n, text in zip(found.written, found.exact, strict=True))
        return Fix(f"write {' and '.join(f'`{text}`' for text in found.exact)}", edits)
    name = found.written[0]
    assert isinstance(name, ast.Name)
    declared = wording.param(name)
    if declared is None or not isinstance(declared.value, ast.Number):
        return None
    value = float(found.exact[0])
    ends = [end.value * _factor(end) for end in _ends(declared.domain)]
    if declared.domain is not None and not (len(ends) == 2 and ends[0] <= value <= ends[1]):
        return None
    text = _text(declared.value, value)
    return Fix(f"make `{name.span.text}` {text}", (Edit(declared.value.span, text),))


def _ends(domain: ast.Expression | None) -> Iterator[ast.Number]:
    if isinstance(domain, ast.Range):
        yield from (end for end in (domain.start, domain.end) if isinstance(end, ast.Number))


def says(wording: Wording, fix: Fix) -> str:
    """The statement after the fix, in one line."""
    span = wording.node.span
    text = span.text
    for edit in sorted(fix.edits, key=lambda e: -e.span.start):
        text = text[: edit.span.start - span.start] + edit.replacement + text[edit.span.end - span.start :]
    return " ".join(text.split())


def left_out(constraint: Constraint) -> Fix | None:
    """Removes a statement that has a line for itself, or stands between semicolons."""
    span, text = constraint.span, constraint.span.source.text
    line = text.rfind("\n", 0, span.start) + 1
    end = text.find("\n", span.end) + 1 or len(text)
    before, after = text[line : span.start], text[span.end : end]
    if before.strip() in ("", "constrain") and not after.strip():
        where = Span(span.source, line, end)
    elif before.rstrip().endswith(";"):
        where = Span(span.source, line + len(before.rstrip()) - 1, span.end)
    elif after.lstrip().startswith(";") and not before.rstrip().endswith("constrain"):
        where = Span(span.source, span.start, span.end + after.index(";") + 1)
    else:
        return None
    return Fix("leave it out", (Edit(where, ""),))


def wished(constraint: Constraint) -> Fix:
    """Makes a statement a preference."""
    span = constraint.span
    before = span.source.text[: span.start].rstrip(" ")
    if before.endswith("constrain"):
        return Fix("make it a wish", (Edit(Span(span.source, len(before) - 9, len(before)), "prefer"),))
    return Fix("make it a wish", (Edit(replace(span, end=span.start), "prefer "),))
