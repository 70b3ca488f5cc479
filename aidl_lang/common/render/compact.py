"""Diagnostics for a language model, and as plain data for JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.render.excerpt import escape
from aidl_lang.common.render.terminal import hunks
from aidl_lang.common.source import Span

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
    return {"title": fix.title, "sure": fix.is_sure, "edits": [_edit(edit) for edit in fix.edits]}


def _edit(edit: Edit) -> dict[str, Any]:
    span = edit.span
    return {**_place(span), "start": span.start, "end": span.end, "replacement": edit.replacement}


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
_LONGEST = 200
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
    blocks += [f"and {count} more {code}{_alike(code, shown)}" for code, count in left.items()]
    return "\n\n".join(blocks)


def _alike(code: str, shown: Iterable[Diagnostic]) -> str:
    return ", to be mended alike" if any(d.code == code for d in shown) else ""


def _lines(d: Diagnostic, main: str) -> Iterator[str]:
    place = f" {_place_in_words(d.span, main)}" if d.span else ""
    yield f"{d.severity} {d.code}{place}: {_one_line(d.message)}"
    if d.span:
        yield f"  {d.span.line} | {_quoted(d.span)}"
    if d.label:
        yield f"  why: {_one_line(d.label)}"
    for label in d.secondary:
        yield f"  {_remark(label, main)}"
    for hint in d.hints:
        yield f"  hint: {_one_line(hint)}"
    if d.fix:
        yield from _fix_in_words(d.fix, main)


def _remark(label: Label, main: str) -> str:
    text = f": {_one_line(label.text)}" if label.text else ""
    return f"{_place_in_words(label.span, main)}{text} | {_quoted(label.span)}"


def _fix_in_words(fix: Fix, main: str) -> Iterator[str]:
    """Yields the lines as the fix leaves them, without unchanged ones in between."""
    lead = f"  fix ({_one_line(fix.title)}): "
    for hunk in hunks(fix):
        file = "" if hunk.source.name == main else f"{escape(hunk.source.name)} "
        gone = [c for c in hunk.changes if c.sign == "-"]
        come = [c.text for c in hunk.changes if c.sign == "+"]
        above = next((c.number for c in hunk.changes if c.sign == " "), 0)
        if not gone:
            yield f"{lead}after {file}line {above} write"
        else:
            first, last = gone[0].number, gone[-1].number
            lines = f"line {first}" if first == last else f"lines {first}-{last}"
            verb = ("becomes" if first == last else "become") if come else "goes" if first == last else "go"
            yield f"{lead}{file}{lines} {verb}"
        yield from (f"    {escape(text)[:_LONGEST]}".rstrip() for text in come)
        lead = "  and: "


def _place_in_words(span: Span, main: str) -> str:
    file = "" if span.source.name == main else f"{escape(span.source.name)} "
    return f"{file}line {span.line}"


def _quoted(span: Span) -> str:
    line = escape(span.source.line(span.line).strip())
    return line if len(line) <= _LONGEST else line[: _LONGEST - 1] + "…"


def _one_line(text: str) -> str:
    return " ".join(escape(text).split())
