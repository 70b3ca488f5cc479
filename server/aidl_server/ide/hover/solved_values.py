"""The values of an expression in the solved model, one for each time it was built; in words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import islice

from aidl_lang.building import boxes
from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import spelled_out
from aidl_lang.building.calls import call
from aidl_lang.building.evaluate import evaluate, iterate, turn_scope
from aidl_lang.building.expression import Evaluator, Unknown
from aidl_lang.building.model import Condition, Geometry, Structure, own_geometry
from aidl_lang.building.state import BuildingLimits, Env, Interpreter, LetBinding, Reach, Scope
from aidl_lang.building.statements import EXECUTORS
from aidl_lang.building.values import (
    Array,
    Exactness,
    ListVal,
    Nothing,
    Num,
    PointVal,
    TextVal,
    Value,
    members,
)
from aidl_lang.building.wording import holds
from aidl_lang.checking.types import PRIMITIVES
from aidl_lang.checking.units import ANGLE, AREA, LENGTH, PLAIN, MaybeDimension
from aidl_lang.common.diagnostics import has_errors
from aidl_lang.common.prose import counted, fixed
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.parser import depth_of
from aidl_lang.syntax import ast
from aidl_server.ide.workspace import Solved, View

# --- The values of an expression in the solved model, one for each time it was built.
#
# An expression in a template, a shape or a loop has as many values as there are instances and turns. It is
# read again in the scope that each of these had, and evaluated at the solved values of the unknowns.

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
class SolvedText(Solved):
    """The outcome of a view's own text."""

    view: View

    @cached_property
    def _known(self) -> frozenset[Unknown]:
        return frozenset(self.built.unknowns)

    @cached_property
    def free(self) -> frozenset[str]:
        return frozenset(self.model.mobility().free)

    def values(self, node: ast.Expression, path: Sequence[ast.Node]) -> list[BuiltValue]:
        """Returns the first values of an expression; none with errors. `path` are the nodes around."""
        if depth_of(node) > _DEEPEST:
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
        by_path = {u.path: u for u in ex.unknowns([value.expression])}
        for motion in self.model.ways:
            rates = {by_path[path]: rate for path, rate in motion.moves.items() if path in by_path}
            largest = max(map(abs, motion.moves.values()), default=0.0)
            if rates and largest and self._changes(value, rates, _STEP / largest):
                return True
        return False if len(self.model.ways) == (self.model.degrees or 0) else None

    def _changes(self, value: Num, rates: dict[Unknown, float], step: float) -> bool:
        solved = self.evaluate.values
        ends = []
        for way in (step, -step):
            moved = {u: solved.get(u, u.guess) + way * rate for u, rate in rates.items()}
            ends.append(Evaluator({**solved, **moved}, self.evaluate.measure)(value.expression))
        return abs(ends[0] - ends[1]) > 2 * _UNMOVED * _STEP


def solved_of(view: View) -> SolvedText | None:
    """Returns the solved values of a view; None if its present text was not built and solved."""
    return SolvedText(**vars(view.solved), view=view) if view.solved is not None else None


def _owner(path: Sequence[ast.Node]) -> int | None:
    """Returns the innermost node with a body around the last one; None where nothing has its own values."""
    for number in range(len(path) - 1, -1, -1):
        node = path[number]
        inside = path[number + 1] if number + 1 < len(path) else None
        match node:
            case ast.FunctionDefinition() | ast.ConstraintDefinition() | ast.Comprehension():
                return None
            case ast.ForArguments() | ast.ArgumentBlock():
                return None
            case ast.Structure(parameters=parameters, body=body) if inside in (body, *(parameters or ())):
                return number
            case ast.ShapeDefinition(body=body) if inside is body:
                return number
            case ast.Module():
                return number
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
    return Env(scope, env.here, env.reach)


def spelled(*values: Value) -> list[Value]:
    """Spells out the sides of boxes in values, as one comparison has them."""
    pairs = ((v.x, v.y) if isinstance(v, PointVal) else (v,) for v in values)
    numbers = (n.expression for pair in pairs for n in pair if isinstance(n, Num))
    known = iter(spelled_out(*numbers))

    def made(number: Num) -> Num:
        return Num(next(known), number.dimension, number.status)

    return [
        PointVal(made(v.x), made(v.y)) if isinstance(v, PointVal) else made(v) if isinstance(v, Num) else v
        for v in values
    ]


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


# --- Solved values in words: `radius = 16 mm, kept`.

DECIMALS = 4
_MOST_ITEMS = 4
_TOLERANCE = 1e-6
_UNITS = {LENGTH: " mm", ANGLE: "°", AREA: " mm²"}
_STATES = {
    "fully": "fully constrained",
    "under": "can still move",
    "over": "constrained more than once",
    "contradictory": "its constraints do not hold together",
}


def number_text(value: float, dimension: MaybeDimension) -> str:
    """Returns a number as people write it, with its unit: `112.4 mm`."""
    if not math.isfinite(value):
        return "no number"
    if dimension is None or dimension == PLAIN:
        return fixed(value, DECIMALS)
    return fixed(value, DECIMALS) + _UNITS.get(dimension, f" {dimension}")


def lines(solved: SolvedText, *sides: tuple[str, list[BuiltValue]]) -> list[str]:
    """Returns a line with the value for each instance or turn; for the sides of a comparison, which read the
    boxes in it together, one for each.
    """
    told: list[str] = []
    for row in zip(*(found for _, found in sides), strict=False):
        head = f"{row[0].label}: " if row[0].label else ""
        values = spelled(*(each.value for each in row))
        for (name, _), value, each in zip(sides, values, row, strict=True):
            told += [head + line for line in _lines(solved, name, value, each.env)]
    return told


def _lines(solved: SolvedText, name: str, value: Value, env: Env) -> Iterator[str]:
    value = spelled(value)[0]
    match value:
        case Num() if (number := solved.number(value)) is not None:
            said = (number_text(number, value.dimension), standing(solved, value))
            yield f"{name} = {', '.join(filter(None, said))}"
        case PointVal() if (text := _point(solved, value)) is not None:
            yield f"{name} = {text}" + (f" (in {env.here.name})" if env.here.parent is not None else "")
        case Geometry():
            yield from _geometry(solved, name, value, env)
        case Structure():
            yield from _structure(solved, name, value)
        case TextVal(text):
            yield f'{name} = "{text}"'
        case bool() | Condition():
            yield f"{name} = {str(holds(value, solved.evaluate, _TOLERANCE)).lower()}"
        case _ if (items := items_of(value)) is not None:
            yield f"{name}: {len(items)} members"
            for index, item in items[:_MOST_ITEMS]:
                yield from _lines(solved, f"{name}{index}", item, env)
            if len(items) > _MOST_ITEMS:
                yield "…"


def standing(solved: SolvedText, value: Num) -> str:
    """Returns how far a number may change: `free`, `kept`, `solved`, `exact`; "" if constant or unknown."""
    unknowns = list(ex.unknowns([value.expression]))
    changing = [u for u in unknowns if not u.exact and u in solved.evaluate.values]
    if not changing:
        if value.status is Exactness.PARAM:
            return "exact (param)"
        if value.status >= Exactness.FIXED:
            return "exact"
        return "as written" if unknowns else ""
    if isinstance(value.expression.payload, Unknown):
        return _of_one(solved, changing[0])
    if all(u.kept for u in changing):
        return "kept"
    if not any(u.path in solved.free for u in changing):
        return "solved"
    moves = solved.moves(value)
    return "" if moves is None else "free" if moves else "solved"


def _of_one(solved: SolvedText, unknown: Unknown) -> str:
    if unknown.kept:
        change = next((c for c in reversed(solved.model.changed) if c.path == unknown.path), None)
        return "kept" if change is None else f"had to change from {fixed(change.written, DECIMALS)}"
    return "free" if unknown.path in solved.free else "solved"


def _point(solved: SolvedText, value: PointVal) -> str | None:
    x, y = solved.number(value.x), solved.number(value.y)
    if x is None or y is None:
        return None
    ways = list(dict.fromkeys(standing(solved, n) for n in (value.x, value.y)))
    how = ways[0] if len(ways) == 1 else f"x {ways[0]}, y {ways[1]}" if all(ways) else ""
    return f"({fixed(x, DECIMALS)}, {fixed(y, DECIMALS)})" + (f", {how}" if how else "")


def _geometry(solved: SolvedText, name: str, geometry: Geometry, env: Env) -> Iterator[str]:
    primitive = PRIMITIVES.get(geometry.type)
    for field in primitive.shown if primitive is not None else geometry.arguments:
        value = _field(solved, geometry, field, env)
        if isinstance(value, Num | PointVal):
            yield from _lines(solved, f"{name}.{field}", value, env)
    if geometry.is_compound and (size := _box_size(solved, geometry, env)) is not None:
        yield f"{name}: {size}"


_SUBJECT = "subject"


def _field(solved: SolvedText, geometry: Geometry, field: str, env: Env) -> Value | None:
    at = geometry.span or geometry.owner.span
    assert at is not None
    scope = Scope(env.scope, turn=True)
    scope.values[_SUBJECT] = geometry
    node = ast.Member(ast.Name(_SUBJECT, span=at), ast.Identifier(field, span=at), span=at)
    return solved.read(node, Env(scope, env.here, env.reach))


def _box_size(solved: SolvedText, thing: Geometry, env: Env) -> str | None:
    box = boxes.box_of(thing, env.here)
    sides = [v for side in ("width", "height") if box is not None and (v := box.field(side)) is not None]
    numbers = [solved.number(side) for side in spelled(*sides) if isinstance(side, Num)]
    if len(numbers) != 2 or any(n is None or not math.isfinite(n) for n in numbers):
        return None
    return f"{fixed(numbers[0] or 0.0, DECIMALS)} × {fixed(numbers[1] or 0.0, DECIMALS)} mm"


def _structure(solved: SolvedText, name: str, structure: Structure) -> Iterator[str]:
    found = solved.model.root.find(structure.path)
    if found is None:
        return
    if found.box is not None:
        box = found.box
        size = f"{fixed(box.width, DECIMALS)} × {fixed(box.height, DECIMALS)} mm"
        across = f"x {fixed(box.left, DECIMALS)} … {fixed(box.right, DECIMALS)}"
        up = f"y {fixed(box.bottom, DECIMALS)} … {fixed(box.top, DECIMALS)}"
        yield f"{name}: {found.kind}, {size}, {across}, {up}"
    else:
        yield f"{name}: {found.kind}, nothing drawn"
    count, state = solved.model.mobility().of(found)
    degrees = "" if count is None else f"{counted(count, 'degree')} of freedom"
    said = ", ".join(filter(None, (_STATES.get(state, ""), degrees)))
    if said:
        yield f"{name}: {said}"


def constraint_lines(solved: Solved, span: Span) -> list[str]:
    """Tells how well the constraint at a place holds; for one in a loop, in how many turns."""
    reports = [r for r in solved.model.constraints if r.span == span]
    if not reports:
        return []
    wrong = [abs(r.residual) for r in reports if not r.satisfied]
    is_wish = reports[0].soft
    if not wrong:
        times = f" in all {len(reports)} cases" if len(reports) > 1 else ""
        return [f"{'This wish is fulfilled' if is_wish else 'This constraint holds'}{times}."]
    head = "This wish is not wholly fulfilled" if is_wish else "This constraint does not hold"
    count = f" in {len(wrong)} of {len(reports)} cases" if len(reports) > 1 else ""
    return [f"{head}{count}: it is off by {fixed(max(wrong), DECIMALS)}."]
