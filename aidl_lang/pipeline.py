"""The stages in order: text → Module → Program → Model → Problem → Solution → Drawing → bytes.

Each stage hands over one value and its diagnostics; nothing here raises for what a program says.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang import parser
from aidl_lang.building.model import Knob, Model
from aidl_lang.checking import library as library_module
from aidl_lang.checking.resolve import resolve
from aidl_lang.checking.subset import adapted
from aidl_lang.checking.symbols import IDLE, SymbolKind, audible, idle
from aidl_lang.common.diagnostics import Diagnostic, TooLongError, has_errors, ordered, within
from aidl_lang.common.running import Later, Stopwatch, checkpoint, working
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import World
from aidl_lang.compiled import Compiled, Facts
from aidl_lang.interp import Asked, Front, Interpretation, Settings, build, interpret, read
from aidl_lang.syntax import ast
from aidl_lang.typecheck import Program
from aidl_lang.typecheck import check as typecheck

if TYPE_CHECKING:
    from aidl_lang.building.expression import Evaluator
    from aidl_lang.building.lower import Lowered, Solved
    from aidl_lang.explaining.failures import Explanation, Rereading
    from aidl_lang.explaining.giving import GaveWay
    from aidl_lang.explaining.trials import Trials
    from aidl_lang.geometry.drawing import Drawing, Findings
    from aidl_lang.geometry.solved import SolvedModel
    from aidl_lang.solver.analysis import Freedom
    from aidl_lang.solver.hierarchy import Memory

_Noted: TypeAlias = "tuple[list[Diagnostic], list[Diagnostic]]"


def front(
    text: SourceFile | parser.Parsed, world: World | None = None, settings: Settings = Settings()
) -> Front:
    """Reads a text, parsed or not, into a Program that is checked. `compile` can go on from it."""
    with working:
        return read(text, world, settings, Stopwatch())


class _Tries(Asked):
    """Ways to try a program again: other texts of it, other readings of its calls."""

    def trials(self, solution: Solved, states_constants: bool = False) -> Trials:
        """Returns what tries other texts of the program with this solution."""
        from aidl_lang.building.lower import lower
        from aidl_lang.explaining.trials import Trials

        solving = self.settings.solving
        hurried = replace(solving, explain=False, seconds=min(solving.seconds, 1.0))
        unexplained = replace(self, settings=replace(self.settings, solving=hurried))

        def build(changed: SourceFile) -> Lowered | None:
            built = replace(unexplained, source=changed).built(states_constants=states_constants)
            return None if built is None else lower(built.model)

        def said(changed: SourceFile) -> list[Diagnostic]:
            return compile(changed, self.world, self.params, unexplained.settings).diagnostics

        return Trials(self.source, build, said, solution, solving)

    def answered(
        self, found: list[Diagnostic], everything: Sequence[Diagnostic], stated: Model
    ) -> list[Diagnostic]:
        """Returns the diagnostics, those on constants with values that would fit; `everything` has all."""
        solving = self.settings.solving
        if not (solving.explain and has_errors(found)):
            return found
        from aidl_lang.building.lower import lower
        from aidl_lang.explaining.remedies import NEVER, with_failing_constants, with_remedies
        from aidl_lang.solver import solve

        is_decided = any(d.code == NEVER for d in found) or any(
            a.condition is False for a in stated.assertions
        )
        if not is_decided or (built := self.built(states_constants=True)) is None:
            return found
        solution = with_failing_constants(solve(lower(built.model), replace(solving, explain=False)))
        return with_remedies(found, everything, self.trials(solution, states_constants=True))

    def built(
        self, turned: Mapping[int, int] | None = None, states_constants: bool = False
    ) -> Interpretation | None:
        """Builds the program with calls read otherwise, or conditions stated; None if wrong then."""
        built, found = build(self, Stopwatch(), turned=turned, states_constants=states_constants)
        return None if has_errors(found) else built


def _beside(notes: Sequence[Diagnostic], errors: Sequence[Diagnostic]) -> Iterator[Diagnostic]:
    """Returns the notes on places at which no error is reported."""
    places = [d.span for d in errors if d.is_error and d.span is not None]
    return (n for n in notes if n.span is None or not any(n.span.overlaps(p) for p in places))


def check(
    source: SourceFile, world: World | None = None, settings: Settings = Settings()
) -> list[Diagnostic]:
    """Returns every diagnostic of a program that needs no solving."""
    with working:
        built, found = build(Asked(source, world, {}, settings), Stopwatch())
    return audible(found, built.allowances)


def formatted(source: SourceFile, world: World | None = None) -> tuple[str | None, list[Diagnostic]]:
    """Returns the canonical form of a program, names as they are defined; None if it does not parse."""
    from aidl_lang.syntax.printer import format_module

    with working:
        parsed = parser.parse(source)
        if has_errors(parsed.diagnostics):
            return None, parsed.diagnostics
        names = typecheck(resolve(parsed.module, world, library_module.load())).resolution
        stated = {node for node, symbol in names.uses.items() if symbol.kind is SymbolKind.CONSTRAINT}
        # An equation with a new name on its left was meant to declare it: the error is about `=`, not `==`.
        declaring = {
            node
            for node in ast.walk(parsed.module)
            if isinstance(node, ast.Equation)
            and isinstance(node.left, ast.Name)
            and node.left not in names.uses
        }
        return format_module(parsed, names.canonical, stated, declaring), parsed.diagnostics


def knobs(
    source: SourceFile, world: World | None = None, settings: Settings = Settings()
) -> tuple[tuple[Knob, ...], list[Diagnostic]]:
    """Returns the `param`s of a program in order of writing."""
    with working:
        built, diagnostics = build(Asked(source, world, {}, settings), Stopwatch())
    return tuple(built.model.knobs), audible(diagnostics, built.allowances)


def compile(
    source: SourceFile,
    world: World | None = None,
    params: Mapping[str, str | float | bool] | None = None,
    settings: Settings = Settings(),
    show: Sequence[str] = (),
    memory: Memory | None = None,
    checked: Front | None = None,
) -> Compiled:
    """Takes a program through all stages. The `diagnostics` say if it is wrong, or does not solve.

    With a `memory` of the last run, structures that no change since then concerns are not solved again; with
    the result of `front` for this very program, it is not checked again. Raises Cancelled if the run is given
    up (see `common.running`).
    """
    watch, tries = Stopwatch(), _Tries(source, world, params or {}, settings)
    with working:
        built, diagnostics = build(tries, watch, checked)
        known = tuple(built.model.knobs)
        if has_errors(diagnostics):
            with watch("fixes"):
                told = audible(tries.answered(diagnostics, diagnostics, built.model), built.allowances)
            made = Compiled("wrong", Later(None, Facts(told)), watch.seconds, known)
        else:
            way = _Finish(built, diagnostics, watch, tries)
            made = way.outcome(known, frozenset(show), memory)
    made.asked = Asked(source, world, params or {}, settings)
    made.allowances = built.allowances
    return made


def again(compiled: Compiled, params: Mapping[str, str | float | bool]) -> Compiled:
    """Takes a program through all stages once more with some params set; the others stay as they were."""
    asked = compiled.asked
    assert asked is not None
    return compile(asked.source, asked.world, {**asked.params, **params}, asked.settings)


def placed(
    program: Program, params: Mapping[str, str | float | bool], settings: Settings = Settings()
) -> tuple[Model, Evaluator] | None:
    """Solves a program with these params, without drawing it. None if it does not solve."""
    from aidl_lang.building.expression import Evaluator
    from aidl_lang.building.lower import lower
    from aidl_lang.solver import Status, solve

    with working:
        built = interpret(program, params, settings.building)
        if has_errors(built.diagnostics):
            return None
        solution = solve(lower(built.model), settings.solving)
    if solution.status is not Status.SOLVED:
        return None
    return built.model, Evaluator(solution.problem.by_unknown(solution.values))


def redrawn(outcome: Compiled, solution: Solved) -> Compiled:
    """Returns an outcome with its parts placed by another solution of the same model, as while one is
    dragged. What there is to say of the drawing is said anew, with fixes that were not tried; what there was
    of the text and its solution stays.

    Raises TooLongError, and ValueError if nothing was built.
    """
    if outcome.built is None:
        raise ValueError("the program is wrong, so there is nothing to draw")
    watch = Stopwatch()
    freedom = Later(partial(_freed, solution, watch))
    with working, within(outcome.limit, "drawing"):
        model, evaluator, drawing, notes, found = _drawn(outcome.built, solution, freedom, watch)

    def facts() -> Facts:
        late, drawn = _examined(outcome.limit, lambda: ([], notes.everything()))
        told = [*late, *found, *_beside(drawn, found)]
        if outcome.asked is not None:
            told = adapted(told, outcome.asked.settings.variant)
        return Facts(ordered([*outcome.find().standing, *audible(told, outcome.allowances)]))

    find = Later(facts)
    if outcome.errors or notes.errors or has_errors(found):
        find()
    return replace(
        outcome,
        status=model.status,
        find=find,
        timings=watch.seconds,
        model=model,
        drawing=drawing,
        evaluate=evaluator,
    )


def _examined(limit: float, noted: Callable[[], _Noted]) -> _Noted:
    """Returns what is noted; if that takes too long, that it does."""
    try:
        with within(limit, "examining"):
            return noted()
    except TooLongError as reason:
        checkpoint()  # it may have been the reader's time that ran out
        return [reason.diagnostic], []


def _freed(solution: Solved, watch: Stopwatch) -> Freedom:
    from aidl_lang.solver.analysis import analyse

    with watch("freedom"):
        return analyse(solution, solution.problem.preference)


def _is_troubled(solution: Solved) -> bool:
    return bool(solution.failures) or any(s.concession is not None or s.despite for s in solution.stages)


def _follows(solution: Solved, span: Span) -> bool:
    from aidl_lang.explaining.giving import follows

    return follows(solution, span)


class _Finish:
    """The way from a built program to its outcome: it is solved, drawn, and then told of, step by step."""

    def __init__(
        self, built: Interpretation, diagnostics: list[Diagnostic], watch: Stopwatch, tries: _Tries
    ) -> None:
        self.built, self.diagnostics, self.tries = built, diagnostics, tries
        self.settings, self.watch = tries.settings, watch
        self.other: Rereading | None = None
        self.given: Sequence[GaveWay] = ()
        self.failures: Sequence[Explanation] = ()

    def outcome(self, known: tuple[Knob, ...], show: frozenset[str], memory: Memory | None) -> Compiled:
        self.solve(memory)
        try:
            self.draw()
        except TooLongError as reason:
            found = ordered([*audible(self.diagnostics, self.built.allowances), reason.diagnostic])
            return Compiled("wrong", Later(None, Facts(found)), self.watch.seconds, known)
        failures, find = self.failures, Later(self.facts)
        gave_way = self.settings.strict and self.given
        if not self.is_solved or self.drawn.errors or has_errors(self.asserted) or gave_way:
            find()
        return Compiled(
            self.model.status,
            find,
            self.watch.seconds,
            known,
            self.model,
            self.drawing,
            show,
            tuple((self.solution.problem.groups[stage.group], stage) for stage in self.solution.stages),
            Later(lambda: tuple(failure.conflict for failure in failures)),
            partial(_follows, self.solution),
            self.built.model,
            self.evaluator,
            self.drawn.everything,
            self.settings.drawing,
        )

    def solve(self, memory: Memory | None) -> None:
        from aidl_lang.building.lower import lower
        from aidl_lang.solver import Status, solve

        with self.watch("lower"):
            lowered = lower(self.built.model)
        with self.watch("solve"):
            self.solution = solve(lowered, self.settings.solving, memory)
            if _is_troubled(self.solution):
                from aidl_lang.explaining.failures import reread

                build, solving = self.tries.built, self.settings.solving
                self.other, self.solution = reread(self.built, self.solution, build, solving)
        if (other := self.other) is not None:
            self.built, self.solution = other.built, other.solution
        self.is_solved = self.solution.status is Status.SOLVED
        self.freedom = Later(partial(_freed, self.solution, self.watch))
        self.tried = cache(partial(self.tries.trials, self.solution))
        if _is_troubled(self.solution):
            from aidl_lang.explaining.failures import explained
            from aidl_lang.explaining.giving import gave_way

            with self.watch("reasons"):
                self.given = gave_way(self.solution, self.settings.solving)
            self.failures = explained(self.tried())

    def draw(self) -> None:
        """Raises TooLongError."""
        with within(self.settings.drawing, "drawing"):
            made = _drawn(self.built.model, self.solution, self.freedom, self.watch)
        self.model, self.evaluator, self.drawing, self.drawn, self.asserted = made
        if self.model.changed:
            from aidl_lang.explaining.giving import with_reasons

            self.model = with_reasons(self.model, self.given, self.solution.problem)

    def facts(self) -> Facts:
        trials = self.tried() if self.failures else self.tries.trials(self.solution)
        elsewhere = self._elsewhere(trials)  # the time of new trials has not begun
        found, notes = _examined(self.settings.drawing, self._noted)
        passing = {(d.code, d.span) for d in [*self.asserted, *notes]}
        found = self._strict([*found, *self.asserted])
        told = adapted([*found, *_beside([*elsewhere, *notes], found)], self.settings.variant)
        if self.settings.solving.explain:
            with self.watch("fixes"):
                told = self._mended(told, trials)
        told = audible(self._with_idle(ordered([*self.diagnostics, *told])), self.built.allowances)
        return Facts(told, tuple(d for d in told if (d.code, d.span) not in passing))

    def _elsewhere(self, trials: Trials) -> list[Diagnostic]:
        """Returns notes on what holds only far from the first guesses."""
        if self.other is None and not _is_troubled(self.solution):
            return []
        from aidl_lang.explaining.failures import elsewhere_notes

        return list(elsewhere_notes(self.built.model, self.other, trials))

    def _noted(self) -> _Noted:
        """Returns the diagnostics on the solution, and those on the drawing if the parts are in place."""
        from aidl_lang.explaining.outcome import solution_notes

        root, free = self.built.model.root, self.freedom()
        with self.watch("notes"):
            found = solution_notes(root, self.solution, free, self.model, self.given, self.failures)
        return found, self.drawn.everything() if self.is_solved else []

    def _strict(self, found: list[Diagnostic]) -> list[Diagnostic]:
        """Returns diagnostics, those that report that something gave way as errors if they are to be."""
        if not (self.settings.strict and self.given):
            return found
        from aidl_lang.explaining.trials import GAVE_WAY

        return [replace(d, code="E0606") if d.code in GAVE_WAY else d for d in found]

    def _mended(self, told: list[Diagnostic], trials: Trials) -> list[Diagnostic]:
        """Returns diagnostics with the fixes that help, and with values that would fit constants."""
        if any(d.fix is not None for d in told):
            from aidl_lang.explaining.trials import verified

            told = verified(told, [*self.diagnostics, *told], trials)
        return self.tries.answered(told, [*self.diagnostics, *told], self.built.model)

    def _with_idle(self, told: list[Diagnostic]) -> list[Diagnostic]:
        """Returns diagnostics with notes on what is allowed and does not occur."""
        if not self.settings.solving.explain or not self.is_solved or has_errors(told):
            return told
        allowed = self.built.allowances
        told = [*told, *(notes := idle(told, [each for each in allowed if each.code != IDLE]))]
        return ordered([*told, *idle(notes, [each for each in allowed if each.code == IDLE])])


def _drawn(
    built: Model, solution: Solved, freedom: Later[Freedom], watch: Stopwatch
) -> tuple[SolvedModel, Evaluator, Drawing, Findings, list[Diagnostic]]:
    """Returns the solved model, its evaluator and drawing, the findings on that, and assertions that fail."""
    from aidl_lang.explaining.outcome import assertion_notes
    from aidl_lang.geometry.picturing import pictured

    model, evaluator, drawing, notes = pictured(built, solution, freedom, watch)
    with watch("asserts"):
        found = assertion_notes(built, model, drawing, evaluator, solved_fully=model.status == "solved")
    return model, evaluator, drawing, notes, found


__all__ = ["Compiled", "Facts", "Front", "Knob", "Settings"]  # of other modules; and all that is above
