"""Signature help: the possible forms of the call at a place, and the current parameter."""

from __future__ import annotations

from aidl_lang.checking.calls import arguments
from aidl_lang.common.records import record
from aidl_lang.parser import standing_before
from aidl_lang.syntax import ast
from aidl_lang.syntax.automaton import Automaton
from aidl_lang.syntax.tokens import Token
from aidl_lang.tools.ide.describing import doc_of, is_public, label_of, of_doc, of_parameter
from aidl_lang.tools.ide.nodes import around, scope_at
from aidl_lang.tools.ide.overloads import Reading, readings
from aidl_lang.tools.ide.site import Where, site_at, spot_at
from aidl_lang.tools.ide.view import View


@record()
class ParameterHelp:
    """`place` is its range in the label of its overload, in code points; `about` is Markdown."""

    name: str
    place: tuple[int, int]
    about: str


@record()
class OverloadHelp:
    """`active` is the number of the current parameter; None if the overload has none for it."""

    label: str
    about: str
    parameters: tuple[ParameterHelp, ...]
    active: int | None
    fits: bool


@record()
class SignatureHelp:
    """All overloads of a call, as they are defined; `active` is the number of the meant one."""

    overloads: tuple[OverloadHelp, ...]
    active: int


def signature_help(view: View, offset: int) -> SignatureHelp | None:
    """Returns help for the innermost call whose parentheses, closed or not, contain an offset."""
    spot = spot_at(view, offset)
    if spot.where is Where.COMMENT:
        return None
    offset = spot.offset  # within the text
    opening = _open_call(standing_before(view.source, offset))
    if opening is None:
        return None
    found = _argument_at(view, opening, offset)
    if found is None and spot.where is Where.CODE:
        site = site_at(view, spot)
        view = site.view or view
        found = _argument_at(view, opening, spot.start + 1)
    if found is None:
        return None
    call, argument = found
    everything = readings(view.program, scope_at(view, call.span.start), call)
    ordered = [reading for reading in everything if is_public(reading.signature)] or everything
    if not ordered:
        return None
    best = _best(ordered, argument)
    listed = sorted(ordered, key=_place)
    overloads = tuple(_told(reading, argument) for reading in listed)
    return SignatureHelp(overloads, listed.index(best))


def _open_call(automaton: Automaton) -> Token | None:
    """Returns the innermost open call in the innermost open block."""
    for token in reversed(automaton.open_brackets()):
        if token.kind == "{":
            return None
        if token.kind == "CALL":
            return token
    return None


def _argument_at(view: View, opening: Token, offset: int) -> tuple[ast.Call, int] | None:
    """Returns the call that begins with a token, and the number of the argument at an offset, the receiver
    counted. Returns None if it has arguments, and the offset lies in none.
    """
    for node in around(view.module, opening.start):
        if isinstance(node, ast.Call) and node.callee.span.start == opening.start:
            before = len(arguments(view.program.inference, node)) - len(node.arguments)
            for number, argument in enumerate(node.arguments):
                if argument.span.start <= offset <= argument.span.end:
                    return node, before + number
            return None if node.arguments else (node, before)
    return None


def _place(reading: Reading) -> tuple[int, str, int]:
    """Returns the sort key of definitions in the order of writing, built-ins first."""
    node = reading.signature.node
    return (0, "", 0) if node is None else (1, node.span.source.name, node.span.start)


def _best(ordered: list[Reading], argument: int) -> Reading:
    """Returns the meant overload: the first of those that fit alike and have a parameter for the argument."""
    alike = [r for r in ordered if r.cost == ordered[0].cost]
    having = [r for r in alike if _parameter(r, argument) is not None]
    return (having or alike)[0]


def _parameter(reading: Reading, argument: int) -> int | None:
    """Returns the number of the parameter that an argument fills; the next one before it is written."""
    names = [name for name, _, _ in reading.signature.parameters]
    if argument >= len(reading.taken):
        return next((n for n, name in enumerate(names) if name not in reading.taken), None)
    taken = reading.taken[argument]
    return names.index(taken) if taken in names else None


def _told(reading: Reading, argument: int) -> OverloadHelp:
    signature = reading.signature
    label = label_of(signature)
    parameters = tuple(
        ParameterHelp(name, place, of_parameter(signature, name))
        for (name, _, _), place in zip(signature.parameters, label.parameters, strict=True)
    )
    about = of_doc(doc_of(signature))
    return OverloadHelp(label.text, about, parameters, _parameter(reading, argument), reading.fits)
