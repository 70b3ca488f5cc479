"""Grows a selection from a word to the nodes around it."""

from __future__ import annotations

from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.nodes import around
from aidl_lang.tools.ide.view import View


def selections(view: View, offset: int) -> list[Span]:
    """Returns the ranges around an offset, each larger than the one before and around it, the whole file
    last.
    """
    found: list[Span] = []
    for node in reversed(around(view.module, offset)):
        for span in (*_parts(node, offset), node.span):
            is_around = span.start <= offset <= span.end
            grows = not found or (span.start <= found[-1].start and span.end >= found[-1].end)
            if is_around and grows and (not found or span != found[-1]):
                found.append(span)
    return found


def _parts(node: ast.Node, offset: int) -> list[Span]:
    """Returns the parts of a node that are no nodes: the name of a call or a member, the inside of a
    block.
    """
    match node:
        case ast.Call(callee=name) | ast.Member(name=name):
            return [name.span]
        case ast.Block(span=span) if span.text[:1] == "{" and span.end - span.start > 2:
            inside = span.text[1:-1]
            start = span.start + 1 + len(inside) - len(inside.lstrip())
            return [Span(span.source, start, start + len(inside.strip()))] if inside.strip() else []
        case _:
            return []
