"""The tables are made once and kept; a cache that fails costs time only."""

from __future__ import annotations

import copy
import os
import pickle
import subprocess
import sys
from pathlib import Path

import pytest

from aidl_lang.resources import resource
from aidl_lang.syntax import tables
from tests.documents import ROOT


def test_the_cache_folder_follows_the_environment(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert tables.cache_path("a").is_relative_to(tmp_path)
    assert tables.cache_path("a") != tables.cache_path("b")


def test_what_was_written_is_read(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "tables.pickle"
    assert tables._read(path) is None
    tables._write(path, tables.load_tables())
    again = tables._read(path)
    assert again is not None
    assert again.actions == tables.load_tables().actions
    assert [file.name for file in path.parent.iterdir()] == ["tables.pickle"]


@pytest.mark.parametrize("content", [b"", b"garbage", b"\x80\x05K\x01."])
def test_a_broken_cache_is_made_anew(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "tables.pickle"
    path.write_bytes(content)
    assert tables._read(path) is None


def _without_rules() -> object:
    """Tables as a version of the code with other fields would have left them."""
    known = copy.copy(tables.load_tables())
    del known.__dict__["rules"]
    return known


@pytest.mark.parametrize("other", [tables.Rule("<a>", 1, None, 0, (0,)), [], _without_rules()])
def test_a_cache_of_something_else_is_made_anew(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, other: object
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    path = tables.cache_path(resource("grammar/aidl.lark").read_text(encoding="utf-8"))
    path.parent.mkdir()
    path.write_bytes(pickle.dumps(other))
    assert tables.load_tables.__wrapped__().rules == tables.load_tables().rules
    read = tables._read(path)
    assert read is not None
    assert read.rules == tables.load_tables().rules


def test_the_name_of_the_cache_depends_on_the_code_that_reads_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    before = tables.cache_path("a")
    edited = tmp_path / "tables.py"
    edited.write_bytes(Path(tables.__file__).read_bytes() + b"# edited")
    monkeypatch.setattr(tables, "__file__", str(edited))
    assert tables.cache_path("a") != before


def test_a_folder_that_cannot_be_written_is_tolerated(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    tables._write(tmp_path / "file" / "tables.pickle", tables.load_tables())


def test_a_warm_start_does_without_lark(tmp_path: Path) -> None:
    program = (
        "import sys; from aidl_lang.parser import parse; from aidl_lang.source import SourceFile;"
        "assert parse(SourceFile('', 'let a = 3')).module.statements; print('lark' in sys.modules)"
    )
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": str(ROOT)}
    runs = [
        subprocess.run(
            [sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True
        )
        for _ in range(2)
    ]
    assert [run.stdout.strip() for run in runs] == ["True", "False"]


def test_resources_are_found() -> None:
    assert resource("grammar/aidl.lark").is_file()
    assert resource("docs/diagnostics").is_dir()
    with pytest.raises(FileNotFoundError):
        resource("nothing/of/the/kind")
