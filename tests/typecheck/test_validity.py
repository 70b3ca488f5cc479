"""Who may read whose unknowns, and how a breach is mended."""

from __future__ import annotations

import textwrap

import pytest

from aidl_lang.common.diagnostics import apply_fixes
from tests.typecheck.checking import checked, mended, messages

OUTLINE = "    plate = rectangle(width: 80, height: 40)"


def around(body: str) -> str:
    return f"solid s {{\n{OUTLINE}\n{textwrap.indent(textwrap.dedent(body).strip(), '    ')}\n}}\n"


CASES = {
    "a point": (
        "hole h { rim = circle(center: plate.center, radius: 4) }",
        """
        hole h { rim = circle(center: (0, 0), radius: 4) }
        constrain h.rim.center == plate.center
        """,
    ),
    "a size keeps its arithmetic": (
        "hole h { rim = circle(radius: plate.width / 4) }",
        """
        hole h { rim = circle(radius: guess(10)) }
        constrain h.rim.radius == plate.width / 4
        """,
    ),
    "one coordinate leaves the other a guess": (
        "hole h { rim = circle(center: (plate.center.x, 5), radius: 4) }",
        """
        hole h { rim = circle(center: (0, 5), radius: 4) }
        constrain h.rim.center.x == plate.center.x
        """,
    ),
    "members of an array": (
        """
        for i in 0..3 {
            hole h[i] { rim = circle(center: plate.center + (i, 0), radius: 4) }  // four
        }
        """,
        """
        for i in 0..3 {
            hole h[i] { rim = circle(center: (0, 0) + (i, 0), radius: 4) }  // four
            constrain h[i].rim.center == plate.center + (i, 0)
        }
        """,
    ),
    "loops inside": (
        """
        hole h {
            let pitch = 3
            for i in 0..3 {
                rim[i] = circle(center: plate.center + (i * pitch, 0), radius: 1)
            }
        }
        """,
        """
        hole h {
            let pitch = 3
            for i in 0..3 {
                rim[i] = circle(center: (0, 0) + (i * pitch, 0), radius: 1)
            }
        }
        for i in 0..3 { constrain h.rim[i].center == plate.center + (i * h.pitch, 0) }
        """,
    ),
    "a let is judged where it is used": (
        "hole h {\n    let c = plate.center\n    rim = circle(center: c, radius: 4)\n}",
        """
        hole h {
            let c = plate.center
            rim = circle(center: (0, 0), radius: 4)
        }
        constrain h.rim.center == plate.center
        """,
    ),
    "the placement of a structure is its holder's": (
        "solid a { r = square(size: 4) }\nhole h at a.r.center { rim = circle(radius: 4) }",
        """
        solid a { r = square(size: 4) }
        hole h at (0, 0) { rim = circle(radius: 4) }
        constrain h.origin == a.r.center
        """,
    ),
    "geometry reads no children": (
        "hole h { rim = circle(radius: 4) }\nk = circle(center: h.rim.center, radius: 6)",
        """
        hole h { rim = circle(radius: 4) }
        k = circle(center: (0, 0), radius: 6)
        constrain k.center == h.rim.center
        """,
    ),
    "points of a list": (
        "hole h { p = polygon([(0, 0), (9, 0), plate.top_right]) }",
        """
        hole h { p = polygon([(0, 0), (9, 0), (0, 0)]) }
        constrain h.p.points[2] == plate.top_right
        """,
    ),
    "a var": (
        "hole h { var g = plate.width\n    rim = circle(radius: g) }",
        """
        hole h { var g = 0
            rim = circle(radius: g) }
        constrain h.g == plate.width
        """,
    ),
    "a constraint moves up": (
        "hole h {\n    rim = circle(radius: 4)\n    constrain rim.center == plate.center\n}",
        """
        hole h {
            rim = circle(radius: 4)
        }
        constrain h.rim.center == plate.center
        """,
    ),
    "a constraint among others, with its own name": (
        "hole h {\n    rim = circle(radius: 4)\n"
        "    constrain { self.inside(plate, margin: 2); rim.radius == 4 }\n}",
        """
        hole h {
            rim = circle(radius: 4)
            constrain { rim.radius == 4 }
        }
        constrain h.inside(plate, margin: 2)
        """,
    ),
    "a preference keeps its weight, a branch its condition": (
        "param n = 3\nhole h {\n    rim = circle(radius: 4)\n"
        "    if n > 2 {\n        prefer rim.radius == plate.height weight 3\n    }\n}",
        """
        param n = 3
        hole h {
            rim = circle(radius: 4)
        }
        if n > 2 { prefer h.rim.radius == plate.height weight 3 }
        """,
    ),
    "the nearest common ancestor": (
        "solid a { solid b { r = square(size: 4) }\n"
        "    hole h { rim = circle(center: b.r.center, radius: 1) } }",
        """
        solid a { solid b { r = square(size: 4) }
            hole h { rim = circle(center: (0, 0), radius: 1) } constrain h.rim.center == b.r.center; }
        """,
    ),
    "more on one line": (
        "hole h { rim = circle(center: plate.center, radius: 4) } hole g { rim = circle(radius: 2) }",
        """
        hole h { rim = circle(center: (0, 0), radius: 4) } constrain h.rim.center == plate.center; """
        """hole g { rim = circle(radius: 2) }
        """,
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_fixes_keep_the_meaning(case: str) -> None:
    before, after = CASES[case]
    assert mended(around(before)) == around(after)


def test_each_fix_applies_alone_and_all_together() -> None:
    text = around(
        """
        hole h {
            rim = circle(center: plate.center, radius: plate.width / 8)
            constrain rim.radius <= plate.height / 2
        }
        """
    )
    program, found = checked(text)
    assert [d.code for d in found] == ["E0401", "E0401", "E0402"]
    for one in found:
        new, count = apply_fixes(program.main.source, [one])
        assert count == 1
        assert [d.code for d in checked(new)[1]] == [d.code for d in found if d is not one]
    assert mended(text) == around(
        """
        hole h {
            rim = circle(center: (0, 0), radius: guess(10))
        }
        constrain h.rim.center == plate.center
        constrain h.rim.radius == plate.width / 8
        constrain h.rim.radius <= plate.height / 2
        """
    )


def test_what_is_said() -> None:
    program, (found,) = checked(around("hole h { rim = circle(center: plate.center, radius: 4) }"))
    assert found.message == "geometry of `h` cannot use `plate.center`, which belongs to `s`"
    assert found.label == "outside `h`"
    assert found.span is not None
    assert found.span.text == "plate.center"
    assert found.hints == (
        "write a first guess here, `(0, 0)`, and in `s` `constrain h.rim.center == plate.center`",
    )
    (violation,) = program.violations
    (node,) = violation.nodes
    written = violation.diagnostic({node: (12.3456789, 1e-17)})
    assert written.fix is not None
    assert written.fix.edits[0].replacement == "(12.3457, 0)"


@pytest.mark.parametrize(
    "body",
    [
        "hole washer(size = 4, c: point = (0, 0)) { rim = circle(center: c, radius: size) }\n"
        "w = washer(size: plate.height / 4, c: plate.center)",
        "hole h { e = offset(plate, -3) }",
        "hole h { e = mirror(plate, about: y_axis) }",
        "hole h { rim = circle(radius: 4) }\nassert h.rim.radius == plate.width",
        "hole h { rim = circle(radius: 4)\n assert rim.radius <= plate.width }",
        "hole h { rim = circle(radius: 4) }\nconstrain h.rim.center == plate.center",
        "hole h at plate.center rotated plate.angle { rim = circle(radius: 4) }",
        "param w = 3\nlet d = 2 * w\nhole h { rim = circle(radius: d); constrain rim.radius <= w }",
        "hole h { rim = circle(center: origin, radius: 4); constrain rim.center == self.origin }",
        "mid = plate.center\nk = circle(center: mid, radius: 4)",
        "for i in 0..2 { hole h[i] { rim = circle(radius: 1 + i) }\n"
        "constrain h[i].rim.center == plate.center }",
    ],
)
def test_what_is_allowed(body: str) -> None:
    assert [m for m in messages(around(body)) if m.startswith("E04")] == []


def test_a_template_that_reads_its_surroundings_cannot_be_mended_by_itself() -> None:
    (found,) = checked(around("hole h(n = 1) { rim = circle(center: plate.center, radius: n) }"))[1]
    assert found.fix is None
    assert found.hints == ("write a first guess here, and the relation as a constraint in `s`",)


def test_the_file_may_be_the_common_ancestor() -> None:
    text = "p = point(3, 4)\nsolid s {\n    c = circle(center: p, radius: 4)\n}\n"
    assert mended(text) == (
        "p = point(3, 4)\nsolid s {\n    c = circle(center: (0, 0), radius: 4)\n}\n"
        "constrain s.c.center == p\n"
    )
