"""Numbers and parts of sentences: the same digits on every run, lists, counts, articles."""

from __future__ import annotations

import math
from collections.abc import Collection, Container, Iterable, Mapping, Sequence
from itertools import islice
from typing import Any

# --- Numbers in texts: the same digits on every run.

_MOST_DECIMALS = 15


def fixed(value: float, decimals: int = 6) -> str:
    """Returns a number with at most so many decimals, without trailing zeros or a minus before zero."""
    text = f"{value:.{decimals}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def shortest(value: float, tolerance: float) -> str:
    """Returns the decimal with the fewest places that is within `tolerance`."""
    for places in range(_MOST_DECIMALS):
        if abs(round(value, places) - value) <= tolerance:
            return fixed(value, places)
    return fixed(value, _MOST_DECIMALS)


def short(value: float, decimals: int = 6) -> str:
    """Returns a number for a sentence: six significant digits, so many decimals at most, never `-0`."""
    return f"{round(value, decimals) + 0.0:.6g}"


def rough(value: float) -> str:
    """Returns a length for a sentence: four significant digits, no exponent for ordinary sizes."""
    return f"{value + 0.0:.4g}"


def literal(value: float | str | bool, digits: int = 6, unit: str = "") -> str:
    """Returns a value as the language writes it; a number with so many significant digits."""
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else f"{value:.{digits}g}{unit}"


def significant(value: float) -> float:
    """Returns a number rounded to 12 significant digits, past which rounding errors begin; -0 becomes 0."""
    if value == 0 or not math.isfinite(value):
        return 0.0 if value == 0 else value
    return float(f"{value:.12g}")


def rounded(value: Any) -> Any:
    """Returns data for JSON with its numbers as `significant` rounds them; infinities and NaN become null."""
    if isinstance(value, float):
        value = significant(value)
        return value if value - value == 0 else None
    if isinstance(value, Mapping):
        return {key: rounded(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(v) for v in value]
    return value


def size_text(size: Sequence[float]) -> str:
    """Returns width and height in mm for a sentence: `600 × 400 mm`."""
    return f"{fixed(size[0], 3)} × {fixed(size[1], 3)} mm"


# --- Parts of sentences: lists, counts, articles.

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


def shortened(text: str, most: int) -> str:
    """Returns a text of at most so many characters, with `…` for the rest."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


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
