"""The other verbs: check, fmt, params, explain, new, and the frame around them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from aidl_lang.cli.new import structure_name
from tests.cli.conftest import GOOD, WRONG, Result

Aidl = Callable[..., Result]
OUT_OF_REACH = """\
assembly a {
    solid plate {
        edge = square(center: origin, size: 30)
        hole bore {
            rim = circle(center: plate.edge.center, radius: 3)
        }
    }
}
"""


def test_check_says_what_it_found(aidl: Aidl) -> None:
    assert aidl("check", "good.aidl") == Result(0, "", "good.aidl: no mistakes found\n")
    result = aidl("check", "wrong.aidl", "good.aidl", "missing.aidl")
    assert result.code == 2
    assert "wrong.aidl: 1 error" in result.err
    assert "good.aidl: no mistakes found" in result.err
    assert "E0901" in result.err


def test_check_as_json(aidl: Aidl) -> None:
    document = json.loads(aidl("check", "wrong.aidl", "--json").out)
    assert document["ok"] is False
    assert document["fixed"] == []
    found = document["diagnostics"][0]
    assert (found["file"], found["line"], found["severity"]) == ("wrong.aidl", 2, "error")


def test_check_fix_mends_the_file(aidl: Aidl, folder: Path) -> None:
    (folder / "reach.aidl").write_text(OUT_OF_REACH)
    assert aidl("check", "reach.aidl").code == 1
    result = aidl("check", "--fix", "reach.aidl")
    assert result.code == 0
    assert "reach.aidl: fixed: " in result.err
    assert (folder / "reach.aidl").read_text() != OUT_OF_REACH
    assert aidl("compile", "reach.aidl").code == 0


def test_check_fix_of_standard_input(aidl: Aidl) -> None:
    result = aidl("check", "--fix", "-", stdin=OUT_OF_REACH)
    assert result.code == 0
    assert result.out.startswith("assembly a {")


def test_check_fix_leaves_a_good_program_alone(aidl: Aidl, folder: Path) -> None:
    before = (folder / "good.aidl").stat().st_mtime_ns
    assert aidl("check", "--fix", "good.aidl").code == 0
    assert (folder / "good.aidl").stat().st_mtime_ns == before


def test_fmt(aidl: Aidl, folder: Path) -> None:
    ugly = "solid   plate{edge=circle(center:origin,radius:5)}"
    (folder / "ugly.aidl").write_text(ugly)
    assert aidl("fmt", "--check", "ugly.aidl").code == 1
    difference = aidl("fmt", "--diff", "ugly.aidl")
    assert difference.code == 0
    assert "-solid   plate{" in difference.out
    assert "\\ No newline at end of file" in difference.out
    assert (folder / "ugly.aidl").read_text() == ugly
    assert aidl("fmt", "ugly.aidl") == Result(0, "", "")
    pretty = (folder / "ugly.aidl").read_text()
    assert pretty == "solid plate { edge = circle(center: origin, radius: 5) }\n"
    assert aidl("fmt", "--check", "ugly.aidl").code == 0
    assert aidl("fmt", "-", stdin=ugly).out == pretty


def test_fmt_leaves_a_broken_program_alone(aidl: Aidl, folder: Path) -> None:
    (folder / "broken.aidl").write_text("solid { = ")
    result = aidl("fmt", "broken.aidl", "missing.aidl")
    assert result.code == 2
    assert "broken.aidl" in result.err
    assert (folder / "broken.aidl").read_text() == "solid { = "


def test_params(aidl: Aidl) -> None:
    result = aidl("params", "good.aidl")
    assert result.code == 0
    assert result.out.split()[:3] == ["width", "=", "40"]
    assert "20..200 step 5" in result.out
    assert "How wide the plate is." in result.out
    knob = json.loads(aidl("params", "good.aidl", "--json").out)[0]
    assert (knob["value"], knob["low"], knob["high"], knob["step"]) == (40, 20, 200, 5)


def test_params_of_a_program_without_any(aidl: Aidl) -> None:
    assert aidl("params", "-", stdin="solid a { c = circle(center: origin, radius: 1) }") == Result(0, "", "")


def test_explain(aidl: Aidl) -> None:
    assert aidl("explain", "e0901").out.startswith("# E0901: ")
    listed = aidl("explain").out.splitlines()
    assert "E0901  there is no such file" in listed
    unknown = aidl("explain", "W0901")
    assert unknown.code == 2
    assert "did you mean E0901?" in unknown.err
    assert aidl("explain", "nonsense").code == 2


def test_new_writes_a_program_that_compiles(aidl: Aidl, folder: Path) -> None:
    assert aidl("new", "lid").code == 0
    assert aidl("fmt", "--check", "lid.aidl").code == 0
    assert aidl("compile", "lid.aidl", "-D", "width=120", "--quiet") == Result(0, "", "")
    (folder / "lid.aidl").write_text("mine")
    again = aidl("new", "lid.aidl")
    assert again.code == 2
    assert "E0906" in again.err
    assert (folder / "lid.aidl").read_text() == "mine"
    assert "E0904" in aidl("new", "absent/lid").err


@pytest.mark.parametrize(
    ("stem", "name"),
    [
        ("lid", "lid"),
        ("Desk-Lamp 2", "desk_lamp_2"),
        ("3d", "part_3d"),
        ("ü", "part"),
        ("shape", "part_shape"),
    ],
)
def test_structure_name(stem: str, name: str) -> None:
    assert structure_name(stem) == name


def test_help_and_version(aidl: Aidl) -> None:
    assert aidl("--version").out.startswith("aidl ")
    assert "compile" in aidl("--help").out
    assert aidl().code == 2
    assert aidl("compile").code == 2


def test_interrupt_is_quiet(aidl: Aidl, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("aidl_lang.pipeline.check", interrupted)
    assert aidl("check", "good.aidl") == Result(130, "", "")


def test_programs_used_here_are_what_they_say(aidl: Aidl) -> None:
    assert aidl("check", "-", stdin=GOOD).code == 0
    assert aidl("check", "-", stdin=WRONG).code == 1
