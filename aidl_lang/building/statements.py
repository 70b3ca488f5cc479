"""The effect of each statement of a body when its line is reached."""

from __future__ import annotations

import math
from collections.abc import Mapping

from aidl_lang.building import expression as ex
from aidl_lang.building.assignment import Assignment, adopt, declare, give_name, index_values
from aidl_lang.building.attributes import read_own_attributes
from aidl_lang.building.calls import declared_names, run_block
from aidl_lang.building.coerce import as_point, numeric
from aidl_lang.building.construct import loose_point, refuses_measure
from aidl_lang.building.edits import GeometryPlacement, check_edit, edited, edits_on, is_edit
from aidl_lang.building.evaluate import evaluate, iterate, truth, turn_scope
from aidl_lang.building.impose import record_assertion
from aidl_lang.building.model import Geometry, Structure
from aidl_lang.building.params import read_param
from aidl_lang.building.state import (
    Env,
    Executor,
    Interpreter,
    LetBinding,
    ParamBinding,
    Reach,
    Scope,
    VarBinding,
)
from aidl_lang.building.structures import build_structure, place_of
from aidl_lang.building.values import (
    NOTHING,
    Array,
    Exactness,
    Instantiation,
    ListVal,
    Nothing,
    Num,
    Pattern,
    PointVal,
    StructureCopy,
    Value,
    holds,
    kind_of,
)
from aidl_lang.syntax import ast


def _assign(it: Interpreter, node: ast.Assign, scope: Scope, here: Structure) -> None:
    indices = index_values(it, node.indices, scope, here)
    if indices is None:
        return
    value = _made(it, node, scope, here, indices)
    if isinstance(value, Nothing):
        declare(it, scope, node.name, indices, NOTHING, node)
        return
    is_new = isinstance(value, Instantiation | StructureCopy | Pattern)
    was_there = holds(value, Structure)
    value = Assignment(it, node, scope, here).whole(value, indices)
    container = scope.declaring().container or here
    if not is_new:
        value = _named(it, node, value, scope, here, indices)
    if was_there or not holds(value, Structure):  # otherwise the structures made here have their own
        read_own_attributes(it, node, value, container, scope)
    if not indices and not isinstance(value, Array | Structure | Geometry | ListVal | PointVal):
        scope.values[node.name.text] = LetBinding(node.value, scope)
        return
    declare(it, scope, node.name, indices, value, node)


def _made(
    it: Interpreter, node: ast.Assign, scope: Scope, here: Structure, indices: tuple[int, ...]
) -> Value:
    """Returns the value of an assignment: placed, and edited by the statements below it."""
    env = Env(scope, here, Reach.OWN)
    value = evaluate(it, node.value, env)
    if isinstance(value, Nothing | Instantiation):
        return value
    placed = None
    if node.placement is not None:
        if isinstance(value, Geometry | PointVal):
            placed = GeometryPlacement(*place_of(it, node.placement, env))
        elif not isinstance(value, StructureCopy | Pattern):
            message = f"`at` and `rotated` place one structure or geometry, not {kind_of(value)}"
            it.report("E0509", message, node.placement, hints=["place each thing where it is made"])
    return edited(it, node, value, edits_on(it, node.name.text, indices, scope), env, placed)


def _named(
    it: Interpreter, node: ast.Assign, value: Value, scope: Scope, here: Structure, indices: tuple[int, ...]
) -> Value:
    """Returns the value under its new name: a literal point becomes geometry."""
    container = scope.declaring().container or here
    if isinstance(value, PointVal) or (
        isinstance(value, ListVal) and not indices and _is_literal_point(node.value)
    ):
        at = as_point(it, value, node.value, Env(scope, here, Reach.OWN))
        if at is None:
            return value
        it.count_entity(node)
        dot = Geometry("point", here, it.place(node))
        give_name(dot, node.name.text, indices, container, node)
        dot.fields = {"at": loose_point(it, at, dot)}
        return dot
    if isinstance(value, Geometry | ListVal):
        adopt(value, node.name.text, indices, container, node)
    return value


def _is_literal_point(node: ast.Expression) -> bool:
    if not isinstance(node, ast.List) or len(node.items) != 2:
        return False
    return all(isinstance(i, ast.Number | ast.Unary) for i in node.items)


def _structure(it: Interpreter, node: ast.Structure, scope: Scope, here: Structure) -> None:
    if node.parameters is not None:
        return
    indices = index_values(it, node.indices, scope, here)
    if indices is not None:
        made = build_structure(it, node, scope, here, indices)
        declare(it, scope, node.name, indices, made, node)


def _param(it: Interpreter, node: ast.Param, scope: Scope, here: Structure) -> None:
    binding = scope.values.get(node.name.text)
    if scope.turn:
        message = f"`param {node.name.text}` would be made in every turn of the loop"
        hint = "put the `param` before the loop, or use a `let` of the loop variable"
        it.report("E0208", message, node.name, hints=[hint])
    elif isinstance(binding, ParamBinding):
        read_param(it, binding, node)


def _var(it: Interpreter, node: ast.Var, scope: Scope, here: Structure) -> None:
    value = evaluate(it, node.value, Env(scope, here, Reach.OWN))
    if isinstance(value, Nothing):
        return
    found = numeric(it, value, node.value, Env(scope, here, Reach.OWN))
    if found is None:
        declare(it, scope, node.name, (), NOTHING, node)
        return
    if found.status is Exactness.FIXED:
        declare(it, scope, node.name, (), found, node)  # nothing is left to find
        return
    holder = scope.declaring().container or here
    if not refuses_measure(it, found, node.value.span) and not math.isfinite(found.value):
        it.report("E0504", f"`{node.value.span.one_line}` has no value at the first guesses", node.value)
    made = it.unknown(found.value, holder, node.name.text, owner=here, dimension=found.dimension)
    assert isinstance(made.payload, ex.Unknown)
    it.became(found, made, holder, node.name.text, found.dimension)
    var = VarBinding(Num(made, found.dimension, Exactness.REFERENCE), made.payload)
    declare(it, scope, node.name, (), var, node)


def _for(it: Interpreter, node: ast.For, scope: Scope, here: Structure) -> None:
    for name in declared_names(node.body, indexed=True):
        scope.declaring().values.setdefault(name, Array(name))  # even if the loop has no turn
    for item in iterate(it, node.iterable, Env(scope, here, Reach.OWN)) or ():
        it.count_turn(node)
        run_block(it, node.body.statements, turn_scope(it, scope, node.variables, item, node), here)


def _if(it: Interpreter, node: ast.If, scope: Scope, here: Structure) -> None:
    test = evaluate(it, node.test, Env(scope, here, Reach.OWN))
    if isinstance(test, Nothing):
        return
    both = (node.then, node.otherwise)
    taken, left_out = both if truth(it, test, node.test) else both[::-1]
    if left_out is not None:
        scope.unbuilt |= dict.fromkeys(declared_names(left_out), node)
    if taken is not None:
        run_block(it, taken.statements, scope, here)


def _expression(it: Interpreter, node: ast.ExpressionStatement, scope: Scope, here: Structure) -> None:
    """Checks an edit, which was applied where the thing was made; defers everything else as a constraint."""
    if isinstance(node.value, ast.Call) and is_edit(it, node.value, scope):
        check_edit(it, node.value, Env(scope, here, Reach.OWN))
    else:
        _defer(it, node, scope, here)


def _defer(it: Interpreter, node: ast.Statement, scope: Scope, here: Structure) -> None:
    it.pending.setdefault(here, []).append((node, scope))


def _assert(it: Interpreter, node: ast.Assert, scope: Scope, here: Structure) -> None:
    """Checks an assertion on the arguments of a shape where that is made; defers any other."""
    if isinstance(container := scope.declaring().container, Geometry):
        record_assertion(it, node, Env(scope, here, Reach.READ), container.type)
    else:
        _defer(it, node, scope, here)


EXECUTORS: Mapping[type, Executor] = {
    ast.Param: _param,
    ast.Var: _var,
    ast.Assign: _assign,
    ast.Structure: _structure,
    ast.For: _for,
    ast.If: _if,
    ast.Constrain: _defer,
    ast.ExpressionStatement: _expression,
    ast.Prefer: _defer,
    ast.Assert: _assert,
}
"""Executors of the statements that take effect when their line is reached; definitions were hoisted."""
