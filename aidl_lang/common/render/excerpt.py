"""The lines of a source that have labels, with the labels drawn under them.

Labels within one line get carets (`^`, or `-` for a secondary one); the rightmost carries its text beside the
carets, the others hang below it. A label over several lines is a bar at the left from its first line to its
last.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby

from aidl_lang.common.diagnostics import Label, Severity
from aidl_lang.common.records import record
from aidl_lang.common.render.style import TerminalStyle
from aidl_lang.common.render.text import Window, escape, window
from aidl_lang.common.source import SourceFile

_WHOLE = 5
"""A label over at most so many lines is shown entirely, a longer one by its ends."""


@record()
class Mark:
    """A label laid on lines: from character `start` of line `first` to before character `end` of `last`."""

    first: int
    start: int
    last: int
    end: int
    text: str
    primary: bool

    @property
    def is_multiline(self) -> bool:
        return self.last > self.first


def mark(label: Label, primary: bool) -> Mark:
    """Returns the place of a label in lines; one that ends with a line break ends on the line it breaks."""
    source = label.span.source
    first, start = source.position(label.span.start)
    last, end = source.position(label.span.end)
    if last > first and end == 1:
        last -= 1
        end = len(source.line(last)) + 1
    return Mark(first, start - 1, last, end - 1, escape(label.text), primary)


class ExcerptRow:
    """One row of characters under construction, each with the kind of label that drew it."""

    def __init__(self) -> None:
        self._cells: list[tuple[str, str]] = []

    def put(self, column: int, text: str, kind: str) -> None:
        self._cells += [(" ", "")] * (column + len(text) - len(self._cells))
        self._cells[column : column + len(text)] = [(char, kind) for char in text]

    def painted(self, style: TerminalStyle, severity: Severity) -> str:
        return "".join(
            _paint("".join(char for char, _ in run), kind, style, severity)
            for kind, run in groupby(self._cells, key=lambda cell: cell[1])
        )


def _paint(text: str, kind: str, style: TerminalStyle, severity: Severity) -> str:
    if kind == "primary":
        return style.severity(text, severity)
    return style.gutter(text) if kind == "secondary" else text


@record()
class Excerpt:
    """The labels of one source, ready to be drawn."""

    source: SourceFile
    marks: tuple[Mark, ...]
    severity: Severity
    style: TerminalStyle
    width: int

    def rows(self) -> Iterator[tuple[int | None, str]]:
        """Yields rows with the line number of those that show source, None for annotations."""
        long = [m for m in self.marks if m.is_multiline]
        bars = Bars(tuple(sorted(long, key=lambda m: (m.first, -m.last))))
        previous = None
        for number in self._shown():
            if previous is not None and number > previous + 1:
                yield None, self._painted(bars.row(number)) + "…"
            yield from self._line(number, bars)
            previous = number

    def _shown(self) -> list[int]:
        lines = set()
        for m in self.marks:
            whole = m.last - m.first < _WHOLE
            lines |= set(range(m.first, m.last + 1)) if whole else {m.first, m.first + 1, m.last}
        for number in list(lines):
            at_end = number == len(self.source.line_starts) and not self.source.line(number).strip()
            if at_end and number > 1:
                lines.add(number - 1)
            if number - 2 in lines:
                lines.add(number - 1)
        return sorted(lines)

    def _line(self, number: int, bars: Bars) -> Iterator[tuple[int | None, str]]:
        on_line = [m for m in self.marks if m.first == m.last == number]
        text = self.source.line(number)
        view = window(text, max(20, self.width - bars.width), self._focus(number, len(text)))
        margin = bars.row(number, starting=text)
        yield number, self._painted(margin) + view.text
        for m in bars.starting(number, text):
            yield None, self._painted(bars.opening(m, view.column(m.start)))
        for row in _annotations(on_line, view, bars, number):
            yield None, self._painted(row)
        for m in bars.ending(number):
            yield None, self._painted(bars.closing(m, max(0, view.column(m.end) - 1)))

    def _focus(self, number: int, length: int) -> tuple[int, int]:
        here = [m for m in self.marks if number in (m.first, m.last)]
        here = [m for m in here if m.primary] or here
        starts = [m.start if m.first == number else m.end for m in here]
        ends = [m.end if m.last == number else m.start for m in here]
        return min(min(starts, default=0), length), min(max(ends, default=0), length)

    def _painted(self, row: ExcerptRow) -> str:
        return row.painted(self.style, self.severity)


@record()
class Bars:
    """The bars of labels that run over several lines, each in two columns of its own."""

    marks: tuple[Mark, ...]

    @property
    def width(self) -> int:
        return 2 * len(self.marks)

    def row(self, number: int, starting: str | None = None, ended: Iterable[Mark] = ()) -> ExcerptRow:
        """Returns the bars that pass a line; given its text, also those that begin before its first word."""
        row = ExcerptRow()
        row.put(0, " " * self.width, "")
        for slot, m in enumerate(self.marks):
            if m.first < number <= m.last and m not in ended:
                row.put(2 * slot, "|", _kind(m))
            elif starting is not None and m.first == number and not starting[: m.start].strip():
                row.put(2 * slot, "/", _kind(m))
        return row

    def starting(self, number: int, text: str) -> list[Mark]:
        """Returns the labels that begin after the first word of a line."""
        return [m for m in self.marks if m.first == number and text[: m.start].strip()]

    def ending(self, number: int) -> list[Mark]:
        return [m for m in reversed(self.marks) if m.last == number]

    def below(self, number: int) -> ExcerptRow:
        """Returns the bars under a line, those that began on it included."""
        row = self.row(number)
        for slot, m in enumerate(self.marks):
            if m.first == number:
                row.put(2 * slot, "|", _kind(m))
        return row

    def opening(self, m: Mark, column: int) -> ExcerptRow:
        slot = self.marks.index(m)
        row = self.row(m.first)
        reach = self.width - 2 * slot + column
        row.put(2 * slot, " " + "_" * (reach - 1) + _sign(m), _kind(m))
        return row

    def closing(self, m: Mark, column: int) -> ExcerptRow:
        slot = self.marks.index(m)
        row = self.row(m.last, ended=[e for e in self.ending(m.last) if self.marks.index(e) > slot])
        reach = self.width - 2 * slot + column
        row.put(2 * slot, "|" + "_" * (reach - 1) + _sign(m), _kind(m))
        if m.text:
            row.put(self.width + column + 2, m.text, _kind(m))
        return row


def _annotations(marks: list[Mark], view: Window, bars: Bars, number: int) -> Iterator[ExcerptRow]:
    """Yields the carets under one line and the texts that belong to them."""
    if not marks:
        return
    marks = sorted(marks, key=lambda m: (m.start, m.primary))
    places = {m: _place(m, view, bars.width) for m in marks}
    carets = bars.below(number)
    for m in sorted(marks, key=lambda m: m.primary):
        start, end = places[m]
        carets.put(start, _sign(m) * (end - start), _kind(m))
    beside = max(marks, key=lambda m: places[m])
    hanging = [m for m in marks if m.text]
    if all(places[m][1] <= places[beside][0] for m in marks if m is not beside):
        hanging = [m for m in hanging if m is not beside]
        if beside.text:
            carets.put(places[beside][1] + 1, beside.text, _kind(beside))
    yield carets
    while hanging:
        yield _stems(hanging, places, bars, number)
        last = hanging.pop()
        row = _stems(hanging, places, bars, number)
        row.put(places[last][0], last.text, _kind(last))
        yield row


def _stems(marks: list[Mark], places: dict[Mark, tuple[int, int]], bars: Bars, number: int) -> ExcerptRow:
    row = bars.below(number)
    for m in marks:
        row.put(places[m][0], "|", _kind(m))
    return row


def _place(m: Mark, view: Window, shift: int) -> tuple[int, int]:
    start = view.column(m.start)
    return shift + start, shift + max(start + 1, view.column(m.end))


def _sign(m: Mark) -> str:
    return "^" if m.primary else "-"


def _kind(m: Mark) -> str:
    return "primary" if m.primary else "secondary"
