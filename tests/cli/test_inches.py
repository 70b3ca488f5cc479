"""Files in inches: the same drawing in the same size, whatever its numbers count."""

from __future__ import annotations

import io
import re
from pathlib import Path
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest
import resvg_py
from ezdxf.bbox import extents
from PIL import Image
from svgelements import SVG
from svgelements import Path as Shape

from tests.commands import Aidl

PLATE = """\
@thickness(3mm)
solid plate {
    body = rounded_rectangle(center: (50.8, 25.4), width: 101.6, height: 50.8, radius: 6)
    hole bore { rim = circle(center: fixed((25.4, 25.4)), diameter: 12.7) }
    hole eye { rim = ellipse(center: fixed((76.2, 25.4)), rx: 12.7, ry: 6.35) }
    @dash(2mm, 1mm) drawing mark {
        l = line(start: fixed((12.7, 12.7)), end: fixed((38.1, 12.7)))
        t = text("Hi", center: (60, 10), height: 5)
    }
}
"""
SIZE = (101.6, 50.8)
"""mm"""


@pytest.fixture
def plate(folder: Path) -> Path:
    (folder / "p.aidl").write_text(PLATE)
    return folder


@pytest.mark.parametrize("kind", ["arcs", "splines", "r12"])
def test_a_dxf_in_inches_says_so_and_is_as_large(aidl: Aidl, plate: Path, kind: str) -> None:
    for units in ("mm", "in"):
        assert aidl("compile", "p.aidl", "--dxf", kind, "--units", units, "-o", f"{units}.dxf").code == 0
    mm, inches = (ezdxf.readfile(plate / f"{units}.dxf") for units in ("mm", "in"))
    if kind != "r12":  # which has no place for a unit
        assert [(d.header["$INSUNITS"], d.header["$MEASUREMENT"]) for d in (mm, inches)] == [(4, 1), (1, 0)]
    assert tuple(extents(inches.modelspace()).size)[:2] == pytest.approx([s / 25.4 for s in SIZE], abs=1e-6)
    assert list(inches.header["$EXTMAX"])[:2] == pytest.approx([s / 25.4 for s in SIZE])
    for one, other in zip(mm.modelspace(), inches.modelspace(), strict=True):
        assert one.dxftype() == other.dxftype()
        assert one.dxf.layer == other.dxf.layer
        assert one.xdata.data.keys() == other.xdata.data.keys()
        a, b = (extents([entity], fast=False) for entity in (one, other))
        assert [25.4 * v for v in (*b.extmin, *b.extmax)] == pytest.approx([*a.extmin, *a.extmax], abs=1e-6)
    (radius,) = (e.dxf.radius for e in inches.modelspace().query("CIRCLE"))
    assert radius == pytest.approx(0.25)
    name = next(e.dxf.linetype for e in inches.modelspace() if e.dxf.linetype.startswith("DASHED"))
    patterns = [
        [t.value for t in d.linetypes.get(name).pattern_tags.tags if t.code == 49] for d in (mm, inches)
    ]
    assert [25.4 * part for part in patterns[1]] == pytest.approx(patterns[0]) == [2, -1]


def test_an_svg_in_inches_says_so_and_is_as_large(aidl: Aidl, plate: Path) -> None:
    for units in ("mm", "in"):
        assert aidl("compile", "p.aidl", "--cut", "--units", units, "-o", f"{units}.svg").code == 0
    root = ElementTree.parse(plate / "in.svg").getroot()
    width, height = root.attrib["width"], root.attrib["height"]
    assert re.fullmatch(r"[\d.]+in", width)
    assert re.fullmatch(r"[\d.]+in", height)
    box = [float(part) for part in root.attrib["viewBox"].split()]
    assert box[2:] == [float(width[:-2]), float(height[:-2])]
    paths = " ".join(p.attrib.get("d", "") for p in root.iter())
    numbers = [float(n) for n in re.findall(r"-?[\d.]+", paths)]
    assert max(map(abs, numbers)) == pytest.approx(4)  # the coordinates themselves
    # A reader makes pixels of both, 96 to the inch.
    boxes = [
        [shape.bbox() for shape in SVG.parse(plate / f"{units}.svg").elements() if isinstance(shape, Shape)]
        for units in ("mm", "in")
    ]
    assert len(boxes[0]) == len(boxes[1]) > 4
    for one, other in zip(*boxes, strict=True):
        assert other == pytest.approx(one, abs=1e-3)


def test_a_picture_in_inches_looks_the_same(aidl: Aidl, plate: Path) -> None:
    (plate / "p.aidl").write_text("@shade(ball)\n" + PLATE)
    pictures = []
    for units in ("mm", "in"):
        assert aidl("compile", "p.aidl", "--units", units, "-o", f"{units}.svg").code == 0
        text = (plate / f"{units}.svg").read_text()
        assert "radialGradient" in text
        text = re.sub(r'(width|height)="([\d.]+)(mm|in)"', r'\1="800"', text)
        png = bytes(resvg_py.svg_to_bytes(svg_string=text))
        pictures.append(np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"), dtype=int))
    assert len(np.unique(pictures[0])) > 20
    apart = np.abs(pictures[0] - pictures[1])
    assert apart.max() <= 16  # along round edges
    assert apart.mean() < 0.01


def test_what_is_imported_in_inches_keeps_its_size(aidl: Aidl, plate: Path) -> None:
    assert aidl("compile", "p.aidl", "--units", "in", "--cut", "-o", "in.svg", "-o", "in.dxf").code == 0
    (plate / "back.aidl").write_text(
        """import "in.svg" as drawn
        import "in.dxf" as cut
        assembly both {
            solid a { o = drawn() }
            solid b at (0, 90) { o = cut() }
            assert a.bb.width in 101.599..101.601 and b.bb.width in 101.599..101.601
            assert a.bb.height in 50.799..50.801 and b.bb.height in 50.799..50.801
        }"""
    )
    read = aidl("check", "back.aidl")
    assert read.code == 0, read.err
