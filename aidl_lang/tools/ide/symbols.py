"""The outline of a program, and the search for names in all programs of a project."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from aidl_lang.checking.resolving.symbols import SymbolKind
from aidl_lang.common.names import fold, is_spelled_in
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.project import Project
from aidl_lang.tools.ide.view import View

MOST_FOUND = 200


@record()
class Entry:
    """A declared thing: `detail` describes it, `span` is all of it, `name_span` its name."""

    name: str
    detail: str
    kind: SymbolKind
    span: Span
    name_span: Span
    children: tuple[Entry, ...] = ()


@record()
class SymbolMatch:
    """An entry of the file `path`; `container` is the dotted path of the one around it."""

    path: Path
    entry: Entry
    container: str


def outline(view: View) -> list[Entry]:
    """Returns the declarations of a file in order of writing, with those in loops and branches."""
    return list(_entries(view, view.module.statements))


def search(project: Project, query: str) -> list[SymbolMatch]:
    """Returns entries whose names have the letters of the query, in this order; whole names and beginnings
    first.
    """
    wanted = fold(query)
    found = [
        each
        for path in project.workspace.programs()
        if (view := project.view(path)) is not None
        for each in _flat(view.path, outline(view), "")
        if is_spelled_in(query, each.entry.name)
    ]
    return sorted(found, key=lambda each: _rank(fold(each.entry.name), wanted))[:MOST_FOUND]


def _rank(name: str, wanted: str) -> tuple[bool, bool, bool, int]:
    return name != wanted, not name.startswith(wanted), wanted not in name, len(name)


def _flat(path: Path, entries: Iterable[Entry], container: str) -> Iterator[SymbolMatch]:
    for entry in entries:
        yield SymbolMatch(path, entry, container)
        inner = f"{container}.{entry.name}" if container else entry.name
        yield from _flat(path, entry.children, inner)


def _entries(view: View, statements: Iterable[ast.Statement]) -> Iterator[Entry]:
    for statement in statements:
        match statement:
            case ast.For(body=body):
                yield from _entries(view, body.statements)
            case ast.If(then=then, otherwise=otherwise):
                yield from _entries(view, then.statements)
                yield from _entries(view, otherwise.statements if otherwise else ())
            case ast.Import(alias=alias) if alias is not None:
                yield _entry(view, statement, alias, statement.path.span.text, SymbolKind.NAMESPACE)
            case _:
                yield from _declared(view, statement)


def _declared(view: View, statement: ast.Statement) -> Iterator[Entry]:
    match statement:
        case ast.Structure(parameters=parameters):
            kind = SymbolKind.STRUCTURE if parameters is None else SymbolKind.TEMPLATE
            detail = statement.kind_word.text
            indices = "".join(f"[{i.span.one_line}]" for i in statement.indices)
            yield _entry(view, statement, statement.name, detail, kind, statement.body, indices)
        case ast.ShapeDefinition():
            yield _entry(view, statement, statement.name, "shape", SymbolKind.SHAPE, statement.body)
        case ast.ConstraintDefinition():
            yield _entry(view, statement, statement.name, "constraint", SymbolKind.CONSTRAINT)
        case ast.FunctionDefinition():
            yield _entry(view, statement, statement.name, statement.value.span.one_line, SymbolKind.FUNCTION)
        case ast.Param(value=value):
            yield _entry(view, statement, statement.name, value.span.one_line, SymbolKind.PARAM)
        case ast.Let(value=value):
            yield _entry(view, statement, statement.name, value.span.one_line, SymbolKind.LET)
        case ast.Var(value=value):
            yield _entry(view, statement, statement.name, value.span.one_line, SymbolKind.VAR)
        case ast.Alias(target=target):
            yield _entry(view, statement, statement.name, target.text, SymbolKind.ALIAS)
        case ast.Assign(value=value):
            made = value.callee.text if isinstance(value, ast.Call) else value.span.one_line
            indices = "".join(f"[{i.span.one_line}]" for i in statement.indices)
            symbol = view.resolution.uses.get(statement.name)
            kind = SymbolKind.GEOMETRY if symbol is None else symbol.kind
            yield _entry(view, statement, statement.name, made, kind, None, indices)
        case _:
            pass


def _entry(
    view: View,
    node: ast.Node,
    name: ast.Identifier,
    detail: str,
    kind: SymbolKind,
    body: ast.Block | None = None,
    indices: str = "",
) -> Entry:
    children = tuple(_entries(view, body.statements)) if body is not None else ()
    return Entry(name.text + indices, detail, kind, node.span, name.span, children)
