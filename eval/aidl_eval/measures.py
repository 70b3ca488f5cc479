"""Measures a valid program, in a worker: its drawing, its requirements, its editability."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from aidl_eval import editability, pictures, shapes
from aidl_eval.editability import Edits
from aidl_eval.plan import VARIANTS
from aidl_eval.regions import of_drawing
from aidl_eval.rendering import RenderedLanguage, as_written
from aidl_eval.requirements import Prompt, examine, examine_regions
from aidl_eval.whole import pieces
from aidl_lang import SourceFile
from aidl_lang.export.job import Options
from aidl_lang.tools.llm.aidl import counted


def draw(variant: str, program: str, prompt: Prompt) -> tuple[bytes, bytes, Mapping[str, Any]]:
    """Draws and measures a valid program. Returns a PNG in the language's own style, one in the style of all,
    and what a record has of it: what is counted in the program, and the requirements.
    """
    language = VARIANTS[variant]
    if isinstance(language, RenderedLanguage):
        rendered = as_written(language, program)
        if not rendered.ok:
            raise ValueError(f"the program was judged valid, and is not: {rendered.errors[0]}")
        drawn, numbers = rendered.regions, {"structures": float(language.structures(program))}
        png, results = pictures.colored(drawn), examine_regions(prompt, drawn)
    else:
        source = SourceFile("part.aidl", program)
        compiled = editability.compiled(language, source)
        if compiled.model is None or compiled.drawing is None:
            raise ValueError("the program was judged valid, and is not")
        drawn, numbers = of_drawing(compiled.model, compiled.drawing), dict(counted(compiled.model))
        png = compiled.export(".png", Options(pixels=shapes.PIXELS))
        results = examine(prompt, source, compiled)
    numbers["detached"] = max(0.0, pieces(drawn.whole) - 1)
    return png, pictures.neutral(drawn), {"numbers": numbers, "requirements": [*map(asdict, results)]}


def edit(variant: str, program: str, prompt: Prompt) -> Edits:
    """Tries edits of a valid program's knobs."""
    language = VARIANTS[variant]
    if isinstance(language, RenderedLanguage):
        return editability.of_rendered(language, program, prompt)
    return editability.of_aidl(language, SourceFile("part.aidl", program), prompt)
