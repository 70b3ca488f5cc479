"""The walk over a program: which statement speaks of which structure of the document.

It takes loops and branches, enters templates, and gathers what is to be checked: constraints, assertions,
and the definitions of geometry and frames.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from aidl_lang import ast
from tests.checker.conditions import expressions
from tests.checker.evaluate import Evaluator
from tests.checker.tree import Geo, Node
from tests.checker.values import MistakeError, Scope, Thunk, fold


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


_LIBRARY_ALIASES = {
    "rect": "rectangle",
    "rounded_rect": "rounded_rectangle",
    "annulus": "ring",
    "capsule": "slot",
    "stadium": "slot",
    "wedge": "sector",
    "diamond": "rhombus",
}


def walk(module: ast.Module, root: Node) -> Program:
    """Everything a module says about the structures below `root`."""
    program = Program()
    top = Scope(None, aliases=dict(_LIBRARY_ALIASES))
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
                scope.functions.setdefault(s.name.text, []).append((s, scope))
            case ast.Structure() if s.parameters is not None:
                scope.functions.setdefault(s.name.text, []).append((s, scope))
            case ast.Alias(name, target):
                scope.aliases[name.text] = target.text

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
            case ast.ExpressionStatement():
                block = ast.Block((s,), span=s.span)
                self.program.constraints.append(Task(self.node, block, scope))
            case ast.Assert():
                self.program.assertions.append(Task(self.node, s, scope))

    def _assign(self, s: ast.Assign, scope: Scope) -> None:
        key = self._key(s.name, s.indices, scope)
        geo = self.node.geometry.get(key)
        if geo is not None:
            self._geometry(s, geo, scope)
            return
        if key in self.node.children:
            self._instance(s, self.node.children[key], scope)
            return
        scope.names[s.name.text] = Thunk(s.value, scope, "let", s.name.text)

    def _geometry(self, s: ast.Assign, geo: Geo, scope: Scope) -> None:
        """Geometry: an instance of a user's shape can be asked for its arguments and `let`s."""
        geo.written = Task(self.node, s, scope)
        self.program.definitions.append((geo.written, geo))
        if not isinstance(s.value, ast.Call):
            return
        for candidate, home in scope.candidates(s.value.callee.text):
            if isinstance(candidate, ast.ShapeDefinition):
                inner = _bind(candidate, home, s.value, scope)
                if inner is not None:
                    inner.names |= geo.members()
                    for item in candidate.body.statements:
                        self._declare(item, inner)
                    geo.source = inner
                    return

    def _instance(self, s: ast.Assign, child: Node, scope: Scope) -> None:
        self._place(child, s.placement, scope)
        assert isinstance(s.value, ast.Call)
        for candidate, home in scope.candidates(s.value.callee.text):
            if isinstance(candidate, ast.Structure):
                inner = _bind(candidate, home, s.value, scope)
                if inner is not None:
                    body = Scope(inner, node=child)
                    body.names |= inner.names
                    child.env = body
                    _Walker(self.program, child).block(candidate.body.statements, body)
                    return
        raise MistakeError(f"no template {s.value.callee.text}")

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


def _bind(definition: Any, home: Scope, call: ast.Call, scope: Scope) -> Scope | None:
    """The arguments of a call as names; None when they do not fit."""
    names = [p.name.text for p in definition.parameters]
    positional = [a for a in call.arguments if a.name is None]
    given = {n: Thunk(a.value, scope) for n, a in zip(names, positional, strict=False)}
    for argument in call.arguments:
        if argument.name is not None:
            known = next((n for n in names if fold(n) == fold(argument.name.text)), None)
            if known is None:
                return None
            given[known] = Thunk(argument.value, scope)
    inner = Scope(home, dict(given))
    for parameter in definition.parameters:
        if parameter.name.text not in given:
            if parameter.default is None:
                return None
            inner.names[parameter.name.text] = Thunk(parameter.default, inner)
    return inner


def stated(task: Task) -> Iterator[tuple[ast.Expression, Scope]]:
    """The constraints of a task one by one."""
    yield from expressions(Evaluator(task.node), task.statement, task.scope)
