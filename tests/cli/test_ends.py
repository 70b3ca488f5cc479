"""`aidl check --ends`: what is said, where, and with which exit code."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import pytest

from tests.commands import Aidl

RANGED = """\
param width = 40 in 20..200
param free = 3

solid plate {
    edge = rectangle(center: origin, width: width, height: 100 + free)
    assert width <= 150
}
"""


def test_ends_that_fail_are_told_on_standard_output(aidl: Aidl, folder: Path) -> None:
    (folder / "ranged.aidl").write_text(RANGED)
    result = aidl("check", "--ends", "ranged.aidl")
    assert result.code == 1
    assert result.out == (
        "ranged.aidl: error at `width = 200` the assert in line 6 fails (200 is not <= 150); "
        "`width <= 150` holds up to 150\n"
    )
    assert re.sub(r"[\d.]+ s", "N s", result.err) == (
        "ranged.aidl: no mistakes found\n"
        "ranged.aidl: 2 ends of 1 param tried, 1 fails, N s; 1 param has no range\n"
    )


def test_good_program_is_good_at_its_ends(aidl: Aidl) -> None:
    result = aidl("check", "--ends", "good.aidl", "unsolvable.aidl", "wrong.aidl")
    assert (result.code, result.out) == (1, "")
    assert re.search(r"good.aidl: 2 ends of 1 param tried, none fail, [\d.]+ s\n", result.err)
    assert "unsolvable.aidl: 1 error; the ends of its params were not tried\n" in result.err
    assert "wrong.aidl: 1 error; nothing was solved; the ends of its params were not tried\n" in result.err
    assert aidl("check", "--ends", "good.aidl").code == 0
    none = aidl("check", "--ends", "-", stdin="solid a { b = circle(center: origin, radius: 2) }")
    assert none.code == 0
    assert none.err.endswith("-: no param has a range, so there is nothing to turn\n")


def test_ends_as_json(aidl: Aidl, folder: Path) -> None:
    (folder / "ranged.aidl").write_text(RANGED)
    result = aidl("check", "--ends", "--json", "ranged.aidl")
    assert (result.code, result.err) == (1, "")
    document = json.loads(result.out)
    assert (document["ok"], document["solved"], document["diagnostics"]) == (False, True, [])
    (found,) = document["ends"]
    lower, upper = found["tried"]
    assert (found["file"], found["ok"], found["without_range"], found["left"]) == (
        "ranged.aidl",
        False,
        ["free"],
        0,
    )
    assert {k: lower[k] for k in ("param", "value", "ok", "works")} == {
        "param": "width",
        "value": 20.0,
        "ok": True,
        "works": None,
    }
    assert (upper["written"], upper["value"], upper["works"], upper["beyond"]["value"]) == (40, 200, 150, 151)
    assert upper["findings"] == [
        {
            "code": "E0604",
            "message": "assertion failed: `width <= 150` does not hold",
            "label": "200 is not <= 150",
            "text": "width <= 150",
            "file": "ranged.aidl",
            "line": 6,
        }
    ]


def test_mended_program_is_tried(aidl: Aidl, folder: Path) -> None:
    (folder / "slip.aidl").write_text(RANGED.replace("width: width", "widht: width"))
    result = aidl("check", "--fix", "--ends", "slip.aidl")
    assert (folder / "slip.aidl").read_text() == RANGED
    assert (result.code, result.out.count("holds up to 150")) == (1, 1)


def test_ends_cannot_be_tried_without_solving(aidl: Aidl) -> None:
    result = aidl("check", "--ends", "--no-solve", "good.aidl")
    assert result.code == 2
    assert "not allowed with argument" in result.err


def test_terminal_is_told_how_far_it_is(aidl: Aidl, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    told = aidl("check", "--ends", "good.aidl").err
    assert "\r\x1b[K0 of 2 ends tried\r\x1b[K1 of 2 ends tried\r\x1b[K2 of 2 ends tried\r\x1b[K" in told
