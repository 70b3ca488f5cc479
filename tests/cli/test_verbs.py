"""The other verbs: check, fmt, params, doc, guide, explain, new, and the frame around them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from aidl_lang.tools.cli.doc import structure_name
from tests.commands import Aidl, Result

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


def test_the_bare_command_greets_with_what_one_needs_first(aidl: Aidl) -> None:
    result = aidl()
    assert result.code == 0
    verbs = re.findall(r"^  aidl ([a-z]+)", result.out, re.MULTILINE)
    assert verbs == ["new", "preview", "compile", "doc", "guide"]
    for verb in verbs:
        assert aidl(verb, "--help").code == 0


def test_check_says_what_it_found(aidl: Aidl) -> None:
    assert aidl("check", "good.aidl") == Result(0, "", "good.aidl: no mistakes found\n")
    result = aidl("check", "wrong.aidl", "good.aidl", "missing.aidl")
    assert result.code == 2
    assert "wrong.aidl: 1 error; nothing was solved\n" in result.err
    assert "good.aidl: no mistakes found\n" in result.err
    assert "E0901" in result.err
    assert "missing.aidl: " not in result.err


def test_check_solves_and_draws_unless_told_not_to(aidl: Aidl, folder: Path) -> None:
    result = aidl("check", "unsolvable.aidl")
    assert result.code == 1
    assert "error[E0601]" in result.err
    assert result.err.endswith("unsolvable.aidl: 1 error\n")
    quick = "unsolvable.aidl: no mistakes found; nothing was solved\n"
    assert aidl("check", "--no-solve", "unsolvable.aidl") == Result(0, "", quick)
    (folder / "corner.aidl").write_text("solid a { b = square(center: origin, size: 10); fillet(b, 6) }\n")
    assert "error[E0518]" in aidl("check", "corner.aidl").err
    (folder / "thin.aidl").write_text(
        "solid a { b = square(center: origin, size: 10); assert b.width > 20 }\n"
    )
    assert "error[E0604]" in aidl("check", "thin.aidl").err
    assert list(folder.glob("*.svg")) == []


def test_check_as_json(aidl: Aidl) -> None:
    document = json.loads(aidl("check", "wrong.aidl", "--json").out)
    assert document["ok"] is False
    assert document["solved"] is False
    assert document["fixed"] == []
    found = document["diagnostics"][0]
    assert (found["file"], found["line"], found["severity"]) == ("wrong.aidl", 2, "error")


def test_check_as_json_says_whether_it_solved(aidl: Aidl) -> None:
    def document(*arguments: str) -> dict[str, object]:
        return json.loads(aidl("check", "--json", *arguments).out)

    assert document("good.aidl") == {"ok": True, "solved": True, "fixed": [], "diagnostics": []}
    assert document("good.aidl", "--no-solve") == {**document("good.aidl"), "solved": False}
    failed = document("good.aidl", "unsolvable.aidl")
    assert (failed["ok"], failed["solved"], len(failed["diagnostics"])) == (False, False, 1)


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


def test_check_fix_tells_what_solving_finds_in_what_it_mended(aidl: Aidl) -> None:
    program = "solid a { b = circle(center: origin, raduis: 5); constrain { b.radius == 6; b.radius == 7 } }"
    result = aidl("check", "--fix", "-", stdin=program)
    assert (result.code, result.out) == (1, program.replace("raduis", "radius"))
    assert "error[E0601]" in result.err
    quick = aidl("check", "--fix", "--no-solve", "-", stdin=program)
    assert (quick.code, quick.out) == (0, result.out)
    assert quick.err.endswith("-: no mistakes found; nothing was solved\n")


def test_check_fix_says_why_a_fix_was_left(aidl: Aidl, folder: Path) -> None:
    program = "solid a { b = circle(center: origin, radius: 5); constrain { b.radius == 6; b.radius <= 4 } }"
    result = aidl("check", "--fix", "-", stdin=program)
    assert (result.code, result.out) == (1, program)
    assert (
        "-: not fixed: write `6`: it changes what you wrote, so the choice is yours\n-: 1 error\n"
        in result.err
    )
    assert "not fixed" not in aidl("check", "-", stdin=program).err
    (folder / "two.aidl").write_text(program)
    (found,) = json.loads(aidl("check", "--fix", "--json", "two.aidl").out)["diagnostics"]
    assert (found["fix"]["title"], found["not_fixed"]) == (
        "write `6`",
        "it changes what you wrote, so the choice is yours",
    )
    (found,) = json.loads(aidl("check", "--json", "two.aidl").out)["diagnostics"]
    assert "not_fixed" not in found


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
    unknown = aidl("doc", "an_elephant")
    assert (unknown.code, unknown.out) == (2, "")
    assert unknown.err.startswith("error[E0912]: there is no `an_elephant` to tell about\n")
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
    assert "E0912" in aidl("doc", "kerf", "--picture", "-").err


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
    assert "E0912" in aidl("doc", "--picture", "all.svg").err
    assert "E0904" in aidl("doc", "ring", "--picture", "absent/ring.svg").err


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
    unknown = aidl("explain", "W0901")
    assert unknown.code == 2
    assert "did you mean E0901?" in unknown.err
    nonsense = aidl("explain", "nonsense")
    assert nonsense.code == 2
    assert nonsense.err.startswith("error[E0907]: there is no code `nonsense`\n")


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
