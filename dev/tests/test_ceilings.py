"""Ceilings fall and never rise; a room above its own is told, as is one without."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.documents import ROOT

sys.path.insert(0, str(ROOT / ".ci"))
from ceilings import lines, lowered, told

PROJECT = """\
[tool.aidl.ceilings]
"aidl_lang/solver" = 10
"aidl_lang/tools/cli" = 10

[tool.other]
"aidl_lang/solver" = 10
"""


def test_ceilings_are_lowered_and_none_is_raised() -> None:
    found = lowered(PROJECT, {"aidl_lang/solver": 7, "aidl_lang/tools/cli": 12})
    assert found == PROJECT.replace("10", "7", 1)


def test_what_is_above_its_ceiling_or_has_none_is_told() -> None:
    ceilings = {"aidl_lang/solver": 10, "aidl_lang/gone": 3}
    assert told({"aidl_lang/solver": 10}, {"aidl_lang/solver": 10}) == []
    assert told({"aidl_lang/solver": 12, "aidl_lang/new": 1}, ceilings) == [
        "aidl_lang/solver: 12 lines, 2 above the ceiling of 10",
        "aidl_lang/new: 1 lines and no ceiling",
        "aidl_lang/gone: it has a ceiling and no lines",
    ]


@pytest.mark.parametrize(
    ("path", "room"),
    [
        ("aidl_lang/parser.py", "aidl_lang"),
        ("aidl_lang/solver/stages/all.py", "aidl_lang/solver"),
        ("aidl_lang/tools/vocabulary.py", "aidl_lang/tools"),
        ("server/aidl_server/ide/hover/hover.py", "server/aidl_server/ide"),
        ("eval/aidl_eval/study/site.py", "eval/aidl_eval"),
    ],
)
def test_lines_are_counted_by_room(tmp_path: Path, path: str, room: str) -> None:
    file = tmp_path / path
    file.parent.mkdir(parents=True)
    file.write_text('"""What it is."""\n\n# why\nx = 1\n')
    assert lines(tmp_path) == {room: 4}
