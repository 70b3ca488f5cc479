"""The step from Model to Problem: the structure tree for the solver, unknowns and constraints by number.

The solver's groups are the structures, parents first. Unknowns that nothing can move are constants there: a
frame that no constraint mentions, an argument that was read while building, an angle that nothing turns.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Expression, Place, Unknown
from aidl_lang.building.model import (
    Comparison,
    Condition,
    Constraint,
    Geometry,
    Model,
    Structure,
    chain,
    convert,
    is_size,
    own_geometry,
)
from aidl_lang.building.values import Num, PointVal
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.common.records import record
from aidl_lang.solver import Constraint as SolverConstraint
from aidl_lang.solver import Problem, Relation, Row, Solution
from aidl_lang.solver.expression import TapeBuilder
from aidl_lang.solver.problem import Floats, constraint_arrays

_RADIAN = 180.0 / np.pi

_LONGEST_TURN = 60.0  # degrees that an angle may turn in one step of the solver

_SIDES = frozenset({"left", "right"}), frozenset({"bottom", "top"})  # the sides of boxes by axis

LEAST_SHARE = 1e-3
"""The least part of a kept size that remains when it gives way: it may shrink, but not vanish."""


@record(kw_only=True)
class Lowered(Problem):
    """A problem for the solver that knows what its numbers stand for.

    unknowns  by their number
    stated    for each constraint that was lowered, the one of the model; None for those that come with the
              nature of a size or a box (never negative)
    groups    path of the structure that each group is
    """

    unknowns: tuple[Unknown, ...]
    stated: tuple[Constraint | None, ...]
    groups: tuple[str, ...]

    def by_unknown(self, values: Floats) -> dict[Unknown, float]:
        return dict(zip(self.unknowns, values.tolist(), strict=True))

    def stated_at(self, numbers: Iterable[int]) -> list[Constraint]:
        """Returns the constraints of the model behind those with some numbers."""
        return [stated for number in numbers if (stated := self.stated[number]) is not None]

    @property
    def preference(self) -> list[int]:
        """The constraints as conflicts take them for granted: unwritten ones first, then as written."""

        def place(index: int) -> tuple[bool, str, int, int]:
            if (stated := self.stated[index]) is None:
                return (False, "", 0, index)
            return (stated.wording is not None, stated.span.source.name, stated.span.start, index)

        return sorted(range(len(self.stated)), key=place)


Solved: TypeAlias = Solution[Lowered]


def lower(model: Model) -> Lowered:
    return _Lowering(model).run()


class _Lowering:
    def __init__(self, model: Model) -> None:
        self.model = model
        self.groups = {s: i for i, s in enumerate(model.root.walk())}
        self.tape = TapeBuilder()
        self.make = {op: getattr(self.tape, op) for op in ex.EVALUATE}
        self.node_of: dict[Expression, int] = {}
        self.numbers: dict[Unknown, int] = {}
        self.variables: dict[Structure, list[Unknown]] = {}
        parts = (part for c in model.constraints for part in c.comparisons)
        self.mentioned = set(ex.unknowns(side for part in parts for side in (part.left, part.right)))
        self.holders = {c.holder for c in model.constraints}
        self.named = {c: self._named(c) for c in model.constraints}
        self.named_things: dict[Structure, set[Hashable]] = {}
        # Every number that defines the drawing, by structure.
        self.seen = {s: [at for _, _, at in seen(s)] for s in self.groups}
        self.size = _extent(self.seen, model.root)

    def run(self) -> Lowered:
        self._number_unknowns()
        stated = [c for c in (*self.model.constraints, *self._bounds()) if c.holder in self.groups]
        # In an order of their own, so that the order of writing cannot show in the last digits.
        stated.sort(key=lambda c: (c.text, c.label, c.span.start))
        constraints = [*map(self._constraint, stated), *self._never_vanishing()]
        observables = tuple((self.groups[s], o) for s in self.groups for o in self._observables(s))
        found = tuple(self.numbers)
        stands = cache(self._stands)
        return Lowered(
            tape=self.tape.finish(),
            initial=np.array([u.guess for u in found], dtype=np.float64),
            scale=np.array([_RADIAN / self.size if u.angular else 1.0 for u in found], dtype=np.float64),
            kept=np.array([u.kept for u in found], dtype=np.bool_),
            group=np.array([self.groups[self._placer(u)] for u in found], dtype=np.intp),
            frame_of=np.array(
                [self.groups[m] if (m := self._moved(u)) else -1 for u in found], dtype=np.intp
            ),
            axis=np.array([_axis(u) for u in found], dtype=np.intp),
            longest=np.array([_LONGEST_TURN if u.angular else np.inf for u in found], dtype=np.float64),
            parent=np.array([self.groups[s.parent] if s.parent else -1 for s in self.groups], dtype=np.intp),
            **constraint_arrays(constraints),
            named=True,
            standing=np.array([not u.angular and stands(u.frame_of) for u in found], dtype=np.bool_),
            spanned=np.array([_is_spanned(u) for u in found], dtype=np.bool_),
            rigid=np.array([self._is_rigid(s) for s in self.groups], dtype=np.bool_),
            sealed=np.array([self._sealed(u.owner) for u in found], dtype=np.intp),
            thing=_numbered(
                (u.holder, u.field if u.kept and not _is_spanned(u) else u.field.rpartition(".")[0])
                for u in found
            ),
            clinging=frozenset(self.groups[s] for parent in self.groups for s in _clinging(parent)),
            observables=observables,
            names=tuple(u.path for u in found),
            unknowns=found,
            stated=(*stated, *[None] * (len(constraints) - len(stated))),
            groups=tuple(s.path for s in self.groups),
        )

    # --- Unknowns ------------------------------------------------------------------------------

    def _number_unknowns(self) -> None:
        """Numbers the unknowns that can move: the drawing's, and both coordinates of mentioned frames."""
        shown = self.mentioned.union(u for u in ex.unknowns(self._observed()) if u.frame_of is None)
        for constraint in self.model.constraints:
            if constraint.weight is None and not constraint.is_inherent:
                self._name_things(constraint)
        named = {
            s
            for c, both in self.named.items()
            for structures in both
            for structure in structures
            for s in chain(structure)
            if s.is_within(c.holder) and s is not c.holder
        }
        for unknown in self.model.unknowns:
            is_variable = _is_variable(unknown)
            live = is_variable or unknown in shown or unknown.frame_of in named
            if live and not unknown.exact and unknown.owner in self.groups:
                self.numbers[unknown] = len(self.numbers)
                if is_variable:
                    self.variables.setdefault(unknown.owner, []).append(unknown)

    def _placer(self, unknown: Unknown) -> Structure:
        """Returns the structure at whose turn an unknown is placed; for an empty one's box its parent."""
        parent = unknown.owner.parent
        return parent if parent is not None and self._is_outline(unknown) else unknown.owner

    def _is_outline(self, unknown: Unknown) -> bool:
        return unknown.outline and unknown in self.mentioned and unknown.owner not in self.holders

    def _moved(self, unknown: Unknown) -> Structure | None:
        """Returns the structure that an unknown moves as a whole; None for one of its contents."""
        return unknown.owner if self._is_outline(unknown) else unknown.frame_of

    def _stands(self, s: Structure | None) -> bool:
        """Tells whether a frame lies on its parent's, with something in it at an exact place: that is exact
        in the parent, too, as long as the frame stays. It turns only on request.
        """
        if s is None:
            return False
        lies_on = s.frame.x.value == s.frame.y.value == s.frame.rotation.value == 0.0
        return lies_on and any(map(_is_exact, self.seen[s]))

    def _sealed(self, s: Structure) -> int:
        """Returns the depth of the innermost `@rigid` structure around this; 0 for none, -1 for the root."""
        said = [each.attributes.get("rigid", (False,)) != (False,) for each in chain(s)]
        depths = (len(said) - 1 - n for n, is_rigid in enumerate(said) if is_rigid)
        return next((depth or -1 for depth in depths), 0)

    def _is_rigid(self, s: Structure) -> bool:
        """Tells whether a structure can move and constraints around it name one thing of it at most: its
        place, a side of its box along x and one along y, a point that can move in it, a structure in it.
        """
        named = self.named_things.get(s, set())
        sides = {thing for thing in named if isinstance(thing, frozenset)}
        along = ({side for side in sides if side & axis} for axis in _SIDES)
        inside = sum(thing is not None and not isinstance(thing, frozenset) for thing in named)
        movable = (any(u in self.numbers for u in ex.unknowns([at])) for at in (s.frame.x, s.frame.y))
        return inside + max(None in named, *map(len, along)) < 2 and all(movable)

    def _name_things(self, constraint: Constraint) -> None:
        """Notes the things that a constraint names in the structures within its holder."""
        for comparison in constraint.comparisons:
            for structure, sides in comparison.boxes.items():
                self._name_thing(constraint.holder, structure, sides)
            for unknown in comparison.spoken_of:
                if (moved := self._moved(unknown)) is not None:
                    self._name_thing(constraint.holder, moved, None)
                elif not unknown.kept:
                    thing = unknown.holder, unknown.field.rpartition(".")[0]
                    self._name_thing(constraint.holder, unknown.owner, thing)

    def _name_thing(self, holder: Structure, s: Structure, thing: Hashable) -> None:
        """Notes a thing of `s` in it, and in each structure up to the holder the one that it is in."""
        for structure in chain(s, holder):
            self.named_things.setdefault(structure, set()).add(thing)
            thing = structure

    # --- Expressions ---------------------------------------------------------------------------

    def _node(self, root: Expression) -> int:
        return ex.folded(root, self.node_of, self.make, self._leaf)

    def _leaf(self, node: Expression) -> int:
        if node.op == "constant":
            return self.tape.constant(node.value)
        if (number := self.numbers.get(node.payload)) is None:
            return self.tape.constant(node.payload.guess)
        return self.tape.unknown(number, shifts=_axis(node.payload) >= 0)

    def _observed(self) -> Iterator[Expression]:
        for s, found in self.seen.items():
            for at in found:
                yield from at
            if any(len(at) == 2 for at in found):
                for frame in (each.frame for each in chain(s)[:-1]):
                    yield from (frame.x, frame.y, frame.rotation)

    def _observables(self, s: Structure) -> Iterator[int]:
        """Yields the numbers of a structure that a reader could see move, and its variables."""
        for at in self.seen[s]:
            yield from map(self._node, convert(at, s, self.model.root) if isinstance(at, Place) else at)
        yield from (self.tape.unknown(self.numbers[u]) for u in self.variables.get(s, ()))

    # --- Constraints ---------------------------------------------------------------------------

    def _constraint(self, constraint: Constraint) -> SolverConstraint:
        rows = tuple(self._row(c) for c in constraint.comparisons)
        placed = {u for c in constraint.comparisons for u in c.placed}
        named = self.named.get(constraint, ((), ()))
        whole, inside = (frozenset(self.groups[s] for s in each if s in self.groups) for each in named)
        numbers = frozenset(self.numbers[u] for u in placed if u in self.numbers)
        return SolverConstraint(
            self.groups[constraint.holder], rows, numbers, constraint.weight, whole, inside
        )

    def _named(self, constraint: Constraint) -> tuple[set[Structure], set[Structure]]:
        """Returns the structures that a constraint names as a whole, and those in which it names something. A
        constraint of a shape on itself names nothing.
        """
        whole: set[Structure] = set()
        inside: set[Structure] = set()
        for comparison in () if constraint.is_inherent else constraint.comparisons:
            mentioned = set(comparison.spoken_of)
            for structure in comparison.boxes:
                whole.add(structure)
                if structure.plan:  # its box is that of its contents
                    inside.add(structure)
                mentioned.update(ex.unknowns(_places(structure, constraint.holder)))
            for unknown in mentioned:
                moved = self._moved(unknown)
                (inside if moved is None else whole).add(moved or unknown.owner)
        return whole, inside

    def _row(self, comparison: Comparison) -> Row:
        tape = self.tape
        left, right = self._node(comparison.left), self._node(comparison.right)
        length, angle = comparison.dimension or LENGTH
        scale = float(self.size**length * _RADIAN**angle)  # of a typical residual, for its tolerance
        if comparison.relation == "==":
            difference = tape.sub(left, right)
            if comparison.dimension == ANGLE:
                # Angles agree modulo a turn: the difference as a direction, smooth except at half a turn.
                radians = tape.mul(difference, tape.constant(1 / _RADIAN))
                turn = tape.atan2(tape.sin(radians), tape.cos(radians))
                difference = tape.mul(turn, tape.constant(_RADIAN))
            return Row(difference, Relation.EQUAL, scale)
        if comparison.relation in (">=", ">"):
            left, right = right, left
        return Row(tape.sub(left, right), Relation.AT_MOST, scale)

    def _bounds(self) -> Iterator[Constraint]:
        """Yields the bounds that shapes demand of their numbers and that hold as written, as constraints: no
        size becomes one that its shape would refuse.
        """
        for asked in self.model.assertions:
            parts = list(_comparisons(asked.condition)) if asked.shape else []
            if not parts or not all(_is_bound(part) for part in parts):
                continue
            for part in parts:
                if any(u in self.numbers for u in ex.unknowns([part.left, part.right])):
                    yield Constraint(
                        asked.holder, (part,), asked.text, asked.span, None, asked.label, is_inherent=True
                    )

    def _never_vanishing(self) -> Iterator[SolverConstraint]:
        for unknown, number in self.numbers.items():
            is_named = is_size(unknown.field.rpartition(".")[2]) and unknown.guess >= 0
            if is_named or (unknown.kept and unknown.is_size and unknown.guess > 0):
                least = LEAST_SHARE * unknown.guess
                expression = self.tape.sub(self.tape.constant(least), self.tape.unknown(number))
                row = Row(expression, Relation.AT_MOST, self.size)
                yield SolverConstraint(self.groups[unknown.owner], (row,), frozenset())


def _is_exact(at: _Seen) -> bool:
    """Tells whether a place is one that only sizes and angles could move."""
    return len(at) == 2 and all(u.kept or u.angular for u in ex.unknowns(at))


def _comparisons(condition: Condition | bool) -> Iterator[Comparison]:
    """Yields the comparisons that all have to hold for a condition; none if there is more to it."""
    if not isinstance(condition, Condition) or condition.operator != "and":
        return
    for part in condition.parts:
        if isinstance(part, Comparison):
            yield part
        else:
            yield from _comparisons(part)


def _is_bound(part: Comparison) -> bool:
    """Tells whether a comparison is an inequality that holds at the first guesses."""
    if part.relation in ("==", "!=") or part.left.is_open or part.right.is_open:
        return False
    low, high = (part.left, part.right) if part.relation in ("<=", "<") else (part.right, part.left)
    return low.value <= high.value


def _clinging(parent: Structure) -> Sequence[Structure]:
    """Returns the children that belong to the drawing around them: all that lie in a part or in an assembly
    within another, and in the root holes and drawings beside parts; but none that stands still, as its place
    was given in the frame of the root.
    """
    frames = [(c, c.frame) for c in parent.children]
    children = [c for c, f in frames if parent.parent or not (f.x.is_constant and f.y.is_constant)]
    if parent.plan or parent.parent or any(not geometry.construction for geometry in parent.own()):
        return children
    without = [child for child in children if child.kind in ("hole", "drawing")]
    return without if len(without) < len(children) else ()


def _is_variable(unknown: Unknown) -> bool:
    """Tells whether an unknown is a number of a structure, and no part of its frame or outline."""
    return isinstance(unknown.holder, Structure) and unknown.frame_of is None and not unknown.outline


def _axis(unknown: Unknown) -> int:
    """Returns the axis along which a coordinate lies; -1 for an unknown that is no place."""
    if unknown.kept or unknown.angular or _is_variable(unknown):
        return -1
    return {"x": 0, "y": 1, "left": 0, "bottom": 1}.get(unknown.field.rpartition(".")[2], -1)


def _places(structure: Structure, holder: Structure) -> Iterator[Expression]:
    for frame in (s.frame for s in chain(structure, holder)):
        yield from (frame.x, frame.y, frame.rotation)


_Seen = Place | tuple[Expression]  # a place, or a number


def seen(s: Structure) -> Iterator[tuple[Geometry | Structure, str, _Seen]]:
    """Yields the numbers that define the geometry of a structure itself, in its own frame, with the thing and
    its path. The observables of the problem are these, structure by structure, and after each its variables.
    """
    for geometry in s.own():
        for path, at in _seen_geometry(geometry):
            yield geometry, path, at
    if s.plan:
        left, bottom, width, height = s.plan
        yield s, s.path, Place(left, bottom)
        yield s, s.path, Place(left + width, bottom + height)


def _seen_geometry(geometry: Geometry) -> Iterator[tuple[str, _Seen]]:
    for name, value in geometry.fields.items():
        if isinstance(value, PointVal):
            yield f"{geometry.path}.{name}", value.place
        elif isinstance(value, Num):
            yield f"{geometry.path}.{name}", (value.expression,)
    # A pattern begins where the outline does that it fills: where what it repeats stands is not seen.
    recipe = geometry.recipe
    within = recipe.operands[1] if recipe is not None and recipe.kind == "tiled" else None
    for part in own_geometry(geometry.parts, geometry):
        if within is None or part in within:
            yield from _seen_geometry(part)


def _is_spanned(unknown: Unknown) -> bool:
    """Tells whether an unknown is the way from one literal point of a shape to the next, for which no number
    was written. The steps of a path have numbers.
    """
    return unknown.implied and isinstance(unknown.holder, Geometry) and unknown.holder.type != "path"


def _numbered(keys: Iterable[Hashable]) -> NDArray[np.intp]:
    numbers: dict[Hashable, int] = {}
    return np.array([numbers.setdefault(key, len(numbers)) for key in keys], dtype=np.intp)


def _extent(drawn: Mapping[Structure, Iterable[_Seen]], root: Structure) -> float:
    """Returns about the extent of the places at the first guesses in mm: the power of two above it, at least
    1.

    So a small change of a model changes no tolerance, and nothing in parts that it does not concern.
    """
    low, high = 0.0, 0.0
    for s, found in drawn.items():
        for at in found:
            for value in convert(at, s, root).written if isinstance(at, Place) else ():
                if abs(value) < 1e12:
                    low, high = min(low, value), max(high, value)
    return float(2.0 ** np.ceil(np.log2(max(high - low, 1.0))))
