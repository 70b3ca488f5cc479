"""Completion entries, before and after ranking, and those from fixed lists."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import field
from functools import lru_cache, partial
from pathlib import Path

from aidl_lang.building.attributes import EDGES, NO_OUTLINE, ORIENTATIONS
from aidl_lang.building.outlines import CORNER_WORDS
from aidl_lang.checking import library
from aidl_lang.checking.builtins import WORDED
from aidl_lang.checking.types import PARAMETER_TYPES, AnyType, NumberType, Signature, TextType
from aidl_lang.checking.units import UNITS
from aidl_lang.common.colors import COLOR_NAMES
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.materials import densities
from aidl_lang.common.names import fold, is_spelled_in
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import reference
from aidl_lang.tools.vocabulary import SNIPPETS, Snippet, expanded, vocabulary
from aidl_server.ide.completion.context import Context
from aidl_server.ide.signatures import of_callable, of_public, type_of
from aidl_server.ide.site import EditSite

MOST = 200
"""Most entries of a list. After that many the editor asks again as the word grows."""


@record()
class Draft:
    """A completion entry before it is ranked.

    label    the text shown, and compared with the typed text
    kind     `keyword`, `kind`, `snippet`, `unit`, `attribute`, `color`, `type`, `file`, `word`, `argument`,
             `field`, `method`, or a `SymbolKind` in its words
    tier     0 for the likeliest; equal ones keep the order of drafting
    text     what is written; a snippet has placeholders: `${1:name}`, `${1|a,b|}`, `$0`
    detail   its type, or its call, in a few words
    extra    edits elsewhere that it needs, as an import
    describe makes its documentation in Markdown; too slow for a whole list
    """

    label: str
    kind: str
    tier: float
    text: str = ""
    detail: str = ""
    is_snippet: bool = False
    extra: tuple[Edit, ...] = ()
    describe: Callable[[], str] = field(default=str, repr=False, compare=False)


@record()
class Completion(Draft):
    """An entry whose text replaces `span`; `rank` is its place in the list, 0 for the best."""

    span: Span = field(kw_only=True)
    rank: int = field(kw_only=True)

    @property
    def documentation(self) -> str:
        return self.describe()

    @property
    def plain(self) -> str:
        """Returns the text with each placeholder replaced by its proposal."""
        return expanded(self.text) if self.is_snippet else self.text


def ranked(drafts: Iterable[Draft], span: Span, prefix: str) -> list[Completion]:
    """Returns entries by tier, each label once, of those that the prefix may abbreviate."""
    chosen: dict[tuple[str, str], Draft] = {}
    for draft in sorted(drafts, key=lambda d: d.tier):
        chosen.setdefault((draft.label, draft.text), draft)
    fitting = [d for d in chosen.values() if is_spelled_in(prefix, d.label)]
    return [
        Completion(**{**vars(d), "text": d.text or d.label}, span=span, rank=rank)
        for rank, d in enumerate(fitting[:MOST])
    ]


def written_out(snippet: Snippet) -> str:
    """Writes a snippet for completion: indented as programs are, without `$0` at its end."""
    return snippet.body.replace("\t", "    ").removesuffix("$0")


def stop(number: int, proposed: str) -> str:
    escaped = re.sub(r"[\\$}]", r"\\\g<0>", proposed)
    return f"${{{number}:{escaped}}}"


def choice(number: int, names: Sequence[str]) -> str:
    """Returns a placeholder with a choice of names; the first is proposed."""
    return f"${{{number}|{','.join(names)}|}}" if len(names) > 1 else stop(number, names[0])


# --- Completion from fixed lists: units, attributes, colours, types, the choices of an argument, files.

Files = Callable[[], Iterable[Path]]
"""A function that lists the programs of a workspace."""
_DEEPEST = 4
"""Depth of nested calls searched for the choices of a parameter."""
_FAVOURITES = ("mm", "deg")
_PLAIN_TYPES = ("number", "integer", "length", "angle", "point", "text", "bool", "list", "box")


def units(context: Context | None) -> Iterator[Draft]:
    """Yields units after a number, those of the wanted dimension first."""
    wanted = context.wanted.kinds if context is not None else ()
    dimensions = [k.dimension for k in wanted if isinstance(k, NumberType) and k.dimension is not None]
    for number, (unit, (factor, dimension)) in enumerate(UNITS.items()):
        fits = dimension in dimensions
        tier = number / 10 + 2.0 * (bool(dimensions) and not fits) - (unit in _FAVOURITES)
        base = "mm" if dimension == UNITS["mm"][1] else "degrees"
        yield Draft(unit, "unit", tier, detail=(str(dimension) if factor == 1.0 else f"{factor:.6g} {base}"))


def attributes(is_called: bool) -> Iterator[Draft]:
    """Yields attributes after `@`; the name alone before an existing parenthesis."""
    for snippet in (s for s in SNIPPETS if s.place == "attribute"):
        name = snippet.prefix.removeprefix("@")
        text = name if is_called else written_out(snippet).removeprefix("@")
        entry = reference().entries.get(snippet.prefix)
        detail = entry.doc.line if entry is not None else ""
        described = partial(of_public, snippet.prefix)
        yield Draft(name, "attribute", 0.0, text, detail, "$" in text, describe=described)


def of_attribute(name: str, *, is_quoted: bool) -> Iterator[Draft]:
    """Yields the words that an attribute takes as argument."""
    listed: dict[str, Sequence[str]] = {
        **dict.fromkeys(("color", "colour"), sorted(COLOR_NAMES)),
        "orientation": ORIENTATIONS,
        "stroke": [NO_OUTLINE.value],
        "edges": EDGES,
        "material": sorted(densities()),
    }
    kind = "color" if fold(name) in ("color", "colour") else "word"
    for word in listed.get(fold(name), ()):
        is_bare = word.isidentifier() and name in WORDED and kind == "word"
        yield Draft(word, kind, 0.0, word if is_quoted or is_bare else f'"{word}"')


def types(context: Context) -> Iterator[Draft]:
    """Yields types after `:` in a parameter, and shapes by their names."""
    for number, word in enumerate(dict.fromkeys((*_PLAIN_TYPES, *PARAMETER_TYPES))):
        yield Draft(word, "type", number / 100, detail=str(PARAMETER_TYPES[word]))
    words = vocabulary()
    own = [name for name, _ in context.callables()]
    for name in (*own, *words.shapes):
        signatures = context.called(name)
        if signatures and signatures[0].kind is ast.ShapeDefinition:
            described = partial(of_callable, name, tuple(signatures))
            yield Draft(name, "shape", 2.0 - (name in own), describe=described)


def choices(context: Context, *, is_quoted: bool) -> Iterator[Draft]:
    """Yields the words that the parameter at this place takes."""
    found = ((reading.signature, name) for reading, name in context.filled)
    for word in dict.fromkeys(word for signature, name in found for word in words_of(signature, name)):
        is_common = word in vocabulary().bare_words
        text = word if is_quoted or (context.is_named and is_common) else f'"{word}"'
        yield Draft(word, "word", 0.0 if is_common else 0.1, text)


@lru_cache(maxsize=1024)
def words_of(signature: Signature, parameter: str, depth: int = _DEEPEST) -> Sequence[str]:
    """Returns the words that a definition, or its calls, choose among by a parameter."""
    kind = type_of(signature, parameter)
    if not isinstance(kind, TextType | AnyType):
        return ()
    node = signature.node
    if node is None:
        return CORNER_WORDS.get(parameter, ()) if isinstance(kind, TextType) else ()
    body = node.value if isinstance(node, ast.FunctionDefinition) else node.body
    for call in (n for n in ast.walk(body) if isinstance(n, ast.Call)):
        given = [a.value for a in call.arguments]
        named = (n for n, a in enumerate(given) if isinstance(a, ast.Name) and a.text == parameter)
        place = next(named, None)
        if place is None:
            continue
        if call.callee.text == "choice":
            listed = call.arguments[-1].value
            items = listed.items if isinstance(listed, ast.List) else ()
            return tuple(item.value for item in items if isinstance(item, ast.String))
        if depth and (found := _words_inside(call, place, depth)):
            return found
    return ()


def _words_inside(call: ast.Call, place: int, depth: int) -> Sequence[str]:
    """Returns the choices of the parameter that gets the argument at a place of a call."""
    word = call.arguments[place].name
    for signature in library.load().callables.get(call.callee.text, ()):
        number = place + (call.receiver is not None)
        if word is None and number >= len(signature.parameters):
            continue
        name = word.text if word is not None else signature.parameters[number][0]
        if found := words_of(signature, name, depth - 1):
            return found
    return ()


def files(site_path: Path, listed: Files | None, *, quoted: bool = False) -> Iterator[Draft]:
    """Yields the programs that a file may import: those in its folder and below it."""
    for name in importable(site_path, listed):
        yield Draft(name, "file", name.count("/") / 10, f'"{name}"' if quoted else name)


def importable(path: Path, listed: Files | None) -> list[str]:
    """Returns programs as an import names them, relative to the file at a path."""
    others = (other for other in (listed() if listed is not None else ()) if other != path)
    beside = (other for other in others if other.is_relative_to(path.parent))
    return sorted(other.relative_to(path.parent).as_posix() for other in beside)


def imported_names(site: EditSite, node: ast.Import) -> Iterator[Draft]:
    """Yields the names that `import … from "file"` may bring."""
    view = site.view
    target = view.resolution.imports.get(node) if view is not None else None
    if view is None or target is None:
        return
    scope = view.resolution.scopes[target]
    taken = {name.text for name in node.names}
    for name in (*scope.callables, *scope.aliases, *scope.values):
        if name not in taken:
            kind = str(scope.values[name].kind) if name in scope.values else "function"
            described = partial(of_callable, name, tuple(scope.callables.get(name, ())))
            yield Draft(name, kind, 0.0, describe=described)
