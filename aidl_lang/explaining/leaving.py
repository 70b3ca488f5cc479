"""Details that constraints from outside moved within their structure, away from what is drawn beside them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from aidl_lang.building.expression import Unknown
from aidl_lang.building.lower import Lowered
from aidl_lang.building.model import Constraint, Geometry, Structure
from aidl_lang.common.diagnostics import Diagnostic, Label
from aidl_lang.common.prose import named, short
from aidl_lang.common.records import record
from aidl_lang.solver import Settings, Solution

_FAR = 0.1
"""The part of the extent of both by which a detail may move without a word."""
_NAMED = 3
"""Siblings told by name."""
_STILL = 1e-6
"""Moves below this, in mm, count as none."""
_SECONDS = 1.0
"""For the search for a place of a structure as a whole."""


@record()
class _Detail:
    """A geometry of a structure, how far it moved there, and the constraints that name it."""

    geometry: Geometry
    moved: float
    constraints: tuple[Constraint, ...]

    def left_by(self, structure: Structure) -> bool:
        """Tells whether the detail moved for constraints from outside alone."""
        outside = [not c.holder.is_within(structure) for c in self.constraints]
        return self.moved > _STILL and bool(outside) and all(outside)

    @property
    def stayed(self) -> bool:
        """Tells whether it is drawn and stayed where it was written, with no constraint on it."""
        is_drawn = self.geometry.type != "point" and not self.geometry.construction
        return is_drawn and not self.constraints and self.moved <= _STILL


def leaving_notes(root: Structure, lowered: Lowered, solution: Solution) -> Iterator[Diagnostic]:
    """Yields a warning for each structure of which a part was taken away from the rest by constraints that a
    structure around it holds, and for what else was left behind.
    """
    written = dict(zip(lowered.unknowns, map(float, lowered.problem.initial), strict=True))
    solved = dict(zip(lowered.unknowns, map(float, solution.values), strict=True))
    naming: dict[Unknown | Structure, list[Constraint]] = {}
    for stated in filter(None, lowered.stated):
        for comparison in stated.comparisons:
            for unknown in comparison.spoken_of:
                naming.setdefault(unknown, []).append(stated)
            for structure in comparison.boxes:
                naming.setdefault(structure, []).append(stated)
    places: dict[Structure, dict[Geometry, list[Unknown]]] = {}
    for unknown in written:
        holder = unknown.holder
        is_place = not (unknown.kept or unknown.angular or unknown.frame_of or unknown.outline)
        if is_place and isinstance(holder, Geometry) and unknown.owner.parent is not None:
            places.setdefault(unknown.owner, {}).setdefault(holder, []).append(unknown)
    for structure, found in places.items():
        details = [
            _Detail(
                geometry,
                max(abs(solved[u] - written[u]) for u in unknowns),
                tuple(dict.fromkeys(c for u in unknowns for c in naming.get(u, ()))),
            )
            for geometry, unknowns in found.items()
        ]
        stayed = [detail for detail in details if detail.stayed]
        left = [detail for detail in details if detail.left_by(structure)]
        extent = _extent([u for d in (*stayed, *left) for u in found[d.geometry]], written)
        left = [detail for detail in left if detail.moved > _FAR * extent]
        if left and stayed:
            yield _left(structure, left, stayed, _fits(structure, lowered))
    from aidl_lang.explaining.staying import staying_notes

    yield from staying_notes(root, lowered, solution, naming)


def _fits(structure: Structure, lowered: Lowered) -> bool:
    """Tells whether a place is found for a structure as a whole, with all other positions free."""
    from aidl_lang.solver.suspects import nearby_solution

    problem = lowered.problem
    start = {
        index: float(problem.initial[index])
        for index, unknown in enumerate(lowered.unknowns)
        if unknown.frame_of is structure or not (unknown.kept or unknown.owner.is_within(structure))
    }
    hard = [index for index, weight in enumerate(problem.weight.tolist()) if weight != weight]
    return nearby_solution(problem, Settings(seconds=_SECONDS), hard, start) is not None


def _extent(unknowns: Sequence[Unknown], written: Mapping[Unknown, float]) -> float:
    """Returns the larger extent of some coordinates along an axis."""
    spans = []
    for axis in ("x", "y"):
        along = [written[u] for u in unknowns if u.field.rpartition(".")[2] == axis]
        spans.append(max(along) - min(along) if along else 0.0)
    return max(spans)


def _left(structure: Structure, left: Sequence[_Detail], stayed: Sequence[_Detail], fits: bool) -> Diagnostic:
    chief = max(left, key=lambda detail: detail.moved)
    inside = f"{structure.path}."
    stays = named([d.geometry.path.removeprefix(inside) for d in stayed], _NAMED)
    asking = list(dict.fromkeys(c for d in left for c in d.constraints))
    name = chief.geometry.path.removeprefix(inside)
    return Diagnostic(
        "W0603",
        f"`{name}` moved by {short(chief.moved)} within `{structure.path}`, and {stays} stayed where written",
        chief.geometry.span or structure.span,
        "left what stands beside it",
        tuple(Label(span, "asks for it") for span in dict.fromkeys(c.span for c in asking)),
        (
            f"with `fixed(…)` for `{name}` others give way: `{structure.name}` fits as a whole then"
            if fits
            else f"`{structure.name}` as a whole has no place that fits: with `fixed(…)` for `{name}` it is "
            "told what stands against it",
            f"if `{name}` shall move alone, say by a constraint in `{structure.name}` where the others are",
        ),
    )
