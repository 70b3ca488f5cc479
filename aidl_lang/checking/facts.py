"""Facts about names, members and operators before anything is built: types, and the unknowns they read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.checking import builtins, rules, units
from aidl_lang.checking.binding import FIELDS, MEMBERS
from aidl_lang.checking.complaints import did_you_mean, renamed, respell
from aidl_lang.checking.rules import a, in_box, shown
from aidl_lang.checking.symbols import Symbol, SymbolKind, SymbolScope
from aidl_lang.checking.types import (
    ANY,
    AnyType,
    BoxType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RangeType,
    RecordType,
    StructureType,
    TextType,
    TruthType,
    Type,
    parameter_type,
)
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.names import find, fold, nearest
from aidl_lang.common.prose import first_few, ticked
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference


# --- Facts about an expression before anything is built: its type, and the unknowns it reads.


@record(slots=True)
class ReadPlace:
    """A structure whose unknowns are read: `below` is its path as the structure or file `holder` sees it."""

    holder: ast.Node
    below: tuple[str, ...] = ()


Reads: TypeAlias = frozenset[ReadPlace]

NOTHING_READ: Reads = frozenset()


@record(slots=True)
class Fact:
    """The facts about a value, as far as they are known.

    type   of the value
    reads  the structures whose unknowns the value depends on; empty for constants, and if it is not known
    of     the definition whose members it has (a list: its elements): structure, template, shape, or file
    place  of a structure
    bare   the param or let whose number without a unit it is
    pattern  the operation that laid out the members of an array
    """

    type: Type = ANY
    reads: Reads = NOTHING_READ
    of: ast.Node | None = None
    place: ReadPlace | None = None
    bare: Symbol | None = None
    pattern: str = ""

    @property
    def is_any(self) -> bool:
        return isinstance(self.type, AnyType)

    def listed(self, times: int = 1) -> Fact:
        """Returns the fact of a list of such values, or of lists of lists."""
        kind = self.type
        for _ in range(times):
            kind = ListType(kind)
        return Fact(kind, self.reads, self.of, self.place, None, "" if times else self.pattern)

    def element(self) -> Fact:
        """Returns the fact of a member of a list of such values."""
        kind = self.type.element if isinstance(self.type, ListType) else ANY
        return replace(self, type=kind, pattern="")


UNKNOWN = Fact()


def joined(a: Fact, b: Fact) -> Fact:
    """Returns the facts that two alternative values have in common."""
    reads = a.reads | b.reads
    if a.type == b.type and a.of is b.of:
        return Fact(a.type, reads, a.of, a.place if a.place == b.place else None)
    return Fact(ANY, reads)


def is_point(kind: Type) -> bool:
    return isinstance(kind, PointType) or kind == GeometryType("point")


def is_number(kind: Type) -> bool:
    """Tells whether a type is a number, or an edge that stands for its coordinate."""
    return isinstance(kind, NumberType) or kind == GeometryType("line")


# --- Facts about names: of params, lets, loop variables, parameters, geometry and structures.


def of_symbol(check: Inference, symbol: Symbol) -> Fact:
    """Returns the fact of a name as it is declared."""
    match symbol.kind:
        case SymbolKind.BUILTIN:
            return _builtin(check, symbol)
        case SymbolKind.NAMESPACE:
            return UNKNOWN
        case SymbolKind.STRUCTURE if symbol.scope is None:  # its own name, inside the structure
            return _structure_itself(symbol.node)
        case SymbolKind.LOOP:
            return _loop_variable(check, symbol)
        case SymbolKind.ARGUMENT:
            assert isinstance(symbol.node, ast.Parameter)
            return Fact(parameter_type(symbol.node) or ANY)
        case _:
            return _declared(check, symbol)


def _builtin(check: Inference, symbol: Symbol) -> Fact:
    if symbol.name == "self":
        return _structure_itself(check.homes[-1])
    if symbol.name in builtins.STRUCTURE:
        return Fact(builtins.STRUCTURE[symbol.name])
    let = check.resolution.library.constants.get(symbol.name)
    if let is None or not isinstance(let.value, ast.Number | ast.String | ast.Boolean):
        return UNKNOWN
    return check.fact(let.value)


def _structure_itself(node: ast.Node | None) -> Fact:
    if not isinstance(node, ast.Structure):
        return UNKNOWN
    place = ReadPlace(node)
    return Fact(StructureType(), frozenset({place}), node, place)


def _loop_variable(check: Inference, symbol: Symbol) -> Fact:
    loop = symbol.node
    assert isinstance(loop, ast.For | ast.ForArguments | ast.Comprehension)
    if len(loop.variables) > 1:
        return UNKNOWN
    if (run := check.facts.get(loop.iterable)) is None:
        return UNKNOWN
    if isinstance(run.type, RangeType):
        return Fact(NumberType(None, whole=True)) if _is_plain_range(loop.iterable) else UNKNOWN
    element = run.element()
    return Fact(ANY, element.reads) if isinstance(element.type, NumberType) else element


def _declared(check: Inference, symbol: Symbol) -> Fact:
    """Returns the fact of a declared name; of several declarations, what they have in common."""
    facts = [_declaration(check, symbol, node) for node in symbol.nodes]
    fact = reduce(joined, facts) if facts else UNKNOWN
    if isinstance(fact.type, NumberType) and fact.type.dimension is None and not fact.reads:
        fact = replace(fact, bare=symbol)
    return fact


def _declaration(check: Inference, symbol: Symbol, node: ast.Node) -> Fact:
    if node in check.running:
        return UNKNOWN  # a cycle, which is reported when its names are checked
    check.running.add(node)
    assert symbol.scope is not None
    before, check.homes = check.homes, symbol.scope.homes
    try:
        return _value_of(check, symbol, node)
    finally:
        check.homes = before
        check.running.discard(node)


def _value_of(check: Inference, symbol: Symbol, node: ast.Node) -> Fact:
    home = check.homes[-1]
    match node:
        case ast.Param():
            return _param(check, node)
        case ast.Let(value=value):
            return check.fact(value)
        case ast.Var(value=value):
            kind = check.fact(value).type
            if isinstance(kind, NumberType):  # that the solver finds: not whole, and if bare of any dimension
                kind = ANY if kind.dimension is None else NumberType(kind.dimension)
            return Fact(kind, frozenset({ReadPlace(home)}))
        case ast.Structure(indices=indices):
            place = ReadPlace(home, (symbol.name,))
            return Fact(StructureType(), frozenset({place}), node, place).listed(len(indices))
        case ast.Assign(value=value, indices=indices):
            fact = check.fact(value)
            is_made = symbol.kind is SymbolKind.GEOMETRY
            if isinstance(fact.type, StructureType) or (is_made and _holds_structures(fact.type)):
                place = ReadPlace(home, (symbol.name,))
                fact = replace(fact, reads=frozenset({place}), place=place)
            elif is_made:
                # A copy of an ancestor's geometry is for the ancestor to constrain.
                far = {p for p in fact.reads if p.holder is not home}
                fact = replace(fact, reads=frozenset({ReadPlace(home), *far}))
            return fact.listed(len(indices))
        case _:
            return UNKNOWN


def _holds_structures(kind: Type) -> bool:
    while isinstance(kind, ListType):
        kind = kind.element
    return isinstance(kind, StructureType)


def _param(check: Inference, node: ast.Param) -> Fact:
    fact = check.fact(node.value)
    if not isinstance(fact.type, NumberType):
        return fact
    dimension = fact.type.dimension
    if dimension is None and isinstance(node.domain, ast.Range):
        for end in (node.domain.start, node.domain.end):
            bound = check.fact(end).type
            if isinstance(bound, NumberType) and bound.dimension is not None:
                dimension = bound.dimension
    return Fact(NumberType(dimension, whole=dimension is None))


def _is_plain_range(node: ast.Expression) -> bool:
    return isinstance(node, ast.Range) and not any(
        isinstance(n, ast.Number) and n.unit is not None for n in ast.walk(node)
    )


# --- Facts about the library's own definitions. They see nothing of a program, so each is found once.

CONSTANT = frozenset({"len", "written"})
"""Functions whose results are constants even for unknowns."""


def body_of(check: Inference, definition: ast.Node) -> SymbolScope:
    """Returns the scope of the body of a structure or a definition."""
    if check.is_standard(definition):
        return check.of_standard(body_of, definition)
    return check.resolution.scope_of(definition)


def part(check: Inference, definition: ast.Node, key: str) -> Fact:
    """Returns the fact of a name that a body declares."""
    if check.is_standard(definition):
        return check.of_standard(part, definition, key)
    return of_symbol(check, body_of(check, definition).values[key])


def result(check: Inference, definition: ast.FunctionDefinition) -> tuple[Fact, bool]:
    """Returns the fact of a function's expression, and whether it depends on solved values of arguments."""
    if check.is_standard(definition):
        return check.of_standard(result, definition)
    before, check.homes = check.homes, body_of(check, definition).homes
    try:
        return check.fact(definition.value), _reads_arguments(definition)
    finally:
        check.homes = before


def _reads_arguments(definition: ast.FunctionDefinition) -> bool:
    names = {parameter.name.text for parameter in definition.parameters}
    stack: list[ast.Node] = [definition.value]
    while stack:
        match stack.pop():
            case ast.Name(text) if text in names:
                return True
            case ast.Call(callee=callee) if fold(callee.text) in CONSTANT:
                pass
            case node:
                stack.extend(ast.children(node))
    return False


# --- Arithmetic, vectors and comparisons: the operands that go together, and the types of the results.


def unary(check: Inference, node: ast.Unary) -> Fact:
    if node.operator == "not":
        return Fact(TruthType(), check.wants(node.operand, "a condition", TruthType).reads)
    fact = check.fact(node.operand)
    return fact if isinstance(fact.type, PointType) else check.numeric(node.operand)


def binary(check: Inference, node: ast.Binary) -> Fact:
    if node.operator in ("and", "or"):
        sides = [check.wants(n, "a condition", TruthType) for n in (node.left, node.right)]
        return Fact(TruthType(), sides[0].reads | sides[1].reads)
    left, right = check.fact(node.left), check.fact(node.right)
    reads = left.reads | right.reads
    if left.is_any or right.is_any or isinstance(left.type, ListType) or isinstance(right.type, ListType):
        return Fact(ANY, reads)
    if node.operator == "+" and isinstance(left.type, TextType) and isinstance(right.type, TextType):
        return Fact(TextType(), reads)
    if is_point(left.type) or is_point(right.type):
        return _vector(check, node, left, right)
    left, right = check.numeric(node.left), check.numeric(node.right)
    if not isinstance(left.type, NumberType) or not isinstance(right.type, NumberType):
        return Fact(ANY, reads)
    return _arithmetic(check, node, left, right, left.type, right.type)


def _vector(check: Inference, node: ast.Binary, left: Fact, right: Fact) -> Fact:
    points = is_point(left.type), is_point(right.type)
    numbers = isinstance(left.type, NumberType), isinstance(right.type, NumberType)
    op = node.operator
    if (
        (all(points) and op in "+-")
        or (points[0] and numbers[1] and op in "*/")
        or (numbers[0] and op == "*")
    ):
        return Fact(PointType(), left.reads | right.reads)
    misfit = rules.no_vectors(op, left.type, right.type, shown(node.left), shown(node.right))
    sides = ((node.left, left, right), (node.right, right, left))
    for side, fact, other in sides:
        if isinstance(side, ast.Member) and (text := _meant_point(check, side, fact, other)) is not None:
            hints = misfit.hints
            if isinstance(fact.type, GeometryType):
                hints = (f"`{shown(side)}` is {a(fact.type)} of the outline; the corner is `{text}`",)
            fix = Fix(f"write `{text}`", (Edit(side.span, text),))
            return check.misfit(replace(misfit, hints=hints), node, fix)
    return check.misfit(misfit, node)


def _meant_point(check: Inference, node: ast.Member, fact: Fact, other: Fact) -> str | None:
    """Returns the point or coordinate that is meant by a member beside a point or a number:
    `plate.top_left` by the arc `plate.corner_top_left`, `disc.top.y` by the point `disc.top`.
    """
    of, name = node.value.span.text, check.resolution.canonical.get(node.name, node.name.text)
    if is_number(other.type) and isinstance(fact.type, PointType):
        axis = {"top": "y", "bottom": "y", "left": "x", "right": "x"}.get(name)
        return f"{of}.{name}.{axis}" if axis else None
    corner = name.removeprefix("corner_")
    whole = check.fact(node.value).of
    if corner == name or whole is None or not is_point(other.type):
        return None
    return f"{of}.{corner}" if corner in body_of(check, whole).values else None


def _arithmetic(
    check: Inference, node: ast.Binary, left: Fact, right: Fact, x: NumberType, y: NumberType
) -> Fact:
    reads = left.reads | right.reads
    op = node.operator
    if op == "%":
        for operand in (node.left, node.right):
            if not check.known(operand, "an operand of `%`"):
                break
    if op in "+-%":
        dimension = check.same_dimension(left, right, node, f"`{op}` does not join")
        bare = left.bare or right.bare if dimension is None else None
        return Fact(NumberType(dimension, x.whole and y.whole), reads, bare=bare)
    if op == "^":
        if x.dimension in (None, units.PLAIN):
            return Fact(NumberType(x.dimension), reads)
        return Fact(ANY, reads)
    unclear = node.left if x.dimension is None else node.right
    if (x.dimension is None) != (y.dimension is None) and not _is_plain(unclear):
        return Fact(ANY, reads)  # a bare param may be a length or a plain number, which only building shows
    combine = units.multiply if op == "*" else units.divide
    return Fact(NumberType(combine(x.dimension, y.dimension), op == "*" and x.whole and y.whole), reads)


def comparison(check: Inference, node: ast.Comparison) -> Fact:
    facts = [check.fact(operand) for operand in node.operands]
    for i, operator in enumerate(node.operators):
        compare(check, operator, node.operands[i], node.operands[i + 1], node)
    return Fact(TruthType(), frozenset().union(*(f.reads for f in facts)))


def compare(
    check: Inference, operator: str, left: ast.Expression, right: ast.Expression, node: ast.Node
) -> None:
    """Reports two sides that cannot be compared."""
    x, y = check.fact(left), check.fact(right)
    if x.is_any or y.is_any:
        return
    if is_number(x.type) and is_number(y.type):
        what = f"`{operator}` does not compare"
        check.same_dimension(check.numeric(left), check.numeric(right), node, what)
        return
    if is_point(x.type) and is_point(y.type):
        if operator not in ("==", "!="):
            check.misfit(rules.no_order(operator), node)
        return
    if isinstance(x.type, ListType) or isinstance(y.type, ListType):
        return
    if type(x.type) is type(y.type) and isinstance(x.type, TextType | TruthType) and operator in ("==", "!="):
        return
    misfit = rules.no_comparison(operator, x.type, y.type, shown(left), shown(right))
    sides = ((left, x.type, y.type), (right, y.type, x.type))
    boxed = ((side, in_box(kind, side.span.text, other)) for side, kind, other in sides)
    fix = next((Fix(f"write `{text}`", (Edit(side.span, text),)) for side, text in boxed if text), None)
    check.misfit(misfit, node, fix)


def membership(check: Inference, node: ast.Membership) -> Fact:
    value = check.fact(node.value)
    container = check.wants(node.container, "a range or a list", RangeType, ListType)
    if isinstance(node.container, ast.Range) and isinstance(container.type, RangeType):
        compare(check, ">=", node.value, node.container.start, node)
        if not isinstance(node.container.end, ast.Number):
            compare(check, "<=", node.value, node.container.end, node)
    return Fact(TruthType(), value.reads | container.reads)


def _is_plain(node: ast.Expression) -> bool:
    """Tells whether a number without a unit can only be plain: it is made of digits alone."""
    return all(isinstance(n, ast.Number | ast.Unary | ast.Binary) for n in ast.walk(node))


# --- Facts about members: of structures, shapes, primitives, points, boxes, lists and imported files.


def member(check: Inference, node: ast.Member) -> Fact:
    if (space := check.namespace(node.value)) is not None:
        return _of_file(check, node, space)
    return member_of(check, check.fact(node.value), node)


def _of_file(check: Inference, node: ast.Member, space: Symbol) -> Fact:
    assert space.scope is not None
    scope = space.scope.spaces[space.name]
    if (key := find(node.name.text, scope.values)) is None:
        return _no_member(check, node, "the file", list(scope.values))
    _means(check, node, scope.values[key])
    return of_symbol(check, scope.values[key])


def member_of(check: Inference, base: Fact, node: ast.Member) -> Fact:
    """Returns the fact of `base.name`."""
    name = node.name.text
    match base.type:
        case AnyType() | RecordType():
            return Fact(ANY, base.reads)
        case ListType():
            return _mapped(check, base, node)
        case StructureType():
            return _of_structure(check, base, node)
        case GeometryType(kind):
            if base.of is not None:
                return _of_shape(check, base, node)
            if kind in builtins.PRIMITIVE:
                return _field(check, base, node, builtins.PRIMITIVE[kind])
            return Fact(ANY, base.reads)
        case PointType():
            return _field(check, base, node, builtins.PRIMITIVE["point"])
        case BoxType():
            return _field(check, base, node, {})
        case _:
            message = f"{a(base.type)} has no members, so there is no `{shown(node.value)}.{name}`"
            return check.report("E0202", message, node.name)


def _mapped(check: Inference, base: Fact, node: ast.Member) -> Fact:
    """Returns the fact of `a.rim` for a list: of each member's; sides of a list may be those of its group."""
    settings = builtins.PATTERN.get(base.pattern, {})
    if (key := find(node.name.text, settings)) is not None:
        return Fact(settings[key], base.reads)
    element = base.element()
    if element.is_any or builtins.is_box_name(node.name.text) or find(node.name.text, builtins.BOX):
        return Fact(ANY, base.reads)
    return member_of(check, element, node).listed()


def _of_structure(check: Inference, base: Fact, node: ast.Member) -> Fact:
    if base.of is None:
        return Fact(ANY, base.reads)
    scope = check.resolution.scope_of(base.of)
    if (key := find(node.name.text, scope.values)) is None:
        if len(within := _holding(check, scope, node.name.text)) == 1:
            path, at = f"{within[0]}.{node.name.text}", node.name.span
            message = f"`{shown(node.value)}` has no `{node.name.text}`: that is in its `{within[0]}`"
            fix = Fix(f"write `{path}`", (Edit(at, path),), is_sure=True)
            return check.report("E0202", message, node.name, fix=fix)
        return _field(check, base, node, builtins.STRUCTURE, list(scope.values))
    symbol = scope.values[key]
    _means(check, node, symbol)
    if symbol.kind is SymbolKind.ARGUMENT:
        return of_symbol(check, symbol)
    fact = of_symbol(check, symbol)
    if base.place is None:
        return replace(fact, reads=base.reads if fact.reads else NOTHING_READ, place=None)
    place = fact.place and _seen(check, fact.place, base.of, base.place, symbol)
    reads = frozenset(_seen(check, p, base.of, base.place, symbol) for p in fact.reads)
    return replace(fact, place=place, reads=reads)


def _holding(check: Inference, scope: SymbolScope, name: str) -> list[str]:
    """Returns the structures in a scope that have a structure or geometry of a name that all things lack."""
    if any(find(name, table) for table in (builtins.STRUCTURE, builtins.BOX, builtins.FINISH)):
        return []
    if builtins.is_box_name(name) or fold(name) in FIELDS:
        return []
    nodes = ((key, symbol.node) for key, symbol in scope.values.items())
    inner = ((key, node) for key, node in nodes if isinstance(node, ast.Structure))
    return [key for key, node in inner if name in check.resolution.scope_of(node).values]


def _seen(check: Inference, place: ReadPlace, of: ast.Node, base: ReadPlace, symbol: Symbol) -> ReadPlace:
    """Returns a place that is given from inside a structure, or from around it, as seen from where that
    structure is named. A structure that the expression itself stands in is seen from inside.
    """
    if place.holder is not of:
        around = symbol.scope.homes if symbol.scope is not None else ()
        if place.holder in check.homes or place.holder not in around:
            return place
        outwards = len(around) - 1 - around.index(place.holder)
        return ReadPlace(base.holder, base.below[: max(len(base.below) - outwards, 0)] + place.below)
    if place.below == (symbol.name,) and symbol.node in check.homes and not symbol.is_array:
        assert symbol.node is not None
        return ReadPlace(symbol.node)
    return ReadPlace(base.holder, base.below + place.below)


def _of_shape(check: Inference, base: Fact, node: ast.Member) -> Fact:
    assert base.of is not None
    scope = body_of(check, base.of)
    if (key := find(node.name.text, scope.values)) is None:
        if find(node.name.text, dict.fromkeys(builtins.OUTLINE)):
            return Fact(ANY, base.reads)
        return _field(check, base, node, {}, list(scope.values))
    _means(check, node, scope.values[key])
    return replace(part(check, base.of, key), reads=base.reads, place=None, bare=None)


def _field(
    check: Inference, base: Fact, node: ast.Member, own: Mapping[str, Type], known: Sequence[str] = ()
) -> Fact:
    """Returns the fact of a field of a primitive or a structure, or of one of the box that everything has."""
    name = node.name.text
    if builtins.is_box_name(name):
        return Fact(BoxType(), base.reads)
    for table in (own, builtins.BOX, builtins.FINISH):
        if (key := find(name, table)) is not None:
            _means(check, node, Symbol(key, SymbolKind.FIELD))
            return Fact(table[key], base.reads)
    names = [*known, *own, *builtins.BOX]
    meant = next((m for m in MEMBERS.get(fold(name), ()) if find(m, dict.fromkeys(names))), None)
    if meant is not None:
        return _in_other_words(check, base, node, meant)
    return _no_member(check, node, a(base.type), names)


def _in_other_words(check: Inference, base: Fact, node: ast.Member, meant: str) -> Fact:
    """Returns the fact of a field named by a synonym: `c.r` for `c.radius`."""
    name = ast.Identifier(meant, span=node.name.span)
    other = ast.Member(node.value, name, span=node.span)
    fact = member_of(check, base, other)
    check.resolution.canonical[node.name] = check.resolution.canonical.get(name, meant)
    if (symbol := check.resolution.uses.get(other)) is not None:
        check.resolution.uses[node] = symbol
    return fact


def _means(check: Inference, node: ast.Member, symbol: Symbol) -> None:
    check.resolution.uses[node] = symbol
    if symbol.name != node.name.text:
        check.resolution.canonical[node.name] = symbol.name


def _function_or_coordinate(check: Inference, node: ast.Member, known: Sequence[str]) -> Fact | None:
    """Reports `plate.area`, a function here, and `c.x` of something with a width. None for other names."""
    name, of = node.name.text, node.value.span.text
    if fold(name) in ("area", "perimeter", "circumference"):
        function = "area" if fold(name) == "area" else "perimeter"
        message = f"`{function}` is a function and has to be called: `{function}({shown(node.value)})`"
        fix = Fix(f"write `{function}(…)`", (Edit(node.span, f"{function}({of})"),), is_sure=True)
        return check.report("E0206", message, node.name, fix=fix)
    if fold(name) in ("x", "y") and "center" in known and "width" in known:
        side = "left" if fold(name) == "x" else "bottom"
        message = f"`{shown(node.value)}` has no `{name}`: it has a centre and sides"
        hint = f"write `{shown(node.value)}.center.{name}`, or a side, as `{shown(node.value)}.{side}`"
        fix = Fix(f"write `center.{name}`", (Edit(node.name.span, f"center.{name}"),))
        return check.report("E0202", message, node.name, hints=[hint], fix=fix)
    if "rotation" in known and fold(name) in ("angle", "orientation", "tilt", "theta", "rotate"):
        message = f"`{shown(node.value)}` has no `{name}`: how a structure is turned is its `rotation`"
        return check.report("E0202", message, node.name, fix=renamed(node.name, "rotation"))
    return None


def _no_member(check: Inference, node: ast.Member, what: str, known: Sequence[str]) -> Fact:
    name = node.name.text
    if (answer := _function_or_coordinate(check, node, known)) is not None:
        return answer
    like = nearest(name, known, 2)
    members = f"its members are {first_few(ticked(dict.fromkeys(known)), 8, '')}, …"
    if fold(name) in ("apex", "tip", "peak") and {"a", "b", "c", "centroid"} <= set(known):
        like, members = [], "its corners are `a`, `b` and `c`, in the order in which they were given"
    message = f"`{shown(node.value)}` has no `{name}`" + did_you_mean(like)
    label = f"not a member of {what}"
    hints = () if like else (members,) if known else ()
    return check.report("E0202", message, node.name, label=label, hints=hints, fix=respell(node.name, like))
