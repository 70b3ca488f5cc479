"""What stands in for parts of numpy is what numpy says."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aidl_lang.solver.arrays import each_once, others, scattered

NUMBERS = st.lists(st.integers(-5, 5), max_size=12)


@settings(deadline=None)
@given(NUMBERS)
def test_distinct_numbers(numbers):
    array = np.array(numbers, dtype=np.int64)
    assert each_once(array).tolist() == np.unique(array).tolist()


@settings(deadline=None)
@given(st.integers(0, 12), st.data())
def test_others(count, data):
    gone = data.draw(st.lists(st.integers(0, count - 1), max_size=count) if count else st.just([]))
    assert others(count, iter(gone)).tolist() == np.setdiff1d(np.arange(count), gone).tolist()


@pytest.mark.parametrize("seed", [0, 1, 7])
def test_scattered_numbers_are_spread_evenly_and_follow_no_rule(seed):
    found = scattered(4000, seed)
    assert found.tolist() == scattered(4000, seed).tolist()
    assert (np.abs(found) <= 1.0).all()
    assert abs(found.mean()) < 0.03
    assert abs(found.var() - 1 / 3) < 0.02
    assert len(set(found.tolist())) == 4000
    followers = np.corrcoef([found[:-2], found[1:-1], found[2:]])
    assert (np.abs(followers - np.eye(3)) < 0.06).all()
    assert scattered(8, seed).tolist() != scattered(8, seed + 1).tolist()
