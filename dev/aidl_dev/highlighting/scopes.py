"""TextMate's names of the classes, and its rules as data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

Rule: TypeAlias = dict[str, object]

SCOPES: Mapping[str, str] = {
    "comment.line": "comment.line",
    "comment.documentation": "comment.line.documentation",
    "comment.block": "comment.block",
    "keyword.declaration": "keyword.declaration",
    "keyword.demand": "keyword.other.demand",
    "keyword.modifier": "storage.modifier",
    "keyword.control": "keyword.control",
    "keyword.import": "keyword.control.import",
    "keyword.clause": "keyword.other.clause",
    "keyword.operator": "keyword.operator.expression",
    "constant.truth": "constant.language.boolean",
    "operator.comparison": "keyword.operator.comparison",
    "operator.arithmetic": "keyword.operator.arithmetic",
    "operator.logic": "keyword.operator.logical",
    "operator.range": "keyword.operator.range",
    "operator.assignment": "keyword.operator.assignment",
    "bracket": "punctuation.section",
    "punctuation": "punctuation.separator",
    "attribute.sign": "punctuation.definition.annotation",
    "attribute": "entity.other.attribute-name",
    "kind": "storage.type.kind",
    "name.structure": "entity.name.type.structure",
    "name.template": "entity.name.type.template",
    "name.function": "entity.name.function.definition",
    "name.definition": "variable.other.definition",
    "name.parameter": "variable.parameter.definition",
    "name.argument": "variable.parameter.argument",
    "name.type": "support.type",
    "name.member": "variable.other.property",
    "name.everywhere": "variable.language",
    "name.constant": "support.constant",
    "name.module": "entity.name.namespace",
    "name": "variable.other.readwrite",
    "call.shape": "support.class.shape",
    "call.constraint": "support.function.constraint",
    "call.function": "support.function.library",
    "call.member": "entity.name.function.call.member",
    "call": "entity.name.function.call",
    "number": "constant.numeric",
    "unit": "keyword.other.unit",
    "string": "string.quoted",
    "escape": "constant.character.escape",
    "unknown": "invalid.illegal",
}
"""The scope of each class. In the grammar `.aidl` follows, in some after further words."""


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
