"""The list of words: nothing of the grammar, of what is built in or of the library is without a class."""

from __future__ import annotations

import itertools
import re

from aidl_lang.checking import builtins, library
from aidl_lang.checking.builtins import CUTS
from aidl_lang.checking.units import UNITS
from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.tools.vocabulary import NAMES, vocabulary

WORDS = vocabulary()
GRAMMAR = resource("grammar/aidl.lark").read_text("utf-8")
KEYWORD_CLASSES = (
    *("declarations", "demands", "modifiers", "control", "imports", "clauses", "word_operators", "truths"),
)
SIGN_CLASSES = (
    *("comparisons", "arithmetic", "logic", "ranges", "assignments", "brackets", "punctuation"),
    "attribute_signs",
)


def literals() -> set[str]:
    """What stands in quotes in the rules of the grammar."""
    rules = [line for line in GRAMMAR.partition("// --- Terminals")[0].splitlines() if line[:2] != "//"]
    return set(re.findall(r'"([^"]+)"', "\n".join(rules)))


def test_every_word_and_sign_of_the_grammar_has_one_class() -> None:
    keywords = [word for name in KEYWORD_CLASSES for word in getattr(WORDS, name)]
    signs = [sign for name in SIGN_CLASSES for sign in getattr(WORDS, name)]
    assert sorted([*keywords, *signs]) == sorted(literals())
    assert WORDS.keywords == tuple(keywords)
    assert WORDS.signs == tuple(signs)


def test_statements_are_the_words_that_may_begin_one() -> None:
    tail = {
        "param": "a = 1", "var": "a = 1", "let": "a = 1", "fn": "f(x) = x", "shape": "s() { }",
        "constraint": "c(a) { }", "alias": "a = above", "constrain": "a == b", "prefer": "a == b",
        "assert": "a == b", "todo": "", "construction": "a = line(b, c)", "template": "solid t() { }",
        "for": "i in 0..1 { }", "if": "a { }", "import": '"a.aidl"',
    }  # fmt: skip
    assert set(tail) == set(WORDS.statements)
    for word, rest in tail.items():
        found = parse(SourceFile("", f"{word} {rest}")).diagnostics
        assert [d.message for d in found if d.is_error] == [], word
    others = set(WORDS.keywords) - set(WORDS.statements)
    assert others == {
        *("else", "then", "from", "as", "at", "rotated", "in", "step", "weight", "and", "or", "not"),
        *("true", "false", "True", "False"),
    }


def test_every_name_of_the_library_has_a_class() -> None:
    loaded = library.load()
    synonyms = [word for word, _ in WORDS.synonyms]
    public = itertools.chain.from_iterable(getattr(WORDS, name) for name in NAMES)
    listed = [*public, *synonyms, *WORDS.helpers]
    defined = {*builtins.SIGNATURES, *loaded.callables, *loaded.constants, *loaded.aliases}
    assert sorted(listed) == sorted(defined), "one class for each"
    assert set(WORDS.named()) == defined - set(WORDS.helpers)


def test_names_are_in_the_class_of_their_definition() -> None:
    """Told from the words that define them in the sources, without the parser."""
    text = "\n".join(path.read_text("utf-8") for path in sorted(resource("stdlib").glob("*.aidl")))
    shapes = set(re.findall(r"^shape (\w+)\(", text, re.MULTILINE))
    constraints = set(re.findall(r"^constraint (\w+)\(", text, re.MULTILINE))
    functions = set(re.findall(r"^fn (\w+)\(", text, re.MULTILINE))
    templates = set(re.findall(r"^(?:solid|hole|assembly|drawing) (\w+)\(", text, re.MULTILINE))
    assert set(WORDS.constraints) | set(WORDS.relations) <= constraints
    assert set(WORDS.templates) == templates - set(WORDS.helpers) - CUTS  # which are outlines as well
    assert set(WORDS.functions) <= functions
    assert set(WORDS.shapes) <= shapes | functions
    assert shapes <= {*WORDS.shapes, *WORDS.primitives, *WORDS.helpers}
    assert "circle" in WORDS.primitives
    assert {"fillet", "offset", "mirror", "move", "grid"} <= set(WORDS.operations)
    assert {"fixed", "guess"} <= set(WORDS.exactness)
    assert {"sin", "len"} <= set(WORDS.built_in)
    assert {"above", "centered_in"} <= set(WORDS.relations)
    assert {"tangent", "parallel"} <= set(WORDS.constraints)
    assert {"ring", "gear"} <= set(WORDS.shapes)
    assert dict(WORDS.synonyms)["annulus"] == "ring"


def test_units_are_those_of_the_grammar() -> None:
    number = re.compile(re.search(r"^NUMBER: /(.*)/$", GRAMMAR, re.MULTILINE)[1])
    assert all(number.fullmatch(f"5{unit}") for unit in WORDS.units)
    letters = [*map(chr, range(33, 0x250)), *("".join(p) for p in itertools.product("cdefgimnrtu", repeat=2))]
    taken = {s for s in letters if number.fullmatch(f"5{s}") and not s[0].isdigit() and s[0] != "."}
    assert taken <= set(WORDS.units)
    assert set(UNITS) <= set(WORDS.units)
    assert "°" in WORDS.units


def test_the_form_in_json_has_every_class() -> None:
    data = WORDS.to_dict()
    assert set(NAMES) | set(KEYWORD_CLASSES) | set(SIGN_CLASSES) < set(data)
    assert data["synonyms"]["annulus"] == "ring"
