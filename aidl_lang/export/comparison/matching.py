"""Pairs the structures and geometries of two versions: by path first, renamed ones by shape."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import PurePath
from typing import TypeVar

import numpy as np

from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.export.comparison.changes import STILL, Move, Pose, pose_of
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure

_T = TypeVar("_T", SolvedGeometry, SolvedStructure)
_MOST = 8
"""Structures of one form that are tried for a new name."""


@record(frozen=False)
class GeometryPair:
    """One geometry in both versions."""

    before: SolvedGeometry
    after: SolvedGeometry
    pose: Pose

    def follows(self, move: Move) -> bool:
        return self.pose.follows(move)

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
        parts = [item.pose for item in self.items]
        return Pose.joined([*parts, *_plan(self.before, self.after, self.tolerance)], self.tolerance)

    @property
    def items(self) -> list[GeometryPair | StructurePair]:
        return [*self.geometry, *self.structures]

    def leaves(self) -> Iterator[GeometryPair]:
        """Yields all geometry in it that is in both versions."""
        for pair in self.walk():
            yield from pair.geometry

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
    """Returns the candidate of the same shape that moved least, among the first few: many that were renamed
    together keep their order.
    """
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
    return (
        s.kind,
        tuple((g.name, g.type) for g in s.geometry),
        tuple((c.name, _form(c)) for c in s.structures),
    )


def _form_of_geometry(g: SolvedGeometry) -> object:
    return g.type, g.construction, tuple((p.name, _form_of_geometry(p)) for p in g.parts)
