"""The roles of a call's arguments: those it places and those it holds.

A relation that puts one thing where another is (`above(a, b)`, `centered_in(a, b)`) holds the other. One over
equals holds nobody by its place: the parameter type `peer` says so of one thing, and `peers` of a list, in
the library as in a program. A list that is given as one counts as equals, too: `align_left(slits)`.
"""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.building.conditions import replace_placed, value_unknowns
from aidl_lang.building.model import Condition
from aidl_lang.building.state import Env
from aidl_lang.building.values import Num, Value, members, spliced
from aidl_lang.checking.types import PEERS, Binding, BoxType, GeometryType, PointType, StructureType
from aidl_lang.common.names import fold
from aidl_lang.syntax import ast


def placing(
    condition: Value,
    definition: ast.ConstraintDefinition,
    binding: Binding,
    values: Sequence[Value],
    env: Env,
) -> Value:
    """Returns the condition of a call with the unknowns it places. The last positional argument is held on
    the first try and those before it are placed; equals are parties of one rank. A definition that only calls
    another leaves the choice to that one (`contains` holds its first), unless it gathered the arguments that
    it passes on.
    """
    if not isinstance(condition, Condition):
        return condition
    equals = _equals(definition, binding, values)
    if equals:
        parties = tuple(frozenset(value_unknowns(value, env.here)) for value in equals)
        every = frozenset().union(*parties)
        return replace_placed(condition, every, () if _is_given_a_place(definition, binding) else parties)
    positional = [values[i] for i in binding.positional]
    only = definition.body.statements[0] if len(definition.body.statements) == 1 else None
    delegates = isinstance(only, ast.ExpressionStatement) and isinstance(only.value, ast.Call)
    if delegates and not (binding.gathered and len(positional) > 1):
        return condition
    if len(positional) > 2 and isinstance(positional[-1], Num) and not isinstance(positional[-2], Num):
        positional.pop()  # the value that a measure is set to
    flat = [item for value in positional for item in spliced(value)] if binding.gathered else positional
    placed = flat[:-1] if len(flat) > 1 else flat
    unknowns = frozenset(u for value in placed for u in value_unknowns(value, env.here))
    return replace_placed(condition, unknowns) if unknowns else condition


def _equals(definition: ast.ConstraintDefinition, binding: Binding, values: Sequence[Value]) -> list[Value]:
    """Returns the things of one rank in a call, in the order of its arguments; none if it holds one."""
    given = binding.arguments
    declared = [
        values[i]
        for parameter in definition.parameters
        if parameter.type is not None and fold(parameter.type.text) in PEERS
        for i in given.get(parameter.name.text, ())
    ]
    if not declared and binding.signature.gathers and len(binding.positional) == 1:
        (only,) = given.get(binding.signature.parameters[0][0], (None,))
        declared = [values[only]] if only is not None and members(values[only]) is not None else []
    return [item for value in declared for item in spliced(value)]


def _is_given_a_place(definition: ast.ConstraintDefinition, binding: Binding) -> bool:
    """Tells whether another thing decides the place of a list, as in `spread(list, inside: box)`: then all
    are placed and there is no anchor among them.
    """
    related = {name for name, kind, _ in binding.taken if isinstance(kind, _PLACES)}
    word = definition.parameters[0].type
    return word is not None and fold(word.text) == "peers" and bool(related)


_PLACES = BoxType | PointType | GeometryType | StructureType
