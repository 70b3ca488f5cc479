"""The command `aidl`: one module per verb, and here what they share at the door.

Whatever costs time to import is imported inside the verb that needs it, so that `aidl --help` is quick.
Exit codes: 0 done, 1 the program is wrong or does not solve, 2 wrong use, 130 interrupted.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from io import TextIOWrapper

from aidl_lang.cli import (
    check,
    compile,
    diff,
    doc,
    eval,
    explain,
    fmt,
    generate,
    grammar,
    guide,
    lsp,
    mcp,
    measure,
    new,
    params,
    preview,
    report,
    show,
    tool_schema,
    watch,
)
from aidl_lang.drawing_time import TooLongError
from aidl_lang.version import __version__

INTERRUPTED = 130
BROKEN_PIPE = 141

_VERBS = (
    compile,
    check,
    show,
    measure,
    diff,
    fmt,
    params,
    doc,
    guide,
    grammar,
    explain,
    watch,
    preview,
    new,
    generate,
    lsp,
    mcp,
    tool_schema,
    eval,
)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code; wrong use of options raises `SystemExit(2)`."""
    # Threads cost more than they bring for matrices of the size of a part; numpy asks when it is loaded.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    _keep_writing()
    try:
        arguments = _parser().parse_args(argv)
        code: int = arguments.run(arguments)
        sys.stdout.flush()
    except report.UseError as reason:
        report.show([reason.diagnostic])
        return 2
    except TooLongError as reason:
        report.show([reason.diagnostic])
        return report.exit_code([reason.diagnostic])
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        _forget_output()
        return BROKEN_PIPE
    return code


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="aidl",
        description="AIDL: a text language for 2D CAD. Say relationships, get a constraint-solved drawing.",
        epilog="`aidl VERB --help` tells more. Exit codes: 0 done, 1 the program is wrong or does not solve, "
        "2 wrong use.",
    )
    parser.add_argument("--version", action="version", version=f"aidl {__version__}")
    verbs = parser.add_subparsers(title="verbs", metavar="VERB", required=True)
    for verb in _VERBS:
        verb.register(verbs)
    return parser


def _keep_writing() -> None:
    """Characters that the terminal's encoding lacks are written as escapes instead of raising."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _forget_output() -> None:
    """The reader has gone: let the flush at exit write to nowhere."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
