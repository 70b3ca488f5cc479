"""What is discrete in the outcome of a program, and what differs between two of its outcomes.

A *kind* is all that cannot change little by little: whether the program solves and its asserts hold, how its
ambiguous calls are read, the way round of its edges, the openings and pieces of its bodies, which bodies
touch or overlap, and the warnings about outlines and holes. In a picture, bodies lie over each other: where
some do as written, contacts count between those of a known thickness alone, and otherwise what touches
nothing any more; the others are paint, which may fall into pieces. Two outcomes with different sets of names,
as those of different counts, are compared by what all members of an array have in common.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field
from functools import cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from aidl_lang.checking.types import PRIMITIVES
from aidl_lang.common.prose import counted, first_few, ticked
from aidl_lang.common.records import record
from aidl_lang.compiled import Compiled
from aidl_lang.geometry.curves import Arc, Bounds, Line, Piece, union_bounds
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.sections import Section, fill
from aidl_lang.geometry.solved import SolvedGeometry, SolvedModel, SolvedStructure
from aidl_lang.tools.ends import Place, clause
from aidl_lang.tools.sweeping.bundle import OF_KIND, Fault, fault

_SAME_BOX = 1e-5
"""How near two boxes are that are the same, as a part of the size of the drawing."""
_TOUCHING = 1e-4
"""The width of what two bodies share that only touch, as a part of that size."""
_OPEN_TYPES = frozenset(kind for kind, each in PRIMITIVES.items() if "end" in each.types) | {"point"}
_BY_HAND = frozenset(("line", "arc", "path", "polygon"))
"""Geometry whose edges are written one by one."""
_MOST_BOXES = 300
"""Boxes of which all pairs are followed."""
_RADII = frozenset(("radius", "rx", "ry"))
_INDEX = re.compile(r"\[[^\]]*\]")
_RANK = re.compile(r"\((\d+) of \d+\)$")

Pair = tuple[str, str]
Cutter = tuple[str, bool, Bounds]


@record()
class Change:
    """Something that is of another kind beyond a value.

    kind   `error`, `jump`, `reading`, `edge`, `openings`, `pieces`, `contact` or `warning`
    line   the line that it is about; `paths` are the things
    """

    kind: str
    text: str
    line: int | None = None
    paths: tuple[str, ...] = ()

    @property
    def key(self) -> tuple[str, int | None, tuple[str, ...]]:
        """Returns what tells it from other changes, wherever they happen."""
        return self.kind, self.line, self.paths


@record(frozen=False)
class Look:
    """The outcome at one value, as far as it is compared.

    unknowns  what the solver found, by path
    spots     the coordinates of all points, and radii, in sizes of the drawing; `places` names each
    ways      the vectors of straight edges and the sweeps of arcs, by path
    cutters   the closed geometries of holes: the body that each cuts, whether it has its own opening, its box
    bodies    the number of pieces and of openings, and the box
    touchable the bodies whose contacts count: pairs in `near` touch at least, those in `overlaps` overlap
    """

    value: float
    is_picture: bool = False
    is_solved: bool = False
    errors: Mapping[Place, Fault] = field(default_factory=dict)
    warnings: Mapping[Place, Fault] = field(default_factory=dict)
    names: frozenset[str] = frozenset()
    unknowns: Mapping[str, float] = field(default_factory=dict)
    places: tuple[str, ...] = ()
    spots: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    readings: tuple[tuple[int, str, str], ...] = ()
    ways: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    bodies: Mapping[str, tuple[int, int, Bounds]] = field(default_factory=dict)
    cutters: Mapping[str, Cutter] = field(default_factory=dict)
    touchable: frozenset[str] = frozenset()
    near: frozenset[Pair] = frozenset()
    overlaps: frozenset[Pair] = frozenset()
    size: float = 1.0


def look(compiled: Compiled, value: float, written: Look | None = None) -> Look:
    """Returns what is discrete in an outcome; `written` is that of the program as written, if not this."""
    found = Look(value, is_picture=written is not None and written.is_picture)
    found.errors = {each.place: each for each in map(fault, compiled.errors)}
    found.is_solved = compiled.status == "solved"
    model, drawing = compiled.model, compiled.drawing
    if not found.is_solved or model is None or drawing is None or compiled.evaluate is None:
        return found
    found.size = drawing.size
    told = [d for d in compiled.audible(compiled.on_drawing()) if d.code in OF_KIND]
    found.warnings = {each.place: each for each in map(fault, told)}
    found.unknowns = {unknown.path: number for unknown, number in compiled.evaluate.values.items()}
    spots = list(_spots(model))
    found.places = tuple(place for place, _ in spots)
    found.spots = np.array([number for _, number in spots]) / found.size
    found.readings = tuple((r.span.line, r.span.one_line, r.text) for r in model.readings)
    structures = list(model.root.walk())
    found.names = frozenset(s.path for s in structures)
    found.names |= {path for s in structures for g in s.geometry for path in _stated(g)}
    found.ways = dict(_ways(model))
    regions = [(b, b.region.faces) for b in drawing.bodies]
    found.bodies = {b.path: (len(faces), sum(len(f.holes) for f in faces), b.box) for b, faces in regions}
    found.cutters = dict(_cutters(model, drawing))
    _see_contacts(found, model, drawing)
    if written is None and found.overlaps:
        found.is_picture = True
        _see_contacts(found, model, drawing)
    return found


def _stated(g: SolvedGeometry) -> Iterator[str]:
    """Yields the paths of geometry and its parts, without the pieces of an outline that is worked out."""
    yield g.path
    yield from (path for part in g.parts if g.recipe is None for path in _stated(part))


def _spots(model: SolvedModel) -> Iterator[tuple[str, float]]:
    """Yields the coordinates of the points of all geometry, and radii, with what they are of."""
    for geometry in model.root.walk_geometry():
        for name, value in geometry.values.items():
            place = geometry.path if name == "at" else f"{geometry.path}.{name}"
            if isinstance(value, tuple):
                yield from ((place, float(x)) for x in np.ravel(value))
            elif name in _RADII:
                yield place, float(value)


def _ways(model: SolvedModel) -> Iterator[tuple[str, tuple[float, ...]]]:
    """Yields the edges of what is filled, as far as they are written one by one."""
    filled = (s for s in model.root.walk() if s.kind in ("solid", "hole"))
    for geometry in (g for s in filled for g in s.geometry if g.type in _BY_HAND):
        for number, leaf in enumerate(geometry.leaves()):
            key = f"{leaf.path}\0{number}"
            if isinstance(leaf.curve, Line):
                (a, b), (c, d) = leaf.curve.start, leaf.curve.end
                yield key, (c - a, d - b)
            elif isinstance(leaf.curve, Arc):
                yield key, (leaf.curve.sweep,)


def _cutters(model: SolvedModel, drawing: Drawing) -> Iterator[tuple[str, Cutter]]:
    """Yields what cuts bodies; it has an opening of its own if one has its box."""
    slack = _SAME_BOX * drawing.size
    openings = {
        b.path: np.array([_box(loop.pieces) for face in b.region.faces for loop in face.holes]).reshape(-1, 4)
        for b in drawing.bodies
    }

    def visit(structure: SolvedStructure, body: str | None) -> Iterator[tuple[str, Cutter]]:
        body = structure.path if structure.path in openings else body
        if structure.kind == "hole" and body is not None:
            for path, box in _closed(structure):
                is_own = bool((np.abs(openings[body] - box).max(axis=1, initial=0) < slack).any())
                yield path, (body, is_own, box)
        for child in structure.structures:
            yield from visit(child, body)

    return visit(model.root, None)


def _closed(structure: SolvedStructure) -> Iterator[tuple[str, Bounds]]:
    """Yields the closed geometries of a hole; the hole itself if it is drawn line by line."""
    shapes = [g for g in structure.drawn if not g.construction and g.type not in _OPEN_TYPES]
    boxed = [(g.path, box) for g in shapes if (box := _box(g.curves())) is not None]
    if not boxed and (box := _box(c for g in structure.drawn for c in g.curves())) is not None:
        boxed = [(structure.path, box)]
    yield from boxed


def _box(curves: Iterable[Piece]) -> Bounds | None:
    boxes = [curve.box for curve in curves]
    return union_bounds(boxes) if boxes else None


def _see_contacts(found: Look, model: SolvedModel, drawing: Drawing) -> None:
    """Adds the contacts between bodies that may be at one height."""
    heights = dict(_heights(model, drawing))
    found.touchable = frozenset(heights if found.is_picture else found.bodies)
    pairs = [pair for pair in drawing.contacts.near() if found.touchable.issuperset(pair)]
    regions = {b.path: b.region for b in drawing.bodies}

    @cache
    def section(path: str) -> Section:
        return fill(regions[path].polygons(_TOUCHING * drawing.size), "EvenOdd")

    def is_overlap(a: str, b: str) -> bool:
        common = section(a) & section(b)
        if common.is_empty:
            return False
        left, bottom, right, top = common.box
        return common.area > _TOUCHING * drawing.size * (right - left + top - bottom)

    found.near = frozenset((a, b) for a, b in pairs if _meet(heights.get(a), heights.get(b)))
    found.overlaps = frozenset(pair for pair in found.near if is_overlap(*pair))


def _heights(model: SolvedModel, drawing: Drawing) -> Iterator[tuple[str, tuple[str, float, float]]]:
    """Yields the bodies of a known thickness: from where it is seen, its lower and its upper side."""

    def visit(structure: SolvedStructure, below: float) -> Iterator[tuple[str, tuple[str, float, float]]]:
        (lift,) = structure.attributes.get("elevation", (0.0,))
        height = below + float(lift)
        style = drawing.styles.get(structure.path)
        if style is not None and style.thickness is not None:
            yield structure.path, (structure.orientation, height, height + style.thickness)
        for child in structure.structures:
            yield from visit(child, height)

    return visit(model.root, 0.0)


def _meet(a: tuple[str, float, float] | None, b: tuple[str, float, float] | None) -> bool:
    if a is None or b is None or a[0] != b[0]:
        return True
    return min(a[2], b[2]) - max(a[1], b[1]) > 1e-9


# --- What differs between two outcomes.


def differences(a: Look, b: Look) -> list[Change]:
    """Returns what is of another kind at `b` than at `a`."""
    if a.errors.keys() != b.errors.keys():
        return list(_of_errors(a, b))
    if not (a.is_solved and b.is_solved):
        return []
    fresh = [each for place, each in b.warnings.items() if place not in a.warnings]
    found = [Change("warning", clause(each), each.line, (each.code,)) for each in fresh]
    found += _of_readings(a, b)
    if a.names != b.names:
        return [*found, *_of_arrays(a, b)]
    return [*found, *_of_edges(a, b), *_of_openings(a, b), *_of_contacts(a, b)]


def _of_errors(a: Look, b: Look) -> Iterator[Change]:
    for place, each in b.errors.items():
        if place not in a.errors:
            yield Change("error", clause(each), each.line)
    for place, each in a.errors.items():
        if place not in b.errors and not b.errors:
            yield Change("error", f"what failed before is well again: {clause(each)}", each.line, ("well",))


def _of_readings(a: Look, b: Look) -> Iterator[Change]:
    """Yields ambiguous calls that are read as another of their meanings."""
    if len(a.readings) == len(b.readings):
        for (line, call, before), (_, _, after) in zip(a.readings, b.readings, strict=True):
            if _RANK.findall(before) != _RANK.findall(after):
                yield Change("reading", f"`{call}` in line {line} is read in another sense", line, (call,))


def _of_edges(a: Look, b: Look) -> Iterator[Change]:
    for key, way in b.ways.items():
        was = a.ways.get(key)
        if was is None or len(was) != len(way):
            continue
        path = key.partition("\0")[0]
        if len(way) == 1 and abs(way[0] - was[0]) > math.pi:
            yield Change("edge", f"`{path}` goes the other way round", None, (path,))
        elif len(way) == 2 and way[0] * was[0] + way[1] * was[1] < 0:
            yield Change("edge", f"`{path}` turns back: its ends pass each other", None, (path,))


def _of_openings(a: Look, b: Look) -> Iterator[Change]:
    for path in a.bodies.keys() - b.bodies.keys():
        yield Change("pieces", f"nothing is left of `{path}`", None, (path,))
    for path in b.bodies.keys() - a.bodies.keys():
        yield Change("pieces", f"`{path}` is a body", None, (path,))
    for path in [path for path in a.bodies if path in b.bodies]:
        (pieces, openings, _), (pieces_then, openings_then, _) = a.bodies[path], b.bodies[path]
        parts = [p for p, cut in b.cutters.items() if cut[0] == path and cut[:2] != a.cutters[p][:2]]
        is_paint = path not in b.touchable
        if parts or (openings != openings_then and not is_paint):
            text = f"the openings of `{path}` go from {openings} to {openings_then}"
            if openings == openings_then:
                text = f"an opening of `{path}` is another"
            yield Change("openings", text + _why(parts, b), None, (path, *parts))
        if pieces != pieces_then and not is_paint:
            text = f"`{path}` goes from {counted(pieces, 'piece')} to {pieces_then}"
            yield Change("pieces", text, None, (path,))


def _why(parts: list[str], b: Look) -> str:
    """Returns what the cutters whose openings differ do, as the end of a sentence."""
    lost = [path for path in parts if not b.cutters[path][1]]
    won = [path for path in parts if b.cutters[path][1]]
    fates: dict[tuple[str, str], list[str]] = {("stands alone", "stand alone"): won} if won else {}
    for path in lost:
        body, _, box = b.cutters[path]
        if any(_gap(box, b.cutters[other][2]) < 0 for other in lost if other != path):
            fate = "meets another", "run into each other"
        elif _gap(box, b.bodies[body][2]) >= 0:
            fate = "leaves it", "leave it"
        else:
            fate = "breaks through its edge", "break through its edge"
        fates.setdefault(fate, []).append(path)
    told = [f"{first_few(ticked(these), 4)} {does[len(these) > 1]}" for does, these in fates.items()]
    return f": {'; '.join(told)}" if told else ""


def _gap(a: Bounds, b: Bounds) -> float:
    return max(a[0] - b[2], a[1] - b[3], b[0] - a[2], b[1] - a[3])


def _of_contacts(a: Look, b: Look) -> Iterator[Change]:
    for one, other in sorted(b.overlaps - a.overlaps):
        yield Change("contact", f"`{one}` and `{other}` begin to overlap", None, (one, other))
    for one, other in sorted(a.near - b.near):
        yield Change("contact", f"`{one}` and `{other}` let go of each other", None, (one, other, ""))


def _of_arrays(a: Look, b: Look) -> Iterator[Change]:
    """Yields what becomes of members of arrays, where their number is another."""
    alone, shared = ({_bare(p) for p, cut in look.cutters.items() if not cut[1]} for look in (a, b))
    for name in sorted((shared - alone) & set(map(_bare, a.cutters))):
        yield Change("openings", f"not each `{name}` has an opening of its own any more", None, (name,))
    names = set(map(_bare, a.names)) & set(map(_bare, b.names))
    was, now = ({(_bare(one), _bare(other)) for one, other in look.overlaps} for look in (a, b))
    for one, other in sorted(pair for pair in now - was if names.issuperset(pair)):
        yield Change("contact", f"`{one}` and `{other}` begin to overlap", None, (one, other))


def _bare(path: str) -> str:
    return _INDEX.sub("", path)


# --- What moves from one outcome to the other.


def moves(a: Look, b: Look) -> NDArray[np.float64]:
    """Returns how much each spot moves; nothing where they are of others."""
    return b.spots - a.spots if a.places == b.places else np.zeros(0)


def may_meet(a: Look, b: Look) -> float | None:
    """Returns the part of the way from `a` to `b` at which two boxes meet that are apart at both, if all move
    evenly: two openings of one body, two bodies. None if none do.
    """
    boxes, then = _moving(a), _moving(b)
    if not 2 <= len(boxes) <= _MOST_BOXES or boxes.keys() != then.keys():
        return None
    start, end = (np.array([box for _, box in look.values()]) for look in (boxes, then))
    owners = [owner for owner, _ in boxes.values()]
    pairs = [(i, j) for i, j in combinations(range(len(owners)), 2) if owners[i] == owners[j]]
    one, other = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
    apart = (_gaps(start, one, other) > 0) & (_gaps(end, one, other) > 0)
    shares = np.linspace(0, 1, 18)[1:-1].tolist() if apart.any() else ()
    deepest = [(float(_gaps(start + t * (end - start), one, other)[apart].min()), t) for t in shares]
    gap, share = min(deepest, default=(0.0, 0.0))
    return share if gap < 0 else None


def _moving(look: Look) -> dict[str, tuple[str, Bounds]]:
    """Returns the boxes that may meet, with what they belong to."""
    cutters = {path: (body, box) for path, (body, _, box) in look.cutters.items()}
    return cutters | {path: ("", box) for path, (*_, box) in look.bodies.items() if path in look.touchable}


def _gaps(boxes: NDArray[np.float64], one: NDArray[np.intp], other: NDArray[np.intp]) -> NDArray[np.float64]:
    """Returns how far boxes are apart, negative where they overlap."""
    a, b = boxes[one], boxes[other]
    found: NDArray[np.float64] = np.maximum(a[:, :2] - b[:, 2:], b[:, :2] - a[:, 2:]).max(axis=1)
    return found
