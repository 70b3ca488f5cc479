"""The outlines that a machine follows, joined end to end, with what it does along each, in order."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import count, groupby

import numpy as np

from aidl_lang.common.prose import significant
from aidl_lang.common.records import record
from aidl_lang.export.marks import Area, Curves, Group, Ink, Mark
from aidl_lang.export.profiles import CUTS, ENGRAVE, FILL, INNER, OUTER, PLAIN, Profile
from aidl_lang.geometry.boolean import united
from aidl_lang.geometry.curves import Piece, larger_side, union_bounds
from aidl_lang.geometry.drawing import SLIT, Body, Drawing, Stroke
from aidl_lang.geometry.intersect import inside, near_pairs
from aidl_lang.geometry.network import RELATIVE_TOLERANCE, Weld
from aidl_lang.geometry.region import Face, Loop, Region
from aidl_lang.geometry.solved import SolvedModel
from aidl_lang.geometry.styles import Style
from aidl_lang.solver.valuation import connected

# --- Joins curves end to end, for machines that draw them in one go.

Chain = tuple[Piece, ...]


def chains(pieces: Sequence[Piece], tolerance: float) -> list[Chain]:
    """Joins pieces to chains as long as possible; each piece occurs once, reversed if its neighbours need it.

    A chain ends where nothing follows within the tolerance (mm) and where more than two ends meet. Whole
    circles and ellipses stand alone.
    """
    weld = Weld(tolerance)
    nodes = [tuple(map(weld.number, p.ends)) for p in pieces]
    meeting: dict[int, list[int]] = defaultdict(list)
    for number, piece in enumerate(pieces):
        for node in () if piece.is_closed else nodes[number]:
            meeting[node].append(number)
    left = dict.fromkeys(range(len(pieces)))

    def follow(node: int) -> list[Piece]:
        """Removes and returns the pieces that continue from a node."""
        found = []
        while len(meeting[node]) == 2 and (more := [n for n in meeting[node] if n in left]):
            (number,) = more
            del left[number]
            start, end = nodes[number]
            found.append(pieces[number] if start == node else pieces[number].reversed())
            node = end if start == node else start
        return found

    result = []
    while left:
        number = next(iter(left))
        del left[number]
        start, end = nodes[number]
        after = follow(end)
        before = [piece.reversed() for piece in reversed(follow(start))]
        result.append((*before, pieces[number], *after))
    return result


# --- The outlines that a machine follows, with what it does along each, in order.
#
# What is engraved and scored comes before what is cut, the cuts inside parts before those around them, as
# the profile says. The outline around an opening in which another part lies is cut late, after that part, so
# that nothing is cut in a piece that has come loose.

HOLE, OPEN = "hole", "open"


@record()
class Outline:
    """Pieces joined end to end, with their layer, style and owner.

    path   of the body, or of the structure that draws the lines
    layer  what `@layer` says, else the kind of the structure, `open` for curves that were to bound something
    style  of its lines; what it says of a fill is said of none
    operation  what a machine does along it, one of `OPERATIONS`; none for `open` ones
    hole   path of the hole that an inner outline comes from; a ring has its inner one without any
    clockwise  whether a whole curve, which has no direction of its own, is run through clockwise
    area   the number of the area that it bounds together with others, where that is engraved
    """

    pieces: tuple[Piece, ...]
    closed: bool
    path: str
    layer: str
    style: Style
    operation: str = ""
    hole: str | None = None
    clockwise: bool = False
    area: int = 0

    @property
    def loop(self) -> Loop:
        return Loop(self.pieces, self.clockwise)


def outlines(model: SolvedModel, drawing: Drawing, profile: Profile = PLAIN) -> list[Outline]:
    """Returns all outlines of a drawing in the order of drawing and cutting."""
    rank = {operation: place for place, operation in enumerate(("", *profile.order))}
    lines = _apart(list(_lines(drawing, profile)), profile)
    return sorted([*lines, *_cuts(model, drawing, profile)], key=lambda o: rank[o.operation])


def unfilled(drawing: Drawing, profile: Profile) -> list[str]:
    """Returns the paths of drawings that are to be engraved as areas and have lines that enclose none."""
    lines = (line for line in _lines(drawing, profile) if line.operation == ENGRAVE)
    unlike = (line.path for line in lines if profile.operation(line.style.layer, ENGRAVE) == FILL)
    return list(dict.fromkeys(unlike))


def _lines(drawing: Drawing, profile: Profile) -> Iterator[Outline]:
    tolerance = RELATIVE_TOLERANCE * drawing.size
    areas = count(1)
    for (path, role, style), group in groupby(drawing.strokes, key=lambda s: (s.path, s.role, s.style)):
        layer = role if role == OPEN else style.layer or (HOLE if role == SLIT else role)
        made = partial(Outline, path=path, layer=layer, style=style)
        if role == HOLE:
            operation = profile.operation(style.layer, INNER)
            for loop in drawing.regions[path].loops:
                yield made(loop.pieces, True, operation=operation, clockwise=loop.reversed)
            continue
        by_kind = INNER if role == SLIT else ENGRAVE
        operation = "" if role == OPEN else profile.operation(style.layer, by_kind)
        followed: list[Piece] = []
        for stroke in group:
            loops = _bounding(stroke, operation, profile, tolerance)
            area = next(areas) if loops else 0
            for loop in loops:
                yield made(loop.pieces, True, operation=FILL, area=area, clockwise=loop.reversed)
            followed += () if loops else stroke.pieces
        for pieces in chains(followed, tolerance):
            closed = _is_closed(pieces, tolerance)
            if operation != FILL:
                yield made(pieces, closed, operation=operation)
            elif closed:
                yield made(pieces, True, operation=FILL, area=next(areas))
            else:
                yield made(pieces, False, operation=ENGRAVE)


def _apart(found: Sequence[Outline], profile: Profile) -> Iterator[Outline]:
    """Yields outlines with areas of one colour that lie on each other made one, under the name of the first:
    machines fill all closed outlines of a colour together, by alternation.
    """
    areas = [list(run) for area, run in groupby(found, key=lambda o: o.area) if area]
    boxes = [union_bounds([piece.box for o in area for piece in o.pieces]) for area in areas]
    colors = [profile.color(first) for first, *_ in areas]
    pairs = [pair for pair in near_pairs(boxes, 0.0) if colors[pair[0]] == colors[pair[1]]]
    one, other = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
    first_of = connected(one, other, len(areas))
    yield from (outline for outline in found if not outline.area)
    for k, area in enumerate(areas):
        together = [areas[j] for j in np.flatnonzero(first_of == k)]
        if len(together) < 2:
            yield from area if together else ()
            continue
        for loop in united(*(Region((_face(each),)) for each in together)).loops:
            yield replace(area[0], pieces=loop.pieces, clockwise=loop.reversed)


def _face(area: Iterable[Outline]) -> Face:
    first, *others = (outline.loop for outline in area)
    return Face(first, tuple(others))


def _bounding(stroke: Stroke, operation: str, profile: Profile, tolerance: float) -> list[Loop]:
    """Returns the outlines of the area that a stroke is engraved as; none if its lines are followed."""
    if stroke.faces and (operation == FILL or (operation == ENGRAVE and profile.letters == FILL)):
        return [loop for face in stroke.faces for loop in face.loops]
    if operation != FILL:
        return []
    found = chains(stroke.pieces, tolerance)
    return [Loop(pieces) for pieces in found] if all(_is_closed(c, tolerance) for c in found) else []


def _is_closed(pieces: Sequence[Piece], tolerance: float) -> bool:
    start, end = pieces[0].ends[0], pieces[-1].ends[1]
    return math.dist(start, end) <= tolerance < extent(pieces)


def extent(pieces: Iterable[Piece]) -> float:
    return larger_side(union_bounds([piece.box for piece in pieces]))


def _cuts(model: SolvedModel, drawing: Drawing, profile: Profile) -> Iterator[Outline]:
    """Yields the outlines of parts by rising area, those in a part before the one around it."""
    kinds = {s.path: s.kind for s in model.root.walk()}
    edges = _HoleEdges(model, drawing)
    faces = [(face, body) for body in drawing.bodies for face in body.region.faces]
    faces.sort(key=lambda pair: significant(pair[0].outer.area))
    late = _late(faces)
    for number, (face, body) in enumerate(faces):
        for k, loop in enumerate(face.holes):
            hole = edges.owner(loop, body.path)
            look = body.style
            style = replace(drawing.styles[hole or body.path], stroke=look.stroke, dash=look.dash)
            operation = profile.operation(style.layer, OUTER if (number, k) in late else INNER)
            layer = style.layer or HOLE
            yield Outline(loop.pieces, True, body.path, layer, style, operation, hole, loop.reversed)
        layer = body.style.layer or kinds[body.path]
        operation = profile.operation(body.style.layer, OUTER)
        yield Outline(face.outer.pieces, True, body.path, layer, body.style, operation)


def _late(faces: Sequence[tuple[Face, Body]]) -> set[tuple[int, int]]:
    """Returns the openings, as numbers of a face and of a hole in it, in which other faces lie."""
    if len(faces) < 2:
        return set()
    openings = [(n, k, loop) for n, (face, _) in enumerate(faces) for k, loop in enumerate(face.holes)]
    boxes = [union_bounds([piece.box for piece in face.outer.pieces]) for face, _ in faces]
    around = [union_bounds([piece.box for piece in loop.pieces]) for *_, loop in openings]
    found: set[tuple[int, int]] = set()
    for face, number in near_pairs([*boxes, *around], 0.0):
        if not face < len(faces) <= number:
            continue
        n, k, loop = openings[number - len(faces)]
        box, room = boxes[face], around[number - len(faces)]
        fits = room[0] <= box[0] and room[1] <= box[1] and box[2] <= room[2] and box[3] <= room[3]
        if n != face and (n, k) not in found and fits and _holds(loop, faces[face][0]):
            found.add((n, k))
    return found


def _holds(loop: Loop, face: Face) -> bool:
    """Tells whether most of an outline lies in a loop, on which it may end."""
    spots = np.array([piece.point(t) for piece in face.outer.pieces for t in (0.25, 0.5, 0.75)])
    polygon = loop.polygon(0.01 * extent(loop.pieces))
    return bool(inside([polygon], spots).mean() > 0.5)


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
        for path, piece in reversed(self._edges):  # inner ones first
            for either in (piece, piece.reversed()):
                self._same[either].append(path)
        boxes = np.array([piece.box for _, piece in self._edges]).reshape(-1, 4)
        self._low, self._high = boxes[:, :2] - self._tolerance, boxes[:, 2:] + self._tolerance

    def owner(self, loop: Loop, body: str) -> str | None:
        """Returns the hole that shares an edge with a loop of a body: of several, as where a pin goes through
        parts that lie on each other, the innermost in the body.
        """
        for found in (self._same.get, self._beside):  # a piece may have been drawn anew in the loop
            paths = [path for piece in loop.pieces for path in found(piece) or ()]
            if paths:
                return max(paths, key=lambda path: path.startswith(f"{body}."))
        return None

    def _beside(self, piece: Piece) -> Iterable[str]:
        """Returns the holes on whose edges the middle of a piece lies, inner ones first."""
        p = piece.point(0.5)
        near = np.flatnonzero(((self._low <= p) & (p <= self._high)).all(axis=1))
        found = (self._edges[k] for k in reversed(near))
        return [path for path, edge in found if edge.locate(p, self._tolerance) is not None]


# --- What a cutter follows, as marks of a picture: outlines and engraved areas in the order of a profile.


def followed_groups(model: SolvedModel, drawing: Drawing, profile: Profile) -> Iterator[Group]:
    """Yields a group for each run of outlines with one operation and one structure."""
    kinds = {s.path: s.kind for s in model.root.walk()}
    found = [outline for outline in outlines(model, drawing, profile) if outline.operation]
    used: dict[str, int] = {}

    def look(outline: Outline) -> tuple[str, str, str | None]:
        own = outline.style.layer
        return outline.path, outline.operation, profile.look(own, outline.operation).layer or own

    for (path, operation, layer), run in groupby(found, key=look):
        name = f"{path}:{operation}"
        used[name] = count = used.get(name, 0) + 1
        attributes = {"data-kind": kinds[path], "data-path": path, "data-operation": operation}
        if layer is not None:
            attributes["data-layer"] = layer
        yield Group(name if count == 1 else f"{name}-{count}", tuple(_marks(list(run), profile)), attributes)


def _marks(run: Sequence[Outline], profile: Profile) -> Iterator[Mark]:
    for area, bounding in groupby(run, key=lambda o: o.area):
        if area:
            together = list(bounding)
            yield Area(_face(together), profile.color(together[0]), None, FILL)
            continue
        for outline in bounding:
            width = profile.look(outline.style.layer, outline.operation).width
            ink = Ink(profile.color(outline), width)
            role = "cut" if outline.operation in CUTS else outline.operation
            if outline.closed:
                yield Area(Face(outline.loop), None, ink, role)
            else:
                yield Curves(outline.pieces, ink, role)
