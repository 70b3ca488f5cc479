"""`aidl diff`: what it prints, writes and refuses."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.commands import Aidl, Result

OLD = """\
/// Two plates and a label.
assembly desk {
    param width = 40 in 20..200

    @material("steel")
    solid base { body = rectangle(center: fixed((0, 0)), width: width, height: 20) }
    solid lid {
        body = rectangle(center: fixed((0, 12)), width: 10, height: 4)
        for i in 0..2 {
            hole eye[i] { rim = circle(center: fixed((3 * i - 3, 12)), radius: 1) }
        }
    }
    @detached
    solid dial rotated 0deg { hand = rectangle(center: fixed((60, 0)), width: 10, height: 2) }
    drawing label { name = line(fixed((0, -30)), fixed((30, -30))) }
}
"""
NEW = (
    OLD.replace("width = 40", "width = 50")
    .replace("steel", "brass")
    .replace("12", "14")
    .replace("radius: 1)", "radius: 0.5 + i / 2)")
    .replace("dial rotated 0deg", "dial rotated 90deg")
    .replace("drawing label { name = line(fixed((0, -30)), fixed((30, -30))) }", "")
    .replace(
        "assembly desk {",
        "assembly desk {\n    @detached solid cord { c = square(center: fixed((0, -80)), size: 4) }",
    )
)
TOLD = """\
  desk             changed: width 85 → 50 (−35), height 44 → 147 (+103)
                   params: width 40 → 50
  desk.base        grew: width 40 → 50 (+10), area 800 → 1000 mm² (+25 %)
                   @material "steel" → "brass"
                   body: width 40 → 50
  desk.lid         moved by (0, 2)
                   shrank: area 30.575 → 29.004 mm² (−5.14 %)
  desk.lid.eye[0]  shrank: width 2 → 1 (−1), height 2 → 1 (−1), area 3.1416 → 0.7854 mm² (−75 %)
                   rim: radius 1 → 0.5
  desk.lid.eye[2]  grew: width 2 → 3 (+1), height 2 → 3 (+1), area 3.1416 → 7.0686 mm² (+125 %)
                   rim: radius 1 → 1.5
  desk.dial        turned by 90° about (0, 0)
- desk.label       vanished: drawing, 30 × 0
+ desk.cord        appeared: solid, 4 × 4, area 16 mm²
  contacts         base and lid: touching → 2 apart
                   base and dial: 35 apart → 45 apart
                   lid and dial: 50.804 apart → 39 apart
"""


@pytest.fixture
def versions(folder: Path) -> Path:
    (folder / "old.aidl").write_text(OLD)
    (folder / "new.aidl").write_text(NEW)
    return folder


def test_it_tells_what_differs(aidl: Aidl, versions: Path) -> None:
    result = aidl("diff", "old.aidl", "new.aidl")
    assert (result.code, result.err) == (0, "")
    assert result.out == TOLD


def test_params(aidl: Aidl) -> None:
    told = """\
  plate  grew: width 40 → 60 (+20), area 800 → 1200 mm² (+50 %)
         params: width 40 → 60
         edge: width 40 → 60
"""
    assert aidl("diff", "good.aidl", "--to", "width=60") == Result(0, told, "")
    assert aidl("diff", "good.aidl", "-D", "width=60", "--from", "width=40").out == told
    assert aidl("diff", "good.aidl", "good.aidl", "-D", "width=60") == Result(0, "no difference\n", "")


def test_standard_input_is_read_once(aidl: Aidl, folder: Path) -> None:
    program = (folder / "good.aidl").read_text()
    assert "width 40 → 60" in aidl("diff", "-", "--to", "width=60", stdin=program).out
    assert aidl("diff", "good.aidl", "-", stdin=program).out == "no difference\n"


def test_exit_code(aidl: Aidl) -> None:
    assert aidl("diff", "good.aidl", "good.aidl", "--exit-code").code == 0
    assert aidl("diff", "good.aidl", "--to", "width=60", "--exit-code").code == 1
    assert aidl("diff", "good.aidl", "--to", "width=60").code == 0


def test_json(aidl: Aidl) -> None:
    document = json.loads(aidl("diff", "good.aidl", "--to", "width=60", "--json").out)
    assert document == {
        "aidl_diff": 1,
        "units": "mm",
        "equal": False,
        "status": ["solved", "solved"],
        "dof": [0, 0],
        "freed": [],
        "held": [],
        "structures": [
            {
                "path": "plate",
                "kind": "solid",
                "change": "changed",
                "sizes": {"width": [40, 60], "area": [800, 1200], "perimeter": [120, 160]},
                "params": {"width": [40, 60]},
                "geometry": [
                    {
                        "name": "edge",
                        "type": "rectangle",
                        "change": "changed",
                        "fields": {"width": [40, 60]},
                        "outline": "changed",
                    }
                ],
            }
        ],
        "contacts": [],
    }


def test_the_picture(aidl: Aidl, folder: Path) -> None:
    result = aidl("diff", "good.aidl", "--to", "width=60", "-o", "out.svg")
    assert (result.code, result.err) == (0, "out.svg: drawn\n")
    assert "grew" in result.out
    picture = (folder / "out.svg").read_text()
    assert ElementTree.fromstring(picture).tag.endswith("svg")
    piped = aidl("diff", "good.aidl", "--to", "width=60", "-o", "-")
    assert (piped.out, piped.err) == (picture, result.out)


def test_a_wrong_side(aidl: Aidl) -> None:
    result = aidl("diff", "good.aidl", "wrong.aidl")
    assert (result.code, result.out) == (1, "")
    assert "error[E0201]: there is no `wdth` here" in result.err
    assert result.err.endswith("error[E0922]: `wrong.aidl` cannot be compared: it does not compile\n")
    both = aidl("diff", "wrong.aidl", "unsolvable.aidl")
    assert both.code == 1
    assert both.err.count("E0922") == 2


def test_a_side_that_does_not_solve(aidl: Aidl, folder: Path) -> None:
    result = aidl("diff", "unsolvable.aidl", "good.aidl")
    assert (result.code, result.out) == (1, "")
    assert result.err.endswith(
        "error[E0922]: `unsolvable.aidl` cannot be compared: its constraints do not solve\n"
        "  = hint: `--best-effort` compares it as it is\n"
    )
    tried = aidl("diff", "unsolvable.aidl", "good.aidl", "--best-effort")
    assert tried.code == 0
    assert "status" in tried.out
    (folder / "false.aidl").write_text(
        "solid s { c = circle(center: fixed((0, 0)), radius: 3) assert c.radius > 4 }"
    )
    assert "an assertion in it fails\n" in aidl("diff", "false.aidl", "good.aidl").err


def test_what_is_refused(aidl: Aidl) -> None:
    alone = aidl("diff", "good.aidl")
    assert alone == Result(
        2,
        "",
        "error[E0922]: there is nothing to compare `good.aidl` with\n"
        "  = hint: name a second program, or say what differs, as in `--to width=200`\n",
    )
    pair = ("diff", "good.aidl", "--to", "width=60")
    refused = aidl(*pair, "-o", "x.dxf")
    assert refused.code == 2
    assert refused.err.startswith("error[E0905]: differences cannot be drawn as `dxf`\n  = hint: formats: ")
    assert "E0905" in aidl(*pair, "-o", "x").err
    assert "E0908" in aidl(*pair, "-o", "good.aidl", "--format", "svg").err
    assert "E0904" in aidl(*pair, "-o", "nowhere/x.svg").err
    assert "E0914" in aidl(*pair, "-o", "-", "--json").err
    assert "E0901" in aidl("diff", "good.aidl", "missing.aidl").err
    assert aidl("diff", "good.aidl", "--to", "wide").code == 2
    assert aidl("diff", "good.aidl", "--to", "wide=3").code == 2


def test_texts_cannot_disturb_a_terminal(aidl: Aidl, folder: Path) -> None:
    program = '@material("{}") @detached solid s {{ c = circle(center: fixed((0, 0)), radius: 3) }}'
    (folder / "a.aidl").write_text(program.format("oak"))
    (folder / "b.aidl").write_text(program.format("\x1b[31m</svg>"))
    result = aidl("diff", "a.aidl", "b.aidl", "-o", "out.svg")
    assert result.code == 0
    assert "\x1b" not in result.out
    assert "</svg>" in result.out
    ElementTree.parse(folder / "out.svg")
