"""`--sheet`, `--kerf` and `--tile`: what is written, and what is said."""

from __future__ import annotations

import io
import math
import re
from pathlib import Path

import pytest
from svgelements import SVG
from svgelements import Path as SvgPath

from aidl_lang.export import FORMATS
from tests.commands import Aidl, Result

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


def paths(file: Path, role: str) -> list[SvgPath]:
    """Those of a class, in mm to three decimals: the reader takes an inch for 1/0.0393701 mm."""
    svg = SVG.parse(io.BytesIO(file.read_bytes()), ppi=25.4)
    return list(svg.elements(lambda e: isinstance(e, SvgPath) and e.values.get("class") == role))


def sizes(file: Path) -> list[tuple[float, float]]:
    """Those of the outlines around parts."""
    boxes = [p.bbox() for p in paths(file, "cut") if p.values["data-operation"] == "outer"]
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
    for x0, y0, x1, y1 in (p.bbox() for p in paths(box / "box-2.svg", "cut")):
        assert min(x0, y0) >= 3 - 1e-3
        assert x1 <= 207 + 1e-3
        assert y1 <= 107 + 1e-3


def test_what_lies_on_no_part_is_told(aidl: Aidl, box: Path) -> None:
    result = aidl("compile", "box.aidl", "-o", "box.svg", "--sheet", "a4")
    assert "warning[W0736]: what of `box.stray.edge` lies on no part is left off the sheets" in result.err
    assert "  --> box.aidl:14:21" in result.err
    assert "hint: a drawing inside a `solid` is laid out with it" in result.err
    assert result.code == 0


def test_names_are_written_if_asked(aidl: Aidl, box: Path) -> None:
    assert aidl("compile", "box.aidl", "-o", "a.svg", "--sheet", "a4", "--show", "names").code == 0
    assert re.findall(r"<text[^>]*>([^<]*)<", (box / "a-2.svg").read_text()) == [
        "s[0]",
        "s[1]",
        "s[2]",
        "s[3]",
    ]


def test_same_program_same_sheets(aidl: Aidl, box: Path) -> None:
    for name in ("a", "b"):
        aidl("compile", "box.aidl", "-o", f"{name}.svg", "-o", f"{name}.dxf", "--sheet", "20x20cm")
    for name in ("a.svg", "a-2.svg", "a.dxf", "a-2.dxf"):
        assert (box / name).read_bytes() == (box / name.replace("a", "b")).read_bytes()


def test_sheets_as_dxf(aidl: Aidl, box: Path) -> None:
    import ezdxf

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
    import ezdxf

    options = ("--kerf", "0.2mm", *sheet)
    aidl("compile", "box.aidl", "-o", "box.svg", "-o", "box.dxf", *options)
    number = "-2" if sheet else ""
    found = [size for size in sizes(box / f"box{number}.svg") if size[1] < 60]
    assert found == [(100.2, 50.2)] * 4
    space = ezdxf.readfile(box / f"box{number}.dxf").modelspace()
    assert sorted({round(c.dxf.radius, 9) for c in space.query("CIRCLE")}) == (
        [9.9] if sheet else [9.9, 30.1]
    )


def refused(result: Result) -> list[str]:
    assert result.code == 2
    return result.err.splitlines()


def test_parts_larger_than_the_sheet(aidl: Aidl, box: Path) -> None:
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--sheet", "90x60"))[:3] == [
        "error[E0923]: `box.s[0]`, `box.s[1]`, `box.s[2]` and 2 more do not fit on a sheet of 90 × 60 mm; "
        "`box.s[0]` measures 100 × 50 mm",
        "  = hint: `box.s[0]` needs a sheet of at least 106 × 56 mm with 3 mm around it",
        "  = hint: to print it on small paper and join the pages, use `--tile a4` in place of `--sheet`",
    ]
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--sheet", "110x60", "--spacing", "1"))[:2] == [
        "error[E0923]: `box.lid` measures 60 × 60 mm and does not fit on a sheet of 110 × 60 mm",
        "  = hint: it needs a sheet of at least 62 × 62 mm with 1 mm around it",
    ]
    assert not (box / "x.svg").exists()


def test_what_sheets_cannot_show(aidl: Aidl, box: Path) -> None:
    sheet = ("--sheet", "a4")
    able = ", ".join(sorted(suffix for suffix, format in FORMATS.items() if format.cuts))
    assert refused(aidl("compile", "box.aidl", "-o", "x.json", *sheet)) == [
        "error[E0924]: `--sheet` has no meaning for `.json`",
        f"  = hint: formats for it: {able}",
    ]
    assert refused(aidl("compile", "box.aidl", "-o", "x.json", "--kerf", "0.1"))[0] == (
        "error[E0924]: `--kerf` has no meaning for `.json`"
    )
    assert refused(aidl("compile", "box.aidl", "-o", "x.dxf", "--tile", "a4"))[0] == (
        "error[E0924]: `--tile` has no meaning for `.dxf`"
    )
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", *sheet, "--show", "names,dof,points")) == [
        "error[E0924]: `--show dof,points` explains the assembled drawing and has no place on cut sheets",
        "  = hint: `--show names,numbers` writes the names and numbers of the parts on them",
    ]
    for cutting in (sheet, ("--cut",), ("--kerf", "0.1")):
        assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--dimension", *cutting)) == [
            "error[E0924]: `--dimension` explains the assembled drawing and has no place among what a cutter "
            "follows",
            "  = hint: write it to a file of its own, without `--cut`, `--profile`, `--sheet` and `--kerf`",
        ]
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", *sheet, "--spacing", "105")) == [
        "error[E0924]: a sheet of 210 × 297 mm has no room within a spacing of 105 mm",
        "  = hint: give a larger `--sheet` or a smaller `--spacing`",
    ]
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--kerf", "21")) == [
        "error[E0924]: holes or gaps of `box.s[0]` are narrower than a cut of 21 mm",
        "  = hint: widen them, or give a smaller `--kerf`",
    ]


def test_nothing_to_cut(aidl: Aidl) -> None:
    text = "drawing d { l = line(start: (0, 0), end: (9, 0)) }"
    assert refused(aidl("compile", "-", "-o", "x.svg", "--sheet", "a4", stdin=text)) == [
        "error[E0924]: there is no part to lay on a sheet",
        "  = hint: only a `solid` is cut; a `drawing` is engraved on it",
    ]


def test_too_many_parts(aidl: Aidl, box: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("aidl_lang.export.sheets.MOST_PARTS", 4)
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--sheet", "a4")) == [
        "error[E0924]: 5 parts are more than the 4 that are laid on sheets",
        "  = hint: draw them in several programs",
    ]


def test_several_sheets_do_not_fit_on_standard_output(aidl: Aidl, box: Path) -> None:
    assert refused(aidl("compile", "box.aidl", "-o", "-", "--sheet", "a4"))[0] == (
        "error[E0914]: 2 files do not fit on standard output"
    )


@pytest.mark.parametrize(
    "text", ["600", "0x10", "axb", "600x400furlongs", "nanxnan", "1e9x1e9", "600x400x3", "a9", ""]
)
def test_sizes_that_are_none(aidl: Aidl, text: str) -> None:
    for option in ("--sheet", "--tile"):
        lines = refused(aidl("compile", "good.aidl", option, text))
        assert lines[-1] == (
            f"aidl compile: error: argument {option}: expected a size such as 600x400, 60x40cm or 24x18in, "
            f"or one of a0, a1, a2, a3, a4, a5, letter, legal, tabloid, not `{text}`"
        )


@pytest.mark.parametrize("text", ["-3", "three", "nan", "3 parsec", "3deg"])
def test_lengths_that_are_none(aidl: Aidl, text: str) -> None:
    lines = refused(aidl("compile", "good.aidl", f"--kerf={text}"))
    assert lines[-1] == (
        f"aidl compile: error: argument --kerf: expected a length such as 3, 0.15mm or 0.1in, not `{text}`"
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
    labels = [
        re.search(r">(\d/\d: row \d, column \d)<", (box / f"page{k}.svg").read_text())
        for k in ("", "-2", "-3", "-4", "-5")
    ]
    assert [m and m[1] for m in labels] == [
        "1/5: row 1, column 1",
        "2/5: row 1, column 2",
        "3/5: row 2, column 1",
        "4/5: row 2, column 2",
        "5/5: row 2, column 3",
    ]


def test_nesting_is_of_sheets_and_needs_its_package(
    aidl: Aidl, box: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--nest"))[0] == (
        "error[E0924]: `--nest` packs parts on sheets, and there is none"
    )
    assert aidl("compile", "box.aidl", "-o", "x.svg", "--sheet", "210x110", "--nest", "0").code == 2
    assert (
        aidl("compile", "box.aidl", "-o", "box.svg", "--sheet", "210x110", "--nest", "1", "--quiet").code == 0
    )
    assert sizes(box / "box.svg") == [(60, 60)]
    monkeypatch.setattr("aidl_lang.export.job.find_spec", lambda _: None)
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--sheet", "210x110", "--nest"))[:2] == [
        "error[E0913]: `--nest` needs a package that is not installed",
        "  = hint: pip install 'aidl-lang[nest]'",
    ]


def test_a_packer_that_gives_up_is_told(aidl: Aidl, box: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class PanicException(BaseException):
        pass

    class Panicking:
        def __init__(self, *_: object) -> None:
            raise PanicException("an empty polygon")

    monkeypatch.setattr("spyrrow.StripPackingInstance", Panicking)
    assert refused(aidl("compile", "box.aidl", "-o", "x.svg", "--sheet", "210x110", "--nest"))[:2] == [
        "error[E0924]: the parts could not be packed by their outlines: an empty polygon",
        "  = hint: leave `--nest` out: they are packed by their boxes then",
    ]


PANEL = "@thickness(3mm) solid front { body = finger_panel(width: 90, height: 50, thickness: 3, kerf: KERF) }"
OWN = "solid front { param kerf = KERF in 0..1  body = rectangle(width: 90 + kerf, height: 50) }"


@pytest.mark.parametrize(("program", "path"), [(PANEL, "front.body"), (OWN, "front")])
def test_a_cut_made_up_for_twice_is_told(aidl: Aidl, folder: Path, program: str, path: str) -> None:
    (folder / "front.aidl").write_text(program.replace("KERF", "0.2"))
    result = aidl("compile", "front.aidl", "-o", "x.dxf", "-o", "x.svg", "--kerf", "0.15")
    assert result.code == 0
    first, *lines = result.err.splitlines()
    assert first == (
        f"note[N0742]: the width of the cut is made up for twice: by `--kerf` and by the `kerf` of `{path}`"
    )
    assert any(line.endswith("drawn for a cut of 0.2 mm, and grown for one of 0.15 mm") for line in lines)
    assert "  = hint: leave out `--kerf`: the program does it" in lines
    assert "  = hint: or have the program draw without it: with `-D kerf=0` if it is a `param`" in lines
    assert result.err.count("N0742") == 1
    assert "N0742" not in aidl("compile", "front.aidl", "-o", "x.dxf").err
    (folder / "front.aidl").write_text(program.replace("KERF", "0"))
    assert "N0742" not in aidl("compile", "front.aidl", "-o", "x.dxf", "--kerf", "0.15").err


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
    for text in ("0", "-1", "x"):
        lines = refused(aidl("compile", "egg.aidl", f"--tolerance={text}"))
        assert "argument --tolerance: expected a length" in lines[-1]


def _entities(text: str) -> list[str]:
    return text.partition("ENTITIES")[2].partition("ENDSEC")[0].splitlines()
