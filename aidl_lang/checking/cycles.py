"""The checks for constants defined by way of themselves, and for params that count something."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.checking.calls import arguments
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.resolving.complaints import meant_outside
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import NumberType
from aidl_lang.syntax import ast

# --- The check for constants that are defined by way of themselves.


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
    """Returns for each param or let the symbols that its value names, and where. Members of an array may
    follow from one another.
    """
    uses = infer.resolution.uses
    return {
        symbol: [(uses[name], name) for node in symbol.nodes for name in _names(node) if name in uses]
        for symbol in infer.resolution.symbols
        if symbol.kind in (SymbolKind.LET, SymbolKind.PARAM) and not symbol.is_array
    }


def _names(node: ast.Node) -> Iterator[ast.Name]:
    if isinstance(node, ast.Let | ast.Assign | ast.Param):
        yield from (n for n in ast.walk(node.value) if isinstance(n, ast.Name))


def _report(infer: Inference, circle: list[Symbol], name: ast.Name) -> None:
    first = circle[0]
    way = f": {' → '.join(s.name for s in [*circle, first])}" if len(circle) > 1 else ""
    hint, fix = (meant_outside(first, name) if not way else None) or (
        "one of them needs a value that does not depend on the others",
        None,
    )
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
