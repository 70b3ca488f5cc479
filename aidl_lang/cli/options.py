"""Options that several verbs have in common."""

from __future__ import annotations

import argparse

from aidl_lang.cli import sizes


def add_program(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE", help="the program; - reads standard input")


def add_params(
    parser: argparse.ArgumentParser,
    option: str = "-D",
    name: str = "params",
    help: str = "set a param, by name or by path (part.bolt.size=4)",
) -> None:
    parser.add_argument(
        option, dest=name, action="append", default=[], type=_definition, metavar="NAME=VALUE", help=help
    )


def add_pixels(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--pixels", type=_pixels, default=1600, metavar="N", help="larger side of a PNG (default: 1600)"
    )


def add_look(parser: argparse.ArgumentParser) -> None:
    """The options that say what is seen in a picture."""
    parser.add_argument(
        "--show",
        type=_layers,
        default=frozenset(),
        metavar="LAYERS",
        help="draw these over the picture, separated by commas: names, points, bbox, constraints, dof, plan",
    )
    parser.add_argument("--dimension", action="store_true", help="draw dimensions of what is sized")
    parser.add_argument(
        "--cut", action="store_true", help="the outlines alone, as hairlines: what a cutter follows"
    )
    parser.add_argument(
        "--best-effort", action="store_true", help="draw how far the solver came even if it did not solve"
    )


def add_drawing(parser: argparse.ArgumentParser) -> None:
    """The options that say what to draw and where to put it."""
    parser.add_argument(
        "-o",
        "--output",
        action="append",
        default=[],
        metavar="OUT",
        help="where to write; the suffix tells the format; may be given several times; - is standard output "
        "(default: FILE with .svg)",
    )
    parser.add_argument("--format", metavar="SUFFIX", help="format of outputs whose name does not tell it")
    add_params(parser)
    add_look(parser)
    add_pixels(parser)
    parser.add_argument(
        "--thickness",
        type=_thickness,
        metavar="MM",
        help="thickness of parts without `@thickness`, for STEP, STL and 3MF",
    )
    _add_cutting(parser)


def _add_cutting(parser: argparse.ArgumentParser) -> None:
    """The options for cutters and for printing 1:1."""
    parser.add_argument(
        "--sheet",
        type=sizes.size,
        metavar="SIZE",
        help="lay the parts apart on sheets to cut them from: 600x400, 60x40cm, 24x18in, a3, letter",
    )
    parser.add_argument(
        "--spacing",
        type=sizes.length,
        default=3.0,
        metavar="MM",
        help="between parts on a sheet, and to its edge (default: 3)",
    )
    parser.add_argument(
        "--kerf",
        type=sizes.length,
        default=0.0,
        metavar="MM",
        help="width of the cut: outlines grow by half of it, so that parts keep their size",
    )
    parser.add_argument(
        "--tile",
        type=sizes.size,
        metavar="SIZE",
        help="print 1:1 over several pages of this size: a4, letter",
    )
    parser.add_argument(
        "--overlap",
        type=sizes.length,
        default=10.0,
        metavar="MM",
        help="of neighbouring pages (default: 10)",
    )


def _definition(text: str) -> tuple[str, str]:
    name, equals, value = (part.strip() for part in text.partition("="))
    if not (name and equals and value):
        raise argparse.ArgumentTypeError(f"expected NAME=VALUE, as in width=200, not `{text}`")
    return name, value


def _pixels(text: str) -> int:
    if not text.isdecimal() or not 16 <= int(text) <= 20_000:
        raise argparse.ArgumentTypeError(f"expected a number from 16 to 20000, not `{text}`")
    return int(text)


def _thickness(text: str) -> float:
    try:
        value = float(text.removesuffix("mm"))
    except ValueError:
        value = 0.0
    if not 0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"expected millimetres above 0, as in 3, not `{text}`")
    return value


def _layers(text: str) -> frozenset[str]:
    from aidl_lang.export import SHOW

    layers = [layer.strip() for layer in text.split(",") if layer.strip()]
    for layer in layers:
        if layer not in SHOW:
            raise argparse.ArgumentTypeError(f"there is no `{layer}`; there are {', '.join(SHOW)}")
    return frozenset(layers)
