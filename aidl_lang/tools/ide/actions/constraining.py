"""Adds a missing constraint: a statement that holds something movable where it is.

An alignment that exists already comes first, else the present number.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from functools import partial

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.numbers import fixed
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.evaluate import bounds
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.solved import Box, Motion, SolvedGeometry, SolvedModel, SolvedStructure
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.actions.action import Action, first_error
from aidl_lang.tools.ide.edits import indent_at, insert
from aidl_lang.tools.ide.nodes import structures_around
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.ide.view import View, edited

_ALIGNED = 1e-6
"""Distance within which places coincide, relative to the size of the drawing."""
_DECIMALS = 3
"""Decimals of a written number: no finer than a micrometre."""
_MOST = 4
"""Motions of a structure for which actions are offered."""
_WRITABLE = re.compile(r"[^\W\d]\w*(\[-?\d+\])*(\.[^\W\d]\w*(\[-?\d+\])*)*")


@record()
class _Thing:
    """Something with a place: its path in the structure, and its box, for a point the point itself."""

    name: str
    box: Box
    is_point: bool


def missing_constraints(view: View, offset: int) -> Iterator[Action]:
    """Yields actions for the innermost structure around the cursor, if something in it can still move."""
    if view.outcome is None or view.outcome.model is None or view.outcome.status != "solved":
        return
    model = view.outcome.model
    node = next((n for n in structures_around(view, offset) if n.parameters is None), None)
    found = [s for s in model.root.walk() if node is not None and s.span == node.span]
    if node is None or len(found) != 1:
        return
    structure, inside = found[0], f"{found[0].path}."
    own = [m for m in model.motions if all(thing.startswith(inside) for thing in m.things)]
    for motion in own[:_MOST]:
        for statement in _statements(model, structure, motion):
            title = f"Add the missing constraint: `{statement}`"
            yield Action(title, "quickfix", partial(_added, view, node, statement))


def _added(view: View, node: ast.Structure, statement: str) -> list[Edit]:
    """Adds the statement to the structure's last `constrain { }`, or to a new one at its end."""
    edits = [_place(view, node, statement)]
    changed = edited(view, edits)
    before, after = (each.model if (each := v.outcome) is not None else None for v in (view, changed))
    if after is None or changed.outcome is None or not changed.outcome.ok:
        raise CannotError(f"with `{statement}` the program does not solve: {first_error(changed)}")
    if before is None or before.degrees is None or (after.degrees or 0) >= before.degrees:
        raise CannotError(f"`{statement}` would hold nothing that is free")
    return edits


def _place(view: View, node: ast.Structure, statement: str) -> Edit:
    text = view.source.text
    blocks = [s.items for s in node.body.statements if isinstance(s, ast.Constrain) and s.braces]
    if blocks and blocks[-1].statements:
        last = blocks[-1].statements[-1].span
        if "\n" in blocks[-1].span.text:
            return insert(view.source, last.end, f"\n{indent_at(text, last.start)}{statement}")
        return insert(view.source, last.end, f", {statement}")
    end = node.body.span.end - 1
    if "\n" not in node.body.span.text:
        return insert(view.source, end, f" constrain {statement} ")
    outer = indent_at(text, end)
    if text[end - len(outer) - 1 : end] != f"\n{outer}":  # the brace stands behind the last statement
        return insert(view.source, end, f" constrain {statement}\n{outer}")
    return insert(view.source, end - len(outer), f"{outer}    constrain {statement}\n")


def _statements(model: SolvedModel, structure: SolvedStructure, motion: Motion) -> Iterator[str]:
    """Yields statements that would hold one moving thing, the more telling first."""
    things = {thing.name: thing for thing in _things(structure)}
    name = motion.things[0].removeprefix(f"{structure.path}.")
    if not _WRITABLE.fullmatch(name):
        return
    moved = things.get(name)
    match motion.kind:
        case "slide" | "together" if moved is not None:
            axes = {"slide along x": "x", "slide along y": "y"}.get(motion.words, "xy")
            for axis in axes:
                yield from _held(model, structure, things, moved, axis, motion)
        case "grow" if moved is not None:
            side = "width" if motion.words == "grow wider" else "height"
            length = moved.box.width if side == "width" else moved.box.height
            yield f"{name}.{side} == {fixed(length, _DECIMALS)}"
        case "change":
            value = _number(structure, name)
            if value is not None:
                yield f"{name} == {fixed(value, _DECIMALS)}"
        case "turn" if (angle := _number(structure, f"{name}.angle")) is not None:
            yield f"{name}.angle == {fixed(angle, _DECIMALS)}deg"
        case _:
            pass


def _held(
    model: SolvedModel,
    structure: SolvedStructure,
    things: dict[str, _Thing],
    moved: _Thing,
    axis: str,
    motion: Motion,
) -> Iterator[str]:
    """Yields alignments that hold now, then the present coordinate."""
    moving = [thing.removeprefix(f"{structure.path}.") for thing in motion.things]
    at = _middle(moved.box, axis)
    place = f"{moved.name}.{axis}" if moved.is_point else f"{moved.name}.center.{axis}"
    for name, other in things.items():
        is_apart = not any(name == m or name.startswith(f"{m}.") or m.startswith(f"{name}.") for m in moving)
        if is_apart and abs(_middle(other.box, axis) - at) <= _ALIGNED * _size(model):
            yield f"{place} == {name}.{axis}" if other.is_point else f"{place} == {name}.center.{axis}"
            break
    if (origin := _origin(model.root, structure.path)) is not None:
        yield f"{place} == {fixed(at - origin['xy'.index(axis)], _DECIMALS)}"


def _things(structure: SolvedStructure) -> Iterator[_Thing]:
    """Yields the contents of a structure under the names its constraints use, large things first."""
    inside = f"{structure.path}."
    for below in structure.walk():
        if below is not structure and below.box is not None:
            yield _Thing(below.path.removeprefix(inside), below.box, is_point=False)
    for geometry in structure.walk_geometry():
        yield from _placed(geometry, inside)


def _placed(geometry: SolvedGeometry, inside: str) -> Iterator[_Thing]:
    name = geometry.path.removeprefix(inside)
    if not _WRITABLE.fullmatch(name):
        return
    curves = [bounds(piece) for piece in geometry.curves()]
    if curves:
        yield _Thing(name, Box(*union_bounds(curves)), is_point=False)
    for field, value in geometry.values.items():
        if isinstance(value, tuple) and len(value) == 2 and all(isinstance(v, float) for v in value):
            x, y = value
            assert isinstance(x, float)
            assert isinstance(y, float)
            point = name if field == "at" else f"{name}.{field}"
            yield _Thing(point, Box(x, y, x, y), is_point=True)


def _origin(root: SolvedStructure, path: str) -> Vec | None:
    """Returns the origin of a structure's frame in that of the root; None if it is turned or mirrored."""
    x = y = 0.0
    for around in root.walk():
        if around is not root and f"{path}.".startswith(f"{around.path}."):
            if around.frame.mirrored or abs(around.frame.rotation) > _ALIGNED:
                return None
            x, y = x + around.frame.x, y + around.frame.y
    return x, y


def _number(structure: SolvedStructure, name: str) -> float | None:
    """Returns a number of a structure, or of some geometry in it."""
    thing, _, field = name.rpartition(".")
    path = f"{structure.path}.{thing}" if thing else structure.path
    values: list[object] = [s.params.get(field) for s in structure.walk() if s.path == path]
    values += [g.values.get(field) for g in structure.walk_geometry() if g.path == path]
    return next((float(v) for v in values if isinstance(v, float | int) and not isinstance(v, bool)), None)


def _middle(box: Box, axis: str) -> float:
    return (box.left + box.right) / 2 if axis == "x" else (box.bottom + box.top) / 2


def _size(model: SolvedModel) -> float:
    box = model.root.box
    return math.hypot(box.width, box.height) if box is not None else 1.0
