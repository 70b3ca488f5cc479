"""`aidl watch`: draw a program again whenever it, or a file beside it that it may read, is saved."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.files import is_data, may_be_read
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.build import build, targets
from aidl_lang.tools.cli.options import add_drawing, add_program, add_strict, add_variant
from aidl_lang.tools.cli.report import UseError, say

if TYPE_CHECKING:
    from aidl_lang.solver.memory import Memory


def register(parser: argparse.ArgumentParser) -> None:
    parser.epilog = (
        "All programs in its folder and below are watched, and the drawings (.svg, .dxf) and fonts that it "
        "reads, so that a change to an import counts too."
    )
    add_program(parser)
    add_drawing(parser)
    add_variant(parser)
    add_strict(parser)
    parser.set_defaults(run=run, timings=False)


def run(arguments: argparse.Namespace) -> int:
    """Runs until interrupted."""
    from watchfiles import watch

    if arguments.file == files.STANDARD:
        raise UseError("E0902", "standard input cannot be watched", "name a file")
    files.read(arguments.file)
    from aidl_lang.solver.memory import Memory

    targets(arguments)

    program, memory = Path(arguments.file).resolve(), Memory()
    read = _once(arguments, memory)
    for changes in watch(program.parent, watch_filter=lambda _, path: may_be_read(path)):
        paths = {Path(path) for _, path in changes}
        # Programs are few; what is written here may be a drawing itself, and starts nothing.
        if any(not is_data(path) for path in paths) or paths & read:
            read = _once(arguments, memory) or read
    return 0


def _once(arguments: argparse.Namespace, memory: Memory) -> frozenset[Path]:
    """Runs once, with one line of report. A file that is gone for a moment does not end the watch. Returns
    the files that were read beside the program; none if it could not be run.
    """
    from aidl_lang.common.render import one_line

    clock = time.strftime("%H:%M:%S")
    try:
        outcome = build(arguments, memory)
    except UseError as reason:
        say(f"{clock} {one_line(reason.diagnostic)}")
        return frozenset()
    errors = outcome.compiled.errors
    more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
    say(f"{clock} {one_line(errors[0])}{more}" if errors else f"{clock} {outcome.line(arguments.file)}")
    return outcome.read
