"""Structures, in place and from templates, with their frames and, if they are empty, their boxes."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from aidl_lang.building import expression as ex
from aidl_lang.building.attributes import read_attributes
from aidl_lang.building.blocks import run_block
from aidl_lang.building.calls import default_of
from aidl_lang.building.clipping import settle_clips_in
from aidl_lang.building.coerce import as_point, numeric
from aidl_lang.building.constraints import read_constraint
from aidl_lang.building.construct import solvable
from aidl_lang.building.edits import EditCall, edits_on, frame_edited
from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.model import Frame, Geometry, Structure
from aidl_lang.building.plain_cuts import tell_plain_cuts
from aidl_lang.building.scopes import Scope, indexed
from aidl_lang.building.stacking import settle_order
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.building.templates import passed
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    Instantiation,
    Nothing,
    Num,
    PointVal,
    number,
    point,
    type_of,
)
from aidl_lang.checking import rules
from aidl_lang.checking.builtins import FINISHES, ROTATION
from aidl_lang.checking.rules import shown
from aidl_lang.checking.types import NumberType, PointType
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.syntax import ast

_PLAN = 10.0
"""Width and height at which the box of an empty structure starts, in mm."""


def build_structure(
    it: Interpreter, node: ast.Structure, scope: Scope, parent: Structure | None, indices: tuple[int, ...]
) -> Structure:
    """Builds a structure from its definition in place."""
    name = indexed(node.name.text, indices)
    structure = _new(it, node.kind, name, parent, node)
    structure.doc = node.doc
    edits = edits_on(it, node.name.text, indices, scope) if parent is not None else ()
    _place(it, structure, node.placement, scope, edits)
    body = Scope(_around(scope, node.name.text, structure), structure, labels=scope.labels)
    structure.scope = body
    own_names(body, structure)
    run_block(it, node.body.statements, body, structure)
    if node.kind == "hole":
        tell_plain_cuts(it, node, body, "" if parent is None else parent.kind)
    # what is said of the root may name its params, as nothing is around it
    read_attributes(it, structure, node.attributes, body if parent is None else scope)
    finish(it, structure)
    return structure


def instantiate(
    it: Interpreter,
    node: ast.Assign,
    template: Instantiation,
    scope: Scope,
    here: Structure,
    indices: tuple[int, ...],
    framed: Callable[[Frame], Frame] | None = None,
) -> Structure | Nothing:
    """Builds an instance of a template under its assigned name; `framed` moves its frame elsewhere."""
    definition = template.definition
    name = indexed(node.name.text, indices)
    if not it.enter(template.node, definition):
        return NOTHING
    try:
        structure = _new(it, definition.kind, name, here, node)
        structure.doc = definition.doc
        _place(it, structure, node.placement, scope, edits_on(it, node.name.text, indices, scope))
        assert isinstance(template.scope, Scope)
        around = _around(template.scope, definition.name.text, structure)
        body = Scope(around, structure, labels=scope.labels)
        structure.scope = body
        own_names(body, structure)
        for parameter, (key, kind, _) in zip(
            definition.parameters or (), template.signature.parameters, strict=True
        ):
            value = template.arguments.get(key)
            if value is None:
                value = default_of(it, parameter, kind, Env(body, structure, Reach.OWN))
            given = (a.value for a in template.node.arguments if a.name is not None and a.name.text == key)
            body.values[key] = passed(it, key, value, structure, here, next(given, parameter))
        read_attributes(it, structure, definition.attributes, body)
        read_attributes(it, structure, node.attributes, scope)  # in the scope outside the template
        if definition.placement is not None:
            _place(it, structure, definition.placement, body)
        if framed is not None:
            structure.frame = framed(structure.frame)
        run_block(it, definition.body.statements, body, structure)
        if definition.kind == "hole":
            tell_plain_cuts(it, definition, body, here.kind)
        finish(it, structure)
    finally:
        it.leave()
    return structure


def _new(it: Interpreter, kind: str, name: str, parent: Structure | None, node: ast.Node) -> Structure:
    it.count_entity(node)
    structure = Structure(kind, name, parent, it.place(node))
    if parent is None:
        it.root = structure
    else:
        parent.children.append(structure)
    return structure


def _around(scope: Scope, name: str, structure: Structure) -> Scope:
    around = Scope(scope)
    around.values[name] = structure
    return around


def own_names(scope: Scope, structure: Structure) -> None:
    """Adds `self`, `origin` and the axes, which every structure has."""
    exact = [point(ex.constant(x), ex.constant(y), Exactness.FIXED) for x, y in ((0, 0), (1, 0), (0, 1))]
    scope.values["self"] = structure
    scope.values["origin"] = exact[0]
    for name, end in zip(("x_axis", "y_axis"), exact[1:], strict=True):
        axis = Geometry("line", structure, structure.span, {"start": exact[0], "end": end})
        axis.name, axis.container, axis.construction = name, structure, True
        scope.values[name] = axis


def _place(
    it: Interpreter,
    s: Structure,
    placement: ast.Placement | None,
    scope: Scope,
    edits: Sequence[EditCall] = (),
) -> None:
    """Sets the frame: `at` is a position, `rotated` is exact unless it is a guess or an unknown."""
    if s.parent is None:
        if placement is not None:
            message = "the root's frame is fixed, so `at` and `rotated` change nothing here"
            it.report("W0502", message, placement)
        return
    at, turn = place_of(it, placement, Env(scope, s.parent, Reach.OWN))
    if edits:
        at, turn = frame_edited(it, edits, s, at, turn)
    x, y = (
        solvable(it, n, s.span)
        if n.status >= Exactness.FIXED
        else it.became(n, it.unknown(n.value, s, axis, owner=s.parent, dimension=LENGTH, frame_of=s), s, axis)
        for n, axis in ((at.x, "x"), (at.y, "y"))
    )
    rotation = solvable(it, turn, s.span) if turn is not None else ex.ZERO
    if turn is not None and turn.status is Exactness.GUESS:
        rotation = it.unknown(turn.value, s, ROTATION, owner=s.parent, dimension=ANGLE, frame_of=s)
        it.became(turn, rotation, s, ROTATION, ANGLE)
    elif it.frames_turn and (turn is None or turn.status is Exactness.NUMBER) and rotation.is_constant:
        rotation = it.unknown(rotation.value, s, ROTATION, owner=s.parent, dimension=ANGLE, frame_of=s)
        assert isinstance(rotation.payload, ex.Unknown)
        rotation.payload.locked = rotation.payload.exact = True
    s.frame = Frame(x, y, rotation)


def place_of(it: Interpreter, placement: ast.Placement | None, env: Env) -> tuple[PointVal, Num | None]:
    """Returns the values of `at` and `rotated`; the origin, and None, without them."""
    at = None
    if placement is not None and placement.at is not None:
        value = evaluate(it, placement.at, env)
        at = as_point(it, value, placement.at, env)
        if at is None and not isinstance(value, Nothing):
            wrong = rules.unwanted("`at`", PointType(), type_of(value), shown(placement.at))
            it.misfit(wrong, placement.at)
    return at or PointVal(number(0.0, LENGTH), number(0.0, LENGTH)), _rotation(it, placement, env)


def _rotation(it: Interpreter, placement: ast.Placement | None, env: Env) -> Num | None:
    if placement is None or placement.rotated is None:
        return None
    value = evaluate(it, placement.rotated, env)
    found = numeric(it, value, placement.rotated, env)
    if found is None:
        return None
    if found.dimension not in (None, ANGLE):
        wrong = rules.unwanted("`rotated`", NumberType(ANGLE), type_of(found), shown(placement.rotated))
        it.misfit(wrong, placement.rotated)
        return None
    return found


def finish(it: Interpreter, structure: Structure) -> None:
    """Ends a structure whose body has been run: an empty one gets its box, then constraints are read."""
    if structure.is_empty and structure.parent is not None:
        _plan(it, structure)
    structure.is_complete = True
    settle_order(it, structure)
    settle_clips_in(it, structure)
    pending = it.pending.pop(structure, [])
    # Finished corners first, as constraints may mention their sizes, wherever they are written.
    for node, scope in sorted(pending, key=lambda item: not _finishes(it, item[0])):
        read_constraint(it, node, scope, structure)


def _finishes(it: Interpreter, node: ast.Statement) -> bool:
    if not isinstance(node, ast.ExpressionStatement) or not isinstance(call := node.value, ast.Call):
        return False
    return it.spelled(call.callee) in FINISHES


def _plan(it: Interpreter, s: Structure) -> None:
    half = _PLAN / 2
    left, bottom, width, height = (
        it.unknown(guess, s, name, owner=s, dimension=LENGTH)
        for name, guess in (("left", -half), ("bottom", -half), ("width", _PLAN), ("height", _PLAN))
    )
    for side in (left, bottom, width, height):
        assert isinstance(side.payload, ex.Unknown)
        side.payload.outline = True
    s.plan = (left, bottom, width, height)
