"""Templates: the results of their calls, and their arguments inside.

A number argument keeps its status; one that is literal is a single unknown inside the instance. A reference
becomes an unknown of every structure that uses it, tied by an equality that the instantiating structure
holds.
"""

from __future__ import annotations

from dataclasses import replace

from aidl_lang.building.coerce import as_written
from aidl_lang.building.conditions import compare_numbers
from aidl_lang.building.construct import positions, refuses_measure
from aidl_lang.building.model import Condition, Constraint, Geometry, Structure, convert_point
from aidl_lang.building.scopes import PassedBinding
from aidl_lang.building.state import Env, Interpreter
from aidl_lang.building.values import Exactness, ListVal, Num, PointVal, RecordVal, Value, kind_of, members
from aidl_lang.syntax import ast


def passed(
    it: Interpreter, name: str, value: Value, instance: Structure, holder: Structure, node: ast.Node
) -> Value | PassedBinding:
    """Returns the binding of an instance's parameter."""
    if (thing := _drawn(value)) is not None:
        message = f"a template takes numbers, points, texts and lists, and `{name}` is given {kind_of(thing)}"
        hint = f"pass one of its points or sizes, or constrain `{instance.name}` from outside"
        it.report("E0313", message, node, hints=[hint])
    if isinstance(value, Num | PointVal) or (isinstance(value, ListVal) and _refers(value)):
        return PassedBinding(name, value, instance, holder, node)
    return value


def _drawn(value: Value) -> Geometry | Structure | None:
    """Returns a geometry or a structure that a value is, or holds; None if there is none."""
    if isinstance(value, Geometry | Structure):
        return value
    held = value.fields.values() if isinstance(value, RecordVal) else members(value) or ()
    return next((thing for item in held if (thing := _drawn(item)) is not None), None)


def read_passed(it: Interpreter, binding: PassedBinding, env: Env) -> Value:
    """Returns an argument as the structure that reads it has it."""
    here = env.here if env.here.is_within(binding.instance) else binding.instance
    if (known := binding.tied.get(here)) is None:
        known = binding.tied[here] = _tie(it, binding, here)
    return known


def _tie(it: Interpreter, binding: PassedBinding, here: Structure) -> Value:
    match binding.value:
        case Num(status=Exactness.REFERENCE) as number:
            refuses_measure(it, number, binding.node.span)
            made = it.unknown(number.value, here, binding.name, owner=here, dimension=number.dimension)
            own = Num(made, number.dimension, Exactness.REFERENCE)
            _hold_equal(it, binding, [(own, number)])
            return own
        case Num(status=Exactness.NUMBER) as number if here is binding.instance:
            made = it.unknown(
                number.value, here, binding.name, owner=here, dimension=number.dimension, kept=True, cell=True
            )
            it.became(number, made, here, binding.name, number.dimension)
            return Num(made, number.dimension, Exactness.NUMBER)
        case PointVal() as point if here is not binding.instance and not _refers(point):
            return point
        case PointVal() as point:
            own_point = _own_point(it, binding, point, here)
            if _refers(point):
                outside = convert_point(own_point, here, binding.holder)
                pairs = [(outside.x, point.x), (outside.y, point.y)]
                _hold_equal(it, binding, [p for p in pairs if p[1].status is Exactness.REFERENCE])
            return own_point
        case ListVal(items):
            bindings = (replace(binding, name=f"{binding.name}[{i}]", value=v) for i, v in enumerate(items))
            return ListVal(tuple(_tie(it, b, here) if _refers(b.value) else b.value for b in bindings))
        case value:
            return value


def _refers(value: Value) -> bool:
    match value:
        case Num(status=status):
            return status is Exactness.REFERENCE
        case PointVal(x, y):
            return _refers(x) or _refers(y)
        case ListVal(items):
            return any(map(_refers, items))
        case _:
            return False


def _own_point(it: Interpreter, binding: PassedBinding, point: PointVal, here: Structure) -> PointVal:
    """Makes a point of the instance where, in its frame, the argument is at the first guesses."""
    if _refers(point):
        numbers = as_written(point)
        assert isinstance(numbers, PointVal)
        at = as_written(convert_point(numbers, binding.holder, here))
        assert isinstance(at, PointVal)
        point = at
    return positions(it, [point], here, [binding.name], here)[0]


def _hold_equal(it: Interpreter, binding: PassedBinding, pairs: list[tuple[Num, Num]]) -> None:
    conditions = [compare_numbers(it, "==", own, outer, binding.node) for own, outer in pairs]
    comparisons = tuple(c for m in conditions if isinstance(m, Condition) for c in m.comparisons())
    span = it.place(binding.node)
    if comparisons and span is not None:
        text = f"{binding.instance.name}.{binding.name} == {span.text}"
        it.add_constraint(Constraint(binding.holder, comparisons, text, span))
