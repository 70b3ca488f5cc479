"""Joins curves end to end, for machines that draw them in one go."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.evaluate import ends, is_closed, reverse
from aidl_lang.geometry.network import Weld

Chain = tuple[Piece, ...]


def chains(pieces: Sequence[Piece], tolerance: float) -> list[Chain]:
    """Joins pieces to chains as long as possible; each piece occurs once, reversed if its neighbours need it.

    A chain ends where nothing follows within the tolerance (mm) and where more than two ends meet. Whole
    circles and ellipses stand alone.
    """
    weld = Weld(tolerance)
    nodes = [tuple(map(weld.number, ends(p))) for p in pieces]
    meeting: dict[int, list[int]] = defaultdict(list)
    for number, piece in enumerate(pieces):
        for node in () if is_closed(piece) else nodes[number]:
            meeting[node].append(number)
    left = dict.fromkeys(range(len(pieces)))

    def follow(node: int) -> list[Piece]:
        """Removes and returns the pieces that continue from a node."""
        found = []
        while len(meeting[node]) == 2 and (more := [n for n in meeting[node] if n in left]):
            (number,) = more
            del left[number]
            start, end = nodes[number]
            found.append(pieces[number] if start == node else reverse(pieces[number]))
            node = end if start == node else start
        return found

    result = []
    while left:
        number = next(iter(left))
        del left[number]
        start, end = nodes[number]
        after = follow(end)
        before = [reverse(piece) for piece in reversed(follow(start))]
        result.append((*before, pieces[number], *after))
    return result
