"""Constraints, preferences and assertions, read when the structure that holds them is whole."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.building.blocks import hoist_values
from aidl_lang.building.coerce import numeric
from aidl_lang.building.evaluate import evaluate, iterate, truth, turn_scope
from aidl_lang.building.impose import impose, record_assertion
from aidl_lang.building.model import Structure
from aidl_lang.building.scopes import LetBinding, Scope
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.building.values import Nothing
from aidl_lang.syntax import ast


def read_constraint(it: Interpreter, node: ast.Statement, scope: Scope, here: Structure) -> None:
    match node:
        case ast.Constrain(items=items):
            _read_items(it, items.statements, scope, here)
        case ast.ExpressionStatement(value=value):
            impose(it, value, Env(scope, here, Reach.SUBTREE))
        case ast.Prefer():
            _prefer(it, node, scope, here)
        case ast.Assert():
            record_assertion(it, node, Env(scope, here, Reach.READ))


def _prefer(it: Interpreter, node: ast.Prefer, scope: Scope, here: Structure) -> None:
    env = Env(scope, here, Reach.SUBTREE)
    weight = 1.0
    if node.weight is not None:
        found = numeric(it, evaluate(it, node.weight, env), node.weight, env)
        if found is not None and found.expression.is_constant:
            weight = found.value
        if not weight > 0:
            it.report("E0511", f"a weight must be more than 0, and this is {weight:g}", node.weight)
            return
    impose(it, node.value, env, weight)


def _read_items(it: Interpreter, statements: Sequence[ast.Statement], scope: Scope, here: Structure) -> None:
    env = Env(scope, here, Reach.SUBTREE)
    hoist_values(scope, statements, here)
    for node in statements:
        match node:
            case ast.For():
                for item in iterate(it, node.iterable, env) or ():
                    it.count_turn(node)
                    _read_items(
                        it, node.body.statements, turn_scope(it, scope, node.variables, item, node), here
                    )
            case ast.If():
                test = evaluate(it, node.test, env)
                if not isinstance(test, Nothing):
                    chosen = node.then if truth(it, test, node.test) else node.otherwise
                    _read_items(it, chosen.statements if chosen else (), scope, here)
            case ast.Equation():
                it.report("N0501", "`=` inside `constrain` is read as `==`", node)
                if node not in it.program.rejected:
                    impose(it, node.meant, env)
            case ast.Assign():
                scope.values[node.name.text] = LetBinding(node.value, scope)
            case _:
                read_constraint(it, node, scope, here)
