"""Types and dependences of expressions, each found once.

The check is gradual: what is known only when the program is built has the type ANY, which is accepted everywhere,
and after an error the type is ANY too, so that one mistake is reported once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from aidl_lang import ast, units
from aidl_lang.checking import members
from aidl_lang.checking.facts import NOTHING_READ, UNKNOWN, Fact, Place, joined
from aidl_lang.checking.wording import a, comparison_hint, shown
from aidl_lang.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.names import find, nearest
from aidl_lang.resolve import Resolution
from aidl_lang.resolving.symbols import Symbol, SymbolKind
from aidl_lang.source import Span
from aidl_lang.types import (
    ANY,
    PARAMETER_TYPES,
    AnyType,
    BoxType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RangeType,
    StructureType,
    TextType,
    TruthType,
    Type,
)
from aidl_lang.units import ANGLE, LENGTH, UNITS, MaybeDimension


class Inference:
    """Facts about the expressions of one program, and the diagnostics that finding them gave."""

    def __init__(self, resolution: Resolution) -> None:
        self.resolution = resolution
        self.facts: dict[ast.Node, Fact] = {}
        self.diagnostics: list[Diagnostic] = []
        self.homes: tuple[ast.Node, ...] = (resolution.main,)
        self._library = frozenset(resolution.library.sources)
        self._running: set[ast.Node] = set()
        self._served: dict[Symbol, tuple[MaybeDimension, ast.Node]] = {}

    # --- Reporting -----------------------------------------------------------------------------

    def report(
        self,
        code: str,
        message: str,
        node: ast.Node,
        label: str = "",
        hints: Sequence[str] = (),
        secondary: Sequence[Label] = (),
        fix: Fix | None = None,
    ) -> Fact:
        """Say what is wrong in a program (the library has tests of its own); nothing is known of the result."""
        if node.span.source not in self._library:
            self.diagnostics.append(
                Diagnostic(code, message, node.span, label, tuple(secondary), tuple(hints), fix)
            )
        return UNKNOWN

    def wants(self, node: ast.Expression, what: str, *allowed: type[Type]) -> Fact:
        """The fact of an expression that has to be of one of some types."""
        fact = self.fact(node)
        if isinstance(fact.type, (AnyType, *allowed)):
            return fact
        return self.report("E0302", f"{what} is needed here, and this is {a(fact.type)}", node)

    def known(self, node: ast.Expression, what: str) -> bool:
        """Report an expression whose value the solver finds where one is needed while building."""
        if not self.fact(node).reads:
            return True
        self.report(
            "E0501",
            f"{what} must be known before solving, and `{shown(node)}` is found by the solver",
            node,
            label="depends on unknowns",
            hints=[
                "use a `param`, a `let` of constants, a loop variable, or `written(…)` for the value as written"
            ],
        )
        return False

    def test(self, node: ast.Expression) -> None:
        """A condition that chooses what is built."""
        fact = self.wants(node, "a condition", TruthType)
        if fact.reads:
            self.report(
                "E0502",
                f"`{shown(node)}` is decided by the solver, so it cannot choose what is built",
                node,
                label="depends on unknowns",
                hints=["compare `param`s and constants, or use `written(…)` for the value as written"],
            )

    # --- Expressions ---------------------------------------------------------------------------

    def fact(self, node: ast.Node) -> Fact:
        known = self.facts.get(node)
        if known is None:
            known = self.facts[node] = _INFER[type(node)](self, node)
        return known

    def _number(self, node: ast.Number) -> Fact:
        dimension = UNITS[node.unit][1] if node.unit else None
        return Fact(NumberType(dimension, whole=dimension is None and node.value == int(node.value)))

    def _name(self, node: ast.Name) -> Fact:
        symbol = self.resolution.uses.get(node)
        return self.of_symbol(symbol) if symbol is not None else UNKNOWN

    def _point(self, node: ast.Point) -> Fact:
        reads = NOTHING_READ
        for part in (node.x, node.y):
            fact = self.numeric(part)
            reads |= fact.reads
            if isinstance(fact.type, NumberType):
                self.serves(fact, LENGTH, part)
                if fact.type.dimension not in (None, LENGTH):
                    self.report(
                        "E0301",
                        f"a coordinate must be a length, and `{shown(part)}` is {a(fact.type)}",
                        part,
                    )
        return Fact(PointType(), reads)

    def numeric(self, node: ast.Expression) -> Fact:
        """The fact of an operand that has to be a number; an edge stands for its coordinate."""
        fact = self.fact(node)
        match fact.type:
            case NumberType() | AnyType():
                return fact
            case GeometryType("line"):
                return Fact(NumberType(LENGTH), fact.reads)
            case _:
                return self.report("E0302", f"a number is needed here, and this is {a(fact.type)}", node)

    def _list(self, node: ast.List) -> Fact:
        facts = [self.fact(item) for item in node.items]
        if not facts:
            return Fact(ListType(ANY, 0))
        reads = frozenset().union(*(f.reads for f in facts))
        first = facts[0]
        kinds = {_loose(f.type) for f in facts}
        kind = first.type if len({f.type for f in facts}) == 1 else kinds.pop() if len(kinds) == 1 else ANY
        same = all(f.of is first.of for f in facts)
        return Fact(ListType(kind, len(facts)), reads, first.of if same else None)

    def _comprehension(self, node: ast.Comprehension) -> Fact:
        reads = self.iterable(node.iterable, len(node.variables)).reads
        if node.condition is not None:
            self.test(node.condition)
        element = self.fact(node.element)
        return replace(element.listed(), reads=element.reads | reads)

    def iterable(self, node: ast.Expression, variables: int = 1) -> Fact:
        """The fact of what a `for` runs through."""
        fact = self.fact(node)
        match fact.type:
            case RangeType():
                self.known(node, "the ends of a range that is run through")
                return Fact(fact.type)
            case ListType() | AnyType():
                return fact
            case NumberType():
                return self.report(
                    "E0304",
                    f"`for` runs through a range or a list, and this is {a(fact.type)}",
                    node,
                    hints=[f"`0..<{shown(node)}` counts from 0 up to it"],
                    fix=Fix(f"write `0..<{shown(node)}`", (Edit(_at(node), "0..<"),))
                    if isinstance(node, ast.Name | ast.Number | ast.Member | ast.Call)
                    else None,
                )
            case _:
                return self.report(
                    "E0304",
                    f"`for` runs through a range or a list, and this is {a(fact.type)}",
                    node,
                    hints=["as in `for i in 0..9 { … }` or `for s in [-1, 1] { … }`"],
                )

    def _range(self, node: ast.Range) -> Fact:
        start, end = self.numeric(node.start), self.numeric(node.end)
        self.same_dimension(start, end, node, "a range does not join")
        return Fact(RangeType(), start.reads | end.reads)

    def _conditional(self, node: ast.Conditional) -> Fact:
        self.test(node.test)
        then, otherwise = self.fact(node.then), self.fact(node.otherwise)
        if isinstance(then.type, NumberType) and isinstance(otherwise.type, NumberType):
            return Fact(_loose_number(then.type, otherwise.type), then.reads | otherwise.reads)
        return joined(then, otherwise)

    def _index(self, node: ast.Index) -> Fact:
        fact = self.fact(node.value)
        self.whole(node.index, "an index")
        match fact.type:
            case ListType():
                return fact.element()
            case AnyType():
                return Fact(ANY, fact.reads)
            case _:
                return self.report(
                    "E0305", f"`{shown(node.value)}` is {a(fact.type)} and has no members by number", node
                )

    def whole(self, node: ast.Expression, what: str) -> None:
        """An expression that has to be a whole number known while building."""
        fact = self.fact(node)
        match fact.type:
            case AnyType():
                self.known(node, what)
            case NumberType(dimension):
                is_fraction = isinstance(node, ast.Number) and node.value != int(node.value)
                if dimension not in (None, units.PLAIN) or is_fraction:
                    self.report("E0306", f"{what} must be a whole number, and this is `{shown(node)}`", node)
                else:
                    self.known(node, what)
            case _:
                self.report("E0302", f"{what} must be a whole number, not {a(fact.type)}", node)

    # --- Names ---------------------------------------------------------------------------------

    def of_symbol(self, symbol: Symbol) -> Fact:
        """What is known of a name where it is declared."""
        match symbol.kind:
            case SymbolKind.BUILTIN:
                return self._builtin(symbol)
            case SymbolKind.NAMESPACE:
                return UNKNOWN
            case SymbolKind.STRUCTURE if symbol.scope is None:  # a structure's own name, inside it
                return self._structure_itself(symbol.node)
            case SymbolKind.LOOP:
                return self._loop_variable(symbol)
            case SymbolKind.ARGUMENT:
                return self._argument(symbol)
            case _:
                return self._declared(symbol)

    def _builtin(self, symbol: Symbol) -> Fact:
        if symbol.name == "self":
            return self._structure_itself(self.homes[-1])
        if symbol.name in members.STRUCTURE:
            return Fact(members.STRUCTURE[symbol.name])
        let = self.resolution.library.constants.get(symbol.name)
        return UNKNOWN if let is None else self._literal(let.value)

    def _literal(self, node: ast.Expression) -> Fact:
        return self.fact(node) if isinstance(node, ast.Number | ast.String | ast.Boolean) else UNKNOWN

    def _structure_itself(self, node: ast.Node | None) -> Fact:
        if not isinstance(node, ast.Structure):
            return UNKNOWN
        place = Place(node)
        return Fact(StructureType(), frozenset({place}), node, place)

    def _loop_variable(self, symbol: Symbol) -> Fact:
        loop = symbol.node
        assert isinstance(loop, ast.For | ast.Comprehension)
        if len(loop.variables) > 1:
            return UNKNOWN
        run = self.facts.get(loop.iterable)
        if run is None:
            return UNKNOWN
        if isinstance(run.type, RangeType):
            return Fact(NumberType(None, whole=True)) if _is_plain_range(loop.iterable) else UNKNOWN
        element = run.element()
        return Fact(ANY, element.reads) if isinstance(element.type, NumberType) else element

    def _argument(self, symbol: Symbol) -> Fact:
        parameter = symbol.node
        assert isinstance(parameter, ast.Parameter)
        if parameter.type is None:
            return UNKNOWN
        word = find(parameter.type.text, PARAMETER_TYPES)
        return Fact(PARAMETER_TYPES[word]) if word else UNKNOWN

    def _declared(self, symbol: Symbol) -> Fact:
        """The value of a declared name; of several declarations, what they have in common."""
        fact: Fact | None = None
        for node in symbol.nodes:
            one = self._declaration(symbol, node)
            fact = one if fact is None else joined(fact, one)
        fact = fact or UNKNOWN
        if isinstance(fact.type, NumberType) and fact.type.dimension is None and not fact.reads:
            fact = replace(fact, bare=symbol)
        return fact

    def _declaration(self, symbol: Symbol, node: ast.Node) -> Fact:
        if node in self._running:
            return UNKNOWN  # a cycle, which is reported when its names are checked
        self._running.add(node)
        assert symbol.scope is not None
        before, self.homes = self.homes, symbol.scope.homes
        try:
            return self._value_of(symbol, node)
        finally:
            self.homes = before
            self._running.discard(node)

    def _value_of(self, symbol: Symbol, node: ast.Node) -> Fact:
        home = self.homes[-1]
        match node:
            case ast.Param():
                return self._param(node)
            case ast.Let(value=value):
                return self.fact(value)
            case ast.Var(value=value):
                return Fact(_unlocked(self.fact(value).type), frozenset({Place(home)}))
            case ast.Structure(indices=indices):
                place = Place(home, (symbol.name,))
                return Fact(StructureType(), frozenset({place}), node, place).listed(len(indices))
            case ast.Assign(value=value, indices=indices):
                fact = self.fact(value)
                if isinstance(fact.type, StructureType):
                    place = Place(home, (symbol.name,))
                    fact = replace(fact, reads=frozenset({place}), place=place)
                elif symbol.kind is SymbolKind.GEOMETRY:
                    fact = fact.reading(frozenset({Place(home)}))
                return fact.listed(len(indices))
            case _:
                return UNKNOWN

    def _param(self, node: ast.Param) -> Fact:
        fact = self.fact(node.value)
        if not isinstance(fact.type, NumberType):
            return fact
        dimension = fact.type.dimension
        if dimension is None and isinstance(node.domain, ast.Range):
            for end in (node.domain.start, node.domain.end):
                bound = self.fact(end).type
                if isinstance(bound, NumberType) and bound.dimension is not None:
                    dimension = bound.dimension
        return Fact(NumberType(dimension, whole=dimension is None))

    # --- Members -------------------------------------------------------------------------------

    def _member(self, node: ast.Member) -> Fact:
        if isinstance(node.value, ast.Name):
            symbol = self.resolution.uses.get(node.value)
            if symbol is not None and symbol.kind is SymbolKind.NAMESPACE:
                return self._of_file(node, symbol)
        return self.member(self.fact(node.value), node)

    def _of_file(self, node: ast.Member, space: Symbol) -> Fact:
        assert space.scope is not None
        if (scope := space.scope.spaces.get(space.name)) is None:
            return UNKNOWN
        key = find(node.name.text, scope.values)
        if key is None:
            return self._no_member(node, "the file", list(scope.values))
        self._means(node, scope.values[key])
        return self.of_symbol(scope.values[key])

    def member(self, base: Fact, node: ast.Member) -> Fact:
        """`base.name`"""
        name = node.name.text
        match base.type:
            case AnyType():
                return Fact(ANY, base.reads)
            case ListType():
                return self._mapped(base, node)
            case StructureType():
                return self._of_structure(base, node)
            case GeometryType(kind):
                if base.of is not None:
                    return self._of_shape(base, node)
                if (fields := members.PRIMITIVE.get(kind)) is not None:
                    return self._field(base, node, fields)
                return Fact(ANY, base.reads)
            case PointType():
                return self._field(base, node, members.PRIMITIVE["point"])
            case BoxType():
                return self._field(base, node, {})
            case _:
                return self.report(
                    "E0202",
                    f"{a(base.type)} has no members, so there is no `{shown(node.value)}.{name}`",
                    node.name,
                )

    def _mapped(self, base: Fact, node: ast.Member) -> Fact:
        """`a.rim` of a list runs through its members; sides of a list may be those of its group."""
        element = base.element()
        if element.is_any or members.is_box_name(node.name.text) or find(node.name.text, members.BOX):
            return Fact(ANY, base.reads)
        return self.member(element, node).listed()

    def _of_structure(self, base: Fact, node: ast.Member) -> Fact:
        if base.of is None:
            return Fact(ANY, base.reads)
        scope = self.resolution.scope_of(base.of)
        key = find(node.name.text, scope.values)
        if key is None:
            return self._field(base, node, members.STRUCTURE, list(scope.values))
        symbol = scope.values[key]
        self._means(node, symbol)
        if symbol.kind is SymbolKind.ARGUMENT:
            return self.of_symbol(symbol)
        fact = self.of_symbol(symbol)
        if base.place is None:
            return replace(fact, reads=base.reads if fact.reads else NOTHING_READ, place=None)
        place = fact.place and self._seen(fact.place, base.of, base.place, symbol)
        reads = frozenset(self._seen(p, base.of, base.place, symbol) for p in fact.reads)
        return replace(fact, place=place, reads=reads)

    def _seen(self, place: Place, of: ast.Node, base: Place, symbol: Symbol) -> Place:
        """A place told from inside a structure, as it is from where that structure is named. A structure that
        the expression itself stands in is seen from inside.
        """
        if place.holder is not of:
            return place
        if place.below == (symbol.name,) and symbol.node in self.homes and not symbol.is_array:
            assert symbol.node is not None
            return Place(symbol.node)
        return Place(base.holder, base.below + place.below)

    def _of_shape(self, base: Fact, node: ast.Member) -> Fact:
        assert base.of is not None
        scope = self.resolution.scope_of(base.of)
        key = find(node.name.text, scope.values)
        if key is None:
            if find(node.name.text, dict.fromkeys(members.OUTLINE)):
                return Fact(ANY, base.reads)
            return self._field(base, node, {}, list(scope.values))
        symbol = scope.values[key]
        self._means(node, symbol)
        fact = self.of_symbol(symbol)
        return replace(fact, reads=base.reads, place=None, bare=None)

    def _field(
        self, base: Fact, node: ast.Member, fields: Mapping[str, Type], known: Sequence[str] = ()
    ) -> Fact:
        """A field of a primitive or a structure, or one of the box that everything has."""
        name = node.name.text
        if members.is_box_name(name):
            return Fact(BoxType(), base.reads)
        for table in (fields, members.BOX):
            key = find(name, table)
            if key is not None:
                self._means(node, Symbol(key, SymbolKind.FIELD))
                return Fact(table[key], base.reads)
        return self._no_member(node, a(base.type), [*known, *fields, *members.BOX])

    def _means(self, node: ast.Member, symbol: Symbol) -> None:
        self.resolution.uses[node] = symbol
        if symbol.name != node.name.text:
            self.resolution.canonical[node.name] = symbol.name

    def _no_member(self, node: ast.Member, what: str, known: Sequence[str]) -> Fact:
        name = node.name.text
        like = nearest(name, known)
        shown_names = ", ".join(f"`{n}`" for n in list(dict.fromkeys(known))[:8])
        return self.report(
            "E0202",
            f"`{shown(node.value)}` has no `{name}`" + (f"; did you mean `{like[0]}`?" if like else ""),
            node.name,
            label=f"not a member of {what}",
            hints=() if like else (f"its members are {shown_names}, …",) if known else (),
            fix=Fix(f"write `{like[0]}`", (Edit(node.name.span, like[0]),)) if like else None,
        )

    # --- Operators -----------------------------------------------------------------------------

    def _unary(self, node: ast.Unary) -> Fact:
        if node.operator == "not":
            return Fact(TruthType(), self.wants(node.operand, "a condition", TruthType).reads)
        fact = self.fact(node.operand)
        return fact if isinstance(fact.type, PointType) else self.numeric(node.operand)

    def _binary(self, node: ast.Binary) -> Fact:
        if node.operator in ("and", "or"):
            sides = [self.wants(n, "a condition", TruthType) for n in (node.left, node.right)]
            return Fact(TruthType(), sides[0].reads | sides[1].reads)
        left, right = self.fact(node.left), self.fact(node.right)
        reads = left.reads | right.reads
        if left.is_any or right.is_any or isinstance(left.type, ListType) or isinstance(right.type, ListType):
            return Fact(ANY, reads)
        if is_point(left.type) or is_point(right.type):
            return self._vector(node, left, right)
        left, right = self.numeric(node.left), self.numeric(node.right)
        if not isinstance(left.type, NumberType) or not isinstance(right.type, NumberType):
            return Fact(ANY, reads)
        return self._arithmetic(node, left, right, left.type, right.type)

    def _vector(self, node: ast.Binary, left: Fact, right: Fact) -> Fact:
        points = is_point(left.type), is_point(right.type)
        numbers = isinstance(left.type, NumberType), isinstance(right.type, NumberType)
        op = node.operator
        if (
            (all(points) and op in "+-")
            or (points[0] and numbers[1] and op in "*/")
            or (numbers[0] and op == "*")
        ):
            return Fact(PointType(), left.reads | right.reads)
        hint = "points take `+` and `-` with points, `*` and `/` with numbers; see also `dot` and `cross`"
        if op in "+-" and any(numbers):
            hint = "to move a point, add a point: `p + (dx, dy)`"
        return self.report(
            "E0307", f"`{op}` does not work on {a(left.type)} and {a(right.type)}", node, hints=[hint]
        )

    def _arithmetic(self, node: ast.Binary, left: Fact, right: Fact, x: NumberType, y: NumberType) -> Fact:
        reads = left.reads | right.reads
        op = node.operator
        if op == "%":
            for operand in (node.left, node.right):
                if not self.known(operand, "an operand of `%`"):
                    break
        if op in "+-%":
            dimension = self.same_dimension(left, right, node, f"`{op}` does not join")
            bare = left.bare or right.bare if dimension is None else None
            return Fact(NumberType(dimension, x.whole and y.whole), reads, bare=bare)
        if op == "^":
            if x.dimension in (None, units.PLAIN):
                return Fact(NumberType(x.dimension), reads)
            return Fact(ANY, reads)
        if (x.dimension is None) != (y.dimension is None) and not _is_plain(
            node.left if x.dimension is None else node.right
        ):
            return Fact(ANY, reads)  # a bare param may be a length or a plain number: building tells
        combine = units.multiply if op == "*" else units.divide
        return Fact(NumberType(combine(x.dimension, y.dimension), op == "*" and x.whole and y.whole), reads)

    def same_dimension(self, left: Fact, right: Fact, node: ast.Node, what: str) -> MaybeDimension:
        """The common dimension of two numbers; reported when there is none."""
        if not isinstance(left.type, NumberType) or not isinstance(right.type, NumberType):
            return None
        x, y = left.type.dimension, right.type.dimension
        try:
            common = units.add(x, y)
        except ValueError:
            self.report(
                "E0308",
                f"{what} {a(left.type)} and {a(right.type)}",
                node,
                hints=["both sides need the same dimension; units are written as in `30deg`, `4mm`"],
            )
            return None
        for side in (left, right):
            self.serves(side, common, node)
        return common

    def serves(self, fact: Fact, dimension: MaybeDimension, node: ast.Node) -> None:
        """A number without a unit is used as a length or as an angle: one name may not serve as both."""
        if fact.bare is None or dimension not in (LENGTH, ANGLE):
            return
        earlier = self._served.setdefault(fact.bare, (dimension, node))
        if earlier[0] == dimension or earlier[0] is None:
            return
        self._served[fact.bare] = (None, node)  # said once
        words = {LENGTH: ("a length", "mm"), ANGLE: ("an angle", "deg")}
        first, unit = words[earlier[0]]
        declared = fact.bare.declarations[:1]
        self.report(
            "E0320",
            f"`{fact.bare.name}` has no unit and is used both as {first} and as {words[dimension][0]}",
            node,
            label=f"as {words[dimension][0]}",
            secondary=[
                Label(earlier[1].span, f"as {first}"),
                *(Label(d.span, "declared here") for d in declared),
            ],
            hints=[
                f"write its unit where it is declared, as in `10{unit}`, and use another name for the other"
            ],
        )

    def _comparison(self, node: ast.Comparison) -> Fact:
        facts = [self.fact(operand) for operand in node.operands]
        for i, operator in enumerate(node.operators):
            self.compare(operator, node.operands[i], node.operands[i + 1], node)
        return Fact(TruthType(), frozenset().union(*(f.reads for f in facts)))

    def compare(self, operator: str, left: ast.Expression, right: ast.Expression, node: ast.Node) -> None:
        """Report two sides that cannot be compared."""
        x, y = self.fact(left), self.fact(right)
        if x.is_any or y.is_any:
            return
        if isinstance(x.type, NumberType | GeometryType) and isinstance(y.type, NumberType | GeometryType):
            if _is_number(x.type) and _is_number(y.type):
                self.same_dimension(
                    self.numeric(left), self.numeric(right), node, f"`{operator}` does not compare"
                )
                return
        if is_point(x.type) and is_point(y.type):
            if operator not in ("==", "!="):
                self.report(
                    "E0309",
                    f"points have no order, so `{operator}` does not compare them",
                    node,
                    hints=["compare coordinates, as in `a.x <= b.x`"],
                )
            return
        if isinstance(x.type, ListType) or isinstance(y.type, ListType):
            return
        if (
            type(x.type) is type(y.type)
            and isinstance(x.type, TextType | TruthType)
            and operator in ("==", "!=")
        ):
            return
        self.report(
            "E0309",
            f"`{operator}` does not compare {a(x.type)} with {a(y.type)}",
            node,
            hints=[comparison_hint(x.type, y.type, shown(left), shown(right))],
        )

    def _membership(self, node: ast.Membership) -> Fact:
        value, container = (
            self.fact(node.value),
            self.wants(node.container, "a range or a list", RangeType, ListType),
        )
        if isinstance(node.container, ast.Range) and isinstance(container.type, RangeType):
            self.compare(">=", node.value, node.container.start, node)
            if not isinstance(node.container.end, ast.Number):
                self.compare("<=", node.value, node.container.end, node)
        return Fact(TruthType(), value.reads | container.reads)

    def _call(self, node: ast.Call) -> Fact:
        from aidl_lang.checking.calls import call

        return call(self, node)


_INFER: dict[type, Callable[..., Fact]] = {
    ast.Number: Inference._number,
    ast.String: lambda self, node: Fact(TextType()),
    ast.Boolean: lambda self, node: Fact(TruthType()),
    ast.Name: Inference._name,
    ast.Member: Inference._member,
    ast.Index: Inference._index,
    ast.Call: Inference._call,
    ast.Point: Inference._point,
    ast.List: Inference._list,
    ast.Comprehension: Inference._comprehension,
    ast.Unary: Inference._unary,
    ast.Binary: Inference._binary,
    ast.Comparison: Inference._comparison,
    ast.Membership: Inference._membership,
    ast.Range: Inference._range,
    ast.Conditional: Inference._conditional,
}


def is_point(kind: Type) -> bool:
    return isinstance(kind, PointType) or kind == GeometryType("point")


def _is_number(kind: Type) -> bool:
    """A number, or an edge that stands for its coordinate."""
    return isinstance(kind, NumberType) or kind == GeometryType("line")


def _is_plain(node: ast.Expression) -> bool:
    """Whether a number without a unit can only be plain: it is made of digits and loop variables' arithmetic."""
    return all(isinstance(n, ast.Number | ast.Unary | ast.Binary) for n in ast.walk(node))


def _is_plain_range(node: ast.Expression) -> bool:
    return isinstance(node, ast.Range) and not any(
        isinstance(n, ast.Number) and n.unit is not None for n in ast.walk(node)
    )


def _loose(kind: Type) -> Type:
    """A type without what may differ among the members of a list."""
    return NumberType(kind.dimension, whole=kind.dimension is None) if isinstance(kind, NumberType) else kind


def _unlocked(kind: Type) -> Type:
    """A number that the solver finds is not whole, and a bare one is what its constraints make of it."""
    if isinstance(kind, NumberType):
        return ANY if kind.dimension is None else NumberType(kind.dimension)
    return kind


def _loose_number(x: NumberType, y: NumberType) -> Type:
    """One of two numbers."""
    if x.dimension == y.dimension:
        return NumberType(x.dimension, x.whole or y.whole)
    return ANY


def _at(node: ast.Node) -> Span:
    """The empty place before a node."""
    return Span(node.span.source, node.span.start, node.span.start)
