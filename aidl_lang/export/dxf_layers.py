"""Layers of a DXF: names that it can hold, and a colour for each."""

from __future__ import annotations

import math
import re
from typing import Any

from aidl_lang.common.colors import rgb
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.export.dxf_lines import weight
from aidl_lang.export.profiles import Look
from aidl_lang.geometry.solved import SolvedModel

OWN = {"solid": 7, "assembly": 7, "hole": 1, "drawing": 5, "open": 6}
"""Layers for outlines (black or white), holes (red), drawings on parts (blue) and what bounds nothing
(magenta) without a layer of their own; colours in the AutoCAD Color Index.
"""
FURTHER = (3, 4, 30, 200, 140, 54, 8)
"""Colours for layers of the author, in turn, since some programs tell layers apart by colour alone."""


@record()
class _Names:
    """What a version of DXF takes as the name of a layer, and how that is said."""

    longest: int
    refused: re.Pattern[str]
    rule: str


_NEW = _Names(
    255,
    re.compile('[<>/\\\\":;?*|,=`^\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]'),
    'names in DXF have 1 to 255 characters and none of < > / \\ " : ; ? * | , = ` ^',
)
_OLD = _Names(31, re.compile("[^A-Za-z0-9$_-]"), "names in DXF R12 have 1 to 31 letters, digits, $, - and _")
_ALIKE = "DXF makes no difference between capital and small letters in names, and keeps some for itself"
_NEVER_PLOTTED = "defpoints"


def color_attributes(color: str, is_old: bool) -> dict[str, int]:
    """Returns the attributes for a colour: R12 knows those of the AutoCAD Color Index alone."""
    from ezdxf.colors import aci2rgb

    red, green, blue = wanted = rgb(color)
    # White and black are one colour of the index, by the background.
    nearest = min(range(1, 256), key=lambda index: math.dist(aci2rgb(index), wanted)) if any(wanted) else 7
    return {"color": nearest} if is_old else {"true_color": red << 16 | green << 8 | blue}


class Layers:
    """The layers in use. DXF ignores case in names, so one of two that differ only in case is changed."""

    def __init__(self, document: Any, model: SolvedModel, is_old: bool = False) -> None:
        self.is_old = is_old
        self._rules = _OLD if is_old else _NEW
        self.notes: list[Diagnostic] = []
        self._document = document
        self._root = model.root
        self._names: dict[str, str] = {}
        self._taken = {_NEVER_PLOTTED, *OWN}
        self._colors: dict[str, str] = {}

    def name(self, wanted: str, look: Look | None = None) -> str:
        """Returns the document's name for a layer of the program, which is made on first use, with a look."""
        if wanted not in self._names:
            self._names[wanted] = name = wanted if wanted in OWN else self._free(wanted)
            if name not in self._document.layers:
                own = sum(known not in OWN for known in self._names) - 1
                color = OWN.get(name) or FURTHER[own % len(FURTHER)]
                self._document.layers.add(name, **({"color": color} if look is None else self._like(look)))
            if look is not None:
                self._colors[name] = look.color
        return self._names[wanted]

    def has_color(self, name: str, color: str) -> bool:
        """Tells whether a layer of the document was made with a colour."""
        return self._colors.get(name) == color

    def _like(self, look: Look) -> dict[str, int]:
        """Returns the attributes of a layer; programs that know no true colours take that of the index."""
        index = color_attributes(look.color, is_old=True)
        if self.is_old:
            return index
        return index | color_attributes(look.color, is_old=False) | {"lineweight": weight(look.width)}

    def _free(self, wanted: str) -> str:
        """Returns a free name like the wanted one that DXF allows."""
        longest = self._rules.longest
        allowed = self._rules.refused.sub("_", wanted).strip()[:longest] or "_"
        name, count = allowed, 1
        while name.casefold() in self._taken:
            count += 1
            name = f"{allowed[: longest - len(str(count)) - 1]}_{count}"
        self._taken.add(name.casefold())
        if name != wanted:
            self.notes.append(self._changed_note(wanted, name, taken=count > 1))
        return name

    def _place(self, layer: str) -> Span | None:
        found = (s.span for s in self._root.walk() if str((*s.attributes.get("layer", ()), "")[0]) == layer)
        return next(found, None)

    def _changed_note(self, wanted: str, name: str, taken: bool) -> Diagnostic:
        why = _ALIKE if taken else self._rules.rule
        message = f"the layer `{_short(wanted)}` is called `{_short(name)}` in the DXF"
        return Diagnostic("W0720", message, self._place(wanted), hints=(why,))


def _short(name: str) -> str:
    return name if len(name) <= 60 else f"{name[:59]}…"
