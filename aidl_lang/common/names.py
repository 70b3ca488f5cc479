"""Names as people and models spell them: lookup without regard to case and underscores, and suggestions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import lru_cache
from itertools import accumulate
from typing import TypeVar

from aidl_lang.common.lexicon import NEAR_WORDS, WORDS

T = TypeVar("T")

_NUMBER = re.compile(r"\d+")
_FEWEST_LETTERS = 3
"""That a name must have for one that is wrong to leave no doubt."""
_WIDER = 6
"""Names beyond those wanted that are compared letter by letter."""
_MOST_LETTERS = 200_000
"""Pairs of letters that are compared in search of a name: some hundred names of ordinary length and more."""


@lru_cache(maxsize=4096)
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
smaller narrower shorter less fewer thinner | larger bigger wider taller longer greater more thicker
small narrow short thin | large big wide tall long thick
lower under below beneath | higher over above upper
left | right
top | bottom
up | down
inside inner within | outside outer
inset | outset
in | out
horizontal horizontally level | vertical vertically upright
parallel | perpendicular
start first begin | end last
min minimum | max maximum
minor | major
near nearest | far farthest
row | column
rows | columns
front | back
before | after
most | least
same equal | different unequal
convex | concave
concentric | eccentric
clockwise cw | counterclockwise anticlockwise ccw
internal | external
union add | difference subtract
hole | solid
x rx dx cx | y ry dy cy
x1 x2 | y1 y2
width | height
positive | negative
""".strip().splitlines()
)
"""Words that mean the reverse of those on the other side of the bar, or its counterpart."""
_TURNING = ("no", "not", "non", "never", "without", "by")
"""Words that turn the meaning of the rest round."""
_PART_OF_A_NAME = 4
"""Letters from which on a word is known inside a longer one: `alignleft`."""


def are_opposite(a: str, b: str) -> bool:
    """Whether two names differ by a word and the reverse of it, as `align_left` and `align_right` do, or one
    of them denies or turns round what the other says: `no_overlap`, `contained_by`.
    """
    if any(_says(a, word) != _says(b, word) for word in _TURNING) or any(
        _denies(*p) for p in _differing(a, b)
    ):
        return True
    return any(
        any(_says(a, w) and not _says(b, w) for w in here)
        and any(_says(b, w) and not _says(a, w) for w in there)
        for pair in _OPPOSITES
        for here, there in (pair, pair[::-1])
    )


def _denies(a: str, b: str) -> bool:
    """Whether one of two words is the other with a syllable before it that turns it round."""
    return any(a == before + b or b == before + a for before in ("anti", "counter", "dis", "non", "un"))


def _says(name: str, word: str) -> bool:
    return word in fold(name) if len(word) >= _PART_OF_A_NAME else word in name.casefold().split("_")


def means_otherwise(name: str, other: str) -> bool:
    """Whether two names differ in a word that says something else in each: `same_side` and `same_size`."""
    return any(
        a in WORDS and b in WORDS and not _are_forms(a, b) for a, b in _differing(name, other) if a and b
    )


def _differing(name: str, other: str) -> list[tuple[str, str]]:
    """The words at one place that are not the same; none where the names have not as many words."""
    words, others = name.casefold().split("_"), other.casefold().split("_")
    return [(a, b) for a, b in zip(words, others, strict=True) if a != b] if len(words) == len(others) else []


def _are_forms(a: str, b: str) -> bool:
    """Whether two words are one: `center`, `centre`, `centers`, `centered`."""
    a, b = (word.replace("centre", "center").replace("centr", "center") for word in (a, b))
    return not {a, _ENDING.sub("", a)}.isdisjoint((b, _ENDING.sub("", b)))


_ENDING = re.compile(r"(?:e?s|e?d)$")


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
    """Known names that `name` may be a misspelling of, best first; never one that means the reverse, or is
    another word. A single letter is a misspelling of nothing.
    """
    if len(name) < 2:
        return []
    folded: dict[str, str] = {}
    for key in known:
        folded.setdefault(fold(key), key)
    likeness = 0.6 if len(name) < 5 else 0.7  # one wrong letter weighs more in a short name
    wanted = fold(name)
    most = _MOST_LETTERS // max(len(wanted), 1)
    from difflib import get_close_matches  # most programs are spelled right

    found = get_close_matches(wanted, _within(folded, len(wanted), most), n=count + _WIDER, cutoff=likeness)
    matches = [match for match in found if _may_be_meant(name, folded[match])]
    matches.sort(key=lambda match: _distance(wanted, match))
    return [folded[match] for match in matches[:count]]


def _may_be_meant(name: str, other: str) -> bool:
    """Whether one may ask if a name was meant for another: they are near, and do not say different things."""
    if are_opposite(name, other) or means_otherwise(name, other):
        return False
    wanted, match = fold(name), fold(other)
    if wanted in match or match in wanted:
        return True
    pairs = [(wanted, match), *_differing(name, other)]
    return all(_distance(a, b) <= max(1, len(a) // 3) for a, b in pairs)


def _within(names: Mapping[str, str], length: int, letters: int) -> list[str]:
    """The names that are about so long, as many of them as have so many letters together."""
    by_length = sorted(names, key=lambda each: abs(len(each) - length))
    ends = accumulate(map(len, by_length))
    return [each for each, end in zip(by_length, ends, strict=True) if end <= letters]


def is_spelled_in(letters: str, word: str) -> bool:
    """Whether the letters stand in a word in their order, as those do that somebody types to find it."""
    rest = iter(fold(word))
    return all(letter in rest for letter in fold(letters))


def is_like(name: str, meant: str) -> bool:
    """Whether one name is so near to the other that it may be put in its place where that is asked for: a
    letter wrong, missing, too many or exchanged with its neighbour, two in a long name but not in a short
    word of it. A word more is too much: `same_center_x`; so is another number: `hole3` is not `hole2`; or a
    letter of one or two: `x10`, `s10`.
    """
    if fold(name) == fold(meant):
        return True
    if _NUMBER.findall(name) != _NUMBER.findall(meant) or sum(map(str.isalpha, name)) < _FEWEST_LETTERS:
        return False
    words, others = name.casefold().split("_"), meant.casefold().split("_")
    if len(words) != len(others) or _distance(fold(name), fold(meant)) > _most_slips(fold(name)):
        return False
    return all(_distance(x, y) <= _most_slips(x) for x, y in zip(words, others, strict=True))


def is_slip(name: str, meant: str) -> bool:
    """Whether nobody need be asked what a name was to be: it is like the other one, and the words in which
    they differ are no words as they are written, but slips of the pen in those that are meant.
    """
    if not is_like(name, meant) or are_opposite(name, meant):
        return False
    return fold(name) == fold(meant) or all(_is_slip_in(a, b) for a, b in _differing(name, meant))


def _is_slip_in(written: str, word: str) -> bool:
    """Whether a word was meant for another: letters exchanged, one doubled or not, one missing or too many
    within the word, or in a long word another one there. A short word may as well be another, as may be one
    with another beginning or ending: `fat` and `flat`, `plate` and `slate`, `bolt` and `bolts`.
    """
    if written in WORDS or written in NEAR_WORDS or min(len(written), len(word)) < _FEWEST_LETTERS:
        return False
    if sorted(written) == sorted(word):
        return True
    if _are_forms(written, word) or written[0] != word[0] or min(len(written), len(word)) < _SHORT:
        return False
    if _LETTERS.sub(r"\1", written) == _LETTERS.sub(r"\1", word):
        return True
    if word[:-1] == written and len(written) > _SHORT and word[-1] not in _INFLECTIONS:
        return True
    has_end = written[-1] == word[-1]
    return has_end and (len(written) != len(word) or len(written) >= _LONG)


_LETTERS = re.compile(r"(.)\1+")
_INFLECTIONS = "sdry"
"""Letters that make another form of a word."""
_SHORT, _LONG = 5, 8
"""Letters from which on a word is no other word for one letter missing, and for another letter."""


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
