"""The grammar keeps to what every engine takes, and is the same to Lark and to the parser."""

from __future__ import annotations

import re

import pytest
from lark import Lark

from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax.tables import load_tables, tokenize

GRAMMAR = resource("grammar/aidl.lark").read_text(encoding="utf-8")
RULES = "\n".join(line for line in GRAMMAR.splitlines() if not line.startswith("//"))
WORDS = """
param var let constrain prefer assert for in if else import shape fn constraint alias template construction
step weight todo at rotated and or not true false
"""
RESERVED = WORDS.split()


@pytest.mark.parametrize(
    ("feature", "pattern"),
    [
        ("terminal priority", r"^[A-Z_]+\.\d"),
        ("rule priority", r"^[a-z_?!]+\.\d"),
        ("template", r"^\??\w+\{"),
        ("directive other than %ignore", r"^%(?!ignore)"),
        ("look-around", r"\(\?[=!<]"),
        ("word boundary", r"\\[bB]"),
        ("back-reference", r"\\[1-9]"),
        ("lazy repetition", r"/.*(?<!\\)[*+}]\?.*/"),
        ("flags", r"/[imslux]+\s*$"),
    ],
)
def test_it_avoids(feature: str, pattern: str) -> None:
    found = [line for line in RULES.splitlines() if re.search(pattern, line)]
    assert not found, feature


def test_the_reserved_words() -> None:
    assert sorted(load_tables().reserved) == sorted(RESERVED)


def _words() -> list[str]:
    """Each reserved word, its beginnings, and words one letter away from it."""
    near = {word[:i] for word in RESERVED for i in range(1, len(word))}
    near |= {word + tail for word in RESERVED for tail in ("s", "_", "0", "é")}
    near |= {word[:i] + "q" + word[i + 1 :] for word in RESERVED for i in range(len(word))}
    return sorted(near | set(RESERVED) | {"x", "Circle", "größe", "_a", "True", "If"})


def test_a_call_is_a_name_that_is_not_reserved() -> None:
    call = re.compile(Lark(GRAMMAR, start="module").get_terminal("CALL").pattern.to_regexp())
    for word in _words():
        matched = call.match(word + "(")
        assert (matched is not None and matched.end() == len(word) + 1) == (word not in RESERVED), word


def test_the_scanner_reads_calls_as_the_grammar_does() -> None:
    soft = load_tables().soft_words
    for word in _words():
        kinds = [token.kind for token in tokenize(SourceFile("", word + "(")).tokens]
        assert (kinds[0] == "CALL") == (word not in RESERVED), word
        assert not soft & set(RESERVED)


@pytest.mark.parametrize(
    "word", ["then", "as", "from", "above", "solid", "hole", "mm", "deg", "self", "origin"]
)
def test_other_words_are_names(word: str) -> None:
    text = f"let {word} = 3\nlet b = {word} + 1\n{word} = circle(radius: {word})\nconstrain {word} == 3"
    assert not parse(SourceFile("", text)).diagnostics
