"""Leaves curves and values without a place out of a solved model, so that all later numbers can be drawn,
measured and written.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import field, replace

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.geometry.evaluate import LARGEST, is_finite
from aidl_lang.geometry.notes import unusable_note
from aidl_lang.geometry.solved import Box, Frame, SolvedGeometry, SolvedModel, SolvedStructure


def with_places(model: SolvedModel) -> tuple[SolvedModel, list[Diagnostic]]:
    """Returns the model without curves and numbers that are not finite or out of range, and diagnostics on
    them.
    """
    if all(map(_is_sound, model.root.walk())):
        return model, []
    cleaner = _Cleaner()
    return replace(model, root=cleaner.structure(model.root)), cleaner.notes


def _is_sound(structure: SolvedStructure) -> bool:
    frame, box = structure.frame, structure.box
    return (
        _is_within((frame.x, frame.y, frame.rotation))
        and (box is None or _is_within(box.bounds))
        and all(map(_has_place, structure.geometry))
    )


def _has_place(geometry: SolvedGeometry) -> bool:
    """Tells whether all of a geometry, with its parts, can be drawn."""
    return (
        (is_finite(geometry.curve, LARGEST) if geometry.curve else _is_within(geometry.values.values()))
        and all(map(_has_place, geometry.parts))
        and (geometry.recipe is None or _is_possible(geometry))
    )


def _is_possible(outline: SolvedGeometry) -> bool:
    assert outline.recipe is not None
    return _is_within(outline.recipe.numbers.values()) and all(
        _has_place(g) for operand in outline.recipe.operands for g in operand
    )


def _is_within(value: object) -> bool:
    """Tells whether every number in a value can be drawn."""
    if isinstance(value, float):
        return abs(value) <= LARGEST
    return isinstance(value, str | int) or (isinstance(value, Iterable) and all(map(_is_within, value)))


@record(frozen=False)
class _Cleaner:
    notes: list[Diagnostic] = field(default_factory=list)

    def structure(self, s: SolvedStructure) -> SolvedStructure:
        geometry = tuple(self._drawable(s, g) for g in s.geometry)
        children = tuple(map(self.structure, s.structures))
        frame, box = s.frame, s.box
        if not _is_within((frame.x, frame.y, frame.rotation)):
            frame = Frame(0.0, 0.0, 0.0, frame.mirrored)
        if box is None or not s.is_empty:
            curves = (curve for g in geometry for curve in g.curves() if is_finite(curve))
            box = Box.around(curves, children)
        elif not _is_within(box.bounds):
            box = None
        return replace(s, geometry=geometry, structures=children, frame=frame, box=box)

    def _drawable(self, s: SolvedStructure, whole: SolvedGeometry) -> SolvedGeometry:
        if _has_place(whole):
            return whole
        lost = list(_lost(whole))
        is_whole = all(g in lost for g in whole.walk() if not g.parts)
        self.notes.append(unusable_note(s, lost[0], whole if is_whole else lost[0]))
        return _stripped(whole)


def _lost(geometry: SolvedGeometry) -> Iterator[SolvedGeometry]:
    """Yields the innermost parts that have no place."""
    inside = [lost for part in geometry.parts for lost in _lost(part)]
    yield from inside
    if not inside and not _has_place(geometry):
        yield geometry


def _stripped(geometry: SolvedGeometry) -> SolvedGeometry:
    """Returns a geometry with those of its parts and values that have a place; its name stays."""
    if _has_place(geometry):
        return geometry
    values = {name: value for name, value in geometry.values.items() if _is_within(value)}
    is_primitive = len(values) < len(geometry.values) and not geometry.parts
    return replace(
        geometry,
        values=values,
        curve=None if is_primitive else geometry.curve,
        parts=tuple(map(_stripped, geometry.parts)),
        recipe=geometry.recipe if geometry.recipe is not None and _is_possible(geometry) else None,
    )
