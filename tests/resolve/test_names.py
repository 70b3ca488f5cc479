"""Names: scopes, order, spelling, duplicates, cycles."""

from __future__ import annotations

import pytest

from aidl_lang.checking.resolving.symbols import SymbolKind
from aidl_lang.syntax import ast
from tests.typecheck.checking import checked, mended, messages, resolved


def test_a_misspelt_name_gets_the_nearest_one() -> None:
    text = "solid s { outline = square(size: 9); constrain outlin.center == (0, 0) }"
    (found,) = checked(text)[1]
    assert found.message == "there is no `outlin` here; did you mean `outline`?"
    assert [label.text for label in found.secondary] == ["declared here"]
    assert "constrain outline.center" in mended(text)


def test_spelling_is_forgiven_and_the_canonical_one_is_known() -> None:
    text = "assembly a { solid myPart { r = Square(size: 4) }\n constrain my_part.bb.bottomLeft == (0, 0) }"
    resolution = resolved(text)
    spelt = {getattr(n, "text", ""): s for n, s in resolution.canonical.items()}
    assert spelt == {"Square": "square", "my_part": "myPart", "bottomLeft": "bottom_left"}
    assert messages(text) == []


def test_constants_are_visible_above_their_line_and_below_in_the_tree() -> None:
    assert (
        messages(
            """
            solid s {
                r = rectangle(width: w, height: h)
                hole c { rim = circle(radius: w / 8) }
                let h = w / 2
                param w = 80
            }
            """
        )
        == []
    )


def test_geometry_is_not_visible_above_its_line_but_constraints_see_all() -> None:
    assert messages(
        """
        solid s {
            constrain a.start == b.end
            a = line(b.end, (5, 5))
            b = line((0, 0), (9, 0))
            c = line(c.end, (1, 1))
        }
        """
    ) == [
        "E0205 3: `b` is used above the line that makes it",
        "E0205 5: `c` is used in its own definition",
    ]


def test_members_of_an_array_may_build_on_earlier_ones() -> None:
    assert (
        messages(
            """
            solid s {
                a[0] = line((0, 0), (9, 0))
                for i in 1..3 { a[i] = line(a[i - 1].end, (9 * i, i)) }
            }
            """
        )
        == []
    )


def test_callables_and_values_live_apart() -> None:
    assert (
        messages(
            """
            solid slot {
                circle = circle(radius: 4)
                body   = slot(center: circle.center, length: 30, width: 12)
            }
            """
        )
        == []
    )


def test_own_name_and_self_mean_the_structure() -> None:
    text = "solid s { r = square(size: 4); constrain { s.width == 5; self.height == 5; s.origin == (0, 0) } }"
    assert messages(text) == []


def test_both_branches_of_an_if_may_declare_a_name() -> None:
    text = """
    solid s {
        param n = 3
        if n > 2 { r = circle(radius: 4) } else { r = square(size: 8) }
        constrain r.center == (0, 0)
    }
    """
    assert messages(text) == []


@pytest.mark.parametrize(
    ("body", "line"),
    [
        ("a = point(0, 0)\na = point(1, 1)", 3),
        ("param a = 1\nlet a = 2", 3),
        ("a = point(0, 0)\na[1] = point(1, 1)", 3),
        ("a[1] = point(0, 0)\na[1] = point(1, 1)", 3),
        ("if true { a = point(0, 0) }\na = point(1, 1)", 3),
    ],
)
def test_duplicates_name_the_earlier_place(body: str, line: int) -> None:
    (found,) = checked(f"solid s {{\n{body}\n}}")[1]
    assert (found.code, found.span.line if found.span else 0) == ("E0209", line)
    assert found.secondary[0].span.line == 2
    assert found.secondary[0].text == "declared here"


def test_overloads_are_not_duplicates_unless_they_take_the_same() -> None:
    assert messages("fn f(a: length) = a\nfn f(a: point) = a.x\nsolid s { r = square(size: f(3mm)) }") == []
    assert messages("fn f(a: length) = a\nfn f(a: length) = 2 * a") == ["E0209 2: `f` is declared twice"]


def test_a_loop_makes_members_under_indices_of_their_own() -> None:
    text = "solid s {\n for i in 0..3 {\n  let x = 10 * i\n  p = circle(center: (x, 0), radius: 4)\n } }"
    assert messages(text) == ["E0208 4: `p` is made in every turn of this `for` and needs an index"]
    assert "p[i] = circle" in mended(text)
    assert messages(text.replace("p =", "p[0] =")) == [
        "E0208 4: `p` gets the same index in every turn of this `for`"
    ]


def test_each_turn_has_its_own_lets() -> None:
    text = """
    solid s {
        for i in 0..3 { let x = 10 * i
            a[i] = circle(center: (x, 0), radius: 4) }
        for i in 0..3 { let x = 20 * i
            b[i] = circle(center: (0, x), radius: 4) }
    }
    """
    assert messages(text) == []
    assert messages(text.replace("    }\n", "        c = circle(center: (x, 0), radius: 1)\n    }\n", 1))


def test_circles_of_constants_are_told_once() -> None:
    assert messages("solid s {\n let a = b\n let b = c + 1\n let c = a\n r = square(size: a) }") == [
        "E0207 4: `a` is defined by way of itself: a → b → c → a"
    ]


def test_aliases() -> None:
    text = "alias resting = over\nassembly a { solid b {}\n solid c {}\n constrain resting(b, c) }"
    assert messages(text) == []
    assert messages("alias a = b\nalias b = a") == [
        "E0207 1: the alias `a` stands for itself: a → b → a",
        "E0207 2: the alias `b` stands for itself: b → a → b",
    ]
    assert messages("alias resting = abov") == [
        "E0203 1: there is no function, shape or constraint `abov`; did you mean `above`?"
    ]


def test_a_definition_has_to_be_called_and_a_value_cannot() -> None:
    assert messages("solid s { a = circle(radius: 3)\n b = line(circle, (1, 1))\n c = a(3) }") == [
        "E0206 2: `circle` is a function and has to be called: `circle(…)`",
        "E0206 3: `a` is geometry and cannot be called",
    ]


def test_equality_sign_with_a_new_name_among_constraints() -> None:
    text = "solid s { r = square(size: 9)\n constrain { h = r.width / 2\n h == 4 } }"
    assert "E0201 2: there is no `h` here; among constraints `=` compares" in messages(text)


def test_uses_lead_to_definitions() -> None:
    resolution = resolved(
        "solid washer(outer = 4) { rim = circle(radius: outer) }\n"
        "solid s { a = washer(outer: 3)\n constrain a.rim.radius == 3 }"
    )
    used = {node.span.text: symbol for node, symbol in resolution.uses.items()}
    assert used["a.rim"].kind is SymbolKind.GEOMETRY
    assert isinstance(used["a.rim"].node, ast.Assign)
    assert isinstance(used["a.rim"].owner, ast.Structure)
    assert used["washer(outer: 3)"].kind is SymbolKind.TEMPLATE
    assert used["outer"].kind is SymbolKind.ARGUMENT
    assert [s.name for s in resolution.symbols if s.kind is SymbolKind.STRUCTURE] == ["s", "a"]
