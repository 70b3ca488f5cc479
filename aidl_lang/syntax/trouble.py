"""The place where the parser cannot go on, with questions about it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax.automaton import Automaton
from aidl_lang.syntax.tokens import END, Token
from aidl_lang.syntax.words import STATEMENT_WORDS


@record()
class TokenRepair:
    """Tokens that replace those at `start:stop`, to read on with."""

    start: int
    stop: int
    tokens: tuple[Token, ...] = ()


@record()
class SyntaxProblem:
    """A diagnostic and its repair. `with_block`: if there is no repair, the block of the statement is left
    out as well.
    """

    diagnostic: Diagnostic
    repair: TokenRepair | None = None
    with_block: bool = False


@record()
class Trouble:
    """The token number `position`, which cannot stand in the automaton's state; `begin` is the first of its
    statement.
    """

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

    def token_here(self, kind: str, text: str = "") -> Token:
        end = self.gap().end
        return Token(kind, text or kind, end, end)

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


def replaced(title: str, span: Span, text: str, *, is_sure: bool = True) -> Fix:
    """Returns the fix that replaces a text; `is_sure` if nothing else can have been meant."""
    return Fix(title, (Edit(span, text),), is_sure)


LONGEST = 500
"""Characters and tokens beyond which nobody wrote a head or a line by hand."""


def line_end(text: str, offset: int) -> int:
    """Returns the offset at which the line around an offset ends."""
    end = text.find("\n", offset)
    return len(text) if end < 0 else end


def statement_end(source: SourceFile, tokens: Sequence[Token], begin: int) -> int:
    """Returns the number of the token behind the statement at `begin`, which ends with its line at the
    latest.
    """
    stop = min(begin, len(tokens) - 1)
    end = line_end(source.text, tokens[stop].start)
    last = min(begin + LONGEST, len(tokens) - 1)
    while stop < last and tokens[stop].kind not in (END, ";", "}") and tokens[stop].start < end:
        stop += 1
    return stop


def closing(tokens: Sequence[Token], opening: int) -> int:
    """Returns the number of the bracket that closes one; -1 if it is missing, or beyond LONGEST tokens."""
    depth = 0
    for n in range(opening, min(len(tokens), opening + LONGEST)):
        depth += (tokens[n].kind in ("CALL", "(", "[", "{")) - (tokens[n].kind in (")", "]", "}"))
        if depth == 0:
            return n
    return -1
