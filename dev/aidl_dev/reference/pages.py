"""The reference as Markdown: a page for each topic, the table of signatures, and the index of all names."""

from __future__ import annotations

from collections.abc import Mapping

from aidl_lang.common.prose import ticked
from aidl_lang.tools.reference import entry_blocks, exactness_of, held_of, parts_of, picture
from aidl_lang.tools.reference.collect import Entry, Reference, Topic

MARK = "<!-- Made from the library by `make reference`. -->"
"""The last line of a generated page."""

_INDEX, _SIGNATURES, _IMAGES = "README.md", "signatures.md", "images"
_WIDTH = 200
"""Width of a picture on a page, in pixels; it is never higher than that."""

_INTRODUCTION = f"""\
Every public name with its signature, an example and the picture that the example draws. `aidl doc NAME` shows
the same in a terminal; [signatures.md]({_SIGNATURES}) has all signatures in tables,
[coverage.md](coverage.md) tells which constraint takes what. These pages are made from the library by
`make reference`.
"""
_TYPES = """\
A `length` is in millimetres and an `angle` or `turn` in degrees, unless a unit says otherwise. What has a
default (`= …`) may be left out. Arguments may be given in order or by name, with `:` or `=`. A `box` is
anything that has one: a structure, a geometry, or a list of them.
"""
_PLACING = """\
In a call, what is *held* stays on the first try, and the others are placed; only if that cannot satisfy
everything does it move too. A relation of *boxes* reads the upright rectangle around a thing, the others read
its curves. A measure is met `exactly`, or is what there is `at least` or `at most`.
"""
_GROUPS: Mapping[str, tuple[str, str]] = {
    "shape": ("Shapes", ""),
    "template": ("Parts", ""),
    "relation": ("Relations of boxes", _PLACING),
    "constraint": ("Constraints on geometry", ""),
    "function": ("Functions", ""),
    "builtin": ("Built in", ""),
    "constant": ("Constants", ""),
}


def pages(reference: Reference) -> dict[str, str]:
    """Returns every page by its path below `docs/reference`."""
    found = {f"{topic.name}.md": topic_page(reference, topic) for topic in reference.topics}
    return {_INDEX: _index(reference), _SIGNATURES: signature_page(reference), **found}


def pictures(reference: Reference) -> dict[str, bytes]:
    """Returns the drawing of every example by its path below `docs/reference`."""
    return {image(entry): picture(entry) for entry in reference.entries.values() if entry.doc.example}


def image(entry: Entry) -> str:
    return f"{_IMAGES}/{entry.name.replace('@', 'attribute_')}.svg"


def topic_page(reference: Reference, topic: Topic) -> str:
    entries = reference.of_topic(topic.name)
    links = ", ".join(f"[`{e.name}`](#{anchor(e)})" for e in entries)
    blocks = [f"# {topic.title}", *([topic.text] if topic.text else []), links]
    for entry in entries:
        blocks += entry_blocks(entry)
        if entry.doc.example:
            size = f'width="{_WIDTH}" height="{_WIDTH}"'
            blocks.append(f'<img src="{image(entry)}" alt="{entry.name}" {size}>')
    return page_of(blocks)


def signature_page(reference: Reference) -> str:
    """Returns one table of everything that can be called."""
    blocks = ["# Signatures", "Everything that can be called, by what it is.", _TYPES]
    for sort, (title, text) in _GROUPS.items():
        entries = [e for e in reference.entries.values() if e.sort == sort]
        if entries:
            blocks += [f"## {title}", *([text] if text else []), _table(sort, entries)]
    return page_of(blocks)


def _table(sort: str, entries: list[Entry]) -> str:
    columns = {"shape": ["parts"], "template": ["parts"]}
    heads = columns.get(sort, ["held", "measures"] if sort in ("relation", "constraint") else ["does"])
    rows = [f"| name | called as | {' | '.join(heads)} |", "|---" * (2 + len(heads)) + "|"]
    for entry in entries:
        called = "<br>".join(dict.fromkeys(f"`{_cell(o.form)}`" for o in entry.overloads))
        link = f"[{entry.name}]({entry.topic}.md#{anchor(entry)})"
        rows.append(f"| {link} | {called} | {' | '.join(_cells(sort, entry))} |")
    return "\n".join(rows)


def _cells(sort: str, entry: Entry) -> list[str]:
    if sort in ("shape", "template"):
        return [", ".join(ticked(parts_of(entry)))]
    if sort in ("relation", "constraint"):
        measures = ", ".join(f"`{name}` {word}" for name, word in exactness_of(entry).items())
        return [" or ".join(held_of(entry)), measures]
    return [_cell(entry.doc.line)]


def _index(reference: Reference) -> str:
    blocks = ["# Reference", _INTRODUCTION]
    for topic in reference.topics:
        blocks.append(f"## [{topic.title}]({topic.name}.md)")
        entries = reference.of_topic(topic.name)
        rows = [f"| [{e.name}]({topic.name}.md#{anchor(e)}) | {_cell(e.doc.line)} |" for e in entries]
        blocks.append("\n".join(["| | |", "|---|---|", *rows]))
    return page_of(blocks)


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def anchor(entry: Entry) -> str:
    """Returns the anchor that Markdown renderers give to the heading of an entry."""
    return entry.name.removeprefix("@").lower()


def page_of(blocks: list[str]) -> str:
    """Returns a generated page of some paragraphs."""
    return "\n\n".join(block.strip("\n") for block in [*blocks, MARK]) + "\n"
