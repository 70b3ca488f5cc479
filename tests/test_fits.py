"""Limits of fits against the tables of ISO 286-2, in micrometres."""

from __future__ import annotations

import pytest

from aidl_lang.common.materials import is_fit, limits

PUBLISHED = """
H6 30 0 13 | H7 3 0 10 | H7 10 0 15 | H7 20 0 21 | H7 50 0 25 | H7 100 0 35 | H7 200 0 46 | H7 500 0 63
H8 30 0 33 | H9 30 0 52 | H10 100 0 140 | H11 30 0 130 | F8 25 20 53 | G7 25 7 28 | JS7 25 -10.5 10.5
K7 25 -15 6 | M7 25 -21 0 | N7 25 -28 -7 | P7 25 -35 -14 | K7 3 -10 0 | N7 3 -14 -4 | P7 3 -16 -6
K7 100 -25 10 | N7 100 -45 -10 | P7 100 -59 -24 | D10 40 80 180 | E9 40 50 112
h6 20 -13 0 | h7 50 -25 0 | h9 50 -62 0 | h10 6 -48 0 | h11 50 -160 0 | h6 500 -40 0
g6 3 -8 -2 | g6 5 -12 -4 | g6 20 -20 -7 | g6 50 -25 -9 | g6 100 -34 -12
f7 5 -22 -10 | f7 25 -41 -20 | f7 100 -71 -36 | e8 40 -89 -50 | d9 40 -142 -80
js6 20 -6.5 6.5 | k6 3 0 6 | k6 5 1 9 | k6 20 2 15 | k6 100 3 25 | m6 5 4 12 | m6 20 8 21
n6 3 4 10 | n6 20 15 28 | n6 100 23 45 | p6 3 6 12 | p6 20 22 35 | p6 100 37 59 | p6 500 68 108
"""
ENTRIES = [entry.split() for line in PUBLISHED.split("\n") for entry in line.split("|") if entry.strip()]


def test_limits_are_those_of_the_table():
    for fit, size, low, high in ENTRIES:
        wanted = float(low) / 1000, float(high) / 1000
        assert limits(fit, float(size)) == pytest.approx(wanted, abs=1e-12), (fit, size)


def test_a_range_ends_with_its_last_size():
    assert limits("H7", 18) == (0, 0.018)
    assert limits("H7", 18.001) == (0, 0.021)


def test_what_the_standard_does_not_have():
    assert limits("H7", 500.1) is None
    assert not any(map(is_fit, ("", "H", "7", "H4", "H99", "Q7", "N8", "k9", "Js7", "H7 ", "hh6")))
    with pytest.raises(ValueError, match="Z9"):
        limits("Z9", 10)
