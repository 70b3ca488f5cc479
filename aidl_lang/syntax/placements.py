"""Placements in lists and arguments, where none can stand."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.common.diagnostics import Diagnostic, Fix
from aidl_lang.common.source import Span
from aidl_lang.syntax.tokens import END, Token, begins_line
from aidl_lang.syntax.trouble import SyntaxProblem, TokenRepair, Trouble, closing, replaced

_OPENING, _CLOSING = ("CALL", "(", "[", "{"), (")", "]", "}")


def placement_in_expression(t: Trouble) -> SyntaxProblem | None:
    """Recognises `[rib(h: 6) at (8, 8), …]`, `mirror(rib() at (8, 8), …)`."""
    if t.token.kind not in ("at", "rotated") or not t.open or t.before is None or t.before.kind != ")":
        return None
    opening = t.tokens.index(t.open[-1], t.begin)
    close = closing(t.tokens, opening)
    if close < t.position or t.tokens[close].kind != ("]" if t.open[-1].kind == "[" else ")"):
        return None
    listed = _as_members(t, opening, close)
    stop = _item_end(t.tokens, t.position, close)
    call = f"{t.tokens[_call_start(t.tokens, t.position - 1)].text}…) {t.token.kind} …"
    hint = f"give the part a name of its own: `part = {call}`"
    if t.tokens[stop].kind == "for":
        hint = f"give each part a name in a loop: `for i in 0..3 {{ part[i] = {call} }}`"
    fix, repair = listed or (None, TokenRepair(t.position, stop))
    return SyntaxProblem(
        Diagnostic(
            "E0126",
            f"`{t.token.kind}` stands behind a definition, not inside an expression",
            t.span(to=t.tokens[stop - 1]),
            hints=(hint,) if fix is None else (),
            fix=fix,
        ),
        repair,
    )


def _as_members(t: Trouble, opening: int, close: int) -> tuple[Fix, TokenRepair] | None:
    """Returns the fix and repair that write `ribs = [a() at p, b()]` as `ribs[0] = a() at p` and `ribs[1] =
    b()`.
    """
    name, after = t.first, t.tokens[close + 1]
    is_list = [token.kind for token in t.tokens[t.begin : opening + 1]] == ["NAME", "=", "["]
    is_last = after.kind in ("}", ";", END) or begins_line(t.source.text, after.start)
    whole = t.span(name, t.tokens[close])
    if not (is_list and is_last) or any(sign in whole.text for sign in ("//", "/*", "#")):
        return None
    items: list[Sequence[Token]] = []
    start = opening + 1
    while start < close:
        stop = _item_end(t.tokens, start, close)
        if t.tokens[stop].kind == "for" or stop == start:
            return None
        items.append(t.tokens[start:stop])
        start = stop + 1
    lines, tokens = [], list[Token]()
    for i, item in enumerate(items):
        at = item[0].start, item[0].start
        own = name if i == 0 else Token(name.kind, name.text, *at)
        index = Token("[", "[", *at), Token("NUMBER", str(i), *at), Token("]", "]", *at), Token("=", "=", *at)
        tokens += [own, *index, *item]
        lines.append(f"{name.text}[{i}] = {Span(t.source, item[0].start, item[-1].end).text}")
    text = ("\n" + " " * t.indentation(name.start)).join(lines)
    fix = replaced("give each its own line", whole, text)
    return fix, TokenRepair(t.begin, close + 1, tuple(tokens))


def _item_end(tokens: Sequence[Token], start: int, close: int) -> int:
    """Returns the number of the `,` or `for` behind an item, or of the bracket that closes the list."""
    depth = 0
    for n in range(start, close):
        if depth == 0 and tokens[n].kind in (",", "for"):
            return n
        depth += (tokens[n].kind in _OPENING) - (tokens[n].kind in _CLOSING)
    return close


def _call_start(tokens: Sequence[Token], close: int) -> int:
    """Returns the number of the token that opens the bracket closed at `close`."""
    depth = 0
    for n in range(close, -1, -1):
        depth += (tokens[n].kind in _CLOSING) - (tokens[n].kind in _OPENING)
        if depth == 0:
            return n
    return close
