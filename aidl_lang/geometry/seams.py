"""The edges of united structures and geometries that run inside their body: fine lines in pictures,
nothing in cutting formats.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from aidl_lang.geometry.bodies import Mass
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.evaluate import part
from aidl_lang.geometry.faces import OwnFace
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.sections import Section, inside_mask, union
from aidl_lang.geometry.trace import Traced, trace_all


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


def inner_seams(
    network: Network,
    mass: Mass,
    traced: Mapping[str, Traced],
    sections: Mapping[str, Section],
    faces: Mapping[str, Sequence[OwnFace]],
) -> Iterator[tuple[str, tuple[Piece, ...]]]:
    """Yields the edges of the faces that some structures of a body draw, as far as they lie inside it and no
    later face of the structure, and no structure in it, lies over them; by the path of the structure, each
    drawn once.
    """
    taken = {edge for path in (*mass.inner, mass.structure.path) for edge in traced[path].edges}
    for path in (*mass.inner, mass.structure.path):
        own = [face.section for face in faces.get(path, ())]
        over = union([sections[inner] for inner in mass.inner if inner.startswith(f"{path}.")])
        found: set[int] = set()
        outlines = trace_all(network, own)
        for section, outline in zip(reversed(own), reversed(outlines), strict=True):
            candidates = sorted(outline.edges - taken)
            spots = network.midpoints(candidates)
            seen = inside_mask(mass.section, spots) & ~inside_mask(over, spots)
            found.update(edge for edge, is_seen in zip(candidates, seen, strict=True) if is_seen)
            taken.update(candidates)
            over = union([over, section])
        if found:
            yield path, tuple(_merged(network, sorted(found)))


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
