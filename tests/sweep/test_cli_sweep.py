"""`aidl sweep` as its user has it: what it says, its exit codes, its progress, and hostile orders."""

from __future__ import annotations

import csv
import json
import os
import pty
import random
import re
import shlex
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

import aidl_lang
from aidl_lang.tools.cli import main, sweep
from aidl_lang.tools.sweeping import session
from aidl_lang.tools.sweeping.session import Progress
from tests.commands import Aidl as Command
from tests.sweep.here import PLATE, SIGN


def test_a_summary_for_scripts(folder: Path, aidl: Command) -> None:
    done = aidl("sweep", "plate.aidl", "-D", "width=80,120", "--json")
    told = json.loads(done.out)
    assert (done.code, told["variants"], told["ok"], told["failed"], told["complete"]) == (1, 2, 1, 1, True)
    (failure,) = told["failures"]
    assert (failure["n"], failure["params"], failure["messages"][0]["code"]) == (2, {"width": 120.0}, "E0604")
    assert aidl("sweep", "plate.aidl", "-D", "width=80").code == 0


HOSTILE = [
    *('O\'Brien "Tiny"', '"quoted"', "'", '6"', " spaced ", "</script><script>alert(1)</script>", "a,b;c\td"),
    *("two\nlines", "a\r\nb", "שלום", "\u202eevil", "👍🏽"),
    *("../../../etc/passwd", "/etc/passwd", "..", "con", "\ufeff", "e\u0301"),
    *("=1+1", "@SUM(A1)", "-rf", "$(id)", "`id`", "%s%n", "{width}", "{{n}}", "\\", "x\u0000y", "\x1b[31m"),
]


def orders(count: int) -> list[str]:
    """Returns names of an order, hostile ones and plain ones."""
    chance = random.Random(1)
    plain = [
        "".join(chance.choices("abcdefghijklmnopqrstuvwxyzABC -'", k=chance.randint(1, 12)))
        for _ in range(count)
    ]
    return [*HOSTILE, *plain][:count]


def told_of(folder: Path, names: list[str]) -> None:
    """Asserts that each order is right, or told, and that nothing lies where it should not."""
    with open(folder / "table.csv", newline="", encoding="utf-8-sig") as file:
        found = list(csv.DictReader(file))
    assert [row["name"] for row in found] == [f"'{n}" if n[:1] in "=+-@" and n else n for n in names]
    for row in found:
        if row["ok"] == "true":
            path = Path(row["files"])
            assert path.parent == Path("out")
            ElementTree.parse(folder / path)
        else:
            assert row["messages"], row
            assert not row["files"], row
    inside = {path.name for path in (folder / "out").iterdir()}
    assert inside == {Path(row["files"]).name for row in found if row["files"]}
    beside = {path.name for path in folder.iterdir()}
    assert (
        beside
        == {"plate.aidl", "sign.aidl", "orders.csv", "out", "table.csv", "table.jsonl", "sheet.html", "said"}
        & beside
    )
    assert not {"etc", "passwd"} & {path.name for path in folder.parent.iterdir()}


def write_orders(folder: Path, names: list[str]) -> None:
    with open(folder / "orders.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([["name", "width"], *([name, "300"] for name in names)])


def test_hostile_orders_are_right_or_told(folder: Path, aidl: Command) -> None:
    names = orders(len(HOSTILE) + 1)
    write_orders(folder, names)
    outputs = ("-o", "out/{name}.svg", "-o", "table.csv")
    done = aidl("sweep", "sign.aidl", "--table", "orders.csv", *outputs)
    assert done.code == 1
    told_of(folder, names)
    assert "\x1b" not in done.err.replace("\x1b[K", "")


def test_a_command_with_a_hostile_name_makes_its_file(folder: Path, aidl: Command) -> None:
    names = ['O\'Brien "Tiny"', '"quoted"', "$(id)", "`id`", "a\\'b", " spaced "]
    write_orders(folder, names)
    assert (
        aidl("sweep", "sign.aidl", "--table", "orders.csv", "-o", "out/{n}.svg", "-o", "table.jsonl").code
        == 0
    )
    for line in (folder / "table.jsonl").read_text().splitlines():
        row = json.loads(line)
        (path,) = row["files"]
        made = Path(path).read_bytes()
        Path(path).unlink()
        told = subprocess.run(
            ["bash", "-c", f"printf '%s\\0' {row['command']}"], capture_output=True, text=True, check=True
        ).stdout
        assert main(told.split("\0")[1:-1]) == 0
        assert Path(path).read_bytes() == made, row["name"]


def test_words_with_invisible_characters_reach_a_shell() -> None:
    words = ["a\nb", "x\u202ey", "tab\there", "it's\x1b", "back\\slash\n", "é\n", "\udcff"]
    told = subprocess.run(
        ["bash", "-c", f"printf '%s\\0' {session.joined(words)}"], capture_output=True, check=True
    ).stdout
    assert told.split(b"\0")[:-1] == [word.encode("utf-8", "surrogateescape") for word in words]
    assert session.joined(words).isprintable()
    assert shlex.split(session.joined(["a b", "c"])) == ["a b", "c"]


@pytest.mark.slow
def test_five_hundred_signs(tmp_path: Path) -> None:
    (tmp_path / "sign.aidl").write_text(SIGN)
    names = [*orders(499), "a" * 10_000]
    write_orders(tmp_path, names)
    words = ["--table", "orders.csv", "-o", "out/{name}.svg", "-o", "table.csv", "-o", "sheet.html"]
    words += ["--time-limit", "60"]  # for the name of 10,000 letters
    with open(tmp_path / "said", "wb") as said:
        done = subprocess.run(
            [sys.executable, "-m", "aidl_lang", "sweep", "sign.aidl", *words],
            cwd=tmp_path,
            stderr=said,
            check=False,
        )
    assert done.returncode == 1
    told_of(tmp_path, names)


def test_progress_on_a_terminal(tmp_path: Path) -> None:
    (tmp_path / "plate.aidl").write_text(PLATE)
    words = [sys.executable, *"-m aidl_lang sweep plate.aidl -D width=80,100,120 --jobs 1".split()]
    main_end, other_end = pty.openpty()
    with subprocess.Popen(words, cwd=tmp_path, stderr=other_end, stdout=subprocess.DEVNULL) as run:
        os.close(other_end)
        said = b""
        while True:
            try:
                part = os.read(main_end, 4096)
            except OSError:
                break
            if not part:
                break
            said += part
        assert run.wait() == 1
    os.close(main_end)
    assert re.search(r"\d/3 .*variants/s?.*now width=\d+", said.decode().replace("\r", "\n"))


def test_progress_for_programs(folder: Path, aidl: Command) -> None:
    words = ("sweep", "plate.aidl", "-D", "width=80,120", "-D", "style=*")
    told = [line for line in aidl(*words, "--progress", "json").err.splitlines() if line.startswith("{")]
    last = json.loads(told[-1])
    assert (last["done"], last["count"], last["failed"], last["left"]) == (4, 4, 2, 0)
    quiet = aidl(*words)
    assert (quiet.code, "now width" in quiet.err) == (1, False)


def test_a_cluster_without_workers_is_told_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sweep, "_PATIENCE", 0.0)
    with sweep.progress("auto") as listen:
        for places in (2, 0, 0, 0, 1, 0):
            listen(Progress(10, 3, 0, 0, (), places, 0))
    assert capsys.readouterr().err == "the cluster has no workers; waiting for some\n"


def test_what_a_sweep_reads_is_not_overwritten(folder: Path, aidl: Command) -> None:
    disc = '<svg xmlns="http://www.w3.org/2000/svg"><circle r="5"/></svg>'
    (folder / "2.svg").write_text(disc)
    (folder / "t.csv").write_text("w\n20\n30\n")
    program = 'import "2.svg" as disc\nparam w = 5\nsolid plate { edge = disc()\n rim = circle(radius: w) }\n'
    (folder / "sign.aidl").write_text(program)
    (folder / "link.csv").symlink_to("t.csv")
    (folder / "link.html").symlink_to("sign.aidl")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    for output, read in (
        ("t.csv", "t.csv"),
        ("link.csv", "link.csv"),
        ("{n}.svg", "2.svg"),
        ("link.html", "link.html"),
    ):
        done = aidl("sweep", "sign.aidl", "--table", "t.csv", "-o", output)
        assert (done.code, done.err) == (2, f"error[E0908]: `{read}` was read, and is not overwritten\n")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_the_python_way_does_not_overwrite_what_it_read_either(folder: Path) -> None:
    (folder / "t.csv").write_text("width\n60\n")
    with pytest.raises(aidl_lang.AidlError, match=r"`t.csv` was read"):
        aidl_lang.sweep("plate.aidl", table="t.csv", output="t.csv")


def test_no_cell_of_a_table_is_a_formula(folder: Path, aidl: Command) -> None:
    names = ["=1+1", "+A1", "-B2", "@SUM(A1)", "Ada", "-5", "'t Hooft"]
    with open(folder / "orders.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([["name", "=note"], *([name, name] for name in names)])
    (folder / "sign.aidl").write_text(SIGN.replace("width - 6mm", "width + 600mm"))
    assert aidl("sweep", "sign.aidl", "--table", "orders.csv", "-o", "a.csv", "--no-timings").code == 0
    with open(folder / "a.csv", newline="", encoding="utf-8-sig") as file:
        head, *rows = csv.reader(file)
    assert "'=note" in head
    told = [f"'{name}" for name in names[:4]] + names[4:]
    assert [row[head.index("name")] for row in rows] == [row[head.index("'=note")] for row in rows] == told


def test_a_drawing_sheet_for_each_variant(aidl: Command, tmp_path: Path):
    (tmp_path / "plate.aidl").write_text(
        "solid plate { param width = 100 in 60..140 body = rectangle(width: width, height: 50) }"
    )
    made = ("sweep", "plate.aidl", "-D", "width=60,80")
    done = aidl(*made, "-o", "{n}.svg", "-o", "table.csv", "--drawing-sheet", "--no-timings")
    assert done.code == 0, done.err
    for number, width in ((1, 60), (2, 80)):
        drawn = (tmp_path / f"{number}.svg").read_text("utf-8")
        assert "title-block" in drawn
        assert f'data-value="{width}"' in drawn
    command = next(csv.DictReader((tmp_path / "table.csv").read_text("utf-8-sig").splitlines()))["command"]
    before = (tmp_path / "1.svg").read_bytes()
    assert aidl(*shlex.split(command)[1:]).code == 0
    assert (tmp_path / "1.svg").read_bytes() == before
