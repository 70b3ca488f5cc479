"""Ways of solving compared: what each moves, on programs small enough to foresee."""

from __future__ import annotations

import json
from dataclasses import replace

from aidl_eval import ablation
from aidl_eval.ablation import WAYS, Solved, compare
from aidl_lang.common.source import SourceFile
from eval.tests.conftest import Evaluation

LIFTED = """
assembly stack {
    assembly low { solid foot { plate = rectangle(center: (0, 0), width: 40, height: 10) } }
    assembly high {
        solid lid { plate = rectangle(center: (3, 30), width: 40, height: 10) }
        solid knob { ball = circle(center: (3, 40), radius: 5) }
        constrain knob.bottom == lid.top
    }
    constrain { high.lid.bottom == low.foot.top high.lid.center_x == low.foot.center_x }
}
"""
KIT = """
assembly kit {
    solid post { bar = rectangle(center: (0, 0), width: 10, height: 40) }
    solid slid { plate = rectangle(center: (30, 3), width: 12, height: 8) }
    solid turned {
        plate = rectangle(center: (60, 0), width: 20, height: 6)
        hole eye { rim = circle(center: (66, 0), radius: 2) }
    }
    solid widened { plate = rectangle(center: (100, 0), width: guess(14), height: 8) }
    constrain {
        slid.left == post.right + 5
        turned.rotation == 30
        turned.plate.center == (70, 20)
        widened.width == 20
    }
}
"""


def solves(program: str) -> dict[str, Solved]:
    return {solved.way: solved for solved in compare(SourceFile("stack.aidl", program))}


def test_ways_move_parts_as_wholes_where_all_at_once_moves_what_is_in_them() -> None:
    found = solves(LIFTED)
    assert list(found) == list(WAYS)
    assert {solved.status for solved in found.values()} == {"solved"}
    assert found["full"].disturbed == found["paper"].disturbed == 0
    assert found["flat"].disturbed > 0
    assert {(s.parts, s.sizes) for s in found.values()} == {(3, 0)}


def test_a_part_moved_and_turned_as_a_whole_is_as_it_was() -> None:
    found = solves(KIT)
    assert {solved.status for solved in found.values()} == {"solved"}
    assert {solved.parts for solved in found.values()} == {5}
    assert (found["full"].disturbed, found["flat"].disturbed) == (1, 2)


def test_an_empty_structure_is_disturbed_by_its_size_alone() -> None:
    plan = "assembly a {{ solid b {{ }} solid c {{ }} constrain {{ c.left == b.right + 20 {} }} }}"
    assert solves(plan.format(""))["full"].disturbed == 0
    wider = solves(plan.format("c.width == 30"))["full"]
    assert (wider.parts, wider.disturbed) == (2, 1)


def test_what_holds_already_is_left_alone_by_all() -> None:
    found = solves("solid a { c = circle(center: (3, 4), radius: 5) constrain c.radius == 5 }")
    assert {(s.status, s.disturbed, s.drift) for s in found.values()} == {("solved", 0, 0.0)}


def test_what_cannot_hold_is_solved_by_none() -> None:
    found = solves("solid a { c = circle(radius: 5) constrain { c.radius == 5 c.radius == 6 } }")
    assert "solved" not in {solved.status for solved in found.values()}


# --- Tables -------------------------------------------------------------------------------------------


def solved(way: str, program: str, thing: str, **figures: object) -> Solved:
    known: dict[str, object] = {"status": "solved", "seconds": 0.01, "parts": 10, "drift": 1.0}
    return Solved(program, thing, way, **(known | figures))  # type: ignore[arg-type]


def table(drifts: dict[str, float], **figures: object) -> list[Solved]:
    """Solves of programs, of which `flat` has the drifts given and the others 1."""
    return [
        solved(way, program, program[0], **({"drift": drift, **figures} if way == "flat" else {}))
        for program, drift in drifts.items()
        for way in WAYS
    ]


def lines(solves: list[Solved], way: str) -> list[list[str]]:
    text = ablation.markdown(solves)
    cells = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("|")]
    return [line for line in cells if way in line]


def test_means_are_over_programs_and_differences_over_things() -> None:
    # The differences of the things a, b, c are 3, 1 and 2, the mean of a counting once.
    found = table({"a1": 2.0, "a2": 6.0, "b": 2.0, "c": 3.0})
    (means,) = [line for line in lines(found, "flat") if line[0] == "flat"]
    assert means[1] == "100 % [100–100] (4/4)"
    assert means[4].startswith("3.25 ± 1.89 [2.00–")  # 13 / 4
    ((_, _, difference, things, p, adjusted),) = lines(found, "flat − full")
    assert difference == "+2.00 [1.00–3.00]"
    assert (things, p, adjusted) == ("3", "0.250", "1.000")  # 2 of 8 exchanges; of five ways the least


def test_what_one_way_does_not_solve_is_in_no_mean() -> None:
    found = table({"a": 2.0, "b": 4.0})
    found = [replace(s, status="failed") if (s.way, s.program) == ("paper", "b") else s for s in found]
    rows = {line[0]: line for line in lines(found, "flat") + lines(found, "paper") if len(line) == 6}
    assert rows["paper"][1] == "50 % [0–100] (1/2)"
    assert rows["flat"][1] == "100 % [100–100] (2/2)"
    assert rows["flat"][4] == "2.00 (1)"
    assert "All but `solved` are over the 1 programs of 2" in ablation.markdown(found)


def test_a_wrong_program_is_told_apart() -> None:
    (wrong,) = compare(SourceFile("a.aidl", "solid a { b = }"))
    assert wrong.status == "wrong"
    text = ablation.markdown([wrong, *compare(SourceFile("b.aidl", LIFTED))])
    assert "| a.aidl | full | wrong |" in text
    assert "over the 1 programs of 1 that every way solves; they draw 1 things." in text


def test_the_command_prints_the_tables(evaluation: Evaluation) -> None:
    file = evaluation.folder / "stack.aidl"
    file.write_text(LIFTED)
    done = evaluation.called("eval", "--solver", file.name)
    assert done.code == 0
    assert done.out.count("| stack.aidl | ") == len(WAYS)
    assert evaluation.called("eval", "--solver", "no.aidl").code == 2


def test_the_command_takes_the_programs_of_a_recording(evaluation: Evaluation) -> None:
    replies = [f"```aidl\n{program}```\n" for program in ("solid a { b = }\n", LIFTED, KIT)]
    shared = {"aidl_recording": 1, "prompt": "stack", "run": 1}
    conversations = [
        {**shared, "variant": "full", "replies": [*replies, "I am at a loss."]},
        {**shared, "variant": "openscad", "replies": ["```openscad\nsquare(1);\n```\n"]},
    ]
    file = evaluation.folder / "said.jsonl"
    file.write_text("\n".join(map(json.dumps, conversations)))
    done = evaluation.called("eval", "--solver", file.name)
    assert done.code == 1  # as one of them is wrong
    assert "| stack/full/1, reply 1 | full | wrong |" in done.out
    assert done.out.count("| stack/full/1, reply 3 | ") == len(WAYS)
    assert "over the 2 programs of 2 that every way solves; they draw 1 things." in done.out
    assert "openscad" not in done.out
    file.write_text(json.dumps(conversations[1]))
    without = evaluation.called("eval", "--solver", file.name)
    assert without.code == 2
    assert "error[E0994]: `said.jsonl` holds no program in AIDL" in without.err
    file.write_text("{}")
    assert evaluation.called("eval", "--solver", file.name).code == 2
