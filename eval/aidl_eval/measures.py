"""Measures a valid program, in a worker: its drawing, its requirements, and its editability: its knobs are
set to other values, and what still does as before is counted.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from aidl_eval import pictures
from aidl_eval.plan import VARIANTS
from aidl_eval.regions import Regions, of_drawing
from aidl_eval.rendering import RenderedLanguage, as_written
from aidl_eval.requirements import Prompt, examine
from aidl_eval.whole import pieces
from aidl_lang import SourceFile, pipeline
from aidl_lang.building.model import Knob
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.ends import Value, allowed, rounded
from aidl_lang.tools.llm.aidl import Aidl, counted
from aidl_lang.tools.llm.messages import Language

SHARES = (-0.25, -0.1, 0.1, 0.25)
"""Changes of a number, as shares of its value."""
_KNOBS = 25
"""Most knobs of a program that are tried."""


@dataclass(frozen=True)
class Edit:
    """`holds` if the program still is valid, and meets each requirement that it met before."""

    knob: str
    value: Value
    holds: bool


@dataclass(frozen=True)
class Edits:
    """`knobs` is how many there are, of which the first few are tried."""

    knobs: int
    edits: tuple[Edit, ...]


def draw(variant: str, program: str, prompt: Prompt) -> tuple[bytes, Mapping[str, Any]]:
    """Draws and measures a valid program. Returns a PNG, and what a record has of it: what is counted in the
    program, and the requirements.
    """
    language = VARIANTS[variant]
    if isinstance(language, RenderedLanguage):
        rendered = as_written(language, program)
        if not rendered.ok:
            raise ValueError(f"the program was judged valid, and is not: {rendered.errors[0]}")
        found, numbers = rendered.regions, {"structures": float(language.structures(program))}
    else:
        valid = compiled(language, SourceFile("part.aidl", program))
        if valid.model is None:
            raise ValueError("the program was judged valid, and is not")
        found, numbers = drawn(valid), dict(counted(valid.model))
    numbers["detached"] = max(0.0, pieces(found) - 1)
    return pictures.png(found), {"numbers": numbers, "requirements": [*map(asdict, examine(prompt, found))]}


def edit(variant: str, program: str, prompt: Prompt) -> Edits:
    """Tries edits of a valid program's knobs."""
    language = VARIANTS[variant]
    if isinstance(language, RenderedLanguage):
        return of_rendered(language, program, prompt)
    return of_aidl(language, SourceFile("part.aidl", program), prompt)


def compiled(language: Language, source: SourceFile, params: Mapping[str, Value] | None = None) -> Compiled:
    """Compiles a program in its subset of the language."""
    assert isinstance(language, Aidl)
    return pipeline.compile(source, params=params, settings=pipeline.Settings.of(language.variant))


def drawn(compiled: Compiled) -> Regions:
    """Returns what a valid program draws, nothing of another one."""
    if not compiled.ok or compiled.model is None or compiled.drawing is None:
        return Regions()
    return of_drawing(compiled.model, compiled.drawing)


def of_aidl(language: Language, source: SourceFile, prompt: Prompt) -> Edits:
    """Edits the `param`s of a valid program."""
    before = compiled(language, source)
    tried = [(knob.path, value) for knob in before.knobs[:_KNOBS] for value in turned(knob)]
    after = (drawn(compiled(language, source, {path: value})) for path, value in tried)
    return Edits(len(before.knobs), _judged(prompt, drawn(before), tried, after))


def of_rendered(language: RenderedLanguage, program: str, prompt: Prompt) -> Edits:
    """Edits the numbers of a valid program in another language."""
    knobs = language.knobs(program)
    tried = [
        (name, value)
        for name, written in list(knobs.items())[:_KNOBS]
        for value in dict.fromkeys(_whole(aim, written) for aim in _numbers(written))
        if value != written
    ]
    after = language.run(program, [{name: value} for name, value in tried]) if tried else []
    before = as_written(language, program).regions
    drawn = (r.regions if r.ok else Regions() for r in after)
    return Edits(len(knobs), _judged(prompt, before, tried, drawn))


def _judged(
    prompt: Prompt, before: Regions, tried: Sequence[tuple[str, Value]], after: Iterable[Regions]
) -> tuple[Edit, ...]:
    met = _met(prompt, before)
    return tuple(
        Edit(name, value, bool(found) and met <= _met(prompt, found))
        for (name, value), found in zip(tried, after, strict=True)
    )


def _met(prompt: Prompt, drawn: Regions) -> frozenset[str]:
    return frozenset(r.text for r in examine(prompt, drawn) if r.is_met)


def turned(knob: Knob) -> list[Value]:
    """Returns the values to try. A text without choices has none."""
    if knob.choices:
        return [choice for choice in knob.choices if choice != knob.value][: len(SHARES)]
    if isinstance(knob.value, bool):
        return [not knob.value]
    if isinstance(knob.value, str):
        return []
    written = float(knob.value)
    aims = [_whole(aim, written) if knob.unit == "" else aim for aim in _numbers(written)]
    return [value for value in dict.fromkeys(allowed(knob, aim) for aim in aims) if value != knob.value]


def _numbers(value: float) -> list[float]:
    """Returns values around one; a zero has no share of itself and is left alone."""
    return [rounded(value * (1 + share)) for share in SHARES] if value else []


def _whole(aim: float, written: float) -> float:
    """Keeps a value whole if the written number, maybe a count, is whole."""
    return float(round(aim)) if written.is_integer() else aim
