"""The edits that come with diagnostics, one by one and all together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.tools.ide.actions.action import Action
from aidl_lang.tools.ide.edits import between
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.ide.view import View
from aidl_lang.tools.mending import mend

_CONFLICTS = frozenset({"E0601", "E0602", "E0603", "E0605"})


def fixes(view: View, start: int, end: int) -> Iterator[Action]:
    """Yields fixes for diagnostics at a selection; for a conflict, those of each constraint in it."""
    near = [d for d in view.diagnostics if any(_is_at(view, p, start, end) for p in _places(d))]
    offered: list[Fix] = []
    for d in near:
        if d.fix is not None:
            offered.append(d.fix)
            yield _action(d.fix, d, is_preferred=d.is_error and d.fix.is_sure)
    for d in near:
        for fix in _remedies(view, d):
            if fix not in offered:
                offered.append(fix)
                yield _action(fix, d, is_preferred=False)
    if any(d.fix is not None and d.fix.is_sure for d in view.diagnostics):
        yield Action("Apply all fixes", "source.fixAll", lambda: _everything(view))


def _places(d: Diagnostic) -> list[tuple[object, int, int]]:
    spans = [d.span, *(label.span for label in d.secondary)]
    return [(span.source, span.start, span.end) for span in spans if span is not None]


def _is_at(view: View, place: tuple[object, int, int], start: int, end: int) -> bool:
    source, first, last = place
    return source is view.source and first <= end and start <= last


def _remedies(view: View, d: Diagnostic) -> Iterator[Fix]:
    """Yields the fixes for each of the constraints in a conflict."""
    if d.code not in _CONFLICTS or view.outcome is None:
        return
    for conflict in view.outcome.conflicts():
        if any(party.span == d.span for party in conflict.parties):
            yield from (party.fix for party in conflict.parties if party.fix is not None)


def _action(fix: Fix, d: Diagnostic, *, is_preferred: bool) -> Action:
    title = fix.title[:1].upper() + fix.title[1:]
    return Action(title, "quickfix", lambda: fix.edits, d, is_preferred)


def _everything(view: View) -> Sequence[Edit]:
    mended = mend(view.source, view.world)
    if mended.source.text == view.source.text:
        raise CannotError("the fixes stand in files that this one imports, or make nothing better")
    return between(view.source, mended.source.text)
