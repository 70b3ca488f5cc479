"""Pictures as pdfium and Pillow read them: sizes, curves, pixels, texts, pages, in any scale."""

from __future__ import annotations

import io
import math

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from pypdfium2 import PdfDocument

from aidl_lang.export.marks import Area, Curves, Dot, Frame, Group, Ink, Mark, Picture, Text, scaled
from aidl_lang.export.pdf import to_pdf, to_png
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece
from aidl_lang.geometry.region import Face, Loop
from aidl_lang.geometry.solved import SolvedStructure
from tests.export.making import near, written
from tests.export.readers import read_pdf
from tests.geometry.models import circle, rectangle, structure

MM = 25.4 / 72
PLATE = structure(
    "solid",
    "plate",
    rectangle("r", 0, 0, 100, 50),
    structure("hole", "bore", circle("c", 25, 25, 10)),
    color=("teal",),
)


def of(*marks: object, box: tuple[float, float, float, float] = (0, 0, 100, 100)) -> bytes:
    return to_pdf([Picture(box, (Group("g", tuple(marks)),))], "test")  # type: ignore[arg-type]


def test_areas_of_curves():
    """pdfium hands out coordinates in single precision."""
    ellipse = Ellipse((50, 50), 30, 10, 0.3)
    half = EllipseArc((50, 50), 30, 10, 0.0, (80, 50), (20, 50), 0.0, math.pi)
    loops = {
        math.pi * 400: Loop((Circle((50, 50), 20),)),
        math.pi * 300: Loop((ellipse,)),
        math.pi * 150: Loop((half, Line((20, 50), (80, 50)))),
        # Between a cubic and its chord lie 3/5 of the box of its control points.
        1440: Loop((Bezier((0, 0), (0, 40), (60, 40), (60, 0)), Line((60, 0), (0, 0)))),
    }
    for area, loop in loops.items():
        (body,) = read_pdf(of(Area(Face(loop), "#000000", Ink("#000000", 0.1))))
        assert body.area == pytest.approx(area, rel=1e-5)


def test_dots_frames_dashes_and_opacity():
    data = of(
        Dot((20, 20), 5, "#0000ff"),
        Frame((40, 40, 90, 90), "#00ff00", 2, 4.0),
        Curves((Line((0, 5), (100, 5)),), Ink("#ff0000", 4, opacity=0.5)),
    )
    shown = PdfDocument(data)[0].render(scale=3).to_pil()
    per_mm = shown.width / 100
    pixel = {
        spot: shown.getpixel((round(spot[0] * per_mm), round((100 - spot[1]) * per_mm)))
        for spot in [(20, 20), (65, 65), (50, 5)]
    }
    assert near(pixel[20, 20], (0, 0, 255))
    assert near(pixel[65, 65], (255, 255, 255))
    assert near(pixel[50, 5], (255, 128, 128))
    green = [shown.getpixel((round(40 * per_mm), round((100 - y / 10) * per_mm))) for y in range(420, 880)]
    assert 0.4 < sum(near(p, (0, 255, 0)) for p in green) / len(green) < 0.75


def test_texts_can_be_searched_and_stand_where_they_should():
    data = of(
        Text((50, 50), "⌀8 café", 6, "#000000", "middle"),
        Text((10, 10), "up", 6, "#000000", angle=90),
    )
    text = PdfDocument(data)[0].get_textpage()
    assert "⌀8 café" in text.get_text_range()
    boxes = [[MM * side for side in text.get_charbox(k)] for k in range(text.count_chars())]
    middle = (min(b[0] for b in boxes[:7]) + max(b[2] for b in boxes[:7])) / 2
    assert middle == pytest.approx(50, abs=1)
    found = text.get_text_range().index("up")
    assert boxes[found + 1][1] > boxes[found][1] + 2
    assert boxes[found + 1][0] == pytest.approx(boxes[found][0], abs=2)


def test_tiles_are_pages():
    document = PdfDocument(written(PLATE, ".pdf", tile=(105, 105)).data)
    assert len(document) == 2
    assert all([MM * s for s in page.get_size()] == pytest.approx([105, 105], abs=1e-3) for page in document)


# --- PNG -------------------------------------------------------------------------------------------

TEAL, WHITE = (0, 128, 128), (255, 255, 255)


def image(root: SolvedStructure, pixels: int = 1060) -> Image.Image:
    return Image.open(io.BytesIO(written(root, ".png", pixels=pixels).data))


@pytest.mark.parametrize("suffix", [".png", ".pdf"])
def test_material_holes_and_margins(suffix: str):
    """The margin is 3 mm of 100: at 1060 pixels a millimetre is ten."""
    page = PdfDocument(written(PLATE, ".pdf").data)[0]
    shown = image(PLATE) if suffix == ".png" else page.render(scale=10 * MM).to_pil()
    assert shown.size == pytest.approx((1060, 560), abs=1)
    spots = {TEAL: [(2, 2), (98, 48), (25, 10), (50, 25), (25, 36)]}
    spots[WHITE] = [(25, 25), (33, 25), (25, 33), (-2, 25), (50, 52)]
    for color, places in spots.items():
        for x, y in places:
            assert near(shown.getpixel((round(10 * (x + 3)), round(10 * (53 - y)))), color), (x, y)


def test_the_resolution_is_stated():
    assert image(PLATE).info["dpi"] == pytest.approx((254, 254), abs=0.1)


def test_a_very_long_picture_is_not_too_slim_to_see():
    shown = image(structure("solid", "s", rectangle("r", 0, 0, 1e6, 1)), 1000)
    assert shown.size[0] == 1000
    assert shown.size[1] >= 10


def test_texts_have_the_font_that_comes_along():
    """A wide letter leaves more ink than a narrow one, and a character without a glyph leaves some too."""

    def ink(text: str) -> int:
        mark = Text((1, 1), text, 8, "#000000", halo=False)
        shown = Image.open(io.BytesIO(to_png(Picture((0, 0, 12, 12), (Group("g", (mark,)),)), 120)))
        return sum(count for count, color in shown.convert("RGB").getcolors(1 << 16) if sum(color) < 384)

    assert ink("M") > 2 * ink("l") > 0
    assert ink("零") > 0


def test_a_warning_names_the_characters_that_the_font_lacks():
    root, show = structure("solid", "零件 \U0001f600", rectangle("r", 0, 0, 10, 10)), frozenset({"names"})
    for suffix in (".png", ".pdf"):
        (note,) = written(root, suffix, show=show).notes
        assert note.code == "W0733"
        assert note.message == (
            "the font has no `零`, `件`, `\U0001f600`; texts in the picture show a box in their place"
        )
    assert written(root, ".svg", show=show).notes == ()


# --- In another scale ------------------------------------------------------------------------------

PIECES: tuple[Piece, ...] = (
    Line((1.0, 2.0), (5.0, -3.0)),
    Arc((1.0, 1.0), 2.0, (3.0, 1.0), (1.0, 3.0), 1.5707963267948966),
    Circle((4.0, 5.0), 3.0),
    Ellipse((2.0, 1.0), 4.0, 2.0, 0.5),
    EllipseArc((0.0, 0.0), 4.0, 2.0, 0.0, (4.0, 0.0), (0.0, 2.0), 0.0, 1.5707963267948966),
    Bezier((0.0, 0.0), (1.0, 4.0), (5.0, 4.0), (6.0, 0.0)),
)
INK = Ink("#102030", 0.5, (2.0, 1.0))
MARKS: tuple[Mark, ...] = (
    Area(Face(Loop((Circle((0.0, 0.0), 9.0),)), (Loop((Circle((1.0, 0.0), 2.0),), True),)), "#ffcc00", INK),
    Curves(PIECES, INK),
    Text((-9.0, 9.0), "text", 2.0, "#000000"),
    Dot((3.0, 3.0), 0.5, "#ff0000"),
    Frame((-5.0, -5.0, 5.0, 5.0), "#00ff00", 0.25, 1.0),
)
PICTURE = Picture((-12.0, -12.0, 12.0, 12.0), (Group("all", MARKS, {}, (-10.0, -10.0, 10.0, 10.0)),))


def test_a_picture_of_any_size_becomes_the_same_pixels() -> None:
    """But for the last shade of what is drawn at the edge of a line."""
    plain = _pixels(scaled(PICTURE, 2.0**8))
    assert len(np.unique(plain)) > 50
    for factor in (2.0**14, 2.0**40, 2.0**90):
        assert np.abs(_pixels(scaled(PICTURE, factor)) - plain).mean() < 0.5


def _pixels(picture: Picture) -> NDArray[np.int64]:
    with Image.open(io.BytesIO(to_png(picture, 200))) as image:
        return np.asarray(image, dtype=np.int64)
