"""The lists of words for the CodeMirror package, as a module of TypeScript, or of plain JavaScript."""

from __future__ import annotations

import json
from collections.abc import Mapping

from aidl_lang.tools.highlighting import called
from aidl_lang.tools.reference.collect import reference
from aidl_lang.tools.vocabulary import SNIPPETS, vocabulary

_HEAD = "// Made by `make colours` from aidl_lang/tools/vocabulary.py; do not edit.\n"
_LISTS = tuple(
    "kinds attributes units types everywhere constants statements clauses keywords reserved".split()
)


def words(*, typed: bool = True) -> str:
    """Returns `words`: lists by class; `calls`: names by the class of their call; `about`: the names of the
    library with their purpose; `snippets`. Without types it is plain JavaScript.
    """
    known = vocabulary()
    lists = {name: getattr(known, name) for name in _LISTS}
    entries = reference().entries
    about = {name: entry.doc.line for name, entry in entries.items() if name in known.named()}
    snippets = [{"prefix": s.prefix, "title": s.title, "body": s.body, "place": s.place} for s in SNIPPETS]
    parts = {
        "words: Record<string, readonly string[]>": lists,
        'calls: Record<string, "call.shape" | "call.constraint" | "call.function">': called(),
        "about: Record<string, string>": about,
        "snippets: readonly { prefix: string; title: string; body: string; place: string }[]": snippets,
    }
    named = {name if typed else name.partition(":")[0]: _literal(value) for name, value in parts.items()}
    return _HEAD + "".join(f"\nexport const {name} = {value};\n" for name, value in named.items())


def _literal(value: object) -> str:
    """Writes a value with each of its items on a line."""
    if isinstance(value, Mapping):
        inside = ",\n".join(f"  {json.dumps(k)}: {_short(v)}" for k, v in value.items())
        return f"{{\n{inside},\n}}"
    assert isinstance(value, list)
    return "[\n" + ",\n".join(f"  {_short(item)}" for item in value) + ",\n]"


def _short(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)
