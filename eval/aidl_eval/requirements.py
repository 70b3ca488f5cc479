"""Prompts and what a drawing of the thing must have, as asserts of the language itself.

A prompt is an AIDL program: its root's comment is what the model is asked, its empty structures are roles
with the words they go by (`@note`), its asserts are the requirements. To examine a program, its solved parts
lend their boxes and regions to the roles that they answer, and the asserts are evaluated there by the
language's own checker and evaluator. The two programs share no scope, so their names do not meet. See
`eval/prompts.md`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from pathlib import Path

from aidl_eval.regions import Regions, of_drawing
from aidl_eval.roles import Role, bind
from aidl_eval.things import Thing, origins
from aidl_eval.whole import MEASURES
from aidl_lang import SourceFile, parser
from aidl_lang.building.expression import Evaluator, Unknown
from aidl_lang.building.model import Assertion, Condition, Measurement, Model, Structure
from aidl_lang.building.values import TextVal
from aidl_lang.common.prose import first_few
from aidl_lang.explaining.outcome import assertion_note, measured
from aidl_lang.geometry.boolean import united
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import Box, SolvedModel
from aidl_lang.interp import interpret
from aidl_lang.pipeline import Compiled, front
from aidl_lang.syntax import ast

WHOLE = "whole"
"""The role of the whole drawing."""

_COUNT = "_count"
"""Suffix of the param of a role of many: `NAME_count` is their number; its range gives the least and the
most.
"""


class Status(StrEnum):
    MET = "met"
    FAILED = "failed"
    UNMEASURABLE = "unmeasurable"  # counts as failed


@dataclass(frozen=True)
class Requirement:
    """`text` describes it, `condition` is checked; `roles` are those in it."""

    text: str
    condition: str
    roles: tuple[str, ...]
    start: int
    """offset of the condition in the prompt"""

    @property
    def is_geometric(self) -> bool:
        """True if it names no role, so that it can be asked of a drawing in any language."""
        return not self.roles


@dataclass(frozen=True)
class Prompt:
    """`text` is the request to the model."""

    name: str
    text: str
    requirements: tuple[Requirement, ...]
    roles: tuple[Role, ...]
    ranges: Mapping[str, tuple[int, int]]
    """The allowed numbers of things, for the roles of many."""
    source: SourceFile


@dataclass(frozen=True)
class Result:
    text: str
    status: Status
    detail: str = ""
    is_geometric: bool = False
    """It is asked of the drawing as a whole, in any language."""


class PromptError(Exception):
    """Raised if a file in a folder of prompts is not a prompt."""


def load(folder: Path | None = None) -> tuple[Prompt, ...]:
    """Returns the prompts of a folder in the order of their file names; those of the project without one.

    Raises PromptError for a file that is no prompt, OSError for a folder that cannot be read.
    """
    folder = folder or Path(__file__).with_name("prompts")
    files = sorted(path for path in folder.iterdir() if path.suffix == ".aidl")
    return tuple(read(SourceFile(path.name, path.read_text(encoding="utf-8"))) for path in files)


def read(source: SourceFile) -> Prompt:
    """Reads a prompt from its program. Raises PromptError."""
    built, module = _built(source, {})
    if not built.root.doc:
        raise PromptError(f"{source.name}: the comment before the root is to say what is asked for")
    ranges = {
        knob.path.removesuffix(_COUNT): (int(knob.low), int(knob.high))
        for knob in built.knobs
        if knob.path.endswith(_COUNT) and knob.low is not None and knob.high is not None
    }
    names = {child.name.partition("[")[0]: child for child in reversed(built.root.children)}
    if strays := sorted(ranges.keys() - names.keys()):
        raise PromptError(f"{source.name}: `{strays[0]}{_COUNT}` counts no role, or is 0 as written")
    roles = tuple(
        _role(child, name, source, many=name in ranges)
        for name, child in reversed(names.items())
        if name != WHOLE
    )
    known = frozenset(role.name for role in roles)
    requirements = tuple(_requirements(module.statements, known, (), source))
    name = Path(source.name).stem.lstrip("0123456789").lstrip("-_")
    return Prompt(name, built.root.doc, requirements, roles, ranges, source)


def _built(source: SourceFile, counts: Mapping[str, float]) -> tuple[Model, ast.Module]:
    """Returns the model of a prompt with so many of each role, and its statements."""
    program, found = front(source)
    if not any(d.is_error for d in found):
        built = interpret(program, counts)
        found = [*found, *built.diagnostics]
    if errors := [d for d in found if d.is_error]:
        place = f":{errors[0].span.line}" if errors[0].span else ""
        raise PromptError(f"{source.name}{place}: {errors[0].message}")
    return built.model, parser.parse(source).module


def _role(role: Structure, name: str, source: SourceFile, *, many: bool) -> Role:
    match role.attributes.get("note"):
        case (TextVal(words),):
            try:
                return Role.read(name, words, many=many)
            except ValueError as reason:
                raise PromptError(f"{source.name}: in the `@note` of `{name}`, {reason}") from None
        case _:
            raise PromptError(f"{source.name}: `{role.name}` has no `@note` of the words it goes by")


def _requirements(
    statements: Sequence[ast.Node], known: frozenset[str], loops: tuple[ast.Node, ...], source: SourceFile
) -> Iterator[Requirement]:
    for node in statements:
        match node:
            case ast.Structure():
                yield from _requirements(node.body.statements, known, loops, source)
            case ast.For():
                yield from _requirements(node.body.statements, known, (*loops, node.iterable), source)
            case ast.Assert(test=test, message=ast.String(value=text)):
                names = [n.text for of in (*loops, test) for n in ast.walk(of) if isinstance(n, ast.Name)]
                roles = tuple(dict.fromkeys(name for name in names if name in known))
                yield Requirement(text, test.span.one_line, roles, test.span.start)
            case ast.Assert():
                raise PromptError(f"{source.name}:{node.span.line}: the assert does not say what it asks for")


# --- Examining -----------------------------------------------------------------------------------


def examine(prompt: Prompt, source: SourceFile, compiled: Compiled) -> tuple[Result, ...]:
    """Examines a program's drawing, and returns one result for each requirement."""
    model, drawing = compiled.model, compiled.drawing
    if model is None or drawing is None:
        return _all(prompt, "the program is wrong, so nothing is drawn")
    if compiled.status != "solved":
        return _all(prompt, "the constraints were not solved, so nothing is in its place")
    examination = _Examination(prompt, model, drawing, parser.parse(source).module)
    return tuple(map(examination.result, prompt.requirements))


def _all(prompt: Prompt, why: str) -> tuple[Result, ...]:
    return tuple(Result(r.text, Status.UNMEASURABLE, why, r.is_geometric) for r in prompt.requirements)


class _MissingError(Exception):
    """Raised if a part lacks something that a requirement measures; the message tells what."""


def examine_regions(prompt: Prompt, drawn: Regions) -> tuple[Result, ...]:
    """Examines what a program of any language draws, and returns one result for each requirement that is
    asked of the whole drawing.
    """
    asked, _ = _built(prompt.source, {})
    whole = next((child for child in asked.root.children if child.name == WHOLE), None)
    values = dict(_measured_values(asked, drawn))
    if whole is not None:
        values |= dict(_box_values(whole, Box(*drawn.whole.box) if drawn.whole else None))
    evaluate = Evaluator(values, lambda payload: math.nan)
    judge = _Judge(evaluate, _by_start(asked))
    return tuple(judge.result(r) for r in prompt.requirements if r.is_geometric)


def _by_start(asked: Model) -> dict[int, list[Assertion]]:
    found: dict[int, list[Assertion]] = {}
    for assertion in asked.assertions:
        found.setdefault(assertion.span.start, []).append(assertion)
    return found


def _measured_values(asked: Model, drawn: Regions) -> Iterator[tuple[Unknown, float]]:
    for unknown in asked.unknowns:
        if unknown.holder is asked.root and unknown.field in MEASURES:
            yield unknown, MEASURES[unknown.field](drawn)


def _box_values(placeholder: Structure, box: Box | None) -> Iterator[tuple[Unknown, float]]:
    """Yields the sides of a role's box; NaN without one."""
    assert placeholder.plan is not None
    box = box or Box(*(math.nan,) * 4)
    for side, value in zip(placeholder.plan, (box.left, box.bottom, box.width, box.height), strict=True):
        assert isinstance(side.payload, Unknown)
        yield side.payload, value


@dataclass(frozen=True)
class _Judge:
    """Says what holds, given the values of a prompt's unknowns."""

    evaluate: Evaluator
    assertions: Mapping[int, Sequence[Assertion]]

    def result(self, requirement: Requirement, told: str = "") -> Result:
        """Returns the result of a requirement; `told` is what a failure is told with."""
        known = requirement.is_geometric
        try:
            failures = [self._failure(a) for a in self.assertions.get(requirement.start, ())]
        except _MissingError as missing:
            return Result(requirement.text, Status.UNMEASURABLE, str(missing), known)
        if failed := next(filter(None, failures), None):
            return Result(requirement.text, Status.FAILED, failed + told, known)
        return Result(requirement.text, Status.MET, "", known)

    def _failure(self, assertion: Assertion) -> str | None:
        comparisons = assertion.condition.comparisons() if isinstance(assertion.condition, Condition) else ()
        for comparison in comparisons:
            if not all(math.isfinite(self.evaluate(side)) for side in (comparison.left, comparison.right)):
                raise _MissingError(f"nothing is drawn of which `{assertion.text}` could be asked")
        note = assertion_note(assertion, self.evaluate)
        if note is not None and assertion.condition is False:
            return f"`{assertion.text}` is false"
        return None if note is None else note.label


class _Examination:
    def __init__(self, prompt: Prompt, model: SolvedModel, drawing: Drawing, program: ast.Module) -> None:
        self.prompt, self.model, self.drawing = prompt, model, drawing
        self.drawn = of_drawing(model, drawing)
        self.bound = bind(prompt.roles, model, drawing, origins(program))
        counts = {
            f"{name}{_COUNT}": float(count if low <= (count := len(self.bound[name])) <= high else low)
            for name, (low, high) in prompt.ranges.items()
        }
        asked, _ = _built(prompt.source, counts)
        self.things = {s: thing for s in asked.root.children if (thing := self._thing(s)) is not None}
        self.regions: dict[Structure, Region] = {}
        self.judge = _Judge(Evaluator(dict(self._values(asked)), self._measure), _by_start(asked))

    @cached_property
    def whole(self) -> Region:
        """All bodies as one."""
        return united(*(body.region for body in self.drawing.bodies))

    def _thing(self, placeholder: Structure) -> Thing | None:
        name, _, index = placeholder.name.partition("[")
        if name == WHOLE:
            return Thing(((self.model.root,),))
        found, k = self.bound[name], int(index.rstrip("]") or 0)
        return found[k] if k < len(found) else None

    def _values(self, asked: Model) -> Iterator[tuple[Unknown, float]]:
        """Yields the boxes of the things bound to roles, and measures of the whole drawing; NaN without a
        value.
        """
        for placeholder, thing in self.things.items():
            box = thing.box(lambda of=placeholder: self._region(of))  # type: ignore[misc]
            yield from _box_values(placeholder, box)
        yield from _measured_values(asked, self.drawn)

    def _region(self, placeholder: Structure) -> Region:
        if placeholder not in self.regions:
            is_whole = placeholder.name == WHOLE
            self.regions[placeholder] = (
                self.whole if is_whole else self.things[placeholder].region(self.drawing)
            )
        return self.regions[placeholder]

    def _measure(self, payload: object) -> float:
        assert isinstance(payload, Measurement)
        parts = [part for part in payload.of if isinstance(part, Structure)]
        for part in parts:
            if not self._region(part):
                raise _MissingError(f"`{self.things[part].path}` covers no area")
        return measured(payload.kind, [self._region(part) for part in parts], self.drawing.size)

    def result(self, requirement: Requirement) -> Result:
        if why := next(filter(None, map(self._unusable, requirement.roles)), None):
            return Result(requirement.text, Status.UNMEASURABLE, why, requirement.is_geometric)
        return self.judge.result(requirement, self._bindings(requirement))

    def _unusable(self, role: str) -> str | None:
        found, (low, high) = len(self.bound[role]), self.prompt.ranges.get(role, (1, 1))
        if not found and low:
            return f"no {role.replace('_', ' ')} was found"
        if found < low:
            return f"{found} of `{role}` were found, and {low} at least are needed"
        if found > high:
            return f"{found} of `{role}` were found, and {high} at most are looked at"
        buried = next((thing for thing in self.bound[role] if thing.is_buried), None)
        return f"`{buried.path}` is inside other material and is not to be seen" if buried else None

    def _bindings(self, requirement: Requirement) -> str:
        told = []
        for name in requirement.roles:
            paths = [thing.path for thing in self.bound[name]]
            told.append(f"{name}: {first_few(paths, 4) or 'none'}")
        return f" ({'; '.join(told)})" if told else ""
