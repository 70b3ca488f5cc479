"""Facts about the library's own definitions. They see nothing of a program, so each is found once."""

from __future__ import annotations

import threading
from functools import lru_cache
from typing import TYPE_CHECKING

from aidl_lang.checking.facts import Fact
from aidl_lang.checking.library import Library
from aidl_lang.checking.named import of_symbol
from aidl_lang.checking.resolving.symbols import SymbolScope
from aidl_lang.common.names import fold
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference

CONSTANT = frozenset({"len", "written"})
"""Functions whose results are constants even for unknowns."""

_EMPTY = ast.Module(SourceFile("empty", ""), (), (), span=Span(SourceFile("empty", ""), 0, 0))


def body_of(check: Inference, definition: ast.Node) -> SymbolScope:
    """Returns the scope of the body of a structure or a definition."""
    if check.is_standard(definition):
        return _body(check.resolution.library, definition)
    return check.resolution.scope_of(definition)


def part(check: Inference, definition: ast.Node, key: str) -> Fact:
    """Returns the fact of a name that a body declares."""
    if check.is_standard(definition):
        return _part(check.resolution.library, definition, key)
    return of_symbol(check, body_of(check, definition).values[key])


def result(check: Inference, definition: ast.FunctionDefinition) -> tuple[Fact, bool]:
    """Returns the fact of a function's expression, and whether its result depends on the solved values of its
    arguments, not only on those as written.
    """
    if check.is_standard(definition):
        return _result(check.resolution.library, definition)
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


@lru_cache(maxsize=1024)
def _body(library: Library, definition: ast.Node) -> SymbolScope:
    with _ONE_AT_A_TIME:
        return body_of(_alone(library, definition), definition)


@lru_cache(maxsize=4096)
def _part(library: Library, definition: ast.Node, key: str) -> Fact:
    with _ONE_AT_A_TIME:
        return part(_alone(library, definition), definition, key)


@lru_cache(maxsize=1024)
def _result(library: Library, definition: ast.FunctionDefinition) -> tuple[Fact, bool]:
    with _ONE_AT_A_TIME:
        return result(_alone(library, definition), definition)


_ONE_AT_A_TIME = threading.Lock()  # an inference serves one thread


@lru_cache(maxsize=1024)
def _alone(library: Library, definition: ast.Node) -> Inference:
    """Returns an inference for one definition: for it, the library is the program."""
    from aidl_lang.checking.infer import Inference  # it imports this module
    from aidl_lang.checking.resolve import resolve

    return Inference(resolve(_EMPTY, None, library), standard=())
