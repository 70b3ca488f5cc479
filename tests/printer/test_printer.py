"""The canonical form: layout, comments, blank lines, one-line blocks, long lines."""

from __future__ import annotations

import textwrap

import pytest

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_module


def form(text: str) -> str:
    parsed = parse(SourceFile("", text))
    assert not [d.message for d in parsed.diagnostics if d.is_error]
    once = format_module(parsed)
    assert format_module(parse(SourceFile("", once))) == once
    return once


def check(written: str, canonical: str) -> None:
    assert form(textwrap.dedent(written)) == textwrap.dedent(canonical).lstrip("\n")


def test_blank_lines_are_at_most_one() -> None:
    check("\n\nlet a = 3\n\n\n\nlet b = 4\nlet c = 5\n\n\n", "let a = 3\n\nlet b = 4\nlet c = 5\n")
    check("solid a {\n\n\n  let b = 3\n\n}\n", "solid a {\n    let b = 3\n}\n")


def test_comments_stay_where_they_are() -> None:
    check(
        """
        // head
        /* block */

        solid a {   // about a
        // first
           let b = 3   # trailing
           let longer = 4;  // too

           // before the end
        }  // after
        // last
        """,
        """
        // head
        /* block */

        solid a {  // about a
            // first
            let b = 3       # trailing
            let longer = 4  // too

            // before the end
        }  // after
        // last
        """,
    )


def test_comments_inside_a_statement_move_in_front_of_it() -> None:
    check(
        "x = circle(\n  center: (0, 0),  // here\n  radius: 5\n)\n",
        "// here\nx = circle(center: (0, 0), radius: 5)\n",
    )
    check("if a { // one\n b = c\n} else { // two\n d = e\n}", """
        if a {  // one
            b = c
        } else {  // two
            d = e
        }
        """)  # fmt: skip


def test_allow_before_any_statement() -> None:
    check(
        "@allow('N0602')param k=3 @allow(\"W0201\",'N0602') /* c */ let a=k "
        "constrain{@allow('N0602')a==3,@allow('W0202') if k>2{@allow('N0605') prefer k==3}}",
        """
        @allow("N0602") param k = 3
        /* c */
        @allow("W0201", "N0602") let a = k
        constrain { @allow("N0602") a == 3; @allow("W0202") if k > 2 { @allow("N0605") prefer k == 3 } }
        """,
    )


def test_docs_and_attributes() -> None:
    check(
        "/// Doc.\n@thickness(3mm)  @color('red') solid a { @layer('b') c = circle(radius: 1) }",
        """
        /// Doc.
        @thickness(3mm) @color("red") solid a { @layer("b") c = circle(radius: 1) }
        """,
    )


def test_attributes_stay_on_the_line_they_were_written_on() -> None:
    check(
        """
        @color("red")   @detached
        solid a { r = circle(radius: 1) }
        @color("red")
        @detached solid b {
        @layer("cut")   c = circle(radius: 1)
        }
        """,
        """
        @color("red") @detached
        solid a { r = circle(radius: 1) }
        @color("red")
        @detached solid b {
            @layer("cut") c = circle(radius: 1)
        }
        """,
    )


def test_attributes_that_find_no_room_stand_above() -> None:
    red = '@color("' + "r" * 38 + '")'
    circles = "solid a { r = circle(radius: 1); s = circle(radius: 2) }"
    assert len(f"{red} {circles}") == 105
    assert form(f"{red} {circles}") == f"{red}\n{circles}\n"
    block = "solid a {\n    r = circle(radius: 1)\n}"
    assert form(f"{red} {block}") == f"{red} {block}\n"
    assert form(f"{red} {red} {block}") == f"{red} {red}\n{block}\n"
    assert form(f"{red} {red} @detached\n{block}") == f"{red}\n{red}\n@detached\n{block}\n"


@pytest.mark.parametrize("width", [99, 100, 101])
def test_attributes_fill_a_line_to_its_end(width: int) -> None:
    name = "a" * (width - len('@color("red") solid  {'))
    gap = " " if width <= 100 else "\n"
    assert form(f'@color("red") solid {name} {{\n}}') == f'@color("red"){gap}solid {name} {{\n}}\n'


def test_attributes_leave_the_layout_of_what_they_stand_before() -> None:
    fits = "[(-100, -100), (100, -100), (100, 100), (-100, 100), (-150, 0), (-150, -50)]"
    is_long = f"{fits[:-1]}, (-120, -80)]"
    check(
        f"hole h {{\n @layer('cut') e = polygon({fits})\n @layer('cut') f = polygon({is_long}) }}",
        f"""
        hole h {{
            @layer("cut")
            e = polygon({fits})
            @layer("cut") f = polygon(
                {is_long}
            )
        }}
        """,
    )


def test_comments_behind_attributes_stay_there() -> None:
    check(
        """
        @color("red") // the accent
        @detached /* one */ solid a { // of it
          @layer("cut") /// for the laser
          r = circle(radius: 1)
        }
        """,
        """
        @color("red")  // the accent
        @detached solid a {
            /* one */
            // of it
            @layer("cut")  /// for the laser
            r = circle(radius: 1)
        }
        """,
    )


def test_short_blocks_stay_on_one_line() -> None:
    check(
        "hole h { r = circle(radius: 1); constrain r.width == 9 }",
        "hole h { r = circle(radius: 1); constrain r.width == 9 }\n",
    )
    check("hole h {\n r = circle(radius: 1) }", "hole h {\n    r = circle(radius: 1)\n}\n")
    long = "hole h { " + "; ".join(f"radius_{i} = circle(radius: {i})" for i in range(4)) + " }"
    assert form(long).count("\n") == 6


def test_long_lists_are_broken() -> None:
    check(
        "edge = polygon([(-100, -100), (100, -100), (100, 100), (-100, 100), (-150, 0)], "
        "rotatable: true, angle: 45deg)",
        """
        edge = polygon(
            [(-100, -100), (100, -100), (100, 100), (-100, 100), (-150, 0)], rotatable: true, angle: 45deg
        )
        """,
    )


def test_what_does_not_fit_on_one_line_of_its_own_has_a_line_each() -> None:
    check(
        "edge = polygon([(-100, -100), (100, -100), (100, 100), (-100, 100), (-150, 0)], "
        "rotatable: true, angle: 45deg + 3 * turn_of_the_part)",
        """
        edge = polygon(
            [(-100, -100), (100, -100), (100, 100), (-100, 100), (-150, 0)],
            rotatable: true,
            angle: 45deg + 3 * turn_of_the_part
        )
        """,
    )


def test_the_value_of_a_function_may_stand_below_its_head() -> None:
    check(
        "fn pentagon(center: point = (0, 0), radius: length) = "
        "regular_polygon(center: center, radius: radius, sides: 5)",
        """
        fn pentagon(center: point = (0, 0), radius: length) =
            regular_polygon(center: center, radius: radius, sides: 5)
        """,
    )


def test_a_long_reason_stands_below_its_test() -> None:
    check(
        "assert distance(frame[i].rim.center, slot[i].center) >= bolt / 2 + slot_width / 2 + min_wall, "
        '"too little material"',
        """
        assert distance(frame[i].rim.center, slot[i].center) >= bolt / 2 + slot_width / 2 + min_wall,
            "too little material"
        """,
    )


def test_else_if_is_a_chain() -> None:
    check(
        "if a {\n b = c } else if d { e = f } else {\n if g { h = i } }",
        """
        if a {
            b = c
        } else if d {
            e = f
        } else {
            if g { h = i }
        }
        """,
    )


def test_names_are_spelled_as_asked() -> None:
    module = parse(SourceFile("", "CenteredIn(hole_a, Plate)\nx = Circle(radius: 5)\n")).module
    names = {
        node: {"CenteredIn": "centered_in", "Circle": "circle"}[node.text]
        for node in ast.walk(module)
        if isinstance(node, ast.Identifier) and node.text in ("CenteredIn", "Circle")
    }
    assert format_module(module, names) == "centered_in(hole_a, Plate)\nx = circle(radius: 5)\n"


@pytest.mark.parametrize("text", ["", "\n\n", "// only\n", "/* a\n   b */\n"])
def test_files_without_statements(text: str) -> None:
    assert form(text) == text.strip("\n") + ("\n" if text.strip() else "")


def test_carriage_returns_go() -> None:
    assert form("let a = 3\r\n\r\nlet b = 4 // c\r\n") == "let a = 3\n\nlet b = 4  // c\n"
