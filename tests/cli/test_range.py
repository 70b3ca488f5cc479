"""`aidl check --range`: what is said, where, and with which exit code."""

from __future__ import annotations

import json
import re
from pathlib import Path

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


def test_a_place_is_told_on_standard_output_with_what_would_keep_it(aidl: Aidl, folder: Path) -> None:
    (folder / "plate.aidl").write_text(PLATE)
    result = aidl("check", "--range", "plate.aidl")
    assert (result.code, result.out.splitlines()[:2]) == (
        1,
        [
            "plate.aidl: at `way = 34.05` the openings of `plate` go from 1 to 0: "
            "`plate.bore.rim` breaks through its edge",
            "plate.aidl:   let the range of `way` end at 34",
        ],
    )
    assert re.search(
        r"1 param walked from end to end, 2 places where the kind changes, [\d.]+ s; ", result.err
    )


def test_what_is_of_one_kind_is_quiet_and_says_how_far_that_holds(aidl: Aidl) -> None:
    result = aidl("check", "--range", "good.aidl", "wrong.aidl")
    assert (result.code, result.out) == (1, "")
    assert re.search(r"good.aidl: 1 param walked from end to end, one kind throughout, [\d.]+ s", result.err)
    assert "not for what lies between two of them" in result.err
    assert "wrong.aidl: 1 error; nothing was solved; its params were not walked\n" in result.err
    none = aidl("check", "--range", "-", stdin="solid a { b = circle(center: origin, radius: 2) }")
    assert none.code == 0
    assert none.err.endswith("-: no param has a range of numbers, so there is nothing to walk\n")
    assert aidl("check", "--range", "--ends", "good.aidl").code == 2


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
    text = """\
solid plate {
    param way = 0 in 0..30
    param size = 4 in 2..14
    body = rectangle(center: origin, width: 80, height: 50)
    hole bore { rim = circle(center: (way, 0), radius: size) }
}
"""
    (folder / "plate.aidl").write_text(text)
    assert aidl("check", "--range", "plate.aidl").code == 0
    result = aidl("check", "--pairs", "plate.aidl")
    assert (result.code, result.out) == (
        1,
        "plate.aidl: at `way = 30` with `size = 14` the openings of `plate` go from 1 to 0: "
        "`plate.bore.rim` breaks through its edge\n",
    )
    assert "1 pair of params tried at the ends and halfway, at 8 pairs of values" in result.err
    (found,) = json.loads(aidl("check", "--pairs", "--json", "plate.aidl").out)["range"]
    (pair,) = found["pairs"]
    assert (pair["params"], pair["turns"][0]["values"], pair["tried"]) == (["way", "size"], [30, 14], 8)


def test_python_gives_warnings_with_fixes() -> None:
    first, second = aidl_lang.check(PLATE, range=True)
    assert (first.code, first.span and first.span.line, second.code) == ("W0607", 2, "W0607")
    assert first.fix is not None
    assert first.fix.title == "let the range of `way` end at 34"
    assert aidl_lang.check(PLATE) == []
