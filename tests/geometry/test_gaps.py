"""Small gaps between the ends of curves: closed, exactly, and told."""

from __future__ import annotations

import math

import pytest

from aidl_lang.geometry.curves import Bezier, Circle, Line
from tests.compiled import compiled
from tests.geometry.test_regions import assert_closed

WEDGE = """\
solid wedge {
    base  = line((0, 0), (40, 0))
    side  = line(base.end, (40, 25))
    slope = line(side.end, END)
}
"""


def codes(text: str) -> list[str]:
    return [d.code for d in compiled(text).diagnostics]


@pytest.mark.parametrize(
    ("end", "expected"),
    [
        ("(0, 0.0199)", "N0708"),  # 0.0005 of 40 mm are 0.02 mm
        ("(0, 0.0201)", "W0702"),
        ("(0, 1e-5)", "N0708"),  # so near that they are one point of the arrangement
        ("(0, 1e-7)", None),  # rounding
        ("(0, 0)", None),
    ],
)
def test_how_wide_a_gap_may_be(end: str, expected: str | None):
    found = codes(WEDGE.replace("END", end))
    assert found == ([expected] if expected else [])


def test_in_large_drawings_five_hundredths_of_a_millimetre():
    wide = WEDGE.replace("40", "4000")
    assert codes(wide.replace("END", "(0, 0.0499)")) == ["N0708"]
    assert codes(wide.replace("END", "(0, 0.0501)")) == ["W0702"]


def test_curves_of_every_kind_stay_what_they_are():
    result = compiled(
        """
        solid s {
            base = line((0, 0), (40, 0))
            cap  = arc(center: (20, 0), radius: 20.01, start_angle: 0.02deg, end_angle: 179.98deg)
            hole h { leaf = bezier((10, 5), (20, 25), (30, 5), (10.01, 5.01)) }
            hole k { bore = arc(center: (30, 5), radius: 2, start_angle: 0deg, end_angle: 359.9deg) }
        }
        """
    )
    notes = [d.message for d in result.diagnostics if d.code == "N0708"]
    assert [note.partition(" was")[0] for note in notes] == [
        "a gap of 0.0122 mm between `cap.start` and `base.end` at (40, 0)",
        "a gap of 0.0122 mm between `cap.end` and `base.start` at (0, 0)",
        "a gap of 0.01414 mm between `leaf.p3` and `leaf.p0` at (10, 5)",
        "a gap of 0.003491 mm between `bore.end` and `bore.start` at (32, 5)",
    ]
    found = result.drawing.regions["s"]
    assert_closed(found)
    line, arc = found.faces[0].outer.pieces
    assert line == Line((0, 0), (40, 0))
    for end in (arc.start, arc.end):
        assert math.dist(end, arc.center) == pytest.approx(arc.radius, abs=1e-12)
    kinds = {type(piece) for loop in found.faces[0].holes for piece in loop.pieces}
    assert kinds == {Bezier, Circle}


def test_where_nothing_is_enclosed_all_stays_as_it_was():
    text = "solid s { a = line((0, 0), (40, 0))\n b = line((40, 0.01), (40, 25)) }"
    assert codes(text) == ["W0702"]


def test_overshooting_ends_are_trimmed_without_a_word():
    result = compiled(
        """
        solid s {
            a = line((-0.01, 0), (40.01, 0))
            b = line((40.01, -0.01), (19.99, 20.01))
            c = line((20.005, 20.005), (-0.005, -0.005))
        }
        """
    )
    assert not result.diagnostics
    assert result.drawing.regions["s"].area == pytest.approx(400, abs=1e-2)
