"""`aidl diff`: what moved, turned, grew, appeared and vanished between two versions of a program."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, exit_code, say, show
from aidl_lang.tools.cli.options import add_params, add_pixels, flag, value

if TYPE_CHECKING:
    from aidl_lang.common.source import SourceFile
    from aidl_lang.export.comparison import Comparison
    from aidl_lang.pipeline import Compiled

LONGEST = 20.0
"""Seconds of the processor's time for the picture of two versions."""


def register_diff(parser: argparse.ArgumentParser) -> None:
    """`aidl diff`: what moved, turned, grew, appeared and vanished between two versions of a program."""
    parser.add_argument("before", metavar="BEFORE", help="a program; - reads standard input")
    parser.add_argument(
        "after", nargs="?", metavar="AFTER", help="another; without it BEFORE with the params of --to"
    )
    parser.add_argument(
        "-o", "--output", action="append", default=[], metavar="OUT", help="draw both over each other"
    )
    value(parser, "--format", "SUFFIX", "format of outputs whose name does not tell it")
    add_params(parser)
    add_params(parser, "--from", "params_before", "the same for BEFORE alone")
    add_params(parser, "--to", "params_after", "the same for AFTER alone")
    add_pixels(parser)
    flag(parser, "--json", "print the differences as JSON")
    flag(parser, "--exit-code", "exit with 1 if there is a difference")
    flag(parser, "--best-effort", "compare how far the solver came even if it did not solve")
    parser.set_defaults(run=run_diff)


def run_diff(arguments: argparse.Namespace) -> int:
    outputs = [(name, _suffix(name, arguments)) for name in arguments.output]
    on_standard = sum(name == files.STANDARD for name, _ in outputs)
    if on_standard + arguments.json > 1:
        raise UseError("E0914", "2 files do not fit on standard output", "name a file with -o")
    comparison = _comparison(arguments)
    if isinstance(comparison, int):
        return comparison
    _draw(comparison, outputs, arguments.pixels)
    if arguments.json:
        import json

        print(json.dumps(comparison.to_dict(), indent=1, ensure_ascii=False))
    elif on_standard:
        say(str(comparison))
    else:
        print(comparison)
    return int(arguments.exit_code and not comparison.is_equal)


def _suffix(name: str, arguments: argparse.Namespace) -> str:
    from aidl_lang.export import PICTURES

    files.require_directory(name)
    own = "" if name == files.STANDARD else Path(name).suffix.lower()
    said = (
        f".{arguments.format.lower().lstrip('.')}" if arguments.format else ".svg" * (name == files.STANDARD)
    )
    for suffix in (own, said):
        if suffix in PICTURES:
            return suffix
    asked = (said or own).lstrip(".")
    message = (
        f"differences cannot be drawn as `{asked}`" if asked else f"the name `{name}` does not tell a format"
    )
    raise UseError("E0905", message, f"formats: {', '.join(sorted(s.lstrip('.') for s in PICTURES))}")


def _comparison(arguments: argparse.Namespace) -> Comparison | int:
    """Returns the comparison, or the exit code if a side is wrong, which has been reported."""
    names = arguments.before, arguments.after or arguments.before
    if arguments.after is None and not (arguments.params_before or arguments.params_after):
        raise UseError(
            "E0922",
            f"there is nothing to compare `{names[0]}` with",
            "name a second program, or say what differs, as in `--to width=200`",
        )
    sources = {name: files.read(name) for name in dict.fromkeys(names)}
    versions: list[Compiled] = []
    code = 0
    for name, own in zip(names, (arguments.params_before, arguments.params_after), strict=True):
        compiled = _compiled(name, sources[name], dict(arguments.params) | dict(own))
        may_be_used = compiled.ok or arguments.best_effort
        if may_be_used and compiled.model is not None and compiled.drawing is not None:
            versions.append(compiled)
        else:
            show([*compiled.errors, _refusal(name, compiled)], quiet=True)
            code = max(code, exit_code(compiled.errors), 1)
    return code or versions[0].compared(versions[1])


def _compiled(name: str, source: SourceFile, params: Mapping[str, str]) -> Compiled:
    from aidl_lang import pipeline

    return pipeline.compile(source, files.world(name), params=params)


def _refusal(name: str, compiled: Compiled) -> Diagnostic:
    if compiled.drawing is None:
        return Diagnostic("E0922", f"`{name}` cannot be compared: it does not compile")
    what = "its constraints do not solve" if compiled.status != "solved" else "an assertion in it fails"
    return Diagnostic(
        "E0922", f"`{name}` cannot be compared: {what}", hints=("`--best-effort` compares it as it is",)
    )


def _draw(comparison: Comparison, outputs: list[tuple[str, str]], pixels: int) -> None:
    if not outputs:
        return
    from aidl_lang.common.drawing_time import within
    from aidl_lang.export import Options, render
    from aidl_lang.export.comparison.picture import overlay

    with within(LONGEST, "drawing the differences in"):
        picture = overlay(comparison)
        made = [(name, render(picture, suffix, Options(pixels=pixels))) for name, suffix in outputs]
    files.require_unread(name for name, _ in made)
    for name, data in made:
        files.write(name, data)
        if name != files.STANDARD:
            say(f"{name}: drawn")
