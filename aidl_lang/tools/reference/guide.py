"""The guide: the language on a few pages, a page for each variant (`docs/guide.md`, `docs/guides`)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from aidl_lang.checking.subset import Variant
from aidl_lang.common.resources import resource
from aidl_lang.tools.reference.collect import reference
from aidl_lang.tools.reference.pages import entry_blocks


@cache
def guide(variant: Variant = Variant.FULL) -> str:
    """Returns the guide as Markdown."""
    name = "docs/guide.md" if variant is Variant.FULL else f"docs/guides/{variant}.md"
    return resource(name).read_text("utf-8")


def guide_with(topics: Sequence[str]) -> str:
    """Returns the guide and, after it, the entries of the reference on some topics, without pictures. Raises
    KeyError for a topic that does not exist.
    """
    known = {topic.name: topic for topic in reference().topics}
    blocks = [guide().strip(), "# Reference"]
    for name in topics:
        blocks.append(f"## {known[name].title}")
        for entry in reference().of_topic(name):
            blocks += entry_blocks(entry, "###")
    return "\n\n".join(blocks) + "\n"


def full_guide() -> str:
    """Returns the guide with the whole reference."""
    return guide_with([topic.name for topic in reference().topics])
