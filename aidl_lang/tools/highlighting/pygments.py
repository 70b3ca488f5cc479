"""The lexer for Pygments, which finds it by the package's entry point. Nothing else imports this module."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import ClassVar

from pygments.lexer import Lexer
from pygments.token import (
    Comment,
    Error,
    Keyword,
    Name,
    Number,
    Operator,
    Punctuation,
    String,
    Whitespace,
    _TokenType,
)

from aidl_lang.tools.highlighting import classify

TOKENS: Mapping[str, _TokenType] = {
    "comment.line": Comment.Single,
    "comment.documentation": String.Doc,
    "comment.block": Comment.Multiline,
    "keyword.declaration": Keyword.Declaration,
    "keyword.demand": Keyword,
    "keyword.modifier": Keyword.Declaration,
    "keyword.control": Keyword,
    "keyword.import": Keyword.Namespace,
    "keyword.clause": Keyword,
    "keyword.operator": Operator.Word,
    "constant.truth": Keyword.Constant,
    "operator.comparison": Operator,
    "operator.arithmetic": Operator,
    "operator.logic": Operator,
    "operator.range": Operator,
    "operator.assignment": Operator,
    "bracket": Punctuation,
    "punctuation": Punctuation,
    "attribute.sign": Name.Decorator,
    "attribute": Name.Decorator,
    "kind": Keyword.Type,
    "name.structure": Name.Class,
    "name.template": Name.Class,
    "name.function": Name.Function,
    "name.definition": Name.Variable,
    "name.parameter": Name.Variable,
    "name.argument": Name.Attribute,
    "name.type": Name.Builtin,
    "name.member": Name.Property,
    "name.everywhere": Name.Builtin.Pseudo,
    "name.constant": Name.Constant,
    "name.module": Name.Namespace,
    "name": Name,
    "call.shape": Name.Builtin,
    "call.constraint": Name.Function.Magic,
    "call.function": Name.Function.Magic,
    "call.member": Name.Function,
    "call": Name.Function,
    "number": Number,
    "unit": Number.Unit,
    "string": String,
    "escape": String.Escape,
    "unknown": Error,
}
"""Pygments' names of the classes, which its styles know."""


class AidlLexer(Lexer):  # type: ignore[misc]  # Pygments has no types
    """Programs in AIDL, broken ones included."""

    name = "AIDL"
    aliases: ClassVar[list[str]] = ["aidl"]
    filenames: ClassVar[list[str]] = ["*.aidl"]
    mimetypes: ClassVar[list[str]] = ["text/x-aidl"]

    def get_tokens_unprocessed(self, text: str) -> Iterator[tuple[int, _TokenType, str]]:
        """Yields every piece and every blank as (offset, token, text)."""
        end = 0
        for piece in classify(text):
            if end < piece.start:
                yield end, Whitespace, text[end : piece.start]
            yield piece.start, TOKENS[piece.kind], text[piece.start : piece.end]
            end = piece.end
        if end < len(text):
            yield end, Whitespace, text[end:]
