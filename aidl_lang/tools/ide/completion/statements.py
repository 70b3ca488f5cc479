"""Completion of statements and of the words that continue one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from aidl_lang.syntax import ast
from aidl_lang.syntax.words import KINDS
from aidl_lang.tools.ide.completion import names
from aidl_lang.tools.ide.completion.constraints import constraints
from aidl_lang.tools.ide.completion.context import Context
from aidl_lang.tools.ide.completion.draft import Draft, written_out
from aidl_lang.tools.ide.signatures import of_public
from aidl_lang.tools.ide.site import EditSite
from aidl_lang.tools.reference.collect import reference
from aidl_lang.tools.snippets import OF_WORD
from aidl_lang.tools.vocabulary import vocabulary

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
