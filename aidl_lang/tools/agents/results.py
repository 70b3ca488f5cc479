"""The results of the tools: plain data, and the same as text for a language model in few words."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import Any, Literal, TypeAlias

from aidl_lang.common import resources
from aidl_lang.common.diagnostics import Diagnostic, Fix
from aidl_lang.common.prose import rounded, shortened
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.boolean import Contact
from aidl_lang.tools.reference import forms
from aidl_lang.tools.reference.collect import Entry, search

MOST_FINDINGS = 50
Status: TypeAlias = Literal["solved", "partial", "failed", "wrong"]
_LONGEST = 2_000
"""Most characters of a message: names in a program may be of any length."""


@record()
class Place:
    """A range of a file; lines and columns count from 1, the end is exclusive."""

    file: str
    line: int
    column: int
    end_line: int
    end_column: int


@record()
class Replacement:
    """Replace the text `old` at a place by `new`; where `old` is empty, insert."""

    place: Place
    old: str
    new: str


@record()
class Repair:
    """Replacements that together mend a mistake and keep what the author meant."""

    title: str
    replacements: list[Replacement]


@record()
class Related:
    """Another place that takes part, with a few words about it."""

    place: Place
    label: str


@record()
class Finding:
    """A diagnostic: what is wrong, where and why. `explain` tells more about its code."""

    code: str
    severity: Literal["error", "warning", "note"]
    message: str
    place: Place | None
    reason: str
    related: list[Related]
    hints: list[str]
    fix: Repair | None


@record()
class Findings:
    """The diagnostics of a program, `left_out` of which are not listed."""

    listed: list[Finding]
    left_out: int = 0


@record(kw_only=True)
class Result:
    """What every result has in common: beside its data the whole for a reader, and pictures (PNG)."""

    text: str = field(repr=False)
    pictures: tuple[bytes, ...] = field(default=(), repr=False)


def data(result: object) -> Any:
    """Returns a result as data for JSON; numbers that are not finite are null."""
    return rounded(_plain(result))


def _plain(value: object) -> Any:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: _plain(getattr(value, f.name)) for f in shown_fields(type(value))}
    if isinstance(value, Mapping):
        return {str(key): _plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return value


def shown_fields(kind: type) -> Iterator[dataclasses.Field[Any]]:
    """Yields the fields of a dataclass that are part of its data: those in its `repr`."""
    return (f for f in dataclasses.fields(kind) if f.repr)


def findings(diagnostics: Sequence[Diagnostic]) -> Findings:
    """Returns diagnostics as findings, errors first."""
    ranked = sorted(diagnostics, key=lambda d: "EWN".index(d.code[0]))
    listed = [_finding(d) for d in ranked[:MOST_FINDINGS]]
    return Findings(listed, len(ranked) - len(listed))


def _finding(d: Diagnostic) -> Finding:
    return Finding(
        d.code,
        d.severity.value,
        shortened(d.message, _LONGEST),
        place(d.span) if d.span else None,
        shortened(d.label, _LONGEST),
        [Related(place(label.span), shortened(label.text, _LONGEST)) for label in d.secondary],
        [shortened(hint, _LONGEST) for hint in d.hints],
        repair(d.fix) if d.fix else None,
    )


def place(span: Span) -> Place:
    end_line, end_column = span.source.position(span.end)
    return Place(span.source.name, span.line, span.column, end_line, end_column)


def repair(fix: Fix) -> Repair:
    made = [Replacement(place(edit.span), edit.span.text, edit.replacement) for edit in fix.edits]
    return Repair(shortened(fix.title, _LONGEST), made)


def joined(blocks: Iterable[str]) -> str:
    """Joins paragraphs that are not empty, with an empty line between two."""
    return "\n\n".join(filter(None, (block.rstrip() for block in blocks)))


@record()
class Checked(Result):
    """What can be said of a program without solving it. `fixed_program` is the program with all fixes
    applied, whose titles are in `fixes`; null where there were none. `findings_after_fixes` is what is left
    in it.
    """

    ok: bool
    findings: Findings
    fixes: list[str]
    fixed_program: str | None
    findings_after_fixes: Findings | None


@record()
class Knob:
    """A `param` of the program, and which values it may take."""

    path: str
    value: float | str | bool
    low: float | None
    high: float | None
    choices: list[float | str | bool]
    step: float | None
    unit: str
    doc: str | None


@record()
class Body:
    """A separate piece of material with its box in the frame of the root, in mm, and its area in mm²."""

    path: str
    left: float
    bottom: float
    right: float
    top: float
    area: float


@record()
class Export:
    """A file: its text, or its bytes in base64."""

    format: str
    encoding: Literal["text", "base64"]
    content: str


@record()
class Drawn(Result):
    """What came of a program. `status` is `solved`, `partial`, `failed`, or `wrong` for a program that could
    not be built. `motions` says what can still move. `model` is the solved model as JSON where it was asked
    for; `shortened` says what was left out of it. The picture comes beside this.
    """

    ok: bool
    status: Status
    findings: Findings
    params: list[Knob]
    degrees_of_freedom: int | None
    motions: list[str]
    bodies: list[Body]
    contacts: list[Contact]
    model: dict[str, Any] | None
    shortened: str | None
    exports: list[Export]
    left_out: list[str]


@record()
class Measured(Result):
    """Areas, walls, gaps and masses, as `aidl measure --json` tells them: mm, mm², mm³, g, mm⁴."""

    whole: dict[str, Any]
    parts: list[dict[str, Any]]
    contacts: list[Contact]
    all_contacts: bool
    touches_no_other: list[str]
    findings: Findings


@record()
class Edited(Result):
    """A program whose `param` has another default, and what that changes in the drawing, as sentences
    (`changes`).
    """

    ok: bool
    status: Status
    program: str
    replacement: Replacement
    changes: str
    findings: Findings


@record()
class Party:
    """A constraint in a conflict, as its author wrote it. `off` is by how much it does not hold where the
    solver came nearest; `would_fit` says what in it would let the others hold; `remedy` writes that, and
    `solves` tells whether the program solves then.
    """

    constraint: str
    held_by: str
    place: Place
    off: float | None
    would_fit: str
    remedy: Repair | None
    solves: bool | None


@record()
class Given:
    """An exact number behind a conflict: the value of a param that has a `name`, or one that is `fixed`."""

    name: str
    place: Place
    would_fit: str
    remedy: Repair
    solves: bool | None


@record()
class Conflict:
    """Constraints that do not hold together. With `is_minimal` the others hold without any one of them."""

    headline: str
    is_minimal: bool
    parties: list[Party]
    givens: list[Given]


@record()
class Conflicts(Result):
    """Why a program does not solve, or for one that does, what is redundant in it (`findings`) and what can
    move.
    """

    status: Status
    conflicts: list[Conflict]
    degrees_of_freedom: int | None
    motions: list[str]
    findings: Findings


@record()
class Page(Result):
    """A text in Markdown. `sections` can be asked for one by one."""

    title: str
    content: str
    sections: list[str] = field(default_factory=list)


@record()
class Hit:
    """A name of the library, or the code of a diagnostic, that fits a query. `forms` is how it is written."""

    name: str
    kind: str
    summary: str
    forms: list[str]
    example: str


@record()
class Hits(Result):
    """What fits a query, best first. `explain` tells all about one."""

    hits: list[Hit]


def told(hit: Hit) -> str:
    lines = [f"{hit.name} ({hit.kind}): {hit.summary}", *(f"  {form}" for form in hit.forms)]
    return "\n".join([*lines, *(f"    {line}" for line in hit.example.splitlines())])


# --- What a search finds, as it is sent: short, with an example.

_MENDED = re.compile(r"^## Mended\n+```aidl[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_MOST_FORMS = 4
_LONGEST_EXAMPLE = 1_200


def hits(query: str, most: int) -> list[Hit]:
    return [_of_code(about) if isinstance(about, str) else _of_entry(about) for about in search(query, most)]


def _of_entry(entry: Entry) -> Hit:
    return Hit(entry.name, entry.sort, entry.doc.line, forms(entry)[:_MOST_FORMS], _short(entry.doc.example))


def _of_code(code: str) -> Hit:
    mended = _MENDED.search(resources.page(code))
    return Hit(code, "diagnostic", resources.title(code), [], _short(mended[1] if mended else ""))


def _short(example: str) -> str:
    if len(example) <= _LONGEST_EXAMPLE:
        return example
    return example[:_LONGEST_EXAMPLE].rpartition("\n")[0] + "\n// … `explain` has the rest\n"
