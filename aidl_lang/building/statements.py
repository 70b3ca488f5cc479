"""The effect of each statement of a body when its line is reached, and the names given to values."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import field, replace

from aidl_lang.building import expression as ex
from aidl_lang.building.attributes import read_attributes, read_own_attributes
from aidl_lang.building.coerce import as_point, numeric, whole
from aidl_lang.building.construct import loose_point, refuses_measure
from aidl_lang.building.copies import Copier
from aidl_lang.building.curves import STILL, Motion, of_frame
from aidl_lang.building.edits import GeometryPlacement, check_edit, edited, edits_on, is_edit
from aidl_lang.building.evaluate import declared_names, evaluate, run_block, truth, turns
from aidl_lang.building.impose import record_assertion
from aidl_lang.building.members import read_param
from aidl_lang.building.model import Frame, Geometry, Holder, Structure, chain
from aidl_lang.building.state import (
    Env,
    Executor,
    Indices,
    Interpreter,
    LetBinding,
    ParamBinding,
    Reach,
    VarBinding,
    indexed,
)
from aidl_lang.building.structures import build_structure, instantiate, place_of
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
    certain,
    holds,
    kind_of,
)
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

# --- Names given to values: members of structures and shapes, with and without indices.


def declare(
    it: Interpreter, env: Env, name: ast.Identifier, value: Value | VarBinding, indices: Indices = ()
) -> None:
    """Gives a value a name in the structure or shape whose body this is."""
    target = env.scope.declaring()
    before = target.values.get(name.text)
    if name in it.program.rejected:
        return
    if not indices:
        if env.scope.turn and before is not None and not isinstance(before, LetBinding):
            message = f"`{name.text}` is declared in every turn of the loop"
            hint = f"give it an index: `{name.text}[i] = …`"
            it.report("E0208", message, name, label="the same name again", hints=[hint])
            return
        target.values[name.text] = value
    else:
        array = before if isinstance(before, Array) else Array(name.text)
        target.values[name.text] = array
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


def index_values(it: Interpreter, nodes: Sequence[ast.Expression], env: Env) -> tuple[int, ...] | None:
    found: list[int] = []
    for node in nodes:
        if (index := whole(it, evaluate(it, node, env), node, "an index")) is None:
            return None
        found.append(index)
    return tuple(found)


def give_name(geometry: Geometry, name: str, indices: Indices, container: Holder, node: ast.Assign) -> None:
    geometry.name = indexed(name, indices)
    geometry.container = container
    geometry.construction = geometry.construction or node.construction
    if geometry.span is None or not isinstance(container, Geometry):
        geometry.span = node.span


def adopt(value: Value, name: str, indices: Indices, container: Holder, node: ast.Assign) -> None:
    """Gives nameless geometry the name it is assigned to; geometry with a name keeps it."""
    if isinstance(value, Geometry):
        if value.name is None:
            give_name(value, name, indices, container, node)
    elif isinstance(value, ListVal):
        for i, item in enumerate(value.items):
            adopt(item, name, (*indices, i), container, node)


# --- Structures that wait for the name they are assigned to: instances of templates, and copies.

_WAITING = Instantiation | StructureCopy | Pattern | ListVal


@record(frozen=False)
class Assignment:
    """The making of the structures that one assignment names.

    first  instances of templates that other members of a pattern are copies of, with the frame each had of
           its own
    """

    it: Interpreter
    node: ast.Assign
    env: Env
    first: dict[Instantiation, tuple[Structure, Frame]] = field(default_factory=dict)

    def whole(self, value: Value, indices: Indices) -> Value:
        """Returns the assignment's value: every structure in it made, every geometry of a pattern named."""
        match value:
            case Pattern() | StructureCopy(source=Structure()) if self.node.placement is not None:
                self._stands(value)
        return self.value(value, indices)

    def value(self, value: Value, indices: Indices) -> Value:
        match value:
            case Instantiation():
                return instantiate(self.it, self.node, value, self.env, indices)
            case StructureCopy():
                return self._copy(value, indices)
            case ListVal(items) if any(isinstance(i, _WAITING) for i in items):
                return ListVal(tuple(self.value(item, (*indices, i)) for i, item in enumerate(items)))
            case Pattern(settings=settings) if settings.name is None:
                return self._pattern(value, indices)
            case _:
                return value

    def _stands(self, value: StructureCopy | Pattern) -> None:
        name, fix = self.node.name.text, None
        if isinstance(value, Pattern):
            message, hint = f"the place of `{name}` is that of its members", "give it a `center` or a `start`"
            match self.node.value, self.node.placement:
                case ast.Call(ast.Identifier("linear_array" | "grid")) as call, ast.Placement(at, None) if at:
                    rest = Span(call.span.source, call.span.end - 1, at.span.end)
                    edit = Edit(rest, f", start: {at.span.text})")
                    is_placed = any(a.name and a.name.text in ("center", "start") for a in call.arguments)
                    fix = None if is_placed else Fix("lay it out from there", (edit,), is_sure=True)
        else:
            source = certain(value.source, Structure)
            message = f"`{name}` is a copy, and its place follows from `{source.name}`"
            hint = "say where it goes in the copy: `copy(x, by: (10, 0))`, `mirror(x, about: y_axis)`"
        self.it.report("E0330", message, self.node.placement, hints=[hint], fix=fix)

    def _pattern(self, pattern: Pattern, indices: Indices) -> Pattern:
        container, name = self.env.holder, self.node.name.text
        give_name(pattern.settings, name, indices, container, self.node)
        pattern.name = indexed(name, indices)
        for index, member in pattern.members.items():
            place = (*indices, *index)
            if isinstance(member, Geometry):
                adopt(member, name, place, container, self.node)
            else:
                pattern.members[index] = self.value(member, place)
        self._moves_as_frame(pattern)
        return pattern

    def _moves_as_frame(self, pattern: Pattern) -> None:
        """Makes the position of a pattern of structures a frame: it counts only if something mentions it."""
        for structure, _ in self.first.values():
            for unknown in ex.unknowns([structure.frame.x, structure.frame.y]):
                if unknown.holder is pattern.settings and not unknown.kept:
                    unknown.frame_of = structure

    def _copy(self, copy: StructureCopy, indices: Indices) -> Value:
        motion, source = copy.motion, copy.source
        if isinstance(source, Structure):
            return self._of(source, _framed(source, self.env.here), motion, indices)
        if (known := self.first.get(source)) is not None:
            return self._of(known[0], known[1], motion, indices)
        return self._instance(source, motion, indices, copy)

    def _instance(
        self, template: Instantiation, motion: Motion, indices: Indices, copy: StructureCopy
    ) -> Value:
        if not (motion.scale.is_constant and motion.scale.value == 1.0):
            message = f"`{template.signature.name}` makes a structure of the sizes that it is given"
            hint = "pass it other sizes, or name the structure first and scale a copy of it"
            return self.it.report("E0334", message, copy.node, hints=[hint])
        own: list[Frame] = []

        def framed(frame: Frame) -> Frame:
            if self.node.placement is not None:  # moved in the frame that `at` and `rotated` place
                own.append(frame)
                return of_frame(frame).frame(motion.frame(Frame()))
            if copy.is_laid:  # where it is written
                frame = replace(frame, x=ex.constant(frame.x.value), y=ex.constant(frame.y.value))
            own.append(frame)
            return motion.frame(own[0])

        made = instantiate(self.it, self.node, template, self.env, indices, framed)
        if isinstance(made, Structure):
            self.first[template] = made, own[0]
        return made

    def _of(self, source: Structure, frame: Frame, motion: Motion, indices: Indices) -> Value:
        outward = (g for g in self.it.following if not g.bound_to.is_within(source))
        follower = next((g for g in outward if g.owner.is_within(source)), None)
        if follower is not None:
            why = f"`{follower.path}` is made of geometry of `{follower.bound_to.path}`"
            message = f"`{source.name}` cannot be copied alone: {why}"
            hint = f"copy `{follower.bound_to.name}` with all that it holds"
            return self.it.report("E0331", message, self.node.value, hints=[hint])
        scale = motion.scale
        inside = STILL if scale.is_constant and scale.value == 1.0 else replace(STILL, scale=scale)
        copier = Copier(self.it, None, inside, span=self.node.span)
        name = indexed(self.node.name.text, indices)
        made = copier.structure(source, self.env.here, name, motion.frame(frame))
        read_attributes(self.it, made, self.node.attributes, self.env.scope, self.env.scope)
        return made


def _framed(source: Structure, here: Structure) -> Frame:
    """Returns the frame of a structure as one above it sees it."""
    frame = source.frame
    for around in chain(source, here)[1:]:
        frame = of_frame(around.frame).frame(frame)
    return frame


def _assign(it: Interpreter, node: ast.Assign, env: Env) -> None:
    if (indices := index_values(it, node.indices, env)) is None:
        return
    value = _made(it, node, env, indices)
    if isinstance(value, Nothing):
        declare(it, env, node.name, NOTHING, indices)
        return
    is_new = isinstance(value, Instantiation | StructureCopy | Pattern)
    was_there = holds(value, Structure)
    value = Assignment(it, node, env).whole(value, indices)
    if not is_new:
        value = _named(it, node, value, env, indices)
    if was_there or not holds(value, Structure):  # otherwise the structures made here have their own
        read_own_attributes(it, node, value, env)
    if not indices and not isinstance(value, Array | Structure | Geometry | ListVal | PointVal):
        env.scope.values[node.name.text] = LetBinding(node.value, env.scope)
        return
    declare(it, env, node.name, value, indices)


def _made(it: Interpreter, node: ast.Assign, env: Env, indices: Indices) -> Value:
    """Returns the value of an assignment: placed, and edited by the statements below it."""
    value = evaluate(it, node.value, env)
    if isinstance(value, Nothing | Instantiation):
        return value
    placed = None
    if node.placement is not None:
        if isinstance(value, Geometry | PointVal):
            placed = GeometryPlacement(*place_of(it, node.placement, env))
        elif not isinstance(value, StructureCopy | Pattern):
            message = f"`at` and `rotated` place one structure or geometry, not {kind_of(value)}"
            it.report("E0509", message, node.placement, hints=["place each thing where it is made"])
    return edited(it, node, value, edits_on(it, node.name.text, indices, env.scope), env, placed)


def _named(it: Interpreter, node: ast.Assign, value: Value, env: Env, indices: Indices) -> Value:
    """Returns the value under its new name: a literal point becomes geometry."""
    is_list = isinstance(value, ListVal) and not indices and _is_literal_point(node.value)
    if isinstance(value, PointVal) or is_list:
        if (at := as_point(it, value, node.value, env)) is None:
            return value
        it.count_entity(node)
        dot = Geometry("point", env.here, it.place(node))
        give_name(dot, node.name.text, indices, env.holder, node)
        dot.fields = {"at": loose_point(it, at, dot)}
        return dot
    adopt(value, node.name.text, indices, env.holder, node)
    return value


def _is_literal_point(node: ast.Expression) -> bool:
    if not isinstance(node, ast.List) or len(node.items) != 2:
        return False
    return all(isinstance(i, ast.Number | ast.Unary) for i in node.items)


def _structure(it: Interpreter, node: ast.Structure, env: Env) -> None:
    if node.parameters is None and (indices := index_values(it, node.indices, env)) is not None:
        declare(it, env, node.name, build_structure(it, node, env.scope, env.here, indices), indices)


def _param(it: Interpreter, node: ast.Param, env: Env) -> None:
    binding = env.scope.values.get(node.name.text)
    if env.scope.turn:
        message = f"`param {node.name.text}` would be made in every turn of the loop"
        hint = "put the `param` before the loop, or use a `let` of the loop variable"
        it.report("E0208", message, node.name, hints=[hint])
    elif isinstance(binding, ParamBinding):
        read_param(it, binding, node)


def _var(it: Interpreter, node: ast.Var, env: Env) -> None:
    value = evaluate(it, node.value, env)
    if isinstance(value, Nothing):
        return
    found = numeric(it, value, node.value, env)
    if found is None or found.status is Exactness.FIXED:  # of which nothing is left to find
        declare(it, env, node.name, found or NOTHING)
        return
    if not refuses_measure(it, found, node.value.span) and not math.isfinite(found.value):
        it.report("E0504", f"`{node.value.span.one_line}` has no value at the first guesses", node.value)
    made = it.unknown(found.value, env.holder, node.name.text, dimension=found.dimension)
    it.became(found, made, env.holder, node.name.text, found.dimension)
    number = Num(made, found.dimension, Exactness.REFERENCE)
    declare(it, env, node.name, VarBinding(number, certain(made.payload, ex.Unknown)))


def _for(it: Interpreter, node: ast.For, env: Env) -> None:
    for name in declared_names(node.body, indexed=True):
        env.scope.declaring().values.setdefault(name, Array(name))  # even if the loop has no turn
    for turn in turns(it, node, env) or ():
        run_block(it, node.body.statements, turn)


def _if(it: Interpreter, node: ast.If, env: Env) -> None:
    test = evaluate(it, node.test, env)
    if isinstance(test, Nothing):
        return
    both = (node.then, node.otherwise)
    taken, left_out = both if truth(it, test, node.test) else both[::-1]
    if left_out is not None:
        env.scope.unbuilt |= dict.fromkeys(declared_names(left_out), node)
    if taken is not None:
        run_block(it, taken.statements, env)


def _expression(it: Interpreter, node: ast.ExpressionStatement, env: Env) -> None:
    """Checks an edit, which was applied where the thing was made; defers everything else as a constraint."""
    if isinstance(node.value, ast.Call) and is_edit(it, node.value, env.scope):
        check_edit(it, node.value, env)
    else:
        _defer(it, node, env)


def _defer(it: Interpreter, node: ast.Statement, env: Env) -> None:
    it.pending.setdefault(env.here, []).append((node, env))


def _assert(it: Interpreter, node: ast.Assert, env: Env) -> None:
    """Checks an assertion on the arguments of a shape where that is made; defers any other."""
    if isinstance(env.holder, Geometry):
        record_assertion(it, node, env.reaching(Reach.READ), env.holder.type)
    else:
        _defer(it, node, env)


EXECUTORS: Mapping[type, Executor] = {
    ast.Param: _param,
    ast.Var: _var,
    ast.Assign: _assign,
    ast.Structure: _structure,
    ast.For: _for,
    ast.If: _if,
    ast.Constrain: _defer,
    ast.ExpressionStatement: _expression,
    ast.Prefer: _defer,
    ast.Assert: _assert,
}
"""Executors of the statements that take effect when their line is reached; definitions were hoisted."""
