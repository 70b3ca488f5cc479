"""The step from what an author states (constraints, preferences, assertions, dimensions) to the model."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import SIDES, Box, foreseen, unmoved, with_measured
from aidl_lang.building.coerce import as_point, numeric
from aidl_lang.building.curves import ask_to_turn, defining
from aidl_lang.building.evaluate import evaluate, stated
from aidl_lang.building.measured import FORMULAS, OTHERWISE, formula
from aidl_lang.building.model import (
    Assertion,
    Comparison,
    Condition,
    Constraint,
    Geometry,
    Measurement,
    Structure,
)
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.building.values import (
    Array,
    ListVal,
    Nothing,
    Num,
    PointVal,
    TextVal,
    Value,
    kind_of,
    members,
    number,
    numbers_of,
    type_of,
)
from aidl_lang.building.wording import (
    EXACT,
    RELATIONS,
    Wording,
    all_of,
    compare_numbers,
    compared,
    differences,
    givens,
    rounding,
    sides,
    value_unknowns,
)
from aidl_lang.checking import rules
from aidl_lang.checking.rules import shown
from aidl_lang.checking.units import LENGTH
from aidl_lang.common.materials import is_fit
from aidl_lang.common.names import fold
from aidl_lang.syntax import ast

# --- Dimensions that the program asks for: `dimension(a, b, offset: 8)`.

NAME = "dimension"
OPTIONS = ("offset", "tolerance", "fit")
LEVEL = frozenset({"left", "right", "center_x", "x"})
UPRIGHT = frozenset({"bottom", "top", "center_y", "y"})

_MEASURED_ALONE = frozenset({"line", "circle", "arc"})


def is_by_hand(it: Interpreter, node: ast.Call) -> bool:
    """Tells whether a call is that of the library's `dimension`."""
    candidates = it.program.resolution.candidates.get(node, ())
    return it.spelled(node.callee) == NAME and all(candidate.standard for candidate in candidates)


def measured(node: ast.Call) -> list[ast.Expression]:
    """Returns the things that a dimension measures, as they are written."""
    receiver = [node.receiver] if node.receiver is not None else []
    return [*receiver, *(a.value for a in node.arguments if a.name is None or a.name.text not in OPTIONS)]


def options(node: ast.Call) -> dict[str, ast.Expression]:
    return {a.name.text: a.value for a in node.arguments if a.name is not None and a.name.text in OPTIONS}


def record_dimension(it: Interpreter, node: ast.Call, env: Env) -> None:
    """Notes a dimension for the drawing; reports one that measures nothing."""
    if isinstance(evaluate(it, node, env), Nothing):
        return
    things = measured(node)
    values = [evaluate(it, thing, env) for thing in things]
    if reason := next(_reasons(things, values), ""):
        hint = "as in `dimension(body.left, eye.center)`, `dimension(a.x, b.x)` or `dimension(rim)`"
        it.report("E0590", f"this dimension measures nothing: {reason}", node, hints=[hint])
        return
    said = {name: evaluate(it, value, env) for name, value in options(node).items()}
    fit, tolerance = said.get("fit"), said.get("tolerance")
    if isinstance(fit, TextVal) and fit.value and not is_fit(fit.value):
        hint = "holes are H6 to H11, F7, G7, K7, N7, P7 …; shafts h6 to h11, f7, g6, k6, n6, p6 …"
        it.report("E0590", f"there is no fit `{fit.value}`", options(node)["fit"], hints=[hint])
    elif isinstance(tolerance, Num) and not tolerance.value >= 0:
        hint = "`tolerance: 0.1` is written as ±0.1"
        it.report("E0590", "a tolerance is above 0", options(node)["tolerance"], hints=[hint])
    else:
        it.by_hand.append(_constraint(Wording(node, it, env), ()))


def axis_of(node: ast.Expression, value: Value) -> int | None:
    """Returns the axis along which something is a coordinate; None for a place in the plane."""
    if isinstance(value, Num) and isinstance(node, ast.Member):
        name = fold(node.name.text)
        return next((k for k, names in enumerate((LEVEL, UPRIGHT)) if name in set(map(fold, names))), None)
    return None


def _reasons(things: list[ast.Expression], values: list[Value]) -> Iterator[str]:
    for thing, value in zip(things, values, strict=True):
        is_coordinate = axis_of(thing, value) is not None
        if not is_coordinate and not isinstance(value, PointVal | Geometry | Structure | Box):
            yield f"`{thing.span.one_line}` is no part of the drawing"
    axes = [axis_of(thing, value) for thing, value in zip(things, values, strict=True)]
    if len(set(axes) - {None}) > 1:
        yield "one end is a place from left to right, the other one a place from bottom to top"
    if len(things) == 1:
        (value,) = values
        if not isinstance(value, Geometry) or value.type not in _MEASURED_ALONE:
            yield f"`{things[0].span.one_line}` alone is no line, circle or arc"


# --- The step from a condition that an author states to a constraint of the model.


def impose(it: Interpreter, node: ast.Expression, env: Env, weight: float | None = None) -> None:
    """Adds `constrain EXPR` or, with a weight, `prefer EXPR`; checks constant conditions on the spot."""
    if isinstance(node, ast.Call) and is_by_hand(it, node):
        record_dimension(it, node, env)
        return
    handed = _handed_over(it, node)
    if any(_holds_place(it, inner) for inner in handed):
        for inner in handed:
            impose(it, inner, env, weight)
        return
    said = Wording(node, it, env)
    if isinstance(node, ast.Call) and _holds_place(it, node):
        value = _held(it, node, env)
    else:
        value = evaluate(it, _as_relation(node), env)
    match value:
        case bool() if it.states_constants and weight is None:
            _state_constants(said)
        case Nothing() | True:
            return
        case False:
            _never(said, weight)
        case Condition():
            _impose_condition(said, value, weight)
        case Geometry():
            message = f"this {value.type} has no name, so it is not part of the model"
            it.report("E0323", message, node, hints=[f"give it one: `{value.type}_1 = {node.span.text}`"])
        case _:
            it.misfit(rules.no_condition(shown(node), type_of(value)), node)


def _holds_place(it: Interpreter, node: ast.Expression) -> bool:
    return isinstance(node, ast.Call) and it.spelled(node.callee) == "fixed"


def _handed_over(it: Interpreter, node: ast.Expression) -> list[ast.Expression]:
    """Returns the items of `AddConstraint(…)`, of which `fixed(p)` is no condition by itself."""
    if isinstance(node, ast.Call) and node.receiver is None and it.spelled(node.callee) == "add_constraint":
        values = [a.value for a in node.arguments]
        return [item for v in values for item in (v.items if isinstance(v, ast.List) else (v,))]
    return []


def _as_relation(node: ast.Expression) -> ast.Expression:
    """Returns `angle(a, b) == v` as `angle(a, b, v)`, in the same reading; likewise `<=` and `>=`."""
    match node:
        case ast.Comparison(operands=(ast.Call() as call, value), operators=(relation,)):
            named = any(a.name is not None for a in call.arguments)
            count = len(call.arguments) + (call.receiver is not None)
            bound = _BOUNDS.get(relation)
            if fold(call.callee.text) not in ("angle", "anglebetween") or named:
                return node
            if (relation == "==" and 1 <= count <= 3) or (bound is not None and count == 2):
                name = ast.Identifier(bound, span=value.span) if bound else None
                given = ast.Argument(name, value, span=value.span)
                return ast.Call(call.callee, call.receiver, (*call.arguments, given), span=node.span)
    return node


_BOUNDS = {"<=": "at_most", "<": "at_most", ">=": "at_least", ">": "at_least"}


def _turn(env: Env) -> str:
    return f" [{', '.join(env.scope.labels)}]" if env.scope.labels else ""


def _never(wording: Wording, weight: float | None) -> None:
    it, node = wording.it, wording.node
    if any(part in it.watched for part in ast.walk(node)):
        return  # reported as a breach of validity, and read with values as written
    shape, found = _library_shape(wording), compared(wording)
    if _refuses_measured(it, found, node):
        return
    false, both = differences(wording, ex.Evaluator({}), EXACT), sides(wording, ex.Evaluator({}))
    values = (f", {both}" if both else "") + _turn(wording.env)
    places = () if shape is not None else givens(wording)
    change = "one of these, or what is stated" if places else "what it speaks of, or leave it out"
    near = [h for c in found if c.relation == "==" for h in rounding(c.left.value, c.right.value)]
    hints = near or [f"nothing in it moves: change {change}"]
    wish = "" if weight is None else "the wish "
    if not near and any(isinstance(part, ast.Member) for part in ast.walk(node)):
        hints.append("a size that shall move is written as a first guess, as in `radius: guess(5)`")
    code = "E0513" if weight is None else "N0605"
    message = f"{wish}`{node.span.one_line}` can never hold: both sides are constants{values}"
    place = shape.span if shape is not None else node
    label = "; ".join(false) or "false as written"
    it.report(code, message, place, label=label, hints=hints, secondary=places)


def _constraint(said: Wording, comparisons: Iterable[Comparison], weight: float | None = None) -> Constraint:
    text, span, turn = said.it.said(said.node, said.env)
    return Constraint(said.env.here, tuple(comparisons), text, span, weight, turn, said)


def _state_constants(wording: Wording) -> None:
    """Adds a condition that is decided already as a constraint, so that other constants for it can be
    sought. One that measures what is drawn after solving cannot be.
    """
    found = compared(wording) if _library_shape(wording) is None else ()
    if found and not _measurements(found):
        wording.it.add_constraint(_constraint(wording, found))


def _measurements(comparisons: Iterable[Comparison]) -> list[Measurement]:
    sides = (e for c in comparisons for e in (c.left, c.right) if e.is_open)
    return [n.payload for n in ex.nodes(sides, only_open=True) if isinstance(n.payload, Measurement)]


def _refuses_measured(it: Interpreter, comparisons: Iterable[Comparison], node: ast.Expression) -> bool:
    """Reports a condition on what is known once all is solved. Returns whether it did."""
    if all(measurement.kind in SIDES for measurement in _measurements(comparisons)):
        return False
    message = "areas, perimeters and clearances of outlines are known after solving only"
    instead = "put it in an `assert`, or constrain boxes and distances instead"
    apart = "`clearance` constrains between points, lines, circles, slots and convex shapes; name these"
    it.report("E0512", message, node, hints=[f"{FORMULAS}: name that", instead, apart])
    return True


def _library_shape(said: Wording) -> Geometry | None:
    """Returns the shape of the library that holds a condition for itself; None for others."""
    shape = said.env.scope.declaring().container
    is_standard = said.node.span.source in said.it.library_sources
    return shape if isinstance(shape, Geometry) and is_standard else None


def _impose_condition(said: Wording, condition: Condition, weight: float | None) -> None:
    it, node = said.it, said.node
    comparisons: list[Comparison] = []
    for part in condition.parts if condition.operator == "and" else (condition,):
        if part is False:
            if it.states_constants:
                _state_constants(said)
            else:
                _never(said, weight)
            return
        if isinstance(part, Condition) or (isinstance(part, Comparison) and part.relation not in RELATIONS):
            word = part.operator if isinstance(part, Condition) else part.relation
            hint = "state the one that is meant, choose with `if` over params, or `assert` it"
            it.misfit(rules.no_equation(word, hint), node)
            return
        if isinstance(part, Comparison):
            comparisons.append(part)
    if any(map(_is_angle, ast.walk(node))):
        ask_to_turn(comparisons)
    comparisons = _by_formulas(said, comparisons, weight)
    if _refuses_measured(it, comparisons, node):
        return
    comparisons = _with_foreseen_boxes(said, comparisons, weight)
    if comparisons and (shape := _library_shape(said)) is not None:
        _impose_within(said, shape, comparisons)
    elif (follower := _following(it, comparisons, said.env.here)) is not None:
        _box_follows(said, follower)
    elif comparisons:
        it.add_constraint(_constraint(said, _placed_in_call(said, comparisons), weight))


def _with_foreseen_boxes(
    said: Wording, comparisons: list[Comparison], weight: float | None
) -> list[Comparison]:
    """Returns comparisons with boxes as they can be foreseen; the drawing is looked at but for a wish."""
    measured = _measurements(comparisons)
    if measured and weight is None:
        (outline,) = measured[0].of
        assert isinstance(outline, Geometry)
        _look_again(said, comparisons, outline=outline)
    return [_foreseen(comparison) for comparison in comparisons] if measured else comparisons


def _by_formulas(said: Wording, comparisons: list[Comparison], weight: float | None) -> list[Comparison]:
    """Returns comparisons with areas and perimeters by their formulas; what is drawn is measured again."""
    if all(m.kind in SIDES for m in _measurements(comparisons)):
        return comparisons
    sides = (with_measured(formula, c.left, c.right) for c in comparisons)
    found = [replace(c, left=a, right=b) for c, (a, b) in zip(comparisons, sides, strict=True)]
    if weight is None and all(m.kind in SIDES for m in _measurements(found)):
        _look_again(said, comparisons, OTHERWISE)
    return found


def _foreseen(comparison: Comparison) -> Comparison:
    """Returns a comparison with the boxes of outlines made of others as they can be foreseen."""
    left, right = foreseen(comparison.left, comparison.right)
    changed = replace(comparison, left=left, right=right)
    moved = changed.placed - unmoved(comparison.left, comparison.right)
    return replace(changed, moved=moved) if moved else changed


def _look_again(
    said: Wording, comparisons: list[Comparison], message: str | None = None, outline: Geometry | None = None
) -> None:
    """Keeps a constraint to be looked at in the drawing; with an `outline`, one on its box as foreseen."""
    both, told = Condition("and", tuple(comparisons)), said.it.said(said.node, said.env)
    again = Assertion(said.env.here, both, message, *told, wording=said, outline=outline)
    said.it.assertions.append(again)


def _is_angle(node: ast.Node) -> bool:
    match node:
        case ast.Member(name=name) | ast.Call(callee=name):
            return fold(name.text) == "angle"
    return False


def _following(it: Interpreter, comparisons: list[Comparison], here: Structure) -> Geometry | None:
    """Returns a geometry in the boxes of comparisons that is derived of some outside of their structure."""
    spoken_of = {s for c in comparisons for s in c.boxes}
    outside = (g for g in it.following if not g.bound_to.is_within(here))
    return next((g for g in outside if spoken_of & _boxes_of(g)), None)


def _boxes_of(g: Geometry) -> set[Structure]:
    around: set[Structure] = set()
    structure = None if g.construction else g.owner
    while structure is not None:
        around.add(structure)
        structure = structure.parent if structure.kind != "hole" else None
    return around


def _box_follows(said: Wording, follower: Geometry) -> None:
    """Reports a constraint on a box with geometry in it that follows something outside of its holder."""
    here, span = said.env.here, said.it.place(said.node) or said.node.span
    why = f"which is derived of geometry outside of `{here.path}`"
    message = f"a constraint of `{here.path}` cannot use a box that `{follower.path}` is in, {why}"
    hint = f"say it in `{follower.bound_to.path}`, or name a geometry of `{here.name}`, not its box"
    said.it.report("E0402", message, span, hints=[hint])


def _impose_within(said: Wording, shape: Geometry, comparisons: list[Comparison]) -> None:
    """Adds a constraint that a library's shape holds for itself, named after it, at its author's line."""
    if shape.name is not None and shape.span is not None:
        text = f"{shape.path.removeprefix(said.env.here.path + '.')}: {said.node.span.one_line}"
        own, turn = tuple(comparisons), ", ".join(said.env.scope.labels)
        said.it.add_constraint(Constraint(said.env.here, own, text, shape.span, None, turn, is_inherent=True))


def _placed_in_call(said: Wording, comparisons: list[Comparison]) -> list[Comparison]:
    """Holds the last argument of the call in `distance(a, b) == 18`, as in every call."""
    node = said.node
    if not isinstance(node, ast.Comparison) or not isinstance(call := node.operands[0], ast.Call):
        return comparisons
    positional = [call.receiver] if call.receiver is not None else []
    positional += [a.value for a in call.arguments if a.name is None]
    if len(positional) < 2 or any(isinstance(p, ast.Call) for p in positional):
        return comparisons
    values = [evaluate(said.it, p, said.env) for p in positional[:-1]]
    placed = frozenset(u for v in values for u in value_unknowns(v, said.env.here))
    return [replace(c, moved=c.placed & placed or c.placed, parties=()) for c in comparisons]


def record_assertion(it: Interpreter, node: ast.Assert, env: Env, shape: str = "") -> None:
    """Keeps an `assert` to be checked once solved; those of a shape on constants are checked now."""
    value = evaluate(it, node.test, env)
    if isinstance(value, Nothing):
        return
    if not isinstance(value, bool | Condition):
        it.misfit(rules.needed("a condition", type_of(value)), node.test)
        return
    message = evaluate(it, node.message, env) if node.message is not None else None
    told = message.value if isinstance(message, TextVal) else None
    wording = Wording(node.test, it, env)
    if value is False and shape:
        why = told if told is not None else f"`{node.test.span.one_line}` is false"
        false = differences(wording, ex.Evaluator({}), EXACT)
        label = "; ".join(false) or "false as written"
        it.report("E0604", f"assertion failed: {why}{_turn(env)}", node.test, label=label)
        return
    if isinstance(value, bool) and it.states_constants and not shape:
        _state_constants(wording)
        return
    it.assertions.append(Assertion(env.here, value, told, *it.said(node.test, env), shape, wording))


def _held(it: Interpreter, node: ast.Call, env: Env) -> Value:
    """Returns the condition of `constrain fixed(x)`: x stays as written, in the frame of the holder."""
    arguments = [node.receiver] if node.receiver is not None else []
    arguments += [a.value for a in node.arguments]
    found: list[Value] = []
    for argument in arguments:
        value = evaluate(it, argument, env)
        if isinstance(value, Nothing):
            return value
        if not (numbers := list(_numbers(it, value, argument, env))):
            it.report("E0321", f"{kind_of(value)} has nothing to hold", argument)
        found += [compare_numbers(it, "==", n, number(n.value, n.dimension), node) for n in numbers]
    return all_of(found)


def _numbers(it: Interpreter, value: Value, node: ast.Expression, env: Env) -> Iterator[Num]:
    match value:
        case Num() | PointVal():
            yield from numbers_of(value)
        case Geometry():
            if (at := as_point(it, value, node, env)) is not None:
                yield from numbers_of(at)
            else:
                yield from (Num(e, LENGTH) for e in defining(value, env.here))
        case Structure():
            for structure in value.walk():
                for geometry in structure.own():
                    yield from (Num(e, LENGTH) for e in defining(geometry, env.here))
        case ListVal() | Array():
            for item in members(value) or ():
                yield from _numbers(it, item, node, env)
        case Box():
            yield from (Num(value.side(s), LENGTH) for s in SIDES)


# --- Constraints, preferences and assertions, read when the structure that holds them is whole.


def read_constraint(it: Interpreter, node: ast.Statement, env: Env) -> None:
    match node:
        case ast.Constrain(items=items):
            for inner, place in stated(it, items.statements, env):
                read_constraint(it, inner, place)
        case ast.Equation():
            it.report("N0501", "`=` inside `constrain` is read as `==`", node, once=True)
            if node not in it.program.rejected:
                impose(it, node.meant, env)
        case ast.ExpressionStatement(value=value):
            impose(it, value, env)
        case ast.Prefer():
            _prefer(it, node, env)
        case ast.Assert():
            record_assertion(it, node, env.reaching(Reach.READ))


def _prefer(it: Interpreter, node: ast.Prefer, env: Env) -> None:
    weight = 1.0
    if node.weight is not None:
        found = numeric(it, evaluate(it, node.weight, env), node.weight, env)
        if found is not None and found.expression.is_constant:
            weight = found.value
        if not weight > 0:
            it.report("E0511", f"a weight must be more than 0, and this is {weight:g}", node.weight)
            return
    impose(it, node.value, env, weight)
