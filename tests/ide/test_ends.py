"""What stands above params: the offer to try their ends, and what came of it."""

from __future__ import annotations

import pytest

from aidl_lang.tools.ide.lenses import Found, can_be_tried, end_lenses, tried
from aidl_lang.tools.ide.workspace import SETTINGS, View
from tests.ide.conftest import seen

PLATE = """\
solid plate {
    param width = 60mm in 40..120
    param height = 94mm in 20..200
    param look = "plain" in ["plain", "other", "third"]
    param free = 3
    body = rectangle(center: origin, width: width, height: height)
    hole bore { rim = circle(center: (0, 0), radius: free) }
    if look == "other" { hole b { rim = circle(center: (9, 9), radius: 2) } }
    assert height > 15
    assert width < 100
}
"""


def titles(view: View, found: Found | None = None) -> list[tuple[str, str]]:
    return [(span.text.split()[1], title) for span, title in end_lenses(view, found)]


def swept(view: View) -> Found:
    return tried(view, SETTINGS, lambda done, count: None, 60.0)


def test_each_param_tells_what_came_of_it() -> None:
    view = seen(PLATE, solved=True)
    assert titles(view, swept(view)) == [
        (
            "width",
            "at `width = 120mm` the assert in line 10 fails (120 is not < 100); "
            "`width < 100` holds up to 99.99mm",
        ),
        ("height", "works from 20mm to 200mm, one kind throughout"),
        ("look", 'works with "other" and "third"'),
    ]


@pytest.mark.parametrize(
    "text",
    [
        "solid a { b = circle(center: origin, radius: 4) }",
        "solid a { param r = 3; b = circle(center: origin, radius: r) }",
        "solid a { param r = 3 in 1..5; b = circle(center: origin, radius: r); assert r > 4 }",
        "solid a { param r = 3 in 1..5; b = circle(center: origin, radius: ) }",
    ],
)
def test_there_may_be_nothing_to_try(text: str) -> None:
    view = seen(text, solved=True)
    assert not can_be_tried(view)
    assert titles(view) == []
    with pytest.raises(ValueError, match="the program has to work as it is written"):
        swept(view)
