"""The LALR(1) automaton that the grammar describes, with nodes built as rules are recognised."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from typing import Any, NamedTuple

from aidl_lang.syntax.tables import Tables
from aidl_lang.syntax.tokens import END, Token
from aidl_lang.syntax.tree import Builder, action


class Checkpoint(NamedTuple):
    """The stacks as they were before the statement that begins with the token number `position`."""

    position: int
    states: list[int]
    values: list[Any]
    starts: list[int]
    statements: int  # read in the block so far


@cache
def _reductions(tables: Tables) -> list[tuple[int, int | None, tuple[int, ...], Callable[..., Any] | None]]:
    """Returns for each rule its size, what it passes on, what it keeps, and the method that makes its
    node.
    """
    return [
        (rule.size, rule.passes, rule.kept, action(rule.action) if rule.action else None)
        for rule in tables.rules
    ]


class Automaton:
    """The states, values and places of the tokens read so far, as three stacks of one length."""

    def __init__(self, tables: Tables, builder: Builder) -> None:
        self.tables = tables
        self.states: list[int] = [tables.start]
        self.values: list[Any] = [None]
        self.starts: list[int] = [0]
        self.end = 0  # offset behind the last token taken
        self.builder = builder
        self.reductions = _reductions(tables)

    def feed(self, token: Token) -> bool:
        """Takes one token. Returns False if it cannot stand here; the statement before it may be complete by
        then.
        """
        states, values, starts = self.states, self.values, self.starts
        actions, steps = self.tables.actions, self.tables.steps
        kind = token.kind
        if kind in self.tables.soft_words and not self._advance(list(states), kind):
            kind = "NAME"
        while (target := actions[states[-1]].get(kind)) is not None and target < 0:
            size, passes, kept, method = self.reductions[~target]
            start = starts[-size] if size else token.start
            if method is not None:
                symbols: list[Any] = []
                for i in kept:
                    part = values[i - size]
                    if type(part) is list:
                        symbols += part
                    else:
                        symbols.append(part)
                value = method(self.builder, start, self.end, *symbols)
            elif passes is not None:
                value = values[passes - size]
            else:
                value = self._gather(kept, size)
            if size:
                del states[-size:], values[-size:], starts[-size:]
            step = (states[-1], target, kind)
            if (reached := steps.get(step)) is None:
                reached = steps[step] = self._reduced(*step)
            states.append(reached)
            values.append(value)
            starts.append(start)
        if target is None:
            return kind == END and states[-1] == self.tables.end
        states.append(target)
        values.append(token)
        starts.append(token.start)
        self.end = token.end
        return True

    def _gather(self, kept: tuple[int, ...], size: int) -> list[Any]:
        """Returns the values of the kept symbols in one list, reusing that of the first if it is one."""
        gathered: list[Any] | None = None
        for i in kept:
            part = self.values[i - size]
            if gathered is None:
                gathered = part if type(part) is list else [part]
            elif type(part) is list:
                gathered += part
            else:
                gathered.append(part)
        return [] if gathered is None else gathered

    def _reduced(self, below: int, reduction: int, kind: str) -> int:
        """Returns the state after a reduction and all those behind it that only pass on one value: chains of
        these (a name is a product is a sum is …) are most of the work, so they are one step.
        """
        rules, actions = self.tables.rules, self.tables.actions
        state = actions[below][rules[~reduction].origin]
        while (target := actions[state].get(kind)) is not None and target < 0:
            rule = rules[~target]
            if rule.size != 1 or rule.passes != 0:
                break
            state = actions[below][rule.origin]
        return state

    # --- For recovery ---

    @property
    def between_statements(self) -> bool:
        """True if a statement may begin here: none is under way."""
        return self.states[-1] in self.tables.statement_states

    @property
    def began_statement(self) -> bool:
        """True if the token just taken was the first of a statement."""
        return len(self.states) > 1 and self.states[-2] in self.tables.statement_states

    def checkpoint(self, position: int) -> Checkpoint:
        """Returns the stacks before the statement under way. Only when `began_statement`."""
        return Checkpoint(
            position, self.states[:-1], self.values[:-1], self.starts[:-1], len(self.values[-2])
        )

    def restore(self, checkpoint: Checkpoint) -> None:
        self.states[:] = checkpoint.states
        self.values[:] = checkpoint.values
        self.starts[:] = checkpoint.starts
        if isinstance(self.values[-1], list):
            del self.values[-1][checkpoint.statements :]

    def enter_block(self) -> None:
        """Begins the list of statements of a block in which there are none yet."""
        target = self.tables.actions[self.states[-1]].get(";", 0)
        if target < 0 and not (rule := self.tables.rules[~target]).size:
            reached = self.tables.actions[self.states[-1]][rule.origin]
            if reached in self.tables.statement_states:
                self.states.append(reached)
                self.values.append([])
                self.starts.append(self.end)

    def drop_statement(self) -> None:
        """Forgets the statement under way, keeping all that stands before it in its block."""
        self.enter_block()
        while not self.between_statements:
            del self.states[-1], self.values[-1], self.starts[-1]
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
        for kind in kinds:
            if kind in self.tables.soft_words and not self._advance(list(states), kind):
                kind = "NAME"
            if not self._advance(states, kind):
                return kind == END and states[-1] == self.tables.end
        return True

    def _advance(self, states: list[int], kind: str) -> bool:
        """Moves a stack of states over a token. Returns False if it cannot stand there."""
        actions, rules = self.tables.actions, self.tables.rules
        while (target := actions[states[-1]].get(kind)) is not None and target < 0:
            rule = rules[~target]
            if rule.size:
                del states[-rule.size :]
            states.append(actions[states[-1]][rule.origin])
        if target is None:
            return False
        states.append(target)
        return True
