"""Reports on standard error, and the exit code that follows from diagnostics."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable

from aidl_lang.common.diagnostics import Diagnostic, Severity

_FAMILY_OF_USE = "E09"


class UseError(Exception):
    """Raised for wrong use: a file is missing, a format unknown. The command ends with 2."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(message)
        self.diagnostic = Diagnostic(code, message, hints=hints)

    @classmethod
    def of(cls, diagnostic: Diagnostic) -> UseError:
        """Wraps a diagnostic as an exception."""
        return cls(diagnostic.code, diagnostic.message, *diagnostic.hints)


def show(diagnostics: Iterable[Diagnostic], quiet: bool = False) -> None:
    """Prints diagnostics for a reader, errors only if `quiet`."""
    said = [d for d in diagnostics if not quiet or d.severity is Severity.ERROR]
    if not said:
        return
    import shutil

    from aidl_lang.common.render import TerminalStyle, render, wants_colour

    style = TerminalStyle(wants_colour(sys.stderr, os.environ))
    width = shutil.get_terminal_size((110, 24)).columns
    for diagnostic in said:
        say(render(diagnostic, style, width), end="\n\n" if diagnostic.span else "\n")


def say(line: str, end: str = "\n") -> None:
    """Prints a line about the work; standard output is left to the results."""
    print(line, end=end, file=sys.stderr)


def exit_code(diagnostics: Iterable[Diagnostic]) -> int:
    """Returns 2 if the command was used wrongly, 1 if the program is wrong, else 0."""
    codes = {d.code for d in diagnostics if d.is_error}
    if any(code.startswith(_FAMILY_OF_USE) for code in codes):
        return 2
    return 1 if codes else 0
