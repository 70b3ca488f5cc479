"""The parts that drawings are engraved on, for drawings whose parts are taken from one another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from aidl_lang.geometry.boolean import common, without
from aidl_lang.geometry.clipping import clipped_each
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.drawing import SLIT, Body, Stroke
from aidl_lang.geometry.evaluate import NO_LENGTH, are_near, bounds
from aidl_lang.geometry.measures import length
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.overhanging import Holders
from aidl_lang.geometry.region import Region


def engraved(
    bodies: Sequence[Body], strokes: Sequence[Stroke]
) -> tuple[dict[str, list[Stroke]], list[Stroke]]:
    """Returns the strokes of drawings by the path of their body, and the strokes on no body."""
    holders = Holders(bodies)
    on: dict[str, list[Stroke]] = {}
    off: list[Stroke] = []
    for stroke in strokes:
        if stroke.role not in ("drawing", SLIT):
            continue
        holder = holders.of(stroke)
        if holder is not None:
            on.setdefault(holder.path, []).append(stroke)
            continue
        rest: Stroke | None = stroke
        for body in _by_cover(stroke, bodies):
            if rest is None:
                break
            inside, rest = _cut_off(rest, body.region)
            if inside is not None:
                on.setdefault(body.path, []).append(inside)
        if rest is not None and _length(rest.pieces) > NO_LENGTH:
            off.append(rest)
    return on, off


def _cut_off(stroke: Stroke, region: Region) -> tuple[Stroke | None, Stroke | None]:
    """Returns a stroke as far as it lies on a region, and the rest of it: areas as areas, lines as lines."""
    inside, outside = divided(stroke.pieces, region)
    if not outside or not inside:
        return (stroke, None) if inside else (None, stroke)
    if not stroke.faces:
        return replace(stroke, pieces=inside), replace(stroke, pieces=outside)
    area = Region(stroke.faces)
    found = (operation(area, region) for operation in (common, without))
    here, there = (replace(stroke, pieces=a.pieces, faces=a.faces) if a else None for a in found)
    return here, there


def _by_cover(stroke: Stroke, bodies: Sequence[Body]) -> list[Body]:
    """Returns the bodies under a stroke, first the one that has most of it."""
    box = union_bounds([bounds(piece) for piece in stroke.pieces])
    near = [body for body in reversed(bodies) if are_near(box, body.box)]
    if len(near) < 2:
        return near
    cover = {body.path: _length(divided(stroke.pieces, body.region)[0]) for body in near}
    return sorted(near, key=lambda body: -round(cover[body.path], 6))


def divided(curves: Sequence[Piece], region: Region) -> tuple[tuple[Piece, ...], tuple[Piece, ...]]:
    """Returns the parts of curves in a region or on its edge, and those outside; uncut curves stay as they
    were.
    """
    found = clipped_each(curves, region, with_border=True)
    return tuple(p for one in found for p in one.inner), tuple(p for one in found for p in one.outer)


def _length(pieces: Sequence[Piece]) -> float:
    return sum(map(length, pieces))
