"""Which values of a param are tried, and the way to where it stops working."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from aidl_lang.building.model import Knob
from aidl_lang.tools.ends import ends, limit


def knob(value: object, low: float | None = None, high: float | None = None, **more: object) -> Knob:
    said = {"choices": (), "step": None, "unit": "mm", "doc": None, **more}
    return Knob("k", value, low, high, **said)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("of", "expected"),
    [
        (knob(40.0, 20.0, 60.0), [20.0, 60.0]),
        (knob(20.0, 20.0, 60.0), [60.0]),
        (knob(40.0, 20.0, 63.0, step=5.0), [20.0, 60.0]),
        (knob(40.0), []),
        (knob(True), [False]),
        (knob("a", choices=("a", "b", "c")), ["b", "c"]),
        (knob(6.0, choices=(4.0, 6.0)), [4.0]),
        (knob("free"), []),
    ],
)
def test_ends(of: Knob, expected: list[object]) -> None:
    assert ends(of) == expected


def searched(of: Knob, end: float, works: Callable[[float], bool]) -> tuple[float, float, list[float]]:
    """The limit of a param, and the values that were tried."""
    search, asked = limit(of, end), list[float]()
    try:
        value = next(search)
        while True:
            asked.append(value)
            value = search.send(works(value))
    except StopIteration as done:
        return *done.value, asked


def test_what_fails_on_the_way_to_a_limit_is_the_limit() -> None:
    of = knob(40.0, 40.0, 200.0)
    works, beyond, asked = searched(of, 200.0, lambda v: v <= 150 and not 90 <= v <= 100)
    assert (works, beyond) == (89.99, 90)
    assert {v for v in asked if v < works} >= {
        round(40 + share * (works - 40), 4) for share in (0.25, 0.5, 0.75)
    }
    assert all(float(f"{v:.12g}") == v for v in asked)


@pytest.mark.parametrize(
    ("of", "end", "threshold", "expected"),
    [
        (knob(60.0, 40.0, 120.0), 120.0, 94.0, (94.0, 94.01)),
        (knob(60.0, 40.0, 120.0), 120.0, 60.0, (60.0, 60.01)),
        (knob(100.0, 10.0, 120.0), 10.0, 12.5, (12.5, 12.49)),
        (knob(3.0, 1.0, 9.0, unit=""), 9.0, 6.5, (6.0, 7.0)),
        (knob(40.0, 20.0, 60.0, step=5.0), 60.0, 52.0, (50.0, 55.0)),
        (knob(0.5, 0.0, 1.0, unit=""), 1.0, 0.75, (0.75, 0.7501)),
    ],
)
def test_limit_is_a_short_number(
    of: Knob, end: float, threshold: float, expected: tuple[float, float]
) -> None:
    sign = 1 if end > of.value else -1
    assert searched(of, end, lambda value: sign * value <= sign * threshold)[:2] == expected
