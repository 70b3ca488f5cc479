"""PNG files: pixels where the drawing has material and where it has none, size and resolution."""

from __future__ import annotations

import io

import pytest
from PIL import Image

from aidl_lang.export import export
from aidl_lang.export.job import Job, Options
from aidl_lang.export.marks import Group, Picture, Text
from aidl_lang.export.pdf import to_png
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedStructure
from tests.geometry.models import circle, model, rectangle, structure

PLATE = structure(
    "solid",
    "plate",
    rectangle("r", 0, 0, 100, 50),
    structure("hole", "bore", circle("c", 25, 25, 10)),
    color=("teal",),
)
TEAL, WHITE = (0, 128, 128), (255, 255, 255)


def image(root: SolvedStructure, pixels: int = 1060, *show: str) -> Image.Image:
    m = model(root)
    options = Options(frozenset(show), pixels=pixels)
    return Image.open(io.BytesIO(export(Job(m, draw(m)[0], options=options), ".png").data))


def test_material_holes_and_margins():
    """The margin is 3 mm of 100: at 1060 pixels a millimetre is ten."""
    shown = image(PLATE)
    assert shown.size == (1060, 560)

    def at(x: float, y: float) -> tuple[int, ...]:
        return shown.getpixel((round(10 * (x + 3)), round(10 * (53 - y))))

    for spot in [(2, 2), (98, 48), (25, 10), (50, 25), (25, 36)]:
        assert at(*spot) == TEAL, spot
    for spot in [(25, 25), (33, 25), (25, 33), (-2, 25), (50, 52)]:
        assert at(*spot) == WHITE, spot


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
    m = model(structure("solid", "零件 \U0001f600", rectangle("r", 0, 0, 10, 10)))
    job = Job(m, draw(m)[0], options=Options(frozenset({"names"})))
    for suffix in (".png", ".pdf"):
        (note,) = export(job, suffix).notes
        assert note.code == "W0733"
        assert note.message == (
            "the font has no `零`, `件`, `\U0001f600`; texts in the picture show a box in their place"
        )
    assert export(job, ".svg").notes == ()
