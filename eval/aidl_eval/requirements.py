"""Prompts and what a drawing of the thing must have, as asserts of the language itself.

A prompt is an AIDL program: its root's comment is what the model is asked, its asserts are the requirements.
A `var` with the name of a measure (`whole.py`) has the value that is measured of what a program draws, in any
language; the asserts are evaluated there by the language's own evaluator. See `eval/prompts.md`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from aidl_eval.regions import Regions
from aidl_eval.whole import MEASURES
from aidl_lang import SourceFile
from aidl_lang.building.expression import Evaluator
from aidl_lang.building.model import Assertion, Condition, Model
from aidl_lang.explaining.outcome import assertion_note
from aidl_lang.interp import interpret
from aidl_lang.pipeline import front


@dataclass(frozen=True)
class Prompt:
    """`text` is the request to the model, `requirements` say what is asked of a drawing."""

    name: str
    text: str
    requirements: tuple[str, ...]
    source: SourceFile


@dataclass(frozen=True)
class Result:
    """What came of a requirement; `detail` tells why it is not met."""

    text: str
    is_met: bool
    detail: str = ""


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
    asked = _built(source)
    if not asked.root.doc:
        raise PromptError(f"{source.name}: the comment before the root is to say what is asked for")
    for assertion in asked.assertions:
        if assertion.message is None:
            place = f"{source.name}:{assertion.span.line}"
            raise PromptError(f"{place}: the assert does not say what it asks for")
    requirements = tuple(assertion.message or "" for assertion in asked.assertions)
    name = Path(source.name).stem.lstrip("0123456789").lstrip("-_")
    return Prompt(name, asked.root.doc, requirements, source)


def _built(source: SourceFile) -> Model:
    program, found = front(source)
    if not any(d.is_error for d in found):
        built = interpret(program)
        found = [*found, *built.diagnostics]
    if errors := [d for d in found if d.is_error]:
        place = f":{errors[0].span.line}" if errors[0].span else ""
        raise PromptError(f"{source.name}{place}: {errors[0].message}")
    return built.model


def examine(prompt: Prompt, drawn: Regions) -> tuple[Result, ...]:
    """Examines what a program draws, and returns one result for each requirement."""
    if not prompt.requirements:
        return ()
    asked = _built(prompt.source)
    known = [unknown for unknown in asked.unknowns if unknown.field in MEASURES]
    evaluate = Evaluator({unknown: MEASURES[unknown.field](drawn) for unknown in known})
    return tuple(_result(assertion, evaluate) for assertion in asked.assertions)


def _result(assertion: Assertion, evaluate: Evaluator) -> Result:
    comparisons = assertion.condition.comparisons() if isinstance(assertion.condition, Condition) else ()
    if not all(math.isfinite(evaluate(side)) for of in comparisons for side in (of.left, of.right)):
        detail = f"nothing is drawn of which `{assertion.text}` could be asked"
    else:
        note = assertion_note(assertion, evaluate)
        detail = "" if note is None else note.label
    return Result(assertion.message or "", not detail, detail)
