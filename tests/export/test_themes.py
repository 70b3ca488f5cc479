"""Themes: the look of a picture as a whole."""

from __future__ import annotations

import re

import pytest

from aidl_lang.export.job import Options
from aidl_lang.export.marks import REDUCED, THEMES
from tests.compiled import compiled

PROGRAM = """
assembly lamp {
    @color("gold") solid shade { cone = trapezoid(bottom_width: 40, top_width: 20, height: 20) }
    solid foot { plate = rectangle(center: (0, -14), width: 30, height: 8) }
    @color("crimson") drawing mark { cut = line((0, 0), (5, 0)) }
    constrain foot.below(shade, gap: 0)
}
"""


def svg(**options: object) -> str:
    return compiled(PROGRAM).export(".svg", Options(**options)).decode()  # type: ignore[arg-type]


def colours(text: str) -> set[str]:
    return set(re.findall(r'(?:fill|stroke)="(#\w+|[a-z]+)"', text)) - {"none"}


@pytest.mark.parametrize("name", REDUCED)
def test_dimensions_and_names_are_in_the_theme(name: str) -> None:
    theme = REDUCED[name]
    shown = svg(theme=name, dimension=True, show=frozenset({"names", "points", "bbox"}))
    assert colours(shown) <= {theme.paper, theme.fill, theme.line, "#ffffff"}  # dots have a white rim


@pytest.mark.parametrize("name", REDUCED)
def test_light_and_shade_leave_no_veil_over_the_lines_below(name: str) -> None:
    """What shows through has no fill where all fills are of one colour; its outline stays."""
    program = """
    assembly jar {
        solid body { wall = rectangle(center: fixed((0, 0)), width: 40, height: 30) }
        @opacity(0.4) solid glass { pane = rectangle(center: fixed((0, 0)), width: 20, height: 10) }
        @stroke(none) @opacity(0.3) @color("black")
        solid shade { dark = rectangle(center: fixed((10, 0)), width: 20, height: 30) }
    }
    """
    drawn = compiled(program)
    reduced, coloured = (drawn.export(".svg", Options(theme=theme)).decode() for theme in (name, "colour"))
    assert reduced.count("<path") == coloured.count("<path")  # one less, and the paper
    assert "fill-opacity" in coloured
    assert "fill-opacity" not in reduced


@pytest.mark.parametrize("name", REDUCED)
def test_what_is_shaded_hides_what_is_below_it(name: str) -> None:
    """Shade is left out, and the fill under it stays: else the lines below would show through a tank."""
    tank = "drawing d {{ {} solid tank {{ r = rectangle(center: fixed((0, 0)), width: 20, height: 30) }} }}"
    shown = [
        compiled(tank.format(shade)).export(".svg", Options(theme=name)).decode()
        for shade in ("", "@shade(round)", '@shade("navy")')
    ]
    assert shown[0] == shown[1] == shown[2]
    assert f'fill="{REDUCED[name].fill}" fill-rule="evenodd" stroke="{REDUCED[name].line}"' in shown[0]


@pytest.mark.parametrize("suffix", [".png", ".pdf"])
def test_every_picture_has_every_theme(suffix: str) -> None:
    made = {compiled(PROGRAM).export(suffix, Options(theme=name, pixels=100)) for name in THEMES}
    assert len(made) == len(THEMES)
