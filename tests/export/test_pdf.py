"""PDF files, read back with pdfium: sizes, curves, pixels, texts, pages."""

from __future__ import annotations

import math

import pytest
from pypdfium2 import PdfDocument

from aidl_lang.export import export
from aidl_lang.export.job import ExportError, Job, Options
from aidl_lang.export.marks import Area, Curves, Dot, Frame, Group, Ink, Picture, Text
from aidl_lang.export.pdf import to_pdf
from aidl_lang.geometry.curves import Bezier, Circle, Ellipse, EllipseArc, Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.region import Face, Loop
from aidl_lang.geometry.solved import SolvedStructure
from tests.export.colours import near
from tests.export.readers import read_pdf
from tests.geometry.models import circle, model, rectangle, structure

MM = 25.4 / 72
PLATE = structure(
    "solid",
    "plate",
    rectangle("r", 0, 0, 100, 50),
    structure("hole", "bore", circle("c", 25, 25, 10)),
    color=("teal",),
)


def written(root: SolvedStructure, options: Options | None = None) -> bytes:
    m = model(root)
    return export(Job(m, draw(m)[0], options=options or Options()), ".pdf").data


def of(*marks: object, box: tuple[float, float, float, float] = (0, 0, 100, 100)) -> bytes:
    return to_pdf([Picture(box, (Group("g", tuple(marks)),))], "test")  # type: ignore[arg-type]


def test_material_and_holes():
    page = PdfDocument(written(PLATE))[0]
    shown = page.render(scale=3).to_pil()
    per_mm = shown.width / 106

    def at(x: float, y: float) -> tuple[int, ...]:
        return shown.getpixel((round(per_mm * (x + 3)), round(per_mm * (53 - y))))

    for spot in [(2, 2), (98, 48), (50, 25), (25, 37)]:
        assert near(at(*spot), (0, 128, 128)), spot
    for spot in [(25, 25), (33, 25), (-2, 25)]:
        assert near(at(*spot), (255, 255, 255)), spot


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
    document = PdfDocument(written(PLATE, Options(tile=(105, 105))))
    assert len(document) == 2
    assert all([MM * s for s in page.get_size()] == pytest.approx([105, 105], abs=1e-3) for page in document)


def test_a_page_that_is_too_large():
    with pytest.raises(ExportError) as reason:
        written(structure("solid", "s", rectangle("r", 0, 0, 12000, 3000)))
    assert reason.value.diagnostic.code == "E0921"
    assert str(reason.value) == ("the picture measures 12720 × 3720 mm, and a page of a PDF ends at 5080 mm")
