"""`aidl show`: a preview of the drawing in the terminal."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from typing import TYPE_CHECKING

from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import exit_code, show
from aidl_lang.tools.cli.options import add_look, add_params, add_program, choice, count_to, value
from aidl_lang.tools.terminal import (
    GRAPHICS,
    PROTOCOLS,
    Screen,
    cell_size,
    fit,
    has_true_colour,
    protocol,
)

if TYPE_CHECKING:
    from aidl_lang.export.marks import Picture, Text
    from aidl_lang.tools.terminal import Label

_PROMPT = 2
"""Rows left free: for the command, and for the prompt after it."""
_SAMPLES = 4
"""Pixels drawn per shown pixel, across and down."""


def register_show(parser: argparse.ArgumentParser) -> None:
    """`aidl show`: a preview of the drawing in the terminal."""
    add_program(parser)
    add_params(parser)
    add_look(parser)
    value(parser, "--width", "COLUMNS", "columns to fill at most (default: the terminal)", count_to(1000))
    choice(
        parser,
        "--protocol",
        ("auto", *PROTOCOLS),
        "how to show it (default: auto, the best that the terminal is known for)",
        "auto",
    )


def run_show(arguments: argparse.Namespace) -> int:
    from aidl_lang import pipeline
    from aidl_lang.export import require_sheets
    from aidl_lang.export.job import Job, Options
    from aidl_lang.export.picture import picture

    options = Options(arguments.show, arguments.dimension, arguments.cut, theme=arguments.theme)
    require_sheets(options)
    source, world = files.read(arguments.file), files.world(arguments.file)
    layers = tuple(sorted(arguments.show))
    compiled = pipeline.compile(source, world, params=dict(arguments.params), show=layers)
    show(compiled.diagnostics)
    may_be_shown = compiled.ok or arguments.best_effort
    if may_be_shown and compiled.model is not None and compiled.drawing is not None:
        drawn = picture(Job(compiled.model, compiled.drawing, options=options))
        name = _protocol() if arguments.protocol == "auto" else arguments.protocol
        files.write(files.STANDARD, _shown(drawn, name, _screen(arguments.width)))
    return exit_code(compiled.diagnostics) or int(not compiled.ok)


def _protocol() -> str:
    from aidl_lang.common.render import wants_colour

    return protocol(
        os.environ,
        sys.stdout.encoding,
        is_terminal=sys.stdout.isatty(),
        has_colour=wants_colour(sys.stdout, os.environ),
    )


def _screen(width: int | None) -> Screen:
    """Returns the room for a picture; in a file up to twice as high as `width`."""
    size = shutil.get_terminal_size()
    rows = max(1, size.lines - _PROMPT)
    if sys.stdout.isatty():
        return Screen(min(width or size.columns, size.columns), rows, cell_size(sys.stdout.fileno()))
    return Screen(width or size.columns, width or rows)


def _shown(picture: Picture, name: str, screen: Screen) -> bytes:
    from aidl_lang.export.marks import coarse, framed

    extent = fit(picture.width, picture.height, screen)
    across, down = extent.pixels
    picture = framed(picture, across / down)
    if name not in GRAPHICS:
        return _characters(picture, name, extent)
    from aidl_lang.tools.terminal import iterm, kitty, sixel

    png = _png(coarse(picture, picture.width / across), max(across, down))
    if name == "sixel":
        return f"{sixel(png)}\n".encode()
    return f"{(kitty if name == 'kitty' else iterm)(png, extent.columns, extent.rows)}\n".encode()


def _characters(picture: Picture, name: str, extent: Screen) -> bytes:
    from aidl_lang.export.marks import coarse, outlined, separated
    from aidl_lang.tools.terminal import PIXELS, cells, text, written

    across, down = extent.columns * PIXELS[name][0], extent.rows * PIXELS[name][1]
    picture, texts = separated(picture if name == "blocks" else outlined(picture))
    png = _png(coarse(picture, picture.width / across), _SAMPLES * max(across, down))
    grid = cells(name, png, extent.columns, extent.rows)
    labels = [_label(mark, picture, extent) for mark in texts]
    grid = written(grid, labels, only_ascii=name == "ascii")
    lines = text(grid, true_colour=has_true_colour(os.environ))
    return lines.encode(sys.stdout.encoding, "replace")


def _label(mark: Text, picture: Picture, extent: Screen) -> Label:
    """Returns a text of the picture in cells. A turned one is written level, about its middle."""
    from aidl_lang.common.colors import rgb
    from aidl_lang.tools.terminal import Label

    left, bottom, right, top = mark.box
    edge = {"start": left, "middle": (left + right) / 2, "end": right}
    anchor = "middle" if mark.angle else mark.anchor
    column = (edge[anchor] - picture.box[0]) / picture.width * extent.columns
    row = (picture.box[3] - (bottom + top) / 2) / picture.height * extent.rows
    return Label(mark.text, column, row, anchor, rgb(mark.color))


def _png(picture: Picture, pixels: int) -> bytes:
    from aidl_lang.export import render
    from aidl_lang.export.job import Options

    return render(picture, ".png", Options(pixels=pixels))
