"""The canonical form of a program, `aidl fmt`: parentheses only if needed, line breaks if they help.

An expression becomes a `PrintDocument`: text with groups, the bracketed lists that may be broken over lines.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from aidl_lang.common.records import record
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.parser import Parsed

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


# --- Whole programs.
#
# Formatting twice gives what formatting once gave; all comments stay, and at most one blank line between
# statements. Attributes stay on the line they were written on while it has room for them. Synonyms of the
# syntax become one spelling; numbers stay as they were written.

_GAP = re.compile(r"(?:\s|//[^\n]*|#[^\n]*|/\*.*?\*/)*", re.DOTALL)
"""White space and comments."""


@record(frozen=False)
class Line:
    """A line of output; `comment` follows it, aligned with those of the lines around it."""

    text: str
    comment: str = ""


def format_module(
    parsed: Parsed | ast.Module,
    names: Mapping[ast.Node, str] | None = None,
    stated: Collection[ast.Node] = (),
    declaring: Collection[ast.Node] = (),
) -> str:
    """Returns the text of a program in canonical form.

    stated     calls known to state a constraint, which get the keyword if they stand alone
    declaring  equations that mean nothing as such and stay as they are
    names      the spelling to print for nodes (names, identifiers of members and callees)

    Parts that could not be parsed are not in the tree: do not write the text back over a program with syntax
    errors.
    """
    module = parsed if isinstance(parsed, ast.Module) else parsed.module
    printer = _Printer(module, names, stated, declaring)
    printer.statements(module.statements, 0, len(module.source.text), 0, constraints=False)
    return printer.text()


def format_statement(statement: ast.Statement) -> str:
    """Returns the text of one statement, without comments."""
    module = ast.Module(statement.span.source, (statement,), (), span=statement.span)
    return format_module(module).rstrip("\n")


class _Printer(ExpressionPrinter):
    def __init__(
        self,
        module: ast.Module,
        names: Mapping[ast.Node, str] | None,
        stated: Collection[ast.Node],
        declaring: Collection[ast.Node],
    ) -> None:
        super().__init__(names)
        self.source, self.comments = module.source.text, module.comments
        self.next_comment = 0
        self.lines: list[Line] = []
        self.stated, self.declaring = stated, declaring

    # --- Lines, and the comments among them ---

    def text(self) -> str:
        """Returns all lines, the trailing comments of neighbouring lines in one column."""
        out: list[str] = []
        run: list[Line] = []
        for line in [*self.lines, Line("")]:
            if line.comment:
                run.append(line)
                continue
            column = max((len(one.text) for one in run if len(one.text) <= WIDTH), default=0)
            out += [f"{one.text.ljust(column)}  {one.comment}" for one in run]
            run = []
            out.append(line.text)
        out.pop()
        return "".join(line.rstrip() + "\n" for line in out)

    def _comments_before(self, offset: int, place: int, indent: int, first: bool) -> tuple[int, bool]:
        while (comment := self._peek(offset)) is not None:
            self._blank_line(place, comment.span.start, first)
            first = False
            self.lines.append(Line(" " * indent + comment.text.rstrip()))
            self.next_comment += 1
            place = comment.span.end
        return place, first

    def _peek(self, before: int) -> ast.Comment | None:
        if self.next_comment < len(self.comments) and self.comments[self.next_comment].span.start < before:
            return self.comments[self.next_comment]
        return None

    def _blank_line(self, place: int, start: int, first: bool) -> None:
        if not first and self.source.count("\n", place, start) > 1:
            self.lines.append(Line(""))

    def _trailing_comment(self, place: int) -> int:
        """Puts a comment that follows on the same line behind the last one. Returns where to go on."""
        comment = self._peek(len(self.source) + 1)
        if comment is None or comment.span.start < place or "\n" in comment.text:
            return place
        between = self.source[place : comment.span.start]
        if between.strip(" \t,;") or self.lines[-1].comment:
            return place
        self.lines[-1].comment = comment.text.rstrip()
        self.next_comment += 1
        return comment.span.end

    # --- Lists of statements ---

    def statements(
        self, statements: Sequence[ast.Statement], start: int, end: int, indent: int, constraints: bool
    ) -> None:
        """Prints the statements and comments of the range `start:end`, each on its own lines."""
        place, first = start, True
        for statement in statements:
            place, first = self._comments_before(statement.span.start, place, indent, first)
            self._blank_line(place, statement.span.start, first)
            first = False
            mark = len(self.lines)
            self._statement(statement, indent, constraints)
            while (inside := self._peek(statement.span.end)) is not None:  # which move in front of it
                self.lines.insert(mark, Line(" " * indent + inside.text.rstrip()))
                self.next_comment, mark = self.next_comment + 1, mark + 1
            place = self._trailing_comment(max(place, statement.span.end))
        self._comments_before(end, place, indent, first)

    # --- One statement ---

    def _statement(self, node: ast.Statement, indent: int, constraints: bool) -> None:
        *above, beside = self._attribute_rows(node)
        for row in above:
            self._attributes(row, indent)
            self._trailing_comment(row[-1].span.end)
        mark = len(self.lines)
        self._without_attributes(node, indent, constraints)
        if beside:
            self._attributes_before(beside, mark, indent)

    def _attribute_rows(self, node: ast.Statement) -> list[list[ast.Attribute]]:
        """Returns the attributes as they were written on lines, last those on the line of their statement."""
        rows: list[list[ast.Attribute]] = [[]]
        for attribute in ast.attributes(node):
            rows[-1].append(attribute)
            gap = _GAP.match(self.source, attribute.span.end)
            if gap and "\n" in gap[0]:
                rows.append([])
        return rows

    def _attributes(self, row: Sequence[ast.Attribute], indent: int) -> None:
        """Prints attributes together if a line has room for them, else each by itself."""
        documents = [self._attribute(attribute) for attribute in row]
        text = " ".join(document.flat() for document in documents)
        if indent + len(text) <= WIDTH:
            self.lines.append(Line(" " * indent + text))
            return
        for document in documents:
            self._leaf(document, indent)

    def _attributes_before(self, row: Sequence[ast.Attribute], mark: int, indent: int) -> None:
        """Puts attributes on the first line of what was printed from `mark` on, above it if that has no room.

        What was printed stays laid out as it is: attributes never break what fits without them.
        """
        text = "".join(self._attribute(attribute).flat() + " " for attribute in row)
        first, statement = self.lines[mark], self.lines[mark:]
        if len(text) + len(first.text) <= WIDTH:
            first.text = " " * indent + text + first.text[indent:]
        else:
            del self.lines[mark:]
            self._attributes(row, indent)
            self.lines += statement

    def _without_attributes(self, node: ast.Statement, indent: int, constraints: bool) -> None:
        if not self._blocks(node):
            document = self._head(node, constraints)
            if isinstance(node, ast.Assert) and node.message and indent + document.width > WIDTH:
                self._long_assert(node, node.message, indent)
            elif isinstance(node, ast.FunctionDefinition) and indent + document.width > WIDTH:
                self._long_function(node, document, indent)
            else:
                self._leaf(document, indent)
            return
        short = self._one_line(node, constraints)
        if short is not None and indent + len(short) <= WIDTH:
            self.lines.append(Line(" " * indent + short))
            return
        self._long(node, indent, constraints)

    def _leaf(self, document: PrintDocument, indent: int) -> None:
        self._add(render(document, indent), indent)

    def _long_assert(self, node: ast.Assert, message: ast.Expression, indent: int) -> None:
        """Prints an assert with its reason on a line of its own, which saves breaking up the test."""
        test = doc("assert ", self.expression(node.test, OR), ",")
        self._leaf(test, indent)
        self._leaf(self.expression(message, OR), indent + INDENT)

    def _long_function(self, node: ast.FunctionDefinition, document: PrintDocument, indent: int) -> None:
        head = doc("fn ", self._parameters(node.name, node.parameters), " =")
        value = self.expression(node.value)
        if indent + head.width <= WIDTH and indent + INDENT + value.width <= WIDTH:
            self._leaf(head, indent)
            self._leaf(value, indent + INDENT)
        else:
            self._leaf(document, indent)

    def _long(self, node: ast.Statement, indent: int, constraints: bool) -> None:
        self._leaf(doc(self._head(node, constraints), " {"), indent)
        block, *others = self._blocks(node)
        inner = constraints or isinstance(node, ast.Constrain | ast.ConstraintDefinition)
        self._block(block, indent, inner)
        while others:
            block = others[0]
            if (chained := _chained(block)) is not None:
                test = self.expression(chained.test, OR)
                self._leaf(doc("} else if ", test, " {"), indent)
                block, *others = self._blocks(chained)
            else:
                self._add("} else {", indent)
                others = []
            self._block(block, indent, inner)
        self._add("}", indent)

    def _add(self, text: str, indent: int) -> None:
        self.lines += [Line(line) for line in (" " * indent + text).split("\n")]

    def _block(self, block: ast.Block, indent: int, constraints: bool) -> None:
        start, end = block.span.start + 1, max(block.span.end - 1, block.span.start + 1)
        # Comments of the head stand before its brace in the text; they move into the block.
        comment = self._peek(end)
        place = start if comment is None or comment.span.start < start else self._trailing_comment(start)
        self.statements(block.statements, place, end, indent + INDENT, constraints)

    def _one_line(self, node: ast.Statement, constraints: bool) -> str | None:
        """Returns the statement on one line, without attributes; None if its blocks were on several."""
        for block in self._blocks(node):
            comment = self._peek(block.span.end)
            if "\n" in block.span.text or (comment is not None and comment.span.end > node.span.start):
                return None
        return self._flat(node, constraints)

    def _flat(self, node: ast.Statement, constraints: bool) -> str:
        head = self._head(node, constraints).flat()
        blocks = self._blocks(node)
        if not blocks:
            return head
        inner = constraints or isinstance(node, ast.Constrain | ast.ConstraintDefinition)
        text = f"{head} {self._flat_block(blocks[0], inner)}"
        if len(blocks) == 2:
            chained = _chained(blocks[1])
            text += f" else {self._flat(chained, inner) if chained else self._flat_block(blocks[1], inner)}"
        return text

    def _flat_block(self, block: ast.Block, constraints: bool) -> str:
        parts = []
        for statement in block.statements:
            attributes = (self._attribute(a).flat() + " " for a in ast.attributes(statement))
            parts.append("".join(attributes) + self._flat(statement, constraints))
        return "{ " + "; ".join(parts) + " }" if parts else "{}"

    def _blocks(self, node: ast.Statement) -> list[ast.Block]:
        match node:
            case ast.Structure() | ast.For() | ast.ShapeDefinition() | ast.ConstraintDefinition():
                return [node.body]
            case ast.If():
                return [node.then] + ([node.otherwise] if node.otherwise else [])
            case ast.Constrain(braces=True):
                return [node.items]
        return []

    # --- The text of a statement up to its block ---

    def _head(self, node: ast.Statement, constraints: bool) -> PrintDocument:  # noqa: C901 (one case a node)
        name, expression = self.name, self.expression
        match node:
            case ast.Structure():
                called = doc(name(node.name), *self._indices(node.indices))
                target = called if node.parameters is None else self._parameters(node.name, node.parameters)
                return doc(f"{node.kind} ", target, *self._placement(node.placement))
            case ast.Assign():
                level = OR if node.placement else 0
                word = "construction " if node.construction else ""
                target = doc(word, name(node.name), *self._indices(node.indices))
                return doc(target, " = ", expression(node.value, level), *self._placement(node.placement))
            case ast.Param():
                level = CONDITION if isinstance(node.value, ast.Comparison) else SUM
                domain = doc(" in ", self.iterable(node.domain)) if node.domain else doc()
                step = doc(" step ", expression(node.step, SUM)) if node.step else doc()
                return doc(f"param {name(node.name)} = ", expression(node.value, level), domain, step)
            case ast.Var():
                return doc(f"var {name(node.name)} = ", expression(node.value))
            case ast.Let():
                return doc(f"let {name(node.name)} = ", expression(node.value))
            case ast.ExpressionStatement():
                is_call = isinstance(node.value, ast.Call) and node.value not in self.stated
                bare = begins_statement(node.value) and (constraints or is_call)
                return doc("" if bare else "constrain ", expression(node.value))
            case ast.Equation():
                return doc("" if begins_statement(node.meant) else "constrain ", self._equation(node))
            case ast.Constrain(braces=True):
                return doc("constrain")
            case ast.Constrain():
                item = node.items.statements[0]
                assert isinstance(item, ast.Equation | ast.ExpressionStatement)
                said = self._equation(item) if isinstance(item, ast.Equation) else expression(item.value)
                return doc("constrain ", said)
            case ast.Prefer():
                weight = doc(" weight ", expression(node.weight, SUM)) if node.weight else doc()
                return doc("prefer ", expression(node.value, OR), weight)
            case ast.Assert():
                message = doc(", ", expression(node.message, OR)) if node.message else doc()
                return doc("assert ", expression(node.test, OR), message)
            case ast.For():
                return self.loop(node)
            case ast.If():
                return doc("if ", expression(node.test, OR))
            case ast.Import():
                return self._import(node)
            case ast.FunctionDefinition():
                return doc("fn ", self._parameters(node.name, node.parameters), " = ", expression(node.value))
            case ast.ShapeDefinition():
                return doc("shape ", self._parameters(node.name, node.parameters))
            case ast.ConstraintDefinition():
                return doc("constraint ", self._parameters(node.name, node.parameters))
            case ast.Alias():
                return doc(f"alias {name(node.name)} = {name(node.target)}")
            case ast.Todo():
                return doc("todo")

    def _parameters(self, name: ast.Identifier, parameters: Sequence[ast.Parameter]) -> PrintDocument:
        items = []
        for p in parameters:
            kind = f": {self.name(p.type)}" if p.type else ""
            default = doc(" = ", self.expression(p.default)) if p.default else doc()
            items.append(doc(self.name(p.name) + kind, default))
        return doc(BracketGroup(self.name(name) + "(", tuple(items), ")"))

    def _indices(self, indices: Sequence[ast.Expression]) -> list[PrintDocument]:
        return [doc("[", self.expression(index), "]") for index in indices]

    def _placement(self, placement: ast.Placement | None) -> list[PrintDocument]:
        if placement is None:
            return []
        at = [doc(" at ", self.expression(placement.at, SUM))] if placement.at else []
        rotated = placement.rotated
        return at + ([doc(" rotated ", self.expression(rotated, SUM))] if rotated else [])

    def _attribute(self, node: ast.Attribute) -> PrintDocument:
        name = "@" + self.name(node.name)
        return self.arguments(name + "(", node.arguments) if node.arguments else doc(name)

    def _equation(self, node: ast.Equation) -> PrintDocument:
        expression = self.expression
        if node in self.declaring:
            return doc(expression(node.left, SUM), " = ", expression(node.right, OR))
        return expression(node.meant)

    def _import(self, node: ast.Import) -> PrintDocument:
        path = string_text(node.path.value)
        if node.names:
            return doc(f"import {', '.join(map(self.name, node.names))} from {path}")
        alias = f" as {self.name(node.alias)}" if node.alias else ""
        return doc(f"import {path}{alias}")


def _chained(block: ast.Block) -> ast.If | None:
    """Returns the `if` that stands behind an `else` without a block of its own."""
    inner = block.statements[0] if len(block.statements) == 1 else None
    return inner if isinstance(inner, ast.If) and inner.span == block.span else None
