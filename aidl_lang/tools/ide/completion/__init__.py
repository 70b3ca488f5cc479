"""Completion at a place: finds the kind of place and collects its drafts; those of statements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from aidl_lang.checking.types import TextType
from aidl_lang.parser import standing_before
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import KINDS, kind_of
from aidl_lang.tools.ide.completion import drafts, names
from aidl_lang.tools.ide.completion.constraints import constraints
from aidl_lang.tools.ide.completion.context import CONDITION, Context, Use, context_of
from aidl_lang.tools.ide.completion.drafts import MOST, Completion, Draft, Files, ranked, written_out
from aidl_lang.tools.ide.completion.members import indices, members, named_arguments
from aidl_lang.tools.ide.completion.names import importing
from aidl_lang.tools.ide.signatures import of_public
from aidl_lang.tools.ide.site import EditSite, Spot, Where, around, site_at, spot_at
from aidl_lang.tools.ide.workspace import View, look
from aidl_lang.tools.reference.collect import reference
from aidl_lang.tools.snippets import OF_WORD
from aidl_lang.tools.vocabulary import vocabulary

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
_AT_TOP = ("import",)
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
        yield _later(draft, _NAMES)
    yield from _operations(context)
    yield from _shapes(context)
    yield from constraints(context, behind=_LOW)


def _later(draft: Draft, tier: float) -> Draft:
    return replace(draft, tier=tier + draft.tier / 100)


def kinds(site: EditSite, tier: float) -> Iterator[Draft]:
    """Yields the kinds of structures; the word alone before an existing name."""
    if not site.takes("NAME", "NAME", "{"):
        return
    is_named = site.following.lstrip(" \t")[:1].isidentifier()
    for number, kind in enumerate(KINDS):
        text = kind if is_named else f"{kind} ${{1:name}}" + _BLOCK
        yield Draft(
            kind,
            "kind",
            tier + number / 10,
            text,
            "structure",
            not is_named,
            describe=partial(of_public, kind),
        )


def _keywords(site: EditSite, tier: float) -> Iterator[Draft]:
    words = vocabulary()
    is_top = site.automaton.open_blocks() == 0
    among = _IN_ITEMS if not site.takes("todo") else words.statements
    for number, word in enumerate(among):
        if site.takes(word) and (is_top or word not in _AT_TOP):
            yield _statement(site, word, tier + number / 100)


def _statement(site: EditSite, word: str, tier: float) -> Draft:
    """Returns a statement with placeholders; the word alone if the statement goes on already."""
    rest = site.following.partition("\n")[0].strip()
    is_alone = not rest or rest.startswith("}")
    text = _beginning(word) if is_alone else word
    return Draft(word, "keyword", tier, text, is_snippet="$" in text, describe=partial(of_public, word))


def _beginning(word: str) -> str:
    if word in _OWN:
        return _OWN[word]
    return written_out(OF_WORD[word]) if word in OF_WORD else word


def _operations(context: Context) -> Iterator[Draft]:
    """Yields statements that change existing geometry: `fillet(…)`, `move(…)`, `union(…)`."""
    yield from _calls(context, vocabulary().operations, _OPERATIONS)


def _calls(context: Context, found: tuple[str, ...], tier: float) -> Iterator[Draft]:
    for name in found:
        called = context.scope.called(name)
        entry = reference().entries.get(name)
        if called is not None and (entry is None or entry.topic != "path"):
            yield names.call(context, name, called[1], tier)


def _shapes(context: Context) -> Iterator[Draft]:
    """Yields geometry under a new name: `name = circle(…)`."""
    words = vocabulary()
    own = [name for name, _ in context.callables()]
    if context.site.following.startswith("("):
        return
    for name in (*own, *words.primitives, *words.shapes, *words.templates):
        called = context.scope.called(name)
        if called is None or all(
            s.kind in (ast.ConstraintDefinition, ast.FunctionDefinition) and not s.standard for s in called[1]
        ):
            continue
        draft = names.call(context, name, called[1], _SHAPES - 0.5 * (name in own))
        yield Draft(
            name,
            draft.kind,
            draft.tier,
            f"${{1:name}} = {name}($2)",
            draft.detail,
            is_snippet=True,
            describe=draft.describe,
        )


# --- Words that go on ------------------------------------------------------------------------------


def clauses(site: EditSite, *, is_condition: bool = True) -> Iterator[Draft]:
    """Yields words that continue the present statement: `at`, `in`, `step`, `and`, …"""
    words = vocabulary()
    operand = not site.may_end and site.takes("NUMBER")
    for number, word in enumerate(
        (*words.clauses, "else", "if", *words.word_operators, "as", "from", "then")
    ):
        if _goes_on(site, word, operand=operand, is_condition=is_condition):
            text = _CLAUSES.get(word, _OWN["else"] if word == "else" and _ends_block(site) else word)
            yield Draft(
                word,
                "keyword",
                number / 100 + _NAMES_FIRST * operand,
                text,
                is_snippet="$" in text,
                describe=partial(of_public, word),
            )


def _ends_block(site: EditSite) -> bool:
    return site.spot.before is not None and site.spot.before.kind == "}"


def _goes_on(site: EditSite, word: str, *, operand: bool, is_condition: bool) -> bool:
    if word in ("as", "from", "then"):
        return _soft(site, word)
    if word == "not":
        return operand and is_condition and site.takes(word)
    if word == "if":  # behind a value, not as a statement of its own
        return (
            not operand and not site.automaton.between_statements and site.takes("if", "NAME", "else", "NAME")
        )
    return site.takes(word)


def _soft(site: EditSite, word: str) -> bool:
    """Tells whether a contextual keyword, elsewhere a name, is a keyword here."""
    match word:
        case "as":
            return site.takes("as", "NAME", ";") and not site.automaton.between_statements
        case "from":
            return site.takes("from", "STRING") and not site.takes("NAME")
        case _:
            return site.takes(word) and not site.takes("NAME")


def truths(site: EditSite) -> Iterator[Draft]:
    for word in ("true", "false"):
        if site.takes(word) and not site.following.startswith("("):
            yield Draft(word, "keyword", 5.0, describe=partial(of_public, word))


def complete(view: View, offset: int, files: Files | None = None) -> list[Completion]:
    """Returns the completions at an offset, the likeliest first, at most `MOST`. `files` lists the programs
    of the workspace, for imports.
    """
    spot = spot_at(view, offset)
    match spot.where:
        case Where.COMMENT:
            return []
        case Where.STRING:
            drafts = list(_in_string(view, spot, files))
        case Where.NUMBER:
            drafts = list(_behind_number(view, spot))
        case _:
            return _in_code(view, spot, files)
    prefix = view.source.text[spot.start : spot.offset]
    return ranked(drafts, view.span(spot.start, spot.end), prefix)


# --- Strings and numbers ---------------------------------------------------------------------------


def _in_string(view: View, spot: Spot, files: Files | None) -> Iterator[Draft]:
    """Yields files of an import, and the words that an attribute or an argument takes."""
    before = spot.before
    if before is not None and before.kind in ("import", "from"):
        yield from drafts.files(view.path, files)
        return
    context = _of_literal(view, spot)
    if context is None:
        return
    attribute = next((n for n in reversed(context.path) if isinstance(n, ast.Attribute)), None)
    if attribute is not None:
        yield from drafts.of_attribute(attribute.name.text, is_quoted=True)
    else:
        yield from drafts.choices(context, is_quoted=True)


def _behind_number(view: View, spot: Spot) -> Iterator[Draft]:
    if spot.offset >= spot.start and (spot.before is None or spot.before.kind != "."):
        yield from drafts.units(_of_literal(view, spot))


def _of_literal(view: View, spot: Spot) -> Context | None:
    """Returns the context around a string, closed if it is not, or around a number without its unit."""
    assert spot.token is not None
    start, text = spot.token.start, view.source.text
    if spot.where is Where.STRING:
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
    automaton = standing_before(view.source, start)
    return context_of(
        EditSite(view, Spot(Where.CODE, start, start, start, spot.before), automaton, shown, path)
    )


# --- Code ------------------------------------------------------------------------------------------


def _in_code(view: View, spot: Spot, files: Files | None) -> list[Completion]:
    site = site_at(view, spot)
    return ranked(_drafts(site, files), site.replaced, site.prefix)


def _drafts(site: EditSite, files: Files | None) -> Iterator[Draft]:
    before = site.spot.before
    kind = before.kind if before is not None else ""
    if kind == "@":
        yield from drafts.attributes(site.following.startswith("("))
    elif kind in ("import", "from"):
        yield from _of_import(site, files)
    elif _is_free(site):
        context = context_of(site)
        if context is not None:
            yield from _by_node(context, files)
        elif not site.may_end or site.takes("NAME", "NAME", "{"):
            yield from kinds(site, 1.0) if not site.automaton.between_statements else ()
        if kind != ".":
            yield from clauses(site, is_condition=context is not None and context.wanted == CONDITION)


def _of_import(site: EditSite, files: Files | None) -> Iterator[Draft]:
    node = next((n for n in reversed(site.path) if isinstance(n, ast.Import)), None)
    if node is not None:
        yield from drafts.imported_names(site, node)
    yield from drafts.files(site.original.path, files, quoted=True)


def _is_free(site: EditSite) -> bool:
    """Tells whether anything can be proposed: not where a new name is given."""
    before = site.spot.before
    if before is None:
        return True
    is_head = before.kind == "NAME" and kind_of(before.text) is not None and site.takes("NAME", "{")
    return before.kind not in _NAMING and not (is_head and not site.may_end)


_NAMING = ("param", "var", "let", "fn", "shape", "constraint", "alias", "for", "as", "construction")


def _by_node(context: Context, files: Files | None) -> Iterator[Draft]:
    """Yields drafts by the node that the placeholder became."""
    site, node, above = context.site, context.site.node, context.site.parent()
    match node, above:
        case ast.Identifier(), ast.Member(value=value):
            yield from members(context, value)
        case ast.Identifier(), ast.Call(receiver=receiver) if receiver is not None:
            yield from members(context, receiver)
        case ast.Identifier(), ast.Call():
            yield from _at_call(context, files)
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
        case ast.Name(), ast.Argument() if _attribute(context) is not None:
            attribute = _attribute(context)
            assert attribute is not None
            yield from drafts.of_attribute(attribute.name.text, is_quoted=False)
        case ast.Name(), _:
            yield from _value(context)
            yield from importing(context, files)
        case _:
            pass


def _attribute(context: Context) -> ast.Attribute | None:
    above = context.site.parent(2)
    return above if isinstance(above, ast.Attribute) else None


def _at_call(context: Context, files: Files | None) -> Iterator[Draft]:
    """Yields statements for a call by itself, values for any other."""
    if isinstance(context.site.parent(2), ast.ExpressionStatement):
        if context.site.begins_statement or not context.site.may_end:
            yield from statements(context)
            yield from importing(context, files)
    else:
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
    if context.wanted.types != (TextType(),):
        yield from names.calls(context)
    yield from truths(context.site)


__all__ = ["MOST", "Completion", "complete"]
