"""Pictures in a terminal: its protocol, its size, and pixels in a form that it understands."""

from __future__ import annotations

import io
import math
import re
import struct
import unicodedata
from base64 import standard_b64encode
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from PIL import Image, ImageFilter

from aidl_lang.common.records import record

# --- The size of a terminal, and of a picture in it.

CELL = (8, 16)
"""Pixels of a cell if the terminal does not tell: rather few, so that nothing outgrows the screen."""
_PLAUSIBLE = (1.4, 3.0)
"""Plausible heights of a cell relative to its width; some terminals report arbitrary sizes."""


@record()
class Screen:
    """Columns and rows that a picture may take, or takes, and the pixels of a cell, across and down."""

    columns: int
    rows: int
    cell: tuple[int, int] = CELL

    @property
    def pixels(self) -> tuple[int, int]:
        return self.columns * self.cell[0], self.rows * self.cell[1]


def fit(width: float, height: float, screen: Screen) -> Screen:
    """The cells that a picture of these proportions fills: as many as the screen allows, at least one."""
    across, down = screen.cell
    scale = min(screen.columns * across / width, screen.rows * down / height)
    columns = math.ceil(width * scale / across - 1e-9)
    rows = math.ceil(height * scale / down - 1e-9)
    return Screen(min(max(columns, 1), screen.columns), min(max(rows, 1), screen.rows), screen.cell)


def cell_size(descriptor: int) -> tuple[int, int]:
    """Pixels of a cell of the terminal behind a file descriptor, or `CELL`."""
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
    """Returns the picture over so many cells, in chunks; `q=2`, or the terminal would answer to the shell."""
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
"""Protocols that take pixels; the others take characters: `blocks`, `braille` and `ascii`."""

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
    *"VTE_VERSION XTERM_VERSION KONSOLE_VERSION ALACRITTY_WINDOW_ID WT_SESSION".split(),
    *"INSIDE_EMACS VIM_TERMINAL NVIM".split(),
)
"""Set by terminals that show no pictures, or only if told to."""
_TRUE_COLOUR = ("truecolor", "24bit")


def protocol(environment: Mapping[str, str], encoding: str, *, is_terminal: bool, has_colour: bool) -> str:
    """Returns the best protocol for standard output.

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


# --- Pictures made of characters: grids of cells, lettering in them, and the text that they become.

Colour: TypeAlias = tuple[int, int, int]
"""Red, green and blue, from 0 to 255."""

WHITE: Colour = (255, 255, 255)
_LEVELS = (0, 95, 135, 175, 215, 255)
"""Of the colour cube of xterm."""
_ASCII = {"⌀": "D", "×": "x", "°": "deg", "–": "-", "−": "-", "…": "..", "²": "2", "≤": "<=", "≥": ">="}


class Cell(NamedTuple):
    """A character in front of its paper. Without colours it takes those of the terminal."""

    character: str
    ink: Colour | None = None
    paper: Colour | None = None


Grid: TypeAlias = list[list[Cell]]


@record()
class Label:
    """A line of text in a grid, about `column` and `row`; `anchor` is start, middle or end."""

    text: str
    column: float
    row: float
    anchor: str
    colour: Colour


def written(grid: Grid, labels: Iterable[Label], *, only_ascii: bool = False) -> Grid:
    """Returns the grid with labels in it, except those that would touch an earlier one, or leave the grid."""
    rows = [list(row) for row in grid]
    taken: set[tuple[int, int]] = set()
    for label in labels:
        characters = _characters(label.text, only_ascii)
        start = round(
            label.column - {"start": 0.0, "middle": 0.5, "end": 1.0}[label.anchor] * len(characters)
        )
        row = int(label.row)
        needed = {(row, column) for column in range(start - 1, start + len(characters) + 1)}
        is_inside = 0 <= row < len(rows) and start >= 0 and start + len(characters) <= len(rows[row])
        if not is_inside or taken & needed:
            continue
        taken |= needed
        for column, character in enumerate(characters, start):
            is_coloured = rows[row][column].paper is not None
            rows[row][column] = Cell(character, label.colour, WHITE) if is_coloured else Cell(character)
    return rows


def _characters(text: str, only_ascii: bool) -> list[str]:
    """Returns one character for each column; a wide one is followed by an empty one."""
    if only_ascii:
        text = "".join(_ASCII.get(c, c if c.isascii() else "?") for c in text)
    found: list[str] = []
    for character in unicodedata.normalize("NFC", text):
        if unicodedata.combining(character):
            continue
        found.append(character if character.isprintable() else "?")
        if unicodedata.east_asian_width(character) in "WF":
            found.append("")
    return found


def text(grid: Grid, *, true_colour: bool = True) -> str:
    """Returns the grid as lines. Colours end with each, so that none runs into the margin."""
    return "".join(f"{_line(row, true_colour)}\n" for row in grid)


def _line(row: Sequence[Cell], true_colour: bool) -> str:
    if all(cell.paper is None for cell in row):
        return "".join(cell.character for cell in row).rstrip(" \u2800")
    pieces, ink, paper = [], None, None
    for cell in row:
        codes = []
        if cell.ink != ink and cell.ink is not None and cell.character != " ":
            codes.append(f"38;{_code(cell.ink, true_colour)}")
            ink = cell.ink
        if cell.paper != paper and cell.paper is not None:
            codes.append(f"48;{_code(cell.paper, true_colour)}")
            paper = cell.paper
        pieces += [f"\x1b[{';'.join(codes)}m"] if codes else []
        pieces.append(cell.character)
    return "".join(pieces) + "\x1b[0m"


def _code(colour: Colour, true_colour: bool) -> str:
    return "2;{};{};{}".format(*colour) if true_colour else f"5;{nearest(colour)}"


def nearest(colour: Colour) -> int:
    """Returns the nearest of xterm's 256 colours, without the first 16, which themes change."""
    cube = [min(range(6), key=lambda k: abs(_LEVELS[k] - part)) for part in colour]
    grey = min(max(round((sum(colour) / 3 - 8) / 10), 0), 23)
    choices = [
        (_distance(colour, tuple(_LEVELS[k] for k in cube)), 16 + 36 * cube[0] + 6 * cube[1] + cube[2]),
        (_distance(colour, (8 + 10 * grey,) * 3), 232 + grey),
    ]
    return min(choices)[1]


def _distance(one: Sequence[int], other: Sequence[int]) -> int:
    return sum((a - b) ** 2 for a, b in zip(one, other, strict=True))


# --- Turns pixels into characters: half blocks in colour, dots of braille, and ASCII by shape.

PIXELS = {"blocks": (1, 2), "braille": (2, 4), "ascii": (4, 8)}
"""Pixels of a cell, across and down."""

_DARK = 150
"""Grey below which a dot of braille is set."""
_DOTS = ((1, 8), (2, 16), (4, 32), (64, 128))
"""Bits of the dots of a cell, by row and column (Unicode, Braille Patterns)."""

_STROKES: tuple[tuple[str, tuple[tuple[float, ...], ...]], ...] = (
    (" ", ()),
    ("-", ((0, 3, 4, 3),)),
    ("-", ((0, 4, 4, 4),)),
    ("-", ((0, 5, 4, 5),)),
    ("_", ((0, 6.5, 4, 6.5),)),
    ("_", ((0, 7.5, 4, 7.5),)),
    ('"', ((0, 0.5, 4, 0.5),)),
    ('"', ((1.2, 0, 1.2, 2.5), (2.8, 0, 2.8, 2.5))),
    ("|", ((0.7, 0, 0.7, 8),)),
    ("|", ((2, 0, 2, 8),)),
    ("|", ((3.3, 0, 3.3, 8),)),
    ("/", ((4, 0, 0, 8),)),
    ("\\", ((0, 0, 4, 8),)),
    ("'", ((2, 0, 2, 2.5),)),
    ("`", ((1, 0, 2.5, 2),)),
    (".", ((2, 7, 2, 7),)),
    (",", ((2, 6.5, 1.2, 8),)),
    (":", ((2, 3, 2, 3), (2, 7, 2, 7))),
    ("(", ((3, 0, 1.5, 2.5), (1.5, 2.5, 1.5, 5.5), (1.5, 5.5, 3, 8))),
    (")", ((1, 0, 2.5, 2.5), (2.5, 2.5, 2.5, 5.5), (2.5, 5.5, 1, 8))),
    ("<", ((4, 2, 0.5, 4.5), (0.5, 4.5, 4, 7))),
    (">", ((0, 2, 3.5, 4.5), (3.5, 4.5, 0, 7))),
    ("^", ((0.5, 3, 2, 0), (2, 0, 3.5, 3))),
    ("v", ((0.3, 3, 2, 7.5), (2, 7.5, 3.7, 3))),
    ("+", ((0, 4, 4, 4), (2, 2, 2, 6))),
    ("=", ((0, 3, 4, 3), (0, 5.5, 4, 5.5))),
    ("~", ((0, 4.5, 1.3, 3.5), (1.3, 3.5, 2.7, 4.5), (2.7, 4.5, 4, 3.5))),
    ("x", ((0.3, 3, 3.7, 7.5), (3.7, 3, 0.3, 7.5))),
    ("X", ((0, 0, 4, 8), (4, 0, 0, 8))),
    ("o", ((1.2, 3, 2.8, 3), (3.6, 4, 3.6, 6.5), (2.8, 7.5, 1.2, 7.5), (0.4, 6.5, 0.4, 4))),
    ("L", ((0.7, 0, 0.7, 7.5), (0.7, 7.5, 4, 7.5))),
    ("J", ((3.3, 0, 3.3, 7.5), (3.3, 7.5, 0, 7.5))),
    ("T", ((0, 0.5, 4, 0.5), (2, 0.5, 2, 8))),
    ("#", ((0, 2.5, 4, 2.5), (0, 5.5, 4, 5.5), (1.2, 0, 1.2, 8), (2.8, 0, 2.8, 8))),
)
"""Where the strokes of a character run in a cell that is 4 wide and 8 high, y downwards: x, y to x, y. A
character stands for several places of its strokes, as it is the only one of its kind.
"""
_SOFT = 0.8
"""Standard deviation of the pen, and of the blur of the compared picture."""
_DARKEST = 0.5
"""Darkness of a line one pixel wide after the blur."""


def cells(protocol: str, png: bytes, columns: int, rows: int) -> Grid:
    """Returns the picture stretched over a grid. For braille and ASCII it is black lines on white."""
    across, down = PIXELS[protocol]
    with Image.open(io.BytesIO(png)) as image:
        small = image.convert("RGB").resize((columns * across, rows * down), Image.Resampling.BOX)
    return {"blocks": _blocks, "braille": _braille, "ascii": _ascii}[protocol](small)


def _blocks(image: Any) -> Grid:
    pixels = np.asarray(image).tolist()
    return [
        [
            Cell(" ", None, tuple(lower)) if upper == lower else Cell("▀", tuple(upper), tuple(lower))
            for upper, lower in zip(one, other, strict=True)
        ]
        for one, other in zip(pixels[::2], pixels[1::2], strict=True)
    ]


def _braille(image: Any) -> Grid:
    dark = _tiles(np.asarray(image.convert("L")) < _DARK, 2, 4)
    codes = (dark * np.array(_DOTS)).sum(axis=(2, 3))
    return [[Cell(chr(0x2800 + code)) for code in row] for row in codes.tolist()]


def _ascii(image: Any) -> Grid:
    """Returns for each cell the character that looks most like it."""
    soft = image.convert("L").filter(ImageFilter.GaussianBlur(_SOFT))
    tiles = _tiles(1 - np.asarray(soft) / 255, 4, 8)
    names, shapes = _shapes()
    apart = ((tiles[:, :, None] - shapes) ** 2).sum(axis=(3, 4))
    return [[Cell(names[k]) for k in row] for row in apart.argmin(axis=2).tolist()]


def _tiles(pixels: Any, across: int, down: int) -> Any:
    """Returns pixels by row and column of the cell, then by row and column within it."""
    height, width = pixels.shape
    return pixels.reshape(height // down, down, width // across, across).swapaxes(1, 2)


@cache
def _shapes() -> tuple[str, Any]:
    y, x = np.mgrid[0.5:8, 0.5:4]
    far = np.full_like(x, np.inf)
    apart = [
        np.min([far, *(_distance_to(x, y, *stroke) for stroke in strokes)], axis=0) for _, strokes in _STROKES
    ]
    shapes = _DARKEST * np.exp(-(np.array(apart) ** 2) / (2 * _SOFT**2))
    return "".join(name for name, _ in _STROKES), shapes


def _distance_to(x: Any, y: Any, x0: float, y0: float, x1: float, y1: float) -> Any:
    dx, dy = x1 - x0, y1 - y0
    along = ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy or 1.0)
    along = np.clip(along, 0, 1)
    return np.hypot(x - x0 - along * dx, y - y0 - along * dy)
