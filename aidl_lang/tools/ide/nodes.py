"""Finds the nodes and the token at an offset."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.checking.resolving.symbols import SymbolScope
from aidl_lang.syntax import ast
from aidl_lang.syntax.tokens import Token
from aidl_lang.tools.ide.view import View


def around(module: ast.Module, offset: int) -> list[ast.Node]:
    """Returns the nodes that an offset lies in or at the end of, the file first, the innermost last."""
    path: list[ast.Node] = [module]
    while (inner := _child_at(path[-1], offset)) is not None:
        path.append(inner)
    return path


def _child_at(node: ast.Node, offset: int) -> ast.Node | None:
    """Returns the child that an offset lies in; of two that touch there, the one that begins."""
    touching = None
    for child in ast.children(node):
        if child.span.start <= offset < child.span.end:
            return child
        if offset == child.span.end:
            touching = child
    return touching


def scope_at(view: View, offset: int) -> SymbolScope:
    """Returns the innermost scope around an offset."""
    scopes = view.resolution.scopes
    path = around(view.module, offset)
    return next(scopes[node] for node in reversed(path) if node in scopes and _opens_here(node, offset))


def _opens_here(node: ast.Node, offset: int) -> bool:
    """True if the names of a node are visible at an offset: its head belongs to what is around it."""
    match node:
        case ast.Structure(parameters=None) | ast.For() | ast.ForArguments():
            return node.body.span.start < offset <= node.body.span.end
        case _:
            return True


def token_at(view: View, offset: int) -> Token | None:
    """Returns the token that an offset lies in, or else the one that ends there."""
    touching = None
    for token in view.tokens.tokens:
        if token.start <= offset < token.end:
            return token
        if token.end == offset:
            touching = token
    return touching


def structures_around(view: View, offset: int) -> Iterator[ast.Structure]:
    """Yields the structures whose bodies an offset lies in, innermost first."""
    for node in reversed(around(view.module, offset)):
        if isinstance(node, ast.Structure) and node.body.span.start < offset:
            yield node
