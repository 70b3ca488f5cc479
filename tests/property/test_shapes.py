"""Area and perimeter of shapes of the library, by every constructor, for random sizes, against the closed
forms of `shapes.md`. Figures of Bézier curves are integrated along the solved curves instead.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from hypothesis import Phase, given
from hypothesis import strategies as st

from aidl_lang.checking import library
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import reference
from tests.amount import tries
from tests.compiled import json_of, model

SHAPES = r"(arches|arcs|corners|figures|polygons|profiles|quadrilaterals|rectangles|rounds|triangles|wheels)"
"""The library's files of shapes; paths, curves, gears, letters and hardware have tests of their own."""

INTERNAL = frozenset({"anchor", "width_to", "length_ab", "points"})
"""Parameters of overloads that others stand on, and of `polygon` and `polyline`, whose corners are a list."""

Draw: TypeAlias = Callable[[float, float], float]
Measures: TypeAlias = tuple[float, float]

tau = 2 * math.pi
hypot, sin, cos, asin = math.hypot, math.sin, math.cos, math.asin


# --- What rows of the table use: area and perimeter ----------------------------------------------------


def polygon(*corners: tuple[float, float]) -> Measures:
    """By the shoelace formula."""
    pairs = list(zip(corners, corners[1:] + corners[:1], strict=True))
    area = sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in pairs) / 2
    return abs(area), sum(hypot(x1 - x0, y1 - y0) for (x0, y0), (x1, y1) in pairs)


def triangle(a: float, b: float, c: float) -> Measures:
    """By Heron's formula."""
    s = (a + b + c) / 2
    return math.sqrt(s * (s - a) * (s - b) * (s - c)), 2 * s


def star(outer: float, inner: float, tips: int) -> Measures:
    edge = math.sqrt(outer**2 + inner**2 - 2 * outer * inner * cos(math.pi / tips))
    return tips * outer * inner * sin(math.pi / tips), 2 * tips * edge


def rim(a: float, b: float) -> float:
    """The perimeter of an ellipse: the rectangle rule converges exponentially for a periodic function."""
    t = np.arange(2000) * tau / 2000
    return float(np.hypot(a * np.sin(t), b * np.cos(t)).sum() * tau / 2000)


def segment(r: float, sweep: float) -> Measures:
    """Of a disc cut off by the chord under an angle in radians."""
    return r**2 / 2 * (sweep - sin(sweep)), r * sweep + 2 * r * sin(sweep / 2)


def slot(between: float, width: float) -> Measures:
    return between * width + math.pi * width**2 / 4, 2 * between + math.pi * width


def gothic(w: float, rise: float) -> Measures:
    """Of what lies over the springing of a pointed arch: a triangle and a segment on each of its sides; the
    length of its two arcs.
    """
    side = hypot(w / 2, rise)
    lean = math.pi / 2 - math.atan2(rise, w / 2)  # of the side, to the upright in which its arc begins
    r = side / (2 * sin(lean))
    return w * rise / 2 + 2 * segment(r, 2 * lean)[0], 4 * r * lean


def openings(outer: float, hub: float, half: float, spokes: int) -> Measures:
    """All of a wheel: each is the sector between two spokes, less what the halves of both take of it."""
    wide, narrow = asin(half / outer), asin(half / hub)

    def taken(radius: float, lean: float) -> float:
        return radius**2 * lean / 2 + half * radius * cos(lean) / 2

    area = math.pi / spokes * (outer**2 - hub**2) - 2 * (taken(outer, wide) - taken(hub, narrow))
    edges = outer * (tau / spokes - 2 * wide) + hub * (tau / spokes - 2 * narrow)
    return spokes * area, spokes * (edges + 2 * (outer * cos(wide) - hub * cos(narrow)))


def arrow(length: float, w: float, head: float, wide: float) -> Measures:
    return (length - head) * w + head * wide / 2, 2 * (length - head) + wide + 2 * hypot(head, wide / 2)


def cubics(*curves: Iterable[Iterable[float]]) -> Measures:
    """The area that cubic Béziers sweep about the origin, and their length, by Gauss's rule."""
    places, weights = np.polynomial.legendre.leggauss(200)
    t = (places[:, None] + 1) / 2
    u = 1 - t
    area = length = 0.0
    for curve in curves:
        feet = np.array(list(curve), float)
        p = u**3 * feet[0] + 3 * t * u**2 * feet[1] + 3 * t**2 * u * feet[2] + t**3 * feet[3]
        legs = np.diff(feet, axis=0)
        v = 3 * (u**2 * legs[0] + 2 * t * u * legs[1] + t**2 * legs[2])
        area += float(weights @ (p[:, 0] * v[:, 1] - p[:, 1] * v[:, 0]) / 4)
        length += float(weights @ np.hypot(*v.T) / 2)
    return area, length


# --- The table ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Form:
    """A row: a call, the sizes that are drawn for it, its area and perimeter."""

    call: str
    sizes: str
    measures: str

    def __call__(self, draw: Draw) -> tuple[str, float, float]:
        names: dict[str, Any] = {**vars(math), **globals()}
        for step in self.sizes.split("; "):
            if ": " in step:
                words, _, ends = step.partition(": ")
                for word in words.split(", "):
                    low, high = (float(eval(end, names)) for end in ends.split(".."))
                    names[word] = draw(low, high)
            else:
                exec(step, names)
        call = re.sub(r"\{(.*?)\}", lambda found: str(eval(found[1], names)), self.call)
        area, perimeter = eval(self.measures, names)
        return call, area, perimeter


def forms() -> Iterable[Form]:
    for row in Path(__file__).with_name("shapes.md").read_text("utf-8").splitlines():
        if row.startswith("| `"):
            call, sizes, measures = (cell.strip(" `") for cell in row.strip("|").split("|"))
            words = re.search(r"\w+(/\w+)+", call)
            for word in words[0].split("/") if words else [""]:
                yield Form(call.replace(words[0], word) if words else call, sizes, measures)


FORMS = list(forms())
SUPERELLIPSE = math.gamma(1 + 1 / 4) ** 2 / math.gamma(1 + 2 / 4)
"""The share of its box that a superellipse of exponent 4 fills."""

BEZIER_FIGURES: dict[str, tuple[float | None, float]] = {
    "heart(width: {w}, height: {h})": (None, 0),
    "egg(width: {w}, height: {h})": (math.pi / 4, 5e-4),
    "squircle(width: {w}, height: {h})": (SUPERELLIPSE, 7e-3),
    "leaf(width: {w}, height: {h})": (None, 0),
    "cloud(width: {w}, height: {h})": (None, 0),
    "squircle(size: {w})": (SUPERELLIPSE, 7e-3),
}
"""The share of its box that what the figure stands for fills, and how near it comes."""


# --- The tests -----------------------------------------------------------------------------------------


def drawing_from(data: st.DataObject) -> Draw:
    # A few decimals, so that the program that fails can be read.
    return lambda low, high: round(data.draw(st.floats(low, high, allow_nan=False)), 3)


few = tries(3, phases=(Phase.explicit, Phase.generate))


def compiled(call: str) -> dict[str, Any]:
    text = f"solid s {{ body = {call} }}"
    found = model(text)
    assert found.ok, (call, found.diagnostics)
    assert not found.diagnostics, (call, [d.message for d in found.diagnostics])
    return json_of(text)


def test_table_is_read_whole() -> None:
    assert len(FORMS) > 170


@pytest.mark.parametrize("make", FORMS, ids=lambda form: f"{call_of(form.call)[0]}-{FORMS.index(form)}")
@few
@given(data=st.data())
def test_area_and_perimeter(make: Form, data: st.DataObject) -> None:
    draw = drawing_from(data)
    call, area, perimeter = make(draw)
    if takes_angle(call) and draw(0, 1) > 0.5:
        call = f"{call.removesuffix(')')}, angle: {draw(-180, 180)})"
    region = compiled(call)["regions"]["s"]
    assert region["area"] == pytest.approx(area, rel=1e-7), call
    assert region["perimeter"] == pytest.approx(perimeter, rel=1e-7), call


@pytest.mark.parametrize("make", FORMS, ids=lambda form: f"{call_of(form.call)[0]}-{FORMS.index(form)}")
def test_a_shape_is_held_at_the_middle_of_its_box_or_says_where(make: Form) -> None:
    call, _, _ = make(lambda low, high: round(low + 0.4 * (high - low), 2))
    name, arguments = call_of(call)
    root = compiled(call)["root"]
    body = root["geometry"]["body"].get("params", {})
    if "center" not in body or any(re.search(r"_(left|right|center)$", each) for each in arguments):
        return
    box = root["bb"]
    middle = ((box["left"] + box["right"]) / 2, (box["bottom"] + box["top"]) / 2)
    entry = reference().find(name)
    if body["center"] != pytest.approx(middle, abs=1e-6):
        assert "`center`" in entry.doc.lies, call


@pytest.mark.parametrize("call", BEZIER_FIGURES)
@few
@given(data=st.data())
def test_figures_of_bezier_curves(call: str, data: st.DataObject) -> None:
    draw = drawing_from(data)
    w, h = draw(5, 50), draw(5, 50)
    share, tolerance = BEZIER_FIGURES[call]
    document = compiled(call.format(w=w, h=h))
    h = h if "{h}" in call else w
    box, region = document["root"]["bb"], document["regions"]["s"]
    assert (box["right"] - box["left"], box["top"] - box["bottom"]) == pytest.approx((w, h))
    parts = document["root"]["geometry"]["body"]["parts"].values()
    curves = [part["points"] for part in parts if part["type"] == "bezier"]
    foot = [curves[-1][3]] * 2 + [curves[0][0]] * 2
    area, length = cubics(*curves, foot)
    assert (region["area"], region["perimeter"]) == pytest.approx((abs(area), length), rel=1e-5)
    assert share is None or region["area"] == pytest.approx(share * w * h, rel=tolerance)


# --- Every constructor is in the table -------------------------------------------------------------------


@functools.cache
def signatures() -> list[tuple[str, frozenset[str], frozenset[str]]]:
    """Of each overload of a public shape: its name, the parameters that it needs, and all of them."""
    found = []
    for name, overloads in library.load().callables.items():
        nodes = [s.node for s in overloads if s.kind in (ast.ShapeDefinition, ast.FunctionDefinition)]
        nodes = [n for n in nodes if re.search(rf"\b{SHAPES}\.aidl$", n.span.source.name)]
        if name == "cross" or any(n.doc for n in nodes):
            for parameters in ([(p.name.text, p.default) for p in n.parameters] for n in nodes):
                needed = frozenset(word for word, default in parameters if default is None)
                found.append((name, needed, frozenset(word for word, _ in parameters)))
    return found


def call_of(text: str) -> tuple[str, frozenset[str]]:
    """The name and the named arguments of a call."""
    return text.partition("(")[0], frozenset(re.findall(r"(\w+): ", text))


def takes_angle(text: str) -> bool:
    name, names = call_of(text)
    fits = [all_ for n, needed, all_ in signatures() if n == name and needed <= names <= all_]
    return "angle" not in names and any("angle" in all_ for all_ in fits)


def unmeasured() -> list[str]:
    """Returns the constructors of public shapes that no row of the tables calls."""
    calls = {call_of(text) for text in [form.call for form in FORMS] + list(BEZIER_FIGURES)}
    known = signatures()
    assert len(known) > 100
    return [
        f"{name}({', '.join(sorted(needed))})"
        for name, needed, every in known
        if not needed & INTERNAL
        and not any(name == called and needed <= given_ <= every for called, given_ in calls)
    ]
