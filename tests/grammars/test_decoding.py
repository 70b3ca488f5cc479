"""What engines for constrained decoding make of the exported grammar, beside what the parser does."""

from __future__ import annotations

import random

import pytest

from aidl_lang.common.source import SourceFile
from aidl_lang.syntax.automaton import Automaton
from aidl_lang.syntax.tables import END, KINDS, Token, load_tables, tokenize
from aidl_lang.syntax.tree import Builder
from aidl_lang.tools.reference import guide
from tests.amount import some, tried
from tests.grammars.engines import all_programs, engine, syntax_errors


def short_programs() -> list[str]:
    texts = some([text for text in all_programs().values() if 40 < len(text) < 1500], 6)
    return [text for text in texts if not syntax_errors(text)]


def test_every_program_is_taken_to_its_end_or_not_at_all_as_by_the_parser() -> None:
    assert len(all_programs()) > 500
    different = {}
    for place, text in some([*all_programs().items()], 40):
        taken, of, accepted = engine().takes(text)
        if accepted == bool(syntax_errors(text)):
            different[place] = (taken, of)
    assert different == {}


# --- Mutants --------------------------------------------------------------------------------------


def mutant(rng: random.Random, tokens: list[Token]) -> list[str]:
    """The texts of the tokens with one change."""
    texts = [token.text for token in tokens]
    at = rng.randrange(len(texts))
    other = rng.choice(texts)
    brackets = [i for i, text in enumerate(texts) if text[-1] in "()[]{}"]
    names = [i for i, token in enumerate(tokens) if token.kind == "NAME"]
    match rng.choice(["left out", "doubled", "swapped", "replaced", "bracket", "keyword", "cut"]):
        case "left out":
            del texts[at]
        case "doubled":
            texts.insert(at, texts[at])
        case "swapped":
            after = min(at + 1, len(texts) - 1)
            texts[at], texts[after] = texts[after], texts[at]
        case "replaced":
            texts[at] = other
        case "bracket" if brackets:
            del texts[rng.choice(brackets)]
        case "keyword" if names:
            texts[rng.choice(names)] = rng.choice(sorted(load_tables().reserved))
        case _:
            texts = texts[: at + 1]
    return texts


def laid_out(texts: list[str]) -> str:
    """White space between all tokens, and as the parser wants it before a `(`."""
    return "".join(("\n" if text == "(" else " ") + text for text in texts).lstrip()


def unexpected(text: str) -> tuple[Token, list[Token]] | None:
    """The first token that cannot stand where it does, and all tokens; before any mending."""
    source = SourceFile("", text)
    tokens = tokenize(source)
    automaton = Automaton(Builder(source, tokens.docs))
    wrong = next((token for token in tokens.tokens if not automaton.feed(token)), None)
    return (wrong, tokens.tokens) if wrong else None


def refused_byte(text: str) -> int:
    """The first byte that cannot be taken; the length where all can but the text must go on."""
    tokens = engine().vocabulary(text)
    matcher = engine().matcher()
    taken = matcher.try_consume_tokens(tokens)
    before = len(engine().vocabulary.text(tokens[:taken]).encode())
    if taken == len(tokens):
        assert not matcher.is_accepting()
        return before
    within = list(engine().vocabulary.tokens[tokens[taken]])
    bytes_taken = matcher.try_consume_tokens(within)
    assert bytes_taken < len(within), "the token could have been taken"
    return before + bytes_taken


def stricter_here(tokens: list[Token], at: int) -> bool:
    """Where the export takes less than the language: kinds of structures, and words that may be keywords."""
    token, before = tokens[at], tokens[at - 1]
    wrong_kind = token.kind in ("NAME", "CALL") and before.kind == "NAME" and before.text not in KINDS
    wrong_kind |= token.kind == "NAME" and before.kind == "template" and token.text not in KINDS
    return wrong_kind or token.kind in load_tables().soft_words or before.kind in load_tables().soft_words


def mutants(count: int) -> list[tuple[str, Token, list[Token]]]:
    """So many texts that the parser refuses for their syntax, each with the token that it refuses."""
    rng, short = random.Random(1), short_programs()
    found: list[tuple[str, Token, list[Token]]] = []
    while len(found) < count:
        tokens = [t for t in tokenize(SourceFile("", rng.choice(short))).tokens if t.kind != END]
        text = laid_out(mutant(rng, tokens))
        if refused := unexpected(text):
            found.append((text, *refused))
    return found


def test_mutants_are_refused_at_the_token_that_the_parser_refuses() -> None:
    """The byte at which the engine stops is one of the refused token, or the one behind it.

    Behind it where the token itself could still have become another: `constrain` may be the beginning of a
    name.
    """
    cases = mutants(tried(1000))
    different = []
    for text, wrong, tokens in cases:
        refused = refused_byte(text)
        start, end = (len(text[:offset].encode()) for offset in (wrong.start, wrong.end))
        if not start <= refused <= end:
            offset = len(text.encode()[:refused].decode(errors="ignore"))
            at = next(i for i, token in enumerate(tokens) if offset <= token.end)
            different.append((text, wrong, offset, stricter_here(tokens, at)))
    assert [case for case in different if not case[3]] == []
    assert len(different) <= len(cases) // 15


# --- Particular places ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        "x = 0..9", "x = 0.5..1", "x = 2.y", "x = 1e3mm", "let a = -b", "constrain !(a or b)",
        "constrain ! a == b",
        "// only a comment\n", "", "\n\n", "a = b;c = d", "solid s { }", "solid s{a = b}",
        "constrain {a == b,c == d}",
        "let größe = 3", "path(from: a)", "let a = b\n(c - d).x == 3", "constrain { (a - b).x == 3 }",
        "/// doc\n\n// more\nsolid s { } // end\n",
    ],
)  # fmt: skip
def test_taken_by_both(text: str) -> None:
    assert engine().takes(text)[2]
    assert syntax_errors(text) == []


@pytest.mark.parametrize(
    "text",
    [
        "let constrain = 3", "at = 3", "x = 3y = 4", "x = 0...5", "x = f (3)", "letx", "let x = 3 if",
        "solidd s { }",
        "alias a = b(c).x == 3", "x = 3 4 5", "import a", "constrain {", "a = 'b", "/* open",
        "x = 3 // no end of line",
        "then = 4", "x = 3.", "for i in 0..9 ( a )",
    ],
)  # fmt: skip
def test_not_taken(text: str) -> None:
    assert not engine().takes(text)[2]


def test_a_block_begins_on_a_line_of_its_own() -> None:
    block = "```aidl\nsolid plate {\n    outline = rectangle(center: origin, width: 60, height: 40)\n}\n```"
    assert engine(fenced=True).takes(f"Here it is:\n\n{block}")[2]
    assert not engine(fenced=True).takes(f"Here it is: {block}")[2]


@pytest.mark.parametrize("piece", ["\n", " ", "// loop\n", "\n// loop\n", "//", "x", "1"])
def test_nothing_outside_brackets_and_statements_goes_on_for_ever(piece: str) -> None:
    text = "x = a " + 5000 * piece
    taken, of, _ = engine().takes(text)
    assert taken < of


TOKENS = 8000
"""What the guide may take of a model's attention."""


def test_the_guide_is_short_enough() -> None:
    assert len(engine().vocabulary(guide())) <= TOKENS
