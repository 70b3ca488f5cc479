"""Kinds of values and dimensions, in every body, executed or not."""

from __future__ import annotations

import pytest

from tests.typecheck.checking import checked, mended, messages

PLATE = "solid s {{\n r = rectangle(width: 60, height: 20)\n c = circle(radius: 4)\n {0}\n}}"


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("constrain r.width == 30deg", "E0308 4: `==` does not compare a length and an angle"),
        ("let x = 4mm + 30deg", "E0308 4: `+` does not join a length and an angle"),
        ("let x = r.widht", "E0202 4: `r` has no `widht`; did you mean `width`?"),
        ("let x = r.center.z", "E0202 4: `r.center` has no `z`"),
        ("let x = 3.width", None),
        ("constrain c.center <= r.center", "E0309 4: points have no order, so `<=` does not compare them"),
        ("constrain c == r", "E0309 4: `==` does not compare a circle with a rectangle"),
        ("constrain c.center == 3", "E0309 4: `==` does not compare a point with a number"),
        ("constrain r.top == c.bb.top", None),
        ("constrain r.width", "E0321 4: `r.width` is a length and constrains nothing"),
        ("r.width", None),
        ("constrain r", "E0321 4: `r` is a rectangle and constrains nothing"),
        ("constrain not r.width == 4",
         "E0322 4: `not` does not constrain: there are many ways to satisfy it"),
        ("constrain r.width != 4", "E0322 4: `!=` does not constrain: there are many ways to satisfy it"),
        ("constrain true or false", None),
        ("constrain fixed(r)", None),
        ("assert r.width == 4 or r.width != 5", None),
        ("assert r.width", "E0302 4: a condition is needed here, and this is a length"),
        ("prefer r.width == 4 weight 2", None),
        ("if r.width > 4 { p = point(0, 0) }", "E0502 4: `r.width > 4` is decided by the solver, so it "
         "cannot choose what is built"),
        ("if 4 { p = point(0, 0) }", "E0302 4: a condition is needed here, and this is a number"),
        ("for i in 0..r.width { p[i] = point(i, 0) }",
         "E0501 4: the ends of a range that is run through must "
         "be known before solving, and `0..r.width` is found by the solver"),
        ("for i in [1, 2] { p[i] = point(i, 0) }", None),
        ("for i in len([r, c])..4 { p[i] = point(i, 0) }", None),
        ("let x = r.width % 2", "E0501 4: an operand of `%` must be known before solving, and `r.width` is "
         "found by the solver"),
        ("let x = round(written(r.width))", None),
        ("p = polygon([(0, 0), (3, 4), c.center])", None),
        ("q = [c, c]\n let x = q[r.width]",
         "E0306 5: an index must be a whole number, and this is `r.width`"),
        ("q = [c, c]\n let x = q[1].radus", "E0202 5: `q[1]` has no `radus`; did you mean `radius`?"),
        ("q = [c, c]\n let x = q.radius", None),
        ("let x = c[0]", "E0305 4: `c` is a circle and has no members by number"),
        ("let x = c.center + 5", "E0307 4: `+` does not work on a point and a number"),
        ("let x = [1, 2] + c.center", None),
        ("let x = 2 * c.center / 3 - (1, 1)", None),
        ("hole h rotated 3mm {}", "E0302 4: `rotated` wants an angle, and this is a length"),
        ("hole h at 3 {}", "E0302 4: `at` wants a point, and this is a number"),
        ("hole h at [3, 4] rotated 30 {}", None),
        ("param n = 4 in 2mm..30deg", "E0308 4: a range does not join a length and an angle"),
        ("param n = 4 in 2..9 step 30deg", None),
        ("param n = 4mm in 2..9 step 30deg",
         "E0308 4: the step does not fit the value: a length and an angle"),
        ('param n = "a" in ["a", "b"]', None),
        ('param n = "a" in 1..2', "E0314 4: a range fits a number, and `n` is a text"),
        ("d = circle(radius: 30deg)", "E0311 4: `circle` needs `radius` to be a length, not an angle"),
        ("d = circle(centr: (0, 0), radius: 4)", "E0324 4: `circle` has no parameter `centr`; did you mean "
         "`center`?"),
        ("d = circle(center: (10 * cos(30deg), 10 * sin(30)), radius: 4)", None),
        ("d = circle(center: (30deg, 0), radius: 4)",
         "E0301 4: a coordinate must be a length, and `30deg` is "
         "an angle"),
        ("d = regular_polygon(radius: 4, sides: 6 / 2)", None),
        ("circle(radius: 3)", "E0323 4: this `circle` has no name, so nothing could refer to it"),
    ],
)  # fmt: skip
def test_one_statement(statement: str, message: str | None) -> None:
    found = messages(PLATE.format(statement))
    if message is None:
        assert [f for f in found if f.startswith("E03") and "no members" not in f] == []
    else:
        assert found == [message]


def test_unnamed_geometry_gets_the_next_free_name() -> None:
    text = PLATE.format("circle_1 = circle(radius: 2)\n circle(radius: 3)")
    assert "circle_2 = circle(radius: 3)" in mended(text)


def test_a_bare_number_may_not_serve_as_length_and_angle() -> None:
    text = PLATE.format("param t = 20\n hole h rotated t { q = square(size: t)\n p = square(size: t) }")
    (found,) = checked(text)[1]
    assert found.message == "`t` has no unit and is used both as an angle and as a length"
    assert [label.text for label in found.secondary] == ["as an angle", "declared here"]
    assert messages(PLATE.format("hole h rotated 20 { let t = 4\n q = square(size: t + t / 2) }")) == []


def test_one_mistake_is_told_once() -> None:
    text = PLATE.format(
        "let x = c.radus + 4\n let y = 30deg + x\n d = circle(radius: y)\n constrain d.radius == x"
    )
    assert messages(text) == ["E0202 4: `c` has no `radus`; did you mean `radius`?"]


@pytest.mark.parametrize(
    "text",
    [
        "shape f() { c = circle(radius: 3)\n d = line(c.centr, (0, 0)) }",
        "solid t(n = 3) { c = circle(radius: n)\n d = line(c.centr, (0, 0)) }",
        "constraint k(c: circle) { c.radius == 2\n c.centr == (0, 0) }",
        "fn k(c: circle) = \n c.centr",
        "solid s { c = circle(radius: 3)\n if false { d = line(c.centr, (0, 0)) } }",
        "solid s { c = circle(radius: 3)\n for i in 0..<0 { d[i] = line(c.centr, (0, 0)) } }",
    ],
)
def test_every_body_is_checked(text: str) -> None:
    assert messages(text) == ["E0202 2: `c` has no `centr`; did you mean `center`?"]


def test_members_through_templates_arrays_and_the_library() -> None:
    head = "hole bolt(size = 4) { rim = circle(radius: size / 2) }\nsolid s {\n"
    lines = "for i in 0..3 { a[i] = bolt(size: 3) }\n constrain a[0].rim.center == a[-1].rim.center\n"
    assert messages(head + lines + "assert len(a.rim) == 4 }") == []
    assert messages(head + lines + "assert a[1].rin.radius == 4 }") == [
        "E0202 5: `a[1]` has no `rin`; did you mean `rim`?"
    ]
    assert messages(head + "r = rectangle(width: 4, height: 4)\n constrain r.top.lenght == 4 }") == [
        "E0202 4: `r.top` has no `lenght`; did you mean `length`?"
    ]


def test_what_is_not_known_is_not_judged() -> None:
    assert (
        messages(
            """
            fn pick(a, b) = if a.size > 3 then b else a[0]
            constraint near(a, b, gap = 3) { distance(a.middle, b) == gap }
            shape thing(n, p0: point) { p = circle(center: p0 + n * (1, 1), radius: n.depth) }
            solid s {
                t = thing(4, (0, 0))
                constrain near(t, pick(t, t.p))
            }
            """
        )
        == []
    )


def test_functions_carry_types() -> None:
    text = (
        "fn twice(a: length) = 2 * a\nsolid s { c = circle(radius: 3)\n constrain twice(c.radius) == 30deg }"
    )
    assert messages(text) == ["E0308 3: `==` does not compare a length and an angle"]
    assert messages("fn f(n) = if n > 0 then f(n - 1) else 1\nsolid s { c = circle(radius: f(3)) }") == []
