"""Profiles: the same colours, widths and layers in SVG, DXF and PDF, in the order of a machine."""

from __future__ import annotations

import re
from typing import Any

import pytest
from ezdxf.colors import int2rgb
from ezdxf.document import Drawing as Document
from shapely import Polygon, unary_union

from aidl_lang.export.job import ExportError
from aidl_lang.export.profiles import OPERATIONS, PROFILES, Profile, parsed
from tests.export import readers
from tests.export.making import written
from tests.export.readers import dxf_of

PLATE = """\
assembly tag {
    solid plate {
        body = rectangle(center: origin, width: 80, height: 50)
        hole bore { rim = circle(center: fixed((-25, 10)), radius: 6) }
        drawing name { letters = text("OB", center: fixed((10, 5)), height: 12) }
        drawing frame { edge = rectangle(center: fixed((10, 5)), width: 40, height: 20) }
        @layer("score") drawing fold { crease = line(fixed((-40, -15)), fixed((40, -15))) }
        @layer("fill") drawing mark {
            disc = ring(center: fixed((-25, -5)), outer_radius: 5, inner_radius: 3)
        }
        @layer("cut") drawing slit { way = line(fixed((0, -20)), fixed((20, -20))) }
    }
}
"""


def svg_paths(text: str, profile: Profile, **options: object) -> list[Any]:
    return readers.svg_paths(written(text, ".svg", profile=profile, **options).data)


def in_svg(text: str, profile: Profile) -> list[tuple[str, str, bool]]:
    """Operation, colour and whether it is filled, of each path in the order of the file."""
    found = []
    for path in svg_paths(text, profile):
        filled = path.values["fill"] != "none"
        assert filled != (path.values["stroke"] != "none")
        color = path.values["fill" if filled else "stroke"]
        found.append((path.values["data-operation"], color, filled))
    return found


def document(text: str, profile: Profile, **options: str) -> Document:
    data = written(text, ".dxf", profile=profile, **options).data
    found: Document = dxf_of(data, "cp1252" if options else "utf-8")
    assert not found.audit().errors
    return found


def color_in_dxf(found: Document, entity: object) -> str:
    own, layer = entity.dxf, found.layers.get(entity.dxf.layer).dxf  # type: ignore[attr-defined]
    value = own.true_color if own.hasattr("true_color") else layer.true_color
    return "#{:02x}{:02x}{:02x}".format(*int2rgb(value))


@pytest.mark.parametrize("name", PROFILES)
def test_svg_and_dxf_agree_in_order_and_colour(name: str) -> None:
    profile = PROFILES[name]
    told = in_svg(PLATE, profile)
    found = document(PLATE, profile)
    in_dxf = [color_in_dxf(found, entity) for entity in found.modelspace()]
    # The frame, a fold, a ring of two, a slit, the bore, the plate, and the outlines of O and B.
    assert len(in_dxf) == 1 + 1 + 2 + 1 + 1 + 1 + 5
    places = [OPERATIONS.index(operation) for operation, *_ in told]
    assert places == sorted(places)
    assert set(places) == set(range(len(OPERATIONS)))
    seen = [color for color, before in zip(in_dxf, [None, *in_dxf], strict=False) if color != before]
    assert seen == [
        c
        for c, before in zip([c for _, c, _ in told], [None, *[c for _, c, _ in told]], strict=False)
        if c != before
    ]
    assert {color for operation, color, _ in told if operation == "outer"} == {profile.looks["outer"].color}


PALETTE = "000000 0000ff ff0000 00e000 d0d000 ff8000 00e0e0 ff00ff b4b4b4 0000a0 a00000"


def test_the_colours_of_lightburn_are_those_of_its_palette_in_rising_order() -> None:
    palette = [f"#{color}" for color in PALETTE.split()]
    looks = PROFILES["lightburn"].looks
    numbers = [palette.index(looks[operation].color) for operation in OPERATIONS]
    assert numbers == sorted(set(numbers))
    assert [look.layer[:3] for look in looks.values()] == [f"C{n:02}" for n in numbers]  # type: ignore[index]


def test_the_colours_of_glowforge_rise() -> None:
    colors = [PROFILES["glowforge"].looks[operation].color for operation in OPERATIONS]
    assert colors == sorted(set(colors))


def test_ponoko_cuts_blue_and_engraves_red_with_the_thinnest_lines() -> None:
    told = in_svg(PLATE, PROFILES["ponoko"])
    assert {(color, filled) for operation, color, filled in told if operation in ("inner", "outer")} == {
        ("#0000ff", False)
    }
    assert {(color, filled) for operation, color, filled in told if operation in ("engrave", "score")} == {
        ("#ff0000", False)
    }
    assert {(color, filled) for operation, color, filled in told if operation == "fill"} == {
        ("#000000", True)
    }
    lines = [p for p in svg_paths(PLATE, PROFILES["ponoko"]) if p.values["stroke"] != "none"]
    assert {path.values["stroke-width"] for path in lines} == {"0.01"}
    found = document(PLATE, PROFILES["ponoko"])
    assert {found.layers.get(e.dxf.layer).dxf.lineweight for e in found.modelspace()} == {0}


# --- Files ---------------------------------------------------------------------------------------

SHOP = """\
base = "glowforge"
letters = "engrave"

[outer]
colour = "navy"
width = 0.05
layer = "OUT"

[layers]
fold = "score"
Glue_Here = {as = "engrave", color = "#a0a000", layer = "C12"}
"""


def test_a_file_of_ones_own() -> None:
    text = PLATE.replace('@layer("score")', '@layer("Fold")').replace(
        "drawing frame", '@layer("glue_here") drawing frame'
    )
    profile = parsed(SHOP, "shop.toml")
    told = in_svg(text, profile)
    assert ("outer", "#000080", False) in told
    assert ("engrave", "#a0a000", False) in told
    assert ("score", "#00ff00", False) in told
    assert [filled for operation, _, filled in told if operation == "engrave"] == [False] * 6
    found = document(text, profile)
    assert found.layers.get("OUT").dxf.lineweight == 5
    assert {e.dxf.layer for e in found.modelspace()} == {"OUT", "C12", "score", "engrave", "inner", "fill"}
    assert written(text, ".svg", profile=profile).notes == ()


def test_a_file_that_is_nested_too_deeply_is_told() -> None:
    with pytest.raises(ExportError, match=r"`shop.toml` cannot be used: its values are nested too deeply"):
        parsed(f"x = {'[' * 5000}", "shop.toml")


def test_lines_that_enclose_no_area_are_engraved() -> None:
    text = PLATE.replace('@layer("score")', '@layer("fill")')
    assert [operation for operation, *_ in in_svg(text, PROFILES["ponoko"])].count("engrave") == 2


def test_letters_over_the_edge_of_a_part_are_areas_up_to_there() -> None:
    text = (
        "assembly a { @detached solid p { r = rectangle(center: fixed((0, 0)), width: 30, height: 20) }"
        ' drawing d { t = text("II", center: fixed((13.2, 0)), height: 10) } }'
    )
    paths = svg_paths(text, PROFILES["glowforge"], sheet=(60, 40))
    (plate,) = [p.bbox() for p in paths if p.values["data-operation"] == "outer"]
    drawn = [p for p in paths if p.values["data-path"] == "a.d"]
    assert {p.values["data-operation"] for p in drawn} == {"fill"}
    for path in drawn:
        assert path.bbox()[2] <= plate[2] + 1e-6


def test_no_colour_of_the_program_reaches_a_machine_that_goes_by_colour() -> None:
    text = PLATE.replace("solid plate", '@color("crimson") solid plate')
    data = written(text, ".svg", profile=PROFILES["ponoko"]).data.decode()
    assert set(re.findall('(?:fill|stroke)="(#[^"]*)"', data)) == {"#000000", "#ff0000", "#0000ff"}


def test_what_is_cut_encloses_what_is_drawn() -> None:
    paths = [
        p for p in svg_paths(PLATE, PROFILES["lightburn"]) if p.values["data-operation"] in ("inner", "outer")
    ]
    rings = [
        Polygon([(s.x, s.y) for s in map(p.point, [k / 360 for k in range(360)])])
        for p in paths
        if p.values["data-path"] == "tag.plate"
    ]
    assert unary_union(rings).area == pytest.approx(4000, rel=1e-3)
