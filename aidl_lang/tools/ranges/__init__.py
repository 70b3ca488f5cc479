"""Walks each param of a program over its whole range, and tells where something changes kind.

`looks` says what a kind is, `walking` how the way is made, `pairs` what two params do together, `telling`
what is said of it.
"""

from aidl_lang.tools.ranges.telling import described, findings, sentence, sentences, summary, together, turned
from aidl_lang.tools.ranges.walking import Ranges, Turn, Walk, has_way, ranges

__all__ = [
    "Ranges",
    "Turn",
    "Walk",
    "described",
    "findings",
    "has_way",
    "ranges",
    "sentence",
    "sentences",
    "summary",
    "together",
    "turned",
]
