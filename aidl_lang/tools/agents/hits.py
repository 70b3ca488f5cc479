"""What a search finds, as it is sent: short, with an example."""

from __future__ import annotations

import re

from aidl_lang.common import resources
from aidl_lang.tools.agents.results import Hit
from aidl_lang.tools.reference.collect import Entry
from aidl_lang.tools.reference.pages import forms
from aidl_lang.tools.reference.searching import search

_MENDED = re.compile(r"^## Mended\n+```aidl[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_MOST_FORMS = 4
_LONGEST_EXAMPLE = 1_200


def hits(query: str, most: int) -> list[Hit]:
    """Returns the best hits, best first."""
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
