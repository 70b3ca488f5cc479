"""Makes a program smaller that has some property: lines first, then tokens, then characters (delta debugging:
Zeller and Hildebrandt, Simplifying and Isolating Failure-Inducing Input, 2002).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from itertools import pairwise

from aidl_lang.common.source import SourceFile
from aidl_lang.syntax.tables import tokenize


def minimised(text: str, holds: Callable[[str], bool], seconds: float) -> str:
    """The smallest text found in that time for which the property still holds."""
    until = time.monotonic() + seconds

    def still(parts: Sequence[str]) -> bool:
        return time.monotonic() < until and holds("".join(parts))

    before = ""
    while text != before and time.monotonic() < until:
        before = text
        for split in (lambda whole: whole.splitlines(keepends=True), _tokens, list):
            if split is not list or len(text) < 400:
                text = "".join(_reduced(split(text), still))
    return text


def _tokens(text: str) -> list[str]:
    ends = [0, *(token.end for token in tokenize(SourceFile("fuzz", text)).tokens), len(text)]
    return [text[a:b] for a, b in pairwise(ends) if b > a]


def _reduced(parts: list[str], holds: Callable[[Sequence[str]], bool]) -> list[str]:
    """As few of the parts as are needed: runs of them are left out, long ones first."""
    size = len(parts) // 2
    while size:
        at = 0
        while at < len(parts):
            fewer = parts[:at] + parts[at + size :]
            if holds(fewer):
                parts = fewer
            else:
                at += size
        size //= 2
    return parts
