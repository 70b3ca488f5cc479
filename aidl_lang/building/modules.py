"""The main module: its root structure, and what it imports."""

from __future__ import annotations

import re
from pathlib import PurePath

from aidl_lang.building.blocks import hoist_callables, hoist_values, run_block
from aidl_lang.building.construct import hidden_constraints
from aidl_lang.building.model import Structure
from aidl_lang.building.params import read_param, report_unused
from aidl_lang.building.scopes import ParamBinding, Scope
from aidl_lang.building.state import Interpreter
from aidl_lang.building.structures import build_structure, finish, own_names
from aidl_lang.building.values import Namespace
from aidl_lang.common.drawings import WHOLE
from aidl_lang.syntax import ast


def run_module(it: Interpreter, library: Scope) -> Structure:
    """Runs the main module. Returns its root structure, or an implicit assembly around the statements at file
    level.
    """
    module = it.program.main
    statements = module.statements
    scope = _file_scope(it, module, library, {})
    roots = [s for s in statements if isinstance(s, ast.Structure) and s.parameters is None]
    loose = [s for s in statements if not isinstance(s, (*ast.DEFINITIONS, ast.Structure))]
    if len(roots) == 1 and not loose:
        it.root = root = Structure("assembly", "", None, None)
        hoist_values(scope, statements, root)
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
        run_block(it, statements, scope, root)
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
    if module in loading:
        return loading[module]
    scope = loading[module] = Scope(library)
    hoist_callables(it, scope, module.statements)
    for statement in module.statements:
        if isinstance(statement, ast.Import) and (other := it.program.imports.get(statement)) is not None:
            inner = _file_scope(it, other, library, loading)
            hoist_values(inner, other.statements, Structure("assembly", "", None, None))
            _bring_in(scope, inner, statement, is_drawing=other.source in it.program.resolution.drawings)
    return scope


def _bring_in(scope: Scope, inner: Scope, statement: ast.Import, *, is_drawing: bool) -> None:
    if statement.alias is not None:
        scope.values[statement.alias.text] = Namespace({**inner.values, "": inner})
        if is_drawing:
            scope.callables[statement.alias.text] = inner.callables[WHOLE]
        return
    wanted = {name.text for name in statement.names}

    def is_wanted(name: str) -> bool:
        return not wanted or name in wanted

    for name, binding in inner.values.items():
        if is_wanted(name):
            scope.values.setdefault(name, binding)
    for name, candidates in inner.callables.items():
        if is_wanted(name):
            scope.callables.setdefault(name, candidates)
    for name, target in inner.aliases.items():
        if is_wanted(name):
            scope.aliases.setdefault(name, target)
