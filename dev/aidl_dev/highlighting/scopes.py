"""What editors call the classes, and the rules of TextMate as data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

Rule: TypeAlias = dict[str, object]

_NAMES: Mapping[str, tuple[str, ...]] = {
    "comment.line": ("comment.line", "comment", "comment.line"),
    "comment.documentation": (
        "comment.line.documentation",
        "comment.documentation",
        "comment.line.documentation",
    ),
    "comment.block": ("comment.block", "comment", "comment.block"),
    "keyword.declaration": ("keyword.declaration", "keyword", "keyword.storage.type"),
    "keyword.demand": ("keyword.other.demand", "keyword"),
    "keyword.modifier": ("storage.modifier", "keyword.modifier", "keyword.storage.modifier"),
    "keyword.control": ("keyword.control", "keyword.conditional", "keyword.control.conditional"),
    "keyword.control for": ("", "keyword.repeat", "keyword.control.repeat"),
    "keyword.import": ("keyword.control.import", "keyword.import", "keyword.control.import"),
    "keyword.clause": ("keyword.other.clause", "keyword"),
    "keyword.operator": ("keyword.operator.expression", "keyword.operator"),
    "constant.truth": ("constant.language.boolean", "boolean", "constant.builtin.boolean"),
    "operator.comparison": ("keyword.operator.comparison", "operator"),
    "operator.arithmetic": ("keyword.operator.arithmetic", "operator"),
    "operator.logic": ("keyword.operator.logical", "operator"),
    "operator.range": ("keyword.operator.range", "operator"),
    "operator.assignment": ("keyword.operator.assignment", "operator"),
    "bracket": ("punctuation.section", "punctuation.bracket"),
    "punctuation": ("punctuation.separator", "punctuation.delimiter"),
    "attribute.sign": ("punctuation.definition.annotation", "attribute"),
    "attribute": ("entity.other.attribute-name", "attribute"),
    "kind": ("storage.type.kind", "keyword.type", "keyword.storage.type"),
    "name.structure": ("entity.name.type.structure", "type"),
    "name.template": ("entity.name.type.template", "type"),
    "name.function": ("entity.name.function.definition", "function"),
    "name.definition": ("variable.other.definition", "variable"),
    "name.parameter": ("variable.parameter.definition", "variable.parameter"),
    "name.argument": ("variable.parameter.argument", "variable.parameter"),
    "name.type": ("support.type", "type"),
    "name.member": ("variable.other.property", "variable.member", "variable.other.member"),
    "name.everywhere": ("variable.language", "variable.builtin"),
    "name.constant": ("support.constant", "constant.builtin"),
    "name.module": ("entity.name.namespace", "module", "namespace"),
    "name": ("variable.other.readwrite", "variable"),
    "call.shape": ("support.class.shape", "constructor"),
    "call.constraint": ("support.function.constraint", "function.builtin"),
    "call.function": ("support.function.library", "function.builtin"),
    "call.member": ("entity.name.function.call.member", "function.method.call", "function.method"),
    "call": ("entity.name.function.call", "function.call", "function"),
    "number": ("constant.numeric", "number", "constant.numeric"),
    "unit": ("keyword.other.unit", "type.builtin"),
    "string": ("string.quoted", "string"),
    "escape": ("constant.character.escape", "string.escape", "constant.character.escape"),
    "unknown": ("invalid.illegal", "comment.error", "error"),
}
"""What TextMate and Neovim call each class, and Helix where it has another name than Neovim. The scope of
TextMate goes on with `.aidl` in the grammar, in some after further words; Neovim's names are mostly those of
tree-sitter's command line and of Zed.
"""
SCOPES = {kind: names[0] for kind, names in _NAMES.items() if names[0]}
NEOVIM = {kind: names[1] for kind, names in _NAMES.items()}
HELIX = {kind: names[-1] for kind, names in _NAMES.items()}


def scope(written: str) -> str:
    """Returns the scope of `class`, or of `class/more.words` for a more precise one."""
    kind, _, more = written.partition("/")
    return ".".join(filter(None, (SCOPES[kind], more, "aidl")))


def match(pattern: str, *groups: str, whole: str = "") -> Rule:
    """Returns a rule for a pattern: the classes of its groups, "" for one without, and that of the whole."""
    rule: Rule = {"match": pattern}
    if whole:
        rule["name"] = scope(whole)
    return rule | ({"captures": _captures(groups)} if groups else {})


def region(
    begin: str, end: str, *inside: str | Rule, begins: Sequence[str] = (), ends: Sequence[str] = ()
) -> Rule:
    """Returns a rule for the text between two patterns; rules inside go by their names in the repository."""
    rule: Rule = {
        "begin": begin,
        "end": end,
        "patterns": [p if isinstance(p, dict) else include(p) for p in inside],
    }
    if begins:
        rule["beginCaptures"] = _captures(begins)
    return rule | ({"endCaptures": _captures(ends)} if ends else {})


def include(name: str) -> Rule:
    return {"include": f"#{name}"}


def _captures(groups: Sequence[str]) -> Rule:
    return {str(number): {"name": scope(group)} for number, group in enumerate(groups, 1) if group}
