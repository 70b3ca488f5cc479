"""Widths, dashes and opacity in files: what each holds of them, and what it says where it cannot."""

from __future__ import annotations

import io
import re
from functools import cache

import pytest
from ezdxf.document import Drawing as Document
from PIL import Image
from pypdfium2 import PdfDocument

from aidl_lang.export import FORMATS
from aidl_lang.export.job import Exported
from aidl_lang.export.marks import LIGHT, OUTLINE
from aidl_lang.export.profiles import PROFILES
from tests.export.making import near, written
from tests.export.readers import dxf_of

PROGRAM = """
param thin = 0.23mm
@thickness(3mm)
assembly a {
    @color("blue") solid plate { body = rectangle(center: fixed((0, 0)), width: 100, height: 60) }
    @color("yellow") @opacity(0.5) @stroke(2 * thin) @dash(4, 2)
    solid pane {
        body = rectangle(center: fixed((20, 0)), width: 20, height: 20)
        hole bore { rim = circle(center: fixed((20, 0)), radius: 2) }
    }
    @color("red") drawing marks {
        @stroke(4) @opacity(0.25) wide = line(fixed((-45, -20)), fixed((0, -20)))
        @dash rim = line(fixed((-45, 20)), fixed((0, 20)))
        fine = line(fixed((0, 20)), fixed((5, 25)))
    }
}
"""


def group(svg: str, name: str) -> str:
    found = re.search(rf'<g [^>]*id="{name}".*?</g>', svg, re.DOTALL)
    assert found is not None
    return found[0]


@pytest.mark.parametrize("length", [0.01, 100])
def test_dashes_that_no_pixel_shows_are_a_paler_line(length: float) -> None:
    program = f"@dash({length}, {3 * length}) @stroke(1000) drawing d {{ one = line((0, 0), (500m, 0)) }}"
    picture = Image.open(io.BytesIO(written(program, ".png", pixels=400).data)).convert("L")
    middle = picture.getpixel((200, picture.height // 2))
    assert isinstance(middle, int)
    assert 190 < middle < 220


# --- DXF -------------------------------------------------------------------------------------------


def document(**options: object) -> Document:
    return dxf_of(written(PROGRAM, ".dxf", **options).data)


def test_dxf_has_the_nearest_weight_and_a_linetype_for_each_pattern() -> None:
    made = document()
    assert not made.audit().errors
    entities = list(made.modelspace())
    looks = {(e.dxf.lineweight, e.dxf.linetype) for e in entities}
    # the outline of the pane and of its bore, the wide line, the dashed one, and all else
    assert looks == {(50, "DASHED_4_2"), (211, "BYLAYER"), (-1, "DASHED"), (-1, "BYLAYER")}
    assert sum(e.dxf.linetype == "DASHED_4_2" for e in entities) == 2
    patterns = {t.dxf.name: t.simplified_line_pattern() for t in made.linetypes if "DASHED" in t.dxf.name}
    assert {name: list(map(float, p)) for name, p in patterns.items()} == {
        "DASHED_4_2": [4, 2],
        "DASHED": pytest.approx([1.2, 0.8]),
    }
    (outline,) = [e for e in made.modelspace().query("LWPOLYLINE") if e.dxf.linetype == "DASHED_4_2"]
    assert outline.dxf.flags & 128


def test_a_cutter_follows_whole_hairlines() -> None:
    looks = {(e.dxf.lineweight, e.dxf.linetype) for e in document(kerf=0.1).modelspace()}
    assert looks == {(-1, "BYLAYER")}
    for options in ({"cut": True}, {"theme": "cutter"}):
        svg = written(PROGRAM, ".svg", **options).data.decode()
        assert set(re.findall(r'stroke-width="([^"]*)"', svg)) == {"0.1"}
        assert "dash" not in svg
        assert "opacity" not in svg


def test_a_geometry_has_its_own_colour_in_a_dxf() -> None:
    program = """
    @color("red") drawing d {
        a = line((0, 0), (5, 0))
        @color("blue") b = line((5, 0), (9, 0))
    }
    """
    made = dxf_of(written(program, ".dxf").data)
    assert [e.rgb for e in made.modelspace()] == [(255, 0, 0), (0, 0, 255)]


# --- Outlines --------------------------------------------------------------------------------------


BALL = """
@stroke(0.4)
assembly a {
    @color("crimson") solid skin { rim = circle(center: fixed((0, 0)), radius: 30) }
    @color("white") @opacity(0.6) @stroke(none)
    solid shine {
        spot = circle(center: fixed((0, 0)), radius: 10)
        drawing mark { cross = line(fixed((-5, 0)), fixed((5, 0))) }
    }
}
"""


def test_contours_are_cut_without_an_outline_too() -> None:
    for options in ({"cut": True}, {"theme": "cutter"}):
        assert 'stroke-width="0.1"' in group(written(BALL, ".svg", **options).data.decode(), "a.shine:outer")
    entities = list(dxf_of(written(BALL, ".dxf").data).modelspace())
    assert sorted(e.dxftype() for e in entities) == ["CIRCLE", "CIRCLE", "LINE"]
    assert sorted(e.dxf.lineweight for e in entities) == [-1, -1, 40]


def test_outlines_are_a_darker_tone_of_the_fill() -> None:
    program = """
    assembly a {
        solid plain { body = square(center: fixed((0, 0)), size: 5) }
        @color("black") solid dark { body = square(center: fixed((10, 0)), size: 5) }
        @color("#c86428") solid toned { body = square(center: fixed((20, 0)), size: 5) }
        @color("white") solid pale { body = square(center: fixed((30, 0)), size: 5) }
    }
    """
    svg = written(program, ".svg").data.decode()
    found = dict(re.findall(r'data-path="a\.(\w+)".*?stroke="([^"]*)"', svg, re.DOTALL))
    assert found.pop("plain") == OUTLINE
    assert found == {"dark": "#000000", "toned": "#6e3716", "pale": "#808080"}
    for theme, line in (("blueprint", "#eaf2ff"), ("ink", "#000000"), ("cutter", "#ff0000")):
        lines = re.findall(r'stroke="(#[^"]*)"', written(program, ".svg", theme=theme).data.decode())
        assert set(lines) == {line}


def test_a_part_more_at_the_end_changes_no_other_part() -> None:
    def fills(count: int) -> list[str]:
        solids = "".join(
            f"solid s{k} {{ b = square(center: fixed(({9 * k}, 0)), size: 5) }}\n" for k in range(count)
        )
        return re.findall(r' fill="(#[^"]*)"', written(f"assembly a {{ {solids} }}", ".svg").data.decode())

    assert fills(5)[:4] == fills(4)
    assert len(set(fills(5))) == 5


# --- Seams -----------------------------------------------------------------------------------------


def test_a_solid_with_a_look_in_a_solid_is_an_area_and_has_no_seams() -> None:
    def svg(looks: str) -> str:
        inner = f"{looks} solid knob {{ rim = circle(center: fixed((0, 0)), radius: 6) }}"
        plate = "body = rectangle(center: fixed((0, 0)), width: 40, height: 20)"
        return written(f"solid a {{ {plate}\n {inner} }}", ".svg").data.decode()

    assert 'class="seam"' in svg("")
    assert 'class="seam"' not in svg('@color("gold")')
    assert svg('@color("gold") @stroke(none)').count('stroke="none"') == 1


def test_the_pdf_is_named_after_what_the_program_says_it_is() -> None:
    program = "/// A square.\n/// It has four corners.\nsolid plate { body = square(size: 30) }"
    assert PdfDocument(written(program, ".pdf").data).get_metadata_dict()["Title"] == "A square."
    assert (
        PdfDocument(written(program[program.index("solid") :], ".pdf").data).get_metadata_dict()["Title"]
        == "plate"
    )


def seen(suffix: str, program: str) -> Image.Image:
    """What is seen of a drawing 100 mm wide, with its margin: ten pixels for each millimetre."""
    if suffix == ".png":
        return Image.open(io.BytesIO(written(program, suffix, pixels=1060).data)).convert("RGB")
    page = PdfDocument(written(program, suffix).data)[0]
    return page.render(scale=10 / 72 * 25.4).to_pil().convert("RGB")


def at(image: Image.Image, x: float, y: float, wide: float = 106) -> tuple[int, int, int]:
    """The colour at so many millimetres from the middle of a picture."""
    scale, middle = image.width / wide, (image.width / 2, image.height / 2)
    return image.getpixel((round(middle[0] + x * scale), round(middle[1] - y * scale)))  # type: ignore


# --- Letters -----------------------------------------------------------------------------------------

LATER = """
solid a {
    face = rectangle(center: fixed((0, 0)), width: 100, height: 100)
    drawing lines { level = line(fixed((-50, 20)), fixed((50, 20))) }
    @color("red") over = circle(center: fixed((0, 20)), radius: 10)
    @color("lime") under = circle(center: fixed((0, -20)), radius: 10)
    bare = rectangle(center: fixed((0, -20)), width: 8, height: 8)
    @color("blue") solid inner { dot = circle(center: fixed((30, -20)), radius: 8) }
    @color("gold") pin = circle(center: fixed((34, -20)), radius: 2)
    plug = circle(center: fixed((26, -20)), radius: 2)
    spot = circle(center: fixed((-30, 0)), radius: 8)
    @clip(spot) solid paint { @color("blue") band = rectangle(center: fixed((0, 0)), width: 100, height: 4) }
}
"""


def test_what_is_written_later_lies_on_top() -> None:
    for image in (seen(".png", LATER), seen(".pdf", LATER)):
        assert near(image.getpixel((530, 330)), (255, 0, 0))  # the area hides the line before it
        assert near(image.getpixel((530 + 80, 730)), (0, 255, 0))
        assert near(image.getpixel((530, 730)), image.getpixel((530 - 300, 730)))
        assert near(image.getpixel((830, 730)), (0, 0, 255))
        assert near(image.getpixel((870, 730)), (255, 215, 0))
        assert near(image.getpixel((790, 730)), image.getpixel((530 - 300, 730)))
        assert near(image.getpixel((230, 530)), (0, 0, 255))
        assert near(image.getpixel((430, 530)), image.getpixel((530 - 300, 730)))  # the band ends at the spot


VEILS = """
@stroke(none)
assembly a {
    @color("blue") solid wall { body = rectangle(center: fixed((0, 0)), width: 100, height: 100) }
    solid pane { @color("red") @opacity(0.5) glass = square(center: fixed((-30, 0)), size: 20) }
    @opacity(0.5) solid half { @color("red") glass = square(center: fixed((0, 0)), size: 20) }
    solid glow { @color("red") @shade(fade) light = circle(center: fixed((30, 0)), radius: 10) }
}
"""


@pytest.mark.parametrize("suffix", [".png", ".pdf"])
def test_nothing_lies_below_what_a_body_of_areas_shows_of_what_is_behind(suffix: str) -> None:
    image = seen(suffix, VEILS)
    assert near(image.getpixel((230, 530)), (128, 0, 128))
    assert near(image.getpixel((530, 530)), (128, 0, 128))
    assert near(image.getpixel((830, 530)), (255, 0, 0))
    assert near(image.getpixel((830, 624)), (0, 0, 255))


LETTERS = """
assembly a {
    @color("yellow") solid plate { body = rectangle(center: fixed((0, 0)), width: 100, height: 60) }
    @color("red") drawing marks {
        ring = text("O", center: fixed((-20, 0)), height: 30)
        bare = text("I", center: fixed((20, 0)), height: 30, bold: true, outline: true)
    }
}
"""


def test_letters_are_filled_and_their_counters_open() -> None:
    filled, outlined = re.findall("<path .*?/>", group(written(LETTERS, ".svg").data.decode(), "a.marks"))
    assert 'fill="red" fill-rule="evenodd" stroke="none"' in filled
    assert filled.count("Z") == 2
    assert 'fill="none" stroke="red"' in outlined
    for image in (seen(".png", LETTERS), seen(".pdf", LETTERS)):
        assert near(image.getpixel((530 - 200, 330)), (255, 255, 0))  # within the O
        assert near(image.getpixel((530 - 200 + 125, 330)), (255, 0, 0))  # its right side
        assert near(image.getpixel((530 + 200, 330)), (255, 255, 0))  # within the outlined I


HALOED = """
@thickness(3mm)
assembly a {
    @color("blue") solid plate { body = rectangle(center: fixed((0, 0)), width: 100, height: 60) }
    @color("yellow") @halo(5)
    solid ring {
        band = ring(center: fixed((-20, 0)), outer_radius: 20, inner_radius: 15)
        @color("red") drawing dot { rim = circle(center: fixed((-20, 17.5)), radius: 1) }
    }
    @halo(4) @stroke(2) drawing cord { way = line(fixed((20, 50)), fixed((20, -50))) }
    @halo(4) solid away { rim = circle(center: fixed((80, 0)), radius: 10) }
}
"""


def test_gaps_lie_over_what_is_behind_and_under_what_is_in_front() -> None:
    image = seen(".png", HALOED)
    white, blue, yellow = (255, 255, 255), (0, 0, 255), (255, 255, 0)
    for color, places in (
        (blue, [(-46, 0), (-20, 0), (14, 0), (26, 0)]),
        (white, [(-43, 0), (-32, 0), (16.2, 0), (23.8, 0)]),  # in the ring, too
        (yellow, [(-37.5, 0), (-20, 15.4)]),  # beside what is drawn on it
    ):
        for x, y in places:
            assert near(at(image, x - 20, y, 1.06 * 140), color), (x, y)


SHADOWED = """
assembly a {
    @color("blue") @stroke(none) solid wall { body = rectangle(width: 100, height: 60) }
    @shadow(10, -20, 0.4) assembly b {
        @color("yellow") solid one {
            body = rectangle(center: fixed((0, 0)), width: 20, height: 20)
            @color("red") @opacity(0.5) @stroke(none) glow = circle(center: fixed((0, 0)), radius: 25)
        }
        @color("yellow") solid other { body = rectangle(center: fixed((5, 0)), width: 20, height: 20) }
    }
}
"""


@pytest.mark.parametrize("suffix", [".png", ".pdf"])
def test_a_shadow_is_one_of_all_that_casts_it_and_a_veil_lies_beyond_its_body(suffix: str) -> None:
    image = seen(suffix, SHADOWED)
    assert near(at(image, -40, 0), (0, 0, 255))
    assert near(at(image, 22, -28), (0, 0, 153))  # of both parts: once as dark
    assert near(at(image, 2, -28), (0, 0, 153))
    assert near(at(image, -2, -28), (0, 0, 255))
    assert near(at(image, -12, 0), (128, 0, 128))  # the glow, on the wall
    assert near(at(image, -8, 0), (255, 128, 0))
    assert near(at(image, 12, 0), (255, 255, 0))  # in front of it
    assert "fill-opacity" not in written(SHADOWED, ".svg", theme="blueprint").data.decode()


# --- Shade -----------------------------------------------------------------------------------------


_PLACES = {
    "left": (0.3, 0.5),
    "middle": (0.5, 0.5),
    "right": (0.85, 0.5),
    "above": (0.5, 0.3),
    "below": (0.5, 0.85),
}


@cache
def _brightness(attributes: str, *, frame: str = "", suffix: str = ".png") -> dict[str, float]:
    """The brightness of a grey square, seen at the left, in its middle, on the right, above and below."""
    square = "plate = rectangle(center: fixed((0, 0)), width: 40, height: 40)"
    program = f'@stroke(none) assembly a {{ @color("gray") {attributes} solid s {frame} {{ {square} }} }}'
    data = written(program, suffix, pixels=200).data if suffix == ".png" else written(program, suffix).data
    image = (
        Image.open(io.BytesIO(data)) if suffix == ".png" else PdfDocument(data)[0].render(scale=3).to_pil()
    )
    grey, (width, height) = image.convert("L"), image.size
    return {name: float(grey.getpixel((int(x * width), int(y * height)))) for name, (x, y) in _PLACES.items()}


@pytest.mark.parametrize("suffix", [".png", ".pdf"])
def test_light_and_shade_go_their_ways(suffix: str) -> None:
    """Half of the way out of the middle, 0.3 of the square, shows 0.4 of it: 0.78 at 0.3, and 0.3 at 0.6."""
    ways = ("@shade(round)", '@shade("white", 0deg)', "@shade(fade, 0deg)", "@shade(fade)")
    bar, white, fading, glow = (_brightness(way, suffix=suffix) for way in ways)
    assert bar["left"] > bar["middle"] > bar["right"]
    assert bar["above"] == pytest.approx(bar["below"], abs=2)
    assert white["left"] < white["middle"] < white["right"]
    assert white["right"] > 220
    assert fading["left"] < fading["middle"] < fading["right"]
    assert fading["middle"] == pytest.approx((128 + 255) / 2, abs=4)
    assert fading["above"] == pytest.approx(fading["below"], abs=2)
    assert glow["middle"] == pytest.approx(128, abs=5)
    assert glow["left"] == pytest.approx(255 - 127 * (0.78 - 0.48 / 3), abs=5)
    assert glow["left"] < glow["right"] == pytest.approx(glow["below"], abs=3)


def test_light_comes_from_one_side_however_a_part_is_turned() -> None:
    for shade in ("@shade(round)", "@shade(slope)"):
        for frame in ("rotated 180deg", "at (3, 4)"):
            assert _brightness(shade, frame=frame) == pytest.approx(_brightness(shade), abs=2)
    turned = _brightness("@shade(round)", frame="rotated 90deg")
    assert turned == pytest.approx(_brightness("@shade(round, 90deg)"), abs=2)


def test_what_fades_is_flat_where_its_box_is() -> None:
    program = "@stroke(none) @shade(fade) solid s { pool = ellipse(center: fixed((0, 0)), rx: 40, ry: 10) }"
    image = Image.open(io.BytesIO(written(program, ".png", pixels=400).data)).convert("L")
    width, height = image.size
    inner = int(width * 0.15), int(height * 0.15)
    level = image.getpixel((width // 2 + int(0.3 * (width - 2 * inner[0])), height // 2))
    upright = image.getpixel((width // 2, height // 2 - int(0.3 * (height - 2 * inner[1]))))
    assert level == pytest.approx(upright, abs=40)


def test_shade_ends_where_it_is_said() -> None:
    program = """
    @shade(round) assembly a {
        solid b { p = rectangle(center: fixed((0, 0)), width: 9, height: 9) }
        @shade(none) solid c { p = rectangle(center: fixed((9, 0)), width: 9, height: 9) }
    }
    """
    svg = written(program, ".svg").data.decode()
    assert "url(#shade-1)" in group(svg, "a.b")
    assert "url(" not in group(svg, "a.c")
    assert "url(" not in written(program, ".svg", theme="ink").data.decode()


@pytest.mark.parametrize("color", ["gold", "skyblue", "#a7bcd6"])
def test_an_area_of_a_solid_may_have_an_outline_of_its_own(color: str) -> None:
    said = f'@color("{color}")' if color == "gold" else ""
    body = '@color("skyblue")' if color != "#a7bcd6" else ""
    text = f"""
    {body} solid plate {{
        body = rectangle(center: fixed((0, 0)), width: 90, height: 60)
        {said} @stroke(3mm) disc = circle(center: fixed((20, 10)), radius: 9)
    }}
    """
    svg = written(text, ".svg").data.decode()
    assert re.search(rf'fill="{color}"[^>]*stroke-width="3"', svg)


@pytest.mark.parametrize(("shade", "is_shaded"), [('"navy"', False), ("slope", True), ("fade", True)])
def test_a_colour_of_its_own_does_not_go_over_into_another(shade: str, is_shaded: bool) -> None:
    text = f"""
    @color("skyblue") @shade({shade}) solid scene {{
        sky = rectangle(center: fixed((0, 0)), width: 90, height: 60)
        @color("gold") sun = circle(center: fixed((20, 10)), radius: 9)
    }}
    """
    assert (b'fill="gold"' in written(text, ".svg").data) != is_shaded


INSCRIBED = """
assembly a {
    @color("navy") solid dark {
        body = rectangle(center: fixed((0, 0)), width: 60, height: 30)
        @color("black") plate = rectangle(center: fixed((0, 8)), width: 40, height: 10)
        drawing mark { on_dark = text("A", center: fixed((0, 8)), height: 6) }
    }
    @color("gold") solid light {
        body = rectangle(center: fixed((0, -30)), width: 60, height: 30)
        @color("ivory") plate = rectangle(center: fixed((0, -30)), width: 40, height: 10)
        drawing mark { on_light = text("B", center: fixed((0, -30)), height: 6) }
    }
    drawing beside {
        over_dark = text("C", center: fixed((0, -6)), height: 6)
        over_light = text("D", center: fixed((0, -20)), height: 6)
    }
    @color("dimgray") drawing said { as_said = text("E", center: fixed((20, -6)), height: 6) }
}
"""


def test_letters_without_a_colour_of_their_own_can_be_read_on_what_they_lie_on() -> None:
    """Whether they are written in what they lie on or beside it."""
    svg = written(INSCRIBED, ".svg").data.decode()
    fills = re.findall(r'class="letters".* fill="(#?\w+)"', svg)
    light, dark = LIGHT, OUTLINE
    assert fills == [light, dark, light, dark, "dimgray"]


PLATE = """\
@thickness(6mm) @color("teal") {said}
solid plate {{
    body = rectangle(center: origin, width: 60, height: 30)
    knob = circle(center: fixed((30, 0)), radius: 8)
    {depth} hole seat {{ rim = circle(center: fixed((-15, 0)), radius: 5) }}
    drawing mark {{ line = line(fixed((-5, -10)), fixed((20, 10))) }}
}}
"""
LOOKS = ("@stroke(1mm)", "@dash(3, 1)", "@opacity(0.5)", "@shade(round)", "@edges(seams)", "@stroke(none)")
DEPTHS = ("@depth(2mm)", "@depth(2mm, 90deg)")
FILES = [*(suffix for suffix in FORMATS if suffix not in (".csv", ".json")), "cutter.svg", "cutter.dxf"]


@cache
def saying(said: str, name: str) -> Exported:
    text = PLATE.format(said="", depth=said) if said in DEPTHS else PLATE.format(said=said, depth="")
    cutter, _, suffix = name.rpartition(".")
    return written(text, f".{suffix}", profile=PROFILES["lightburn"] if cutter else None, pixels=400)


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("said", [*LOOKS, *DEPTHS])
def test_it_is_in_the_file_or_told(said: str, name: str) -> None:
    told = {note.code for note in saying(said, name).notes}
    is_there = saying(said, name).data != saying("", name).data
    if said in DEPTHS:
        assert is_there
        wanted = FORMATS[f".{name.rpartition('.')[2]}"]
        assert ("N0756" in told) == (name.startswith("cutter") or (wanted.cuts and not wanted.tiles))
    else:
        assert is_there or "N0741" in told
