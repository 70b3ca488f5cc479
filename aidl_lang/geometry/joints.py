"""Outlines that touch each other in a point, with a joint there: boundary representations want a vertex where
two outlines of a face meet.
"""

from __future__ import annotations

from aidl_lang.geometry.evaluate import reverse
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.region import Face, Loop


def jointed(face: Face) -> Face:
    """Returns the face with the pieces of its outlines divided where these touch."""
    network = Network([piece for loop in face.loops for piece in loop.pieces])
    number, loops = 0, []
    for loop in face.loops:
        numbers = range(number, number + len(loop.pieces))
        number = numbers.stop
        pieces = [network.piece(use) for k in numbers for use in network.uses[k]]
        if loop.reversed and len(pieces) > 1:
            loops.append(Loop(tuple(reverse(piece) for piece in reversed(pieces))))
        else:
            loops.append(Loop(tuple(pieces), loop.reversed))
    return Face(loops[0], tuple(loops[1:]))
