"""The static check: types, dimensions and validity of a whole program, executed or not.

Every body is checked: branches that are not taken, templates and shapes that nothing uses. Facts about
expressions come from `infer`; this file goes through the statements and checks which expressions each takes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from aidl_lang.checking import rules
from aidl_lang.checking.builtins import EDITS, NAMING, PRIMITIVE
from aidl_lang.checking.calls import (
    arguments,
    check_operation,
    check_square,
    check_unused_geometry,
    check_unused_params,
    operation,
)
from aidl_lang.checking.complaints import meant_outside
from aidl_lang.checking.facts import Fact, of_symbol
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.library import Library
from aidl_lang.checking.members import compare
from aidl_lang.checking.resolve import made_by
from aidl_lang.checking.rules import a, shown
from aidl_lang.checking.subset import Variant, check_subset
from aidl_lang.checking.symbols import Resolution, Symbol, SymbolKind, word_meant
from aidl_lang.checking.types import (
    ANY,
    AnyType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RangeType,
    StructureType,
    TextType,
    TruthType,
    Type,
    accepts,
)
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
    find_cycles(inference)
    check_unused_geometry(inference)
    check_unused_params(inference)
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
        counts=counting_params(inference),
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
        self._statements(module.statements)

    def _statements(self, statements: tuple[ast.Statement, ...]) -> None:
        for statement in statements:
            self._statement(statement)

    def _statement(self, node: ast.Statement) -> None:
        match node:
            case ast.Structure():
                self._structure(node)
            case ast.FunctionDefinition() | ast.ShapeDefinition() | ast.ConstraintDefinition():
                self._definition(node)
            case ast.For(variables, iterable, body):
                self.infer.iterable(iterable, len(variables))
                self._statements(body.statements)
            case ast.If(test, then, otherwise):
                self.infer.test(test)
                self._statements(then.statements)
                self._statements(otherwise.statements if otherwise else ())
            case ast.Assign():
                self._attributes(node.attributes)
                self._indices(node.indices)
                self.infer.fact(node.value)
                check_square(self.infer, node.value)
                self._placement(node.placement)
            case ast.Constrain(items):
                check_empty(self.infer, node)
                self._items(items)
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
                if not check_operation(infer, value):
                    check_condition(infer, value)
            case ast.Equation(left, right):
                if not self._joined(node):
                    compare(infer, "==", left, right, node)
            case ast.Prefer(value, weight):
                check_condition(infer, value)
                if weight is not None:
                    infer.known(weight, "a weight")
            case ast.Assert(test, message):
                self._assert(test, message)
            case _:
                pass

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
            case ast.ConstraintDefinition(body=body):
                self._items(body)
            case _:
                self._statements(node.body.statements)
        infer.homes = before

    def _default(self, parameter: ast.Parameter) -> None:
        """Reports a default that is not of the parameter's own type (E0302)."""
        if parameter.default is None:
            return
        fact = self.infer.fact(parameter.default)
        symbol = self.infer.resolution.uses.get(parameter.name)
        wanted = of_symbol(self.infer, symbol).type if symbol is not None else ANY
        if accepts(wanted, fact.type) is None:
            self.infer.report(
                "E0302",
                f"`{parameter.name.text}` is {a(wanted)}, and its default is {a(fact.type)}",
                parameter.default,
            )

    def _items(self, block: ast.Block) -> None:
        for item in block.statements:
            if isinstance(item, ast.ExpressionStatement):
                check_item(self.infer, item.value)
            else:
                self._item(item)

    def _item(self, item: ast.Statement) -> None:
        match item:
            case ast.For(variables, iterable, body):
                self.infer.iterable(iterable, len(variables))
                self._items(body)
            case ast.If(test, then, otherwise):
                self.infer.test(test)
                self._items(then)
                if otherwise is not None:
                    self._items(otherwise)
            case _:
                self._statement(item)

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
            case RangeType() | ListType() | AnyType():
                pass
            case kind:
                infer.misfit(rules.no_domain(kind), domain)
        infer.known(domain, "the range of a `param`")

    def _assert(self, test: ast.Expression, message: ast.Expression | None) -> None:
        self.infer.wants(test, "a condition", TruthType)
        if message is not None:
            self.infer.wants(message, "a text", TextType)

    def _indices(self, indices: tuple[ast.Expression, ...]) -> None:
        for index in indices:
            self.infer.whole(index, "an index")

    def _attributes(self, attributes: tuple[ast.Attribute, ...]) -> None:
        for attribute in attributes:
            is_named = word_meant(attribute.name.text, (*NAMING, ast.ALLOW)) is not None
            for argument in () if is_named else attribute.arguments:
                self.infer.known(argument.value, f"the argument of `@{attribute.name.text}`")


def find_cycles(infer: Inference) -> None:
    """Reports every circle of params and lets once, at the use that closes it.

    A depth-first search in text order, with a stack of its own since chains may be long.
    """
    graph = _dependences(infer)
    done: set[Symbol] = set()
    for start in graph:
        trail = [(start, iter(graph[start]))]
        places = {start: 0}
        while trail and start not in done:
            symbol, rest = trail[-1]
            target, name = next(rest, (None, None))
            if target is None or name is None:
                done.add(symbol)
                del places[symbol]
                trail.pop()
            elif target in places:
                _report(infer, [s for s, _ in trail[places[target] :]], name)
            elif target in graph and target not in done:
                places[target] = len(trail)
                trail.append((target, iter(graph[target])))


def _dependences(infer: Inference) -> dict[Symbol, list[tuple[Symbol, ast.Name]]]:
    """Returns for each param or let, but for arrays, the symbols that its value names, and where."""
    uses = infer.resolution.uses
    return {
        symbol: [
            (uses[name], name)
            for node in symbol.nodes
            if isinstance(node, ast.Let | ast.Assign | ast.Param)
            for name in ast.walk(node.value)
            if isinstance(name, ast.Name) and name in uses
        ]
        for symbol in infer.resolution.symbols
        if symbol.kind in (SymbolKind.LET, SymbolKind.PARAM) and not symbol.is_array
    }


def _report(infer: Inference, circle: list[Symbol], name: ast.Name) -> None:
    first = circle[0]
    way = f": {' → '.join(s.name for s in [*circle, first])}" if len(circle) > 1 else ""
    outside = meant_outside(first, name) if not way else None
    hint, fix = outside or ("one of them needs a value that does not depend on the others", None)
    infer.report("E0207", f"`{first.name}` is defined by way of itself{way}", name, hints=[hint], fix=fix)


# --- Params that count something: the number of an array, the end of a range that is counted through.


def counting_params(check: Inference) -> frozenset[ast.Param]:
    """Returns the params of a checked program of which only whole numbers make sense: those that come to
    where a whole number is asked for, by themselves, in sums and products, by way of a `let` or an argument.
    """
    resolution = check.resolution
    if not any(isinstance(s.node, ast.Param) for s in resolution.symbols):
        return frozenset()
    nodes = [node for module in resolution.modules for node in ast.walk(module)]
    asked = [(node, False) for node in _asked(check, nodes)]
    asked += [(end, True) for node in nodes if (end := _last(node)) is not None]
    found: set[ast.Param] = set()
    seen: set[ast.Node] = set()
    while asked:
        node, may_measure = asked.pop()
        for name in _factors(node):
            symbol = resolution.uses.get(name)
            if symbol is None or symbol.node is None or (may_measure and check.is_measured(symbol)):
                continue
            if isinstance(symbol.node, ast.Param):
                found.add(symbol.node)
            elif symbol.node not in seen:
                seen.add(symbol.node)
                if isinstance(symbol.node, ast.Let):
                    asked.append((symbol.node.value, may_measure))
                elif symbol.kind is SymbolKind.ARGUMENT:
                    asked += [(given, may_measure) for given in _given(check, symbol.node)]
    return frozenset(found)


def _asked(check: Inference, nodes: list[ast.Node]) -> Iterator[ast.Expression]:
    """Yields the expressions where nothing but a whole number is taken: indices, and arguments that are."""
    for node in nodes:
        if isinstance(node, ast.Index):
            yield node.index
        elif isinstance(node, ast.Call) and node in check.fits:
            given = arguments(check, node)
            fits = check.fits[node]
            for index, value in enumerate(given):
                kinds = [
                    kind
                    for fit in fits
                    for name, kind, _ in fit.signature.parameters
                    if name == fit.parameter_of(index)
                ]
                if kinds and all(isinstance(k, NumberType) and k.whole for k in kinds):
                    yield value


def _last(node: ast.Node) -> ast.Expression | None:
    """Returns the end of a range that is counted through from a whole number, in steps of one."""
    if isinstance(node, ast.For | ast.Comprehension):
        match node.iterable:
            case ast.Range(ast.Number(value, None), end, _, None) if value.is_integer():
                return end
    return None


def _factors(node: ast.Node) -> Iterator[ast.Node]:
    """Yields the names that an expression is a sum or a product of; it is whole if they are."""
    match node:
        case ast.Name() | ast.Member():
            yield node
        case ast.Unary(_, operand):
            yield from _factors(operand)
        case ast.Binary("+" | "-" | "*", left, right):
            for side in (left, right):
                yield from _factors(side)
        case ast.Conditional(_, then, otherwise):
            for side in (then, otherwise):
                yield from _factors(side)


def _given(check: Inference, parameter: ast.Node) -> Iterator[ast.Expression]:
    """Yields what calls give to a parameter of a definition of the program."""
    assert isinstance(parameter, ast.Parameter)
    for call, fits in check.fits.items():
        for fit in fits:
            if fit.signature.node is not None and parameter in ast.children(fit.signature.node):
                given = arguments(check, call)
                yield from (v for i, v in enumerate(given) if fit.parameter_of(i) == parameter.name.text)


# --- The checks of constraints: which expressions can constrain, and which stand in the place of one.


def check_empty(infer: Inference, node: ast.Constrain) -> None:
    """Reports a `constrain { }` without anything in it."""
    if not node.items.statements and not node.items.span.text.strip("{} \t\r\n"):
        fix = Fix("remove it", (Edit(node.span.with_separator, ""),), is_sure=True)
        infer.report("W0202", "this `constrain` holds nothing", node, fix=fix)


def check_item(infer: Inference, node: ast.Expression) -> None:
    """Reports an operation among constraints, where nothing is made and nothing edited."""
    if (name := operation(infer, node)) is not None:
        text, fix = shown(node), None
        hints = [f"`{text}` is a statement of its own, outside `constrain`"]
        if name == "rotate":
            said = _turned(infer, node)
            fix = Fix(f"write `{said}`", (Edit(node.span, said),), is_sure=True) if said else None
            example = "" if said else ": `a.angle == 30deg`, for a structure `a.rotation == 30deg`"
            hints = [f"how a thing is turned is an equation too{example}"]
        elif name in EDITS:
            hints = [
                "where a thing has to be says a relation: `a.left == b.right`, `a.above(b)`, "
                "`coincident(a.end, b.start)`",
                f"outside `constrain`, `{text}` changes what was written, and `name = {text}` makes a copy; "
                "a structure is placed by `at`",
            ]
        message = f"`{name}` constrains nothing: it changes what is drawn"
        infer.report("E0352", message, node, hints=hints, fix=fix)
        return
    check_condition(infer, node, may_make=False)


def _turned(infer: Inference, node: ast.Expression) -> str | None:
    """Returns the equation that `rotate(r, 30)` among constraints means; None for what has no angle."""
    given = arguments(infer, node) if isinstance(node, ast.Call) else []
    if len(given) not in (2, 3):
        return None
    thing, angle, *about = given
    if about and shown(about[0]) != f"{shown(thing)}.center":
        return None
    fact, field = infer.fact(thing), "angle"
    if isinstance(fact.type, StructureType):
        field = "rotation"
    elif not isinstance(fact.type, GeometryType) or not (
        infer.resolution.scope_of(fact.of).values if fact.of else PRIMITIVE.get(fact.type.kind, {})
    ).get(field):
        return None
    unit = "deg" if isinstance(angle, ast.Number) and not angle.unit else ""
    return f"{shown(thing)}.{field} == {shown(angle)}{unit}"


def check_condition(infer: Inference, node: ast.Expression, may_make: bool = True) -> None:
    """Reports an expression that cannot constrain anything; `may_make`: with a name it would be geometry."""
    fact = infer.fact(node)
    if isinstance(fact.type, TruthType):
        _check_logic(infer, node)
        return
    if isinstance(node, ast.Call):
        if infer.called(node) == "fixed":
            return  # holds a thing where it was written
        scope = infer.resolution.scopes[infer.homes[-1]]
        if made_by(node, scope) is not SymbolKind.LET:
            _needs_name(infer, node, may_make)
            return
    if isinstance(fact.type, AnyType):
        return
    infer.misfit(rules.no_condition(shown(node), fact.type), node)


def _needs_name(infer: Inference, node: ast.Call, may_make: bool) -> None:
    kind = node.callee.text
    taken = {symbol.name for symbol in infer.resolution.symbols}
    number = next(n for n in range(1, len(taken) + 2) if f"{kind}_{n}" not in taken)
    name = f"{kind}_{number}"
    start = Span(node.span.source, node.span.start, node.span.start)
    remedy = "give it a name" if may_make else "make it outside `constrain`"
    message = f"this `{kind}` has no name, so nothing could refer to it"
    hint = f"{remedy}: `{name} = {shown(node)}`"
    fix = Fix(f"name it `{name}`", (Edit(start, f"{name} = "),), is_sure=True) if may_make else None
    infer.report("E0323", message, node, label="made and lost", hints=[hint], fix=fix)


def _check_logic(infer: Inference, node: ast.Expression) -> None:
    """Reports `or`, `not` and `!=` over unknowns, which leave no equation; not those over constants."""
    match node:
        case ast.Binary(operator="and", left=left, right=right):
            _check_logic(infer, left)
            _check_logic(infer, right)
        case ast.Binary(operator="or", left=left, right=right) if infer.fact(node).reads:
            _cannot(
                infer,
                node,
                "or",
                f"constrain the one you mean, as in `constrain {shown(left)}`, or let an `if` over "
                "constants choose; `assert` takes `or`",
                Fix("constrain the first of them", (Edit(node.span, left.span.text),)),
            )
        case ast.Unary(operator="not", operand=operand) if infer.fact(node).reads:
            hint = f"constrain what shall hold instead; `assert not {shown(operand)}` checks it"
            _cannot(infer, node, "not", hint)
        case ast.Comparison(operators=operators) if "!=" in operators and infer.fact(node).reads:
            _cannot(infer, node, "!=", "say on which side, with `<=` or `>=` and a distance, or `assert` it")


def _cannot(infer: Inference, node: ast.Expression, word: str, hint: str, fix: Fix | None = None) -> None:
    infer.misfit(rules.no_equation(word, hint), node, fix)
