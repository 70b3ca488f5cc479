"""The meaning of each name in a text: the one table for hover, definitions, references and renaming."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias

from aidl_lang.checking.calls import arguments
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import Signature
from aidl_lang.common.names import find, fold
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.site import around, scope_at
from aidl_lang.tools.ide.workspace import View

Place: TypeAlias = tuple[Path, int]
"""The file and the offset of the first declaration of a symbol: the same in every view of a project."""


@record()
class Mention:
    """One occurrence of a name. `node` is the named node: a Name, Member, Call, Identifier, …"""

    span: Span
    node: ast.Node
    symbol: Symbol

    @property
    def is_declaration(self) -> bool:
        return any(self.span == declaration.span for declaration in self.symbol.declarations)


def mentions(view: View, module: ast.Module | None = None) -> Iterator[Mention]:
    """Yields every name of the file, or of one that it imports, whose meaning is known."""
    for node in ast.walk(module or view.module):
        yield from _mentions_of(view, node)


def mention_at(view: View, offset: int) -> Mention | None:
    """Returns the name at an offset, or that ends there."""
    for node in reversed(around(view.module, offset)):
        for mention in _mentions_of(view, node):
            if mention.span.start <= offset <= mention.span.end:
                return mention
    return None


def place_of(view: View, symbol: Symbol) -> Place | None:
    """Returns the first declaration of a symbol; None for a built-in."""
    if not symbol.declarations:
        return None
    first = symbol.declarations[0].span
    file = view.file(first.source)
    return None if file is None else (file, first.start)


def _mentions_of(view: View, node: ast.Node) -> Iterator[Mention]:
    uses = view.resolution.uses
    symbol = uses.get(node)
    match node:
        case ast.Name() | ast.Identifier() if symbol is not None:
            yield Mention(node.span, node, symbol)
        case ast.Member() if symbol is not None:
            yield Mention(node.name.span, node, symbol)
        case ast.Call():
            if symbol is not None:
                yield Mention(node.callee.span, node, _as_written(view, node, symbol))
            yield from _named_arguments(view, node)
        case ast.Import():
            yield from _imported_names(view, node)
        case ast.Alias():
            yield from _alias_target(view, node)
        case _:
            pass


def _as_written(view: View, call: ast.Call, symbol: Symbol) -> Symbol:
    """Returns the alias that a call uses, else the symbol itself."""
    if fold(call.callee.text) == fold(symbol.name):
        return symbol
    for scope in scope_at(view, call.span.start).chain():
        if (name := find(call.callee.text, scope.aliases)) is not None:
            return scope.aliases[name]
    return symbol


def chosen(view: View, call: ast.Call) -> Signature | None:
    """Returns the overload that a call means; of several that fit, the best."""
    fits = view.program.inference.fits.get(call)
    return fits[0].signature if fits else None


def _named_arguments(view: View, call: ast.Call) -> Iterator[Mention]:
    fits = view.program.inference.fits.get(call)
    if not fits:
        return
    offset = len(arguments(view.program.inference, call)) - len(call.arguments)
    for index, argument in enumerate(call.arguments, offset):
        meant = fits[0].parameter_of(index) if argument.name is not None else None
        if argument.name is not None and meant is not None:
            yield Mention(argument.name.span, argument, parameter(view, fits[0].signature, meant))


def parameter(view: View, signature: Signature, name: str) -> Symbol:
    """Returns the parameter of a callable by its name."""
    node = parameter_node(signature, name)
    if node is not None and signature.node is not None:
        view.resolution.scope_of(signature.node)  # which enters the names of a library definition
        if (symbol := view.resolution.uses.get(node.name)) is not None:
            return symbol
    return Symbol(name, SymbolKind.ARGUMENT)


def parameter_node(signature: Signature, name: str) -> ast.Parameter | None:
    """Returns the declaration of a parameter; None for a built-in."""
    parameters = (signature.node.parameters or ()) if signature.node is not None else ()
    return next((p for p in parameters if p.name.text == name), None)


def free_name(view: View, name: str) -> str:
    """Returns the name, or the first one with a number appended, that neither the text nor the library
    has.
    """
    taken = {fold(node.text) for node in ast.walk(view.module) if isinstance(node, ast.Identifier | ast.Name)}
    taken |= set(map(fold, view.program.library.callables))
    candidate, count = name, 1
    while fold(candidate) in taken:
        count += 1
        candidate = f"{name}_{count}"
    return candidate


def _imported_names(view: View, node: ast.Import) -> Iterator[Mention]:
    """Yields the meaning of each name in `import a, b from "file"`."""
    target = view.resolution.imports.get(node)
    if target is None:
        return
    scope = view.resolution.scopes[target]
    for name in node.names:
        if name in view.resolution.uses:
            continue  # a value, which stands in the table already
        for signature in scope.callables.get(name.text, ())[:1]:
            if signature.node in view.resolution.of_definition:
                yield Mention(name.span, name, view.resolution.of_definition[signature.node])
        if name.text in scope.aliases:
            yield Mention(name.span, name, scope.aliases[name.text])


def _alias_target(view: View, node: ast.Alias) -> Iterator[Mention]:
    found = scope_at(view, node.span.start).called(node.target.text)
    if found is not None and found[1]:
        definition = found[1][0].node
        symbol = view.resolution.of_definition.get(definition) if definition is not None else None
        if symbol is None and definition is not None:
            symbol = Symbol(found[0], SymbolKind.FUNCTION, definition, None, [definition.name], [definition])
        yield Mention(node.target.span, node, symbol or Symbol(found[0], SymbolKind.BUILTIN))
