"""Completion: what is offered at a place, and that what is offered is understood there."""

from __future__ import annotations

import random
import re
from itertools import product
from pathlib import Path

import pytest

from aidl_dev.reference.coverage import KINDS
from aidl_lang.common.diagnostics import has_errors
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax.tables import tokenize
from aidl_lang.tools.vocabulary import vocabulary
from aidl_server.ide.completion import MOST, Completion, complete
from aidl_server.ide.completion.names import forms
from aidl_server.ide.workspace import Workspace, applied, look
from server.tests.ide.conftest import cursor, seen
from tests.amount import TRIES_ALL, some
from tests.compiled import FEW

THINGS = """\
import "parts.aidl" as parts
solid plate {
    /// How wide it is.
    param width = 60mm in 40..90
    let half = width / 2
    body = rectangle(center: origin, width: width, height: 20)
    rim = circle(radius: 3)
    first = line((0, 0), (30, 4))
    second = line((0, 5), (30, 9))
    hole bore at (3, 0) { edge = circle(radius: 2) }
    for i in 0..2 { hole peg[i] { edge = circle(center: (5 * i, 0), radius: 1) } }
    %s
    late = circle(center: (20, 0), radius: 4)
}
"""
PARTS = """\
/// A rivet of a size.
hole rivet(size = 4, head = 8) { edge = circle(radius: size / 2) }
fn twice(x) = 2 * x
param play = 0.2
"""


def offered(marked: str, template: str = THINGS) -> list[Completion]:
    text, offset = cursor(template.replace("%s", marked))
    view = seen(text, parts=PARTS)
    folder = Path("/project")
    return complete(view, offset, lambda: [folder / "part.aidl", folder / "parts.aidl"])


def labels(marked: str, template: str = THINGS) -> list[str]:
    return [c.label for c in offered(marked, template)]


def one(marked: str, label: str) -> Completion:
    return next(c for c in offered(marked) if c.label == label)


def errors(text: str) -> int:
    return sum(d.is_error for d in parse(SourceFile("x.aidl", text)).diagnostics)


def put(text: str, completion: Completion) -> str:
    return text[: completion.span.start] + completion.plain + text[completion.span.end :]


# --- Members ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("marked", "has", "has_not"),
    [
        ("x = rim.¦", {"center", "radius", "diameter", "bb", "left"}, {"above", "start", "rim"}),
        ("x = first.¦", {"start", "end", "midpoint", "length", "angle"}, {"radius"}),
        ("x = first.start.¦", {"x", "y"}, {"start"}),
        ("constrain body.¦", {"top_left", "edges", "width", "height", "above", "centered_in"}, {"first"}),
        ("constrain { bore.¦ }", {"edge", "width", "center_x", "origin", "inside"}, {"radius"}),
        ("constrain { bore.edge.¦ == 3 }", {"radius", "center"}, {"edge"}),
        ("constrain { peg[1].¦\n rim.radius == 3 }", {"edge", "width"}, {"peg"}),
        ("constrain { peg.¦ }", {"edge", "left", "width"}, {"peg"}),
        ("x = parts.¦", {"rivet", "twice", "play"}, {"circle", "width"}),
        ("x = polar_array(rim, n: 3, radius: 9).¦", {"center", "radius"}, {"above"}),
        ("x = 3.¦", set(), {"mm", "x", "center"}),
    ],
)
def test_members(marked: str, has: set[str], has_not: set[str]) -> None:
    found = set(labels(marked))
    assert has <= found
    assert not has_not & found


@pytest.mark.parametrize("thing", ["rim", "first", "body", "first.start", "body.top", "rim.bb"])
def test_every_member_is_there(thing: str) -> None:
    text, offset = cursor(THINGS.replace("%s", f"let x = {thing}.¦"))
    fields = [c for c in complete(seen(text, parts=PARTS), offset) if c.kind != "method"]
    assert fields
    lets = "\n".join(f"let x{n} = {thing}.{c.plain}" for n, c in enumerate(fields))
    found = seen(THINGS.replace("%s", lets), parts=PARTS).found
    assert "E0202" not in {d.code for d in found}, [d.message for d in found]


def test_indices_are_those_that_were_drawn() -> None:
    text, offset = cursor(THINGS.replace("%s", "assert peg[¦2].width > 0"))
    view = seen(text, solved=True, parts=PARTS)
    assert view.outcome is not None
    assert [c.label for c in complete(view, offset) if c.kind == "word"] == ["0", "1", "2", "-1"]


# --- Names -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("marked", "has", "has_not"),
    [
        ("x = circle(radius: ¦)", {"width", "half", "first"}, {"late", "bore", "self", "x"}),
        ("constrain { ¦ }", {"late", "bore", "peg", "rim", "self"}, {"edge", "solid"}),
        ("assert ¦", {"late", "bore", "area", "clearance"}, {"circle"}),
        ("param more = ¦", {"width", "pi"}, {"rim", "late"}),
        ("x = mirror(¦, about: y_axis)", {"rim", "bore"}, {"late"}),
        ("hole inner { edge = mirror(¦, about: y_axis) }", {"rim", "bore"}, {"late"}),
        ("hole inner { edge = circle(center: ¦) }", {"origin", "width"}, {"rim", "body", "plate"}),
        ("hole inner { edge = circle(radius: 1)\n constrain { ¦ } }", {"edge", "inner"}, {"rim", "plate"}),
        ("for k in 0..2 { constrain { rim.radius == ¦ } }", {"k", "rim"}, set()),
    ],
)
def test_only_what_may_be_used_is_offered(marked: str, has: set[str], has_not: set[str]) -> None:
    found = set(labels(marked))
    assert has <= found
    assert not has_not & found


@pytest.mark.parametrize(
    "marked",
    [
        "x = circle(radius: ¦)",
        "x = circle(center: ¦)",
        "hole inner { edge = circle(center: ¦) }",
        "constrain { rim.radius == ¦ }",
        "hole inner { edge = circle(radius: 1)\n constrain { edge.radius == ¦ } }",
        "param more = ¦",
        "assert ¦ == 3",
    ],
)
def test_the_checker_lets_every_offered_name_be_read(marked: str) -> None:
    text, offset = cursor(THINGS.replace("%s", marked))
    kinds = ("param", "let", "var", "geometry", "structure", "loop variable", "parameter", "built-in name")
    names = [c for c in complete(seen(text, parts=PARTS), offset) if c.kind in kinds]
    assert names
    for completion in names:
        view = seen(put(text, completion), parts=PARTS)
        codes = {d.code for d in view.found} | {
            v.diagnostic({}).code for v in view.program.violations if completion.kind != "let"
        }
        assert not codes & {"E0201", "E0205", "E0401", "E0402", "E0501"}, completion.label


def test_what_fits_comes_first() -> None:
    assert labels("x = circle(center: ¦)")[0] == "origin"
    assert set(labels("x = circle(radius: ¦)")[:2]) == {"half", "width"}
    primitives = list(vocabulary().primitives)
    assert labels("x = ¦")[: len(primitives)] == primitives
    assert labels("p = path(from: (0, 0), ¦)").index("right") < 12


# --- Constraints -----------------------------------------------------------------------------------


def test_constraints_with_names_filled_in_compile() -> None:
    text, offset = cursor(THINGS.replace("%s", "constrain { ¦ }"))
    found = [c for c in complete(seen(text, parts=PARTS), offset) if c.kind == "constraint"]
    fitting = [c for c in found if "|" in c.text]
    assert len(fitting) > 40
    for completion in some(fitting):
        made = put(text, completion).replace("a, b, p, q", "rim, first, body, second")
        known = set(tokenize(SourceFile("x", completion.plain)).tokens)
        if {"p", "q", "box"} & {token.text for token in known}:
            continue  # of more things than two: what else it takes is to be filled in
        assert not has_errors(seen(made, parts=PARTS).found), completion.plain


def test_own_constraints() -> None:
    template = """\
constraint beside_it(a: circle, b: line, by: length) { a.center.x == b.start.x + by }
drawing d {
    c = circle(radius: 3)
    l = line((0, 0), (3, 4))
    constrain { %s }
}
"""
    found = offered("¦", template)
    assert found[0].label == "beside_it" or found[0].rank < 12
    mine = next(c for c in found if c.label == "beside_it")
    assert mine.text == "beside_it(${1:c}, ${2:l}, by: ${3:by})"


def test_what_fits_is_read_off_the_table_of_the_reference() -> None:
    (above,), (inside,) = forms()["above"], forms()["inside"]
    boxed = KINDS.keys() - {"number"}
    assert (above.text, above.pairs) == ("above(a, b)", set(product(boxed, repeat=2)))
    assert {("point", "line"), ("list", "list")} <= inside.pairs
    assert not {("point", "point"), ("line", "point"), ("point", "number")} & inside.pairs


# --- Arguments, words, units -----------------------------------------------------------------------


def test_named_arguments_that_are_still_open() -> None:
    found = [c.label for c in offered("x = arc(center: (0, 0), radius: 3, ¦)") if c.kind == "argument"]
    assert found[:2] == ["start_angle:", "end_angle:"]
    assert not {"center:", "radius:"} & set(found)
    assert one("x = rectangle(¦)", "rotatable:").text == "rotatable: ${1:false}"
    assert one("constrain body.above(rim, ¦)", "align:").text.startswith("align: ${1|left,center,right")
    assert "a:" not in labels("constrain above(¦)")


@pytest.mark.parametrize(
    ("marked", "first"),
    [
        ("x = circle(radius: 30¦)", "mm"),
        ("x = arc(center: (0, 0), radius: 3, start_angle: 0, end_angle: 90¦)", "deg"),
        ("x = arc(center: (0, 0), radius: 3, start_angle: 0, end_angle: 90d¦)", "deg"),
        ("solid part_ rotated 45¦ { todo }", "deg"),
        ("constrain rim.radius == 1.5e1¦", "mm"),
    ],
)
def test_units_that_fit(marked: str, first: str) -> None:
    found = offered(marked)
    assert found[0].label == first
    assert {c.kind for c in found} == {"unit"}
    text = cursor(THINGS.replace("%s", marked))[0]
    assert not has_errors(seen(put(text, found[0]), parts=PARTS).found)


@pytest.mark.parametrize(
    ("marked", "has"),
    [
        ("constrain above(rim, body, align: ¦)", {"left", "center", "right"}),
        ('constrain above(rim, body, align: "¦")', {"left", "center", "right"}),
        ("x = clearance_hole(¦)", {"m3", "m12"}),
        ('x = clearance_hole("m3", fit: "¦', {"close", "medium", "loose"}),
        ("x = offset(body, 3, corners: ¦)", {"sharp", "round"}),
        ("@¦", {"color", "thickness", "detached", "orientation"}),
        ('@color("¦") solid s { todo }', {"crimson", "teal"}),
        ('@color("¦', {"crimson"}),
        ("@orientation(¦) solid s { todo }", {"front", "side", "top"}),
        ('@material("¦") solid s { todo }', {"birch"}),
        ("fn f(x: ¦) = 3", {"length", "point", "box", "rectangle"}),
        ("param n = 3 ¦", {"in", "step"}),
        ("for i ¦", {"in"}),
        ("solid s ¦ { todo }", {"at", "rotated"}),
        ("x = bore.edge ¦", {"if"}),
        ("if width > 3 { todo } ¦", {"else"}),
        ("alias flat = ¦", {"horizontal", "parallel"}),
        ("import ¦", {"parts.aidl"}),
        ('import "¦"', {"parts.aidl"}),
        ('import ¦ from "parts.aidl"', {"rivet", "twice", "play"}),
        ('import rivet, ¦ from "parts.aidl"', {"twice", "play"}),
    ],
)
def test_words(marked: str, has: set[str]) -> None:
    assert has <= set(labels(marked))


@pytest.mark.parametrize(
    "marked",
    [
        "// what ¦",
        "/* so¦ */",
        "/* open ¦",
        "# ¦",
        'x = text("so¦", height: 3)',
        "param ¦",
        "var ¦ = 3",
        "for ¦ in 0..3 { }",
        "solid ¦ { }",
        "solid ¦",
        "fn ¦",
        "shape ¦",
        "alias ¦ = circle",
        "construction ¦",
        'import "parts.aidl" as ¦',
        "fn f(¦) = 3",
        "x = 3¦0",
    ],
)
def test_nothing_where_nothing_is_to_be_offered(marked: str) -> None:
    assert labels(marked) == []


# --- Imports ---------------------------------------------------------------------------------------


def test_what_other_files_define_comes_with_its_import() -> None:
    template = "// about\nsolid a {\n    x = %s\n}\n"
    text, offset = cursor(template.replace("%s", "ri¦"))
    folder = Path("/project")
    view = seen(text, parts=PARTS)
    listed = complete(view, offset, lambda: [folder / "parts.aidl", Path("/elsewhere/o.aidl")])
    rivet = next(c for c in listed if c.label == "rivet")
    made = applied(put(text, rivet), rivet.extra)
    assert 'import rivet from "parts.aidl"' in made
    assert not has_errors(seen(made, parts=PARTS).found)
    assert "A rivet of a size." in rivet.documentation


# --- Everywhere ------------------------------------------------------------------------------------

_OPERANDS_FOLLOW = frozenset(
    (
        *("and", "or", "if", "not", "then", "as", "from"),
        *("fn", "shape", "constraint", "alias", "template", "for", "prefer", "assert"),
    )
)
_AFTER = ("", " == 0", "()")
_BEHIND_AN_ATTRIBUTE = re.compile(r"@\w+(\([^()]*\))?\s*$")


def closed(text: str) -> str:
    """What closes the brackets that are open at the end of a text."""
    opened: list[str] = []
    for token in tokenize(SourceFile("x", text)).tokens:
        if token.kind in _CLOSERS:
            opened.append(_CLOSERS[token.kind])
        elif token.kind in _CLOSERS.values():
            opened.pop()
    return "".join(reversed(opened))


_CLOSERS = {"(": ")", "CALL": ")", "[": "]", "{": "}"}


@pytest.mark.parametrize("path", FEW)
def test_what_is_inserted_parses_no_worse(path: Path) -> None:
    """A word is taken out of a program, or all that follows it too, what is open being closed: each entry
    that is put there leaves no more mistakes than there are without it. A name may begin a statement.
    """
    chance = random.Random(path.stem)
    text = path.read_text("utf-8")
    world = Workspace([path.parent]).world(path)
    tokens = [t for t in tokenize(SourceFile(path.name, text)).tokens if t.text[:1].isalnum()]
    for number, token in enumerate(chance.sample(tokens, 5 if TRIES_ALL else 3)):
        end = token.end - (token.kind == "CALL")
        broken = text[: token.start] + (text[end:] if number % 2 else closed(text[: token.start]))
        found = complete(look(path, broken, world), token.start)
        assert len(found) <= MOST
        assert [c.rank for c in found] == list(range(len(found)))
        before = errors(broken)
        for completion in chance.sample(found, min(8, len(found))):
            if completion.label in _OPERANDS_FOLLOW:
                continue
            if _BEHIND_AN_ATTRIBUTE.search(broken[: token.start]):
                continue  # any statement may stand behind `@allow`, and few behind another
            made = (
                broken[: token.start] + completion.plain + more + broken[token.start :] for more in _AFTER
            )
            is_no_worse = any(errors(m) <= before for m in made)
            assert is_no_worse, (completion.label, broken[token.start - 40 : token.start])
