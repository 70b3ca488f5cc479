"""How long anything may take that is done with a drawing: working it out, measuring it, comparing it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from aidl_lang.cancelling import OutOfTime, limited_to
from aidl_lang.diagnostics import Diagnostic


class TooLongError(ValueError):
    """What is done with a drawing takes longer than it may; the diagnostic says what that is."""

    def __init__(self, doing: str, seconds: float) -> None:
        self.diagnostic = Diagnostic(
            "E0805",
            f"{doing} what this program says takes more than {seconds:g} seconds",
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
    except OutOfTime:
        raise TooLongError(doing, seconds) from None
