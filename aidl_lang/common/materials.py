"""Tables of makers: materials, sizes of paper, fits by ISO 286-1."""

from __future__ import annotations

import re
import tomllib
from bisect import bisect_left
from collections.abc import Mapping
from functools import cache

from aidl_lang.common.names import nearest
from aidl_lang.common.resources import resource

# --- Densities and least walls of materials by the names that makers write (`materials.toml`).

_TABLE = "aidl_lang/common/materials.toml"


@cache
def _known(what: str) -> Mapping[str, float]:
    """Returns a property by name, other names included, all in lower case; of what has none, its group's."""
    table = tomllib.loads(resource(_TABLE).read_text("utf-8"))
    found: dict[str, float] = {}
    for group in table.values():
        for name, entry in group.items():
            if isinstance(entry, dict):
                names = (name, *entry.get("also", ()))
                found |= dict.fromkeys(names, float(entry[what] if what in entry else group[what]))
    return found


def densities() -> Mapping[str, float]:
    """Returns kg/m³ by name."""
    return _known("density")


def density(material: str, own: Mapping[str, float] | None = None) -> float | None:
    """Returns the density in kg/m³ of the longest known name in a text, `own` names first.

    None if the text has no known name: `6 mm birch plywood` has one, `unobtainium` has none.
    """
    own = {_plain(name): value for name, value in (own or {}).items()}
    found = _of_longest(own, material)
    return _of_longest(densities(), material) if found is None else found


def least_wall(material: str) -> float | None:
    """Returns the width in mm below which a wall of the longest known name in a text does not last."""
    return _of_longest(_known("wall"), material)


def _of_longest(table: Mapping[str, float], material: str) -> float | None:
    text = _plain(material)
    known = [name for name in table if re.search(rf"(?<!\w){re.escape(name)}(?!\w)", text)]
    return table[max(known, key=lambda name: (len(name), name))] if known else None


def similar(material: str) -> list[str]:
    """Returns known names that a text, or a word in it, may be a misspelling of, best first."""
    text = _plain(material)
    words = [word for word in re.findall(r"\w+", text) if len(word) > 2]
    found = (name for part in (text, *words) for name in nearest(part, densities(), 3))
    return list(dict.fromkeys(found))[:3]


def _plain(text: str) -> str:
    """Returns a name in lower case, with `-`, `_` and any run of spaces as one space."""
    return re.sub(r"[\s_-]+", " ", text).strip().casefold()


# --- Sizes of paper.

PAPERS = {
    "a0": (841.0, 1189.0),
    "a1": (594.0, 841.0),
    "a2": (420.0, 594.0),
    "a3": (297.0, 420.0),
    "a4": (210.0, 297.0),
    "a5": (148.0, 210.0),
    "letter": (215.9, 279.4),
    "legal": (215.9, 355.6),
    "tabloid": (279.4, 431.8),
}
"""Width and height in mm, upright."""


# --- Fits: the limits of sizes by ISO 286-1, from its tolerance grades and fundamental deviations.

_UP_TO = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
"""Each range of sizes ends with this one, mm, and begins behind the one before it."""

_GRADES = {
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
    11: (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400),
}
"""Widths of the tolerance grades, µm, by range of sizes."""

_BELOW = {
    "d": (20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230),
    "e": (14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135),
    "f": (6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
    "g": (2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
    "h": (0,) * 13,
}
"""How far a shaft stays below its size at least, µm; a hole of the same letter stays as far above."""

_ABOVE = {
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68),
}
"""How far a shaft goes beyond its size at least, µm."""

_TIGHT_SHAFTS, _TIGHT_HOLES = (5, 6, 7), (7,)
"""Grades of shafts and holes of these letters; others have exceptions in the standard."""

LARGEST = _UP_TO[-1]


def is_fit(text: str) -> bool:
    """Tells whether a tolerance class is known: `H7`, `g6`, `js9`."""
    return _parsed(text) is not None


def limits(text: str, size: float) -> tuple[float, float] | None:
    """Returns the lower and upper deviation, mm, of a size of a tolerance class; None beyond 500 mm.

    Raises ValueError for a class that is not known.
    """
    parsed = _parsed(text)
    if parsed is None:
        raise ValueError(text)
    if not 0 < size <= LARGEST:
        return None
    letter, grade = parsed
    k = bisect_left(_UP_TO, size)
    width, kind = _GRADES[grade][k], letter.lower()
    is_hole = letter[0].isupper()
    if kind == "js":
        return -width / 2000, width / 2000
    if kind in _BELOW:
        apart = _BELOW[kind][k]
        low, high = (apart, apart + width) if is_hole else (-apart - width, -apart)
    else:
        beyond = _ABOVE[kind][k]
        if is_hole:
            # So that a hole with a shaft one grade finer fits as H does with its shaft (ISO 286-1, 4.3.2.5).
            eased = width - _GRADES[grade - 1][k] if size > _UP_TO[0] else 0
            low, high = eased - beyond - width, eased - beyond
        else:
            low, high = beyond, beyond + width
    return low / 1000, high / 1000


def _parsed(text: str) -> tuple[str, int] | None:
    found = re.fullmatch(r"(JS|js|[A-Za-z])(\d{1,2})", text)
    if found is None:
        return None
    letter, grade = found[1], int(found[2])
    kind = letter.lower()
    if grade not in _GRADES:
        return None
    if kind in _BELOW or kind == "js":
        return letter, grade
    allowed = _TIGHT_HOLES if letter.isupper() else _TIGHT_SHAFTS
    return (letter, grade) if kind in _ABOVE and grade in allowed else None
