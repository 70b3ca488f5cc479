"""Names given to values: members of structures and shapes, with and without indices."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.building.coerce import whole
from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.model import Geometry, Structure
from aidl_lang.building.scopes import LetBinding, Scope, VarBinding, indexed
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.building.values import Array, ListVal, Nothing, Value
from aidl_lang.syntax import ast


def declare(
    it: Interpreter,
    scope: Scope,
    name: ast.Identifier,
    indices: tuple[int, ...],
    value: Value | VarBinding,
    node: ast.Node,
) -> None:
    """Gives a value a name in the structure or shape whose body this is."""
    target = scope.declaring()
    if name in it.program.rejected:
        return
    if not indices:
        if scope.turn and name.text in target.values and not isinstance(target.values[name.text], LetBinding):
            message = f"`{name.text}` is declared in every turn of the loop"
            hint = f"give it an index: `{name.text}[i] = …`"
            it.report("E0208", message, name, label="the same name again", hints=[hint])
            return
        target.values[name.text] = value
    else:
        array = target.values.get(name.text)
        if not isinstance(array, Array):
            array = target.values[name.text] = Array(name.text)
        if indices in array.members and not isinstance(value, Nothing):
            shown = indexed(name.text, indices)
            it.report("E0208", f"`{shown}` is declared twice", name, hints=["use another index"])
            return
        array.members[indices] = value  # type: ignore[assignment]
        value = array
    container = target.container
    if isinstance(container, Structure):
        container.members[name.text] = value  # type: ignore[assignment]
        if isinstance(value, Geometry | Array | ListVal):
            container.geometry[name.text] = value
    elif isinstance(container, Geometry) and isinstance(value, Geometry | Array | ListVal):
        container.parts[name.text] = value


def index_values(
    it: Interpreter, nodes: Sequence[ast.Expression], scope: Scope, here: Structure
) -> tuple[int, ...] | None:
    found: list[int] = []
    for node in nodes:
        index = whole(it, evaluate(it, node, Env(scope, here, Reach.OWN)), node, "an index")
        if index is None:
            return None
        found.append(index)
    return tuple(found)


def give_name(
    geometry: Geometry, name: str, indices: tuple[int, ...], container: Geometry | Structure, node: ast.Assign
) -> None:
    geometry.name = indexed(name, indices)
    geometry.container = container
    geometry.construction = geometry.construction or node.construction
    if geometry.span is None or not isinstance(container, Geometry):
        geometry.span = node.span


def adopt(
    value: Value, name: str, indices: tuple[int, ...], container: Geometry | Structure, node: ast.Assign
) -> None:
    """Gives nameless geometry the name it is assigned to; geometry with a name keeps it."""
    if isinstance(value, Geometry):
        if value.name is None:
            give_name(value, name, indices, container, node)
    elif isinstance(value, ListVal):
        for i, item in enumerate(value.items):
            adopt(item, name, (*indices, i), container, node)
