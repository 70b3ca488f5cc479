"""All the words of the language by class, for colouring and completion.

Each list comes from where its words are defined: the grammar, the kinds, the units, what is built in and the
library. What is said here is only to which class a word of the grammar belongs; `unclaimed` names the words
that no class has.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields
from functools import cache

from aidl_lang.checking import builtins, library
from aidl_lang.checking.types import PARAMETER_TYPES, PUBLIC
from aidl_lang.checking.units import UNITS
from aidl_lang.common.records import record
from aidl_lang.syntax.tables import KIND_OF_WORD, KINDS, load_tables
from aidl_lang.tools.reference.collect import reference

_KEYWORDS: Mapping[str, str] = {
    "declarations": "param var let fn shape constraint alias",
    "demands": "constrain prefer assert todo",
    "modifiers": "construction template",
    "control": "for if else then",
    "imports": "import from as",
    "clauses": "at rotated in step weight",
    "word_operators": "and or not",
    "truths": "true false True False",
}

_SIGNS: Mapping[str, str] = {
    "comparisons": "== != <= >= < >",
    "arithmetic": "+ - * / % ^ **",
    "logic": "! && ||",
    "ranges": ".. ..<",
    "assignments": "=",
    "brackets": "( ) [ ] { }",
    "punctuation": ", ; : .",
    "attribute_signs": "@",
}

_EXACTNESS = "exactness"
"""The topic of what says whether a number may change."""

_SORTS = {"shape": "shapes", "function": "functions", "template": "templates", "constant": "constants"}
_SORTS |= {"constraint": "constraints", "relation": "relations"}


@record()
class Vocabulary:
    """The words by class. No keyword and no sign is in two classes, nor is a name of the library; a name may
    well be a kind, a parameter's type and a bare word besides.

    Keywords:
    declarations    begin a statement that gives a name: `param`, `fn`
    demands         begin one that asks for something: `constrain`, `assert`
    modifiers       stand before a definition: `construction`
    control, imports, word_operators, truths
    clauses         stand inside a statement: `at`, `step`
    statements      the words of the classes above that may begin a statement
    reserved        those that are never names

    Signs: comparisons, arithmetic, logic, ranges, assignments, brackets, punctuation, attribute_signs.

    Fixed words that are no keywords:
    kinds           the four kinds of structure
    kind_words      what may stand for them, themselves included
    attributes      what may stand behind `@`
    units           what may touch a number
    types           what may stand behind `:` in a parameter, beside the names of shapes
    everywhere      names that every structure has: `origin`
    modules         namespaces of other languages: `math`
    bare_words      words that may stand as an argument: `axis: x`

    Names that are called; what the library adds to a name that is built in goes with it:
    primitives      `circle`
    operations      `offset`, `move`, `grid`
    exactness       `fixed`
    built_in        the other built-in functions: `sin`, `len`
    shapes, templates, constraints, functions
    relations       constraints on boxes: `above`

    constants       of the library: `pi`
    synonyms        (other word, name in one of the classes above)
    helpers         names for the library's own use, its synonyms for them among these
    """

    declarations: tuple[str, ...]
    demands: tuple[str, ...]
    modifiers: tuple[str, ...]
    control: tuple[str, ...]
    imports: tuple[str, ...]
    clauses: tuple[str, ...]
    word_operators: tuple[str, ...]
    truths: tuple[str, ...]
    reserved: tuple[str, ...]
    statements: tuple[str, ...]
    comparisons: tuple[str, ...]
    arithmetic: tuple[str, ...]
    logic: tuple[str, ...]
    ranges: tuple[str, ...]
    assignments: tuple[str, ...]
    brackets: tuple[str, ...]
    punctuation: tuple[str, ...]
    attribute_signs: tuple[str, ...]
    kinds: tuple[str, ...]
    kind_words: tuple[str, ...]
    attributes: tuple[str, ...]
    units: tuple[str, ...]
    types: tuple[str, ...]
    everywhere: tuple[str, ...]
    modules: tuple[str, ...]
    bare_words: tuple[str, ...]
    primitives: tuple[str, ...]
    operations: tuple[str, ...]
    exactness: tuple[str, ...]
    built_in: tuple[str, ...]
    shapes: tuple[str, ...]
    templates: tuple[str, ...]
    constraints: tuple[str, ...]
    relations: tuple[str, ...]
    functions: tuple[str, ...]
    constants: tuple[str, ...]
    synonyms: tuple[tuple[str, str], ...]
    helpers: tuple[str, ...]

    @property
    def keywords(self) -> tuple[str, ...]:
        """The keywords of the grammar."""
        return tuple(word for name in _KEYWORDS for word in getattr(self, name))

    @property
    def signs(self) -> tuple[str, ...]:
        """The signs of the grammar."""
        return tuple(sign for name in _SIGNS for sign in getattr(self, name))

    def to_dict(self) -> dict[str, object]:
        """Returns the form in JSON: every class by its name."""
        lists = {f.name: list(getattr(self, f.name)) for f in fields(self)}
        return {**lists, "synonyms": dict(self.synonyms)}

    def named(self) -> dict[str, str]:
        """Returns every public and built-in name, with the name of its class; a synonym has that of its
        meaning.
        """
        found = {word: name for name in NAMES for word in getattr(self, name)}
        return {**found, **{word: found[target] for word, target in self.synonyms}}


NAMES = (
    *("primitives", "operations", "exactness", "built_in", "shapes", "templates"),
    *("constraints", "relations", "functions", "constants"),
)
"""The classes of names that a program may use without defining them."""


@cache
def vocabulary() -> Vocabulary:
    """Returns the words of this installation."""
    tables = load_tables()
    words = tables.reserved | tables.soft_words
    starts = {tables.kinds.get(name) for state in tables.statement_states for name in tables.states[state]}
    signs = tables.types.keys() - words
    keywords = {name: _present(listed, words) for name, listed in _KEYWORDS.items()}
    named = _named()
    known = {word for members in named.values() for word in members}
    synonyms = {word: target for word, target in reference().aliases.items() if word not in known}
    loaded = library.load()
    defined = (*builtins.SIGNATURES, *loaded.callables, *loaded.constants, *loaded.aliases)
    return Vocabulary(
        **keywords,
        **{name: _present(listed, signs) for name, listed in _SIGNS.items()},
        **named,
        statements=tuple(word for members in keywords.values() for word in members if word in starts),
        reserved=tuple(sorted(tables.reserved)),
        kinds=KINDS,
        kind_words=tuple(KIND_OF_WORD),
        attributes=builtins.ATTRIBUTES,
        units=(*UNITS, *_unit_signs()),
        types=tuple(PARAMETER_TYPES),
        everywhere=builtins.EVERYWHERE,
        modules=builtins.MATH,
        bare_words=tuple(sorted(builtins.WORDS)),
        synonyms=tuple(sorted(synonyms.items())),
        helpers=tuple(sorted({word for word in defined if word not in known and word not in synonyms})),
    )


def unclaimed() -> frozenset[str]:
    """Returns words and signs of the grammar without a class: empty unless somebody is changing the
    grammar.
    """
    claimed = {
        word for classes in (_KEYWORDS, _SIGNS) for listed in classes.values() for word in listed.split()
    }
    return frozenset(load_tables().types) - claimed


def _present(listed: str, words: Iterable[str]) -> tuple[str, ...]:
    """Returns the words of a list that the grammar has; it may have lost one."""
    there = frozenset(words)
    return tuple(word for word in listed.split() if word in there)


def _unit_signs() -> tuple[str, ...]:
    """Returns the units that are no words, as the number of the grammar has them."""
    alternatives = load_tables().patterns["NUMBER"].rpartition("(")[2].rstrip("?").rstrip(")").split("|")
    return tuple(unit for unit in alternatives if not unit.isidentifier())


def _named() -> dict[str, tuple[str, ...]]:
    """Returns the public names by class, in the order of the reference."""
    found: dict[str, list[str]] = {name: [] for name in NAMES}
    for entry in reference().entries.values():
        if entry.sort != "word":
            found[_class(entry.name, entry.sort, entry.topic)].append(entry.name)
    return {name: tuple(members) for name, members in found.items()}


def _class(name: str, sort: str, topic: str) -> str:
    if sort in _SORTS:
        return _SORTS[sort]
    if name in PUBLIC:
        return "primitives"
    if name in builtins.DERIVING | builtins.PATTERNS | builtins.FINISHES:
        return "operations"
    return "exactness" if topic == _EXACTNESS else "built_in"
