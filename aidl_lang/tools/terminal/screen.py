"""The size of a terminal, and of a picture in it."""

from __future__ import annotations

import math
import sys

from aidl_lang.common.records import record

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
    if sys.platform == "win32":
        return CELL
    import fcntl
    import struct
    import termios

    try:
        told = fcntl.ioctl(descriptor, termios.TIOCGWINSZ, bytes(8))
    except OSError:
        return CELL
    rows, columns, width, height = struct.unpack("HHHH", told)
    return plausible(width // columns, height // rows) if rows and columns else CELL


def plausible(width: int, height: int) -> tuple[int, int]:
    """The size of a cell as a terminal tells it, or `CELL` if that cannot be."""
    least, most = _PLAUSIBLE
    return (width, height) if 3 <= width <= 200 and least * width <= height <= most * width else CELL
