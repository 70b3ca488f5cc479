"""A diagnostic as text: the headline, the place, the lines with their labels, hints and the fix."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from aidl_lang.common.diagnostics import Diagnostic, Label, Severity
from aidl_lang.common.prose import counted, listed
from aidl_lang.common.render.excerpt import Excerpt, Mark, mark
from aidl_lang.common.render.patch import ChangedLine, Hunk, hunks
from aidl_lang.common.render.style import TerminalStyle
from aidl_lang.common.render.text import escape, window
from aidl_lang.common.source import SourceFile, Span

WIDTH = 110
"""Columns to use if the width of the terminal is not known."""


def render(diagnostic: Diagnostic, style: TerminalStyle | None = None, width: int = WIDTH) -> str:
    """Returns the diagnostic for a reader, without a line break at the end; plain text unless `style` has
    colour.
    """
    return "\n".join(_Page(diagnostic, style or TerminalStyle(), width).lines())


def one_line(diagnostic: Diagnostic) -> str:
    """Returns `part.aidl:3:9: error[E0301]: …`: the headline with its place before it, for lists."""
    d = diagnostic
    place = f"{d.span.source.name}:{d.span.line}:{d.span.column}: " if d.span else ""
    return escape(f"{place}{d.severity}[{d.code}]: {d.message}").replace("\n", " ")


def summary(diagnostics: Iterable[Diagnostic]) -> str:
    """Returns `2 errors and 1 warning`; empty if there is nothing to count."""
    counts = Counter(d.severity for d in diagnostics)
    return listed(counted(n, s) for s in Severity if (n := counts[s]))


class _Page:
    """One diagnostic being written: its settings, marks and hunks, which all its parts share."""

    def __init__(self, diagnostic: Diagnostic, style: TerminalStyle, width: int) -> None:
        self.diagnostic = diagnostic
        self.style = style
        self.hunks = list(hunks(diagnostic.fix)) if diagnostic.fix else []
        self.marks = _by_source(diagnostic)
        numbers = [m.last for marks in self.marks.values() for m in marks]
        numbers += [change.number for hunk in self.hunks for change in hunk.changes]
        self.gutter = len(str(max(numbers, default=0)))
        self.width = max(40, width - self.gutter - 3)

    def lines(self) -> Iterator[str]:
        yield self._headline()
        arrow = "-->"
        for source, marks in self.marks.items():
            yield self._arrow(arrow, source, marks)
            yield from self._excerpt(source, marks)
            arrow = ":::"
        notes = [*(("hint", hint) for hint in self.diagnostic.hints), *self._fix_title()]
        if notes and self.marks:
            yield self._bar()
        for kind, text in notes:
            yield from self._note(kind, text)
        for hunk in self.hunks:
            yield from self._hunk(hunk)

    def _headline(self) -> str:
        d = self.diagnostic
        head = self.style.severity(f"{d.severity}[{d.code}]", d.severity)
        return head + self.style.strong(": " + escape(d.message))

    def _arrow(self, arrow: str, source: SourceFile, marks: list[Mark]) -> str:
        lead = next((m for m in marks if m.primary), marks[0])
        place = f"{escape(source.name)}:{lead.first}:{lead.start + 1}"
        return " " * self.gutter + self.style.gutter(arrow) + " " + place

    def _excerpt(self, source: SourceFile, marks: list[Mark]) -> Iterator[str]:
        excerpt = Excerpt(source, tuple(marks), self.diagnostic.severity, self.style, self.width)
        yield self._bar()
        for number, text in excerpt.rows():
            yield self._bar(text, number)

    def _bar(self, text: str = "", number: int | None = None, sign: str = "|") -> str:
        head = "" if number is None else str(number)
        return (self.style.gutter(f"{head:>{self.gutter}} {sign}") + " " + text).rstrip()

    def _fix_title(self) -> list[tuple[str, str]]:
        return [("fix", self.diagnostic.fix.title)] if self.diagnostic.fix else []

    def _note(self, kind: str, text: str) -> Iterator[str]:
        lead = self.style.gutter(" " * self.gutter + " =") + " " + self.style.strong(f"{kind}: ")
        for line in escape(text).split("\n"):
            yield lead + line
            lead = " " * (self.gutter + 5 + len(kind))

    def _hunk(self, hunk: Hunk) -> Iterator[str]:
        main = self.diagnostic.span.source if self.diagnostic.span else None
        if hunk.source is not main:
            yield " " * self.gutter + self.style.gutter(":::") + " " + escape(hunk.source.name)
        yield self._bar()
        for change in hunk.changes:
            yield self._change(change)

    def _change(self, change: ChangedLine) -> str:
        text = window(change.text, self.width, change.focus).text
        if change.sign == " ":
            return self._bar(text, change.number)
        paint = self.style.added if change.sign == "+" else self.style.removed
        head = self.style.gutter(f"{change.number:>{self.gutter}}")
        return (head + " " + paint(change.sign + " " + text)).rstrip()


def _by_source(diagnostic: Diagnostic) -> dict[SourceFile, list[Mark]]:
    """Returns the labels of each source, that of the primary one first."""
    labels = [(label, False) for label in diagnostic.secondary]
    if diagnostic.span is not None:
        labels.insert(0, (Label(_shown(diagnostic.span), diagnostic.label), True))
    marks: dict[SourceFile, list[Mark]] = {}
    for label, primary in labels:
        marks.setdefault(label.span.source, []).append(mark(label, primary))
    return marks


def _shown(span: Span) -> Span:
    """Returns the span without the blank space that a recovering parser may have taken along at its end."""
    return Span(span.source, span.start, max(span.start, span.start + len(span.text.rstrip())))
