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


def refused(result: Result) -> list[str]:
    assert result.code == 2
    return result.err.splitlines()


# --- Profiles ------------------------------------------------------------------------------------


def test_a_profile_by_name_or_from_a_file(aidl: Aidl, box: Path) -> None:
    (box / "shop.toml").write_text('base = "ponoko"\n[outer]\ncolor = "#123456"\n')
    assert aidl("compile", "box.aidl", "-o", "a.svg", "--profile", "ponoko", "--quiet") == Result(0, "", "")
    assert aidl("compile", "box.aidl", "-o", "b.svg", "--profile", "shop.toml", "--quiet").code == 0
    before, after = ((box / name).read_text() for name in ("a.svg", "b.svg"))
    assert set(re.findall('stroke="(#[^"]*)"', before)) == {"#0000ff"}
    assert set(re.findall('stroke="(#[^"]*)"', after)) == {"#0000ff", "#123456"}


def test_profiles_that_are_none(aidl: Aidl, box: Path) -> None:
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--profile", "lightbrn")) == [
        "error[E0956]: there is no profile `lightbrn`",
        "  = hint: did you mean `lightburn`?",
        "  = hint: there are `plain`, `lightburn`, `glowforge` and `ponoko`; a file is called as in "
        "`shop.toml`",
    ]
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--profile", "none.toml")) == [
        "error[E0901]: there is no file `none.toml`"
    ]
    (box / "shop.toml").write_text("[layers]\nx = 1")
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--profile", "shop.toml")) == [
        "error[E0957]: the profile `shop.toml` cannot be used: `layers.x` is the name of an operation, or a "
        "table, not `1`"
    ]
    assert refused(aidl("compile", "box.aidl", "-o", "x.step", "--profile", "plain"))[0] == (
        "error[E0924]: `--profile` has no meaning for `.step`"
    )
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--profile", "plain", "--theme", "ink"))[0] == (
        "error[E0924]: `--theme ink` colours a picture, and a cutter goes by colours of its own"
    )
    assert not list(box.glob("x.*"))


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


def test_the_cut_list(aidl: Aidl, box: Path) -> None:
    """Equal parts are one item however they are turned; the strip is measured along itself."""
    assert aidl("compile", "box.aidl", "-o", "cut.csv", "--quiet") == Result(0, "", "")
    assert rows(box / "cut.csv") == [
        HEAD.split(","),
        ["1", "lid", "3", "", "3", "60", "60", "2827.433", "188.496"],
        ["2", "s", "4", "birch", "3", "100", "50", "4685.841", "362.832"],
        ["3", "strip", "1", "birch", "3", "150", "8", "1200", "316"],
    ]


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
        result = aidl(
            *("compile", "box.aidl", "-o", "x.dxf", "--sheet", "210x150", "--dxf", kind),
            *("--show", "numbers,names,list"),
        )
        assert "note[N0755]: the cut list is drawn in pictures, and `.dxf` is none" in result.err
        assert "hint: write it beside: `-o cutlist.csv`, or `-o cutlist.pdf`" in result.err
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


def test_what_is_of_sheets_needs_sheets(aidl: Aidl, box: Path) -> None:
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--show", "list,numbers")) == [
        "error[E0924]: `--show list,numbers` is about the parts on sheets, and there are none",
        "  = hint: lay them on sheets: `--sheet 600x400`",
        "  = hint: the list alone is written by `-o cutlist.csv`",
    ]
    assert refused(aidl("show", "box.aidl", "--show", "numbers"))[0] == (
        "error[E0924]: `--show numbers` is about the parts on sheets, and there are none"
    )
    text = "drawing d { l = line(start: (0, 0), end: (9, 0)) }"
    assert refused(aidl("compile", "-", "-o", "x.csv", stdin=text)) == [
        "error[E0924]: there is no part to list",
        "  = hint: only a `solid` is cut; a `drawing` is engraved on it",
    ]


def test_a_material_is_no_formula(aidl: Aidl, folder: Path) -> None:
    text = '@material("=1+1") solid p { r = rectangle(width: 20, height: 10) }'
    aidl("compile", "-", "-o", "x.csv", stdin=text)
    assert rows(folder / "x.csv")[1][3] == "'=1+1"


@pytest.mark.parametrize("given", ["(0)", "(1.5)", "(3mm)", "", "(1e9)"])
def test_quantities_that_are_none(given: str) -> None:
    found = compiled.compiled(f"@quantity{given} solid p {{ r = rectangle(width: 20, height: 10) }}")
    assert [(d.code, d.message) for d in found.diagnostics if d.is_error] == [
        ("E0517", "`@quantity` takes a whole number of pieces from 1 to 1000, as in `@quantity(4)`")
    ]


def test_a_quantity_is_of_parts() -> None:
    text = "solid p { r = rectangle(width: 20, height: 10) @quantity(2) hole h { c = circle(radius: 2) } }"
    (error,) = (d for d in compiled.compiled(text).diagnostics if d.is_error)
    assert (error.code, error.message) == (
        "E0517",
        "`@quantity` is said of parts to be made, and `h` is a hole",
    )
    assert error.hints == ("put `@quantity(2)` before a `solid` or an `assembly`",)


def test_quantities_multiply_and_are_bounded(aidl: Aidl, folder: Path) -> None:
    text = "@quantity({0}) assembly a {{ @quantity({1}) solid p {{ r = rectangle(width: 20, height: 10) }} }}"
    aidl("compile", "-", "-o", "x.csv", stdin=text.format(3, 4))
    assert rows(folder / "x.csv")[1][2] == "12"
    assert refused(aidl("compile", "-", "-o", "x.svg", "--sheet", "a4", stdin=text.format(900, 900)))[0] == (
        "error[E0924]: 810000 parts are more than the 5000 that are laid on sheets"
    )


# --- One file for each part ----------------------------------------------------------------------


def test_one_file_for_each_part_in_every_format(aidl: Aidl, box: Path) -> None:
    patterns = [f"parts/{{part}}.{suffix}" for suffix in ("dxf", "svg", "pdf", "png", "stl", "3mf", "step")]
    outputs = [word for pattern in patterns for word in ("-o", pattern)]
    result = aidl("compile", "box.aidl", *outputs, "-o", "made/{material}/{number}.dxf")
    assert result.code == 0
    assert result.err.splitlines()[:2] == [
        "note[N0759]: a file has one piece, and several are to be cut: `lid` ×3 and `s` ×4",
        "  = hint: `{quantity}` in the name of an output says how many: `{number}-{part}-x{quantity}`",
    ]
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


def test_the_name_of_a_part_says_how_many(aidl: Aidl, box: Path) -> None:
    result = aidl("compile", "box.aidl", "-o", "{number}-{part}-x{quantity}.dxf")
    assert "N0759" not in result.err
    assert sorted(p.name for p in box.glob("*.dxf")) == ["1-lid-x3.dxf", "2-s-x4.dxf", "3-strip-x1.dxf"]


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
    result = aidl("compile", "-", "-o", "out/{part}.svg", "-o", "by/{material}/{part}.svg", stdin=text)
    assert sorted(p.name for p in (folder / "out").iterdir()) == ["Lid.svg", "con_.svg", "lid-2.svg", "q.svg"]
    assert sorted(p.name for p in (folder / "by").iterdir()) == ["A", "B", "etc-passwd", "nul.txt_"]
    assert (
        "warning[W0758]: `out/{part}.svg` gives several parts one name: `out/lid-2.svg` is numbered"
    ) in result.err
    assert "hint: `{number}` tells them apart: `{number}-{part}`" in result.err


def test_equal_parts_share_a_file_that_bears_all_their_names(aidl: Aidl, folder: Path) -> None:
    text = (
        "assembly a { solid wall() { r = rectangle(center: origin, width: 40, height: 9) }"
        " @detached front = wall() at (0, 0)  @detached back = wall() at (0, 20) rotated 90deg }"
    )
    aidl("compile", "-", "-o", "{part}.svg", stdin=text)
    assert [p.name for p in folder.glob("*.svg")] == ["front+back.svg"]


def test_patterns_that_are_none(aidl: Aidl, box: Path) -> None:
    assert refused(aidl("compile", "box.aidl", "-o", "{prt}.dxf")) == [
        "error[E0926]: `{prt}` in `{prt}.dxf` stands for nothing",
        "  = hint: did you mean `{part}`?",
    ]
    assert refused(aidl("compile", "box.aidl", "-o", "{x}{part}.dxf"))[1] == (
        "  = hint: there are `{part}`, `{number}`, `{material}` and `{quantity}`"
    )
    assert refused(aidl("compile", "box.aidl", "-o", "{material}.dxf")) == [
        "error[E0926]: `{material}.dxf` is one name for several parts",
        "  = hint: name them apart: with `{part}`, or with `{number}`",
    ]
    for suffix in ("json", "csv"):
        assert refused(aidl("compile", "box.aidl", "-o", f"{{part}}.{suffix}")) == [
            f"error[E0926]: `.{suffix}` tells of the whole, and is not written part by part",
            "  = hint: give it a name without `{part}`",
        ]
    for option in (("--dimension",), ("--show", "names")):
        assert refused(aidl("compile", "box.aidl", "-o", "{part}.svg", *option)) == [
            f"error[E0926]: `{' '.join(option)}` explains the whole drawing and has no place in files of "
            "single parts",
            "  = hint: write it to a file of its own",
        ]
    for option in (("--kerf", "0.1"), ("--profile", "plain")):
        assert refused(aidl("compile", "box.aidl", "-o", "{part}.stl", *option))[0] == (
            f"error[E0924]: `{option[0]}` has no meaning for `.stl`"
        )
    text = "drawing d { l = line(start: (0, 0), end: (9, 0)) }"
    assert refused(aidl("compile", "-", "-o", "{part}.svg", stdin=text)) == [
        "error[E0926]: there is no part to write",
        "  = hint: only a `solid` is cut; a `drawing` is engraved",
    ]
    (box / "file").write_text("")
    assert refused(aidl("compile", "box.aidl", "-o", "file/{part}.svg")) == [
        "error[E0904]: `file` cannot be made: file exists"
    ]


def test_two_outputs_never_share_a_file(aidl: Aidl, box: Path) -> None:
    for outputs in (("x.svg", "x.svg"), ("x.svg", "./x.svg"), ("x.svg", "x-2.svg")):
        words = [word for name in outputs for word in ("-o", name)]
        assert refused(aidl("compile", "box.aidl", *words, "--sheet", "210x150")) == [
            f"error[E0927]: two outputs go to `{outputs[1]}`, and nothing is written",
            "  = hint: give each a name of its own: further sheets, pages and parts have names made of it",
        ]
    assert not list(box.glob("*.svg"))


def test_python_saves_part_by_part(folder: Path) -> None:
    made = compiled.model(BOX).save(folder / "new" / "{part}.dxf", kerf=0.2)
    assert [path.name for path in made.paths] == ["lid.dxf", "s.dxf", "strip.dxf"]
    assert all(path.is_file() for path in made.paths)


# --- What falls out ------------------------------------------------------------------------------


def test_what_falls_out_is_counted_named_and_measured() -> None:
    """The ring of 16 mm within `ring` and the insides of A and B: all in one warning."""
    text = (
        "@thickness(3) solid sign { plate = rectangle(center: origin, width: 90, height: 40)\n"
        'hole name { letter = text("AB", center: (-15, 0), height: 20)\n'
        "groove = ring(center: fixed((28, 0)), outer_radius: 10, inner_radius: 8) } }"
    )
    (warning,) = (d for d in compiled.compiled(text).diagnostics if d.code == "W0714")
    assert warning.message == "4 pieces fall out of solid `sign`: hole `sign.name` cuts all around them"
    assert (
        warning.label
        == "nothing holds what is inside `groove` and `letter`: 4 pieces, the largest 16 × 16 mm"
    )
    (warning,) = (d for d in compiled.compiled(text.replace('"AB"', '"I"')).diagnostics if d.code == "W0714")
    assert warning.message == "a piece falls out of solid `sign`: hole `sign.name` cuts all around it"
    assert warning.label == "nothing holds what is inside `groove`: 16 × 16 mm"


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


def test_slits_of_another_width_than_the_cut_are_told(aidl: Aidl, folder: Path) -> None:
    (folder / "h.aidl").write_text(HINGE)
    for kerf, widths in (("0.15", "0.15 mm wide, as the cut, and drawn 0.2"), ("0.3", "0.3")):
        told = aidl("compile", "h.aidl", "-o", "h.dxf", "--kerf", kerf).err
        count = 27 if kerf == "0.15" else 28
        assert f"note[N0757]: {count} slits of `cover` are cut in one pass: {widths}" in told
    assert "and drawn 0.2 and 0.4 mm wide" in told
    assert "N0757" not in aidl("compile", "h.aidl", "-o", "h.dxf", "--kerf", "0.1").err
