"""The tables are made of the grammar once, and kept as data."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable

from lark import Lark, Token, Tree

from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax.automaton import Automaton
from aidl_lang.syntax.tables import tokenize
from tests.amount import some
from tests.grammars.engines import all_programs

GRAMMAR = resource("grammar/aidl.lark").read_text(encoding="utf-8")


class Trees:
    """A builder that makes what Lark does."""

    def span(self, start: int, end: int) -> None:
        pass

    def __getattr__(self, name: str) -> Callable[..., Tree[Token]]:
        return lambda at, *parts: Tree(name.rstrip("_"), list(parts))


def test_what_was_kept_reads_as_what_is_built() -> None:
    """The same trees as by Lark from the grammar, which it takes strictly, with its lexer that knows what may
    stand where.
    """
    built = Lark(GRAMMAR, parser="lalr", strict=True, start="module", maybe_placeholders=False)
    programs = some([*all_programs().values()], 16)
    right = [text for text in programs if not parse(SourceFile("", text)).diagnostics]
    assert len(right) > 30
    for text in right:
        automaton = Automaton(Trees())
        assert all(map(automaton.feed, tokenize(SourceFile("", text)).tokens))
        assert automaton.made == built.parse(text)


def test_nothing_is_worked_out_or_unpickled_to_parse() -> None:
    program = (
        "from aidl_lang.parser import parse; from aidl_lang.common.source import SourceFile;"
        "import lark.lark;"
        "from aidl_lang.syntax.tables import load_tables; load_tables(); load_tables.cache_clear();"
        "lark.lark.load_grammar = lark.lark.pickle = None;"
        "print(len(parse(SourceFile('', 'let a = 3')).module.statements))"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["1"]
