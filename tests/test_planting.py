"""Several conflicts in one drawing are all told, each with its set, and their fixes together solve it."""

from __future__ import annotations

import pytest

from tests.planting import judged, planted


@pytest.mark.parametrize("count", [1, 2, *(pytest.param(n, marks=pytest.mark.slow) for n in (3, 5))])
def test_all_that_is_wrong_is_told_at_once_and_mended(count: int) -> None:
    verdict = judged(planted(1000 * count, count))
    assert (verdict.found, verdict.fits, verdict.solved) == (True, True, True)


@pytest.mark.slow
@pytest.mark.parametrize("count", range(1, 6))
def test_nearly_all_that_is_planted_is_told_and_mended(count: int) -> None:
    verdicts = [judged(planted(1000 * count + n, count)) for n in range(50)]
    assert sum(verdict.found for verdict in verdicts) >= 49
    assert sum(verdict.solved for verdict in verdicts) >= 45
