"""Lark's parser of `grammar/aidl.lark`, the words of the language and those of habit, and text to tokens."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import field
from functools import cache
from keyword import iskeyword
from pathlib import Path
from typing import Any, NamedTuple, cast

import lark
from lark import Lark, TextSlice
from lark.grammar import NonTerminal, Rule, RuleOptions, Terminal
from lark.lexer import LexerState, PatternRE, PatternStr, TerminalDef
from lark.lexer import Token as LarkToken
from lark.parsers.lalr_analysis import Reduce, Shift
from lark.parsers.lalr_parser_state import ParseConf

from aidl_lang.common.records import record
from aidl_lang.common.resources import derived, resource
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax.ast import Comment

# Lark works its tables out when the package is built; an installation brings them along as JSON, a checkout
# makes them anew when the grammar has changed (`resources.derived`).

DERIVED = "tables.json"
UNKNOWN = "?"

_BROKEN = r"""
OPEN_COMMENT: /\/\*[\s\S]*/
BROKEN.-1: /["'][^\n]*|[\s\S]/
"""
"""Terminals for what no rule takes: a comment or a text that is not closed, a foreign character."""


class _Kept:
    """Has Lark keep terminals that no rule of the grammar has."""

    always_accept = ("OPEN_COMMENT", "BROKEN")


@record(eq=False)
class Tables:
    """Lark's parser, and its terminals by what they are in the text.

    `parsing` has its states, and makes nothing; `makers` make the value of each rule, from a builder and the
    symbols. `types` are Lark's names of the terminals whose text is fixed (`==`, `param`), by that text, and
    `kinds` these the other way around; `patterns` are those of the other terminals, and of these `comments`
    are no tokens. `reserved` are the words that CALL leaves out, `soft_words` those that are names wherever
    the grammar has no place for them. In `statement_states` a statement may begin.
    """

    lark: Lark
    parsing: ParseConf[int]
    makers: dict[Rule, Callable[[Any, list[Any]], Reduced]]
    types: dict[str, str]
    kinds: dict[str, str]
    patterns: dict[str, str]
    comments: frozenset[str]
    reserved: frozenset[str]
    soft_words: frozenset[str]
    statement_states: frozenset[int]


@cache
def load_tables() -> Tables:
    """Returns the tables of the grammar of this installation, or of this checkout as it stands."""
    return decoded(derived(DERIVED, _inputs, built))


def _inputs() -> Iterator[Path]:
    yield Path(__file__)
    yield Path(lark.__file__)
    yield resource("grammar/aidl.lark")


def built() -> bytes:
    """Returns as JSON what Lark keeps of its parser, in half a second. Raises GrammarError if it cannot."""
    grammar = resource("grammar/aidl.lark").read_text(encoding="utf-8") + _BROKEN
    options = {"parser": "lalr", "lexer": "basic", "start": ["module"], "maybe_placeholders": False}
    made = Lark(grammar, **options, postlex=_Kept())
    types, call = _types(made), made.get_terminal("CALL")
    words = sorted(filter(str.isidentifier, types))
    soft_words = [word for word in words if re.fullmatch(call.pattern.to_regexp(), word + "(")]
    # The same with look-ahead, which not every engine has, is compiled in a tenth of the time.
    reserved = "|".join(word for word in words if word not in soft_words)
    call.pattern = PatternRE(rf"(?!({reserved})\()[^\W\d]\w*\(")
    data, memo = made.memo_serialize([Rule, TerminalDef])
    for place in data["rules"]:
        del memo[place["@"]]  # four fifths of it say what is alike in all rules
    states, sets, end = _states(made)
    data["options"] = options
    both = {"start_states": {"module": 0}, "end_states": {"module": end}}
    data["parser"]["parser"] = {"tokens": {}, "states": {}, **both}
    # Comments are no tokens to the grammar, but the printer needs them.
    space, *comments = data["parser"]["lexer_conf"]["ignore"]
    data["parser"]["lexer_conf"]["ignore"] = [space]
    # A `;` may stand among arguments in a block too.
    begins = {types.get(";"), types.get("prefer")}
    kept = {
        "data": data,
        "memo": memo,
        "rules": [
            (
                r.origin.name,
                ["+-"[s.filter_out] + s.name if isinstance(s, Terminal) else s.name for s in r.expansion],
                r.alias,
                r.options.keep_all_tokens,
                r.options.expand1,
            )
            for r in made.rules
        ],
        "states": states,
        "sets": sets,
        "comments": comments,
        "soft_words": soft_words,
        "statement_states": [n for n, (shifts, *_) in enumerate(states) if begins <= shifts.keys()],
    }
    return json.dumps(kept, separators=(",", ":")).encode()


def _states(made: Lark) -> tuple[list[Any], list[tuple[str, ...]], int]:
    """Returns the states, sets of symbols, and the state at the end.

    A state groups its reductions by the sets of symbols before which they are made: there are few such sets,
    and they are most of the tables.
    """
    conf = made.parse_interactive().parser_state.parse_conf
    rules = {rule: number for number, rule in enumerate(made.rules)}
    sets: dict[tuple[str, ...], int] = {}
    states: list[Any] = []
    # Lark's numbers of states follow the order of its sets, which changes from run to run.
    numbers = {conf.start_state: 0}
    for state in (waiting := [conf.start_state]):
        shifts: dict[str, int] = {}
        before: dict[int, list[str]] = {}
        for symbol, (action, target) in sorted(conf.states[state].items()):
            if action is Shift:
                if target not in numbers:
                    numbers[target] = len(numbers)
                    waiting.append(target)
                shifts[symbol] = numbers[target]
            elif target in rules:  # the end of the text is no rule
                before.setdefault(rules[target], []).append(symbol)
        reductions = [(rule, sets.setdefault(tuple(found), len(sets))) for rule, found in before.items()]
        states.append([shifts, *(x for pair in reductions for x in pair)])
    return states, list(sets), numbers[conf.end_state]


class Reduced(NamedTuple):
    """What a rule made: a value, and its place with the parentheses around it. The members of a list become
    parts of what the next rule makes.
    """

    value: Any
    start: int
    end: int


def _maker(rule: Rule) -> Callable[[Any, list[Any]], Reduced]:
    """Returns what makes the value of a rule: the method of a builder that has its name, or a list if that
    begins with `_`.
    """
    name = rule.alias or rule.origin.name
    method = "" if name.startswith("_") else name + "_" * iskeyword(name)
    is_filtered = [isinstance(s, Terminal) and s.filter_out for s in rule.expansion]
    kept = [i for i, is_out in enumerate(is_filtered) if rule.options.keep_all_tokens or not is_out]
    hands_on = rule.options.expand1 and not rule.alias and len(kept) == 1

    def make(builder: Any, symbols: list[Any]) -> Reduced:
        start, end = (symbols[0].start, symbols[-1].end) if symbols else (0, 0)
        if hands_on:
            return Reduced(symbols[kept[0]].value, start, end)
        parts: list[Any] = []
        for i in kept:
            value = symbols[i].value if type(symbols[i]) is Reduced else symbols[i]
            if type(value) is not list:
                parts.append(value)
            elif parts:
                parts += value
            else:
                parts = value  # which grows in place, as a list of statements is long
        value = getattr(builder, method)(builder.span(start, end), *parts) if method else parts
        return Reduced(value, start, end)

    return make


def _types(made: Lark) -> dict[str, str]:
    return {t.pattern.value: t.name for t in made.terminals if isinstance(t.pattern, PatternStr)}


def _rule(origin: str, symbols: list[str], alias: str | None, keeps_all: bool, passes_one: bool) -> Rule:
    expansion = [NonTerminal(s) if s[0] not in "-+" else Terminal(s[1:], s[0] == "-") for s in symbols]
    return Rule(NonTerminal(origin), expansion, 0, alias, RuleOptions(keeps_all, passes_one))


def decoded(text: bytes) -> Tables:
    """Returns Lark's parser from what `built` made of it."""
    kept = json.loads(text)
    memo = {int(number): value for number, value in kept["memo"].items()}
    rules = {place["@"]: _rule(*row) for place, row in zip(kept["data"]["rules"], kept["rules"], strict=True)}
    made = Lark.load({"data": kept["data"], "memo": memo | rules})
    conf = made.parse_interactive().parser_state.parse_conf
    reduce = [(Reduce, rule) for rule in made.rules]
    conf.callbacks = {}  # of Lark, which would make trees
    for number, (shifts, *reductions) in enumerate(kept["states"]):
        conf.states[number] = row = {symbol: (Shift, target) for symbol, target in shifts.items()}
        for i in range(0, len(reductions), 2):
            row.update(dict.fromkeys(kept["sets"][reductions[i + 1]], reduce[reductions[i]]))
    types, soft_words = _types(made), frozenset(kept["soft_words"])
    return Tables(
        made,
        conf,
        {rule: _maker(rule) for rule in made.rules},
        types,
        {name: text for text, name in types.items()} | dict.fromkeys(_Kept.always_accept, UNKNOWN),
        {t.name: t.pattern.to_regexp() for t in made.terminals if not isinstance(t.pattern, PatternStr)},
        frozenset(kept["comments"]),
        frozenset(filter(str.isidentifier, types)) - soft_words,
        soft_words,
        frozenset(kept["statement_states"]),
    )


# Newlines and indentation are no tokens. Characters outside any token become one of kind UNKNOWN, which the
# parser cannot accept and so reports.

END = "$END"


class Token(LarkToken):
    """A token; `kind` is the text itself for words and signs of the grammar, else the terminal's name."""

    __slots__ = ("kind",)
    kind: str
    # Lark's own, under shorter names.
    text = cast(str, LarkToken.value)
    start = cast(int, LarkToken.start_pos)
    end = cast(int, LarkToken.end_pos)

    def __new__(cls, kind: str, text: str, start: int, end: int) -> Token:
        token = str.__new__(cls, text)
        token.kind, token.value, token.start_pos, token.end_pos = kind, text, start, end
        token.type = load_tables().types.get(kind, kind)
        token.line = token.column = token.end_line = token.end_column = None
        return token

    @property
    def nesting(self) -> int:
        """1 for a bracket that opens, -1 for one that closes, else 0."""
        return (self.kind in ("CALL", "(", "[", "{")) - (self.kind in (")", "]", "}"))

    def but(self, kind: str, text: str) -> Token:
        """Returns another token in the place of this one."""
        return Token(kind, text, self.start, self.end)


@record(frozen=False)
class Tokens:
    """The tokens of a text.

    `tokens` ends with one of kind END; `docs` holds `///` texts by the offset of the token they stand before;
    `spaced_calls` are the calls whose `(` does not touch the name, which is understood and reported.
    """

    tokens: list[Token] = field(default_factory=list)
    comments: list[Comment] = field(default_factory=list)
    docs: dict[int, str] = field(default_factory=dict)
    spaced_calls: list[Token] = field(default_factory=list)


def tokenize(source: SourceFile, start: int = 0, end: int | None = None) -> Tokens:
    """Returns the tokens of a text or a part of it. Never fails: see UNKNOWN."""
    text, tables = source.text, load_tables()
    length = len(text) if end is None else end
    result = Tokens()
    tokens = result.tokens
    doc: list[str] = []
    state = LexerState(TextSlice(text, start, length))
    for found in tables.lark.parser.lexer.lex(state, None):
        kind, word, position = tables.kinds.get(found.type, found.type), found.value, found.start_pos
        if kind in tables.comments:
            result.comments.append(Comment(Span(source, position, position + len(word)), word))
            if word.startswith("///") and not word.startswith("////") and begins_line(text, position):
                doc.append(word[3:].removeprefix(" ").rstrip())
            continue
        token = Token(kind, word, position, position + len(word))
        if doc:
            result.docs[position] = "\n".join(doc)
            doc.clear()
        if tokens and tokens[-1].end == position and tokens[-1].kind in ("NUMBER", ".."):
            token = _touching(tokens, token)
            state.line_ctr.char_pos = token.end
        elif kind == "(" and tokens and tokens[-1].kind == "NAME":
            name = tokens[-1]
            if not text[name.end : position].strip(" \t"):
                tokens.pop()
                token = Token("CALL", name.text + "(", name.start, token.end)
                result.spaced_calls.append(token)
        tokens.append(token)
    tokens.append(Token(END, "", length, length))
    return result


def is_open_comment(token: Token) -> bool:
    """Tells whether a token is a comment that is not closed, which takes in the rest of the text."""
    return token.kind == UNKNOWN and token.text.startswith("/*")


def _touching(tokens: list[Token], token: Token) -> Token:
    """Splits a token that touches a number or `..`: letters behind a number are meant as a unit."""
    before = tokens[-1]
    if before.kind == "NUMBER" and token.kind in ("NAME", "CALL", "NUMBER"):
        digits = before.text.rstrip(_LETTERS) if token.kind != "NUMBER" else before.text
        tokens[-1] = Token("NUMBER", digits, before.start, before.start + len(digits))
        text = before.text[len(digits) :] + token.text.rstrip("(")
        return Token(UNKNOWN, text, tokens[-1].end, tokens[-1].end + len(text))
    if before.kind == ".." and token.kind == "NUMBER" and token.text[0] == ".":
        return Token(".", ".", token.start, token.start + 1)  # `0...5` is no range that ends at .5
    return token


def begins_line(text: str, offset: int) -> bool:
    """Tells whether only white space stands before an offset on its line."""
    return not text[text.rfind("\n", 0, offset) + 1 : offset].strip()


_LETTERS = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ°"


# --- The words that may stand before a structure's name, and the four kinds they mean.

_WORDS = {
    "assembly": "assembly group model design product subassembly system mechanism",
    "solid": "solid part component body piece element",
    "hole": "hole cut cutout void pocket opening negative",
    "drawing": "drawing sketch annotation engraving reference guide",
}

KINDS: tuple[str, ...] = tuple(_WORDS)
KIND_OF_WORD: dict[str, str] = {word: kind for kind, words in _WORDS.items() for word in words.split()}


def kind_of(word: str) -> str | None:
    """Returns the kind a word means, without regard to case and underscores; None if it is no kind."""
    return KIND_OF_WORD.get(word.lower().replace("_", ""))


# Typographic quotes, which stand for straight ones.
SINGLE_QUOTES = "‘’‚"  # noqa: RUF001
QUOTES = "“”„«»" + SINGLE_QUOTES

UNITS = ("mm", "cm", "m", "in", "ft", "deg", "rad", "turn")

UNIT_WORDS = {
    "millimeter": "mm", "millimeters": "mm", "millimetre": "mm", "millimetres": "mm",
    "centimeter": "cm", "centimeters": "cm", "centimetre": "cm", "centimetres": "cm",
    "meter": "m", "meters": "m", "metre": "m", "metres": "m",
    "inch": "in", "inches": "in", "foot": "ft", "feet": "ft",
    "degree": "deg", "degrees": "deg", "degs": "deg", "d": "deg",
    "radian": "rad", "radians": "rad", "rads": "rad", "turns": "turn", "rev": "turn",
}  # fmt: skip

STATEMENT_WORDS = frozenset(
    """
    param var let constrain prefer assert for if import fn shape constraint alias template
    construction todo
    """.split()
)

# The tokens that may begin a value, and those that may end one.
VALUE_STARTS = frozenset(
    ["NAME", "NUMBER", "STRING", "CALL", "(", "[", "true", "false", "True", "False", "if", "not"]
)

VALUE_ENDS = ("NAME", "NUMBER", ")", "]")

# A sign of other languages or of typography, its counterpart here, and a word about it.
SIGNS: dict[str, tuple[str | None, str]] = {
    "≤": ("<=", ""), "≥": (">=", ""), "≠": ("!=", ""), "×": ("*", ""), "·": ("*", ""), "÷": ("/", ""),
    "−": ("-", ""), "–": ("-", ""), "—": ("-", ""), "…": ("..", "`a..b` includes both ends"),
    "∧": ("and", ""),
    "∨": ("or", ""),  # noqa: RUF001
    "¬": ("not", ""), "&": ("and", ""), "|": ("or", ""),
    "≈": ("==", ""), "⊥": (None, "write `perpendicular(a, b)`"), "∥": (None, "write `parallel(a, b)`"),
    "?": (None, "a choice is written `if c then a else b`"), "$": (None, "names stand for themselves"),
    "π": (None, "write `pi`"), "`": (None, ""), "\\": (None, "statements go on below without a sign"),
}  # fmt: skip

# Words that begin statements elsewhere: advice, and the word to put in their place if any.
_FOREIGN: tuple[tuple[str, str, str | None], ...] = (
    ("def function func fun", "functions are defined as `fn f(x) = 2 * x`", "fn"),
    ("const val", "a name for a value is given by `let`", "let"),
    ("number float int double", "values have no type before their name; write `let`", "let"),
    ("parameter", "a parameter is declared by `param`", "param"),
    ("variable", "an unknown is declared by `var`", "var"),
    ("elif elseif", "write `else if`", "else if"),
    ("foreach", "write `for i in 0..9 { … }`", "for"),
    ("while", "programs repeat with `for i in 0..9 { … }`", None),
    ("return", "a function is one expression: `fn f(x) = 2 * x`", None),
    ("class", "what is made more than once is a template: `solid washer(outer = 20) { … }`", None),
    ("with", "a structure is written `solid base { … }`", None),
    ("struct", "a structure begins with its kind: `solid washer { … }`", None),
    ("include use", "other files are named by `import \"file.aidl\"`", "import"),
    ("from", "names are imported as `import a, b from \"file.aidl\"`", None),
    ("print", "what holds is stated by `assert`; the solved model shows every value", None),
    ("require ensure", "what must hold is stated by `constrain` or checked by `assert`", "constrain"),
    ("constraints", "constraints stand in `constrain { … }`", "constrain"),
    ("end", "a block ends with `}`", None),
)  # fmt: skip
FOREIGN_WORDS = {word: (advice, right) for words, advice, right in _FOREIGN for word in words.split()}
TWO_WAYS = frozenset({"require", "ensure"})
"""Words above that may also be meant otherwise."""

EXAMPLES = {
    "param": "`param` declares a parameter: `param w = 80`",
    "var": "`var` declares an unknown: `var gap = 5`",
    "let": "`let` names a value: `let h = w / 2`",
    "for": "`for` repeats: `for i in 0..3 { … }`",
    "if": "`if` chooses: `if n > 2 { … }`",
    "else": "`else` follows the block of an `if`",
    "shape": "`shape` defines one: `shape cross(size = 10) { … }`",
    "constraint": "`constraint` defines one: `constraint flush(a, b) { … }`",
    "constrain": "`constrain` states what must hold: `constrain a.width == 20`",
    "fn": "`fn` defines a function: `fn half(x) = x / 2`",
    "alias": "`alias` adds a name: `alias orthogonal = perpendicular`",
    "template": "`template` may stand before a structure with parameters",
    "construction": "`construction` marks a guide: `construction axis = line(…)`",
    "step": "`step` belongs to a range: `param w = 80 in 20..200 step 5`",
    "weight": "`weight` belongs to `prefer`: `prefer a.width == 20 weight 2`",
    "at": "`at` places a structure: `solid a at (10, 0) { … }`",
    "rotated": "`rotated` turns a structure: `solid a rotated 45deg { … }`",
    "in": "`in` belongs to a range: `x in 3..5`",
    "import": "`import` reads another file: `import \"parts.aidl\"`",
    "prefer": "`prefer` states a wish: `prefer a.width == 20`",
    "assert": "`assert` checks the result: `assert a.width > 10, \"too narrow\"`",
    "todo": "`todo` marks a body that is still to be written",
}  # fmt: skip
"""The use of each word of the language."""


def describe(token: Token) -> str:
    """Returns the name of a token in a message."""
    if token.kind == END:
        return "the end of the file"
    if token.kind == "CALL":
        return f"the call `{token.text}…)`"
    if token.kind == "STRING":
        return "this text"
    return f"`{token.text}`"
