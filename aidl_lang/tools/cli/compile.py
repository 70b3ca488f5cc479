"""`aidl compile`: a program in, drawings out."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from aidl_lang.tools.cli.build import build
from aidl_lang.tools.cli.options import add_drawing, add_program, add_strict, add_variant
from aidl_lang.tools.cli.report import say, show

if TYPE_CHECKING:
    from aidl_lang.solver.solution import StageReport

_MOST_MOTIONS = 6
"""Most lines about remaining motions."""


def register(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    add_drawing(parser)
    add_variant(parser)
    add_strict(parser)
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")
    parser.add_argument("--timings", action="store_true", help="tell how long each stage took")
    parser.add_argument(
        "--trace-solve", action="store_true", help="tell which structures were solved in which stages"
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    outcome = build(arguments)
    told = outcome.compiled.errors if arguments.quiet else outcome.compiled.diagnostics
    show([*told, *outcome.notes], arguments.quiet)
    if arguments.trace_solve:
        _show_stages(outcome.compiled.stages)
    if arguments.timings:
        _show_timings(outcome.compiled.timings)
    if not arguments.quiet:
        say(outcome.line(arguments.file))
        for sentence in outcome.motions(_MOST_MOTIONS):
            say(f"  {sentence}")
    return outcome.code


def _show_stages(stages: Sequence[tuple[str, StageReport]]) -> None:
    """Prints one line for each stage tried, in order: a parent comes after its children."""
    width = max((len(path) for path, _ in stages), default=0)
    width = max(width, len("structure"))
    say(f"{'structure':<{width}}  {'stage':<16}{'unknowns':>9}{'rows':>6}")
    for path, stage in stages:
        result = "solved" if stage.succeeded else "not enough"
        say(f"{path:<{width}}  {stage.stage:<16}{stage.unknowns:>9}{stage.rows:>6}  {result}")
    if not stages:
        say("nothing to solve: every constraint holds as written")


def _show_timings(timings: Mapping[str, float]) -> None:
    for stage, seconds in [*timings.items(), ("total", sum(timings.values()))]:
        say(f"{stage:<12}{1000 * seconds:>9.1f} ms")
