"""The limit on the time that working out, measuring or comparing a drawing may take."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.running import OutOfTime, limited_to
from aidl_lang.common.source import Span


class TooLongError(AidlError):
    """Work on a drawing takes too long: names it and, if known, the part of the program to blame."""

    def __init__(self, doing: str, seconds: float, span: Span | None = None, label: str = "") -> None:
        super().__init__(
            Diagnostic(
                "E0805",
                f"{doing} what this program says takes more than {seconds:g} seconds",
                span,
                label,
                hints=(
                    "it has too many curves, or too many that cross: fewer copies, or a wider `pitch`, "
                    "take less; the limit is a setting of the API",
                ),
            )
        )


@contextmanager
def within(seconds: float, doing: str) -> Iterator[None]:
    """Raises TooLongError if work takes more processor seconds than these; `doing` names it, as `drawing`."""
    try:
        with limited_to(seconds):
            yield
    except _Blamed as late:
        raise TooLongError(doing, seconds, late.span, late.label) from None
    except OutOfTime:
        raise TooLongError(doing, seconds) from None


class _Blamed(OutOfTime):
    """Raised when the time runs out in work on a known part of the program."""

    def __init__(self, span: Span, label: str) -> None:
        super().__init__()
        self.span, self.label = span, label


@contextmanager
def blaming(span: Callable[[], Span | None], label: str) -> Iterator[None]:
    """Names a part of the program, the innermost of nested ones, to blame if the time runs out in it."""
    try:
        yield
    except _Blamed:
        raise
    except OutOfTime:
        if (found := span()) is None:
            raise
        raise _Blamed(found, label) from None
