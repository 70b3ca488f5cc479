"""Fixes that are made unasked: the sure ones, and only where nothing gets worse for them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from aidl_lang.common.source import SourceFile
from aidl_lang.pipeline import Settings, check
from aidl_lang.tools.mending import mend


def mended(text: str) -> str:
    return mend(SourceFile("part.aidl", text)).source.text


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("solid s { c = cirlce(raduis: 3) }", "solid s { c = circle(radius: 3) }"),
        ("solid s { c = circle(radius: 3)", "solid s { c = circle(radius: 3)\n}"),
        ("drawing d { let x == 3; c = circle(radius: x) }", "drawing d { let x = 3; c = circle(radius: x) }"),
        ("drawing d { c = circle(d: 5 mm) }", "drawing d { c = circle(d: 5mm) }"),
        ("```aidl\ndrawing d { c = circle(radius: 5) }\n```\n", "\ndrawing d { c = circle(radius: 5) }\n\n"),
        (
            "drawing d { l = polygon([(0, 0); (9, 0); (9, 9)]); constrain |l.left| == 3 }",
            "drawing d { l = polygon([(0, 0), (9, 0), (9, 9)]); constrain abs(l.left) == 3 }",
        ),
        (
            "assembly c { assembly d { solid f { r = circle(radius: 5) } } constrain c.f.r.left == 3 }",
            "assembly c { assembly d { solid f { r = circle(radius: 5) } } constrain c.d.f.r.left == 3 }",
        ),
        (
            "drawing d { r = rectangle(width: 5, height: 4); constrain Rotate(r, 30) }",
            "drawing d { r = rectangle(width: 5, height: 4); constrain r.angle == 30deg }",
        ),
    ],
)
def test_what_can_mean_nothing_else_is_mended(before: str, after: str) -> None:
    assert mended(before) == after


@pytest.mark.parametrize(
    "text",
    [
        "drawing d { c = circle(radius: guess(3)); constrain c.radius == 3 or c.radius == 5 }",
        "drawing d { s = square(5) }",
        "drawing d { r = rectangle(1, 2, 30, 40) }",
        "drawing d { r = rectangle(width: 5, height: 4); constrain r.x == 3 }",
        "drawing d { c = circle(radius: 5); constrain h = 3 }",
        "drawing d { let c = circle(radius: 5) }",
        "drawing d { c = circle(radius: 5) } /* the rest",
        "drawing d { c = circle(width: 5) }",
        "solid s { r = circle(center: (40 * i, 0), radius: 3) }",
        "drawing d { r = rectangle((40, 20), 30) }",
    ],
)
def test_what_may_mean_several_things_is_not(text: str) -> None:
    source = SourceFile("part.aidl", text)
    assert check(source)
    assert mended(text) == text


def test_fixes_that_need_each_other_are_made_together() -> None:
    """The second mistake shows once the first is mended: for a moment there are no fewer errors."""
    text = "drawing d { r = rectanlge(widht: 30, heihgt: 40) }"
    assert mended(text) == "drawing d { r = rectangle(width: 30, height: 40) }"


def test_nothing_is_begun_when_the_time_is_over() -> None:
    text = "solid s { c = cirlce(radius: 3) }"
    settings = Settings()
    hurried = replace(settings, building=replace(settings.building, seconds=0.0))
    assert mend(SourceFile("part.aidl", text), settings=hurried).source.text == text
