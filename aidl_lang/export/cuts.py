"""The outlines that a machine follows, in order: drawings on parts first, then the outlines of parts.

Outlines come from the inside out: holes before the outline around them, and a part that lies in the hole of
another before that hole, so that nothing is cut in a piece that has come loose.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator
from itertools import groupby

import numpy as np

from aidl_lang.common.numbers import significant
from aidl_lang.common.records import record
from aidl_lang.export.chains import chains
from aidl_lang.geometry.curves import Piece
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.evaluate import bounds, ends, locate, point, reverse
from aidl_lang.geometry.measures import loop_area
from aidl_lang.geometry.network import RELATIVE_TOLERANCE, union_bounds
from aidl_lang.geometry.region import Loop
from aidl_lang.geometry.solved import SolvedModel
from aidl_lang.geometry.styles import Style

HOLE, OPEN = "hole", "open"


@record()
class Outline:
    """Pieces joined end to end, with their layer, style and owner.

    path   of the body, or of the structure that draws the lines
    layer  what `@layer` says, else the kind of the structure, `open` for curves that were to bound something
    style  of its lines; what it says of a fill is said of none
    hole   path of the hole that an inner outline comes from; a ring has its inner one without any
    clockwise  whether a whole curve, which has no direction of its own, is run through clockwise
    """

    pieces: tuple[Piece, ...]
    closed: bool
    path: str
    layer: str
    style: Style
    hole: str | None = None
    clockwise: bool = False


def outlines(model: SolvedModel, drawing: Drawing) -> list[Outline]:
    """Returns all outlines of a drawing in the order of drawing and cutting."""
    return [*_lines(drawing), *_cuts(model, drawing)]


def _lines(drawing: Drawing) -> Iterator[Outline]:
    tolerance = RELATIVE_TOLERANCE * drawing.size
    for (path, role, style), strokes in groupby(drawing.strokes, key=lambda s: (s.path, s.role, s.style)):
        layer = role if role == OPEN else style.layer or role
        if role == HOLE:
            for loop in drawing.regions[path].loops:
                yield Outline(loop.pieces, True, path, layer, style, clockwise=loop.reversed)
            continue
        for pieces in chains([piece for s in strokes for piece in s.pieces], tolerance):
            start, end = ends(pieces[0])[0], ends(pieces[-1])[1]
            closed = math.dist(start, end) <= tolerance < _extent(pieces)
            yield Outline(pieces, closed, path, layer, style)


def _extent(pieces: Iterable[Piece]) -> float:
    left, bottom, right, top = union_bounds([bounds(piece) for piece in pieces])
    return max(right - left, top - bottom)


def _cuts(model: SolvedModel, drawing: Drawing) -> Iterator[Outline]:
    kinds = {s.path: s.kind for s in model.root.walk()}
    edges = _HoleEdges(model, drawing)
    faces = [(face, body) for body in drawing.bodies for face in body.region.faces]
    faces.sort(key=lambda pair: significant(loop_area(pair[0].outer)))
    for face, body in faces:
        for loop in face.holes:
            hole = edges.owner(loop, body.path)
            style = drawing.styles[hole or body.path].with_lines_of(body.style)
            yield Outline(
                loop.pieces, True, body.path, style.layer or HOLE, style, hole, clockwise=loop.reversed
            )
        layer = body.style.layer or kinds[body.path]
        yield Outline(face.outer.pieces, True, body.path, layer, body.style)


class _HoleEdges:
    """The outlines of all holes of a model, to find the hole that an inner loop of a body comes from."""

    def __init__(self, model: SolvedModel, drawing: Drawing) -> None:
        self._tolerance = RELATIVE_TOLERANCE * drawing.size
        self._edges = [
            (s.path, piece)
            for s in model.root.walk()
            if s.kind == "hole" and s.path in drawing.regions
            for loop in drawing.regions[s.path].loops
            for piece in loop.pieces
        ]
        self._same: dict[Piece, list[str]] = defaultdict(list)
        for path, piece in self._edges:
            for either in (piece, reverse(piece)):
                self._same[either].append(path)
        boxes = np.array([bounds(piece) for _, piece in self._edges]).reshape(-1, 4)
        self._low, self._high = boxes[:, :2] - self._tolerance, boxes[:, 2:] + self._tolerance

    def owner(self, loop: Loop, body: str) -> str | None:
        """Returns the hole that shares an edge with a loop of a body: of several, as where a pin goes through
        parts that lie on each other, the innermost in the body.
        """
        for found in (self._same_edge, self._beside):  # a piece may have been drawn anew in the loop
            paths = [path for piece in loop.pieces for path in found(piece)]
            if paths:
                return max(paths, key=lambda path: path.startswith(f"{body}."))
        return None

    def _same_edge(self, piece: Piece) -> Iterable[str]:
        """Returns the holes with this very edge, inner ones first."""
        return reversed(self._same.get(piece, []))

    def _beside(self, piece: Piece) -> Iterable[str]:
        """Returns the holes on whose edges the middle of a piece lies, inner ones first."""
        p = point(piece, 0.5)
        near = np.flatnonzero(((self._low <= p) & (p <= self._high)).all(axis=1))
        found = (self._edges[k] for k in reversed(near))
        return [path for path, edge in found if locate(edge, p, self._tolerance) is not None]
