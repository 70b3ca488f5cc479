"""The evaluation of expressions of the language to values, and the run of bodies, statement by statement."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import Any

from aidl_lang.building import expression as ex
from aidl_lang.building.coerce import (
    as_point,
    as_written,
    constant,
    coordinate,
    entry,
    items_of,
    joined,
    numeric,
    whole,
)
from aidl_lang.building.members import member, no_index, not_built, read
from aidl_lang.building.model import Condition, Geometry
from aidl_lang.building.state import Ahead, Candidate, Env, Interpreter, LetBinding, ParamBinding, Scope
from aidl_lang.building.values import (
    NOTHING,
    Array,
    ListVal,
    Nothing,
    Num,
    PointVal,
    RangeVal,
    RecordVal,
    TextVal,
    Value,
    members,
    number,
    spliced,
    type_of,
    with_numbers,
)
from aidl_lang.building.wording import compare, conjunction, holds, negation
from aidl_lang.checking import rules, units
from aidl_lang.checking.builtins import WORDS
from aidl_lang.checking.library import signature
from aidl_lang.checking.rules import blocks, shown
from aidl_lang.checking.units import UNITS
from aidl_lang.syntax import ast


def evaluate(it: Interpreter, node: ast.Expression, env: Env) -> Value:
    """Returns the value of an expression; NOTHING after an error, which has been reported."""
    if node in it.program.rejected:
        return NOTHING
    value = _EVALUATE[type(node)](it, node, env)
    if type(value) in _UNBOUNDED:
        it.check_extent(node, value)
    if it.watched and node in it.watched:
        if isinstance(value, Geometry):
            value = as_point(it, value, node, env) or value
        if isinstance(value, Num | PointVal):
            it.written[node] = value.value if isinstance(value, Num) else value.place.written
        return as_written(value)
    return value


_UNBOUNDED = frozenset({ListVal, RecordVal, TextVal})
"""Values that grow without limit when they are joined with themselves."""


def _number(it: Interpreter, node: ast.Number, env: Env) -> Value:
    if (known := it.numbers.get(node)) is not None:
        return known
    factor, dimension = UNITS[node.unit] if node.unit is not None else (1.0, None)
    value = node.value * factor
    if not ex.is_number(value):
        return _out_of_range(it, node)
    made = it.numbers[node] = Num(ex.literal(value, node), dimension)
    return made


def _point(it: Interpreter, node: ast.Point, env: Env) -> Value:
    x, y = (coordinate(it, evaluate(it, n, env), n, env) for n in (node.x, node.y))
    return PointVal(x, y) if x is not None and y is not None else NOTHING


def _listed(found: list[Value]) -> Value:
    return NOTHING if any(isinstance(f, Nothing) for f in found) else ListVal(tuple(found))


def _comprehension(it: Interpreter, node: ast.Comprehension, env: Env) -> Value:
    def made(inner: Env) -> list[Value]:
        if node.condition is not None and not truth(it, evaluate(it, node.condition, inner), node.condition):
            return []
        element = evaluate(it, node.element, inner)
        if node.innermost is node or isinstance(element, Nothing):
            return [element]
        return list(members(element) or ())

    return _of_turns(it, node, env, made)


def _for_arguments(it: Interpreter, node: ast.ForArguments, env: Env) -> Value:
    return _of_turns(it, node, env, lambda inner: _arguments_of(it, node.body, inner))


def _of_turns(
    it: Interpreter, node: ast.Comprehension | ast.ForArguments, env: Env, made: Callable[[Env], list[Value]]
) -> Value:
    run = turns(it, node, env)
    return NOTHING if run is None else _listed([value for inner in run for value in made(inner)])


def _if_arguments(it: Interpreter, node: ast.IfArguments, env: Env) -> Value:
    test = evaluate(it, node.test, env)
    if isinstance(test, Nothing):
        return NOTHING
    taken = node.then if truth(it, test, node.test) else node.otherwise
    return _listed(_arguments_of(it, taken, env) if taken is not None else [])


def _arguments_of(it: Interpreter, block: ast.ArgumentBlock, env: Env) -> list[Value]:
    """Returns the arguments in a block; of a list among them its members, as of one among the others."""
    scope = Scope(env.scope, env.scope.container, turn=True, labels=env.scope.labels)
    inner = env.within(scope)
    found: list[Value] = []
    for item in block.items:
        if isinstance(item, ast.Let):
            scope.values[item.name.text] = LetBinding(item.value, scope)
    for item in block.items:
        if not isinstance(item, ast.Let):
            found += spliced(evaluate(it, item, inner))
    return found


def iterate(it: Interpreter, node: ast.Expression, env: Env) -> list[Value] | None:
    """Returns the values that a `for` runs through; None after an error."""
    value = evaluate(it, node, env)
    items = items_of(it, value, node)
    if items is None and not isinstance(value, RangeVal | Nothing):
        it.misfit(rules.no_run(type_of(value)), node)
    return list(items) if items is not None else None


def turns(
    it: Interpreter, node: ast.For | ast.Comprehension | ast.ForArguments, env: Env
) -> Iterator[Env] | None:
    """Returns the environments of the turns of a loop; None after an error."""
    items = iterate(it, node.iterable, env)
    return None if items is None else (_turn(it, node, item, env) for item in items)


def _turn(
    it: Interpreter, node: ast.For | ast.Comprehension | ast.ForArguments, item: Value, env: Env
) -> Env:
    it.count_turn(node)
    return env.within(turn_scope(it, env.scope, node.variables, item, node))


def turn_scope(
    it: Interpreter, scope: Scope, variables: tuple[ast.Identifier, ...], item: Value, node: ast.Node
) -> Scope:
    """Returns the scope of one turn of a loop with its variables bound."""
    inner = Scope(scope, scope.container, turn=True, labels=scope.labels)
    items: list[Value] = [item]
    if len(variables) > 1:
        unpacked = [item.x, item.y] if isinstance(item, PointVal) else members(item)
        if unpacked is None or len(unpacked) != len(variables):
            it.report("E0304", f"each turn has to give {len(variables)} values, one for each variable", node)
            unpacked = [NOTHING] * len(variables)
        items = list(unpacked)
    for variable, value in zip(variables, items, strict=True):
        inner.values[variable.text] = value
        other = value.value if isinstance(value, TextVal) else "…"
        shown = f"{value.value:g}" if isinstance(value, Num) else other
        inner.labels += (f"{variable.text} = {shown}",)
    return inner


def truth(it: Interpreter, value: Value, node: ast.Node) -> bool:
    """Returns the truth of a condition that decides what is built; False after an error."""
    if isinstance(value, bool):
        return value
    if isinstance(value, Condition):
        found = [u for c in value.comparisons() for u in ex.unknowns([c.left, c.right])]
        if all(u.cell or u.exact for u in found):
            for u in found:
                u.exact = True
            return holds(value, lambda e: e.value, 1e-9, strict=True)
        it.misfit(rules.undecided(shown(node)), node)
    elif not isinstance(value, Nothing):
        it.misfit(rules.needed("a condition", type_of(value)), node)
    return False


def _name(it: Interpreter, node: ast.Name, env: Env) -> Value:
    name = it.spelled(node)
    if (found := env.scope.find(name)) is not None:
        return read(it, found.values[name], node, env)
    for scope in env.scope.chain():
        if (branch := scope.unbuilt.get(name)) is not None:
            return not_built(it, node, branch)
    if node.text in WORDS:
        return TextVal(node.text)
    if node in it.program.resolution.uses or node.span.source in it.library_sources:
        it.report("E0201", f"there is no `{node.text}` here yet", node, label="made further on")
    return NOTHING  # else reported by the checker, or its file could not be imported


def _index(it: Interpreter, node: ast.Index, env: Env) -> Value:
    value = evaluate(it, node.value, env)
    index = evaluate(it, node.index, env)
    if isinstance(value, Nothing) or isinstance(index, Nothing):
        return NOTHING
    if isinstance(value, RecordVal) and isinstance(index, TextVal):
        return entry(it, value, index.value, node.index)
    if (items := members(value)) is None:
        return it.misfit(rules.no_members(shown(node.value), type_of(value)), node)
    if (position := whole(it, index, node.index, "an index")) is None:
        return NOTHING
    if isinstance(value, Array):
        if (position,) in value.members:
            return value.members[(position,)]
        if (row := value.row(position)).members:
            return row
        if position >= 0:
            return no_index(it, node, sorted({k[0] for k in value.members}), position)
    if -len(items) <= position < len(items):
        return items[position]
    return no_index(it, node, list(range(len(items))), position)


def _unary(it: Interpreter, node: ast.Unary, env: Env) -> Value:
    value = evaluate(it, node.operand, env)
    if node.operator == "not":
        return negation(it, value, node)
    if isinstance(node.operand, ast.Number) and isinstance(value, Num):
        signed = -value.value if node.operator == "-" else value.value
        return Num(ex.literal(signed, node), value.dimension)
    if isinstance(value, Nothing) or node.operator == "+":
        return value
    if isinstance(value, PointVal):
        return with_numbers(value, _negative)
    found = numeric(it, value, node.operand, env)
    return _negative(found) if found else NOTHING


def _negative(value: Num) -> Num:
    return Num(-value.expression, value.dimension, value.status)


def _binary(it: Interpreter, node: ast.Binary, env: Env) -> Value:
    left = evaluate(it, node.left, env)
    if node.operator in ("and", "or"):
        # A constant that decides ends it: a guard may keep an expression from being evaluated.
        if left is (node.operator == "or"):
            return left
        return conjunction(it, node.operator, left, evaluate(it, node.right, env), node)
    right = evaluate(it, node.right, env)
    if type(left) is Num and type(right) is Num:
        return arithmetic(it, node.operator, left, right, node)
    if isinstance(left, Nothing) or isinstance(right, Nothing):
        return NOTHING
    if node.operator == "+" and (together := joined(left, right)) is not None:
        return together
    a, b = (as_point(it, v, n, env) for v, n in ((left, node.left), (right, node.right)))
    if a is not None or b is not None:
        return _vector(it, node, a if a is not None else left, b if b is not None else right)
    x = numeric(it, left, node.left, env)
    y = numeric(it, right, node.right, env)
    return arithmetic(it, node.operator, x, y, node) if x is not None and y is not None else NOTHING


def _vector(it: Interpreter, node: ast.Binary, left: Value, right: Value) -> Value:
    op = node.operator
    if isinstance(left, PointVal) and isinstance(right, PointVal) and op in "+-":
        x, y = arithmetic(it, op, left.x, right.x, node), arithmetic(it, op, left.y, right.y, node)
    elif isinstance(left, PointVal) and isinstance(right, Num) and op in "*/":
        x, y = arithmetic(it, op, left.x, right, node), arithmetic(it, op, left.y, right, node)
    elif isinstance(left, Num) and isinstance(right, PointVal) and op == "*":
        x, y = arithmetic(it, op, left, right.x, node), arithmetic(it, op, left, right.y, node)
    else:
        sides = shown(node.left), shown(node.right)
        return it.misfit(rules.no_vectors(op, type_of(left), type_of(right), *sides), node)
    return PointVal(x, y) if isinstance(x, Num) and isinstance(y, Num) else NOTHING


_DIMENSION: dict[str, Callable[[units.MaybeDimension, units.MaybeDimension], units.MaybeDimension]] = {
    "+": units.add,
    "-": units.add,
    "%": units.add,
    "*": units.multiply,
    "/": units.divide,
}
_OPERATION: dict[str, Callable[[ex.Expression, ex.Expression], ex.Expression]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "^": partial(ex.apply, "power"),
}


def arithmetic(it: Interpreter, op: str, a: Num, b: Num, node: ast.Node) -> Num | Nothing:
    """Evaluates arithmetic on numbers, dimensions included; of two statuses the stronger counts."""
    status = a.status if a.status >= b.status else b.status
    try:
        if op in "+-" and a.dimension is b.dimension:
            dimension = a.dimension
        elif op == "^":
            if (exponent := constant(it, b, node, "an exponent")) is None:
                return NOTHING
            dimension = units.power(a.dimension, exponent)
        else:
            dimension = _DIMENSION[op](a.dimension, b.dimension)
    except units.UnequalError as pair:
        return it.misfit(rules.unequal(f"`{op}` does not join", *pair.args), node)
    except ValueError as reason:
        return it.report("E0308", f"`{op}` has no meaning here: {reason}", node)
    if op == "%":
        x, y = (constant(it, n, node, "an operand of `%`") for n in (a, b))
        if x is None or y is None:
            return NOTHING
        if y == 0:
            return _divided_by_zero(it, node)
        return number(x - y * math.floor(x / y), dimension, status)
    result = _OPERATION[op](a.expression, b.expression)
    if result.op == "constant" and not ex.is_number(result.value):
        return _without_value(it, op, a.expression, b.expression, node)
    return Num(result, dimension, status)


def _without_value(it: Interpreter, op: str, a: ex.Expression, b: ex.Expression, node: ast.Node) -> Nothing:
    if op == "^" and a.value < 0 and not b.value.is_integer():
        return _no_value(it, node, "it takes the root of a negative number")
    divisor = {"/": b, "^": a}.get(op)
    if divisor is not None and divisor.is_constant and divisor.value == 0:
        return _divided_by_zero(it, node)
    return _out_of_range(it, node)


def _divided_by_zero(it: Interpreter, node: ast.Node) -> Nothing:
    hint = "let an `if … then … else` choose another value where the divisor is zero"
    return _no_value(it, node, "it divides by zero", hint)


def _out_of_range(it: Interpreter, node: ast.Node) -> Nothing:
    hint = f"numbers reach to {ex.LARGEST:g} in either direction"
    return _no_value(it, node, "it leaves the range of numbers", hint)


def _no_value(it: Interpreter, node: ast.Node, why: str, *hints: str) -> Nothing:
    return it.report("E0504", f"`{node.span.one_line}` has no value: {why}", node, hints=hints)


def _comparison(it: Interpreter, node: ast.Comparison, env: Env) -> Value:
    values = [evaluate(it, operand, env) for operand in node.operands]
    result: Value = True
    for i, relation in enumerate(node.operators):
        pair = compare(it, relation, values[i], values[i + 1], node, env, node.operands[i : i + 2])
        result = conjunction(it, "and", result, pair, node)
    return result


def _membership(it: Interpreter, node: ast.Membership, env: Env) -> Value:
    value, container = evaluate(it, node.value, env), evaluate(it, node.container, env)
    if isinstance(value, Nothing) or isinstance(container, Nothing):
        return NOTHING
    sides = node.value, node.container
    if isinstance(container, RangeVal):
        low = compare(it, ">=", value, container.start, node, env, sides)
        high = compare(it, "<" if container.exclusive else "<=", value, container.end, node, env, sides)
        return conjunction(it, "and", low, high, node)
    if (items := members(container)) is None:
        return it.misfit(rules.needed("a range or a list", type_of(container)), node.container)
    result: Value = False
    for item in items:
        equal = compare(it, "==", value, item, node, env, sides)
        result = conjunction(it, "or", result, equal, node)
    return result


def _range(it: Interpreter, node: ast.Range, env: Env) -> Value:
    start, end = (numeric(it, evaluate(it, n, env), n, env) for n in (node.start, node.end))
    step = numeric(it, evaluate(it, node.step, env), node.step, env) if node.step is not None else None
    if start is None or end is None or (node.step is not None and step is None):
        return NOTHING
    try:
        dimension = units.add(start.dimension, end.dimension)
        dimension = units.add(dimension, step.dimension) if step is not None else dimension
    except units.UnequalError as pair:
        return it.misfit(rules.unequal("a range does not join", *pair.args), node)
    low, high = (Num(n.expression, dimension, n.status) for n in (start, end))
    return RangeVal(low, high, node.exclusive, step)


def chosen(it: Interpreter, node: ast.If | ast.Conditional, env: Env) -> Any:
    """Returns what is taken of two ways; None if there is no other one, or after an error."""
    test = evaluate(it, node.test, env)
    if isinstance(test, Nothing):
        return None
    return node.then if truth(it, test, node.test) else node.otherwise


def _conditional(it: Interpreter, node: ast.Conditional, env: Env) -> Value:
    taken = chosen(it, node, env)
    return NOTHING if taken is None else evaluate(it, taken, env)


_EVALUATE: dict[type, Callable[..., Value]] = {
    ast.Number: _number,
    ast.String: lambda it, node, env: TextVal(node.value),
    ast.Boolean: lambda it, node, env: node.value,
    ast.Name: _name,
    ast.Member: lambda it, node, env: member(it, evaluate(it, node.value, env), node.name.text, node, env),
    ast.Index: _index,
    ast.Call: lambda it, node, env: it.caller(it, node, env),
    ast.Point: _point,
    ast.List: lambda it, node, env: _listed([evaluate(it, item, env) for item in node.items]),
    ast.Comprehension: _comprehension,
    ast.ForArguments: _for_arguments,
    ast.IfArguments: _if_arguments,
    ast.Unary: _unary,
    ast.Binary: _binary,
    ast.Comparison: _comparison,
    ast.Membership: _membership,
    ast.Range: _range,
    ast.Conditional: _conditional,
}


# --- Bodies: the declarations that hold in the whole of one, and its statements one by one.


def run_block(it: Interpreter, statements: Sequence[ast.Statement], env: Env) -> None:
    """Runs the statements of a body. Callables and constants are visible in the whole of it."""
    hoist_callables(it, env.scope, statements)
    hoist_values(env, statements)
    ahead = Ahead(statements, env)
    it.ahead.append(ahead)
    try:
        for ahead.next, statement in enumerate(statements, start=1):
            _execute(it, statement, env)
    finally:
        it.ahead.pop()


def hoist_callables(it: Interpreter, scope: Scope, statements: Iterable[ast.Statement]) -> None:
    for node in statements:
        if isinstance(node, ast.Alias):
            scope.aliases[node.name.text] = node.target.text
        elif ast.is_definition(node):
            if node not in it.signatures:
                it.signatures[node] = signature(node)
            scope.define(Candidate(it.signatures[node], scope))


def hoist_values(env: Env, statements: Iterable[ast.Statement]) -> None:
    scope = env.scope
    for node in statements:
        match node:
            case ast.Let():
                scope.values.setdefault(node.name.text, LetBinding(node.value, scope))
            case ast.Param():
                scope.values.setdefault(node.name.text, ParamBinding(node, scope, env.here))


def _execute(it: Interpreter, node: ast.Statement, env: Env) -> None:
    """Carries out a statement; definitions were hoisted and do nothing here."""
    if (run := it.executors.get(type(node))) is None:
        return
    it.check_time(node)
    try:
        run(it, node, env)
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
            case ast.For() | ast.If():
                for inner in blocks(node):
                    yield from declared_names(inner, indexed=indexed)


def stated(
    it: Interpreter, statements: Sequence[ast.Statement], env: Env
) -> Iterator[tuple[ast.Statement, Env]]:
    """Yields the conditions of a block, each where it is read: in the turns of loops and the branch taken."""
    hoist_values(env, statements)
    for node in statements:
        match node:
            case ast.For():
                for turn in turns(it, node, env) or ():
                    yield from stated(it, node.body.statements, turn)
            case ast.If():
                if (taken := chosen(it, node, env)) is not None:
                    yield from stated(it, taken.statements, env)
            case ast.Constrain(items=items):
                yield from stated(it, items.statements, env)
            case ast.Assign():
                env.scope.values[node.name.text] = LetBinding(node.value, env.scope)
            case ast.Let():
                pass
            case _:
                yield node, env
