"""Words and signs written by habit, and their counterparts here; kinds of structures, names of tokens."""

from __future__ import annotations

from aidl_lang.syntax.tables import END, Token

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
    [
        "param",
        "var",
        "let",
        "constrain",
        "prefer",
        "assert",
        "for",
        "if",
        "import",
        "fn",
        "shape",
        "constraint",
        "alias",
        "template",
        "construction",
        "todo",
    ]
)

# The tokens that may begin a value.
VALUE_STARTS = frozenset(
    ["NAME", "NUMBER", "STRING", "CALL", "(", "[", "true", "false", "True", "False", "if", "not"]
)

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

# A word that begins statements elsewhere: advice, and the word to put in its place if any.
FOREIGN_WORDS: dict[str, tuple[str, str | None]] = {
    "def": ("functions are defined as `fn f(x) = 2 * x`", "fn"),
    "function": ("functions are defined as `fn f(x) = 2 * x`", "fn"),
    "func": ("functions are defined as `fn f(x) = 2 * x`", "fn"),
    "fun": ("functions are defined as `fn f(x) = 2 * x`", "fn"),
    "const": ("a name for a value is given by `let`", "let"),
    "val": ("a name for a value is given by `let`", "let"),
    "number": ("values have no type before their name; write `let`", "let"),
    "float": ("values have no type before their name; write `let`", "let"),
    "int": ("values have no type before their name; write `let`", "let"),
    "double": ("values have no type before their name; write `let`", "let"),
    "parameter": ("a parameter is declared by `param`", "param"),
    "variable": ("an unknown is declared by `var`", "var"),
    "elif": ("write `else if`", "else if"),
    "elseif": ("write `else if`", "else if"),
    "foreach": ("write `for i in 0..9 { … }`", "for"),
    "while": ("programs repeat with `for i in 0..9 { … }`", None),
    "return": ("a function is one expression: `fn f(x) = 2 * x`", None),
    "class": ("what is made more than once is a template: `solid washer(outer = 20) { … }`", None),
    "with": ("a structure is written `solid base { … }`", None),
    "struct": ("a structure begins with its kind: `solid washer { … }`", None),
    "include": ("other files are named by `import \"file.aidl\"`", "import"),
    "use": ("other files are named by `import \"file.aidl\"`", "import"),
    "from": ("names are imported as `import a, b from \"file.aidl\"`", None),
    "print": ("what holds is stated by `assert`; the solved model shows every value", None),
    "require": ("what must hold is stated by `constrain` or checked by `assert`", "constrain"),
    "ensure": ("what must hold is stated by `constrain` or checked by `assert`", "constrain"),
    "constraints": ("constraints stand in `constrain { … }`", "constrain"),
    "end": ("a block ends with `}`", None),
}  # fmt: skip
TWO_WAYS = frozenset({"require", "ensure"})
"""Words above that may also be meant otherwise."""

_EXAMPLES = {
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


def example(word: str) -> str:
    """Returns the use of a word of the language, with an example."""
    return _EXAMPLES.get(word, "")


def describe(token: Token) -> str:
    """Returns the name of a token in a message."""
    if token.kind == END:
        return "the end of the file"
    if token.kind == "CALL":
        return f"the call `{token.text}…)`"
    if token.kind == "STRING":
        return "this text"
    return f"`{token.text}`"
