"""The stages before solving, text → Program → Model, with all diagnostics that they can give."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TypeAlias

from aidl_lang.building.state import DEFAULT_LIMITS, BuildingLimits
from aidl_lang.checking import library as library_module
from aidl_lang.checking.resolve import resolve
from aidl_lang.checking.subset import Variant, adapted
from aidl_lang.common.diagnostics import Diagnostic, has_errors, is_too_many, ordered, within_limit
from aidl_lang.common.records import record
from aidl_lang.common.running import Stopwatch
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.interp import Interpretation, interpret, nothing_built
from aidl_lang.parser import DEFAULT_LIMITS as DEFAULT_TEXT_LIMITS
from aidl_lang.parser import Parsed, TextLimits, parse
from aidl_lang.solver import Settings as SolverSettings
from aidl_lang.solver import Stages
from aidl_lang.typecheck import Program
from aidl_lang.typecheck import check as typecheck

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
    source: SourceFile,
    world: World | None,
    params: Mapping[str, str | float | bool],
    settings: Settings,
    watch: Stopwatch,
    checked: Front | None = None,
    turned: Mapping[int, int] | None = None,
    states_constants: bool = False,
) -> tuple[Interpretation, list[Diagnostic]]:
    """Builds the Model of a text. Returns it with every diagnostic that does not need solving."""
    program, found = checked or read(source, world, settings, watch)
    if is_too_many(found):  # nothing of the model would be used or reported
        return nothing_built(), within_limit(ordered(adapted(found, settings.variant)))
    static = list(found)
    with watch("interpret"):
        built = interpret(program, params, settings.building, turned, states_constants)
    static += [violation.diagnostic(built.written) for violation in program.violations]
    return built, within_limit(ordered(adapted([*static, *built.diagnostics], settings.variant)))
