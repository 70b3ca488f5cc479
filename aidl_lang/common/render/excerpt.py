"""The lines of a source that have labels, with the labels under them, made safe for a terminal."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from typing import TextIO

from aidl_lang.common.diagnostics import Label, Severity
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile

# --- Source text made safe and measured for a terminal.
#
# A source may hold anything: tabs, wide and combining characters, escape sequences that would move the
# cursor or recolour the screen, marks that reorder the line. Each character becomes a harmless cell with a
# known width, so that carets stand under what they mean.

TAB = 4
_REACH = 4_000
"""Characters that are laid out before what a label points at; no terminal is as wide."""
_BREAKING = {"Cc", "Cf", "Cs", "Zl", "Zp"}
"""Categories that change the screen rather than print: controls, formats, surrogates, separators."""


def escape(text: str) -> str:
    """Returns the text with stand-ins for characters that disturb a terminal; line breaks are kept."""
    return "".join(char if char == "\n" else _visible(char) for char in text)


def width_of(text: str) -> int:
    """Returns the terminal columns that an escaped text takes."""
    return sum(_width(char) for char in text)


@record()
class Window:
    """The part of a line that is shown: characters `start:end` of its cells, with `…` in place of the rest.
    `columns[i]` is where character i begins; the last entry is the end of the line. Of a very long one only
    some characters are laid out: those from `skipped` on, to the end unless `is_cut`.
    """

    cells: tuple[str, ...]
    columns: tuple[int, ...]
    start: int
    end: int
    skipped: int = 0
    is_cut: bool = False

    @property
    def text(self) -> str:
        before = "…" if self.start or self.skipped else ""
        after = "…" if self.end < len(self.cells) or self.is_cut else ""
        return before + "".join(self.cells[self.start : self.end]) + after

    def column(self, index: int) -> int:
        """Returns the column of a character within `text`; a character left out counts as at the edge."""
        index -= self.skipped
        if index < self.start:
            return 0
        shift = self.columns[self.start] - (1 if self.start or self.skipped else 0)
        return self.columns[min(index, self.end)] - shift


def lay_out(text: str) -> Window:
    """Returns a whole line: tabs go to the next stop, controls become their pictures or code points."""
    cells: list[str] = []
    columns = [0]
    for char in text:
        cell = " " * (TAB - columns[-1] % TAB) if char == "\t" else _visible(char)
        cells.append(cell)
        columns.append(columns[-1] + width_of(cell))
    return Window(tuple(cells), tuple(columns), 0, len(cells))


def window(text: str, width: int, focus: tuple[int, int]) -> Window:
    """Cuts a line to `width` columns so that the characters of `focus`, or its first ones, can be seen."""
    skipped = max(0, focus[0] - _REACH)
    end = focus[0] + 2 * _REACH
    line, is_cut = lay_out(text[skipped:end]), len(text) > end
    total = line.columns[-1]
    if total <= width and not (skipped or is_cut):
        return line
    first, last = line.column(focus[0] - skipped), line.column(focus[1] - skipped)
    room = width - 2
    lead = max(0, (room - (last - first)) // 2) if last - first <= room else room // 8
    left = max(0, min(first - lead, total - room))
    start = next(i for i, column in enumerate(line.columns) if column >= left)
    end = start
    while end < len(line.cells) and line.columns[end + 1] - line.columns[start] <= room:
        end += 1
    return Window(line.cells, line.columns, start, end, skipped, is_cut)


def _visible(char: str) -> str:
    if char.isprintable() or unicodedata.category(char) not in _BREAKING:
        return char
    code = ord(char)
    if code < 0x20:
        return chr(0x2400 + code)
    if code == 0x7F:
        return "␡"
    return f"<U+{code:04X}>"


def _width(char: str) -> int:
    if unicodedata.combining(char) or unicodedata.category(char) in ("Mn", "Me"):
        return 0
    return 2 if unicodedata.east_asian_width(char) in ("W", "F") else 1


# --- Terminal colours, and the rule when to use them.

_RESET = "\x1b[0m"
_SEVERITY = {Severity.ERROR: "\x1b[1;31m", Severity.WARNING: "\x1b[1;33m", Severity.NOTE: "\x1b[1;36m"}


@record()
class TerminalStyle:
    """A way to print: in terminal colours, or plain."""

    colour: bool = False

    def severity(self, text: str, severity: Severity) -> str:
        return self._paint(text, _SEVERITY[severity])

    def strong(self, text: str) -> str:
        return self._paint(text, "\x1b[1m")

    def gutter(self, text: str) -> str:
        return self._paint(text, "\x1b[1;34m")

    def added(self, text: str) -> str:
        return self._paint(text, "\x1b[32m")

    def removed(self, text: str) -> str:
        return self._paint(text, "\x1b[31m")

    def _paint(self, text: str, start: str) -> str:
        return f"{start}{text}{_RESET}" if self.colour and text else text


def wants_colour(stream: TextIO, environment: Mapping[str, str]) -> bool:
    """Tells whether to colour: on a terminal, unless `NO_COLOR` or `FORCE_COLOR` overrule, in that order."""
    if environment.get("NO_COLOR"):
        return False
    if environment.get("FORCE_COLOR", "0") != "0":
        return True
    return stream.isatty() and environment.get("TERM") != "dumb"


# --- The lines of a source that have labels, with the labels drawn under them.
#
# Labels within one line get carets (`^`, or `-` for a secondary one); the rightmost carries its text beside
# the carets, the others hang below it. A label over several lines is a bar at the left from its first line
# to its last.

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

    @property
    def sign(self) -> str:
        return "^" if self.primary else "-"


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
    """One row of characters under construction, each with whether the label that drew it is primary."""

    def __init__(self, width: int) -> None:
        self._cells: list[tuple[str, bool | None]] = [(" ", None)] * width

    def put(self, column: int, text: str, by: Mark) -> None:
        self._cells += [(" ", None)] * (column + len(text) - len(self._cells))
        self._cells[column : column + len(text)] = [(char, by.primary) for char in text]

    def painted(self, style: TerminalStyle, severity: Severity) -> str:
        row = ""
        for primary, run in groupby(self._cells, key=lambda cell: cell[1]):
            text = "".join(char for char, _ in run)
            if primary is not None:
                text = style.severity(text, severity) if primary else style.gutter(text)
            row += text
        return row


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
        row = ExcerptRow(self.width)
        for slot, m in enumerate(self.marks):
            if m.first < number <= m.last and m not in ended:
                row.put(2 * slot, "|", m)
            elif starting is not None and m.first == number and not starting[: m.start].strip():
                row.put(2 * slot, "/", m)
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
                row.put(2 * slot, "|", m)
        return row

    def opening(self, m: Mark, column: int) -> ExcerptRow:
        slot = self.marks.index(m)
        row = self.row(m.first)
        reach = self.width - 2 * slot + column
        row.put(2 * slot, " " + "_" * (reach - 1) + m.sign, m)
        return row

    def closing(self, m: Mark, column: int) -> ExcerptRow:
        slot = self.marks.index(m)
        row = self.row(m.last, ended=[e for e in self.ending(m.last) if self.marks.index(e) > slot])
        reach = self.width - 2 * slot + column
        row.put(2 * slot, "|" + "_" * (reach - 1) + m.sign, m)
        if m.text:
            row.put(self.width + column + 2, m.text, m)
        return row


def _annotations(marks: list[Mark], view: Window, bars: Bars, number: int) -> Iterator[ExcerptRow]:
    if not marks:
        return
    marks = sorted(marks, key=lambda m: (m.start, m.primary))
    places = {m: _place(m, view, bars.width) for m in marks}
    carets = bars.below(number)
    for m in sorted(marks, key=lambda m: m.primary):
        start, end = places[m]
        carets.put(start, m.sign * (end - start), m)
    beside = max(marks, key=lambda m: places[m])
    hanging = [m for m in marks if m.text]
    if all(places[m][1] <= places[beside][0] for m in marks if m is not beside):
        hanging = [m for m in hanging if m is not beside]
        if beside.text:
            carets.put(places[beside][1] + 1, beside.text, beside)
    yield carets
    while hanging:
        yield _stems(hanging, places, bars, number)
        last = hanging.pop()
        row = _stems(hanging, places, bars, number)
        row.put(places[last][0], last.text, last)
        yield row


def _stems(marks: list[Mark], places: dict[Mark, tuple[int, int]], bars: Bars, number: int) -> ExcerptRow:
    row = bars.below(number)
    for m in marks:
        row.put(places[m][0], "|", m)
    return row


def _place(m: Mark, view: Window, shift: int) -> tuple[int, int]:
    start = view.column(m.start)
    return shift + start, shift + max(start + 1, view.column(m.end))
