"""Mutants of real programs are mended without a new error, with all constraints they had, and for good."""

from __future__ import annotations

import pytest

from tests.amount import some
from tests.fuzz.mends import finding, program
from tests.fuzz.sources import seeds

_EACH = 10
"""Programs to a test."""


@pytest.mark.parametrize("first", some([*range(0, 250, _EACH)], 13))
def test_mending_makes_nothing_worse(first: int) -> None:
    for seed in range(first, first + _EACH):
        text = program(seed, seeds())
        found = finding(text)
        assert found is None, f"seed {seed}: {found.kind}\n{text}\n=== {found.details}"
