"""What comes of programs that many tests look at and none changes: each is compiled once in a process."""

from __future__ import annotations

from functools import cache

import pytest

import aidl_lang
from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from tests.documents import ROOT

EXAMPLES = sorted((ROOT / "examples").glob("*.aidl"))

DEAR = {"finger_box", "gear_pair", "ruler"}
LIGHTER = [
    pytest.param(path, id=path.stem, marks=[pytest.mark.slow] if path.stem in DEAR else [])
    for path in EXAMPLES
]
"""The examples for tests that ask much of each: the largest three are slow. They are drawn, exported and
checked on every run, and what they are made of (gears, joints, text) has specs.
"""


@cache
def compiled(text: str) -> pipeline.Compiled:
    """What comes of a program that imports nothing."""
    return pipeline.compile(SourceFile("<text>", text))


def model(text: str) -> aidl_lang.Model:
    """The same, as the package has it."""
    return aidl_lang.Model(compiled(text))


def example(name: str) -> aidl_lang.Model:
    """What comes of `examples/NAME.aidl`."""
    return model((ROOT / "examples" / f"{name}.aidl").read_text("utf-8"))
