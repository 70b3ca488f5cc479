"""Statements: structures, geometry and loops in text order, constraints when a structure is whole."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import PurePath

from aidl_lang import ast, units
from aidl_lang import expression as ex
from aidl_lang.building.calls import default_of
from aidl_lang.building.coerce import as_point, numeric, whole
from aidl_lang.building.construct import hidden_constraints, loose_point
from aidl_lang.building.evaluate import evaluate, iterate, truth, turn_scope
from aidl_lang.building.impose import impose, record_assertion
from aidl_lang.building.params import read_param, report_unused
from aidl_lang.building.scopes import Candidate, LetBinding, ParamBinding, Scope, VarBinding
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.building.templates import passed
from aidl_lang.builtins import WORDED
from aidl_lang.library import signature
from aidl_lang.model import Frame, Geometry, Structure
from aidl_lang.units import ANGLE, LENGTH
from aidl_lang.values import (
    NOTHING,
    Array,
    Instantiation,
    ListVal,
    Namespace,
    Nothing,
    Num,
    PointVal,
    Status,
    Text,
    Value,
    kind_of,
    number,
    point,
)

_PLAN = 10.0
"""Width and height at which the box of an empty structure starts, in mm."""


# --- Modules -------------------------------------------------------------------------------------


def run_module(it: Interpreter, library: Scope) -> Structure:
    """Run the main module; its root structure, or an implicit assembly around what stands at file level."""
    module = it.program.main
    statements = module.statements
    scope = _file_scope(it, module, library, {})
    roots = [s for s in statements if isinstance(s, ast.Structure) and s.parameters is None]
    loose = [s for s in statements if not isinstance(s, (*_DEFINITIONS, ast.Structure))]
    if len(roots) == 1 and not loose:
        it.root = root = Structure("assembly", "", None, None)
        _hoist_values(scope, statements, root)
        _register_params(it, scope)
        root = build_structure(it, roots[0], scope, None, ())
    else:
        name = re.sub(r"\W+", "_", PurePath(module.source.name).stem).strip("_") or "model"
        it.root = root = Structure("assembly", name, None, module.span)
        root.scope = scope
        scope.container = root
        _own_names(scope, root)
        run_block(it, statements, scope, root)
        _finish(it, root)
        if not roots and not loose and not it.diagnostics:
            it.report(
                "W0501",
                "this file draws nothing",
                None,
                hints=["a drawing needs a structure, as in `solid plate { … }`"],
            )
    report_unused(it)
    for constraint in hidden_constraints(it):
        it.add_constraint(constraint)
    return root


_DEFINITIONS = (
    ast.Import,
    ast.Param,
    ast.Let,
    ast.Alias,
    ast.FunctionDefinition,
    ast.ShapeDefinition,
    ast.ConstraintDefinition,
    ast.Todo,
)


def _register_params(it: Interpreter, scope: Scope) -> None:
    for binding in list(scope.values.values()):
        if isinstance(binding, ParamBinding):
            read_param(it, binding, binding.node)


def _file_scope(
    it: Interpreter, module: ast.Module, library: Scope, loading: dict[ast.Module, Scope]
) -> Scope:
    """The scope of a file: its definitions and what it imports."""
    if module in loading:
        return loading[module]
    scope = loading[module] = Scope(library)
    _hoist_callables(scope, module.statements)
    for statement in module.statements:
        if isinstance(statement, ast.Import) and (other := it.program.imports.get(statement)) is not None:
            inner = _file_scope(it, other, library, loading)
            _hoist_values(inner, other.statements, Structure("assembly", "", None, None))
            _bring_in(scope, inner, statement)
    return scope


def _bring_in(scope: Scope, inner: Scope, statement: ast.Import) -> None:
    if statement.alias is not None:
        scope.values[statement.alias.text] = Namespace({**inner.values, "": inner})
        return
    wanted = {name.text for name in statement.names}

    def is_wanted(name: str) -> bool:
        return not wanted or name in wanted

    for name, binding in inner.values.items():
        if is_wanted(name):
            scope.values.setdefault(name, binding)
    for name, candidates in inner.callables.items():
        if is_wanted(name):
            scope.callables.setdefault(name, candidates)
    for name, target in inner.aliases.items():
        if is_wanted(name):
            scope.aliases.setdefault(name, target)


# --- Blocks ----------------------------------------------------------------------------------------


def run_block(it: Interpreter, statements: Sequence[ast.Statement], scope: Scope, here: Structure) -> None:
    """Run the statements of a body. Callables and constants are visible in the whole of it."""
    _hoist_callables(scope, statements)
    _hoist_values(scope, statements, here)
    for statement in statements:
        execute(it, statement, scope, here)


def _hoist_callables(scope: Scope, statements: Iterable[ast.Statement]) -> None:
    for node in statements:
        match node:
            case ast.FunctionDefinition() | ast.ShapeDefinition() | ast.ConstraintDefinition():
                scope.callables.setdefault(node.name.text, []).append(Candidate(signature(node), scope))
            case ast.Structure(parameters=parameters) if parameters is not None:
                scope.callables.setdefault(node.name.text, []).append(Candidate(signature(node), scope))
            case ast.Alias(name=name, target=target):
                scope.aliases[name.text] = target.text


def _hoist_values(scope: Scope, statements: Iterable[ast.Statement], here: Structure) -> None:
    for node in statements:
        match node:
            case ast.Let():
                scope.values.setdefault(node.name.text, LetBinding(node.value, scope))
            case ast.Param():
                scope.values.setdefault(node.name.text, ParamBinding(node, scope, here))


def execute(it: Interpreter, node: ast.Statement, scope: Scope, here: Structure) -> None:
    if (run := _EXECUTE.get(type(node))) is not None:
        run(it, node, scope, here)


def _defer(it: Interpreter, node: ast.Statement, scope: Scope, here: Structure) -> None:
    it.pending.setdefault(here, []).append((node, scope))


def _assert(it: Interpreter, node: ast.Assert, scope: Scope, here: Structure) -> None:
    """In a shape an assertion is about its arguments, hence it is checked where the shape is made."""
    if isinstance(scope.declaring().container, Geometry):
        record_assertion(it, node, Env(scope, here, Reach.READ), at_once=True)
    else:
        _defer(it, node, scope, here)


def _param(it: Interpreter, node: ast.Param, scope: Scope, here: Structure) -> None:
    binding = scope.values.get(node.name.text)
    if scope.turn:
        it.report(
            "E0208",
            f"`param {node.name.text}` would be made in every turn of the loop",
            node.name,
            hints=["put the `param` before the loop, or use a `let` of the loop variable"],
        )
    elif isinstance(binding, ParamBinding):
        read_param(it, binding, node)


def _var(it: Interpreter, node: ast.Var, scope: Scope, here: Structure) -> None:
    value = evaluate(it, node.value, Env(scope, here, Reach.OWN))
    if isinstance(value, Nothing):
        return
    found = numeric(it, value, node.value, Env(scope, here, Reach.OWN))
    if found is None:
        _declare(it, scope, node.name, (), NOTHING, node)
        return
    holder = scope.declaring().container or here
    made = it.unknown(found.value, holder, node.name.text, owner=here, dimension=found.dimension)
    assert isinstance(made.payload, ex.Unknown)
    var = VarBinding(Num(made, found.dimension, Status.REFERENCE), made.payload)
    _declare(it, scope, node.name, (), var, node)


def _for(it: Interpreter, node: ast.For, scope: Scope, here: Structure) -> None:
    for name in _declared(node.body, indexed=True):
        scope.declaring().values.setdefault(name, Array(name))  # also when there is no turn
    for item in iterate(it, node.iterable, Env(scope, here, Reach.OWN)) or ():
        it.count_turn(node)
        run_block(it, node.body.statements, turn_scope(it, scope, node.variables, item, node), here)


def _if(it: Interpreter, node: ast.If, scope: Scope, here: Structure) -> None:
    test = evaluate(it, node.test, Env(scope, here, Reach.OWN))
    if isinstance(test, Nothing):
        return
    taken, left_out = (
        (node.then, node.otherwise) if truth(it, test, node.test) else (node.otherwise, node.then)
    )
    if left_out is not None:
        scope.unbuilt |= dict.fromkeys(_declared(left_out), node)
    if taken is not None:
        run_block(it, taken.statements, scope, here)


def _declared(block: ast.Block, *, indexed: bool = False) -> Iterator[str]:
    """Names that a block gives to geometry and structures, only those with an index if `indexed`."""
    for node in block.statements:
        match node:
            case ast.Assign() | ast.Structure(parameters=None):
                if node.indices or not indexed:
                    yield node.name.text
            case ast.Var() if not indexed:
                yield node.name.text
            case ast.For(body=body):
                yield from _declared(body, indexed=indexed)
            case ast.If(then=then, otherwise=otherwise):
                for branch in (then, otherwise):
                    if branch is not None:
                        yield from _declared(branch, indexed=indexed)


def _todo(it: Interpreter, node: ast.Todo, scope: Scope, here: Structure) -> None:
    here.is_todo = True


# --- Declarations ----------------------------------------------------------------------------------


def _assign(it: Interpreter, node: ast.Assign, scope: Scope, here: Structure) -> None:
    indices = _indices(it, node.indices, scope, here)
    if indices is None:
        return
    env = Env(scope, here, Reach.OWN)
    value = evaluate(it, node.value, env)
    if isinstance(value, Nothing):
        _declare(it, scope, node.name, indices, NOTHING, node)
        return
    if isinstance(value, Instantiation):
        made = _instantiate(it, node, value, scope, here, indices)
        _declare(it, scope, node.name, indices, made, node)
        return
    if node.placement is not None:
        it.report(
            "E0509",
            f"`at` and `rotated` place structures, and `{node.name.text}` is {kind_of(value)}",
            node.placement,
            hints=["geometry is placed by its own points, as in `center: (10, 0)`"],
        )
    container = scope.declaring().container or here
    if isinstance(value, PointVal) or (
        isinstance(value, ListVal) and not indices and _is_literal_point(node.value)
    ):
        at = as_point(it, value, node.value, env)
        if at is not None:
            it.count_entity(node)
            dot = Geometry("point", here, it.place(node))
            value = dot
            _name(dot, node.name.text, indices, container, node)
            dot.fields = {"at": loose_point(it, at, dot)}
    elif isinstance(value, Geometry | ListVal):
        _adopt(value, node.name.text, indices, container, node)
    elif (isinstance(value, Num | bool) or not isinstance(value, Array | Structure)) and not indices:
        scope.values[node.name.text] = LetBinding(node.value, scope)
        return
    _declare(it, scope, node.name, indices, value, node)


def _is_literal_point(node: ast.Expression) -> bool:
    return (
        isinstance(node, ast.List)
        and len(node.items) == 2
        and all(isinstance(i, ast.Number | ast.Unary) for i in node.items)
    )


def _name(
    geometry: Geometry,
    name: str,
    indices: tuple[int, ...],
    container: Geometry | Structure,
    node: ast.Assign,
) -> None:
    geometry.name = name + "".join(f"[{i}]" for i in indices)
    geometry.container = container
    geometry.construction = geometry.construction or node.construction
    if geometry.span is None or not isinstance(container, Geometry):
        geometry.span = node.span


def _adopt(
    value: Value, name: str, indices: tuple[int, ...], container: Geometry | Structure, node: ast.Assign
) -> None:
    """Geometry made without a name gets the one it is assigned to; what has one keeps it."""
    if isinstance(value, Geometry):
        if value.name is None:
            _name(value, name, indices, container, node)
    elif isinstance(value, ListVal):
        for i, item in enumerate(value.items):
            _adopt(item, name, (*indices, i), container, node)


def _indices(
    it: Interpreter, nodes: Sequence[ast.Expression], scope: Scope, here: Structure
) -> tuple[int, ...] | None:
    found: list[int] = []
    for node in nodes:
        index = whole(it, evaluate(it, node, Env(scope, here, Reach.OWN)), node, "an index")
        if index is None:
            return None
        found.append(index)
    return tuple(found)


def _declare(
    it: Interpreter,
    scope: Scope,
    name: ast.Identifier,
    indices: tuple[int, ...],
    value: Value | VarBinding,
    node: ast.Node,
) -> None:
    """Give a value a name in the structure or shape whose body this is."""
    target = scope.declaring()
    if name.text in _EVERYWHERE:
        it.report(
            "E0209",
            f"`{name.text}` belongs to every structure and cannot be declared",
            name,
            hints=["choose another name"],
        )
        return
    if not indices:
        if scope.turn and name.text in target.values and not isinstance(target.values[name.text], LetBinding):
            it.report(
                "E0208",
                f"`{name.text}` is declared in every turn of the loop",
                name,
                label="the same name again",
                hints=[f"give it an index: `{name.text}[i] = …`"],
            )
            return
        target.values[name.text] = value
    else:
        array = target.values.get(name.text)
        if not isinstance(array, Array):
            array = target.values[name.text] = Array(name.text)
        if indices in array.members and not isinstance(value, Nothing):
            shown = "".join(f"[{i}]" for i in indices)
            it.report("E0208", f"`{name.text}{shown}` is declared twice", name, hints=["use another index"])
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


# --- Structures ------------------------------------------------------------------------------------


def _structure(it: Interpreter, node: ast.Structure, scope: Scope, here: Structure) -> None:
    if node.parameters is not None:
        return
    indices = _indices(it, node.indices, scope, here)
    if indices is not None:
        made = build_structure(it, node, scope, here, indices)
        _declare(it, scope, node.name, indices, made, node)


def build_structure(
    it: Interpreter, node: ast.Structure, scope: Scope, parent: Structure | None, indices: tuple[int, ...]
) -> Structure:
    """A structure from its definition in place."""
    name = node.name.text + "".join(f"[{i}]" for i in indices)
    structure = _new(it, node.kind, name, parent, node)
    structure.doc = node.doc
    _place(it, structure, node.placement, scope)
    _attributes(it, structure, node.attributes, scope)
    body = Scope(_around(scope, node.name.text, structure), structure, labels=scope.labels)
    structure.scope = body
    _own_names(body, structure)
    run_block(it, node.body.statements, body, structure)
    _finish(it, structure)
    return structure


def _instantiate(
    it: Interpreter,
    node: ast.Assign,
    template: Instantiation,
    scope: Scope,
    here: Structure,
    indices: tuple[int, ...],
) -> Structure | Nothing:
    """An instance of a template under the name it is assigned to."""
    definition = template.definition
    name = node.name.text + "".join(f"[{i}]" for i in indices)
    if not it.enter(template.node, definition):
        return NOTHING
    try:
        structure = _new(it, definition.kind, name, here, node)
        structure.doc = definition.doc
        _place(it, structure, node.placement, scope)
        assert isinstance(template.scope, Scope)
        around = _around(template.scope, definition.name.text, structure)
        body = Scope(around, structure, labels=scope.labels)
        structure.scope = body
        _attributes(it, structure, (*definition.attributes, *node.attributes), body)
        _own_names(body, structure)
        for parameter, (key, kind, _) in zip(
            definition.parameters or (), template.signature.parameters, strict=True
        ):
            value = template.arguments.get(key)
            if value is None:
                value = default_of(it, parameter, kind, Env(body, structure, Reach.OWN))
            where = _argument_node(template.node, key) or parameter
            body.values[key] = passed(it, key, value, structure, here, where)
        if definition.placement is not None:
            _place(it, structure, definition.placement, body)
        run_block(it, definition.body.statements, body, structure)
        _finish(it, structure)
    finally:
        it.leave()
    return structure


def _argument_node(node: ast.Call, name: str) -> ast.Node | None:
    return next((a.value for a in node.arguments if a.name is not None and a.name.text == name), None)


def _new(it: Interpreter, kind: str, name: str, parent: Structure | None, node: ast.Node) -> Structure:
    it.count_entity(node)
    structure = Structure(kind, name, parent, it.place(node))
    if parent is None:
        it.root = structure
    else:
        parent.children.append(structure)
    return structure


def _around(scope: Scope, name: str, structure: Structure) -> Scope:
    """What a body sees around it: its structure by name, which is no member of it."""
    around = Scope(scope)
    around.values[name] = structure
    return around


_EVERYWHERE = frozenset({"self", "origin", "x_axis", "y_axis"})


def _own_names(scope: Scope, structure: Structure) -> None:
    """`self`, `origin` and the axes, which every structure has."""
    exact = [point(ex.constant(x), ex.constant(y), Status.FIXED) for x, y in ((0, 0), (1, 0), (0, 1))]
    scope.values["self"] = structure
    scope.values["origin"] = exact[0]
    for name, end in zip(("x_axis", "y_axis"), exact[1:], strict=True):
        axis = Geometry("line", structure, structure.span, {"start": exact[0], "end": end})
        axis.name, axis.container, axis.construction = name, structure, True
        scope.values[name] = axis


def _place(it: Interpreter, s: Structure, placement: ast.Placement | None, scope: Scope) -> None:
    """The frame: `at` is a position, `rotated` is exact unless it is a guess or an unknown."""
    if s.parent is None:
        if placement is not None:
            it.report(
                "W0502", "the root's frame is fixed, so `at` and `rotated` change nothing here", placement
            )
        return
    env = Env(scope, s.parent, Reach.OWN)
    at = None
    if placement is not None and placement.at is not None:
        value = evaluate(it, placement.at, env)
        at = as_point(it, value, placement.at, env)
        if at is None and not isinstance(value, Nothing):
            it.report("E0302", f"`at` wants a point, not {kind_of(value)}", placement.at)
    at = at or PointVal(number(0.0, LENGTH), number(0.0, LENGTH))
    x, y = (
        n.expression
        if n.status >= Status.FIXED
        else it.unknown(n.value, s, axis, owner=s.parent, dimension=LENGTH, frame_of=s)
        for n, axis in ((at.x, "x"), (at.y, "y"))
    )
    s.frame = Frame(x, y, _rotation(it, s, placement, env))


def _rotation(it: Interpreter, s: Structure, placement: ast.Placement | None, env: Env) -> ex.Expression:
    if placement is None or placement.rotated is None:
        return ex.ZERO
    value = evaluate(it, placement.rotated, env)
    found = numeric(it, value, placement.rotated, env)
    if found is None:
        return ex.ZERO
    if found.dimension not in (None, ANGLE):
        it.report("E0301", "`rotated` wants an angle", placement.rotated, hints=["as in `rotated 45deg`"])
        return ex.ZERO
    if found.status is Status.GUESS:
        assert s.parent is not None
        return it.unknown(found.value, s, "rotation", owner=s.parent, dimension=ANGLE, frame_of=s)
    return found.expression


_ATTRIBUTES = ("color", "layer", "thickness", "material", "detached", "note", "orientation")


def _attributes(it: Interpreter, s: Structure, attributes: Iterable[ast.Attribute], scope: Scope) -> None:
    from aidl_lang.names import find, nearest

    for attribute in attributes:
        name = find(attribute.name.text, dict.fromkeys((*_ATTRIBUTES, "colour")))
        if name is None:
            like = nearest(attribute.name.text, _ATTRIBUTES)
            known = ", ".join(f"`@{a}`" for a in _ATTRIBUTES)
            hint = f"did you mean `@{like[0]}`?" if like else f"there are {known}"
            it.report(
                "E0204", f"there is no attribute `@{attribute.name.text}`", attribute.name, hints=[hint]
            )
            continue
        values: list[Value] = []
        for argument in attribute.arguments:
            value = argument.value
            if name in WORDED and isinstance(value, ast.Name) and scope.find(value.text) is None:
                value = ast.String(value.text, span=value.span)
            values.append(evaluate(it, value, Env(scope, s.parent or s, Reach.OWN)))
        if _fits(it, name, values, attribute):
            s.attributes["color" if name == "colour" else name] = tuple(values)


_ORIENTATIONS = ("top", "front", "side")


def _fits(it: Interpreter, name: str, values: Sequence[Value], attribute: ast.Attribute) -> bool:
    """Whether an attribute is given what it takes."""
    if any(isinstance(value, Nothing) for value in values):
        return False
    wanted = ""
    match name, *values:
        case ("orientation", Text(word)) if word in _ORIENTATIONS:
            pass
        case ("orientation", *_):
            wanted = "one of `top`, `front` and `side`, as in `@orientation(front)`"
        case ("thickness", Num() as thickness) if thickness.dimension in (None, units.LENGTH):
            wanted = "" if thickness.value > 0 else "a thickness above 0"
        case ("thickness", *_):
            wanted = "a length above 0, as in `@thickness(3mm)`"
        case ("layer" | "material" | "note", Text()) | ("detached",) | ("detached", bool()):
            pass
        case ("layer" | "material" | "note", *_):
            wanted = f'a text, as in `@{name}("…")`'
        case ("detached", *_):
            wanted = "nothing, or true or false"
    if wanted:
        it.report("E0517", f"`@{attribute.name.text}` takes {wanted}", attribute)
    return not wanted


def _finish(it: Interpreter, structure: Structure) -> None:
    """The body has been run: an empty structure gets its box, then constraints are read."""
    if structure.is_empty and structure.parent is not None:
        _plan(it, structure)
    structure.is_complete = True
    for node, scope in it.pending.pop(structure, []):
        _read_constraints(it, node, scope, structure)


def _plan(it: Interpreter, s: Structure) -> None:
    half = _PLAN / 2
    left, bottom, width, height = (
        it.unknown(guess, s, name, owner=s, dimension=LENGTH)
        for name, guess in (("left", -half), ("bottom", -half), ("width", _PLAN), ("height", _PLAN))
    )
    for side in (left, bottom, width, height):
        assert isinstance(side.payload, ex.Unknown)
        side.payload.outline = True
    s.plan = (left, bottom, width, height)


# --- Constraints -----------------------------------------------------------------------------------


def _read_constraints(it: Interpreter, node: ast.Statement, scope: Scope, here: Structure) -> None:
    match node:
        case ast.Constrain(items=items):
            _read_items(it, items.statements, scope, here)
        case ast.ExpressionStatement(value=value):
            impose(it, value, Env(scope, here, Reach.SUBTREE))
        case ast.Prefer():
            _prefer(it, node, scope, here)
        case ast.Assert():
            record_assertion(it, node, Env(scope, here, Reach.READ))


def _prefer(it: Interpreter, node: ast.Prefer, scope: Scope, here: Structure) -> None:
    env = Env(scope, here, Reach.SUBTREE)
    weight = 1.0
    if node.weight is not None:
        found = numeric(it, evaluate(it, node.weight, env), node.weight, env)
        if found is not None and found.expression.is_constant:
            weight = found.value
        if not weight > 0:
            it.report("E0511", f"a weight must be more than 0, and this is {weight:g}", node.weight)
            return
    impose(it, node.value, env, weight)


def _read_items(it: Interpreter, statements: Sequence[ast.Statement], scope: Scope, here: Structure) -> None:
    env = Env(scope, here, Reach.SUBTREE)
    _hoist_values(scope, statements, here)
    for node in statements:
        match node:
            case ast.For():
                for item in iterate(it, node.iterable, env) or ():
                    it.count_turn(node)
                    _read_items(
                        it, node.body.statements, turn_scope(it, scope, node.variables, item, node), here
                    )
            case ast.If():
                test = evaluate(it, node.test, env)
                if not isinstance(test, Nothing):
                    chosen = node.then if truth(it, test, node.test) else node.otherwise
                    _read_items(it, chosen.statements if chosen else (), scope, here)
            case ast.Equation(left=left, right=right):
                equal = ast.Comparison((left, right), ("==",), span=node.span)
                it.report("N0501", "`=` inside `constrain` is read as `==`", node)
                impose(it, equal, env)
            case ast.Assign():
                scope.values[node.name.text] = LetBinding(node.value, scope)
            case _:
                _read_constraints(it, node, scope, here)


_EXECUTE: dict[type, Callable[..., None]] = {
    ast.Param: _param,
    ast.Var: _var,
    ast.Assign: _assign,
    ast.Structure: _structure,
    ast.For: _for,
    ast.If: _if,
    ast.Todo: _todo,
    ast.Constrain: _defer,
    ast.ExpressionStatement: _defer,
    ast.Prefer: _defer,
    ast.Assert: _assert,
}
"""Statements that do something when their line is reached; definitions were hoisted."""
