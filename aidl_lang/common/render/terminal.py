"""A diagnostic as text: the headline, the place, the lines with their labels, hints and the fix."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label, Severity
from aidl_lang.common.prose import counted, listed
from aidl_lang.common.records import record
from aidl_lang.common.render.excerpt import Excerpt, Mark, TerminalStyle, escape, mark, window
from aidl_lang.common.source import SourceFile, Span

# --- A fix as the lines it removes and the lines it adds.

_LONGEST = 12
"""Rows of one hunk that are shown."""


@record()
class ChangedLine:
    """One row: its line, `-`, `+` or a space for a line that stays, its text and what differs in it."""

    number: int
    sign: str
    text: str
    focus: tuple[int, int] = (0, 0)


@record()
class Hunk:
    source: SourceFile
    changes: tuple[ChangedLine, ...]


def hunks(fix: Fix) -> Iterator[Hunk]:
    """Yields the fix in pieces, one for each run of touched lines, in order of files and lines."""
    sources = list(dict.fromkeys(edit.span.source for edit in fix.edits))
    for source in sources:
        edits = sorted((e for e in fix.edits if e.span.source is source), key=lambda e: e.span.start)
        for cluster in _clusters(edits):
            yield Hunk(source, tuple(_changes(source, cluster)))


def _clusters(edits: list[Edit]) -> Iterator[list[Edit]]:
    """Yields groups of edits; those that touch a common line belong together."""
    cluster: list[Edit] = []
    last = 0
    for edit in edits:
        if cluster and edit.span.line > last:
            yield cluster
            cluster = []
        cluster.append(edit)
        last = max(last, edit.span.source.position(edit.span.end)[0])
    if cluster:
        yield cluster


def _changes(source: SourceFile, edits: list[Edit]) -> Iterator[ChangedLine]:
    first = edits[0].span.line
    last = max(source.position(edit.span.end)[0] for edit in edits)
    old = [source.line(number) for number in range(first, last + 1)]
    new = _patched(source, edits, first, last)
    head = _common(old, new)
    tail = _common(old[head:][::-1], new[head:][::-1])
    gone, come = old[head : len(old) - tail], new[head : len(new) - tail]
    number = first + head
    if not gone:
        yield from _context(source, number)
    focus = _differing(gone[0], come[0]) if len(gone) == len(come) == 1 else ((0, 0), (0, 0))
    for i, text in enumerate(gone[:_LONGEST]):
        yield ChangedLine(number + i, "-", text, focus[0])
    for i, text in enumerate(come[:_LONGEST]):
        yield ChangedLine(number + i, "+", text, focus[1])


def _context(source: SourceFile, number: int) -> Iterator[ChangedLine]:
    """Yields the line above an insertion."""
    if number > 1:
        yield ChangedLine(number - 1, " ", source.line(number - 1))


def _patched(source: SourceFile, edits: list[Edit], first: int, last: int) -> list[str]:
    start = source.line_starts[first - 1]
    end = source.line_starts[last - 1] + len(source.line(last))
    text = source.text[start : max(end, edits[-1].span.end)]
    for edit in reversed(edits):
        text = text[: edit.span.start - start] + edit.replacement + text[edit.span.end - start :]
    return [line.rstrip("\r") for line in text.split("\n")]


def _common(a: list[str], b: list[str]) -> int:
    """Returns the number of items that two lists have in common at their beginning."""
    count = 0
    for x, y in zip(a, b, strict=False):
        if x != y:
            break
        count += 1
    return count


def _differing(a: str, b: str) -> tuple[tuple[int, int], tuple[int, int]]:
    """Returns the range of each text that the other does not share."""
    head = _common(list(a), list(b))
    tail = _common(list(a[head:])[::-1], list(b[head:])[::-1])
    return (head, len(a) - tail), (head, len(b) - tail)


# --- A diagnostic as text: the headline, the place, the lines with their labels, hints and the fix.

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
