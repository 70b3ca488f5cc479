"""B-splines as cubic Bézier curves."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from aidl_lang.common.cancelling import checkpoint
from aidl_lang.common.font_files import Curve, Vec

if TYPE_CHECKING:
    from ezdxf.math import BSpline

_NEAR = 1e-7
"""Distance of a cubic from the curve that it follows, relative to the size of that."""
_HALVINGS = 10


def cubics(entity: Any) -> tuple[list[Curve], bool]:
    """Returns the cubics of a SPLINE, and whether they are the same curve."""
    spline: BSpline = entity.construction_tool()
    if spline.degree <= 3 and not spline.is_rational and spline.is_clamped:
        return [_raised([_flat(p) for p in piece]) for piece in spline.bezier_decomposition()], True
    points = [_flat(p) for p in spline.control_points]
    size = max(max(axis) - min(axis) for axis in zip(*points, strict=True)) or 1.0
    knots = sorted(set(spline.knots()[spline.degree : len(spline.knots()) - spline.degree]))
    found = [
        curve
        for first, last in pairwise(knots)
        for curve in _followed(spline, first, last, _NEAR * size, _HALVINGS)
    ]
    return [_joined(curve, found[k - 1] if k else None) for k, curve in enumerate(found)], False


def _flat(p: Any) -> Vec:
    return float(p[0]), float(p[1])


def _raised(points: list[Vec]) -> Curve:
    """Returns a Bézier curve of a degree up to 3 as a line or a cubic."""
    while 2 < len(points) < 4:
        n = len(points)
        inner = [
            tuple((k * a + (n - k) * b) / n for a, b in zip(points[k - 1], points[k], strict=True))
            for k in range(1, n)
        ]
        points = [points[0], *((x, y) for x, y in inner), points[-1]]
    return tuple(points)


def _followed(spline: BSpline, first: float, last: float, near: float, halvings: int) -> Iterator[Curve]:
    """Yields cubics with the ends and the derivatives of a part of a spline, halved until they are near."""
    checkpoint()
    step = last - first
    inside = [first + 1e-12 * step, last - 1e-12 * step]  # of the part, should its ends be corners
    (start, heading), (end, arrival) = ((_flat(p), _flat(d)) for p, d in spline.derivatives(inside, 1))
    one = start[0] + heading[0] * step / 3, start[1] + heading[1] * step / 3
    two = end[0] - arrival[0] * step / 3, end[1] - arrival[1] * step / 3
    middle = (first + last) / 2
    off = max(
        math.dist(_at((start, one, two, end), k / 4), _flat(spline.point(first + k / 4 * step)))
        for k in (1, 2, 3)
    )
    if off <= near or halvings == 0:
        yield start, one, two, end
        return
    yield from _followed(spline, first, middle, near, halvings - 1)
    yield from _followed(spline, middle, last, near, halvings - 1)


def _at(curve: Curve, t: float) -> Vec:
    s = 1.0 - t
    weights = s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t
    x, y = (sum(w * p[axis] for w, p in zip(weights, curve, strict=True)) for axis in (0, 1))
    return x, y


def _joined(curve: Curve, before: Curve | None) -> Curve:
    """Returns a curve that begins where the one before it ends, to the last digit."""
    return curve if before is None else (before[-1], *curve[1:])
