"""The queries by which editors colour the nodes of the tree-sitter grammar.

Editors have different names for the colours and one language for queries: a node is named by what stands
around it. Where several patterns fit, the last one holds; so the general ones come first.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping

from aidl_dev.highlighting.scopes import HELIX, NEOVIM
from aidl_lang.tools.highlighting import called, fixed_classes
from aidl_lang.tools.vocabulary import vocabulary

FOLDER = "editors/tree-sitter-aidl/queries"

_PATTERNS = (
    ("comment.line", "(line_comment) $"),
    ("comment.documentation", "(doc_comment) $"),
    ("comment.block", "(block_comment) $"),
    ("number", "(number) $"),
    ("unit", "(unit) $"),
    ("unknown", "[(unknown_unit) (ellipsis)] $"),
    ("string", "(string) $"),
    ("escape", "(escape_sequence) $"),
    ("constant.truth", "[(true) (false)] $"),
    ("keyword.demand", "(todo_statement) $"),
)
"""Tokens that are nodes, with their classes; `$` stands for the name of the colour."""

_NAMES = (
    ("name.member", "(member_expression property: (identifier) $)"),
    ("name.argument", "(named_argument name: (identifier) $)"),
    ("call", "(call_expression function: (identifier) $)"),
    ("call.member", "(call_expression function: (member_expression property: (identifier) $))"),
)
_CALLED = "(call_expression function: [(identifier) $ (member_expression property: (identifier) $)])"
_DEFINED = (
    ("kind", "(structure kind: (identifier) $)"),
    ("name.structure", "(structure name: (identifier) $)"),
    ("name.template", "(structure name: (identifier) $ parameters: (parameters))"),
    ("attribute", "(attribute name: (identifier) $)"),
    ("name.parameter", "(parameter name: (identifier) $)"),
    ("name.type", "(parameter type: (identifier) $)"),
    ("name.function", "(function_definition name: (identifier) $)"),
    ("name.function", "(shape_definition name: (identifier) $)"),
    ("name.function", "(constraint_definition name: (identifier) $)"),
    ("name.definition", "(param_declaration name: (identifier) $)"),
    ("name.definition", "(var_declaration name: (identifier) $)"),
    ("name.definition", "(let_declaration name: (identifier) $)"),
    ("name.definition", "(alias_declaration name: (identifier) $)"),
    ("name.definition", "(import_statement name: (identifier) $)"),
    ("name.definition", "(import_statement alias: (identifier) $)"),
    ("name.definition", "(variables (identifier) $)"),
    ("name.definition", "(assignment target: (identifier) $)"),
    ("name.definition", "(assignment target: (index_expression object: (identifier) $))"),
    (
        "name.definition",
        "(assignment target: (index_expression object: (index_expression object: (identifier) $)))",
    ),
)
"""Names by their place, with their classes."""


def highlights(captures: Mapping[str, str]) -> str:
    """Returns the query for colours, by an editor's names of the classes."""
    parts = ["; Made by `make colours`; do not edit."]
    for kind, pattern in _in_order():
        parts.append(pattern.replace("$", f"@{captures[kind]}"))
    return "\n\n".join(parts) + "\n"


def queries() -> dict[str, str]:
    """Returns every generated query by its path in a checkout."""
    return {
        f"{FOLDER}/highlights.scm": highlights(NEOVIM),
        f"{FOLDER}/helix/highlights.scm": highlights(HELIX),
    }


def _in_order() -> Iterator[tuple[str, str]]:
    words = vocabulary()
    yield from _PATTERNS
    yield from _tokens()
    yield "name", "(identifier) $"
    yield "name.everywhere", _listed("(identifier) $", words.everywhere)
    yield "name.constant", _listed("(identifier) $", words.constants)
    yield "name.module", _listed("(member_expression object: (identifier) $)", words.modules)
    yield from _NAMES
    lists: dict[str, list[str]] = {}
    for name, kind in called().items():
        lists.setdefault(kind, []).append(name)
    for kind, names in lists.items():
        yield kind, _listed(_CALLED, names)
    yield from _DEFINED


def _tokens() -> Iterator[tuple[str, str]]:
    """Yields words and signs that are no nodes of their own, those of one class in a row."""
    lists: dict[str, list[str]] = {}
    for text, kind in fixed_classes().items():
        if kind != "constant.truth" and text != "todo":
            lists.setdefault("keyword.control for" if text == "for" else kind, []).append(text)
    for kind, texts in lists.items():
        yield kind, f"[{' '.join(map(json.dumps, texts))}] $"


def _listed(pattern: str, names: Iterable[str]) -> str:
    """Returns a pattern for one of these names, in lines that can be read."""
    lines, line = [], ""
    for name in map(json.dumps, names):
        if line and len(line) + len(name) > 100:
            lines.append(line)
            line = ""
        line = f"{line} {name}" if line else name
    inside = "\n    ".join([*lines, line])
    return f"({pattern}\n  (#any-of? $\n    {inside}))"
