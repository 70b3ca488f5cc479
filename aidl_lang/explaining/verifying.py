"""Verifies the fixes of findings made after solving: one that does not resolve its finding is not offered."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.explaining.trials import GAVE_WAY, Trials

_TRIED = frozenset({"E0601", "E0602", "E0603", "E0605", "N0602", "N0604"})
"""Codes of findings whose fixes were tried already."""
_SAID = frozenset({"W0705"})
"""Codes of findings whose fixes are a word that says that they are meant, which changes no drawing."""


def verified(
    found: Sequence[Diagnostic], everything: Sequence[Diagnostic], trials: Trials
) -> list[Diagnostic]:
    """Returns findings without the fixes that do not mend them, and without the hints that repeat these.
    `everything` are all findings about the program.
    """
    return [_verified(d, everything, trials) for d in found]


def mends(found: Diagnostic, fix: Fix, before: Sequence[Diagnostic], trials: Trials) -> bool:
    """Tells whether a program with the findings `before` no longer has `found` after a fix, and nothing
    worse.
    """
    if trials.is_over or not trials.can_edit(fix.edits) or found.code in _SAID:
        return found.code in _SAID and trials.can_edit(fix.edits)
    after = trials.diagnostics(fix.edits)
    return not _bad(after) - _bad(before) and not any(_is_same(d, found, fix.edits) for d in after)


def _verified(d: Diagnostic, before: Sequence[Diagnostic], trials: Trials) -> Diagnostic:
    if d.fix is None or d.code in _TRIED or mends(d, d.fix, before, trials):
        return d
    written = "\n".join(edit.replacement for edit in d.fix.edits)
    hints = tuple(h for h in d.hints if not any(q in written for q in re.findall(r"`([^`]+)`", h)))
    return replace(d, fix=None, hints=hints)


def _bad(found: Sequence[Diagnostic]) -> Counter[str]:
    return Counter(d.code for d in found if d.is_error or d.code in GAVE_WAY)


def _is_same(one: Diagnostic, before: Diagnostic, edits: Sequence[Edit]) -> bool:
    """Tells whether a finding in the program after some edits is one that was in it before."""
    if one.code != before.code or one.span is None or before.span is None:
        return one.code == before.code and one.message == before.message
    span = before.span
    shift = sum(len(e.replacement) - (e.span.end - e.span.start) for e in edits if e.span.end <= span.start)
    if one.span.start != span.start + shift:
        return False
    is_rewritten = any(e.span.start <= span.start and span.end <= e.span.end for e in edits)
    return one.message == before.message or not is_rewritten
