"""The diagnostic, one value for terminal, JSON, editor and language model; renderers live apart from it.

Codes are `E`, `W` or `N` (error, warning, note) and four digits whose first two name the family:

    01 syntax    02 names    03 types and arguments    04 validity of references
    05 building the model    06 solving    07 regions and drawings    08 limits    09 files and use

Every code has a page `docs/diagnostics/CODE.md` that shows the mistake and the mended program; the pages are
the registry: `aidl explain` prints them and a test fails when a code and its page do not match.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from enum import StrEnum

from aidl_lang.common.records import record
from aidl_lang.common.running import OutOfTime, limited_to
from aidl_lang.common.source import SourceFile, Span


class Severity(StrEnum):
    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


_SEVERITY = {"E": Severity.ERROR, "W": Severity.WARNING, "N": Severity.NOTE}


@record()
class Label:
    """A place with a few words about it, as "declared here"."""

    span: Span
    text: str = ""


@record()
class Edit:
    """A replacement of the text of `span` (empty for an insertion)."""

    span: Span
    replacement: str


@record()
class Fix:
    """Edits that together mend the program without losing what its author meant.

    A fix that `is_sure` is applied unasked: it keeps the meaning of the program, or mends what can have meant
    nothing else. All others are offered, and applied when somebody chooses them.
    """

    title: str
    edits: tuple[Edit, ...]
    is_sure: bool = False


@record()
class Diagnostic:
    """An error, warning or note: what is wrong, where, why and what to do about it. The headline must stand
    alone. `points` are the places in the drawing that it is about, in mm.
    """

    code: str
    message: str
    span: Span | None = None
    label: str = ""
    secondary: tuple[Label, ...] = ()
    hints: tuple[str, ...] = ()
    fix: Fix | None = None
    points: tuple[tuple[float, float], ...] = ()

    @property
    def severity(self) -> Severity:
        return _SEVERITY[self.code[0]]

    @property
    def is_error(self) -> bool:
        return self.severity is Severity.ERROR


class AidlError(ValueError):
    """Raised for what cannot be done, with the diagnostics that say why and what to do about it. The headline
    of the first is the message if there is no other; its hints are printed below a traceback.
    """

    def __init__(self, *diagnostics: Diagnostic, message: str = "") -> None:
        super().__init__(message or diagnostics[0].message)
        self.diagnostics = diagnostics
        for hint in diagnostics[0].hints if diagnostics else ():
            self.add_note(f"hint: {hint}")

    @property
    def diagnostic(self) -> Diagnostic:
        """The first of the diagnostics."""
        return self.diagnostics[0]

    def __reduce__(self) -> tuple[object, ...]:
        return _error_again, (type(self), self.diagnostics, str(self))


def _error_again(kind: type[AidlError], diagnostics: tuple[Diagnostic, ...], message: str) -> AidlError:
    """Returns an unpickled error of a kind that was made of other arguments."""
    made = kind.__new__(kind)
    AidlError.__init__(made, *diagnostics, message=message)
    return made


MOST_ERRORS = 100
"""Errors of a program that are reported. A stage may stop looking once it has found one more than these."""


def is_too_many(diagnostics: Iterable[Diagnostic]) -> bool:
    """Tells whether there are more errors than are reported."""
    return sum(d.is_error for d in diagnostics) > MOST_ERRORS


def within_limit(diagnostics: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Returns the diagnostics in order, up to the first error beyond MOST_ERRORS, which E0803 replaces."""
    errors = 0
    for index, found in enumerate(diagnostics):
        errors += found.is_error
        if errors > MOST_ERRORS:
            return [*diagnostics[:index], too_many_errors(found.span, MOST_ERRORS)]
    return list(diagnostics)


def too_many_errors(span: Span | None, most: int) -> Diagnostic:
    hint = "mend the first ones and check again: later ones often follow from them"
    message = f"more than {most} errors; what comes after this is not told"
    return Diagnostic("E0803", message, span, hints=(hint,))


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    return any(d.is_error for d in diagnostics)


def ordered(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Returns the diagnostics in order of place, without duplicates."""
    unique: dict[object, Diagnostic] = {}
    for d in diagnostics:
        place = (d.span.source.name, d.span.start, d.span.end) if d.span else None
        unique.setdefault((d.code, place, d.message), d)
    return sorted(unique.values(), key=lambda d: (d.span.source.name, d.span.start) if d.span else ("", -1))


def by_statement(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Returns one diagnostic for all of the same code, places and fix: loops make several of a statement."""
    alike: dict[object, list[Diagnostic]] = {}
    for d in diagnostics:
        places = (d.span, *(label.span for label in d.secondary)) if d.span else (d.message,)
        alike.setdefault((d.code, places, d.fix), []).append(d)
    return [_said_once(list({d.message: d for d in several}.values())) for several in alike.values()]


def _said_once(alike: Sequence[Diagnostic]) -> Diagnostic:
    first = min(alike, key=lambda d: (len(d.message), d.message))  # by number, where it is one
    more = len(alike) - 1
    if not more:
        return first
    hint = f"the same holds for {more} more of what this statement makes"
    points = tuple(p for d in alike for p in d.points)
    return replace(first, hints=(hint, *first.hints), points=points)


def apply_fixes(source: SourceFile, diagnostics: Iterable[Diagnostic]) -> tuple[str, int]:
    """Returns the text with every fix applied that does not overlap an earlier one, and the number of those
    applied.

    Insertions at one place are kept in the order of the diagnostics.
    """
    taken: list[Edit] = []
    applied = 0
    for fix in (d.fix for d in diagnostics if d.fix):
        edits = [e for e in fix.edits if e not in taken]
        if any(e.span.source is not source for e in edits):
            continue
        if any(e.span.overlaps(t.span) for e in edits for t in taken):
            continue
        taken += edits
        applied += 1
    text = source.text
    for _, edit in sorted(enumerate(taken), key=lambda pair: (-pair[1].span.start, -pair[0])):
        text = text[: edit.span.start] + edit.replacement + text[edit.span.end :]
    return text, applied


# --- The limit on the time that working out, measuring or comparing a drawing may take.


class TooLongError(AidlError):
    """Work on a drawing takes too long: names it and, if known, the part of the program to blame."""

    def __init__(self, doing: str, seconds: float, span: Span | None = None, label: str = "") -> None:
        message = f"{doing} what this program says takes more than {seconds:g} seconds"
        cause = "it has too many curves, or too many that cross: fewer copies, or a wider `pitch`, take less"
        hints = (f"{cause}; the limit is a setting of the API",)
        super().__init__(Diagnostic("E0805", message, span, label, hints=hints))


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
