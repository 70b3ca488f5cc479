"""Labels look for places that are free."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.export.overlay import Taken
from aidl_lang.geometry.curves import Bounds

_SPANS = st.tuples(st.integers(-20, 20), st.integers(1, 20)).map(lambda at: (at[0], at[0] + at[1]))


@st.composite
def boxes(draw: st.DrawFn) -> Bounds:
    (left, right), (bottom, top) = draw(_SPANS), draw(_SPANS)
    return float(left), float(bottom), float(right), float(top)


@given(st.lists(boxes(), max_size=200), boxes())
def test_what_is_covered_is_the_sum_over_all_that_is_taken(others: list[Bounds], box: Bounds) -> None:
    taken = Taken()
    for other in others:
        taken.add(other)
    covered = 0.0
    for left, bottom, right, top in others:
        wide = max(0.0, min(right, box[2]) - max(left, box[0]))
        covered += wide * max(0.0, min(top, box[3]) - max(bottom, box[1]))
    assert taken.overlap(box) == covered
