"""Files of programs and of models made by hand, to be read back, and how colours of pixels compare."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from aidl_lang.export import export
from aidl_lang.export.job import Exported, ExportError, Job, Options
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from tests.compiled import compiled
from tests.geometry.models import model


def written(of: str | SolvedModel | SolvedStructure, suffix: str, **options: Any) -> Exported:
    """What comes of a program, a model or its root in a format."""
    asked = Options(**options)
    if isinstance(of, str):
        made = compiled(of)
        assert made.ok, made.diagnostics
        return made.exported(suffix, asked)
    found = of if isinstance(of, SolvedModel) else model(of)
    return export(Job(found, draw(found)[0], options=asked), suffix)


def refused(of: str | SolvedModel | SolvedStructure, suffix: str, **options: Any) -> tuple[str, ...]:
    """The code, the message and the hints that tell why something cannot be written."""
    with pytest.raises(ExportError) as reason:
        written(of, suffix, **options)
    found = reason.value.diagnostic
    return found.code, found.message, *found.hints


def near(color: Sequence[int], other: Sequence[int], by: int = 24) -> bool:
    """Whether no channel differs by more."""
    return all(abs(a - b) <= by for a, b in zip(color, other, strict=True))
