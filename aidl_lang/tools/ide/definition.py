"""Go to definition."""

from __future__ import annotations

from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.meaning import mention_at
from aidl_lang.tools.ide.nodes import around
from aidl_lang.tools.ide.view import View


def definitions(view: View, offset: int) -> list[Span]:
    """Returns the declarations of the name at an offset, or the beginning of the file that an import names;
    in this file, in others, or in the library (see `View.file`).
    """
    mention = mention_at(view, offset)
    if mention is not None:
        return [_place(view, declaration.span) for declaration in mention.symbol.declarations]
    for node in around(view.module, offset):
        if isinstance(node, ast.Import) and node.path.span.start <= offset <= node.path.span.end:
            target = view.resolution.imports.get(node)
            return [Span(target.source, 0, 0)] if target is not None else []
    return []


def _place(view: View, span: Span) -> Span:
    """Returns the beginning of a drawing for what is defined by it: its text is none of AIDL."""
    return Span(span.source, 0, 0) if span.source in view.resolution.drawings else span
