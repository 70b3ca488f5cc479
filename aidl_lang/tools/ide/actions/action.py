"""An offer to change a program."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from aidl_lang.common.diagnostics import Diagnostic, Edit
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.export import ExportError
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.ide.view import View


@record()
class Action:
    """A code action.

    kind    `quickfix`, `refactor.extract`, `refactor.rewrite` or `source.fixAll`, as editors sort them
    make    returns the edits; raises CannotError
    mends   the diagnostic that it is for
    """

    title: str
    kind: str
    make: Callable[[], Sequence[Edit]]
    mends: Diagnostic | None = None
    is_preferred: bool = False


def drawn_alike(one: View, other: View) -> bool:
    """Tells whether two programs solve and draw the same picture. Raises CannotError if a picture cannot be
    made.
    """
    outcomes = [view.outcome for view in (one, other)]
    if any(outcome is None or not outcome.ok for outcome in outcomes):
        return False
    try:
        first, second = (outcome.export(".svg") for outcome in outcomes if outcome is not None)
    except ExportError as reason:
        raise CannotError(str(reason)) from None
    return first == second


def first_error(view: View) -> str:
    """Returns the first error of a program, in one sentence."""
    return next((d.message for d in view.diagnostics if d.is_error), "the drawing would change")


def is_here(source: SourceFile, edits: Sequence[Edit]) -> bool:
    return all(edit.span.source is source for edit in edits)
