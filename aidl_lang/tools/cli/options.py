"""Options of the command: shared ones, their values read from words, and as keywords of Python."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean, listed, ticked
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError

if TYPE_CHECKING:
    from aidl_lang.checking.subset import Variant
    from aidl_lang.compiled import Compiled
    from aidl_lang.export.job import Options
    from aidl_lang.export.profiles import Profile
    from aidl_lang.tools.llm.messages import Sampling
    from aidl_lang.tools.llm.providers import Closable, Price


def flag(parser: argparse._ActionsContainer, name: str, help: str) -> None:
    parser.add_argument(name, action="store_true", help=help)


def choice(parser: argparse._ActionsContainer, name: str, choices: Sequence[str], help: str) -> None:
    """Adds an option that is one of some words, of which the first is the default."""
    parser.add_argument(name, choices=choices, default=choices[0], help=help)


def value(
    parser: argparse._ActionsContainer,
    name: str,
    metavar: str,
    help: str,
    type: Callable[[str], Any] = str,
    default: object = None,
    **more: Any,
) -> None:
    """Adds an option with a value; `type` reads it from the word."""
    parser.add_argument(name, type=type, default=default, metavar=metavar, help=help, **more)


def _in_units(what: str) -> Callable[[str], Any]:
    """Returns the function of `units` that reads a length or a size, as argparse wants it."""

    def read(text: str) -> Any:
        from aidl_lang.checking import units

        try:
            return getattr(units, what)(text)
        except ValueError as reason:
            raise argparse.ArgumentTypeError(str(reason)) from None

    return read


length, size = _in_units("length"), _in_units("size")


LONGEST_NESTING = 600
"""Seconds that packing by outlines may take."""


def add_program(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE", help="the program; - reads standard input")


def add_variant(parser: argparse._ActionsContainer) -> None:
    about = "the language, or a subset of it: full (the default), no-hierarchy, no-constraints, paper"
    value(parser, "--variant", "NAME", about, _variant, "full")


def add_strict(parser: argparse._ActionsContainer) -> None:
    flag(parser, "--strict", "refuse what the constraints could only hold by changing what was written")


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
    value(parser, "--pixels", "N", "larger side of a PNG (default: 1600)", count_to(20_000, 16), 1600)


def add_look(parser: argparse.ArgumentParser) -> None:
    about = (
        "draw these over the picture, separated by commas: names, points, bbox, constraints, dof, plan; "
        "with --sheet: names, numbers, list"
    )
    value(parser, "--show", "LAYERS", about, _layers, frozenset())
    flag(parser, "--dimension", "draw dimensions of what is sized")
    flag(parser, "--cut", "the outlines alone, as hairlines: what a cutter follows")
    themes = ("colour", "blueprint", "ink", "cutter")
    about = "the look of all of it: as coloured (the default), white on blue, black on white, or as --cut"
    choice(parser, "--theme", themes, about)
    flag(parser, "--best-effort", "draw how far the solver came even if it did not solve")


def add_outputs(parser: argparse.ArgumentParser, help: str) -> None:
    parser.add_argument("-o", "--output", action="append", default=[], metavar="OUT", help=help)


def add_drawing(parser: argparse.ArgumentParser) -> None:
    add_outputs(
        parser,
        "where to write; the suffix tells the format; may be given several times; - is standard output "
        "(default: FILE with .svg)",
    )
    add_params(parser)
    add_drawing_options(parser)


def add_drawing_options(parser: argparse.ArgumentParser) -> None:
    add = partial(value, parser)
    add("--format", "SUFFIX", "format of outputs whose name does not tell it")
    add_look(parser)
    add_pixels(parser)
    about = "thickness of parts without `@thickness`, for STEP, STL and 3MF"
    thickness = _number(lambda value: 0 < value < 1e9, "millimetres above 0, as in 3", "mm")
    add("--thickness", "MM", about, thickness)
    add(
        "--profile",
        "NAME",
        "colours, layers and order of what a cutter follows: plain, lightburn, glowforge, ponoko, or a "
        "file such as shop.toml",
    )
    about = "lay the parts apart on sheets to cut them from: 600x400, 60x40cm, 24x18in, a3, letter"
    add("--sheet", "SIZE", about, size)
    add("--spacing", "MM", "between parts on a sheet, and to its edge (default: 3)", length, 3.0)
    about = (
        "pack parts on sheets by their outlines, not by their boxes, if that saves material "
        "(default: for 5 seconds)"
    )
    add("--nest", "SECONDS", about, count_to(LONGEST_NESTING), nargs="?", const=5)
    about = "width of the cut: outlines grow by half of it, so that parts keep their size"
    add("--kerf", "MM", about, length, 0.0)
    about = "of the coordinates in an SVG or a DXF: millimetres (the default) or inches"
    choice(parser, "--units", ("mm", "in"), about)
    about = (
        "the kind of a DXF: each outline one polyline of lines and arcs (the default), the same for old "
        "programs, or exact with splines"
    )
    choice(parser, "--dxf", ("arcs", "r12", "splines"), about)
    about = "how far the arcs of a DXF may be from the curves that they stand for (default: 0.01)"
    add("--tolerance", "MM", about, _tolerance, 0.01)
    add("--tile", "SIZE", "print 1:1 over several pages of this size: a4, letter", size)
    add("--overlap", "MM", "of neighbouring pages (default: 10)", length, 10.0)


def add_provider(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("the model")
    add = partial(value, group)
    add(
        "--provider",
        "NAME",
        "openai (or any server that speaks its protocol), anthropic, or exec:COMMAND "
        "(default: what the environment says)",
        str,
        "",
    )
    add("--model", "NAME", "the model (default: $AIDL_MODEL)", str, "")
    add("--base-url", "URL", "of the server, as in http://localhost:11434/v1", str, "")
    add("--seed", "N", "of the reply, for servers that have one", int)
    temperature = _number(lambda value: 0 <= value <= 2, "a number from 0 to 2")
    add("--temperature", "T", "0 is the least random", temperature)
    add("--max-tokens", "N", "of one reply", count_to(1_000_000))
    add(
        "--constrain",
        "SERVER",
        "keep the model to the grammar, at a server of this kind: llama.cpp, sglang or vllm, "
        "or as in vllm:llguidance where that engine decodes",
        _server,
    )
    seconds = _number(lambda value: 0 < value <= 86_400, "seconds above 0 and up to a day", "s")
    add("--timeout", "SECONDS", "how long the model may be silent (default: 600)", seconds, 600.0)
    about = "dollars per million tokens, where the server does not tell the cost (default: $AIDL_PRICE)"
    add("--price", "IN/OUT", about, _price)


def provider(arguments: argparse.Namespace) -> Closable:
    """Returns the model that the options of `add_provider` name. Raises AidlError."""
    from aidl_lang.tools.llm.providers import Connection, Constrained, connect

    names = ("provider", "model", "base_url", "timeout", "price")
    connected = connect(Connection(**{name: getattr(arguments, name) for name in names}))
    return Constrained(connected, arguments.constrain) if arguments.constrain else connected


def sampling(arguments: argparse.Namespace) -> Sampling:
    from aidl_lang.tools.llm.messages import Sampling

    return Sampling(arguments.seed, arguments.temperature, arguments.max_tokens)


def _definition(text: str) -> tuple[str, str]:
    name, equals, value = (part.strip() for part in text.partition("="))
    if not (name and equals):
        raise argparse.ArgumentTypeError(f"expected NAME=VALUE, as in width=200, not `{text}`")
    return name, value


def _variant(text: str) -> Variant:
    from aidl_lang.checking.subset import Variant

    return Variant(_one_of(list(Variant), text))


def _number(fits: Callable[[float], bool], wanted: str, unit: str = "") -> Callable[[str], float]:
    """Returns a parser of numbers that fit, with their unit or without."""

    def read(text: str) -> float:
        try:
            value = float(text.removesuffix(unit))
        except ValueError:
            value = math.nan  # which is in no range
        if not fits(value):
            raise argparse.ArgumentTypeError(f"expected {wanted}, not `{text}`")
        return value

    return read


def _tolerance(text: str) -> float:
    value: float = length(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"expected a length above 0, such as 0.01 or 0.001in, not `{text}`")
    return value


def _layers(text: str) -> frozenset[str]:
    from aidl_lang.export.job import ON_SHEETS, SHOW

    known = dict.fromkeys((*SHOW, *ON_SHEETS))
    return frozenset(_one_of(known, layer.strip()) for layer in text.split(",") if layer.strip())


def count_to(most: int, least: int = 1) -> Callable[[str], int]:
    """Returns a parser of whole numbers from `least` to `most`."""

    def read(text: str) -> int:
        if not text.isdecimal() or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"expected a number from {least} to {most}, not `{text}`")
        return int(text)

    return read


def _one_of(known: Collection[str], text: str) -> str:
    if text not in known:
        raise argparse.ArgumentTypeError(f"there is no `{text}`; there are {', '.join(known)}")
    return text


def _server(text: str) -> str:
    from aidl_lang.tools.llm.providers import SERVERS

    return _one_of(SERVERS, text)


def _price(text: str) -> Price:
    from aidl_lang.tools.llm.providers import Price

    try:
        return Price.parse(text)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"expected dollars per million tokens in and out, as in 2.5/10, not `{text}`"
        ) from None


# --- The options of `aidl compile` as the keywords of Python's `Model.save`.

_NOT_OF_A_FILE = ("file", "output", "params")
"""What the command says otherwise than by keywords: the program, the file, and the knobs."""


class Asked(NamedTuple):
    """What keywords say of a file to be written."""

    options: Options
    format: str | None
    best_effort: bool


def read(given: Mapping[str, object], compiled: Compiled | None = None) -> Asked:
    """Reads keywords as the command line reads its options: `kerf=0.15`, `kerf="0.15mm"`, `sheet="a3"`,
    `sheet=(600, 400)`, `dimension=True`.

    Raises AidlError for an unknown option and for a value that it does not take.
    """
    parser, defaults = _parser()
    asked = {_known(name, sorted(defaults)): value for name, value in given.items() if value is not None}
    try:
        arguments = parser.parse_args(_words(asked, defaults))
    except argparse.ArgumentError as reason:
        name = (reason.argument_name or "").lstrip("-").replace("-", "_")
        raise UseError("E0925", f"`{name}`: {reason.message}") from None
    return Asked(options(arguments, compiled), arguments.format, arguments.best_effort)


def said(arguments: argparse.Namespace) -> list[str]:
    """Returns the options of a drawing that are not the default, as the command line has them."""
    _, defaults = _parser(add_variant, add_strict)
    asked = {name: getattr(arguments, name) for name in sorted(defaults) if name != "timings"}
    return _words({name: value for name, value in asked.items() if value != defaults[name]}, defaults)


def _parser(
    *more: Callable[[argparse.ArgumentParser], None],
) -> tuple[argparse.ArgumentParser, dict[str, Any]]:
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False, exit_on_error=False)
    parser.add_argument("file", nargs="?")
    add_drawing(parser)
    parser.add_argument("--timings", action="store_true")
    for add in more:
        add(parser)
    defaults = vars(parser.parse_args([]))
    return parser, {name: value for name, value in defaults.items() if name not in _NOT_OF_A_FILE}


def _known(name: str, known: list[str]) -> str:
    if name in known:
        return name
    near = nearest(name, known, 1)
    hints = did_you_mean(near) or [f"options are {', '.join(ticked(known))}"]
    raise UseError("E0925", f"there is no option `{name}`", *hints)


def _words(asked: Mapping[str, object], defaults: Mapping[str, object]) -> list[str]:
    """Returns values of options by their names as the words of a command."""
    words = []
    for name, value in asked.items():
        option, is_flag = f"--{name.replace('_', '-')}", defaults[name] is False
        if is_flag != isinstance(value, bool):
            has = "is on or off: `True` or `False`" if is_flag else "has a value, and is not on or off"
            raise UseError("E0925", f"`{name}` {has}")
        if not is_flag:
            words.append(f"{option}={_text(name, value)}")
        elif value:
            words.append(option)
    return words


def _text(name: str, value: object) -> str:
    if isinstance(value, str | Path):
        return str(value)
    if isinstance(value, int | float):
        from decimal import Decimal

        return f"{Decimal(repr(float(value) if isinstance(value, float) else int(value))):f}"
    if isinstance(value, Iterable):
        items = sorted(value) if isinstance(value, frozenset) else list(value)
        return ("," if all(isinstance(each, str) for each in items) else "x").join(
            _text(name, each) for each in items
        )
    raise UseError("E0925", f"`{name}` takes numbers and texts, not `{type(value).__name__}`")


def options(arguments: argparse.Namespace, compiled: Compiled | None = None) -> Options:
    """Returns the options of an export as the command line says them; timings are those of a compile."""
    from aidl_lang.export.job import Options

    said: dict[str, Any] = {
        each.name: getattr(arguments, each.name) for each in fields(Options) if each.name != "timings"
    }
    said["profile"] = profile(arguments.profile)
    return Options(timings=compiled.timings if compiled and arguments.timings else None, **said)


def profile(name: str | None) -> Profile | None:
    if name is None:
        return None
    from aidl_lang.export.profiles import PROFILES, parsed

    if name in PROFILES:
        return PROFILES[name]
    if not (name.endswith(".toml") or Path(name).is_file()):
        told = f"there are {listed(ticked(PROFILES))}; a file is called as in `shop.toml`"
        raise UseError("E0956", f"there is no profile `{name}`", *did_you_mean(nearest(name, PROFILES)), told)
    return parsed(files.read(name).text, Path(name).name)
