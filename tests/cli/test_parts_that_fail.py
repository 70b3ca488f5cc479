"""What would spoil a part is told by `check` and by `compile`, with the cure."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.commands import Result

Aidl = Callable[..., Result]

MEDAL = """\
@thickness(3mm)
solid medal {
    disc = circle(center: origin, diameter: 80)
    construction way = arc(center: origin, radius: 30, start_angle: 200deg, end_angle: 340deg)
    drawing marks {
        words = text("Forest run of the year, height: 5", along: way, height: 6)
    }
}
"""
STAR = """\
@thickness(3mm)
solid medal {
    disc = circle(center: origin, diameter: 80)
    hole eye { rim = circle(center: origin, radius: 15) }
    drawing marks { rays = star(center: origin, points: 5, outer_radius: 45, inner_radius: 20) }
}
"""
SPLIT = """\
solid plate {
    body = rectangle(center: origin, width: 100, height: 40)
    hole slot { rim = rectangle(center: fixed((10, 0)), width: 10, height: 50) }
}
"""


@pytest.fixture
def told(aidl: Aidl, folder: Path) -> Callable[[str], str]:
    """What `check` says of a program, which `compile` says, too."""

    def run(text: str) -> str:
        (folder / "p.aidl").write_text(text)
        checked = aidl("check", "p.aidl").err
        compiled = aidl("compile", "p.aidl", "-o", "p.svg").err
        assert [line for line in compiled.splitlines() if line.startswith("warning")] == [
            line for line in checked.splitlines() if line.startswith("warning")
        ]
        return checked

    return run


def test_a_text_longer_than_its_arc(told: Callable[[str], str], aidl: Aidl, folder: Path) -> None:
    found = told(MEDAL)
    assert (
        "warning[W0761]: this text is 130.4 mm long, and the way along which it is written 73.3 mm" in found
    )
    assert "= hint: letters of 3.37 mm fit: `height: 3.37`" in found
    assert 'text("Forest run of the year, height: 5", along: way, height: 3.37)' in found
    assert told(MEDAL.replace("height: 6)", "height: 3.37)")) == "p.aidl: no mistakes found\n"
    # Around a whole circle it may go all around, and no further.
    ring = MEDAL.replace("arc(", "circle(").replace(", start_angle: 200deg, end_angle: 340deg", "")
    assert told(ring) == "p.aidl: no mistakes found\n"
    assert "W0761" in told(ring.replace("height: 6)", "height: 12)"))
    # The size that is solved counts, not the one that is written.
    grown = MEDAL.replace("radius: 30", "radius: guess(30)").replace(
        "    drawing", "    constrain way.radius == 60\n    drawing"
    )
    assert "W0761" not in told(grown)


def test_a_hole_that_leaves_a_part_in_pieces(told: Callable[[str], str]) -> None:
    found = told(SPLIT)
    assert "warning[W0762]: solid `plate` falls into 2 pieces: `plate.slot` cuts through it" in found
    assert "what is left measures 55 × 40 mm, 35 × 40 mm" in found
    assert "= hint: if that is meant, say so: `@detached` before `plate`" in found
    fine = (
        SPLIT.replace("height: 50", "height: 30"),
        "@detached " + SPLIT,
        SPLIT.replace(
            "height: 50) }", "height: 50) solid bridge { b = square(center: (10, 0), size: 12) } }"
        ),
    )
    for text in fine:
        assert "W0762" not in told(text)


PLATE = """
solid plate {
    body = rectangle(center: origin, width: 60, height: 20)
    drawing title { word = text("AIDL", center: (0, 0), height: 6) }
}
"""


def test_letters_that_reach_out_of_their_solid(told: Callable[[str], str]) -> None:
    found = told(PLATE.replace('"AIDL"', '"WIDER THAN IT"').replace("width: 60", "width: 40"))
    assert "warning[W0763]: `plate.title.word` reaches 11.63 mm out of `plate`" in found


def test_a_drawing_that_reaches_out_of_its_part(told: Callable[[str], str]) -> None:
    found = told(STAR)
    assert "warning[W0763]: `medal.marks.rays` reaches 5 mm out of `medal`, on which it is engraved" in found
    assert "= hint: or have it end at the edge: `@clip(medal)` before the drawing" in found
    fine = (
        STAR.replace("45", "39"),
        STAR.replace("    drawing", "    @clip(medal) drawing"),
        STAR.replace("@thickness(3mm)\n", ""),  # a picture, and no part
        PLATE,
        PLATE.replace("(0, 0)", "(0, 30)"),  # a title beside it
    )
    for text in fine:
        assert "W0763" not in told(text)
