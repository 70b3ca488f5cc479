"""Compares two trees from the root down, once their structures and geometries are paired."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import PurePath
from typing import TypeGuard, TypeVar

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.export.comparison.changes import (
    STILL,
    Comparison,
    ContactChange,
    Fields,
    GeometryChange,
    Move,
    Pose,
    Sort,
    StructureChange,
    Value,
    Version,
    pose_of,
)
from aidl_lang.geometry.boolean import Contact
from aidl_lang.geometry.curves import Arc, Line, Vec
from aidl_lang.geometry.region import Region, measure
from aidl_lang.geometry.solved import Scalar, SolvedGeometry, SolvedStructure

# --- Pairs the structures and geometries of two versions: by path first, renamed ones by shape.

_T = TypeVar("_T", SolvedGeometry, SolvedStructure)
_MOST = 8
"""Structures of one form that are tried for a new name."""


@record(frozen=False)
class GeometryPair:
    """One geometry in both versions."""

    before: SolvedGeometry
    after: SolvedGeometry
    pose: Pose

    @property
    def was(self) -> str | None:
        return self.before.name if self.before.name != self.after.name else None


@record(frozen=False)
class StructurePair:
    """One structure in both versions, with its paired, vanished and new members.

    `was` is the path before of a structure that was found by its shape under another name.
    """

    before: SolvedStructure
    after: SolvedStructure
    geometry: list[GeometryPair]
    structures: list[StructurePair]
    gone_geometry: list[SolvedGeometry]
    new_geometry: list[SolvedGeometry]
    gone: list[SolvedStructure]
    new: list[SolvedStructure]
    tolerance: float
    was: str | None = None

    def walk(self) -> Iterator[StructurePair]:
        yield self
        for pair in self.structures:
            yield from pair.walk()

    @cached_property
    def pose(self) -> Pose:
        """The pose of everything that is in both versions; valid once all pairs are found."""
        parts = [*(g.pose for g in self.geometry), *(s.pose for s in self.structures)]
        return Pose.joined([*parts, *_plan(self.before, self.after, self.tolerance)], self.tolerance)

    @property
    def items(self) -> list[Pose | StructurePair]:
        return [*(g.pose for g in self.geometry), *self.structures]

    def follows(self, move: Move) -> bool:
        """True if most of its members moved by `move`."""
        if self.pose.fits(move):
            return True
        return 2 * sum(item.follows(move) for item in self.items) > len(self.items)

    @cached_property
    def is_altered(self) -> bool:
        """True if anything in it appeared, vanished or changed its kind, wherever the rest is."""
        a, b = self.before, self.after
        return (
            bool(self.gone or self.new or self.gone_geometry or self.new_geometry)
            or a.kind != b.kind
            or [f.sizes for f in a.finishes] != [f.sizes for f in b.finishes]
            or any(p.before.construction != p.after.construction for p in self.geometry)
            or any(p.is_altered for p in self.structures)
        )


def _plan(a: SolvedStructure, b: SolvedStructure, tolerance: float) -> Iterator[Pose]:
    """Yields the pose of the box of two structures that are still empty."""
    if not (a.is_empty or b.is_empty):
        return
    if not (a.is_empty and b.is_empty and a.box and b.box):
        yield Pose(tolerance, congruent=False)
        return
    corners = [[(s.box.left, s.box.bottom), (s.box.right, s.box.top)] for s in (a, b) if s.box]
    yield Pose(tolerance, np.array(corners))


def match(before: SolvedStructure, after: SolvedStructure, tolerance: float) -> StructurePair:
    """Pairs two trees; `tolerance` in mm."""
    enclosed = _enclosed(before, after)
    root = _by_name(enclosed, _enclosed(after, before) if enclosed is before else after, tolerance)
    is_named_by_file = all(s.span and _stem(s.span.source.name) == s.name for s in (before, after))
    if root.before.name != root.after.name and not is_named_by_file:
        root.was = root.before.path
    _find_renamed(root, tolerance)
    return root


def _enclosed(root: SolvedStructure, other: SolvedStructure) -> SolvedStructure:
    """Puts a root into an assembly of the other root's name if it stands inside that in the other version.

    A file with one structure has it as root; with a second one, both are in an assembly named after the file.
    """
    inner = next((s for s in other.structures if s.name == root.name and s.kind == root.kind), None)
    if inner is None or root.name == other.name:
        return root
    return replace(other, geometry=(), structures=(root,), box=root.box, finishes=(), finished=None)


def _stem(file: str) -> str:
    """Returns the name that a file gives to an assembly without one of its own."""
    return re.sub(r"\W+", "_", PurePath(file).stem).strip("_") or "model"


def _by_name(a: SolvedStructure, b: SolvedStructure, tolerance: float) -> StructurePair:
    checkpoint()
    geometry, gone_geometry, new_geometry = _split(a.geometry, b.geometry)
    structures, gone, new = _split(a.structures, b.structures)
    pairs = [GeometryPair(p, q, pose_of(p, q, tolerance)) for p, q in geometry]
    for p, q, pose in _congruent(gone_geometry, new_geometry, _form_of_geometry, pose_of, tolerance):
        pairs.append(GeometryPair(p, q, pose))
    order = {g.name: i for i, g in enumerate(b.geometry)}
    pairs.sort(key=lambda pair: order[pair.after.name])
    children = [_by_name(p, q, tolerance) for p, q in structures]
    return StructurePair(a, b, pairs, children, gone_geometry, new_geometry, gone, new, tolerance)


def _split(a: Sequence[_T], b: Sequence[_T]) -> tuple[list[tuple[_T, _T]], list[_T], list[_T]]:
    """Returns pairs of the same name in order of b, those only in a, those only in b."""
    before, after = {x.name: x for x in a}, {x.name for x in b}
    both = [(before[y.name], y) for y in b if y.name in before]
    return both, [x for x in a if x.name not in after], [y for y in b if y.name not in before]


def _find_renamed(root: StructurePair, tolerance: float) -> None:
    """Pairs what vanished with what appeared in the same shape, anywhere in the tree."""
    nodes = list(root.walk())
    gone = [s for node in nodes for s in node.gone]
    new = [s for node in nodes for s in node.new]
    holder = {s.path: node for node in nodes for s in node.new}

    def pose(a: SolvedStructure, b: SolvedStructure, tolerance: float) -> Pose:
        pair = _by_name(a, b, tolerance)
        return Pose(tolerance, congruent=False) if pair.is_altered else pair.pose

    for a, b, _ in _congruent(gone, new, _form, pose, tolerance):
        pair = _by_name(a, b, tolerance)
        pair.was = a.path
        holder[b.path].structures.append(pair)
    left = {s.path for s in gone}, {s.path for s in new}
    for node in nodes:
        node.gone = [s for s in node.gone if s.path in left[0]]
        node.new = [s for s in node.new if s.path in left[1]]
        order = {s.name: i for i, s in enumerate(node.after.structures)}
        node.structures.sort(key=lambda p: order[p.after.name])


def _congruent(
    gone: list[_T],
    new: list[_T],
    form: Callable[[_T], object],
    pose: Callable[[_T, _T, float], Pose],
    tolerance: float,
) -> list[tuple[_T, _T, Pose]]:
    """Removes pairs of the same shape from both lists, those that moved least first."""
    by_form: dict[object, list[_T]] = {}
    for x in gone:
        by_form.setdefault(form(x), []).append(x)
    found = []
    for y in new:
        near = _nearest(y, by_form.get(form(y), []), pose, tolerance)
        if near is not None:
            found.append(near)
            same = by_form[form(y)]
            same[:] = [x for x in same if x is not near[0]]
    old, young = ({id(pair[side]) for pair in found} for side in (0, 1))
    gone[:] = [x for x in gone if id(x) not in old]
    new[:] = [y for y in new if id(y) not in young]
    return found


def _nearest(
    y: _T, candidates: Sequence[_T], pose: Callable[[_T, _T, float], Pose], tolerance: float
) -> tuple[_T, _T, Pose] | None:
    """Returns the like candidate that moved least, of the first few: renamed ones keep their order."""
    found: list[tuple[float, float, int, _T, Pose]] = []
    for x in candidates[:_MOST]:
        p = pose(x, y, tolerance)
        move = p.move() if p.points.size else None
        if move is not None:
            found.append(
                (abs(move.turn) + 360 * move.mirrored, math.hypot(move.dx, move.dy), len(found), x, p)
            )
        if move == STILL:
            break
    if not found:
        return None
    *_, x, p = min(found, key=lambda entry: entry[:3])
    return x, y, p


def _form(s: SolvedStructure) -> object:
    """Returns a key that is equal for structures that differ only in name and place."""
    inner = tuple((c.name, _form(c)) for c in s.structures)
    return s.kind, tuple((g.name, g.type) for g in s.geometry), inner


def _form_of_geometry(g: SolvedGeometry) -> object:
    return g.type, g.construction, tuple((p.name, _form_of_geometry(p)) for p in g.parts)


# --- The numbers and words of a structure or geometry, and which of them differ.

RELATIVE, ABSOLUTE = 1e-6, 1e-9
Values = Mapping[str, Value]
Changed = dict[str, tuple[Value, Value]]


def changed(a: Values, b: Values, move: Move = STILL, tolerance: float = 0.0) -> Changed:
    """Returns the values that differ, in order of writing after; points moved by `move` are equal."""
    pairs = {name: (a.get(name), b.get(name)) for name in dict.fromkeys([*b, *a])}
    return {
        name: (x, y)
        for name, (x, y) in pairs.items()
        if not ((_is_point(x) and _is_point(y) and math.dist(move(x), y) <= tolerance) or is_same(x, y, name))
    }


def is_same(a: Value, b: Value, name: str = "") -> bool:
    """True for equal values: numbers to 1e-6 of themselves, angles up to whole turns."""
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(is_same, a, b))
    if _is_number(a) and _is_number(b):
        difference = math.remainder(a - b, 360) if "angle" in name else a - b
        return abs(difference) <= RELATIVE * max(abs(a), abs(b)) + ABSOLUTE
    return type(a) is type(b) and a == b


def _is_number(value: Value) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_point(value: Value) -> TypeGuard[Vec]:
    return isinstance(value, tuple) and len(value) == 2 and all(isinstance(x, float) for x in value)


def settings(s: SolvedStructure) -> dict[str, Value]:
    """Returns the kind, the attributes and the finished corners of a structure."""
    found: dict[str, Value] = {"kind": s.kind}
    for name, values in s.attributes.items():
        found[f"@{name}"] = _plain(values) if values else True
    for finish in s.finishes:
        name, number = f"{finish.kind} of {finish.text}", 2
        while name in found:
            name, number = f"{finish.kind} {number} of {finish.text}", number + 1
        found[name] = _plain(finish.sizes)
    return found


def _plain(values: tuple[Scalar, ...]) -> Value:
    return values[0] if len(values) == 1 else values


def sizes(s: SolvedStructure, region: Region | None) -> dict[str, Value]:
    """Returns the size of the box and, for material or a hole, the measures of the region."""
    found: dict[str, Value] = {}
    if s.box is not None:
        found |= {"width": s.box.width, "height": s.box.height}
    if region:
        measures = measure(region)
        found |= {"area": measures.area, "perimeter": measures.perimeter, "centroid": measures.centroid}
    return found


def of_geometry(a: SolvedGeometry, b: SolvedGeometry, move: Move, tolerance: float) -> Changed:
    """Returns the changed fields of a geometry that did not move as one; corners and radii of outlines."""
    if a.type != b.type:
        return {"type": (a.type, b.type)}
    first, last = _values(a), _values(b)
    both = {name: first[name] for name in first if name in last}, {n: last[n] for n in last if n in first}
    found = changed(*both, move, tolerance)
    if found or not b.parts:
        return found
    corners = dict(_corners(a)), dict(_corners(b))
    return changed(*corners, move, tolerance) | changed(dict(_radii(a)), dict(_radii(b)))


def _values(g: SolvedGeometry) -> dict[str, Value]:
    found: dict[str, Value] = {}
    for name, value in g.values.items():
        if isinstance(value, tuple) and value and isinstance(value[0], tuple):
            found |= {f"{name}[{i}]": p for i, p in enumerate(value) if isinstance(p, tuple)}
        else:
            found[name] = value  # type: ignore[assignment]
    if isinstance(g.curve, Line):
        x, y = (q - p for p, q in zip(g.curve.start, g.curve.end, strict=True))
        found |= {"length": math.hypot(x, y), "angle": math.degrees(math.atan2(y, x))}
    if isinstance(g.curve, Arc):
        found["sweep"] = math.degrees(abs(g.curve.sweep))
    return found


def _corners(g: SolvedGeometry, prefix: str = "") -> Iterator[tuple[str, Value]]:
    for part in g.parts:
        if part.type == "point":
            yield prefix + part.name, part.values["at"]  # type: ignore[misc]
        yield from _corners(part, f"{prefix}{part.name}.")


def _radii(g: SolvedGeometry, prefix: str = "") -> Iterator[tuple[str, Value]]:
    for part in g.parts:
        for name in ("radius", "rx", "ry"):
            if name in part.values:
                yield f"{prefix}{part.name}.{name}", part.values[name]  # type: ignore[misc]
        yield from _radii(part, f"{prefix}{part.name}.")


# --- Compares two trees from the root down: each structure relative to the motion of its parent.

TOLERANCE = 1e-6
_CANDIDATES = 3
"""Motions tried for a structure of which not everything went the same way."""


def compare(before: Version, after: Version) -> Comparison:
    """Returns the differences between two versions."""
    size = max(_extent(before), _extent(after))
    with np.errstate(all="ignore"):  # a model that did not solve may hold numbers that are none
        root = match(before.model.root, after.model.root, TOLERANCE * size)
        structures = tuple(_Walk(before, after, TOLERANCE * size).changes(root, STILL, is_root=True))
    names = {pair.before.path: pair.after.path for pair in root.walk()}
    free = {_renamed(path, names): None for path in before.model.mobility().free}
    still_free = set(after.model.mobility().free)
    return Comparison(
        before,
        after,
        structures,
        tuple(_contact_changes(before, after, names, TOLERANCE * size)),
        tuple(path for path in after.model.mobility().free if path not in free),
        tuple(path for path in free if path not in still_free),
        size,
    )


def _extent(version: Version) -> float:
    box = version.model.root.box
    return max([version.drawing.size, *([] if box is None else [box.width, box.height])])


def _renamed(path: str, names: Mapping[str, str]) -> str:
    """Returns the path after of a path before, renamed by its longest beginning that is a structure."""
    beginning = path
    while beginning not in names and "." in beginning:
        beginning = beginning.rpartition(".")[0]
    return names.get(beginning, beginning) + path[len(beginning) :]


def _contact_changes(
    before: Version, after: Version, names: Mapping[str, str], tolerance: float
) -> Iterator[ContactChange]:
    bodies = {names.get(b.path, "") for b in before.drawing.bodies} & {b.path for b in after.drawing.bodies}
    first = {
        frozenset((names[c.a], names[c.b])): c for c in before.drawing.pairs if {c.a, c.b} <= names.keys()
    }
    last = {frozenset((c.a, c.b)): c for c in after.drawing.pairs}
    for pair in dict.fromkeys([*last, *first]):
        a, b = first.get(pair), last.get(pair)
        if not pair <= bodies or _is_same(a, b, tolerance):
            continue
        ends = (b.a, b.b) if b else (names[a.a], names[a.b]) if a else ("", "")
        yield ContactChange(*ends, a, b)


def _is_same(a: Contact | None, b: Contact | None, tolerance: float) -> bool:
    """True for equal contacts; pairs without one are apart."""
    if a is None or b is None:
        return all(c is None or c.relation == "apart" for c in (a, b))
    if a.gap is not None and b.gap is not None:
        return abs(a.gap - b.gap) <= tolerance
    return a.relation == b.relation and is_same(a.area, b.area)


@record()
class _Walk:
    before: Version
    after: Version
    tolerance: float

    def changes(
        self, pair: StructurePair, expected: Move, *, is_root: bool = False, settled: bool = False
    ) -> Iterator[StructureChange]:
        """Yields the changes of a structure and of all in it.

        `expected` is the motion of its parent; `settled` says that all in it is known to have moved so.
        """
        checkpoint()
        whole = expected if settled else pair.pose.move(expected)
        move = whole or self._majority(pair, expected, is_root) or expected
        a, b = pair.before, pair.after
        geometry = tuple(self._geometry(pair, move, whole is not None))
        is_turned = bool(move.turn) or any(g.move is not None and g.move.turn for g in geometry)
        told = StructureChange(
            b.path,
            b.kind,
            was=pair.was,
            move=None if move == expected else move,
            middle=_middle(a),
            sizes={} if whole and not pair.is_altered else self._sizes(pair, move, is_root, is_turned),
            params=changed(a.params, b.params),
            settings=changed(settings(a), settings(b)),
            geometry=geometry,
        )
        if told.is_one:
            yield told
        for child in pair.structures:
            yield from self.changes(child, move, settled=whole is not None)
        for vanished in pair.gone:
            yield self._alone(vanished, "vanished", self.before)
        for appeared in pair.new:
            yield self._alone(appeared, "appeared", self.after)

    def _majority(self, pair: StructurePair, expected: Move, is_root: bool) -> Move | None:
        """Returns the motion of most in a structure, if not `expected`; None for a root with what stayed."""
        if pair.follows(expected) or (is_root and any(item.follows(STILL) for item in pair.items)):
            return None
        return next((move for move in self._candidates(pair) if pair.follows(move)), None)

    def _candidates(self, pair: StructurePair) -> list[Move]:
        """The most frequent motions of single things; turns get a place, for circles show only shifts."""
        votes: dict[tuple[int, ...], list[Move]] = {}
        for move in (leaf.pose.shift() for inner in pair.walk() for leaf in inner.geometry):
            if move is not None and np.isfinite([move.dx, move.dy, move.turn]).all():
                steps = (move.dx / self.tolerance, move.dy / self.tolerance, 1e5 * move.turn)
                votes.setdefault((*(round(s / 100) for s in steps), move.mirrored), []).append(move)
        ranked = [same[0] for same in sorted(votes.values(), key=lambda same: -len(same))]
        turns = [move for move in ranked if move.turn or move.mirrored]
        return ranked[:_CANDIDATES] + turns[:_CANDIDATES]

    def _sizes(self, pair: StructurePair, move: Move, is_root: bool, is_turned: bool) -> Fields:
        a, b = pair.before, pair.after
        if b.kind == "assembly" and not (is_root or pair.geometry):
            return {}  # that of its parts is told there
        first = sizes(a, self.before.drawing.regions.get(a.path))
        last = sizes(b, self.after.drawing.regions.get(b.path))
        if is_turned:  # the box of a turned thing is another one
            first, last = (
                {n: v for n, v in f.items() if n not in ("width", "height")} for f in (first, last)
            )
        return changed(first, last, move, self.tolerance)

    def _alone(self, s: SolvedStructure, sort: Sort, version: Version) -> StructureChange:
        found = sizes(s, version.drawing.regions.get(s.path))
        told = changed({}, found) if sort == "appeared" else changed(found, {})
        return StructureChange(s.path, s.kind, sort, middle=_middle(s), sizes=told)

    def _geometry(self, pair: StructurePair, expected: Move, settled: bool) -> Iterator[GeometryChange]:
        for g in pair.geometry:
            told = self._one_geometry(g, expected, settled)
            if told.was or told.move or told.fields or told.is_outline_changed:
                yield told
        for vanished in pair.gone_geometry:
            yield GeometryChange(vanished.name, vanished.type, "vanished")
        for appeared in pair.new_geometry:
            yield GeometryChange(appeared.name, appeared.type, "appeared")

    def _one_geometry(self, g: GeometryPair, expected: Move, settled: bool) -> GeometryChange:
        a, b = g.before, g.after
        whole = expected if settled else g.pose.move(expected)
        found = changed({"construction": a.construction}, {"construction": b.construction})
        if whole is None:
            found = of_geometry(a, b, expected, self.tolerance) | found
        move = None if whole == expected else whole
        return GeometryChange(b.name, b.type, "changed", g.was, move, found, is_outline_changed=whole is None)


def _middle(s: SolvedStructure) -> Vec | None:
    return None if s.box is None else ((s.box.left + s.box.right) / 2, (s.box.bottom + s.box.top) / 2)


__all__ = ["Comparison", "ContactChange", "GeometryChange", "StructureChange", "Version", "compare"]
