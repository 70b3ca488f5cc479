"""Each format is complete, the same every time, and read by a tool that is made for it."""

from __future__ import annotations

import re

import pytest
from llguidance.gbnf_to_lark import gbnf_to_lark

from aidl_lang.common.resources import resource
from aidl_lang.syntax.tables import load_tables
from aidl_lang.tools.grammars import FENCED_FORMATS, FORMATS, export
from tests.amount import TRIES_ALL
from tests.grammars.engines import Engine, all_programs, syntax_errors
from tests.grammars.recogniser import Recogniser

SOURCE = resource("grammar/aidl.lark").read_text(encoding="utf-8")
RULES = set(re.findall(r"^[?!]*([a-z_]+):", SOURCE, flags=re.MULTILINE))
TOKENS = load_tables().types


def defined(text: str) -> set[str]:
    return set(re.findall(r"^([\w-]+)\s*(?:::=|:)", text, flags=re.MULTILINE))


def test_lark_is_the_source() -> None:
    assert export("lark") == SOURCE


@pytest.mark.parametrize("format", FORMATS)
def test_every_fixed_text_occurs(format: str) -> None:
    text = export(format)
    assert len(TOKENS) > 50
    assert [token for token in TOKENS if f'"{token}"' not in text] == []


def test_every_rule_occurs() -> None:
    for_readers = defined(export("ebnf"))
    assert {rule.lstrip("_") for rule in RULES} - for_readers == set()
    for_engine = {re.sub(r"_(after|ending)_\w+$", "", name) for name in defined(export("llguidance"))}
    assert RULES - for_engine == set()


@pytest.mark.parametrize("format", ["llguidance", "gbnf", "ebnf"])
def test_every_name_used_is_defined_once(format: str) -> None:
    text = export(format)
    plain = re.sub(r'"(?:[^"\\]|\\.)*"|' + r"'[^']*'|/\[(?:[^\]\\]|\\.)*\]/|\[(?:[^\]\\]|\\.)*\]", " ", text)
    names = re.findall(r"^([\w-]+)\s*(?:::=|:)", plain, flags=re.MULTILINE)
    assert len(names) == len(set(names))
    used = set(re.findall(r"[A-Za-z_][\w-]*", re.sub(r"%llguidance", " ", plain)))
    assert used == set(names)


@pytest.mark.parametrize("fenced", [False, True])
@pytest.mark.parametrize("format", FENCED_FORMATS)
def test_names_are_no_reserved_words(format: str, fenced: bool) -> None:
    """The rule for names alone, asked of the engine."""
    text = export(format, fenced)
    text = gbnf_to_lark(text) if format == "gbnf" else text
    name = re.search(r"^NAME:.*?(?=\n\w+:)", text, flags=re.MULTILINE | re.DOTALL)
    assert name
    words = Engine(f"start: NAME\n{name[0]}\n")
    reserved = load_tables().reserved
    assert [word for word in reserved if words.takes(word)[2]] == []
    near = {word + end for word in reserved for end in ("s", "_", "0", "é")}
    near |= {word[:n] for word in reserved for n in range(1, len(word))}
    near |= {word[:n] + "q" + word[n + 1 :] for word in reserved for n in range(len(word))}
    near |= {word.capitalize() for word in reserved}
    assert [word for word in near - reserved - load_tables().soft_words if not words.takes(word)[2]] == []


def test_letters_of_names_are_letters_to_the_parser() -> None:
    name = re.search(r"^NAME ::= \[(.*?)\]", export("gbnf"), flags=re.MULTILINE)
    assert name
    ranges = re.findall(r"([^\x00-\x7f])-([^\x00-\x7f])", name[1])
    letters = [chr(n) for a, b in ranges for n in range(ord(a), ord(b) + 1)]
    assert len(letters) > 400
    assert [letter for letter in letters if not re.fullmatch(r"[^\W\d]", letter)] == []


@pytest.fixture(scope="module")
def gbnf() -> Recogniser:
    return Recogniser(export("gbnf"))


def test_gbnf_takes_the_same_programs(gbnf: Recogniser) -> None:
    short = [text for _, text in sorted(all_programs().items()) if len(text) < 300]
    texts = short[:: 20 if TRIES_ALL else 60]
    assert len(texts) > 5
    assert [text for text in texts if gbnf.takes(text) == bool(syntax_errors(text))] == []


@pytest.mark.slow  # it takes as many steps as all of the above
def test_gbnf_takes_a_long_program(gbnf: Recogniser) -> None:
    assert gbnf.takes(all_programs()["examples/bottle_opener.aidl"])


def test_gbnf_keeps_few_ways_open(gbnf: Recogniser) -> None:
    """Nesting does not multiply them."""
    deep = Recogniser(export("gbnf"))
    shallow = Recogniser(export("gbnf"))
    assert deep.takes("x = " + "f([(" * 8 + "1" + ")])" * 8 + "\n")
    assert shallow.takes("x = " + "f([(" * 4 + "1" + ")])" * 4 + "\n")
    assert deep.most <= 2 * shallow.most


@pytest.mark.parametrize(
    "text",
    ["letx", "x = 3y = 4", "let at = 3", "x = f (3)", "x = 0...5", "solid s {", "solidd s { }", "x = ((1)"],
)
def test_gbnf_refuses(gbnf: Recogniser, text: str) -> None:
    assert not gbnf.takes(text)


def test_gbnf_fenced() -> None:
    fenced = Recogniser(export("gbnf", fenced=True))
    assert fenced.takes("So:\n```aidl\nsolid s { }\n```\n")
    assert not fenced.takes("So:\nsolid s { }\n")


def test_the_converter_of_llguidance_reads_gbnf() -> None:
    Engine(gbnf_to_lark(export("gbnf")))


def test_what_is_not_there_raises() -> None:
    with pytest.raises(ValueError, match="bnf"):
        export("bnf")
    with pytest.raises(ValueError, match="lark"):
        export("lark", fenced=True)
