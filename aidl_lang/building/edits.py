"""`move`, `rotate` and `scale` as statements: they change what was written of a thing made above them.

They are looked for when the thing is made, further down in its body, and applied to the arguments it is made
with: first guesses and sizes as written change, and how exact they are does not. A shape that cannot be turned
by its arguments is built as it is and turned as a whole.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeVar

from aidl_lang import ast
from aidl_lang import expression as ex
from aidl_lang.binding import select
from aidl_lang.building.arguments import arranged
from aidl_lang.building.blocks import hoist_values
from aidl_lang.building.calls import bound, find_candidates
from aidl_lang.building.coerce import as_written, whole
from aidl_lang.building.copies import centre_of, motion_for
from aidl_lang.building.derive import Copier
from aidl_lang.building.evaluate import evaluate, iterate, truth, turn_scope
from aidl_lang.building.motion import STILL, Motion, Place, after
from aidl_lang.building.scopes import Scope
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.builtins import EDITS
from aidl_lang.model import Geometry, Structure
from aidl_lang.names import fold
from aidl_lang.primitives import DIRECTIONS
from aidl_lang.types import Binding, Given, PointType
from aidl_lang.units import ANGLE, LENGTH, UNITS
from aidl_lang.values import (
    Array,
    Instantiation,
    ListVal,
    Nothing,
    Num,
    Pattern,
    PointVal,
    StructureCopy,
    Value,
    kind_of,
    number,
    type_of,
)

_CLOSE = 1e-9
"""How far two numbers may differ, relative to the size of the shape, and count as one."""

T = TypeVar("T")


@dataclass(frozen=True)
class Edit:
    """One edit and the names it sees."""

    call: ast.Call
    scope: Scope


# --- Finding edits ---------------------------------------------------------------------------------


def is_edit(it: Interpreter, node: ast.Node, scope: Scope) -> bool:
    """Whether a statement's expression is an edit, and not a definition of the program of that name."""
    if not isinstance(node, ast.Call) or _target(node) is None:
        return False
    candidates = find_candidates(it, node.callee.text, scope, None)
    return bool(candidates) and candidates[0].signature.node is None and candidates[0].signature.name in EDITS


def _target(call: ast.Call) -> ast.Expression | None:
    """What a call is about: `a` in `move(a, …)` and in `a.move(…)`."""
    if call.receiver is not None:
        return call.receiver
    named = (a.value for a in call.arguments if a.name is None or fold(a.name.text) == "x")
    return next(named, None)


def _path(node: ast.Expression | None) -> tuple[str, tuple[ast.Expression, ...]] | None:
    """Name and indices of `a[i][j]`."""
    indices: list[ast.Expression] = []
    while isinstance(node, ast.Index):
        indices.insert(0, node.index)
        node = node.value
    return (node.text, tuple(indices)) if isinstance(node, ast.Name) else None


def edits_on(it: Interpreter, name: str, indices: tuple[int, ...], scope: Scope) -> list[Edit]:
    """The edits of a thing that is being made, in text order: those below it in the bodies around it."""
    found: list[Edit] = []
    for ahead in reversed(it.ahead):
        if ahead.scope.declaring() is not scope.declaring():
            break
        if fold(name) in _edited_names(it, ahead.statements):
            found += _among(it, ahead.statements[ahead.next :], ahead.scope, (fold(name), indices))
    return found


def _edited_names(it: Interpreter, statements: Sequence[ast.Statement]) -> frozenset[str]:
    """What calls that stand as statements of a body, its loops and branches are about."""
    if (known := it.edited_names.get(id(statements))) is not None:
        return known
    found: set[str] = set()
    for statement in statements:
        match statement:
            case ast.ExpressionStatement(ast.Call() as call) if (path := _path(_target(call))) is not None:
                found.add(fold(path[0]))
            case ast.For(body=body):
                found |= _edited_names(it, body.statements)
            case ast.If(then=then, otherwise=otherwise):
                found |= _edited_names(it, then.statements)
                found |= _edited_names(it, otherwise.statements) if otherwise else set()
    it.edited_names[id(statements)] = frozenset(found)
    return it.edited_names[id(statements)]


def _among(
    it: Interpreter, statements: Sequence[ast.Statement], scope: Scope, wanted: tuple[str, tuple[int, ...]]
) -> Iterator[Edit]:
    if wanted[0] not in _edited_names(it, statements):
        return
    env = Env(scope, it.ahead[-1].here, Reach.OWN)
    for statement in statements:
        match statement:
            case ast.ExpressionStatement(ast.Call() as call) if _is_on(it, call, env, wanted):
                it.edited.add((call, scope.labels))
                yield Edit(call, scope)
            case ast.For(variables, iterable, body) if wanted[0] in _edited_names(it, body.statements):
                for item in _tried(it, partial(iterate, it, iterable, env)) or ():
                    it.count_turn(statement)
                    turn = turn_scope(it, scope, variables, item, statement)
                    hoist_values(turn, body.statements, env.here)
                    yield from _among(it, body.statements, turn, wanted)
            case ast.If(test, then, otherwise):
                chosen = _tried(it, partial(_chosen, it, test, env))
                taken = then if chosen else otherwise if chosen is not None else None
                if taken is not None:
                    hoist_values(scope, taken.statements, env.here)
                    yield from _among(it, taken.statements, scope, wanted)


def _chosen(it: Interpreter, test: ast.Expression, env: Env) -> bool:
    return truth(it, evaluate(it, test, env), test)


def _is_on(it: Interpreter, call: ast.Call, env: Env, wanted: tuple[str, tuple[int, ...]]) -> bool:
    path = _path(_target(call))
    if path is None or fold(path[0]) != wanted[0] or len(path[1]) != len(wanted[1]):
        return False
    found = _tried(it, lambda: [whole(it, evaluate(it, i, env), i, "an index") for i in path[1]])
    return found == list(wanted[1]) and is_edit(it, call, env.scope)


def _tried(it: Interpreter, action: Callable[[], T]) -> T | None:
    """The result of looking ahead; None if it fails, which is reported when its line is reached."""
    before = len(it.diagnostics)
    result = action()
    if len(it.diagnostics) > before:
        del it.diagnostics[before:]
        return None
    return result


# --- What an edit does -----------------------------------------------------------------------------


def motion_of(it: Interpreter, edits: Sequence[Edit], thing: Value, centre: Place, here: Structure) -> Motion:
    """All edits together, as one motion in numbers; those that fail are reported and change nothing."""
    motion = STILL
    for edit in edits:
        place = motion.place(*centre)
        step = _step(it, edit, thing, lambda place=place: place, here)
        if step is not None:
            motion = after(motion, step)
    return motion


def _step(
    it: Interpreter, edit: Edit, thing: Value, centre: Callable[[], Place], here: Structure
) -> Motion | None:
    node, env = edit.call, Env(edit.scope, here, Reach.OWN)
    nodes = [node.receiver] if node.receiver is not None else []
    nodes += [a.value for a in node.arguments]
    target = _target(node)
    values = [thing if n is target else evaluate(it, n, env) for n in nodes]
    if any(isinstance(v, Nothing) for v in values):
        return None
    names = [None] * (len(nodes) - len(node.arguments))
    names += [a.name.text if a.name else None for a in node.arguments]
    given = [Given(name, type_of(v)) for name, v in zip(names, values, strict=True)]
    candidates = find_candidates(it, node.callee.text, edit.scope, None)
    chosen = select([c.signature for c in candidates], given)
    if isinstance(chosen, list):
        if node not in it.program.rejected:
            it.report("E0311", f"`{node.callee.text}` {chosen[0].reason}", node)
        return None
    values, places = arranged(chosen, values, nodes)
    arguments = bound(it, chosen, values, places, env)
    if arguments is None:
        return None
    arguments = {name: v if name == "x" else as_written(v) for name, v in arguments.items()}
    return motion_for(it, arguments, centre, node)


# --- Geometry --------------------------------------------------------------------------------------


def edited(
    it: Interpreter, node: ast.Assign, value: Value, edits: Sequence[Edit], env: Env
) -> Value:
    """What an assignment makes, with the edits below it applied."""
    match value:
        case Instantiation():
            return value  # its frame is edited, see structures
        case PointVal():
            return _edited_point(it, node.name.text, value, edits, env)
        case Geometry(source=None, name=None):
            return _Editing(it, node, value, edits, env).run()
        case _:
            _refuse(it, edits[0].call, node.name.text, value)
            return value


def _refuse(it: Interpreter, call: ast.Call, name: str, value: Value) -> None:
    word = call.callee.text
    source: Geometry | Structure | Instantiation | None = None
    if isinstance(value, Geometry):
        source = value.source or value
    elif isinstance(value, StructureCopy):
        source = value.source
    if isinstance(value, Pattern):
        it.report(
            "E0330",
            f"`{name}` is a pattern, whose members follow from its centre and pitch",
            call,
            hints=[f"change those, or make a copy: `other = {call.span.one_line}`"],
        )
    elif source is not None:
        named = isinstance(source, Geometry | Structure) and source.name
        _follows(it, call, name, f"`{source.name}`" if named else "what it copies")  # type: ignore[union-attr]
    else:
        it.report(
            "E0333",
            f"`{word}` changes a geometry or a structure, and `{name}` is {kind_of(value)}",
            call,
            hints=["name one thing that is made in this body above the line"],
        )


def _follows(it: Interpreter, call: ast.Call, name: str, source: str) -> None:
    word = call.callee.text
    it.report(
        "E0330",
        f"`{name}` follows from {source}, so `{word}` has nothing to change there",
        call,
        hints=[f"change {source} instead, or make a copy: `other = {call.span.one_line}`"],
    )


def _edited_point(
    it: Interpreter, name: str, at: PointVal, edits: Sequence[Edit], env: Env
) -> Value:
    if (source := _referred(at)) is not None:
        _follows(it, edits[0].call, name, source)
        return at
    return motion_of(it, edits, at, (at.x.expression, at.y.expression), env.here).point(at)


def _referred(value: PointVal | Num) -> str | None:
    """What a number or a point refers to; None where it was written in numbers."""
    numbers = (value.x, value.y) if isinstance(value, PointVal) else (value,)
    found = next(ex.unknowns([n.expression for n in numbers]), None)
    if found is None:
        return None
    path = found.path.partition(".")[2]
    return f"`{path[:-2] if path.endswith(('.x', '.y')) else path}`"


@dataclass
class _Editing:
    """The making of one geometry that is edited. `first` is what the program would make without edits."""

    it: Interpreter
    node: ast.Assign
    first: Geometry
    edits: Sequence[Edit]
    env: Env
    refers: str | None = None

    def run(self) -> Value:
        centre = centre_of(self.it, self.first, self.edits[0].call, self.env)
        written = ex.constant(centre[0].value), ex.constant(centre[1].value)
        motion = motion_of(self.it, self.edits, self.first, written, self.env.here)
        if (made := self._by_arguments(motion)) is not None:
            return made
        if self.refers is not None:
            _follows(self.it, self.edits[0].call, self.node.name.text, self.refers)
            return self.first
        unturned = Motion(written, motion.place(*written), scale=motion.scale)
        if (made := self._by_arguments(unturned)) is not None:
            centre = centre_of(self.it, made, self.edits[0].call, self.env)
            return self._as_whole(made, replace(motion, about=centre, to=centre, scale=ex.ONE))
        away = [ex.sub(b, a) for a, b in zip(written, motion.place(*written), strict=True)]
        to = ex.add(centre[0], away[0]), ex.add(centre[1], away[1])
        return self._as_whole(self.first, replace(motion, about=centre, to=to))

    def _as_whole(self, made: Geometry, motion: Motion) -> Geometry:
        """A shape that its arguments cannot turn: everything in it turns."""
        made.known_as = None
        turned = Copier(self.it, self.env.here, motion, span=made.span).geometry(made)
        turned.source = None  # it stands in the place of what was written, and is no copy to the author
        return turned

    def _by_arguments(self, motion: Motion) -> Geometry | None:
        """The same call with its arguments moved; None when that does not move the shape."""
        it = self.it
        calls = [c for c in (self.node.value, *_branches(self.node.value)) if isinstance(c, ast.Call)]
        before, hidden, said = dict(it.edits), len(it.hidden), len(it.diagnostics)
        it.edits |= dict.fromkeys(calls, lambda binding, given: self._moved(binding, given, motion))
        try:
            made = evaluate(it, self.node.value, self.env)
        finally:
            it.edits = before
        meant = Copier(it, self.env.here, motion).geometry(self.first)
        if isinstance(made, Geometry) and self.refers is None and _are_alike(made, meant, self.env):
            return made
        del it.diagnostics[said:]
        del it.hidden[hidden:]
        return None

    def _moved(self, binding: Binding, given: dict[str, Value], motion: Motion) -> dict[str, Value]:
        given = dict(given)
        for name, default in _defaults(binding):
            given.setdefault(name, default)
        return {name: self._argument(name, value, motion) for name, value in given.items()}

    def _argument(self, name: str, value: Value, motion: Motion) -> Value:
        match value:
            case PointVal():
                self._refuse(value)
                return motion.point(value)
            case ListVal(items):
                return ListVal(tuple(self._argument(name, item, motion) for item in items))
            case Num() if name in DIRECTIONS:
                if motion.turn.value % 360.0 != 0.0:
                    self._refuse(value)
                return replace(value, expression=motion.direction(value.expression))
            case Num():
                if motion.scale.value != 1.0:
                    self._refuse(value)
                return replace(value, expression=motion.measure(value.expression, value.dimension))
            case _:
                return value


    def _refuse(self, value: PointVal | Num) -> None:
        self.refers = self.refers or _referred(value)


def _branches(node: ast.Expression) -> tuple[ast.Expression, ...]:
    return (node.then, node.otherwise) if isinstance(node, ast.Conditional) else ()


def _defaults(binding: Binding) -> Iterator[tuple[str, Value]]:
    """Positions and directions that are left out, by what stands for them."""
    definition = binding.signature.node
    if definition is None:
        for name, kind, optional in binding.signature.parameters:
            if optional and isinstance(kind, PointType):
                yield name, _at(0.0, 0.0)
            elif optional and name in DIRECTIONS:
                yield name, number(0.0, ANGLE)
        return
    for parameter in definition.parameters or ():
        match parameter.default:
            case ast.Point(ast.Number() as x, ast.Number() as y):
                yield parameter.name.text, _at(x.value, y.value)
            case ast.Number(value, unit) if parameter.name.text in DIRECTIONS:
                yield parameter.name.text, number(value * (UNITS[unit][0] if unit else 1.0), ANGLE)


def _at(x: float, y: float) -> PointVal:
    return PointVal(number(x, LENGTH), number(y, LENGTH))


def _are_alike(a: Geometry, b: Geometry, env: Env) -> bool:
    """Whether two geometries draw the same curves as written."""
    one, other = list(a.primitives()) or [a], list(b.primitives()) or [b]
    return len(one) == len(other) and all(map(_is_same, one, other))


def _is_same(a: Geometry, b: Geometry) -> bool:
    if a.type != b.type or a.clockwise != b.clockwise:
        return False
    pairs = [(n, v, b.fields[n]) for n, v in a.fields.items() if n in b.fields]
    size = max([1.0, *(abs(x) for _, v, _ in pairs for x in _values(v))])
    for name, v, w in pairs:
        for x, y in zip(_values(v), _values(w), strict=True):
            away = (x - y + 180.0) % 360.0 - 180.0 if name in DIRECTIONS else x - y
            if not abs(away) <= _CLOSE * size:
                return False
    return True


def _values(value: Value) -> tuple[float, ...]:
    match value:
        case PointVal(x, y):
            return x.value, y.value
        case Num():
            return (value.value,)
        case _:
            return ()


# --- Structures ------------------------------------------------------------------------------------


def frame_edited(
    it: Interpreter, edits: Sequence[Edit], s: Structure, at: PointVal, turn: Num | None
) -> tuple[PointVal, Num | None]:
    """Where a structure is placed, with the edits below it applied."""
    assert s.parent is not None
    motion = motion_of(it, edits, s, (at.x.expression, at.y.expression), s.parent)
    if motion.scale.value != 1.0:
        it.report(
            "E0334",
            f"`{s.name}` is a structure, and its contents have the sizes that are written in it",
            edits[0].call,
            hints=[f"make a copy of another size: `{s.name}_2 = copy({s.name}, scale: …, at: …)`"],
        )
        return at, turn
    source = _referred(at)
    if source is not None:
        _follows(it, edits[0].call, s.name, source)
        return at, turn
    moved = motion.point(at)
    if motion.turn.value % 360.0 == 0.0:
        return moved, turn
    written = turn or number(0.0, ANGLE)
    return moved, replace(written, expression=ex.add(written.expression, motion.turn))


# --- The statement itself --------------------------------------------------------------------------


def check_edit(it: Interpreter, call: ast.Call, env: Env) -> None:
    """An edit that nothing was made with is an error."""
    if (call, env.scope.labels) in it.edited or call in it.watched or call in it.program.rejected:
        return
    target = _target(call)
    assert target is not None
    value = evaluate(it, target, env)
    if isinstance(value, Nothing):
        return
    shown, word = target.span.one_line, call.callee.text
    if isinstance(target, ast.Member):
        why, hint = f"`{shown}` is part of another thing", f"`{word}` that as a whole, where it is made"
    elif isinstance(value, Array | ListVal):
        why, hint = f"`{shown}` has members", f"`{word}` them one by one, as in `for i in … {{ {word}({shown}[i], …) }}`"
    else:
        why, hint = (
            f"`{shown}` is not made in this body above this line",
            f"write it below the line that makes `{shown}`, in the same structure",
        )
    it.report("E0333", f"`{word}` changes nothing here: {why}", call, hints=[hint])
