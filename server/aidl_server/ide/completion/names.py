"""Completion of values, callables and constraints by their names, in this program and in other files."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, lru_cache, partial

from aidl_lang.checking import builtins
from aidl_lang.checking.facts import Fact, result
from aidl_lang.checking.library import signature
from aidl_lang.checking.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import (
    ANY,
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
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.records import record
from aidl_lang.common.resources import resource
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import FileError
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import reference
from aidl_lang.tools.vocabulary import vocabulary
from aidl_server.ide.completion.context import Context, KnownName, Use
from aidl_server.ide.completion.drafts import Draft, Files, choice, importable, stop
from aidl_server.ide.signatures import joined, of_callable, of_definition, of_public
from aidl_server.ide.workspace import insert

MAKERS, OWN, MAYBE, PARTS, CALLS, OTHERS, FAR = 0.8, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0
"""Tiers: makers of geometry if that is wanted; values that fit, that may fit, that have parts which fit;
callables that fit; other declared names; names that hardly fit.
"""
_STEPS = "path"
"""The topic, and the shape, of the steps that outline a path."""
_HAVING_PARTS = (StructureType, GeometryType, PointType)


def values(context: Context) -> Iterator[Draft]:
    """Yields the names that may be read here, those of a wanted type first."""
    for known in context.values:
        yield of_name(known, _tier(context, known))


def _tier(context: Context, known: KnownName) -> float:
    kind = known.fact.type
    distance = context.wanted.distance(kind)
    general = 0.5 * (known.symbol.kind is SymbolKind.BUILTIN)
    if context.wanted.name and known.name == context.wanted.name:
        general -= 0.5
    if distance is not None and not isinstance(kind, AnyType):
        return OWN + 0.1 * distance + general
    if isinstance(kind, AnyType):
        return MAYBE + general
    return (PARTS if isinstance(kind, _HAVING_PARTS) else OTHERS) + general


def of_name(known: KnownName, tier: float) -> Draft:
    kind, described = str(known.symbol.kind), partial(about, known.symbol)
    return Draft(known.name, kind, tier, detail=detail(known), describe=described)


def detail(known: KnownName) -> str:
    node = known.symbol.node
    if isinstance(known.fact.of, ast.Structure) and isinstance(known.fact.type, StructureType):
        return known.fact.of.kind
    if isinstance(node, ast.Param):
        return f"param {node.value.span.one_line}"
    return str(known.symbol.kind) if isinstance(known.fact.type, AnyType) else str(known.fact.type)


def about(symbol: Symbol) -> str:
    """Returns the description of a name that is not callable."""
    if symbol.node is not None:
        return joined(dict.fromkeys(of_definition(node) for node in symbol.nodes[:3]))
    return of_public(symbol.name)


def calls(context: Context) -> Iterator[Draft]:
    """Yields the callables that give a value."""
    is_whole = isinstance(context.site.parent(), ast.Assign) and not context.in_items  # as in `rim = …`
    for name, alias in context.callables():
        signatures = context.called(name)
        if any(s.kind is not ast.ConstraintDefinition for s in signatures):
            yield call(context, name, signatures, _call_tier(context, signatures, is_whole), alias)
    words = vocabulary()
    makers = (*words.primitives, *words.shapes, *words.operations, *words.templates)
    for name in (*makers, *words.exactness, *words.functions, *words.built_in):
        signatures, makes = context.called(name), name in makers
        if not signatures or not _belongs(context, name):
            continue
        if not makes or is_whole or _takes_things(context):
            yield call(context, name, signatures, _call_tier(context, signatures, is_whole and makes))


def _takes_things(context: Context) -> bool:
    kinds = context.wanted.kinds
    takes = any(isinstance(kind, GeometryType | StructureType | ListType | AnyType) for kind in kinds)
    return takes and context.use is Use.GEOMETRY if context.call is None else takes or not kinds


def _belongs(context: Context, name: str) -> bool:
    """Tells whether a library name is useful here: steps in a path only, checks in an assert."""
    entry = reference().entries.get(name)
    in_path = context.call is not None and context.call[0].callee.text == _STEPS
    if entry is not None and entry.topic == _STEPS and name != _STEPS:
        return in_path
    if name in ("area", "perimeter", "overlaps", "clearance"):
        return context.use is Use.CHECK
    return name not in ("fillet", "chamfer")


def _call_tier(context: Context, signatures: Sequence[Signature], makes: bool) -> float:
    if makes:
        is_own = any(not s.standard for s in signatures)
        made = result_type(context, signatures[0])
        is_maker = is_own or isinstance(made, GeometryType | StructureType) or signatures[0].node is None
        return MAKERS + 0.1 * (not is_own) if is_maker else OTHERS
    entry = reference().entries.get(signatures[0].name)
    if entry is not None and entry.topic == _STEPS and signatures[0].standard and entry.name != _STEPS:
        return OWN
    kinds = {result_type(context, s) for s in signatures}
    distances = [d for kind in kinds if (d := context.wanted.distance(kind)) is not None]
    if not distances:
        return FAR
    is_own = any(not s.standard for s in signatures)
    certain = any(not isinstance(kind, AnyType) for kind in kinds)
    return CALLS + 0.1 * min(distances) + 0.5 * (not certain) - 0.3 * is_own


def result_type(context: Context, signature: Signature) -> Type:
    """Returns the result type of a callable, as far as it is the same for all arguments."""
    match signature.kind:
        case None:
            return builtins.RESULTS.get(signature.name, ANY)
        case ast.ShapeDefinition:
            return GeometryType(signature.name)
        case ast.Structure:
            return StructureType()
        case ast.ConstraintDefinition:
            return TruthType()
    if signature.standard and isinstance(signature.node, ast.FunctionDefinition):
        return result(context.view.program.inference, signature.node)[0].type
    return ANY


def call(
    context: Context, name: str, signatures: Sequence[Signature], tier: float, alias: Symbol | None = None
) -> Draft:
    kind = SymbolKind.ALIAS if alias is not None else kind_of(signatures[0])
    return of_call(name, kind, tier, called(context, name, signatures), signatures)


def of_call(name: str, kind: str, tier: float, text: str, signatures: Sequence[Signature]) -> Draft:
    described = partial(of_callable, name, tuple(signatures))
    return Draft(name, str(kind), tier, text, brief(signatures), "$" in text, describe=described)


def called(context: Context, name: str, signatures: Sequence[Signature], skipped: int = 0) -> str:
    """Returns the text of a call, a snippet if it takes something; the name alone before an existing `(`."""
    if context.site.following.startswith("("):
        return name
    is_bare = all(len(s.parameters) <= skipped and not (s.takes_any or s.gathers) for s in signatures)
    return f"{name}()" if is_bare else f"{name}($1)"


def brief(signatures: Sequence[Signature]) -> str:
    """Returns the parameters of the first overload, and the number of others."""
    names = [name + "?" * optional for name, _, optional in signatures[0].parameters]
    more = f" +{len(signatures) - 1}" if len(signatures) > 1 else ""
    return f"({', '.join(names)}){more}"


_KINDS = {
    ast.ShapeDefinition: SymbolKind.SHAPE,
    ast.ConstraintDefinition: SymbolKind.CONSTRAINT,
    ast.Structure: SymbolKind.TEMPLATE,
}


def kind_of(signature: Signature) -> SymbolKind:
    if signature.kind is None:
        is_shape = isinstance(builtins.RESULTS.get(signature.name), GeometryType)
        return SymbolKind.SHAPE if is_shape else SymbolKind.FUNCTION
    return _KINDS.get(signature.kind, SymbolKind.FUNCTION)


# --- Completion of definitions in other files of the workspace, each with its import.

MOST_FILES = 40
"""Most files that are read."""
_TIER = 8.5


def importing(context: Context, files: Files | None) -> Iterator[Draft]:
    """Yields the definitions of other programs that this one does not import yet."""
    if context.use is Use.CONSTANT or context.site.following.startswith("("):
        return
    view = context.site.original
    for name in importable(view.path, files)[:MOST_FILES]:
        try:
            text = view.world.read(name)
        except FileError:
            continue  # gone since, or unreadable: an import of it would report that
        for node in definitions(name, text):
            # constraints among constraints, what gives a value elsewhere
            fits = isinstance(node, ast.ConstraintDefinition) == (context.use is Use.CONSTRAINT)
            if not context.called(node.name.text) and (fits or isinstance(node, ast.FunctionDefinition)):
                yield _draft(context, name, node)


@lru_cache(maxsize=128)
def definitions(name: str, text: str) -> tuple[ast.Callable, ...]:
    statements = parse(SourceFile(name, text)).module.statements
    return tuple(s for s in statements if ast.is_definition(s))


def _draft(context: Context, file: str, node: ast.Callable) -> Draft:
    name = node.name.text
    made = signature(node)
    return replace(
        of_call(name, kind_of(made), _TIER, called(context, name, [made]), [made]),
        detail=f'{brief([made])} from "{file}"',
        extra=(_import(context, file, name),),
        describe=partial(of_definition, node),
    )


def _import(context: Context, file: str, name: str) -> Edit:
    """Adds the import after the existing ones, or at the head of the file below its first comments."""
    view = context.site.original
    imports = [s for s in view.module.statements if isinstance(s, ast.Import)]
    known = next((s for s in imports if s.names and s.path.value == file), None)
    if known is not None:
        return insert(view.source, known.names[-1].span.end, f", {name}")
    statement = f'import {name} from "{file}"'
    if imports:
        return insert(view.source, imports[-1].span.end, f"\n{statement}")
    return insert(view.source, int(view.source.text.startswith("\ufeff")), f"{statement}\n")


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
    """A form of a constraint, and the kinds of things (a, b) that it takes; of a single one b is ""."""

    name: str
    text: str
    pairs: frozenset[tuple[str, str]]


@cache
def forms() -> Mapping[str, tuple[Form, ...]]:
    """Returns the forms of each constraint of the library, in the order of the reference."""
    found: dict[str, list[Form]] = {}
    name = ""
    for line in _table():
        if line.startswith("## "):
            name = line[3:].strip()
        elif name and (form := _FORM.match(line)):
            found.setdefault(name, []).append(Form(name, form[1], _told(form[2] or "")))
        elif name in found and (row := _ROW.match(line)):
            cells = [cell.strip() == _MARK for cell in row[2].split("|")]
            more = {(row[1], kind) for kind, works in zip(kinds(), cells, strict=True) if works}
            last = found[name][-1]
            found[name][-1] = replace(last, pairs=last.pairs | more)
    return {name: tuple(listed) for name, listed in found.items()}


def _table() -> list[str]:
    return resource(_TABLE).read_text("utf-8").splitlines()


@cache
def kinds() -> tuple[str, ...]:
    """Returns the kinds of things, as the heads of the tables name them."""
    head = next(line for line in _table() if line.startswith(_HEAD))
    return tuple(cell.strip() for cell in head.removeprefix(_HEAD).removesuffix("|").split("|"))


def _told(words: str) -> frozenset[tuple[str, str]]:
    if words.startswith("any two"):
        but = {word.strip() for word in re.split(r", but no | and no ", words)[1:]}
        left = [kind for kind in kinds() if kind not in but]
        return frozenset((a, b) for a in left for b in left)
    return frozenset((kind, "") for kind in re.split(r",\s*", words) if kind in kinds())


def thing_kind(fact: Fact) -> str:
    """Returns the kind of a thing in that table; "" for a thing that is not in it."""
    match fact.type:
        case GeometryType(name):
            return name if name in kinds() else "shape"
        case StructureType():
            return "structure"
        case PointType() if fact.reads:
            return "point"
        case ListType() if fact.reads:
            return "list"
        case NumberType() if fact.reads:
            return "number"
        case _:
            return ""


_FITS_PARTS, _FITS, _FITS_ANY, _FITS_NOT, _BARE = -0.1, 0.0, 1.0, 6.0, 0.5
_MOST_NAMES = 8
_FEW_PAIRS = 40
"""Most pairs of kinds that a specific constraint takes; a constraint with more takes nearly all."""
_LETTER = re.compile(r"\b([abpq]|box)\b(?!\()|(?<![\w.])(\d+)(?=deg\b|\b)")


def constraints(context: Context, behind: float = 0.0) -> Iterator[Draft]:
    """Yields all constraints possible here; `behind` is added to each tier."""
    seen = (known for known in context.values if known.fact.reads and known.symbol.scope is not None)
    things = _latest([known for known in seen if known.symbol.kind is not SymbolKind.BUILTIN])
    for name, alias in context.callables():
        signatures = context.called(name)
        if any(s.kind is ast.ConstraintDefinition for s in signatures):
            yield _own(context, name, signatures, things, behind + _BARE * (alias is not None))
    words = vocabulary()
    table = forms()
    for name in (*words.constraints, *words.relations, *(n for n in table if n in words.functions)):
        if signatures := context.called(name):
            yield _standard(context, name, signatures, table.get(name, ()), things, behind)


def _latest(things: Sequence[KnownName]) -> list[KnownName]:
    counts: Counter[str] = Counter()
    found = []
    for known in reversed(things):
        kind = thing_kind(known.fact)
        counts[kind] += 1
        if counts[kind] <= _MOST_NAMES:
            found.append(known)
    return found[::-1]


def _standard(
    context: Context,
    name: str,
    signatures: Sequence[Signature],
    listed: Sequence[Form],
    things: Sequence[KnownName],
    behind: float,
) -> Draft:
    best = min(((_form_tier(form, things), n, form) for n, form in enumerate(listed)), default=None)
    tier = _FITS_NOT if best is None else best[0]
    text = f"{name}($1)" if best is None else _filled(best[2], things)
    text = name if context.site.following.startswith("(") else text
    return of_call(name, SymbolKind.CONSTRAINT, tier + behind, text, signatures)


def _form_tier(form: Form, things: Sequence[KnownName]) -> float:
    """Returns the tier of a form: a specific one whose things exist before one that takes anything."""
    pair = next(_chosen(form, things), None)
    if pair is None:
        return _FITS_NOT + len(form.pairs) / 1000
    is_of_parts = any(each is not None and thing_kind(each.fact) == "structure" for each in pair)
    if is_of_parts and form.name in vocabulary().relations:
        return _FITS_PARTS
    return (_FITS if len(form.pairs) < _FEW_PAIRS else _FITS_ANY) + len(form.pairs) / 1000


def _chosen(form: Form, things: Sequence[KnownName]) -> Iterator[tuple[KnownName, KnownName | None]]:
    for number, a in enumerate(things):
        first = thing_kind(a.fact)
        if (first, "") in form.pairs:
            yield a, None
        for b in (*things[number + 1 :], *things[:number]):
            if (first, thing_kind(b.fact)) in form.pairs:
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


def _own(
    context: Context, name: str, signatures: Sequence[Signature], things: Sequence[KnownName], behind: float
) -> Draft:
    made = [_stated(name, signature, things) for signature in signatures]
    text, fits = max(made, key=lambda m: m[1])
    text = name if context.site.following.startswith("(") else text
    tier = (_FITS if fits else _FITS_NOT) + behind
    return of_call(name, SymbolKind.CONSTRAINT, tier, text, signatures)


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
    given = thing.fact.type
    is_fit = accepts(kind, given) is not None and not isinstance(given, AnyType)
    return isinstance(kind, AnyType | ListType) or is_fit
