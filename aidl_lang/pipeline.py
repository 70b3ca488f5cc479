"""The stages in order: text → Module → Program → Model → Problem → Solution → Drawing → bytes.

Each stage hands over one value and its diagnostics; nothing here raises for what a program says.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang import parser
from aidl_lang.building.front import Front, Settings, build, read
from aidl_lang.building.model import Knob, Model
from aidl_lang.checking import library as library_module
from aidl_lang.checking.allowing import IDLE, audible, idle
from aidl_lang.checking.resolve import resolve
from aidl_lang.checking.resolving.symbols import SymbolKind
from aidl_lang.checking.subset import adapted
from aidl_lang.common.diagnostics import Diagnostic, has_errors, ordered
from aidl_lang.common.drawing_time import TooLongError, within
from aidl_lang.common.records import record
from aidl_lang.common.running import Later, Stopwatch, checkpoint, working
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import World
from aidl_lang.compiled import Asked, Compiled, Facts
from aidl_lang.geometry.picturing import pictured
from aidl_lang.interp import Interpretation, interpret
from aidl_lang.syntax import ast
from aidl_lang.typecheck import Program
from aidl_lang.typecheck import check as typecheck

if TYPE_CHECKING:
    from aidl_lang.building.expression import Evaluator
    from aidl_lang.building.lower import Lowered
    from aidl_lang.explaining.failures import Explanation
    from aidl_lang.explaining.giving import GaveWay
    from aidl_lang.explaining.rereading import Rereading
    from aidl_lang.explaining.trials import Trials
    from aidl_lang.geometry.drawing import Drawing, Findings
    from aidl_lang.geometry.solved import SolvedModel
    from aidl_lang.solver.analysis import Freedom
    from aidl_lang.solver.problem import Solution
    from aidl_lang.solver.riding import Memory

_Noted: TypeAlias = "tuple[list[Diagnostic], list[Diagnostic]]"


def front(
    text: SourceFile | parser.Parsed, world: World | None = None, settings: Settings = Settings()
) -> Front:
    """Reads a text, parsed or not, into a Program that is checked. `compile` can go on from it."""
    with working:
        return read(text, world, settings, Stopwatch())


@record()
class _Tries:
    """Ways to try a program again: other texts of it, other readings of its calls."""

    source: SourceFile
    world: World | None
    params: Mapping[str, str | float | bool]
    settings: Settings

    def trials(self, lowered: Lowered, solution: Solution, states_constants: bool = False) -> Trials:
        """Returns what tries other texts of the program with this problem and solution."""
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

        return Trials(self.source, build, said, lowered, solution, solving)

    def answered(
        self, found: list[Diagnostic], everything: Sequence[Diagnostic], stated: Model
    ) -> list[Diagnostic]:
        """Returns the diagnostics, those on constants with values that would fit. `everything` is all that is
        reported.
        """
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
        lowered = lower(built.model)
        solution = with_failing_constants(lowered, solve(lowered.problem, replace(solving, explain=False)))
        return with_remedies(found, everything, self.trials(lowered, solution, states_constants=True))

    def built(
        self, turned: Mapping[int, int] | None = None, states_constants: bool = False
    ) -> Interpretation | None:
        """Builds the program with ambiguous calls read otherwise, or conditions over constants stated. None
        if it is wrong then.
        """
        built, found = build(
            self.source,
            self.world,
            self.params,
            self.settings,
            Stopwatch(),
            turned=turned,
            states_constants=states_constants,
        )
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
        built, found = build(source, world, {}, settings, Stopwatch())
    return audible(found, built.allowances)


def formatted(source: SourceFile, world: World | None = None) -> tuple[str | None, list[Diagnostic]]:
    """Returns the canonical form of a program, names spelled as they are defined; None if it does not
    parse.
    """
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
        built, diagnostics = build(source, world, {}, settings, Stopwatch())
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
    watch = Stopwatch()
    with working:
        built, diagnostics = build(source, world, params or {}, settings, watch, checked)
        known = tuple(built.model.knobs)
        tries = _Tries(source, world, params or {}, settings)
        if has_errors(diagnostics):
            with watch("fixes"):
                told = audible(tries.answered(diagnostics, diagnostics, built.model), built.allowances)
            made = Compiled("wrong", Later(None, Facts(told)), watch.seconds, known)
        else:
            made = _finish(built, diagnostics, settings, watch, known, frozenset(show), memory, tries)
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
        lowered = lower(built.model)
        solution = solve(lowered.problem, settings.solving)
    if solution.status is not Status.SOLVED:
        return None
    return built.model, Evaluator(dict(zip(lowered.unknowns, solution.values.tolist(), strict=True)))


def redrawn(outcome: Compiled, lowered: Lowered, solution: Solution) -> Compiled:
    """Returns an outcome with its parts placed by another solution of the same model, as while one is
    dragged. What there is to say of the drawing is said anew, with fixes that were not tried; what there was
    of the text and its solution stays.

    Raises TooLongError, and ValueError if nothing was built.
    """
    if outcome.built is None:
        raise ValueError("the program is wrong, so there is nothing to draw")
    watch = Stopwatch()
    freedom = Later(partial(_freed, lowered, solution, watch))
    with working, within(outcome.limit, "drawing"):
        model, evaluator, drawing, notes, found = _drawn(outcome.built, lowered, solution, freedom, watch)

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
    try:
        with within(limit, "examining"):
            return noted()
    except TooLongError as reason:
        checkpoint()  # it may have been the reader's time that ran out
        return [reason.diagnostic], []


def _freed(lowered: Lowered, solution: Solution, watch: Stopwatch) -> Freedom:
    from aidl_lang.building.lower import preference
    from aidl_lang.solver.analysis import analyse

    with watch("freedom"):
        return analyse(lowered.problem, solution, preference(lowered))


def _is_troubled(solution: Solution) -> bool:
    """Tells whether something failed, gave way, or holds only far from the first guesses."""
    return bool(solution.failures) or any(s.concession is not None or s.despite for s in solution.stages)


def _explained(
    lowered: Lowered, solution: Solution, settings: Settings, tried: Callable[[], Trials], watch: Stopwatch
) -> tuple[Sequence[GaveWay], Sequence[Explanation]]:
    if not _is_troubled(solution):
        return (), ()
    from aidl_lang.explaining.failures import explained
    from aidl_lang.explaining.giving import gave_way

    with watch("reasons"):
        given = gave_way(lowered, solution, settings.solving)
    return given, explained(lowered, solution, tried())


def _elsewhere(
    built: Model, lowered: Lowered, solution: Solution, other: Rereading | None, trials: Trials
) -> list[Diagnostic]:
    """Returns notes on what holds only far from the first guesses."""
    if other is None and not _is_troubled(solution):
        return []
    from aidl_lang.explaining.rereading import elsewhere_notes

    return list(elsewhere_notes(built, lowered, solution, other, trials))


def _follows(lowered: Lowered, solution: Solution, span: Span) -> bool:
    from aidl_lang.explaining.giving import follows

    return follows(lowered, solution, span)


def _finish(
    built: Interpretation,
    diagnostics: list[Diagnostic],
    settings: Settings,
    watch: Stopwatch,
    known: tuple[Knob, ...],
    show: frozenset[str],
    memory: Memory | None,
    tries: _Tries,
) -> Compiled:
    from aidl_lang.building.lower import lower
    from aidl_lang.solver import Status, solve

    other: Rereading | None = None
    with watch("lower"):
        lowered = lower(built.model)
    with watch("solve"):
        solution = solve(lowered.problem, settings.solving, memory)
        if _is_troubled(solution):
            from aidl_lang.explaining.rereading import reread

            other, solution = reread(built, lowered, solution, tries.built, settings.solving)
    if other is not None:
        built, lowered, solution = other.built, other.lowered, other.solution
    freedom = Later(partial(_freed, lowered, solution, watch))
    tried = cache(partial(tries.trials, lowered, solution))
    given, failures = _explained(lowered, solution, settings, tried, watch)
    try:
        with within(settings.drawing, "drawing"):
            model, evaluator, drawing, drawn, asserted = _drawn(
                built.model, lowered, solution, freedom, watch
            )
    except TooLongError as reason:
        found = ordered([*audible(diagnostics, built.allowances), reason.diagnostic])
        return Compiled("wrong", Later(None, Facts(found)), watch.seconds, known)
    if model.changed:
        from aidl_lang.explaining.giving import with_reasons

        model = with_reasons(model, given, lowered)
    is_solved = solution.status is Status.SOLVED

    def noted() -> _Noted:
        """Returns the diagnostics on the solution, and those on the drawing if the parts are in place."""
        from aidl_lang.explaining.outcome import solution_notes

        root, free = built.model.root, freedom()
        with watch("notes"):
            found = solution_notes(root, lowered, solution, free, model, given, failures)
        return found, drawn.everything() if is_solved else []

    def facts() -> Facts:
        trials = tried() if failures else tries.trials(lowered, solution)  # whose time has not begun
        elsewhere = _elsewhere(built.model, lowered, solution, other, trials)
        found, notes = _examined(settings.drawing, noted)
        passing = {(d.code, d.span) for d in [*asserted, *notes]}
        found = [*found, *asserted]
        if settings.strict and given:
            from aidl_lang.explaining.giving import as_error

            found = list(map(as_error, found))
        told = adapted([*found, *_beside([*elsewhere, *notes], found)], settings.variant)
        if settings.solving.explain:
            with watch("fixes"):
                if any(d.fix is not None for d in told):
                    from aidl_lang.explaining.trials import verified

                    told = verified(told, [*diagnostics, *told], trials)
                told = tries.answered(told, [*diagnostics, *told], built.model)
        told, allowed = ordered([*diagnostics, *told]), built.allowances
        if settings.solving.explain and is_solved and not has_errors(told):
            told += (idle_notes := idle(told, [each for each in allowed if each.code != IDLE]))
            told = ordered([*told, *idle(idle_notes, [each for each in allowed if each.code == IDLE])])
        told = audible(told, allowed)
        return Facts(told, tuple(d for d in told if (d.code, d.span) not in passing))

    find = Later(facts)
    if not is_solved or drawn.errors or has_errors(asserted) or (settings.strict and given):
        find()
    return Compiled(
        model.status,
        find,
        watch.seconds,
        known,
        model,
        drawing,
        show,
        tuple((lowered.groups[stage.group], stage) for stage in solution.stages),
        Later(lambda: tuple(failure.conflict for failure in failures)),
        partial(_follows, lowered, solution),
        built.model,
        evaluator,
        drawn.everything,
        settings.drawing,
    )


def _drawn(
    built: Model, lowered: Lowered, solution: Solution, freedom: Later[Freedom], watch: Stopwatch
) -> tuple[SolvedModel, Evaluator, Drawing, Findings, list[Diagnostic]]:
    from aidl_lang.explaining.outcome import assertion_notes

    model, evaluator, drawing, notes = pictured(built, lowered, solution, freedom, watch)
    with watch("asserts"):
        found = assertion_notes(built, model, drawing, evaluator, solved_fully=model.status == "solved")
    return model, evaluator, drawing, notes, found


__all__ = [
    "Compiled",
    "Facts",
    "Front",
    "Knob",
    "Settings",
    "again",
    "check",
    "compile",
    "formatted",
    "front",
    "knobs",
    "placed",
    "redrawn",
]
