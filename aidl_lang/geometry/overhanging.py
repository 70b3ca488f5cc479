"""Drawings that reach out of the part that they are engraved on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import rough
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.evaluate import points
from aidl_lang.geometry.nearness import inside
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import SolvedStructure
from aidl_lang.geometry.tessellate import loop_points

if TYPE_CHECKING:
    from aidl_lang.geometry.drawing import Body, Stroke

UNSEEN = 0.05
"""mm that a drawing may reach out without a word."""
_TIMES = np.linspace(0, 1, 5)
_MOST = 400
"""Spots outside of a part of which the distance to it is measured."""


class Holders:
    """Finds the body that a stroke is drawn in."""

    def __init__(self, bodies: Sequence[Body]) -> None:
        self._bodies = {body.path: body for body in bodies}
        self._around = {owner(self._bodies, body.path.rpartition(".")[0]) for body in bodies}

    def of(self, stroke: Stroke) -> Body | None:
        """Returns that body; None if there is none, or others are in it, on which the stroke may be."""
        path = owner(self._bodies, stroke.path)
        return None if path is None or path in self._around else self._bodies[path]


def owner(bodies: Mapping[str, Body], path: str) -> str | None:
    """Returns the nearest body at a path or above it."""
    while path and path not in bodies:
        path = path.rpartition(".")[0]
    return path or None


def overhang(pieces: Sequence[Piece], region: Region) -> float:
    """Returns how far curves reach out of the outer outlines of a region, mm, by samples; 0 for none."""
    size = float(np.ptp(region.boxes.reshape(-1, 2), axis=0).max(initial=0.0))
    polygons = [loop_points(face.outer, 1e-5 * size) for face in region.faces]
    spots = np.concatenate([points(piece, _TIMES) for piece in pieces])
    spots = spots[~inside(polygons, spots)]
    spots = spots[:: len(spots) // _MOST + 1]
    if not len(spots):
        return 0.0
    start = np.concatenate(polygons)
    way = np.concatenate([np.roll(p, -1, axis=0) - p for p in polygons])
    square = np.maximum((way**2).sum(axis=1), 1e-300)
    furthest = 0.0
    for spot in spots:
        t = np.clip(((spot - start) * way).sum(axis=1) / square, 0, 1)
        furthest = max(furthest, float(np.hypot(*(spot - start - t[:, None] * way).T).min()))
    return furthest if furthest > max(UNSEEN, 1e-3 * size) else 0.0


def overhanging_notes(
    root: SolvedStructure, bodies: Sequence[Body], strokes: Sequence[Stroke]
) -> Iterator[Diagnostic]:
    """Yields a warning for each geometry that is drawn in a part of some stock, and reaches out of it."""
    if not any(body.style.thickness or body.style.material for body in bodies):
        return
    holders = Holders(bodies)
    spans = {g.path: g.span for s in root.walk() for drawn in s.drawn for g in drawn.walk()}
    found: dict[str, tuple[Body, float]] = {}
    for stroke in strokes:
        body = holders.of(stroke) if stroke.role == "drawing" else None
        if body is None or not (body.style.thickness or body.style.material):
            continue
        far = max(overhang(stroke.pieces, body.region), found.get(stroke.geometry, (body, 0.0))[1])
        if far:
            found[stroke.geometry] = body, far
    for path, (body, far) in found.items():
        yield Diagnostic(
            "W0763",
            f"`{path}` reaches {rough(round(far, 2))} mm out of `{body.path}`, on which it is engraved",
            spans.get(path),
            hints=(
                "make it smaller or move it inwards: a cutter burns what lies beside the part, too",
                f"or have it end at the edge: `@clip({body.path.rpartition('.')[2]})` before the drawing",
            ),
        )
