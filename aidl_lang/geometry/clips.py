"""What structures are clipped to, in the network of curves: solids and holes lie inside of it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from itertools import count

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import named
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.described import as_geometry
from aidl_lang.geometry.faces import Shape, own_faces, union_of
from aidl_lang.geometry.network import Network
from aidl_lang.geometry.sections import Section
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure

Clips = Mapping[str, Shape]
"""By the path of the structure that states it, the outline that one is clipped to."""


def clip_shapes(root: SolvedStructure, first: int) -> tuple[dict[str, Shape], list[Piece]]:
    """Returns the outlines that structures are clipped to, with their curves, which have the numbers from
    `first` on in the network.
    """
    shapes: dict[str, Shape] = {}
    curves: list[Piece] = []
    numbers = count(first)
    for s in root.walk():
        if s.inside is not None:
            whole = SolvedGeometry("clip", f"{s.path}.clip", "clip", {}, None, (), False, s.span)
            pieces = s.inside.pieces
            leaves = (as_geometry(f"edges[{k}]", whole, piece) for k, piece in enumerate(pieces))
            shapes[s.path] = Shape(whole, tuple(zip(leaves, numbers, strict=False)))
            curves += pieces
    return shapes, curves


def clip_sections(network: Network, root: SolvedStructure, shapes: Clips) -> dict[str, Section]:
    """Returns what each structure that is clipped, or lies in one that is, may lie in."""
    return dict(_clip_sections(network, root, shapes, None)) if shapes else {}


def _clip_sections(
    network: Network, s: SolvedStructure, shapes: Clips, around: Section | None
) -> Iterator[tuple[str, Section]]:
    """Yields the sections of a structure and of what lies in it, which is clipped to `around`, too.

    No closure, which would keep itself and what it holds: Manifold tells of sections left at the end.
    """
    if s.path in shapes:
        around = union_of(own_faces(network, [shapes[s.path]]).faces)
    if around is not None:
        yield s.path, around
    for child in s.structures:
        yield from _clip_sections(network, child, shapes, around)


def empty_clips(root: SolvedStructure, drawn: Collection[str]) -> Iterator[Diagnostic]:
    """Yields errors about structures of which nothing is left inside; `drawn`: the paths of those of which
    something is there.
    """
    if root.inside is not None and not any(s.path in drawn for s in root.walk()):
        if any(True for s in root.walk() for g in s.geometry for _ in g.curves()):
            yield _nothing_left(root)
        return
    for child in root.structures:
        yield from empty_clips(child, drawn)


def _nothing_left(s: SolvedStructure) -> Diagnostic:
    of = f"the material of `{s.ground}`" if s.ground is not None else named([g.name for g in s.clip])
    return Diagnostic(
        "E0339",
        f"nothing of `{s.path}` lies inside {of}, to which it is clipped",
        s.span,
        "nothing is drawn of this",
        hints=("place the two so that they overlap, as they shall in the drawing",),
    )
