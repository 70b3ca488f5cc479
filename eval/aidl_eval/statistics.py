"""Intervals by resampling, paired tests between languages, and how far raters agree.

Runs of one prompt are not independent of each other, so prompts are what is drawn and what is compared.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

RESAMPLES = 10_000
"""Of each interval, and the most sign patterns of a test: up to 13 prompts all of them are tried."""
SEED = 1

Interval = tuple[float, float]
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Case:
    """The share of one conversation in a figure: the figure is the sum of `value` over that of `weight`."""

    prompt: str
    value: float
    weight: float = 1.0


@dataclass(frozen=True)
class Comparison:
    """The difference of a figure between two languages, over the prompts that both have; each counts once."""

    prompts: int
    difference: float
    interval: Interval | None
    p: float | None
    """Two-sided, of the paired permutation test; None for fewer than two prompts."""

    adjusted: float | None = None
    """`p` after Holm's correction for the number of pairs of languages."""


def interval(cases: Sequence[Case]) -> Interval | None:
    """Returns the 95 % percentile interval of a figure, by drawing prompts with replacement; where there is
    one prompt, by drawing its conversations. None for fewer than two.
    """
    from scipy.stats import bootstrap

    if len({case.prompt for case in cases}) < 2:
        cases = [replace(case, prompt=str(number)) for number, case in enumerate(cases)]
    drawn = _sums(cases)
    if len(drawn) < 2:
        return None
    found = bootstrap(
        tuple(zip(*drawn.values(), strict=True)),
        lambda values, weights, axis: values.sum(axis) / weights.sum(axis),
        paired=True,
        vectorized=True,
        n_resamples=RESAMPLES,
        method="percentile",
        random_state=np.random.default_rng(SEED),  # `rng` in scipy 1.15 and later
    )
    return float(found.confidence_interval.low), float(found.confidence_interval.high)


def wilson(part: int, count: int) -> Interval:
    """Returns Wilson's score interval at 95 % of a share."""
    from scipy.stats import binomtest

    found = binomtest(part, count).proportion_ci(method="wilson")
    return float(found.low), float(found.high)


def by_prompt(cases: Sequence[Case]) -> dict[str, float]:
    """Returns the figure of each prompt."""
    return {prompt: value / weight for prompt, (value, weight) in _sums(cases).items()}


def _sums(cases: Sequence[Case]) -> dict[str, tuple[float, float]]:
    """Returns value and weight of each prompt that has any."""
    found = dict[str, tuple[float, float]]()
    for case in cases:
        value, weight = found.get(case.prompt, (0.0, 0.0))
        found[case.prompt] = value + case.value, weight + case.weight
    return {prompt: of for prompt, of in found.items() if of[1] > 0}


def compared(first: Mapping[str, float], second: Mapping[str, float]) -> Comparison | None:
    """Returns how much greater a figure is in the first language than in the second; None if no prompt has
    both.
    """
    shared = [prompt for prompt in first if prompt in second]
    if not shared:
        return None
    differences = [first[prompt] - second[prompt] for prompt in shared]
    mean = float(np.mean(differences))
    if len(shared) < 2:
        return Comparison(1, mean, None, None)
    drawn = [Case(prompt, value) for prompt, value in zip(shared, differences, strict=True)]
    return Comparison(len(shared), mean, interval(drawn), _p(differences))


def _p(differences: Sequence[float]) -> float:
    """Returns the two-sided probability that the languages of each prompt, exchanged at random, differ so
    much.
    """
    if not any(differences):
        return 1.0
    from scipy.stats import permutation_test

    found = permutation_test(
        (np.asarray(differences, float),),  # of one sample the signs are exchanged
        np.mean,
        permutation_type="samples",
        vectorized=True,
        n_resamples=RESAMPLES,
        random_state=np.random.default_rng(SEED),  # `rng` in scipy 1.15 and later
    )
    return min(1.0, float(found.pvalue))


def holm(values: Sequence[float]) -> list[float]:
    """Returns probabilities after Holm's correction (Scandinavian Journal of Statistics 6, 1979, 65)."""
    adjusted, least = [0.0] * len(values), 0.0
    for rank, index in enumerate(sorted(range(len(values)), key=values.__getitem__)):
        least = max(least, min(1.0, (len(values) - rank) * values[index]))
        adjusted[index] = least
    return adjusted


def alpha(groups: Iterable[Iterable[Sequence[float]]]) -> float | None:
    """Returns Krippendorff's alpha of ranks (Computing Krippendorff's Alpha-Reliability, University of
    Pennsylvania, 2011) over the units of all groups, each unit the ranks that raters gave it: 1 if they
    agree, 0 as by chance. What chance does is taken from each group by itself, as ranks among two and among
    five things are not the same values. Ranks differ by how many given ones lie between them. None where no
    two raters saw one unit, or all values are equal.
    """
    from scipy.stats import rankdata

    observed = expected = 0.0
    for units in groups:
        if shared := [unit for unit in units if len(unit) > 1]:
            ranks = rankdata(np.concatenate(shared))
            own = np.split(ranks, np.cumsum([len(unit) for unit in shared])[:-1])
            observed += sum(len(unit) * np.var(unit, ddof=1) for unit in own)
            expected += len(ranks) * np.var(ranks, ddof=1)
    return float(1 - observed / expected) if expected > 0 else None
