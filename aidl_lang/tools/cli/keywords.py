"""The options of `aidl compile` as the keywords of Python's `Model.save`."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean, ticked
from aidl_lang.tools.cli.options import add_drawing, add_strict, add_variant
from aidl_lang.tools.cli.report import UseError

if TYPE_CHECKING:
    from aidl_lang.compiled import Compiled
    from aidl_lang.export import Options

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
    from aidl_lang.tools.cli.build import options

    parser, defaults = _parser()
    known = sorted(defaults)
    words = [
        word
        for name, value in given.items()
        if value is not None
        for word in _words(_known(name, known), value, is_flag=defaults[name] is False)
    ]
    try:
        arguments = parser.parse_args(words)
    except argparse.ArgumentError as reason:
        name = (reason.argument_name or "").lstrip("-").replace("-", "_")
        raise _refused(f"`{name}`: {reason.message}") from None
    try:
        return Asked(options(arguments, compiled), arguments.format, arguments.best_effort)
    except UseError as reason:
        raise AidlError(reason.diagnostic) from None


def said(arguments: argparse.Namespace) -> list[str]:
    """Returns the options that say how a drawing is made, as far as they are not the default, as the command
    line has them.
    """
    _, defaults = _parser(add_variant, add_strict)
    asked = {name: getattr(arguments, name) for name in sorted(defaults) if name != "timings"}
    return [
        word
        for name, value in asked.items()
        if value != defaults[name]
        for word in _words(
            name, sorted(value) if isinstance(value, frozenset) else value, is_flag=defaults[name] is False
        )
    ]


def _parser(
    *more: Callable[[argparse.ArgumentParser], None],
) -> tuple[argparse.ArgumentParser, dict[str, Any]]:
    """Returns a parser for the options of a drawing, and their defaults by name."""
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
    raise _refused(f"there is no option `{name}`", *hints)


def _refused(message: str, *hints: str) -> AidlError:
    return AidlError(Diagnostic("E0925", message, hints=hints))


def _words(name: str, value: object, *, is_flag: bool) -> list[str]:
    """Returns an option as the command line has it."""
    option = f"--{name.replace('_', '-')}"
    if is_flag != isinstance(value, bool):
        has = "is on or off: `True` or `False`" if is_flag else "has a value, and is not on or off"
        raise _refused(f"`{name}` {has}")
    if is_flag:
        return [option] if value else []
    return [f"{option}={_text(name, value)}"]


def _text(name: str, value: object) -> str:
    """Returns a value as the command line has it."""
    if isinstance(value, str | Path):
        return str(value)
    if isinstance(value, int | float):
        return f"{Decimal(repr(float(value) if isinstance(value, float) else int(value))):f}"
    if isinstance(value, Iterable):
        items = list(value)
        return ("," if all(isinstance(each, str) for each in items) else "x").join(
            _text(name, each) for each in items
        )
    raise _refused(f"`{name}` takes numbers and texts, not `{type(value).__name__}`")
