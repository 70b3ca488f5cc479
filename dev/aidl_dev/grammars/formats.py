"""The export formats and how each is built."""

from __future__ import annotations

from aidl_dev.grammars.descent import from_left_to_right
from aidl_dev.grammars.notation import (
    Chars,
    Name,
    Node,
    Repeat,
    Rules,
    Seq,
    Text,
    alt,
    optional,
    reachable,
    seq,
)
from aidl_dev.grammars.reader import read_rules
from aidl_dev.grammars.spacing import spaced
from aidl_dev.grammars.terminals import SPACING, bounded_terminals, reading_terminals
from aidl_dev.grammars.writing import GBNF, LARK, W3C
from aidl_lang.syntax.tables import KINDS

# Lines without three backticks, and the opening of a block.
_TICKS = optional(alt(Text("`"), Text("``")))
_LINES = optional(seq(Repeat(seq(_TICKS, Chars("^`")), 0, None), _TICKS, Chars("\\n")))
_OPENING = seq(_LINES, Text("```aidl"), optional(Chars("\\r")), Chars("\\n"))


FOLDER = "aidl_lang/tools/grammars"


def texts() -> dict[str, str]:
    """Returns every export by its path in a checkout."""
    found = {"ebnf": for_readers()}
    for format in ("llguidance", "gbnf"):
        found |= {format: for_decoding(format, False), f"{format}-fenced": for_decoding(format, True)}
    return {f"{FOLDER}/{name}.txt": text for name, text in found.items()}


def for_readers() -> str:
    """Returns W3C EBNF: the rules of the source, without white space."""
    return W3C.definitions(read_rules()) + "\n" + W3C.definitions(reading_terminals())


def for_decoding(format: str, fenced: bool) -> str:
    """Returns a grammar with bounded terminals, white space in the rules, and only existing kinds of
    structures.
    """
    rules = spaced(_with_kinds(read_rules()), "module") | SPACING
    program = seq(optional(Name("heading")), Name("module"))
    if fenced:
        rules["start"] = seq(Name("OPENING"), program, Name("new_line"), Text("```"), optional(Name("SPACE")))
    else:
        rules["start"] = seq(program, optional(Name("gap")))
    terminals = {**bounded_terminals(), "OPENING": _OPENING}
    if format == "gbnf":
        return GBNF.definitions(reachable(from_left_to_right(rules) | terminals, "start"))
    used = reachable(rules | terminals, "start")
    return "%llguidance {}\n\n" + LARK.definitions(used)


def _with_kinds(rules: Rules) -> dict[str, Node]:
    """Returns the rules with the kinds of structures in the place of any name; the parser refuses others."""
    return {
        **rules,
        "kind": alt(*map(Text, KINDS)),
        **{
            name: _first_replaced(rules[name], Name("NAME"), Name("kind"))
            for name in ("structure", "template")
        },
    }


def _first_replaced(node: Node, old: Node, new: Node) -> Node:
    """Returns a sequence with its first item of one sort replaced."""
    if not isinstance(node, Seq):
        raise TypeError(f"not a sequence: {node}")
    at = node.items.index(old)
    return seq(*node.items[:at], new, *node.items[at + 1 :])
