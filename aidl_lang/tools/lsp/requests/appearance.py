"""The appearance of a text: colours of its words, folding, selection, its canonical form."""

from __future__ import annotations

from itertools import count

from lsprotocol import types

from aidl_lang.tools.ide.outline import folds, selections
from aidl_lang.tools.ide.positions import format_document, format_range
from aidl_lang.tools.ide.semantic_tokens import (
    MODIFIERS,
    TYPES,
    Colored,
    as_bytes,
    colors,
    semantic_tokens,
    spellings,
)
from aidl_lang.tools.lsp.convert import Converter
from aidl_lang.tools.lsp.documents import Document
from aidl_lang.tools.lsp.server import Asked, Server

_LEGEND = types.SemanticTokensLegend(TYPES, MODIFIERS)
_TYPE = {name: index for index, name in enumerate(TYPES)}
_MODIFIER = {name: 1 << index for index, name in enumerate(MODIFIERS)}
_FOLD = {"comment": types.FoldingRangeKind.Comment, "imports": types.FoldingRangeKind.Imports}


def register_appearance(server: Server) -> None:
    tokens = _Tokens()
    server.answers_to(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, _LEGEND)(tokens.full)
    server.answers_to(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, _LEGEND)(tokens.delta)
    server.answers_to(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, _LEGEND)(_tokens_in_range)
    server.on_closed.append(tokens.forget)
    server.answers_to(types.TEXT_DOCUMENT_FOLDING_RANGE)(_folding)
    server.answers_to(types.TEXT_DOCUMENT_SELECTION_RANGE)(_selections)
    server.answers_to(types.TEXT_DOCUMENT_FORMATTING, edits=True)(_format)
    server.answers_to(types.TEXT_DOCUMENT_RANGE_FORMATTING, edits=True)(_format_range)
    server.answers_to(types.TEXT_DOCUMENT_DOCUMENT_COLOR)(_colors)
    server.answers_to(types.TEXT_DOCUMENT_COLOR_PRESENTATION)(_spellings)


class _Tokens:
    """The last answer for each document, from which differences are told."""

    def __init__(self) -> None:
        self._answered: dict[str, types.SemanticTokens] = {}
        self._ids = count(1)

    def full(self, asked: Asked, params: object) -> types.SemanticTokens:
        data = _encoded(semantic_tokens(asked.view), asked.convert)
        made = types.SemanticTokens(data, result_id=str(next(self._ids)))
        self._answered[asked.uri] = made
        return made

    def delta(
        self, asked: Asked, params: types.SemanticTokensDeltaParams
    ) -> types.SemanticTokens | types.SemanticTokensDelta:
        before = self._answered.get(asked.uri)
        now = self.full(asked, params)
        if before is None or before.result_id != params.previous_result_id:
            return now
        old, new = list(before.data), list(now.data)
        start = _alike(old, new)
        end = min(_alike(old[::-1], new[::-1]), len(old) - start, len(new) - start)
        edit = types.SemanticTokensEdit(start, len(old) - end - start, new[start : len(new) - end])
        changed = bool(edit.delete_count or edit.data)
        return types.SemanticTokensDelta([edit] if changed else [], result_id=now.result_id)

    def forget(self, document: Document) -> None:
        self._answered.pop(document.uri, None)


def _alike(a: list[int], b: list[int]) -> int:
    """Counts the equal numbers at the beginning."""
    return next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))


def _tokens_in_range(asked: Asked, params: types.SemanticTokensRangeParams) -> types.SemanticTokens:
    wanted = asked.convert.span(params.range)
    found = [
        c for c in semantic_tokens(asked.view) if c.span.start < wanted.end and c.span.end > wanted.start
    ]
    return types.SemanticTokens(_encoded(found, asked.convert))


def _encoded(found: list[Colored], convert: Converter) -> list[int]:
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


def _folding(asked: Asked, params: types.FoldingRangeParams) -> list[types.FoldingRange]:
    source, convert = asked.view.source, asked.convert

    def line(number: int) -> int:
        return convert.position(source, source.line_starts[number - 1]).line

    return [
        types.FoldingRange(line(fold.start), line(fold.end), kind=_FOLD.get(fold.kind))
        for fold in folds(asked.view)
    ]


def _selections(asked: Asked, params: types.SelectionRangeParams) -> list[types.SelectionRange]:
    made = []
    for position in params.positions:
        place = types.SelectionRange(types.Range(position, position))
        parent = None
        for span in reversed(selections(asked.view, asked.convert.offset(position))):
            parent = types.SelectionRange(asked.convert.range(span), parent)
        made.append(parent or place)
    return made


def _format(asked: Asked, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
    return asked.convert.edits(format_document(asked.view))


def _format_range(asked: Asked, params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
    return asked.convert.edits(format_range(asked.view, asked.convert.span(params.range)))


def _colors(asked: Asked, params: types.DocumentColorParams) -> list[types.ColorInformation]:
    made = []
    for color in colors(asked.view):
        red, green, blue = (part / 255 for part in color.rgb)
        made.append(
            types.ColorInformation(asked.convert.range(color.span), types.Color(red, green, blue, alpha=1.0))
        )
    return made


def _spellings(asked: Asked, params: types.ColorPresentationParams) -> list[types.ColorPresentation]:
    span = asked.convert.span(params.range)
    rgb = as_bytes((params.color.red, params.color.green, params.color.blue))
    return [
        types.ColorPresentation(text, types.TextEdit(params.range, text))
        for text in spellings(asked.view, span, rgb)
    ]
