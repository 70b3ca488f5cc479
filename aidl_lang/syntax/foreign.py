"""What other languages, typography and habit write otherwise: loops, blocks, points, imports; units, quotes,
operators, and words that are reserved here.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import accumulate

from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.source import Span
from aidl_lang.syntax.automaton import (
    LONGEST,
    SyntaxProblem,
    TokenRepair,
    Trouble,
    closing,
    line_end,
    operand_end,
    replaced,
    statement_end,
    wrong,
)
from aidl_lang.syntax.tables import (
    END,
    EXAMPLES,
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
    is_open_comment,
    tokenize,
)

_PROSE = re.compile(
    r"[ \t]*(?:#{1,6} |[-*•] |\d+[.)] )?[*_`\"“]*[A-ZÀ-Þ][^{};=@<>|\n]*\Z"  # no sign of the language
)
_PROSE_ON = re.compile(r"[ \t]*[^\s{};=@<>|`/][^{};=@<>|\n]*\Z")
_WORDS = re.compile(r"[^\W\d_]+(?:['’][^\W\d_]+)?[,:.!?*_`\")]* +(?=[(*_`\"]*[^\W_])")
_FEWEST = 2
"""Words of a line of prose with another one behind them."""


def prose(t: Trouble) -> SyntaxProblem | None:
    """Recognises a paragraph about the program among its statements: the fix makes it a comment."""
    text, first = t.source.text, t.first.start
    start = text.rfind("\n", 0, first) + 1
    if text[start:first].strip():
        return None
    line = text[start : line_end(text, first)]
    if not _PROSE.match(line) or len(_WORDS.findall(line)) < _FEWEST:
        return None
    starts, end = [start], start + len(line)
    while _PROSE_ON.match(line := text[end + 1 : line_end(text, end + 1)]) and end < len(text):
        starts.append(end + 1)
        end += 1 + len(line)
    behind = (k for k in range(t.begin, len(t.tokens)) if t.tokens[k].start >= end)
    stop = next(behind, len(t.tokens) - 1)
    starts[0] = first
    edits = tuple(Edit(Span(t.source, at, at), "// ") for at in starts)
    message = "this is prose, and no part of the program"
    fix = Fix("make it a comment", edits, is_sure=True)
    return wrong("E0108", message, Span(t.source, first, end), fix=fix, repair=TokenRepair(t.begin, stop))


_LOOP = re.compile(
    r"for\s*(?P<open>\()?\s*(?:(?:let|var|const|int|auto)\s+)?(?P<i>[^\W\d]\w*)\s*"
    r"(?:=\s*(?P<a>[^;:,\n{}\[\]]+?)\s*;\s*(?P=i)\s*(?P<op><=?|!=)\s*(?P<b>[^;\n{}]+?)\s*;\s*"
    r"(?:(?P=i)\s*\+\+|\+\+\s*(?P=i)|(?P=i)\s*\+=\s*(?P<s>[^;\n{})]+?)|(?P=i)\s*=\s*(?P=i)\s*\+\s*(?P<s2>[^;\n{})]+?))"
    r"|=\s*\[\s*(?P<a3>[^;:,\n{}\[\]]+?)\s*:\s*(?:(?P<s3>[^;:,\n{}\[\]]+?)\s*:\s*)?(?P<b3>[^;:,\n{}\[\]]+?)\s*\]"
    r"|(?:=|from)\s*(?P<a4>[^;:,\n{}\[\]]+?)\s+to\s+(?P<b4>[^;:,\n{}\[\]]+?)"
    r"|(?P<word>of|in|=)\s*(?P<list>[^;:\n{}]+?))"
    r"\s*(?P<close>\))?\s*(?=[{:\n]|$)"
)


def foreign_loop(t: Trouble) -> SyntaxProblem | None:
    """Recognises `for (i = 0; i < 4; i++)`, `for i = [0:3]`, `for i of list` and the like."""
    if t.first.kind != "for" or t.between:
        return None
    end = min(line_end(t.source.text, t.first.start), t.first.start + LONGEST)
    found = _LOOP.match(t.source.text, t.first.start, end)
    if found is None or found.end() < t.token.start or bool(found["open"]) != bool(found["close"]):
        return None
    if found["word"] == "in" and not found["open"]:
        return None  # correct so far: the trouble lies elsewhere
    end, text = found.end("close") if found["close"] else _last(found), found["list"]
    if not text:
        low, high = ("a", "b") if found["a"] else ("a3", "b3") if found["a3"] else ("a4", "b4")
        text = f"{found[low]}{'..<' if found['op'] in ('<', '!=') else '..'}{found[high]}"
        text += "".join(f" step {found[name]}" for name in ("s", "s2", "s3") if found[name])
    right, span = f"for {found['i']} in {text}", Span(t.source, found.start(), end)
    return wrong("E0113", f"a loop is written `{right} {{ … }}`", span, right=right, tokens=t.tokens)


def _last(found: re.Match[str]) -> int:
    if found["list"] or found["b4"]:
        return max(found.end(name) for name in ("list", "b4"))
    return found.end("b3") + 1


def indented_block(t: Trouble) -> SyntaxProblem | None:
    """Recognises `for i in 0..3:` and an indented block, as in Python."""
    if t.between or t.open or t.token.kind != ":" or t.following.kind in ("{", END) or not t.accepts(*"{}"):
        return None
    text, indentation = t.source.text, t.indentation(t.first.start)
    end_of_head = line_end(text, t.token.start)
    one_line = t.following.start < end_of_head
    last = t.position
    while (token := t.tokens[last + 1]).kind != END:
        if (token.start > end_of_head) if one_line else (t.indentation(token.start) <= indentation):
            break
        last += 1
    if last == t.position:
        return None
    end = t.tokens[last].end
    close = Edit(Span(t.source, end, end), " }")
    if not one_line:
        end = line_end(text, end)
        close = Edit(Span(t.source, end, end), "\n" + " " * indentation + "}")
    opening = Edit(Span(t.source, t.gap().start, t.token.end), " {")
    message = f"the block of `{t.first.text}` stands in braces, not behind a colon"
    label = "`{` belongs here, and `}` at the end of the block"
    fix = Fix("put the block in braces", (opening, close), is_sure=True)
    return wrong("E0121", message, t.span(), label, fix=fix, tokens=t.tokens)


def object_literal(t: Trouble) -> SyntaxProblem | None:
    """Recognises `{x: 1, y: 2}`, and `{1, 2}`."""
    if t.token.kind != "{" or t.between or not t.accepts("NUMBER"):
        return None
    close = closing(t.tokens, t.position)
    if close < 0 or close == t.position + 1:
        return None
    kinds = {token.kind for token in t.tokens[t.position + 1 : close]}
    if kinds.isdisjoint((":", "=", ";", *STATEMENT_WORDS)):
        return _braced_list(t, close)
    two = t.tokens[t.position + 2]
    if two.kind not in (":", "=") or t.following.kind not in ("NAME", "STRING"):
        return None
    inner = t.tokens[t.position + 1 : close]
    keys: list[int] = []
    depth = 0
    for n, token in enumerate(inner):
        if depth == 0 and (n == 0 or inner[n - 1].kind == ",") and n + 1 < len(inner):
            keys.append(n)
        depth += token.nesting
    names = [inner[n].text.strip("\"'") for n in keys]
    values = [inner[n + 2 : after] for n, after in zip(keys, [*keys[1:], len(inner) + 1], strict=True)]
    values = [v[:-1] if v and v[-1].kind == "," else v for v in values]
    if not all(values) or not all(name.isidentifier() for name in names):
        return None
    texts = [t.span(v[0], v[-1]).text for v in values]
    if [name.lower() for name in names] == ["x", "y"]:
        right, what = f"({texts[0]}, {texts[1]})", "a point"
        begin, comma, end = (t.token.but(sign, sign) for sign in "(,)")
        tokens = [begin, *values[0], comma, *values[1], end]
    else:
        right = f"record({', '.join(f'{n}: {v}' for n, v in zip(names, texts, strict=True))})"
        what = "a record"
        tokens = [t.token.but("CALL", "record(")]
        for name, key, value in zip(names, keys, values, strict=True):
            tokens += [inner[key].but("NAME", name), t.token.but(":", ":"), *value, t.token.but(",", ",")]
        tokens.append(t.token.but(")", ")"))
    span, repair = t.span(to=t.tokens[close]), TokenRepair(t.position, close + 1, tuple(tokens))
    return wrong("E0109", f"{what} is written `{right}`", span, right=right, repair=repair)


def _braced_list(t: Trouble, close: int) -> SyntaxProblem:
    inner, last = t.tokens[t.position + 1 : close], t.tokens[close]
    depths = accumulate(token.nesting for token in inner)
    commas = sum(token.kind == "," and depth == 0 for token, depth in zip(inner, depths, strict=True))
    what, sides = ("a point", "()") if commas == 1 else ("a list", "[]")
    fix = Fix(f"put it in `{sides}`", tuple(map(Edit, map(t.span, (t.token, last)), sides)), is_sure=True)
    message = f"{what} stands in `{sides}`, as in `{'(10, 5)' if commas == 1 else '[a, b, c]'}`"
    return wrong("E0109", message, t.span(t.token, last), fix=fix, tokens=t.tokens)


def question_mark(t: Trouble) -> SyntaxProblem | None:
    """Recognises `c ? a : b`."""
    if t.token.text != "?" or t.between:
        return None
    first, last = max(t.begin, t.position - LONGEST), min(t.position + LONGEST, len(t.tokens) - 1)
    begin = operand_end(t.tokens, t.position, -1, first - 1, _SEPARATORS) + 1
    colon = operand_end(t.tokens, t.position, 1, last, _SEPARATORS)
    stop = operand_end(t.tokens, colon, 1, last, _SEPARATORS) if colon < last else last
    if t.tokens[colon].kind != ":" or begin == t.position or stop <= colon + 1:
        return None
    parts = t.tokens[begin : t.position], t.tokens[t.position + 1 : colon], t.tokens[colon + 1 : stop]
    texts = [t.span(part[0], part[-1]).text for part in parts]
    right, span = f"if {texts[0]} then {texts[1]} else {texts[2]}", t.span(parts[0][0], parts[2][-1])
    return wrong("E0109", f"a choice is written `{right}`", span, right=right, tokens=t.tokens)


_SEPARATORS = (",", ";", ":", "=", END)


def inches(t: Trouble) -> SyntaxProblem | None:
    """Recognises `5"` and `5 in`."""
    token, before = t.token, t.before
    if before is None:
        return None
    if token.kind in (UNKNOWN, "STRING") and token.text[0] == '"' and _has_no_unit(before) and t.touches:
        rest = tokenize(t.source, token.start + 1, token.end).tokens[:-1]
        span, right = Span(t.source, before.start, token.start + 1), before.text + "in"
        inch = Token("NUMBER", right, span.start, span.end)
        repair = TokenRepair(t.position - 1, t.position + 1, (inch, *rest))
        return wrong("E0105", f"inches are written `{right}`", span, right=right, repair=repair)
    number = t.tokens[t.position - 2]
    if t.position < 2 or before.kind != "in" or not _has_no_unit(number) or token.kind not in _ENDS:
        return None
    gap = Span(t.source, number.end, before.start)
    right, span = number.text + "in", t.span(number, before)
    message, label = f"a unit touches its number: `{right}`", "the space ends the number"
    repair = TokenRepair(t.position - 2, t.position, (Token("NUMBER", right, number.start, before.end),))
    return wrong("E0106", message, span, label, fix=replaced("remove the space", gap, ""), repair=repair)


def _has_no_unit(token: Token) -> bool:
    return token.kind == "NUMBER" and token.text[-1].isdigit()


_ENDS = frozenset([")", "]", "}", ",", ";", "+", "-", "*", "/", "==", "<=", ">=", END])


def loose_point(t: Trouble) -> SyntaxProblem | None:
    """Recognises `5.`."""
    for at in (t.position, t.position - 1) if t.before is not None else ():
        number, point = t.tokens[at - 1], t.tokens[at]
        if at and point.kind == "." and number.kind == "NUMBER" and (at < t.position or t.touches):
            span, right, repair = t.span(number, point), number.text, TokenRepair(at, at + 1)
            return wrong("E0105", f"`{right}.` is written `{right}`", span, right=right, repair=repair)
    return None


def word_for_sign(t: Trouble) -> SyntaxProblem | None:
    """Recognises `if a is b`, `5 mod 3`."""
    sign = {"is": "==", "mod": "%", "equals": "=="}.get(t.token.text)
    if sign is None or t.between or t.token.kind != "NAME" or not t.accepts(sign):
        return None
    message = f"`{t.token.text}` is written `{sign}`"
    return wrong("E0109", message, t.span(), right=sign, repair=t.exchanged(sign))


_MODULES = frozenset("math numpy np cadquery build123d aidl typing random sys os ezdxf maker jscad".split())


def import_of_module(t: Trouble) -> SyntaxProblem | None:
    """Recognises `import math`, `from build123d import *`."""
    words = [token.text for token in t.tokens[t.begin : t.begin + 2]]
    if len(words) < 2 or words[0] not in ("import", "from") or words[1] not in _MODULES:
        return None
    stop = statement_end(t.source, t.tokens, t.begin)
    span = t.span(t.first, t.tokens[stop - 1])
    message = f"nothing is imported from `{words[1]}`: functions and shapes are known without it"
    fix = replaced("remove the line", span, "")
    return wrong("E0113", message, span, fix=fix, tokens=t.tokens)


def several_names(t: Trouble) -> SyntaxProblem | None:
    """Recognises `x, y = 3, 4` and `let (x, y) = …`."""
    has_let = t.first.kind in ("let", "var", "param") and t.token.kind in ("(", "[") and len(t.statement) == 1
    kinds = t.first.kind, t.token.kind, t.following.kind
    bare = kinds == ("NAME", ",", "NAME") and len(t.statement) == 1
    if not has_let and not (bare and t.tokens[t.position + 2].kind == "=" and not t.automaton.in_constraints):
        return None
    message = "each name gets its value by itself: `let x = 3; let y = 4`"
    return wrong("E0103", message, t.span(t.first), "one name at a time")


def documentation_text(t: Trouble) -> SyntaxProblem | None:
    """Recognises a text as a statement: `\"\"\"A bracket.\"\"\"` or `"A bracket."`."""
    if t.token.kind not in ("STRING", UNKNOWN) or t.token.text[0] not in "\"'":
        return None
    if not (t.between or (t.complete and t.on_new_line)):
        return None
    quotes = t.source.text[t.token.start : t.token.start + 3]
    end, inner = t.token.end, t.token.text.strip("\"'")
    if quotes in ('"""', "'''"):
        close = t.source.text.find(quotes, t.token.start + 3)
        if close < 0:
            return None
        end, inner = close + 3, t.source.text[t.token.start + 3 : close]
    span = Span(t.source, t.token.start, end)
    lines = [line.strip() for line in inner.strip().splitlines()]
    comment = "\n".join(f"// {line}".rstrip() for line in lines)
    message = "a text alone says nothing; a remark begins with `//`"
    fix = replaced("make it a comment", span, comment)
    return wrong("E0117", message, span, fix=fix, tokens=t.tokens)


# --- Signs, units, quotes and words.


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
        right, message = number + digits, f"`{number}{text}` is written `{number}{digits}`"
        return wrong("E0105", message, t.span(before, t.token), right=right, tokens=t.tokens)
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
    line = Span(t.source, t.token.start, line_end(t.source.text, t.token.start))
    message = "the fence of a Markdown block is no part of the program"
    return wrong("E0108", message, line, fix=replaced("remove it", line, ""), tokens=t.tokens)


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
    return wrong("E0108", message, span, fix=fix, tokens=t.tokens)


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
        return wrong("E0113", message, span, fix=fix, tokens=t.tokens)
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
        EXAMPLES.get(word, ""),
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
