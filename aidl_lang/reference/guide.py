"""The guide: the language on a few pages. Its prose stands in `guide.md`; what can drift is put in from the
library, the grammar and the examples, where that file has a placeholder.

    {{calls TOPIC …}}      how the names of those topics are called, and the parts of shapes
    {{forms TOPIC …}}      the same without parts
    {{names TOPIC …}}      those names alone
    {{fields}}             what each primitive can be asked for
    {{reserved}}           the words that cannot be names
    {{example NAME}}       the program `examples/NAME.aidl`
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from itertools import groupby
from pathlib import Path

from aidl_lang.reference.collect import Entry, reference
from aidl_lang.reference.pages import entry_blocks, short_calls
from aidl_lang.reference.signatures import parts
from aidl_lang.resources import resource

_PLACED = re.compile(r"\(center\?, (.*), angle\?, rotatable\?\)$")
_ALTERNATIVES = re.compile(r"\b(\w+)/\w+(/\w+){2,}")
_PLACEHOLDER = re.compile(r"\{\{(\w+) ?([^}]*)\}\}")


@cache
def guide() -> str:
    """The guide as Markdown. Raises KeyError for a placeholder or a topic that does not exist."""
    return _PLACEHOLDER.sub(lambda m: _MAKERS[m[1]](*m[2].split()), template())


def full_guide() -> str:
    """The guide and, after it, every entry of the reference, without pictures."""
    blocks = [guide().strip(), "# Reference"]
    for topic in reference().topics:
        blocks.append(f"## {topic.title}")
        for entry in reference().of_topic(topic.name):
            blocks += [block for block in entry_blocks(entry, "###") if not block.startswith("<img")]
    return "\n\n".join(blocks) + "\n"


def template() -> str:
    return Path(__file__).with_name("guide.md").read_text("utf-8")


def _entries(topics: tuple[str, ...]) -> list[Entry]:
    known = {topic.name for topic in reference().topics}
    if unknown := [topic for topic in topics if topic not in known]:
        raise KeyError(f"the guide asks for topics that do not exist: {', '.join(unknown)}")
    return [entry for topic in topics for entry in reference().of_topic(topic)]


def _calls(*topics: str) -> str:
    """A line for each name, with its parts; those that an earlier shape has too are told by its name."""
    lines, told = [], dict[str, set[str]]()
    for entry in _entries(topics):
        named = list(dict.fromkeys(part.name for node in entry.nodes for part in parts(node)))
        like = next((n for n, known in told.items() if len(known) > 3 and known <= set(named)), None)
        more = [part for part in named if like is None or part not in told[like]]
        if named:
            told[entry.name] = set(named)
        shown = " ".join(([f"as {like}"] if like else []) + more)
        lines.append((entry.name, _arguments(entry) + (f" → {shown}" if shown else "")))
    return _joined(lines)


def _forms(*topics: str) -> str:
    return _joined([(entry.name, _arguments(entry)) for entry in _entries(topics)])


def _joined(lines: Sequence[tuple[str, str]]) -> str:
    """Names that follow each other and are called alike stand in one line: `sin, cos(angle)`."""
    groups = groupby(lines, key=lambda line: line[1])
    return "\n".join(", ".join(name for name, _ in group) + arguments for arguments, group in groups)


def _arguments(entry: Entry) -> str:
    """The forms of a name without the name, as short as can be: `…` for the three arguments that most shapes
    have, `a/…` for one of several names, and a measure to compare goes without saying where it can be set.
    """
    calls = [call for call in short_calls(entry) if call.startswith(f"{entry.name}(")]
    forms = [call.removeprefix(entry.name) for call in calls]
    forms = [f for f in forms if not any(other.startswith(f[:-1] + ", value") for other in forms)]
    forms = [_PLACED.sub(r"(…, \1)", _ALTERNATIVES.sub(r"\1/…", form)) for form in forms]
    return " | ".join(forms) if entry.sort != "constant" else ""


def _names(*topics: str) -> str:
    return ", ".join(f"`{entry.name}`" for entry in _entries(topics))


def _fields() -> str:
    from aidl_lang.primitives import FIELDS
    from aidl_lang.types import PRIMITIVES

    return "\n".join(f"{kind}: {' '.join(fields)}" for kind, fields in FIELDS.items() if kind in PRIMITIVES)


def _reserved() -> str:
    from aidl_lang.syntax.tables import load_tables

    return " ".join(sorted(load_tables().reserved))


def _example(name: str) -> str:
    return f"```aidl\n{resource(f'examples/{name}.aidl').read_text('utf-8')}```"


_MAKERS: Mapping[str, Callable[..., str]] = {
    "calls": _calls,
    "forms": _forms,
    "names": _names,
    "fields": _fields,
    "reserved": _reserved,
    "example": _example,
}
