"""`llms.txt`: an index of this project for language models (llmstxt.org)."""

from __future__ import annotations

from itertools import takewhile
from pathlib import Path

from aidl_lang.tools.reference.collect import doc, reference

_HEAD = """\
# AIDL

> AIDL is a text language for 2D CAD. A program says what a thing is made of and how its parts relate; a
> constraint solver finds where everything goes, and an exact drawing comes out.

`aidl guide` prints the guide, `aidl doc NAME` tells about one name, `aidl explain CODE` about a diagnostic,
and `aidl check --fix` mends what can be mended.
"""
_FIRST = {
    "guide": "[Guide](docs/guide.md): the whole language on a few pages; start here",
    "language": "[Language](docs/language.md): the language in full, topic by topic, with programs",
    "cli": "[Command line](docs/cli.md): every verb, its options and exit codes",
    "json": "[JSON](docs/json.md): the solved model as data",
}
"""Pages for readers who write programs, in this order; other pages are optional."""


def llms(root: Path) -> str:
    """Returns the file for the checkout at `root`."""
    others = [path for path in (root / "docs").glob("*.md") if path.stem not in _FIRST]
    optional = sorted([*others, root / "eval/README.md"])
    first = [f"- {link}" for link in _FIRST.values()]
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
        "Optional": [_page(path, root) for path in optional],
    }
    return _HEAD + "".join(f"\n## {title}\n\n" + "\n".join(lines) + "\n" for title, lines in sections.items())


_INDEX = "- [All names](docs/reference/README.md): every public name in a line"
_SIGNATURES = "- [Signatures](docs/reference/signatures.md): every call with its arguments and parts"


def _page(path: Path, root: Path) -> str:
    """Returns the title of a page and the first sentence of its first paragraph of prose."""
    title, *rest = path.read_text("utf-8").split("\n\n")
    prose = next((p for p in rest if p[:1].isalnum()), "")
    about = doc(prose).line.rstrip(".")
    return f"- [{title.removeprefix('#').strip()}]({path.relative_to(root).as_posix()})" + (
        f": {about}" if about else ""
    )


def headline(program: str) -> str:
    """Returns the first sentence of the comment that a program begins with."""
    comment = takewhile(lambda line: line.startswith("//"), program.splitlines())
    return doc("\n".join(line.lstrip("/ ") for line in comment)).line


def _example(path: Path) -> str:
    return f"- [{path.stem}](examples/{path.name}): {headline(path.read_text('utf-8')).rstrip('.')}"
