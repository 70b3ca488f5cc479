"""Diagnostics for a terminal, and in few words for language models."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label, Severity
from aidl_lang.common.prose import counted, listed, shortened
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


def hunks(fix: Fix) -> Iterator[tuple[SourceFile, list[ChangedLine]]]:
    """Yields the fix in pieces, one for each run of touched lines, in order of files and lines."""
    for source in dict.fromkeys(edit.span.source for edit in fix.edits):
        edits = sorted((e for e in fix.edits if e.span.source is source), key=lambda e: e.span.start)
        for cluster in _clusters(edits):
            yield source, list(_changes(source, cluster))


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
    if not gone and number > 1:
        yield ChangedLine(number - 1, " ", source.line(number - 1))
    focus = _differing(gone[0], come[0]) if len(gone) == len(come) == 1 else ((0, 0), (0, 0))
    for i, text in enumerate(gone[:_LONGEST]):
        yield ChangedLine(number + i, "-", text, focus[0])
    for i, text in enumerate(come[:_LONGEST]):
        yield ChangedLine(number + i, "+", text, focus[1])


def _patched(source: SourceFile, edits: list[Edit], first: int, last: int) -> list[str]:
    start = source.line_starts[first - 1]
    end = source.line_starts[last - 1] + len(source.line(last))
    text = source.text[start : max(end, edits[-1].span.end)]
    for edit in reversed(edits):
        text = text[: edit.span.start - start] + edit.replacement + text[edit.span.end - start :]
    return [line.rstrip("\r") for line in text.split("\n")]


def _common(a: Sequence[str], b: Sequence[str]) -> int:
    """Returns the number of items that two texts or lists have in common at their beginning."""
    return next((k for k, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))


def _differing(a: str, b: str) -> tuple[tuple[int, int], tuple[int, int]]:
    head = _common(a, b)
    tail = _common(a[head:][::-1], b[head:][::-1])
    return (head, len(a) - tail), (head, len(b) - tail)


# --- A diagnostic as text: the headline, the place, the lines with their labels, hints and the fix.

WIDTH = 110
"""Columns to use if the width of the terminal is not known."""


def render(diagnostic: Diagnostic, style: TerminalStyle | None = None, width: int = WIDTH) -> str:
    """Returns the diagnostic for a reader, in plain text unless `style` has colour, without a last break."""
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
        numbers += [change.number for _, changes in self.hunks for change in changes]
        self.gutter = len(str(max(numbers, default=0)))
        self.width = max(40, width - self.gutter - 3)

    def lines(self) -> Iterator[str]:
        yield self._headline()
        arrow = "-->"
        for source, marks in self.marks.items():
            yield self._arrow(arrow, source, marks)
            yield self._bar()
            excerpt = Excerpt(source, tuple(marks), self.diagnostic.severity, self.style, self.width)
            yield from (self._bar(text, number) for number, text in excerpt.rows())
            arrow = ":::"
        notes = [("hint", hint) for hint in self.diagnostic.hints]
        notes += [("fix", self.diagnostic.fix.title)] if self.diagnostic.fix else []
        if notes and self.marks:
            yield self._bar()
        for kind, text in notes:
            yield from self._note(kind, text)
        for source, changes in self.hunks:
            if self.diagnostic.span is None or source is not self.diagnostic.span.source:
                yield " " * self.gutter + self.style.gutter(":::") + " " + escape(source.name)
            yield self._bar()
            yield from map(self._change, changes)

    def _headline(self) -> str:
        d = self.diagnostic
        head = self.style.severity(f"{d.severity}[{d.code}]", d.severity)
        return head + self.style.strong(": " + escape(d.message))

    def _arrow(self, arrow: str, source: SourceFile, marks: list[Mark]) -> str:
        lead = next((m for m in marks if m.primary), marks[0])
        place = f"{escape(source.name)}:{lead.first}:{lead.start + 1}"
        return " " * self.gutter + self.style.gutter(arrow) + " " + place

    def _bar(self, text: str = "", number: int | None = None) -> str:
        head = "" if number is None else str(number)
        return (self.style.gutter(f"{head:>{self.gutter}} |") + " " + text).rstrip()

    def _note(self, kind: str, text: str) -> Iterator[str]:
        lead = self.style.gutter(" " * self.gutter + " =") + " " + self.style.strong(f"{kind}: ")
        for line in escape(text).split("\n"):
            yield lead + line
            lead = " " * (self.gutter + 5 + len(kind))

    def _change(self, change: ChangedLine) -> str:
        text = window(change.text, self.width, change.focus).text
        if change.sign == " ":
            return self._bar(text, change.number)
        paint = self.style.added if change.sign == "+" else self.style.removed
        head = self.style.gutter(f"{change.number:>{self.gutter}}")
        return (head + " " + paint(change.sign + " " + text)).rstrip()


def _by_source(diagnostic: Diagnostic) -> dict[SourceFile, list[Mark]]:
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


# --- A diagnostic as plain data, for JSON. Lines and columns count from 1, offsets from 0, in code points.


def to_dict(diagnostic: Diagnostic) -> dict[str, Any]:
    """Returns every field of a diagnostic; `file` and the places are None for one without a place."""
    return {
        "code": diagnostic.code,
        "severity": str(diagnostic.severity),
        "message": diagnostic.message,
        **_place(diagnostic.span),
        "label": diagnostic.label,
        "secondary": [{**_place(label.span), "label": label.text} for label in diagnostic.secondary],
        "hints": list(diagnostic.hints),
        "fix": _fix(diagnostic.fix) if diagnostic.fix else None,
    }


def _place(span: Span | None) -> dict[str, Any]:
    if span is None:
        return dict.fromkeys(("file", "line", "column", "end_line", "end_column"))
    end_line, end_column = span.source.position(span.end)
    return {
        "file": span.source.name,
        "line": span.line,
        "column": span.column,
        "end_line": end_line,
        "end_column": end_column,
    }


def _fix(fix: Fix) -> dict[str, Any]:
    edits = [
        {**_place(e.span), "start": e.span.start, "end": e.span.end, "replacement": e.replacement}
        for e in fix.edits
    ]
    return {"title": fix.title, "sure": fix.is_sure, "edits": edits}


# --- Diagnostics for a language model: short, without pictures made of characters, the fix as text to write.
#
# error E0301 line 4: `radius` is a length, not text
#   4 | rim = circle(radius: "3")
#   why: …
#   line 2: declared here | bore = 3
#   hint: …
#   fix (write a number): line 4 becomes
#     rim = circle(radius: 3)

_MOST = 12
"""Diagnostics that are written in full; the others are counted."""
_ALIKE = 3
"""Diagnostics of one code that are written in full: the rest are mended alike."""
_LONGEST_COMPACT = 200
"""Characters of a line that are shown."""


def compact(diagnostics: Sequence[Diagnostic]) -> str:
    """Returns the diagnostics in their order, errors first, with an empty line between two; empty for none.

    Places are lines of the file that most of them are about; other files are named.
    """
    ranked = sorted(diagnostics, key=lambda d: "EWN".index(d.code[0]))
    shown: list[Diagnostic] = []
    times: Counter[str] = Counter()
    for d in ranked:
        times[d.code] += 1
        if times[d.code] <= _ALIKE and len(shown) < _MOST:
            shown.append(d)
    names = Counter(d.span.source.name for d in diagnostics if d.span)
    main = names.most_common(1)[0][0] if names else ""
    blocks = ["\n".join(_lines(d, main)) for d in shown]
    left = Counter(d.code for d in ranked) - Counter(d.code for d in shown)
    told = {d.code for d in shown}
    alike = {code: ", to be mended alike" * (code in told) for code in left}
    return "\n\n".join([*blocks, *(f"and {count} more {code}{alike[code]}" for code, count in left.items())])


def _lines(d: Diagnostic, main: str) -> Iterator[str]:
    place = f" {_place_in_words(d.span, main)}" if d.span else ""
    yield f"{d.severity} {d.code}{place}: {_one_line(d.message)}"
    if d.span:
        yield f"  {d.span.line} | {_quoted(d.span)}"
    if d.label:
        yield f"  why: {_one_line(d.label)}"
    for label in d.secondary:
        text = f": {_one_line(label.text)}" if label.text else ""
        yield f"  {_place_in_words(label.span, main)}{text} | {_quoted(label.span)}"
    for hint in d.hints:
        yield f"  hint: {_one_line(hint)}"
    if d.fix:
        yield from _fix_in_words(d.fix, main)


def _fix_in_words(fix: Fix, main: str) -> Iterator[str]:
    """Yields the lines as the fix leaves them, without unchanged ones in between."""
    lead = f"  fix ({_one_line(fix.title)}): "
    for source, changes in hunks(fix):
        file = "" if source.name == main else f"{escape(source.name)} "
        gone = [c for c in changes if c.sign == "-"]
        come = [c.text for c in changes if c.sign == "+"]
        above = next((c.number for c in changes if c.sign == " "), 0)
        if not gone:
            yield f"{lead}after {file}line {above} write"
        else:
            first, last = gone[0].number, gone[-1].number
            lines = f"line {first}" if first == last else f"lines {first}-{last}"
            verb = ("becomes" if first == last else "become") if come else "goes" if first == last else "go"
            yield f"{lead}{file}{lines} {verb}"
        yield from (f"    {escape(text)[:_LONGEST_COMPACT]}".rstrip() for text in come)
        lead = "  and: "


def _place_in_words(span: Span, main: str) -> str:
    file = "" if span.source.name == main else f"{escape(span.source.name)} "
    return f"{file}line {span.line}"


def _quoted(span: Span) -> str:
    return shortened(escape(span.source.line(span.line).strip()), _LONGEST_COMPACT)


def _one_line(text: str) -> str:
    return " ".join(escape(text).split())
