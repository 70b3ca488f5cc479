"""The picture protocols of a terminal, the size of its screen, and pixels in the form of each."""

from __future__ import annotations

import io
import math
import re
from base64 import standard_b64encode
from collections.abc import Iterator, Mapping
from typing import Any

from aidl_lang.common.records import record

# --- The size of a terminal, and of a picture in it.

CELL = (8, 16)
"""Pixels of a cell if the terminal does not tell: rather few, so that nothing outgrows the screen."""
_PLAUSIBLE = (1.4, 3.0)
"""Plausible heights of a cell relative to its width; some terminals report arbitrary sizes."""


@record()
class Screen:
    """Columns and rows that a picture may take, and the pixels of a cell, across and down."""

    columns: int
    rows: int
    cell: tuple[int, int] = CELL


@record()
class Extent:
    """Columns and rows that a picture takes, and the pixels of a cell."""

    columns: int
    rows: int
    cell: tuple[int, int]

    @property
    def pixels(self) -> tuple[int, int]:
        return self.columns * self.cell[0], self.rows * self.cell[1]


def fit(width: float, height: float, screen: Screen) -> Extent:
    """The cells that a picture of these proportions fills: as many as the screen allows, at least one."""
    across, down = screen.cell
    scale = min(screen.columns * across / width, screen.rows * down / height)
    columns = math.ceil(width * scale / across - 1e-9)
    rows = math.ceil(height * scale / down - 1e-9)
    return Extent(min(max(columns, 1), screen.columns), min(max(rows, 1), screen.rows), screen.cell)


def cell_size(descriptor: int) -> tuple[int, int]:
    """Pixels of a cell of the terminal behind a file descriptor, or `CELL`."""
    import struct

    try:
        import fcntl  # not on Windows
        import termios

        told = fcntl.ioctl(descriptor, termios.TIOCGWINSZ, bytes(8))
    except (ImportError, OSError):
        return CELL
    rows, columns, width, height = struct.unpack("HHHH", told)
    return plausible(width // columns, height // rows) if rows and columns else CELL


def plausible(width: int, height: int) -> tuple[int, int]:
    """The size of a cell as a terminal tells it, or `CELL` if that cannot be."""
    least, most = _PLAUSIBLE
    return (width, height) if 3 <= width <= 200 and least * width <= height <= most * width else CELL


# --- PNG as it is, in the envelopes of kitty and of iTerm2.
#
# https://sw.kovidgoyal.net/kitty/graphics-protocol/, https://iterm2.com/documentation-images.html

_CHUNK = 4096


def kitty(png: bytes, columns: int, rows: int) -> str:
    """Returns the picture over so many cells, in chunks. A terminal answers unless told not to (`q=2`), and
    the shell would take the answer for typing.
    """
    text = standard_b64encode(png).decode()
    chunks = [text[k : k + _CHUNK] for k in range(0, len(text), _CHUNK)]
    heads = [f"a=T,f=100,q=2,c={columns},r={rows}"] + ["q=2"] * (len(chunks) - 1)
    more = [1] * (len(chunks) - 1) + [0]
    return "".join(
        f"\x1b_G{head},m={m};{chunk}\x1b\\" for head, m, chunk in zip(heads, more, chunks, strict=True)
    )


def iterm(png: bytes, columns: int, rows: int) -> str:
    """Returns the picture within so many cells."""
    head = f"inline=1;size={len(png)};width={columns};height={rows};preserveAspectRatio=1"
    return f"\x1b]1337;File={head}:{standard_b64encode(png).decode()}\x07"


# --- Sixel: bands of six rows, and in each band a layer for each colour that is in it (DEC VT340).

_COLOURS = 256
_ROWS = 6
_RUN = re.compile(r"(.)\1{3,}")
"""What gets shorter by being counted: `!4x` for `xxxx`."""


def sixel(png: bytes) -> str:
    """The picture in its own pixels, with the 256 colours that suit it best."""
    import numpy as np
    from PIL import Image

    with Image.open(io.BytesIO(png)) as image:
        indexed = image.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
    pixels = np.asarray(indexed)
    height, width = pixels.shape
    used = [int(k) for k in np.unique(pixels)]
    palette = indexed.getpalette() or []
    colours = "".join(
        f"#{k};2;" + ";".join(str(round(part * 100 / 255)) for part in palette[3 * k : 3 * k + 3])
        for k in used
    )
    bands = "-".join("$".join(_layers(pixels[top : top + _ROWS])) for top in range(0, height, _ROWS))
    return f'\x1bP0;1;0q"1;1;{width};{height}{colours}{bands}\x1b\\'


def _layers(band: Any) -> Iterator[str]:
    """Yields for each colour of a band its columns, a bit for each row."""
    import numpy as np

    weights = (1 << np.arange(len(band), dtype=np.uint8))[:, None]
    for colour in np.unique(band):
        bits = ((band == colour) * weights).sum(axis=0, dtype=np.uint8)
        columns = (bits + 63).astype(np.uint8).tobytes().decode().rstrip("?")
        yield f"#{colour}" + _RUN.sub(lambda run: f"!{len(run[0])}{run[1]}", columns)


# --- The picture protocols of a terminal, chosen by its environment.
#
# A terminal that is taken for another fills the screen with garbage, so a protocol is chosen only where a
# terminal names itself and nothing speaks against it. Variables are inherited: in a multiplexer, or in a
# terminal that was started from another one, those of the outer terminal are still there.

GRAPHICS = ("kitty", "iterm", "sixel")
"""Protocols that take pixels; the others take characters."""
PROTOCOLS = (*GRAPHICS, "blocks", "braille", "ascii")

_MULTIPLEXERS = ("TMUX", "STY", "ZELLIJ")
_MULTIPLEXED = ("tmux", "screen")
"""Beginnings of TERM; it crosses a remote shell where variables do not."""

_BY_TERM = (
    ("xterm-kitty", "kitty"),
    ("xterm-ghostty", "kitty"),
    ("foot", "sixel"),
    ("mlterm", "sixel"),
    ("yaft", "sixel"),
)
_BY_PROGRAM = {"kitty": "kitty", "ghostty": "kitty", "WezTerm": "iterm", "iTerm.app": "iterm"}
"""WezTerm follows the protocol of iTerm2 more closely than that of kitty, which can be switched off there."""
_OTHERS = (
    "VTE_VERSION",
    "XTERM_VERSION",
    "KONSOLE_VERSION",
    "ALACRITTY_WINDOW_ID",
    "WT_SESSION",
    "INSIDE_EMACS",
    "VIM_TERMINAL",
    "NVIM",
)
"""Set by terminals that show no pictures, or only if told to."""
_TRUE_COLOUR = ("truecolor", "24bit")


def protocol(environment: Mapping[str, str], encoding: str, *, is_terminal: bool, has_colour: bool) -> str:
    """Returns the best of `PROTOCOLS` for standard output.

    `has_colour` is false where colour is not wanted (NO_COLOR, TERM=dumb); escape codes are not wanted then.
    """
    if not has_colour:
        return _encodable("braille", "\u28ff", encoding)
    found = _graphics(environment) if is_terminal else None
    return found or _encodable("blocks", "▀", encoding)


def has_true_colour(environment: Mapping[str, str]) -> bool:
    """True if colours may be given as red, green and blue; else they are of the 256 of xterm."""
    if environment.get("STY"):
        return False  # GNU screen shows other colours then, whatever the terminal around it says
    return environment.get("COLORTERM") in _TRUE_COLOUR or bool(environment.get("WT_SESSION"))


def _graphics(environment: Mapping[str, str]) -> str | None:
    term, program = environment.get("TERM", ""), environment.get("TERM_PROGRAM", "")
    if any(map(environment.get, _MULTIPLEXERS)) or term.startswith(_MULTIPLEXED):
        return None
    for start, name in _BY_TERM:
        if term.startswith(start):
            return name
    if term.endswith("-sixel"):
        return "sixel"
    is_common = not term or term.startswith(("xterm", "wezterm"))
    if not is_common or any(map(environment.get, _OTHERS)):
        return None
    if program:
        return _BY_PROGRAM.get(program)
    if environment.get("KITTY_WINDOW_ID"):
        return "kitty"
    return "iterm" if environment.get("LC_TERMINAL") == "iTerm2" else None


def _encodable(name: str, sample: str, encoding: str) -> str:
    try:
        sample.encode(encoding)
    except (UnicodeEncodeError, LookupError):
        return "ascii"
    return name
