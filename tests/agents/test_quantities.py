"""Numbers as people type them."""

from __future__ import annotations

import pytest

from aidl_lang.tools.agents.workspace import LONGEST, quantity


@pytest.mark.parametrize(
    ("text", "value", "unit", "named"),
    [
        ("80", 80, "", None),
        ("80+20", 100, "", None),
        ("12cm", 120, "mm", "cm"),
        (" 12 cm ", 120, "mm", "cm"),
        ("1/2in", 12.7, "mm", "in"),
        ("3 1/2 in", 88.9, "mm", "in"),
        ("1in + 3mm", 28.4, "mm", None),
        ("80 + 20mm", 100, "mm", "mm"),
        ("1/4turn", 90, "deg", "turn"),
        ("45deg * 2", 90, "deg", "deg"),
        ("12,5", 12.5, "", None),
        ("\u22127.5", -7.5, "", None),
        ("2 * (3 + 4)", 14, "", None),
        ("sqrt(9) * 1mm", 3, "mm", "mm"),
    ],
)
def test_what_a_number_means(text: str, value: float, unit: str, named: str | None) -> None:
    found = quantity(text)
    assert not isinstance(found, str)
    assert (found.value, found.unit, found.named) == (pytest.approx(value), unit, named)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "that is not a number"),
        ("12.", "that is not a number"),
        ("true", "that is not a number"),
        ("5 // x", "that is not a number"),
        ("5\n6", "that is not a number"),
        ("1) solid x { c = circle(radius: 2) } param y = (2", "that is not a number"),
        ("1" * (LONGEST + 1), "that is not a number"),
        ("wide", "there is no `wide` here"),
        ("2mm * 3mm", "that is neither a length, an angle nor a plain number"),
        ("90deg + 1mm", "`+` does not join an angle and a length"),
        ("1/0", "divides by zero"),
        ("9^9^9^9", "leaves the range of numbers"),
    ],
)
def test_what_means_no_number(text: str, why: str) -> None:
    found = quantity(text)
    assert isinstance(found, str)
    assert why in found
