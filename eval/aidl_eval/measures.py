"""Measures a valid program, in a worker: its drawing, its requirements, its editability."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from aidl_eval import editability, pictures, shapes
from aidl_eval.editability import Edits
from aidl_eval.plan import VARIANTS
from aidl_eval.regions import Regions, of_drawing
from aidl_eval.rendering import RenderedLanguage, as_written
from aidl_eval.requirements import Prompt, Result, examine, examine_regions
from aidl_eval.whole import pieces
from aidl_lang import SourceFile
from aidl_lang.export.job import Options
from aidl_lang.tools.llm.aidl import counted
from aidl_lang.tools.llm.messages import Language


@dataclass(frozen=True)
class DrawnProgram:
    """`png` is in the language's own style, `neutral` in the one style of all; `numbers` holds what is
    counted in the program.
    """

    png: bytes
    neutral: bytes
    numbers: Mapping[str, float] = field(default_factory=dict)
    requirements: tuple[Result, ...] = ()


def draw(variant: str, program: str, prompt: Prompt) -> DrawnProgram:
    """Draws and measures a valid program."""
    language = VARIANTS[variant]
    if isinstance(language, RenderedLanguage):
        return _draw(language, program, prompt)
    return _draw_aidl(language, program, prompt)


def _draw_aidl(language: Language, program: str, prompt: Prompt) -> DrawnProgram:
    source = SourceFile("part.aidl", program)
    compiled = editability.compiled(language, source)
    model, drawing = compiled.model, compiled.drawing
    if model is None or drawing is None:
        raise ValueError("the program was judged valid, and is not")
    drawn = of_drawing(model, drawing)
    numbers = counted(model) | _counted(drawn)
    png = compiled.export(".png", Options(pixels=shapes.PIXELS))
    return DrawnProgram(png, pictures.neutral(drawn), numbers, examine(prompt, source, compiled))


def _draw(language: RenderedLanguage, program: str, prompt: Prompt) -> DrawnProgram:
    rendered = as_written(language, program)
    if not rendered.ok:
        raise ValueError(f"the program was judged valid, and is not: {rendered.errors[0]}")
    drawn = rendered.regions
    numbers = {"structures": float(language.structures(program)), **_counted(drawn)}
    requirements = examine_regions(prompt, drawn)
    return DrawnProgram(pictures.colored(drawn), pictures.neutral(drawn), numbers, requirements)


def _counted(drawn: Regions) -> dict[str, float]:
    """Counts the pieces beyond the first."""
    return {"detached": max(0.0, pieces(drawn.whole) - 1)}


def edit(variant: str, program: str, prompt: Prompt) -> Edits:
    """Tries edits of a valid program's knobs."""
    language = VARIANTS[variant]
    if isinstance(language, RenderedLanguage):
        return editability.of_rendered(language, program, prompt)
    return editability.of_aidl(language, SourceFile("part.aidl", program), prompt)
