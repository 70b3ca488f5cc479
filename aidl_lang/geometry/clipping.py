"""Open curves cut to the inside of a region."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.geometry.boolean import section_of
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import inside_mask


def clipped(curves: Sequence[Piece], region: Region) -> list[Piece]:
    """Returns the parts of curves that lie inside."""
    pieces = [p for loop in region.loops for p in loop.pieces]
    network = Network([*pieces, *curves])
    section = section_of(network, region, 0)
    uses = [use for of_curve in network.uses[len(pieces) :] for use in of_curve]
    within = inside_mask(section, network.midpoints([edge for edge, _ in uses]))
    return [network.piece(use) for use, is_inside in zip(uses, within, strict=True) if is_inside]
