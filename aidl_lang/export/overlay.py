"""Layers that explain a drawing: names, points, boxes, constraints, freedom, plans; labels of parts."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field
from textwrap import wrap
from typing import TypeAlias, TypeGuard

import numpy as np
from numpy.typing import NDArray

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.export import marks
from aidl_lang.export.job import Job
from aidl_lang.export.marks import CHARACTER, Dot, Frame, Mark, Text, widened
from aidl_lang.geometry.curves import Bounds, Vec, are_near, union_bounds
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.intersect import from_sides, inside
from aidl_lang.geometry.region import COARSE, Region, piece_points
from aidl_lang.geometry.solved import ConstraintReport, SolvedGeometry, SolvedModel, SolvedStructure

# --- Names and numbers of parts on sheets, each where its part has room for it.

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
    asked = job.options.show & {"names", "numbers"}
    if not asked or job.options.sheet is None:
        return
    root, numbers = job.model.root.path, job.cut_list.numbers if "numbers" in asked else {}
    for body in job.drawing.bodies:
        words = [str(numbers[body.path])] if numbers else []
        words += [body.path.removeprefix(f"{root}.")] if "names" in asked else []
        label = " ".join(words)
        pieces = (piece for stroke in job.drawing.strokes for piece in stroke.pieces)
        engraved = [piece_points(piece, COARSE) for piece in pieces if are_near(piece.box, body.box)]
        middle, size = _room(body.region, engraved, CHARACTER * len(label))
        at = middle[0], middle[1] - _BASELINE * size
        yield Text(at, label, size, marks.NAME, "middle", halo=False)


def _room(region: Region, engraved: list[NDArray[np.float64]], width: float) -> tuple[Vec, float]:
    """Returns the middle and the size of the largest text, so many times as wide as high, that lies in the
    material beside what is engraved, as near to the middle of the part as there is room.
    """
    shrunk = [polygon / (width, 1.0) for polygon in region.polygons(COARSE)]
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
    start, end = np.split(np.concatenate(sides), 2, axis=1)
    room = np.array([from_sides(spot - start, end - start).min() for spot in spots])
    sizes = _AIR * np.sqrt(2) * room
    best = int(np.argmax(np.minimum(sizes, SIZE)))
    x, y = spots[best] * (width, 1.0)
    return (float(x), float(y)), float(min(sizes[best], SIZE))


def _sides(line: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.concatenate((line[:-1], line[1:]), axis=1)


# Text is sized by the picture, so that it can be read at the scale at which the whole is seen. Labels look
# for a free place near what they name; lists stand to the right of the drawing or below it.

FONT_SIZE = 0.022
MANY = 150
"""More points than this are drawn as dots alone."""
LINE_LENGTH = 58
"""Characters in a line of a list."""

_Thing: TypeAlias = SolvedStructure | SolvedGeometry


@record(frozen=False)
class Explainer:
    """The state of one overlay: font size and line width, and the boxes (n, 4) of what is on it already."""

    model: SolvedModel
    drawing: Drawing
    size: float
    taken: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 4)))

    @property
    def font(self) -> float:
        return FONT_SIZE * self.size

    @property
    def hair(self) -> float:
        return 0.0012 * self.size

    def take(self, box: Bounds) -> None:
        self.taken = np.vstack((self.taken, box))

    def overlap(self, box: Bounds) -> float:
        """Returns the area by which a box covers others."""
        left, bottom, right, top = self.taken.T
        width = np.minimum(right, box[2]) - np.maximum(left, box[0])
        height = np.minimum(top, box[3]) - np.maximum(bottom, box[1])
        covered: list[float] = (width * height)[(width > 0) & (height > 0)].tolist()
        return sum(covered)

    def boxes(self) -> Iterator[tuple[SolvedStructure, Bounds]]:
        for structure in self.model.root.walk():
            if structure.box is not None:
                yield structure, structure.box.bounds

    def label(self, text: str, around: Bounds, color: str, size: float, bold: bool = False) -> Text:
        """Returns the text at the first free place around and in a box, else where it hides least."""
        candidates = [Text(at, text, size, color, anchor, bold) for at, anchor in _places(around, size)]
        return self.first_free(candidates)

    def first_free(self, candidates: list[Text]) -> Text:
        checkpoint()
        air = 0.2 * candidates[0].size
        chosen = min(candidates, key=lambda c: self.overlap(widened(c.box, air)))
        self.take(chosen.box)
        return chosen


def explain(
    model: SolvedModel, drawing: Drawing, show: frozenset[str], box: Bounds, size: float
) -> tuple[Bounds, dict[str, list[Mark]]]:
    """Returns the box that holds the drawing with the layers asked for, and the marks of these, in a fixed
    order from the back to the front.
    """
    layers: dict[str, list[Mark]] = {}
    if not show:
        return box, layers
    at = Explainer(model, drawing, size)
    boxes = (Frame(box, marks.BOX, at.hair, 4 * at.hair) for _, box in at.boxes())
    makers = {"plan": _plans(at), "bbox": boxes, "points": _points(at), "names": _names(at)}
    for name, made in makers.items():
        if name in show:
            layers[name] = list(made)
    # Lists stand beside a tall drawing and below a wide one, where they cost the least of its size.
    wide = box[2] - box[0] > 1.25 * (box[3] - box[1])
    corner = (box[0], box[1] - 3 * at.font) if wide else (box[2] + 2 * at.font, box[3] - 0.7 * at.font)
    for name, lists in (("constraints", _constraints), ("dof", _degrees)):
        if name in show:
            layers[name] = lists(at, corner)
            listed = [m.box[2] for m in layers[name] if isinstance(m, Text) and not m.halo]
            corner = (max(listed, default=corner[0]) + 2 * at.font, corner[1])
    texts = [m.box for layer in layers.values() for m in layer if isinstance(m, Text | Frame)]
    return union_bounds([box, *texts]), layers


def _places(box: Bounds, size: float) -> Iterator[tuple[Vec, str]]:
    """Yields baselines for a label: above the left corner, centred above, inside, below, beside."""
    left, bottom, right, top = box
    middle, gap = (left + right) / 2, 0.35 * size
    yield (left, top + gap), "start"
    yield (middle, top + gap), "middle"
    yield (right, top + gap), "end"
    yield (left + gap, top - size), "start"
    yield (middle, (top + bottom) / 2 - 0.3 * size), "middle"
    yield (left, bottom - size), "start"
    yield (middle, bottom - size), "middle"
    yield (right + gap, (top + bottom) / 2 - 0.3 * size), "start"
    yield (left - gap, (top + bottom) / 2 - 0.3 * size), "end"


def _names(at: Explainer) -> Iterator[Mark]:
    """Yields names of structures at their boxes, the root's first and bold."""
    for structure, box in at.boxes():
        small = max(0.5 * at.font, min(at.font, 0.3 * (box[3] - box[1])))
        yield _name(at, structure, box, small)


def _name(at: Explainer, structure: SolvedStructure, box: Bounds, size: float) -> Text:
    """Places a name in the upper left corner of a structure without parts if it fits, else around it."""
    inside = Text((box[0] + 0.35 * size, box[3] - 1.1 * size), structure.name, size, marks.NAME)
    fits = inside.box[2] < box[2] and box[3] - box[1] > 2.5 * size
    if fits and not structure.structures and not at.overlap(inside.box):
        return at.first_free([inside])
    return at.label(structure.name, box, marks.NAME, size, bold=structure is at.model.root)


def _plans(at: Explainer) -> Iterator[Mark]:
    for plan in at.drawing.plans:
        yield Frame(plan.box, marks.PLAN, 1.6 * at.hair, 8 * at.hair)
        left, bottom, right, top = plan.box
        fitting = (right - left) / max(1, 0.7 * len(plan.name))
        size = max(0.5 * at.font, min(1.2 * at.font, fitting, 0.6 * (top - bottom)))
        label = Text(
            ((left + right) / 2, (top + bottom) / 2 - 0.3 * size), plan.name, size, marks.PLAN, "middle"
        )
        at.take(label.box)
        yield label


def _points(at: Explainer) -> Iterator[Mark]:
    """Yields dots at all named points; names that coincide share a label."""
    names: dict[tuple[int, int], list[str]] = defaultdict(list)
    places: dict[tuple[int, int], Vec] = {}
    step = 1e-6 * at.size
    for structure in at.model.root.walk():
        for geometry in structure.geometry:
            for name, p in _named_points(geometry, geometry.name):
                key = (round(p[0] / step), round(p[1] / step))
                places.setdefault(key, p)
                if name not in names[key]:
                    names[key].append(name)
    radius = 0.2 * at.font
    for p in places.values():
        at.take((p[0] - radius, p[1] - radius, p[0] + radius, p[1] + radius))
        yield Dot(p, radius, marks.POINT)
    if len(places) <= MANY:
        size = 0.6 * at.font
        for key, p in places.items():
            spot = (p[0] - radius, p[1] - 1.5 * radius, p[0] + radius, p[1] + 1.5 * radius)
            text = " = ".join(names[key][:2]) + (" …" if len(names[key]) > 2 else "")
            yield at.label(text, spot, marks.POINT, size)


def _named_points(geometry: SolvedGeometry, name: str) -> Iterator[tuple[str, Vec]]:
    """Yields the points of a geometry by name; of compound shapes only named ones, no ends of edges."""
    if geometry.type == "point":
        value = geometry.values.get("at")
        if _is_point(value):
            yield name, value
        return
    for key, value in geometry.values.items():
        if _is_point(value):
            yield f"{name}.{key}", value
    for part in geometry.parts:
        if part.type == "point":
            yield from _named_points(part, f"{name}.{part.name}")


def _is_point(value: object) -> TypeGuard[Vec]:
    return isinstance(value, tuple) and len(value) == 2 and all(isinstance(v, float | int) for v in value)


def _constraints(at: Explainer, corner: Vec) -> list[Mark]:
    """Returns numbers near what the constraints mention, and their texts in a list; violated ones in red."""
    found: list[Mark] = []
    size, (left, top) = 0.7 * at.font, corner
    every: list[_Thing] = [*at.model.root.walk(), *at.model.root.walk_geometry()]
    things = {thing.path: thing for thing in reversed(every)}
    for number, constraint in enumerate(at.model.constraints, 1):
        checkpoint()
        color = marks.GOOD if constraint.satisfied else marks.BAD
        spot = _spot(things, constraint)
        if spot is not None:
            found.append(at.label(str(number), spot, color, 0.75 * at.font, bold=True))
        text = " ".join(constraint.text.split())
        soft = "prefer " if constraint.soft and not text.startswith("prefer") else ""
        holds = "" if constraint.satisfied else f"  ✗ off by {constraint.residual:.3g}"
        words = f"{number}  {soft}{text}{holds}"
        lines = wrap(words, LINE_LENGTH, break_long_words=False, break_on_hyphens=False)
        for k, line in enumerate(lines):
            found.append(Text((left + (1.6 * size if k else 0), top), line, size, color, halo=False))
            top -= 1.35 * size
    return found


def _spot(things: Mapping[str, _Thing], constraint: ConstraintReport) -> Bounds | None:
    """Returns a place between the things that a constraint mentions."""
    for paths in (constraint.mentions(), (constraint.path,)):
        if boxes := [box for path in paths if (box := _box_of(things, path)) is not None]:
            x = sum(b[0] + b[2] for b in boxes) / (2 * len(boxes))
            y = sum(b[1] + b[3] for b in boxes) / (2 * len(boxes))
            return x, y, x, y
    return None


def _box_of(things: Mapping[str, _Thing], path: str) -> Bounds | None:
    """Returns the box of what a path leads to, or of its last known element."""
    known = path
    while known and known not in things:
        known = known[: max(known.rfind("."), known.rfind("["), 0)]
    thing = things.get(known)
    if thing is None or isinstance(thing, SolvedStructure):
        return None if thing is None or thing.box is None else thing.box.bounds
    value = thing.values.get(path.removeprefix(known).lstrip(".") or "at")
    if _is_point(value):
        return value[0], value[1], value[0], value[1]
    boxes = [part.curve.box for part in thing.walk() if part.curve is not None]
    return union_bounds(boxes) if boxes else None


def _degrees(at: Explainer, corner: Vec) -> list[Mark]:
    """Returns the degrees of freedom at each structure that has any, and the free parameters in a list."""
    found: list[Mark] = []
    size, (left, top) = 0.7 * at.font, corner
    structures, mobility = list(at.model.root.walk()), at.model.mobility()
    free = _free_by_structure(structures, mobility.free)
    for structure, box in at.boxes():
        degrees, _ = mobility.of(structure)
        if degrees or structure is at.model.root:
            found.append(at.label(f"{structure.name}: {degrees} dof", box, marks.FREE, size))
    count = mobility.degrees
    lines = [(0, "degrees of freedom not counted" if count is None else f"{count} degrees of freedom")]
    for structure in structures:
        if names := free.get(structure.path):
            lines.append((0, f"{structure.path}: {mobility.of(structure)[0]}"))
            lines += [(1, name) for name in names]
    for indent, line in lines:
        found.append(Text((left + indent * size, top), line, size, marks.FREE, halo=False))
        top -= 1.35 * size
    return found


def _free_by_structure(structures: list[SolvedStructure], free: Iterable[str]) -> dict[str, list[str]]:
    """Groups free parameters by the innermost structure whose path they begin with, named from there."""
    paths = {s.path for s in structures}
    result: dict[str, list[str]] = defaultdict(list)
    for name in free:
        path = name.rpartition(".")[0]
        while path and path not in paths:
            path = path.rpartition(".")[0]
        result[path].append(name.removeprefix(path + "."))
    return result
