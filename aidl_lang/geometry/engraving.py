"""The parts that drawings are engraved on, for drawings whose parts are taken from one another."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from aidl_lang.geometry.boolean import section_of
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.drawing import SLIT, Body, Stroke
from aidl_lang.geometry.evaluate import NO_LENGTH, Bounds, bounds, reverse
from aidl_lang.geometry.measures import length
from aidl_lang.geometry.network import Network, union_bounds
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.sections import inside_mask


def engraved(
    bodies: Sequence[Body], strokes: Sequence[Stroke]
) -> tuple[dict[str, list[Stroke]], list[Stroke]]:
    """Returns the strokes of drawings by the path of their body, and the strokes on no body."""
    by_path = {body.path: body for body in bodies}
    around = {owner(by_path, body.path.rpartition(".")[0]) for body in bodies}  # these have others in them
    on: dict[str, list[Stroke]] = {}
    off: list[Stroke] = []
    for stroke in strokes:
        if stroke.role not in ("drawing", SLIT):
            continue
        holder = owner(by_path, stroke.path)
        if holder is not None and holder not in around:
            on.setdefault(holder, []).append(stroke)
            continue
        rest = stroke.pieces
        for body in _by_cover(stroke, bodies):
            if not rest:
                break
            inside, rest = divided(rest, body.region)
            if inside:
                on.setdefault(body.path, []).extend(_cut_off(stroke, inside))
        if _length(rest) > NO_LENGTH:
            off.append(replace(stroke, pieces=rest))
    return on, off


def _cut_off(stroke: Stroke, inside: tuple[Piece, ...]) -> Iterator[Stroke]:
    """Yields a stroke as far as it lies on a body: letters whole, with what they enclose, or as lines."""
    if not stroke.faces or inside == stroke.pieces:
        yield replace(stroke, pieces=inside)
        return
    here = {*inside, *map(reverse, inside)}
    whole = [f for f in stroke.faces if all(p in here for loop in f.loops for p in loop.pieces)]
    enclosing = {p for f in whole for loop in f.loops for p in loop.pieces}
    enclosing |= {*map(reverse, enclosing)}
    letters = tuple(p for p in inside if p in enclosing)
    if letters:
        yield replace(stroke, pieces=letters, faces=tuple(whole))
    if rest := tuple(p for p in inside if p not in enclosing):
        yield replace(stroke, pieces=rest, faces=())


def owner(bodies: Mapping[str, Body], path: str) -> str | None:
    """Returns the nearest body at a path or above it."""
    while path and path not in bodies:
        path = path.rpartition(".")[0]
    return path or None


def _by_cover(stroke: Stroke, bodies: Sequence[Body]) -> list[Body]:
    """Returns the bodies under a stroke, first the one that has most of it."""
    box = union_bounds([bounds(piece) for piece in stroke.pieces])
    near = [body for body in reversed(bodies) if boxes_meet(box, body.box)]
    if len(near) < 2:
        return near
    cover = {body.path: _length(divided(stroke.pieces, body.region)[0]) for body in near}
    return sorted(near, key=lambda body: -round(cover[body.path], 6))


def divided(curves: Sequence[Piece], region: Region) -> tuple[tuple[Piece, ...], tuple[Piece, ...]]:
    """Returns the parts of curves in a region or on its edge, and those outside; uncut curves stay as they
    were.
    """
    outline = [p for loop in region.loops for p in loop.pieces]
    network = Network([*outline, *curves])
    own, others = network.uses[: len(outline)], network.uses[len(outline) :]
    edges = sorted({edge for uses in others for edge, _ in uses})
    mask = inside_mask(section_of(network, region, 0), network.midpoints(edges))
    within = {edge for uses in own for edge, _ in uses} | {edges[k] for k in np.flatnonzero(mask)}
    inside: list[Piece] = []
    outside: list[Piece] = []
    for curve, uses in zip(curves, others, strict=True):
        if len({edge in within for edge, _ in uses}) == 1:
            (inside if uses[0][0] in within else outside).append(curve)
            continue
        for use in uses:
            (inside if use[0] in within else outside).append(network.piece(use))
    return tuple(inside), tuple(outside)


def boxes_meet(a: Bounds, b: Bounds) -> bool:
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


def _length(pieces: Sequence[Piece]) -> float:
    return sum(map(length, pieces))
