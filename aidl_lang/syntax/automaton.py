"""Lark's parser at a place in a text: what recovery asks of it, and questions about where it cannot go on."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from copy import copy
from functools import cached_property, partial
from typing import Any, NamedTuple

from lark import UnexpectedToken
from lark.grammar import Rule
from lark.lexer import Token as LarkToken
from lark.parsers.lalr_analysis import Reduce, Shift
from lark.parsers.lalr_parser_state import ParserState

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import END, STATEMENT_WORDS, Reduced, Token, load_tables, tokenize

# --- Lark's parser at a place in a text, with what recovery asks of it and does to its stacks.

_NO_LEXER: Any = None
"""In place of Lark's lexer: tokens are fed."""


class Checkpoint(NamedTuple):
    """The stacks as they were before the statement that begins with the token number `position`."""

    position: int
    states: list[int]
    values: list[Any]
    sizes: list[int]  # of the values: lists of statements grow in place
    told: int  # of what the builder had to say


class _Making(dict[Any, Any]):
    """What makes the values of rules with a builder; of which most programs have few."""

    def __init__(self, builder: Any) -> None:
        self.builder = builder

    def __missing__(self, rule: Rule) -> Any:
        found = self[rule] = partial(load_tables().makers[rule], self.builder)
        return found

    def __bool__(self) -> bool:
        return True  # to Lark an empty one says that nothing is made


class Automaton:
    """Lark's parser, and what it has read: its states, with the tokens and what was made of them between. A
    builder makes that, whose `diagnostics` are those of what was kept.
    """

    def __init__(self, builder: Any) -> None:
        self.tables, self.builder = load_tables(), builder
        parsing = copy(self.tables.parsing)
        parsing.callbacks = _Making(builder)
        self.parser: ParserState[int] = ParserState(parsing, _NO_LEXER)
        self.states, self.values = self.parser.state_stack, self.parser.value_stack
        self.end = 0  # offset behind the last token taken
        self.made: tuple[ast.Statement, ...] = ()  # of the whole text, when its end was taken

    def feed(self, token: Token) -> bool:
        """Takes one token. Returns False if it cannot stand here; what is before may be complete."""
        if token.kind in self.tables.soft_words:
            token.type = self._type(self.states, token.kind)
        try:
            whole = self.parser.feed_token(token, token.kind == END)
        except UnexpectedToken:
            return False
        self.end = token.end
        if token.kind == END:
            self.made = whole.value
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
        return self.tables.parsing.states[inner].get(self.tables.types[","], (None,))[0] is Shift

    def checkpoint(self, position: int) -> Checkpoint:
        """Returns the stacks before the statement under way. Only when `began_statement`."""
        values = self.values[:-1]
        sizes = [len(value.value) if type(value.value) is list else 0 for value in values]
        return Checkpoint(position, self.states[:-1], values, sizes, len(self.builder.diagnostics))

    def restore(self, checkpoint: Checkpoint) -> None:
        self.states[:] = checkpoint.states
        self.values[:] = checkpoint.values
        for value, size in zip(self.values, checkpoint.sizes, strict=True):
            if type(value.value) is list:
                del value.value[size:]
        del self.builder.diagnostics[checkpoint.told :]

    def enter_block(self) -> None:
        """Begins the list of statements of a block in which there are none yet."""
        row = self.tables.parsing.states[self.states[-1]]
        action, rule = row.get(self.tables.types[";"], (Shift, None))
        if action is Reduce and not rule.expansion:
            _, reached = row[rule.origin.name]
            if reached in self.tables.statement_states:
                self.states.append(reached)
                self.values.append(Reduced([], 0, 0))

    def drop_statement(self) -> None:
        """Forgets the statement under way, keeping all that stands before it in its block."""
        self.enter_block()
        if (begin := self.begin) is not None:
            said = self.builder.diagnostics
            said[:] = [d for d in said if d.span is not None and d.span.start < begin]
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
        """Tells whether tokens of these kinds could come next, or in place of the statement under way."""
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
        trial = ParserState(self.tables.parsing, _NO_LEXER, states, [None] * len(states))
        try:
            trial.feed_token(LarkToken(type_, ""), type_ == END)
        except UnexpectedToken:
            return False
        return True


@record()
class TokenRepair:
    """Tokens that replace those at `start:stop`, to read on with."""

    start: int
    stop: int
    tokens: tuple[Token, ...] = ()


@record()
class SyntaxProblem:
    """A diagnostic and its repair. `with_block`: without one, the statement's block is left out as well."""

    diagnostic: Diagnostic
    repair: TokenRepair | None = None
    with_block: bool = False


@record()
class Trouble:
    """The token number `position`, which cannot stand where it does; `begin` is its statement's first."""

    source: SourceFile
    tokens: list[Token]
    position: int
    begin: int
    automaton: Automaton

    @property
    def token(self) -> Token:
        return self.tokens[self.position]

    @property
    def before(self) -> Token | None:
        return self.tokens[self.position - 1] if self.position else None

    @property
    def following(self) -> Token:
        return self.tokens[min(self.position + 1, len(self.tokens) - 1)]

    @property
    def statement(self) -> list[Token]:
        """The tokens of the statement so far."""
        return self.tokens[self.begin : self.position]

    @property
    def first(self) -> Token:
        return self.tokens[self.begin]

    @cached_property
    def open(self) -> list[Token]:
        """The open brackets of the statement, outermost first; of blocks those among arguments."""
        return [t for t in self.automaton.open_brackets() if t.start >= self.first.start]

    @property
    def between(self) -> bool:
        return self.begin == self.position

    @cached_property
    def complete(self) -> bool:
        """True if the statement could end here."""
        return not self.open and self.accepts(";")

    @property
    def on_new_line(self) -> bool:
        before = self.before
        return before is None or "\n" in self.source.text[before.end : self.token.start]

    @property
    def touches(self) -> bool:
        """True if the token touches the one before it."""
        return self.before is not None and self.before.end == self.token.start

    def accepts(self, *kinds: str) -> bool:
        return self.automaton.accepts(kinds)

    def span(self, token: Token | None = None, to: Token | None = None) -> Span:
        token = token or self.token
        return Span(self.source, token.start, (to or token).end)

    def gap(self) -> Span:
        """Returns the empty place behind the last token taken, where something is missing."""
        end = self.before.end if self.before else 0
        return Span(self.source, end, end)

    def exchanged(self, *kinds: str) -> TokenRepair:
        """Returns the repair that reads signs or words in place of the token; none leaves it out."""
        tokens = tuple(self.token.but(kind, kind) for kind in kinds)
        return TokenRepair(self.position, self.position + 1, tokens)

    def put_in(self, *kinds: str) -> TokenRepair:
        """Returns the repair that reads signs or words before the token."""
        end = self.gap().end
        return TokenRepair(self.position, self.position, tuple(Token(k, k, end, end) for k in kinds))

    def indentation(self, offset: int) -> int:
        return len(line := self.source.line(self.source.position(offset)[0])) - len(line.lstrip())

    def begins_statement(self) -> bool:
        """Tells whether the token, on a line of its own, looks like the start of another statement."""
        if self.token.kind in ("}", END):
            return True
        if not self.on_new_line:
            return self.token.kind in STATEMENT_WORDS - {"if", "for"}
        in_call = self.token.kind in ("for", "if") and self.open and self.open[-1].kind in ("CALL", "{")
        if self.token.kind in STATEMENT_WORDS | {"@"} and not in_call:
            return True
        return self.indentation(self.token.start) <= self.indentation(self.first.start)


def wrong(
    code: str,
    message: str,
    span: Span,
    label: str = "",
    secondary: tuple[Label, ...] = (),
    *,
    right: str | None = None,
    fix: Fix | None = None,
    hints: tuple[str, ...] = (),
    repair: TokenRepair | None = None,
    tokens: Sequence[Token] = (),
    with_block: bool = False,
) -> SyntaxProblem:
    """Returns a problem; with what is `right`, the fix writes that. With the `tokens` of the text, these are
    read as the fix writes them.
    """
    if right is not None:
        fix = replaced(f"write `{right}`", span, right)
    if tokens and fix is not None:
        repair = reread(tokens, fix)
    diagnostic = Diagnostic(code, message, span, label, secondary, hints, fix)
    return SyntaxProblem(diagnostic, repair, with_block)


def replaced(title: str, span: Span, text: str, *, is_sure: bool = True) -> Fix:
    """Returns the fix that replaces a text; `is_sure` if nothing else can have been meant."""
    return Fix(title, (Edit(span, text),), is_sure)


def reread(tokens: Sequence[Token], fix: Fix) -> TokenRepair:
    """Returns the repair that reads what a fix writes: the tokens that it keeps, and new ones in the places
    of those they stand for.
    """
    from difflib import SequenceMatcher  # takes time to load, and most programs need no mending

    found: list[Token] = []
    places: list[int] = []
    for edit in sorted(fix.edits, key=lambda edit: edit.span.start):
        low, high = edit.span.start, edit.span.end
        start = stop = next((n for n, token in enumerate(tokens) if token.end > low), len(tokens) - 1)
        while tokens[stop].start < high and tokens[stop].end > low:
            stop += 1
        found += tokens[places[-1] : start] if places else ()
        old, new = tokens[start:stop], tokenize(SourceFile("", edit.replacement)).tokens[:-1]
        alike = SequenceMatcher(None, [k.text for k in old], [k.text for k in new], autojunk=False)
        for word, i, j, k, m in alike.get_opcodes():
            around = old[i:j] or old[max(i - 1, 0) : max(i, 1)]
            place = (around[0].start, around[-1].end) if around else (low, low)
            found += old[i:j] if word == "equal" else [Token(t.kind, t.text, *place) for t in new[k:m]]
        places += start, stop
    return TokenRepair(places[0], places[-1], tuple(found))


CLOSE_BLOCK = "close the block"
"""The title of the fix for a block that is not closed."""

LONGEST = 500
"""Characters and tokens beyond which nobody wrote a head or a line by hand."""


def line_end(text: str, offset: int) -> int:
    """Returns the offset at which the line around an offset ends."""
    end = text.find("\n", offset)
    return len(text) if end < 0 else end


def statement_end(source: SourceFile, tokens: Sequence[Token], begin: int) -> int:
    """Returns the number of the token behind the statement at `begin`; its line is the latest end."""
    stop = min(begin, len(tokens) - 1)
    end = line_end(source.text, tokens[stop].start)
    last = min(begin + LONGEST, len(tokens) - 1)
    while stop < last and tokens[stop].kind not in (END, ";", "}") and tokens[stop].start < end:
        stop += 1
    return stop


def operand_end(tokens: Sequence[Token], at: int, step: int, limit: int, ends: Collection[str] = ()) -> int:
    """Returns the number of the token at which what stands behind another one (`step` 1) or before it (-1)
    ends: a bracket around it, or one of the `ends`; the `limit` if there is none before that.
    """
    depth, n = 0, at + step
    while n != limit:
        deeper = step * tokens[n].nesting
        if depth == 0 and (deeper < 0 or tokens[n].kind in ends):
            break
        depth += deeper
        n += step
    return n


def closing(tokens: Sequence[Token], opening: int) -> int:
    """Returns the number of the bracket that closes one; -1 if it is missing, or beyond LONGEST tokens."""
    limit = min(len(tokens), opening + LONGEST)
    close = operand_end(tokens, opening, 1, limit)
    return -1 if close == limit else close


def opening(tokens: Sequence[Token], close: int) -> int:
    """Returns the number of the bracket that one closes; its own if that is missing, or too far away."""
    limit = max(close - LONGEST, -1)
    found = operand_end(tokens, close, -1, limit)
    return close if found == limit else found
