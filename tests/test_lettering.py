"""The font that ships with the package, and what is made of its outlines."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import pytest
from fontTools.ttLib import TTFont
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import GeometryCollection, LineString, MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from aidl_lang import pipeline
from aidl_lang.common import lettering
from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile
from aidl_lang.geometry.boolean import lettered_region, stencilled
from aidl_lang.geometry.curves import Bezier, Line
from tests.amount import TRIES_ALL, tries

FONT = TTFont(resource("aidl_lang/common/fonts/DejaVuSansAIDL.ttf"))
FONTS = {False: lettering.plain_font(), True: lettering.bold_font()}
FACES = pytest.mark.parametrize(
    "font", [lettering.plain_font(), lettering.bold_font()], ids=["plain", "bold"]
)
CAPITAL = 1493
CHARACTERS = {chr(code): name for code, name in FONT.getBestCmap().items()}


def contours(glyph: lettering.Glyph) -> Iterator[Polygon]:
    """The closed outlines of a character as polygons, each curve in eight steps."""
    spots: list[tuple[float, float]] = []
    for curve in glyph.curves:
        if spots and curve[0] != spots[-1]:
            yield Polygon(spots)
            spots = []
        spots += [curve[0]] if not spots else []
        if len(curve) == 2:
            spots.append(curve[1])
        else:
            spots += [_on(curve, k / 8) for k in range(1, 9)]
    yield Polygon(spots)


def _on(points: lettering.Curve, t: float) -> tuple[float, float]:
    """By de Casteljau's algorithm."""
    while len(points) > 1:
        points = tuple(((1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1]) for a, b in pairwise(points))
    return points[0]


LATIN = (
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.,:;!?'\"-–—_()[]{}/\\|+=<>*#%&@^~`$€£°±×÷·•…"
    "\u2018\u2019“”„«»→←↑↓µØøÆæŒœßĐđŁłı¡¿§²³⌀ÀÁÂÃÄÅÇÈÉÊËÌÍÎÏÑÒÓÔÕÖÙÚÛÜÝŠŽČĚŘŤàáâãäåçèéêëìíîïñòóôõöùúûüýÿšžčěřąęşșőűğ"
)


def parts(area: BaseGeometry) -> list[Polygon]:
    """The polygons of an area."""
    found = list(area.geoms) if isinstance(area, MultiPolygon | GeometryCollection) else [area]
    return [part for part in found if isinstance(part, Polygon) and not part.is_empty]


def ink(glyph: lettering.Glyph) -> BaseGeometry:
    """What the contours of a character enclose, nested ones in turns."""
    found: BaseGeometry = Polygon()
    for contour in contours(glyph):
        found = found.symmetric_difference(contour)
    return found


@pytest.mark.parametrize("character", "HILTAVWXEFKMNZ147")
def test_ink_is_that_of_the_font(character: str) -> None:
    """The box of straight letters is the one that the font's own table tells."""
    told = FONT["glyf"][CHARACTERS[character]]
    left, bottom, right, top = (
        v * CAPITAL for v in lettering.box_around(lettering.typeset(character, "left", 1.6))
    )
    assert (left, right) == pytest.approx((0, told.xMax - told.xMin))
    assert (bottom, top) == pytest.approx((told.yMin, told.yMax))


@FACES
def test_faces_of_letters_are_what_their_contours_enclose(font: lettering.Font) -> None:
    """Nested contours in turns, by another geometry; counted for every character."""
    for character in CHARACTERS if TRIES_ALL else LATIN[:94:2]:
        for glyph in lettering.typeset(character, "left", 1.6, font):
            curves = [Line(*c) if len(c) == 2 else Bezier(*c) for c in glyph.curves]  # type: ignore[call-arg]
            region = lettered_region([curves])
            assert region is not None, character
            faces = region.faces
            alternating = ink(glyph)
            assert len(faces) == len(parts(alternating)), character
            areas = [[loop.area for loop in face.loops] for face in faces]
            assert all(outer > 0 and all(hole < 0 for hole in holes) for outer, *holes in areas), character
            assert sum(map(sum, areas)) == pytest.approx(alternating.area, rel=0.02), character


def test_letters_that_may_meet_are_arranged() -> None:
    """Of letters side by side each keeps its faces; where boxes meet, or one is open, nothing is said."""
    glyphs = lettering.typeset("BO", "left", 1.6)
    first, second = ([Line(*c) if len(c) == 2 else Bezier(*c) for c in g.curves] for g in glyphs)  # type: ignore[call-arg]
    apart = lettered_region([first, second])
    assert apart is not None
    assert [len(face.holes) for face in apart.faces] == [2, 1]
    turned = lettered_region([[piece.reversed() for piece in reversed(letter)] for letter in (first, second)])
    assert turned is not None
    areas = [sum(loop.area for loop in face.loops) for region in (apart, turned) for face in region.faces]
    assert areas[:2] == pytest.approx(areas[2:])
    assert lettered_region([first, first]) is None
    assert lettered_region([first[1:]]) is None


@FACES
def test_stencils_enclose_nothing(font: lettering.Font) -> None:
    """Of what a character is made of nothing goes all around anything, and only bridges were taken away."""
    for character in CHARACTERS if TRIES_ALL else LATIN[:94:2]:
        for glyph in lettering.typeset(character, "left", 1.6, font):
            whole, cut = ink(glyph), ink(lettering.Glyph(stencilled(glyph.curves, 0.1), glyph.box))
            assert not any(part.interiors for part in parts(cut)), character
            assert whole.buffer(0.01).contains(cut), character
            if any(part.interiors for part in parts(whole)):
                assert 0.3 * whole.area < cut.area < whole.area, character
            else:
                assert cut.area == pytest.approx(whole.area), character


@given(st.sampled_from("ADOPQRabdegopq0469"), st.floats(0.02, 0.3))
@tries(40)
def test_bridges_are_as_wide_as_said(character: str, width: float) -> None:
    """What is taken away is upright bars of that width, but for what the chords of curves are off."""
    (glyph,) = lettering.typeset(character, "left", 1.6)
    taken = ink(glyph) - ink(lettering.Glyph(stencilled(glyph.curves, width), glyph.box)).buffer(0.003)
    widths = [part.bounds[2] - part.bounds[0] for part in parts(taken) if part.area > 1e-4]
    assert max(widths) == pytest.approx(width, abs=0.02)


def test_letters_of_single_lines_are_drawn_once() -> None:
    """No two strokes of a character lie on each other, capitals stand on the line and are as high as said."""
    font = lettering.single_line_font()
    for character in LATIN:
        (glyph,) = lettering.typeset(character, "left", 1.6, font)
        strokes = [LineString([_on(c, k / 16) for k in range(17)]) for c in glyph.curves]
        twice = [a.intersection(b).length for i, a in enumerate(strokes) for b in strokes[:i]]
        assert max(twice, default=0.0) < 1e-6, character
    for capital in "ABCDEFGHIJKLMNOPRSTUVWXYZ":
        (glyph,) = lettering.typeset(capital, "left", 1.6, font)
        assert (glyph.box[1], glyph.box[3]) == pytest.approx((0, 1), abs=1e-9), capital


def test_many_labels_cost_little_to_solve() -> None:
    """Each is one geometry with a place: the solver sees no curve of it."""
    text = "drawing d { for i in 0..30 { n[i] = text(str(i), center: (10 * i, 0), height: 3) } }"
    compiled = pipeline.compile(SourceFile("p", text))
    assert compiled.ok
    assert compiled.model is not None
    assert compiled.model.degrees == 2 * 31


@given(
    st.floats(-50, 50),
    st.floats(5, 60),
    st.floats(1, 12),
    st.booleans(),
    st.booleans(),
    st.floats(-360, 360),
    st.floats(20, 340),
)
@tries(40)
def test_letters_stand_on_their_curve(
    x: float, radius: float, height: float, inside: bool, bold: bool, first: float, sweep: float
) -> None:
    """Below the middle of its ink each has a point of the circle, and there the direction of it."""
    said = f"height: {height}, inside: {str(inside).lower()}, bold: {str(bold).lower()}"
    text = f"""drawing d {{
        rim = circle(center: ({x}, 3), radius: {radius})
        bow = arc(center: ({x}, 3), radius: {radius}, start_angle: {first}deg, end_angle: {first + sweep}deg)
        a = text("Agj8", along: rim, {said})
        b = text("Agj8", along: bow, {said})
    }}"""
    model = pipeline.compile(SourceFile("p", text)).model
    assert model is not None
    named = {g.name: g for g in model.root.geometry}
    boxes = [g.box for g in lettering.typeset("Agj8", "center", 1.6, FONTS[bold])]
    middles = [(left + right) / 2 for left, _, right, _ in boxes]
    for name in "ab":
        center = named["rim" if name == "a" else "bow"].values["center"]
        for glyph, middle in zip(named[name].parts, middles, strict=True):
            start, angle = glyph.values["start"], math.radians(glyph.values["angle"])  # type: ignore[arg-type]
            foot = [
                start[0] + middle * height * math.cos(angle),
                start[1] + middle * height * math.sin(angle),
            ]  # type: ignore[index]
            out = foot[0] - center[0], foot[1] - center[1]  # type: ignore[index]
            assert math.hypot(*out) == pytest.approx(radius)
            up = (-math.sin(angle) * out[0] + math.cos(angle) * out[1]) / radius
            assert up == pytest.approx(-1 if inside else 1)
