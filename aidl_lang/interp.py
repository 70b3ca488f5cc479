"""Program → Model: the program is run once, which builds the structure tree and collects its constraints.

Running means: constants are computed, loops and branches taken, geometry made with its unknowns, and every
arithmetic over unknowns kept as an expression. An error is reported and yields `NOTHING`, which everything it
touches passes on in silence, so that one run reports all errors and still yields what can be drawn.

The work is done in `building/`: `structures` (files and roots, too), `statements`, `evaluate` (expressions
and bodies), `calls` (definitions), `construct` (geometry and the exactness of its numbers), `impose`
(constraints). The stages before come along: text → Program → Model, with all diagnostics that they can give.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TypeAlias

from aidl_lang.building.anchors import anchored
from aidl_lang.building.attributes import settle_clips
from aidl_lang.building.calls import call
from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.model import Model, Structure
from aidl_lang.building.state import DEFAULT_LIMITS, BuildingLimits, Interpreter, Stop
from aidl_lang.building.statements import EXECUTORS
from aidl_lang.building.structures import run_module
from aidl_lang.checking import library as library_module
from aidl_lang.checking.builtins import ROTATION
from aidl_lang.checking.resolve import resolve
from aidl_lang.checking.subset import Variant, adapted
from aidl_lang.checking.symbols import Allowance
from aidl_lang.common.diagnostics import Diagnostic, has_errors, is_too_many, ordered, within_limit
from aidl_lang.common.names import fold, folded
from aidl_lang.common.records import record
from aidl_lang.common.running import Stopwatch, limited_to
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.parser import DEFAULT_LIMITS as DEFAULT_TEXT_LIMITS
from aidl_lang.parser import Parsed, TextLimits, parse
from aidl_lang.solver import Settings as SolverSettings
from aidl_lang.solver import Stages
from aidl_lang.syntax import ast
from aidl_lang.typecheck import Program
from aidl_lang.typecheck import check as typecheck


@record()
class Interpretation:
    """The model that a program builds; `written` holds the values, at the first guesses, of the expressions
    that break a rule of validity, `allowances` what is not to be told of it.
    """

    model: Model
    diagnostics: list[Diagnostic]
    written: Mapping[ast.Node, tuple[float, float] | float]
    allowances: tuple[Allowance, ...] = ()


def interpret(
    program: Program,
    overrides: Mapping[str, str | float | bool] | None = None,
    limits: BuildingLimits = DEFAULT_LIMITS,
    turned: Mapping[int, int] | None = None,
    states_constants: bool = False,
) -> Interpretation:
    """Runs a program. Never raises for what a program says; errors are among the diagnostics.

    turned            for ambiguous calls, by number, how many places from the nearest reading to take
    states_constants  conditions over constants, which are decided at once, become constraints all the same
    """
    it = Interpreter(program, overrides or {}, limits, EXECUTORS, evaluate, call, turned=turned or {})
    it.states_constants = states_constants
    it.frames_turn = any(map(_speaks_of_rotation, program.resolution.modules))
    it.watched = frozenset(node for violation in program.violations for node in violation.nodes)
    try:
        with limited_to(limits.seconds):
            root = run_module(it)
            settle_clips(it)
            for copier in tuple(it.copiers):
                copier.clip()
            for copier in it.copiers:
                copier.finish()
    except Stop:
        root = it.root or _nothing()
    constraints = anchored(it.constraints)
    model = Model(
        root, constraints, it.assertions, it.unknowns, it.knobs, it.readings, it.literals, it.by_hand
    )
    return Interpretation(model, it.diagnostics, it.written, program.resolution.allowances)


def _speaks_of_rotation(module: ast.Module) -> bool:
    if fold(ROTATION) not in folded(module.source.text):
        return False
    return any(isinstance(n, ast.Member) and fold(n.name.text) == ROTATION for n in ast.walk(module))


def _nothing() -> Structure:
    return Structure("assembly", "model", None, None)


_UNUSED = "W0201"


@record()
class Settings:
    """Limits for programs that are not trusted, the solver's settings, the subset of the language, and
    whether it is an error that something gave way unasked.

    drawing  seconds of the processor's time for the stages after solving, and for each use of the drawing:
             writing a file, measuring, comparing
    """

    text: TextLimits = DEFAULT_TEXT_LIMITS
    building: BuildingLimits = DEFAULT_LIMITS
    solving: SolverSettings = SolverSettings(tolerance=1e-10)
    variant: Variant = Variant.FULL
    strict: bool = False
    drawing: float = 20.0

    @staticmethod
    def of(variant: Variant, *, strict: bool = False) -> Settings:
        """Returns the settings of a variant of the language: the paper's has the paper's solver, too."""
        stages = Stages.PAPER if variant is Variant.PAPER else Settings.solving.stages
        solving = replace(Settings.solving, stages=stages)
        return Settings(variant=variant, strict=strict, solving=solving)


@record()
class Asked:
    """What a program is compiled of."""

    source: SourceFile
    world: World | None
    params: Mapping[str, str | float | bool]
    settings: Settings


Front: TypeAlias = tuple[Program, list[Diagnostic]]


def read(text: SourceFile | Parsed, world: World | None, settings: Settings, watch: Stopwatch) -> Front:
    """Reads a text into a Program: parsed, unless it is, resolved and type-checked."""
    with watch("parse"):
        parsed = text if isinstance(text, Parsed) else parse(text, settings.text)
    with watch("library"):
        library = library_module.load()
    with watch("resolve"):
        resolution = resolve(parsed.module, world, library)
    with watch("typecheck"):
        program = typecheck(resolution, settings.variant)
    found = program.diagnostics
    if has_errors(parsed.diagnostics):  # the parts left out may have used them
        found = tuple(d for d in found if d.code != _UNUSED)
    return program, [*parsed.diagnostics, *found]


def build(
    asked: Asked,
    watch: Stopwatch,
    checked: Front | None = None,
    turned: Mapping[int, int] | None = None,
    states_constants: bool = False,
) -> tuple[Interpretation, list[Diagnostic]]:
    """Builds the Model of a text. Returns it with every diagnostic that does not need solving."""
    settings = asked.settings
    program, found = checked or read(asked.source, asked.world, settings, watch)
    if is_too_many(found):  # nothing of the model would be used or reported
        unbuilt = Interpretation(Model(_nothing()), [], {})
        return unbuilt, within_limit(ordered(adapted(found, settings.variant)))
    static = list(found)
    with watch("interpret"):
        built = interpret(program, asked.params, settings.building, turned, states_constants)
    static += [violation.diagnostic(built.written) for violation in program.violations]
    return built, within_limit(ordered(adapted([*static, *built.diagnostics], settings.variant)))
