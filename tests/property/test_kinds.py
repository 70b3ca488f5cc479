"""Each kind of curve of the registry keeps relations along its whole curve: a kind that one of them does not
know fails here.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from aidl_lang.checking.types import PRIMITIVES, PUBLIC
from tests.compiled import compiled, json_of
from tests.property.test_paths import curve

CURVES = [kind for kind in PUBLIC if kind != "point"]
OPEN = [kind for kind in CURVES if "end" in PRIMITIVES[kind].types]


def sample(kind: str, x: float, y: float) -> str:
    return PRIMITIVES[kind].sample.format(x=x, y=y)


def drawn(text: str) -> dict[str, NDArray[Any]]:
    """Returns points of each curve of a program without errors, close together, from its start on."""
    assert compiled(text).errors == []
    return {name: np.array(points(geometry)) for name, geometry in json_of(text)["root"]["geometry"].items()}


def points(geometry: dict[str, Any]) -> list[complex]:
    if parts := geometry.get("parts"):
        return [p for part in parts.values() for p in points(part)]
    return [curve(geometry, k / 400) for k in range(401)]


def farthest(a: NDArray[Any], b: NDArray[Any]) -> float:
    """Returns how far a point of either is from the other."""
    between = np.abs(a[:, None] - b)
    return float(max(between.min(axis=0).max(), between.min(axis=1).max()))


@pytest.mark.parametrize("kind", CURVES)
@pytest.mark.parametrize("relation", ["symmetric", "mirror_of"])
def test_two_of_a_kind_are_mirror_images(kind: str, relation: str) -> None:
    found = drawn(
        f"drawing d {{ a = {sample(kind, 12, 8)}; b = {sample(kind, -31, 11)}\n"
        f"constrain {{ {relation}(a, b, about: y_axis) }} }}"
    )
    assert farthest(found["a"], -found["b"].conjugate()) < 1e-6


@pytest.mark.parametrize("kind", CURVES)
def test_two_of_a_kind_are_images_about_a_point(kind: str) -> None:
    found = drawn(
        f"drawing d {{ a = {sample(kind, 12, 8)}; b = {sample(kind, -31, -11)}\n"
        "constrain { symmetric(a, b, about: (2, 3)) } }"
    )
    assert farthest(found["a"], 4 + 6j - found["b"]) < 1e-6


@pytest.mark.parametrize("kind", OPEN)
@pytest.mark.parametrize(("relation", "turn"), [("tangent", 1), ("perpendicular", 1j)])
def test_a_line_goes_on_from_its_end(kind: str, relation: str, turn: complex) -> None:
    found = drawn(
        f"drawing d {{ a = {sample(kind, 12, 8)}; b = line(a.end, a.end + (6, 2))\n"
        f"constrain {relation}(a, b) }}"
    )
    ahead = found["a"][-1] - found["a"][-2]
    assert (turn * ahead.conjugate() * (found["b"][-1] - found["b"][0])).imag == pytest.approx(0, abs=0.02)


@pytest.mark.parametrize("kind", CURVES)
def test_what_it_encloses_is_measured(kind: str) -> None:
    closing = "b = line(a.end, fixed((15, -20))); c = line(b.end, a.start)" if kind in OPEN else ""
    found = drawn(
        f"shape outline() {{ a = {sample(kind, 12, 8)}; {closing} }}\n"
        "solid s { of = outline(); constrain area(of) == 150 }"
    )
    outline = found["of"]
    around = (outline.conjugate() * np.roll(outline, -1)).imag.sum() / 2
    assert abs(around) == pytest.approx(150, rel=1e-3)


@pytest.mark.parametrize("kind", CURVES)
def test_places_along_it_are_found(kind: str) -> None:
    found = drawn(
        f"drawing d {{ a = {sample(kind, 12, 8)}; b = line(a.edge_point(along: 7), fixed((0, 0))) }}"
    )
    after = np.abs(np.diff(found["a"])).cumsum()
    place = found["a"][1:][np.searchsorted(after, 7)]
    assert abs(place - found["b"][0]) == pytest.approx(0, abs=0.2)
