"""Intervals, tests and agreement, against cases worked out by hand, published ones, and scipy."""

from __future__ import annotations

import warnings
from itertools import permutations

import numpy as np
import pytest

from aidl_eval.statistics import RESAMPLES, SEED, Case, alpha, by_prompt, compared, holm, interval


def cases(*values: float, prompt: str = "") -> list[Case]:
    return [Case(prompt or f"p{n}", value) for n, value in enumerate(values)]


def test_interval_as_scipy_draws_it() -> None:
    from scipy import stats

    values = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0]
    expected = stats.bootstrap(
        (values,), np.mean, n_resamples=RESAMPLES, method="percentile", rng=np.random.default_rng(SEED)
    ).confidence_interval
    assert interval(cases(*values)) == pytest.approx((expected.low, expected.high), abs=0.05)


def test_interval_of_two_prompts() -> None:
    """Of the draws (0, 0), (0, 8), (8, 0), (8, 8) the outer two are a quarter each, far more than 2.5 %."""
    assert interval(cases(0.0, 8.0)) == (0.0, 8.0)


def test_prompts_are_drawn_whole() -> None:
    """A hundred equal runs of each of two prompts tell no more than one run of each."""
    many = cases(*[0.0] * 100, prompt="a") + cases(*[1.0] * 100, prompt="b")
    assert interval(many) == (0.0, 1.0)
    alone = interval(cases(*[0.0, 1.0] * 50, prompt="a"))
    assert alone is not None
    assert alone == pytest.approx((0.4, 0.6), abs=0.011)  # the binomial's outer 2.5 %


def test_interval_of_a_share_of_several_things() -> None:
    """1 of 2 and 3 of 3: the draws give 2/4, 4/5 and 6/6."""
    assert interval([Case("a", 1, 2), Case("b", 3, 3)]) == (0.5, 1.0)


@pytest.mark.parametrize("few", [[], cases(1.0), [Case("a", 0, 0), Case("b", 1, 2)]])
def test_too_few_have_no_interval(few: list[Case]) -> None:
    assert interval(few) is None


def test_figures_by_prompt() -> None:
    found = by_prompt([Case("a", 1, 2), Case("a", 3, 6), Case("b", 2), Case("c", 0, 0)])
    assert found == {"a": 0.5, "b": 2.0}


def test_comparison_worked_out_by_hand() -> None:
    """Differences 1, 1, 1, 0: of 16 patterns of signs 2 give a mean of 3/4 or more, so p is 2 * 2 / 16."""
    first, second = {"a": 1.0, "b": 1, "c": 1, "d": 0, "only": 9}, {"a": 0.0, "b": 0, "c": 0, "d": 0}
    found = compared(first, second)
    assert found is not None
    assert (found.prompts, found.difference, found.p) == (4, 0.75, 0.25)
    turned = compared(second, first)
    assert turned is not None
    assert (turned.difference, turned.p) == (-0.75, 0.25)


def test_comparison_agrees_with_wilcoxon() -> None:
    """Where differences are their own ranks the permutation test is Wilcoxon's."""
    from scipy import stats

    first = {f"p{n}": float(d) for n, d in enumerate((1, 2, -3, 4, 5, 6, 7, -8, 9, 10))}
    found = compared(first, dict.fromkeys(first, 0.0))
    assert found is not None
    assert found.p == pytest.approx(stats.wilcoxon(list(first.values()), method="exact").pvalue)


def test_many_prompts_are_compared_at_random_and_alike_each_time() -> None:
    from scipy import stats

    first = {f"p{n}": (-1.0) ** n * n + 4 for n in range(36)}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = [compared(first, dict.fromkeys(first, 0.0)) for _ in range(2)]
    assert found[0] == found[1] is not None
    t_test = stats.ttest_1samp(list(first.values()), 0).pvalue
    assert found[0] is not None
    assert found[0].p == pytest.approx(t_test, abs=0.03)


def test_comparisons_of_too_little() -> None:
    assert compared({"a": 1.0}, {"b": 1.0}) is None
    one = compared({"a": 1.0}, {"a": 0.5})
    assert one is not None
    assert (one.prompts, one.difference, one.interval, one.p) == (1, 0.5, None, None)
    same = compared({"a": 1.0, "b": 2.0}, {"a": 1.0, "b": 2.0})
    assert same is not None
    assert same.p == 1.0


def test_holm_worked_out_by_hand() -> None:
    """0.01 by 4, 0.02 by 3, 0.03 by 2 (which is 0.06 already), 0.5 by 1."""
    assert holm([0.5, 0.01, 0.03, 0.02]) == pytest.approx([0.5, 0.04, 0.06, 0.06])
    assert holm([]) == []


# --- Krippendorff's alpha ---------------------------------------------------------------------------

_ = None
OBSERVERS = (
    (1, 2, 3, 3, 2, 1, 4, 1, 2, _, _, _),
    (1, 2, 3, 3, 2, 2, 4, 1, 2, 5, _, 3),
    (_, 3, 3, 3, 2, 3, 4, 2, 2, 5, 1, _),
    (1, 2, 3, 3, 2, 4, 4, 1, 2, 5, 1, _),
)
"""Krippendorff 2011, part C: four observers, twelve units, some values missing."""
UNITS = [[value for value in unit if value is not None] for unit in zip(*OBSERVERS, strict=True)]


def test_published_value_of_agreement() -> None:
    assert alpha([UNITS]) == pytest.approx(0.815, abs=5e-4)


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


def test_agreement_on_random_units_as_by_definition() -> None:
    random = np.random.default_rng(5)
    for _number in range(20):
        units = [list(random.integers(1, 5, random.integers(0, 5)).astype(float)) for _unit in range(12)]
        assert alpha([units]) == pytest.approx(by_definition(units))


def test_ends_of_agreement() -> None:
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
