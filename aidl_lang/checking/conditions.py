"""The checks of constraints, of constants defined by way of themselves, and of params that count."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.checking import rules
from aidl_lang.checking.builtins import EDITS, PRIMITIVE
from aidl_lang.checking.calls import arguments, operation
from aidl_lang.checking.complaints import meant_outside
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.resolve import made_by
from aidl_lang.checking.rules import shown
from aidl_lang.checking.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import AnyType, GeometryType, NumberType, StructureType, TruthType
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast


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
