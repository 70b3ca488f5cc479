"""Area and perimeter of the library's shapes against closed forms, by every constructor, for random sizes.

Each entry of `FORMS` writes a call with sizes that it draws, and says what area and perimeter must come out.
The forms are written from geometry, not from the library. Figures of Bézier curves are integrated numerically
along the solved curves instead, and compared with what they stand for.
"""

from __future__ import annotations

import functools
import json
import math
import re
from collections.abc import Callable, Iterable
from typing import Any, TypeAlias

import numpy as np
import pytest
from hypothesis import Phase, given
from hypothesis import strategies as st

import aidl_lang
from aidl_lang import parser
from aidl_lang.checking import library
from aidl_lang.common.source import SourceFile
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import reference
from tests.amount import tries

FILES = (
    "arches",
    "arcs",
    "corners",
    "figures",
    "polygons",
    "profiles",
    "quadrilaterals",
    "rectangles",
    "rounds",
    "triangles",
    "wheels",
)
"""The library's files of shapes; paths, curves, gears, letters and hardware have tests of their own."""

INTERNAL = frozenset({"anchor", "width_to", "length_ab", "points"})
"""Parameters of overloads that others stand on, and of `polygon` and `polyline`, which have a test below."""

Draw: TypeAlias = Callable[[float, float], float]
Form: TypeAlias = Callable[[Draw], tuple[str, float, float]]
"""Draws sizes; gives the call, the area and the perimeter."""

tau = 2 * math.pi
hypot, sin, cos, tan, sqrt = math.hypot, math.sin, math.cos, math.tan, math.sqrt
asin, acos, radians, degrees = math.asin, math.acos, math.radians, math.degrees


def polygon_measures(points: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """Area (by the shoelace formula) and perimeter of a polygon."""
    corners = list(points)
    pairs = list(zip(corners, corners[1:] + corners[:1], strict=True))
    area = sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in pairs) / 2
    return abs(area), sum(hypot(x1 - x0, y1 - y0) for (x0, y0), (x1, y1) in pairs)


# --- Rectangles ------------------------------------------------------------------------------------

FORMS: list[Form] = []


def form(make: Form) -> Form:
    FORMS.append(make)
    return make


ANCHORS = (
    "center",
    "bottom_left",
    "bottom_right",
    "top_right",
    "top_left",
    "bottom_center",
    "right_center",
    "top_center",
    "left_center",
)


def anchored(anchor: str) -> list[Form]:
    """The shapes that can be placed by a point of their border."""

    def rectangle(n: Draw) -> tuple[str, float, float]:
        w, h = n(1, 50), n(1, 50)
        return f"rectangle({anchor}: (3, 4), width: {w}, height: {h})", w * h, 2 * (w + h)

    def rounded(n: Draw) -> tuple[str, float, float]:
        w, h = n(4, 50), n(4, 50)
        r = n(0.1, 0.45 * min(w, h))
        call = f"rounded_rectangle({anchor}: (3, 4), width: {w}, height: {h}, radius: {r})"
        return call, w * h - (4 - math.pi) * r**2, 2 * (w + h) - (8 - tau) * r

    def chamfered(n: Draw) -> tuple[str, float, float]:
        w, h = n(4, 50), n(4, 50)
        c = n(0.1, 0.45 * min(w, h))
        call = f"chamfered_rectangle({anchor}: (3, 4), width: {w}, height: {h}, chamfer: {c})"
        return call, w * h - 2 * c**2, 2 * (w + h) - (8 - 4 * sqrt(2)) * c

    def square(n: Draw) -> tuple[str, float, float]:
        a = n(1, 50)
        return f"square({anchor}: (3, 4), size: {a})", a**2, 4 * a

    has_square = anchor == "center" or not anchor.endswith("center")
    return [rectangle, rounded, chamfered, *([square] if has_square else [])]


FORMS += [make for anchor in ANCHORS for make in anchored(anchor)]


@form
def between_corners(n: Draw) -> tuple[str, float, float]:
    x, y, w, h = n(-9, 9), n(-9, 9), n(1, 50), n(1, 50)
    return f"rectangle(bottom_left: ({x}, {y}), top_right: ({x + w}, {y + h}))", w * h, 2 * (w + h)


@form
def between_the_other_corners(n: Draw) -> tuple[str, float, float]:
    x, y, w, h = n(-9, 9), n(-9, 9), n(1, 50), n(1, 50)
    return f"rectangle(top_left: ({x}, {y}), bottom_right: ({x + w}, {y - h}))", w * h, 2 * (w + h)


@form
def any_two_corners(n: Draw) -> tuple[str, float, float]:
    x0, y0, x1, y1 = n(-9, 9), n(10, 20), n(10, 20), n(-9, 9)
    w, h = x1 - x0, y0 - y1
    return f"rectangle(start: ({x1}, {y1}), end: ({x0}, {y0}))", w * h, 2 * (w + h)


@form
def by_sides(n: Draw) -> tuple[str, float, float]:
    left, bottom, w, h = n(-9, 9), n(-9, 9), n(1, 50), n(1, 50)
    call = f"rectangle(left: {left}, right: {left + w}, bottom: {bottom}, top: {bottom + h})"
    return call, w * h, 2 * (w + h)


@form
def by_left_and_bottom(n: Draw) -> tuple[str, float, float]:
    w, h = n(1, 50), n(1, 50)
    return f"rectangle(left: 2, bottom: 3, width: {w}, height: {h})", w * h, 2 * (w + h)


@form
def by_left_and_top(n: Draw) -> tuple[str, float, float]:
    w, h = n(1, 50), n(1, 50)
    return f"rectangle(left: 2, top: 3, width: {w}, height: {h})", w * h, 2 * (w + h)


@form
def four_radii_by_name(n: Draw) -> tuple[str, float, float]:
    w, h, r, s = n(10, 50), n(10, 50), n(0, 4.5), n(0, 4.5)
    radii = f"radius_bottom_left: {r}, radius_bottom_right: {s}, radius_top_right: 0, radius_top_left: {r}"
    cut = 1 - math.pi / 4
    area = w * h - cut * (2 * r**2 + s**2)
    return f"rounded_rectangle(width: {w}, height: {h}, {radii})", area, 2 * (w + h) - 2 * cut * (2 * r + s)


def rounded_by_sides(place: Callable[[float, float], str]) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        w, h, r = n(10, 50), n(10, 50), n(0.1, 4.5)
        call = f"rounded_rectangle({place(w, h)}, radius: {r})"
        return call, w * h - (4 - math.pi) * r**2, 2 * (w + h) - (8 - tau) * r

    return make


BY_SIDES: list[Callable[[float, float], str]] = [
    lambda w, h: f"left: -3, right: {w - 3}, bottom: 2, top: {h + 2}",
    lambda w, h: f"left: -3, bottom: 2, width: {w}, height: {h}",
    lambda w, h: f"left: -3, top: 2, width: {w}, height: {h}",
]
FORMS += [rounded_by_sides(place) for place in BY_SIDES]


@form
def rectangle_with_a_radius(n: Draw) -> tuple[str, float, float]:
    w, h, r = n(10, 50), n(10, 50), n(0.1, 4.5)
    call = f"rectangle(width: {w}, height: {h}, radius: {r})"
    return call, w * h - (4 - math.pi) * r**2, 2 * (w + h) - (8 - tau) * r


@form
def four_radii(n: Draw) -> tuple[str, float, float]:
    w, h = n(10, 50), n(10, 50)
    radii = [n(0, 4.5) for _ in range(4)]
    call = f"rounded_rectangle(width: {w}, height: {h}, radii: {radii})"
    cut = 1 - math.pi / 4
    return call, w * h - cut * sum(r**2 for r in radii), 2 * (w + h) - 2 * cut * sum(radii)


@form
def frame(n: Draw) -> tuple[str, float, float]:
    w, h = n(10, 50), n(10, 50)
    t = n(0.5, 4)
    area = w * h - (w - 2 * t) * (h - 2 * t)
    return f"frame(width: {w}, height: {h}, thickness: {t})", area, 4 * (w + h) - 8 * t


# --- Triangles -------------------------------------------------------------------------------------


def from_sides(a: float, b: float, c: float) -> tuple[float, float]:
    """Heron's formula."""
    s = (a + b + c) / 2
    return sqrt(s * (s - a) * (s - b) * (s - c)), 2 * s


@form
def triangle_of_corners(n: Draw) -> tuple[str, float, float]:
    a, b, c = (n(-9, 0), n(-9, 0)), (n(2, 9), n(-9, 0)), (n(-9, 9), n(2, 9))
    return f"triangle(a: {a}, b: {b}, c: {c})", *polygon_measures([a, b, c])


def triangle_on_a_base(place: str) -> Form:
    def made(n: Draw) -> tuple[str, float, float]:
        b, h = n(1, 50), n(1, 50)
        return f"triangle({place}base: {b}, height: {h})", b * h / 2, b + 2 * hypot(b / 2, h)

    return made


FORMS += [triangle_on_a_base(place) for place in ("", "bottom_center: (3, 4), ")]


@form
def triangle_of_sides(n: Draw) -> tuple[str, float, float]:
    ab, bc = n(5, 50), n(5, 50)
    ca = n(abs(ab - bc) + 1, ab + bc - 1)
    return f"triangle(ab: {ab}, bc: {bc}, ca: {ca})", *from_sides(ab, bc, ca)


@form
def triangle_of_the_textbook(n: Draw) -> tuple[str, float, float]:
    a, b = n(5, 50), n(5, 50)
    c = n(abs(a - b) + 1, a + b - 1)
    return f"triangle(a: {a}, b: {b}, c: {c})", *from_sides(a, b, c)


@form
def triangle_of_two_sides(n: Draw) -> tuple[str, float, float]:
    ab, ca, angle = n(5, 50), n(5, 50), n(10, 170)
    bc = sqrt(ab**2 + ca**2 - 2 * ab * ca * cos(radians(angle)))
    return f"triangle(ab: {ab}, angle_a: {angle}, ca: {ca})", ab * ca * sin(radians(angle)) / 2, ab + bc + ca


@form
def triangle_of_two_angles(n: Draw) -> tuple[str, float, float]:
    ab, a, b = n(5, 50), n(10, 80), n(10, 80)
    ratio = ab / sin(radians(180 - a - b))
    sides = (ab, ratio * sin(radians(a)), ratio * sin(radians(b)))
    return f"triangle(angle_a: {a}, ab: {ab}, angle_b: {b})", *from_sides(*sides)


@form
def triangle_of_one_side(n: Draw) -> tuple[str, float, float]:
    a = n(1, 50)
    return f"triangle(side: {a})", sqrt(3) / 4 * a**2, 3 * a


@form
def equilateral_triangle(n: Draw) -> tuple[str, float, float]:
    a = n(1, 50)
    return f"equilateral_triangle(side: {a})", sqrt(3) / 4 * a**2, 3 * a


def right_triangle(base: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        w, h = n(1, 50), n(1, 50)
        return f"right_triangle({base}: {w}, height: {h})", w * h / 2, w + h + hypot(w, h)

    return make


FORMS += [right_triangle(base) for base in ("width", "base")]


# --- Polygons --------------------------------------------------------------------------------------

OF_RADIUS: dict[str, Callable[[float, int], float]] = {
    "radius": lambda r, n: r,
    "diameter": lambda r, n: 2 * r,
    "side": lambda r, n: 2 * r * sin(math.pi / n),
    "inradius": lambda r, n: r * cos(math.pi / n),
    "across_flats": lambda r, n: 2 * r * cos(math.pi / n),
}


def regular(name: str, sides: int | None, by: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        r, count = n(1, 50), sides or 4 + 2 * int(n(0, 5))
        call = f"{name}({by}: {OF_RADIUS[by](r, count)}{'' if sides else f', sides: {count}'})"
        return call, count / 2 * r**2 * sin(tau / count), 2 * count * r * sin(math.pi / count)

    return make


FORMS.append(regular("polygon", None, "radius"))
for _name, _sides in (("regular_polygon", None), ("pentagon", 5), ("hexagon", 6), ("octagon", 8)):
    FORMS += [regular(_name, _sides, by) for by in OF_RADIUS if by != "across_flats" or _sides != 5]


def star_measures(outer: float, inner: float, tips: int) -> tuple[float, float]:
    edge = sqrt(outer**2 + inner**2 - 2 * outer * inner * cos(math.pi / tips))
    return tips * outer * inner * sin(math.pi / tips), 2 * tips * edge


@form
def star(n: Draw) -> tuple[str, float, float]:
    outer, tips = n(10, 50), 3 + int(n(0, 6))
    inner = n(2, 0.9 * outer)
    call = f"star(outer_radius: {outer}, inner_radius: {inner}, points: {tips})"
    return call, *star_measures(outer, inner, tips)


@form
def pentagram(n: Draw) -> tuple[str, float, float]:
    r = n(1, 50)
    golden = (1 + sqrt(5)) / 2  # the tips of a pentagram cut its sides in the golden ratio
    return f"star(radius: {r}, points: 5)", *star_measures(r, r / golden**2, 5)


# --- Four corners ----------------------------------------------------------------------------------


def trapezoid(place: str) -> Form:
    def made(n: Draw) -> tuple[str, float, float]:
        a, b, h = n(1, 50), n(1, 50), n(1, 50)
        call = f"trapezoid({place}bottom_width: {a}, top_width: {b}, height: {h})"
        return call, (a + b) / 2 * h, a + b + 2 * hypot((a - b) / 2, h)

    return made


FORMS += [trapezoid(place) for place in ("", "bottom_center: (3, 4), ", "top_center: (3, 4), ")]


@form
def trapezoid_by_slant(n: Draw) -> tuple[str, float, float]:
    a, h, angle = n(30, 50), n(1, 10), n(40, 130)
    inset = h / tan(radians(angle))
    call = f"trapezoid(bottom_width: {a}, height: {h}, leg_angle: {angle})"
    return call, (a - inset) * h, 2 * a - 2 * inset + 2 * h / sin(radians(angle))


@form
def right_trapezoid(n: Draw) -> tuple[str, float, float]:
    a, b, h = n(1, 50), n(1, 50), n(1, 50)
    call = f"right_trapezoid(bottom_width: {a}, top_width: {b}, height: {h})"
    return call, (a + b) / 2 * h, a + b + h + hypot(a - b, h)


@form
def parallelogram(n: Draw) -> tuple[str, float, float]:
    w, h, s = n(1, 50), n(1, 50), n(-20, 20)
    return f"parallelogram(width: {w}, height: {h}, shift: {s})", w * h, 2 * w + 2 * hypot(h, s)


@form
def parallelogram_by_sides(n: Draw) -> tuple[str, float, float]:
    w, s, angle = n(1, 50), n(1, 50), n(10, 170)
    call = f"parallelogram(width: {w}, side: {s}, side_angle: {angle})"
    return call, w * s * sin(radians(angle)), 2 * (w + s)


_TIPS = ("", "bottom_corner: (3, 4), ", "top_corner: (3, 4), ")


def rhombus(place: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        w, h = n(1, 50), n(1, 50)
        return f"rhombus({place}width: {w}, height: {h})", w * h / 2, 2 * hypot(w, h)

    return make


FORMS += [rhombus(place) for place in _TIPS]


@form
def rhombus_by_side(n: Draw) -> tuple[str, float, float]:
    s, angle = n(1, 50), n(10, 170)
    return f"rhombus(side: {s}, side_angle: {angle})", s**2 * sin(radians(angle)), 4 * s


def kite(place: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        w, h = n(1, 50), n(10, 50)
        s = n(1, h - 1)
        call = f"kite({place}width: {w}, height: {h}, shoulder: {s})"
        return call, w * h / 2, 2 * hypot(w / 2, s) + 2 * hypot(w / 2, h - s)

    return make


FORMS += [kite(place) for place in _TIPS]


@form
def strip(n: Draw) -> tuple[str, float, float]:
    x, y, w = n(10, 50), n(-50, 50), n(1, 20)
    length = hypot(x, y)
    return f"strip(start: (0, 0), end: ({x}, {y}), width: {w})", length * w, 2 * (length + w)


@form
def tapered_strip(n: Draw) -> tuple[str, float, float]:
    x, y, a, b = n(10, 50), n(-50, 50), n(1, 20), n(1, 20)
    length = hypot(x, y)
    call = f"strip(start: (0, 0), end: ({x}, {y}), start_width: {a}, end_width: {b})"
    return call, length * (a + b) / 2, a + b + 2 * hypot(length, (a - b) / 2)


# --- Profiles: bars with right angles ----------------------------------------------------------------


def profile(name: str, material: Callable[[float, float], float], edges: Callable[..., float]) -> Form:
    """`material` is the length of all bars without what overlaps."""

    def make(n: Draw) -> tuple[str, float, float]:
        w, h = n(10, 50), n(10, 50)
        t = n(0.5, 3)
        call = f"{name}(width: {w}, height: {h}, thickness: {t})"
        return call, t * (material(w, h) - CROSSINGS[name] * t), edges(w, h, t)

    return make


CROSSINGS = {"l_shape": 1, "t_shape": 1, "u_shape": 2, "h_shape": 2, "i_shape": 2, "z_shape": 1}


def around(w: float, h: float, t: float) -> float:
    """The perimeter of a staircase is that of its box."""
    return 2 * (w + h)


FORMS += [
    profile("l_shape", lambda w, h: w + h, around),
    profile("t_shape", lambda w, h: w + h, around),
    profile("u_shape", lambda w, h: w + 2 * h, lambda w, h, t: around(w, h, t) + 2 * (h - t)),
    profile("h_shape", lambda w, h: w + 2 * h, lambda w, h, t: around(w, h, t) + 2 * (h - t)),
    profile("i_shape", lambda w, h: h + 2 * w, lambda w, h, t: around(w, h, t) + 2 * (w - t)),
    # Two half flanges that reach over the web, and the web between them.
    profile("z_shape", lambda w, h: w + h, lambda w, h, t: 2 * (w + t) / 2 + (w - t) + 2 * h),
]


@form
def i_shape(n: Draw) -> tuple[str, float, float]:
    w, h, flange, web = n(10, 50), n(10, 50), n(0.5, 4), n(0.5, 4)
    call = f"i_shape(width: {w}, height: {h}, flange: {flange}, web: {web})"
    return call, 2 * w * flange + web * (h - 2 * flange), 2 * (w + h) + 2 * (w - web)


def equal_cross(name: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        a, t = n(10, 50), n(1, 9)
        return f"{name}(size: {a}, width: {t})", 2 * a * t - t**2, 4 * a

    return make


def cross_in_a_box(name: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        w, h, t = n(10, 50), n(10, 50), n(1, 9)
        return f"{name}(width: {w}, height: {h}, thickness: {t})", (w + h - t) * t, 2 * (w + h)

    return make


FORMS += [kind(name) for name in ("cross", "cross_shape") for kind in (equal_cross, cross_in_a_box)]


@form
def chevron(n: Draw) -> tuple[str, float, float]:
    w, h = n(10, 50), n(10, 50)
    t = n(1, 9)
    call = f"chevron(width: {w}, height: {h}, thickness: {t})"
    return call, h * t, 2 * t + 4 * hypot(w - t, h / 2)


# --- Rings, slices and slots -------------------------------------------------------------------------


@form
def ellipse(n: Draw) -> tuple[str, float, float]:
    a, b = n(5, 25), n(5, 25)
    steps = 2000  # the rectangle rule converges exponentially for a periodic function
    turns = (tau * i / steps for i in range(steps))
    rim = sum(hypot(a * sin(t), b * cos(t)) for t in turns) * tau / steps
    return f"ellipse(width: {2 * a}, height: {2 * b})", math.pi * a * b, rim


RINGS: dict[tuple[str, str], Callable[[float, float], tuple[float, float]]] = {
    ("outer_radius", "inner_radius"): lambda a, b: (a, b),
    ("outer_radius", "thickness"): lambda a, b: (a, a - b),
    ("inner_radius", "thickness"): lambda a, b: (b, a - b),
    ("outer_diameter", "inner_diameter"): lambda a, b: (2 * a, 2 * b),
    ("outer_diameter", "thickness"): lambda a, b: (2 * a, a - b),
    ("inner_diameter", "thickness"): lambda a, b: (2 * b, a - b),
}


def ring(names: tuple[str, str]) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        outer = n(10, 50)
        inner = n(1, outer - 1)
        first, second = RINGS[names](outer, inner)
        call = f"ring({names[0]}: {first}, {names[1]}: {second})"
        return call, math.pi * (outer**2 - inner**2), tau * (outer + inner)

    return make


FORMS += [ring(names) for names in RINGS]


def sector(by: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        r, start, sweep = n(1, 50), n(-180, 180), n(10, 350)
        angles = f"start_angle: {start}, end_angle: {start + sweep}" if by == "ends" else f"{by}: {sweep}"
        return f"sector(radius: {r}, {angles})", r**2 * radians(sweep) / 2, r * (2 + radians(sweep))

    return make


FORMS += [sector(by) for by in ("ends", "sweep", "angle")]


def segment_measures(r: float, sweep: float) -> tuple[float, float]:
    """Of a disc cut off by the chord under an angle in radians."""
    return r**2 / 2 * (sweep - sin(sweep)), r * sweep + 2 * r * sin(sweep / 2)


@form
def segment_by_angles(n: Draw) -> tuple[str, float, float]:
    r, start, sweep = n(1, 50), n(-180, 180), n(10, 350)
    call = f"segment(radius: {r}, start_angle: {start}, end_angle: {start + sweep})"
    return call, *segment_measures(r, radians(sweep))


@form
def segment_by_size(n: Draw) -> tuple[str, float, float]:
    r, sweep = n(1, 50), radians(n(10, 350))
    call = f"segment(width: {2 * r * sin(sweep / 2)}, height: {r * (1 - cos(sweep / 2))})"
    return call, *segment_measures(r, sweep)


@form
def segment_by_ends(n: Draw) -> tuple[str, float, float]:
    r, sweep = n(5, 50), n(10, 170)
    x, y = r * sin(radians(sweep)), r * (1 - cos(radians(sweep)))
    call = f"segment(start: (0, 0), end: ({x}, {y}), radius: {r})"
    return call, *segment_measures(r, radians(sweep))


@form
def semicircle(n: Draw) -> tuple[str, float, float]:
    r = n(1, 50)
    return f"semicircle(radius: {r})", math.pi * r**2 / 2, (math.pi + 2) * r


@form
def semicircle_by_diameter(n: Draw) -> tuple[str, float, float]:
    r = n(1, 50)
    return f"semicircle(diameter: {2 * r})", math.pi * r**2 / 2, (math.pi + 2) * r


@form
def quarter_circle(n: Draw) -> tuple[str, float, float]:
    r = n(1, 50)
    return f"quarter_circle(radius: {r})", math.pi * r**2 / 4, (math.pi / 2 + 2) * r


def ring_sector(second: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        outer, start, sweep = n(10, 50), n(-180, 180), n(10, 350)
        inner = n(1, outer - 1)
        size = inner if second == "inner_radius" else outer - inner
        call = (
            f"ring_sector(outer_radius: {outer}, {second}: {size}, "
            f"start_angle: {start}, end_angle: {start + sweep})"
        )
        turn = radians(sweep)
        return call, (outer**2 - inner**2) * turn / 2, (outer + inner) * turn + 2 * (outer - inner)

    return make


FORMS += [ring_sector(second) for second in ("inner_radius", "thickness")]


@form
def ring_sector_by_its_inside(n: Draw) -> tuple[str, float, float]:
    inner, thickness, sweep = n(1, 40), n(1, 40), n(10, 350)
    call = f"ring_sector(inner_radius: {inner}, thickness: {thickness}, start_angle: 0, end_angle: {sweep})"
    outer, turn = inner + thickness, radians(sweep)
    return call, (outer**2 - inner**2) * turn / 2, (outer + inner) * turn + 2 * thickness


def slot_measures(between: float, width: float) -> tuple[float, float]:
    return between * width + math.pi * width**2 / 4, 2 * between + math.pi * width


@form
def slot_by_ends(n: Draw) -> tuple[str, float, float]:
    x, y, w = n(5, 50), n(-50, 50), n(1, 20)
    return f"slot(start: (2, 3), end: ({2 + x}, {3 + y}), width: {w})", *slot_measures(hypot(x, y), w)


@form
def slot_by_length(n: Draw) -> tuple[str, float, float]:
    d, w = n(1, 50), n(1, 20)
    return f"slot(length: {d + w}, width: {w})", *slot_measures(d, w)


@form
def slot_by_centres(n: Draw) -> tuple[str, float, float]:
    d, w = n(1, 50), n(1, 20)
    return f"slot(center_distance: {d}, width: {w})", *slot_measures(d, w)


@form
def arc_slot(n: Draw) -> tuple[str, float, float]:
    r, start, sweep = n(20, 50), n(-180, 180), n(10, 250)
    w = n(1, 12)
    call = f"arc_slot(radius: {r}, width: {w}, start_angle: {start}, end_angle: {start + sweep})"
    return call, *slot_measures(r * radians(sweep), w)


@form
def tapered_slot(n: Draw) -> tuple[str, float, float]:
    a, b, d = n(1, 15), n(1, 15), n(20, 50)
    lean = asin((a - b) / d)  # of the sides, to the line between the centres
    side = d * cos(lean)
    area = side * (a + b) + a**2 * (math.pi / 2 + lean) + b**2 * (math.pi / 2 - lean)
    call = f"tapered_slot(start: (0, 0), end: (0, {d}), start_radius: {a}, end_radius: {b})"
    return call, area, 2 * side + a * (math.pi + 2 * lean) + b * (math.pi - 2 * lean)


# --- Outlines of arcs --------------------------------------------------------------------------------


def d_shape(by: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        r = n(1, 50)
        h = n(0.2 * r, 1.8 * r)
        call = f"d_shape({by}: {r if by == 'radius' else 2 * r}, height: {h})"
        return call, *segment_measures(r, 2 * acos(1 - h / r))

    return make


def double_d(by: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        r = n(1, 50)
        flats = n(0.2 * r, 1.8 * r)
        cut = 2 * acos(flats / (2 * r))
        area, _ = segment_measures(r, cut)
        call = f"double_d({by}: {r if by == 'radius' else 2 * r}, across_flats: {flats})"
        return call, math.pi * r**2 - 2 * area, 2 * r * (math.pi - cut) + 4 * r * sin(cut / 2)

    return make


FORMS += [shape(by) for shape in (d_shape, double_d) for by in ("radius", "diameter")]


def keyhole(by: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        r = n(4, 20)
        w, length = n(1, 1.8 * r), n(r + 1, 60)
        depth = sqrt(r**2 - w**2 / 4)  # of the corners where the slit begins
        head = tau - 2 * asin(w / (2 * r))
        area = r**2 * head / 2 + w * depth / 2 + w * (length - depth) + math.pi * w**2 / 8
        call = f"keyhole({by}: {r if by == 'radius' else 2 * r}, width: {w}, length: {length})"
        return call, area, r * head + 2 * (length - depth) + math.pi * w / 2

    return make


FORMS += [keyhole(by) for by in ("radius", "diameter")]


@form
def lens(n: Draw) -> tuple[str, float, float]:
    r, sweep = n(5, 50), radians(n(10, 170))
    area, edges = segment_measures(r, sweep)
    call = f"lens(width: {2 * r * sin(sweep / 2)}, height: {2 * r * (1 - cos(sweep / 2))})"
    return call, 2 * area, 2 * (edges - 2 * r * sin(sweep / 2))


@form
def crescent(n: Draw) -> tuple[str, float, float]:
    r, s = n(10, 30), n(10, 30)
    d = n(abs(r - s) + 1, r + s - 1)
    # What the discs share is two segments on the chord of their crossings.
    a = 2 * acos((d**2 + r**2 - s**2) / (2 * d * r))
    b = 2 * acos((d**2 + s**2 - r**2) / (2 * d * s))
    shared = segment_measures(r, a)[0] + segment_measures(s, b)[0]
    call = f"crescent(outer_radius: {r}, inner_radius: {s}, offset: {d})"
    return call, math.pi * r**2 - shared, r * (tau - a) + s * b


@form
def reuleaux(n: Draw) -> tuple[str, float, float]:
    w = n(1, 50)
    return f"reuleaux(width: {w})", (math.pi - sqrt(3)) / 2 * w**2, math.pi * w


@form
def reuleaux_of_five(n: Draw) -> tuple[str, float, float]:
    w = n(1, 50)
    r = w / (2 * cos(math.pi / 10))
    inside = 5 / 2 * r**2 * sin(tau / 5)
    return f"reuleaux(width: {w}, sides: 5)", inside + 5 * segment_measures(w, math.pi / 5)[0], math.pi * w


# --- Arches ------------------------------------------------------------------------------------------


def standing(anchor: str, make: Form) -> Form:
    """The same outline, held by the middle of its foot or by its center."""

    def held(n: Draw) -> tuple[str, float, float]:
        call, area, edges = make(n)
        return call.replace("(", f"({anchor}: (3, 4), ", 1), area, edges

    held.__qualname__ = f"{make.__qualname__} by {anchor}"
    return held


def round_arch(n: Draw) -> tuple[str, float, float]:
    w, straight = n(2, 40), n(1, 40)
    r = w / 2
    call = f"arch(width: {w}, height: {straight + r})"
    return call, w * straight + math.pi * r**2 / 2, w + 2 * straight + math.pi * r


def flat_arch(n: Draw) -> tuple[str, float, float]:
    r, sweep, straight = n(5, 50), radians(n(20, 179)), n(1, 40)
    w, rise = 2 * r * sin(sweep / 2), r * (1 - cos(sweep / 2))
    area, edges = segment_measures(r, sweep)
    call = f"arch(width: {w}, height: {straight + rise}, rise: {rise})"
    return call, area + w * straight, edges + 2 * straight


def gothic_top(w: float, rise: float) -> tuple[float, float]:
    """Of what lies over the springing of a pointed arch: a triangle and a segment on each of its sides; the
    length of its two arcs.
    """
    side = hypot(w / 2, rise)
    lean = math.pi / 2 - math.atan2(rise, w / 2)  # of the side, to the upright in which its arc begins
    r = side / (2 * sin(lean))
    area, _ = segment_measures(r, 2 * lean)
    return w * rise / 2 + 2 * area, 4 * r * lean


def equilateral_arch(n: Draw) -> tuple[str, float, float]:
    w, straight = n(2, 40), n(1, 40)
    area, arcs = gothic_top(w, w * sqrt(3) / 2)
    call = f"pointed_arch(width: {w}, height: {straight + w * sqrt(3) / 2})"
    return call, area + w * straight, w + 2 * straight + arcs


def pointed_arch(n: Draw) -> tuple[str, float, float]:
    w, straight = n(2, 40), n(1, 40)
    rise = n(0.51, 2) * w
    area, arcs = gothic_top(w, rise)
    call = f"pointed_arch(width: {w}, height: {straight + rise}, rise: {rise})"
    return call, area + w * straight, w + 2 * straight + arcs


def ogive(n: Draw) -> tuple[str, float, float]:
    w = n(2, 40)
    h = n(0.51, 3) * w
    area, arcs = gothic_top(w, h)
    return f"ogive(width: {w}, height: {h})", area, w + arcs


def ogee_arch(n: Draw) -> tuple[str, float, float]:
    w, straight = n(2, 40), n(1, 40)
    rise = n(0.51, 2) * w
    # An S bulges as much over its chord as it lacks; each of its arcs leans from upright to the chord.
    lean = math.atan2(w / 2, rise)
    r = hypot(w / 2, rise) / 2 / (2 * sin(lean))
    call = f"ogee_arch(width: {w}, height: {straight + rise}, rise: {rise})"
    return call, w * straight + w * rise / 2, w + 2 * straight + 8 * r * lean


def measured_cubics(curves: list[list[tuple[float, float]]]) -> tuple[float, float]:
    """Twice the area that cubic Béziers sweep about the origin, and their length, by Simpson's rule."""
    steps = 2000
    area = length = 0.0
    for a, b, c, d in curves:
        for k in range(steps + 1):
            t = k / steps
            weights = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3
            slopes = -3 * (1 - t) ** 2, 3 * (1 - t) * (1 - 3 * t), 3 * t * (2 - 3 * t), 3 * t**2
            x, y = (sum(w * p[i] for w, p in zip(weights, (a, b, c, d), strict=True)) for i in (0, 1))
            u, v = (sum(w * p[i] for w, p in zip(slopes, (a, b, c, d), strict=True)) for i in (0, 1))
            weight = (1 if k in (0, steps) else 4 if k % 2 else 2) / (3 * steps)
            area += weight * (x * v - y * u)
            length += weight * hypot(u, v)
    return area, length


def dome(n: Draw) -> tuple[str, float, float]:
    w, h = n(2, 40), n(2, 40)
    k = 4 / 3 * tan(math.pi / 8)
    quarter = [(w / 2, 0.0), (w / 2, k * h), (k * w / 2, h), (0.0, h)]
    area, length = measured_cubics([quarter])
    assert area == pytest.approx(math.pi * w * h / 4, rel=1e-3)
    return f"dome(width: {w}, height: {h})", area, w + 2 * length


for _make in (round_arch, flat_arch, equilateral_arch, pointed_arch, ogive, ogee_arch, dome):
    FORMS += [standing(anchor, _make) for anchor in ("center", "bottom_center")]


@form
def equilateral_shield(n: Draw) -> tuple[str, float, float]:
    call, area, edges = equilateral_arch(n)
    return call.replace("pointed_arch", "shield"), area, edges


@form
def shield(n: Draw) -> tuple[str, float, float]:
    call, area, edges = pointed_arch(n)
    return call.replace("pointed_arch", "shield"), area, edges


# --- Wheels ------------------------------------------------------------------------------------------


def wheel_form(bore: bool) -> Form:
    def wheel(n: Draw) -> tuple[str, float, float]:
        r, hub, spokes = n(20, 40), n(4, 10), 3 + int(n(0, 7))
        rim = n(1, 6)
        half = n(0.2, 0.9) * hub * sin(math.pi / spokes)
        outer = r - rim
        # An opening is the sector between two spokes, less what the halves of both take of it.
        wide, narrow = asin(half / outer), asin(half / hub)

        def taken(radius: float, lean: float) -> float:
            return radius**2 * lean / 2 + half * radius * cos(lean) / 2

        opening = math.pi / spokes * (outer**2 - hub**2) - 2 * (taken(outer, wide) - taken(hub, narrow))
        edges = outer * (tau / spokes - 2 * wide) + hub * (tau / spokes - 2 * narrow)
        edges += 2 * (outer * cos(wide) - hub * cos(narrow))
        b = hub / 2 if bore else 0
        call = f"wheel(radius: {r}, rim: {rim}, hub_radius: {hub}, spokes: {spokes}, spoke_width: {2 * half}"
        area = math.pi * (r**2 - b**2) - spokes * opening
        return call + (f", bore_radius: {b})" if bore else ")"), area, tau * (r + b) + spokes * edges

    return wheel


FORMS += [wheel_form(False), wheel_form(True)]


@form
def rosette(n: Draw) -> tuple[str, float, float]:
    r, lobes, sweep = n(10, 40), 4 + int(n(0, 12)), radians(n(10, 170))
    corner = 2 * r * sin(math.pi / lobes)
    lobe = corner / 2 / sin(sweep / 2)
    outer = r * cos(math.pi / lobes) + lobe * (1 - cos(sweep / 2))
    area, _ = segment_measures(lobe, sweep)
    call = f"rosette(outer_radius: {outer}, inner_radius: {r}, lobes: {lobes})"
    return call, lobes * (r**2 * sin(tau / lobes) / 2 + area), lobes * lobe * sweep


@form
def flower(n: Draw) -> tuple[str, float, float]:
    outer, lobes = n(10, 40), 4 + int(n(0, 12))
    half = math.pi / lobes
    inner = n(0.1, 0.95) * outer * cos(half) / (1 + sin(half))
    reach = (4 * outer / cos(half) - inner) / 3
    feet = np.array(
        [(r * cos(a), r * sin(a)) for r, a in ((inner, 0), (reach, 0), (reach, 2 * half), (inner, 2 * half))]
    )
    places, weights = np.polynomial.legendre.leggauss(60)
    t = (places[:, None] + 1) / 2
    p = (
        (1 - t) ** 3 * feet[0]
        + 3 * t * (1 - t) ** 2 * feet[1]
        + 3 * t**2 * (1 - t) * feet[2]
        + t**3 * feet[3]
    )
    legs = np.diff(feet, axis=0)
    v = 3 * ((1 - t) ** 2 * legs[0] + 2 * t * (1 - t) * legs[1] + t**2 * legs[2])
    area = weights @ (p[:, 0] * v[:, 1] - p[:, 1] * v[:, 0]) / 4
    length = weights @ np.hypot(*v.T) / 2
    call = f"rosette(outer_radius: {outer}, inner_radius: {inner}, lobes: {lobes})"
    return call, lobes * float(area), lobes * float(length)


def chamfered_by_sides(place: Callable[[float, float], str]) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        w, h, c = n(10, 50), n(10, 50), n(0.1, 4.5)
        call = f"chamfered_rectangle({place(w, h)}, chamfer: {c})"
        return call, w * h - 2 * c**2, 2 * (w + h) - (8 - 4 * sqrt(2)) * c

    return make


FORMS += [chamfered_by_sides(place) for place in BY_SIDES]


@form
def cog(n: Draw) -> tuple[str, float, float]:
    outer, teeth, share = n(20, 40), 2 + int(n(0, 20)), n(0.1, 0.9)
    inner = n(0.5, 0.95) * outer
    call = f"cog(outer_radius: {outer}, inner_radius: {inner}, teeth: {teeth}, share: {share})"
    area = math.pi * (share * outer**2 + (1 - share) * inner**2)
    return call, area, tau * (share * outer + (1 - share) * inner) + 2 * teeth * (outer - inner)


# --- Figures -----------------------------------------------------------------------------------------


def arrow_measures(length: float, w: float, head: float, wide: float) -> tuple[float, float]:
    area = (length - head) * w + head * wide / 2
    return area, 2 * (length - head) + wide + 2 * hypot(head, wide / 2)


@form
def arrow_between_points(n: Draw) -> tuple[str, float, float]:
    x, y, head, w = n(20, 50), n(-50, 50), n(2, 15), n(1, 5)
    wide = n(6, 20)
    call = f"arrow(start: (0, 0), end: ({x}, {y}), width: {w}, head_length: {head}, head_width: {wide})"
    return call, *arrow_measures(hypot(x, y), w, head, wide)


@form
def arrow_of_a_length(n: Draw) -> tuple[str, float, float]:
    length, head, w, wide = n(20, 50), n(2, 15), n(1, 5), n(6, 20)
    call = f"arrow(length: {length}, width: {w}, head_length: {head}, head_width: {wide})"
    return call, *arrow_measures(length, w, head, wide)


@form
def double_arrow(n: Draw) -> tuple[str, float, float]:
    x, y, head, w, wide = n(35, 50), n(-50, 50), n(2, 15), n(1, 5), n(6, 20)
    area, edges = arrow_measures(hypot(x, y) / 2, w, head, wide)
    call = (
        f"double_arrow(start: (0, 0), end: ({x}, {y}), width: {w}, head_length: {head}, head_width: {wide})"
    )
    return call, 2 * area, 2 * (edges - w)


def house(place: str) -> Form:
    def make(n: Draw) -> tuple[str, float, float]:
        w, h = n(10, 50), n(10, 50)
        roof = n(1, h - 1)
        walls = h - roof
        call = f"house({place}width: {w}, height: {h}, roof_height: {roof})"
        return call, w * walls + w * roof / 2, w + 2 * walls + 2 * hypot(w / 2, roof)

    return make


FORMS += [house(place) for place in ("", "bottom_center: (3, 4), ")]


@form
def drop(n: Draw) -> tuple[str, float, float]:
    r = n(1, 20)
    h = n(2.2 * r, 5 * r)
    side = sqrt((h - r) ** 2 - r**2)  # a tangent from the tip
    sweep = tau - 2 * acos(r / (h - r))
    return f"drop(radius: {r}, height: {h})", r * side + r**2 * sweep / 2, 2 * side + r * sweep


SUPERELLIPSE = math.gamma(1 + 1 / 4) ** 2 / math.gamma(1 + 2 / 4)
"""The share of its box that a superellipse of exponent 4 fills."""

BEZIER_FIGURES: dict[str, tuple[str, Callable[[float, float], float] | None, float]] = {
    "heart": ("width: {w}, height: {h}", None, 0),
    "egg": ("width: {w}, height: {h}", lambda w, h: math.pi * w * h / 4, 5e-4),
    "squircle": ("width: {w}, height: {h}", lambda w, h: w * h * SUPERELLIPSE, 7e-3),
    "leaf": ("width: {w}, height: {h}", None, 0),
    "cloud": ("width: {w}, height: {h}", None, 0),
    "squircle of a size": ("size: {w}", lambda w, h: w * w * SUPERELLIPSE, 7e-3),
}
"""Arguments, the area of what the figure stands for, and how near it comes."""


# --- The tests -----------------------------------------------------------------------------------------


def drawing_from(data: st.DataObject) -> Draw:
    def draw(low: float, high: float) -> float:
        # A few decimals, so that the program that fails can be read.
        return round(data.draw(st.floats(low, high, allow_nan=False)), 3)

    return draw


few = tries(3, phases=(Phase.explicit, Phase.generate))


def compiled(call: str) -> dict[str, Any]:
    model = aidl_lang.compile(f"solid s {{ body = {call} }}")
    assert model.ok, (call, model.diagnostics)
    assert not model.diagnostics, (call, [d.message for d in model.diagnostics])
    document: dict[str, Any] = json.loads(model.to_json())
    return document


def label(make: Form) -> str:
    return f"{make.__qualname__.partition('.')[0]}-{FORMS.index(make)}"


@pytest.mark.parametrize("make", FORMS, ids=label)
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


@pytest.mark.parametrize("make", FORMS, ids=label)
def test_a_shape_is_held_at_the_middle_of_its_box_or_says_where(make: Form) -> None:
    call, _, _ = make(lambda low, high: round(low + 0.4 * (high - low), 2))
    name, arguments = call_of(call)
    model = compiled(call)["root"]
    body = model["geometry"]["body"].get("params", {})
    if "center" not in body or any(re.search(r"_(left|right|center)$", each) for each in arguments):
        return
    box = model["bb"]
    middle = ((box["left"] + box["right"]) / 2, (box["bottom"] + box["top"]) / 2)
    entry = reference().find(name)
    assert entry is not None
    if body["center"] != pytest.approx(middle, abs=1e-6):
        assert "`center`" in entry.doc.lies, call


@pytest.mark.parametrize("name", BEZIER_FIGURES)
@few
@given(data=st.data())
def test_figures_of_bezier_curves(name: str, data: st.DataObject) -> None:
    draw = drawing_from(data)
    w, h = draw(5, 50), draw(5, 50)
    written, nearly, tolerance = BEZIER_FIGURES[name]
    call = f"{name.partition(' ')[0]}({written.format(w=w, h=h)})"
    h = w if "size" in written else h
    document = compiled(call)
    box = document["root"]["bb"]
    assert box["right"] - box["left"] == pytest.approx(w)
    assert box["top"] - box["bottom"] == pytest.approx(h)
    parts = document["root"]["geometry"]["body"]["parts"].values()
    outline = [
        p
        for part in parts
        if part["type"] == "bezier"
        for p in (*sampled(part["points"]), part["points"][-1])
    ]
    area, perimeter = polygon_measures(outline)
    region = document["regions"]["s"]
    assert region["area"] == pytest.approx(area, rel=1e-5)
    assert region["perimeter"] == pytest.approx(perimeter, rel=1e-5)
    if nearly is not None:
        assert region["area"] == pytest.approx(nearly(w, h), rel=tolerance)


def sampled(controls: list[list[float]], steps: int = 400) -> list[tuple[float, float]]:
    """Points of a cubic Bézier curve, without its last."""
    shares = [i / steps for i in range(steps)]
    weights = [((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3) for t in shares]
    return [
        (
            sum(w * c[0] for w, c in zip(row, controls, strict=True)),
            sum(w * c[1] for w, c in zip(row, controls, strict=True)),
        )
        for row in weights
    ]


def test_polygon_and_polyline() -> None:
    points = [(0, 0), (30, 0), (30, 20), (12, 9), (0, 20)]
    region = compiled(f"polygon({points})")["regions"]["s"]
    area, perimeter = polygon_measures(points)
    assert region["area"] == pytest.approx(area)
    assert region["perimeter"] == pytest.approx(perimeter)
    closed = [*points, points[0]]
    assert compiled(f"polyline({closed})")["regions"]["s"]["area"] == pytest.approx(area)


# --- Every constructor is in the table -------------------------------------------------------------------


@functools.cache
def signatures() -> list[tuple[str, frozenset[str], frozenset[str]]]:
    """Of each overload of a public shape: its name, the parameters that it needs, and all of them."""
    found = []
    for module in library.load().modules:
        if module.source.name.rpartition("/")[2].removesuffix(".aidl") not in FILES:
            continue
        callables = [
            s for s in module.statements if isinstance(s, ast.ShapeDefinition | ast.FunctionDefinition)
        ]
        public = {c.name.text for c in callables if c.doc} | {"cross"}
        found += [
            (
                c.name.text,
                frozenset(p.name.text for p in c.parameters if p.default is None),
                frozenset(p.name.text for p in c.parameters),
            )
            for c in callables
            if c.name.text in public
        ]
    return found


def call_of(text: str) -> tuple[str, frozenset[str]]:
    """The name and the named arguments of a call."""
    module = parser.parse(SourceFile("call", f"drawing d {{ a = {text} }}")).module
    (root,) = module.statements
    assert isinstance(root, ast.Structure)
    (assignment,) = root.body.statements
    assert isinstance(assignment, ast.Assign)
    assert isinstance(assignment.value, ast.Call)
    names = (a.name.text for a in assignment.value.arguments if a.name is not None)
    return assignment.value.callee.text, frozenset(names)


def takes_angle(text: str) -> bool:
    name, names = call_of(text)
    fits = [all_ for n, needed, all_ in signatures() if n == name and needed <= names <= all_]
    return "angle" not in names and any("angle" in all_ for all_ in fits)


def unmeasured() -> list[str]:
    """Returns the constructors of public shapes that no row of the tables calls."""
    calls = {call_of(make(lambda low, high: (low + high) / 2)[0]) for make in FORMS}
    calls |= {
        (name.partition(" ")[0], call_of(f"f({written.format(w=1, h=1)})")[1])
        for name, (written, _, _) in BEZIER_FIGURES.items()
    }
    known = signatures()
    assert len(known) > 100
    return [
        f"{name}({', '.join(sorted(needed))})"
        for name, needed, every in known
        if not needed & INTERNAL
        and not any(name == called and needed <= given_ <= every for called, given_ in calls)
    ]
