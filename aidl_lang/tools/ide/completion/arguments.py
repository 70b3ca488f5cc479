"""Completion of named arguments that a call does not have yet."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import partial

from aidl_lang.checking.types import ListType, NumberType, PointType, Signature, TextType, TruthType, Type
from aidl_lang.checking.units import ANGLE
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.completion.context import Context
from aidl_lang.tools.ide.completion.draft import Draft, stop
from aidl_lang.tools.ide.completion.words import words_of
from aidl_lang.tools.ide.describing import is_public, of_parameter
from aidl_lang.tools.ide.meaning import parameter_node
from aidl_lang.tools.ide.overloads import Reading
from aidl_lang.tools.reference.signatures import things

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


def _open(reading: Reading, number: int) -> list[tuple[str, Type, bool]]:
    """Returns the parameters that no other argument fills."""
    taken = {name for n, name in enumerate(reading.taken) if n != number}
    node = reading.signature.node
    related = {p.name.text for p in things(node)} if isinstance(node, ast.ConstraintDefinition) else set()
    return [p for p in reading.signature.parameters if p[0] not in taken and p[0] not in related]


def _argument(context: Context, signature: Signature, name: str, kind: Type, tier: float) -> Draft:
    default = _default(signature, name)
    is_named = _NAMED.match(context.site.following) is not None
    text = name if is_named else f"{name}: {_proposed(signature, name, kind, default)}"
    return Draft(
        f"{name}:",
        "argument",
        tier,
        text,
        str(kind) + (f" = {default}" if default else ""),
        not is_named,
        describe=partial(of_parameter, signature, name),
    )


def _default(signature: Signature, name: str) -> str:
    node = parameter_node(signature, name)
    return node.default.span.one_line if node is not None and node.default is not None else ""


def _proposed(signature: Signature, name: str, kind: Type, default: str) -> str:
    """Returns a snippet placeholder with a value that the parameter takes."""
    if isinstance(kind, TextType) and (words := words_of(signature, name)):
        listed = [word if word.isidentifier() else f'"{word}"' for word in words if word != "free"]
        return f"${{1|{','.join(listed)}|}}"
    if default and len(default) < _LONGEST_DEFAULT:
        return stop(1, default)
    match kind:
        case NumberType(dimension, whole):
            return stop(1, "45deg" if dimension == ANGLE else "3" if whole else "10")
        case PointType():
            return "(${1:0}, ${2:0})"
        case TextType():
            return '"${1:text}"'
        case TruthType():
            return "${1|true,false|}"
        case ListType():
            return f"[{stop(1, name)}]"
        case _:
            return stop(1, name)
