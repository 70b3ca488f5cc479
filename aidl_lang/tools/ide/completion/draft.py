"""Completion entries before ranking."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import field

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.names import is_spelled_in
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.tools.ide.completion.item import MOST, Completion, nothing
from aidl_lang.tools.snippets import Snippet


@record()
class Draft:
    """`tier` ranks it, 0 the likeliest; equal ones keep the order of drafting."""

    label: str
    kind: str
    tier: float
    text: str = ""
    detail: str = ""
    is_snippet: bool = False
    extra: tuple[Edit, ...] = ()
    describe: Callable[[], str] = field(default=nothing, repr=False)


def ranked(drafts: Iterable[Draft], span: Span, prefix: str) -> list[Completion]:
    """Returns entries by tier, each label once, of those that the prefix may abbreviate."""
    chosen: dict[tuple[str, str], Draft] = {}
    for draft in sorted(drafts, key=lambda d: d.tier):
        chosen.setdefault((draft.label, draft.text), draft)
    fitting = [d for d in chosen.values() if is_spelled_in(prefix, d.label)]
    return [
        Completion(
            d.label, d.kind, d.text or d.label, span, d.detail, d.is_snippet, rank, d.extra, d.describe
        )
        for rank, d in enumerate(fitting[:MOST])
    ]


def escaped(text: str) -> str:
    """Escapes a text for a snippet."""
    for sign in ("\\", "$", "}"):
        text = text.replace(sign, "\\" + sign)
    return text


def written_out(snippet: Snippet) -> str:
    """Writes a snippet for completion: indented as programs are, the cursor at its end unless it says
    otherwise.
    """
    return snippet.body.replace("\t", "    ").removesuffix("$0")


def stop(number: int, proposed: str) -> str:
    return f"${{{number}:{escaped(proposed)}}}"


def choice(number: int, names: Sequence[str]) -> str:
    """Returns a placeholder with a choice of names; the first is proposed."""
    return f"${{{number}|{','.join(names)}|}}" if len(names) > 1 else stop(number, names[0])
