"""`aidl compile`: what is written, when, and what is said."""

from __future__ import annotations

import json
import os
import stat
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import GOOD
from tests.commands import Aidl, Result
from tests.documents import ROOT, blocks


def test_default_output_stands_beside_the_program(aidl: Aidl, folder: Path) -> None:
    result = aidl("compile", "good.aidl")
    assert (result.code, result.out) == (0, "")
    assert result.err.startswith("good.svg: solved")
    assert (folder / "good.svg").read_text().lstrip().startswith("<")


def test_standard_input_and_output(aidl: Aidl) -> None:
    result = aidl("compile", "-", stdin=GOOD)
    assert result.code == 0
    assert "<svg" in result.out
    assert json.loads(aidl("compile", "-", "-o", "-", "--format", "json", stdin=GOOD).out)["aidl"] == 1


def test_format_for_a_name_that_does_not_tell_it(aidl: Aidl, folder: Path) -> None:
    assert aidl("compile", "good.aidl", "-o", "picture.xml", "--format", ".SVG").code == 0
    assert "<svg" in (folder / "picture.xml").read_text()


def test_param_is_set(aidl: Aidl) -> None:
    model = json.loads(aidl("compile", "good.aidl", "-D", "width=100", "-o", "-", "--format", "json").out)
    box = model["root"]["bb"]
    assert box["right"] - box["left"] == pytest.approx(100)


def test_a_text_can_be_set_to_nothing(aidl: Aidl, folder: Path) -> None:
    (folder / "sign.aidl").write_text(
        'param word = "A"\nsolid s {\n    b = square(size: 30)\n'
        '    if word != "" { drawing d { t = text(word, height: 5) } }\n}\n'
    )
    assert "s.d" in aidl("compile", "sign.aidl", "-o", "-").out
    assert "s.d" not in aidl("compile", "sign.aidl", "-D", "word=", "-o", "-").out


def test_layers_are_shown(aidl: Aidl) -> None:
    plain = aidl("compile", "good.aidl", "-o", "-").out
    assert aidl("compile", "good.aidl", "-o", "-", "--show", "names,points").out != plain


def test_timings(aidl: Aidl) -> None:
    lines = aidl("compile", "good.aidl", "--timings").err.splitlines()
    assert any(line.startswith("total") and line.endswith(" ms") for line in lines)


def test_wrong_program_leaves_the_old_drawing(aidl: Aidl, folder: Path) -> None:
    (folder / "wrong.svg").write_text("old")
    result = aidl("compile", "wrong.aidl", "--best-effort")
    assert result.code == 1
    assert "wrong.aidl:2:45" in result.err
    assert "nothing written" in result.err
    assert (folder / "wrong.svg").read_text() == "old"


def test_unsolved_program_is_drawn_only_if_asked(aidl: Aidl, folder: Path) -> None:
    assert aidl("compile", "unsolvable.aidl").code == 1
    assert not (folder / "unsolvable.svg").exists()
    assert aidl("compile", "unsolvable.aidl", "--best-effort").code == 1
    assert (folder / "unsolvable.svg").exists()


def test_existing_output_keeps_its_mode_and_its_link(aidl: Aidl, folder: Path) -> None:
    real = folder / "real.svg"
    real.write_text("old")
    real.chmod(0o640)
    (folder / "link.svg").symlink_to(real)
    assert aidl("compile", "good.aidl", "-o", "link.svg").code == 0
    assert (folder / "link.svg").is_symlink()
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert real.read_text() != "old"


def test_nothing_is_left_beside_the_output(aidl: Aidl, folder: Path) -> None:
    before = set(os.listdir(folder))
    aidl("compile", "good.aidl")
    assert set(os.listdir(folder)) - before == {"good.svg"}


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["latin1.aidl"], "E0903", "not UTF-8 text (line 2)"),
        (["zeros.aidl"], "E0903", "zero bytes"),
        (["good.aidl", "-o", "folder.svg"], "E0904", "is a directory"),
    ],
)
def test_wrong_files(aidl: Aidl, folder: Path, arguments: list[str], code: str, words: str) -> None:
    (folder / "latin1.aidl").write_bytes("// fine\n// gr\xf6\xdfe".encode("latin-1"))
    (folder / "zeros.aidl").write_bytes(b"\0\0\0")
    (folder / "folder.svg").mkdir()
    result = aidl("compile", *arguments)
    assert (result.code, result.out) == (2, "")
    assert result.err.startswith(f"error[{code}]")
    assert words in result.err


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read and write everything")
def test_permissions(aidl: Aidl, folder: Path) -> None:
    (folder / "good.aidl").chmod(0)
    assert "E0902" in aidl("compile", "good.aidl").err
    folder.chmod(0o500)
    assert "E0904" in aidl("compile", "-", "-o", "x.svg", stdin=GOOD).err


def test_what_a_program_reads_is_not_overwritten(aidl: Aidl, folder: Path) -> None:
    disc = '<svg xmlns="http://www.w3.org/2000/svg"><circle r="5"/></svg>'
    (folder / "disc.svg").write_text(disc)
    (folder / "sign.aidl").write_text('import "disc.svg" as disc\nsolid plate { edge = disc() }\n')
    result = aidl("compile", "sign.aidl", "-o", "disc.svg")
    assert result.code == 2
    assert "error[E0908]: `disc.svg` was read, and is not overwritten" in result.err
    assert (folder / "disc.svg").read_text() == disc


@pytest.mark.parametrize("verb", ["compile", "sheet"])
def test_a_link_to_what_was_read_is_not_overwritten(aidl: Aidl, folder: Path, verb: str) -> None:
    (folder / "soft.pdf").symlink_to("good.aidl")
    (folder / "hard.pdf").hardlink_to(folder / "good.aidl")
    for name in ("soft.pdf", "hard.pdf"):
        result = aidl(verb, "good.aidl", "-o", name)
        assert (result.code, result.err) == (2, f"error[E0908]: `{name}` was read, and is not overwritten\n")
    assert (folder / "good.aidl").read_text() == GOOD


def test_what_is_write_protected_is_not_replaced(aidl: Aidl, folder: Path) -> None:
    for name, words in (("kept.svg", ("compile", "good.aidl", "-o")), ("ugly.aidl", ("fmt",))):
        (folder / name).write_text("solid   a { }")
        (folder / name).chmod(0o444)
        told = f"error[E0904]: `{name}` cannot be written: it is write-protected\n"
        assert aidl(*words, name) == Result(2, "", told)
        assert (folder / name).read_text() == "solid   a { }"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no such files")
def test_only_regular_files_of_bounded_size_are_read(aidl: Aidl, folder: Path) -> None:
    os.mkfifo(folder / "pipe.aidl")
    with open(folder / "endless.aidl", "wb") as file:
        file.truncate(10_000_001)
    told = {
        "pipe.aidl": "it is no regular file",
        "/dev/zero": "it is no regular file",
        "endless.aidl": "it has more than 10 MB",
    }
    for name, why in told.items():
        result = aidl("check", name)
        assert (result.code, result.err) == (2, f"error[E0902]: `{name}` cannot be read: {why}\n")
    result = aidl("check", "-", stdin=" " * 10_000_001)
    assert (result.code, result.err) == (2, "error[E0902]: `-` cannot be read: it has more than 10 MB\n")
    (folder / "main.aidl").write_text('import "pipe.aidl" as pipe\n')
    result = aidl("check", "main.aidl")
    assert result.code == 1
    assert "it cannot be read" in result.err


@pytest.mark.parametrize("text", ["", "// only a remark\n", "solid part(w = 3) { b = square(size: w) }\n"])
@pytest.mark.parametrize("more", [(), ("--quiet",)])
def test_nothing_replaces_no_drawing(aidl: Aidl, folder: Path, text: str, more: tuple[str, ...]) -> None:
    assert aidl("compile", "good.aidl", "-o", "plate.svg", "-o", "plate.dxf").code == 0
    before = (folder / "plate.svg").read_bytes(), (folder / "plate.dxf").read_bytes()
    (folder / "none.aidl").write_text(text)
    result = aidl("compile", "none.aidl", "-o", "new.svg", "-o", "plate.svg", "-o", "plate.dxf", *more)
    assert result.code == 2
    assert "error[E0929]: nothing is drawn, so `plate.svg` is left as it is\n" in result.err
    assert "= hint: if it shall be empty, delete it first\n" in result.err
    assert ((folder / "plate.svg").read_bytes(), (folder / "plate.dxf").read_bytes()) == before
    assert not (folder / "new.svg").exists()
    # Where there is none yet, or a drawing of nothing, one is written.
    for _ in range(2):
        assert aidl("compile", "none.aidl", "-o", "new.svg", *more).code == 0
    assert (folder / "new.svg").exists()


def test_a_terminal_is_sent_text_alone(aidl: Aidl, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    assert aidl("compile", "good.aidl", "-o", "-", "--format", "svg").out.startswith("<?xml")
    refused = aidl("compile", "good.aidl", "-o", "-", "--format", "png")
    assert (refused.code, refused.out) == (2, "")
    assert "error[E0920]: a terminal cannot show this format\n" in refused.err


def test_the_page_on_the_solver_shows_what_is_printed(aidl: Aidl, folder: Path) -> None:
    program, shown = [b for b in blocks(ROOT / "docs" / "solver.md") if b.heading == "An example"]
    (folder / "sign.aidl").write_text(program.text, encoding="utf-8")
    assert aidl("compile", "sign.aidl", "--trace-solve", "--quiet").err == shown.text
