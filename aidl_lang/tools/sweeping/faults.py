"""Diagnostics as they are passed between processes: without their sources."""

from __future__ import annotations

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.processes import Limit
from aidl_lang.common.records import record


@record()
class Fault:
    """A diagnostic of a compile without its sources.

    text   the source text at its place, in one line
    file   the file of its place, with its line; None without a place
    """

    code: str
    message: str
    label: str = ""
    text: str = ""
    file: str | None = None
    line: int | None = None

    @property
    def is_error(self) -> bool:
        return self.code.startswith("E")

    @property
    def place(self) -> tuple[str, str | None, int | None]:
        """Returns the key by which it is recognised at another value."""
        return self.code, self.file, self.line


BROKEN = {
    Limit.TIME: "the program takes longer than a compile may",
    Limit.DEATH: "the program ends the process that compiles it",
    Limit.MEMORY: "the program needs more memory than there is for it",
}


def limit_fault(limit: Limit) -> Fault:
    """Returns what there is to say of a program that met a limit."""
    return Fault("E0603", BROKEN[limit])


def fault(diagnostic: Diagnostic) -> Fault:
    """Returns a diagnostic without its sources."""
    span = diagnostic.span
    if span is None:
        return Fault(diagnostic.code, diagnostic.message, diagnostic.label)
    return Fault(
        diagnostic.code,
        diagnostic.message,
        diagnostic.label,
        span.one_line,
        span.source.name,
        span.line,
    )
