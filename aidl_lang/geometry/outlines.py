"""Works out outlines derived from others, and finished corners, as recorded while building."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import reduce

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.geometry import finishing, solved
from aidl_lang.geometry import outline_notes as notes
from aidl_lang.geometry.boolean import clipped_each, common, united, without
from aidl_lang.geometry.curves import LARGEST, Line, Piece, Vec, extent
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.faces import region_of
from aidl_lang.geometry.finishing import Arm, Corner, Result, Work, arms_at, corners_of
from aidl_lang.geometry.offsets import NEAR, hull, offset, thick
from aidl_lang.geometry.outline_notes import Misfit
from aidl_lang.geometry.region import Region, length
from aidl_lang.geometry.solved import Finish, SolvedGeometry, SolvedModel, SolvedStructure, as_geometry
from aidl_lang.geometry.styles import is_filled
from aidl_lang.geometry.tiling import Lattice, TooManyCopiesError, tiled_areas, tiled_bars, tiled_strokes

_SAME_AREA = 1e-6
"""Relative difference of areas up to which a shape of the library is what exact geometry gives."""
_HALVINGS = 24


def complete(model: SolvedModel) -> tuple[SolvedModel, list[Diagnostic]]:
    """Returns the model with its derived outlines and finished corners, and diagnostics on them."""
    index = {g.path: g for g in model.root.walk_geometry()}
    outliner = _Outliner(tuple(f for s in model.root.walk() for f in s.finishes), index)
    root = outliner.structure(model.root)
    return replace(model, root=root), list(
        dict.fromkeys([*outliner.notes, *notes.merged_notes(outliner.misfits)])
    )


def _leaves(g: SolvedGeometry) -> Iterator[tuple[SolvedGeometry, Piece]]:
    """Yields the primitives of a geometry that is drawn, with their curves, if they have a place."""
    for leaf in g.leaves():
        if (curve := leaf.curve) and curve.is_finite(LARGEST):
            yield leaf, curve


def _shown(g: SolvedGeometry) -> SolvedGeometry:
    return replace(g, construction=False) if g.construction else g


def _with_parts(g: SolvedGeometry, parts: tuple[SolvedGeometry, ...]) -> SolvedGeometry:
    """Returns a geometry with these parts; itself if it has them."""
    return g if all(map(operator.is_, parts, g.parts)) else replace(g, parts=parts)


@record(frozen=False)
class _Outliner:
    """
    finishes     of all structures; index: all geometry by path, as it was read out
    made         by path, what was worked out already: outlines as they are drawn, before finishing
    derived      the paths of those that had no curves before
    carried_out  the finishes of the structure at hand, with their corners
    sizes        those of finishes that were carried out
    """

    finishes: tuple[Finish, ...]
    index: Mapping[str, SolvedGeometry]
    notes: list[Diagnostic] = field(default_factory=list)
    made: dict[str, SolvedGeometry] = field(default_factory=dict)
    derived: set[str] = field(default_factory=set)
    carried_out: dict[Finish, list[Vec]] = field(default_factory=dict)
    sizes: dict[Finish, tuple[float, ...]] = field(default_factory=dict)
    misfits: list[Misfit] = field(default_factory=list)

    def structure(self, s: SolvedStructure, around: Region | None = None) -> SolvedStructure:
        """Returns a structure with its outlines worked out; `around`: what those around it are clipped to."""
        geometry = tuple(map(self._completed, s.geometry))
        inside = self._inside(s, around) if s.clip else around
        children = tuple(self.structure(child, inside) for child in s.structures)
        self.carried_out = {}
        finished = self._finished(tuple(map(self._drawn, geometry)), s.finishes, s)
        for g in geometry:
            if g.construction:
                self._finished([_shown(self._drawn(g))], s.finishes, s)
        if s.kind == "drawing" and inside is not None:
            finished = clipped_ink(finished, inside)
        # Its own in their order, with the corners where they were carried out; then those it has as a copy.
        left, more = dict(self.carried_out), (f for f in self.carried_out if f not in s.finishes)
        finishes = tuple(
            replace(f, corners=tuple(left.pop(f, ())), sizes=self.sizes.get(f, f.sizes))
            for f in (*s.finishes, *more)
        )
        derived = (curve for g in geometry for curve in g.curves())
        return replace(
            s,
            geometry=geometry,
            structures=children,
            box=solved.Box.around(derived, children, [s.box.bounds] if s.box is not None else []),
            finishes=finishes,
            finished=tuple(finished),
            inside=inside if s.clip else None,
        )

    def _inside(self, s: SolvedStructure, around: Region | None) -> Region | None:
        """Returns what the outline around a structure encloses in those around it; theirs if it is open."""
        own = _region(self._operand(s.clip))
        if not own:
            self.notes.append(notes.open_clip(s))
            return around
        return own if around is None else common(own, around)

    # --- Outlines made of others -------------------------------------------------------------------

    def _completed(self, g: SolvedGeometry) -> SolvedGeometry:
        """Returns a geometry with the curves of derived outlines as parts, its own or those of its parts."""
        if g.recipe is None or g.curve is not None or any(True for _ in _leaves(_shown(g))):
            return _with_parts(g, tuple(map(self._completed, g.parts)))
        exact = self._exact(g, g.recipe)
        self.derived.add(g.path)
        return replace(exact, parts=(*map(self._completed, g.parts), *exact.parts))

    def _drawn(self, g: SolvedGeometry) -> SolvedGeometry:
        """Returns a geometry as it is drawn: a shape that the library made by an operation, by exact geometry
        if that differs (the source has fillets, or less is left than the formula says).
        """
        if g.recipe is None or g.path in self.derived or not any(True for _ in _leaves(_shown(g))):
            return _with_parts(g, tuple(map(self._drawn, g.parts)))
        exact = self._exact(g, g.recipe)
        regions = [_region([_shown(one)]) for one in (g, exact)]
        areas = [r.area for r in regions]
        return g if abs(areas[0] - areas[1]) <= _SAME_AREA * abs(areas[1]) else exact

    def _exact(self, g: SolvedGeometry, recipe: solved.Recipe) -> SolvedGeometry:
        if g.path not in self.made:
            self.made[g.path] = replace(g, parts=solved.edges_of(g, self._curves(g, recipe)), curve=None)
        return replace(self.made[g.path], construction=g.construction)

    def _curves(self, g: SolvedGeometry, recipe: solved.Recipe) -> list[Piece]:
        groups = [self._operand(group) for group in recipe.operands]
        curves = [[c for one in group for _, c in _leaves(one)] for group in groups]
        match recipe.kind:
            case "hull":
                points = [
                    p for group in groups for one in group if isinstance(p := one.values.get("at"), tuple)
                ]
                dots = [Line(p, p) for p in points]  # type: ignore[arg-type]
                region = hull([*curves[0], *(d for d in dots if max(map(abs, d.box)) <= LARGEST)])
            case "thick":
                width, words = recipe.numbers["width"], recipe.words
                sharp = words["joins"] == "sharp"
                region = thick(curves[0], width, words["caps"], sharp) if width > 0 else Region()
            case "tiled":
                return self._tiled(g, recipe, groups, curves[0])
            case _:
                return self._from_regions(g, recipe, groups, curves[0])
        return self._left(g, recipe, region.pieces)

    def _left(
        self, g: SolvedGeometry, recipe: solved.Recipe, pieces: Sequence[Piece], depth: float | None = None
    ) -> list[Piece]:
        """Returns what is left of an outline, and tells if that is nothing."""
        if not pieces:
            self.notes.append(notes.nothing_left(g, recipe, depth))
        return list(pieces)

    def _operand(self, group: Iterable[SolvedGeometry]) -> list[SolvedGeometry]:
        shown = [_shown(self._drawn(self._completed(g))) for g in group]
        return self._finished(shown, self.finishes)

    def _from_regions(
        self, g: SolvedGeometry, recipe: solved.Recipe, groups: list[list[SolvedGeometry]], first: list[Piece]
    ) -> list[Piece]:
        regions = [_region(group) for group in groups]
        if recipe.kind == "clip" and not regions[0] and regions[1]:
            clipped = clipped_each(first, regions[1])
            return self._left(g, recipe, [piece for one in clipped for piece in one.inner])
        if empty := [r for r, region in zip(recipe.operands, regions, strict=True) if not region]:
            self.notes.append(notes.not_closed(g, recipe, empty[0]))
            return []
        sharp, region, depth = recipe.words.get("corners") != "round", regions[0], None
        match recipe.kind:
            case "offset":
                distance = recipe.numbers["distance"]
                result = offset(region, distance, sharp)
                if not result:
                    depth = _deepest(region, -distance)
                elif len(result.faces) > len(region.faces):
                    self.notes.append(notes.splits(g, recipe, len(result.faces)))
            case "shell":
                wall = max(recipe.numbers["thickness"], 0.0)
                inner = offset(region, -wall, sharp)
                result = without(region, inner) if inner else region
                if not inner:
                    self.notes.append(notes.all_wall(g, recipe, _deepest(region, wall)))
            case "union":
                result = united(*regions)
            case "difference":
                result = without(*regions)
            case _:
                result = reduce(common, regions)
        return self._left(g, recipe, result.pieces, depth)

    def _tiled(
        self, g: SolvedGeometry, recipe: solved.Recipe, groups: list[list[SolvedGeometry]], first: list[Piece]
    ) -> list[Piece]:
        region = _region(groups[1])
        if not region:
            self.notes.append(notes.not_closed(g, recipe, recipe.operands[1]))
            return []
        points = [p for one in groups[2] if isinstance(p := one.values.get("at"), tuple)]
        lattice = Lattice.through(points, region, recipe.words["start"])  # type: ignore[arg-type]
        if not lattice.is_possible:
            self.notes.append(notes.no_lattice(g, recipe))
            return []
        cell, area = [lattice.turned(c) for c in first], _region(groups[0]).mapped(lattice.turned)
        whole, width = "whole" in recipe.words, recipe.numbers.get("width", 0.0)
        try:
            if area:
                found: Sequence[Piece] = tiled_areas(area, region, lattice, whole=whole).pieces
            elif width > 0:
                found = tiled_bars(cell, region, lattice, width).pieces
            else:
                found = tiled_strokes(cell, region, lattice, whole=whole)
        except TooManyCopiesError as many:
            self.notes.append(notes.too_many(g, recipe, many.args[0]))
            return []
        return self._left(g, recipe, found)

    # --- Finished corners --------------------------------------------------------------------------

    def _finished(
        self,
        geometry: Sequence[SolvedGeometry],
        finishes: Sequence[Finish],
        told: SolvedStructure | None = None,
    ) -> list[SolvedGeometry]:
        """Returns the geometry with all finishes that are about its corners. `told`: the structure whose
        program hears of those that do not fit; elsewhere they are passed over.
        """
        if not self.finishes:
            return list(geometry)
        leaves = [leaf for g in geometry for leaf in _leaves(g)]
        near = NEAR * extent([c for _, c in leaves])
        works: list[Work] = []
        reasons: list[Finish] = []
        for f, corner in (*self._own(leaves, finishes, near, told), *self._inherited(leaves, near)):
            earlier = next(
                (k for k, w in enumerate(works) if math.dist(w.corner.at, corner.at) <= near), None
            )
            if earlier is None:
                works.append(Work(f.kind, corner, (f.sizes[0], f.sizes[-1]) if f.sizes else (0.0, 0.0)))
                reasons.append(f)
            elif told is not None and f in finishes and f.span != reasons[earlier].span:
                self.notes.append(notes.twice(f, reasons[earlier], corner, told))
        works, reasons = self._fitted(leaves, works, reasons, told)
        result = finishing.finish([c for _, c in leaves], works)
        if told is not None:
            if result.failures:
                self.misfits += notes.misfits(result, works, reasons, leaves, told)
            for made in result.finished:
                reason = reasons[works.index(made.work)]
                self.carried_out.setdefault(reason, []).append(made.work.corner.at)
                self.sizes[reason] = reason.sizes or made.work.sizes[:1]
        return _rebuilt(geometry, leaves, result) if result.finished else list(geometry)

    def _fitted(
        self, leaves: solved.Leaves, works: list[Work], reasons: list[Finish], told: SolvedStructure | None
    ) -> tuple[list[Work], list[Finish]]:
        """Returns the works with the sizes of those as large as fits, without those that do not fit."""
        if all(f.sizes for f in reasons):
            return works, reasons
        curves = [c for _, c in leaves]
        works = finishing.fitted(curves, works, [0 if f.sizes else f.run for f in reasons], extent(curves))
        fit = [(w, f) for w, f in zip(works, reasons, strict=True) if w.sizes[0] > 0]
        without = [(w, f) for w, f in zip(works, reasons, strict=True) if not w.sizes[0] > 0]
        if told is not None and without:
            self.notes.append(notes.no_room(without[0][1], without[0][0].corner, told))
        return [w for w, _ in fit], [f for _, f in fit]

    def _own(
        self, leaves: solved.Leaves, finishes: Sequence[Finish], near: float, told: SolvedStructure | None
    ) -> Iterator[tuple[Finish, Corner]]:
        for f in finishes:
            if f.of and not any(_is_of(g.path, f.of) for g, _ in leaves):
                continue
            corners = _corners(f, leaves, near)
            if not corners and told is not None:
                self.notes.append(notes.no_corner(f, leaves, near))
            if not f.sizes or max(f.sizes) > 0:
                yield from ((f, corner) for corner in corners)

    def _inherited(self, leaves: solved.Leaves, near: float) -> Iterator[tuple[Finish, Corner]]:
        """Yields a copy's finishes from its source: of the same corners, with sizes in proportion."""
        sources, curves = [(self._source(g), c) for g, c in leaves], [c for _, c in leaves]
        for _ in self.index:  # copies of copies: no chain is longer than that
            if not any(g is not None for g, _ in sources):
                break
            numbers = [k for k, (g, _) in enumerate(sources) if g is not None and g.curve is not None]
            theirs = [(g, g.curve) for g, _ in sources if g is not None and g.curve is not None]
            sizes = ((length(curves[k]), length(c)) for k, (_, c) in zip(numbers, theirs, strict=True))
            share = next((own / other for own, other in sizes if other > 0), 1.0)
            for f in self.finishes:
                if not f.of or any(_is_of(g.path, f.of) for g, _ in theirs):
                    for corner in _corners(f, theirs, near / share):
                        arms = ((numbers[a.number], a.first) for a in corner.arms)
                        one, other = (
                            Arm(curves[k] if first else curves[k].reversed(), k, first) for k, first in arms
                        )
                        made = replace(f, sizes=tuple(share * s for s in f.sizes))
                        yield made, Corner(one.curve.ends[0], (one, other))
            sources = [(self._source(g) if g else None, c) for g, c in sources]

    def _source(self, g: SolvedGeometry) -> SolvedGeometry | None:
        """Returns what a copy was made from; None for what is no copy, or has the name of its copy."""
        return self.index.get(g.source) if g.source is not None and g.source != g.path else None


def _is_of(path: str, of: Iterable[str]) -> bool:
    """Tells whether a path is one of some, or leads on from it."""
    return any(path == p or path.startswith((f"{p}.", f"{p}[")) for p in of)


def _corners(f: Finish, leaves: solved.Leaves, near: float) -> list[Corner]:
    own = [number for number, (g, _) in enumerate(leaves) if _is_of(g.path, f.of)]
    if f.at is None:
        found = corners_of([leaves[n][1] for n in own], near)
        return [_renumbered(c, own) for c in found]
    for numbers in (own, list(range(len(leaves)))):
        arms = arms_at([leaves[n][1] for n in numbers], f.at, near)
        if len(arms) == 2:
            corner = _renumbered(Corner(f.at, (arms[0], arms[1])), numbers)
            return [] if corner.is_smooth else [corner]
    return []


def _renumbered(corner: Corner, numbers: Sequence[int]) -> Corner:
    a, b = (replace(arm, number=numbers[arm.number]) for arm in corner.arms)
    return Corner(corner.at, (a, b))


def _rebuilt(
    geometry: Sequence[SolvedGeometry], leaves: solved.Leaves, result: Result
) -> list[SolvedGeometry]:
    """Returns the geometry with its new curves, which belong to what both their neighbours belong to."""
    changed = {g.path: c for (g, old), c in zip(leaves, result.curves, strict=True) if c is not old}
    added: dict[str, list[SolvedGeometry]] = {}
    free: list[SolvedGeometry] = []
    tops = [next(t for t in geometry if _is_of(g.path, [t.path])) for g, _ in leaves]
    for made in result.finished:
        a, b = (tops[arm.number] for arm in made.work.corner.arms)
        if a is b:
            own = added.setdefault(a.path, [])
            own.append(as_geometry(f"{made.work.kind}[{len(own)}]", a, made.piece))
        else:
            free.append(
                as_geometry(f"{made.work.kind}[{len(free)}]", a, made.piece, a.path.rpartition(".")[0])
            )

    def renewed(g: SolvedGeometry) -> SolvedGeometry:
        curve = changed.get(g.path, g.curve)
        return replace(g, curve=curve, parts=(*map(renewed, g.parts), *added.get(g.path, ())))

    return [*map(renewed, geometry), *free]


# --- Small things ----------------------------------------------------------------------------------


def clipped_ink(geometry: Sequence[SolvedGeometry], region: Region) -> list[SolvedGeometry]:
    """Returns the geometry of a drawing as far as it lies in a region or along its border: parts of curves,
    and the outlines of what is left of filled letters and areas.
    """
    leaves = [leaf for g in geometry for leaf in _leaves(g)]
    found = clipped_each([c for _, c in leaves], region, with_border=True)
    kept = {id(g): (c, one) for (g, c), one in zip(leaves, found, strict=True)}

    def inner(g: SolvedGeometry) -> SolvedGeometry:
        if (g.filled or is_filled(g, "drawing")) and not all(
            kept[id(leaf)][1].is_whole for leaf, _ in _leaves(g)
        ):
            return replace(g, curve=None, parts=solved.edges_of(g, common(_region([g]), region).pieces))
        curve, one = kept.get(id(g), (None, None))
        if one is None or one.inner == (curve,):
            return replace(g, parts=tuple(map(inner, g.parts)))
        return replace(g, curve=None, parts=solved.edges_of(g, one.inner))

    return [g if g.construction else inner(g) for g in geometry]


def _region(geometry: Sequence[SolvedGeometry]) -> Region:
    found = ((g, list(_leaves(g))) for g in geometry)
    return region_of((g, leaves) for g, leaves in found if leaves)[0]


def _deepest(region: Region, too_deep: float) -> float:
    """Returns how far an outline can move inwards before nothing is left, to about seven digits."""
    return finishing.largest(lambda depth: bool(offset(region, -depth)), too_deep, _HALVINGS)


# --- Drawings that are clipped to the material of a solid, once that is known.


def on_material(model: SolvedModel, drawing: Drawing) -> SolvedModel:
    """Returns a model with its drawings cut to the solids they are clipped to, by the `drawing` without."""
    return replace(model, root=_inked(model.root, drawing, None))


def _inked(s: SolvedStructure, drawing: Drawing, around: Region | None) -> SolvedStructure:
    """Returns a structure with its drawings clipped; `around`: the material that those around it lie on."""
    ground = around
    if s.ground is not None:
        ground = _material(drawing, s.ground)
        ground = ground if around is None else common(ground, around)
    children = tuple(_inked(child, drawing, ground) for child in s.structures)
    if ground is None:
        return replace(s, structures=children)
    inside = s.inside if s.ground is None else ground
    return replace(s, structures=children, finished=tuple(clipped_ink(s.drawn, ground)), inside=inside)


def _material(drawing: Drawing, path: str) -> Region:
    """Returns what is left of a solid in the end: the bodies around it have holes, too."""
    region = drawing.regions.get(path, Region())
    for body in drawing.bodies:
        if f"{path}.".startswith(f"{body.path}.") and body.path != path:
            region = common(region, body.region)
    return region
