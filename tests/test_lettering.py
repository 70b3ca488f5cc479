"""The font that ships with the package, and what is made of its outlines."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise

import pytest
from fontTools.ttLib import TTFont
from shapely.geometry import MultiPolygon, Polygon

from aidl_lang import pipeline
from aidl_lang.common import lettering
from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile
from aidl_lang.geometry.curves import Bezier, Line
from aidl_lang.geometry.letters import letter_faces
from aidl_lang.geometry.measures import loop_area

FONT = TTFont(resource("aidl_lang/common/fonts/DejaVuSansAIDL.ttf"))
BOLD = TTFont(resource("aidl_lang/common/fonts/DejaVuSansAIDL-Bold.ttf"))
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


@FACES
def test_contours_of_the_font_are_nested(font: lettering.Font) -> None:
    """None crosses itself or another, so that filling them in turns gives the letter."""
    crossing = []
    for character in CHARACTERS:
        for glyph in lettering.typeset(character, "left", 1.6, font):
            found = list(contours(glyph))
            apart = all(not a.boundary.intersects(b.boundary) for i, a in enumerate(found) for b in found[:i])
            if not apart or not all(polygon.is_valid for polygon in found):
                crossing.append(character)
    assert crossing == []


@pytest.mark.parametrize("character", "HILTAVWXEFKMNZ147")
def test_ink_is_that_of_the_font(character: str) -> None:
    """The box of straight letters is the one that the font's own table tells."""
    told = FONT["glyf"][CHARACTERS[character]]
    left, bottom, right, top = (
        v * CAPITAL for v in lettering.box_around(lettering.typeset(character, "left", 1.6))
    )
    assert (left, right) == pytest.approx((0, told.xMax - told.xMin))
    assert (bottom, top) == pytest.approx((told.yMin, told.yMax))


def test_characters_stand_an_advance_apart() -> None:
    """`AVA` has no kerning: the third letter is as far behind the second as the widths say."""
    names, widths = FONT.getBestCmap(), FONT["hmtx"].metrics
    a, v = names[ord("A")], names[ord("V")]
    first, second, third = (g.box[0] * CAPITAL for g in lettering.typeset("AVA", "left", 1.6))
    bearing = widths[v][1] - widths[a][1]
    assert second - first == pytest.approx(widths[a][0] + bearing, abs=1)
    assert third - first == pytest.approx(widths[a][0] + widths[v][0])


def test_what_the_font_should_have() -> None:
    text = (
        "ABCxyz0123456789 äöüßÄÖÜ éèêç łŁąęż øØåÅ ñ ¿¡ αβγΩμ Ж.,:;!?()[]{}<>/\\|'\"`~@#$%^&*-+=_ "
        "±°×÷µ²³½¼¾ ≤≥≈≠√∞ ←↑→↓ ⌀ € £ § © ™ – — … „“” ✓"
    )
    assert lettering.unknown_characters(text) == []


def test_the_faces_have_the_same_characters() -> None:
    assert BOLD.getBestCmap().keys() == FONT.getBestCmap().keys()


@FACES
def test_faces_of_letters_are_what_their_contours_enclose(font: lettering.Font) -> None:
    """Nested contours in turns, by another geometry; counted for all characters."""
    for character in CHARACTERS:
        for glyph in lettering.typeset(character, "left", 1.6, font):
            curves = [Line(*c) if len(c) == 2 else Bezier(*c) for c in glyph.curves]  # type: ignore[call-arg]
            faces = letter_faces(curves)
            alternating = Polygon()
            for contour in contours(glyph):
                alternating = alternating.symmetric_difference(contour)
            count = len(alternating.geoms) if isinstance(alternating, MultiPolygon) else 1
            assert len(faces) == count, character
            areas = [[loop_area(loop) for loop in face.loops] for face in faces]
            assert all(outer > 0 and all(hole < 0 for hole in holes) for outer, *holes in areas), character
            assert sum(map(sum, areas)) == pytest.approx(alternating.area, rel=0.02), character


def test_accents_written_apart_are_joined() -> None:
    assert lettering.typeset("e\u0301", "left", 1.6) == lettering.typeset("é", "left", 1.6)


def test_no_font_is_loaded_without_text() -> None:
    program = (
        "import sys; from aidl_lang import pipeline; from aidl_lang.common.source import SourceFile;"
        "pipeline.compile(SourceFile('p', 'solid s { c = circle(radius: 3) }'));"
        "sys.exit('fontTools' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_many_labels_cost_little_to_solve() -> None:
    """Each is one geometry with a place: the solver sees no curve of it."""
    text = "drawing d { for i in 0..30 { n[i] = text(str(i), center: (10 * i, 0), height: 3) } }"
    compiled = pipeline.compile(SourceFile("p", text))
    assert compiled.ok
    assert compiled.model is not None
    assert compiled.model.degrees == 2 * 31
