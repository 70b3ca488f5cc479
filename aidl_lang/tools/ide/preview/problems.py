"""Problems on the drawing, each with its elements and points."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.source import Span
from aidl_lang.geometry.solved import ConstraintReport
from aidl_lang.tools.ide.preview.elements import Elements
from aidl_lang.tools.ide.preview.places import Places
from aidl_lang.tools.ide.preview.values import Conflict, Party, Problem
from aidl_lang.tools.ide.view import View

_QUOTED = re.compile("`([^`]+)`")


def problems(
    view: View, elements: Elements, painting: Sequence[Diagnostic] = (), *, tried: bool = False
) -> Iterator[Problem]:
    """Yields the diagnostics of the text, and those of painting it, each with its elements and points. Of
    values that are only tried none has a fix: fixes are of the text.
    """
    finder = _Finder(view, elements)
    for found in (*view.diagnostics, *painting):
        yield Problem(
            found.severity.value,
            found.code,
            found.message,
            () if tried and found.fix is not None else found.hints,
            found.span,
            tuple(finder.about(found)),
            tuple(p for p in found.points if all(map(math.isfinite, p))),
            (found.fix,) if found.fix is not None and not tried else (),
        )


def conflicts(view: View, elements: Elements) -> Iterator[Conflict]:
    """Yields the conflicting constraints of a program that does not solve."""
    if view.outcome is None or view.outcome.status == "solved":
        return
    finder = _Finder(view, elements)
    for conflict in view.outcome.conflicts():
        parties = tuple(
            Party(
                party.text,
                party.span,
                tuple(finder.related(party.span, party.path)),
                party.off if math.isfinite(party.off) else None,
            )
            for party in conflict.parties
        )
        yield Conflict(conflict.headline, parties)


class _Finder:
    def __init__(self, view: View, elements: Elements) -> None:
        self.elements = elements
        self.constraints: dict[Span, list[ConstraintReport]] = {}
        model = view.drawn.model if view.drawn is not None else None
        places = Places(view)
        for report in model.constraints if model is not None else ():
            if (span := places.now(report.span)) is not None:
                self.constraints.setdefault(span, []).append(report)

    def about(self, found: Diagnostic) -> list[int]:
        """Returns the elements written, or constrained, in the places that a diagnostic names.

        If several share a place, as the turns of a loop do, only those whose paths the message quotes, before
        it names what is beside them.
        """
        spans = [s for s in (found.span, *(label.span for label in found.secondary)) if s is not None]
        here = [k for span in spans for k in self._at(span)]
        quoted = set(_QUOTED.findall(found.message.partition(";")[0]))
        named = [k for k in here if self.elements.values[k].path in quoted]
        return list(dict.fromkeys(named or here))

    def _at(self, span: Span) -> list[int]:
        return self.elements.written_at(span) or self.related(span)

    def related(self, span: Span, holder: str | None = None) -> list[int]:
        """Returns the elements that the constraints in a place relate; only those of `holder`, if given."""
        reports = self.constraints.get(span, [])
        paths = [path for r in reports if holder in (None, r.path) for path in r.mentions()]
        return self.elements.all_near(paths)
