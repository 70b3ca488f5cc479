"""What a conversation loses is noticed, named and put back; what is only said in another way is no loss."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.llm.intent import Kind, Ledger, request
from tests.amount import tries

EXAMPLES = Path(__file__).parents[3] / "examples"

CLOCK = """assembly clock {
    param size = 60mm in 40..100
    solid face { disc = circle(center: origin, radius: size) }
    @detached
    solid hand rotated 15deg {
        blade = rectangle(center: (0, 20), width: 4, height: 40)
    }
    solid foot {
        block = rectangle(center: (3, -70), width: 50, height: guess(18), angle: 10deg)
    }
    constrain {
        foot.below(face, gap: 0)
        foot.centered_horizontally(face)
        hand.bottom == face.center_y
        foot.block.height == 20
    }
    assert foot.top <= face.bottom
}
"""


@cache
def compiled(text: str) -> pipeline.Compiled:
    return pipeline.compile(SourceFile("clock.aidl", text))


def told(*programs: str) -> Ledger:
    """A conversation of these programs."""
    ledger = Ledger()
    for text in programs:
        ledger.note(SourceFile("clock.aidl", text), compiled(text))
    return ledger


def phrases(*programs: str) -> list[str]:
    return [loss.phrase for loss in told(*programs).missing]


def changed(*pairs: tuple[str, str], text: str = CLOCK) -> str:
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text


def restored(text: str, *before: str) -> str:
    ledger = told(*before, text)
    return ledger.restore(SourceFile("clock.aidl", text))[0]


HAND = """    @detached
    solid hand rotated 15deg {
        blade = rectangle(center: (0, 20), width: 4, height: 40)
    }
"""
BELOW, MIDDLE = "foot.below(face, gap: 0)", "foot.centered_horizontally(face)"


SAME = {
    "synonyms": changed((BELOW, "under(foot, face, gap: 0mm)"), (MIDDLE, "center_horizontally(foot, face)")),
    "sides": changed(("hand.bottom == face.center_y", "face.center_y == hand.bottom")),
    "order": changed((f"        {BELOW}\n        {MIDDLE}\n", f"        {MIDDLE}\n        {BELOW}\n")),
    "block": changed((f"        {BELOW}\n", ""), ("    assert", f"    constrain {BELOW}\n    assert")),
    "renamed": changed(("foot", "stand")),
    "all renamed": changed(("foot", "stand"), ("block", "slab")),
    "root": changed(("clock", "timepiece")),
    "numbers": changed(("15deg", "20deg"), ("height == 20", "height == 22"), ("60mm", "70mm")),
    "rewritten": changed((BELOW, "foot.top == face.bottom")),
    "joined": changed((BELOW, "foot.below(face, gap: 0) and foot.block.width <= 60")),
    "moved": changed(
        ("    solid foot {\n        block", "    solid base { solid foot {\n        block"),
        ("10deg)\n    }", "10deg)\n    } }"),
        ("foot.", "base.foot."),
    ),
    "format": " ".join(CLOCK.split()),
}


@pytest.mark.parametrize("after", SAME.values(), ids=SAME)
def test_the_same_in_other_words_is_no_loss(after: str) -> None:
    assert compiled(after).status == "solved"
    assert phrases(CLOCK, after) == []


BACK = ": it fits as it was; put it back"
CENTERED = "`foot.centered_horizontally(face)` (in `clock`)"
LOST = {
    "constraint": (changed((f"        {MIDDLE}\n", "")), f"{CENTERED} is gone{BACK}"),
    "rotation": (
        changed((" rotated 15deg", "")),
        f"the rotation `rotated 15deg` of `clock.hand` is gone{BACK}",
    ),
    "level": (
        changed((" rotated 15deg", " rotated 0deg")),
        f"the rotation `rotated 15deg` of `clock.hand` is gone{BACK}",
    ),
    "angle": (
        changed((", angle: 10deg", "")),
        f"the rotation `angle: 10deg` of `clock.foot.block` is gone{BACK}",
    ),
    "wish": (changed((MIDDLE, f"prefer {MIDDLE} weight 2")), f"{CENTERED} became a wish{BACK}"),
    "assert only": (
        changed((f"        {MIDDLE}\n", ""), ("    assert", f"    assert {MIDDLE}\n    assert")),
        f"{CENTERED} is only checked now, by an `assert`{BACK}",
    ),
    "assert": (
        changed(("    assert foot.top <= face.bottom\n", "")),
        f"`assert foot.top <= face.bottom` (in `clock`) is gone{BACK}",
    ),
    "structure": (
        changed((HAND, ""), ("        hand.bottom == face.center_y\n", "")),
        "structure `clock.hand` (solid, 1 geometry) is gone, and with it `hand.bottom == face.center_y`"
        + BACK,
    ),
    "says less": (
        changed((BELOW, "foot.width <= face.width")),
        "`foot.below(face, gap: 0)` (in `clock`) was replaced by `foot.width <= face.width`, which says less"
        + BACK,
    ),
    "param": (
        changed(("    param size = 60mm in 40..100\n", ""), ("radius: size", "radius: 60")),
        "`param size = 60mm in 40..100` (in `clock`) is gone: what it set is written as numbers now, or"
        " not at all; use it there again",
    ),
    "all": ("", "structure `clock` (assembly, 3 structures, 3 geometries, 4 constraints) is gone"),
}


@pytest.mark.parametrize(("after", "phrase"), LOST.values(), ids=LOST)
def test_a_loss_is_named(after: str, phrase: str) -> None:
    assert phrases(CLOCK, after) == [phrase]


def test_a_constraint_comes_back_under_new_names() -> None:
    after = changed((f"        {MIDDLE}\n", ""), ("foot", "stand"))
    assert "stand.centered_horizontally(face)" in restored(after, CLOCK)


LID = """drawing tin {
    box = rectangle(center: fixed((0, 0)), width: fixed(60), height: 30)
    lid = rectangle(center: (3, 25), width: 40, height: 6)
    constrain {
        lid.left == box.left
        lid.right == box.right
        lid.width == 40
        lid.bottom == box.top
    }
}
"""


def test_what_was_deleted_to_silence_an_error_is_missed() -> None:
    silenced = changed(("        lid.right == box.right\n", ""), text=LID)
    assert compiled(LID).status != "solved"
    assert compiled(silenced).status == "solved"
    ledger = told(LID, silenced)
    (loss,) = ledger.missing
    assert (loss.kind, loss.item.home, loss.item.text) == (
        Kind.CONSTRAINT,
        ("tin",),
        "lid.right == box.right",
    )
    assert loss.phrase == (
        "`lid.right == box.right` (in `tin`) is gone: as it was it conflicts with `lid.left == box.left` and"
        " `lid.width == 40`; say it in another way, or mend one of those"
    )
    assert loss.phrase in request(ledger.missing)
    assert ledger.restore(SourceFile("clock.aidl", silenced))[0] == silenced
    mended = changed(("        lid.width == 40\n", "        lid.width == 60\n"), text=LID)
    assert phrases(LID, silenced, mended) == []


def test_a_wrong_statement_may_be_replaced() -> None:
    wrong = changed((" rotated 15deg", ""), (BELOW, f"{BELOW}\n        turn_by(hand, 15deg)"))
    assert phrases(wrong, CLOCK) == []
    assert phrases(wrong, changed((" rotated 15deg", ""))) == [
        "`turn_by(hand, 15deg)` (in `clock`) is gone: it was written wrongly; say it in a way that is right"
    ]


@pytest.mark.parametrize(
    ("now", "missing"),
    [
        (" rotated 20deg {", 0),
        (" { block = rectangle(width: 50, height: 18, angle: 20deg) }", 0),
        (" { block = rectangle(width: 50, height: 18) }", 1),
    ],
)
def test_a_turn_in_wrong_words_may_be_one_of_what_is_inside(now: str, missing: int) -> None:
    plain = (
        "assembly a { solid foot { block = rectangle(width: 50, height: 18) } constrain orient(foot, 20) }"
    )
    other = plain.partition(" constrain")[0].replace(" {", now, 2).replace(now, " {", 1) + " }"
    mended = {" rotated 20deg {": other}.get(now, f"assembly a {{ solid foot{now} }}")
    assert len(told(plain, mended).missing) == missing


POT = """assembly t {
    solid pot { belly = circle(center: origin, radius: 50) }
    solid handle { loop = ring(center: (60, 0), outer_radius: 28, inner_radius: 20) }
    solid lid { top = rectangle(center: (0, 60), width: 40, height: 10) }
    constrain {
        handle.left == pot.right - 10
        handle.center_y == pot.center_y
        lid.above(pot)
    }
}
"""
LEFT, ABOVE = "handle.left == pot.right - 10", "lid.above(pot)"


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (LEFT, "handle.left >= pot.right - 10", "less: it fits as it was; put it back"),
        (LEFT, "pot.left_of(handle, at_least: -10)", "less: it fits as it was; put it back"),
        (ABOVE, "lid.width <= pot.width", "less: it fits as it was; put it back"),
        (
            ABOVE,
            "pot.above(lid)",
            "otherwise: as it was it conflicts with `pot.above(lid)`; say it in another way, or mend one of"
            " those",
        ),
    ],
)
def test_what_says_less_or_the_opposite_is_a_loss(old: str, new: str, says: str) -> None:
    after = changed((old, new), text=POT)
    assert compiled(after).status == "solved"
    assert phrases(POT, after) == [f"`{old}` (in `t`) was replaced by `{new}`, which says {says}"]


ON_TOP = changed((ABOVE, f"{ABOVE}\n        lid.bottom == pot.top - 4"), text=POT)


def test_an_equation_that_conflicted_may_be_changed_but_not_weakened() -> None:
    assert [d.code for d in compiled(ON_TOP).diagnostics] == ["E0601"]
    for words in ("lid.bottom == pot.top", "lid.above(pot, gap: 1)"):
        assert phrases(ON_TOP, changed(("lid.bottom == pot.top - 4", words), text=ON_TOP)) == []
    assert phrases(ON_TOP, changed(("== pot.top - 4", ">= pot.top - 4"), text=ON_TOP)) == [
        "`lid.bottom == pot.top - 4` (in `t`) was replaced by `lid.bottom >= pot.top - 4`, which says less:"
        " as it was it conflicts with `lid.above(pot)`; say it in another way, or mend one of those"
    ]


def test_all_that_went_with_a_structure_is_told() -> None:
    own = "lid.top.bottom == pot.belly.top - 4"
    clashing = changed((ABOVE, f"{ABOVE}\n        {own}\n        lid.center_x == pot.center_x"), text=POT)
    assert [d.code for d in compiled(clashing).diagnostics] == ["E0601"]
    lid = "    solid lid { top = rectangle(center: (0, 60), width: 40, height: 10) }\n"
    spoken = (ABOVE, own, "lid.center_x == pot.center_x")
    without = changed((lid, ""), *((f"        {each}\n", "") for each in spoken), text=clashing)
    assert phrases(clashing, without) == [
        f"structure `t.lid` (solid, 1 geometry) is gone, and with it `{ABOVE}`, `{own}` and"
        f" `lid.center_x == pot.center_x`: put it back, but say `{ABOVE}` and `{own}` in a way that holds"
    ]
    assert restored(without, clashing) == without  # by the rest alone it would touch nothing
    again = restored(without, clashing.replace("center: (0, 60)", "center: (0, 52)"))
    assert [each in again for each in ("solid lid", *spoken)] == [True, False, False, True]


DIAL = """solid dial {
    plate = circle(center: origin, radius: 28)
    for i in 0..9 {
        hole finger[i] { rim = circle(center: fixed(polar(19, 30deg * i)), radius: 4) }
    }
    constrain plate.radius == 28
}
"""


def dialled(*pairs: tuple[str, str]) -> str:
    return changed(*pairs, text=DIAL)


PINS = """drawing pins {
    param size = 2mm
    pin = [circle(center: (x, 0), radius: size) for x in [0, 10, 20]]
    nail = [circle(center: (0, 10), radius: size), circle(center: (9, 10), radius: size)]
}
"""


@pytest.mark.parametrize(
    ("before", "after", "thing", "counts"),
    [
        (DIAL, dialled(("0..9", "0..3")), "dial.finger", (10, 4)),
        (PINS, changed(("[0, 10, 20]", "[0, 10]"), text=PINS), "pins.pin", (3, 2)),
        (PINS, changed((", circle(center: (9, 10), radius: size)", ""), text=PINS), "pins.nail", (2, 1)),
    ],
)
def test_fewer_of_the_same_are_told(before: str, after: str, thing: str, counts: tuple[int, int]) -> None:
    many, few = counts
    ledger = told(before, after, after)
    (loss,) = ledger.missing
    assert loss.phrase == f"{many} `{thing}` became {few}: unless fewer are meant, make as many again"
    assert loss.is_doubtful
    assert ledger.restore(SourceFile("clock.aidl", after))[0] == after
    assert phrases(before, after, before) == []


def test_a_param_may_make_fewer() -> None:
    for n in ("n", "m"):
        knob = ("solid dial {", "solid dial {\n    param n = 10\n    let m = n * 1")
        before = dialled(knob, ("0..9", f"0..({n} - 1)"))
        assert compiled(before).status == "solved"
        assert phrases(before, changed(("param n = 10", "param n = 4"), text=before)) == []


WHOLE = [CLOCK, POT, *((EXAMPLES / f"{name}.aidl").read_text() for name in ("bottle_opener", "toy_sword"))]


def deleted() -> list[tuple[str, str, str]]:
    """Programs with one constraint each left out, of those that have it on a line of its own."""
    found = []
    for text in WHOLE:
        lines, inside = text.splitlines(keepends=True), False
        for number, line in enumerate(lines):
            inside = inside and line.strip() != "}"
            if inside and line.count("(") == line.count(")"):
                found.append((text, "".join([*lines[:number], *lines[number + 1 :]]), line))
            inside = inside or line.strip() == "constrain {"
    return found


@tries(12)
@given(st.sampled_from(deleted()))
def test_any_constraint_deleted_is_named_and_put_back(chosen: tuple[str, str, str]) -> None:
    text, after, line = chosen
    (loss,) = told(text, after).missing
    assert loss.item.text == " ".join(line.split("//")[0].split())
    assert phrases(text, restored(after, text)) == []


@tries(10)
@given(
    st.sampled_from(WHOLE),
    st.text(st.characters(codec="utf-8"), max_size=5),
    st.floats(0, 1),
    st.floats(0, 1),
)
def test_any_text_may_follow(text: str, junk: str, first: float, second: float) -> None:
    a, b = sorted(int(share * len(text)) for share in (first, second))
    ledger = told(text, text[:a] + junk + text[b:])
    assert all(loss.phrase for loss in ledger.missing)
