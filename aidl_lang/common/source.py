"""Source text and places in it.

Offsets count Unicode code points from 0; lines and columns count from 1, as people do.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import field
from functools import cached_property

from aidl_lang.common.records import record


@record(eq=False)
class SourceFile:
    """One text with the name it is known by (a path, or `<stdin>`)."""

    name: str
    text: str

    @cached_property
    def line_starts(self) -> list[int]:
        """Offset at which each line begins."""
        return [0] + [match.end() for match in re.finditer("\n", self.text)]

    def position(self, offset: int) -> tuple[int, int]:
        """Returns line and column of an offset, both from 1."""
        offset = max(0, min(offset, len(self.text)))
        line = bisect_right(self.line_starts, offset)
        return line, offset - self.line_starts[line - 1] + 1

    def line(self, number: int) -> str:
        """Returns the text of a line (from 1) without its line break."""
        start = self.line_starts[number - 1]
        end = self.line_starts[number] - 1 if number < len(self.line_starts) else len(self.text)
        return self.text[start:end].rstrip("\r")


@record(slots=True)
class Span:
    """A half-open range `start:end` of a source file."""

    source: SourceFile = field(repr=False)
    start: int
    end: int

    @property
    def text(self) -> str:
        return self.source.text[self.start : self.end]

    @property
    def one_line(self) -> str:
        """The text with every run of white space as one space."""
        return " ".join(self.text.split())

    @property
    def line(self) -> int:
        return self.source.position(self.start)[0]

    @property
    def column(self) -> int:
        return self.source.position(self.start)[1]

    @property
    def with_separator(self) -> Span:
        """The span of a statement with its `;` or `,`, and of its whole line if nothing else is on it."""
        text, start, end = self.source.text, self.start, self.end
        end += len(text[end:]) - len(text[end:].lstrip(" \t;,"))
        begin = text.rfind("\n", 0, start) + 1
        if not text[begin:start].strip() and text[end : end + 1] == "\n":
            return Span(self.source, begin, end + 1)
        return Span(self.source, start, end)

    def to(self, other: Span) -> Span:
        """Returns the range from the start of this span to the end of the other."""
        return Span(self.source, self.start, max(self.end, other.end))

    def overlaps(self, other: Span) -> bool:
        return self.source is other.source and self.start < other.end and other.start < self.end
