"""Types and dependences of expressions, each found once.

The check is gradual: values known only when the program is built have the type ANY, which is accepted
everywhere, and after an error the type is ANY too, so that one mistake is reported once.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import lru_cache, reduce
from typing import Any, TypeVar

from aidl_lang.checking import calls, facts, rules, units
from aidl_lang.checking.facts import NOTHING_READ, UNKNOWN, Fact, joined
from aidl_lang.checking.library import Library
from aidl_lang.checking.resolve import resolve
from aidl_lang.checking.rules import TypeMisfit, place_before, shown
from aidl_lang.checking.symbols import Resolution, Symbol, SymbolKind
from aidl_lang.checking.types import (
    ANY,
    AnyType,
    Binding,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RangeType,
    RecordType,
    TextType,
    TruthType,
    Type,
)
from aidl_lang.checking.units import ANGLE, LENGTH, PLAIN, UNITS, MaybeDimension
from aidl_lang.common.diagnostics import MOST_ERRORS, Diagnostic, Edit, Fix, Label
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast

T = TypeVar("T")

_DEEPEST = 120
"""Levels of expressions and of the names in them that are followed: within Python's usual limit on frames."""


class Inference:
    """Facts about the expressions of one program, and the diagnostics found with them.

    `fits` has the overloads that each call may mean, best first. Nothing is reported in files of `standard`,
    the library, whose facts are found apart.
    """

    def __init__(self, resolution: Resolution, standard: Iterable[SourceFile] | None = None) -> None:
        self.resolution = resolution
        self.facts: dict[ast.Node, Fact] = {}
        self.diagnostics: list[Diagnostic] = []
        self.fits: dict[ast.Call, list[Binding]] = {}
        self.homes: tuple[ast.Node, ...] = (resolution.main,)
        self._standard = frozenset(resolution.standard_sources if standard is None else standard)
        self.running: set[ast.Node] = set()
        self._depth = 0
        self._errors = 0
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
        """Reports a mistake in a program (the library has tests). Returns the fact of an unknown result."""
        if not self.is_standard(node) and self._errors <= MOST_ERRORS:
            found = Diagnostic(code, message, node.span, label, tuple(secondary), tuple(hints), fix)
            self.diagnostics.append(found)
            self._errors += found.is_error
        return UNKNOWN

    def misfit(self, found: TypeMisfit, node: ast.Node, fix: Fix | None = None) -> Fact:
        """Reports an expression that does not fit its place. Returns the fact of an unknown result."""
        return self.report(found.code, found.message, node, found.label, found.hints, fix=fix)

    def is_standard(self, node: ast.Node) -> bool:
        return node.span.source in self._standard

    def of_standard(self, ask: Callable[..., T], definition: ast.Node, *more: str) -> T:
        """Returns the answer of `facts` on a definition of the library, which sees nothing of a program."""
        answer: T = _of_standard(self.resolution.library, ask, definition, *more)
        return answer

    def called(self, node: ast.Expression) -> str:
        """Returns the name that a call calls, with aliases resolved; empty for other expressions."""
        return (
            self.resolution.canonical.get(node.callee, node.callee.text) if isinstance(node, ast.Call) else ""
        )

    def namespace(self, node: ast.Node | None) -> Symbol | None:
        """Returns the file that an expression names; None for other expressions."""
        symbol = self.resolution.uses.get(node) if isinstance(node, ast.Name) else None
        return symbol if symbol is not None and symbol.kind is SymbolKind.NAMESPACE else None

    def wants(self, node: ast.Expression, what: str, *allowed: type[Type]) -> Fact:
        """Returns the fact of an expression; reports one that is of none of the types allowed."""
        fact = self.fact(node)
        if isinstance(fact.type, (AnyType, *allowed)):
            return fact
        return self.misfit(rules.needed(what, fact.type), node)

    def known(self, node: ast.Expression, what: str) -> bool:
        """Reports an expression needed while building and not known by then. Returns whether it is."""
        if not self.fact(node).reads:
            return True
        self.misfit(rules.unknown_yet(what, shown(node)), node)
        return False

    def test(self, node: ast.Expression) -> None:
        """Checks a condition that chooses what is built."""
        fact = self.wants(node, "a condition", TruthType)
        if fact.reads:
            self.misfit(rules.undecided(shown(node)), node)

    # --- Expressions ---------------------------------------------------------------------------

    def fact(self, node: ast.Node) -> Fact:
        """Returns the fact of an expression; of one at the end of a very long chain of names, UNKNOWN."""
        if (known := self.facts.get(node)) is not None:
            return known
        if self._depth >= _DEEPEST:
            return UNKNOWN
        self._depth += 1
        known = self.facts[node] = _INFER[type(node)](self, node)
        self._depth -= 1
        return known

    def _number(self, node: ast.Number) -> Fact:
        dimension = UNITS[node.unit][1] if node.unit else None
        return Fact(NumberType(dimension, whole=dimension is None and node.value.is_integer()))

    def _name(self, node: ast.Name) -> Fact:
        symbol = self.resolution.uses.get(node)
        return facts.of_symbol(self, symbol) if symbol is not None else UNKNOWN

    def _point(self, node: ast.Point) -> Fact:
        reads = NOTHING_READ
        for part in (node.x, node.y):
            fact = self.numeric(part)
            reads |= fact.reads
            if isinstance(fact.type, NumberType):
                self.serves(fact, LENGTH, part)
                if fact.type.dimension not in (None, PLAIN, LENGTH):
                    self.misfit(rules.no_coordinate(shown(part), fact.type), part)
        return Fact(PointType(), reads)

    def numeric(self, node: ast.Expression) -> Fact:
        """Returns the fact of an operand that has to be a number; an edge counts as its coordinate."""
        fact = self.fact(node)
        match fact.type:
            case NumberType() | AnyType():
                return fact
            case GeometryType("line"):
                return Fact(NumberType(LENGTH), fact.reads)
            case _:
                return self.misfit(rules.needed("a number", fact.type), node)

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
        reads = self.iterable(node.iterable).reads
        if node.condition is not None:
            self.test(node.condition)
        element = self.fact(node.element)
        listed = element.listed() if node.innermost is node else element
        return replace(listed, reads=element.reads | reads)

    def _for_arguments(self, node: ast.ForArguments) -> Fact:
        reads = self.iterable(node.iterable).reads
        members = self._argument_block(node.body)
        return replace(members.listed(), reads=members.reads | reads)

    def _if_arguments(self, node: ast.IfArguments) -> Fact:
        self.test(node.test)
        members = self._argument_block(node.then)
        if node.otherwise is not None:
            members = joined(members, self._argument_block(node.otherwise))
        return members.listed()

    def _argument_block(self, block: ast.ArgumentBlock) -> Fact:
        """Returns what the arguments in a block have in common; a list among them counts by its members."""
        facts = []
        for item in block.items:
            fact = self.fact(item.value if isinstance(item, ast.Let) else item)
            if not isinstance(item, ast.Let):
                facts.append(fact.element() if isinstance(fact.type, ListType) else fact)
        return reduce(joined, facts) if facts else UNKNOWN

    def iterable(self, node: ast.Expression) -> Fact:
        """Returns the fact of the value that a `for` runs through."""
        fact = self.fact(node)
        match fact.type:
            case RangeType():
                self.known(node, "the ends of a range that is run through")
                return Fact(fact.type)
            case ListType() | AnyType():
                return fact
            case NumberType():
                counted = f"0..<{shown(node)}"
                misfit = replace(rules.no_run(fact.type), hints=(f"`{counted}` counts from 0 up to it",))
                fix = None
                if isinstance(node, ast.Name | ast.Number | ast.Member | ast.Call):
                    fix = Fix(f"write `{counted}`", (Edit(place_before(node), "0..<"),), is_sure=True)
                return self.misfit(misfit, node, fix)
            case _:
                return self.misfit(rules.no_run(fact.type), node)

    def _range(self, node: ast.Range) -> Fact:
        start, end = self.numeric(node.start), self.numeric(node.end)
        self.same_dimension(start, end, node, "a range does not join")
        if node.step is not None:
            self.same_dimension(start, self.numeric(node.step), node, "a range does not join")
        return Fact(RangeType(), start.reads | end.reads)

    def _conditional(self, node: ast.Conditional) -> Fact:
        self.test(node.test)
        then, otherwise = self.fact(node.then), self.fact(node.otherwise)
        if isinstance(node.otherwise, ast.Call) and node.otherwise.callee.text == "refuse":
            return then
        if isinstance(then.type, NumberType) and isinstance(otherwise.type, NumberType):
            (one, other), reads = (then.type, otherwise.type), then.reads | otherwise.reads
            is_alike = one.dimension == other.dimension
            return Fact(NumberType(one.dimension, one.whole or other.whole) if is_alike else ANY, reads)
        return joined(then, otherwise)

    def _index(self, node: ast.Index) -> Fact:
        fact = self.fact(node.value)
        if isinstance(fact.type, RecordType):
            self.wants(node.index, "the name of a field", TextType)
            return Fact(ANY, fact.reads)
        if isinstance(fact.type, AnyType) and isinstance(self.fact(node.index).type, TextType):
            return Fact(ANY, fact.reads)
        between = node.span.source.text[node.value.span.end : node.index.span.start]
        if isinstance(node.value, ast.Index) and fact.type is ANY and "[" not in between:
            return Fact(ANY, fact.reads)  # the rest of `[a, b]`, of which `a` was reported
        if not isinstance(fact.type, ListType | AnyType) and "\n" in between.partition("[")[0]:
            return self.misfit(rules.list_on_a_line(shown(node.value), fact.type), node)
        self.whole(node.index, "an index")
        match fact.type:
            case ListType():
                return fact.element()
            case AnyType():
                return Fact(ANY, fact.reads)
            case _:
                return self.misfit(rules.no_members(shown(node.value), fact.type), node)

    def whole(self, node: ast.Expression, what: str) -> None:
        """Reports an expression that is no whole number known while building."""
        fact = self.fact(node)
        match fact.type:
            case AnyType():
                self.known(node, what)
            case NumberType(dimension):
                is_fraction = isinstance(node, ast.Number) and not node.value.is_integer()
                if dimension not in (None, units.PLAIN) or is_fraction:
                    self.misfit(rules.fraction(what, shown(node)), node)
                else:
                    self.known(node, what)
            case _:
                self.misfit(rules.no_whole_number(what, fact.type), node)

    # --- Numbers ---

    def same_dimension(self, left: Fact, right: Fact, node: ast.Node, what: str) -> MaybeDimension:
        """Returns the common dimension of two numbers; reports them if there is none."""
        if not isinstance(left.type, NumberType) or not isinstance(right.type, NumberType):
            return None
        x, y = left.type.dimension, right.type.dimension
        try:
            common = units.add(x, y)
        except ValueError:
            self.misfit(rules.unequal(what, x, y), node)
            return None
        for side in (left, right):
            self.serves(side, common, node)
        return common

    def is_measured(self, symbol: Symbol) -> bool:
        """Tells whether the number that a name stands for is used as a length or an angle."""
        return symbol in self._served

    def serves(self, fact: Fact, dimension: MaybeDimension, node: ast.Node) -> None:
        """Reports a number without a unit that is used both as a length and as an angle."""
        if fact.bare is None or dimension not in (LENGTH, ANGLE):
            return
        earlier = self._served.setdefault(fact.bare, (dimension, node))
        if earlier[0] == dimension or earlier[0] is None:
            return
        self._served[fact.bare] = (None, node)  # reported once
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


_INFER: dict[type, Callable[..., Fact]] = {
    ast.Number: Inference._number,
    ast.String: lambda self, node: Fact(TextType()),
    ast.Boolean: lambda self, node: Fact(TruthType()),
    ast.Name: Inference._name,
    ast.Member: facts.member,
    ast.Index: Inference._index,
    ast.Call: calls.call,
    ast.Point: Inference._point,
    ast.List: Inference._list,
    ast.Comprehension: Inference._comprehension,
    ast.ForArguments: Inference._for_arguments,
    ast.IfArguments: Inference._if_arguments,
    ast.Unary: facts.unary,
    ast.Binary: facts.binary,
    ast.Comparison: facts.comparison,
    ast.Membership: facts.membership,
    ast.Range: Inference._range,
    ast.Conditional: Inference._conditional,
}


def _loose(kind: Type) -> Type:
    """Returns a type without the properties that may differ among the members of a list."""
    return NumberType(kind.dimension, whole=kind.dimension is None) if isinstance(kind, NumberType) else kind


_EMPTY = ast.Module(SourceFile("empty", ""), (), (), span=Span(SourceFile("empty", ""), 0, 0))
_ONE_AT_A_TIME = threading.Lock()  # an inference serves one thread


@lru_cache(maxsize=8192)
def _of_standard(library: Library, ask: Callable[..., Any], definition: ast.Node, *more: str) -> Any:
    with _ONE_AT_A_TIME:
        return ask(_alone(library, definition), definition, *more)


@lru_cache(maxsize=1024)
def _alone(library: Library, definition: ast.Node) -> Inference:
    return Inference(resolve(_EMPTY, None, library), standard=())
