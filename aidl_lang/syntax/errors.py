"""Explanations of tokens that cannot stand: questions are asked in order, the more particular first. Those
about what is missing, left over or in the wrong place are here.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import count, takewhile

from aidl_lang.common.diagnostics import Edit, Fix, Label
from aidl_lang.common.prose import listed
from aidl_lang.common.source import Span
from aidl_lang.syntax import foreign, rewriting
from aidl_lang.syntax.automaton import (
    CLOSE_BLOCK,
    LONGEST,
    SyntaxProblem,
    TokenRepair,
    Trouble,
    closing,
    line_end,
    opening,
    operand_end,
    replaced,
    wrong,
)
from aidl_lang.syntax.tables import (
    END,
    STATEMENT_WORDS,
    VALUE_ENDS,
    VALUE_STARTS,
    Token,
    begins_line,
    describe,
    kind_of,
)
from aidl_lang.syntax.tree import out_of_place

# --- Placements in lists and arguments, where none can stand.

_ITEM_ENDS = (",", "for")


def placement_in_expression(t: Trouble) -> SyntaxProblem | None:
    """Recognises `[rib(h: 6) at (8, 8), …]`, `mirror(rib() at (8, 8), …)`."""
    if t.token.kind not in ("at", "rotated") or not t.open or t.before is None or t.before.kind != ")":
        return None
    begin = t.tokens.index(t.open[-1], t.begin)
    close = closing(t.tokens, begin)
    if close < t.position or t.tokens[close].kind != ("]" if t.open[-1].kind == "[" else ")"):
        return None
    stop = operand_end(t.tokens, t.position - 1, 1, close, _ITEM_ENDS)
    call = f"{t.tokens[opening(t.tokens, t.position - 1)].text}…) {t.token.kind} …"
    hint = f"give the part a name of its own: `part = {call}`"
    if t.tokens[stop].kind == "for":
        hint = f"give each part a name in a loop: `for i in 0..3 {{ part[i] = {call} }}`"
    message = f"`{t.token.kind}` stands behind a definition, not inside an expression"
    span = t.span(to=t.tokens[stop - 1])
    if (fix := _as_members(t, begin, close)) is not None:
        return wrong("E0126", message, span, fix=fix, tokens=t.tokens)
    return wrong("E0126", message, span, hints=(hint,), repair=TokenRepair(t.position, stop))


def _as_members(t: Trouble, opening: int, close: int) -> Fix | None:
    """Returns the fix that writes `ribs = [a() at p, b()]` as `ribs[0] = a() at p`, `ribs[1] = b()`."""
    name, after = t.first, t.tokens[close + 1]
    is_list = [token.kind for token in t.tokens[t.begin : opening + 1]] == ["NAME", "=", "["]
    is_last = after.kind in ("}", ";", END) or begins_line(t.source.text, after.start)
    whole = t.span(name, t.tokens[close])
    if not (is_list and is_last) or any(sign in whole.text for sign in ("//", "/*", "#")):
        return None
    lines: list[str] = []
    start = opening + 1
    while start < close:
        stop = operand_end(t.tokens, start - 1, 1, close, _ITEM_ENDS)
        if t.tokens[stop].kind == "for" or stop == start:
            return None
        lines.append(f"{name.text}[{len(lines)}] = {t.span(t.tokens[start], t.tokens[stop - 1]).text}")
        start = stop + 1
    text = ("\n" + " " * t.indentation(name.start)).join(lines)
    return replaced("give each its own line", whole, text)


_EXAMPLE_VALUE = {"param": "80", "var": "5", "let": "w / 2"}


def equation_for_definition(t: Trouble) -> SyntaxProblem | None:
    """Recognises `let x == 3`."""
    if t.token.kind != "==" or not t.accepts("="):
        return None
    message = "a name is given its value by `=`, not `==`"
    return wrong("E0111", message, t.span(), "`==` compares", right="=", repair=t.exchanged("="))


def definition_for_equation(t: Trouble) -> SyntaxProblem | None:
    """Recognises `a.x = b.x` outside `constrain`, `assert a = b`."""
    if t.token.kind != "=" or not t.accepts("==", "NAME"):
        return None
    definition = t.first.kind not in STATEMENT_WORDS and not t.open
    message = "`=` gives a value to a name; what must be equal is written with `==`"
    hint = "a part of a geometry already has a value: `constrain a.x == b.x` ties it to another"
    hints, repair = (hint,) if definition else (), t.exchanged("==")
    return wrong("E0110", message, t.span(), "write `==`", right="==", hints=hints, repair=repair)


def colon_for_equals(t: Trouble) -> SyntaxProblem | None:
    """Recognises `param w: 80` and `param w: length = 80`."""
    if t.token.kind != ":" or not t.accepts("="):
        return None
    after_next = t.tokens[min(t.position + 2, len(t.tokens) - 1)]
    if t.following.kind == "NAME" and after_next.kind == "=":
        message = f"`{t.first.text}` takes no type: its value tells"
        fix = replaced("remove the type", Span(t.source, t.gap().start, t.following.end), "")
        hint = "write the unit with the number: `80mm`, `30deg`"
        return wrong("E0109", message, t.span(to=t.following), fix=fix, hints=(hint,), tokens=t.tokens)
    message = "a name is given its value by `=`, not `:`"
    fix = replaced("write `=`", Span(t.source, t.gap().start, t.token.end), " =")
    return wrong("E0109", message, t.span(), fix=fix, repair=t.exchanged("="))


def missing_equals(t: Trouble) -> SyntaxProblem | None:
    """Recognises `param w 80`."""
    if t.first.kind not in ("param", "var", "let", "fn", "alias") or t.on_new_line:
        return None
    if t.token.kind not in VALUE_STARTS or not t.accepts("=", t.token.kind):
        return None
    return wrong(
        "E0103",
        f"expected `=` between the name and its value: `{t.first.text} {t.before and t.before.text} = …`",
        t.span(),
        fix=replaced("put in `=`", t.gap(), " ="),
        repair=t.put_in("="),
    )


def missing_value(t: Trouble) -> SyntaxProblem | None:
    """Recognises a statement that ends before its value."""
    if t.between or t.open or t.complete:
        return None
    first, before = t.first, t.before
    if before is None or not (t.token.kind in (";", ",") or t.begins_statement() or t.on_new_line):
        return None
    word = first.text
    if word in _EXAMPLE_VALUE and first.kind == word:
        name = t.tokens[t.begin + 1].text if len(t.statement) > 1 else "w"
        given = len(t.statement) > 1 and not t.accepts("NAME", "=")
        if t.accepts("NAME", "=") and len(t.statement) == 1:
            return _lacking(t, f"`{word}` needs a name and a value: `{word} w = {_EXAMPLE_VALUE[word]}`")
        if given and (t.accepts("=") or before.kind == "="):
            return _lacking(t, f"`{word}` needs a value: `{word} {name} = {_EXAMPLE_VALUE[word]}`")
    if t.accepts("else", "NAME"):
        return _lacking(t, "`if … then …` in an expression needs an `else`: `if c then a else b`")
    if t.accepts("NAME") and (t.accepts("NUMBER") or t.accepts("(")):
        return _lacking(t, f"expected a value after {describe(before)}")
    if t.accepts("NAME") and before.kind in STATEMENT_WORDS | {"."}:
        return _lacking(t, f"expected a name after {describe(before)}")
    return None


def _lacking(t: Trouble, message: str) -> SyntaxProblem:
    return wrong("E0103", message, t.span(t.before), "nothing follows")


def choice_without_parentheses(t: Trouble) -> SyntaxProblem | None:
    """Recognises `a == if c then b else d`."""
    if t.token.kind != "if" or t.between or t.complete or not t.accepts("(", "if"):
        return None
    message = f"a choice stands in parentheses behind {describe(t.before or t.first)}"
    return wrong("E0101", message, t.span(), "this begins a choice", hints=("write `(if c then a else b)`",))


def typed_definition(t: Trouble) -> SyntaxProblem | None:
    """Recognises `circle rim = circle(…)`."""
    if len(t.statement) != 2 or t.token.kind != "=" or not t.accepts("{"):
        return None
    kind, name = t.statement
    if kind.kind != "NAME" or name.kind != "NAME":
        return None
    message = f"a definition has no type before its name: `{name.text} = …`"
    label = "the value tells what it is"
    fix = replaced(f"remove `{kind.text}`", Span(t.source, kind.start, name.start), "")
    return wrong("E0113", message, t.span(kind), label, fix=fix, repair=TokenRepair(t.begin, t.begin + 1))


def import_without_path(t: Trouble) -> SyntaxProblem | None:
    """Recognises `import gears`."""
    if t.first.kind != "import" or t.before is None or t.before.kind != "NAME" or not t.accepts("from"):
        return None
    name = t.before.text
    message = f"`import {name}` does not say from which file"
    span = t.span(t.first, t.before)
    hint = f'`import "{name}.aidl"` for all of it, `import {name} from "parts.aidl"` for one name'
    return wrong("E0103", message, span, "a file is named by its path, in quotes", hints=(hint,))


def nameless_structure(t: Trouble) -> SyntaxProblem | None:
    """Recognises `hole { … }` and `solid "base" { … }`."""
    if len(t.statement) != 1 or t.first.kind != "NAME":
        return None
    word = t.first.text
    if t.token.kind == "STRING":
        inner = t.token.text[1:-1]
        name = "".join(c if c.isalnum() else "_" for c in inner) or word + "_1"
        name = name if name.isidentifier() else "_" + name
        message = f"a name is written without quotes: `{word} {name}`"
        repair = TokenRepair(t.position, t.position + 1, (t.token.but("NAME", name),))
        return wrong("E0116", message, t.span(), right=name, repair=repair)
    if t.token.kind not in ("{", "at", "rotated") or not (kind_of(word) or t.token.kind == "{"):
        return None
    taken = {token.text for token in t.tokens if token.kind == "NAME"}
    name = next(free for n in count(1) if (free := f"{word}_{n}") not in taken)
    article = "an" if word[0] in "aeiou" else "a"
    message = f"{article} `{word}` needs a name: `{word} {name} {{ … }}`"
    label, hints = "the name is missing", ("constraints and other parts speak of it by its name",)
    fix = replaced(f"name it `{name}`", t.gap(), f" {name}")
    return wrong("E0116", message, t.span(t.first), label, fix=fix, hints=hints, tokens=t.tokens)


def missing_block(t: Trouble) -> SyntaxProblem | None:
    """Recognises a head without its `{`, or with Python's colon."""
    if t.between or t.open or not t.accepts("{", "}") or t.token.kind in ("(", "="):
        return None
    colon = t.token.kind == ":"
    if not (colon or t.on_new_line or t.token.kind in (END, "}", ";") or t.token.kind in STATEMENT_WORDS):
        return None
    message = f"expected `{{` to begin the block of {describe(t.first)}"
    label, other = "the block begins with `{` and ends with `}`", Label(t.span(t.first), "for this")
    hints = ("blocks stand in braces, not behind a colon",) if colon else ()
    repair = t.exchanged() if colon and t.following.kind == "{" else None
    return wrong("E0121", message, t.gap(), label, (other,), hints=hints, repair=repair)


def repeated_placement(t: Trouble) -> SyntaxProblem | None:
    word = t.token.kind
    earlier = next((token for token in t.statement if token.kind == word), None)
    if word not in ("at", "rotated") or earlier is None or t.open:
        return None
    other = Label(t.span(earlier), "the first time")
    hint = "a structure has one position and one rotation"
    return wrong("E0120", f"`{word}` is said twice", t.span(), "the second time", (other,), hints=(hint,))


def out_of_place_in_constrain(t: Trouble) -> SyntaxProblem | None:
    """Recognises a statement inside `constrain { }` that is no constraint."""
    definition = len(t.statement) == 1 and kind_of(t.first.text) and t.token.kind in ("NAME", "CALL")
    if not t.automaton.in_constraints or not (
        definition or (t.between and t.token.kind in STATEMENT_WORDS | {"@"})
    ):
        return None
    word = t.first.text
    where = "behind the `}` of `constrain`" if word == "assert" else "in front of `constrain`"
    message = f"`{word}` cannot stand inside `constrain`"
    label = "only constraints, `let`, `prefer`, `for` and `if` do"
    return wrong("E0119", message, t.span(t.first), label, hints=(f"move it {where}",), with_block=True)


def attribute_out_of_place(t: Trouble) -> SyntaxProblem | None:
    if t.first.kind != "@" or t.between or t.open or not t.accepts("template"):
        return None
    return SyntaxProblem(out_of_place(t.span(t.first, t.before), describe(t.token)))


def bare_value(t: Trouble) -> SyntaxProblem | None:
    """Recognises an expression as a statement that neither constrains nor does anything."""
    if t.between or t.open or t.first.kind in STATEMENT_WORDS:
        return None
    if t.accepts(";") or not t.accepts("==", "NAME"):
        return None
    if not (t.begins_statement() or t.on_new_line or t.token.kind in (";", ",", "and", "or")):
        return None
    span = t.span(t.first, t.before)
    text, label = " ".join(span.text.split()), "a statement defines a name, compares, or calls something"
    text = text if len(text) <= 40 else text[:37] + "…"
    hints = ("to constrain it, compare it: `… == …`", "to name it, write `name = …`")
    return wrong("E0117", f"`{text}` alone says nothing", span, label, hints=hints)


def else_without_if(t: Trouble) -> SyntaxProblem | None:
    if t.token.kind != "else" or not t.between:
        return None
    message = "`else` follows the block of an `if`, and there is none before it"
    return wrong("E0101", message, t.span(), hints=("`if c { … } else { … }`",))


_CLOSER = {"(": ")", "CALL": ")", "[": "]", "{": "}"}
_BRACKET = {"(": "the parenthesis", "CALL": "the call", "[": "the bracket", "{": "the block"}
_ITEMS = {"CALL": "arguments", "{": "arguments", "[": "items", "(": "coordinates"}


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
    stop = operand_end(t.tokens, t.position, 1, min(len(t.tokens) - 1, t.position + LONGEST))
    end = line_end(t.source.text, t.token.start)
    if any(k.kind in (END, "}") or k.start >= end for k in t.tokens[t.position : stop + 1]):
        return None
    edits = tuple(Edit(t.span(k), ",") for k in t.tokens[t.position : stop] if k.kind == ";")
    message = f"{_ITEMS[t.open[-1].kind]} are separated by `,`; a `;` ends a statement"
    label = f"within {_BRACKET[t.open[-1].kind]}"
    fix = Fix("write `,`", edits, is_sure=True)
    return wrong("E0112", message, t.span(), label, fix=fix, tokens=t.tokens)


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
    limit = max(t.begin, t.position - LONGEST)
    n = operand_end(t.tokens, t.position, -1, limit, ("for", "if"))
    token, before = t.tokens[n], t.tokens[n - 1]
    if n <= limit or token.kind not in ("for", "if") or before.kind not in (*VALUE_ENDS, "STRING"):
        return None
    place = Span(t.source, before.end, before.end)
    message = f"expected `,` before a block of arguments that begins with `{token.text}`"
    other = Label(t.span(t.open[-1]), f"in {_BRACKET[t.open[-1].kind]} that begins here")
    fix = replaced("put in `,`", place, ",")
    return wrong("E0112", message, place, "a comma is missing here", (other,), fix=fix, tokens=t.tokens)


def unclosed_arguments(t: Trouble) -> SyntaxProblem | None:
    """Recognises a block among arguments that is left open where its call is closed."""
    if t.token.kind != ")" or not t.open or t.open[-1].kind != "{":
        return None
    opener, blocks = t.open[-1], takewhile(lambda k: k.kind == "{", reversed(t.open))
    text = "}" * len(list(blocks))
    if not t.accepts(*text, ")"):
        return None
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
    return wrong("E0119", message, t.span(t.before, t.token), fix=fix, hints=(hint,), tokens=t.tokens)


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


# --- All questions, in the order in which they are asked.

_QUESTIONS: tuple[Callable[[Trouble], SyntaxProblem | None], ...] = (
    foreign.prose,
    foreign.import_of_module,
    foreign.documentation_text,
    foreign.inches,
    foreign.question_mark,
    foreign.unclosed_comment,
    foreign.unclosed_string,
    foreign.unknown_unit,
    foreign.foreign_character,
    foreign.foreign_loop,
    rewriting.arrow_function,
    foreign.object_literal,
    foreign.loose_point,
    foreign.word_for_sign,
    foreign.several_names,
    foreign.operator_spelling,
    foreign.spaced_unit,
    foreign.foreign_statement,
    nameless_structure,
    repeated_placement,
    out_of_place_in_constrain,
    placement_in_expression,
    foreign.reserved_word,
    else_without_if,
    unclosed_arguments,
    comma_before_block,
    name_in_block,
    choice_in_block,
    wrong_closer,
    unclosed_block,
    equation_for_definition,
    definition_for_equation,
    colon_for_equals,
    semicolons,
    unclosed_bracket,
    three_coordinates,
    missing_comma,
    missing_equals,
    typed_definition,
    choice_without_parentheses,
    import_without_path,
    missing_value,
    foreign.indented_block,
    missing_block,
    bare_value,
    attribute_out_of_place,
    stray_closer,
    stray_comma,
)

# Names of what could come next, the most useful first.
_EXPECTED = (
    ("a value", ("NUMBER",)),
    ("a name", ("NAME",)),
    ("`=`", ("=",)),
    ("`{`", ("{",)),
    ("`in`", ("in",)),
    ("`else`", ("else",)),
    ("`then`", ("then",)),
    ("`,`", (",",)),
    ("`)`", (")",)),
    ("`]`", ("]",)),
    ("a comparison such as `==`", ("==",)),
    ("an operator", ("+",)),
)


def explain(trouble: Trouble) -> SyntaxProblem:
    """Returns the first answer to the questions, or a problem that names the token and what could stand."""
    for question in _QUESTIONS:
        if (problem := question(trouble)) is not None:
            return problem
    return _unexpected(trouble)


def _unexpected(t: Trouble) -> SyntaxProblem:
    possible = [words for words, kinds in _EXPECTED if t.accepts(*kinds)]
    if "a name" in possible and "`then`" in possible:
        possible.remove("`then`")  # which would be a name here
    if t.between:
        message = f"a statement cannot begin with {describe(t.token)}"
        possible = []
    elif t.complete:
        message = f"{describe(t.token)} cannot stand here: the statement before it is complete"
    else:
        if possible[:2] == ["a value", "a name"]:
            del possible[1]
        possible = possible[:3]
        expected = listed(possible, last="or")
        place = describe(t.token) if t.token.kind != END else "the end of the file"
        message = f"expected {expected}, not {place}" if expected else f"{place} cannot stand here"
    secondary = (Label(t.span(t.first), "in the statement that begins here"),) if not t.between else ()
    return wrong("E0101", message, t.span(), secondary=secondary)
