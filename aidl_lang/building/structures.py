"""Structures, the root among them: in place and from templates, with frames and boxes."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import PurePath
from typing import Any

from aidl_lang.building import expression as ex
from aidl_lang.building.attributes import read_attributes, settle_clips_in, settle_order
from aidl_lang.building.calls import default_of
from aidl_lang.building.coerce import as_point, numeric
from aidl_lang.building.construct import hidden_constraints, loose_place, solvable
from aidl_lang.building.edits import Edits, edits_on, frame_edited
from aidl_lang.building.evaluate import evaluate, hoist_callables, hoist_values, run_block
from aidl_lang.building.impose import read_constraint
from aidl_lang.building.members import passed, read_param, report_unused
from aidl_lang.building.model import Frame, Structure
from aidl_lang.building.state import (
    Candidate,
    Env,
    Interpreter,
    LetBinding,
    NameBinding,
    ParamBinding,
    Reach,
    Scope,
    indexed,
    own_names,
)
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    Instantiation,
    Namespace,
    Nothing,
    Num,
    PointVal,
    certain,
    number,
    type_of,
)
from aidl_lang.checking import rules
from aidl_lang.checking.builtins import CUTS, FINISHES, MATH, ROTATION, SIGNATURES
from aidl_lang.checking.library import Library
from aidl_lang.checking.rules import shown
from aidl_lang.checking.types import NumberType, PointType
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.source import Span
from aidl_lang.common.world import WHOLE
from aidl_lang.syntax import ast

# --- Ready-made cuts that are written in a hole: there they are circles, without depth or thread.

_LOST = {
    "depth": "nothing is sunk, and all of it is cut through",
    "thread": "no drawing sheet tells of its thread",
}
"""By attribute of a cut, what is missing where its circle stands alone."""
_PLACED_IN = ("solid", "assembly")  # kinds of structures in which the name of a cut means a whole hole


def tell_plain_cuts(it: Interpreter, hole: ast.Structure, scope: Scope, around: Structure | None) -> None:
    """Tells of cuts in a hole that are deep or have a thread where they are placed in a solid."""
    is_standard = hole.span.source in it.library_sources
    if hole.kind != "hole" or is_standard or any(a.name.text in _LOST for a in hole.attributes):
        return
    is_placed = around is not None and around.kind in _PLACED_IN
    nodes = list(ast.walk(hole.body))
    inner = [node.span for node in nodes if isinstance(node, ast.Structure)]
    for statement in nodes:
        if not isinstance(statement, ast.Assign) or any(map(statement.span.overlaps, inner)):
            continue
        for call in ast.walk(statement.value):
            if not isinstance(call, ast.Call) or it.spelled(call.callee) not in CUTS:
                continue
            found = scope.candidates(it.spelled(call.callee))
            templates = [c.signature.node for c in found if c.signature.standard]
            placed = next((node for node in templates if isinstance(node, ast.Structure)), None)
            if placed is not None and found[0].signature.standard:
                _tell(it, call, hole, placed, _fix(hole, statement, placed) if is_placed else None)


def _tell(
    it: Interpreter, call: ast.Call, hole: ast.Structure, placed: ast.Structure, fix: Fix | None
) -> None:
    stated = (node.name.text for node in ast.walk(placed) if isinstance(node, ast.Attribute))
    said = next((name for name in stated if name in _LOST), None)
    if said is None:
        return
    name = hole.name.text
    hints = (
        f"in the solid itself it is a whole one: `{name} = {call.callee.text}(…) at (x, y)`, without `hole`",
        f"or say it of this hole: `@{said}(…) hole {name} {{ … }}`",
    )
    message = f"in a `hole`, `{call.callee.text}` is a bare circle: {_LOST[said]}"
    it.report("W0504", message, call, hints=hints, fix=fix, once=True)


def _fix(hole: ast.Structure, statement: ast.Assign, placed: ast.Structure) -> Fix | None:
    """Returns the edit that puts a cut in the place of a hole with nothing else in it; None if something else
    may be lost, or what is in the hole is named elsewhere, as in `hole.rim`, and the cut has nothing of that
    name.
    """
    source, inside, name = hole.span.source, hole.body.span.text, statement.name.text
    members = {node.name.text for node in placed.body.statements if isinstance(node, ast.Assign)}
    is_named = re.search(rf"\.\s*{re.escape(name)}\b", source.text) is not None and name not in members
    is_alone = inside.strip("{;} \t\n") == statement.span.text.strip("; \t\n")
    if is_named or not is_alone or not isinstance(statement.value, ast.Call):
        return None
    if hole.parameters is not None or hole.placement is not None or hole.attributes:
        return None
    head = Span(source, hole.name.span.start, hole.body.span.start).text.strip()
    made = Span(source, statement.value.span.start, statement.span.end).text.rstrip("; \t\n")
    title = f"make `{hole.name.text}` a whole one, in place of the hole"
    return Fix(title, (Edit(hole.span, f"{head} = {made}"),), is_sure=True)


# --- Structures, in place and from templates, with their frames and, if they are empty, their boxes.

_PLAN = 10.0  # width and height at which the box of an empty structure starts, in mm


def build_structure(
    it: Interpreter, node: ast.Structure, scope: Scope, parent: Structure | None, indices: tuple[int, ...]
) -> Structure:
    """Builds a structure from its definition in place."""
    name = indexed(node.name.text, indices)
    structure = _new(it, node.kind, name, parent, node)
    structure.doc = node.doc
    edits = edits_on(it, node.name.text, indices, scope) if parent is not None else ()
    _place(it, structure, node.placement, scope, edits)
    body = _body(structure, node.name.text, scope, scope.labels)
    run_block(it, node.body.statements, Env(body, structure))
    tell_plain_cuts(it, node, body, parent)
    # what is said of the root may name its params, as nothing is around it
    read_attributes(it, structure, node.attributes, body if parent is None else scope, body)
    finish(it, structure)
    return structure


def instantiate(
    it: Interpreter,
    node: ast.Assign,
    template: Instantiation,
    env: Env,
    indices: tuple[int, ...],
    framed: Callable[[Frame], Frame] | None = None,
) -> Structure | Nothing:
    """Builds an instance of a template under its assigned name; `framed` moves its frame elsewhere."""
    definition, scope, here = template.definition, env.scope, env.here
    if not it.enter(template.node, definition):
        return NOTHING
    try:
        structure = _new(it, definition.kind, indexed(node.name.text, indices), here, node)
        structure.doc = definition.doc
        _place(it, structure, node.placement, scope, edits_on(it, node.name.text, indices, scope))
        body = _body(structure, definition.name.text, certain(template.scope, Scope), scope.labels)
        for parameter, (key, kind, _) in zip(
            definition.parameters or (), template.signature.parameters, strict=True
        ):
            if (value := template.arguments.get(key)) is None:
                value = default_of(it, parameter, kind, Env(body, structure))
            given = (a.value for a in template.node.arguments if a.name is not None and a.name.text == key)
            body.values[key] = passed(it, key, value, structure, here, next(given, parameter))
        read_attributes(it, structure, definition.attributes, body, body)
        read_attributes(it, structure, node.attributes, scope, scope)  # in the scope outside the template
        if definition.placement is not None:
            _place(it, structure, definition.placement, body)
        if framed is not None:
            structure.frame = framed(structure.frame)
        run_block(it, definition.body.statements, Env(body, structure))
        tell_plain_cuts(it, definition, body, here)
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


def _body(structure: Structure, name: str, scope: Scope, labels: tuple[str, ...]) -> Scope:
    """Returns the scope of a body, in which its structure, which is no member of it, is known by name."""
    around = Scope(scope)
    around.values[name] = structure
    structure.scope = body = Scope(around, structure, labels=labels)
    own_names(body, structure)
    return body


def _place(
    it: Interpreter, s: Structure, node: ast.Placement | None, scope: Scope, edits: Edits = ()
) -> None:
    """Sets the frame: `at` is a position, `rotated` is exact unless it is a guess or an unknown."""
    if s.parent is None:
        if node is not None:
            message = "the root's frame is fixed, so `at` and `rotated` change nothing here"
            it.report("W0502", message, node)
        return
    at, turn = place_of(it, node, Env(scope, s.parent))
    if edits:
        at, turn = frame_edited(it, edits, s, at, turn)
    x, y = loose_place(it, at, s)
    rotation = solvable(it, turn, s.span) if turn is not None else ex.ZERO
    if turn is not None and turn.status is Exactness.GUESS:
        rotation = it.unknown(turn.value, s, ROTATION, owner=s.parent, dimension=ANGLE, frame_of=s)
        it.became(turn, rotation, s, ROTATION, ANGLE)
    elif it.frames_turn and (turn is None or turn.status is Exactness.NUMBER) and rotation.is_constant:
        rotation = it.unknown(
            rotation.value, s, ROTATION, owner=s.parent, dimension=ANGLE, frame_of=s, locked=True
        )
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
    if (found := numeric(it, value, placement.rotated, env)) is None:
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
    for node, env in sorted(pending, key=lambda item: not _finishes(it, item[0])):
        read_constraint(it, node, env.reaching(Reach.SUBTREE))


def _finishes(it: Interpreter, node: ast.Statement) -> bool:
    if not isinstance(node, ast.ExpressionStatement) or not isinstance(call := node.value, ast.Call):
        return False
    return it.spelled(call.callee) in FINISHES


def _plan(it: Interpreter, s: Structure) -> None:
    half = _PLAN / 2
    left, bottom, width, height = (
        it.unknown(guess, s, name, owner=s, dimension=LENGTH, outline=True)
        for name, guess in (("left", -half), ("bottom", -half), ("width", _PLAN), ("height", _PLAN))
    )
    s.plan = (left, bottom, width, height)


# --- The main module: its root structure, and what it imports.


def run_module(it: Interpreter) -> Structure:
    """Runs the main module. Returns its root, or an implicit assembly around the statements at file level."""
    module = it.program.main
    statements = module.statements
    scope = _file_scope(it, module, _library_scope(it.program.library), {})
    roots = [s for s in statements if isinstance(s, ast.Structure) and s.parameters is None]
    loose = [s for s in statements if not isinstance(s, (*ast.DEFINITIONS, ast.Structure))]
    if len(roots) == 1 and not loose:
        it.root = root = Structure("assembly", "", None, None)
        hoist_values(Env(scope, root), statements)
        for binding in list(scope.values.values()):
            if isinstance(binding, ParamBinding):
                read_param(it, binding, binding.node)
        root = build_structure(it, roots[0], scope, None, ())
    else:
        name = re.sub(r"\W+", "_", PurePath(module.source.name).stem).strip("_") or "model"
        it.root = root = Structure("assembly", name, None, module.span)
        root.scope = scope
        scope.container = root
        own_names(scope, root)
        run_block(it, statements, Env(scope, root))
        finish(it, root)
        if not roots and not loose and not it.diagnostics:
            hint = "a drawing needs a structure, as in `solid plate { … }`"
            it.report("W0501", "this file draws nothing", None, hints=[hint])
    report_unused(it)
    for constraint in hidden_constraints(it):
        it.add_constraint(constraint)
    return root


def _file_scope(
    it: Interpreter, module: ast.Module, library: Scope, loading: dict[ast.Module, Scope]
) -> Scope:
    """Returns the scope of a file: its definitions and what it imports."""
    if module in loading:
        return loading[module]
    scope = loading[module] = Scope(library)
    hoist_callables(it, scope, module.statements)
    for statement in module.statements:
        if isinstance(statement, ast.Import) and (other := it.program.imports.get(statement)) is not None:
            inner = _file_scope(it, other, library, loading)
            hoist_values(Env(inner, Structure("assembly", "", None, None)), other.statements)
            _bring_in(scope, inner, statement, is_drawing=other.source in it.program.resolution.drawings)
    return scope


def _bring_in(scope: Scope, inner: Scope, statement: ast.Import, *, is_drawing: bool) -> None:
    if statement.alias is not None:
        scope.values[statement.alias.text] = Namespace({**inner.values, "": inner})
        if is_drawing:
            scope.callables[statement.alias.text] = inner.callables[WHOLE]
        return
    wanted = {name.text for name in statement.names}
    tables: list[tuple[dict[str, Any], dict[str, Any]]] = [
        (scope.values, inner.values),
        (scope.callables, inner.callables),
        (scope.aliases, inner.aliases),
    ]
    for own, other in tables:
        for name, meaning in other.items():
            if not wanted or name in wanted:
                own.setdefault(name, meaning)


def _library_scope(library: Library) -> Scope:
    """Returns the outermost scope: built-in and library names. Library code sees no names of the program."""
    scope = Scope(None)

    @cache
    def supply(name: str) -> list[Candidate]:
        if name not in library.callables and name not in SIGNATURES:
            return []
        found = [Candidate(signature, None) for signature in SIGNATURES.get(name, ())]
        return found + [Candidate(signature, scope) for signature in library.callables.get(name, ())]

    scope.supply = supply
    scope.aliases = dict(library.aliases)
    scope.values = _Constants(library.constants, scope)
    return scope


class _Constants(dict[str, NameBinding]):
    """The library's constants by name; a program reads few, so each is looked up when it is first read."""

    def __init__(self, constants: Mapping[str, ast.Let], scope: Scope) -> None:
        super().__init__(dict.fromkeys([*constants, *MATH], NOTHING))
        self._constants, self._scope = constants, scope

    def __getitem__(self, name: str) -> NameBinding:
        if super().__getitem__(name) is NOTHING:
            if name in MATH:
                self[name] = Namespace({**{key: self[key] for key in self._constants}, "": self._scope})
            else:
                self[name] = LetBinding(self._constants[name].value, self._scope)
        return super().__getitem__(name)
