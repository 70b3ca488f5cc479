"""Programs of which nothing is told: all is of one kind, or what changes is what the program says."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang.tools.ranges import sentences
from benchmarks.ranges import walk_of
from tests.documents import ROOT

EXAMPLES = sorted((ROOT / "examples").rglob("*.aidl"))
TOLD = {"fence_bracket": ["`leg = 32.72mm`", "`leg = 57.28mm`", "`reach = 102.7mm`"], "lantern": []}
"""What changes kind in an example: holes break through the edge of the bracket."""
QUICK = {"flange"}


def told(path: Path) -> list[str]:
    walks, _ = walk_of(path.read_text("utf-8"), str(path))
    return [text for walk in walks for text in sentences(walk) if text.startswith("at ")]


@pytest.mark.parametrize(
    "path",
    [pytest.param(p, marks=() if p.stem in QUICK else pytest.mark.slow, id=p.stem) for p in EXAMPLES],
)
def test_examples_are_of_one_kind_over_their_ranges(path: Path) -> None:
    found, wanted = told(path), TOLD.get(path.stem, [])
    assert len(found) == len(wanted), found
    assert all(place in text for place, text in zip(wanted, found, strict=True))
