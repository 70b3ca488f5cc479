"""The numbers of a program that have a share in constraints, and the program built again with edits:
whether constraints that failed hold, whether a fix resolves its finding.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from enum import Enum
from functools import cached_property

import numpy as np

from aidl_lang.building.lower import Lowered, Solved
from aidl_lang.building.model import is_size
from aidl_lang.checking.symbols import Symbol, SymbolKind
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, apply_fixes, has_errors
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.solver import Settings, solve
from aidl_lang.solver.conflicts import equations, nearby_solution, residual, shortfall
from aidl_lang.solver.expression import Floats
from aidl_lang.solver.newton import Clock
from aidl_lang.solver.problem import GroupFailure
from aidl_lang.syntax import ast

_MOST = 12  # the most exact numbers behind the names mentioned; nearer ones first
_FACTORING = ("*", "/", "%", "^")
_BY_DEFINITION = frozenset({SymbolKind.FUNCTION, SymbolKind.SHAPE, SymbolKind.CONSTRAINT, SymbolKind.ALIAS})
"""Kinds of symbols that belong to the vocabulary rather than to the drawing."""


class Sign(Enum):
    """The values possible for a number that is not negative as it is written."""

    ANY = "a coordinate"
    NOT_NEGATIVE = "a gap, a margin, or what is added"
    POSITIVE = "a size"


@record()
class Dial:
    """A number of the text.

    place      where it stands, with its sign
    value      in the `unit` in which it is written (empty: mm, degrees or none)
    name       of the `param` or `let` that it is the value of
    is_exact   nothing but the text changes it, and it stands in none of the constraints
    is_factor  it multiplies or divides
    sign       what it may be
    is_rough   a number of many digits in its place would not be what anyone means
    """

    place: Span
    value: float
    unit: str
    name: str = ""
    is_exact: bool = False
    is_factor: bool = False
    sign: Sign = Sign.NOT_NEGATIVE
    is_rough: bool = False

    def may_be(self, value: float) -> bool:
        """Tells whether its author can have meant a value: none whose sign reverses the meaning."""
        if self.value < 0.0 or self.sign is Sign.ANY:
            return True
        return value > 0.0 if self.sign is Sign.POSITIVE else value >= 0.0


def written_numbers(node: ast.Expression) -> list[Dial]:
    """Returns the numbers written in a statement, the last first: those that count among its arguments and
    its comparisons. Indices are left out: they say which thing is meant.
    """
    found: list[Dial] = []
    stack: list[ast.Node] = [node]
    while stack:
        match stack.pop():
            case ast.Number() | ast.Unary(operator="-", operand=ast.Number()) as literal:
                found.append(_dial(literal))
            case ast.Binary() as operation:
                sides = operation.right, operation.left
                found += _among(sides, Sign.NOT_NEGATIVE, stack, operation.operator)
            case ast.Index(value=inner):
                stack.append(inner)
            case ast.Comparison(operands=operands):
                sized = any(isinstance(o, ast.Member) and is_size(o.name.text) for o in operands)
                found += _among(operands, Sign.POSITIVE if sized else Sign.ANY, stack)
            case ast.Point(x=x, y=y):
                found += (replace(dial, is_rough=True) for dial in _among((x, y), Sign.ANY, stack))
            case other:
                stack.extend(ast.children(other))
    return sorted(found, key=lambda dial: -dial.place.start)


def _among(
    nodes: Iterable[ast.Node], sign: Sign, further: list[ast.Node], operator: str = ""
) -> Iterator[Dial]:
    """Yields the literals among the operands of an operator; appends the other operands to `further`."""
    for node in nodes:
        if _is_literal(node):
            yield replace(_dial(node), sign=sign, is_factor=operator in _FACTORING)
        else:
            further.append(node)


def exact_numbers(nodes: Iterable[ast.Node], uses: Mapping[ast.Node, Symbol]) -> list[Dial]:
    """Returns the exact numbers behind the names in some nodes: values of `param`s and `let`s, and of
    `fixed(…)`, in the definitions mentioned and in those that these mention in turn; zeros, which mostly say
    where to begin, come last.
    """
    found: dict[Span, Dial] = {}
    waiting, seen = list(nodes), set[ast.Node]()
    while waiting and len(found) < _MOST:
        here, waiting = waiting, []
        for node in here:
            for part in ast.walk(node):
                if isinstance(part, ast.Call) and fold(part.callee.text) == "fixed":
                    for argument in part.arguments:
                        for dial in written_numbers(argument.value):
                            found.setdefault(dial.place, _exact(dial))
                symbol = uses.get(part)
                if symbol is None or symbol.node is None or symbol.node in seen:
                    continue
                if symbol.kind in _BY_DEFINITION or symbol.node.span.source is not node.span.source:
                    continue
                seen.add(symbol.node)
                if isinstance(symbol.node, ast.Param | ast.Let) and _is_literal(symbol.node.value):
                    dial = _dial(symbol.node.value)
                    found.setdefault(dial.place, _exact(dial, symbol.name))
                else:
                    waiting.append(symbol.node)
    return sorted(found.values(), key=lambda dial: dial.value == 0.0)[:_MOST]


def _exact(dial: Dial, name: str = "") -> Dial:
    is_size = not name and not dial.is_rough and dial.unit != "deg"
    sign = Sign.POSITIVE if is_size and dial.sign is Sign.NOT_NEGATIVE else dial.sign
    return replace(dial, name=name, is_exact=True, is_rough=not name, sign=sign)


def _is_literal(node: ast.Node) -> bool:
    return isinstance(node, ast.Number) or (
        isinstance(node, ast.Unary) and node.operator == "-" and isinstance(node.operand, ast.Number)
    )


def _dial(literal: ast.Node) -> Dial:
    number = literal.operand if isinstance(literal, ast.Unary) else literal
    assert isinstance(number, ast.Number)
    value = -number.value if isinstance(literal, ast.Unary) else number.value
    return Dial(literal.span, value, number.unit or "")


# Each remedy is tried here, as it is printed, before a message offers it.

SECONDS, LONGEST = 1.5, 3.0
"""Time after which no new search is begun for one failure, and time after which nothing is tried at all for a
single one: some programs take long to build.
"""
MOST = 5
"""The most failures that prolong the latter, each by the former."""
GAVE_WAY = frozenset({"N0601", "W0601", "W0602"})
"""Codes of diagnostics that report what gave way."""
_TOLD = GAVE_WAY | {"N0604"}  # these codes, and that of a program solved from elsewhere
_LONGEST = 0.5  # seconds for one solve
_FLAT = 3e-3
"""Singular values of unit rows that count as none: a search stops near the place where all lies flat."""
_TURNS = 1e-3  # change of the slope of a unit row that is none by rounding
_MOVED = 1e-6  # moves below this, in mm or degrees, count as none


@record(frozen=False)
class Trials:
    """
    source   the program as it is
    build    returns the problem of another text; None if that has errors
    compile  returns the diagnostics of another text
    solution the solution of the program as it is
    """

    source: SourceFile
    build: Callable[[SourceFile], Lowered | None]
    compile: Callable[[SourceFile], Sequence[Diagnostic]]
    solution: Solved
    settings: Settings
    cut_short: set[tuple[int, ...]] = field(default_factory=set)
    """The conflicts for which numbers were left untried, for want of time."""
    _begun: dict[tuple[int, ...], float] = field(default_factory=dict, repr=False)
    """The time that was left when the first search for a failure began."""
    _built: dict[str, Lowered | None] = field(default_factory=dict, repr=False)
    _said: dict[str, Sequence[Diagnostic]] = field(default_factory=dict, repr=False)
    _lacks: dict[tuple[int, tuple[int, ...]], float] = field(default_factory=dict, repr=False)
    """Violations by the problem, which `_built` keeps, and the constraints of the failure."""
    _mended: dict[tuple[int, tuple[int, ...]], bool] = field(default_factory=dict, repr=False)
    _places: dict[tuple[tuple[int, ...], int], dict[int, float] | None] = field(
        default_factory=dict, repr=False
    )
    """Values at which the constraints of a failure hold without one of them (in several failures, too)."""

    @cached_property
    def _clock(self) -> Clock:
        """The time of all trials; it runs from the first one."""
        return Clock(LONGEST + SECONDS * (min(len(self.solution.failures), MOST) - 1))

    def is_late(self, failure: GroupFailure) -> bool:
        """Tells whether no new search should be begun for a failure."""
        left = self._clock.left
        return self.is_over or self._begun.setdefault(failure.conflict, left) - left > SECONDS

    @property
    def is_over(self) -> bool:
        """True if the time is spent: nothing more is tried or offered."""
        return self._clock.expired

    def can_edit(self, edits: Iterable[Edit]) -> bool:
        """Tells whether edits are of the program itself, and not of a file that it imports."""
        return all(edit.span.source is self.source for edit in edits)

    def lack(self, edits: Sequence[Edit], failure: GroupFailure) -> float | None:
        """Returns the violation of the constraints of a failure with no kept size changed, after the edits
        (see `solver.refuting`); None if the program then has errors or is another one.
        """
        if (found := self._counterpart(edits, failure)) is None:
            return None
        other, matched, numbered = found
        if (known := self._lacks.get((id(other), failure.conflict))) is not None:
            return known
        start = {numbered[u]: value for u, value in self._free(failure).items()}
        members = [matched[index] for index in failure.conflict]
        within = [matched[index] for index in self._together(failure)]
        off = shortfall(other, self._quick, members, within, start)
        self._lacks[id(other), failure.conflict] = off
        return off

    def _together(self, failure: GroupFailure) -> list[int]:
        """Returns the constraints that took part in the search, without those of other failures."""
        others = self._others(failure)
        hard = np.isnan(self.solution.problem.weight)
        return [i for i in failure.within if hard[i] and i not in others]

    def _others(self, failure: GroupFailure) -> set[int]:
        others = {i for f in self.solution.failures if f is not failure for i in f.conflict}
        return others.difference(failure.conflict)

    def residual(self, edits: Sequence[Edit], failure: GroupFailure, member: int) -> float | None:
        """Returns the signed residual of a member after edits where the others hold; None if nowhere."""
        if (place := self._without(failure, member)) is None:
            return None
        if (found := self._counterpart(edits, failure)) is None:
            return None
        other, matched, numbered = found
        there = {numbered[u]: value for u, value in place.items()}
        return residual(other, self._quick, matched[member], there)

    def lies_flat(self, edits: Sequence[Edit], further: Sequence[Edit], failure: GroupFailure) -> bool:
        """Tells whether the constraints of a failure hold after edits only where several that turn with the
        place depend on each other, as the sides of a triangle without height; after others that go `further`
        they do not.
        """
        slopes: list[list[Floats]] = []
        for each in (edits, further):
            if (found := self._counterpart(each, failure)) is None:
                return False
            other, matched, numbered = found
            members = [matched[index] for index in failure.conflict]
            start = {numbered[u]: value for u, value in self._free(failure).items()}
            if (place := nearby_solution(other, self._quick, members, start)) is None:
                return False
            slopes.append(equations(other, self._quick, members, place))
        turned = zip(failure.conflict, *slopes, strict=True)
        turning = self.solution.problem.stated_at(
            index for index, a, b in turned if np.abs(a - b).max(initial=0.0) > _TURNS
        )
        flat, free = (np.linalg.matrix_rank(np.vstack(each), _FLAT) for each in slopes)
        return bool(flat < free) and sum(not stated.is_inherent for stated in turning) > 1

    def _without(self, failure: GroupFailure, member: int) -> dict[int, float] | None:
        key = failure.conflict, member
        if key not in self._places:
            rest = [index for index in self._together(failure) if index != member]
            self._places[key] = nearby_solution(self.solution.problem, self._quick, rest, self._free(failure))
        return self._places[key]

    def _free(self, failure: GroupFailure) -> dict[int, float]:
        """Returns the unknowns that may move if nothing gives way, with their values at the nearest place."""
        unknowns = self.solution.problem.unknowns
        return {
            u: value
            for u, value in failure.nearest
            if not unknowns[u].kept or unknowns[u].implied or u in failure.sizes
        }

    def _counterpart(
        self, edits: Sequence[Edit], failure: GroupFailure
    ) -> tuple[Lowered, dict[int, int], dict[int, int]] | None:
        """Returns the edited problem, its constraints and unknowns by number; None for another kind."""
        if self.is_over or (other := self._with(edits)) is None:
            return None
        if (matched := _matched(self.solution.problem, other)) is None:
            return None
        names, keys = {key: u for u, key in enumerate(_keys(other))}, _keys(self.solution.problem)
        numbered = {u: names[keys[u]] for u, _ in failure.nearest if keys[u] in names}
        return (other, matched, numbered) if len(numbered) == len(failure.nearest) else None

    def mends(self, edits: Sequence[Edit], failure: GroupFailure) -> bool:
        """Tells whether all constraints hold after the edits, but for those of other failures, and nothing
        gives way but what did before and the sizes that the constraints are about.
        """
        if self.is_over or (other := self._with(edits)) is None:
            return False
        key = id(other), failure.conflict
        if key not in self._mended:
            self._mended[key] = self._is_mended(failure, other)
        return self._mended[key]

    def _is_mended(self, failure: GroupFailure, other: Lowered) -> bool:
        own, problem = self.solution.problem, other
        if others := self._others(failure):
            # What is stated at one place for several things is judged for all of them.
            places = [None if c is None else c.span for c in own.stated]
            judged = {None, *(places[i] for i in failure.conflict)}
            matched = _matched(own, other) or _by_text(own, other)
            apart = {matched[i] for i in others if i in matched and places[i] not in judged}
            left = [c for i, c in enumerate(problem.constraints) if i not in apart]
            problem = problem.with_constraints(left)
        found = solve(problem, self._quick)
        if not np.all(np.asarray(found.satisfied)[np.isnan(problem.weight)]):
            return False
        asked = {own.names[u] for u in failure.sizes}
        return _gave_way(found) <= _gave_way(self.solution) | asked

    def holds(self, edits: Sequence[Edit], failure: GroupFailure) -> bool:
        """Tells whether the constraints of a failure hold after the edits, whatever gives way for it."""
        if self.is_over or (other := self._with(edits)) is None:
            return False
        matched = _matched(self.solution.problem, other) or {}
        found = solve(other, self._quick).satisfied if matched else ()
        return bool(found) and all(found[matched[i]] for i in failure.conflict)

    def finishes(self, edits: Sequence[Edit]) -> bool:
        """Tells whether edits that resolve a failure leave no errors, such as another failure."""
        return not has_errors(self.diagnostics(edits))

    def idles(self, edits: Sequence[Edit]) -> bool:
        """Tells whether a statement that edits change says nothing new then, which would be told next."""
        idle = [d.span for d in self.diagnostics(edits) if d.code == "N0602" and d.span is not None]
        return any(span.start <= edit.span.start < span.end for span in idle for edit in edits)

    def settles(self, edits: Sequence[Edit]) -> bool:
        """Tells whether the program after the edits solves from its first guesses, and nothing gives way."""
        if self.is_over or not self.can_edit(edits):
            return False
        found = self.diagnostics(edits)
        return not has_errors(found) and not any(d.code in _TOLD for d in found)

    def diagnostics(self, edits: Sequence[Edit]) -> Sequence[Diagnostic]:
        """Returns the diagnostics of the program after edits."""
        changed = self.edited(edits)
        if changed.text not in self._said:
            self._said[changed.text] = self.compile(changed)
        return self._said[changed.text]

    @property
    def _quick(self) -> Settings:
        return replace(self.settings, explain=False, seconds=min(self.settings.seconds, _LONGEST))

    def edited(self, edits: Sequence[Edit]) -> SourceFile:
        """Returns the program after edits."""
        text, _ = apply_fixes(self.source, [Diagnostic("E0601", "", fix=Fix("", tuple(edits)))])
        return SourceFile(self.source.name, text)

    def _with(self, edits: Sequence[Edit]) -> Lowered | None:
        if not self.can_edit(edits):
            return None
        changed = self.edited(edits)
        if changed.text not in self._built:
            self._built[changed.text] = self.build(changed)
        return self._built[changed.text]


def _matched(one: Lowered, other: Lowered) -> dict[int, int] | None:
    """Returns another problem's constraints by numbers in this one; None if their order differs."""
    pairs = list(zip(_in_order(one), _in_order(other), strict=False))
    if len(one.stated) != len(other.stated) or any(_label(one, a) != _label(other, b) for a, b in pairs):
        return None
    return dict(pairs)


def _by_text(one: Lowered, other: Lowered) -> dict[int, int]:
    """Returns the numbers of the constraints in another problem by those that read the same."""
    found = {(c.text, c.label, c.holder.path): i for i, c in enumerate(other.stated) if c is not None}
    keys = ((i, (c.text, c.label, c.holder.path)) for i, c in enumerate(one.stated) if c is not None)
    return {i: found[key] for i, key in keys if key in found}


def _in_order(lowered: Lowered) -> list[int]:
    """Returns the constraints in the order of the text; those that nobody stated come last."""

    def place(index: int) -> tuple[bool, str, int, str, int]:
        if (stated := lowered.stated[index]) is None:
            return True, "", 0, "", index
        return False, stated.span.source.name, stated.span.start, stated.label, index

    return sorted(range(len(lowered.stated)), key=place)


def _label(lowered: Lowered, index: int) -> str | None:
    stated = lowered.stated[index]
    return None if stated is None else stated.label


def _keys(lowered: Lowered) -> list[tuple[str, int]]:
    """Returns a key that each unknown keeps: its path, and how many before it have that path."""
    met: Counter[str] = Counter()
    found = []
    for path in lowered.names:
        found.append((path, met[path]))
        met[path] += 1
    return found


def _gave_way(solution: Solved) -> set[str]:
    lowered = solution.problem
    moved = np.abs(solution.values - lowered.initial) > _MOVED
    gave = {u for stage in solution.stages if stage.concession is not None for u in stage.concession.unknowns}
    return {lowered.names[u] for u in gave if moved[u] and not lowered.unknowns[u].implied}


# --- Verifies the fixes of findings made after solving: one that does not resolve its finding is not
# offered.

_TRIED = frozenset({"E0601", "E0602", "E0603", "E0605", "N0602", "N0604"})
"""Codes of findings whose fixes were tried already."""
_SAID = frozenset({"W0705"})
"""Codes of findings whose fixes are a word that says that they are meant, which changes no drawing."""


def verified(
    found: Sequence[Diagnostic], everything: Sequence[Diagnostic], trials: Trials
) -> list[Diagnostic]:
    """Returns findings without the fixes that do not mend them, and without the hints that repeat these.
    `everything` are all findings about the program.
    """
    return [_verified(d, everything, trials) for d in found]


def mends(found: Diagnostic, fix: Fix, before: Sequence[Diagnostic], trials: Trials) -> bool:
    """Tells whether a program with the findings `before` lacks `found` after a fix, with nothing worse."""
    if trials.is_over or not trials.can_edit(fix.edits) or found.code in _SAID:
        return found.code in _SAID and trials.can_edit(fix.edits)
    after = trials.diagnostics(fix.edits)
    return not _bad(after) - _bad(before) and not any(_is_same(d, found, fix.edits) for d in after)


def _verified(d: Diagnostic, before: Sequence[Diagnostic], trials: Trials) -> Diagnostic:
    if d.fix is None or d.code in _TRIED or mends(d, d.fix, before, trials):
        return d
    written = "\n".join(edit.replacement for edit in d.fix.edits)
    hints = tuple(h for h in d.hints if not any(q in written for q in re.findall(r"`([^`]+)`", h)))
    return replace(d, fix=None, hints=hints)


def _bad(found: Sequence[Diagnostic]) -> Counter[str]:
    return Counter(d.code for d in found if d.is_error or d.code in GAVE_WAY)


def _is_same(one: Diagnostic, before: Diagnostic, edits: Sequence[Edit]) -> bool:
    """Tells whether a finding in the program after some edits is one that was in it before."""
    if one.code != before.code or one.span is None or before.span is None:
        return one.code == before.code and one.message == before.message
    span = before.span
    shift = sum(len(e.replacement) - (e.span.end - e.span.start) for e in edits if e.span.end <= span.start)
    if one.span.start != span.start + shift:
        return False
    is_rewritten = any(e.span.start <= span.start and span.end <= e.span.end for e in edits)
    return one.message == before.message or not is_rewritten
