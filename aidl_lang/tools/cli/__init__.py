"""The command `aidl`: the common entry point of its verbs.

Only the verb that is asked for is loaded, and what costs time to import is imported inside it where it is
needed, so that `aidl --help` is quick.
Exit codes: 0 done, 1 the program is wrong or does not solve, 2 wrong use, 74 messages were lost, 130
interrupted.
"""

from __future__ import annotations

import argparse
import atexit
import gc
import os
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from io import BufferedWriter, FileIO, TextIOWrapper
from typing import Any

from aidl_lang.common.diagnostics import AidlError, Diagnostic, TooLongError
from aidl_lang.tools.cli import files
from aidl_lang.version import __version__

INTERRUPTED = 130
BROKEN_PIPE = 141
UNHEARD = 74
"""Exit code where messages were lost, as on a full disk: `EX_IOERR` of sysexits.h."""
_BETWEEN_SEARCHES = 100_000
"""Objects made before cycles among them are sought."""

VERBS = {
    "compile": "draw a program",
    "check": "find mistakes, write nothing",
    "sheet": "put a technical drawing on paper",
    "show": "show the drawing in the terminal",
    "measure": "tell areas, walls, gaps and masses",
    "diff": "tell what differs between two versions",
    "fmt": "format programs",
    "params": "list what -D can set",
    "doc": "tell what a name is, with an example",
    "guide": "print the language on a few pages",
    "grammar": "write the grammar for constrained decoding",
    "explain": "tell what a code means",
    "sweep": "draw many variants, and tell what comes of each",
    "watch": "draw again on every save",
    "preview": "show a program in the browser, and change it there",
    "new": "write a starter program",
    "generate": "have a model write a program",
    "lsp": "serve editors",
    "mcp": "serve the tools to agents",
    "tool-schema": "print the tools for agents as JSON",
    "eval": "measure how models do, over prompts and runs",
}
"""The verbs in the order of the help."""
_TOGETHER = {
    "build": ("compile", "watch", "sheet", "show"),
    "check": ("fmt", "params"),
    "doc": ("guide", "grammar", "explain", "new", "tool-schema"),
    "generate": ("eval",),
    "measure": ("diff",),
    "serving": ("preview", "lsp", "mcp"),
}
"""Modules with the verbs in them; any other verb is in the module of its name."""
_MODULES = {verb: module for module, verbs in _TOGETHER.items() for verb in verbs}
_GREETING = f"""\
AIDL {__version__}: say what the parts are and how they relate, get an exact drawing.

  aidl new part.aidl                     a program to begin with
  aidl preview part.aidl                 see it in the browser, turn its knobs, drag its points
  aidl compile part.aidl -o part.svg     draw it; also .pdf .png .dxf .step .stl .3mf
  aidl doc slot                          what a name means, with an example
  aidl guide                             the language on a few pages

`aidl --help` lists all there is, `aidl VERB --help` tells more of one.
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the command line and returns its exit code; wrong use of options raises SystemExit."""
    # Threads cost more than they save for matrices of the size of a part; numpy reads this when it is loaded.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    _keep_writing()
    _seldom_search()
    try:
        code = _ended(argv)
    except SystemExit:
        if _is_unheard():
            raise SystemExit(UNHEARD) from None
        raise
    return UNHEARD if _is_unheard() else code


def _is_unheard() -> bool:
    return isinstance(sys.stderr, _Messages) and sys.stderr.is_lost


def _ended(argv: Sequence[str] | None) -> int:
    try:
        words = sys.argv[1:] if argv is None else argv
        code = _run(words)
        sys.stdout.flush()
    except AidlError as reason:
        files.show([reason.diagnostic])
        return files.exit_code([reason.diagnostic]) if isinstance(reason, TooLongError) else 2
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        _forget(sys.stdout.fileno())
        return BROKEN_PIPE
    except _OutputError as reason:
        _forget(sys.stdout.fileno())
        files.show([Diagnostic("E0904", f"standard output cannot be written: {reason}")])
        return 2
    return code


def _run(words: Sequence[str]) -> int:
    if not words:
        sys.stdout.write(_GREETING)
        return 0
    try:
        arguments = _parser(words).parse_args(words)
    except SystemExit:  # help was asked for, or needed
        sys.stdout.flush()
        raise
    code: int = arguments.run(arguments)
    return code


class _OutputError(Exception):
    """Raised where standard output takes nothing more, as on a full disk."""


class _Output(FileIO):
    """Standard output, whose failure is told from that of other files."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            raise
        except OSError as error:
            raise _OutputError((error.strerror or str(error)).lower()) from None


def _parser(words: Sequence[str]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="aidl",
        description="AIDL: a text language for 2D CAD. Say relationships, get a constraint-solved drawing.",
        epilog="`aidl VERB --help` tells more. Exit codes: 0 done, 1 the program is wrong or does not solve, "
        "2 wrong use.",
    )
    parser.add_argument("--version", action="version", version=f"aidl {__version__}")
    verbs = parser.add_subparsers(title="verbs", metavar="VERB", required=True)
    for verb in words[:1] if words and words[0] in VERBS else VERBS:
        own = verbs.add_parser(verb, help=VERBS[verb])
        if verb in words:
            register = registering(verb)
            own.description = register.__doc__
            own.set_defaults(run=_of_module("run", verb))
            register(own)
    return parser


def registering(verb: str) -> Callable[[argparse.ArgumentParser], None]:
    """Returns what gives a parser the options of a verb; its docstring describes the verb."""
    register: Callable[[argparse.ArgumentParser], None] = _of_module("register", verb)
    return register


def _of_module(what: str, verb: str) -> Any:
    """Returns a function of the module of a verb; None for one that it does not have."""
    name = verb.replace("-", "_")
    module = import_module(f"aidl_lang.tools.cli.{_MODULES.get(verb, name)}")
    return getattr(module, f"{what}_{name}", None)


def _seldom_search() -> None:
    """Searches garbage seldom: most objects are needed until the command ends, or one of its rounds."""
    gc.set_threshold(_BETWEEN_SEARCHES)
    atexit.unregister(gc.freeze)
    atexit.register(gc.freeze)


class _Messages(TextIOWrapper):
    """Standard error; what it does not take ends nothing, and is told by the exit code."""

    is_lost = False

    def write(self, text: str) -> int:
        try:
            return super().write(text)
        except OSError as error:
            _forget(2)
            if isinstance(error, BrokenPipeError):
                raise
            self.is_lost = True
            return len(text)


def _keep_writing() -> None:
    """Makes standard streams escape characters that the terminal's encoding lacks instead of raising, and
    standard output tell that it failed. What was closed by who runs the command takes all and keeps nothing.
    """
    if sys.stdout is None or sys.stderr is None:
        nowhere = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 (open as long as the command runs)
        sys.stdout, sys.stderr = sys.stdout or nowhere, sys.stderr or nowhere
    elif type(sys.stdout) is TextIOWrapper and sys.stdout.fileno() == 1:
        sys.stdout.flush()
        buffer = BufferedWriter(_Output(sys.stdout.fileno(), "w", closefd=False))
        encoding, by_line = sys.stdout.encoding, sys.stdout.isatty()
        sys.stdout = TextIOWrapper(buffer, encoding, "backslashreplace", line_buffering=by_line)
    if type(sys.stderr) is TextIOWrapper and sys.stderr.fileno() == 2:
        told = BufferedWriter(FileIO(2, "w", closefd=False))
        sys.stderr = _Messages(told, sys.stderr.encoding, "backslashreplace", line_buffering=True)


def _forget(stream: int) -> None:
    """Redirects a stream to nowhere after its reader has gone, for the flush at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
