"""`aidl compile`: a program in, drawings out."""

from __future__ import annotations

import argparse
from collections.abc import Mapping

from aidl_lang.cli.build import build
from aidl_lang.cli.options import add_drawing, add_program
from aidl_lang.cli.report import say, show


def register(verbs: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = verbs.add_parser("compile", help="draw a program", description=__doc__)
    add_program(parser)
    add_drawing(parser)
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")
    parser.add_argument("--timings", action="store_true", help="tell how long each stage took")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    outcome = build(arguments)
    show(outcome.compiled.diagnostics, arguments.quiet)
    if arguments.timings:
        _show_timings(outcome.compiled.timings)
    if not arguments.quiet:
        say(outcome.line(arguments.file))
    return outcome.code


def _show_timings(timings: Mapping[str, float]) -> None:
    for stage, seconds in [*timings.items(), ("total", sum(timings.values()))]:
        say(f"{stage:<12}{1000 * seconds:>9.1f} ms")
