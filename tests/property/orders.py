"""The same program with its constraints, and siblings that do not name each other, in another order."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator, Sequence

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast


def reordered(text: str, chance: random.Random) -> str:
    """The program with constraints and unrelated siblings in each other's places, in every block."""
    module = parse(SourceFile("program.aidl", text)).module
    return _Reordering(text, chance).statements(module.statements, 0, len(text), held=False)


class _Reordering:
    def __init__(self, text: str, chance: random.Random) -> None:
        self.text, self.chance = text, chance

    def statements(self, nodes: Sequence[ast.Node], start: int, end: int, held: bool) -> str:
        """The text from `start` to `end`, in which these statements stand."""
        movable = (
            [i for i, n in enumerate(nodes) if not isinstance(n, ast.Let)] if held else self._free(nodes)
        )
        order = dict(zip(movable, self.chance.sample(movable, len(movable)), strict=True))
        pieces = []
        for i, node in enumerate(nodes):
            pieces += [self.text[start : node.span.start], self._statement(nodes[order.get(i, i)], held)]
            start = node.span.end
        return "".join([*pieces, self.text[start:end]])

    def _statement(self, node: ast.Node, held: bool) -> str:
        held = isinstance(node, ast.Constrain) or (held and not isinstance(node, ast.Structure))
        pieces, start = [], node.span.start
        for block in _blocks(node):
            first, last = block.span.start, block.span.end
            pieces += [self.text[start:first], self.statements(block.statements, first, last, held)]
            start = last
        return "".join([*pieces, self.text[start : node.span.end]])

    def _free(self, nodes: Sequence[ast.Node]) -> list[int]:
        """The structures among some statements that name none of the others."""
        found = [i for i, n in enumerate(nodes) if isinstance(n, ast.Structure) and n.parameters is None]
        names = {i: re.compile(rf"\b{nodes[i].name.text}\b") for i in found}
        return [
            i
            for i in found
            if not any(
                names[j].search(nodes[i].span.text) or names[i].search(nodes[j].span.text)
                for j in found
                if j != i
            )
        ]


def _blocks(node: ast.Node) -> Iterator[ast.Block]:
    """The outermost blocks in a node, in text order."""
    for child in ast.children(node):
        if isinstance(child, ast.Block):
            yield child
        else:
            yield from _blocks(child)
