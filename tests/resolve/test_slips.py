"""Which names are so near to each other that a fix may write the one for the other unasked."""

from __future__ import annotations

import pytest

from aidl_lang.common.names import is_slip
from aidl_lang.common.source import SourceFile
from aidl_lang.pipeline import check

SLIPS = "raduis radius, gpa gap, Hole_2 hole2, hloe2 hole2, part_nmber_7 part_number_7, rectanlge rectangle"
OTHERS = "hole3 hole2, hole hole2, plate12 plate21, x10 s10, i pi, l1 r1, ab ac, same_center_x same_center"


@pytest.mark.parametrize("pair", SLIPS.split(", "))
def test_a_letter_that_is_wrong(pair: str) -> None:
    assert is_slip(*pair.split())


@pytest.mark.parametrize("pair", OTHERS.split(", "))
def test_what_may_be_another_name(pair: str) -> None:
    assert not is_slip(*pair.split())


@pytest.mark.parametrize("name", ["hole3", "hole12"])
def test_a_member_that_is_not_there_is_no_other_member(name: str) -> None:
    text = (
        "solid s {\n    hole1 = circle(radius: 3)\n    hole2 = circle(center: (9, 0), radius: 3)\n"
        f"    constrain {name}.radius == 4\n}}\n"
    )
    (found,) = [d for d in check(SourceFile("s.aidl", text)) if d.code == "E0201"]
    assert found.fix is None
    assert "did you mean `hole" in found.message
