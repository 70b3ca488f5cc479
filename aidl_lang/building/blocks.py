"""Bodies: the declarations that hold in the whole of one, and its statements one by one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from aidl_lang.building.model import Structure
from aidl_lang.building.scopes import Candidate, LetBinding, ParamBinding, Scope
from aidl_lang.building.state import Ahead, Interpreter
from aidl_lang.checking.library import signature
from aidl_lang.syntax import ast


def run_block(it: Interpreter, statements: Sequence[ast.Statement], scope: Scope, here: Structure) -> None:
    """Runs the statements of a body. Callables and constants are visible in the whole of it."""
    hoist_callables(it, scope, statements)
    hoist_values(scope, statements, here)
    ahead = Ahead(statements, scope, here)
    it.ahead.append(ahead)
    try:
        for ahead.next, statement in enumerate(statements, start=1):
            execute(it, statement, scope, here)
    finally:
        it.ahead.pop()


def hoist_callables(it: Interpreter, scope: Scope, statements: Iterable[ast.Statement]) -> None:
    for node in statements:
        match node:
            case ast.FunctionDefinition() | ast.ShapeDefinition() | ast.ConstraintDefinition():
                _hoist(it, scope, node)
            case ast.Structure(parameters=parameters) if parameters is not None:
                _hoist(it, scope, node)
            case ast.Alias(name=name, target=target):
                scope.aliases[name.text] = target.text


def _hoist(it: Interpreter, scope: Scope, node: ast.Callable) -> None:
    if node not in it.signatures:
        it.signatures[node] = signature(node)
    scope.define(Candidate(it.signatures[node], scope))


def hoist_values(scope: Scope, statements: Iterable[ast.Statement], here: Structure) -> None:
    for node in statements:
        match node:
            case ast.Let():
                scope.values.setdefault(node.name.text, LetBinding(node.value, scope))
            case ast.Param():
                scope.values.setdefault(node.name.text, ParamBinding(node, scope, here))


def execute(it: Interpreter, node: ast.Statement, scope: Scope, here: Structure) -> None:
    """Carries out a statement; definitions were hoisted and do nothing here."""
    if (run := it.executors.get(type(node))) is None:
        return
    it.check_time(node)
    try:
        run(it, node, scope, here)
    except RecursionError:
        it.too_deep(node)


def declared_names(block: ast.Block, *, indexed: bool = False) -> Iterator[str]:
    """Yields the names that a block gives to geometry and structures; if `indexed`, those with an index."""
    for node in block.statements:
        match node:
            case ast.Assign() | ast.Structure(parameters=None):
                if node.indices or not indexed:
                    yield node.name.text
            case ast.Var() if not indexed:
                yield node.name.text
            case ast.For(body=body):
                yield from declared_names(body, indexed=indexed)
            case ast.If(then=then, otherwise=otherwise):
                for branch in (then, otherwise):
                    if branch is not None:
                        yield from declared_names(branch, indexed=indexed)
