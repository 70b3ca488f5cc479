"""The terminals of the grammar, bounded where the language itself sets no limit.

Small models repeat themselves: a comment, blank lines, the digits of a number or the letters of a name
without end. Every repetition inside a terminal is bounded here, and what a model has no need of is left
out: comments other than `//`, numbers that begin with a point, and letters beyond the Latin and Greek ones.
All of it is part of what the language takes; the reverse does not hold.
"""

from __future__ import annotations

import string
from collections.abc import Iterable

from aidl_dev.grammars.notation import Alt, Chars, Name, Node, Repeat, Text, alt, optional, seq
from aidl_lang.syntax.tables import load_tables

UNITS = ("mm", "cm", "m", "in", "ft", "deg", "rad", "turn", "°")

_DECIMALS = string.digits
_ASCII = string.ascii_letters + _DECIMALS + "_"
_LETTERS = "À-ÖØ-öø-ɏΑ-ΡΣ-Ωα-ω"  # beside those
_MOST_LETTERS = 40  # of a name
_MOST_DIGITS = 17  # on each side of the point
_MOST_CHARACTERS = 200  # of a string or a comment
_MOST_COMMENTS = 20  # lines in a row
_MOST_BLANKS = 60  # in a row
_MOST_NEWLINES = 3  # in a row


def _members(characters: set[str]) -> str:
    """Returns the inside of a class of characters, as ranges."""
    runs: list[str] = []
    for character in sorted(characters):
        if runs and ord(runs[-1][-1]) + 1 == ord(character):
            runs[-1] += character
        else:
            runs.append(character)
    return "".join(run if len(run) < 3 else f"{run[0]}-{run[-1]}" for run in runs)


_REST = Repeat(Chars(_members(set(_ASCII)) + _LETTERS), 0, _MOST_LETTERS)  # of a name
_DIGITS = Repeat(Chars("0-9"), 1, _MOST_DIGITS)
_EXPONENT = seq(Chars("eE"), optional(Chars("+-")), Repeat(Chars("0-9"), 1, 2))
_SCALE = seq(optional(_EXPONENT), optional(Alt(tuple(map(Text, UNITS)))))
_BLANKS = Chars(" \\t")
_NEWLINES = Repeat(
    seq(optional(Chars("\\r")), Chars("\\n"), Repeat(_BLANKS, 0, _MOST_BLANKS)), 1, _MOST_NEWLINES
)


def _quoted(quote: str) -> Node:
    inner = alt(Chars(f"^{quote}\\\\\\n"), seq(Text("\\"), Chars("^\\n")))
    return seq(Text(quote), Repeat(inner, 0, _MOST_CHARACTERS), Text(quote))


def bounded_terminals() -> dict[str, Node]:
    """Returns the terminals of the source, and those that only exports have.

    A number is a rule rather than a terminal. Engines without backtracking in their lexers could not go
    back over the point in `0..9`: WHOLE ends before a point, and FRACTION begins with it.
    """
    name = _names_without(load_tables().reserved | _taken_soft_words())
    return {
        "NAME": name,
        "CALL": seq(name, Text("(")),
        "WHOLE": seq(_DIGITS, _SCALE),
        "DIGITS": _DIGITS,
        "FRACTION": seq(Text("."), _DIGITS, _SCALE),
        "STRING": alt(_quoted('"'), _quoted("'")),
        "SPACE": alt(seq(Repeat(_BLANKS, 1, _MOST_BLANKS), optional(_NEWLINES)), _NEWLINES),
        "BREAK": seq(Repeat(_BLANKS, 0, _MOST_BLANKS), _NEWLINES),
        "COMMENT": seq(Text("//"), Repeat(Chars("^\\n"), 0, _MOST_CHARACTERS), Chars("\\n")),
    }


_COMMENTS = seq(Name("COMMENT"), optional(Name("SPACE")))

SPACING: dict[str, Node] = {
    "number": alt(Name("WHOLE"), seq(Name("DIGITS"), Name("FRACTION"))),
    "gap": seq(Name("SPACE"), Repeat(_COMMENTS, 0, _MOST_COMMENTS)),
    "new_line": seq(Name("BREAK"), Repeat(_COMMENTS, 0, _MOST_COMMENTS)),
    "heading": Repeat(_COMMENTS, 1, _MOST_COMMENTS),
}
"""Rules made of the terminals; `new_line` is a gap with the end of a line in it."""


def reading_terminals() -> dict[str, Node]:
    """Returns the terminals by their own names, without those that rules name as literals."""
    bounded = bounded_terminals()
    return {
        "NAME": seq(Chars(_members(set(_ASCII) - set(_DECIMALS)) + _LETTERS), _REST),
        "CALL": seq(Name("NAME"), Text("(")),
        "NUMBER": alt(bounded["WHOLE"], seq(bounded["DIGITS"], bounded["FRACTION"]), bounded["FRACTION"]),
        "STRING": bounded["STRING"],
        "COMMENT": bounded["COMMENT"],
    }


def _taken_soft_words() -> set[str]:
    """Returns the words that the parser reads as keywords in some place of a name."""
    tables = load_tables()
    rows = [row for row in tables.parsing.states.values() if "NAME" in row or "CALL" in row]
    return {word for word in tables.soft_words if any(tables.types[word] in row for row in rows)}


def _names_without(words: Iterable[str]) -> Node:
    """Returns names other than the given words, as those that leave each of them at some letter.

    Not all engines know the complement of an expression.
    """
    return _tails(sorted(words), is_first=True)


def _tails(words: list[str], is_first: bool = False) -> Node:
    """Returns what may follow a beginning, given the rests that would complete it to a word."""
    letters = set(_ASCII) - (set(_DECIMALS) if is_first else set())
    firsts = sorted({word[0] for word in words if word})
    choices: list[Node] = [seq(Chars(_members(letters - set(firsts)) + _LETTERS), _REST)]
    for first in firsts:
        longer = [word[1:] for word in words if word[:1] == first]
        choices.append(seq(Text(first), _tails(longer)))
    choice = alt(*choices)
    return choice if is_first or "" in words else optional(choice)
