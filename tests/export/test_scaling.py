"""A picture in another scale shows the same."""

from __future__ import annotations

import io

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from aidl_lang.export.marks import Area, Curves, Dot, Frame, Group, Ink, Mark, Picture, Text, scaled
from aidl_lang.export.pdf import to_png
from aidl_lang.geometry.curves import Arc, Bezier, Circle, Ellipse, EllipseArc, Line, Piece
from aidl_lang.geometry.region import Face, Loop

PIECES: tuple[Piece, ...] = (
    Line((1.0, 2.0), (5.0, -3.0)),
    Arc((1.0, 1.0), 2.0, (3.0, 1.0), (1.0, 3.0), 1.5707963267948966),
    Circle((4.0, 5.0), 3.0),
    Ellipse((2.0, 1.0), 4.0, 2.0, 0.5),
    EllipseArc((0.0, 0.0), 4.0, 2.0, 0.0, (4.0, 0.0), (0.0, 2.0), 0.0, 1.5707963267948966),
    Bezier((0.0, 0.0), (1.0, 4.0), (5.0, 4.0), (6.0, 0.0)),
)
INK = Ink("#102030", 0.5, (2.0, 1.0))
MARKS: tuple[Mark, ...] = (
    Area(Face(Loop((Circle((0.0, 0.0), 9.0),)), (Loop((Circle((1.0, 0.0), 2.0),), True),)), "#ffcc00", INK),
    Curves(PIECES, INK),
    Text((-9.0, 9.0), "text", 2.0, "#000000"),
    Dot((3.0, 3.0), 0.5, "#ff0000"),
    Frame((-5.0, -5.0, 5.0, 5.0), "#00ff00", 0.25, 1.0),
)
PICTURE = Picture((-12.0, -12.0, 12.0, 12.0), (Group("all", MARKS, {}, (-10.0, -10.0, 10.0, 10.0)),))


@pytest.mark.parametrize("piece", PIECES, ids=lambda piece: type(piece).__name__)
def test_curves_keep_their_shape(piece: Piece) -> None:
    picture = scaled(Picture((0.0, 0.0, 1.0, 1.0), (Group("one", (Curves((piece,), INK),)),)), 4.0)
    (mark,) = picture.groups[0].marks
    assert isinstance(mark, Curves)
    for k in range(9):
        x, y = piece.point(k / 8)
        assert mark.pieces[0].point(k / 8) == pytest.approx((4 * x, 4 * y))


def test_a_picture_of_any_size_becomes_the_same_pixels() -> None:
    """But for the last shade of what is drawn at the edge of a line."""
    plain = _pixels(scaled(PICTURE, 2.0**8))
    assert len(np.unique(plain)) > 50
    for factor in (2.0**14, 2.0**40, 2.0**90):
        assert np.abs(_pixels(scaled(PICTURE, factor)) - plain).mean() < 0.5


def _pixels(picture: Picture) -> NDArray[np.int64]:
    with Image.open(io.BytesIO(to_png(picture, 200))) as image:
        return np.asarray(image, dtype=np.int64)
