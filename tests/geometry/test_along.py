"""Members along free curves stand at equal lengths of them, by the lengths of fine chords."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.geometry.curves import Circle
from aidl_lang.geometry.solved import SolvedGeometry

FINE = 200_001


def solved(text: str) -> dict[str, SolvedGeometry]:
    compiled = pipeline.compile(SourceFile("test.aidl", text))
    assert compiled.model is not None
    assert not [d for d in compiled.diagnostics if d.is_error], compiled.diagnostics
    return {g.name: g for s in compiled.model.root.walk() for g in s.geometry}


def chords(way: SolvedGeometry) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points of a curve, and its length up to each."""
    spots = np.concatenate([c.points(np.linspace(0, 1, FINE)) for c in way.curves()])
    return spots, np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(spots, axis=0).T))])


def ways(found: dict[str, SolvedGeometry], count: int) -> tuple[list[float], float]:
    """The lengths of the curve at which the members stand, and that of the whole."""
    spots, lengths = chords(found["way"])
    at = []
    for k in range(count):
        (circle,) = found[f"dot[{k}]"].curves()
        assert isinstance(circle, Circle)
        away = np.hypot(*(spots - circle.center).T)
        assert away.min() < 1e-4 * lengths[-1]
        at.append(float(lengths[away.argmin()]))
    return at, float(lengths[-1])


OPEN = [
    "bezier((0, 0), (10, 60), (50, -20), (80, 30))",
    "bezier((0, 0), (0, 0), (50, 90), (80, 30))",
    "bezier((0, 0), (90, 50), (-10, 50), (80, 0))",
    "spline([(0, 0), (30, -20), (60, 10), (65, 40)])",
    "wave((0, 0), (90, 10), 8, waves: 3)",
    "spiral(start_radius: 5, end_radius: 30, turns: 3)",
    "path((0, 0), line_to(30, 0), bezier_to((40, 0), (40, 20), (60, -10)), arc_to((80, -10), radius: 12))",
    "cord((0, 0), (60, 20), sag: 25)",
]


@pytest.mark.parametrize("curve", OPEN)
def test_members_stand_at_equal_lengths(curve: str) -> None:
    found = solved(f"drawing d {{ way = {curve}; dot = along(circle(radius: 1), way, n: 9) }}")
    at, whole = ways(found, 9)
    assert at == pytest.approx([whole * k / 8 for k in range(9)], abs=1e-4 * whole)


@pytest.mark.parametrize(
    "curve",
    ["ellipse(rx: 40, ry: 12, angle: 20deg)", "spline([(0, 0), (30, 40), (60, 5), (80, 50)], closed: true)"],
)
def test_closed_curves_have_no_last_member_on_the_first(curve: str) -> None:
    found = solved(f"drawing d {{ way = {curve}; dot = along(circle(radius: 1), way, pitch: 7) }}")
    whole = float(chords(found["way"])[1][-1])
    count = round(whole / 7)
    assert f"dot[{count}]" not in found
    at, _ = ways(found, count)
    assert [b - a for a, b in pairwise(at)] == pytest.approx([whole / count] * (count - 1), rel=1e-3)


def test_members_follow_a_curve_that_bends() -> None:
    """The places at the first guesses are followed by Newton's method."""
    text = """drawing d {
        way = bezier(guess((0, 0)), guess((10, 40)), guess((50, 40)), guess((60, 0)))
        dot = along(circle(radius: 1), way, n: 7, inset: 5)
        constrain { way.p0 == (0, 0); way.p1 == (12, 46); way.p2 == (48, 36); way.p3 == (64, 3) }
    }"""
    at, whole = ways(solved(text), 7)
    assert at == pytest.approx([5 + (whole - 10) * k / 6 for k in range(7)], abs=2e-4 * whole)


def test_members_turn_with_the_curve_or_stay_upright() -> None:
    curve = "bezier((0, 0), (10, 60), (50, -20), (80, 30))"
    text = "drawing d {{ way = {}; bar = along(line((0, 0), (2, 0)), way, n: 5{}) }}"
    headings = {}
    for more in ("", ", turn: false"):
        found = solved(text.format(curve, more))
        spots, lengths = chords(found["way"])
        for k in range(5):
            start, end = (np.array(found[f"bar[{k}]"].values[name]) for name in ("start", "end"))
            i = min(max(int(np.searchsorted(lengths, lengths[-1] * k / 4)), 1), len(spots) - 2)
            ahead = spots[i + 1] - spots[i - 1]
            headings[more, k] = math.degrees(math.atan2(*(end - start)[::-1]) - math.atan2(*ahead[::-1]))
            if more:
                assert (end - start).tolist() == pytest.approx([2, 0])
    assert [headings["", k] for k in range(5)] == pytest.approx([0] * 5, abs=0.01)
