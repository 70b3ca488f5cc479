"""Navigation, renaming, and the appearance of a text: colours, folding, selection, its canonical form."""

from __future__ import annotations

from functools import partial
from itertools import count

from lsprotocol import types

from aidl_lang.checking.symbols import SymbolKind
from aidl_server.ide import outline, references
from aidl_server.ide.preview.elements import alike
from aidl_server.ide.workspace import format_document, format_range
from aidl_server.lsp.documents import Converter
from aidl_server.lsp.server import Asked, Server

# --- Navigation: definitions, references, outlines, links; and renaming.

_KIND = {
    SymbolKind.PARAM: types.SymbolKind.Constant,
    SymbolKind.LET: types.SymbolKind.Constant,
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
    @server.answers_to(types.TEXT_DOCUMENT_DEFINITION)
    def definition(asked: Asked, params: types.DefinitionParams) -> list[types.Location]:
        spans = references.definitions(asked.view, asked.convert.offset(params.position))
        return [place for span in spans if (place := asked.convert.location(span)) is not None]

    @server.answers_to(types.TEXT_DOCUMENT_REFERENCES, searches=True)
    def find_references(asked: Asked, params: types.ReferenceParams) -> list[types.Location]:
        view = asked.project.view(asked.view.path)
        if view is None:
            return []
        convert = asked.convert
        found = references.references(asked.project, view, convert.offset(params.position))
        return [
            types.Location(convert.uri_of(each.path), convert.range(each.span))
            for each in found
            if params.context.include_declaration or not each.is_declaration
        ]

    @server.answers_to(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def highlight(asked: Asked, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
        found = references.highlights(asked.view, asked.convert.offset(params.position))
        kinds = (types.DocumentHighlightKind.Read, types.DocumentHighlightKind.Write)
        places = ((asked.convert.range(each.span), kinds[each.is_declaration]) for each in found)
        return [types.DocumentHighlight(*each) for each in places]

    @server.answers_to(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare_rename(asked: Asked, params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder:
        span = references.renameable(asked.view, asked.convert.offset(params.position))
        return types.PrepareRenamePlaceholder(asked.convert.range(span), span.text)

    @server.answers_to(types.TEXT_DOCUMENT_RENAME, searches=True, edits=True)
    def rename_everywhere(asked: Asked, params: types.RenameParams) -> types.WorkspaceEdit | None:
        view = asked.project.view(asked.view.path)
        if view is None:
            return None
        offset = asked.convert.offset(params.position)
        return asked.convert.changes(references.rename(asked.project, view, offset, params.new_name))

    server.answers_to(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)(_outline)

    @server.answers_to(types.TEXT_DOCUMENT_DOCUMENT_LINK)
    def find_links(asked: Asked, params: types.DocumentLinkParams) -> list[types.DocumentLink]:
        return [
            types.DocumentLink(asked.convert.range(span), asked.convert.uri_of(path))
            for span, path in references.links(asked.view)
        ]

    @server.feature(types.WORKSPACE_SYMBOL)
    async def search_everywhere(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        return await server.searches.ask(partial(_search, server, params.query))


def _outline(
    asked: Asked, params: types.DocumentSymbolParams
) -> list[types.DocumentSymbol] | list[types.SymbolInformation]:
    entries = outline.outline(asked.view)
    if asked.can("text_document.document_symbol.hierarchical_document_symbol_support"):
        return [_symbol(entry, asked.convert) for entry in entries]
    return [
        types.SymbolInformation(
            types.Location(asked.uri, asked.convert.range(entry.span)),
            entry.name,
            _kind(entry),
            container_name=container or None,
        )
        for entry, container in outline.flat(entries)
    ]


def _kind(entry: outline.Entry) -> types.SymbolKind:
    return _KIND.get(entry.kind, types.SymbolKind.Variable)


def _symbol(entry: outline.Entry, convert: Converter) -> types.DocumentSymbol:
    return types.DocumentSymbol(
        name=entry.name or " ",
        kind=_kind(entry),
        range=convert.range(entry.span),
        selection_range=convert.range(entry.name_span),
        detail=entry.detail,
        children=[_symbol(child, convert) for child in entry.children],
    )


def _search(server: Server, query: str) -> list[types.WorkspaceSymbol]:
    made = []
    for view, entry, container in outline.search(server.project, query):
        if (place := server.converter(view).location(entry.name_span)) is not None:
            kind, around = _kind(entry), container or None
            made.append(types.WorkspaceSymbol(place, entry.name, kind, container_name=around))
    return made


_LEGEND = types.SemanticTokensLegend(outline.TYPES, outline.MODIFIERS)
_TYPE = {name: index for index, name in enumerate(outline.TYPES)}
_MODIFIER = {name: 1 << index for index, name in enumerate(outline.MODIFIERS)}
_FOLD = {"comment": types.FoldingRangeKind.Comment, "imports": types.FoldingRangeKind.Imports}


def register_appearance(server: Server) -> None:
    server.answers_to(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, _LEGEND)(_tokens)
    server.answers_to(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, _LEGEND)(_new_tokens)

    @server.answers_to(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, _LEGEND)
    def tokens_in_range(asked: Asked, params: types.SemanticTokensRangeParams) -> types.SemanticTokens:
        wanted = asked.convert.span(params.range)
        found = [c for c in outline.semantic_tokens(asked.view) if c.span.overlaps(wanted)]
        return types.SemanticTokens(_encoded(found, asked.convert))

    @server.answers_to(types.TEXT_DOCUMENT_FOLDING_RANGE)
    def folding(asked: Asked, params: types.FoldingRangeParams) -> list[types.FoldingRange]:
        source, convert = asked.view.source, asked.convert

        def line(number: int) -> int:
            return convert.position(source, source.line_starts[number - 1]).line

        found = outline.folds(asked.view)
        return [types.FoldingRange(line(a), line(b), kind=_FOLD.get(kind)) for a, b, kind in found]

    @server.answers_to(types.TEXT_DOCUMENT_SELECTION_RANGE)
    def find_selections(asked: Asked, params: types.SelectionRangeParams) -> list[types.SelectionRange]:
        made = []
        for position in params.positions:
            place = types.SelectionRange(types.Range(position, position))
            parent = None
            for span in reversed(outline.selections(asked.view, asked.convert.offset(position))):
                parent = types.SelectionRange(asked.convert.range(span), parent)
            made.append(parent or place)
        return made

    @server.answers_to(types.TEXT_DOCUMENT_FORMATTING, edits=True)
    def format(asked: Asked, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        return asked.convert.edits(format_document(asked.view))

    @server.answers_to(types.TEXT_DOCUMENT_RANGE_FORMATTING, edits=True)
    def format_lines(asked: Asked, params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
        return asked.convert.edits(format_range(asked.view, asked.convert.span(params.range)))

    @server.answers_to(types.TEXT_DOCUMENT_DOCUMENT_COLOR)
    def find_colors(asked: Asked, params: types.DocumentColorParams) -> list[types.ColorInformation]:
        return [
            types.ColorInformation(
                asked.convert.range(span), types.Color(red / 255, green / 255, blue / 255, alpha=1.0)
            )
            for span, (red, green, blue) in outline.colors(asked.view)
        ]

    @server.answers_to(types.TEXT_DOCUMENT_COLOR_PRESENTATION)
    def find_spellings(asked: Asked, params: types.ColorPresentationParams) -> list[types.ColorPresentation]:
        span = asked.convert.span(params.range)
        rgb = params.color.red, params.color.green, params.color.blue
        return [
            types.ColorPresentation(text, types.TextEdit(params.range, text))
            for text in outline.spellings(asked.view, span, rgb)
        ]


_ids = count(1)


def _tokens(asked: Asked, params: object) -> types.SemanticTokens:
    data = _encoded(outline.semantic_tokens(asked.view), asked.convert)
    asked.document.colored = types.SemanticTokens(data, result_id=str(next(_ids)))
    return asked.document.colored


def _new_tokens(
    asked: Asked, params: types.SemanticTokensDeltaParams
) -> types.SemanticTokens | types.SemanticTokensDelta:
    """Returns the difference to the last answer."""
    before, now = asked.document.colored, _tokens(asked, params)
    if before is None or before.result_id != params.previous_result_id:
        return now
    old, new = list(before.data), list(now.data)
    start = alike(old, new)
    end = alike(old[start:][::-1], new[start:][::-1])
    edit = types.SemanticTokensEdit(start, len(old) - end - start, new[start : len(new) - end])
    changed = bool(edit.delete_count or edit.data)
    return types.SemanticTokensDelta([edit] if changed else [], result_id=now.result_id)


def _encoded(found: list[outline.Colored], convert: Converter) -> list[int]:
    """Returns five numbers for each token, its place relative to the one before."""
    data: list[int] = []
    line = character = 0
    for colored in found:
        place = convert.range(colored.span)
        start, length = place.start, place.end.character - place.start.character
        if place.end.line != start.line or length <= 0:
            continue
        modifiers = sum(_MODIFIER[name] for name in colored.modifiers)
        after = character if start.line == line else 0
        data += [start.line - line, start.character - after, length, _TYPE[colored.type], modifiers]
        line, character = start.line, start.character
    return data
