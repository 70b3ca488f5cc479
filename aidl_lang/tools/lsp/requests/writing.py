"""Help while writing: completion, signature help and hover."""

from __future__ import annotations

from lsprotocol import types

from aidl_lang.tools.ide.completion import MOST, Completion, complete
from aidl_lang.tools.ide.hover import hover
from aidl_lang.tools.ide.positions import Positions
from aidl_lang.tools.ide.signatures import OverloadHelp, signature_help
from aidl_lang.tools.lsp.documents import Document
from aidl_lang.tools.lsp.params import EntryRequest, read
from aidl_lang.tools.lsp.server import Asked, Server

_KIND = {
    "keyword": types.CompletionItemKind.Keyword,
    "kind": types.CompletionItemKind.Keyword,
    "snippet": types.CompletionItemKind.Snippet,
    "unit": types.CompletionItemKind.Unit,
    "attribute": types.CompletionItemKind.Property,
    "color": types.CompletionItemKind.Color,
    "type": types.CompletionItemKind.TypeParameter,
    "file": types.CompletionItemKind.File,
    "word": types.CompletionItemKind.EnumMember,
    "argument": types.CompletionItemKind.Property,
    "param": types.CompletionItemKind.Constant,
    "let": types.CompletionItemKind.Constant,
    "var": types.CompletionItemKind.Variable,
    "loop variable": types.CompletionItemKind.Variable,
    "parameter": types.CompletionItemKind.Variable,
    "geometry": types.CompletionItemKind.Field,
    "structure": types.CompletionItemKind.Class,
    "field": types.CompletionItemKind.Field,
    "method": types.CompletionItemKind.Method,
    "function": types.CompletionItemKind.Function,
    "shape": types.CompletionItemKind.Struct,
    "constraint": types.CompletionItemKind.Operator,
    "template": types.CompletionItemKind.Interface,
    "imported file": types.CompletionItemKind.Module,
    "built-in name": types.CompletionItemKind.Constant,
}


_PATIENCE = 0.3
"""Seconds that a hover waits for solved values."""


def register_writing(server: Server) -> None:
    lists = _Lists()
    triggers = [".", "@", "(", '"']
    options = types.CompletionOptions(trigger_characters=triggers, resolve_provider=True)
    server.answers_to(types.TEXT_DOCUMENT_COMPLETION, options)(lists.complete)
    server.on_closed.append(lists.forget)

    @server.feature(types.COMPLETION_ITEM_RESOLVE)
    async def resolve(item: types.CompletionItem) -> types.CompletionItem:
        if item.data is not None:
            given = read(item.data, EntryRequest)
            chosen = lists.find(given.uri, given.list, given.entry)
            if chosen is not None:
                said = await server.answers.ask(lambda: chosen.documentation)
                item.documentation = _markdown(said) if said else None
        return item

    server.answers_to(types.TEXT_DOCUMENT_HOVER, patience=_PATIENCE)(_hover)
    helping = types.SignatureHelpOptions(trigger_characters=["(", ","], retrigger_characters=[")"])
    server.answers_to(types.TEXT_DOCUMENT_SIGNATURE_HELP, helping)(_help)


class _Lists:
    """The last list of each document: the documentation of an entry is made on demand."""

    def __init__(self) -> None:
        self._last: dict[str, tuple[int, list[Completion]]] = {}

    def complete(self, asked: Asked, params: types.CompletionParams) -> types.CompletionList:
        offset = asked.convert.offset(params.position)
        found = complete(asked.view, offset, asked.project.workspace.programs)
        number = self._last.get(asked.uri, (0, []))[0] + 1
        self._last[asked.uri] = number, found
        snippets = asked.can("text_document.completion.completion_item.snippet_support")
        return types.CompletionList(
            is_incomplete=len(found) >= MOST,
            items=[
                _item(each, asked, snippets, {"uri": asked.uri, "list": number, "entry": index})
                for index, each in enumerate(found)
            ],
        )

    def find(self, uri: str, number: int, entry: int) -> Completion | None:
        known, found = self._last.get(uri, (0, []))
        return found[entry] if known == number and 0 <= entry < len(found) else None

    def forget(self, document: Document) -> None:
        self._last.pop(document.uri, None)


def _item(each: Completion, asked: Asked, snippets: bool, data: dict[str, object]) -> types.CompletionItem:
    edit, snippet = asked.convert, types.InsertTextFormat.Snippet
    is_snippet = each.is_snippet and snippets
    return types.CompletionItem(
        label=each.label,
        kind=_KIND.get(each.kind, types.CompletionItemKind.Text),
        detail=each.detail or None,
        sort_text=f"{each.rank:04}",
        insert_text_format=snippet if is_snippet else types.InsertTextFormat.PlainText,
        text_edit=types.TextEdit(edit.range(each.span), each.text if is_snippet else each.plain),
        additional_text_edits=[edit.edit(e) for e in each.extra] or None,
        data=data,
    )


def _hover(asked: Asked, params: types.HoverParams) -> types.Hover | None:
    found = hover(asked.view, asked.convert.offset(params.position))
    return None if found is None else types.Hover(_markdown(found.text), asked.convert.range(found.span))


def _help(asked: Asked, params: types.SignatureHelpParams) -> types.SignatureHelp | None:
    found = signature_help(asked.view, asked.convert.offset(params.position))
    if found is None:
        return None
    return types.SignatureHelp(
        [_overload(overload) for overload in found.overloads],
        active_signature=found.active,
        active_parameter=_active(found.overloads[found.active]),
    )


def _overload(overload: OverloadHelp) -> types.SignatureInformation:
    positions = Positions(overload.label)  # which are of UTF-16 here, whatever was agreed for texts
    parameters = []
    for parameter in overload.parameters:
        start, end = (positions.length(0, offset) for offset in parameter.place)
        about = _markdown(parameter.about) if parameter.about else None
        parameters.append(types.ParameterInformation((start, end), about))
    about = _markdown(overload.about) if overload.about else None
    return types.SignatureInformation(overload.label, about, parameters, _active(overload))


def _active(overload: OverloadHelp) -> int:
    """Returns the current parameter; one past the last if there is none."""
    return len(overload.parameters) if overload.active is None else overload.active


def _markdown(text: str) -> types.MarkupContent:
    return types.MarkupContent(types.MarkupKind.Markdown, text)
