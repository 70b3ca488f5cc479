"""Measures a valid program, in a worker: its drawing, its requirements, its editability."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from aidl_lang import pipeline
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.export import Options
from aidl_lang.geometry.boolean import united
from aidl_lang.geometry.region import Region
from aidl_lang.tools.evaluation import editability, openscad, shapes
from aidl_lang.tools.evaluation.editability import Edits
from aidl_lang.tools.evaluation.requirements import Prompt, Result, examine
from aidl_lang.tools.evaluation.whole import pieces
from aidl_lang.tools.llm.aidl import counted

OPENSCAD = "openscad"


@record()
class DrawnProgram:
    """`numbers` holds measures of the language's programs only; `requirements` is empty if none are
    examined.
    """

    png: bytes
    numbers: Mapping[str, float] = field(default_factory=dict)
    requirements: tuple[Result, ...] = ()


def draw(variant: str, program: str, prompt: Prompt) -> DrawnProgram:
    """Draws and measures a valid program."""
    return _draw_openscad(program) if variant == OPENSCAD else _draw_aidl(program, prompt)


def _draw_aidl(program: str, prompt: Prompt) -> DrawnProgram:
    source = SourceFile("part.aidl", program)
    compiled = pipeline.compile(source)
    model, drawing = compiled.model, compiled.drawing
    if model is None or drawing is None:
        raise ValueError("the program was judged valid, and is not")
    numbers = counted(model) | {"detached": _detached(united(*(body.region for body in drawing.bodies)))}
    png = compiled.export(".png", Options(pixels=shapes.PIXELS))
    return DrawnProgram(png, numbers, examine(prompt, source, compiled))


def _draw_openscad(program: str) -> DrawnProgram:
    drawn = shapes.region(openscad.render(program).outlines)
    numbers = {"structures": float(openscad.structures(program)), "detached": _detached(drawn)}
    return DrawnProgram(shapes.png(drawn), numbers)


def _detached(drawn: Region) -> float:
    """Counts the pieces beyond the first."""
    return max(0.0, pieces(drawn) - 1)


def edit(variant: str, program: str) -> Edits:
    """Tries edits of a valid program's knobs."""
    if variant == OPENSCAD:
        return editability.of_openscad(program)
    return editability.of_aidl(SourceFile("part.aidl", program))
