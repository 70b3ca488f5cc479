"""Ready-made cuts, such as `clearance_hole("m3")`: holes in a solid or an assembly, elsewhere outlines.

The library has each under one name, as a template and as an operation that makes its outline. The place of a
call decides which of them it means; the centre given to a hole becomes its placement.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from aidl_lang.checking.builtins import COPYING, CUTS, OUTLINES, PATTERNS
from aidl_lang.checking.synonyms import PARAMETERS
from aidl_lang.checking.types import Signature
from aidl_lang.common.names import fold, folded
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

_FOLDED = frozenset(map(fold, CUTS))
_HOLDING = ("solid", "assembly")
_CENTER = 1
"""The index of the centre among the arguments of every cut."""


def with_placed_cuts(module: ast.Module) -> ast.Module:
    """Returns a file in which the centre given to a hole stands behind `at`."""
    if not (cuts := _cuts_in(module)):
        return module
    return replace(module, statements=_Reader(cuts).placed(module.statements, "", frozenset()))


def hole_calls(module: ast.Module) -> frozenset[ast.Call]:
    """Returns the calls of a file that make holes, of cuts that can make outlines as well."""
    if not (cuts := _cuts_in(module)):
        return frozenset()
    return frozenset(_Reader(cuts).calls(module.statements, "", frozenset()))


def meant(candidates: Sequence[Signature], is_hole: bool) -> Sequence[Signature]:
    """Returns the overloads of a ready-made cut that are meant: templates for a hole, else those that make an
    outline.
    """
    templates = [c.kind is ast.Structure for c in candidates if c.standard]
    if all(templates) or not any(templates):
        return candidates
    return [c for c in candidates if not c.standard or (c.kind is ast.Structure) is is_hole]


def _cuts_in(module: ast.Module) -> frozenset[str]:
    """Returns the folded names of cuts that a file may mean: none that it defines itself."""
    text = folded(module.source.text)
    found = {name for name in _FOLDED if name in text}
    if found:
        found -= {fold(n.name.text) for n in ast.walk(module) if isinstance(n, ast.Callable | ast.Alias)}
    return frozenset(found)


@record()
class _Reader:
    """A reader of the bodies of a file. `kind` is that of the structure around, `outlines` are the names of
    which other outlines are made in it.
    """

    cuts: frozenset[str]

    def _is_cut(self, call: ast.Call) -> bool:
        return fold(call.callee.text) in self.cuts

    # --- Finding --------------------------------------------------------------------------------

    def calls(
        self, statements: Sequence[ast.Statement], kind: str, outlines: frozenset[str]
    ) -> Iterator[ast.Call]:
        for node in statements:
            match node:
                case ast.Structure(body=body):
                    yield from self.calls(body.statements, node.kind, _used_as_outlines(body))
                case ast.For(body=body):
                    yield from self.calls(body.statements, kind, outlines)
                case ast.If(then=then, otherwise=otherwise):
                    for block in (then, otherwise):
                        yield from self.calls(block.statements, kind, outlines) if block is not None else ()
                case ast.Assign(name=name, value=value) if kind in _HOLDING and name.text not in outlines:
                    yield from self._made(value)

    def _made(self, value: ast.Expression) -> Iterator[ast.Call]:
        """Yields the cuts that an assignment makes: its value, members of it, or what it makes copies of."""
        match value:
            case ast.Call() if self._is_cut(value):
                yield value
            case ast.Call(callee=callee, receiver=receiver, arguments=arguments):
                if callee.text in COPYING | PATTERNS:
                    named = (a.value for a in arguments if a.name is None or fold(a.name.text) == "x")
                    if (of := receiver or next(named, None)) is not None:
                        yield from self._made(of)
            case ast.List(items=items):
                for item in items:
                    yield from self._made(item)
            case ast.Comprehension(element=element):
                yield from self._made(element)
            case ast.Conditional(then=then, otherwise=otherwise):
                yield from self._made(then)
                yield from self._made(otherwise)

    # --- Placing --------------------------------------------------------------------------------

    def placed(
        self, statements: Sequence[ast.Statement], kind: str, outlines: frozenset[str]
    ) -> tuple[ast.Statement, ...]:
        return tuple(self._statement(node, kind, outlines) for node in statements)

    def _block(self, block: ast.Block, kind: str, outlines: frozenset[str]) -> ast.Block:
        return replace(block, statements=self.placed(block.statements, kind, outlines))

    def _statement(self, node: ast.Statement, kind: str, outlines: frozenset[str]) -> ast.Statement:
        match node:
            case ast.Structure(body=body):
                return replace(node, body=self._block(body, node.kind, _used_as_outlines(body)))
            case ast.For(body=body):
                return replace(node, body=self._block(body, kind, outlines))
            case ast.If(then=then, otherwise=otherwise):
                other = self._block(otherwise, kind, outlines) if otherwise is not None else None
                return replace(node, then=self._block(then, kind, outlines), otherwise=other)
            case ast.Assign(name=name) if kind in _HOLDING and name.text not in outlines:
                return self._assign(node)
        return node

    def _assign(self, node: ast.Assign) -> ast.Assign:
        value, placement = node.value, node.placement
        if not (isinstance(value, ast.Call) and self._is_cut(value)):
            moved = self._moved(value)
            return node if moved is value else replace(node, value=moved)
        call, center = _without_center(value)
        if center is None or (placement is not None and placement.at is not None):
            return node
        rotated = placement.rotated if placement is not None else None
        return replace(node, value=call, placement=ast.Placement(center, rotated, span=center.span))

    def _moved(self, value: ast.Expression) -> ast.Expression:
        """Returns a value in which each cut with a centre is a copy moved there."""
        match value:
            case ast.Call() if self._is_cut(value):
                call, center = _without_center(value)
                if center is None:
                    return value
                callee = ast.Identifier("copy", span=value.callee.span)
                by = ast.Argument(ast.Identifier("by", span=center.span), center, span=center.span)
                return ast.Call(callee, None, (ast.Argument(None, call, span=call.span), by), span=value.span)
            case ast.List(items=items):
                return replace(value, items=tuple(map(self._moved, items)))
            case ast.Comprehension(element=element):
                return replace(value, element=self._moved(element))
            case ast.Conditional(then=then, otherwise=otherwise):
                return replace(value, then=self._moved(then), otherwise=self._moved(otherwise))
        return value


def _used_as_outlines(body: ast.Block) -> frozenset[str]:
    """Returns the names in a body of which other outlines are made there."""
    calls = (n for n in ast.walk(body) if isinstance(n, ast.Call) and n.callee.text in OUTLINES)
    return frozenset(n.text for call in calls for n in ast.walk(call) if isinstance(n, ast.Name))


def _without_center(call: ast.Call) -> tuple[ast.Call, ast.Expression | None]:
    """Returns a call without its centre, and the centre; None for a call that has none."""
    named = (a for a in call.arguments if a.name is not None and _means_center(a.name.text))
    unnamed = [a for a in call.arguments if a.name is None]
    by_place = unnamed[_CENTER] if len(unnamed) > _CENTER and call.receiver is None else None
    found = next(named, by_place)
    if found is None:
        return call, None
    return replace(call, arguments=tuple(a for a in call.arguments if a is not found)), found.value


def _means_center(word: str) -> bool:
    return fold(word) == "center" or "center" in PARAMETERS.get(fold(word), ())
