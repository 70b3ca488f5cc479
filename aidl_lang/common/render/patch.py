"""A fix as the lines it removes and the lines it adds."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile

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
