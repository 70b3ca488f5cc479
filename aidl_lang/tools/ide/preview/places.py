"""Converts places in the drawn program to places in the present text: the picture may be of an earlier
one.
"""

from __future__ import annotations

from aidl_lang.common.source import SourceFile, Span
from aidl_lang.tools.ide.view import View


class Places:
    """Converts spans of the drawn outcome to spans of a view's texts."""

    def __init__(self, view: View) -> None:
        self._view = view
        self._now = {module.source.name: module.source for module in view.program.resolution.modules}
        self._now[view.source.name] = view.source
        self._shifts: dict[SourceFile, _Shift | None] = {}

    def now(self, span: Span | None) -> Span | None:
        """Returns the present place; None in the library, or if an edit has changed it."""
        if span is None or self._view.is_library(span.source):
            return None
        source = span.source
        if source not in self._shifts:
            current = self._now.get(source.name)
            self._shifts[source] = None if current is None else _Shift(source, current)
        shift = self._shifts[source]
        return None if shift is None else shift(span)


class _Shift:
    """Converts offsets between two texts that differ in one place."""

    def __init__(self, before: SourceFile, after: SourceFile) -> None:
        self.before, self.after = before, after
        if before.text == after.text:
            self.same = self.rest = len(before.text)
            return
        # Offsets up to `same` stay; those from `rest` on count from the end.
        one, other = before.text, after.text
        self.same = _alike(one, other)
        self.rest = len(one) - _alike(one[self.same :][::-1], other[self.same :][::-1])

    def __call__(self, span: Span) -> Span | None:
        start, end = self._start(span.start), self._end(span.end)
        return None if start is None or end is None or start > end else Span(self.after, start, end)

    def _start(self, offset: int) -> int | None:
        if offset < self.same or offset == self.same < self.rest:
            return offset
        return self._from_end(offset)

    def _end(self, offset: int) -> int | None:
        return offset if offset <= self.same else self._from_end(offset)

    def _from_end(self, offset: int) -> int | None:
        """Returns None for an offset in the changed text."""
        if offset < self.rest:
            return None
        return offset + len(self.after.text) - len(self.before.text)


def _alike(one: str, other: str) -> int:
    """Counts the equal characters at the beginning of two texts."""
    pairs = zip(one, other, strict=False)
    return next((k for k, (a, b) in enumerate(pairs) if a != b), min(len(one), len(other)))
