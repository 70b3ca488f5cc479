"""What comes of programs that many tests look at and none changes: each is compiled once in a process."""

from __future__ import annotations

import json
from collections.abc import Container, Iterable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from _pytest.mark import ParameterSet

import aidl_lang
from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
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


@cache
def json_of(text: str) -> dict[str, Any]:
    """The same as JSON, which nobody changes."""
    return json.loads(compiled(text).export(".json"))  # type: ignore[no-any-return]


def example(name: str) -> aidl_lang.Model:
    """What comes of `examples/NAME.aidl`."""
    return model((ROOT / "examples" / f"{name}.aidl").read_text("utf-8"))
