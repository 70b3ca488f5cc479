"""What an editor offers to do, carried out on the text and looked at in what the text draws then."""

from __future__ import annotations

import pytest

from aidl_lang import pipeline
from aidl_server.ide.actions import Action, actions
from aidl_server.ide.references import CannotError
from aidl_server.ide.workspace import View, applied, look, run
from server.tests.ide.conftest import cursor, opened, seen, solved_at
from tests.amount import TRIES_ALL
from tests.documents import ROOT


def offered(marked: str) -> tuple[View, list[Action]]:
    text, offset = cursor(marked)
    view = seen(text, solved=True)
    return view, actions(view, offset, offset)


def done(marked: str, title: str) -> str:
    """The text after the one action whose title begins so."""
    view, found = offered(marked)
    (action,) = [a for a in found if a.title.startswith(title)]
    return applied(view.source.text, action.make())


def compiled(text: str) -> pipeline.Compiled:
    outcome = seen(text, solved=True).outcome
    assert outcome is not None
    return outcome


# --- Fixes -----------------------------------------------------------------------------------------


def test_a_fix_is_offered_where_its_mistake_is() -> None:
    marked = "solid a {\n    c = circle(center: origin, radius: 4)\n    constrain c.radus¦ == 5\n}\n"
    view, found = offered(marked)
    fix = next(a for a in found if a.kind == "quickfix")
    assert fix.mends is not None
    assert fix.mends.fix is not None
    assert applied(view.source.text, fix.make()) == view.source.text.replace("radus", "radius")
    elsewhere = actions(view, 0, 0)
    assert [a.title for a in elsewhere if a.kind == "quickfix"] == []
    assert [a.title for a in elsewhere if a.kind == "source.fixAll"] == ["Apply all fixes"]


def test_each_constraint_of_a_conflict_can_give_way() -> None:
    marked = """\
solid a {
    c = circle(center: origin, radius: 4)
    constrain {
        c.radius == 5
        c.radius ¦== 6
    }
}
"""
    view, found = offered(marked)
    texts = [applied(view.source.text, a.make()) for a in found if a.kind == "quickfix"]
    assert len(texts) >= 2
    for text in texts:
        assert compiled(text).status == "solved"


# --- Naming a number --------------------------------------------------------------------------------

DISK = """\
solid disk {
    rim = circle(center: origin, radius: 16)
    constrain rim.radius >= 3
}
"""


def test_a_number_becomes_a_param_with_a_range() -> None:
    text = done(DISK.replace("16", "1¦6"), "Name this number")
    assert (
        text
        == """\
solid disk {
    param rim_radius = 16 in 8..32

    rim = circle(center: origin, radius: rim_radius)
    constrain rim.radius >= 3
}
"""
    )
    outcome = compiled(text)
    assert outcome.ok
    assert [(k.path, k.value) for k in outcome.knobs] == [("rim_radius", 16)]
    assert outcome.export(".svg") == compiled(DISK).export(".svg")


def test_it_stands_with_the_other_params_and_has_a_name_of_its_own() -> None:
    before = DISK.replace("rim = ", "param rim_radius = 2in\n    let k = 3\n    rim = ")
    text = done(before.replace("radius: 16", "radius: 1.5¦in"), "Name this number")
    assert "    param rim_radius = 2in\n    param rim_radius_2 = 1.5in in 0.75in..3in\n    let k" in text
    assert compiled(text).ok


def test_a_number_in_a_template_is_named_for_the_file() -> None:
    before = (
        "/// A peg.\nsolid peg() { rim = circle(center: origin, radius: 4¦) }\nassembly a { p = peg() }\n"
    )
    text = done(before, "Name this number")
    assert text.startswith("param rim_radius = 4 in 2..8\n\n/// A peg.\nsolid peg() {")
    assert compiled(text).ok


def test_a_number_that_must_give_way_cannot_become_exact() -> None:
    marked = DISK.replace("radius: 16", "radius: 1¦6").replace(">= 3", "== 17")
    _, found = offered(marked)
    (action,) = [a for a in found if a.title.startswith("Name")]
    with pytest.raises(CannotError, match="exact"):
        action.make()


# --- Templates --------------------------------------------------------------------------------------

TOWER = """\
let thick = 3
/// A tower.
assembly tower {
    param width = 40
    for i in 0..2 {
        @color("red")
        solid floor[i] {
            body = rectangle(center: fixed((0, 12 * i)), width: width, height: thick)
            hole door { rim = circle(center: fixed((i, 12 * i)), radius: 1) }
        }
    }
    @thickness(2)
    solid roof {
        cone = triangle((-20, 30), (20, 30), (0, 50))
    } // on top
}
"""


def test_a_structure_of_a_loop_becomes_a_template_with_what_it_uses() -> None:
    marked = TOWER.replace("solid floor", "solid fl¦oor")
    text = done(marked, "Extract `floor`")
    assert "solid floor_solid(i, width) {\n    body = rectangle" in text
    assert '        @color("red")\n        floor[i] = floor_solid(i: i, width: width)\n' in text
    assert text.index("floor_solid(i, width)") < text.index("/// A tower.")
    assert compiled(text).export(".svg") == compiled(TOWER).export(".svg")


def test_what_needs_a_function_from_around_it_is_left() -> None:
    text = TOWER.replace("    for i in", "    fn up(n) = 12 * n\n    for i in").replace(
        "(0, 12 * i)", "(0, up(i))"
    )
    _, found = offered(text.replace("solid floor", "solid fl¦oor"))
    (action,) = [a for a in found if a.title.startswith("Extract")]
    with pytest.raises(CannotError, match="`floor` uses `up`"):
        action.make()


# --- The missing constraint --------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["handset", "wrench"] if TRIES_ALL else ["handset"])
def test_what_is_said_to_be_missing_takes_a_freedom_away(name: str) -> None:
    text = (ROOT / "examples" / f"{name}.aidl").read_text("utf-8")
    project = opened({"part.aidl": text})
    first = next(iter(project.workspace.open))
    view = run(look(first, text, project.workspace.world(first)))
    outcome = view.outcome
    assert outcome is not None
    assert outcome.model is not None
    end = view.module.statements[-1].span.end - 1
    tried = 0
    for action in actions(view, end, end):
        if not action.title.startswith("Add the missing") or (tried == 3 and not TRIES_ALL):
            continue
        try:
            changed = compiled(applied(text, action.make()))
        except CannotError:
            continue
        tried += 1
        assert changed.ok
        assert changed.model is not None
        assert (changed.model.degrees or 0) < (outcome.model.degrees or 0)
    assert tried >= 3


def test_what_is_in_line_is_kept_in_line() -> None:
    marked = """\
assembly a {
    plate = rectangle(center: fixed((0, 0)), width: 40, height: 20)
    solid knob { body = circle(center: (0, 30), radius: 4) }
    constrain {
        knob.center.y >= plate.top.start.y¦
    }
}
"""
    view, found = offered(marked)
    titles = [a.title for a in found if a.title.startswith("Add")]
    assert "Add the missing constraint: `knob.center.x == plate.center.x`" in titles
    for action in found:
        if action.title.startswith("Add"):
            text = applied(view.source.text, action.make())
            assert "        knob.center.y >= plate.top.start.y\n        " in text
            assert compiled(text).ok


# --- Anywhere ---------------------------------------------------------------------------------------


def test_every_place_of_the_examples_is_answered(example: View) -> None:
    view = solved_at(example.path)
    for at in range(0, len(view.source.text) + 1, 7 if TRIES_ALL else 61):
        for action in actions(view, at, min(at + 3, len(view.source.text))):
            assert action.title
            assert action.kind in ("quickfix", "refactor.extract", "refactor.rewrite", "source.fixAll")


def test_solved_values_are_written_here_and_everywhere() -> None:
    marked = """\
drawing a {
    left = circle(center: (1, 31), radius: 4)
    right = circle(center: (2, 3¦0), radius: 4)
    constrain { left.center == (0, 30), right.center == (0, -30) }
}
"""
    view, found = offered(marked)
    title = "Write solved values back as first guesses"
    offers = {a.title: a for a in found if a.kind == "refactor.rewrite"}
    assert list(offers) == [f"{title}: `a`", title]
    text = applied(view.source.text, offers[title].make())
    assert "left = circle(center: (0, 30), radius: 4)" in text
    assert "right = circle(center: (0, -30), radius: 4)" in text
    assert compiled(text).export(".svg") == compiled(view.source.text).export(".svg")
    line = view.source.text.index("(1, 31)")
    selected = [a for a in actions(view, line, line + 7) if a.title == f"{title}: selection"]
    text = applied(view.source.text, selected[0].make())
    assert "left = circle(center: (0, 30), radius: 4)" in text
    assert "right = circle(center: (2, 30), radius: 4)" in text


# --- Notes and warnings that are allowed ---


def _allowed(text: str, mark: str, code: str) -> str:
    """The text once a code is allowed at a mark."""
    start = text.index(mark)
    changed = done(f"{text[:start]}¦{text[start:]}", f"Allow {code} here")
    assert code in [d.code for d in compiled(text).diagnostics]
    assert code not in [d.code for d in compiled(changed).diagnostics]
    return changed


def test_a_note_is_allowed_before_its_statement() -> None:
    head = "solid s {\n    b = rectangle(width: 60, height: 40)\n    constrain b.center == origin\n    "
    told = "constrain b.left + b.right == 0\n}\n"
    assert _allowed(head + told, "b.left", "N0602") == f'{head}@allow("N0602")\n    {told}'


def test_another_code_is_allowed_where_one_is() -> None:
    text = 'solid s {\n    @allow("W0201") param k = 0\n    dot = circle(radius: 0)\n}\n'
    text = text.replace("dot", '@allow("N0505") dot')
    assert '@allow("N0505", "W0706") dot' in _allowed(text, "circle", "W0706")
