"""Completion at a place: finds the kind of place and collects its drafts; statements, members, arguments."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial

from aidl_lang.checking import builtins, types
from aidl_lang.checking.builtins import EDITS
from aidl_lang.checking.facts import Fact, body_of, member_of, of_symbol
from aidl_lang.checking.symbols import Symbol, SymbolKind, SymbolScope
from aidl_lang.checking.units import ANGLE
from aidl_lang.parser import standing_before
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import KINDS, kind_of
from aidl_lang.tools.reference.collect import reference
from aidl_lang.tools.reference.signatures import parts, things
from aidl_lang.tools.vocabulary import OF_WORD, vocabulary
from aidl_server.ide.completion import drafts, names
from aidl_server.ide.completion.context import CONDITION, Context, KnownName, Use, context_of
from aidl_server.ide.completion.drafts import MOST, Completion, Draft, Files
from aidl_server.ide.completion.names import constraints, forms, importing, thing_kind
from aidl_server.ide.references import parameter_node
from aidl_server.ide.signatures import Reading, fenced, is_public, of_parameter, of_public
from aidl_server.ide.site import EditSite, Spot, around, site_at, spot_at
from aidl_server.ide.workspace import View, look

# --- Completion after a dot, between the brackets of an index, and of named arguments.

_MEMBERS, _FIELDS, _DEMANDS, _BOX, _METHODS, _UNFIT = 0.0, 1.0, 1.7, 2.0, 3.0, 4.0
_MOST_INDICES = 12
_SEEN = frozenset(
    {
        *(SymbolKind.PARAM, SymbolKind.LET, SymbolKind.VAR),
        *(SymbolKind.GEOMETRY, SymbolKind.STRUCTURE, SymbolKind.ARGUMENT),
    }
)
_NUMBER = re.compile(r"-?\d+")


def members(context: Context, value: ast.Expression) -> Iterator[Draft]:
    """Yields members of the value before the dot, and calls that take it as first argument."""
    symbol = context.view.resolution.uses.get(value) if isinstance(value, ast.Name) else None
    if symbol is not None and symbol.kind is SymbolKind.NAMESPACE and symbol.scope is not None:
        yield from _of_file(context, symbol.scope.spaces.get(symbol.name))
        return
    fact = context.view.program.inference.fact(value)
    if isinstance(value, ast.Number) or isinstance(fact.type, types.NumberType):
        return
    listed: set[str] = set()
    for tier, name, describe in _names(context, fact):
        if name not in listed:
            listed.add(name)
            yield _member(context, fact, name, tier, describe)
    yield from _methods(context, fact)


def _of_file(context: Context, scope: SymbolScope | None) -> Iterator[Draft]:
    if scope is None:
        return
    for name, symbol in scope.values.items():
        if symbol.kind in (SymbolKind.PARAM, SymbolKind.LET):
            known = KnownName(name, symbol, of_symbol(context.view.program.inference, symbol))
            yield names.of_name(known, _MEMBERS)
    for name in (*scope.callables, *scope.aliases):
        if (found := scope.called(name)) is not None:
            yield names.call(context, name, found[1], _MEMBERS, scope.aliases.get(name))


_Named = Iterator[tuple[float, str, Symbol | None]]


def _names(context: Context, fact: Fact) -> _Named:
    match fact.type:
        case types.StructureType() if fact.of is not None:
            for name, symbol in context.view.resolution.scope_of(fact.of).values.items():
                if symbol.kind in _SEEN:
                    is_late = symbol.kind in (SymbolKind.LET, SymbolKind.ARGUMENT)
                    yield _MEMBERS + 0.5 * is_late, name, symbol
            yield from _plain((*builtins.BOX, "bb"), _BOX)
            yield from _plain(builtins.STRUCTURE, _BOX + 0.5)
        case types.GeometryType(kind):
            if fact.of is not None:
                yield from _of_shape(context, fact.of)
            else:
                yield from _plain(builtins.PRIMITIVE.get(kind, {}), _FIELDS)
            yield from _plain((*builtins.BOX, "bb"), _BOX)
        case types.PointType():
            yield from _plain(("x", "y"), _FIELDS)
        case types.BoxType() | types.StructureType():
            yield from _plain(builtins.BOX, _FIELDS)
        case types.ListType():
            yield from _plain(builtins.PATTERN.get(fact.pattern, {}), _MEMBERS)
            yield from _names(context, fact.element())
            yield from _plain((*builtins.BOX, "bb"), _BOX)


def _plain(found: Iterable[str], tier: float) -> _Named:
    for name in found:
        yield tier, name, None


def _of_shape(context: Context, definition: ast.Node) -> _Named:
    assert isinstance(definition, ast.ShapeDefinition)
    scope = body_of(context.view.program.inference, definition)
    for part in parts(definition):
        name = part.name.partition("[")[0]
        if name in scope.values:
            yield _MEMBERS, name, scope.values[name]
    for parameter in definition.parameters:
        if (symbol := scope.values.get(parameter.name.text)) is not None:
            yield _FIELDS, parameter.name.text, symbol


def _member(context: Context, base: Fact, name: str, tier: float, symbol: Symbol | None) -> Draft:
    here = context.path[-1].span
    node = ast.Member(ast.Name(name, span=here), ast.Identifier(name, span=here), span=here)
    fact = member_of(context.view.program.inference, base, node)
    if context.wanted != CONDITION and context.wanted.distance(fact.type) is None:
        tier += _UNFIT if isinstance(fact.type, types.NumberType | types.PointType) else 0.5
    if symbol is None:
        described = partial(fenced, f"{name}: {fact.type}")
        return Draft(name, "field", tier, detail=str(fact.type), describe=described)
    kind = "field" if symbol.kind is SymbolKind.ARGUMENT else str(symbol.kind)
    detail = str(fact.type) if symbol.is_array else names.detail(KnownName(name, symbol, fact))
    return Draft(name, kind, tier, detail=detail, describe=partial(names.about, symbol))


def _methods(context: Context, fact: Fact) -> Iterator[Draft]:
    """Yields `a.above(…)`: constraints among constraints, functions elsewhere."""
    if isinstance(fact.type, types.AnyType | types.RecordType):
        return
    words = vocabulary()
    holders = ast.ExpressionStatement | ast.Constrain | ast.Block | ast.Prefer | ast.Binary
    is_demand = context.use is Use.CONSTRAINT and isinstance(context.site.parent(2), holders)
    demands = (*words.relations, *words.constraints, *sorted(EDITS & {*words.operations}))
    own = [name for name, _ in context.callables()]
    for name in (*own, *(demands if is_demand else ()), *words.functions):
        signatures = context.called(name)
        distance = _first_fits(fact, signatures, name) if signatures else None
        demanding = [s.kind is ast.ConstraintDefinition for s in signatures]
        if distance is None or (not is_demand and all(demanding)):
            continue
        tier = (_DEMANDS if is_demand and demanding[0] else _METHODS) + 0.1 * distance
        text = names.called(context, name, signatures, skipped=1)
        yield names.of_call(name, "method", tier + 0.05 * (name not in own), text, signatures)


def _first_fits(fact: Fact, signatures: list[types.Signature], name: str) -> float | None:
    """Returns how well a callable's first parameter takes a thing; None if it does not."""
    if name in forms() and all(s.standard for s in signatures):
        pairs = (form.pairs for form in forms()[name])
        kind = thing_kind(fact)
        return min((len(p) / 100 for p in pairs if any(first == kind for first, _ in p)), default=None)
    firsts = [s.parameters[0][1] for s in signatures if s.parameters]
    distances = [d for first in firsts if (d := types.accepts(first, fact.type)) is not None]
    return min((d for d in distances if d < 3), default=None)


def indices(context: Context, index: ast.Index) -> Iterator[Draft]:
    """Yields the indices of an array in the last drawing, the last one as `-1`."""
    drawn = context.site.original.drawn
    if drawn is None or drawn.model is None:
        return
    name = index.value.span.one_line.rpartition(".")[2]
    structures = list(drawn.model.root.walk())
    listed = [each.name for s in structures for each in s.structures]
    listed += [each.name for s in structures for each in s.geometry]
    places = (rest for array, _, rest in (each.partition("[") for each in listed) if array == name)
    found = {int(number[0]) for place in places if (number := _NUMBER.match(place))}
    for at in sorted(found)[:_MOST_INDICES]:
        yield Draft(str(at), "word", _FIELDS, detail=f"{name}[{at}]")
    if found:
        yield Draft("-1", "word", _BOX, detail=f"the last of {len(found)}")


# --- Completion of named arguments that a call does not have yet.

_NEEDED, _OPTIONAL = 0.2, 0.6
_NAMED = re.compile(r"\s*(:|=(?!=))")
_LONGEST_DEFAULT = 20


def named_arguments(context: Context) -> Iterator[Draft]:
    """Yields parameters of the overloads still possible, required ones first."""
    call = context.call
    if call is None:
        return
    public = [r for r in context.readings if is_public(r.signature)] or context.readings
    for order, reading in enumerate(public):
        for place, (name, kind, is_optional) in enumerate(_open(reading, call[1])):
            tier = (_OPTIONAL if is_optional else _NEEDED + order / 20) + place / 100
            yield _argument(context, reading.signature, name, kind, tier)


def _open(reading: Reading, number: int) -> list[tuple[str, types.Type, bool]]:
    taken = {name for n, name in enumerate(reading.taken) if n != number}
    node = reading.signature.node
    related = {p.name.text for p in things(node)} if isinstance(node, ast.ConstraintDefinition) else set()
    return [p for p in reading.signature.parameters if p[0] not in taken and p[0] not in related]


def _argument(
    context: Context, signature: types.Signature, name: str, kind: types.Type, tier: float
) -> Draft:
    node = parameter_node(signature, name)
    default = node.default.span.one_line if node is not None and node.default is not None else ""
    is_named = _NAMED.match(context.site.following) is not None
    text = name if is_named else f"{name}: {_proposed(signature, name, kind, default)}"
    detail = str(kind) + (f" = {default}" if default else "")
    described = partial(of_parameter, signature, name)
    return Draft(f"{name}:", "argument", tier, text, detail, not is_named, describe=described)


def _proposed(signature: types.Signature, name: str, kind: types.Type, default: str) -> str:
    """Returns a snippet placeholder with a value that the parameter takes."""
    if isinstance(kind, types.TextType) and (words := drafts.words_of(signature, name)):
        listed = [word if word.isidentifier() else f'"{word}"' for word in words if word != "free"]
        return f"${{1|{','.join(listed)}|}}"
    if default and len(default) < _LONGEST_DEFAULT:
        return drafts.stop(1, default)
    match kind:
        case types.NumberType(dimension, whole):
            return drafts.stop(1, "45deg" if dimension == ANGLE else "3" if whole else "10")
        case types.PointType():
            return "(${1:0}, ${2:0})"
        case types.TextType():
            return '"${1:text}"'
        case types.TruthType():
            return "${1|true,false|}"
        case types.ListType():
            return f"[{drafts.stop(1, name)}]"
        case _:
            return drafts.stop(1, name)


# --- Completion of statements and of the words that continue one.

_BLOCK = " {\n    $0\n}"
_OWN = {
    "else": "else" + _BLOCK,
    "template": "template ${1:solid} ${2:name}()" + _BLOCK,
    "construction": "construction ${1:axis} = line(${2:origin}, ${3:(0, 10)})",
    "todo": "todo",
}
"""Statements without a snippet, or with another one, in the snippets of all editors (see `snippets`)."""
_IN_ITEMS = ("let", "for", "if", "prefer", "constrain")
_CLAUSES = {
    "weight": "weight ${1:2}",
    "step": "step ${1:5}",
    "in": "in ${1:0}..${2:9}",
    "rotated": "rotated ${1:45deg}",
    "at": "at (${1:0}, ${2:0})",
}
_NAMES_FIRST = 7.0
_STATEMENTS, _KINDS, _OPERATIONS, _SHAPES, _NAMES, _LOW = 2.0, 1.0, 4.0, 5.0, 3.0, 6.0


def statements(context: Context) -> Iterator[Draft]:
    """Yields the statements possible here: definitions in a body, constraints among constraints."""
    site = context.site
    if context.in_items:
        yield from constraints(context)
        yield from names.values(context)
        yield from _keywords(site, 4.0)
        yield from _calls(context, vocabulary().functions, 7.0)
        return
    yield from kinds(site, _KINDS)
    yield from _keywords(site, _STATEMENTS)
    for draft in names.values(context):
        yield replace(draft, tier=_NAMES + draft.tier / 100)
    yield from _calls(context, vocabulary().operations, _OPERATIONS)
    yield from _shapes(context)
    yield from constraints(context, behind=_LOW)


def kinds(site: EditSite, tier: float) -> Iterator[Draft]:
    """Yields the kinds of structures; the word alone before an existing name."""
    if not site.takes("NAME", "NAME", "{"):
        return
    is_named = site.following.lstrip(" \t")[:1].isidentifier()
    for number, kind in enumerate(KINDS):
        text = kind if is_named else f"{kind} ${{1:name}}" + _BLOCK
        described = partial(of_public, kind)
        yield Draft(kind, "kind", tier + number / 10, text, "structure", not is_named, describe=described)


def _keywords(site: EditSite, tier: float) -> Iterator[Draft]:
    is_top = site.automaton.open_blocks() == 0
    among = vocabulary().statements if site.takes("todo") else _IN_ITEMS
    for number, word in enumerate(among):
        if site.takes(word) and (is_top or word != "import"):
            yield _statement(site, word, tier + number / 100)


def _statement(site: EditSite, word: str, tier: float) -> Draft:
    """Returns a statement with placeholders; the word alone if the statement goes on already."""
    rest = site.following.partition("\n")[0].strip()
    if rest and not rest.startswith("}"):
        return _keyword(word, tier, word)
    text = drafts.written_out(OF_WORD[word]) if word in OF_WORD else word
    return _keyword(word, tier, _OWN.get(word, text))


def _keyword(word: str, tier: float, text: str = "") -> Draft:
    return Draft(word, "keyword", tier, text, is_snippet="$" in text, describe=partial(of_public, word))


def _calls(context: Context, found: tuple[str, ...], tier: float) -> Iterator[Draft]:
    for name in found:
        entry = reference().entries.get(name)
        if (called := context.called(name)) and (entry is None or entry.topic != "path"):
            yield names.call(context, name, called, tier)


def _shapes(context: Context) -> Iterator[Draft]:
    """Yields geometry under a new name: `name = circle(…)`."""
    words = vocabulary()
    own = [name for name, _ in context.callables()]
    if context.site.following.startswith("("):
        return
    for name in (*own, *words.primitives, *words.shapes, *words.templates):
        called = context.called(name)
        is_of_values = (ast.ConstraintDefinition, ast.FunctionDefinition)
        if any(s.standard or s.kind not in is_of_values for s in called):
            draft = names.call(context, name, called, _SHAPES - 0.5 * (name in own))
            yield replace(draft, text=f"${{1:name}} = {name}($2)", is_snippet=True)


def clauses(site: EditSite, *, is_condition: bool) -> Iterator[Draft]:
    """Yields words that continue the present statement: `at`, `in`, `step`, `and`, …"""
    known = (*vocabulary().clauses, "else", "if", *vocabulary().word_operators, "as", "from", "then")
    operand = not site.may_end and site.takes("NUMBER")
    for number, word in enumerate(known):
        if _goes_on(site, word, operand=operand, is_condition=is_condition):
            ends_block = site.spot.before is not None and site.spot.before.kind == "}"
            text = _CLAUSES.get(word, _OWN["else"] if word == "else" and ends_block else word)
            yield _keyword(word, number / 100 + _NAMES_FIRST * operand, text)


def _goes_on(site: EditSite, word: str, *, operand: bool, is_condition: bool) -> bool:
    match word:
        case "as":
            return site.takes("as", "NAME", ";") and not site.automaton.between_statements
        case "from":
            return site.takes("from", "STRING") and not site.takes("NAME")
        case "then":
            return site.takes(word) and not site.takes("NAME")
        case "not":
            return operand and is_condition and site.takes(word)
        case "if":  # behind a value, not as a statement of its own
            may_begin = operand or site.automaton.between_statements
            return not may_begin and site.takes("if", "NAME", "else", "NAME")
        case _:
            return site.takes(word)


def truths(site: EditSite) -> Iterator[Draft]:
    for word in ("true", "false"):
        if site.takes(word) and not site.following.startswith("("):
            yield _keyword(word, 5.0)


def complete(view: View, offset: int, files: Files | None = None) -> list[Completion]:
    """Returns the likeliest `MOST` completions at an offset. `files` lists what may be imported."""
    spot = spot_at(view, offset)
    match spot.where:
        case "comment":
            return []
        case "string":
            found = _in_string(view, spot, files)
        case "number":
            is_behind = spot.offset >= spot.start and (spot.before is None or spot.before.kind != ".")
            found = drafts.units(_of_literal(view, spot)) if is_behind else iter(())
        case _:
            found = _drafts(site_at(view, spot), files)
    prefix = view.source.text[spot.start : spot.offset]
    return drafts.ranked(found, view.span(spot.start, spot.end), prefix)


def _in_string(view: View, spot: Spot, files: Files | None) -> Iterator[Draft]:
    """Yields files of an import, and the words that an attribute or an argument takes."""
    if spot.before is not None and spot.before.kind in ("import", "from"):
        yield from drafts.files(view.path, files)
    elif (context := _of_literal(view, spot)) is None:
        return
    elif (attribute := context.innermost(ast.Attribute)) is not None:
        yield from drafts.of_attribute(attribute.name.text, is_quoted=True)
    else:
        yield from drafts.choices(context, is_quoted=True)


def _of_literal(view: View, spot: Spot) -> Context | None:
    """Returns the context around a string, closed if it is not, or around a number without its unit."""
    assert spot.token is not None
    start, text = spot.token.start, view.source.text
    if spot.where == "string":
        quote = text[start]
        shown = view if spot.token.kind == "STRING" else None
        filled = text[:start] + quote * 2 + text[spot.token.end :]
    else:
        shown = view if spot.start == spot.end else None
        filled = text[: spot.start] + text[spot.end :]
    shown = shown if shown is not None else look(view.path, filled, view.world)
    path = tuple(around(shown.module, start))
    if not isinstance(path[-1], ast.Number | ast.String):
        return None
    here = Spot("code", start, start, start, spot.before)
    return context_of(EditSite(view, here, standing_before(view.source, start), shown, path))


def _drafts(site: EditSite, files: Files | None) -> Iterator[Draft]:
    before = site.spot.before
    kind = before.kind if before is not None else ""
    if kind == "@":
        yield from drafts.attributes(site.following.startswith("("))
    elif kind in ("import", "from"):
        node = next((n for n in reversed(site.path) if isinstance(n, ast.Import)), None)
        if node is not None:
            yield from drafts.imported_names(site, node)
        yield from drafts.files(site.original.path, files, quoted=True)
    elif _is_free(site):
        context = context_of(site)
        if context is not None:
            yield from _by_node(context, files)
        elif not site.may_end or site.takes("NAME", "NAME", "{"):
            yield from kinds(site, 1.0) if not site.automaton.between_statements else ()
        if kind != ".":
            yield from clauses(site, is_condition=context is not None and context.wanted == CONDITION)


def _is_free(site: EditSite) -> bool:
    before = site.spot.before
    if before is None:
        return True
    is_head = before.kind == "NAME" and kind_of(before.text) is not None and site.takes("NAME", "{")
    return before.kind not in _NAMING and not (is_head and not site.may_end)


_NAMING = ("param", "var", "let", "fn", "shape", "constraint", "alias", "for", "as", "construction")


def _by_node(context: Context, files: Files | None) -> Iterator[Draft]:
    site, node, above = context.site, context.site.node, context.site.parent()
    match node, above:
        case ast.Identifier(), ast.Member(value=value):
            yield from members(context, value)
        case ast.Identifier(), ast.Call(receiver=receiver) if receiver is not None:
            yield from members(context, receiver)
        case ast.Identifier(), ast.Call():
            is_statement = isinstance(context.site.parent(2), ast.ExpressionStatement)
            if not is_statement or context.site.begins_statement or not context.site.may_end:
                yield from statements(context) if is_statement else _value(context)
                yield from importing(context, files)
        case ast.Identifier(), ast.Structure() if node is above.kind_word:
            yield from kinds(site, 1.0)
        case ast.Identifier(), ast.Parameter() if node is above.type:
            yield from drafts.types(context)
        case ast.Identifier(), ast.Argument():
            yield from named_arguments(context)
        case ast.Identifier(), ast.Import():
            yield from drafts.imported_names(site, above)
        case ast.Identifier(), ast.Alias() if node is above.target:
            yield from names.calls(context)
            yield from constraints(context)
        case ast.Name(), ast.Argument() if isinstance(attribute := site.parent(2), ast.Attribute):
            yield from drafts.of_attribute(attribute.name.text, is_quoted=False)
        case ast.Name(), _:
            yield from _value(context)
            yield from importing(context, files)


def _value(context: Context) -> Iterator[Draft]:
    above = context.site.parent()
    if isinstance(above, ast.Argument) and context.call is not None:
        if above.name is None:
            yield from named_arguments(context)
        yield from drafts.choices(context, is_quoted=False)
    if isinstance(above, ast.Index) and context.site.node is above.index:
        yield from indices(context, above)
    is_demand = context.use is Use.CONSTRAINT and context.wanted == CONDITION
    if is_demand:
        yield from constraints(context)
    yield from names.values(context)
    if context.wanted.kinds != (types.TextType(),):
        yield from names.calls(context)
    yield from truths(context.site)


__all__ = ["MOST", "Completion", "complete"]
