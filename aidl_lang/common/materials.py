"""Densities and least walls of materials by the names that makers write (`materials.toml`)."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from functools import cache

from aidl_lang.common.names import nearest
from aidl_lang.common.resources import resource

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
