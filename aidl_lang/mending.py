"""Applying fixes until there is nothing left to mend."""

from __future__ import annotations

import time
from dataclasses import dataclass

from aidl_lang import pipeline
from aidl_lang.diagnostics import Diagnostic, apply_fixes
from aidl_lang.source import SourceFile
from aidl_lang.world import World

_ROUNDS = 20
"""Times that a program is looked at again: one fix may bring another mistake to light."""


@dataclass(frozen=True)
class Mended:
    """A program as it stands now, the findings left in it, and the titles of the fixes made on the way."""

    source: SourceFile
    diagnostics: list[Diagnostic]
    fixes: tuple[str, ...] = ()


def mend(
    source: SourceFile, world: World | None = None, settings: pipeline.Settings = pipeline.Settings()
) -> Mended:
    """Apply fixes and look again until nothing changes, the text returns to an earlier one, or a limit: of
    rounds, or of the time that building may take. Fixes that undo each other are not made.
    """
    last = time.thread_time() + settings.building.seconds
    fixes: list[str] = []
    seen: dict[object, Mended] = {}
    for _ in range(_ROUNDS):
        diagnostics = pipeline.check(source, world, settings)
        now = Mended(source, diagnostics, tuple(fixes))
        if (before := seen.setdefault(_outlook(now), now)) is not now:
            return before  # what was done since undoes itself
        text, applied = apply_fixes(source, diagnostics)
        if not applied or time.thread_time() > last:
            break
        fixes += [d.fix.title for d in diagnostics if d.fix][:applied]
        source = SourceFile(source.name, text)
    else:
        diagnostics = pipeline.check(source, world, settings)
    return Mended(source, diagnostics, tuple(fixes))


def _outlook(state: Mended) -> object:
    """By what a state is known again: the text, blanks aside, and what there is to say of it."""
    return "".join(state.source.text.split()), tuple(d.message for d in state.diagnostics)
