"""The other verbs: check, fmt, doc, guide, explain, new, grammar, and the frame around them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from aidl_lang.tools.cli.doc import structure_name
from aidl_lang.tools.grammars import FORMATS, export
from tests.commands import Aidl, Result


def test_the_bare_command_greets_with_what_one_needs_first(aidl: Aidl) -> None:
    result = aidl()
    assert result.code == 0
    verbs = re.findall(r"^  aidl ([a-z]+)", result.out, re.MULTILINE)
    assert verbs == ["new", "preview", "compile", "doc", "guide"]
    for verb in verbs:
        assert aidl(verb, "--help").code == 0


def test_check_fix_of_standard_input(aidl: Aidl) -> None:
    mended = "-: fixed: write `radius`\n-: no mistakes found\n"
    slip = "solid a { b = circle(center: origin, raduis: 5) }"
    assert aidl("check", "--fix", "-", stdin=slip) == Result(0, slip.replace("raduis", "radius"), mended)


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


def test_doc_shows_a_name(aidl: Aidl) -> None:
    shown = aidl("doc", "rounded_rectangle")
    assert (shown.code, shown.err) == (0, "")
    assert shown.out.startswith("rounded_rectangle(")
    assert "`top: line`" in shown.out
    assert "Also: " in shown.out
    assert "    solid " in shown.out
    assert "Defined in stdlib/" in shown.out


def test_doc_finds_synonyms_and_mends_slips(aidl: Aidl) -> None:
    by_synonym = aidl("doc", "orthogonal")
    assert by_synonym.out.startswith("`orthogonal` is another name for perpendicular.\n\nperpendicular(")
    by_slip = aidl("doc", "perpendiculr")
    assert by_slip.err == "there is no `perpendiculr`; this is `perpendicular`\n"
    assert by_slip.out.startswith("perpendicular(")
    assert aidl("doc", "RoundedRectangle").out == aidl("doc", "rounded_rectangle").out
    assert aidl("doc", "color").out.startswith('@color("NAME")\n')


def test_doc_of_an_unknown_name(aidl: Aidl) -> None:
    part_of_one = aidl("doc", "circ")
    assert part_of_one.code == 2
    assert "did you mean " in part_of_one.err
    assert "`circle`" in part_of_one.err


def test_doc_finds_names_by_what_they_speak_of(aidl: Aidl) -> None:
    found = aidl("doc", "finger", "joint")
    assert (found.code, found.err) == (0, "")
    assert found.out.startswith("`finger joint` is no name. These speak of it:\n\n  finger_panel  A panel")
    assert aidl("doc", "finger joint").out == found.out
    assert "  living_hinge  " in aidl("doc", "kerf").out  # the name of an argument
    as_json = json.loads(aidl("doc", "kerf", "--json").out)
    assert (as_json[0]["name"], as_json[-1]["name"]) == ("living_hinge", "aidl compile --kerf")


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        *(("export", "aidl compile --output"), ("inch", "in"), ("inch", "aidl compile --units")),
        *((option, f"aidl compile --{option}") for option in ("dxf", "kerf", "nest")),
        *(("sheet", "aidl sheet"), ("text size", "text"), ("distance from the edges", "inside")),
        *(("countersunk", "countersink"), ("cutout", "hole"), ("extrude", "@thickness"), ("label", "text")),
    ],
)
def test_doc_answers_plain_questions_at_once(aidl: Aidl, question: str, answer: str) -> None:
    """What is sought is among the first two."""
    found = aidl("doc", question)
    assert (found.code, found.err) == (0, "")
    lines = [line for line in found.out.splitlines()[1:] if line]
    assert answer in [re.split(r"\s{2,}", line.strip())[0] for line in lines[:2]]


def test_doc_lists_all_names_by_topic(aidl: Aidl) -> None:
    listed = aidl("doc").out
    assert listed.startswith("Rectangles and what is made from them\n  square ")
    assert re.search(r"^  slot +\S", listed, flags=re.MULTILINE)


def test_doc_as_json(aidl: Aidl) -> None:
    found = json.loads(aidl("doc", "inside", "--json").out)
    assert (found["name"], found["sort"], found["topic"]) == ("inside", "relation", "relations")
    form = found["forms"][0]
    assert [a["name"] for a in form["arguments"]][:2] == ["a", "b"]
    assert form["held"] == "b"
    assert form["measures"]["margin"] == "at least"
    everything = json.loads(aidl("doc", "--json").out)
    assert found in everything
    assert len({entry["name"] for entry in everything}) == len(everything)


def test_doc_draws_the_example(aidl: Aidl, folder: Path) -> None:
    result = aidl("doc", "ring", "--picture", "ring.svg")
    assert (result.code, result.out, result.err) == (0, "", "ring.svg: the example of `ring`\n")
    assert (folder / "ring.svg").read_text().startswith("<?xml")
    assert aidl("doc", "ring", "--picture", "-").out == (folder / "ring.svg").read_text()


def test_guide_with_some_topics(aidl: Aidl) -> None:
    some = aidl("guide", "--with", "joints, gear").out
    assert some.startswith(aidl("guide").out.rstrip())
    assert "\n### finger_panel\n" in some
    assert "\n### gear\n" in some
    assert "\n### fillet\n" not in some
    unknown = aidl("guide", "--with", "joint")
    assert unknown.code == 2
    assert unknown.err.startswith(
        "error[E0912]: the reference has no topic `joint`\n  = hint: did you mean `joints`"
    )


def test_guide(aidl: Aidl) -> None:
    short, full = aidl("guide"), aidl("guide", "--full")
    assert (short.code, full.code) == (0, 0)
    assert short.out.startswith("# AIDL in a few pages\n")
    assert full.out.startswith(short.out.rstrip())
    assert "### rounded_rectangle" in full.out


def test_explain(aidl: Aidl) -> None:
    assert aidl("explain", "e0901").out.startswith("# E0901: ")
    listed = aidl("explain").out.splitlines()
    assert "E0901  there is no such file" in listed


def test_new_writes_a_program_that_compiles(aidl: Aidl) -> None:
    assert aidl("new", "lid").code == 0
    assert aidl("fmt", "--check", "lid.aidl").code == 0
    assert aidl("compile", "lid.aidl", "-D", "width=120", "--quiet") == Result(0, "", "")


def test_structure_name() -> None:
    stems = ("lid", "Desk-Lamp 2", "3d", "ü", "shape")
    assert [structure_name(stem) for stem in stems] == ["lid", "desk_lamp_2", "part_3d", "part", "part_shape"]


def test_help_and_version(aidl: Aidl) -> None:
    assert aidl("--version").out.startswith("aidl ")
    assert "compile" in aidl("--help").out
    assert aidl("compile").code == 2


def test_interrupt_is_quiet(aidl: Aidl, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("aidl_lang.pipeline.compile", interrupted)
    assert aidl("check", "good.aidl") == Result(130, "", "")


@pytest.mark.parametrize("asked", [["--report"], ["study", "results"], ["--help"]])
def test_eval_says_what_to_install(aidl: Aidl, monkeypatch: pytest.MonkeyPatch, asked: list[str]) -> None:
    monkeypatch.setattr("aidl_lang.tools.cli.generate.find_spec", lambda name: None)
    assert aidl("eval", *asked) == Result(
        2,
        "",
        "error[E0913]: `aidl eval` needs a package that is not installed\n  = hint: pip install aidl-eval\n",
    )


@pytest.mark.parametrize("format", FORMATS)
def test_grammar_prints_a_format(aidl: Aidl, format: str) -> None:
    assert aidl("grammar", "--format", format) == Result(0, export(format), "")


def test_grammar_writes_a_file(aidl: Aidl, folder: Path) -> None:
    result = aidl("grammar", "--format", "gbnf", "--fenced", "-o", "aidl.gbnf")
    assert result == Result(0, "", "aidl.gbnf: written\n")
    assert (folder / "aidl.gbnf").read_text(encoding="utf-8") == export("gbnf", fenced=True)
