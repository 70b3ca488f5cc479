"""Things: structures or geometry that together are one named part of a drawing."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import dataclass, replace
from itertools import chain
from typing import TypeAlias

from aidl_lang import Span
from aidl_lang.common.prose import first_few
from aidl_lang.geometry.boolean import united, without
from aidl_lang.geometry.curves import Bounds, union_bounds
from aidl_lang.geometry.drawing import Drawing, draw
from aidl_lang.geometry.offsets import hull
from aidl_lang.geometry.outlines import complete
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import Box, Frame, SolvedGeometry, SolvedModel, SolvedStructure
from aidl_lang.syntax import ast

Part: TypeAlias = SolvedStructure | SolvedGeometry
Group: TypeAlias = tuple[Part, ...]
Place: TypeAlias = tuple[str, int, int]
Origins: TypeAlias = Mapping[Place, tuple[str, ...]]
"""The names of a value's makers, by its place in the program."""

_SAME = 1e-6
"""Relative difference up to which lengths are equal."""


@dataclass(frozen=True)
class Thing:
    """Parts in groups: those in one group are drawn as one, and groups only lie together.

    is_buried  the material of its structure is all around it and hides it
    spans      if its curves enclose nothing, it is the area between them (the roof of a `house(…)`)
    """

    groups: tuple[Group, ...]
    is_buried: bool = False
    spans: bool = False

    @property
    def path(self) -> str:
        """The path of the first part, and the number of those beside it."""
        return first_few([group[0].path for group in self.groups], 1)

    @property
    def paths(self) -> Iterator[str]:
        return (part.path for group in self.groups for part in group)

    def region(self, drawing: Drawing) -> Region:
        """Returns its region in the drawing; empty for strokes only."""
        covered = united(*(_region(group, drawing) for group in self.groups))
        if self.spans and not covered:
            parts = (part for group in self.groups for part in group if isinstance(part, SolvedGeometry))
            return hull([curve for part in parts for curve in part.curves()])
        return covered

    def bounds(self) -> Bounds | None:
        """Returns the box of its curves."""
        boxes = [box for group in self.groups for part in group for box in _boxes(part)]
        return union_bounds(boxes) if boxes else None

    def box(self, region: Callable[[], Region]) -> Box | None:
        """Returns the box of its curves; of its region if it has no curves yet."""
        box = self.bounds()
        if box is None and (found := region()):
            box = found.box
        return Box(*box) if box is not None else None

    def buried(self, material: Region | None, drawing: Drawing) -> Thing:
        """Returns it, marked as buried if its removal from a material would leave its whole outline as a new
        edge.
        """
        if not material or not (own := self.region(drawing)):
            return self
        edges = material.perimeter + own.perimeter
        left = without(material, own).perimeter
        return replace(self, is_buried=math.isclose(left, edges, rel_tol=_SAME))

    def without(self, others: Set[str]) -> Thing:
        """Returns it without the parts at these paths inside it, if anything is left."""
        left = (tuple(chain.from_iterable(_less(part, others) for part in group)) for group in self.groups)
        kept = tuple(group for group in left if group)
        return replace(self, groups=kept) if kept else self


def _region(group: Group, drawing: Drawing) -> Region:
    match group:
        case (SolvedStructure(path=path),) if path in drawing.regions:
            return drawing.regions[path]
    return covered(group)


def covered(group: Group) -> Region:
    """Returns what parts cover when nothing else is drawn."""
    return draw(_alone(group))[0].regions.get("it", Region())


def _alone(group: Group) -> SolvedModel:
    geometry = tuple(part for part in group if isinstance(part, SolvedGeometry))
    solids = tuple(part for part in group if isinstance(part, SolvedStructure))
    nowhere = Frame(0.0, 0.0, 0.0)
    it = SolvedStructure("it", "it", "solid", "top", nowhere, {}, {}, geometry, solids, None, False, None)
    return SolvedModel("solved", it)


def _boxes(part: Part) -> Iterator[Bounds]:
    if isinstance(part, SolvedGeometry):
        yield from (curve.box for curve in part.curves())
    elif (box := part.box) is not None:
        yield box.left, box.bottom, box.right, box.top


def _less(part: Part, others: Set[str]) -> Iterator[Part]:
    if not _within(part) & others:
        yield _shown(part) if isinstance(part, SolvedGeometry) else part
        return
    for one in _inside(part):
        if one.path not in others:
            yield from _less(one, others)


def _within(part: Part) -> set[str]:
    found: set[str] = set()
    left = [part]
    while left:
        for one in _inside(left.pop()):
            if one.path not in found:
                found.add(one.path)
                left.append(one)
    return found


def _inside(part: Part) -> Iterator[Part]:
    """Yields the contents of a structure, or the operands of an outline before any cuts."""
    if isinstance(part, SolvedStructure):
        yield from drawn(part)
        yield from part.structures
    elif part.recipe is not None and part.recipe.kind == "union":
        yield from chain(*part.recipe.operands)
    elif part.recipe is not None and part.recipe.kind == "difference":
        yield from part.recipe.operands[0]


def _shown(outline: SolvedGeometry) -> SolvedGeometry:
    """Returns a geometry as it is drawn if nothing is made of it."""
    shown = replace(outline, construction=False)
    if shown.recipe is None or any(True for _ in shown.curves()):
        return shown
    return complete(_alone((shown,)))[0].root.geometry[0]


# --- Geometry and its names ----------------------------------------------------------------------


def origins(module: ast.Module) -> Origins:
    """Returns the template or shape that made each value, and the source of copies."""
    return {
        _place(node.span): tuple(_makers(node.value))
        for node in ast.walk(module)
        if isinstance(node, ast.Assign)
    }


def _place(span: Span) -> Place:
    return span.source.name, span.start, span.end


def _makers(value: ast.Node | None) -> Iterator[str]:
    while isinstance(value, ast.Call):
        yield value.callee.text
        if value.callee.text in ("union", "hull", "intersect"):
            return
        value = next((a.value for a in value.arguments if a.name is None), None)
    if isinstance(value, ast.Name):
        yield value.text


def names(part: Part, made: Origins) -> tuple[str, ...]:
    """Returns the name of a part, and those of its makers."""
    return (part.name, *(made.get(_place(part.span), ()) if part.span is not None else ()))


def drawn(structure: SolvedStructure) -> tuple[SolvedGeometry, ...]:
    return tuple(g for g in structure.drawn if not g.construction and g.type != "point")


@dataclass(frozen=True)
class Outline:
    """Geometry that is drawn, or an operand of such an outline, of which it still is a part or an opening.

    known    the geometry that names it: itself, or the original of a copy
    around   the paths of the outlines made of it
    copy_in  the path of the original copied as a whole, for its parts
    """

    shown: SolvedGeometry
    known: SolvedGeometry
    around: tuple[str, ...] = ()
    copy_in: str | None = None


def outlines(structure: SolvedStructure) -> Iterator[Outline]:
    """Yields the drawn geometry of a structure, each followed by its operands."""
    named = {g.path: g for g in structure.drawn}
    seen: set[str] = set()

    def written(outline: SolvedGeometry) -> SolvedGeometry:
        passed = set[str]()  # an array of what has no name is a copy of itself
        while outline.source is not None and outline.source in named and outline.path not in passed:
            passed.add(outline.path)
            outline = named[outline.source]
        return outline

    def visit(outline: SolvedGeometry, known: SolvedGeometry, around: tuple[str, ...]) -> Iterator[Outline]:
        if outline.path in named:
            if outline.path in seen:
                return
            seen.add(outline.path)
            outline = known = named[outline.path]
        copy_in = next((path for path in reversed(around) if path in named), None)
        yield Outline(_shown(outline), known, around, None if outline is known else copy_in)
        around = (*around, outline.path)
        first = written(known)
        if outline.recipe is not None and first.recipe is not None:
            for mine, its in zip(chain(*outline.recipe.operands), chain(*first.recipe.operands), strict=True):
                yield from visit(mine, its if its.path in named else written(its), around)

    for geometry in drawn(structure):
        yield from visit(geometry, geometry, ())
