"""`move`, `rotate` and `scale` as statements: they change a thing made above them.

They are looked for when the thing is made, further down in its body, and applied to its arguments: first
guesses and sizes as written change, their exactness does not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import TypeAlias, TypeVar

from aidl_lang.building import expression as ex
from aidl_lang.building.calls import arranged, bound
from aidl_lang.building.coerce import as_written, whole
from aidl_lang.building.copies import Copier, centre_of, motion_for
from aidl_lang.building.curves import DIRECTIONS, STILL, Motion, after, turned, xy
from aidl_lang.building.evaluate import chosen, evaluate, hoist_values, turns
from aidl_lang.building.expression import Place
from aidl_lang.building.model import Geometry, Structure
from aidl_lang.building.state import Env, Interpreter, Scope
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
    kind_of,
    number,
    numbers_of,
    type_of,
)
from aidl_lang.checking.binding import select
from aidl_lang.checking.builtins import EDITS
from aidl_lang.checking.rules import blocks
from aidl_lang.checking.types import Binding, PointType, given_to
from aidl_lang.checking.units import ANGLE, LENGTH, UNITS
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

T = TypeVar("T")


@record()
class EditCall:
    """One edit, the names it sees, and the indices of the thing it changes."""

    call: ast.Call
    scope: Scope
    indices: tuple[int, ...]


Edits: TypeAlias = Sequence[EditCall]


def is_edit(it: Interpreter, node: ast.Node, scope: Scope) -> bool:
    """Tells whether a statement's expression is an edit, and not a definition of the program of that name."""
    if not isinstance(node, ast.Call) or _target(node) is None:
        return False
    candidates = scope.candidates(it.spelled(node.callee))
    return bool(candidates) and candidates[0].signature.kind is None and candidates[0].signature.name in EDITS


def _target(call: ast.Call) -> ast.Expression | None:
    if call.receiver is not None:
        return call.receiver
    named = (a.value for a in call.arguments if a.name is None or fold(a.name.text) == "x")
    return next(named, None)


def _path(it: Interpreter, node: ast.Expression | None) -> tuple[str, tuple[ast.Expression, ...]] | None:
    """Returns name and indices of `a[i][j]`; None for other expressions."""
    indices: list[ast.Expression] = []
    while isinstance(node, ast.Index):
        indices.insert(0, node.index)
        node = node.value
    return (it.spelled(node), tuple(indices)) if isinstance(node, ast.Name) else None


def edits_on(it: Interpreter, name: str, indices: tuple[int, ...], scope: Scope) -> list[EditCall]:
    """Returns the edits of a thing being made, in text order: those below it in the bodies around it."""
    found: list[EditCall] = []
    for ahead in reversed(it.ahead):
        if ahead.env.scope.declaring() is not scope.declaring():
            break
        if name in _edited_names(it, ahead.statements):
            found += _among(it, ahead.statements[ahead.next :], ahead.env, (name, indices))
    return found


def _edited_names(it: Interpreter, statements: Sequence[ast.Statement]) -> frozenset[str]:
    """Returns the targets of calls that are statements of a body, its loops and branches."""
    if (known := it.edited_names.get(id(statements))) is not None:
        return known
    found: set[str] = set()
    for statement in statements:
        match statement:
            case ast.ExpressionStatement(ast.Call() as call) if (
                path := _path(it, _target(call))
            ) is not None:
                found.add(path[0])
            case ast.For() | ast.If():
                found |= {name for block in blocks(statement) for name in _edited_names(it, block.statements)}
    it.edited_names[id(statements)] = frozenset(found)
    return it.edited_names[id(statements)]


def _among(
    it: Interpreter, statements: Sequence[ast.Statement], env: Env, wanted: tuple[str, tuple[int, ...]]
) -> Iterator[EditCall]:
    if wanted[0] not in _edited_names(it, statements):
        return
    for statement in statements:
        match statement:
            case ast.ExpressionStatement(ast.Call() as call) if _is_on(it, call, env, wanted):
                it.edited.add((call, env.scope.labels))
                yield EditCall(call, env.scope, wanted[1])
            case ast.For(body=body) if wanted[0] in _edited_names(it, body.statements):
                for turn in _tried(it, partial(turns, it, statement, env)) or ():
                    hoist_values(turn, body.statements)
                    yield from _among(it, body.statements, turn, wanted)
            case ast.If():
                if (taken := _tried(it, partial(chosen, it, statement, env))) is not None:
                    hoist_values(env, taken.statements)
                    yield from _among(it, taken.statements, env, wanted)


def _is_on(it: Interpreter, call: ast.Call, env: Env, wanted: tuple[str, tuple[int, ...]]) -> bool:
    path = _path(it, _target(call))
    if path is None or path[0] != wanted[0] or len(path[1]) != len(wanted[1]):
        return False
    found = _tried(it, lambda: [whole(it, evaluate(it, i, env), i, "an index") for i in path[1]])
    return found == list(wanted[1]) and is_edit(it, call, env.scope)


def _tried(it: Interpreter, action: Callable[[], T]) -> T | None:
    """Returns the result of looking ahead; None if it fails, which is reported when its line is reached."""
    before = len(it.diagnostics)
    result = action()
    if len(it.diagnostics) > before:
        del it.diagnostics[before:]
        return None
    return result


def motion_of(
    it: Interpreter, edits: Edits, thing: Value, centre: Place, here: Structure, placed: Motion = STILL
) -> Motion:
    """Returns all edits as one motion after that of `at`; one that fails is reported and changes nothing."""
    motion = placed
    for edit in edits:
        place = motion.place(centre)
        now = thing
        if motion is not STILL and isinstance(thing, Geometry):
            now = Copier(it, here, motion).geometry(thing)
        if (step := _step(it, edit, now, place, here)) is not None:
            motion = after(motion, step)
    return motion


def _step(it: Interpreter, edit: EditCall, thing: Value, centre: Place, here: Structure) -> Motion | None:
    node, env = edit.call, Env(_seeing(it, edit, thing), here)
    nodes = [node.receiver] if node.receiver is not None else []
    nodes += [a.value for a in node.arguments]
    target = _target(node)
    if isinstance(thing, Structure) and _mentions(nodes, target, thing.name):
        message = f"`{node.callee.text}` needs a point of `{thing.name}` before that is made"
        hint = "write the point in numbers, or leave `about` out: a structure turns about its origin"
        it.report("E0333", message, node, hints=[hint])
        return None
    values = [thing if n is target else evaluate(it, n, env) for n in nodes]
    if any(isinstance(v, Nothing) for v in values):
        return None
    given = given_to(node, [type_of(v) for v in values])
    candidates = edit.scope.candidates(it.spelled(node.callee))
    chosen = select([c.signature for c in candidates], given)
    if isinstance(chosen, list):
        if node not in it.program.rejected:
            it.report("E0311", f"`{node.callee.text}` {chosen[0].reason}", node)
        return None
    taken, places = arranged(chosen, values, nodes)
    if (arguments := bound(it, chosen, taken, places, env)) is None:
        return None
    arguments = {name: v if name == "x" else as_written(v) for name, v in arguments.items()}
    return motion_for(it, arguments, lambda: centre, node)


def _mentions(nodes: Sequence[ast.Expression], target: ast.Node | None, name: str) -> bool:
    others = (part for n in nodes if n is not target for part in ast.walk(n))
    return any(isinstance(n, ast.Name) and fold(n.text) == fold(name.partition("[")[0]) for n in others)


def _seeing(it: Interpreter, edit: EditCall, thing: Value) -> Scope:
    """Returns the scope of an edit's arguments: the thing's name means it as earlier edits have left it."""
    path = _path(it, _target(edit.call))
    assert path is not None
    scope = Scope(edit.scope, edit.scope.container, turn=True, labels=edit.scope.labels)
    if not isinstance(thing, Geometry | PointVal):
        return scope
    scope.values[path[0]] = thing
    if edit.indices:
        found = edit.scope.find(path[0])
        known = found.values[path[0]] if found is not None else None
        scope.values[path[0]] = array = Array(path[0])
        array.members = dict(known.members) if isinstance(known, Array) else {}
        array.members[edit.indices] = thing
    return scope


def follows(it: Interpreter, cause: ast.Node, name: str, source: str) -> None:
    word, other = _asked(cause, name)
    message = f"`{name}` follows from {source}, so `{word}` has nothing to change there"
    it.report("E0330", message, cause, hints=[f"change {source} instead, or make a copy: `other = {other}`"])


def _asked(cause: ast.Node, name: str) -> tuple[str, str]:
    """Returns the word of an edit or a placement, and the text of a copy of its target that is moved so."""
    if isinstance(cause, ast.Call):
        return cause.callee.text, cause.span.one_line
    assert isinstance(cause, ast.Placement)
    if cause.at is None:
        return "rotated", f"copy({name}, angle: …)"
    return "at", f"copy({name}, by: {cause.at.span.one_line})"


def refuse(it: Interpreter, cause: ast.Node, name: str, value: Value) -> None:
    """Reports an edit of a thing with nothing of its own to change."""
    word, other = _asked(cause, name)
    source: Geometry | Structure | Instantiation | None = None
    if isinstance(value, Structure | StructureCopy):
        source = value.source
    elif isinstance(value, Geometry):
        source = value.recipe.sources[0] if value.recipe is not None else value.source or value
    if isinstance(value, Pattern):
        message = f"`{name}` follows from a pattern: its members have no place of their own"
        hint = f"change its centre, its pitch or its radius, or make a copy: `other = {other}`"
        it.report("E0330", message, cause, hints=[hint])
    elif source is not None:
        named = isinstance(source, Geometry | Structure) and source.name
        follows(it, cause, name, f"`{source.name}`" if named else "what it copies")  # type: ignore[union-attr]
    else:
        message = f"`{word}` changes a geometry or a structure, and `{name}` is {kind_of(value)}"
        it.report("E0333", message, cause, hints=["name one thing that is made in this body above the line"])


def referred(value: PointVal | Num) -> str | None:
    """Returns what a number or a point refers to; None if it was written in numbers."""
    found = next(ex.unknowns([n.expression for n in numbers_of(value)]), None)
    if found is None:
        return None
    path = found.path.partition(".")[2]
    return f"`{path[:-2] if path.endswith(('.x', '.y')) else path}`"


def frame_edited(
    it: Interpreter, edits: Edits, s: Structure, at: PointVal, turn: Num | None
) -> tuple[PointVal, Num | None]:
    """Returns the place of a structure, with the edits below it applied."""
    assert s.parent is not None
    motion = motion_of(it, edits, s, xy(at), s.parent)
    if motion.scale.value != 1.0:
        message = f"`{s.name}` is a structure, and its contents have the sizes that are written in it"
        hint = f"make a copy of another size: `{s.name}_2 = copy({s.name}, scale: …, at: …)`"
        it.report("E0334", message, edits[0].call, hints=[hint])
        return at, turn
    if (source := referred(at)) is not None:
        follows(it, edits[0].call, s.name, source)
        return at, turn
    moved = motion.point(at)
    if motion.turn.value % 360.0 == 0.0:
        return moved, turn
    written = turn or number(0.0, ANGLE)
    return moved, replace(written, expression=written.expression + motion.turn)


def check_edit(it: Interpreter, call: ast.Call, env: Env) -> None:
    """Reports an edit that nothing was made with."""
    if (call, env.scope.labels) in it.edited or call in it.watched or call in it.program.rejected:
        return
    target = _target(call)
    assert target is not None
    is_below = isinstance(target, ast.Name) and env.scope.find(it.spelled(target)) is None
    value = NOTHING if is_below else evaluate(it, target, env)
    if isinstance(value, Nothing) and not is_below:
        return
    shown, word = target.span.one_line, call.callee.text
    of = evaluate(it, target.value, env) if isinstance(target, ast.Index) else None
    if isinstance(of, Pattern) or (isinstance(value, Geometry | Structure) and value.source is not None):
        refuse(it, call, shown, of if isinstance(of, Pattern) else value)
        return
    if isinstance(target, ast.Member):
        why, hint = f"`{shown}` is part of another thing", f"`{word}` that as a whole, where it is made"
    elif isinstance(value, Array | ListVal):
        why = f"`{shown}` has members"
        hint = f"`{word}` them one by one, as in `for i in … {{ {word}({shown}[i], …) }}`"
    else:
        why = f"`{shown}` is not made in this body above this line"
        hint = f"write it below the line that makes `{shown}`, in the same structure"
    it.report("E0333", f"`{word}` changes nothing here: {why}", call, hints=[hint])


# --- The making of geometry that is edited: with other arguments, or else turned as a whole.

_CLOSE = 1e-9  # the part of the size of the shape by which two numbers may differ and count as one


@record()
class GeometryPlacement:
    """The place that `at` and `rotated` give a geometry, and how exact it is."""

    at: PointVal
    turn: Num | None

    @property
    def motion(self) -> Motion:
        return turned(self.turn.expression if self.turn is not None else ex.ZERO, to=xy(self.at))

    def point(self, p: PointVal) -> PointVal:
        """Returns a point as exact as its placement."""
        return PointVal(self._as_exact(p.x, self.at.x), self._as_exact(p.y, self.at.y))

    def direction(self, angle: Num) -> Num:
        if self.turn is None:
            return angle
        if self.turn.status is Exactness.GUESS:
            return replace(angle, status=Exactness.GUESS)
        return self._as_exact(angle, self.turn)

    @staticmethod
    def _as_exact(n: Num, by: Num) -> Num:
        return replace(n, status=by.status) if by.status >= max(n.status, Exactness.FIXED) else n


def edited(
    it: Interpreter,
    node: ast.Assign,
    value: Value,
    edits: Edits,
    env: Env,
    placed: GeometryPlacement | None = None,
) -> Value:
    """Returns the value of an assignment, placed by `at` and with the edits below it applied."""
    cause = edits[0].call if edits else node.placement
    if cause is None or (not edits and placed is None):
        return value
    match value:
        case PointVal():
            if (source := referred(value)) is not None:
                follows(it, cause, node.name.text, source)
                return value
            start = placed.motion if placed is not None else STILL
            moved = motion_of(it, edits, value, xy(value), env.here, start).point(value)
            return placed.point(moved) if placed is not None else moved
        case Geometry(source=None, recipe=None, name=None):
            return _Editing(it, node, value, edits, env, cause, placed).run()
        case _:
            refuse(it, cause, node.name.text, value)
            return value


@record(frozen=False)
class _Editing:
    """The making of a placed or edited geometry; `first` is its value without that, `cause` what asks."""

    it: Interpreter
    node: ast.Assign
    first: Geometry
    edits: Edits
    env: Env
    cause: ast.Node
    placed: GeometryPlacement | None = None
    refers: str | None = None

    def run(self) -> Value:
        centre = centre_of(self.it, self.first, self.cause, self.env)
        written = Place(*map(ex.constant, centre.written))
        start = self.placed.motion if self.placed is not None else STILL
        motion = motion_of(self.it, self.edits, self.first, written, self.env.here, start)
        if (made := self._by_arguments(motion)) is not None:
            return made
        if self.refers is not None:
            follows(self.it, self.cause, self.node.name.text, self.refers)
            return self.first
        unturned = Motion(written, motion.place(written), scale=motion.scale)
        if (made := self._by_arguments(unturned)) is not None:
            centre = centre_of(self.it, made, self.cause, self.env)
            return self._as_whole(made, replace(motion, about=centre, to=centre, scale=ex.ONE))
        to = centre + (motion.place(written) - written)
        return self._as_whole(self.first, replace(motion, about=centre, to=to))

    def _as_whole(self, made: Geometry, motion: Motion) -> Geometry:
        """Turns everything in a shape that its arguments cannot turn."""
        made.known_as = None
        asked = self.placed.turn if self.placed is not None else None
        if asked is not None and asked.status is Exactness.GUESS:
            turn = self.it.unknown(motion.turn.value, made, "rotation", dimension=ANGLE)
            motion = replace(motion, turn=turn, facing=ex.towards(turn))
        turned = Copier(self.it, self.env.here, motion, span=made.span).geometry(made)
        turned.source = None  # to the author it is what was written, and no copy
        return turned

    def _by_arguments(self, motion: Motion) -> Geometry | None:
        """Returns the same call's result with its arguments moved; None if that does not move the shape."""
        it = self.it
        value = self.node.value
        branches = (value.then, value.otherwise) if isinstance(value, ast.Conditional) else (value,)
        calls = [branch for branch in branches if isinstance(branch, ast.Call)]
        before, hidden, said = dict(it.edits), len(it.hidden), len(it.diagnostics)
        it.edits |= dict.fromkeys(calls, lambda binding, given: self._moved(binding, given, motion))
        try:
            made = evaluate(it, self.node.value, self.env)
        finally:
            it.edits = before
        meant = Copier(it, self.env.here, motion).geometry(self.first)
        if isinstance(made, Geometry) and self.refers is None and _are_alike(made, meant):
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
                moved = motion.point(value)
                return self.placed.point(moved) if self.placed is not None else moved
            case ListVal(items):
                return ListVal(tuple(self._argument(name, item, motion) for item in items))
            case Num() if name in DIRECTIONS:
                if motion.turn.value % 360.0 != 0.0:
                    self._refuse(value)
                seen = replace(value, expression=motion.direction(value.expression))
                return self.placed.direction(seen) if self.placed is not None else seen
            case Num():
                if motion.scale.value != 1.0:
                    self._refuse(value)
                return replace(value, expression=motion.measure(value.expression, value.dimension))
            case _:
                return value

    def _refuse(self, value: PointVal | Num) -> None:
        self.refers = self.refers or referred(value)


def _defaults(binding: Binding) -> Iterator[tuple[str, Value]]:
    """Yields the omitted positions and directions of a call with their defaults."""
    if (definition := binding.signature.node) is None:
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


def _are_alike(a: Geometry, b: Geometry) -> bool:
    one, other = list(a.primitives()) or [a], list(b.primitives()) or [b]
    return len(one) == len(other) and all(map(_is_same, one, other))


def _is_same(a: Geometry, b: Geometry) -> bool:
    if a.type != b.type or a.clockwise != b.clockwise:
        return False
    pairs = [(n, v, b.fields[n]) for n, v in a.fields.items() if n in b.fields]
    size = max([1.0, *(abs(x.value) for _, v, _ in pairs for x in numbers_of(v))])
    for name, v, w in pairs:
        for x, y in zip(numbers_of(v), numbers_of(w), strict=True):
            away = x.value - y.value
            if name in DIRECTIONS:
                away = (away + 180.0) % 360.0 - 180.0
            if not abs(away) <= _CLOSE * size:
                return False
    return True
