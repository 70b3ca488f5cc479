"""Problems as JSON: `read` and `load` make a problem of the form, `dump` puts any problem into it.

The form is described in tests/solver/problems/README.md. Whatever is wrong with a file is a `FormError`.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import reduce
from typing import NoReturn, TypeVar

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.solver.expression import Tape, TapeBuilder
from aidl_lang.solver.operations import Op
from aidl_lang.solver.problem import Constraint, Problem, Relation, Row, Status, constraint_arrays
from tests.solver.problems.members import (
    Members,
    as_count,
    as_flag,
    as_list,
    as_not_negative,
    as_number,
    as_object,
    as_positive,
    as_text,
    list_of,
    one_of,
)
from tests.solver.problems.notation import NAME, RESERVED, FormError, Notation, quoted, within
from tests.solver.problems.writing import ROOT, dump

__all__ = ["Case", "Expected", "FormError", "dump", "load", "read"]

T = TypeVar("T")

LONGEST_FILE = 50_000_000
"""The most characters of a file."""
LEVELS = 100
"""The most levels of groups within groups."""

MEMBERS = ("about", "groups", "unknowns", "let", "constraints", "observed", "expected", "named")
UNKNOWN = ("guess", "scale", "kept", "group", "frame", "longest", "standing", "spanned", "thing")
CONSTRAINT = ("is", "let", "tag", "group", "placed", "weight", "scale", "whole", "inside")
OBSERVABLE = ("is", "let", "group")


@record()
class Expected:
    """Expectations of a file about the solution; None for what it does not mention.

    values     unknowns by name, each within `tolerance`
    conflicts  the tags of each conflict
    changed    the kept sizes that change
    redundant  tags
    """

    status: Status | None = None
    values: Mapping[str, float] | None = None
    tolerance: float = 1e-6
    degrees: int | None = None
    conflicts: tuple[frozenset[str], ...] | None = None
    changed: frozenset[str] | None = None
    redundant: frozenset[str] | None = None


@record()
class Case:
    """A problem with the names and expectations of its file.

    groups  the name of each group
    tags    the tag of each constraint; `#` and its index where the file gives none
    """

    problem: Problem
    about: str
    groups: tuple[str, ...]
    tags: tuple[str, ...]
    expected: Expected


def read(text: str) -> Case:
    """Returns the problem in a JSON text. Raises `FormError`."""
    if len(text) > LONGEST_FILE:
        raise FormError(f"more than {LONGEST_FILE} characters")
    try:
        form = json.loads(text, parse_int=float, parse_constant=_no_number, object_pairs_hook=_distinct)
    except json.JSONDecodeError as mistake:
        place = f"line {mistake.lineno}, column {mistake.colno}"
        raise FormError(f"{place}: this is not JSON: {mistake.msg.lower()}") from None
    except RecursionError:
        raise FormError("nested too deeply") from None
    return load(form)


def load(form: object) -> Case:
    """Returns the problem in a JSON document that was parsed already. Raises `FormError`."""
    return _Loading().case(form)


def _no_number(word: str) -> NoReturn:
    raise FormError(f"{word} is not a number")


def _distinct(pairs: list[tuple[str, object]]) -> dict[str, object]:
    members: dict[str, object] = {}
    for name, value in pairs:
        if name in members:
            raise FormError(f"{quoted(name)} is there twice")
        members[name] = value
    return members


@record()
class _Unknown:
    """One unknown; the fields are those of `Problem`."""

    guess: float
    scale: float
    kept: bool
    group: int
    frame_of: int
    longest: float
    standing: bool
    spanned: bool
    thing: int


class _Loading:
    def __init__(self) -> None:
        self.tape = TapeBuilder()
        self.notation = Notation(self.tape)
        self.groups = {ROOT: 0}
        self.parent, self.depth = [-1], [0]
        self.unknowns: list[_Unknown] = []
        self.tags: dict[str, int] = {}
        self.named = False

    def case(self, form: object) -> Case:
        members = Members(form, *MEMBERS)
        for name, above in members.table("groups").items():
            with within(f"group {quoted(name)}"):
                self._add_group(name, above)
        for name, entry in members.table("unknowns").items():
            with within(f"unknown {quoted(name)}"):
                self._add_unknown(name, entry)
        self._read_lets(members)
        self.named = members.read("named", as_flag, False)
        listed: list[object] = members.read("constraints", as_list, [])
        constraints = [self._constraint(index, entry) for index, entry in enumerate(listed)]
        problem = self._problem(constraints, self._observables(members))
        self._check_reach(problem.tape, constraints)
        return Case(
            problem=problem,
            about=members.read("about", as_text, ""),
            groups=tuple(self.groups),
            tags=tuple(self.tags),
            expected=members.read("expected", self._expected, Expected()),
        )

    def _problem(self, constraints: list[Constraint], observables: tuple[tuple[int, int], ...]) -> Problem:
        unknowns = self.unknowns
        longest = np.array([u.longest for u in unknowns], dtype=np.float64)
        return Problem(
            tape=self.tape.finish(),
            initial=np.array([u.guess for u in unknowns], dtype=np.float64),
            scale=np.array([u.scale for u in unknowns], dtype=np.float64),
            kept=np.array([u.kept for u in unknowns], dtype=np.bool_),
            group=np.array([u.group for u in unknowns], dtype=np.int64),
            frame_of=np.array([u.frame_of for u in unknowns], dtype=np.int64),
            parent=np.array(self.parent, dtype=np.int64),
            **constraint_arrays(constraints),
            named=self.named,
            longest=longest if np.isfinite(longest).any() else None,
            standing=np.array([u.standing for u in unknowns], dtype=np.bool_),
            spanned=np.array([u.spanned for u in unknowns], dtype=np.bool_),
            thing=np.array([u.thing for u in unknowns], dtype=np.int64),
            observables=observables,
            names=tuple(self.notation.unknowns),
        )

    # -- groups, unknowns, names for expressions

    def _add_group(self, name: str, above: object) -> None:
        if name in self.groups:
            raise FormError("the outermost group has this name already")
        parent = self.groups[one_of("group before it", self.groups)(above)]
        if self.depth[parent] == LEVELS:
            raise FormError(f"more than {LEVELS} levels deep")
        self.depth.append(self.depth[parent] + 1)
        self.parent.append(parent)
        self.groups[name] = len(self.groups)

    def _add_unknown(self, name: str, entry: object) -> None:
        self._check_new(name)
        members = Members(_or_member("guess", entry), *UNKNOWN)
        group, frame_of = self._group(members), -1
        if "frame" in members:
            frame_of = self.groups[members.need("frame", one_of("group", self.groups))]
            if frame_of == 0 or "group" in members:
                raise FormError("frame: only of a group within another, which owns it without being named")
            group = self.parent[frame_of]
        self.notation.unknowns[name] = len(self.unknowns)
        self.unknowns.append(
            _Unknown(
                guess=members.need("guess", as_number),
                scale=members.read("scale", as_positive, 1.0),
                kept=members.read("kept", as_flag, False),
                group=group,
                frame_of=frame_of,
                longest=members.read("longest", as_positive, np.inf),
                standing=members.read("standing", as_flag, False),
                spanned=members.read("spanned", as_flag, False),
                thing=members.read("thing", as_count, 0),
            )
        )

    def _read_lets(self, members: Members) -> None:
        for name, text in members.table("let").items():
            with within(f"let {quoted(name)}"):
                self._check_new(name)
                self.notation.lets[name] = self.notation.value(as_text(text))

    def _check_new(self, name: str) -> None:
        if NAME.fullmatch(name) is None:
            raise FormError("not a name: letters, digits and '_', with parts like '.x' and '[0]'")
        if name in RESERVED:
            raise FormError("the name of a function or a constant")
        if name in self.notation.unknowns or name in self.notation.lets:
            raise FormError("something else has this name")

    def _group(self, members: Members) -> int:
        return self.groups[members.read("group", one_of("group", self.groups), ROOT)]

    def _numbers_of(self, value: object) -> frozenset[int]:
        """Returns the unknowns in a list of names."""
        names = list_of(one_of("unknown", self.notation.unknowns))(value)
        return frozenset(self.notation.unknowns[name] for name in names)

    def _groups_of(self, value: object) -> frozenset[int]:
        """Returns the groups in a list of names."""
        return frozenset(self.groups[name] for name in list_of(one_of("group", self.groups))(value))

    # -- constraints and observables

    def _constraint(self, index: int, entry: object) -> Constraint:
        with within(f"constraints[{index}]"):
            members = Members(_or_member("is", entry), *CONSTRAINT)
            tag = members.read("tag", as_text, f"#{index}")
            if self.tags.setdefault(tag, index) != index:
                raise FormError(f"tag: constraints[{self.tags[tag]}] has {quoted(tag)} already")
        with within(f"constraints[{index}]" + (f" {quoted(tag)}" if "tag" in members else "")):
            self._read_lets(members)
            rows = members.need("is", _one_or_more(self._row))
            scales = members.read("scale", _one_or_more(as_positive), [1.0])
            if len(scales) not in (1, len(rows)):
                raise FormError(f"scale: 1 or {len(rows)} numbers are needed, not {len(scales)}")
            if len(scales) < len(rows):
                scales = scales * len(rows)
            return Constraint(
                group=self._group(members),
                rows=tuple(Row(*row, scale) for row, scale in zip(rows, scales, strict=False)),
                placed=members.read("placed", self._numbers_of, frozenset()),
                weight=members.read("weight", as_not_negative, None),
                whole=members.read("whole", self._groups_of, frozenset()),
                inside=members.read("inside", self._groups_of, frozenset()),
            )

    def _row(self, value: object) -> tuple[int, Relation]:
        return self.notation.row(as_text(value))

    def _observables(self, members: Members) -> tuple[tuple[int, int], ...]:
        """Returns the observables that are given; else all unknowns but those of frames."""
        if "observed" in members:
            return tuple(members.need("observed", list_of(self._observable)))
        drawn = [(u.group, i) for i, u in enumerate(self.unknowns) if u.frame_of < 0]
        return tuple((group, self.tape.unknown(i)) for group, i in drawn)

    def _observable(self, entry: object) -> tuple[int, int]:
        members = Members(_or_member("is", entry), *OBSERVABLE)
        self._read_lets(members)
        return self._group(members), self.notation.value(members.need("is", as_text))

    def _check_reach(self, tape: Tape, constraints: list[Constraint]) -> None:
        """Refuses a constraint that mentions unknowns outside the subtree of its group."""
        homes = self._homes(tape)
        names = list(self.groups)
        for index, constraint in enumerate(constraints):
            for row in constraint.rows:
                home = homes[row.expression]
                if home >= 0 and self._common(home, constraint.group) != constraint.group:
                    held, needed = quoted(names[constraint.group]), quoted(names[home])
                    raise FormError(
                        f"constraints[{index}]: group {held} holds it, but what it mentions lies in {needed}"
                    )

    def _homes(self, tape: Tape) -> list[int]:
        """Returns the innermost group that holds all unknowns below each node, -1 for constants."""
        homes: list[int] = []
        for op, operands in zip(tape.op_list, tape.operand_lists, strict=True):
            if op == Op.UNKNOWN:
                homes.append(self.unknowns[operands[0]].group)
            else:
                homes.append(reduce(self._common, [homes[o] for o in operands if homes[o] >= 0], -1))
        return homes

    def _common(self, a: int, b: int) -> int:
        """Returns the innermost group that holds both; parents have lower numbers than their children."""
        if a < 0:
            return b
        while a != b:
            a, b = min(a, b), self.parent[max(a, b)]
        return a

    # -- expectations

    def _expected(self, value: object) -> Expected:
        members = Members(value, *(field.name for field in fields(Expected)))
        names = list_of(one_of("unknown", self.notation.unknowns))
        tags = list_of(one_of("constraint", self.tags))
        return Expected(
            status=members.read("status", lambda v: Status(one_of("status", list(Status))(v)), None),
            values=members.read("values", self._values, None),
            tolerance=members.read("tolerance", as_positive, Expected.tolerance),
            degrees=members.read("degrees", as_count, None),
            conflicts=members.read("conflicts", lambda v: tuple(map(frozenset, list_of(tags)(v))), None),
            changed=members.read("changed", lambda v: frozenset(names(v)), None),
            redundant=members.read("redundant", lambda v: frozenset(tags(v)), None),
        )

    def _values(self, value: object) -> dict[str, float]:
        unknown = one_of("unknown", self.notation.unknowns)
        values = {}
        for name, number in as_object(value).items():
            with within(quoted(name)):
                values[unknown(name)] = as_number(number)
        return values


def _or_member(name: str, entry: object) -> object:
    """Returns an object, or wraps any other entry as the one member that matters."""
    return entry if isinstance(entry, dict) else {name: entry}


def _one_or_more(convert: Callable[[object], T]) -> Callable[[object], list[T]]:
    """Converts a list of things, or one by itself."""
    return lambda value: list_of(convert)(value) if isinstance(value, list) else [convert(value)]
