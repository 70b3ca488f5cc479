"""What is put right in the tokens before they are parsed: functions as other languages write them, words too
many, lists that begin statements; and lines that begin with a sign.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.automaton import (
    LONGEST,
    SyntaxProblem,
    Trouble,
    closing,
    line_end,
    opening,
    replaced,
    statement_end,
    wrong,
)
from aidl_lang.syntax.tables import END, STATEMENT_WORDS, VALUE_ENDS, Token, begins_line

if TYPE_CHECKING:
    from aidl_lang.parser import Parsed


def understood(source: SourceFile, tokens: list[Token]) -> list[Diagnostic]:
    """Rewrites tokens that have one plain meaning but would be read as another: functions with a body, `new`,
    `between`, texts marked as in Python, and what follows a `todo`.
    """
    found: list[Diagnostic] = []
    places = [n for n, token in enumerate(tokens) if token.text in _WORDS]
    for at in places[: -_MOST_PLACES - 1 : -1]:  # from the end, so that earlier tokens keep their numbers
        problem = _answer(source, tokens, at)
        if problem is not None and problem.repair is not None and len(found) < _MOST_REWRITTEN:
            tokens[problem.repair.start : problem.repair.stop] = problem.repair.tokens
            found.append(problem.diagnostic)
    return found[::-1]


_FUNCTION_WORDS = ("def", "function", "func", "fun", "fn")
_TODO_WORDS = ("todo", "TODO", "Todo", "TODO(")
_WORDS = frozenset([*_FUNCTION_WORDS, *_TODO_WORDS, "between", "lambda", "new", "f", "r", "u", "b"])
_MOST_PLACES, _MOST_REWRITTEN = 5000, 100  # beyond these nobody wrote it by hand


def _answer(source: SourceFile, tokens: Sequence[Token], at: int) -> SyntaxProblem | None:
    one, two = tokens[at], tokens[at + 1]
    if one.text in _FUNCTION_WORDS:
        return _function_with_body(source, tokens, at) if two.kind == "CALL" else None
    if one.text in _TODO_WORDS:
        return _todo(source, tokens, at)
    if one.kind != "NAME":
        return None
    match one.text:
        case "between" if at:
            return _between(source, tokens, at)
        case "lambda" if at > 1 and tokens[at - 1].kind == "=":
            return _lambda(source, tokens, at)
        case "new" if two.kind == "CALL":
            return _left_out(source, tokens, at, "things are made without `new`")
        case "f" | "r" | "u" | "b" if two.kind == "STRING" and one.end == two.start:
            hint = 'texts join with `+`: `"M" + str(size)`' if one.text == "f" else ""
            return _left_out(source, tokens, at, f"a text has no `{one.text}` before it", hint)
        case _:
            return None


def _left_out(
    source: SourceFile, tokens: Sequence[Token], at: int, message: str, hint: str = ""
) -> SyntaxProblem:
    word, after = tokens[at], tokens[at + 1]
    span = Span(source, word.start, word.end)
    fix = replaced(f"leave out `{word.text}`", Span(source, word.start, after.start), "")
    return wrong("E0113", message, span, fix=fix, hints=(hint,) if hint else (), tokens=tokens)


def _todo(source: SourceFile, tokens: Sequence[Token], at: int) -> SyntaxProblem | None:
    """Recognises `todo "the lid"`, `todo: the lid`, `todo()`: the rest of the line is a remark."""
    word, after = tokens[at], tokens[at + 1]
    before = tokens[at - 1].kind if at else ";"
    if before not in ("{", "}", ";") and not begins_line(source.text, word.start):
        return None
    if word.kind == "CALL" or after.kind == "(":
        opening = at if word.kind == "CALL" else at + 1
        inside, stop = slice(opening + 1, closing(tokens, opening)), closing(tokens, opening) + 1
    elif after.kind in ("STRING", ":"):
        stop = at + 2 if after.kind == "STRING" else statement_end(source, tokens, at + 1)
        inside = slice(stop - 1 if after.kind == "STRING" else at + 2, stop)
    else:
        return None
    end, told = tokens[stop - 1].end, tokens[inside]
    if stop <= at or "\n" in source.text[word.start : end]:
        return None
    span = Span(source, word.start, end)
    message, right = "`todo` stands alone", "todo"
    if told:
        remark = source.text[told[0].start : told[-1].end].strip("\"'")
        is_last = not source.text[end : line_end(source.text, end)].strip()
        message += "; what is still to be done says a comment"
        right = f"todo  // {remark}" if is_last else f"todo /* {remark.replace('*/', '')} */"
    return wrong("E0117", message, span, right=right, tokens=tokens)


def _function_with_body(source: SourceFile, tokens: Sequence[Token], begin: int) -> SyntaxProblem | None:
    """Recognises `def f(x): return 2 * x`, `function f(x) { return 2 * x }`, `fn f(x) { 2 * x }`."""
    close = closing(tokens, begin + 1)
    at = close + 1
    if close < 0 or tokens[at].kind not in (":", "{"):
        return None
    in_braces = tokens[at].kind == "{"
    first = at + 2 if tokens[at + 1].text == "return" else at + 1
    if tokens[min(first, len(tokens) - 1)].kind == END:
        return None
    stop, end_of_line = first, line_end(source.text, tokens[first].start)
    while tokens[stop].kind not in (END, "}", ";", "=") and tokens[stop].start < end_of_line:
        stop += 1
    after = stop + (tokens[stop].kind == ";")
    if stop == first or tokens[stop].kind == "=" or (in_braces and tokens[after].kind != "}"):
        return None
    value = tokens[first:stop]
    head = Span(source, tokens[begin + 1].start, tokens[close].end).text
    right = f"fn {head} = {Span(source, value[0].start, value[-1].end).text}"
    span = Span(source, tokens[begin].start, tokens[after].end if in_braces else value[-1].end)
    return _as_function(tokens, span, right)


def _as_function(tokens: Sequence[Token], span: Span, right: str) -> SyntaxProblem:
    fix = replaced("write it so", span, right)
    return wrong("E0113", f"a function is written `{right}`", span, fix=fix, tokens=tokens)


def _between(source: SourceFile, tokens: Sequence[Token], at: int) -> SyntaxProblem | None:
    end, last = line_end(source.text, tokens[at].start), min(at + LONGEST, len(tokens) - 1)
    middle = next((n for n in range(at + 2, last) if tokens[n].kind == "and"), last)
    if middle == last or tokens[middle + 1].start > end or tokens[at - 1].kind not in VALUE_ENDS:
        return None
    low = tokens[at + 1 : middle]
    span = Span(source, tokens[at].start, tokens[middle + 1].end)
    right = f"in {Span(source, low[0].start, low[-1].end).text}..{tokens[middle + 1].text}"
    gap = Span(source, low[-1].end, tokens[middle + 1].start)
    edits = Edit(Span(source, tokens[at].start, tokens[at].end), "in"), Edit(gap, "..")
    fix = Fix(f"write `{right}`", edits, is_sure=True)
    return wrong("E0109", f"a range is written `{right}`", span, fix=fix, tokens=tokens)


def _lambda(source: SourceFile, tokens: Sequence[Token], at: int) -> SyntaxProblem | None:
    """Recognises `let f = lambda x: 2 * x`."""
    last = min(at + LONGEST, len(tokens))
    colon = next((n for n in range(at, last) if tokens[n].kind not in ("NAME", ",")), at)
    stop = statement_end(source, tokens, colon + 1)
    if tokens[colon].kind != ":" or stop == colon + 1:
        return None
    begin = at - 3 if at > 2 and tokens[at - 3].kind == "let" else at - 2
    value = tokens[colon + 1 : stop]
    span = Span(source, tokens[begin].start, value[-1].end)
    return _named_function(tokens, [tokens[at - 2], *tokens[at + 1 : colon]], value, span)


def arrow_function(t: Trouble) -> SyntaxProblem | None:
    """Recognises `let f = (x) => 2 * x`."""
    at = t.position if t.token.kind == "=" else t.position - 1
    if t.tokens[at].kind != "=" or t.tokens[at + 1].kind != ">" or t.tokens[at].end != t.tokens[at + 1].start:
        return None
    statement = t.tokens[t.begin : at]
    shape = [token.kind for token in statement if token.kind not in ("let", ",")]
    if shape[:2] != ["NAME", "="] or any(k not in ("NAME", "(", ")") for k in shape[2:]):
        return None
    stop = statement_end(t.source, t.tokens, at + 2)
    if stop == at + 2:
        return None
    value = t.tokens[at + 2 : stop]
    span = Span(t.source, t.first.start, value[-1].end)
    return _named_function(t.tokens, statement, value, span)


def _named_function(
    tokens: Sequence[Token], head: Sequence[Token], value: Sequence[Token], span: Span
) -> SyntaxProblem:
    called, *parameters = (token.text for token in head if token.kind == "NAME")
    said = Span(span.source, value[0].start, value[-1].end).text
    return _as_function(tokens, span, f"fn {called}({', '.join(parameters)}) = {said}")


def spaced_call(source: SourceFile, token: Token) -> Diagnostic:
    """Returns E0114 for a call whose `(` does not touch its name; it is read as the call that was meant."""
    name = token.text[:-1]
    gap = Span(source, token.start + len(name), token.end - 1)
    message = f"the `(` of a call touches its name: `{name}(`"
    span = Span(source, token.start, token.end)
    label = "a space ends the name here"
    hint = "newlines and spaces end no statement, so `f (x)` would be the name `f` and then `(x)`"
    return Diagnostic("E0114", message, span, label, hints=(hint,), fix=replaced("remove the space", gap, ""))


# --- Lists that begin statements.


def lists_as_statements(source: SourceFile, tokens: list[Token]) -> list[Diagnostic]:
    """Puts `constrain` before each list that begins a statement, such as `[a, b].above(c)`, where the grammar
    wants it. Among constraints that says nothing new; elsewhere E0125 tells of a line that would go on with
    the one above as an index, and E0101 of another statement that begins with a list.
    """
    found: list[tuple[int, Diagnostic | None]] = []
    among_constraints: list[bool] = []  # for each open block
    opened: list[str] = []  # a block in a call is one of arguments, which may be lists
    asserting = False  # the comma before the message of an `assert` ends nothing
    for n, token in enumerate(tokens):
        asserting = token.kind == "assert" or (asserting and token.kind not in ("{", "}", ";"))
        begins = token.kind == "[" and opened[-1:] in ([], ["{"]) and "CALL" not in opened
        if begins and len(found) < _MOST_LISTS:
            before = tokens[n - 1].kind if n else ";"
            joined = before in VALUE_ENDS and begins_line(source.text, token.start)
            ends = before in _STATEMENT_ENDS and not (asserting and before == ",")
            close = closing(tokens, n) if joined or ends else -1
            after = [t.kind for t in tokens[close + 1 : close + 3]]
            among = among_constraints[-1:] == [True]
            may_go_on = not joined or (among and tokens[n + 1].kind != "NUMBER")
            if close > 0 and (after == [".", "CALL"] or (may_go_on and after[0] in _GO_ON)):
                found.append((n, None if among else _list_as_statement(source, token, joined)))
        if token.nesting > 0:
            if token.kind == "{":
                among_constraints.append(among_constraints[-1:] == [True] or _holds_constraints(tokens, n))
            opened.append(token.kind)
        elif token.nesting < 0 and opened and opened.pop() == "{":
            among_constraints.pop()
    for n, _ in reversed(found):
        tokens.insert(n, Token("constrain", "constrain", tokens[n].start, tokens[n].start))
    return [diagnostic for _, diagnostic in found if diagnostic is not None]


def _holds_constraints(tokens: list[Token], brace: int) -> bool:
    """Tells whether a block is that of `constrain { … }` or of the definition of a constraint."""
    if brace and tokens[brace - 1].kind == "constrain":
        return True
    if not brace or tokens[brace - 1].kind != ")":
        return False
    n = opening(tokens, brace - 1)
    return n > 0 and tokens[n].kind == "CALL" and tokens[n - 1].kind == "constraint"


_MOST_LISTS = 100
_STATEMENT_ENDS = ("{", "}", ";", ",")
_GO_ON = (".", "==", "<=", ">=", "<", ">", "in")


def _list_as_statement(source: SourceFile, token: Token, joined: bool) -> Diagnostic:
    span, place = Span(source, token.start, token.end), Span(source, token.start, token.start)
    fix = replaced("put `constrain` before it", place, "constrain ")
    if not joined:
        return Diagnostic("E0101", "a statement cannot begin with `[`", span, fix=fix)
    message = "a line that begins with `[` continues the line above"
    label = "read as an index of the expression above"
    hint = "newlines end no statement; with `constrain` before it a list begins one"
    return Diagnostic("E0125", message, span, label, hints=(hint,), fix=fix)


# --- Lines of `constrain { }` that begin with a sign, and the question if one begins a constraint of its
# own.
#
# Newlines mean nothing to the grammar, so `-` goes on with the line above. If it touches its operand, and
# the line compares, people read it as the next constraint.

_COMPARING = frozenset({"==", "<=", ">=", "<", ">", "!=", "=", "in"})
_ENDING = STATEMENT_WORDS | {END, ";", ",", "{", "}", "and", "or", "&&", "||", "else"}
_OPERANDS = frozenset({"NAME", "NUMBER", "STRING"})


def begins_with_sign(text: str, tokens: Sequence[Token], position: int) -> bool:
    """Tells whether a token is a `-` that begins a line, touches its operand and precedes a comparison."""
    if not _is_sign(text, tokens, position):
        return False
    depth, after_operand = 0, False
    for place in range(position + 1, min(len(tokens), position + LONGEST)):
        kind = tokens[place].kind
        if depth == 0:
            if kind in _COMPARING:
                return True
            begins_operand = kind in _OPERANDS or kind in ("CALL", "(")
            if kind in _ENDING or (after_operand and begins_operand) or _is_sign(text, tokens, place):
                return False
        depth += (kind in ("(", "[", "CALL")) - (kind in (")", "]"))
        if depth < 0:
            return False
        after_operand = kind in _OPERANDS or kind in (")", "]")
    return False


def _is_sign(text: str, tokens: Sequence[Token], position: int) -> bool:
    token = tokens[position]
    return token.kind == "-" and tokens[position + 1].start == token.end and begins_line(text, token.start)


_MOST_PLACES, _LONGEST = 100, 2000  # beyond this many lines and characters nobody wrote it by hand


def lines_joined_by_sign(
    module: ast.Module, tokens: Sequence[Token], read: Callable[[SourceFile], Parsed]
) -> list[Diagnostic]:
    """Returns W0101 for each line that begins with a sign if it and what is above read as statements."""
    source, text = module.source, module.source.text
    signs = (t.start for t in tokens if t.kind in "+-" and begins_line(text, t.start))
    places = [start for start in signs if text[:start].strip()]
    if not places:
        return []
    found = []
    leaves = list(_leaves(module.statements))
    for place in places[:_MOST_PLACES]:
        leaf = next((s for s in leaves if s.span.start < place < s.span.end), None)
        if leaf is None or leaf.span.end - leaf.span.start > _LONGEST:
            continue
        above, below = text[leaf.span.start : place], text[place : leaf.span.end].lstrip("+")
        inside = isinstance(leaf, ast.ExpressionStatement | ast.Equation)
        whole = f"constrain {{ {above}\n}}" if inside else above
        if _is_whole(whole, read) and _says_something(below, read):
            found.append(_warning(source, place, "" if inside and text[place] == "+" else "constrain "))
    return found


def _leaves(statements: Sequence[ast.Statement]) -> list[ast.Node]:
    leaves: list[ast.Node] = []
    stack: list[ast.Node] = list(statements)
    while stack:
        node = stack.pop()
        blocks = [child for child in ast.children(node) if isinstance(child, ast.Block)]
        if not blocks or (isinstance(node, ast.Constrain) and not node.braces):
            leaves.append(node)
        else:
            stack += [statement for block in blocks for statement in block.statements]
    return leaves


def _is_whole(text: str, read: Callable[[SourceFile], Parsed]) -> bool:
    parsed = read(SourceFile("", text))
    return not parsed.diagnostics and len(parsed.module.statements) == 1


def _says_something(text: str, read: Callable[[SourceFile], Parsed]) -> bool:
    """Tells whether an expression would constrain anything by itself."""
    parsed = read(SourceFile("", f"constrain {text}\n"))
    if parsed.diagnostics or len(parsed.module.statements) != 1:
        return False
    statement = parsed.module.statements[0]
    if not isinstance(statement, ast.Constrain) or len(statement.items.statements) != 1:
        return False
    item = statement.items.statements[0]
    return isinstance(item, ast.Equation) or (
        isinstance(item, ast.ExpressionStatement) and isinstance(item.value, ast.Comparison | ast.Membership)
    )


def _warning(source: SourceFile, place: int, begun: str) -> Diagnostic:
    sign = Span(source, place, place + 1)
    begun += sign.text.strip("+")
    before = len(source.text[:place].rstrip())
    message = f"a line that begins with `{sign.text}` continues the line above"
    label = f"this {'subtracts from' if sign.text == '-' else 'adds to'} the expression above"
    hint = "if it was meant as a statement of its own, end the line above with `;`"
    fix = Fix("end the line above with `;`", (Edit(Span(source, before, before), ";"), Edit(sign, begun)))
    return Diagnostic("W0101", message, sign, label, hints=(hint,), fix=fix)
