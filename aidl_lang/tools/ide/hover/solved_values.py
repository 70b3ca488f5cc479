"""The values of an expression in the solved model, one for each time it was built.

An expression in a template, a shape or a loop has as many values as there are instances and turns. It is read
again in the scope that each of these had, and evaluated at the solved values of the unknowns.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import islice

from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import spelled_out
from aidl_lang.building.calls import call
from aidl_lang.building.evaluate import evaluate, iterate, turn_scope
from aidl_lang.building.expression import Evaluator, Unknown
from aidl_lang.building.model import Geometry, Model, Structure, own_geometry
from aidl_lang.building.state import BuildingLimits, Env, Interpreter, LetBinding, Reach, Scope
from aidl_lang.building.statements import EXECUTORS
from aidl_lang.building.values import Array, ListVal, Nothing, Num, PointVal, Value, members
from aidl_lang.common.diagnostics import has_errors
from aidl_lang.common.records import record
from aidl_lang.pipeline import Compiled
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.workspace import View

MOST = 4
"""Most instances and turns that are listed."""
_LOOKED_AT = 200
_LIMITS = BuildingLimits(entities=1_000, turns=2_000, depth=30, items=2_000, seconds=0.2)
"""Limits for reading one expression: far less than a program may ask for."""
_DEEPEST = 60
_STEP = 1e-4
"""Step by which things are moved to see whether a number changes with them, in mm or degrees."""
_UNMOVED = 1e-3


@record(eq=False)
class BuiltValue:
    """A value where it was built: `label` names the instance or turn, "" for a single one."""

    label: str
    value: Value
    env: Env


@record(eq=False)
class Solved:
    """The outcome of a view's own text."""

    view: View
    outcome: Compiled
    built: Model
    evaluate: Evaluator

    @cached_property
    def _known(self) -> frozenset[Unknown]:
        return frozenset(self.built.unknowns)

    @cached_property
    def free(self) -> frozenset[str]:
        return frozenset(self.outcome.model.mobility().free) if self.outcome.model else frozenset()

    def values(self, node: ast.Expression, path: Sequence[ast.Node]) -> list[BuiltValue]:
        """Returns the values of an expression, the first of many; `path` are the nodes around it, outermost
        first. Returns none for one that has an error in it, or makes something.
        """
        if _depth(node) > _DEEPEST:
            return []
        found: list[BuiltValue] = []
        for label, env in islice(self._places(path), _LOOKED_AT):
            value = self.read(node, env)
            if value is not None:
                found.append(BuiltValue(label, value, env))
            if len(found) == MOST:
                break
        return found

    def read(self, node: ast.Expression, env: Env) -> Value | None:
        """Returns the value of an expression in a scope; None if it has no solved value."""
        it = self._interpreter()
        value = evaluate(it, node, env)
        if isinstance(value, Nothing) or has_errors(it.diagnostics) or it.unknowns:
            return None
        return value

    def number(self, value: Num) -> float | None:
        """Returns the solved value of a spelled-out number; None if it depends on something not solved."""
        if not self._known.issuperset(ex.unknowns([value.expression])):
            return None
        return self.evaluate(value.expression)

    def _interpreter(self) -> Interpreter:
        return Interpreter(self.view.program, self.view.params or {}, _LIMITS, EXECUTORS, evaluate, call)

    # --- Where it was built ------------------------------------------------------------------------

    def _places(self, path: Sequence[ast.Node]) -> Iterator[tuple[str, Env]]:
        """Yields the instances of the body around a node, each with the turns of its loops."""
        number = _owner(path)
        if number is None:
            return
        instances = list(islice(self._instances(path[number]), _LOOKED_AT))
        for name, structure, scope in instances:
            env = Env(scope, structure, Reach.READ)
            for label, inner in self._turns(env, path[number + 1 :]):
                yield ", ".join(filter(None, (name if len(instances) > 1 else "", label))), inner

    def _instances(self, owner: ast.Node) -> Iterator[tuple[str, Structure, Scope]]:
        root = self.built.root
        match owner:
            case ast.Module():
                if isinstance(root.scope, Scope):
                    yield "", root, root.scope
            case ast.ShapeDefinition():
                for structure in root.walk():
                    for geometry in _all_of(structure.own()):
                        if geometry.type == owner.name.text and isinstance(geometry.scope, Scope):
                            yield _below(root, geometry.path), geometry.owner, geometry.scope
            case ast.Structure():
                for structure in root.walk():
                    if isinstance(structure.scope, Scope) and _is_made_by(structure, owner):
                        yield _below(root, structure.path), structure, structure.scope
            case _:
                return

    def _turns(self, env: Env, inside: Sequence[ast.Node]) -> Iterator[tuple[str, Env]]:
        """Yields the environments of a place in a body: one for each turn of the loops around it."""
        loop = next((n for n, node in enumerate(inside) if isinstance(node, ast.For)), None)
        block = inside[:loop]
        for node in block:
            if isinstance(node, ast.Block):
                env = _with_lets(env, node)
        if loop is None:
            yield "", env
            return
        node = inside[loop]
        assert isinstance(node, ast.For)
        if loop + 1 < len(inside) and inside[loop + 1] is not node.body:
            yield "", env  # in its head
            return
        it = self._interpreter()
        for item in iterate(it, node.iterable, env) or ():
            scope = turn_scope(it, env.scope, node.variables, item, node)
            label = ", ".join(scope.labels[len(env.scope.labels) :])
            for more, inner in self._turns(Env(scope, env.here, env.reach), inside[loop + 1 :]):
                yield ", ".join(filter(None, (label, more))), inner

    # --- How exact it is ---------------------------------------------------------------------------

    def moves(self, value: Num) -> bool | None:
        """Tells whether a number changes with the remaining motions; None if that is not known."""
        model = self.outcome.model
        if model is None:
            return None
        by_path = {u.path: u for u in ex.unknowns([value.expression])}
        for motion in model.ways:
            rates = {by_path[path]: rate for path, rate in motion.moves.items() if path in by_path}
            largest = max(map(abs, motion.moves.values()), default=0.0)
            if rates and largest and self._changes(value, rates, _STEP / largest):
                return True
        return False if len(model.ways) == (model.degrees or 0) else None

    def _changes(self, value: Num, rates: dict[Unknown, float], step: float) -> bool:
        solved = self.evaluate.values
        ends = []
        for way in (step, -step):
            moved = {u: solved.get(u, u.guess) + way * rate for u, rate in rates.items()}
            ends.append(Evaluator({**solved, **moved}, self.evaluate.measure)(value.expression))
        return abs(ends[0] - ends[1]) > 2 * _UNMOVED * _STEP


def solved_of(view: View) -> Solved | None:
    """Returns the solved values of a view; None if its present text was not built and solved."""
    outcome = view.outcome
    if outcome is None or outcome.built is None or outcome.evaluate is None:
        return None
    return Solved(view, outcome, outcome.built, outcome.evaluate)


def _owner(path: Sequence[ast.Node]) -> int | None:
    """Returns the innermost node with a body around the last one; None within a function or a constraint,
    which have no values of their own.
    """
    for number in range(len(path) - 1, -1, -1):
        node = path[number]
        inside = path[number + 1] if number + 1 < len(path) else None
        match node:
            case ast.FunctionDefinition() | ast.ConstraintDefinition() | ast.Comprehension():
                return None
            case ast.ForArguments() | ast.ArgumentBlock():
                return None
            case ast.Structure() | ast.ShapeDefinition() if inside is node.body:
                return number
            case ast.Structure(parameters=parameters) if parameters is not None and inside in parameters:
                return number
            case ast.Module():
                return number
            case _:
                pass
    return None


def _is_made_by(structure: Structure, node: ast.Structure) -> bool:
    """Tells whether a structure was built from a definition: in place, or as an instance of the template."""
    if node.parameters is None:
        return structure.span == node.span
    scope = structure.scope
    assert isinstance(scope, Scope)
    around = scope.parent.values if scope.parent is not None else {}
    is_named = around.get(node.name.text) is structure and structure.kind == node.kind
    return is_named and all(p.name.text in scope.values for p in node.parameters)


def _below(root: Structure, path: str) -> str:
    return path.removeprefix(f"{root.path}.")


def _all_of(found: Iterable[Geometry]) -> Iterator[Geometry]:
    """Yields geometry with all its parts."""
    stack = list(found)
    while stack:
        yield (top := stack.pop(0))
        stack += own_geometry(top.parts, top)


def _with_lets(env: Env, block: ast.Block) -> Env:
    """Returns the environment extended by the names of a block of constraints, or of a turn."""
    scope = Scope(env.scope, env.scope.container, turn=True, labels=env.scope.labels)
    for node in block.statements:
        match node:
            case ast.Let(name=name, value=value) | ast.Assign(name=name, indices=(), value=value):
                if env.scope.find(name.text) is None:
                    scope.values[name.text] = LetBinding(value, scope)
            case _:
                pass
    return Env(scope, env.here, env.reach)


def _depth(node: ast.Node) -> int:
    deepest, stack = 0, [(node, 1)]
    while stack:
        top, depth = stack.pop()
        deepest = max(deepest, depth)
        stack += [(child, depth + 1) for child in ast.children(top)]
    return deepest


def spelled(*values: Value) -> list[Value]:
    """Spells out the sides of boxes in values, as one comparison has them."""
    numbers = [n for value in values for n in _numbers(value)]
    known = iter(spelled_out(*(n.expression for n in numbers)))

    def made(number: Num) -> Num:
        return Num(next(known), number.dimension, number.status)

    return [
        PointVal(made(v.x), made(v.y)) if isinstance(v, PointVal) else made(v) if isinstance(v, Num) else v
        for v in values
    ]


def _numbers(value: Value) -> list[Num]:
    match value:
        case Num():
            return [value]
        case PointVal(x, y):
            return [x, y]
        case _:
            return []


def items_of(value: Value) -> list[tuple[str, Value]] | None:
    """Returns the members of a list or an array, each with its index; None for anything else."""
    match value:
        case Array():
            firsts = sorted({index[0] for index in value.members})
            return [(f"[{first}]", item) for first, item in zip(firsts, value.items(), strict=True)]
        case ListVal():
            return [(f"[{n}]", item) for n, item in enumerate(members(value) or ())]
        case _:
            return None
