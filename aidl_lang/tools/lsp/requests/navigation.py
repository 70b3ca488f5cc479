"""Navigation: definitions, references, outlines, links; and renaming."""

from __future__ import annotations

from functools import partial
from typing import NoReturn

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from aidl_lang.checking.resolving.symbols import SymbolKind
from aidl_lang.tools.ide.outline import Entry, outline, search
from aidl_lang.tools.ide.references import (
    CannotError,
    definitions,
    highlights,
    links,
    references,
    rename,
    renameable,
)
from aidl_lang.tools.lsp.convert import Converter
from aidl_lang.tools.lsp.server import FAILED, Asked, Server

_KIND = {
    SymbolKind.PARAM: types.SymbolKind.Constant,
    SymbolKind.LET: types.SymbolKind.Constant,
    SymbolKind.VAR: types.SymbolKind.Variable,
    SymbolKind.LOOP: types.SymbolKind.Variable,
    SymbolKind.ARGUMENT: types.SymbolKind.Variable,
    SymbolKind.GEOMETRY: types.SymbolKind.Field,
    SymbolKind.STRUCTURE: types.SymbolKind.Class,
    SymbolKind.FUNCTION: types.SymbolKind.Function,
    SymbolKind.SHAPE: types.SymbolKind.Struct,
    SymbolKind.CONSTRAINT: types.SymbolKind.Operator,
    SymbolKind.TEMPLATE: types.SymbolKind.Interface,
    SymbolKind.ALIAS: types.SymbolKind.Function,
    SymbolKind.NAMESPACE: types.SymbolKind.Module,
}


def register_navigation(server: Server) -> None:
    server.answers_to(types.TEXT_DOCUMENT_DEFINITION)(_definition)
    server.answers_to(types.TEXT_DOCUMENT_REFERENCES, searches=True)(_references)
    server.answers_to(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)(_highlight)
    server.answers_to(types.TEXT_DOCUMENT_PREPARE_RENAME)(_prepare_rename)
    server.answers_to(types.TEXT_DOCUMENT_RENAME, searches=True, edits=True)(_rename)
    server.answers_to(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)(_outline)
    server.answers_to(types.TEXT_DOCUMENT_DOCUMENT_LINK)(_links)

    @server.feature(types.WORKSPACE_SYMBOL)
    async def search_everywhere(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        return await server.searches.ask(partial(_search, server, params.query))


def _definition(asked: Asked, params: types.DefinitionParams) -> list[types.Location]:
    spans = definitions(asked.view, asked.convert.offset(params.position))
    return [place for span in spans if (place := asked.convert.location(span)) is not None]


def _references(asked: Asked, params: types.ReferenceParams) -> list[types.Location]:
    view = asked.project.view(asked.view.path)
    if view is None:
        return []
    convert = asked.convert
    found = references(asked.project, view, convert.offset(params.position))
    return [
        types.Location(convert.uri_of(each.path), convert.range(each.span))
        for each in found
        if params.context.include_declaration or not each.is_declaration
    ]


def _highlight(asked: Asked, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
    return [
        types.DocumentHighlight(
            asked.convert.range(each.span),
            types.DocumentHighlightKind.Write if each.is_declaration else types.DocumentHighlightKind.Read,
        )
        for each in highlights(asked.view, asked.convert.offset(params.position))
    ]


def _prepare_rename(asked: Asked, params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder:
    try:
        span = renameable(asked.view, asked.convert.offset(params.position))
    except CannotError as reason:
        _fail(reason)
    return types.PrepareRenamePlaceholder(asked.convert.range(span), span.text)


def _rename(asked: Asked, params: types.RenameParams) -> types.WorkspaceEdit | None:
    view = asked.project.view(asked.view.path)
    if view is None:
        return None
    try:
        made = rename(asked.project, view, asked.convert.offset(params.position), params.new_name)
    except CannotError as reason:
        _fail(reason)
    return asked.convert.changes(made.edits, asked.can("workspace.workspace_edit.document_changes"))


def _fail(reason: Exception) -> NoReturn:
    raise JsonRpcException(str(reason), FAILED) from None


def _outline(
    asked: Asked, params: types.DocumentSymbolParams
) -> list[types.DocumentSymbol] | list[types.SymbolInformation]:
    entries = outline(asked.view)
    if asked.can("text_document.document_symbol.hierarchical_document_symbol_support"):
        return [_symbol(entry, asked.convert) for entry in entries]
    flat = [(entry, "") for entry in entries]
    for entry, container in flat:  # grows while it is gone through
        inner = f"{container}.{entry.name}" if container else entry.name
        flat += [(child, inner) for child in entry.children]
    return [
        types.SymbolInformation(
            types.Location(asked.uri, asked.convert.range(entry.span)),
            entry.name,
            _KIND.get(entry.kind, types.SymbolKind.Variable),
            container_name=container or None,
        )
        for entry, container in flat
    ]


def _symbol(entry: Entry, convert: Converter) -> types.DocumentSymbol:
    return types.DocumentSymbol(
        name=entry.name or " ",
        kind=_KIND.get(entry.kind, types.SymbolKind.Variable),
        range=convert.range(entry.span),
        selection_range=convert.range(entry.name_span),
        detail=entry.detail,
        children=[_symbol(child, convert) for child in entry.children],
    )


def _search(server: Server, query: str) -> list[types.WorkspaceSymbol]:
    made = []
    for found in search(server.project, query):
        view = server.project.view(found.path)
        if view is None:
            continue  # gone just now
        convert = server.converter(view)
        uri = server.documents.uri_of(found.path)
        place = types.Location(uri, convert.range(found.entry.name_span))
        kind = _KIND.get(found.entry.kind, types.SymbolKind.Variable)
        made.append(
            types.WorkspaceSymbol(place, found.entry.name, kind, container_name=found.container or None)
        )
    return made


def _links(asked: Asked, params: types.DocumentLinkParams) -> list[types.DocumentLink]:
    return [
        types.DocumentLink(asked.convert.range(link.span), asked.convert.uri_of(link.path))
        for link in links(asked.view)
    ]
