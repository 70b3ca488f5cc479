"""`--sheet`, `--kerf` and `--tile`: what is written, and what is said."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import ezdxf
import pytest

from tests.commands import Aidl, Result
from tests.export.readers import svg_paths

BOX = """\
assembly box {
    @material("birch")
    @thickness(3mm)
    solid side() {
        sheet = rectangle(center: origin, width: 100, height: 50)
        hole bore { c = circle(center: fixed((0, 0)), radius: 10) }
    }
    for i in 0..3 {
        @detached
        s[i] = side() at (0, 60 * i)
    }
    @detached
    solid lid { disc = circle(center: fixed((200, 0)), radius: 30) }
    drawing stray { edge = line(start: fixed((90, 0)), end: fixed((150, 0))) }
}
"""


@pytest.fixture
def box(folder: Path) -> Path:
    (folder / "box.aidl").write_text(BOX)
    return folder


def cuts(file: Path) -> list[Any]:
    return [path for path in svg_paths(file.read_bytes()) if path.values.get("class") == "cut"]


def sizes(file: Path) -> list[tuple[float, float]]:
    """Those of the outlines around parts."""
    boxes = [p.bbox() for p in cuts(file) if p.values["data-operation"] == "outer"]
    return [(round(float(x1 - x0), 3), round(float(y1 - y0), 3)) for x0, y0, x1, y1 in boxes]


def test_one_file_for_each_sheet(aidl: Aidl, box: Path) -> None:
    result = aidl("compile", "box.aidl", "-o", "box.svg", "--sheet", "210x110", "--quiet")
    assert result == Result(0, "", "")
    # Two rows of two make 3 + 100 + 3 + 100 + 3 by 3 + 50 + 3 + 50 + 3; the lid is of another stock.
    assert sizes(box / "box.svg") == [(60, 60)]
    assert sizes(box / "box-2.svg") == [(100, 50)] * 4
    assert not (box / "box-3.svg").exists()
    text = (box / "box-2.svg").read_text()
    assert 'width="210mm"' in text
    assert 'viewBox="0 -110 210 110"' in text
    assert "<text" not in text
    assert set(re.findall(r'fill="([^"]*)"', text)) == {"none"}
    for x0, y0, x1, y1 in (p.bbox() for p in cuts(box / "box-2.svg")):
        assert min(x0, y0) >= 3 - 1e-3
        assert x1 <= 207 + 1e-3
        assert y1 <= 107 + 1e-3


def test_names_are_written_if_asked(aidl: Aidl, box: Path) -> None:
    assert aidl("compile", "box.aidl", "-o", "a.svg", "--sheet", "a4", "--show", "names").code == 0
    assert re.findall(r"<text[^>]*>([^<]*)<", (box / "a-2.svg").read_text()) == [f"s[{k}]" for k in range(4)]


def test_same_program_same_sheets(aidl: Aidl, box: Path) -> None:
    for name in ("a", "b"):
        aidl("compile", "box.aidl", "-o", f"{name}.svg", "-o", f"{name}.dxf", "--sheet", "20x20cm")
    for name in ("a.svg", "a-2.svg", "a.dxf", "a-2.dxf"):
        assert (box / name).read_bytes() == (box / name.replace("a", "b")).read_bytes()


def test_sheets_as_dxf(aidl: Aidl, box: Path) -> None:
    aidl("compile", "box.aidl", "-o", "box.dxf", "--sheet", "210x110")
    space = ezdxf.readfile(box / "box-2.dxf").modelspace()
    circles = sorted((c.dxf.center.x, c.dxf.center.y) for c in space.query("CIRCLE"))
    expected = [(x, y) for x in (53, 156) for y in (28, 81)]
    assert [pytest.approx(c) for c in circles] == expected
    assert {c.dxf.radius for c in space.query("CIRCLE")} == {10}
    assert {c.dxf.layer for c in space.query("CIRCLE")} == {"hole"}
    assert len(space.query("LWPOLYLINE")) == 4


@pytest.mark.parametrize("sheet", [(), ("--sheet", "a4")])
def test_kerf_grows_outlines_and_shrinks_holes(aidl: Aidl, box: Path, sheet: tuple[str, ...]) -> None:
    options = ("--kerf", "0.2mm", *sheet)
    aidl("compile", "box.aidl", "-o", "box.svg", "-o", "box.dxf", *options)
    number = "-2" if sheet else ""
    found = [size for size in sizes(box / f"box{number}.svg") if size[1] < 60]
    assert found == [(100.2, 50.2)] * 4
    space = ezdxf.readfile(box / f"box{number}.dxf").modelspace()
    assert sorted({round(c.dxf.radius, 9) for c in space.query("CIRCLE")}) == (
        [9.9] if sheet else [9.9, 30.1]
    )


def test_units_of_sheets(aidl: Aidl, folder: Path) -> None:
    for text, width, height in (("60x40cm", 600, 400), ("24 x 18in", 609.6, 457.2), ("Letter", 215.9, 279.4)):
        assert aidl("compile", "good.aidl", "-o", "x.svg", "--sheet", text).code == 0
        found = re.search(r'viewBox="0 -([\d.]+) ([\d.]+) ([\d.]+)"', (folder / "x.svg").read_text())
        assert found
        assert [float(v) for v in found.groups()] == [height, width, height]


def test_tiles_are_files(aidl: Aidl, box: Path) -> None:
    result = aidl("compile", "box.aidl", "-o", "page.svg", "--tile", "a5", "--cut")
    # The drawing is 280 × 255 mm (to the rim of the lid and the last side); a page shows 128 × 190.
    columns, rows = math.ceil((280 - 10) / 118), math.ceil((255 - 10) / 180)
    assert (columns, rows) == (3, 2)
    assert result.err.startswith("page.svg, page-2.svg, page-3.svg, page-4.svg, page-5.svg: solved")
    assert ">5/5: row 2, column 3<" in (box / "page-5.svg").read_text()


NEST = ("compile", "box.aidl", "-o", "box.svg", "--sheet", "210x110", "--nest", "1", "--quiet")


def test_nesting_needs_its_package(aidl: Aidl, box: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert aidl(*NEST) == Result(0, "", "")
    assert sizes(box / "box.svg") == [(60, 60)]
    monkeypatch.setattr("aidl_lang.export.job.find_spec", lambda _: None)
    missing = "error[E0913]: `--nest` needs a package that is not installed\n"
    assert aidl(*NEST) == Result(2, "", missing + "  = hint: pip install 'aidl-lang[nest]'\n")


def test_a_packer_that_gives_up_is_told(aidl: Aidl, box: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class PanicException(BaseException):
        pass

    def panicking(*_: object) -> None:
        raise PanicException("an empty polygon")

    monkeypatch.setattr("spyrrow.StripPackingInstance", panicking)
    told = "error[E0924]: the parts could not be packed by their outlines: an empty polygon\n"
    hint = "  = hint: leave `--nest` out: they are packed by their boxes then\n"
    assert aidl(*NEST) == Result(2, "", told + hint)


def test_kinds_of_dxf_and_their_tolerance(aidl: Aidl, folder: Path) -> None:
    (folder / "egg.aidl").write_text("solid egg { e = ellipse(rx: 40, ry: 25) }")
    sizes = {}
    for options in ((), ("--tolerance", "0.0001mm"), ("--dxf", "r12"), ("--dxf", "splines")):
        assert aidl("compile", "egg.aidl", "-o", "egg.dxf", "--quiet", *options) == Result(0, "", "")
        text = (folder / "egg.dxf").read_text()
        (kind,) = {"ELLIPSE", "LWPOLYLINE", "POLYLINE"} & {line.strip() for line in _entities(text)}
        sizes[kind, options] = sum(line.strip() == "42" for line in _entities(text))
    assert [kind for kind, _ in sizes] == ["LWPOLYLINE", "LWPOLYLINE", "POLYLINE", "ELLIPSE"]
    coarse, fine, *_ = sizes.values()
    assert 0 < 2 * coarse < fine


def _entities(text: str) -> list[str]:
    return text.partition("ENTITIES")[2].partition("ENDSEC")[0].splitlines()
