"""`aidl check --ends`, `--range` and `--pairs` as data, on a terminal and from Python."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

import aidl_lang
from tests.commands import Aidl

PLATE = """\
solid plate {
    param way = 0 in 0..50
    param free = 3
    body = rectangle(center: origin, width: 80, height: 50)
    hole bore { rim = circle(center: (way, free), radius: 6) }
}
"""


def test_range_as_json(aidl: Aidl, folder: Path) -> None:
    (folder / "plate.aidl").write_text(PLATE)
    document = json.loads(aidl("check", "--range", "--json", "plate.aidl").out)
    (found,) = document["range"]
    (walk,) = found["walked"]
    turn, _ = walk["turns"]
    assert (document["ok"], found["left"], walk["param"], walk["range"]) == (False, [], "way", [0, 50])
    assert (turn["before"], turn["value"], turn["changes"][0]["kind"]) == (34.0, 34.05, "openings")
    start, end, text = turn["fixes"][0]["edit"]
    assert PLATE[:start] + text + PLATE[end:] == PLATE.replace("0..50", "0..34")


def test_two_params_are_turned_together(aidl: Aidl, folder: Path) -> None:
    text = PLATE.replace("0..50", "0..30 step 15").replace("free = 3", "size = 6 in 2..14 step 4")
    (folder / "plate.aidl").write_text(text.replace("(way, free), radius: 6", "(way, 0), radius: size"))
    (found,) = json.loads(aidl("check", "--pairs", "--json", "plate.aidl").out)["range"]
    (pair,) = found["pairs"]
    assert (pair["params"], pair["turns"][0]["values"], pair["tried"]) == (["way", "size"], [30, 14], 8)


def test_terminal_is_told_how_far_it_is(aidl: Aidl, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    told = aidl("check", "--ends", "good.aidl").err
    assert "\r\x1b[K0 of 2 ends tried\r\x1b[K1 of 2 ends tried\r\x1b[K2 of 2 ends tried\r\x1b[K" in told


@pytest.mark.usefixtures("at_once")
def test_python_gives_warnings_with_fixes() -> None:
    first, second = aidl_lang.check(PLATE, range=True)
    assert (first.code, first.span and first.span.line, second.code) == ("W0607", 2, "W0607")
    assert first.fix is not None
    assert first.fix.title == "let the range of `way` end at 34"
    assert aidl_lang.check(PLATE) == []
