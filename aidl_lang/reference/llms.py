"""`llms.txt`: where a language model finds what about this project (llmstxt.org)."""

from __future__ import annotations

from pathlib import Path

from aidl_lang.reference.collect import doc, reference

_HEAD = """\
# AIDL

> AIDL is a text language for 2D CAD. A program says what a thing is made of and how its parts relate; a
> constraint solver finds where everything goes, and an exact drawing comes out.

`aidl guide` prints the guide, `aidl doc NAME` tells about one name, `aidl explain CODE` about a diagnostic,
and `aidl check --fix` mends what can be mended.
"""
_FIRST = ("guide", "language", "cli", "json")
"""Pages that a reader who writes programs wants, in this order; the others are optional."""


def llms(root: Path) -> str:
    """The file for the checkout at `root`."""
    pages = {path.stem: path for path in sorted((root / "docs").glob("*.md")) if path.stem != "guide"}
    first = [_GUIDE, *(_page(pages.pop(name)) for name in _FIRST if name in pages)]
    topics = [
        f"- [{topic.title}](docs/reference/{topic.name}.md): "
        + ", ".join(entry.name for entry in reference().of_topic(topic.name))
        for topic in reference().topics
    ]
    examples = [_example(path) for path in sorted((root / "examples").glob("*.aidl"))]
    sections = {
        "Docs": first,
        "Reference": [_INDEX, _SIGNATURES, *topics],
        "Examples": examples,
        "Optional": [_page(path) for path in pages.values()],
    }
    return _HEAD + "".join(f"\n## {title}\n\n" + "\n".join(lines) + "\n" for title, lines in sections.items())


_GUIDE = "- [The guide](docs/guide.md): the whole language on a few pages; start here"
_INDEX = "- [All names](docs/reference/README.md): every public name in a line"
_SIGNATURES = "- [Signatures](docs/reference/signatures.md): every call with its arguments and parts"


def _page(path: Path) -> str:
    """A page by its title and the first sentence of its first paragraph of prose."""
    title, *rest = path.read_text("utf-8").split("\n\n")
    prose = next((p for p in rest if p[:1].isalnum()), "")
    about = doc(prose).line.rstrip(".")
    return f"- [{title.removeprefix('#').strip()}](docs/{path.name})" + (f": {about}" if about else "")


def _example(path: Path) -> str:
    """An example by its name and the comment it begins with."""
    head = path.read_text("utf-8").partition("\n")[0].lstrip("/ ").rstrip(".")
    return f"- [{path.stem}](examples/{path.name}): {head}"
