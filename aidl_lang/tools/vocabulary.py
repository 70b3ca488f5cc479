"""All words of the language by class, each taken from where it is defined; snippets to write with them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import fields
from functools import cache

from aidl_lang.checking import builtins, library
from aidl_lang.checking.types import PARAMETER_TYPES, PUBLIC
from aidl_lang.checking.units import UNITS
from aidl_lang.common.records import record
from aidl_lang.syntax.tables import KIND_OF_WORD, KINDS, load_tables
from aidl_lang.tools.reference.collect import reference

# --- All the words of the language by class, for colouring and completion.
#
# Each list comes from where its words are defined: the grammar, the kinds, the units, what is built in and
# the library. What is said here is only to which class a word of the grammar belongs.

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
    """

    # Keywords
    declarations: tuple[str, ...]  # begin a statement that gives a name: `param`, `fn`
    demands: tuple[str, ...]  # begin one that asks for something: `constrain`, `assert`
    modifiers: tuple[str, ...]  # stand before a definition: `construction`
    control: tuple[str, ...]
    imports: tuple[str, ...]
    clauses: tuple[str, ...]  # stand inside a statement: `at`, `step`
    word_operators: tuple[str, ...]
    truths: tuple[str, ...]
    reserved: tuple[str, ...]  # those that are never names
    statements: tuple[str, ...]  # the words of the classes above that may begin a statement
    # Signs
    comparisons: tuple[str, ...]
    arithmetic: tuple[str, ...]
    logic: tuple[str, ...]
    ranges: tuple[str, ...]
    assignments: tuple[str, ...]
    brackets: tuple[str, ...]
    punctuation: tuple[str, ...]
    attribute_signs: tuple[str, ...]
    # Fixed words that are no keywords
    kinds: tuple[str, ...]  # the four kinds of structure
    kind_words: tuple[str, ...]  # what may stand for them, themselves included
    attributes: tuple[str, ...]  # what may stand behind `@`
    units: tuple[str, ...]  # what may touch a number
    types: tuple[str, ...]  # what may stand behind `:` in a parameter, beside the names of shapes
    everywhere: tuple[str, ...]  # names that every structure has: `origin`
    modules: tuple[str, ...]  # namespaces of other languages: `math`
    bare_words: tuple[str, ...]  # words that may stand as an argument: `axis: x`
    # Names that are called; what the library adds to a name that is built in goes with it
    primitives: tuple[str, ...]  # `circle`
    operations: tuple[str, ...]  # `offset`, `move`, `grid`
    exactness: tuple[str, ...]  # `fixed`
    built_in: tuple[str, ...]  # the other built-in functions: `sin`, `len`
    shapes: tuple[str, ...]
    templates: tuple[str, ...]
    constraints: tuple[str, ...]
    relations: tuple[str, ...]  # constraints on boxes: `above`
    functions: tuple[str, ...]
    constants: tuple[str, ...]  # of the library: `pi`
    synonyms: tuple[tuple[str, str], ...]  # (other word, name in one of the classes above)
    helpers: tuple[str, ...]  # names for the library's own use, its synonyms for them among these

    @property
    def keywords(self) -> tuple[str, ...]:
        return tuple(word for name in _KEYWORDS for word in getattr(self, name))

    @property
    def signs(self) -> tuple[str, ...]:
        return tuple(sign for name in _SIGNS for sign in getattr(self, name))

    def to_dict(self) -> dict[str, object]:
        """Returns the form in JSON: every class by its name."""
        lists = {f.name: list(getattr(self, f.name)) for f in fields(self)}
        return {**lists, "synonyms": dict(self.synonyms)}

    def named(self) -> dict[str, str]:
        """Returns every public and built-in name with its class; a synonym with that of its meaning."""
        found = {word: name for name in NAMES for word in getattr(self, name)}
        return {**found, **{word: found[target] for word, target in self.synonyms}}


NAMES = (
    *"primitives operations exactness built_in shapes templates".split(),
    *"constraints relations functions constants".split(),
)
"""The classes of names that a program may use without defining them."""


@cache
def vocabulary() -> Vocabulary:
    tables = load_tables()
    words = tables.reserved | tables.soft_words
    states = tables.parsing.states
    starts = {tables.kinds.get(name) for state in tables.statement_states for name in states[state]}
    signs = tables.types.keys() - words
    keywords = {name: _present(listed, words) for name, listed in _KEYWORDS.items()}
    named = _named()
    known = {word for members in named.values() for word in members}
    synonyms = {word: target for word, target in reference().aliases.items() if word not in known}
    loaded = library.load()
    defined = (*builtins.SIGNATURES, *loaded.callables, *loaded.constants, *loaded.aliases)
    alternatives = load_tables().patterns["NUMBER"].rpartition("(")[2].rstrip("?").rstrip(")").split("|")
    return Vocabulary(
        **keywords,
        **{name: _present(listed, signs) for name, listed in _SIGNS.items()},
        **named,
        statements=tuple(word for members in keywords.values() for word in members if word in starts),
        reserved=tuple(sorted(tables.reserved)),
        kinds=KINDS,
        kind_words=tuple(KIND_OF_WORD),
        attributes=builtins.ATTRIBUTES,
        units=(*UNITS, *(unit for unit in alternatives if not unit.isidentifier())),
        types=tuple(PARAMETER_TYPES),
        everywhere=builtins.EVERYWHERE,
        modules=builtins.MATH,
        bare_words=tuple(sorted(builtins.WORDS)),
        synonyms=tuple(sorted(synonyms.items())),
        helpers=tuple(sorted({word for word in defined if word not in known and word not in synonyms})),
    )


def _present(listed: str, words: Iterable[str]) -> tuple[str, ...]:
    """Returns the words of a list that the grammar has; it may have lost one."""
    there = frozenset(words)
    return tuple(word for word in listed.split() if word in there)


def _named() -> dict[str, tuple[str, ...]]:
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


# --- Beginnings of statements to be filled in, for editors.
#
# The bodies are in the syntax of the Language Server Protocol: `${1:text}` is a place to fill in, `$0` where
# the cursor rests in the end. With what is suggested at its places, each is a statement that the checker
# takes.

_PLACE = re.compile(
    r"\\([\\$}])"  # a sign that is meant as itself
    r"|\$\{(\d+)(?::((?:\\.|[^\\}])*)|\|((?:\\.|[^\\,|])*)[^|]*\|)?\}"  # with a text, or a choice of several
    r"|\$(\d+)"
)
_ESCAPED = re.compile(r"\\(.)")


@record()
class Snippet:
    """`prefix` is the text to type for it; `place` where it may stand: `file`, `block` (of a structure, or of
    the file), `constraints` or `attribute` (before a definition).
    """

    prefix: str
    title: str
    body: str
    place: str = "block"


def expanded(body: str) -> str:
    """Returns the text with all placeholders filled with their proposals, equal numbers alike."""
    given: dict[str, str] = {}
    for match in _PLACE.finditer(body):
        text = match[3] if match[3] is not None else match[4]
        if text is not None:
            given.setdefault(match[2], _ESCAPED.sub(r"\1", text))
    return _PLACE.sub(lambda match: match[1] or given.get(match[2] or match[5], ""), body)


SNIPPETS = (
    Snippet(
        "solid",
        "a solid: material",
        "solid ${1:plate} {\n\t${2:outline} = rectangle(width: ${3:60}, height: ${4:40})\n\t$0\n}",
    ),
    Snippet(
        "hole",
        "a hole in what is around it",
        "hole ${1:bore} {\n\t${2:rim} = circle(radius: ${3:5})\n\t$0\n}",
    ),
    Snippet(
        "assembly",
        "several solids, and how they lie to each other",
        "assembly ${1:stand} {\n"
        "\tsolid ${2:foot} {\n\t\tbody = rectangle(width: ${3:60}, height: ${4:10})\n\t}\n"
        "\tsolid ${5:post} {\n\t\tbody = rectangle(width: ${6:8}, height: ${7:80})\n\t}\n\n"
        "\tconstrain {\n\t\t${5:post}.${8:stacked_on}(${2:foot})\n\t}\n\t$0\n}",
    ),
    Snippet(
        "drawing",
        "lines on top",
        "drawing ${1:marks} {\n\t${2:stroke} = line((${3:0}, ${4:0}), (${5:40}, ${6:0}))\n\t$0\n}",
    ),
    Snippet(
        "template",
        "what is made more than once",
        "solid ${1:washer}(${2:outer} = ${3:20}, ${4:inner} = ${5:10}) {\n"
        "\trim = circle(center: origin, radius: ${2:outer} / 2)\n"
        "\thole bore {\n\t\trim = circle(center: origin, radius: ${4:inner} / 2)\n\t}\n}\n$0",
    ),
    Snippet("todo", "a part that is still to be drawn", "solid ${1:lid} { todo }$0"),
    Snippet("param", "a parameter with a range", "param ${1:width} = ${2:80}mm in ${3:40}..${4:160}$0"),
    Snippet(
        "params",
        "a parameter with a range in steps",
        "param ${1:count} = ${2:4} in ${3:2}..${4:12} step ${5:1}$0",
    ),
    Snippet(
        "choice", "a parameter with a few values", 'param ${1:bolt} = "${2:m5}" in ["${3:m4}", "${2:m5}"]$0'
    ),
    Snippet("let", "a name for a value", "let ${1:wall} = ${2:3mm}$0"),
    Snippet("var", "an unknown", "var ${1:gap} = ${2:5mm}$0"),
    Snippet("constrain", "a block of constraints", "constrain {\n\t$0\n}"),
    Snippet("prefer", "a wish", "prefer ${1:true} weight ${2:1}$0"),
    Snippet("assert", "a check of the result", 'assert ${1:true}, "${2:why it must hold}"$0'),
    Snippet("for", "a loop", "for ${1:i} in ${2:0}..${3:3} {\n\tlet ${4:x} = ${5:10} * ${1:i}\n\t$0\n}"),
    Snippet(
        "holes",
        "holes in a row",
        "for ${1:i} in ${2:0}..${3:3} {\n\thole ${4:bore}[${1:i}] {\n"
        "\t\trim = circle(center: (${5:20} * ${1:i}, 0), radius: ${6:3})\n\t}\n}\n$0",
    ),
    Snippet("if", "a choice", "if ${1:true} {\n\t$0\n}"),
    Snippet("ifelse", "a choice of two", "if ${1:true} {\n\t$2\n} else {\n\t$0\n}"),
    Snippet("fn", "a function", "fn ${1:half}(${2:x}) = ${2:x} / ${3:2}$0", "file"),
    Snippet(
        "shape",
        "a shape of your own",
        "/// ${1:What it is.}\nshape ${2:cross_mark}(center: point = (0, 0), ${3:size}: length = ${4:10}) {\n"
        "\tacross = line(center - (${3:size} / 2, 0), center + (${3:size} / 2, 0))\n\t$0\n}",
        "file",
    ),
    Snippet(
        "constraint",
        "a constraint of your own",
        "/// ${1:What it says.}\nconstraint ${2:diagonal_to}(a: box, b: box, by: length) {\n"
        "\ta.top == b.bottom - by\n\ta.left == b.right + by\n\t$0\n}",
        "file",
    ),
    Snippet("alias", "another name for a definition", "alias ${1:flat} = ${2:horizontal}$0", "file"),
    Snippet("import", "the definitions of another file", 'import "${1:parts.aidl}"$0', "file"),
    Snippet("importas", "another file under a name", 'import "${1:parts.aidl}" as ${2:parts}$0', "file"),
    Snippet(
        "importfrom", "some definitions of a file", 'import ${1:washer} from "${2:parts.aidl}"$0', "file"
    ),
    Snippet("@color", "the colour", '@color("${1:crimson}")$0', "attribute"),
    Snippet("@stroke", "the width of lines", "@stroke(${1:0.3mm})$0", "attribute"),
    Snippet("@dash", "dashed lines", "@dash(${1:3}, ${2:1.5})$0", "attribute"),
    Snippet("@opacity", "what shows through", "@opacity(${1:0.5})$0", "attribute"),
    Snippet("@shade", "light and shade on a fill", "@shade(${1:round})$0", "attribute"),
    Snippet("@shadow", "a cast shadow", "@shadow(${1:3mm}, ${2:-3mm})$0", "attribute"),
    Snippet("@edges", "seams in a solid", "@edges(${1:seams})$0", "attribute"),
    Snippet("@halo", "a clear gap around what lies in front", "@halo(${1:1mm})$0", "attribute"),
    Snippet("@clip", "drawn inside an outline only", "@clip(${1:outline})$0", "attribute"),
    Snippet("@behind", "drawn behind another", "@behind(${1:other})$0", "attribute"),
    Snippet("@in_front", "drawn in front of another", "@in_front(${1:other})$0", "attribute"),
    Snippet("@layer", "the layer", '@layer("${1:cut}")$0', "attribute"),
    Snippet("@material", "the material", '@material("${1:birch plywood}")$0', "attribute"),
    Snippet("@thickness", "the thickness", "@thickness(${1:3mm})$0", "attribute"),
    Snippet("@orientation", "how a part stands", "@orientation(${1:front})$0", "attribute"),
    Snippet("@depth", "how deep a hole is that ends in its solid", "@depth(${1:2mm})$0", "attribute"),
    Snippet("@quantity", "how many pieces are made of a part", "@quantity(${1:4})$0", "attribute"),
    Snippet("@elevation", "how high a part lies", "@elevation(${1:18mm})$0", "attribute"),
    Snippet("@note", "a note on the drawing", '@note("${1:glue here}")$0', "attribute"),
    Snippet("@allow", "a note or warning not to be told", '@allow("${1:N0602}")$0', "attribute"),
    Snippet("@title", "the title of a drawing sheet", '@title("${1:Cover plate}")$0', "attribute"),
    Snippet("@author", "who drew it, for its sheet", '@author("${1:A. Maker}")$0', "attribute"),
    Snippet("@number", "the number of a drawing sheet", '@number("${1:C-001}")$0', "attribute"),
    Snippet("@revision", "the revision of a drawing sheet", '@revision("${1:A}")$0', "attribute"),
    Snippet("@thread", "the thread of a hole", '@thread("${1:M10x1}")$0', "attribute"),
    Snippet("@tolerance", "the general tolerances", '@tolerance("${1:ISO 2768-m}")$0', "attribute"),
    Snippet("@finish", "the surface of a part", '@finish("${1:Ra 3.2}")$0', "attribute"),
    Snippet("@detached", "a part that touches no other", "@detached$0", "attribute"),
    Snippet("@rigid", "a part in which nothing moves", "@rigid$0", "attribute"),
    Snippet("gap", "one part above another", "${1:a}.above(${2:b}, gap: ${3:2})$0", "constraints"),
    Snippet("centered", "one part in the middle of another", "${1:a}.centered_in(${2:b})$0", "constraints"),
    Snippet("same", "two sizes alike", "${1:a}.width == ${2:b}.width$0", "constraints"),
    Snippet(
        "row", "parts side by side", 'row(${1:a}, ${2:b}, gap: ${3:5}, align: "${4:center}")$0', "constraints"
    ),
)

OF_WORD = {snippet.prefix: snippet for snippet in SNIPPETS}
