"""A diagnostic as plain data, for JSON. Lines and columns count from 1, offsets from 0, in code points."""

from __future__ import annotations

from typing import Any

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.source import Span


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
    return {"title": fix.title, "sure": fix.is_sure, "edits": [_edit(edit) for edit in fix.edits]}


def _edit(edit: Edit) -> dict[str, Any]:
    span = edit.span
    return {**_place(span), "start": span.start, "end": span.end, "replacement": edit.replacement}
