"""The check for constants that are defined by way of themselves."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.checking.infer import Inference
from aidl_lang.checking.resolving.complaints import meant_outside
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind
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
