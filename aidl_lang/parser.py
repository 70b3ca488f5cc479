"""Text to syntax tree: Lark's LALR parser, which never gives up here.

It is fed the tokens one by one, and Lark's tree becomes nodes at the end. Where a token cannot stand,
`syntax.errors` says what is wrong and how to go on: with tokens put in, left out or exchanged where it is
clear what was meant, else at the next statement. What was complete before stays; so does the inside of a
block whose head is broken.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import replace

from aidl_lang.common.diagnostics import MOST_ERRORS, Diagnostic, ordered, too_many_errors
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast, rewriting
from aidl_lang.syntax.automaton import CLOSE_BLOCK, LONGEST, Automaton, Checkpoint, Trouble
from aidl_lang.syntax.tables import END, STATEMENT_WORDS, Token, Tokens, is_open_comment, tokenize
from aidl_lang.syntax.tree import Builder


@record()
class TextLimits:
    """The limits on a program: its length, the levels of its tree, and how many errors are reported."""

    max_characters: int = 2_000_000
    max_nesting: int = 200
    max_errors: int = MOST_ERRORS


DEFAULT_LIMITS = TextLimits()


_MOST_CLOSED = 5
"""Braces that are put in to read a text."""


@record()
class Parsed:
    """The tree of what could be read, and diagnostics for the rest."""

    module: ast.Module
    diagnostics: list[Diagnostic]


def parse(source: SourceFile, limits: TextLimits = DEFAULT_LIMITS) -> Parsed:
    """Returns the tree of a file. Never raises: what cannot be read is reported (E01xx, E08xx)."""
    parsed, tokens = _read(source, limits)
    joined = rewriting.lines_joined_by_sign(parsed.module, tokens, lambda part: _read(part, limits)[0])
    return Parsed(parsed.module, ordered(parsed.diagnostics + joined))


def standing_before(source: SourceFile, offset: int, limits: TextLimits = DEFAULT_LIMITS) -> Automaton:
    """Returns the automaton after the text before an offset, mended where it is broken."""
    tokens = tokenize(source, 0, offset)
    reader = _Reader(source, Builder(source, tokens.docs), tokens, limits)
    reader.run(to_end=False)
    return reader.automaton


def _read(source: SourceFile, limits: TextLimits, closed: tuple[int, ...] = ()) -> tuple[Parsed, list[Token]]:
    """Returns what `parse` does, without warnings, and the tokens it came from. `closed`: the places of
    braces that are missing. A text where one is found to be missing is read once more with it.
    """
    everything = Span(source, 0, len(source.text))
    if len(source.text) > limits.max_characters:
        return Parsed(ast.Module(source, (), (), span=everything), [_too_long(source, limits)]), []
    tokens = tokenize(source)
    for place in closed:
        before = bisect_left(tokens.tokens, place, key=lambda token: token.start)
        tokens.tokens.insert(before, Token("}", "}", place, place))
    builder = Builder(source, tokens.docs)
    reader = _Reader(source, builder, tokens, limits)
    statements = reader.run()
    diagnostics = builder.diagnostics + reader.diagnostics
    for found in diagnostics if len(closed) < _MOST_CLOSED else ():
        if found.fix is not None and found.fix.title == CLOSE_BLOCK:
            parsed, read = _read(source, limits, (*closed, found.fix.edits[0].span.start))
            return Parsed(parsed.module, ordered([found, *parsed.diagnostics])), read
    if reader.may_be_deep:
        deep = [s for s in statements if depth_of(s) > limits.max_nesting]
        diagnostics += [_too_deep(s.span, limits) for s in deep]
        statements = tuple(s for s in statements if s not in deep)
    module = ast.Module(source, statements, tuple(tokens.comments), span=everything)
    return Parsed(module, ordered(diagnostics)), tokens.tokens


class _Reader:
    """Reads one file: feeds the automaton, and mends or skips at a token that cannot stand."""

    _MOST_REPAIRS = 20  # of one statement; beyond that it is not a statement with slips in it

    def __init__(self, source: SourceFile, builder: Builder, tokens: Tokens, limits: TextLimits) -> None:
        self.source = source
        self.tokens = tokens.tokens
        self.limits = limits
        self.automaton = Automaton(builder)
        self.diagnostics = [rewriting.spaced_call(source, token) for token in tokens.spaced_calls]
        self.diagnostics += rewriting.understood(source, self.tokens)
        self.diagnostics += rewriting.lists_as_statements(source, self.tokens)
        self.automaton.enter_block()
        self.last = Checkpoint(0, self.automaton.states[:], self.automaton.values[:], [0], 0)
        self.repairs = 0
        self.may_be_deep = False
        self.passed_braces: list[int] = []  # for each `{` passed over, how many blocks were open around it

    def run(self, *, to_end: bool = True) -> tuple[ast.Statement, ...]:
        """Returns the statements of the text; none unless it is read `to_end`, as more could follow."""
        automaton, tokens, limits = self.automaton, self.tokens, self.limits
        position = 0
        while True:
            token = tokens[position]
            if token.kind == END and not to_end:
                return ()
            passed = self.passed_braces
            if token.kind == "}" and passed and passed[-1] == automaton.open_blocks():
                passed.pop()
                token = tokens[position] = Token(";", "", token.start, token.end)
            if token.kind == "-" and self._is_item(position):
                self._begin_item(position)
            if not automaton.feed(token):
                if len(self.diagnostics) >= limits.max_errors:
                    here = Span(self.source, token.start, token.end)
                    return self._stop(too_many_errors(here, limits.max_errors))
                position = self._recover(position)
                continue
            if token.kind == END:
                return automaton.made
            if automaton.began_statement:
                self.last = automaton.checkpoint(position)
                self.repairs = 0
            elif (
                position - self.last.position > limits.max_nesting
                or len(automaton.states) > limits.max_nesting // 2
            ):
                self.may_be_deep = True
                if len(automaton.states) > 4 * limits.max_nesting:
                    return self._stop(_too_deep(Span(self.source, token.start, token.end), limits))
            position += 1

    def _is_item(self, position: int) -> bool:
        """Tells whether a `-` begins a constraint below one that is whole."""
        if not rewriting.begins_with_sign(self.source.text, self.tokens, position):
            return False
        return self.automaton.accepts((",", "-"))  # commas stand among constraints alone

    def _begin_item(self, position: int) -> None:
        start = self.tokens[position].start
        self.automaton.feed(Token(",", "", start, start))
        self.last = self.automaton.checkpoint(position)
        self.repairs = 0

    def _stop(self, why: Diagnostic) -> tuple[ast.Statement, ...]:
        self.diagnostics.append(why)
        self.automaton.drop_statement()
        end = self.automaton.end
        while not self.automaton.feed(Token(END, "", end, end)):
            if not self.automaton.feed(Token("}", "", end, end)):
                self.automaton.drop_statement()
        return self.automaton.made

    # --- Recovery ---

    def _recover(self, position: int) -> int:
        """Reports the token that cannot stand. Returns the position to go on from."""
        automaton = self.automaton
        if not automaton.between_statements:
            # Rules may have been recognised on the way to the failure: return to just before the token, where
            # everything that could stand here is still possible.
            automaton.restore(self.last)
            for token in self.tokens[self.last.position : position]:
                automaton.feed(token)
            automaton.enter_block()
            if self._ends_statement(position) and not self._open_since(self._statement_begin(position)):
                automaton.feed(Token(";", "", automaton.end, automaton.end))
        from aidl_lang.syntax.errors import explain  # most programs have no errors of syntax

        problem = explain(
            Trouble(self.source, self.tokens, position, self._statement_begin(position), automaton)
        )
        repair = problem.repair
        if (left_out := problem.diagnostic.span) is not None and repair is not None and not repair.tokens:
            inside = range(left_out.start, left_out.end)
            self.diagnostics = [d for d in self.diagnostics if d.span is None or d.span.start not in inside]
        self._report(problem.diagnostic)
        if repair is not None and self.repairs < self._MOST_REPAIRS:
            self.repairs += 1
            if repair.start >= position:
                self.tokens[repair.start : repair.stop] = repair.tokens
                return position
            if repair.start >= self.last.position:
                self.tokens[repair.start : repair.stop] = repair.tokens
                automaton.restore(self.last)
                return self.last.position
        return self._skip(position, problem.with_block)

    def _ends_statement(self, position: int) -> bool:
        before, token = self.tokens[max(position - 1, 0)], self.tokens[position]
        is_next = token.kind in _CERTAIN_WORDS or token.kind in ("}", ")", "]", "@", "else")
        if not is_next and before.kind != "}":
            return False
        return not self.automaton.between_statements and self.automaton.accepts([";"])

    def _report(self, diagnostic: Diagnostic) -> None:
        for i, said in enumerate(self.diagnostics):
            if said.code == diagnostic.code == "E0104" and said.message == diagnostic.message:
                if said.fix and diagnostic.fix:
                    edits = said.fix.edits + tuple(e for e in diagnostic.fix.edits if e not in said.fix.edits)
                    self.diagnostics[i] = replace(said, fix=replace(said.fix, edits=edits))
                return
        self.diagnostics.append(diagnostic)

    def _statement_begin(self, position: int) -> int:
        """Returns the number of the first token of the statement under way; between statements `position`."""
        begin = self.automaton.begin
        if begin is None:
            return position
        return bisect_left(self.tokens, begin, 0, position, key=lambda token: token.start)

    def _open_since(self, begin: int) -> list[str]:
        """Returns the kinds of the brackets opened since a token and still open, the outermost first."""
        start = self.tokens[begin].start
        return [t.kind for t in self.automaton.open_brackets() if t.start >= start]

    def _skip(self, position: int, with_block: bool) -> int:
        """Leaves out the statement under way. Returns the position where the next one may begin.

        The statements of its block are read on as if they stood in the block around it, unless `with_block`.
        """
        tokens, automaton = self.tokens, self.automaton
        # How many brackets are open in the statement, and in each of the nested blocks among arguments.
        depths = [0]
        for kind in self._open_since(self._statement_begin(position)):
            _follow(depths, kind)
        dropped = not automaton.between_statements
        automaton.drop_statement()
        begun = position
        # A comment that is not closed is reported, however much is left out before it.
        while (kind := tokens[position].kind) != END and (
            position == begun or not is_open_comment(tokens[position])
        ):
            depth = depths[-1] + len(depths) - 1
            if kind == "{" and not (depth and self._begins_arguments(position)):
                if with_block:
                    return self._behind_block(position)
                self.passed_braces.append(automaton.open_blocks())
                return position + 1
            if kind == "}" and len(depths) == 1:
                if position > begun or dropped or automaton.open_blocks():
                    return position
            elif (position > begun or dropped) and self._may_begin(position, depth):
                self.passed_braces += [automaton.open_blocks()] * (len(depths) - 1)
                return position
            else:
                _follow(depths, kind)
            position += 1
        return position

    def _behind_block(self, position: int) -> int:
        braces = 0
        while (token := self.tokens[position]).kind != END and not is_open_comment(token):
            braces += (token.kind == "{") - (token.kind == "}")
            position += 1
            if not braces:
                break
        return position

    def _begins_arguments(self, position: int) -> bool:
        """Tells whether a `{` within brackets belongs to a `for` or an `if` that stands in these."""
        depth = 0
        for n in range(position - 1, max(-1, position - LONGEST), -1):
            kind = self.tokens[n].kind
            if not depth and kind in ("for", "if", "else"):
                return True
            depth += (kind in (")", "]", "}")) - (kind in ("(", "[", "{", "CALL"))
            if depth < 0:
                break
        return False

    def _may_begin(self, position: int, depth: int) -> bool:
        """Tells whether a token looks like the start of a statement, inside so many open brackets."""
        tokens = self.tokens
        token, before = tokens[position], tokens[position - 1]
        if token.kind == ";":
            return depth == 0
        if token.kind in _CERTAIN_WORDS:
            return True
        if before.kind not in (";", "}") and "\n" not in self.source.text[before.end : token.start]:
            return False
        if depth == 0:
            return token.kind in _POSSIBLE_STARTS and before.kind not in (",", "=", "+", "-", "*", "/")
        following = tokens[min(position + 1, len(tokens) - 1)]
        return (
            token.kind == "NAME"
            and following.kind in ("=", "NAME")
            and before.kind not in (",", "(", "[", "CALL")
        )


_CERTAIN_WORDS = STATEMENT_WORDS - {"for", "if"}
_POSSIBLE_STARTS = frozenset(["NAME", "CALL", "NUMBER", "(", "@", "for", "if"])


def _follow(depths: list[int], kind: str) -> None:
    """Counts a bracket in the innermost block; a brace begins or ends one."""
    if kind == "{":
        depths.append(0)
    elif kind == "}":
        depths.pop()
    elif kind in ("(", "[", "CALL"):
        depths[-1] += 1
    elif kind in (")", "]"):
        depths[-1] = max(0, depths[-1] - 1)


def depth_of(root: ast.Node) -> int:
    """Returns how deep nodes lie in each other."""
    deepest, stack = 0, [(root, 1)]
    while stack:
        node, depth = stack.pop()
        deepest = max(deepest, depth)
        stack += [(child, depth + 1) for child in ast.children(node)]
    return deepest


def _too_long(source: SourceFile, limits: TextLimits) -> Diagnostic:
    return Diagnostic(
        "E0801",
        f"the program is longer than {limits.max_characters:,} characters",
        Span(source, 0, 0),
        hints=("write repeated geometry with `for` or a template; move parts of the program to other files",),
    )


def _too_deep(span: Span, limits: TextLimits) -> Diagnostic:
    return Diagnostic(
        "E0802",
        f"this is nested more than {limits.max_nesting} levels deep",
        Span(span.source, span.start, min(span.end, span.start + 1)),
        hints=("give inner expressions names with `let`; add up many terms with `sum([...])`",),
    )
