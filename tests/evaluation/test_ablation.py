"""The solver's stages compared: what each way moves, on programs small enough to foresee."""

from __future__ import annotations

from aidl_lang.common.source import SourceFile
from aidl_lang.tools.evaluation.ablation import Solved, compare, markdown
from tests.evaluation.conftest import Evaluation

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


def solves(program: str) -> dict[str, Solved]:
    return {solved.stages.value: solved for solved in compare(SourceFile("stack.aidl", program))}


def test_stages_move_parts_as_wholes_where_all_at_once_bends_them() -> None:
    found = solves(LIFTED)
    assert list(found) == ["full", "paper", "level", "flat"]
    assert {solved.status for solved in found.values()} == {"solved"}
    assert found["full"].disturbed == found["paper"].disturbed == 0
    assert found["full"].sizes == found["paper"].sizes == 0
    assert found["flat"].disturbed > 0


def test_what_holds_already_is_left_alone_by_all() -> None:
    found = solves("solid a { c = circle(center: (3, 4), radius: 5) constrain c.radius == 5 }")
    assert [(s.status, s.disturbed, s.drift) for s in found.values()] == [("solved", 0, 0.0)] * 4


def test_what_cannot_hold_is_solved_by_none() -> None:
    found = solves("solid a { c = circle(radius: 5) constrain { c.radius == 5 c.radius == 6 } }")
    assert "solved" not in {solved.status for solved in found.values()}


def test_a_wrong_program_is_told_apart() -> None:
    (wrong,) = compare(SourceFile("a.aidl", "solid a { b = }"))
    assert wrong.status == "wrong"
    lines = markdown([wrong, *compare(SourceFile("b.aidl", LIFTED))]).splitlines()
    assert lines[2] == "| a.aidl | | wrong | | | | |"
    assert "All but `solved` are over the 1 programs of 1 that every way solves." in lines


def test_the_command_prints_both_tables(evaluation: Evaluation) -> None:
    file = evaluation.folder / "stack.aidl"
    file.write_text(LIFTED)
    done = evaluation.called("eval", "--solver", file.name)
    assert done.code == 0
    assert done.out.count("| stack.aidl | ") == 4
    assert "| full | 1 of 1 | " in done.out
    assert not evaluation.out.exists()
    assert evaluation.called("eval", "--solver", "no.aidl").code == 2
