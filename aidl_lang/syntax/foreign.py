"""Constructs of other languages: their loops, blocks, functions, points and imports."""

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
    replaced,
    statement_end,
    wrong,
)
from aidl_lang.syntax.tables import END, STATEMENT_WORDS, UNKNOWN, Token, tokenize

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
    start, end = found.start(), found.end("close") if found["close"] else _last(found)
    if found["list"]:
        inner, text = _slice(t, *found.span("list")), found["list"]
    else:
        low, high = ("a", "b") if found["a"] else ("a3", "b3") if found["a3"] else ("a4", "b4")
        sign = "..<" if found["op"] in ("<", "!=") else ".."
        dots = Token(sign, sign, *found.span(high))
        inner = [*_slice(t, *found.span(low)), dots, *_slice(t, *found.span(high))]
        text = f"{found[low]}{sign}{found[high]}"
        by = next((name for name in ("s", "s2", "s3") if found[name]), None)
        if by:
            inner += [Token("step", "step", *found.span(by)), *_slice(t, *found.span(by))]
            text += f" step {found[by]}"
    right = f"for {found['i']} in {text}"
    head = [Token("for", "for", start, start + 3), Token("NAME", found["i"], *found.span("i"))]
    head.append(Token("in", "in", *found.span("i")))
    stop = next(n for n, token in enumerate(t.tokens) if token.start >= end)
    span, repair = Span(t.source, start, end), TokenRepair(t.begin, stop, (*head, *inner))
    return wrong("E0113", f"a loop is written `{right} {{ … }}`", span, right=right, repair=repair)


def _last(found: re.Match[str]) -> int:
    if found["list"] or found["b4"]:
        return max(found.end(name) for name in ("list", "b4"))
    return found.end("b3") + 1


def _slice(t: Trouble, start: int, end: int) -> list[Token]:
    return [token for token in t.tokens if token.start >= start and token.end <= end]


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
    end = t.tokens[last].end
    braces = t.token.but("{", "{"), Token("}", "}", end, end)
    opening = Edit(Span(t.source, t.gap().start, t.token.end), " {")
    message = f"the block of `{t.first.text}` stands in braces, not behind a colon"
    label = "`{` belongs here, and `}` at the end of the block"
    fix = Fix("put the block in braces", (opening, close), is_sure=True)
    repair = TokenRepair(t.position, last + 1, (braces[0], *t.tokens[t.position + 1 : last + 1], braces[1]))
    return wrong("E0121", message, t.span(), label, fix=fix, repair=repair)


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
    texts = [Span(t.source, v[0].start, v[-1].end).text for v in values]
    place = t.token.start, t.token.end
    if [name.lower() for name in names] == ["x", "y"]:
        right, what = f"({texts[0]}, {texts[1]})", "a point"
        begin, comma, end = (Token(sign, sign, *place) for sign in "(,)")
        tokens = [begin, *values[0], comma, *values[1], end]
    else:
        right = f"record({', '.join(f'{n}: {v}' for n, v in zip(names, texts, strict=True))})"
        what = "a record"
        tokens = [Token("CALL", "record(", *place)]
        for n, (key, value) in enumerate(zip(keys, values, strict=True)):
            name = Token("NAME", names[n], inner[key].start, inner[key].end)
            tokens += [name, Token(":", ":", *place), *value, Token(",", ",", *place)]
        tokens.append(Token(")", ")", *place))
    span, repair = t.span(t.token, t.tokens[close]), TokenRepair(t.position, close + 1, tuple(tokens))
    return wrong("E0109", f"{what} is written `{right}`", span, right=right, repair=repair)


def _braced_list(t: Trouble, close: int) -> SyntaxProblem:
    inner, last = t.tokens[t.position + 1 : close], t.tokens[close]
    depths = accumulate(token.nesting for token in inner)
    commas = sum(token.kind == "," and depth == 0 for token, depth in zip(inner, depths, strict=True))
    what, sides = ("a point", "()") if commas == 1 else ("a list", "[]")
    begin, end = (token.but(side, side) for token, side in zip((t.token, last), sides, strict=True))
    places = (Span(t.source, token.start, token.end) for token in (t.token, last))
    fix = Fix(f"put it in `{sides}`", tuple(map(Edit, places, sides)), is_sure=True)
    repair = TokenRepair(t.position, close + 1, (begin, *inner, end))
    message = f"{what} stands in `{sides}`, as in `{'(10, 5)' if commas == 1 else '[a, b, c]'}`"
    return wrong("E0109", message, t.span(t.token, last), fix=fix, repair=repair)


def question_mark(t: Trouble) -> SyntaxProblem | None:
    """Recognises `c ? a : b`."""
    if t.token.text != "?" or t.between:
        return None
    begin = _operand(t.tokens, t.position, -1, max(t.begin, t.position - LONGEST) - 1) + 1
    last = min(t.position + LONGEST, len(t.tokens) - 1)
    colon = _operand(t.tokens, t.position, 1, last)
    stop = _operand(t.tokens, colon, 1, last) if colon < last else last
    if t.tokens[colon].kind != ":" or begin == t.position or stop <= colon + 1:
        return None
    parts = t.tokens[begin : t.position], t.tokens[t.position + 1 : colon], t.tokens[colon + 1 : stop]
    texts = [Span(t.source, part[0].start, part[-1].end).text for part in parts]
    right = f"if {texts[0]} then {texts[1]} else {texts[2]}"
    places = zip(("if", "then", "else"), (parts[0][0], t.token, t.tokens[colon]), strict=True)
    words = [Token(word, word, place.start, place.end) for word, place in places]
    tokens = [token for word, part in zip(words, parts, strict=True) for token in (word, *part)]
    span, repair = t.span(parts[0][0], parts[2][-1]), TokenRepair(begin, stop, tuple(tokens))
    return wrong("E0109", f"a choice is written `{right}`", span, right=right, repair=repair)


def _operand(tokens: Sequence[Token], at: int, step: int, limit: int) -> int:
    """Returns the number of the token that ends the operand before or behind: a separator or a bracket."""
    depth, n = 0, at + step
    while n != limit:
        deeper = step * tokens[n].nesting
        if depth == 0 and (deeper < 0 or tokens[n].kind in (",", ";", ":", "=", END)):
            break
        depth += deeper
        n += step
    return n


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


_MODULES = frozenset(
    (
        *("math", "numpy", "np", "cadquery", "build123d", "aidl", "typing", "random", "sys", "os"),
        *("ezdxf", "maker", "jscad"),
    )
)


def import_of_module(t: Trouble) -> SyntaxProblem | None:
    """Recognises `import math`, `from build123d import *`."""
    words = [token.text for token in t.tokens[t.begin : t.begin + 2]]
    if len(words) < 2 or words[0] not in ("import", "from") or words[1] not in _MODULES:
        return None
    stop = statement_end(t.source, t.tokens, t.begin)
    span = t.span(t.first, t.tokens[stop - 1])
    message = f"nothing is imported from `{words[1]}`: functions and shapes are known without it"
    fix = replaced("remove the line", span, "")
    return wrong("E0113", message, span, fix=fix, repair=TokenRepair(t.begin, stop))


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
    stop, end, inner = t.position + 1, t.token.end, t.token.text.strip("\"'")
    if quotes in ('"""', "'''"):
        close = t.source.text.find(quotes, t.token.start + 3)
        if close < 0:
            return None
        end, inner = close + 3, t.source.text[t.token.start + 3 : close]
        while t.tokens[stop].start < end and t.tokens[stop].kind != END:
            stop += 1
    span = Span(t.source, t.token.start, end)
    lines = [line.strip() for line in inner.strip().splitlines()]
    comment = "\n".join(f"// {line}".rstrip() for line in lines)
    message = "a text alone says nothing; a remark begins with `//`"
    fix = replaced("make it a comment", span, comment)
    return wrong("E0117", message, span, fix=fix, repair=TokenRepair(t.position, stop))
