"""Hides from a language model the texts of files that it did not write.

An unread program may import the AIDL programs below a folder, and use their definitions, but its author must
not see their texts. So only whole programs are imported (`Programs`), and messages quote only the author's
own text (`Reader`): for a mistake in an imported file they give the code and the line.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cached_property

from aidl_lang.checking import library
from aidl_lang.common.diagnostics import Diagnostic, Fix, has_errors
from aidl_lang.common.records import record
from aidl_lang.common.running import Later
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import FileError, ReadFailure, World, is_data
from aidl_lang.explaining.failures import Conflict, Party
from aidl_lang.geometry.solved import SolvedModel
from aidl_lang.parser import parse
from aidl_lang.pipeline import Compiled, Facts

_HIDDEN = "…"
_QUOTED = re.compile(r"`[^`]*`")


@record()
class Programs:
    """The AIDL programs of a world. One with errors of syntax is refused: messages on it would quote it."""

    world: World

    def read(self, path: str) -> str:
        text = self.world.read(path)
        if has_errors(parse(SourceFile(path, text)).diagnostics):
            raise FileError(path, ReadFailure.NOT_A_PROGRAM)
        return text

    def read_bytes(self, path: str) -> bytes:
        """Returns what is in a font, of which no message quotes, or a drawing, whose names can be used."""
        if not is_data(path):
            raise FileError(path, ReadFailure.ANOTHER_KIND)
        return self.world.read_bytes(path)


@record()
class Reader:
    """The author of these files (text by name). The standard library is readable for all."""

    files: Mapping[str, str]

    @staticmethod
    def of(source: SourceFile) -> Reader:
        return Reader({source.name: source.text})

    @cached_property
    def _written(self) -> str:
        return _squeezed("\n".join(self.files.values()))

    def knows(self, span: Span) -> bool:
        """True for a text of the reader's own, or the library's."""
        source = span.source
        return source.name in self.files or any(source is known for known in library.load().sources)

    def diagnostics(self, found: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Returns diagnostics as the reader may see them, without remarks on others' files."""
        return [told for d in found if (told := self._told(d)) is not None]

    def compiled(self, compiled: Compiled) -> Compiled:
        """Returns the outcome of a program, as its author may see it."""
        return replace(
            compiled,
            find=Later(None, Facts(self.diagnostics(compiled.diagnostics))),
            model=compiled.model and self._model(compiled.model),
            conflicts=lambda: tuple(map(self._conflict, compiled.conflicts())),
        )

    def _told(self, d: Diagnostic) -> Diagnostic | None:
        places = [label.span for label in d.secondary] + ([d.span] if d.span else [])
        if all(map(self.knows, places)):
            return d if d.fix is None else replace(d, fix=self._fix(d.fix))
        labels = [replace(label, text=self._redacted(label.text)) for label in d.secondary]
        own = [label for label in labels if self.knows(label.span)]
        others = tuple(f"{_place(label.span)}, takes part in this" for label in labels if label not in own)
        hints = tuple(hint for hint in d.hints if self._redacted(hint) == hint)
        told = replace(
            d,
            message=self._redacted(d.message),
            label=self._redacted(d.label),
            secondary=tuple(own),
            hints=(*hints, *others),
            fix=None,
        )
        if d.span is None or self.knows(d.span):
            return told
        if not d.is_error:
            return None
        message = f"{told.message} (in {_place(d.span)})"
        if not own:
            return replace(told, message=message, span=None)
        return replace(told, message=message, span=own[0].span, label=own[0].text, secondary=tuple(own[1:]))

    def _fix(self, fix: Fix | None) -> Fix | None:
        return fix if fix is not None and all(self.knows(edit.span) for edit in fix.edits) else None

    def _redacted(self, text: str) -> str:
        """Removes all quotations from a sentence except those of the reader's own text."""
        return _QUOTED.sub(lambda found: self._quote(found[0]), text)

    def _quote(self, quoted: str) -> str:
        return quoted if _squeezed(quoted.strip("`")) in self._written else f"`{_HIDDEN}`"

    def _model(self, model: SolvedModel) -> SolvedModel:
        spans = [*(c.span for c in model.constraints), *(r.span for r in model.readings)]
        if all(map(self.knows, spans)):
            return model
        return replace(
            model,
            constraints=tuple(
                c if self.knows(c.span) else replace(c, text=_HIDDEN) for c in model.constraints
            ),
            readings=tuple(reading for reading in model.readings if self.knows(reading.span)),
        )

    def _conflict(self, conflict: Conflict) -> Conflict:
        if all(self.knows(party.span) for party in conflict.parties):
            return conflict
        parties = tuple(map(self._party, conflict.parties))
        return replace(conflict, headline=self._redacted(conflict.headline), parties=parties)

    def _party(self, party: Party) -> Party:
        text = party.text if self.knows(party.span) else f"{_HIDDEN} (in {_place(party.span)})"
        return replace(party, text=text, would_fit=self._redacted(party.would_fit), fix=self._fix(party.fix))


def _place(span: Span) -> str:
    return f"`{span.source.name}`, line {span.line}"


def _squeezed(text: str) -> str:
    return "".join(text.split())
