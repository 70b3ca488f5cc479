"""The walk over a program: which statement speaks of which structure of the document.

It takes loops and branches, enters templates, and gathers what is to be checked: constraints, assertions,
and the definitions of geometry and frames.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from aidl_lang.syntax import ast
from tests.checker import copies, library, patterns
from tests.checker.binding import chosen
from tests.checker.conditions import expressions
from tests.checker.evaluate import Evaluator
from tests.checker.tree import Array, Geo, Node
from tests.checker.values import Exact, MistakeError, Num, Scope, Thunk, fold

FINISHES = ("fillet", "chamfer")
EDITS = ("move", "translate", "rotate", "scale")


@dataclass(frozen=True)
class Task:
    """Something to check in the frame of `node`."""

    node: Node
    statement: Any
    scope: Scope


@dataclass
class Program:
    constraints: list[Task] = field(default_factory=list)
    assertions: list[Task] = field(default_factory=list)
    definitions: list[tuple[Task, Geo]] = field(default_factory=list)
    placements: list[tuple[Task, Node]] = field(default_factory=list)
    copies: list[tuple[Task, copies.Copy, Geo | Node]] = field(default_factory=list)
    patterns: list[tuple[Task, patterns.Pattern]] = field(default_factory=list)


def walk(module: ast.Module, root: Node) -> Program:
    """Everything a module says about the structures below `root`."""
    program = Program()
    top = Scope(library.scope())
    roots = [s for s in module.statements if isinstance(s, ast.Structure) and s.parameters is None]
    others = [s for s in module.statements if s not in roots]
    implicit = len(roots) != 1 or any(
        isinstance(s, ast.Constrain | ast.ExpressionStatement | ast.Assign | ast.For) for s in others
    )
    if implicit:
        scope = Scope(top, node=root)
        root.env = scope
        _Walker(program, root).block(module.statements, scope)
        return program
    scope = Scope(top)
    _Walker(program, root).block(tuple(others), scope)
    _enter(program, roots[0], root, scope)
    return program


def _enter(program: Program, structure: ast.Structure, node: Node, outer: Scope) -> None:
    scope = Scope(outer, node=node)
    node.env = scope
    _Walker(program, node).block(structure.body.statements, scope)


@dataclass
class _Walker:
    program: Program
    node: Node

    @property
    def evaluator(self) -> Evaluator:
        return Evaluator(self.node)

    def block(self, statements: tuple[ast.Statement, ...], scope: Scope) -> None:
        """Names first: callables and constants are visible in their whole block."""
        for s in statements:
            self._declare(s, scope)
        for s in statements:
            self._statement(s, scope)

    def _declare(self, s: ast.Statement, scope: Scope) -> None:
        match s:
            case ast.Let(name, value):
                scope.names[name.text] = Thunk(value, scope, "let", name.text)
            case ast.Param(name, value):
                scope.names[name.text] = Thunk(value, scope, "param", name.text)
            case ast.Var(name, value):
                scope.names[name.text] = Thunk(value, scope, "var", name.text)
            case ast.FunctionDefinition() | ast.ConstraintDefinition() | ast.ShapeDefinition():
                scope.functions.setdefault(fold(s.name.text), []).append((s, scope))
            case ast.Structure() if s.parameters is not None:
                scope.functions.setdefault(fold(s.name.text), []).append((s, scope))
            case ast.Alias(name, target):
                scope.aliases[fold(name.text)] = target.text

    def _statement(self, s: ast.Statement, scope: Scope) -> None:
        ev = self.evaluator
        match s:
            case ast.Structure() if s.parameters is None:
                child = self._child(s.name, s.indices, scope)
                self._place(child, s.placement, scope)
                _enter(self.program, s, child, scope)
            case ast.Assign():
                self._assign(s, scope)
            case ast.For(variables, iterable, body):
                for value in ev.items(ev.value(iterable, scope)):
                    self.block(body.statements, ev.bound(variables, value, scope))
            case ast.If(test, then, otherwise):
                branch = then if ev.truth(test, scope) else otherwise
                if branch is not None:
                    self.block(branch.statements, scope)
            case ast.Constrain(items):
                self.program.constraints.append(Task(self.node, items, scope))
            case ast.ExpressionStatement(ast.Call() as call) if self._is_edit(call, scope):
                pass
            case ast.ExpressionStatement():
                block = ast.Block((s,), span=s.span)
                self.program.constraints.append(Task(self.node, block, scope))
            case ast.Assert():
                self.program.assertions.append(Task(self.node, s, scope))

    def _is_edit(self, call: ast.Call, scope: Scope) -> bool:
        """`move(r, …)` and its like change what was written; `fillet` and `chamfer` come after solving."""
        name = fold(scope.canonical(call.callee.text))
        if scope.own(name) or name not in (*FINISHES, *EDITS):
            return False
        if name in EDITS:
            thing = self.evaluator.arguments(call, scope)[0][0]
            if isinstance(thing, Node):
                for node in thing.walk():
                    for geo in node.geometry.values():
                        geo.is_edited = True
            thing.is_edited = True
        return True

    def _assign(self, s: ast.Assign, scope: Scope) -> None:
        key = self._key(s.name, s.indices, scope)
        geo, child = self.node.geometry.get(key), self.node.children.get(key)
        made = copies.origin(self.evaluator, s.value, scope)
        image = child if geo is None else geo
        if made is not None and image is not None:
            self.program.copies.append((Task(self.node, s, scope), made, image))
            if isinstance(image, Node) and isinstance(made.source, Node):
                copies.same_names(made.source, image)
        elif geo is not None:
            self._geometry(s, geo, scope)
        elif child is not None:
            self._instance(s, child, scope)
        elif isinstance(found := self.node.members().get(s.name.text), Array) and _is_pattern(s, scope):
            self._pattern(s, found, scope)
        else:
            scope.names[s.name.text] = Thunk(s.value, scope, "let", s.name.text)

    def _geometry(self, s: ast.Assign, geo: Geo, scope: Scope) -> None:
        """Geometry: an instance of a shape can be asked for its arguments and `let`s."""
        geo.written = Task(self.node, s, scope)
        self.program.definitions.append((geo.written, geo))
        if isinstance(s.value, ast.Call):
            geo.source = self._names_of(s.value, geo, scope)

    def _names_of(self, call: ast.Call, geo: Geo, scope: Scope) -> Scope | None:
        """The names in a shape, also of one that a function makes; the document tells its numbers."""
        found = _entered(self.evaluator, scope.candidates(call.callee.text), call, scope)
        if found is None:
            return None
        definition, inner = found
        if isinstance(definition, ast.FunctionDefinition):
            value = definition.value
            return self._names_of(value, geo, inner) if isinstance(value, ast.Call) else None
        if not isinstance(definition, ast.ShapeDefinition):
            return None
        told = geo.data.get("params", {})
        inner.names |= {n: told_value(v) for n, v in told.items() if not isinstance(v, list)}
        inner.names |= geo.members()
        for item in definition.body.statements:
            self._declare(item, inner)
        return inner

    def _instance(self, s: ast.Assign, child: Node, scope: Scope) -> None:
        self._place(child, s.placement, scope)
        assert isinstance(s.value, ast.Call)
        self._template(s.value, child, scope)

    def _template(self, call: ast.Call, child: Node, scope: Scope) -> None:
        found = _entered(self.evaluator, scope.candidates(call.callee.text), call, scope)
        if found is None or not isinstance(found[0], ast.Structure):
            raise MistakeError(f"no template {call.callee.text}")
        definition, inner = found
        child.env = Scope(inner, names=dict(inner.names), node=child)
        _Walker(self.program, child).block(definition.body.statements, child.env)

    def _pattern(self, s: ast.Assign, members: Array, scope: Scope) -> None:
        """The members of a template see what is written of it."""
        assert isinstance(s.value, ast.Call)
        thing = s.value.receiver or s.value.arguments[0].value
        if 0 not in members.items:  # a thing with a name is the first member itself
            members.items = {0: self.evaluator.value(thing, scope), **members.items}
        members.pattern = patterns.Pattern(self.node, s.value, scope, members)
        self.program.patterns.append((Task(self.node, s, scope), members.pattern))
        for member in members.pattern.members():
            if isinstance(member, Node) and isinstance(thing, ast.Call):
                self._template(thing, member, scope)

    def _place(self, child: Node, placement: ast.Placement | None, scope: Scope) -> None:
        child.placed = Task(self.node, placement, scope)
        self.program.placements.append((child.placed, child))

    def _child(self, name: ast.Identifier, indices: tuple[ast.Expression, ...], scope: Scope) -> Node:
        key = self._key(name, indices, scope)
        if key not in self.node.children:
            raise MistakeError(f"the document has no structure {self.node.path}.{key}")
        return self.node.children[key]

    def _key(self, name: ast.Identifier, indices: tuple[ast.Expression, ...], scope: Scope) -> str:
        ev = self.evaluator
        return name.text + "".join(f"[{round(ev.number(ev.value(i, scope)).value)}]" for i in indices)


def _is_pattern(s: ast.Assign, scope: Scope) -> bool:
    return isinstance(s.value, ast.Call) and fold(scope.canonical(s.value.callee.text)) in patterns.KINDS


def _entered(
    ev: Evaluator, candidates: list[tuple[Any, Scope]], call: ast.Call, scope: Scope
) -> tuple[Any, Scope] | None:
    """The definition that a call means, with the arguments as expressions that wait for their place."""
    arguments = [(a.name, a.value) for a in call.arguments]
    if call.receiver is not None:
        arguments.insert(0, (None, call.receiver))
    positional = [Thunk(v, scope) for n, v in arguments if n is None]
    named = {n.text: Thunk(v, scope) for n, v in arguments if n is not None}
    found = chosen(candidates, positional, named, lambda v: ev.forced(v, scope))
    if found is None:
        return None
    definition, inner = found
    for parameter in definition.parameters:
        if parameter.name.text not in inner.names and parameter.default is not None:
            inner.names[parameter.name.text] = Thunk(parameter.default, inner)
    return definition, inner


def told_value(value: Any) -> Any:
    """A number of the document; its dimension is not said there."""
    return value if isinstance(value, str | bool) else Num(float(value), Exact.REFERENCE)


def stated(task: Task) -> Iterator[tuple[ast.Expression, Scope]]:
    """The constraints of a task one by one."""
    yield from expressions(Evaluator(task.node), task.statement, task.scope)
