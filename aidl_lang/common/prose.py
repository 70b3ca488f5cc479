"""Parts of sentences: lists, counts, articles."""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable
from itertools import islice

_NAMED = 4
"""Names that a sentence lists."""


def ticked(words: Iterable[object], mark: str = "") -> list[str]:
    """Returns each word between backticks, with a mark before it."""
    return [f"`{mark}{word}`" for word in words]


def listed(words: Iterable[str], most: int | None = None, last: str = "and") -> str:
    """Returns `a`, `a and b`, `a, b and c`; in place of more than `most` words `a, b and 3 more`."""
    said = list(words)
    if most is not None and len(said) > most:
        said[most - 1 :] = [f"{len(said) - most + 1} more"]
    return f" {last} ".join(filter(None, [", ".join(said[:-1]), *said[-1:]]))


def named(names: Iterable[str], most: int = _NAMED) -> str:
    """Returns a list of names between backticks, each once."""
    return listed(ticked(dict.fromkeys(names)), most)


def first_few(words: Collection[str], most: int, rest: str = " and {} more", between: str = ", ") -> str:
    """Returns the first words; if there are more than `most`, with `rest`, which may say how many."""
    left = len(words) - most
    return between.join(islice(words, most)) + (rest.format(left) if left > 0 else "")


def did_you_mean(names: Iterable[str]) -> list[str]:
    """Returns a hint that names what may have been meant; no hint without names."""
    said = " or ".join(ticked(names))
    return [f"did you mean {said}?"] if said else []


def counted(count: int, noun: str, plural: str = "") -> str:
    """Returns `1 part`, `2 parts`."""
    return f"{count} {noun if count == 1 else plural or f'{noun}s'}"


def with_article(noun: object, bare: Container[str] = ("geometry",)) -> str:
    """Returns `a length`, `an angle`; what is not counted, `bare`, as it is."""
    word = str(noun)
    return word if word in bare else f"{'an' if word[0] in 'aeio' else 'a'} {word}"
