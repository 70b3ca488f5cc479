"""Completion entries, before and after ranking."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import field

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.names import is_spelled_in
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.tools.snippets import Snippet, expanded

# --- One completion entry.

MOST = 200
"""Most entries of a list. A list of that length may be incomplete: the editor asks again as the word
grows.
"""


def nothing() -> str:
    return ""


@record()
class Completion:
    """A completion entry.

    label    the text shown, and compared with the typed text
    kind     `keyword`, `kind`, `snippet`, `unit`, `attribute`, `color`, `type`, `file`, `word`, `argument`,
             `field`, `method`, or a `SymbolKind` in its words
    detail   its type, or its call, in a few words
    text     the replacement of `span`; a snippet has placeholders: `${1:name}`, `${1|a,b|}`, `$0`
    rank     its place in the list, 0 for the best
    extra    edits elsewhere that it needs, as an import
    describe makes its documentation in Markdown; too slow for a whole list
    """

    label: str
    kind: str
    text: str
    span: Span
    detail: str = ""
    is_snippet: bool = False
    rank: int = 0
    extra: tuple[Edit, ...] = ()
    describe: Callable[[], str] = field(default=nothing, repr=False, compare=False)

    @property
    def documentation(self) -> str:
        return self.describe()

    @property
    def plain(self) -> str:
        """Returns the text with each placeholder replaced by its proposal."""
        return expanded(self.text) if self.is_snippet else self.text


# --- Completion entries before ranking.


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
