"""Formats a program with few edits."""

from __future__ import annotations

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import Span
from aidl_lang.tools.ide.edits import between, line_start
from aidl_lang.tools.ide.view import View


def format_document(view: View) -> list[Edit]:
    """Returns the edits that bring a text into its canonical form; none if it does not parse."""
    text, _ = pipeline.formatted(view.source, view.world)
    return [] if text is None else between(view.source, text)


def format_range(view: View, wanted: Span) -> list[Edit]:
    """Returns the formatting edits for the lines of a range."""
    text = view.source.text
    start = line_start(text, wanted.start)
    end = text.find("\n", wanted.end)
    end = len(text) if end < 0 else end + 1
    return [e for e in format_document(view) if e.span.start < end and e.span.end >= start]
