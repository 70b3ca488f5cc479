"""All programs of the examples, the gallery and the workshop: the playground draws what is drawn here."""

from __future__ import annotations

import io
import math
import re
from pathlib import Path

import ezdxf
import pytest

import aidl_lang
from aidl_web.site import ROOT
from web.tests.places import Run

pytestmark = pytest.mark.slow
PROGRAMS = sorted((ROOT / "examples").rglob("*.aidl"))
_NUMBER = re.compile(r"-?\d+\.\d+(?:[eE][-+]?\d+)?|-?\d+[eE][-+]?\d+")
_NOISE = 1e-9
"""By how much numbers may differ: sines and square roots of other libraries have another last digit."""


@pytest.fixture(scope="module")
def made(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    run(Path(__file__).parent / "drawing.py", folder, *PROGRAMS)
    return folder


def there(made: Path, program: Path, suffix: str) -> bytes:
    return (made / f"{program.parent.name}-{program.stem}{suffix}").read_bytes()


def apart(one: str, other: str) -> str:
    """Returns where two files say different things, numbers apart that differ by noise; empty if nowhere."""
    if _NUMBER.sub("0", one) != _NUMBER.sub("0", other):
        return "the words differ"
    pairs = zip(_NUMBER.findall(one), _NUMBER.findall(other), strict=True)
    far = [(a, b) for a, b in pairs if abs(float(a) - float(b)) > _NOISE * max(1.0, abs(float(a)))]
    return str(far[:3]) if far else ""


def test_the_pictures_are_the_same_byte_for_byte(made: Path) -> None:
    assert len(PROGRAMS) >= 39
    drawn = {program: aidl_lang.compile(program).export(".svg") for program in PROGRAMS}
    assert [p.stem for p in PROGRAMS if there(made, p, ".svg") != drawn[p]] == []


def areas(dxf: str) -> dict[str, float]:
    """Returns the area within the closed outlines of each layer."""
    found: dict[str, float] = {}
    for line in ezdxf.read(io.StringIO(dxf)).modelspace().query("LWPOLYLINE"):  # type: ignore[attr-defined]
        points = list(line.get_points("xyb"))
        area = 0.0
        for (x, y, bulge), (u, v, _) in zip(points, points[1:] + points[:1], strict=True):
            turn, chord = 4 * math.atan(bulge), math.hypot(u - x, v - y)
            radius = chord / (2 * math.sin(turn / 2)) if bulge else 0.0
            area += (x * v - u * y) / 2 + radius * radius * (turn - math.sin(turn)) / 2
        found[line.dxf.layer] = found.get(line.dxf.layer, 0.0) + abs(area)
    return found


def test_data_differ_by_the_last_digits_of_numbers_at_most(made: Path) -> None:
    found = {}
    for program in PROGRAMS:
        here = aidl_lang.compile(program).export(".json").decode()
        if difference := apart(there(made, program, ".json").decode(), here):
            found[program.stem] = difference
    assert found == {}


def test_outlines_for_cutters_enclose_the_same(made: Path) -> None:
    """Curves are fitted by arcs, where such a digit can lead to other arcs that are as near."""
    found = {}
    for program in PROGRAMS:
        here = areas(aidl_lang.compile(program).export(".dxf").decode())
        if areas(there(made, program, ".dxf").decode()) != pytest.approx(here, rel=1e-4):
            found[program.stem] = here
    assert found == {}
