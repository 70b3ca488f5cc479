"""A place in a text under editing: the nodes around it, and the tokens that the grammar takes there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from itertools import takewhile
from typing import Literal

from aidl_lang.checking.symbols import SymbolScope
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import Parsed, parse, standing_before
from aidl_lang.syntax import ast
from aidl_lang.syntax.automaton import Automaton
from aidl_lang.syntax.tables import END, UNKNOWN, Token, Tokens
from aidl_server.ide.workspace import View, look

# --- Finds the nodes and the token at an offset.


def around(module: ast.Module, offset: int) -> list[ast.Node]:
    """Returns the nodes that an offset lies in or at the end of, the file first, the innermost last."""
    path: list[ast.Node] = [module]
    while found := [c for c in ast.children(path[-1]) if c.span.start <= offset <= c.span.end]:
        # of two that touch there, the one that begins
        path.append(next((c for c in found if offset < c.span.end), found[-1]))
    return path


def scope_at(view: View, offset: int) -> SymbolScope:
    scopes = view.resolution.scopes
    path = around(view.module, offset)
    return next(scopes[node] for node in reversed(path) if node in scopes and _opens_here(node, offset))


def _opens_here(node: ast.Node, offset: int) -> bool:
    """True if the names of a node are visible at an offset: its head belongs to what is around it."""
    match node:
        case ast.Structure(parameters=None) | ast.For() | ast.ForArguments():
            return node.body.span.start < offset <= node.body.span.end
        case _:
            return True


def token_at(view: View, offset: int) -> Token | None:
    """Returns the token that an offset lies in, or else the one that ends there."""
    found = [token for token in view.tokens.tokens if token.start <= offset <= token.end]
    return next((token for token in found if offset < token.end), found[-1] if found else None)


def structures_around(view: View, offset: int) -> Iterator[ast.Structure]:
    """Yields the structures whose bodies an offset lies in, innermost first."""
    for node in reversed(around(view.module, offset)):
        if isinstance(node, ast.Structure) and node.body.span.start < offset:
            yield node


# A text under editing is seldom a program. So a placeholder name is inserted, in the way that leaves the
# fewest mistakes, and the program is checked with it: the node that it became shows what is wanted.

PLACEHOLDER = "_what_is_being_written_here_" + "_" * 40
"""The name inserted at the place: too long to be compared with others as a misspelling."""
_CLOSERS = {"(": ")", "CALL": ")", "[": "]"}
_DIGITS = re.compile(r"(\d+(\.\d+)?|\.\d+)([eE][+-]?\d+)?")


@record()
class Spot:
    """The text that an offset lies in or at the end of: a comment, string or number, or code.

    start, end  the range that a new word replaces: the word there (of a string its contents, of a number its
                unit), or nothing
    token       the string or number
    before      the last token that ends before `start`
    """

    where: Literal["comment", "string", "number", "code"]
    offset: int
    start: int
    end: int
    before: Token | None
    token: Token | None = None


def spot_at(view: View, offset: int) -> Spot:
    text = view.source.text
    offset = max(0, min(offset, len(text)))
    tokens = view.tokens
    if _in_comment(tokens, text, offset):
        return Spot("comment", offset, offset, offset, None)
    before: Token | None = None
    for token in tokens.tokens:
        if token.start >= offset or token.kind == END:
            break
        name_end = _word_end(token)
        if offset <= name_end:
            return Spot("code", offset, token.start, name_end, before)
        if (found := _literal(token, before, text, offset)) is not None:
            return found
        before = token
    return Spot("code", offset, offset, offset, before)


def _in_comment(tokens: Tokens, text: str, offset: int) -> bool:
    for comment in tokens.comments:
        to_line_end = not comment.text.startswith("/*")
        if comment.span.start < offset < comment.span.end + to_line_end:
            return True
    last = next((t for t in reversed(tokens.tokens) if t.kind != END), None)
    return last is not None and last.kind == UNKNOWN and last.text.startswith("/*") and last.start < offset


def _word_end(token: Token) -> int:
    if token.kind == "CALL":
        return token.start + len(token.text.rstrip("( \t"))
    is_keyword = token.kind.isidentifier() and token.text == token.kind
    return token.end if token.kind == "NAME" or is_keyword else -1


def _literal(token: Token, before: Token | None, text: str, offset: int) -> Spot | None:
    is_string = token.text[:1] in ("'", '"')
    if is_string and (offset < token.end or (token.kind == UNKNOWN and offset == token.end)):
        end = token.end - (token.kind == "STRING")
        return Spot("string", offset, token.start + 1, max(end, token.start + 1), before, token)
    if token.kind == "NUMBER" and offset <= token.end:
        return _number(token, before, offset)
    unit = before is not None and before.kind == "NUMBER" and before.end == token.start
    if unit and before is not None and token.kind == UNKNOWN and offset <= token.end:
        number = Token("NUMBER", text[before.start : token.end], before.start, token.end)
        return _number(number, None, offset)
    return None


def _number(token: Token, before: Token | None, offset: int) -> Spot:
    digits = _DIGITS.match(token.text)
    assert digits is not None
    start = token.start + digits.end()
    return Spot("number", offset, start, token.end, before, token)


@record(eq=False)
class EditSite:
    """A place under editing in its program.

    original   the text as it is
    spot       the place in it
    automaton  the state of the grammar before the place
    view       the program with the placeholder; None if no name is possible there
    path       the nodes around the placeholder, outermost first; it is the last
    """

    original: View
    spot: Spot
    automaton: Automaton
    view: View | None
    path: tuple[ast.Node, ...]

    @property
    def node(self) -> ast.Node | None:
        """The Name or Identifier that the placeholder became."""
        return self.path[-1] if self.path else None

    @property
    def following(self) -> str:
        return self.original.source.text[self.spot.end :]

    @cached_property
    def scope(self) -> SymbolScope | None:
        return None if self.view is None else scope_at(self.view, self.spot.start + 1)

    @cached_property
    def may_end(self) -> bool:
        """True if a statement may begin here: the one before is complete, or there is none."""
        return self.automaton.between_statements or self.automaton.accepts([";"])

    @cached_property
    def begins_statement(self) -> bool:
        """True if a statement may begin here, and is likely to: not after another on the same line."""
        if not self.may_end:
            return False
        before = self.spot.before
        if before is None or before.kind in ("{", "}", ";"):
            return True
        between = self.original.source.text[before.end : self.spot.start]
        return "\n" in between or (before.kind == "," and self.automaton.between_statements)

    def takes(self, *kinds: str) -> bool:
        """Tells whether these tokens may stand here."""
        return self.automaton.accepts(kinds)

    def parent(self, above: int = 1) -> ast.Node | None:
        return self.path[-1 - above] if len(self.path) > above else None


def site_at(view: View, spot: Spot) -> EditSite:
    site = EditSite(view, spot, standing_before(view.source, spot.start), None, ())
    takes_name = site.takes("NAME") or site.takes("CALL") or site.may_end
    if not takes_name or (best := _filled(site)) is None:
        return site
    filled = look(view.path, best, view.world)
    return replace(site, view=filled, path=tuple(around(filled.module, spot.start + 1)))


def _filled(site: EditSite) -> Parsed | None:
    """Returns the text with the placeholder, parsed with the fewest mistakes; None if it is lost in all."""
    text, spot = site.original.source.text, site.spot
    head, tail = text[: spot.start], text[spot.end :]
    best: tuple[int, Parsed] | None = None
    for ending in _endings(site):
        parsed = parse(SourceFile(site.original.path.name, head + PLACEHOLDER + ending + tail))
        node = around(parsed.module, spot.start + 1)[-1]
        if not (isinstance(node, ast.Name | ast.Identifier) and node.text == PLACEHOLDER):
            continue
        mistakes = sum(d.is_error for d in parsed.diagnostics)
        if best is None or mistakes < best[0]:
            best = (mistakes, parsed)
        if not mistakes:
            break
    return best[1] if best is not None else None


def _endings(site: EditSite) -> Iterator[str]:
    """Yields texts that may complete the placeholder to a part of a program, the likelier first."""
    following = site.following
    if following.startswith("("):
        plain = [""]
    else:
        space = " " if following[:1].isalnum() or following[:1] == "_" else ""
        is_last = not following.partition("\n")[0].strip()
        as_name, as_statement = [space, "," + space], ["()" + space, "(); "]
        plain = [*as_statement, *as_name] if site.begins_statement and is_last else [*as_name, *as_statement]
    yield from plain
    closing = "".join(_CLOSERS[token.kind] for token in innermost_brackets(site.automaton))
    if closing:
        yield from (closing, closing + ";", "()" + closing, "()" + closing + ";")
    yield closing + " {}"


def innermost_brackets(automaton: Automaton) -> Iterator[Token]:
    """Yields the brackets that are open in the innermost block, the last first."""
    return takewhile(lambda token: token.kind != "{", reversed(automaton.open_brackets()))
