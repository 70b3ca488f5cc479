"""What a program's constraints say: each expression over the names that the document tells."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cache, cached_property
from inspect import signature
from typing import Any

from aidl_lang.checking import library
from aidl_lang.checking.binding import PARAMETERS
from aidl_lang.checking.types import Signature
from aidl_lang.syntax import ast
from tests.checker import measures
from tests.checker.measures import FUNCTIONS, is_line, items
from tests.checker.model import Angle, Geo, Node, UnknownError, fold, named, read, together
from tests.checker.relations import RELATIONS, angle_readings, compare, plain

_UNITS = {None: 1.0, "mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "ft": 304.8}
_ANGLES = {"deg": 1.0, "°": 1.0, "rad": 180 / math.pi, "turn": 360.0}
_WORDS = {"x", "y", "left", "right", "center", "top", "bottom", "middle"}
_WORDED = {"align", "side", "axis", "about", "place"}
_ARITHMETIC: dict[str, Callable[[Any, Any], Any]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "%": lambda a, b: a % b,
    "^": lambda a, b: a**b,
}


@dataclass
class Scope:
    """Names seen at a place: values, expressions that wait, and what a program defines to be called."""

    outer: Scope | None = None
    path: str | None = None
    names: dict[str, Any] = field(default_factory=dict)

    def inside(self, path: str | None = None, **names: Any) -> Scope:
        return Scope(self, path, names)

    def chain(self) -> Iterator[Scope]:
        yield self
        if self.outer is not None:
            yield from self.outer.chain()


@dataclass(frozen=True)
class Waiting:
    """An expression that is evaluated where its name is used."""

    expression: ast.Expression
    scope: Scope


class View:
    """Values as a structure of a document sees them."""

    def __init__(self, document: dict[str, Any], here: str, scopes: dict[str, Scope]) -> None:
        self.root = read(document, here)
        self.nodes = {node.path: node for node in self.root.walk()}
        self.scopes = scopes

    def value(self, e: ast.Expression, scope: Scope) -> Any:
        match e:
            case ast.Number(value, unit):
                return Angle(value * _ANGLES[unit]) if unit in _ANGLES else value * _UNITS[unit]
            case ast.String() | ast.Boolean():
                return e.value
            case ast.Name(text):
                return self.name(text, scope)
            case ast.Point(x, y):
                return complex(*(self.coordinate(v, scope, i) for i, v in enumerate((x, y))))
            case ast.List(found):
                return [self.value(item, scope) for item in found]
            case ast.Range():
                return self.range(e, scope)
            case ast.Unary("not", operand):
                return not self.truth(operand, scope)
            case ast.Unary(operator, operand):
                found = plain(self.value(operand, scope))
                return found if operator == "+" else type(found)(-found)
            case ast.Binary(operator, left, right) if operator not in ("and", "or"):
                return self.arithmetic(operator, self.value(left, scope), self.value(right, scope))
            case ast.Comprehension(element, variables, iterable, condition):
                turns = [self.bound(variables, v, scope) for v in items(self.value(iterable, scope))]
                return [
                    self.value(element, s) for s in turns if condition is None or self.truth(condition, s)
                ]
            case _:
                return self._chosen(e, scope)

    def _chosen(self, e: ast.Expression, scope: Scope) -> Any:
        match e:
            case ast.Conditional(test, then, otherwise):
                return self.value(then if self.truth(test, scope) else otherwise, scope)
            case ast.Member(value, name):
                return self.member(self.value(value, scope), name.text)
            case ast.Index(value, index):
                found, key = self.value(value, scope), self.value(index, scope)
                return measures.field(found, key) if isinstance(key, str) else _indexed(found, round(key))
            case ast.Call():
                return self.call(e, scope)
            case ast.Binary() | ast.Comparison() | ast.Membership():
                return self.truth(e, scope)
        raise UnknownError(f"{type(e).__name__} is not evaluated")

    def coordinate(self, e: ast.Expression, scope: Scope, axis: int) -> float:
        found = self.value(e, scope)
        return measures.edge(found) if is_line(found) else float(found)

    def range(self, e: ast.Range, scope: Scope) -> list[float]:
        start, end = self.value(e.start, scope), self.value(e.end, scope)
        step = 1.0 if e.step is None else self.value(e.step, scope)
        count = (end - start) / step
        last = math.ceil(count - 1e-9) - 1 if e.exclusive else math.floor(count + 1e-9)
        return [start + i * step for i in range(last + 1)]

    def arithmetic(self, operator: str, a: Any, b: Any) -> Any:
        if operator == "+" and type(a) is type(b) and isinstance(a, str | list):
            return a + b
        a, b = plain(a), plain(b)
        found = _ARITHMETIC[operator](a, b)
        are_angles = isinstance(a, Angle) + isinstance(b, Angle)
        is_angle = isinstance(found, float) and (are_angles == 1 or (are_angles == 2 and operator != "/"))
        return Angle(found) if is_angle else found

    def bound(self, variables: tuple[ast.Identifier, ...], item: Any, scope: Scope) -> Scope:
        values = [item] if len(variables) == 1 else items(item)
        return scope.inside(**{v.text: value for v, value in zip(variables, values, strict=True)})

    # --- Names -------------------------------------------------------------------------------------

    def name(self, text: str, scope: Scope) -> Any:
        for here in scope.chain():
            node = self.nodes.get(here.path or "")
            things = {**node.geometry, **node.children, **node.params} if node is not None else {}
            own = {node.name.partition("[")[0]: node, "self": node} if node is not None else {}
            for layer in (here.names, things, own):
                found = named(layer, text)
                if found is not None:
                    return self.forced(found)
        holder = next(s.path for s in scope.chain() if s.path is not None)
        try:
            return measures.field(self.nodes[holder], text)
        except UnknownError:
            if text in ("x", "y"):
                return text
            raise

    def forced(self, found: Any) -> Any:
        if isinstance(found, Waiting):
            return self.value(found.expression, found.scope)
        return float(found) if type(found) is int else found

    def member(self, value: Any, name: str) -> Any:
        """What the document tells, or the body of a structure names."""
        if isinstance(value, Node):
            lets = self.scopes[value.path].names if value.path in self.scopes else {}
            if (found := named(lets, name)) is not None and named(value.params, name) is None:
                return self.forced(found)
        if isinstance(value, dict) and name in value:
            return value[name]
        return measures.field(value, name)

    # --- Calls -------------------------------------------------------------------------------------

    def defined(self, name: str, scope: Scope, values: Any = ()) -> tuple[Any, Scope] | None:
        """What a program defines by a name, or the library where nothing is known here by it; the word itself
        of another word.
        """
        for here in scope.chain():
            found = here.names.get(f"{fold(name)}()")
            other = here.names.get(f"{fold(name)}=")
            if other is not None:
                return self.defined(other, scope, values) or (other, here)
            if found is not None and (
                here.outer is not None or fold(name) not in FUNCTIONS.keys() | RELATIONS
            ):
                nodes = [f.node if isinstance(f, Signature) else f for f in found]
                return next((n for n in nodes if _fits(n, values)), nodes[0]), here
        return None

    def call(self, e: ast.Call, scope: Scope) -> Any:
        positional, given = self.arguments(e, scope)
        own = self.defined(e.callee.text, scope, positional)
        if own is not None and isinstance(own[0], ast.FunctionDefinition):
            return self.value(own[0].value, self.entered(*own, positional, given))
        function = FUNCTIONS.get(fold(own[0] if own and isinstance(own[0], str) else e.callee.text))
        if function is None:
            raise UnknownError(f"no function named {e.callee.text}")
        return function(*positional, **respelled(function, given))

    def arguments(self, e: ast.Call, scope: Scope) -> tuple[list[Any], dict[str, Any]]:
        values = [] if e.receiver is None else [self.value(e.receiver, scope)]
        given: dict[str, Any] = {}
        for a in e.arguments:
            if a.name is not None:
                word = fold(a.name.text)
                is_word = isinstance(a.value, ast.Name) and a.value.text in _WORDS
                is_word = is_word and bool(_WORDED & {word, *PARAMETERS.get(word, ())})
                given[a.name.text] = a.value.span.text if is_word else self.value(a.value, scope)
            elif isinstance(a.value, ast.ForArguments):
                for value in items(self.value(a.value.iterable, scope)):
                    values += self._block(a.value.body, self.bound(a.value.variables, value, scope))
            elif isinstance(a.value, ast.IfArguments):
                taken = a.value.then if self.truth(a.value.test, scope) else a.value.otherwise
                values += [] if taken is None else self._block(taken, scope)
            else:
                values.append(self.value(a.value, scope))
        return values, given

    def _block(self, block: ast.ArgumentBlock, scope: Scope) -> list[Any]:
        inner, found = scope.inside(), list[Any]()
        for item in block.items:
            if isinstance(item, ast.Let):
                inner.names[item.name.text] = self.value(item.value, inner)
            else:
                found.append(self.value(item, inner))
        return found

    def entered(self, definition: Any, home: Scope, positional: list[Any], given: dict[str, Any]) -> Scope:
        """The scope of a call of what a program defines."""
        names = [p.name.text for p in definition.parameters]
        inner = home.inside(**dict(zip(names, positional, strict=False)), **given)
        for p in definition.parameters:
            if p.name.text not in inner.names:
                inner.names[p.name.text] = Waiting(p.default, inner)
        return inner

    # --- Conditions --------------------------------------------------------------------------------

    def truth(self, e: ast.Expression, scope: Scope) -> bool:
        """Whether a condition holds, to a millionth."""
        match e:
            case ast.Binary("or", left, right):
                return self.truth(left, scope) or self.truth(right, scope)
            case ast.Unary("not", operand):
                return not self.truth(operand, scope)
            case ast.Comparison((left, right), ("!=",)):
                return max(compare(self.value(left, scope), "==", self.value(right, scope))) > 1e-6
        return all(r <= 1e-6 for r in self.residuals(e, scope))

    def residuals(self, e: ast.Expression, scope: Scope) -> list[float]:
        """One for each comparison; 0 where it holds."""
        match e:
            case ast.Comparison(operands, operators):
                sides = zip(operands, operators, operands[1:], strict=False)
                return [r for a, o, b in sides for r in self._compared(a, o, b, scope)]
            case ast.Membership(value, ast.Range(low, high)):
                return self._compared(low, "<=", value, scope) + self._compared(value, "<=", high, scope)
            case ast.Membership(value, container):
                now, found = self.value(value, scope), items(self.value(container, scope))
                return [min((max(compare(now, "==", item)) for item in found), default=math.inf)]
            case ast.Binary("and", left, right):
                return self.residuals(left, scope) + self.residuals(right, scope)
            case ast.Conditional(test, then, otherwise):
                return self.residuals(then if self.truth(test, scope) else otherwise, scope)
            case ast.Call():
                return self._stated(e, scope)
            case ast.Name(text):
                for here in scope.chain():
                    if isinstance(waiting := here.names.get(text), Waiting):
                        return self.residuals(waiting.expression, waiting.scope)
        return [0.0 if self.value(e, scope) is True else math.inf]

    def _compared(self, a: ast.Expression, operator: str, b: ast.Expression, scope: Scope) -> list[float]:
        for call, other in ((a, b), (b, a)):  # `angle(a, b) == v` holds in any of its readings
            if operator == "==" and isinstance(call, ast.Call) and fold(call.callee.text) == "angle":
                lines, _ = self.arguments(call, scope)
                if len(lines) == 2 and all(map(is_line, lines)):
                    return [angle_readings(FUNCTIONS["angle"](*lines), self.value(other, scope))]
        return together(lambda: compare(self.value(a, scope), operator, self.value(b, scope)))

    def _stated(self, e: ast.Call, scope: Scope) -> list[float]:
        """A relation of a program, else one of the language, else a condition that a function gives."""
        positional, given = self.arguments(e, scope)
        own = self.defined(e.callee.text, scope, positional)
        if own is not None and isinstance(own[0], ast.ConstraintDefinition):
            inner = self.entered(*own, positional, given)
            return [r for x, s in self.expressions(own[0].body, inner) for r in self.residuals(x, s)]
        if own is not None and isinstance(own[0], ast.FunctionDefinition):
            return self.residuals(own[0].value, self.entered(*own, positional, given))
        relation = RELATIONS.get(fold(own[0] if own and isinstance(own[0], str) else e.callee.text))
        if relation is not None:
            return relation(*positional, **respelled(relation, given))
        found = self.call(e, scope)
        if not isinstance(found, bool):
            raise UnknownError(f"what {e.callee.text} holds is written in the program only")
        return [0.0 if found else math.inf]

    def expressions(self, body: ast.Block, scope: Scope) -> Iterator[tuple[ast.Expression, Scope]]:
        """The constraining expressions of a block, loops and branches taken, each with the names it sees."""
        for item in body.statements:
            match item:
                case ast.ExpressionStatement(value):
                    yield value, scope
                case ast.Equation(left, right):
                    yield ast.Comparison((left, right), ("==",), span=item.span), scope
                case ast.Assign(name, (), value):
                    target = ast.Name(name.text, span=name.span)
                    yield ast.Comparison((target, value), ("==",), span=item.span), scope
                case ast.Constrain(inner):
                    yield from self.expressions(inner, scope)
                case ast.Let(name, value):
                    scope = scope.inside(**{name.text: Waiting(value, scope)})
                case ast.For(variables, iterable, inner):
                    for value in items(self.value(iterable, scope)):
                        yield from self.expressions(inner, self.bound(variables, value, scope))
                case ast.If(test, then, otherwise):
                    branch = then if self.truth(test, scope) else otherwise
                    if branch is not None:
                        yield from self.expressions(branch, scope)


_KINDS: dict[str, Any] = dict.fromkeys(("line", "circle", "arc", "ellipse", "bezier"), Geo) | {
    "text": str,
    "list": list,
    "point": complex,
    "length": float,
    "integer": float,
}
_CURVES = ("line", "circle", "arc", "ellipse", "bezier", "point")


def _fits(definition: Any, values: Any) -> bool:
    """Whether an overload takes as many values, of these kinds."""
    kinds = [fold(p.type.text) if p.type else "" for p in definition.parameters]
    pairs = zip(kinds, values, strict=False)
    return len(values) <= len(kinds) and all(
        v.type == kind if isinstance(v, Geo) and kind in _CURVES else isinstance(v, _KINDS.get(kind, object))
        for kind, v in pairs
    )


def _indexed(found: Any, index: int) -> Any:
    return found[index] if isinstance(found, dict) and index in found else items(found)[index]


def respelled(meaning: Callable[..., Any], given: dict[str, Any]) -> dict[str, Any]:
    """Named arguments by the names that they have here."""
    if not given:
        return {}
    known = {fold(n): n for n in signature(meaning).parameters}
    if "named" in known or "more" in known:
        return given
    found = {known[fold(n)]: v for n, v in given.items() if fold(n) in known}
    for word in (n for n in given if fold(n) not in known):
        free = [known[fold(m)] for m in PARAMETERS.get(fold(word), ()) if fold(m) in known]
        found[next(m for m in free if m not in found)] = given[word]
    return found


_CALLED = (ast.FunctionDefinition, ast.ConstraintDefinition, ast.Structure)


@cache
def _standard() -> Scope:
    """What the library defines."""
    known, top = library.load(), Scope()
    top.names |= {name: Waiting(let.value, top) for name, let in known.constants.items()}
    top.names |= {f"{fold(name)}=": target for name, target in known.aliases.items()}
    for name, overloads in known.callables.items():
        if called := [each for each in overloads if each.kind in _CALLED]:
            top.names.setdefault(f"{fold(name)}()", []).extend(called)
    return top


# --- The walk over a program --------------------------------------------------------------------------


@dataclass(frozen=True)
class Task:
    """A block of constraints or an assertion, in the structure that holds it."""

    path: str
    statement: Any
    scope: Scope


@dataclass
class Program:
    """What a program says of a document's structures."""

    document: dict[str, Any]
    tasks: list[Task] = field(default_factory=list)
    scopes: dict[str, Scope] = field(default_factory=dict)
    views: dict[str, View] = field(default_factory=dict)

    @cached_property
    def root(self) -> Node:
        return read(self.document)

    def view(self, path: str) -> View:
        if path not in self.views:
            self.views[path] = View(self.document, path, self.scopes)
        return self.views[path]

    def read(self, module: ast.Module) -> Program:
        roots = [s for s in module.statements if isinstance(s, ast.Structure) and s.parameters is None]
        others = tuple(s for s in module.statements if s not in roots)
        top = _standard().inside()
        says = ast.Constrain | ast.ExpressionStatement | ast.Assign | ast.For
        if len(roots) != 1 or any(isinstance(s, says) for s in others):
            self._enter(self.root, module.statements, top)
        else:
            self._declare(others, top)
            self._enter(self.root, roots[0].body.statements, top)
        return self

    def _enter(self, node: Node, statements: tuple[ast.Statement, ...], outer: Scope) -> None:
        scope = self.scopes[node.path] = outer.inside(node.path)
        self._block(node, statements, scope)

    def _declare(self, statements: tuple[ast.Statement, ...], scope: Scope) -> None:
        for s in statements:
            match s:
                case ast.Let(name, value):
                    scope.names[name.text] = Waiting(value, scope)
                case ast.Param(name, value) if scope.path is None:  # else the document tells it
                    scope.names[name.text] = Waiting(value, scope)
                case ast.Structure(parameters=None):
                    pass
                case _ if isinstance(s, _CALLED):
                    scope.names.setdefault(f"{fold(s.name.text)}()", []).append(s)
                case ast.Alias(name, target):
                    scope.names[f"{fold(name.text)}="] = target.text

    def _block(self, node: Node, statements: tuple[ast.Statement, ...], scope: Scope) -> None:
        self._declare(statements, scope)
        for s in statements:
            self._statement(node, s, scope)

    def _statement(self, node: Node, s: ast.Statement, scope: Scope) -> None:
        view = self.view(node.path)
        match s:
            case ast.Structure(parameters=None):
                self._enter(node.children[self._key(view, s, scope)], s.body.statements, scope)
            case ast.Assign():
                self._assign(node, s, scope)
            case ast.For(variables, iterable, body):
                for value in items(view.value(iterable, scope)):
                    self._block(node, body.statements, view.bound(variables, value, scope))
            case ast.If(test, then, otherwise):
                branch = then if view.truth(test, scope) else otherwise
                if branch is not None:
                    self._block(node, branch.statements, scope)
            case ast.Constrain() | ast.Assert():
                self.tasks.append(Task(node.path, s, scope))
            case ast.ExpressionStatement(ast.Call(callee)) if fold(callee.text) not in _EDITS:
                self.tasks.append(Task(node.path, ast.Block((s,), span=s.span), scope))
            case ast.ExpressionStatement(value) if not isinstance(value, ast.Call):
                self.tasks.append(Task(node.path, ast.Block((s,), span=s.span), scope))

    def _assign(self, node: Node, s: ast.Assign, scope: Scope) -> None:
        """An instance of a template has constraints of its own; what is neither drawn nor one is a name."""
        view = self.view(node.path)
        key = self._key(view, s, scope)
        child = node.children.get(key)
        if child is None:
            if named({**node.geometry, **node.children}, key) is None:
                scope.names[s.name.text] = Waiting(s.value, scope)
            return
        made = view.defined(s.value.callee.text, scope) if isinstance(s.value, ast.Call) else None
        if made is None or not isinstance(made[0], ast.Structure):
            return
        assert isinstance(s.value, ast.Call)
        given = [(a.name.text if a.name else None, Waiting(a.value, scope)) for a in s.value.arguments]
        words = {n: v for n, v in given if n is not None}
        inner = view.entered(*made, [v for n, v in given if n is None], words)
        self._enter(child, made[0].body.statements, inner)

    def _key(self, view: View, s: Any, scope: Scope) -> str:
        return s.name.text + "".join(f"[{round(view.value(i, scope))}]" for i in s.indices)  # type: ignore[no-any-return]


_EDITS = ("fillet", "chamfer", "move", "translate", "rotate", "scale")
