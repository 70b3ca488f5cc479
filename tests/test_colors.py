"""The functions of colours, beside the same worked out another way."""

from __future__ import annotations

import colorsys

from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.common.colors import COLOR_NAMES, css_color, rgb
from tests.amount import tries
from tests.compiled import compiled as compiled_program

NAMES = sorted(COLOR_NAMES)
SHARES = st.integers(0, 20).map(lambda k: k / 20)


def drawn(color: str) -> tuple[int, int, int]:
    """Returns the colour that an expression gives a part."""
    found = compiled_program(f"@color({color}) solid s {{ rim = circle(radius: 5) }}")
    assert found.drawing is not None, [d.message for d in found.diagnostics]
    style = found.drawing.styles["s"]
    assert style.color is not None
    return rgb(style.color)


def near(one: tuple[int, ...], other: tuple[float, ...]) -> bool:
    return all(abs(a - b) <= 1 for a, b in zip(one, other, strict=True))


@given(st.integers(-360, 720), SHARES, SHARES)
@tries(40)
def test_hsl_is_what_python_makes_of_it(hue: int, saturation: float, lightness: float) -> None:
    red, green, blue = colorsys.hls_to_rgb(hue % 360 / 360, lightness, saturation)
    made = drawn(f"hsl({hue}deg, {saturation}, {lightness})")
    assert near(made, (255 * red, 255 * green, 255 * blue))


@given(st.integers(0, 720), st.integers(2, 100), st.integers(2, 100))
@tries(40)
def test_hsl_in_per_cent_and_as_css_writes_it_are_the_same(hue: int, saturation: int, lightness: int) -> None:
    shares = drawn(f"hsl({hue}deg, {saturation / 100}, {lightness / 100})")
    assert near(drawn(f"hsl({hue}, {saturation}, {lightness})"), shares)
    assert near(drawn(f'"hsl({hue}, {saturation}%, {lightness}%)"'), shares)
    assert near(drawn(f'"hsl({hue}deg {saturation}% {lightness}%)"'), shares)


def test_rgb_as_css_writes_it_is_what_three_numbers_are() -> None:
    assert drawn('"rgb(200, 30, 7)"') == drawn('"RGB( 200 30 7 )"') == (200, 30, 7)
    for wrong in ("rgb(300, 0, 0)", "hsl(9, 120%, 5%)", "rgba(1, 1, 1, 1)", "rgb(1, 1)"):
        assert css_color([wrong]) is None


@given(st.sampled_from(NAMES), st.sampled_from(NAMES), SHARES)
@tries(40)
def test_mix_lies_on_the_way_from_one_to_the_other(one: str, other: str, share: float) -> None:
    made = drawn(f'mix("{one}", "{other}", {share})')
    wanted = tuple((1 - share) * a + share * b for a, b in zip(rgb(one), rgb(other), strict=True))
    assert near(made, wanted)
