"""The making of geometry that is edited: with other arguments, or else turned as a whole."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from aidl_lang.building import expression as ex
from aidl_lang.building.copies import centre_of
from aidl_lang.building.derive import Copier
from aidl_lang.building.edits import EditCall, follows, motion_of, referred, refuse
from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.model import Geometry
from aidl_lang.building.motion import STILL, Motion, turned
from aidl_lang.building.primitives import DIRECTIONS, xy
from aidl_lang.building.state import Env, Interpreter
from aidl_lang.building.values import Exactness, ListVal, Num, PointVal, Value, number
from aidl_lang.checking.types import Binding, PointType
from aidl_lang.checking.units import ANGLE, LENGTH, UNITS
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

_CLOSE = 1e-9
"""The part of the size of the shape by which two numbers may differ and count as one."""


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
    edits: Sequence[EditCall],
    env: Env,
    placed: GeometryPlacement | None = None,
) -> Value:
    """Returns the value of an assignment, placed by `at` and with the edits below it applied."""
    cause = edits[0].call if edits else node.placement
    if cause is None or (not edits and placed is None):
        return value
    match value:
        case PointVal():
            return _edited_point(it, node.name.text, value, edits, env, cause, placed)
        case Geometry(source=None, recipe=None, name=None):
            return _Editing(it, node, value, edits, env, cause, placed).run()
        case _:
            refuse(it, cause, node.name.text, value)
            return value


def _edited_point(
    it: Interpreter,
    name: str,
    at: PointVal,
    edits: Sequence[EditCall],
    env: Env,
    cause: ast.Node,
    placed: GeometryPlacement | None,
) -> Value:
    if (source := referred(at)) is not None:
        follows(it, cause, name, source)
        return at
    motion = placed.motion if placed is not None else STILL
    moved = motion_of(it, edits, at, (at.x.expression, at.y.expression), env.here, motion).point(at)
    return placed.point(moved) if placed is not None else moved


@record(frozen=False)
class _Editing:
    """The making of one geometry that is placed or edited: `first` is its value without that, `cause` the
    node that asks for it.
    """

    it: Interpreter
    node: ast.Assign
    first: Geometry
    edits: Sequence[EditCall]
    env: Env
    cause: ast.Node
    placed: GeometryPlacement | None = None
    refers: str | None = None

    def run(self) -> Value:
        centre = centre_of(self.it, self.first, self.cause, self.env)
        written = ex.constant(centre[0].value), ex.constant(centre[1].value)
        start = self.placed.motion if self.placed is not None else STILL
        motion = motion_of(self.it, self.edits, self.first, written, self.env.here, start)
        if (made := self._by_arguments(motion)) is not None:
            return made
        if self.refers is not None:
            follows(self.it, self.cause, self.node.name.text, self.refers)
            return self.first
        unturned = Motion(written, motion.place(*written), scale=motion.scale)
        if (made := self._by_arguments(unturned)) is not None:
            centre = centre_of(self.it, made, self.cause, self.env)
            return self._as_whole(made, replace(motion, about=centre, to=centre, scale=ex.ONE))
        away = [ex.sub(b, a) for a, b in zip(written, motion.place(*written), strict=True)]
        to = ex.add(centre[0], away[0]), ex.add(centre[1], away[1])
        return self._as_whole(self.first, replace(motion, about=centre, to=to))

    def _as_whole(self, made: Geometry, motion: Motion) -> Geometry:
        """Turns everything in a shape that its arguments cannot turn."""
        made.known_as = None
        asked = self.placed.turn if self.placed is not None else None
        if asked is not None and asked.status is Exactness.GUESS:
            turn = self.it.unknown(motion.turn.value, made, "rotation", owner=made.owner, dimension=ANGLE)
            motion = replace(motion, turn=turn, cos=ex.cos(turn), sin=ex.sin(turn))
        turned = Copier(self.it, self.env.here, motion, span=made.span).geometry(made)
        turned.source = None  # to the author it is what was written, and no copy
        return turned

    def _by_arguments(self, motion: Motion) -> Geometry | None:
        """Returns the same call's result with its arguments moved; None if that does not move the shape."""
        it = self.it
        value = self.node.value
        parts = (value, value.then, value.otherwise) if isinstance(value, ast.Conditional) else (value,)
        calls = [c for c in parts if isinstance(c, ast.Call)]
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
