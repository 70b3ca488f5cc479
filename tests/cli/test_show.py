"""`aidl show`: pictures of characters on standard output, nothing of a wrong program."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.commands import Aidl
from tests.documents import ROOT

TELEPHONE = str(ROOT / "examples" / "telephone.aidl")


def test_into_a_file_dots_without_escapes(aidl: Aidl):
    """The fixture asks for no colour."""
    shown = aidl("show", TELEPHONE, "--width", "60")
    assert shown.code == 0
    lines = shown.out.splitlines()
    assert "\x1b" not in shown.out
    assert set(shown.out) <= {"\n", " ", *map(chr, range(0x2800, 0x2900))}
    assert 15 <= len(lines) <= 40
    assert 50 <= max(map(len, lines)) <= 60
    # The receiver is a box: its upper edge runs through half of the line.
    assert len(re.findall("[⠛⠉⠒⠶⣤⠿]", max(lines[:4], key=len))) > 30


def test_ascii_is_ascii(aidl: Aidl):
    shown = aidl("show", TELEPHONE, "--protocol", "ascii", "--width", "60", "--show", "names")
    assert shown.out.isascii()
    assert "\x1b" not in shown.out
    assert "dial_plate" in shown.out
    assert "telephone" in shown.out


def test_blocks_have_the_colours_of_the_parts(aidl: Aidl, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("COLORTERM", "truecolor")
    shown = aidl("show", TELEPHONE, "--protocol", "blocks", "--width", "40")
    lines = shown.out.splitlines()
    assert all(line.endswith("\x1b[0m") for line in lines)
    widths = {len(re.sub(r"\x1b\[[^m]*m", "", line)) for line in lines}
    assert widths == {40}
    # crimson, the receiver, and the white paper
    assert "48;2;220;20;60m" in shown.out
    assert "48;2;255;255;255m" in shown.out


@pytest.mark.parametrize(
    ("protocol", "start"), [("kitty", "\x1b_Ga=T"), ("iterm", "\x1b]1337;File="), ("sixel", "\x1bP0;1;0q")]
)
def test_graphics_when_asked_for(aidl: Aidl, protocol: str, start: str):
    assert aidl("show", "good.aidl", "--protocol", protocol, "--width", "20").out.startswith(start)


def test_a_wrong_program_shows_nothing(aidl: Aidl):
    wrong = aidl("show", "wrong.aidl")
    assert (wrong.code, wrong.out) == (1, "")
    assert "wdth" in wrong.err
    unsolvable = aidl("show", "unsolvable.aidl")
    assert (unsolvable.code, unsolvable.out) == (1, "")
    tried = aidl("show", "unsolvable.aidl", "--best-effort", "--width", "20")
    assert tried.code == 1
    assert tried.out.strip()


def test_params_and_dimensions(aidl: Aidl):
    narrow, wide = (
        aidl("show", "good.aidl", "-D", f"width={w}", "--dimension", "--width", "80", "--protocol", "ascii")
        for w in (20, 200)
    )
    assert "200" in wide.out
    assert "200" not in narrow.out


@pytest.mark.parametrize(
    ("width", "protocol"), [("1", "blocks"), ("1", "sixel"), ("300", "braille"), ("300", "ascii")]
)
@pytest.mark.parametrize("size", ["width: 1e6, height: 1", "width: 1, height: 1e6"])
def test_extreme_proportions(aidl: Aidl, folder: Path, width: str, protocol: str, size: str):
    (folder / "long.aidl").write_text(f"solid s {{ r = rectangle({size}) }}")
    shown = aidl("show", "long.aidl", "--width", width, "--protocol", protocol)
    assert shown.code == 0
    assert shown.out


def test_nothing_is_drawn(aidl: Aidl, folder: Path):
    (folder / "empty.aidl").write_text("assembly nothing { }")
    shown = aidl("show", "empty.aidl", "--width", "10")
    assert shown.code == 0
    assert shown.out.strip() == ""
