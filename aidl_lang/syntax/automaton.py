"""Lark's parser at a place in a text, with what recovery asks of it and does to its stacks."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from lark import Tree, UnexpectedToken
from lark.lexer import Token as LarkToken
from lark.parsers.lalr_analysis import Reduce, Shift
from lark.parsers.lalr_parser_state import ParserState

from aidl_lang.syntax.tables import PlacedTree, load_tables
from aidl_lang.syntax.tokens import END, Token


class Checkpoint(NamedTuple):
    """The stacks as they were before the statement that begins with the token number `position`."""

    position: int
    states: list[int]
    values: list[Any]
    sizes: list[int]  # of the values: Lark lets lists of statements grow in place


class Automaton:
    """Lark's interactive parser, and what it has read: its states, with the trees and tokens between them."""

    def __init__(self) -> None:
        self.tables = load_tables()
        self.parser = self.tables.lark.parse_interactive()
        self.states = self.parser.parser_state.state_stack
        self.values = self.parser.parser_state.value_stack
        self.end = 0  # offset behind the last token taken
        self.tree: Tree[Token] | None = None  # of the whole text, when its end was taken

    def feed(self, token: Token) -> bool:
        """Takes one token. Returns False if it cannot stand here; the statement before it may be complete by
        then.
        """
        if token.kind in self.tables.soft_words:
            token.type = self._type(self.states, token.kind)
        try:
            self.tree = self.parser.feed_token(token)
        except UnexpectedToken:
            return False
        self.end = token.end
        return True

    @property
    def between_statements(self) -> bool:
        """True if a statement may begin here: none is under way."""
        return self.states[-1] in self.tables.statement_states

    @property
    def began_statement(self) -> bool:
        """True if the token just taken was the first of a statement."""
        return len(self.states) > 1 and self.states[-2] in self.tables.statement_states

    @property
    def begin(self) -> int | None:
        """The offset at which the statement under way begins; None between statements."""
        level = len(self.states) - 1
        while self.states[level] not in self.tables.statement_states:
            level -= 1
        if level == len(self.states) - 1:
            return None
        start: int = self.values[level].start
        return start

    @property
    def in_constraints(self) -> bool:
        """True if the innermost block is one of constraints: commas stand among these alone."""
        inner = next(s for s in reversed(self.states) if s in self.tables.statement_states)
        return self.tables.states[inner].get(self.tables.types[","], (None,))[0] is Shift

    def checkpoint(self, position: int) -> Checkpoint:
        """Returns the stacks before the statement under way. Only when `began_statement`."""
        values = self.values[:-1]
        sizes = [len(value.children) if isinstance(value, Tree) else 0 for value in values]
        return Checkpoint(position, self.states[:-1], values, sizes)

    def restore(self, checkpoint: Checkpoint) -> None:
        self.states[:] = checkpoint.states
        self.values[:] = checkpoint.values
        for value, size in zip(self.values, checkpoint.sizes, strict=True):
            if isinstance(value, Tree):
                del value.children[size:]

    def enter_block(self) -> None:
        """Begins the list of statements of a block in which there are none yet."""
        row = self.tables.states[self.states[-1]]
        action, rule = row.get(self.tables.types[";"], (Shift, None))
        if action is Reduce and not rule.expansion:
            _, reached = row[rule.origin.name]
            if reached in self.tables.statement_states:
                self.states.append(reached)
                self.values.append(PlacedTree(rule.origin.name, []))

    def drop_statement(self) -> None:
        """Forgets the statement under way, keeping all that stands before it in its block."""
        self.enter_block()
        while not self.between_statements:
            del self.states[-1], self.values[-1]
            self.enter_block()

    def open_brackets(self) -> list[Token]:
        """Returns the `(`, `[`, `{` and calls that are not closed yet, outermost first."""
        opened: list[Token] = []
        for value in self.values:
            if isinstance(value, Token):
                if value.kind in ("(", "[", "{", "CALL"):
                    opened.append(value)
                elif value.kind in (")", "]", "}"):
                    opened.pop()
        return opened

    def open_blocks(self) -> int:
        """Returns the number of `{` that are not closed yet."""
        return sum(1 for token in self.open_brackets() if token.kind == "{")

    def accepts(self, kinds: Iterable[str], from_statement: bool = False) -> bool:
        """Tells whether tokens of these kinds could come next, or in the place of the whole statement under
        way.
        """
        states = list(self.states)
        while from_statement and states[-1] not in self.tables.statement_states:
            states.pop()
        return all(self._takes(states, self._type(states, kind)) for kind in kinds)

    def _type(self, states: list[int], kind: str) -> str:
        """Returns Lark's name for a token in a state: a soft word is a name where it cannot stand itself."""
        type_ = self.tables.types.get(kind, kind)
        return "NAME" if kind in self.tables.soft_words and not self._takes(list(states), type_) else type_

    def _takes(self, states: list[int], type_: str) -> bool:
        """Moves a stack of states over a token. Returns False if it cannot stand there."""
        trial = ParserState(self.tables.without_tree, self.parser.lexer_thread, states, [None] * len(states))
        try:
            trial.feed_token(LarkToken(type_, ""), type_ == END)
        except UnexpectedToken:
            return False
        return True
