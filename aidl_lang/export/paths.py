"""SVG path data from exact pieces. Coordinates turn upside down: SVG counts y downwards."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from aidl_lang.common.numbers import fixed
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.evaluate import ends, point
from aidl_lang.geometry.region import Face, Loop

_HALF = 1e-8
"""Radians by which a half turn may be off after solving; to take it for the other half moves nothing."""


def xy(p: Vec) -> str:
    return f"{fixed(p[0])} {fixed(-p[1])}"


def face_path(face: Face) -> str:
    """Returns all loops of a face as one path, its holes really cut out."""
    return "".join(loop_path(loop) for loop in face.loops)


def loop_path(loop: Loop) -> str:
    if loop.is_whole:
        return _whole(loop.pieces[0], clockwise=loop.reversed)
    pieces = loop.pieces
    # The last straight way home is what Z draws.
    drawn = pieces[:-1] if isinstance(pieces[-1], Line) else pieces
    return f"M{xy(ends(pieces[0])[0])}{''.join(map(_segment, drawn))}Z"


def open_path(pieces: Sequence[Piece]) -> str:
    """Returns curves one after the other, moving only where one does not start at the end of the one
    before.
    """
    return "".join(_chain(pieces))


def _chain(pieces: Iterable[Piece]) -> Iterable[str]:
    at: Vec | None = None
    for piece in pieces:
        if isinstance(piece, Circle | Ellipse):
            yield _whole(piece, clockwise=False)
            at = None
            continue
        start, end = ends(piece)
        if start != at:
            yield f"M{xy(start)}"
        yield _segment(piece)
        at = end


def _whole(piece: Piece, clockwise: bool) -> str:
    """Returns a closed curve as two halves, since an `A` that ends where it starts draws nothing."""
    assert isinstance(piece, Circle | Ellipse)
    start, middle = xy(point(piece, 0.0)), xy(point(piece, 0.5))
    flag = int(clockwise)
    radii = _radii(piece)
    return f"M{start}A{radii} 0 {flag} {middle}A{radii} 0 {flag} {start}Z"


def _radii(piece: Arc | Circle | Ellipse | EllipseArc) -> str:
    if isinstance(piece, Arc | Circle):
        return f"{fixed(piece.radius)} {fixed(piece.radius)} 0"
    return f"{fixed(piece.rx)} {fixed(piece.ry)} {fixed(-math.degrees(piece.angle))}"


def _segment(piece: Piece) -> str:
    """Returns the path command that continues from the start of a piece."""
    if isinstance(piece, Line):
        return f"L{xy(piece.end)}"
    if isinstance(piece, Bezier):
        return f"C{xy(piece.p1)} {xy(piece.p2)} {xy(piece.p3)}"
    assert isinstance(piece, Arc | EllipseArc)
    flag = int(piece.sweep < 0)
    if abs(piece.sweep) > 1.9 * math.pi:
        # Nearly full turns lose their direction in rounding: go by way of the middle.
        return f"A{_radii(piece)} 0 {flag} {xy(point(piece, 0.5))}A{_radii(piece)} 0 {flag} {xy(piece.end)}"
    is_large = (
        abs(piece.sweep) > math.pi + _HALF
    )  # of two equal halves no machine says otherwise than another
    return f"A{_radii(piece)} {int(is_large)} {flag} {xy(piece.end)}"
