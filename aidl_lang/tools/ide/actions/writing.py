"""Writes solved values into the text: at the cursor or selection, and everywhere."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import Span
from aidl_lang.tools.ide.actions.action import Action
from aidl_lang.tools.ide.nodes import structures_around
from aidl_lang.tools.ide.view import View
from aidl_lang.tools.ide.writing_back import can_write_back, write_back

_TITLES = {False: "Write solved values back as first guesses", True: "Write changed sizes back"}


def writings(view: View, start: int, end: int) -> Iterator[Action]:
    """Yields actions for the selection, or else the innermost structure around the cursor; and for the whole
    file.
    """
    if view.outcome is None:
        return
    part, where = _part(view, start, end)
    for sizes, title in _TITLES.items():
        if part is not None and can_write_back(view, part, sizes=sizes):
            yield _action(view, part, f"{title}: {where}", sizes=sizes)
        if can_write_back(view, sizes=sizes):
            yield _action(view, None, title, sizes=sizes)


def _part(view: View, start: int, end: int) -> tuple[Span | None, str]:
    """Returns a part of the text with its name."""
    if start < end:
        return view.span(start, end), "selection"
    node = next(structures_around(view, start), None)
    return (None, "") if node is None else (node.span, f"`{node.name.text}`")


def _action(view: View, part: Span | None, title: str, *, sizes: bool) -> Action:
    return Action(title, "refactor.rewrite", partial(_written, view, part, sizes=sizes))


def _written(view: View, part: Span | None, *, sizes: bool) -> Sequence[Edit]:
    return write_back(view, part, sizes=sizes).edits
