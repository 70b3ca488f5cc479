"""Each format is complete, the same every time, and read by a tool that is made for it."""

from __future__ import annotations

import re

import pytest
from llguidance import LLMatcher
from llguidance.gbnf_to_lark import gbnf_to_lark

from aidl_lang.common.resources import resource
from aidl_lang.tools.grammars import export
from tests.amount import TRIES_ALL
from tests.grammars.engines import all_programs, syntax_errors
from tests.grammars.recogniser import Recogniser

SOURCE = resource("grammar/aidl.lark").read_text(encoding="utf-8")
RULES = set(re.findall(r"^[?!]*([a-z_]+):", SOURCE, flags=re.MULTILINE))


def defined(text: str) -> set[str]:
    return set(re.findall(r"^([\w-]+)\s*(?:::=|:)", text, flags=re.MULTILINE))


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


@pytest.fixture(scope="module")
def gbnf() -> Recogniser:
    return Recogniser(export("gbnf"))


def test_gbnf_takes_the_same_programs(gbnf: Recogniser) -> None:
    short = [text for _, text in sorted(all_programs().items()) if len(text) < (300 if TRIES_ALL else 80)]
    texts = short[:: 20 if TRIES_ALL else 30]
    assert len(texts) > 3
    assert [text for text in texts if gbnf.takes(text) == bool(syntax_errors(text))] == []


@pytest.mark.parametrize(
    "text",
    ["letx", "x = 3y = 4", "let at = 3", "x = f (3)", "x = 0...5", "solid s {", "solidd s { }", "x = ((1)"],
)
def test_gbnf_refuses(gbnf: Recogniser, text: str) -> None:
    assert not gbnf.takes(text)


def test_the_converter_of_llguidance_reads_gbnf() -> None:
    assert LLMatcher.validate_grammar(gbnf_to_lark(export("gbnf"))) == ""


def test_what_is_not_there_raises() -> None:
    with pytest.raises(ValueError, match="bnf"):
        export("bnf")
    with pytest.raises(ValueError, match="lark"):
        export("lark", fenced=True)
