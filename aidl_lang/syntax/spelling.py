"""Characters, signs and words of other spelling: units, quotes, operators, reserved words."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.source import Span
from aidl_lang.syntax.automaton import SyntaxProblem, TokenRepair, Trouble, line_end, replaced, wrong
from aidl_lang.syntax.tables import (
    END,
    FOREIGN_WORDS,
    QUOTES,
    SIGNS,
    SINGLE_QUOTES,
    STATEMENT_WORDS,
    TWO_WAYS,
    UNIT_WORDS,
    UNITS,
    UNKNOWN,
    VALUE_ENDS,
    Token,
    example,
    is_open_comment,
    tokenize,
)


def unclosed_comment(t: Trouble) -> SyntaxProblem | None:
    if not is_open_comment(t.token):
        return None
    end = Span(t.source, t.token.end, t.token.end)
    opening = Span(t.source, t.token.start, t.token.start + 2)
    message = "this comment is not closed: expected `*/`"
    label = "the comment begins here and takes in the rest of the file"
    fix = replaced("close the comment at the end of the file", end, " */", is_sure=False)
    hint = "close it with `*/`, or begin each line of it with `//`"
    return wrong("E0107", message, opening, label, fix=fix, hints=(hint,), repair=t.exchanged())


def unclosed_string(t: Trouble) -> SyntaxProblem | None:
    text = t.token.text
    if t.token.kind != UNKNOWN or text[0] not in "\"'":
        return None
    kept = len(text.rstrip(" \t\r;,)]}")) if len(text) > 1 else 1
    end = t.token.start + max(kept, 1)
    written = t.source.text[t.token.start : end]
    escapes = len(written) - len(written.rstrip("\\"))
    closing = "\\" * (escapes % 2) + text[0]
    string = Token("STRING", written + closing, t.token.start, end)
    rest = tokenize(t.source, end, t.token.end).tokens[:-1]
    place = Span(t.source, end, end)
    message = f"this text is not closed: expected `{text[0]}` before the end of the line"
    span = Span(t.source, t.token.start, end)
    fix = replaced(f"close the text with `{text[0]}`", place, closing)
    repair = TokenRepair(t.position, t.position + 1, (string, *rest))
    return wrong("E0107", message, span, "the text begins here", fix=fix, repair=repair)


def unknown_unit(t: Trouble) -> SyntaxProblem | None:
    before = t.before
    if t.token.kind != UNKNOWN or before is None or before.kind != "NUMBER" or not t.touches:
        return None
    text, number = t.token.text, before.text
    if text[0].isdigit() or text[0] == ".":
        message, label = f"`{number}{text}` is not a number", "more than one point"
        return wrong("E0105", message, t.span(before, t.token), label, repair=t.exchanged())
    if text[0] == "_" and (digits := text.replace("_", "")).isdigit():
        whole = Token("NUMBER", number + digits, before.start, t.token.end)
        span, repair = t.span(before, t.token), TokenRepair(t.position - 1, t.position + 1, (whole,))
        message = f"`{number}{text}` is written `{whole.text}`"
        return wrong("E0105", message, span, right=whole.text, repair=repair)
    meant = UNIT_WORDS.get(text.lower())
    return wrong(
        "E0105",
        f"`{text}` is not a unit" + (f"; did you mean `{number}{meant}`?" if meant else ""),
        t.span(before, t.token),
        f"units are {', '.join(UNITS)}",
        fix=replaced(f"write `{meant}`", t.span(), meant) if meant else None,
        hints=()
        if meant
        else ("a number without a unit is in millimetres as a length, in degrees as an angle",),
        repair=t.exchanged(),
    )


def foreign_character(t: Trouble) -> SyntaxProblem | None:
    if t.token.kind != UNKNOWN:
        return None
    char = t.token.text
    if char in QUOTES:
        return _curly_quote(t)
    if t.source.text.startswith("```", t.token.start) and t.on_new_line:
        return _fence(t)
    if char == "|" and (found := _bars(t)) is not None:
        return found
    sign, words = SIGNS.get(char, (None, ""))
    point = "" if char.isprintable() else f" (U+{ord(char):04X})"
    shown = char if char.isprintable() else "?"
    if sign is None:
        message = f"the character `{shown}`{point} has no meaning in the language"
        fix = replaced("remove it", t.span(), "", is_sure=not char.isprintable()) if char != "?" else None
    else:
        message = f"`{shown}` is written `{sign}`"
        written = sign if not sign.isalpha() else f" {sign} "
        fix = replaced(f"write `{sign}`", t.span(), written, is_sure=char != "≈")
    stand_in = (t.token.but(sign, sign),) if sign else ()
    hints = (words,) if words else ()
    repair: TokenRepair | None = TokenRepair(t.position, t.position + 1, stand_in)
    if not stand_in and t.complete and t.following.kind != END:
        repair = None  # the rest makes no sense without the character
    return wrong("E0108", message, t.span(), fix=fix, hints=hints, repair=repair)


def _fence(t: Trouble) -> SyntaxProblem:
    """Recognises a line of Markdown around a program: "```aidl"."""
    end = line_end(t.source.text, t.token.start)
    stop = next(k for k in range(t.position, len(t.tokens)) if t.tokens[k].start >= end)
    line = Span(t.source, t.token.start, end)
    message = "the fence of a Markdown block is no part of the program"
    fix = replaced("remove it", line, "")
    return wrong("E0108", message, line, fix=fix, repair=TokenRepair(t.position, stop))


def _bars(t: Trouble) -> SyntaxProblem | None:
    """Recognises `|a.x|` where a value is due: an absolute value between bars."""
    is_behind_value = t.before is not None and t.before.kind in VALUE_ENDS
    stop = next((k for k in range(t.position + 1, len(t.tokens)) if t.tokens[k].text == "|"), t.position)
    close = t.tokens[stop]
    inner = t.source.text[t.token.end : close.start].strip()
    is_whole = not set(";\n{}") & set(inner) and inner.count("(") == inner.count(")")
    if not inner or not is_whole or (is_behind_value and not t.on_new_line):
        return None
    edits = (Edit(t.span(), "abs("), Edit(Span(t.source, close.start, close.end), ")"))
    message, span = f"an absolute value is written `abs({inner})`", Span(t.source, t.token.start, close.end)
    fix = Fix(f"write `abs({inner})`", edits, is_sure=True)
    tokens = t.token.but("CALL", "abs("), *t.tokens[t.position + 1 : stop], close.but(")", ")")
    return wrong("E0108", message, span, fix=fix, repair=TokenRepair(t.position, stop + 1, tokens))


def _curly_quote(t: Trouble) -> SyntaxProblem:
    """Recognises a text in typographic quotes: the fix makes both of them straight."""
    quote = "'" if t.token.text in SINGLE_QUOTES else '"'
    end = line_end(t.source.text, t.token.start)
    close = next((i for i in range(t.token.end, end) if t.source.text[i] in QUOTES), None)
    edits = [Edit(t.span(), quote)]
    stop, stand_in = t.position + 1, tuple[Token, ...]()
    if close is not None:
        edits.append(Edit(Span(t.source, close, close + 1), quote))
        inner = t.source.text[t.token.end : close]
        stand_in = (Token("STRING", quote + inner.replace("\\", "\\\\") + quote, t.token.start, close + 1),)
        while t.tokens[stop].kind != END and t.tokens[stop].start <= close:
            stop += 1
    message = f"text stands in straight quotes: `{quote}`"
    span = t.span() if close is None else Span(t.source, t.token.start, close + 1)
    label = "this is a typographic quote"
    fix = Fix("make the quotes straight", tuple(edits), is_sure=True)
    return wrong("E0108", message, span, label, fix=fix, repair=TokenRepair(t.position, stop, stand_in))


def spaced_unit(t: Trouble) -> SyntaxProblem | None:
    """Recognises `5 mm`: found at the unit itself, or behind it where a name may stand after a number."""
    for at in (t.position, t.position - 1):
        token, number = t.tokens[at], t.tokens[at - 1]
        if at < 1 or token.kind != "NAME" or token.text not in UNITS or number.kind != "NUMBER":
            continue
        if at == t.position - 1 and t.begin != at:
            continue
        gap = Span(t.source, number.end, token.start)
        if "\n" in gap.text or not gap.text or any(unit in number.text for unit in UNITS):
            continue
        message = f"a unit touches its number: `{number.text}{token.text}`"
        label = "the space ends the number"
        fix = replaced("remove the space", gap, "")
        return wrong("E0106", message, t.span(number, token), label, fix=fix, repair=TokenRepair(at, at + 1))
    return None


_SPELLINGS = {
    ("=", ">"): ">=",
    ("=", "<"): "<=",
    ("==", "="): "==",
    ("!=", "="): "!=",
    ("<", ">"): "!=",
    (">=", "="): ">=",
    ("<=", "="): "<=",
    (":", "="): "=",
    ("..", "."): "..",
    ("=", "=="): "==",
    ("..<", "="): "..",
    ("..", "="): "..",
}  # fmt: skip


def operator_spelling(t: Trouble) -> SyntaxProblem | None:
    """Recognises `=>`, `===`, `:=` and the like, whose first half may have been taken already."""
    for at in (t.position, t.position - 1):
        one, two = t.tokens[at], t.tokens[min(at + 1, len(t.tokens) - 1)]
        if at < 0 or one.end != two.start or (right := _SPELLINGS.get((one.kind, two.kind))) is None:
            continue
        written = one.text + two.text
        hints = {
            ":=": ("`=` gives a name its value",),
            "...": ("`a..b` includes both ends, `a..<b` leaves out the last",),
            "..=": ("`a..b` includes both ends, `a..<b` leaves out the last",),
        }.get(written, ())
        message = f"`{written}` is written `{right}`"
        repair = TokenRepair(at, at + 2, (Token(right, right, one.start, two.end),))
        return wrong("E0109", message, t.span(one, two), right=right, hints=hints, repair=repair)
    for one, two in ((t.token, t.following), (t.before or t.token, t.token)):
        if one.kind in ("+", "-", "*", "/") and two.kind == "=" and one.end == two.start:
            message = f"there is no `{one.text}=`: a name keeps the value it was given"
            hint = "give the new value a name of its own: `let longer = length + 5`"
            return wrong("E0109", message, t.span(one, two), hints=(hint,))
    return None


def foreign_statement(t: Trouble) -> SyntaxProblem | None:
    """Recognises a statement that begins with a word of another language, as `def` or `const`."""
    first = t.first
    word = first.text.rstrip("(")
    if first.kind not in ("NAME", "CALL") or (entry := FOREIGN_WORDS.get(word.lower())) is None:
        return None
    if t.between or (t.position == t.begin + 1 and t.token.kind in ("=", ".", "[")):
        return None
    message, right = entry
    span = Span(t.source, first.start, first.start + len(word))
    fix = repair = None
    following = [token.kind for token in t.tokens[t.begin + 1 : t.begin + 4]]
    if right == "let" and following == ["NAME", "=", "CALL"] and not t.automaton.in_constraints:
        # Geometry made by a call is drawn if it is defined without `let`.
        rest = Span(t.source, first.start, t.tokens[t.begin + 1].start)
        name = t.tokens[t.begin + 1].text
        message = f"there is no `{word}`: a definition begins with its name, `{name} = …`"
        fix = replaced(f"leave out `{word}`", rest, "")
        return wrong("E0113", message, span, fix=fix, repair=TokenRepair(t.begin, t.begin + 1))
    if right:
        stand_in = [Token(part, part, first.start, first.end) for part in right.split()]
        if first.kind == "NAME" and _would_take(t, stand_in):
            repair = TokenRepair(t.begin, t.begin + 1, tuple(stand_in))
        is_sure = repair is not None and word.lower() not in TWO_WAYS
        fix = replaced(f"write `{right}`", span, right, is_sure=is_sure)
    return wrong("E0113", f"there is no `{word}`: {message}", span, fix=fix, repair=repair)


def _would_take(t: Trouble, stand_in: Sequence[Token]) -> bool:
    """Tells whether the statement could be read through the trouble if its first word were exchanged."""
    rest = [*stand_in, *t.tokens[t.begin + 1 : t.position + 1]]
    return t.automaton.accepts((token.kind for token in rest), from_statement=True)


def reserved_word(t: Trouble) -> SyntaxProblem | None:
    """Recognises a word that begins statements, used as a name or called."""
    tables = t.automaton.tables
    token, at = t.token, t.position
    before = t.before
    alone = len(t.statement) == 1 and before is not None and before.kind in tables.reserved
    if alone and before is not None and token.kind in ("=", ".", "[", "==", "<=", ">=", ":"):
        # `shape = circle(…)`: the word was taken as reserved, and the trouble is the token behind it.
        token, at = before, t.position - 1
    if token.kind not in tables.reserved or (at == t.position and not _used_as_name(t)):
        return None
    word = token.text
    if word == "at" and t.open and t.following.kind in (":", "="):
        message = "`at` is a word of the language; where a shape is says its `center`"
        repair = TokenRepair(at, at + 1, (token.but("NAME", "center"),))
        return wrong("E0104", message, t.span(token), right="center", repair=repair)
    called = at + 1 < len(t.tokens) and t.tokens[at + 1].kind == "(" and at == t.position
    as_name = Token("NAME", word, token.start, token.end)
    stop = at + 1
    if called:
        as_name = Token("CALL", word + "(", token.start, t.tokens[at + 1].end)
        stop = at + 2
    role = "called" if called else "a name"
    is_declared = (at > 0 and t.tokens[at - 1].kind in STATEMENT_WORDS) or (
        at == t.begin and t.tokens[stop].kind == "="
    )
    return wrong(
        "E0104",
        f"`{word}` is a word of the language and cannot be {role}",
        t.span(token),
        example(word),
        fix=replaced(f"call it `{word}_1` instead", t.span(token), f"{word}_1", is_sure=is_declared)
        if not called
        else None,
        hints=(f"choose another name, as `{word}_1`",) if not called else (),
        repair=TokenRepair(at, stop, (as_name,)),
    )


def _used_as_name(t: Trouble) -> bool:
    """Tells whether the tokens behind a reserved word show that it is meant as a name."""
    after = t.following.kind
    if t.between:
        return after in ("=", ".", "[", "==", "<=", ">=") and t.token.kind != "else"
    if t.before is not None and t.before.kind in STATEMENT_WORDS and t.accepts("NAME"):
        return after in ("=", "==", ":", "(", "in") or not t.on_new_line
    if t.before is not None and t.before.kind == ".":
        return not t.on_new_line
    if t.on_new_line and t.token.kind in STATEMENT_WORDS:
        return False
    if t.token.kind in ("step", "weight") and t.accepts("NAME") and not t.complete:
        return True
    if t.accepts("CALL") and after == "(":
        return t.token.kind not in ("and", "or", "in", "else", "for")
    return (t.accepts("NAME") or t.accepts("CALL")) and after in (
        ":", "=", ")", "]", ",", ".", "*", "/", "+", "^", "==", "<=", ">=", "<", ">", "["
    ) and t.token.kind not in ("and", "or", "in", "not", "else")  # fmt: skip
