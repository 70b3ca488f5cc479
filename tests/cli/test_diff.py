"""`aidl diff`: what it prints, writes and refuses."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

from tests.commands import Aidl


def test_standard_input_is_read_once(aidl: Aidl, folder: Path) -> None:
    program = (folder / "good.aidl").read_text()
    assert "width 40 → 60" in aidl("diff", "-", "--to", "width=60", stdin=program).out
    assert aidl("diff", "good.aidl", "-", stdin=program).out == "no difference\n"


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


def test_a_side_that_does_not_solve_is_compared_if_asked(aidl: Aidl) -> None:
    tried = aidl("diff", "unsolvable.aidl", "good.aidl", "--best-effort")
    assert tried.code == 0
    assert "status" in tried.out


def test_texts_cannot_disturb_a_terminal(aidl: Aidl, folder: Path) -> None:
    program = '@material("{}") @detached solid s {{ c = circle(center: fixed((0, 0)), radius: 3) }}'
    (folder / "a.aidl").write_text(program.format("oak"))
    (folder / "b.aidl").write_text(program.format("\x1b[31m</svg>"))
    result = aidl("diff", "a.aidl", "b.aidl", "-o", "out.svg")
    assert result.code == 0
    assert "\x1b" not in result.out
    assert "</svg>" in result.out
    ElementTree.parse(folder / "out.svg")
