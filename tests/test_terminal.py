"""What terminals are shown: the choice of a protocol, and each taken apart by a reader of its own."""

from __future__ import annotations

import base64
import io
import re

import numpy as np
import pytest
from PIL import Image

from aidl_lang.tools.terminal import (
    CELL,
    Cell,
    Label,
    Screen,
    cells,
    fit,
    has_true_colour,
    kitty,
    plausible,
    protocol,
    sixel,
    text,
    written,
)

RED, BLUE, WHITE = (255, 0, 0), (0, 0, 255), (255, 255, 255)


def png(pixels: np.ndarray) -> bytes:
    data = io.BytesIO()
    Image.fromarray(pixels.astype(np.uint8)).save(data, "PNG")
    return data.getvalue()


def halves(width: int = 40, height: int = 26) -> np.ndarray:
    """Red on the left, blue on the right, the last row white."""
    pixels = np.zeros((height, width, 3))
    pixels[:, : width // 2], pixels[:, width // 2 :], pixels[-1] = RED, BLUE, WHITE
    return pixels


ENVIRONMENTS = """
kitty: TERM=xterm-kitty | TERM=xterm-ghostty | TERM=xterm-256color KITTY_WINDOW_ID=1
iterm: TERM=xterm-256color TERM_PROGRAM=iTerm.app | TERM=xterm-256color TERM_PROGRAM=WezTerm
iterm: TERM=xterm-256color LC_TERMINAL=iTerm2
sixel: TERM=foot | TERM=foot-extra | TERM=mlterm | TERM=xterm-sixel
blocks: TERM=xterm-256color | TERM=xterm-256color TERM_PROGRAM=vscode
blocks: TERM=xterm-256color TERM_PROGRAM=Apple_Terminal |
blocks: TERM=tmux-256color KITTY_WINDOW_ID=1 | TERM=screen.xterm-256color LC_TERMINAL=iTerm2
blocks: TERM=xterm-kitty TMUX=/tmp/t,1,0 | TERM=foot STY=1.pts
blocks: TERM=xterm-256color KITTY_WINDOW_ID=1 VTE_VERSION=7000 | TERM=alacritty KITTY_WINDOW_ID=1
blocks: TERM=xterm-256color KITTY_WINDOW_ID=1 TERM_PROGRAM=vscode
"""
"""What is inherited from the terminal around does not count in a multiplexer, nor in another terminal."""


@pytest.mark.parametrize("line", ENVIRONMENTS.strip().splitlines())
def test_the_protocol_follows_from_the_environment(line: str):
    expected, _, environments = line.partition(": ")
    for environment in environments.split("|"):
        variables = dict(each.split("=") for each in environment.split())
        assert protocol(variables, "utf-8", is_terminal=True, has_colour=True) == expected


def test_without_colour_or_letters_less_is_shown():
    kitty_terminal = {"TERM": "xterm-kitty"}
    assert protocol(kitty_terminal, "utf-8", is_terminal=True, has_colour=False) == "braille"
    assert protocol(kitty_terminal, "utf-8", is_terminal=False, has_colour=True) == "blocks"
    assert protocol({}, "latin-1", is_terminal=True, has_colour=True) == "ascii"
    assert protocol({}, "ascii", is_terminal=False, has_colour=False) == "ascii"


def test_true_colour_is_used_where_it_is_promised():
    assert has_true_colour({"COLORTERM": "truecolor"})
    assert not has_true_colour({"TERM": "xterm-256color"})
    assert not has_true_colour({"COLORTERM": "truecolor", "STY": "1.pts"})


def test_kitty_is_given_the_file_in_chunks():
    data = png(np.random.default_rng(1).integers(0, 256, (60, 90, 3)))
    sent = kitty(data, 30, 10)
    chunks = re.findall(r"\x1b_G([^;]*);([^\x1b]*)\x1b\\", sent)
    assert "".join(f"\x1b_G{head};{body}\x1b\\" for head, body in chunks) == sent
    assert len(chunks) > 2
    assert all(len(body) <= 4096 for _, body in chunks)
    assert all(len(body) % 4 == 0 for _, body in chunks)
    assert {"a=T", "f=100", "c=30", "r=10", "q=2", "m=1"} == set(chunks[0][0].split(","))
    assert [head.rpartition("m=")[2] for head, _ in chunks] == ["1"] * (len(chunks) - 1) + ["0"]
    assert base64.b64decode("".join(body for _, body in chunks)) == data


def decoded_sixel(sent: str) -> np.ndarray:
    """The pixels of a sixel picture, by the rules of the VT340."""
    width, height, body = re.fullmatch(r'\x1bP0;1;0q"1;1;(\d+);(\d+)(.*)\x1b\\', sent, re.DOTALL).groups()
    pixels = np.full((int(height) + 6, int(width), 3), -1.0)
    colours: dict[int, list[float]] = {}
    x = y = 0
    for token in re.finditer(r"#(\d+);2;(\d+);(\d+);(\d+)|#(\d+)|!(\d+)(.)|([$\-])|([?-~])", body):
        number, r, g, b, chosen, count, run, move, single = token.groups()
        if number:
            colours[int(number)] = [2.55 * int(part) for part in (r, g, b)]
        elif chosen:
            colour = colours[int(chosen)]
        elif move:
            x, y = 0, y + 6 * (move == "-")
        else:
            bits = ord(run or single) - 63
            stop = x + int(count or 1)
            for row in range(6):
                if bits >> row & 1:
                    pixels[y + row, x:stop] = colour
            x = stop
    assert (pixels[int(height) :] == -1).all()
    return pixels[: int(height)]


@pytest.mark.parametrize("size", [(40, 26), (1, 1), (7, 6), (300, 5)])
def test_sixel_has_every_pixel(size: tuple[int, int]):
    pixels = halves(*size)
    assert np.abs(decoded_sixel(sixel(png(pixels))) - pixels).max() < 3


def test_blocks_have_two_pixels_each():
    pixels = np.zeros((4, 2, 3))
    pixels[0], pixels[1:] = RED, BLUE
    (upper, _), (lower, _) = cells("blocks", png(pixels), 2, 2)
    assert upper == Cell("▀", RED, BLUE)
    assert lower == Cell(" ", None, BLUE)


def test_labels_do_not_touch_nor_leave_the_grid():
    grid = [[Cell(".")] * 12 for _ in range(2)]
    labels = [
        Label("one", 1, 0, "start", RED),
        Label("two", 4, 0, "start", RED),
        Label("six", 9, 0, "end", RED),
        Label("far out", 8, 1, "start", RED),
        Label("⌀8", 6, 1, "middle", RED),
    ]
    shown = text(written(grid, labels))
    assert shown == ".one..six...\n.....⌀8.....\n"
    assert "D8" in text(written(grid, labels, only_ascii=True))


@pytest.mark.parametrize(
    ("width", "height", "expected"),
    [(100, 100, (48, 24)), (100, 1, (80, 1)), (1, 100, (1, 24)), (1e9, 1e-9, (80, 1)), (160, 48, (80, 12))],
)
def test_pictures_fill_the_screen_in_their_proportions(width: float, height: float, expected):
    """Cells are twice as high as wide."""
    extent = fit(width, height, Screen(80, 24))
    assert (extent.columns, extent.rows) == expected
    assert extent.pixels == (8 * expected[0], 16 * expected[1])


def test_cells_that_cannot_be_are_not_believed():
    assert plausible(9, 18) == (9, 18)
    assert plausible(0, 0) == CELL
    assert plausible(100, 10) == CELL
