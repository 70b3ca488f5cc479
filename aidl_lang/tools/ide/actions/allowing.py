"""Notes and warnings at a selection, kept from being told by an `@allow` before the statement."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from aidl_lang import parser
from aidl_lang.checking.allowing import IDLE
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.names import fold
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.actions.action import Action
from aidl_lang.tools.ide.edits import applied
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.ide.view import View


def allowances(view: View, start: int, end: int) -> Iterator[Action]:
    """Yields, for each note and warning at a selection, the action that silences it where it is."""
    for d in view.diagnostics:
        place = d.span
        if d.is_error or d.code == IDLE or place is None or place.source is not view.source:
            continue
        if place.start <= end and start <= place.end:
            yield Action(f"Allow {d.code} here", "quickfix", partial(_allowing, view, d.code, place), d)


def _allowing(view: View, code: str, place: Span) -> Sequence[Edit]:
    """Returns the edits that allow a code in the innermost statement about a place that can have it."""
    around = [
        node
        for node in ast.walk(view.resolution.main)
        if isinstance(node, ast.Allowing | ast.Structure | ast.Assign)
        and node.span.start <= place.start
        and place.end <= node.span.end
    ]
    for node in reversed(around):
        edits = [_edit(node, code)]
        changed = SourceFile(view.source.name, applied(view.source.text, edits))
        if not any(d.is_error for d in parser.parse(changed).diagnostics):
            return edits
    raise CannotError("there is no statement about it that could have an `@allow`")


def _edit(node: ast.Allowing | ast.Structure | ast.Assign, code: str) -> Edit:
    source, start = node.span.source, node.span.start
    for attribute in ast.attributes(node):
        if fold(attribute.name.text) == ast.ALLOW and attribute.arguments:
            end = attribute.arguments[-1].span.end
            return Edit(Span(source, end, end), f', "{code}"')
    before = source.text[source.text.rfind("\n", 0, start) + 1 : start]
    between = " " if before.strip() else f"\n{before}"
    return Edit(Span(source, start, start), f'@allow("{code}"){between}')
