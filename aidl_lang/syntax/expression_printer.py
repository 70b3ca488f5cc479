"""Expressions in canonical form: parentheses only if needed, line breaks if they help.

An expression becomes a `PrintDocument`: text with groups, the bracketed lists that may be broken over lines.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from aidl_lang.common.records import record
from aidl_lang.syntax import ast

WIDTH = 100
INDENT = 4

# How tightly an expression binds; an operand that binds less than its place asks for is put in parentheses.
CHOICE, OR, AND, NOT, CONDITION, SUM, PRODUCT, SIGN, POWER, ATOM = range(10)

_BINARY = {
    "or": (OR, OR, AND),
    "and": (AND, AND, NOT),
    "+": (SUM, SUM, PRODUCT),
    "-": (SUM, SUM, PRODUCT),
    "*": (PRODUCT, PRODUCT, SIGN),
    "/": (PRODUCT, PRODUCT, SIGN),
    "%": (PRODUCT, PRODUCT, SIGN),
    "^": (POWER, ATOM, SIGN),
}  # operator: its own level, that of the left operand, that of the right


@record()
class BracketGroup:
    """`opening item, item closing`: on one line, all items on one line of their own, or each on its own. A
    block has spaces inside its braces; it is broken with what it belongs to, and stands on a line of its own
    in what is broken around it.
    """

    opening: str
    items: tuple[PrintDocument, ...]
    closing: str
    is_block: bool = False

    @property
    def edge(self) -> str:
        """What stands inside of both brackets on one line."""
        return " " if self.is_block and self.items else ""


@record()
class PrintDocument:
    """Pieces of text and groups, in order; `width` is that of the whole on one line."""

    pieces: tuple[str | BracketGroup, ...]
    width: int

    def flat(self) -> str:
        return "".join(piece if isinstance(piece, str) else _flat_group(piece) for piece in self.pieces)


def doc(*parts: str | BracketGroup | PrintDocument) -> PrintDocument:
    """Joins parts to one document."""
    pieces: list[str | BracketGroup] = []
    width = 0
    for part in parts:
        if isinstance(part, PrintDocument):
            pieces += part.pieces
            width += part.width
        else:
            pieces.append(part)
            width += len(part) if isinstance(part, str) else _group_width(part)
    return PrintDocument(tuple(pieces), width)


def _flat_group(group: BracketGroup) -> str:
    inside = ", ".join(item.flat() for item in group.items)
    return group.opening + group.edge + inside + group.edge + group.closing


def _group_width(group: BracketGroup) -> int:
    items = sum(item.width for item in group.items) + 2 * max(0, len(group.items) - 1)
    return len(group.opening) + items + 2 * len(group.edge) + len(group.closing)


def _has_block(document: PrintDocument) -> bool:
    return any(isinstance(piece, BracketGroup) and piece.is_block for piece in document.pieces)


def render(document: PrintDocument, indent: int, column: int | None = None, after: int = 0) -> str:
    """Lays a document out, beginning at `column`, with `after` more characters to follow on its last line."""
    column = indent if column is None else column
    if column + document.width + after <= WIDTH:
        return document.flat()
    out: list[str] = []
    for i, piece in enumerate(document.pieces):
        if isinstance(piece, str):
            out.append(piece)
            column += len(piece)
            continue
        # The text up to the next group, and its bracket, must follow on the same line.
        tail = 0
        for later in document.pieces[i + 1 :]:
            tail += len(later) if isinstance(later, str) else len(later.opening)
            if not isinstance(later, str):
                break
        else:
            tail += after
        fits = column + _group_width(piece) + tail <= WIDTH and not piece.is_block
        if not piece.items or fits:
            out.append(_flat_group(piece))
            column += _group_width(piece)
            continue
        inner = indent + INDENT
        together = ", ".join(item.flat() for item in piece.items)
        is_short = inner + len(together) <= WIDTH and not any(map(_has_block, piece.items))
        lines = [together] if is_short else [render(item, inner, after=1) for item in piece.items]
        pad = "\n" + " " * inner
        out.append(piece.opening + pad + ("," + pad).join(lines) + "\n" + " " * indent + piece.closing)
        column = indent + len(piece.closing)
    return "".join(out)


class ExpressionPrinter:
    """A printer of expressions. `names` gives other spellings for names, members and callees."""

    def __init__(self, names: Mapping[ast.Node, str] | None = None) -> None:
        self.names = names or {}

    def name(self, node: ast.Identifier | ast.Name) -> str:
        return self.names.get(node, node.text)

    def expression(self, node: ast.Expression, level: int = CHOICE) -> PrintDocument:
        """Returns a node in a place that asks for at least `level`: in parentheses if it binds less."""
        own, document = self._print(node)
        return document if own >= level else doc("(", document, ")")

    def iterable(self, node: ast.Expression) -> PrintDocument:
        """Returns the expression behind `in`: a range without parentheses, or a sum."""
        return self.expression(node, CONDITION if isinstance(node, ast.Range) else SUM)

    def loop(self, node: ast.For | ast.ForArguments | ast.Comprehension) -> PrintDocument:
        variables = ", ".join(map(self.name, node.variables))
        return doc(f"for {variables} in ", self.iterable(node.iterable))

    def _generator_clause(self, node: ast.Comprehension) -> PrintDocument:
        test = doc(" if ", self.expression(node.condition, OR)) if node.condition else doc()
        return doc(" ", self.loop(node), test)

    def arguments(self, opening: str, arguments: Sequence[ast.Argument]) -> PrintDocument:
        items = tuple(
            doc(f"{self.name(a.name)}: ", self.expression(a.value)) if a.name else self.expression(a.value)
            for a in arguments
        )
        return doc(BracketGroup(opening, items, ")"))

    def _argument_block(self, opening: str, block: ast.ArgumentBlock) -> BracketGroup:
        items = tuple(
            doc(f"let {self.name(item.name)} = ", self.expression(item.value))
            if isinstance(item, ast.Let)
            else self.expression(item)
            for item in block.items
        )
        return BracketGroup(opening + "{", items, "}", is_block=True)

    def _else_arguments(self, block: ast.ArgumentBlock | None) -> PrintDocument:
        if block is None:
            return doc()
        chained = block.items[0] if len(block.items) == 1 else None
        if isinstance(chained, ast.IfArguments) and chained.span == block.span:
            return doc(" else ", self.expression(chained))
        return doc(self._argument_block(" else ", block))

    def _print(self, node: ast.Expression) -> tuple[int, PrintDocument]:  # noqa: C901 (one case a node)
        match node:
            case ast.Number():
                return ATOM, doc(node.text + (node.unit or ""))
            case ast.Name():
                return ATOM, doc(self.name(node))
            case ast.String():
                return ATOM, doc(string_text(node.value))
            case ast.Boolean():
                return ATOM, doc("true" if node.value else "false")
            case ast.Member():
                return ATOM, doc(self._owner(node.value), f".{self.name(node.name)}")
            case ast.Index():
                return ATOM, doc(self._owner(node.value), "[", self.expression(node.index), "]")
            case ast.Call():
                owner = doc(self._owner(node.receiver), ".") if node.receiver else doc()
                return ATOM, doc(owner, self.arguments(self.name(node.callee) + "(", node.arguments))
            case ast.Point():
                return ATOM, doc("(", self.expression(node.x), ", ", self.expression(node.y), ")")
            case ast.List():
                return ATOM, doc(BracketGroup("[", tuple(map(self.expression, node.items)), "]"))
            case ast.Comprehension():
                inner, loops = node.innermost, [self._generator_clause(node)]
                while node is not inner:
                    assert isinstance(node.element, ast.Comprehension)
                    node = node.element
                    loops.append(self._generator_clause(node))
                return ATOM, doc("[", self.expression(inner.element), *loops, "]")
            case ast.ForArguments():
                return CHOICE, doc(self.loop(node), self._argument_block(" ", node.body))
            case ast.IfArguments():
                head = doc("if ", self.expression(node.test, OR))
                block = self._argument_block(" ", node.then)
                return CHOICE, doc(head, block, self._else_arguments(node.otherwise))
            case ast.Unary(operator="not"):
                return NOT, doc("not ", self.expression(node.operand, NOT))
            case ast.Unary():
                return SIGN, doc(node.operator, self.expression(node.operand, SIGN))
            case ast.Binary():
                own, left, right = _BINARY[node.operator]
                operands = self.expression(node.left, left), self.expression(node.right, right)
                return own, doc(operands[0], f" {node.operator} ", operands[1])
            case ast.Comparison():
                parts = [self.expression(node.operands[0], SUM)]
                for operator, operand in zip(node.operators, node.operands[1:], strict=True):
                    parts.append(doc(f" {operator} ", self.expression(operand, SUM)))
                return CONDITION, doc(*parts)
            case ast.Membership():
                return CONDITION, doc(self.expression(node.value, SUM), " in ", self.iterable(node.container))
            case ast.Range():
                start, end = self.expression(node.start, SUM), self.expression(node.end, SUM)
                dots = "..<" if node.exclusive else ".."
                step = doc(" step ", self.expression(node.step, SUM)) if node.step else doc()
                return CONDITION, doc(start, dots + (" " if end.flat().startswith(".") else ""), end, step)
            case ast.Conditional():
                then, otherwise = self.expression(node.then), self.expression(node.otherwise)
                return CHOICE, doc("if ", self.expression(node.test, OR), " then ", then, " else ", otherwise)

    def _owner(self, node: ast.Expression) -> PrintDocument:
        """Returns the expression before `.` or `[`; a number in parentheses, as it would take the point."""
        document = self.expression(node, ATOM)
        return doc("(", document, ")") if isinstance(node, ast.Number) else document


_ESCAPES = str.maketrans({"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r", "\0": "\\0"})


def string_text(value: str) -> str:
    """Returns a text with its quotes."""
    return '"' + value.translate(_ESCAPES) + '"'


_BEGINS = re.compile(r"[(.]|(?!(?:if|not|true|false)\b)\w")
"""What an operand begins with that may begin a statement."""


def begins_statement(node: ast.Expression) -> bool:
    """Tells whether an expression, as printed, may stand as a statement of its own."""
    if isinstance(node, ast.Binary) and node.operator in ("and", "or"):
        is_in_parentheses = ExpressionPrinter()._print(node.left)[0] < _BINARY[node.operator][1]
        return is_in_parentheses or begins_statement(node.left)
    is_statement = isinstance(node, ast.Comparison | ast.Membership | ast.Call)
    return is_statement and _BEGINS.match(format_expression(node)) is not None


def format_expression(node: ast.Expression, names: Mapping[ast.Node, str] | None = None) -> str:
    """Returns the canonical text of an expression, on one line."""
    return ExpressionPrinter(names).expression(node).flat()
