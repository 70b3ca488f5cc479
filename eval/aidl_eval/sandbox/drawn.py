"""Reads what a program of build123d or CadQuery shows: flat outlines, back to front."""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterator
from typing import Any

_ARC, _CURVE = 96, 48
"""Chords of a curved edge: of a circle or part of one, and of any other curve."""
_NEAR = 1e-6
_MOST = 4000
"""Most outlines that a program may show."""

Point = tuple[float, float]


class NotFlat(Exception):  # noqa: N818 (what came of a program, no error of ours)
    """Raised for what is no drawing in the plane."""


def warm_up(library: str) -> None:
    """Has the library load what it loads at the first use."""
    package = importlib.import_module(library)
    if library not in ("build123d", "cadquery"):
        return
    for name in ("OCP.BOPAlgo", "OCP.BRepAlgoAPI"):
        for kind in vars(importlib.import_module(name)).values():
            if "SetRunParallel" in getattr(kind, "__dict__", ()):
                kind.SetRunParallel = lambda self, on: None  # a locked process has no threads
    if library == "build123d":
        face = package.Face.make_rect(2.0, 1.0) - package.Pos(0, 0) * package.Circle(0.2)
        collected([package.fillet(package.Rectangle(4, 2).vertices(), 0.2), face])
    elif library == "cadquery":
        collected([package.Sketch().rect(3, 2).vertices().fillet(0.2)])
        collected([package.Workplane("XY").rect(3, 2).circle(0.2).wire()])


def collected(shown: list[Any]) -> dict[str, Any]:
    """Returns parts, one for each shape that is shown: faces by their closed outlines, the outer one first.
    What has no face makes lines. Raises NotFlat.
    """
    parts: list[list[list[list[Point]]]] = []
    lines: list[list[Point]] = []
    count = 0
    for shape in (shape for thing in shown for shape in _shapes(thing)):
        faces = list(_all(shape, "Faces", "faces"))
        if list(_all(shape, "Solids", "solids")):
            raise NotFlat("the drawing must be flat, and this shows a solid: show faces or sketches")
        if faces:
            parts.append([[_loop(wire) for wire in _wires(face)] for face in faces])
        else:
            lines += [_flat(_points(edge)) for edge in _all(shape, "Edges", "edges")]
        count += len(faces) or 1
        if count > _MOST:
            raise NotFlat(f"more than {_MOST} faces and lines are shown")
    return {"errors": [], "parts": parts, "lines": lines}


def _shapes(thing: Any) -> Iterator[Any]:
    """Yields the shapes in whatever is shown."""
    kind = type(thing).__name__
    if isinstance(thing, (list, tuple, set)) and not hasattr(thing, "wrapped"):
        for one in thing:
            yield from _shapes(one)
    elif kind in ("BuildSketch", "BuildPart", "BuildLine"):
        yield from _shapes(getattr(thing, kind.removeprefix("Build").lower()))
    elif kind == "Workplane":
        for one in thing.vals():
            yield from _shapes(one)
    elif kind == "Sketch" and hasattr(thing, "_faces"):
        yield thing._faces
    elif kind == "Assembly" and hasattr(thing, "traverse"):
        for shape, _, location, _ in thing:
            yield shape.located(location) if location is not None else shape
    elif hasattr(thing, "wrapped") and (hasattr(thing, "edges") or hasattr(thing, "Edges")):
        yield thing
    elif kind not in ("Vector", "Location", "Plane", "NoneType"):
        raise NotFlat(f"`{kind}` cannot be shown: show faces, sketches or lists of them")


def _all(shape: Any, *names: str) -> Any:
    return next(getattr(shape, name) for name in names if hasattr(shape, name))()


def _wires(face: Any) -> list[Any]:
    if hasattr(face, "outerWire"):
        return [face.outerWire(), *face.innerWires()]
    return [face.outer_wire(), *face.inner_wires()]


def _points(edge: Any) -> list[tuple[float, float, float]]:
    kind = str(edge.geomType() if hasattr(edge, "geomType") else edge.geom_type).rpartition(".")[2].upper()
    count = 1 if kind == "LINE" else _ARC if kind == "CIRCLE" else _CURVE
    at = edge.positionAt if hasattr(edge, "positionAt") else edge.position_at
    found = []
    for step in range(count + 1):
        place = at(step / count)
        found.append((place.x, place.y, place.z) if hasattr(place, "x") else tuple(place))
    return [(float(x), float(y), float(z)) for x, y, z in found]


def _flat(points: list[tuple[float, float, float]]) -> list[Point]:
    zs = [z for *_, z in points]
    size = max((abs(c) for p in points for c in p), default=1.0)
    if not all(map(math.isfinite, (c for p in points for c in p))):
        raise NotFlat("a coordinate is not a finite number")
    if max(zs) - min(zs) > 1e-4 * max(size, 1.0):
        raise NotFlat("the drawing must lie in the plane of x and y, and this stands up from it")
    return [(x, y) for x, y, _ in points]


def _loop(wire: Any) -> list[Point]:
    """Returns the corners of a closed wire: its edges, one after the other by their ends."""
    left = [_flat(_points(edge)) for edge in _all(wire, "Edges", "edges")]
    left = [points for points in left if len(points) > 2 or math.dist(points[0], points[-1]) > _NEAR]
    if not left:
        return []
    found = left.pop(0)
    while left:
        end = found[-1]
        best = min(
            range(len(left)), key=lambda k: min(math.dist(end, left[k][0]), math.dist(end, left[k][-1]))
        )
        points = left.pop(best)
        found += (points if math.dist(end, points[0]) <= math.dist(end, points[-1]) else points[::-1])[1:]
    return found
