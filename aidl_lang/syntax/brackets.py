"""Brackets and blocks that are not closed, or closed without being open; commas between their items."""

from __future__ import annotations

from aidl_lang.common.diagnostics import Edit, Fix, Label
from aidl_lang.common.source import Span
from aidl_lang.syntax.automaton import (
    CLOSE_BLOCK,
    LONGEST,
    SyntaxProblem,
    TokenRepair,
    Trouble,
    line_end,
    replaced,
    wrong,
)
from aidl_lang.syntax.tables import END, VALUE_STARTS, Token, begins_line

_CLOSER = {"(": ")", "CALL": ")", "[": "]", "{": "}"}
_BRACKET = {"(": "the parenthesis", "CALL": "the call", "[": "the bracket", "{": "the block"}
_ITEMS = {"CALL": "arguments", "{": "arguments", "[": "items", "(": "coordinates"}
_VALUE_ENDS = ("NAME", "NUMBER", ")", "]")


def wrong_closer(t: Trouble) -> SyntaxProblem | None:
    """Recognises a closing bracket of another kind than the one that is open."""
    if t.token.kind not in (")", "]") or not t.open or _CLOSER[t.open[-1].kind] == t.token.kind:
        return None
    opener = t.open[-1]
    span, right = t.span(opener), _CLOSER[opener.kind]
    if not t.accepts(right):
        return None
    message = f"expected `{right}` to close {_BRACKET[opener.kind]} that begins here, not `{t.token.text}`"
    other = Label(t.span(), f"`{right}` belongs here")
    fix = replaced(f"write `{right}`", t.span(), right)
    return wrong("E0102", message, span, "opened here", (other,), fix=fix, repair=t.exchanged(right))


def semicolons(t: Trouble) -> SyntaxProblem | None:
    """Recognises `[60; 80]` and `rectangle(a; b)`: a bracket that is closed on its line, with semicolons."""
    is_written = t.token.kind == ";" == t.span().text  # not put in for a bracket
    if not is_written or not t.open or not t.accepts(","):
        return None
    end, depth, stop = line_end(t.source.text, t.token.start), 0, t.position
    while depth >= 0 and stop - t.position < LONGEST:
        stop += 1
        token = t.tokens[stop]
        if token.kind in (END, "}") or token.start >= end:
            return None
        depth += token.nesting
    meant = tuple(k.but(",", ",") if k.kind == ";" else k for k in t.tokens[t.position : stop])
    edits = tuple(Edit(t.span(k), ",") for k in t.tokens[t.position : stop] if k.kind == ";")
    message = f"{_ITEMS[t.open[-1].kind]} are separated by `,`; a `;` ends a statement"
    label = f"within {_BRACKET[t.open[-1].kind]}"
    fix = Fix("write `,`", edits, is_sure=True)
    return wrong("E0112", message, t.span(), label, fix=fix, repair=TokenRepair(t.position, stop, meant))


def unclosed_bracket(t: Trouble) -> SyntaxProblem | None:
    """Recognises a bracket left open at the end of its statement, or where another begins."""
    if not t.open or not (t.begins_statement() or t.token.kind in (";", "{", "at", "rotated")):
        return None
    closers = [_CLOSER[opener.kind] for opener in reversed(t.open)]
    if t.token.kind == "}" and "}" in closers[1:]:
        closers = closers[: closers.index("}", 1)]  # which ends the block among arguments
    if not t.accepts(*closers):
        return None
    opener = t.open[-1]
    text = "".join(closers)
    fix = replaced(f"put in `{text}`", t.gap(), text)
    return _not_closed(t, opener, text, t.gap(), fix, t.put_in(*closers))


def _not_closed(
    t: Trouble, opener: Token, text: str, place: Span, fix: Fix, repair: TokenRepair
) -> SyntaxProblem:
    message = f"expected `{text}` to close {_BRACKET[opener.kind]} that begins here"
    label, other = "opened here and not closed", Label(place, f"`{text}` is missing")
    return wrong("E0102", message, t.span(opener), label, (other,), fix=fix, repair=repair)


def unclosed_block(t: Trouble) -> SyntaxProblem | None:
    """Recognises a block left open at the end of the file; indentation tells which was to end, and where."""
    if t.token.kind != END or not t.between:
        return None
    blocks = [token for token in t.automaton.open_brackets() if token.kind == "{"]
    if not blocks:
        return None
    opener = _misindented(t, blocks[0]) or blocks[-1]
    place = _place_for_brace(t, opener)
    indent = " " * t.indentation(opener.start)
    closer = f"\n{indent}}}"
    return _not_closed(t, opener, "}", place, replaced(CLOSE_BLOCK, place, closer), t.put_in("}"))


def _misindented(t: Trouble, outermost: Token) -> Token | None:
    """Returns the first block that ends with a brace indented less than the line on which it begins."""
    opened: list[Token] = []
    for token in t.tokens:
        if token.kind == "{" and token.start >= outermost.start:
            opened.append(token)
        elif token.kind == "}" and opened:
            opener = opened.pop()
            outer = t.indentation(opener.start)
            if begins_line(t.source.text, token.start) and t.indentation(token.start) < outer:
                return opener
    return None


def _place_for_brace(t: Trouble, opener: Token) -> Span:
    """Returns the end of the last line of a block: the next one is indented no deeper than its head."""
    head = t.indentation(opener.start)
    last = opener
    for token in t.tokens:
        if token.start <= opener.start:
            continue
        is_outside = begins_line(t.source.text, token.start) and t.indentation(token.start) <= head
        if is_outside or token.kind == END:
            break
        last = token
    return Span(t.source, last.end, last.end)


def stray_closer(t: Trouble) -> SyntaxProblem | None:
    if t.token.kind not in (")", "]", "}") or t.open or not (t.between or t.accepts(";")):
        return None
    message = f"`{t.token.text}` closes nothing"
    fix = replaced("remove it", t.span(), "")
    return wrong("E0118", message, t.span(), "no bracket is open here", fix=fix, repair=t.exchanged())


def missing_comma(t: Trouble) -> SyntaxProblem | None:
    if not t.open or not (t.token.kind in VALUE_STARTS or t.token.kind == "for"):
        return None
    if not t.accepts(",", t.token.kind):
        return None
    opener, inside = t.open[-1], _ITEMS[t.open[-1].kind]
    message, label = f"expected `,` between two {inside}", "a comma is missing here"
    other = Label(t.span(opener), f"in {_BRACKET[opener.kind]} that begins here")
    fix = replaced("put in `,`", t.gap(), ",")
    return wrong("E0112", message, t.gap(), label, (other,), fix=fix, repair=t.put_in(","))


def comma_before_block(t: Trouble) -> SyntaxProblem | None:
    """Recognises `path((0, 0) for i in 0..3 { … })`, where the comma before `for` is missing."""
    if t.token.kind != "{" or not t.open or t.open[-1].kind not in ("CALL", "{"):
        return None
    depth = 0
    for n in range(t.position - 1, max(t.begin, t.position - LONGEST), -1):
        token, before = t.tokens[n], t.tokens[n - 1]
        if token.kind in ("for", "if") and not depth:
            break
        depth -= token.nesting
        if depth < 0:
            return None
    else:
        return None
    if before.kind not in (*_VALUE_ENDS, "STRING"):
        return None
    place = Span(t.source, before.end, before.end)
    message = f"expected `,` before a block of arguments that begins with `{token.text}`"
    other = Label(t.span(t.open[-1]), f"in {_BRACKET[t.open[-1].kind]} that begins here")
    fix = replaced("put in `,`", place, ",")
    repair = TokenRepair(n, n, (Token(",", ",", before.end, before.end),))
    return wrong("E0112", message, place, "a comma is missing here", (other,), fix=fix, repair=repair)


def unclosed_arguments(t: Trouble) -> SyntaxProblem | None:
    """Recognises a block among arguments that is left open where its call is closed."""
    if t.token.kind != ")" or not t.open or t.open[-1].kind != "{":
        return None
    count = 1
    while count < len(t.open) and t.open[-count - 1].kind == "{":
        count += 1
    if not t.accepts(*"}" * count, ")"):
        return None
    opener, text = t.open[-1], "}" * count
    fix = replaced(f"put in `{text}`", t.gap(), " " + text)
    return _not_closed(t, opener, text, t.gap(), fix, t.put_in(*text))


def choice_in_block(t: Trouble) -> SyntaxProblem | None:
    """Recognises `a if c else b` in a block among arguments."""
    if t.token.kind != "else" or not t.open or t.open[-1].kind != "{" or not t.accepts("{"):
        return None
    message = "in a block of arguments, `if` behind an argument begins a block of its own"
    hint = "write `if c then a else b`, or put `a if c else b` in parentheses"
    return wrong("E0119", message, t.span(), hints=(hint,))


def name_in_block(t: Trouble) -> SyntaxProblem | None:
    """Recognises `p = (i, 0)` and `from: (i, 0)` in a block among arguments."""
    if t.token.kind not in ("=", ":") or not t.open or t.open[-1].kind != "{" or t.before is None:
        return None
    name = t.before.text
    if not name.isidentifier():
        return None
    if t.token.kind == ":":
        hint = f"write `{name}: …` among the arguments outside of the block"
        message = f"an argument in a block has no name, and this is called `{name}`"
        return wrong("E0119", message, t.span(t.before, t.token), hints=(hint,))
    place = Span(t.source, t.before.start, t.before.start)
    message = f"a block of arguments makes nothing, and `{name} = …` would"
    fix = replaced("write `let`", place, "let ")
    hint = f"`let {name} = …` names a value for the rest of the block"
    repair = TokenRepair(t.position - 1, t.position - 1, (Token("let", "let", place.start, place.start),))
    return wrong("E0119", message, t.span(t.before, t.token), fix=fix, hints=(hint,), repair=repair)


def three_coordinates(t: Trouble) -> SyntaxProblem | None:
    if not t.open or t.open[-1].kind != "(" or t.token.kind in (")", END) or t.before is None:
        return None
    if t.before.kind != "," or not t.accepts(")"):
        return None
    message = "a point has two coordinates: `(x, y)`"
    hint = "drawings are flat: leave z out; thickness is an attribute, `@thickness(3mm)`"
    return wrong("E0123", message, t.span(t.open[-1], t.token), "this has a third", hints=(hint,))


def stray_comma(t: Trouble) -> SyntaxProblem | None:
    if t.token.kind != "," or t.open or not t.accepts(";"):
        return None
    message = "statements are not separated by commas"
    label = "a new line or `;` does"
    hint = "commas stand between arguments, and between constraints inside `constrain { }`"
    return wrong("E0122", message, t.span(), label, right=";", hints=(hint,), repair=t.exchanged(";"))
