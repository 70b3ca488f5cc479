"""Folding ranges: blocks, calls and lists over several lines, comments, imports.

Brackets are paired in the text itself, so a program that does not parse folds too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from aidl_lang.common.records import record
from aidl_lang.syntax.tokens import Token
from aidl_lang.tools.ide.view import View

_CLOSES = {"}": "{", "]": "[", ")": "("}


@record()
class Fold:
    """Lines from `start`, which stays visible, to `end`, both from 1. `kind` is `region`, `comment` or
    `imports`.
    """

    start: int
    end: int
    kind: str = "region"


def folds(view: View) -> list[Fold]:
    """Returns folds by their first line; of two that begin in one line the longer."""
    tokens = view.tokens

    def line(offset: int) -> int:
        return view.source.position(offset)[0]

    comments = [(line(c.span.start), line(c.span.end)) for c in tokens.comments]
    imports = [(line(t.start), line(t.start)) for t in tokens.tokens if t.kind == "import"]
    found: dict[int, Fold] = {}
    for fold in (
        *(Fold(a, b, "comment") for a, b in _runs(comments)),
        *(Fold(a, b, "imports") for a, b in _runs(imports)),
        *(Fold(line(a), line(b) - 1) for a, b in _brackets(tokens.tokens)),
    ):
        if fold.end > fold.start and (known := found.get(fold.start, fold)).end <= fold.end:
            found[known.start] = fold
    return [found[start] for start in sorted(found)]


def _brackets(tokens: Iterable[Token]) -> Iterator[tuple[int, int]]:
    """Yields the offsets of paired brackets; a closing bracket without an open one is skipped."""
    opened: list[tuple[str, int]] = []
    for token in tokens:
        if token.kind in _CLOSES.values() or token.kind == "CALL":
            opened.append(("(" if token.kind == "CALL" else token.kind, token.start))
        elif (wanted := _CLOSES.get(token.kind)) in [kind for kind, _ in opened]:
            while (pair := opened.pop())[0] != wanted:
                pass
            yield pair[1], token.start


def _runs(lines: Iterable[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Joins adjacent ranges of lines."""
    start = end = -1
    for first, last in lines:
        if first > end + 1:
            if start >= 0:
                yield start, end
            start = first
        end = last
    if start >= 0:
        yield start, end
