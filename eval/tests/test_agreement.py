"""Krippendorff's alpha, against the values that he published and against its definition."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from aidl_eval.agreement import Metric, alpha, ordinal
from aidl_eval.statistics import Floats

_ = None
OBSERVERS = (
    (1, 2, 3, 3, 2, 1, 4, 1, 2, _, _, _),
    (1, 2, 3, 3, 2, 2, 4, 1, 2, 5, _, 3),
    (_, 3, 3, 3, 2, 3, 4, 2, 2, 5, 1, _),
    (1, 2, 3, 3, 2, 4, 4, 1, 2, 5, 1, _),
)
"""Krippendorff 2011, part C: four observers, twelve units, some values missing."""
UNITS = [[value for value in unit if value is not None] for unit in zip(*OBSERVERS, strict=True)]


def nominal(values: Floats, counts: Floats) -> Floats:
    return (values[:, None] != values).astype(float)


def interval(values: Floats, counts: Floats) -> Floats:
    found: Floats = (values[:, None] - values) ** 2
    return found


def ratio(values: Floats, counts: Floats) -> Floats:
    found: Floats = ((values[:, None] - values) / (values[:, None] + values)) ** 2
    return found


@pytest.mark.parametrize(
    ("metric", "published"), [(nominal, 0.743), (ordinal, 0.815), (interval, 0.849), (ratio, 0.797)]
)
def test_published_values(metric: Metric, published: float) -> None:
    found = alpha([UNITS], metric)
    assert found is not None
    assert round(found, 3) == published


def by_definition(units: list[list[float]]) -> float:
    """1 - D_o / D_e with the ordinal metric, pair by pair."""
    paired = [unit for unit in units if len(unit) > 1]
    given = [value for unit in paired for value in unit]

    def square(c: float, k: float) -> float:
        low, high = min(c, k), max(c, k)
        between = sum(low <= value <= high for value in given)
        return 0.0 if c == k else (between - (given.count(c) + given.count(k)) / 2) ** 2

    observed = sum(sum(square(*pair) for pair in permutations(unit, 2)) / (len(unit) - 1) for unit in paired)
    expected = sum(square(*pair) for pair in permutations(given, 2)) / (len(given) - 1)
    return 1 - observed / expected


def test_random_units_as_by_definition() -> None:
    random = np.random.default_rng(5)
    for _number in range(20):
        units = [list(random.integers(1, 5, random.integers(0, 5)).astype(float)) for _unit in range(12)]
        assert alpha([units]) == pytest.approx(by_definition(units))


def test_ends() -> None:
    assert alpha([[[1, 1], [2, 2], [3, 3]]]) == 1
    assert alpha([[[1, 2], [2, 1]]]) == pytest.approx(-0.5)
    assert alpha([]) is None
    assert alpha([[[1], [2], []]]) is None
    assert alpha([[[2, 2], [2, 2]]]) is None


def test_ranks_among_two_and_among_five_are_no_agreement() -> None:
    """Raters who rank by lot agree on nothing, also where some ranks can be given to few units only."""
    random = np.random.default_rng(2)
    groups = []
    for size in (2, 8):
        ranked = [[random.permutation(size) + 1 for _rater in range(3)] for _sheet in range(200)]
        groups.append([[float(r[n]) for r in sheet] for sheet in ranked for n in range(size)])
    apart, together = alpha(groups), alpha([groups[0] + groups[1]])
    assert apart is not None
    assert together is not None
    assert abs(apart) < 0.03
    assert together > 0.1
