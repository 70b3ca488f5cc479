"""Names as people and models spell them: lookup without regard to case and underscores, and suggestions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from itertools import accumulate
from typing import TypeVar

T = TypeVar("T")

_NUMBER = re.compile(r"\d+")
_FEWEST_LETTERS = 3
"""That a name must have for one that is wrong to leave no doubt."""
_WIDER = 6
"""Names beyond those wanted that are compared letter by letter."""
_MOST_LETTERS = 200_000
"""Pairs of letters that are compared in search of a name: some hundred names of ordinary length and more."""


def fold(name: str) -> str:
    """The form in which `CenterInside`, `centerInside` and `center_inside` are one name."""
    return name.replace("_", "").casefold()


def find(name: str, table: Mapping[str, T]) -> str | None:
    """The key of `table` that `name` means: as written if it is there, else the one that folds alike.

    None when there is none, or when two keys fold alike and neither is written so.
    """
    if name in table:
        return name
    wanted = fold(name)
    alike = [key for key in table if fold(key) == wanted]
    return alike[0] if len(alike) == 1 else None


_OPPOSITES = tuple(
    tuple(tuple(words.split()) for words in line.split(" | "))
    for line in """
smaller narrower shorter less fewer | larger bigger wider taller longer greater more
lower under below beneath | higher over above
left | right
top | bottom
up | down
inside inner within | outside outer
horizontal level | vertical upright
parallel | perpendicular
start first begin | end last
min | max
near | far
row | column
front | back
before | after
most | least
convex | concave
clockwise | counterclockwise anticlockwise
""".strip().splitlines()
)
"""Words that mean the reverse of those on the other side of the bar."""


def are_opposite(a: str, b: str) -> bool:
    """Whether two names differ by a word and the reverse of it, as `align_left` and `align_right` do."""
    one, other = fold(a), fold(b)
    return any(
        any(w in one and w not in other for w in here) and any(w in other and w not in one for w in there)
        for pair in _OPPOSITES
        for here, there in (pair, pair[::-1])
    )


class Spellings:
    """Answers `find` for a table that grows, without looking through the whole of it each time."""

    def __init__(self, table: Mapping[str, object]) -> None:
        self._table = table
        self._known = 0
        self._alike: dict[str, list[str]] = {}

    def find(self, name: str) -> str | None:
        if name in self._table:
            return name
        if len(self._table) != self._known:
            self._known = len(self._table)
            self._alike = {}
            for key in self._table:
                self._alike.setdefault(fold(key), []).append(key)
        alike = self._alike.get(fold(name), ())
        return alike[0] if len(alike) == 1 else None


def nearest(name: str, known: Iterable[str], count: int = 1) -> list[str]:
    """Known names that `name` may be a misspelling of, best first; never one that means the reverse. A single
    letter is a misspelling of nothing.
    """
    if len(name) < 2:
        return []
    folded: dict[str, str] = {}
    for key in known:
        folded.setdefault(fold(key), key)
    likeness = 0.6 if len(name) < 5 else 0.7  # one wrong letter weighs more in a short name
    wanted = fold(name)
    most = _MOST_LETTERS // max(len(wanted), 1)
    found = get_close_matches(wanted, _within(folded, len(wanted), most), n=count + _WIDER, cutoff=likeness)
    matches = [match for match in found if not are_opposite(wanted, match)]
    matches.sort(key=lambda match: _distance(wanted, match))
    return [folded[match] for match in matches[:count]]


def _within(names: Mapping[str, str], length: int, letters: int) -> list[str]:
    """The names that are about so long, as many of them as have so many letters together."""
    by_length = sorted(names, key=lambda each: abs(len(each) - length))
    ends = accumulate(map(len, by_length))
    return [each for each, end in zip(by_length, ends, strict=True) if end <= letters]


def is_spelled_in(letters: str, word: str) -> bool:
    """Whether the letters stand in a word in their order, as those do that somebody types to find it."""
    rest = iter(fold(word))
    return all(letter in rest for letter in fold(letters))


def is_slip(name: str, meant: str) -> bool:
    """Whether one name is so near to the other that nobody need be asked: a letter wrong, missing, too many
    or exchanged with its neighbour, two in a long name but not in a short word of it. A word more is none:
    `same_center_x`; nor is another number: `hole3` is not `hole2`; nor a letter of one or two: `x10`, `s10`.
    """
    if fold(name) == fold(meant):
        return True
    if _NUMBER.findall(name) != _NUMBER.findall(meant) or sum(map(str.isalpha, name)) < _FEWEST_LETTERS:
        return False
    words, others = name.casefold().split("_"), meant.casefold().split("_")
    if len(words) != len(others) or _distance(fold(name), fold(meant)) > _most_slips(fold(name)):
        return False
    return all(_distance(x, y) <= _most_slips(x) for x, y in zip(words, others, strict=True))


def _most_slips(word: str) -> int:
    return 1 if len(word) < 8 else 2


def _distance(a: str, b: str) -> int:
    """Slips between two words, a letter that stands at most one place off counting once."""
    above: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        further, above, row = above, row, [i]
        for j, y in enumerate(b, 1):
            row.append(min(above[j] + 1, row[j - 1] + 1, above[j - 1] + (x != y)))
            if i > 1 and j > 1 and x == b[j - 2] and y == a[i - 2]:
                row[j] = min(row[j], further[j - 2] + 1)
    return row[-1]
