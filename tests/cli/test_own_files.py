"""Files that AIDL has written, imported again: parts are parts, and what is engraved stays engraved."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import ezdxf
import pytest
from svgelements import Path as SvgPath

from tests.commands import Aidl, Result
from tests.export.readers import svg_paths

TAG = """\
@thickness(6mm)
solid tag {
    plate = rounded_rectangle(center: origin, width: 60, height: 30, radius: 4)
    screw = countersink("m4") at fixed((-22, 6))
    drawing name { letters = text("AIO", center: fixed((4, 3)), height: 9) }
    @color("red") drawing dot { c = circle(center: fixed((20, -8)), radius: 3) }
    @layer("score") drawing fold { crease = line(fixed((-20, -9)), fixed((15, -9))) }
    @layer("fill") drawing mark { r = ring(center: fixed((-22, -6)), outer_radius: 3, inner_radius: 2) }
}
"""
CUTTER = ("--profile", "lightburn")


def written(folder: Path, name: str) -> None:
    """A program, and one that imports what is made of it."""
    (folder / "tag.aidl").write_text(TAG)
    (folder / "again.aidl").write_text(f'import "{name}" as tag\nsolid again {{ body = tag() }}\n')


def operations(path: Path) -> dict[str, list[float]]:
    """The lengths of what is done along lines, by operation, in an SVG for a cutter."""
    found = defaultdict(list)
    for each in svg_paths(path.read_bytes()):
        lengths = [SvgPath(way).length() for way in each.as_subpaths()]
        found[each.values["data-operation"]] += lengths
    return {operation: sorted(lengths) for operation, lengths in found.items()}


@pytest.mark.parametrize(
    ("name", "profile"),
    [("p.svg", ()), ("p.svg", CUTTER), ("p.dxf", CUTTER), ("p.dxf", ("--profile", "plain"))],
)
def test_what_is_engraved_stays_engraved(
    aidl: Aidl, folder: Path, name: str, profile: tuple[str, ...]
) -> None:
    written(folder, name)
    kept = profile if profile[1:] == ("plain",) else CUTTER  # which letters are followed by
    assert aidl("compile", "tag.aidl", "-o", name, *profile).code == 0
    assert aidl("compile", "tag.aidl", "-o", "first.svg", *kept).code == 0
    assert aidl("compile", "again.aidl", "-o", "second.svg", "--quiet", *kept) == Result(0, "", "")
    first, second = (operations(folder / f"{n}.svg") for n in ("first", "second"))
    near = 0.01 if "dxf" in name else 1e-4
    assert second == {operation: pytest.approx(lengths, abs=near) for operation, lengths in first.items()}


@pytest.mark.parametrize("name", ["p.svg", "p.dxf"])
def test_layers_and_colours_come_back(aidl: Aidl, folder: Path, name: str) -> None:
    written(folder, name)
    assert aidl("compile", "tag.aidl", "-o", name).code == 0
    assert aidl("compile", "again.aidl", "-o", "second.dxf").code == 0
    found = list(ezdxf.readfile(folder / "second.dxf").modelspace())
    assert {e.dxf.layer for e in found} == {"solid", "hole", "drawing", "score", "fill"}
    assert (255, 0, 0) in {e.rgb for e in found if e.dxf.layer == "drawing"}


def test_what_explains_a_picture_is_no_part_of_it(aidl: Aidl, folder: Path) -> None:
    written(folder, "p.svg")
    aidl("compile", "tag.aidl", "-o", "p.svg", "--dimension", "--show", "names,points,bbox")
    measured = aidl("measure", "again.aidl").out
    assert "size       60 × 30 mm" in measured
    assert "outline    1 piece, 1 hole" in measured
