"""Writes a changed program as a minimal edit of the one before: unchanged meaning keeps its text and
comments.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Sequence
from functools import cached_property

from aidl_lang.common.diagnostics import has_errors
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_statement


def merge(before: str, after: str) -> str:
    """The text of `after` with all that it has in common with `before` written as it is there.

    `after` itself where one of the two does not parse, or the result would not mean the same.
    """
    old, new = (parse(SourceFile("part.aidl", text)) for text in (before, after))
    if has_errors(old.diagnostics) or has_errors(new.diagnostics):
        return after
    text = _merged(_Body.of_file(old.module), _Body.of_file(new.module))
    result = parse(SourceFile("part.aidl", text))
    if has_errors(result.diagnostics) or _means(result.module) != _means(new.module):
        return after
    return text


def _means(module: ast.Module) -> list[str]:
    return [_key(statement) for statement in module.statements]


def _key(statement: ast.Statement) -> str:
    """Returns the meaning of a statement: its canonical form, wherever lines were ended."""
    return re.sub(r"\s*\n\s*", " ", format_statement(statement))


@record()
class _Item:
    """A statement in its text: `lead` is the text before it from the end of the line above on, and `tail` the
    rest of its line.
    """

    node: ast.Statement
    lead: str
    tail: str

    @cached_property
    def key(self) -> str:
        return _key(self.node)

    @property
    def subject(self) -> tuple[object, ...]:
        """A key of its subject: two statements of one subject are versions of each other."""
        match self.node:
            case ast.Structure(kind=kind, name=name, indices=indices):
                return kind, name.text, len(indices)
            case ast.Constrain(braces=braces):
                return type(self.node), braces
            case ast.Param(name=name) | ast.Var(name=name) | ast.Let(name=name) | ast.Assign(name=name):
                return type(self.node), name.text
            case ast.ExpressionStatement(value=ast.Call(callee=callee)):
                return type(self.node), callee.text
            case _:
                return (type(self.node),)


@record()
class _Body:
    """The statements of a file or a block, and the text after the last of them."""

    items: tuple[_Item, ...]
    end: str

    @classmethod
    def of_file(cls, module: ast.Module) -> _Body:
        return cls.between(module.source.text, module.statements, 0, len(module.source.text))

    @classmethod
    def of_block(cls, block: ast.Block) -> _Body:
        return cls.between(block.span.source.text, block.statements, block.span.start + 1, block.span.end - 1)

    @classmethod
    def between(cls, text: str, statements: Sequence[ast.Statement], start: int, end: int) -> _Body:
        items = []
        for i, node in enumerate(statements):
            following = statements[i + 1].span.start if i + 1 < len(statements) else end
            line_end = text.find("\n", node.span.end, following)
            stop = node.span.end if line_end < 0 else line_end
            items.append(_Item(node, text[start : node.span.start], text[node.span.end : stop]))
            start = stop
        return cls(tuple(items), text[start:end])


def _merged(old: _Body, new: _Body) -> str:
    return "".join(_pieces(old, new)) + old.end


def _pieces(old: _Body, new: _Body) -> Iterator[str]:
    keys = [item.key for item in old.items], [item.key for item in new.items]
    matcher = difflib.SequenceMatcher(None, *keys, autojunk=False)
    for kind, i, i_end, j, j_end in matcher.get_opcodes():
        if kind == "equal":
            yield from (_text(item) for item in old.items[i:i_end])
        else:
            yield from _versions(old.items[i:i_end], new.items[j:j_end])


def _versions(gone: Sequence[_Item], come: Sequence[_Item]) -> Iterator[str]:
    """Yields new statements, each as an edit of the old one of its subject, or of a renamed one."""
    left, subjects = list(gone), {item.subject for item in come}
    for item in come:
        same = (old for old in left if old.subject == item.subject)
        renamed = (o for o in left if type(o.node) is type(item.node) and o.subject not in subjects)
        was = next(same, None) or next(renamed, None)
        if was is None:
            yield _text(item)
            continue
        left.remove(was)
        lead = was.lead if was.lead.strip() or not item.lead.strip() else item.lead
        yield lead + _version(was.node, item.node) + (item.tail if item.tail.strip() else was.tail)


def _text(item: _Item) -> str:
    return item.lead + item.node.span.text + item.tail


def _version(old: ast.Statement, new: ast.Statement) -> str:
    blocks = _block(old), _block(new)
    if blocks[0] is None or blocks[1] is None:
        return new.span.text
    heads = [_head(node, block) for node, block in zip((old, new), blocks, strict=True) if block]
    head = heads[0] if _spaceless(heads[0]) == _spaceless(heads[1]) else heads[1]
    return f"{head}{{{_merged(_Body.of_block(blocks[0]), _Body.of_block(blocks[1]))}}}"


def _block(node: ast.Statement) -> ast.Block | None:
    """Returns the one block of a statement that is a head and a block."""
    blocks = [child for child in ast.children(node) if isinstance(child, ast.Block)]
    return blocks[0] if len(blocks) == 1 and blocks[0].span.text.startswith("{") else None


def _head(node: ast.Statement, block: ast.Block) -> str:
    return node.span.source.text[node.span.start : block.span.start]


def _spaceless(text: str) -> str:
    return re.sub(r"\s+", "", text)
