"""Searches the names of the library and the pages on diagnostics.

A document counts for the words of the query that it has: more in its name than in its text, and more for
words that few documents have (the inverse document frequency of text retrieval), and more if it has all of
them.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache

from aidl_lang.common import resources
from aidl_lang.common.records import record
from aidl_lang.tools.reference.collect import Entry, reference

_WORD = re.compile(r"[^\W_]+")
_ENDINGS = ("ings", "ing", "ies", "es", "ed", "s", "ly", "y")
_SHORTEST = 3
"""Least letters of a word without its ending."""
_NAME, _SUMMARY, _TEXT = 6.0, 3.0, 1.0
_IS_THE_NAME = 40.0
_STOP = frozenset(
    _WORD.findall(
        "a an and another are as at be by can do each for from how i in is it make of on one or other put "
        "that the this to two want with"
    )
)

_PLAIN = {
    "text": "size of the letters, label, caption, lettering, write, word, engrave",
    "hole": "cutout, cut out, opening, window, drill, remove, subtract",
    "screw_hole": "hole for a screw",
    "countersink": "countersunk head, screw head, sunk",
    "@thickness": "extrude, extrusion, thick, 3d, height of a body",
    "inside": "distance from the edge, distance from the edges, border, inset",
    "distance": "distance from the edge",
    "fillet": "round a corner, rounded edge, radius of a corner",
    "mirror": "flip, reflect",
    "in": "inch, inches, unit, imperial",
    "param": "variable, knob, parameter, setting",
    "import": "include, load, use another file, svg, dxf",
    "@material": "wood, plywood, stock",
}
"""Words by which somebody new asks for a name, where its documentation has others."""


@record()
class _Document:
    """An entry, or the code of a diagnostic, with the weight of each of its words."""

    about: Entry | str
    names: frozenset[str]
    weights: Mapping[str, float]


def search(query: str, most: int) -> list[Entry | str]:
    """Returns the entries and codes that fit a query best, best first."""
    found = [about for about, _ in _scored(query)][:most]
    return found or [entry for entry in [reference().misspelt(query.strip())] if entry is not None]


def speaking_of(query: str) -> list[Entry]:
    """Returns the entries that have every word of a query, best first."""
    return [about for about, share in _scored(query) if share == 1.0 and isinstance(about, Entry)]


def _scored(query: str) -> list[tuple[Entry | str, float]]:
    """Returns what fits a query, best first, each with its share of the words; equal ones in the order of the
    reference.
    """
    words = list(dict.fromkeys(stems(query)))
    documents = _documents()
    wanted = "".join(_WORD.findall(query)).casefold()
    scored = []
    for number, document in enumerate(documents):
        score = sum(_rarity(word) * document.weights.get(word, 0.0) for word in words)
        share = sum(word in document.weights for word in words) / max(1, len(words))
        score *= share
        if wanted in document.names:
            score += _IS_THE_NAME
        if score:
            scored.append((-score, number, share))
    return [(documents[number].about, share) for _, number, share in sorted(scored)]


@cache
def _documents() -> tuple[_Document, ...]:
    return (*map(_of_entry, reference().entries.values()), *map(_of_code, resources.codes()))


@cache
def _rarity(word: str) -> float:
    documents = _documents()
    having = sum(word in document.weights for document in documents)
    return math.log(1.0 + len(documents) / (1 + having))


def _of_entry(entry: Entry) -> _Document:
    weights = _weighed(
        *((_NAME / len(list(stems(name)) or "1"), name) for name in (entry.name, *entry.synonyms)),
        (_SUMMARY, f"{entry.doc.line} {entry.topic}"),
        (_NAME, _PLAIN.get(entry.name, "")),
        (_TEXT, " ".join([entry.doc.text, *(f"{o.form} {o.doc.line}" for o in entry.overloads)])),
    )
    names = {"".join(_WORD.findall(name)).casefold() for name in (entry.name, *entry.synonyms)}
    return _Document(entry, frozenset(names), weights)


def _of_code(code: str) -> _Document:
    title, page = resources.title(code), resources.page(code)
    prose = page.partition("\n## ")[0].partition("\n")[2]
    return _Document(code, frozenset({code.casefold()}), _weighed((_SUMMARY, title), (_TEXT, prose)))


def _weighed(*parts: tuple[float, str]) -> dict[str, float]:
    """Returns the words of some texts, each with the weight of its most important text; repetition adds
    little.
    """
    weights: dict[str, float] = {}
    for weight, text in parts:
        for word, times in Counter(stems(text)).items():
            weights[word] = max(weights.get(word, 0.0), weight * (1.0 + 0.1 * math.log(times)))
    return weights


def stems(text: str) -> Iterator[str]:
    """Yields the words of a text, folded, without their endings."""
    for word in _WORD.findall(text.casefold()):
        if word in _STOP:
            continue
        ending = next((e for e in _ENDINGS if word.endswith(e) and len(word) - len(e) >= _SHORTEST), "")
        yield word.removesuffix(ending)
