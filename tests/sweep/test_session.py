"""A sweep as a whole: its drawings, its tables, what it keeps and how it goes on."""

from __future__ import annotations

import csv
import json
import shlex
import shutil
from codecs import BOM_UTF8
from itertools import islice
from math import pi
from pathlib import Path

import ezdxf
import pyarrow.parquet
import pytest

from aidl_lang.export.pdf import font_file
from aidl_lang.tools.cli import main
from aidl_lang.tools.sweeping.session import Sweep
from tests.sweep.here import PLATE, Here, asked, sweep


def rows(path: Path) -> list[dict[str, str]]:
    assert path.read_bytes().startswith(BOM_UTF8)
    with open(path, newline="", encoding="utf-8-sig") as file:
        return list(csv.DictReader(file))


def test_a_grid_has_a_drawing_and_a_row_for_each_variant(tmp_path: Path) -> None:
    session = sweep(tmp_path, names=["out/{style}/{width}.dxf", "table.csv", "table.jsonl", "table.parquet"])
    found = rows(tmp_path / "table.csv")
    assert [(row["n"], row["width"], row["style"], row["status"], row["ok"]) for row in found] == [
        ("1", "40", "round", "solved", "true"),
        ("2", "40", "square", "solved", "true"),
        ("3", "80", "round", "solved", "true"),
        ("4", "80", "square", "solved", "true"),
    ]
    for row in found:
        corners = (4 - pi) * 25 if row["style"] == "round" else 0.0
        assert float(row["area"]) == pytest.approx(float(row["width"]) * 30 - pi * 25 - corners)
        assert (row["drawn_width"], row["drawn_height"]) == (row["width"], "30")
        drawn = ezdxf.readfile(row["files"])
        assert (
            max(x for each in drawn.modelspace().query("LWPOLYLINE") for x, *_ in each)
            == float(row["width"]) / 2
        )
        assert Path(row["files"]) == tmp_path / "out" / row["style"] / f"{row['width']}.dxf"
    lines = [json.loads(line) for line in (tmp_path / "table.jsonl").read_text().splitlines()]
    arrow = pyarrow.parquet.read_table(tmp_path / "table.parquet").to_pylist()
    assert lines == arrow
    assert [float(row["area"]) for row in found] == [line["area"] for line in lines]
    assert session.is_complete
    assert session.failed == 0
    assert not list(tmp_path.glob("*.sweep"))


def test_what_fails_is_told_with_the_command_that_makes_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    session = sweep(tmp_path, ["width=80,120"], ["out/{width}.svg", "table.csv"])
    assert session.failed == 1
    bad = rows(tmp_path / "table.csv")[1]
    assert (bad["status"], bad["ok"], bad["errors"], bad["files"]) == ("solved", "false", "1", "")
    assert bad["failed_asserts"] == "E0604 line 10: assertion failed: it fits the sheet (120 is not < 110)"
    assert float(bad["drawn_width"]) == 120
    monkeypatch.chdir(tmp_path)
    program, *words = shlex.split(bad["command"])
    assert (program, main(words)) == ("aidl", 1)
    assert "assertion failed: it fits the sheet" in capsys.readouterr().err


def test_a_sweep_that_is_broken_off_goes_on(tmp_path: Path) -> None:
    names = ["out/{width}-{style}.svg", "table.csv"]
    whole = tmp_path / "whole"
    whole.mkdir()
    values = ["width=40,80,120", "style=*"]
    sweep(whole, values, names)

    with Sweep(asked(tmp_path, values, names), Here) as stopped:
        assert len(list(islice(stopped, 4))) == 4
    assert not (tmp_path / "table.csv").exists()
    assert (tmp_path / "table.csv.sweep").is_dir()
    engine = Here()
    session = sweep(tmp_path, values, names, engine, resumes=True)
    assert (session.kept >= 4, engine.calls + session.kept) == (True, 6)
    assert rows(tmp_path / "table.csv") == [
        {name: cell.replace(str(whole), str(tmp_path)) for name, cell in row.items()}
        for row in rows(whole / "table.csv")
    ]
    assert not (tmp_path / "table.csv.sweep").exists()


def test_without_resume_it_begins_anew(tmp_path: Path) -> None:
    with Sweep(asked(tmp_path, names=["table.csv"]), Here) as stopped:
        next(iter(stopped))
    engine = Here()
    assert sweep(tmp_path, names=["table.csv"], engine=engine).kept == 0
    assert engine.calls == 4


def test_a_wider_sweep_computes_what_is_new(tmp_path: Path) -> None:
    cache, engine = str(tmp_path / "cache"), Here()
    sweep(tmp_path, ["width=40,80"], ["a.csv", "out/{width}.svg"], engine, cache=cache)
    assert engine.calls == 2
    (tmp_path / "out" / "80.svg").unlink()
    wider = sweep(tmp_path, ["width=40,60,80"], ["b.csv", "out/{width}.svg"], engine, cache=cache)
    assert (engine.calls, wider.kept) == (3, 2)
    assert (tmp_path / "out" / "80.svg").is_file()
    assert [row["area"] for row in rows(tmp_path / "b.csv")[::2]] == [
        row["area"] for row in rows(tmp_path / "a.csv")
    ]


def test_a_changed_import_is_seen(tmp_path: Path) -> None:
    text = 'import "lib.aidl"\nsolid s { param w = 10 in 5..50\n body = rectangle(width: w, height: tall) }\n'
    cache, engine = str(tmp_path / "cache"), Here()
    areas = []
    for tall in (10, 20, 10):
        (tmp_path / "lib.aidl").write_text(f"let tall = {tall}\n")
        session = sweep(tmp_path, ["w=10"], ["t.csv"], engine, text, cache=cache)
        areas.append(session.rows[0].outcome.measures["area"])
    assert (areas, engine.calls) == ([100.0, 200.0, 100.0], 3)
    sweep(tmp_path, ["w=10"], ["t.csv"], engine, text, cache=cache)
    assert engine.calls == 3


def test_files_that_only_some_variants_ask_for_are_sent_after_them(tmp_path: Path) -> None:
    for name in ("a.ttf", "b.ttf"):
        shutil.copy(font_file(), tmp_path / name)
    text = 'param face = "a.ttf"\ndrawing d { word = text("A", height: 5, font: face) }\n'
    engine = Here()
    session = sweep(tmp_path, ["face=a.ttf,b.ttf,c.ttf"], ["t.csv"], engine, text)
    assert ([row.ok for row in session.rows], engine.calls) == ([True, True, False], 5)


def test_an_older_run_s_file_of_a_failing_variant_is_named(tmp_path: Path) -> None:
    sweep(tmp_path, ["width=80"], ["out/{width}.svg"])
    session = sweep(tmp_path, ["width=80"], ["out/{width}.svg"], text=PLATE.replace("110mm", "70mm"))
    assert session.stale == [str(tmp_path / "out" / "80.svg")]


def test_two_runs_give_the_same_bytes(tmp_path: Path) -> None:
    names, found = ["t.csv", "t.parquet", "s.pdf", "s.png", "s.html"], []
    for _ in range(2):
        sweep(tmp_path, ["width=40,120", "style=*"], names)
        found.append([(tmp_path / name).read_bytes() for name in names])
    assert found[0] == found[1]
