"""Reads expressions as text, `hypot(b.x - a.x, b.y - a.y) == 10`, onto a tape; `writing` writes them.

    row      sum ("==" | "<=" | ">=") sum
    sum      product (("+" | "-") product)*
    product  signed (("*" | "/" | "%") signed)*
    signed   "-" signed | power
    power    atom ("^" signed)?
    atom     number | "pi" | name | function "(" sum ("," sum)* ")" | "(" sum ")"

Operands come onto the tape in the order of writing.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple, NoReturn

from aidl_lang.solver.expression import TapeBuilder
from aidl_lang.solver.operations import ARITY, NAMES, Op
from aidl_lang.solver.problem import Relation

SUMS = {"+": Op.ADD, "-": Op.SUB}
PRODUCTS = {"*": Op.MUL, "/": Op.DIV, "%": Op.MOD}
FUNCTIONS = {
    "sin": Op.SIN,
    "cos": Op.COS,
    "tan": Op.TAN,
    "asin": Op.ASIN,
    "acos": Op.ACOS,
    "atan2": Op.ATAN2,
    "sqrt": Op.SQRT,
    "square": Op.SQUARE,
    "hypot": Op.HYPOT,
    "abs": Op.ABS,
    "min": Op.MINIMUM,
    "max": Op.MAXIMUM,
    "select": Op.SELECT,
    "cubic_max": Op.CUBIC_MAX,
}
VARIADIC = frozenset({Op.MINIMUM, Op.MAXIMUM})
RESERVED = frozenset({*FUNCTIONS, "pi"})
NAME = re.compile(r"[^\W\d]\w*(?:\.[^\W\d]\w*|\[-?[0-9]+\])*")
"""`x`, `door.left.start.x`, `finger[3].x`."""
LARGEST = 1e150
"""The greatest number that may be written: its square is still a finite number."""
LONGEST_TEXT = 20_000
DEEPEST = 50
"""The most levels of parentheses, signs, powers and calls."""

_NUMBER = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_TOKEN = re.compile(
    rf"\s*(?:(?P<number>{_NUMBER})|(?P<name>{NAME.pattern})|(?P<sign>[=<>]=|[-+*/%^(),])|(?P<end>\Z))"
)


class FormError(ValueError):
    """A mistake in a problem file; the message says where it is and what it is."""


@contextmanager
def within(place: str) -> Iterator[None]:
    """Puts `place` before the message of a mistake found inside."""
    try:
        yield
    except FormError as mistake:
        raise FormError(f"{place}: {mistake}") from None


def quoted(text: str) -> str:
    """Returns a text for a message: in quotes, escaped, and not too long."""
    return repr(text if len(text) <= 60 else text[:57] + "...")


class Notation:
    """Reads expressions onto `tape`. `unknowns` and `lets` give the meaning of names: an unknown, or a
    node.
    """

    def __init__(self, tape: TapeBuilder) -> None:
        self.tape = tape
        self.unknowns: dict[str, int] = {}
        self.lets: dict[str, int] = {}

    def value(self, text: str) -> int:
        """Returns the node of an expression without a relation."""
        reader = _Reader(self, text)
        node = reader.sum()
        reader.finish()
        return node

    def row(self, text: str) -> tuple[int, Relation]:
        """Returns the node that is compared with 0, and the relation."""
        reader = _Reader(self, text)
        left = reader.sum()
        relation = reader.take("==", "<=", ">=")
        if relation is None:
            reader.fail("an operator, '==', '<=' or '>='")
        right = None if reader.is_last("0") else reader.sum()
        reader.finish()
        if relation == ">=":
            node = self.tape.neg(left) if right is None else self.tape.sub(right, left)
        else:
            node = left if right is None else self.tape.sub(left, right)
        return node, Relation.EQUAL if relation == "==" else Relation.AT_MOST


class _Reader:
    """Recursive descent over one text; every turn of the recursion goes through `_signed`."""

    def __init__(self, notation: Notation, text: str) -> None:
        if len(text) > LONGEST_TEXT:
            raise FormError(f"an expression of {len(text)} characters; {LONGEST_TEXT} are allowed")
        self._notation, self._tape = notation, notation.tape
        self._tokens = list(_tokens(text))
        self._next = self._depth = 0

    # -- tokens

    def take(self, *signs: str) -> str | None:
        """Returns and consumes the next token if it is one of these; else returns None."""
        token = self._tokens[self._next].text
        if token not in signs:
            return None
        self._next += 1
        return token

    def is_last(self, text: str) -> bool:
        """Tells whether `text` is the only token left; consumes it then."""
        return self._next == len(self._tokens) - 2 and self.take(text) is not None

    def finish(self) -> None:
        if self._tokens[self._next].text:
            self.fail("an operator or the end")

    def fail(self, needed: str) -> NoReturn:
        token = self._tokens[self._next]
        found = quoted(token.text) if token.text else "the end"
        raise FormError(f"column {token.column}: {needed} is needed, not {found}")

    # -- the grammar

    def sum(self) -> int:
        return self._left_to_right(SUMS, lambda: self._left_to_right(PRODUCTS, self._signed))

    def _left_to_right(self, operators: dict[str, int], operand: Callable[[], int]) -> int:
        node = operand()
        while (sign := self.take(*operators)) is not None:
            node = self._make(operators[sign], node, operand())
        return node

    def _signed(self) -> int:
        self._depth += 1
        if self._depth > DEEPEST:
            raise FormError(f"column {self._tokens[self._next].column}: nested deeper than {DEEPEST} levels")
        if not self.take("-"):
            node = self._power()
        elif self._tokens[self._next].kind == "number" and self._tokens[self._next + 1].text != "^":
            node = self._tape.constant(-self._number())
        else:
            node = self._tape.neg(self._signed())
        self._depth -= 1
        return node

    def _power(self) -> int:
        base = self._atom()
        return self._make(Op.POWER, base, self._signed()) if self.take("^") else base

    def _atom(self) -> int:
        kind = self._tokens[self._next].kind
        if kind == "number":
            return self._tape.constant(self._number())
        if kind == "name":
            return self._call() if self._tokens[self._next + 1].text == "(" else self._named()
        if not self.take("("):
            self.fail("a number, a name or '('")
        return self._enclosed()[0]

    def _number(self) -> float:
        token = self._tokens[self._next]
        value = float(token.text)
        if value > LARGEST:
            raise FormError(f"column {token.column}: {quoted(token.text)} is greater than {LARGEST:g}")
        self._next += 1
        return value

    def _named(self) -> int:
        _, name, column = self._tokens[self._next]
        self._next += 1
        if name == "pi":
            return self._tape.constant(math.pi)
        if name in self._notation.unknowns:
            return self._tape.unknown(self._notation.unknowns[name])
        if name not in self._notation.lets:
            raise FormError(f"column {column}: no unknown and no let is called {quoted(name)}")
        return self._notation.lets[name]

    def _call(self) -> int:
        _, name, column = self._tokens[self._next]
        op = FUNCTIONS.get(name)
        if op is None:
            raise FormError(f"column {column}: no function is called {quoted(name)}")
        self._next += 2
        operands = self._enclosed(",")
        if op not in VARIADIC and len(operands) != ARITY[op]:
            raise FormError(f"column {column}: {name} takes {ARITY[op]} operands, not {len(operands)}")
        return self._make(op, *operands)

    def _enclosed(self, *separator: str) -> list[int]:
        """Returns the operands before the closing parenthesis."""
        operands = [self.sum()]
        while self.take(*separator):
            operands.append(self.sum())
        if not self.take(")"):
            self.fail(" or ".join(["an operator", *map(repr, separator), "')'"]))
        return operands

    def _make(self, op: int, *operands: int) -> int:
        node: int = getattr(self._tape, NAMES[op])(*operands)
        return node


class _Token(NamedTuple):
    kind: str
    text: str
    column: int


def _tokens(text: str) -> Iterator[_Token]:
    """Yields the tokens of `text`, with an empty one at the end."""
    at = 0
    while found := _TOKEN.match(text, at):
        kind = found.lastgroup or ""
        yield _Token(kind, found[kind], found.start(kind) + 1)
        if kind == "end":
            return
        at = found.end()
    at += len(text[at:]) - len(text[at:].lstrip())
    raise FormError(f"column {at + 1}: {quoted(text[at])} has no meaning here")
