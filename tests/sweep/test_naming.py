"""Names of files made of strangers' values: they stay where the pattern says, and no two are one."""

from __future__ import annotations

import os
from pathlib import Path, PurePath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.tools.sweeping.outputs import distinct, safe

HOSTILE = [
    *("../../etc/passwd", "/etc/passwd", "..", ".", "", " ", "con", "NUL.txt", "a/b\\c", "x\0y", "\n", "-rf"),
    *("~", "$(id)", "</script>", "\u202egpj.exe", "e\u0301", "👍", "a" * 10_000, "ß" * 500),
    *(".hidden", "name.", "a:b", "*?|", "\ud800"),
]


def is_one_part_of_a_path(made: str) -> bool:
    plain = made and len(made.encode()) <= 61 and not set(made) & set('/\\\0:*?"<>|\n\r{}~')
    shown = made.isprintable() or any(ord(char) > 127 for char in made)
    return bool(
        plain and shown and os.path.normpath(f"out/{made}.dxf") == f"out/{made}.dxf" and safe(made) == made
    )


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_values_are_plain_in_a_name(text: str, tmp_path: Path) -> None:
    name = f"{safe(text)}.dxf"
    assert is_one_part_of_a_path(safe(text))
    (tmp_path / name).touch()
    assert [each.name for each in tmp_path.iterdir()] == [name]
    assert not name.startswith(".")
    assert PurePath(name).stem.casefold() not in ("con", "nul", "nul.txt")


@given(st.text(max_size=100))
def test_any_text_is_one_part_of_a_path(text: str) -> None:
    assert is_one_part_of_a_path(safe(text))


@given(st.lists(st.sampled_from(["a.dxf", "A.dxf", "b.dxf", "a~2.dxf", "a~3.dxf", "é.dxf", "e\u0301.dxf"])))
def test_names_that_a_file_system_takes_for_one_are_told_apart(names: list[str]) -> None:
    made = list(distinct(names))
    assert len({name.casefold() for name in made}) == len(names)
    assert made == list(distinct(names))
    assert all(name == first for name, first in zip(made[:1], names[:1], strict=True))


def test_plain_values_stay_as_they_are() -> None:
    for text in ("round", "60", "12.5", "-3", "Ada", "Zoë", "דן", "a_b-c"):
        assert safe(text) == text
