"""The edges of united structures that run inside their body: fine lines in pictures, nothing in cutting
formats.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from aidl_lang.geometry.bodies import Mass
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.evaluate import part
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.sections import inside_mask
from aidl_lang.geometry.trace import Traced


def visible_seams(
    network: Network, mass: Mass, traced: Mapping[str, Traced]
) -> Iterator[tuple[str, tuple[Piece, ...]]]:
    """Yields the edges of each united structure inside the body, by its path, each drawn once."""
    outline = traced[mass.structure.path].edges
    candidates = sorted({edge for path in mass.inner for edge in traced[path].edges} - outline)
    mask = inside_mask(mass.section, network.midpoints(candidates))
    left = {edge for edge, within in zip(candidates, mask, strict=True) if within}
    for path in mass.inner:
        edges = sorted(traced[path].edges & left)
        left.difference_update(edges)
        if edges:
            yield path, tuple(_merged(network, edges))


def _merged(network: Network, edges: list[int]) -> Iterator[Piece]:
    """Yields edges that follow each other on one curve as one piece."""
    start = None
    for number, after in zip(edges, [*edges[1:], None], strict=True):
        edge, start = network.edges[number], network.edges[number] if start is None else start
        following = network.edges[after] if after is not None else None
        if following and following.curve == edge.curve and following.t0 == edge.t1:
            continue
        curve, nodes = network.curves[edge.curve], network.nodes
        yield part(curve, start.t0, edge.t1, nodes[start.start], nodes[edge.end])
        start = None
