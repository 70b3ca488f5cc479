"""How long anything may take that is done with a drawing: working it out, measuring it, comparing it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from aidl_lang.common.cancelling import OutOfTime, limited_to
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.source import Span


class TooLongError(ValueError):
    """What is done with a drawing takes longer than it may; the diagnostic says what that is, and what of the
    program is to blame where that is known.
    """

    def __init__(self, doing: str, seconds: float, span: Span | None = None, label: str = "") -> None:
        self.diagnostic = Diagnostic(
            "E0805",
            f"{doing} what this program says takes more than {seconds:g} seconds",
            span,
            label,
            hints=("it has too many curves, or too many that cross; the limit is a setting of the API",),
        )
        super().__init__(self.diagnostic.message)


@contextmanager
def within(seconds: float, doing: str) -> Iterator[None]:
    """Raises TooLongError where the work takes more than so much of the processor's time; `doing` is what is
    done, as in `drawing`.
    """
    try:
        with limited_to(seconds):
            yield
    except _Blamed as late:
        raise TooLongError(doing, seconds, late.span, late.label) from None
    except OutOfTime:
        raise TooLongError(doing, seconds) from None


class _Blamed(OutOfTime):
    """The time ran out in work on a part of the program."""

    def __init__(self, span: Span, label: str) -> None:
        super().__init__()
        self.span, self.label = span, label


@contextmanager
def blaming(span: Callable[[], Span | None], label: str) -> Iterator[None]:
    """Work on a part of the program, which is named where the time runs out meanwhile; of parts within others
    the innermost.
    """
    try:
        yield
    except _Blamed:
        raise
    except OutOfTime:
        if (found := span()) is None:
            raise
        raise _Blamed(found, label) from None
