"""Krippendorff's alpha: how much raters agree beyond chance (Krippendorff, Computing Krippendorff's
Alpha-Reliability, University of Pennsylvania, 2011).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from aidl_eval.statistics import Floats

Metric = Callable[[Floats, Floats], Floats]
"""The squared differences of all pairs of values, from the values in order and how often each was given."""


def ordinal(values: Floats, counts: Floats) -> Floats:
    """Returns the squared differences of ranks: by how many given values lie between two of them."""
    up_to = np.cumsum(counts)
    middles = up_to - counts / 2
    found: Floats = (middles[:, None] - middles[None, :]) ** 2
    return found


def alpha(groups: Iterable[Iterable[Sequence[float]]], metric: Metric = ordinal) -> float | None:
    """Returns the agreement over the units of all groups, each unit the values that raters gave it: 1 if they
    agree, 0 as by chance. What chance does is taken from each group by itself, as ranks among two and among
    five things are not the same values. None where no two raters saw one unit, or all values are equal.
    """
    observed = expected = 0.0
    for units in groups:
        seen, chance = _disagreement([unit for unit in units if len(unit) > 1], metric)
        observed, expected = observed + seen, expected + chance
    return 1 - observed / expected if expected > 0 else None


def _disagreement(units: Sequence[Sequence[float]], metric: Metric) -> tuple[float, float]:
    """Returns the disagreement within units and that expected by chance, times the number of values."""
    if not units:
        return 0.0, 0.0
    values, places = np.unique(np.concatenate(units), return_inverse=True)
    tables = np.zeros((len(units), len(values)))
    np.add.at(tables, (np.repeat(np.arange(len(units)), list(map(len, units))), places), 1)
    counts = tables.sum(0)
    squares = metric(values, counts)
    pairs = np.einsum("ui,uj,ij->u", tables, tables, squares)
    return float((pairs / (tables.sum(1) - 1)).sum()), float(counts @ squares @ counts / (counts.sum() - 1))
