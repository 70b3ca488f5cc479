"""Completion of constraints: those that fit the things at hand first, with their names filled in."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cache, partial

from aidl_lang.checking.facts import Fact
from aidl_lang.checking.resolving.symbols import SymbolKind
from aidl_lang.checking.types import (
    AnyType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    Signature,
    StructureType,
    TextType,
    TruthType,
    Type,
    accepts,
)
from aidl_lang.common.records import record
from aidl_lang.common.resources import resource
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.completion import names
from aidl_lang.tools.ide.completion.context import Context, KnownName
from aidl_lang.tools.ide.completion.drafts import Draft, choice, stop
from aidl_lang.tools.vocabulary import vocabulary

# --- The kinds of things that each constraint takes, from the reference's table of all pairs.
#
# That table was made by compiling a program for each of its cells.

_TABLE = "docs/reference/coverage.md"
_FORM = re.compile(r"^`([^`]+)`(?:: (.*))?$")
_ROW = re.compile(r"^\| \*\*(\w+)\*\* \|(.*)\|$")
_MARK = "●"
_HEAD = "| a ╲ b |"


@record()
class Form:
    """A form of a constraint of `a`, or of `a` and `b`, and the kinds of things it takes; `second` is "" for
    a single one.
    """

    name: str
    text: str
    pairs: frozenset[tuple[str, str]]


@cache
def forms() -> Mapping[str, tuple[Form, ...]]:
    """Returns the forms of each constraint of the library, in the order of the reference."""
    return read(resource(_TABLE).read_text("utf-8"))


@cache
def kinds() -> tuple[str, ...]:
    """Returns the kinds of things, as the heads of the tables name them."""
    lines = resource(_TABLE).read_text("utf-8").splitlines()
    head = next(line for line in lines if line.startswith(_HEAD))
    return tuple(cell.strip() for cell in head.removeprefix(_HEAD).removesuffix("|").split("|"))


def read(page: str) -> Mapping[str, tuple[Form, ...]]:
    found: dict[str, list[Form]] = {}
    name = ""
    for line in page.splitlines():
        if line.startswith("## "):
            name = line[3:].strip()
        elif name and (form := _FORM.match(line)):
            found.setdefault(name, []).append(Form(name, form[1], _told(form[2] or "")))
        elif name in found and (row := _ROW.match(line)):
            cells = [cell.strip() == _MARK for cell in row[2].split("|")]
            more = {(row[1], kind) for kind, works in zip(kinds(), cells, strict=True) if works}
            last = found[name][-1]
            found[name][-1] = Form(last.name, last.text, last.pairs | more)
    return {name: tuple(listed) for name, listed in found.items()}


def _told(words: str) -> frozenset[tuple[str, str]]:
    """Parses `any two, but no number`, or the kinds of a single thing."""
    if words.startswith("any two"):
        but = {word.strip() for word in re.split(r", but no | and no ", words)[1:]}
        left = [kind for kind in kinds() if kind not in but]
        return frozenset((a, b) for a in left for b in left)
    return frozenset((kind, "") for kind in re.split(r",\s*", words) if kind in kinds())


def kind_of(fact: Fact) -> str:
    """Returns the kind of a thing in that table; "" for a thing that is not in it."""
    return _kind(fact.type, is_unknown=bool(fact.reads))


def _kind(kind: Type, *, is_unknown: bool) -> str:
    match kind:
        case PointType():
            return "point" if is_unknown else ""
        case GeometryType(name) if name in kinds():
            return name
        case GeometryType():
            return "shape"
        case StructureType():
            return "structure"
        case ListType():
            return "list" if is_unknown else ""
        case NumberType():
            return "number" if is_unknown else ""
        case _:
            return ""


_FITS_PARTS, _FITS, _FITS_ANY, _FITS_NOT, _BARE = -0.1, 0.0, 1.0, 6.0, 0.5
_MOST_NAMES = 8
_FEW_PAIRS = 40
"""Most pairs of kinds that a specific constraint takes; a constraint with more takes nearly all."""
_LETTER = re.compile(r"\b([abpq]|box)\b(?!\()|(?<![\w.])(\d+)(?=deg\b|\b)")


def constraints(context: Context, behind: float = 0.0) -> Iterator[Draft]:
    """Yields all constraints possible here; `behind` is added to each tier."""
    things = _latest([known for known in context.values if known.is_unknown and not _is_self(known)])
    for name, alias in context.callables():
        found = context.scope.called(name)
        if found is not None and any(s.kind is ast.ConstraintDefinition for s in found[1]):
            yield _own(context, name, found[1], things, behind + _BARE * (alias is not None))
    words = vocabulary()
    table = forms()
    for name in (*words.constraints, *words.relations, *(n for n in table if n in words.functions)):
        found = context.scope.called(name)
        if found is not None:
            yield _standard(context, name, found[1], table.get(name, ()), things, behind)


def _latest(things: Sequence[KnownName]) -> list[KnownName]:
    counts: Counter[str] = Counter()
    found = []
    for known in reversed(things):
        kind = kind_of(known.fact)
        counts[kind] += 1
        if counts[kind] <= _MOST_NAMES:
            found.append(known)
    return found[::-1]


def _is_self(known: KnownName) -> bool:
    return known.symbol.kind is SymbolKind.BUILTIN or known.symbol.scope is None


def _standard(
    context: Context,
    name: str,
    signatures: Sequence[Signature],
    listed: Sequence[Form],
    things: Sequence[KnownName],
    behind: float,
) -> Draft:
    best = min(((_tier(form, things), n, form) for n, form in enumerate(listed)), default=None)
    tier = _FITS_NOT if best is None else best[0]
    text = f"{name}($1)" if best is None else _filled(best[2], things)
    if context.site.following.startswith("("):
        text = name
    return Draft(
        name,
        str(SymbolKind.CONSTRAINT),
        tier + behind,
        text,
        names.brief(signatures),
        is_snippet=text != name,
        describe=partial(names.about_call, name, tuple(signatures)),
    )


def _tier(form: Form, things: Sequence[KnownName]) -> float:
    """Returns the tier of a form: a specific one whose things exist before one that takes anything."""
    found = [pair for a, b in _chosen(form, things) if (pair := (kind_of(a.fact), b and kind_of(b.fact)))]
    if not found:
        return _FITS_NOT + len(form.pairs) / 1000
    if "structure" in found[0] and form.name in vocabulary().relations:
        return _FITS_PARTS
    return (_FITS if len(form.pairs) < _FEW_PAIRS else _FITS_ANY) + len(form.pairs) / 1000


def _chosen(form: Form, things: Sequence[KnownName]) -> Iterator[tuple[KnownName, KnownName | None]]:
    """Yields things that a form takes, in order of declaration."""
    for number, a in enumerate(things):
        first = kind_of(a.fact)
        if (first, "") in form.pairs:
            yield a, None
        for b in (*things[number + 1 :], *things[:number]):
            if (first, kind_of(b.fact)) in form.pairs:
                yield a, b


def _filled(form: Form, things: Sequence[KnownName]) -> str:
    """Returns the form as a snippet, with names of things for its operands."""
    pairs = list(_chosen(form, things))
    firsts = list(dict.fromkeys(a.name for a, _ in pairs))[:_MOST_NAMES]
    default = pairs[0][1] if pairs else None
    seconds = [default.name] if default is not None else []
    seconds += [b.name for _, b in pairs if b is not None]
    letters = {"a": firsts, "b": list(dict.fromkeys(seconds))[:_MOST_NAMES]}
    number = 0

    def place(match: re.Match[str]) -> str:
        nonlocal number
        number += 1
        word = match[0]
        return choice(number, letters[word]) if letters.get(word) else stop(number, word)

    head, bracket, rest = form.text.partition("(")
    return head + bracket + _LETTER.sub(place, rest)


# --- Definitions of the program --------------------------------------------------------------------


def _own(
    context: Context, name: str, signatures: Sequence[Signature], things: Sequence[KnownName], behind: float
) -> Draft:
    made = [_stated(name, signature, things) for signature in signatures]
    text, fits = max(made, key=lambda m: m[1])
    if context.site.following.startswith("("):
        text = name
    return Draft(
        name,
        str(SymbolKind.CONSTRAINT),
        (_FITS if fits else _FITS_NOT) + behind,
        text,
        names.brief(signatures),
        is_snippet=text != name,
        describe=partial(names.about_call, name, tuple(signatures)),
    )


def _stated(name: str, signature: Signature, things: Sequence[KnownName]) -> tuple[str, bool]:
    """Returns a call with the names of fitting things, and True if there are enough of them."""
    items: list[str] = []
    used: list[str] = []
    fits = True
    for parameter, kind, is_optional in signature.parameters:
        if is_optional:
            continue
        number = len(items) + 1
        if isinstance(kind, NumberType | TextType | TruthType):
            items.append(f"{parameter}: {stop(number, parameter)}")
            continue
        fitting = [t.name for t in things if _takes(kind, t)]
        ordered = sorted(fitting, key=used.count)[:_MOST_NAMES]
        fits &= any(n not in used for n in fitting)
        items.append(choice(number, ordered) if ordered else stop(number, parameter))
        used += ordered[:1]
    return f"{name}({', '.join(items)})", fits


def _takes(kind: Type, thing: KnownName) -> bool:
    if isinstance(kind, AnyType | ListType):
        return True
    distance = accepts(kind, thing.fact.type)
    return distance is not None and not isinstance(thing.fact.type, AnyType)
