"""Hierarchies of groups as problems of AIDL's solver, and their check.

    tree-D  groups with four children each, D levels deep. A leaf is a part: a plate of kept size with a hole
            at each end. A group has a plate of its own, on which its children stand in a row, and which is
            at least as large as they need.
    row-N   N parts under one root, in a row

The problems have the shapes that `lower` gives real programs: a frame's translation belongs to the parent; a
box is the least and the greatest over every curve below, in the frame of who asks; what a call on a child
places is everything in that child; sizes never vanish. Every position starts off by up to a millimetre, so
that there is work in each group.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from aidl_lang.solver import Constraint, Problem, Relation, Row
from aidl_lang.solver.expression import TapeBuilder
from aidl_lang.solver.problem import constraint_arrays
from benchmarks.solver.sketch import Floats

BRANCHING = 4
NOISE = 1.0
GAP, MARGIN, INSET = 2.0, 3.0, 4.0
"""Between children, around them, and of a hole from the end of its plate, in millimetres."""
PART = (40.0, 20.0)
LEAST_SHARE = 1e-3
"""Of a kept size, what must be left."""

Node: TypeAlias = int
Sides: TypeAlias = list[list[Node]]
"""Left, right, bottom, top: for each the candidates on the tape, in the frame of a group."""
Box: TypeAlias = tuple[float, float, float, float]
"""Left, right, bottom, top."""


@dataclass
class Group:
    """A structure, by the numbers of its unknowns.

    frame     its translation, x and y; none for the root
    plate     centre x and y, width, height; none for the root of a row
    holes     centre x and y, radius
    sides     the candidates for its box, in its own frame
    unknowns  those of the subtree, its own frame among them
    """

    number: int
    frame: tuple[int, ...] = ()
    plate: tuple[int, ...] = ()
    holes: list[tuple[int, ...]] = field(default_factory=list)
    children: list[Group] = field(default_factory=list)
    sides: Sides = field(default_factory=lambda: [[], [], [], []])
    unknowns: list[int] = field(default_factory=list)


def assembly(shape: str) -> tuple[Problem, Group]:
    """`tree-D` or `row-N`: the problem and its root. Raises ValueError for anything else."""
    kind, _, size = shape.partition("-")
    if kind not in ("tree", "row") or not size.isdigit() or int(size) < 1:
        raise ValueError(f"`{shape}` is no shape; write tree-3 or row-100")
    draft = _Draft()
    root = draft.tree(None, int(size), 0.0) if kind == "tree" else draft.row(int(size))
    return draft.problem(root), root


def flattened(problem: Problem) -> Problem:
    """The same rows over the same unknowns, in a single group."""
    n = len(problem.initial)
    return replace(
        problem,
        group=np.zeros(n, dtype=np.int64),
        frame_of=np.full(n, -1, dtype=np.int64),
        parent=np.array([-1], dtype=np.int64),
        holder=np.zeros(len(problem.holder), dtype=np.int64),
        observables=tuple((0, node) for _, node in problem.observables),
    )


class _Draft:
    """Collects the arrays of a problem."""

    def __init__(self, seed: int = 1) -> None:
        self._tape = TapeBuilder()
        self._random = np.random.default_rng(seed)
        self._initial: list[float] = []
        self._kept: list[bool] = []
        self._owner: list[int] = []
        self._frame_of: list[int] = []
        self._parent: list[int] = []
        self._constraints: list[Constraint] = []

    # -- groups

    def tree(self, parent: Group | None, depth: int, at: float) -> Group:
        if depth == 0:
            return self._part(parent, at)
        group = self._group(parent, at)
        left, right, bottom, top = self._plate(group, (_width(depth), PART[1] + 2.0 * depth * MARGIN), False)
        for i in range(BRANCHING):
            self.tree(group, depth - 1, i * (_width(depth - 1) + GAP))
        boxes = self._stand_in_row(group)
        tape, margin, first = self._tape, self._tape.constant(MARGIN), group.children[0]
        self._equal(group, tape.sub(boxes[0][0], tape.add(left, margin)), placed=first.unknowns)
        self._equal(group, tape.sub(boxes[0][2], tape.add(bottom, margin)), placed=first.unknowns)
        self._at_most(group, tape.add(boxes[-1][1], margin), right)
        for box in boxes:
            self._at_most(group, tape.add(box[3], margin), top)
        return group

    def row(self, count: int) -> Group:
        root = self._group(None, 0.0)
        for i in range(count):
            self._part(root, i * (PART[0] + GAP))
        first = self._stand_in_row(root)[0]
        self._equal(root, first[0], first[2], placed=root.children[0].unknowns)
        return root

    def _part(self, parent: Group | None, at: float) -> Group:
        group, tape = self._group(parent, at), self._tape
        left, right, *_ = self._plate(group, PART, True)
        middle, height = tape.unknown(group.plate[1]), tape.unknown(group.plate[3])
        inset, radii, inner = tape.constant(INSET), [], []
        for end, inwards in ((tape.add(left, inset), tape.add), (tape.sub(right, inset), tape.sub)):
            hole = tuple(self._unknown(group, value) for value in (0.0, 0.0, 3.0))
            group.holes.append(hole)
            x, y, radius = map(tape.unknown, hole)
            self._equal(group, tape.sub(x, end), tape.sub(y, middle), placed=hole[:2])
            self._at_most(group, tape.constant(0.0), radius)
            radii.append(radius)
            inner.append(inwards(x, radius))
        self._equal(group, tape.sub(radii[0], tape.div(height, tape.constant(8.0))), placed=group.holes[0])
        self._equal(group, tape.sub(radii[1], radii[0]), placed=group.holes[1])
        self._at_most(group, tape.add(inner[0], tape.constant(GAP)), inner[1])
        return group

    def _stand_in_row(self, group: Group) -> list[list[Node]]:
        """Children side by side, their bottoms level; their boxes in the frame of the group."""
        tape, boxes = self._tape, []
        for child in group.children:
            shifts = [tape.unknown(child.frame[i]) for i in (0, 0, 1, 1)]
            sides = [
                [tape.add(node, shift) for node in side]
                for side, shift in zip(child.sides, shifts, strict=True)
            ]
            for own, more in zip(group.sides, sides, strict=True):
                own += more
            group.unknowns += child.unknowns
            extremes = (tape.minimum, tape.maximum, tape.minimum, tape.maximum)
            boxes.append([extreme(*side) for extreme, side in zip(extremes, sides, strict=True)])
        for child, before, box in zip(group.children[1:], boxes, boxes[1:], strict=False):
            after = tape.add(before[1], tape.constant(GAP))
            self._equal(group, tape.sub(box[0], after), placed=child.unknowns)
            self._equal(group, tape.sub(box[2], before[2]), placed=child.unknowns)
        return boxes

    def _group(self, parent: Group | None, at: float) -> Group:
        group = Group(len(self._parent))
        self._parent.append(-1 if parent is None else parent.number)
        if parent is not None:
            parent.children.append(group)
            group.frame = tuple(
                self._unknown(group, value, owner=parent.number, frame_of=group.number) for value in (at, 0.0)
            )
        return group

    def _plate(self, group: Group, size: tuple[float, float], is_kept: bool) -> list[Node]:
        """Its left, right, bottom and top. Its size gives way last, or freely; it never vanishes."""
        tape = self._tape
        centre = [self._unknown(group, 0.0) for _ in size]
        extent = [self._unknown(group, value, is_kept=is_kept) for value in size]
        group.plate = (*centre, *extent)
        found = []
        for middle, length, value in zip(centre, extent, size, strict=True):
            half = tape.div(tape.unknown(length), tape.constant(2.0))
            found += [tape.sub(tape.unknown(middle), half), tape.add(tape.unknown(middle), half)]
            least = LEAST_SHARE * value if is_kept else 0.0
            self._at_most(group, tape.constant(least), tape.unknown(length))
        for side, node in zip(group.sides, found, strict=True):
            side.append(node)
        return found

    # -- unknowns and rows

    def _unknown(
        self, group: Group, value: float, owner: int | None = None, frame_of: int = -1, is_kept: bool = False
    ) -> int:
        number = len(self._initial)
        noise = 0.0 if is_kept else float(self._random.uniform(-NOISE, NOISE))
        self._initial.append(value + noise)
        self._kept.append(is_kept)
        self._owner.append(group.number if owner is None else owner)
        self._frame_of.append(frame_of)
        group.unknowns.append(number)
        return number

    def _equal(self, group: Group, *zeros: Node, placed: Sequence[int]) -> None:
        rows = tuple(Row(node, Relation.EQUAL) for node in zeros)
        self._constraints.append(Constraint(group.number, rows, frozenset(placed)))

    def _at_most(self, group: Group, a: Node, b: Node) -> None:
        row = Row(self._tape.sub(a, b), Relation.AT_MOST)
        self._constraints.append(Constraint(group.number, (row,), frozenset()))

    def problem(self, root: Group) -> Problem:
        n = len(self._initial)
        return Problem(
            tape=self._tape.finish(),
            initial=np.array(self._initial),
            scale=np.ones(n),
            kept=np.array(self._kept),
            group=np.array(self._owner, dtype=np.int64),
            frame_of=np.array(self._frame_of, dtype=np.int64),
            parent=np.array(self._parent, dtype=np.int64),
            **constraint_arrays(self._constraints),
            observables=tuple((root.number, node) for side in root.sides for node in side),
        )


def _width(depth: int) -> float:
    """What a group needs."""
    if depth == 0:
        return PART[0]
    return BRANCHING * _width(depth - 1) + (BRANCHING - 1) * GAP + 2.0 * MARGIN


# ---- the check ------------------------------------------------------------------------------------------


def worst_violation(root: Group, x: Floats) -> float:
    """The largest violation in millimetres, on boxes computed from the values alone."""
    violations: list[float] = []
    box = _measure(root, x, violations)
    if not root.plate:
        violations += [abs(box[0]), abs(box[2])]
    return max(map(float, violations))


def _measure(group: Group, x: Floats, violations: list[float]) -> Box:
    """The box of a group in its own frame; adds what is violated in it."""
    boxes: list[Box] = []
    for child in group.children:
        left, right, bottom, top = _measure(child, x, violations)
        dx, dy = x[list(child.frame)]
        boxes.append((left + dx, right + dx, bottom + dy, top + dy))
    for a, b in pairwise(boxes):
        violations += [abs(b[0] - a[1] - GAP), abs(b[2] - a[2])]
    if group.plate:
        middle_x, middle_y, width, height = x[list(group.plate)]
        own = (middle_x - width / 2, middle_x + width / 2, middle_y - height / 2, middle_y + height / 2)
        violations += [*_around(own, boxes), *_in_plate(group, own, x)]
        boxes.append(own)
    lefts, rights, bottoms, tops = zip(*boxes, strict=True)
    return min(lefts), max(rights), min(bottoms), max(tops)


def _around(own: Box, boxes: Sequence[Box]) -> Iterator[float]:
    """A plate that is as large as what stands on it."""
    yield max(own[0] - own[1], own[2] - own[3])
    if boxes:
        yield abs(boxes[0][0] - own[0] - MARGIN)
        yield abs(boxes[0][2] - own[2] - MARGIN)
        yield boxes[-1][1] + MARGIN - own[1]
        yield max(box[3] for box in boxes) + MARGIN - own[3]


def _in_plate(group: Group, own: Box, x: Floats) -> Iterator[float]:
    """Holes at both ends of a plate."""
    for hole, end in zip(group.holes, (own[0] + INSET, own[1] - INSET), strict=False):
        at_x, at_y, radius = x[list(hole)]
        yield abs(at_x - end)
        yield abs(at_y - (own[2] + own[3]) / 2.0)
        yield abs(radius - (own[3] - own[2]) / 8.0)
