"""One completion entry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.tools.snippets import expanded

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
