"""Pictures over several pages: all of it is there, 1:1, and what two pages share is the same."""

from __future__ import annotations

import io
import re
from itertools import pairwise
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st
from svgelements import SVG, Path

from aidl_lang.export.marks import Area, Curves, Dot, Group, Ink, Picture, Text
from aidl_lang.export.picture import tiled
from aidl_lang.geometry.curves import Circle, Line, Vec
from aidl_lang.geometry.region import Face, Loop
from tests.amount import tries
from tests.export.making import written
from tests.geometry.models import circle, polygon, structure

INK = Ink("#000000", 0.1)
A4 = (210.0, 297.0)


def window(page: Picture, margin: float = 10) -> tuple[float, float, float, float]:
    left, bottom, right, top = page.box
    return left + margin, bottom + margin, right - margin, top - margin


def names(page: Picture) -> list[str]:
    return [group.name for group in page.groups]


def label(page: Picture) -> str:
    return [m.text for m in page.groups[-1].marks if isinstance(m, Text)][-1]


def frame(w: float, h: float) -> Loop:
    corners: list[Vec] = [(0, 0), (w, 0), (w, h), (0, h), (0, 0)]
    return Loop(tuple(Line(p, q) for p, q in pairwise(corners)))


def one(*marks, box) -> Picture:
    return Picture(box, (Group("g", marks),))


@tries(60)
@given(
    st.floats(-1e3, 1e3),
    st.floats(-1e3, 1e3),
    st.floats(1, 1500),
    st.floats(1, 1500),
    st.sampled_from([A4, (297.0, 210.0), (148.0, 210.0)]),
    st.floats(0, 30),
)
def test_every_point_is_on_a_page(x, y, w, h, page, overlap):
    lines = (Line((x, y), (x + w, y + h)), Line((x, y + h), (x + w, y)))
    round_one = Circle((x + w / 2, y + h / 2), min(w, h) / 2)
    marks = (Curves(lines, INK), Curves((round_one,), INK))
    found = tiled(one(*marks, box=(x, y, x + w, y + h)), page, overlap=overlap)
    assert all((p.width, p.height) == pytest.approx(page) for p in found)
    for number, piece in enumerate((*lines, round_one)):
        for k in range(101):
            px, py = piece.point(k / 100)
            on = [
                p
                for p in found
                for left, bottom, right, top in [window(p)]
                if left - 1e-9 <= px <= right + 1e-9 and bottom - 1e-9 <= py <= top + 1e-9
            ]
            assert on
            assert all(names(p)[0] == "g" and marks[number // 2] in p.groups[0].marks for p in on)


def test_pages_come_in_reading_order_and_say_where_they_belong():
    # Windows of 190 × 277 mm and 10 mm of overlap: 180 + 190 covers 370, 267 + 277 covers 544.
    box = (0.0, 0.0, 370.0, 544.0)
    found = tiled(one(Area(Face(frame(370, 544)), "#ff0000", INK), box=box), A4)
    assert [label(p) for p in found] == [
        "1/4: row 1, column 1",
        "2/4: row 1, column 2",
        "3/4: row 2, column 1",
        "4/4: row 2, column 2",
    ]
    assert [window(p) for p in found] == [
        pytest.approx((0, 267, 190, 544)),
        pytest.approx((180, 267, 370, 544)),
        pytest.approx((0, 0, 190, 277)),
        pytest.approx((180, 0, 370, 277)),
    ]


def test_dots_and_texts_are_drawn_where_they_are():
    box = (0.0, 0.0, 900.0, 277.0)
    marks = Dot((5, 5), 1, "#000000"), Text((880, 100), "end", 3, "#000000")
    found = tiled(one(*marks, box=box), A4)
    assert [label(p) for p in found] == ["1/2: row 1, column 1", "2/2: row 1, column 5"]
    assert [p.groups[0].marks for p in found] == [marks[:1], marks[1:]]


PLATE = structure(
    "solid",
    "plate",
    polygon("r", (0, 0), (400, 0), (400, 250), (0, 250)),
    structure("hole", "bore", circle("c", 195, 120, 60)),
)


def of_class(svg: SVG, role: str) -> Path:
    *_, last = svg.elements(lambda e: isinstance(e, Path) and e.values.get("class") == role)
    return last


def test_svg_pages_are_true_to_scale_and_clipped():
    made = written(PLATE, ".svg", cut=True, tile=A4)
    documents = [made.data, *made.further]
    assert len(documents) == 3  # 400 mm take three columns of 190 with 10 mm of overlap, 250 mm one row
    for data in documents:
        root = ElementTree.fromstring(data)
        assert (root.get("width"), root.get("height")) == ("210mm", "297mm")
        assert [float(v) for v in root.attrib["viewBox"].split()][2:] == [210, 297]
        svg = SVG.parse(io.BytesIO(data), ppi=25.4)
        left, top, right, bottom = of_class(svg, "cut").bbox()
        assert (right - left, bottom - top) == pytest.approx((400, 250))
        left, _, right, _ = of_class(svg, "scale").bbox()
        assert right - left == pytest.approx(50)
        (clip,) = re.findall(rb'<clipPath id="([^"]+)">', data)
        # Those of the plate, not that of the marks.
        assert data.count(b'clip-path="url(#' + clip + b')"') == data.count(b"data-path") > 0
        rect = root.find(".//{*}clipPath/{*}rect")
        assert (float(rect.attrib["width"]), float(rect.attrib["height"])) == (192, 279)
