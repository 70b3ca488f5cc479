"""Names and numbers of parts on sheets, each where its part has room for it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from aidl_lang.export import Job, themes
from aidl_lang.export.marks import CHARACTER, Text
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.drawing import Body, Drawing
from aidl_lang.geometry.evaluate import are_near, bounds
from aidl_lang.geometry.nearness import inside
from aidl_lang.geometry.parts import COARSE
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.tessellate import piece_points, region_polygons

LABELS = frozenset({"names", "numbers"})
"""What `--show` may ask for of parts on sheets."""
SIZE = 5.0
"""Largest font size, mm."""
_BASELINE = 0.3
"""How far below its middle the baseline of a text runs, relative to its size."""
_STEPS = 15
"""Places looked at along each side of a part."""
_AIR = 0.9
"""Share of the room that a text takes."""


def labels(job: Job) -> Iterator[Text]:
    """Yields a text for each part, as large as it allows, up to what is read easily."""
    asked = job.options.show & LABELS
    if not asked or job.options.sheet is None:
        return
    root, numbers = job.model.root.path, job.cut_list.numbers if "numbers" in asked else {}
    for body in job.drawing.bodies:
        words = [str(numbers[body.path])] if numbers else []
        words += [body.path.removeprefix(f"{root}.")] if "names" in asked else []
        label = " ".join(words)
        middle, size = _room(body.region, _lines_on(body, job.drawing), CHARACTER * len(label))
        at = middle[0], middle[1] - _BASELINE * size
        yield Text(at, label, size, themes.NAME, "middle", halo=False)


def _lines_on(body: Body, drawing: Drawing) -> list[NDArray[np.float64]]:
    """Returns what is engraved about a body, as polylines."""
    near = (s.pieces for s in drawing.strokes)
    boxes = ((piece, bounds(piece)) for pieces in near for piece in pieces)
    return [piece_points(piece, COARSE) for piece, box in boxes if are_near(box, body.box)]


def _room(region: Region, engraved: list[NDArray[np.float64]], width: float) -> tuple[Vec, float]:
    """Returns the middle and the size of the largest text, so many times as wide as high, that lies in the
    material beside what is engraved, as near to the middle of the part as there is room.
    """
    shrunk = [polygon / (width, 1.0) for polygon in region_polygons(region, COARSE)]
    sides = [_sides(np.concatenate((polygon, polygon[:1]))) for polygon in shrunk]
    sides += [_sides(line / (width, 1.0)) for line in engraved]
    outline = np.concatenate(shrunk)
    low, high = outline.min(axis=0), outline.max(axis=0)
    shares = (np.arange(_STEPS) + 0.5) / _STEPS
    spots = low + np.stack(np.meshgrid(shares, shares), axis=-1).reshape(-1, 2) * (high - low)
    spots = np.concatenate(([(low + high) / 2], spots))
    spots = spots[np.argsort(np.hypot(*((spots - spots[0]) * (width, 1.0)).T), kind="stable")]
    spots = spots[within] if (within := inside(shrunk, spots)).any() else spots[:1]
    # A square lies in a circle: where a text is as high as wide, its room is that of a square.
    sizes = _AIR * np.sqrt(2) * _clearance(spots, np.concatenate(sides))
    best = int(np.argmax(np.minimum(sizes, SIZE)))
    x, y = spots[best] * (width, 1.0)
    return (float(x), float(y)), float(min(sizes[best], SIZE))


def _sides(line: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns start and end of each side of a polyline, a row each."""
    return np.concatenate((line[:-1], line[1:]), axis=1)


def _clearance(spots: NDArray[np.float64], sides: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the distance of each point to the nearest side."""
    start, way = sides[:, :2], sides[:, 2:] - sides[:, :2]
    square = np.maximum((way**2).sum(axis=1), 1e-30)
    least = np.full(len(spots), np.inf)
    for k, spot in enumerate(spots):
        t = np.clip(((spot - start) * way).sum(axis=1) / square, 0, 1)
        least[k] = np.hypot(*(spot - start - t[:, None] * way).T).min()
    return least
