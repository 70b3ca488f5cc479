"""Collects every public name with its description, and searches them and the pages on diagnostics."""

from __future__ import annotations

import functools
import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from functools import cache

from aidl_lang.checking import builtins, library
from aidl_lang.common import names, resources
from aidl_lang.common.records import record
from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.signatures import is_refusal, made_shape, relates_boxes, written

# --- Collects every public name with its description: from the library's `///` comments, and from
# `stdlib/docs/*.md` for built-ins and the words of the language.
#
# A name of the library is public if one of its definitions has a `///` comment. Its first sentence is the
# line that lists show; a fenced block is its example, a whole program. A definition below a plain `//`
# comment is a helper.

_EXAMPLE = re.compile(r"^```aidl\n(.*?)^```$\n?", re.MULTILINE | re.DOTALL)
_SENTENCE = re.compile(r"(.+?[.!?])(?=\s+[A-Z`(]|\s*$)", re.DOTALL)
_NAME = re.compile(r"@?\w+")
_LIES = re.compile(r"^Lies (.+?)\.(?=\n\n|\Z)", re.MULTILINE | re.DOTALL)
_ALL_BUT = 0.85
"""Least likeness of a misspelling and a name: one letter in six or so differs."""


@record()
class Doc:
    """A comment in parts: its first sentence, the rest, and its program ("" for none)."""

    line: str
    text: str
    example: str

    @property
    def lies(self) -> str:
        """Returns how a shape lies at angle 0, and where it is held; "" for one told by name and middle."""
        said = _LIES.search(self.text)
        return " ".join(said[1].split()) if said else ""


@record()
class Overload:
    """One form of a name: its text, description, file, and definition in the library if it has one."""

    form: str
    doc: Doc
    where: str
    node: ast.Callable | ast.Let | None = None


@record()
class Entry:
    """A public name. `sort` is `shape`, `relation` (of boxes), `constraint`, `function`, `template`,
    `constant`, `builtin` or `word` (of the language); `topic` the name of its file.
    """

    name: str
    sort: str
    topic: str
    doc: Doc
    overloads: tuple[Overload, ...]
    synonyms: tuple[str, ...] = ()

    @property
    def where(self) -> str:
        return self.overloads[0].where

    @property
    def nodes(self) -> tuple[ast.Callable, ...]:
        return tuple(o.node for o in self.overloads if o.node is not None and not isinstance(o.node, ast.Let))


@record()
class Topic:
    """A file of the library or of `stdlib/docs`: its stem, and the comment at its head."""

    name: str
    title: str
    text: str


@record()
class Reference:
    """`entries` by name, in the order of the topics and, within one, in that of writing."""

    topics: tuple[Topic, ...]
    entries: Mapping[str, Entry]
    aliases: Mapping[str, str]

    def of_topic(self, topic: str) -> list[Entry]:
        return [entry for entry in self.entries.values() if entry.topic == topic]

    def find(self, name: str) -> Entry | None:
        """Returns the entry of a name, a synonym or another spelling of either; `color` finds `@color`."""
        wanted = name.strip("`").removesuffix("()")
        known = names.find(wanted, self._known) or names.find(f"@{wanted}", self._known)
        return self.entries[self._known[known]] if known else None

    def misspelt(self, name: str) -> Entry | None:
        """Returns the entry whose name or synonym an unknown name almost spells."""
        spelt = {names.fold(known): entry for known, entry in self._known.items()}
        near = get_close_matches(names.fold(name), spelt, n=1, cutoff=_ALL_BUT)
        return self.entries[spelt[near[0]]] if near else None

    def near(self, name: str) -> list[str]:
        """Returns names that may have been meant: those that hold the word, then those that look like it."""
        wanted = names.fold(name)
        around = sorted(n for n in self._known if wanted and wanted in names.fold(n))
        return list(dict.fromkeys([*around, *names.nearest(name, self._known, 3)]))[:6]

    @functools.cached_property
    def _known(self) -> dict[str, str]:
        """Every name and every synonym, each with the name of its entry."""
        return {**self.aliases, **{name: name for name in self.entries}}


TOPICS = (
    *"rectangles corners rounds polygons triangles quadrilaterals geometry path text arcs arches".split(),
    *"wheels figures profiles curves cords links spline relations placement arrangements sizes".split(),
    *"constraints tangency symmetry measures clearance operations outlines patterns joints".split(),
    *"hardware mounts fasteners gear dimensions language numbers colors exactness".split(),
)
"""Topics that come first, in this order; the others follow by name."""


@functools.cache
def reference() -> Reference:
    """Returns all public names of this installation."""
    loaded = library.load()
    sections = list(_sections())
    found = {entry.name: entry for _, entries in sections for entry in entries}
    for entry in _library_entries(loaded):
        found[entry.name] = _joined(found[entry.name], entry) if entry.name in found else entry
    aliases = dict(loaded.aliases)  # none is a synonym of a synonym
    aliases |= {synonym: entry.name for entry in found.values() for synonym in entry.synonyms}
    synonyms: dict[str, list[str]] = {}
    for alias, target in aliases.items():
        synonyms.setdefault(target, []).append(alias)
    topics = _topics((topic for topic, _ in sections), loaded.sources)
    ranked = sorted(found.values(), key=lambda entry: list(topics).index(entry.topic))
    used = {entry.topic for entry in ranked}
    return Reference(
        tuple(topic for name, topic in topics.items() if name in used),
        {e.name: replace(e, synonyms=tuple(synonyms.get(e.name, ()))) for e in ranked},
        {alias: target for alias, target in aliases.items() if target in found},
    )


def _topics(described: Iterable[Topic], sources: Iterable[SourceFile]) -> dict[str, Topic]:
    topics = {topic.name: topic for topic in described}
    for source in sources:
        name = source.name.removeprefix("stdlib/").removesuffix(".aidl")
        topics.setdefault(name, _topic(name, source.text))
    order = sorted(topics, key=lambda t: (TOPICS.index(t) if t in TOPICS else len(TOPICS), t))
    return {name: topics[name] for name in order}


def _joined(described: Entry, defined: Entry) -> Entry:
    """Joins a built-in with what the library adds under its name; a shape of the library comes first."""
    if not isinstance(defined.overloads[0].node, ast.ShapeDefinition):
        return replace(described, overloads=(*described.overloads, *defined.overloads))
    own = (replace(overload, doc=described.doc) for overload in described.overloads)
    return replace(defined, overloads=(*defined.overloads, *own))


def _library_entries(loaded: library.Library) -> list[Entry]:
    nodes: dict[str, list[ast.Callable | ast.Let]] = {}
    for name, signatures in loaded.callables.items():
        nodes[name] = [s.node for s in signatures if s.node is not None]
    for name, node in loaded.constants.items():
        nodes.setdefault(name, [node])
    entries = [entry for name, found in nodes.items() if (entry := _entry(name, found)) is not None]
    return sorted(entries, key=lambda e: (e.topic, _start(e)))


def _start(entry: Entry) -> int:
    node = entry.overloads[0].node
    return node.span.start if node is not None else 0


def _entry(name: str, nodes: Sequence[ast.Callable | ast.Let]) -> Entry | None:
    overloads = [Overload(written(n), doc(n.doc or ""), _where(n), n) for n in nodes if not _is_helper(n)]
    leading = [o for o in overloads if o.doc.line]
    if not leading:
        return None
    lead = next((o for o in leading if o.doc.example), leading[0])
    node = lead.node
    assert node is not None
    topic = node.span.source.name.removeprefix("stdlib/").removesuffix(".aidl")
    first = sorted(overloads, key=lambda o: o is not lead)
    return Entry(name, _sort(node), topic, lead.doc, tuple(first))


def _is_helper(node: ast.Callable | ast.Let) -> bool:
    """Tells whether a definition is a helper: it refuses, or its paragraph has a plain comment as head."""
    if not isinstance(node, ast.Let) and is_refusal(node):
        return True
    paragraph = node.span.source.text[: node.span.start].rpartition("\n\n")[2]
    return paragraph.startswith("//") and not paragraph.startswith("///")


def _sort(node: ast.Callable | ast.Let) -> str:
    match node:
        case ast.ShapeDefinition():
            return "shape"
        case ast.ConstraintDefinition():
            return "relation" if relates_boxes(node) else "constraint"
        case ast.FunctionDefinition():
            return "shape" if made_shape(node) else "function"
        case ast.Structure():
            return "template"
        case _:
            return "constant"


def _where(node: ast.Node) -> str:
    return f"{node.span.source.name}:{node.span.line}"


def doc(comment: str) -> Doc:
    """Parses a comment, or a section of a page."""
    example = _EXAMPLE.search(comment)
    text = (comment[: example.start()] + comment[example.end() :] if example else comment).strip()
    paragraph = text.split("\n\n")[0]
    sentence = _SENTENCE.match(paragraph)
    line = sentence[1] if sentence else paragraph
    return Doc(" ".join(line.split()), text[len(line) :].strip(), example[1] if example else "")


def _topic(name: str, source: str) -> Topic:
    """Returns a topic; its title is the first comment of the file, up to its first colon or full stop."""
    head = []
    for line in source.splitlines():
        if not line.startswith("//") or line.startswith("///"):
            break
        head.append(line.removeprefix("//").strip())
    paragraphs = [" ".join(p.split()) for p in "\n".join(head).split("\n\n")]
    title, _, text = re.sub(r"[:.](\s+|$)", "\0", "\n\n".join(paragraphs), count=1).partition("\0")
    return Topic(name, title or name.capitalize(), text[:1].upper() + text[1:])


# --- What is built in, and the words of the language ---------------------------------------------


def _sections() -> Iterator[tuple[Topic, list[Entry]]]:
    """Yields the sections of the pages of `stdlib/docs`: `# title`, a paragraph, and for each name one or
    more headings `## name(parameters)`, its forms, with a comment as in the library below the last of them.
    Another name among them is a synonym.
    """
    for path in sorted(resource("stdlib").glob("docs/*.md")):
        head, *parts = re.split(r"^(?=## )", path.read_text("utf-8"), flags=re.MULTILINE)
        title, _, text = head.strip().partition("\n")
        topic = Topic(path.stem, title.removeprefix("#").strip(), text.strip())
        line = head.count("\n") + 1
        forms: list[tuple[str, str]] = []
        entries = []
        for part in parts:
            heading, _, body = part.partition("\n")
            forms.append((heading.removeprefix("##").strip(), f"stdlib/docs/{path.name}:{line}"))
            line += part.count("\n")
            if body.strip():
                entries.append(_described(path.stem, forms, doc(body)))
                forms = []
        yield topic, entries


def _described(topic: str, forms: Sequence[tuple[str, str]], about: Doc) -> Entry:
    named = [(found[0] if (found := _NAME.match(form)) else form, form, where) for form, where in forms]
    name = named[0][0]
    overloads = tuple(Overload(form, Doc("", "", ""), where) for _, form, where in named)
    others = tuple(dict.fromkeys(other for other, _, _ in named if other != name))
    sort = "builtin" if name in builtins.SIGNATURES else "word"
    return Entry(name, sort, topic, about, overloads, others)


# --- Searches the names of the library and the pages on diagnostics.
#
# A document counts for the words of the query that it has: more in its name than in its text, and more for
# words that few documents have (the inverse document frequency of text retrieval), and more if it has all of
# them.

_WORD = re.compile(r"[^\W_]+")
_ENDINGS = ("ings", "ing", "ies", "es", "ed", "s", "ly", "y")
_SHORTEST = 3
"""Least letters of a word without its ending."""
_NAME_SEARCHING, _SUMMARY, _TEXT = 6.0, 3.0, 1.0
_IS_THE_NAME = 40.0
_STOP = frozenset(
    _WORD.findall(
        "a an and another are as at be by can do each for from how i in is it make of on one or other put "
        "that the this to two want with"
    )
)

_PLAIN = {
    "text": "size of the letters, label, caption, lettering, write, word, engrave",
    "hole": "cutout, cut out, opening, window, drill, remove, subtract",
    "screw_hole": "hole for a screw",
    "countersink": "countersunk head, screw head, sunk",
    "@thickness": "extrude, extrusion, thick, 3d, height of a body",
    "inside": "distance from the edge, distance from the edges, border, inset",
    "distance": "distance from the edge",
    "fillet": "round a corner, rounded edge, radius of a corner",
    "mirror": "flip, reflect",
    "in": "inch, inches, unit, imperial",
    "param": "variable, knob, parameter, setting",
    "import": "include, load, use another file, svg, dxf",
    "@material": "wood, plywood, stock",
}
"""Words by which somebody new asks for a name, where its documentation has others."""


@record()
class _Document:
    """An entry, or the code of a diagnostic, with the weight of each of its words."""

    about: Entry | str
    names: frozenset[str]
    weights: Mapping[str, float]


def search(query: str, most: int) -> list[Entry | str]:
    """Returns the entries and codes that fit a query best, best first."""
    found = [about for about, _ in _scored(query)][:most]
    return found or [entry for entry in [reference().misspelt(query.strip())] if entry is not None]


def speaking_of(query: str) -> list[Entry]:
    """Returns the entries that have every word of a query, best first."""
    return [about for about, share in _scored(query) if share == 1.0 and isinstance(about, Entry)]


def _scored(query: str) -> list[tuple[Entry | str, float]]:
    """Returns what fits a query, best first, each with its share of the words; else as in the reference."""
    words = list(dict.fromkeys(stems(query)))
    documents = _documents()
    wanted = "".join(_WORD.findall(query)).casefold()
    scored = []
    for number, document in enumerate(documents):
        score = sum(_rarity(word) * document.weights.get(word, 0.0) for word in words)
        share = sum(word in document.weights for word in words) / max(1, len(words))
        score *= share
        if wanted in document.names:
            score += _IS_THE_NAME
        if score:
            scored.append((-score, number, share))
    return [(documents[number].about, share) for _, number, share in sorted(scored)]


@cache
def _documents() -> tuple[_Document, ...]:
    return (*map(_of_entry, reference().entries.values()), *map(_of_code, resources.codes()))


@cache
def _rarity(word: str) -> float:
    documents = _documents()
    having = sum(word in document.weights for document in documents)
    return math.log(1.0 + len(documents) / (1 + having))


def _of_entry(entry: Entry) -> _Document:
    weights = _weighed(
        *((_NAME_SEARCHING / len(list(stems(name)) or "1"), name) for name in (entry.name, *entry.synonyms)),
        (_SUMMARY, f"{entry.doc.line} {entry.topic}"),
        (_NAME_SEARCHING, _PLAIN.get(entry.name, "")),
        (_TEXT, " ".join([entry.doc.text, *(f"{o.form} {o.doc.line}" for o in entry.overloads)])),
    )
    names = {"".join(_WORD.findall(name)).casefold() for name in (entry.name, *entry.synonyms)}
    return _Document(entry, frozenset(names), weights)


def _of_code(code: str) -> _Document:
    title, page = resources.title(code), resources.page(code)
    prose = page.partition("\n## ")[0].partition("\n")[2]
    return _Document(code, frozenset({code.casefold()}), _weighed((_SUMMARY, title), (_TEXT, prose)))


def _weighed(*parts: tuple[float, str]) -> dict[str, float]:
    """Returns the words of some texts, each with its most important text's weight; repetition adds little."""
    weights: dict[str, float] = {}
    for weight, text in parts:
        for word, times in Counter(stems(text)).items():
            weights[word] = max(weights.get(word, 0.0), weight * (1.0 + 0.1 * math.log(times)))
    return weights


def stems(text: str) -> Iterator[str]:
    """Yields the words of a text, folded, without their endings."""
    for word in _WORD.findall(text.casefold()):
        if word in _STOP:
            continue
        ending = next((e for e in _ENDINGS if word.endswith(e) and len(word) - len(e) >= _SHORTEST), "")
        yield word.removesuffix(ending)
