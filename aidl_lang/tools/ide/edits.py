"""Edits of one text: applying them, and finding them between two versions."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import SequenceMatcher

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import SourceFile, Span


def applied(text: str, edits: Iterable[Edit]) -> str:
    """Returns the text after edits that do not overlap; insertions at one place stay in their order."""
    for _, edit in sorted(enumerate(edits), key=lambda pair: (-pair[1].span.start, -pair[0])):
        text = text[: edit.span.start] + edit.replacement + text[edit.span.end :]
    return text


def between(source: SourceFile, text: str) -> list[Edit]:
    """Returns the edits, by whole lines, from one text to another."""
    old, new = source.text.splitlines(keepends=True), text.splitlines(keepends=True)
    starts = [0]
    for line in old:
        starts.append(starts[-1] + len(line))
    changes = SequenceMatcher(a=old, b=new, autojunk=False).get_opcodes()
    return [
        Edit(Span(source, starts[i], starts[j]), "".join(new[k:m]))
        for tag, i, j, k, m in changes
        if tag != "equal"
    ]


def line_start(text: str, offset: int) -> int:
    """Returns the beginning of the line of an offset."""
    return text.rfind("\n", 0, offset) + 1


def above_comments(text: str, offset: int) -> int:
    """Returns the beginning of the line of an offset, or of the comments right above it."""
    start = line_start(text, offset)
    while start and text[line_start(text, start - 1) : start].lstrip().startswith(("//", "#")):
        start = line_start(text, start - 1)
    return start


def indent_at(text: str, offset: int) -> str:
    """Returns the white space at the beginning of the line of an offset."""
    line = text[line_start(text, offset) : offset]
    return line[: len(line) - len(line.lstrip())]


def insert(source: SourceFile, offset: int, text: str) -> Edit:
    return Edit(Span(source, offset, offset), text)
