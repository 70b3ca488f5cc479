"""Layers of a DXF: names that it can hold, and a colour for each."""

from __future__ import annotations

import re
from typing import Any

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.source import Span
from aidl_lang.geometry.solved import SolvedModel

OWN = {"solid": 7, "assembly": 7, "hole": 1, "drawing": 5, "open": 6}
"""Layers for outlines (black or white), holes (red), drawings on parts (blue) and what bounds nothing
(magenta) without a layer of their own; colours in the AutoCAD Color Index.
"""
FURTHER = (3, 4, 30, 200, 140, 54, 8)
"""Colours for layers of the author, in turn, since some programs tell layers apart by colour alone."""
LONGEST_NAME = 255
_REFUSED = re.compile('[<>/\\\\":;?*|,=`^\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]')
_NEVER_PLOTTED = "defpoints"


class Layers:
    """The layers in use. DXF ignores case in names, so one of two that differ only in case is changed."""

    def __init__(self, document: Any, model: SolvedModel) -> None:
        self.notes: list[Diagnostic] = []
        self._document = document
        self._root = model.root
        self._names: dict[str, str] = {}
        self._taken = {_NEVER_PLOTTED, *OWN}

    def name(self, wanted: str) -> str:
        """Returns the document's name for a layer of the program, which is made on first use."""
        if wanted not in self._names:
            self._names[wanted] = name = wanted if wanted in OWN else self._free(wanted)
            if name not in self._document.layers:
                own = sum(known not in OWN for known in self._names) - 1
                color = OWN.get(name) or FURTHER[own % len(FURTHER)]
                self._document.layers.add(name, color=color)
        return self._names[wanted]

    def _free(self, wanted: str) -> str:
        """Returns a free name like the wanted one that DXF allows."""
        allowed = _REFUSED.sub("_", wanted).strip()[:LONGEST_NAME] or "_"
        name, count = allowed, 1
        while name.casefold() in self._taken:
            count += 1
            name = f"{allowed[: LONGEST_NAME - len(str(count)) - 1]}_{count}"
        self._taken.add(name.casefold())
        if name != wanted:
            self.notes.append(_changed_note(wanted, name, self._place(wanted), taken=count > 1))
        return name

    def _place(self, layer: str) -> Span | None:
        found = (s.span for s in self._root.walk() if str((*s.attributes.get("layer", ()), "")[0]) == layer)
        return next(found, None)


def _changed_note(wanted: str, name: str, span: Span | None, taken: bool) -> Diagnostic:
    why = (
        "DXF makes no difference between capital and small letters in names, and keeps some for itself"
        if taken
        else f'names in DXF have 1 to {LONGEST_NAME} characters and none of < > / \\ " : ; ? * | , = ` ^'
    )
    return Diagnostic(
        "W0720", f"the layer `{_short(wanted)}` is called `{_short(name)}` in the DXF", span, "", (), (why,)
    )


def _short(name: str) -> str:
    return name if len(name) <= 60 else f"{name[:59]}…"
