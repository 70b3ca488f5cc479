"""Holes that end in their solid: taken away in space, engraved for a cutter, which is told."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path

import ezdxf
import pytest

from tests.commands import Aidl
from tests.export.readers import read_mesh, read_step

PLATE = """\
@thickness({thick}mm) {more}
solid plate {{
    body = rectangle(center: origin, width: 80, height: 30)
    flat = countersink("m4") at (-25, 0)
    bore = counterbore("m3") at (0, 0)
    @depth(2mm) hole pocket {{ rim = square(center: (25, 0), size: 10) }}
}}
"""
THROUGH = math.pi * (2.25**2 + 1.7**2)
"""mm², of the bores of an M4 and of an M3 screw."""


def taken(thick: float) -> float:
    """What is taken away of the plate, mm³, by the formulas of a cone, a cylinder and a box."""
    wide, narrow = 4.48, 2.25
    deep = wide - narrow
    cone = math.pi * deep * (wide**2 + wide * narrow + narrow**2) / 3
    sunk = math.pi * 3.25**2 * 3.4
    return (
        (cone + math.pi * narrow**2 * (thick - deep))
        + (sunk + math.pi * 1.7**2 * (thick - 3.4))
        + 10 * 10 * 2
    )


@pytest.mark.parametrize("more", ["", "@orientation(front)"])
def test_solids_are_sunk_from_the_face_that_is_seen(aidl: Aidl, folder: Path, more: str) -> None:
    (folder / "p.aidl").write_text(PLATE.format(thick=6, more=more))
    result = aidl(
        "compile", "p.aidl", *("-o", "p.step"), *("-o", "p.stl"), *("-o", "p.3mf"), *("-o", "p.dxf")
    )
    assert result.code == 0
    volume = 80 * 30 * 6 - taken(6)
    (part,) = read_step((folder / "p.step").read_bytes(), folder).parts
    assert part.is_valid
    assert part.is_closed
    assert part.volume == pytest.approx(volume, rel=1e-9)
    for name in ("p.stl", "p.3mf"):
        mesh = read_mesh(folder / name)
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(volume, rel=1e-4)
    # The floor of the pocket is 2 mm below the face that is seen: above, or in front.
    across, along = (1, 2) if not more else (2, 1)
    corner = read_mesh(folder / "p.stl").vertices.round(3)
    corner = corner[(corner[:, 0] == 20) & (abs(corner[:, across]) == 5)]
    assert set(corner[:, along]) == ({4, 6} if not more else {0, 2})


def test_a_cutter_cuts_what_goes_through_and_engraves_the_rest(aidl: Aidl, folder: Path) -> None:
    (folder / "p.aidl").write_text(PLATE.format(thick=6, more=""))
    aidl("compile", "p.aidl", "-o", "p.dxf", "--profile", "lightburn")
    found = ezdxf.readfile(folder / "p.dxf").modelspace()
    assert Counter((e.dxf.layer, e.dxftype()) for e in found) == {
        ("C05-inner", "CIRCLE"): 2,
        ("C01-engrave", "CIRCLE"): 2,
        ("C01-engrave", "LWPOLYLINE"): 1,
        ("C10-outer", "LWPOLYLINE"): 1,
    }
    cut = [e.dxf.radius for e in found if e.dxf.layer == "C05-inner"]
    assert sum(math.pi * r**2 for r in cut) == pytest.approx(THROUGH)
    assert aidl("compile", "p.aidl", "-o", "p.dxf", "--sheet", "200x100").err.count("note[N0756]") == 1


def test_as_deep_as_the_solid_goes_through(aidl: Aidl, folder: Path) -> None:
    (folder / "p.aidl").write_text(PLATE.format(thick=2, more=""))
    result = aidl("compile", "p.aidl", "-o", "p.dxf")
    assert "`plate.flat.sink` ends in its solid: its outline is engraved" in result.err
    layers = Counter(e.dxf.layer for e in ezdxf.readfile(folder / "p.dxf").modelspace())
    assert layers == {"solid": 1, "hole": 3, "drawing": 1}


def test_a_hole_of_an_assembly_is_sunk_into_all_its_parts(aidl: Aidl, folder: Path) -> None:
    (folder / "p.aidl").write_text(
        """@thickness(6mm) assembly pair {
            @detached solid a { b = rectangle(bottom_left: fixed((-20, -10)), width: 20, height: 20) }
            @detached solid c { b = rectangle(bottom_left: fixed((0, -10)), width: 20, height: 20) }
            @depth(2mm) hole pocket { rim = square(center: fixed((0, 0)), size: 10) }
        }"""
    )
    assert aidl("compile", "p.aidl", "-o", "p.step").code == 0
    parts = read_step((folder / "p.step").read_bytes(), folder).parts
    assert [part.volume for part in parts] == pytest.approx([20 * 20 * 6 - 10 * 5 * 2] * 2)


IN_HOLES = """\
@thickness(6mm)
solid plate {
    body = rectangle(center: origin, width: 80, height: 30)
    hole flat { rim = countersink("m4") at (-25, 0) }
    hole bore { rim = counterbore("m3", center: (0, 0)) }
    @depth(2mm) hole pocket { rim = square(center: (25, 0), size: 10) }
}
"""


def test_what_is_sunk_in_a_hole_is_told_and_mended(aidl: Aidl, folder: Path) -> None:
    (folder / "p.aidl").write_text(IN_HOLES)
    assert aidl("check", "p.aidl").err.count("W0504]: in a `hole`, `counter") == 2
    assert aidl("check", "--fix", "p.aidl").code == 0
    assert (folder / "p.aidl").read_text() == PLATE.format(thick=6, more="").replace("6mm) ", "6mm)").replace(
        'counterbore("m3") at (0, 0)', 'counterbore("m3", center: (0, 0))'
    )
    assert aidl("compile", "p.aidl", "-o", "p.step").code == 0
    (part,) = read_step((folder / "p.step").read_bytes(), folder).parts
    assert part.volume == pytest.approx(80 * 30 * 6 - taken(6), rel=1e-9)


@pytest.mark.parametrize(
    "more",
    [
        *("constrain flat.rim.center == (-20, 0)", "assert flat.rim.diameter > 8"),
        "drawing d { hole inner { rim = countersink(m4) } }",
    ],
)
def test_a_hole_is_not_replaced_where_something_would_be_lost(aidl: Aidl, folder: Path, more: str) -> None:
    lost = "" if "flat" in more else "// kept"
    text = f"solid plate {{ b = square(size: 40)\n hole flat {{ rim = countersink(m4) {lost}\n }}\n {more} }}"
    (folder / "p.aidl").write_text(text)
    result = aidl("check", "p.aidl")
    assert "W0504" in result.err
    assert "fix:" not in result.err
    assert "`@depth(…) hole flat { … }`" in result.err
