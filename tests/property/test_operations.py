"""What holds for every copy: it covers as much as its source, and lies where a matrix of its own says."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import Phase, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from aidl_lang.geometry.curves import FIELDS, Curve
from aidl_lang.geometry.solved import SolvedStructure
from aidl_lang.pipeline import Compiled
from tests.amount import tries
from tests.compiled import compiled

SHAPES = (
    "circle(center: (3, 4), radius: 5)",
    "rectangle(center: (3, 4), width: 12, height: 7)",
    "rectangle(center: (3, 4), width: 12, height: 7, angle: 20deg)",
    "rounded_rectangle(center: (1, 2), width: 14, height: 8, radius: 2)",
    "trapezoid(center: (3, 4), bottom_width: 12, top_width: 5, height: 7)",
    "triangle(a: (0, 0), b: (9, 1), c: (4, 8))",
    "polygon([(0, 0), (10, 0), (12, 5), (3, 9)])",
    "regular_polygon(center: (2, 2), radius: 6, sides: 5)",
    "star(center: (2, 2), outer_radius: 8, inner_radius: 3, points: 5)",
    "slot(center: (1, 1), length: 12, width: 4)",
    "slot(start: (1, 1), end: (8, 5), width: 3)",
    "ring(center: (1, 1), outer_radius: 7, inner_radius: 4)",
    "sector(center: (1, 1), radius: 7, start_angle: 10deg, end_angle: 100deg)",
    "ellipse(center: (3, 4), rx: 6, ry: 2, angle: 15deg)",
    "segment(center: (1, 1), radius: 7, start_angle: 200deg, end_angle: 320deg)",
)
CLOSE = 1e-7

places = st.tuples(*(st.integers(-300, 300).map(lambda n: n / 10) for _ in range(2)))
angles = st.integers(-359, 359)
profile = tries(8, phases=(Phase.explicit, Phase.generate))


@dataclass(frozen=True)
class Map:
    """p ↦ matrix · (p - about) + to, all by hand."""

    matrix: NDArray[np.float64]
    about: NDArray[np.float64]
    to: NDArray[np.float64]

    def __call__(self, p: tuple[float, float]) -> NDArray[np.float64]:
        return np.asarray(self.matrix @ (np.array(p) - self.about) + self.to)


def turn(degrees: float, about: tuple[float, float]) -> Map:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return Map(np.array([[c, -s], [s, c]]), np.array(about), np.array(about))


def reflection(a: tuple[float, float], b: tuple[float, float]) -> Map:
    way = np.subtract(b, a) / math.dist(a, b)
    return Map(2 * np.outer(way, way) - np.eye(2), np.array(a), np.array(a))


def made(text: str) -> Compiled:
    found = compiled(text)
    assert found.errors == []
    assert found.model.status == "solved"
    return found


def part(found: Compiled, name: str) -> SolvedStructure:
    return found.model.root.find(f"{found.model.root.name}.{name}")


def curves(found: Compiled, name: str) -> list[Curve]:
    return [curve for geometry in part(found, name).geometry for curve in geometry.curves()]


def assert_mapped(sources: list[Curve], copies: list[Curve], by: Map) -> None:
    """The copies are the sources moved, curve by curve."""
    turned_over = np.linalg.det(by.matrix) < 0
    scale = math.sqrt(abs(np.linalg.det(by.matrix)))
    assert [type(c) for c in sources] == [type(c) for c in copies] != []
    for a, b in zip(sources, copies, strict=True):
        for name in FIELDS[type(a)]:
            old, new = getattr(a, name), getattr(b, name)
            if isinstance(old, tuple):
                assert new == pytest.approx(by(old), abs=CLOSE)
            elif name == "angle":
                way = by.matrix @ np.array([math.cos(old), math.sin(old)])
                assert way[0] * math.sin(new) - way[1] * math.cos(new) == pytest.approx(0, abs=CLOSE)
            else:
                turned = -1 if turned_over else 1
                assert new == pytest.approx(turned * old if name == "sweep" else scale * old)


def assert_covers(found: Compiled, name: str, source: str, scale: float = 1.0) -> None:
    one, other = (found.drawing.measures[f"m.{n}"] for n in (source, name))
    assert other.area == pytest.approx(scale * scale * one.area, rel=1e-9)
    assert other.perimeter == pytest.approx(scale * one.perimeter, rel=1e-9)


@pytest.mark.parametrize("shape", SHAPES)
@profile
@given(a=places, b=places, angle=angles, scale=st.sampled_from([0.5, 1.5, 3.0]))
def test_copies_of_geometry(
    shape: str, a: tuple[float, float], b: tuple[float, float], angle: int, scale: float
) -> None:
    if math.dist(a, b) < 1:
        b = (a[0] + 5, a[1])
    found = made(f"""
        @detached assembly m {{
            solid source {{ s = {shape} }}
            solid image {{ let s = {shape}; c = mirror(s, about: line({a}, {b})) }}
            solid turned {{ let s = {shape}; c = rotate(s, {angle}deg, about: {a}) }}
            solid moved {{ let s = {shape}; c = move(s, by: {b}) }}
            solid grown {{ let s = {shape}; c = scale(s, {scale}, about: {a}) }}
            solid edited {{ c = {shape}; rotate(c, {angle}deg, about: {a}); scale(c, {scale}, about: {b}) }}
        }}""")
    source = curves(found, "source")
    grown = Map(scale * np.eye(2), np.array(a), np.array(a))
    again = turn(angle, a)
    edited = Map(scale * again.matrix, again.about, scale * (again.to - b) + b)
    for name, by, size in (
        ("image", reflection(a, b), 1.0),
        ("turned", turn(angle, a), 1.0),
        ("moved", Map(np.eye(2), np.zeros(2), np.array(b)), 1.0),
        ("grown", grown, scale),
        ("edited", edited, scale),
    ):
        assert_mapped(source, curves(found, name), by)
        assert_covers(found, name, "source", size)


@profile
@given(at=places, angle=angles, inner=places, a=places, b=places, shape=st.sampled_from(SHAPES))
def test_a_mirrored_structure(
    at: tuple[float, float],
    angle: int,
    inner: tuple[float, float],
    a: tuple[float, float],
    b: tuple[float, float],
    shape: str,
) -> None:
    if math.dist(a, b) < 1:
        b = (a[0] + 5, a[1])
    found = made(f"""
        @detached assembly m {{
            solid left at {at} rotated {angle}deg {{
                s = {shape}
                solid hand at {inner} rotated -35deg {{ t = {shape} }}
            }}
            right = mirror(left, about: line({a}, {b}))
            back = mirror(right, about: (1, 2))
        }}""")
    image = reflection(a, b)
    assert part(found, "right").frame.mirrored
    assert_mapped(curves(found, "left"), curves(found, "right"), image)
    hands = [curves(found, f"{n}.hand") for n in ("left", "right", "back")]
    assert_mapped(hands[0], hands[1], image)
    assert_mapped(hands[1], hands[2], turn(180, (1, 2)))
    assert_covers(found, "right", "left")
    assert_covers(found, "back", "left")
