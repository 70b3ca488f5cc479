"""The canonical form of a program, as few edits."""

from __future__ import annotations

from difflib import SequenceMatcher

from aidl_lang import pipeline
from aidl_lang.diagnostics import Edit
from aidl_lang.ide.view import View
from aidl_lang.source import Span


def format_document(view: View) -> list[Edit]:
    """The edits that bring a text into its canonical form; none where it does not parse."""
    text, _ = pipeline.formatted(view.source, view.world)
    if text is None or text == view.source.text:
        return []
    old, new = view.source.text.splitlines(keepends=True), text.splitlines(keepends=True)
    starts = [0]
    for line in old:
        starts.append(starts[-1] + len(line))
    changes = SequenceMatcher(a=old, b=new, autojunk=False).get_opcodes()
    return [
        Edit(view.span(starts[i], starts[j]), "".join(new[k:m]))
        for tag, i, j, k, m in changes
        if tag != "equal"
    ]


def format_range(view: View, wanted: Span) -> list[Edit]:
    """Those edits that concern the lines of a range."""
    text = view.source.text
    start = text.rfind("\n", 0, wanted.start) + 1
    end = text.find("\n", wanted.end)
    end = len(text) if end < 0 else end + 1
    return [e for e in format_document(view) if e.span.start < end and e.span.end >= start]
