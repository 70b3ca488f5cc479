"""The workshop's view of `aidl compile`: profiles, quantities, cut lists, one file for each part."""

from __future__ import annotations

import csv
import io
import math
import re
from codecs import BOM_UTF8
from operator import attrgetter
from pathlib import Path

import ezdxf
import pypdfium2
import pytest
import shapely
from shapely import LineString, Polygon, unary_union

from aidl_lang import AidlError
from tests import compiled
from tests.commands import Aidl, Result
from tests.export.readers import read_mesh

BOX = """\
@thickness(3mm)
assembly box {
    @material("birch")
    solid side() {
        sheet = rectangle(center: origin, width: 100, height: 50)
        hole bore { c = circle(center: fixed((0, 0)), radius: 10) }
    }
    for i in 0..3 {
        @detached
        s[i] = side() at (0, 60 * i) rotated 30deg * i
    }
    @detached @quantity(3)
    solid lid { disc = circle(center: fixed((200, 0)), radius: 30) }
    @detached @material("birch")
    solid strip { o = rectangle(center: fixed((300, 0)), width: 150, height: 8, angle: 30deg) }
}
"""
HEAD = "number,part,quantity,material,thickness_mm,width_mm,height_mm,area_mm2,cut_mm"

SHEETS = "sheet,material,thickness_mm,pieces,numbers,used_percent,cut_mm"


@pytest.fixture
def box(folder: Path) -> Path:
    (folder / "box.aidl").write_text(BOX)
    return folder


# --- Profiles ------------------------------------------------------------------------------------


def test_a_profile_by_name_or_from_a_file(aidl: Aidl, box: Path) -> None:
    (box / "shop.toml").write_text('base = "ponoko"\n[outer]\ncolor = "#123456"\n')
    assert aidl("compile", "box.aidl", "-o", "a.svg", "--profile", "ponoko", "--quiet") == Result(0, "", "")
    assert aidl("compile", "box.aidl", "-o", "b.svg", "--profile", "shop.toml", "--quiet").code == 0
    before, after = ((box / name).read_text() for name in ("a.svg", "b.svg"))
    assert set(re.findall('stroke="(#[^"]*)"', before)) == {"#0000ff"}
    assert set(re.findall('stroke="(#[^"]*)"', after)) == {"#0000ff", "#123456"}


def test_keywords_of_python_have_profiles_too(folder: Path) -> None:
    model = compiled.model("solid p { r = rectangle(width: 20, height: 10) }")
    assert b'stroke="#a00000"' in model.export("svg", profile="lightburn")
    with pytest.raises(AidlError, match="there is no profile `lightbrn`"):
        model.export("svg", profile="lightbrn")


# --- Quantities and lists ------------------------------------------------------------------------


def rows(file: Path) -> list[list[str]]:
    data = file.read_bytes()
    assert data.startswith(BOM_UTF8)
    text = data.decode("utf-8-sig")
    return list(csv.reader(io.StringIO(text)))


def test_the_cut_list_of_sheets(aidl: Aidl, box: Path) -> None:
    sheet = ("--sheet", "210x150", "--kerf", "0.2", "--quiet")
    aidl("compile", "box.aidl", "-o", "cut.csv", "-o", "x.svg", *sheet)
    parts, sheets = rows(box / "cut.csv")[1:4], rows(box / "cut.csv")[6:]
    assert rows(box / "cut.csv")[4] == []
    assert ",".join(rows(box / "cut.csv")[5]) == SHEETS
    assert sum(int(sheet[3]) for sheet in sheets) == sum(int(part[2]) for part in parts) == 8
    assert [sheet[:2] for sheet in sheets] == [["1", ""], ["2", "birch"], ["3", "birch"]]
    cut = sum(int(part[2]) * float(part[8]) for part in parts)
    assert sum(float(sheet[6]) for sheet in sheets) == pytest.approx(cut, abs=0.01)
    assert float(sheets[0][5]) == pytest.approx(100 * 3 * 2827.433 / (210 * 150), abs=0.06)
    assert len(list(box.glob("x*.svg"))) == 3


def test_parts_lie_as_their_own_frames_do(aidl: Aidl, box: Path) -> None:
    """The sides are turned by 0, 30, 60 and 90 degrees where they are drawn."""
    aidl("compile", "box.aidl", "-o", "x.dxf", "--sheet", "600x400", "--quiet")
    space = ezdxf.readfile(box / "x-2.dxf").modelspace()
    shapes = [Polygon(e.get_points("xy")) for e in space.query("LWPOLYLINE")]
    sides = [shape.bounds for shape in shapes if shape.area > 2000]
    assert [sorted((round(x1 - x0, 6), round(y1 - y0, 6))) for x0, y0, x1, y1 in sides] == [[50, 100]] * 4


def test_a_part_that_fits_at_a_slant_only_when_turned(aidl: Aidl, box: Path) -> None:
    """150 mm at 30 degrees are 134 × 82 mm; upright they fit on a strip of 20 mm."""
    text = BOX[BOX.index("@detached @material") : BOX.rindex("}")]
    (box / "strip.aidl").write_text(text.strip())
    assert aidl("compile", "strip.aidl", "-o", "x.dxf", "--sheet", "160x20", "--quiet").code == 0
    (strip,) = ezdxf.readfile(box / "x.dxf").modelspace()
    assert Polygon(strip.get_points("xy")).bounds == pytest.approx((3, 3, 153, 11), abs=1e-3)


def test_numbers_and_names_and_the_list_on_pages(aidl: Aidl, box: Path) -> None:
    sheet = ("--sheet", "210x150", "--show", "numbers,list", "--quiet")
    assert aidl("compile", "box.aidl", "-o", "x.svg", "-o", "x.pdf", "-o", "x.png", *sheet).code == 0
    texts = [re.findall(r"<text[^>]*>([^<]*)<", (box / f"x{n}.svg").read_text()) for n in ("", "-2", "-3")]
    assert sorted(texts[0]) == ["1", "1", "1"]
    assert sorted(texts[1] + texts[2]) == ["2", "2", "2", "2", "3"]
    listed = re.findall(r"<text[^>]*>([^<]*)<", (box / "x-4.svg").read_text())
    assert listed[0] == "Parts: lengths in mm, areas in mm²"
    assert listed[1:10] == ["No.", "Part", "Qty", "Material", "Thick", "Width", "Height", "Area", "Cut"]
    assert listed[10:14] == ["1", "lid", "3", ""] or listed[10:13] == ["1", "lid", "3"]
    assert {"4685.8", "362.8", "birch"} <= set(listed)
    assert "565.5" in (box / "x-5.svg").read_text()
    assert not (box / "x-6.svg").exists()
    with pypdfium2.PdfDocument(box / "x.pdf") as made:
        assert len(made) == 5
        millimetres = [tuple(round(side * 25.4 / 72, 3) for side in page.get_size()) for page in made]
        assert millimetres[:3] == [(210, 150)] * 3
        assert "birch" in made[3].get_textpage().get_text_bounded()


def test_numbers_in_dxf_are_on_a_layer_that_is_not_plotted(aidl: Aidl, box: Path) -> None:
    for kind in ("arcs", "r12"):
        sheet = ("--sheet", "210x150", "--dxf", kind, "--show", "numbers,names,list")
        aidl("compile", "box.aidl", "-o", "x.dxf", *sheet)
        found = ezdxf.readfile(box / "x.dxf")
        texts = found.modelspace().query("TEXT")
        assert sorted(text.dxf.text for text in texts) == ["1 lid"] * 3
        assert {text.dxf.layer for text in texts} == {"labels"}
        if kind == "arcs":
            assert found.layers.get("labels").dxf.plot == 0
        discs = [(c.dxf.center.x, c.dxf.center.y) for c in found.modelspace().query("CIRCLE")]
        for text, (x, y) in zip(texts, discs, strict=True):
            assert abs(text.dxf.align_point.x - x) < 0.1
            assert abs(text.dxf.align_point.y - y) < 2


def test_numbers_lie_in_the_material_beside_what_is_engraved(aidl: Aidl, folder: Path) -> None:
    (folder / "p.aidl").write_text(
        "solid p { r = rectangle(center: origin, width: 60, height: 30)\n"
        "hole h { c = rectangle(center: fixed((0, 0)), width: 40, height: 20) }\n"
        "drawing d { l = line(fixed((25, -15)), fixed((25, 15))) } }"
    )
    aidl("compile", "p.aidl", "-o", "x.svg", "--sheet", "80x50", "--show", "numbers", "--quiet")
    found = re.search(
        r'<text[^>]*font-size="([^"]*)"[^>]*x="([^"]*)" y="([^"]*)"', (folder / "x.svg").read_text()
    )
    assert found
    size, x, y = (float(v) for v in found.groups())
    left, right, middle = x - 0.3 * size, x + 0.3 * size, -y + 0.3 * size
    frame = shapely.box(3, 3, 63, 33) - shapely.box(13, 8, 53, 28)
    assert frame.contains(shapely.box(left, middle - size / 2, right, middle + size / 2))
    assert not left < 58 < right
    assert size > 3


def test_a_material_is_no_formula(aidl: Aidl, folder: Path) -> None:
    text = '@material("=1+1") solid p { r = rectangle(width: 20, height: 10) }'
    aidl("compile", "-", "-o", "x.csv", stdin=text)
    assert rows(folder / "x.csv")[1][3] == "'=1+1"


def test_quantities_multiply(aidl: Aidl, folder: Path) -> None:
    text = "@quantity(3) assembly a { @quantity(4) solid p { r = rectangle(width: 20, height: 10) } }"
    aidl("compile", "-", "-o", "x.csv", stdin=text)
    assert rows(folder / "x.csv")[1][2] == "12"


# --- One file for each part ----------------------------------------------------------------------


def test_one_file_for_each_part_in_every_format(aidl: Aidl, box: Path) -> None:
    patterns = [f"parts/{{part}}.{suffix}" for suffix in ("dxf", "svg", "pdf", "png", "stl", "3mf", "step")]
    outputs = [word for pattern in patterns for word in ("-o", pattern)]
    result = aidl("compile", "box.aidl", *outputs, "-o", "made/{material}/{number}.dxf")
    assert result.code == 0
    assert "\nparts/lid.dxf, parts/s.dxf, parts/strip.dxf, parts/lid.svg, " in result.err
    assert " and 16 more: solved" in result.err
    assert sorted(path.name for path in (box / "parts").iterdir()) == sorted(
        f"{part}.{pattern.rpartition('.')[2]}" for pattern in patterns for part in ("lid", "s", "strip")
    )
    assert sorted(str(p.relative_to(box)) for p in (box / "made").rglob("*.dxf")) == [
        "made/birch/2.dxf",
        "made/birch/3.dxf",
        "made/no-material/1.dxf",
    ]
    for name, volume in (("s", 3 * 4685.841), ("strip", 3600), ("lid", 3 * 2827.433)):
        for suffix in ("stl", "3mf"):
            mesh = read_mesh(box / "parts" / f"{name}.{suffix}")
            assert mesh.is_watertight
            assert mesh.volume == pytest.approx(volume, rel=1e-3)
            assert mesh.bounds[0] == pytest.approx([0, 0, 0], abs=0.01)
    (outline,) = ezdxf.readfile(box / "parts" / "s.dxf").modelspace().query("LWPOLYLINE")
    assert Polygon(outline.get_points("xy")).bounds == pytest.approx((0, 0, 100, 50))


def test_parts_beside_their_sheets(aidl: Aidl, box: Path) -> None:
    options = ("--sheet", "210x150", "--kerf", "0.2", "--show", "numbers")
    result = aidl("compile", "box.aidl", "-o", "x.dxf", "-o", "parts/{part}.dxf", *options, "--quiet")
    assert result == Result(0, "", "")
    (disc,) = ezdxf.readfile(box / "parts" / "lid.dxf").modelspace()
    assert disc.dxf.radius == pytest.approx(30.1)
    assert (disc.dxf.center.x, disc.dxf.center.y) == pytest.approx((30.1, 30.1))


def test_parts_that_stand_are_written_flat(aidl: Aidl, folder: Path) -> None:
    text = (
        "@thickness(4mm) assembly a { @orientation(front) @elevation(50) @detached "
        "solid p at fixed((70, 80)) { r = rectangle(center: fixed((0, 0)), width: 20, height: 10) } }"
    )
    aidl("compile", "-", "-o", "{part}.stl", stdin=text)
    mesh = read_mesh(folder / "p.stl")
    assert mesh.bounds.tolist() == [[0, 0, 0], [20, 10, 4]]


def test_names_of_files_are_safe_and_do_not_collide(aidl: Aidl, folder: Path) -> None:
    text = (
        "assembly a { @material('../../etc/passwd') @detached solid con "
        "{ r = circle(center: fixed((0, 0)), radius: 5) }"
        " @material('A') @detached solid Lid { r = circle(center: fixed((20, 0)), radius: 6) }"
        " @material('B') @detached solid lid { r = circle(center: fixed((40, 0)), radius: 7) }"
        " @material('nul.txt') @detached solid q { r = circle(center: fixed((60, 0)), radius: 8) } }"
    ).replace("'", '"')
    aidl("compile", "-", "-o", "out/{part}.svg", "-o", "by/{material}/{part}.svg", stdin=text)
    assert sorted(p.name for p in (folder / "out").iterdir()) == ["Lid.svg", "con_.svg", "lid-2.svg", "q.svg"]
    assert sorted(p.name for p in (folder / "by").iterdir()) == ["A", "B", "etc-passwd", "nul.txt_"]


def test_equal_parts_share_a_file_that_bears_all_their_names(aidl: Aidl, folder: Path) -> None:
    text = (
        "assembly a { solid wall() { r = rectangle(center: origin, width: 40, height: 9) }"
        " @detached front = wall() at (0, 0)  @detached back = wall() at (0, 20) rotated 90deg }"
    )
    aidl("compile", "-", "-o", "{part}.svg", stdin=text)
    assert [p.name for p in folder.glob("*.svg")] == ["front+back.svg"]


def test_python_saves_part_by_part(folder: Path) -> None:
    made = compiled.model(BOX).save(folder / "new" / "{part}.dxf", kerf=0.2)
    assert [path.name for path in made.paths] == ["lid.dxf", "s.dxf", "strip.dxf"]
    assert all(path.is_file() for path in made.paths)


# --- Slits ---------------------------------------------------------------------------------------

HINGE = """\
solid cover {
    sheet = rectangle(center: origin, width: 80, height: 60)
    hole bend { slits = living_hinge(width: 30, height: 60, rows: 2, spacing: 3, slit: 0.2) }
    hole slot { gap = rectangle(center: (-25, 0), width: 0.4, height: 30) }
    constrain bend.center == sheet.center
}
"""


@pytest.mark.parametrize("more", [(), ("--sheet", "200x100")])
def test_slits_are_cut_once(aidl: Aidl, folder: Path, more: tuple[str, ...]) -> None:
    """What a cut of 0.2 mm leaves is the part that is drawn, but for the corners of its openings."""
    (folder / "h.aidl").write_text(HINGE)
    result = aidl("compile", "h.aidl", "-o", "h.dxf", "--kerf", "0.2", "--profile", "lightburn", *more)
    assert "N0757" not in result.err
    assert result.code == 0
    found = list(ezdxf.readfile(folder / "h.dxf").modelspace())
    lines = [LineString([e.dxf.start.vec2, e.dxf.end.vec2]) for e in found if e.dxftype() == "LINE"]
    areas = [Polygon(e.get_points("xy")) for e in found if e.dxftype() == "LWPOLYLINE"]
    slot, outer = sorted(areas, key=attrgetter("area"))
    assert len(lines) == 27
    assert {e.dxf.layer for e in found if e.dxftype() == "LINE"} == {"C05-inner"}
    ways = [*lines, outer.exterior, slot.exterior]
    left = (outer - slot).difference(unary_union([way.buffer(0.1, 64) for way in ways]))
    # A round cut leaves something in each corner: of a slit two at each end, and 10 of them have one end.
    corners = 2 * (2 * 27 - 10) + 4
    drawn = compiled.compiled(HINGE).drawing.measures["cover"].area
    assert left.area == pytest.approx(drawn + corners * 0.1**2 * (1 - math.pi / 4), abs=1e-3)
