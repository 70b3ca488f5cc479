"""Conflicts of a program: the constraints in them, the change that each would need, and whether that
helps.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TypeAlias

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic, Fix, apply_fixes
from aidl_lang.common.prose import short
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.explaining import failures
from aidl_lang.pipeline import Settings
from aidl_lang.tools.agents.results import Conflict, Given, Party, Replacement, place, repair

CODES = ("E0601", "E0602", "E0603", "E0605")
"""Codes of the diagnostics about conflicts."""
Params: TypeAlias = Mapping[str, float | str | bool] | None
_OUTCOMES = {
    True: ", and the program solves",
    False: ", but the program does not solve by that alone",
    None: "",
}
_MOST_TRIED = 12
"""Most remedies that are tried: each is a program to be solved."""


class Remedies:
    """Tries edits on one program."""

    def __init__(self, source: SourceFile, world: World, params: Params, settings: Settings) -> None:
        self.source, self.world, self.params, self.settings = source, world, params, settings
        self.tried = 0

    def conflict(self, found: failures.Conflict) -> Conflict:
        parties, givens = list(map(self._party, found.parties)), list(map(self._given, found.givens))
        return Conflict(found.headline, found.is_minimal, parties, givens)

    def _given(self, given: failures.ExactNumber) -> Given:
        return Given(
            given.name,
            place(given.span),
            given.would_fit,
            repair(given.fix),
            self._solves(given.fix),
        )

    def _party(self, party: failures.Party) -> Party:
        return Party(
            party.text,
            party.path,
            place(party.span),
            party.off if math.isfinite(party.off) else None,
            party.would_fit,
            repair(party.fix) if party.fix else None,
            self._solves(party.fix) if party.fix else None,
        )

    def _solves(self, fix: Fix) -> bool | None:
        """True if the program solves with an edit; None if that was not tried."""
        if self.tried == _MOST_TRIED:
            return None
        self.tried += 1
        text, applied = apply_fixes(self.source, [Diagnostic("E0601", "", fix=fix)])
        if not applied:
            return None
        changed = SourceFile(self.source.name, text)
        return pipeline.compile(changed, self.world, self.params, self.settings).status == "solved"


def in_lines(conflict: Conflict) -> str:
    """Returns a conflict in lines."""
    lead = "without any one of these the others hold" if conflict.is_minimal else "these do not hold"
    told = [line for p in conflict.parties for line in _told(p)]
    return "\n".join([f"{conflict.headline}; {lead}:", *told, *map(_exact, conflict.givens)])


def _told(party: Party) -> Iterator[str]:
    off = f"off by {short(party.off)}" if party.off else ""
    words = "; ".join(filter(None, (party.would_fit, off)))
    yield f"- line {party.place.line}, in {party.held_by}: {party.constraint}{f' ({words})' if words else ''}"
    if party.remedy is not None:
        edits = " and ".join(map(_edit, party.remedy.replacements))
        yield f"    {party.remedy.title}: {edits}{_OUTCOMES[party.solves]}"


def _exact(given: Given) -> str:
    name = f" `{given.name}`" if given.name else ""
    return f"- line {given.place.line}: exact{name}; {given.would_fit}{_OUTCOMES[given.solves]}"


def _edit(edit: Replacement) -> str:
    where = f"line {edit.place.line}, column {edit.place.column}"
    return f"{where}: `{edit.old}` becomes `{edit.new}`" if edit.old else f"{where}: insert `{edit.new}`"
