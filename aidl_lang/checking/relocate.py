"""Relocation of statements from one structure to another above it: paths, names and the place to write."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.checking.facts import NOTHING_READ
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.named import of_symbol
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind, SymbolScope
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

_ATOMS = ast.Name | ast.Member | ast.Index | ast.Call | ast.Number | ast.Point | ast.List


def member_path(name: ast.Identifier, indices: Sequence[ast.Expression]) -> str:
    """Returns a name with its indices as it is declared: `finger[i]`."""
    return name.text + "".join(f"[{index.span.text}]" for index in indices)


@record(eq=False)
class StatementSite:
    """A place among the statements of a file.

    homes  the structures around, the file first
    trail  the statements around, outermost first, and whether the place is in the `else` of each
    """

    homes: tuple[ast.Node, ...]
    trail: tuple[tuple[ast.Statement, bool], ...]

    @property
    def home(self) -> ast.Node:
        return self.homes[-1]

    def within(self, statement: ast.Statement) -> StatementSite:
        return StatementSite(self.homes, (*self.trail, (statement, False)))

    def inside(self, structure: ast.Structure) -> StatementSite:
        return StatementSite((*self.homes, structure), self.trail)

    def otherwise(self, _: ast.If) -> StatementSite:
        return StatementSite(self.homes, (*self.trail[:-1], (self.trail[-1][0], True)))


class Relocation:
    """A move of expressions from a site to an ancestor of its structure, behind the statement that holds the
    site.
    """

    def __init__(self, site: StatementSite, ancestor: ast.Node, infer: Inference) -> None:
        self.site = site
        self.infer = infer
        self.level = site.homes.index(ancestor)
        self.between = site.homes[self.level + 1 :]
        self.scope = infer.resolution.scopes[ancestor]
        nodes: list[ast.Node] = [statement for statement, _ in site.trail]
        self.start = nodes.index(self.between[0]) if self.between else len(nodes) - 1
        self.anchor = nodes[self.start]

    @property
    def is_possible(self) -> bool:
        """False for a site in a template, whose instances stand in many places."""
        return all(isinstance(n, ast.Structure) and n.parameters is None for n in self.between)

    def path(self, to: ast.Node | None = None) -> str:
        """Returns the path from the ancestor to the site's structure, or to one around it; empty for
        itself.
        """
        steps: list[str] = []
        for node in self.between:
            assert isinstance(node, ast.Structure)
            steps.append(member_path(node.name, node.indices))
            if node is to:
                break
        return ".".join(steps)

    def statement(self, text: str) -> str | None:
        """Returns a statement for the ancestor, in the loops and branches that the site is in below it."""
        for node, is_else in reversed(self.site.trail[self.start + 1 :]):
            if isinstance(node, ast.For):
                run = self.expression(node.iterable)
                if run is None:
                    return None
                variables = ", ".join(v.text for v in node.variables)
                text = f"for {variables} in {run} {{ {text} }}"
            elif isinstance(node, ast.If):
                test = self.expression(node.test)
                if test is None:
                    return None
                text = f"if {f'not ({test})' if is_else else test} {{ {text} }}"
        return text

    def expression(self, node: ast.Node) -> str | None:
        """Returns the text of an expression for the ancestor; None if the ancestor cannot name everything in
        it.
        """
        edits: list[tuple[int, int, str]] = []
        resolution = self.infer.resolution
        for part in ast.walk(node):
            if isinstance(part, ast.Call) and self.scope.called(part.callee.text) is None:
                return None
            if not isinstance(part, ast.Name):
                continue
            symbol = resolution.uses.get(part)
            if symbol is None:
                return None
            text = self._name(part, symbol, node)
            if text is None:
                return None
            if text != part.text:
                edits.append((part.span.start, part.span.end, text))
        text = node.span.text
        for start, end, new in sorted(edits, reverse=True):
            text = text[: start - node.span.start] + new + text[end - node.span.start :]
        return text

    def _name(self, node: ast.Name, symbol: Symbol, whole: ast.Node) -> str | None:
        if not self.between:
            return node.text
        match symbol.kind:
            case SymbolKind.WORD | SymbolKind.NAMESPACE:
                return node.text
            case SymbolKind.BUILTIN:
                return self._builtin(node.text)
            case SymbolKind.LOOP:
                here = any(s is symbol.node for s, _ in self.site.trail)
                inside = any(n is symbol.node for n in ast.walk(whole))
                return node.text if here or inside else None
            case _:
                pass
        if symbol.scope is None:
            return self._own_name(node, symbol)
        home = symbol.scope.homes[-1]
        if home in self.between:
            return self._from_below(node, symbol, symbol.scope, home)
        return node.text if self.scope.value(node.text) is symbol else None

    def _builtin(self, name: str) -> str:
        if name == "self":
            return self.path()
        return f"{self.path()}.{name}" if name in ("origin", "x_axis", "y_axis") else name

    def _own_name(self, node: ast.Name, symbol: Symbol) -> str | None:
        if symbol.node in self.between:
            return self.path(symbol.node)
        found = self.scope.value(node.text)
        return node.text if found is not None and found.node is symbol.node else None

    def _from_below(self, node: ast.Name, symbol: Symbol, scope: SymbolScope, home: ast.Node) -> str | None:
        """Returns the path of a name declared by a structure between the two; the expression itself if the
        name stands for one over unknowns, or belongs to a turn of a loop.
        """
        if symbol.kind is SymbolKind.ARGUMENT:
            return None
        reads = of_symbol(self.infer, symbol).reads
        is_local = isinstance(scope.owner, ast.For | ast.ForArguments | ast.Block | ast.ArgumentBlock)
        if symbol.kind is SymbolKind.LET and (is_local or reads != NOTHING_READ):
            value = getattr(symbol.node, "value", None)
            if value is None or symbol.is_array or len(symbol.nodes) > 1:
                return None
            text = self.expression(value)
            return text if text is None or isinstance(value, _ATOMS) else f"({text})"
        return f"{self.path(home)}.{symbol.name}"


def insertion_after(statement: ast.Node, text: str) -> tuple[Span, str]:
    """Returns where to write a statement behind another, and how: on a line of its own, indented alike,
    unless more than a comment follows on the line.
    """
    source = statement.span.source
    line_number, _ = source.position(statement.span.start)
    line = source.line(line_number)
    indent = line[: len(line) - len(line.lstrip())]
    end = statement.span.end
    stop = source.text.find("\n", end)
    stop = len(source.text) if stop < 0 else stop
    rest = source.text[end:stop].strip().lstrip(";").strip()
    if rest and not rest.startswith(("//", "#")):
        semicolon = source.text[end:stop].lstrip().startswith(";")
        return Span(source, end, end), f"{';' if semicolon else ''} {text}" + ("" if semicolon else ";")
    stop = end + len(source.text[end:stop].rstrip())
    return Span(source, stop, stop), f"\n{indent}{text}"
