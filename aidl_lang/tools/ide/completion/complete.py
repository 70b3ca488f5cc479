"""Completion at a place: finds the kind of place and collects its drafts."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.checking.types import TextType
from aidl_lang.parser import standing_before
from aidl_lang.syntax import ast
from aidl_lang.syntax.words import kind_of
from aidl_lang.tools.ide.completion import names, words
from aidl_lang.tools.ide.completion.constraints import constraints
from aidl_lang.tools.ide.completion.context import CONDITION, Context, Use, context_of
from aidl_lang.tools.ide.completion.draft import Completion, Draft, ranked
from aidl_lang.tools.ide.completion.members import indices, members, named_arguments
from aidl_lang.tools.ide.completion.names import importing
from aidl_lang.tools.ide.completion.statements import clauses, kinds, statements, truths
from aidl_lang.tools.ide.completion.words import Files
from aidl_lang.tools.ide.site import EditSite, Spot, Where, around, site_at, spot_at
from aidl_lang.tools.ide.workspace import View, look


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
        yield from words.files(view.path, files)
        return
    context = _of_literal(view, spot)
    if context is None:
        return
    attribute = next((n for n in reversed(context.path) if isinstance(n, ast.Attribute)), None)
    if attribute is not None:
        yield from words.of_attribute(attribute.name.text, is_quoted=True)
    else:
        yield from words.choices(context, is_quoted=True)


def _behind_number(view: View, spot: Spot) -> Iterator[Draft]:
    if spot.offset >= spot.start and (spot.before is None or spot.before.kind != "."):
        yield from words.units(_of_literal(view, spot))


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
        yield from words.attributes(site.following.startswith("("))
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
        yield from words.imported_names(site, node)
    yield from words.files(site.original.path, files, quoted=True)


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
            yield from words.types(context)
        case ast.Identifier(), ast.Argument():
            yield from named_arguments(context)
        case ast.Identifier(), ast.Import():
            yield from words.imported_names(site, above)
        case ast.Identifier(), ast.Alias() if node is above.target:
            yield from names.calls(context)
            yield from constraints(context)
        case ast.Name(), ast.Argument() if _attribute(context) is not None:
            attribute = _attribute(context)
            assert attribute is not None
            yield from words.of_attribute(attribute.name.text, is_quoted=False)
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
        yield from words.choices(context, is_quoted=False)
    if isinstance(above, ast.Index) and context.site.node is above.index:
        yield from indices(context, above)
    is_demand = context.use is Use.CONSTRAINT and context.wanted == CONDITION
    if is_demand:
        yield from constraints(context)
    yield from names.values(context)
    if context.wanted.types != (TextType(),):
        yield from names.calls(context)
    yield from truths(context.site)
