"""The static check: types, dimensions and validity of a whole program, executed or not.

Every body is checked: branches that are not taken, templates and shapes that nothing uses. Facts about
expressions come from `infer`; this file goes through the statements and checks which expressions each takes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from aidl_lang.checking import calls, rules, types
from aidl_lang.checking.builtins import NAMING
from aidl_lang.checking.facts import Fact, compare, of_symbol
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.library import Library
from aidl_lang.checking.rules import a, shown
from aidl_lang.checking.subset import Variant, check_subset
from aidl_lang.checking.symbols import Resolution, word_meant
from aidl_lang.checking.types import AnyType, NumberType, PointType, RangeType, TruthType, Type, accepts
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.checking.violations import Violation, check_validity
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, ordered
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

_MISDECLARED = {"E0208", "E0209"}
_EVALUATED = ast.Expression | ast.Equation
"""The nodes that the builder evaluates, or leaves out if they are wrong."""


@record(eq=False)
class Program:
    """A checked program, ready to be built.

    violations   breaches of the rules of validity; their diagnostics need values as written, and are made
                 after building (`Violation.diagnostic`)
    rejected     nodes with a reported error, which the builder treats as NOTHING without another report
    diagnostics  everything else that resolving and checking found, in text order
    inference    the facts about expressions, for later questions
    counts       the params of which only whole numbers make sense
    """

    main: ast.Module
    imports: Mapping[ast.Import, ast.Module]
    library: Library
    resolution: Resolution
    violations: tuple[Violation, ...]
    diagnostics: tuple[Diagnostic, ...]
    inference: Inference
    rejected: frozenset[ast.Node] = frozenset()
    counts: frozenset[ast.Param] = frozenset()


def check(resolution: Resolution, variant: Variant = Variant.FULL) -> Program:
    """Checks every body of a program, and that it keeps to a variant. Never raises for what it says."""
    inference = Inference(resolution)
    checker = Checker(inference)
    violations: list[Violation] = []
    for module in resolution.modules:
        checker.run(module)
        violations += check_validity(module, inference)
    calls.find_cycles(inference)
    calls.check_unused_geometry(inference)
    calls.check_unused_params(inference)
    inference.diagnostics += check_subset(inference, variant)
    diagnostics = tuple(ordered([*resolution.diagnostics, *inference.diagnostics]))
    return Program(
        main=resolution.main,
        imports=resolution.imports,
        library=resolution.library,
        resolution=resolution,
        violations=tuple(violations),
        diagnostics=diagnostics,
        inference=inference,
        rejected=frozenset(_rejected(resolution.modules, diagnostics)),
        counts=calls.counting_params(inference),
    )


def _rejected(modules: Sequence[ast.Module], found: Sequence[Diagnostic]) -> Iterator[ast.Node]:
    """Yields the innermost expression or equation in which each error was found, and names declared twice."""
    for error in found:
        for module in modules:
            if error.is_error and error.span is not None and error.span.source is module.source:
                around = list(_around(module, error.span))
                yield from [n for n in around if isinstance(n, _EVALUATED)][-1:]
                if error.code in _MISDECLARED:
                    yield around[-1]


def _around(module: ast.Module, place: Span) -> Iterator[ast.Node]:
    """Yields the nodes in which a place lies, the outermost first."""
    node: ast.Node | None = module
    while node is not None:
        yield node
        inner = (n for n in ast.children(node) if n.span.start <= place.start and place.end <= n.span.end)
        node = next(inner, None)


class Checker:
    """Checks the statements of a file."""

    def __init__(self, inference: Inference) -> None:
        self.infer = inference

    def run(self, module: ast.Module) -> None:
        self.infer.homes = (module,)
        for statement in module.statements:
            self._statement(statement)

    def _block(self, block: ast.Block, among_constraints: bool = False) -> None:
        for statement in block.statements:
            if among_constraints and isinstance(statement, ast.ExpressionStatement):
                calls.check_item(self.infer, statement.value)
            else:
                self._statement(statement, among_constraints)

    def _statement(self, node: ast.Statement, among_constraints: bool = False) -> None:
        match node:
            case ast.Structure():
                self._structure(node)
            case ast.FunctionDefinition() | ast.ShapeDefinition() | ast.ConstraintDefinition():
                self._definition(node)
            case ast.For(iterable=iterable, body=body):
                self.infer.iterable(iterable)
                self._block(body, among_constraints)
            case ast.If(test, then, otherwise):
                self.infer.test(test)
                for block in filter(None, (then, otherwise)):
                    self._block(block, among_constraints)
            case ast.Assign():
                self._attributes(node.attributes)
                self._indices(node.indices)
                self.infer.fact(node.value)
                calls.check_square(self.infer, node.value)
                self._placement(node.placement)
            case ast.Constrain(items):
                calls.check_empty(self.infer, node)
                self._block(items, among_constraints=True)
            case _:
                self._simple(node)

    def _simple(self, node: ast.Statement) -> None:
        infer = self.infer
        match node:
            case ast.Let(value=value):
                infer.fact(value)
            case ast.Param():
                self._param(node)
            case ast.Var(value=value):
                self._unknown(value)
            case ast.ExpressionStatement(value):
                if not calls.check_operation(infer, value):
                    calls.check_condition(infer, value)
            case ast.Equation(left, right):
                if not self._joined(node):
                    compare(infer, "==", left, right, node)
            case ast.Prefer(value, weight):
                calls.check_condition(infer, value)
                if weight is not None:
                    infer.known(weight, "a weight")
            case ast.Assert(test, message):
                self._assert(test, message)

    def _joined(self, node: ast.Equation) -> bool:
        """Reports `a = b and c == d`, which compares `a` with all of the rest. Returns whether it is that."""
        first, infer = node.right, self.infer
        while isinstance(first, ast.Binary) and first.operator in ("and", "or"):
            first = first.left
        if first is node.right or isinstance(infer.fact(first).type, TruthType | AnyType):
            return False
        source, start = node.span.source, node.left.span.end
        at = source.text.index("=", start)
        infer.report(
            "E0110",
            "`=` takes all of the line for its right side; conditions are joined where each has `==`",
            node,
            fix=Fix("write `==`", (Edit(Span(source, at, at + 1), "=="),), is_sure=True),
        )
        return True

    # --- Structures and definitions --------------------------------------------------------------

    def _structure(self, node: ast.Structure) -> None:
        self._attributes(node.attributes)
        self._indices(node.indices)
        self._placement(node.placement)
        self._definition(node)

    def _definition(self, node: ast.Callable) -> None:
        infer = self.infer
        before, infer.homes = infer.homes, infer.resolution.scope_of(node).homes
        for parameter in node.parameters or ():
            self._default(parameter)
        match node:
            case ast.FunctionDefinition(value=value):
                infer.fact(value)
            case _:
                self._block(node.body, isinstance(node, ast.ConstraintDefinition))
        infer.homes = before

    def _default(self, parameter: ast.Parameter) -> None:
        """Reports a default that is not of the parameter's own type (E0302)."""
        if parameter.default is None:
            return
        fact = self.infer.fact(parameter.default)
        symbol = self.infer.resolution.uses.get(parameter.name)
        wanted = of_symbol(self.infer, symbol).type if symbol is not None else types.ANY
        if accepts(wanted, fact.type) is None:
            self.infer.report(
                "E0302",
                f"`{parameter.name.text}` is {a(wanted)}, and its default is {a(fact.type)}",
                parameter.default,
            )

    # --- What statements want ----------------------------------------------------------------------

    def _placement(self, placement: ast.Placement | None) -> None:
        if placement is None:
            return
        if placement.at is not None:
            self._wanted(placement.at, "`at`", PointType())
        if placement.rotated is not None:
            self._wanted(placement.rotated, "`rotated`", NumberType(ANGLE))

    def _wanted(self, node: ast.Expression, what: str, wanted: Type) -> None:
        fact = self.infer.fact(node)
        if accepts(wanted, fact.type) is None:
            self.infer.misfit(rules.unwanted(what, wanted, fact.type, shown(node)), node)
        elif isinstance(wanted, NumberType):
            self.infer.serves(fact, wanted.dimension, node)

    def _unknown(self, node: ast.Expression) -> None:
        kind = self.infer.fact(node).type
        if all(accepts(k, kind) is None for k in (NumberType(LENGTH), NumberType(ANGLE), PointType())):
            message = f"a `var` wants a number or a point, and this is {a(kind)}"
            hint = "`var gap = 5` is an unknown number; shapes are defined without `var`"
            self.infer.report("E0302", message, node, hints=[hint])

    def _param(self, node: ast.Param) -> None:
        infer = self.infer
        infer.known(node.value, "the value of a `param`")
        fact = infer.fact(node.value)
        if node.domain is not None:
            self._domain(node, fact, node.domain)
        if node.step is not None:
            step = infer.numeric(node.step)
            infer.same_dimension(fact, step, node.step, "the step does not fit the value:")

    def _domain(self, node: ast.Param, fact: Fact, domain: ast.Expression) -> None:
        """Checks the value behind `in`: a range of such numbers, or a list of choices."""
        infer = self.infer
        match infer.fact(domain).type:
            case RangeType() if not isinstance(fact.type, NumberType | AnyType):
                infer.report(
                    "E0314", f"a range fits a number, and `{node.name.text}` is {a(fact.type)}", domain
                )
            case RangeType() if isinstance(domain, ast.Range):
                for end in (domain.start, domain.end):
                    infer.same_dimension(fact, infer.fact(end), end, "the range does not fit the value:")
            case RangeType() | types.ListType() | AnyType():
                pass
            case kind:
                infer.misfit(rules.no_domain(kind), domain)
        infer.known(domain, "the range of a `param`")

    def _assert(self, test: ast.Expression, message: ast.Expression | None) -> None:
        self.infer.wants(test, "a condition", TruthType)
        if message is not None:
            self.infer.wants(message, "a text", types.TextType)

    def _indices(self, indices: tuple[ast.Expression, ...]) -> None:
        for index in indices:
            self.infer.whole(index, "an index")

    def _attributes(self, attributes: tuple[ast.Attribute, ...]) -> None:
        for attribute in attributes:
            is_named = word_meant(attribute.name.text, (*NAMING, ast.ALLOW)) is not None
            for argument in () if is_named else attribute.arguments:
                self.infer.known(argument.value, f"the argument of `@{attribute.name.text}`")
