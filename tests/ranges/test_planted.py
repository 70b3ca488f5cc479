"""Changes that were planted are found where they are (see `benchmarks.ranges`), and nothing else is told."""

from __future__ import annotations

import pytest

from benchmarks.ranges import Planted, judged, planted, walk_of

CASES = planted()
QUICK = [case for number, case in enumerate(CASES) if number % 30 == 0]


def is_right(case: Planted) -> bool:
    (walk,), _ = walk_of(case.text)
    return judged(case, walk) == (True, 0)


@pytest.mark.parametrize("case", QUICK, ids=lambda case: f"{case.name} at {case.place:g}")
def test_some_changes_are_found(case: Planted) -> None:
    assert is_right(case)


@pytest.mark.slow
def test_nearly_all_changes_are_found() -> None:
    assert len(CASES) == 60
    assert sum(map(is_right, CASES)) >= 57
