"""What comes of programs that many tests look at and none changes: each is compiled once in a process."""

from __future__ import annotations

import json
from collections.abc import Container, Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from _pytest.mark import ParameterSet

import aidl_lang
from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.solver.hierarchy import Memory
from tests.documents import ROOT


def lighter(paths: Iterable[Path], dear: Container[str]) -> list[ParameterSet]:
    """Returns files as parameters of a test; those whose names are among `dear` are slow."""
    slow = [pytest.mark.slow]
    return [pytest.param(path, id=path.stem, marks=slow if path.stem in dear else []) for path in paths]


EXAMPLES = sorted((ROOT / "examples").glob("*.aidl"))

DEAR = {"finger_box", "gear_pair", "ruler"}
LIGHTER = lighter(EXAMPLES, DEAR)
"""The examples for tests that ask much of each: the largest three are slow. They are drawn, exported and
checked on every run, and what they are made of (gears, joints, text) has specs.
"""
FEW = lighter(EXAMPLES, {path.stem for path in EXAMPLES} - {"bottle_opener", "telephone"})
"""The examples for tests that try something at each place of a text: two are tried on every run."""


@cache
def compiled(text: str) -> pipeline.Compiled:
    """What comes of a program that imports nothing."""
    return pipeline.compile(SourceFile("<text>", text))


def model(text: str) -> aidl_lang.Model:
    """The same, as the package has it."""
    return aidl_lang.Model(compiled(text))


@pytest.fixture
def once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands compile a program that reads no other file once in the process, whatever they make of it."""
    monkeypatch.setattr(pipeline, "compile", _once)


KEPT: dict[object, pipeline.Compiled] = {}
_compile = pipeline.compile


def _once(
    source: SourceFile,
    world: World | None = None,
    params: Mapping[str, str | float | bool] | None = None,
    settings: pipeline.Settings = pipeline.Settings(),
    show: Sequence[str] = (),
    memory: Memory | None = None,
    checked: pipeline.Front | None = None,
) -> pipeline.Compiled:
    if memory is not None or checked is not None or "import" in source.text or "font" in source.text:
        return _compile(source, world, params, settings, show, memory, checked)
    key = (source.name, source.text, tuple((params or {}).items()), settings, tuple(show))
    if key not in KEPT:
        KEPT[key] = _compile(source, world, params, settings, show)
    return KEPT[key]


@cache
def json_of(text: str) -> dict[str, Any]:
    """The same as JSON, which nobody changes."""
    return json.loads(compiled(text).export(".json"))  # type: ignore[no-any-return]


def example(name: str) -> aidl_lang.Model:
    """What comes of `examples/NAME.aidl`."""
    return model((ROOT / "examples" / f"{name}.aidl").read_text("utf-8"))
