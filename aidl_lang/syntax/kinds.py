"""The words that may stand before a structure's name, and the four kinds they mean."""

from __future__ import annotations

_WORDS = {
    "assembly": "assembly group model design product subassembly system mechanism",
    "solid": "solid part component body piece element",
    "hole": "hole cut cutout void pocket opening negative",
    "drawing": "drawing sketch annotation engraving reference guide",
}

KINDS: tuple[str, ...] = tuple(_WORDS)
KIND_OF_WORD: dict[str, str] = {word: kind for kind, words in _WORDS.items() for word in words.split()}


def kind_of(word: str) -> str | None:
    """Returns the kind a word means, without regard to case and underscores; None if it is no kind."""
    return KIND_OF_WORD.get(word.lower().replace("_", ""))
