"""The lines of a DXF: weights that it knows, and a linetype for each pattern of dashes."""

from __future__ import annotations

from typing import Any

from aidl_lang.common.numbers import fixed
from aidl_lang.export import UNITS
from aidl_lang.geometry.styles import Style

WEIGHTS = (
    *(0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211),
)
"""Hundredths of a millimetre: DXF takes no others."""
DASHED = "DASHED"


def weight(width: float) -> int:
    """Returns the weight nearest to a width, mm."""
    return min(WEIGHTS, key=lambda known: abs(known - 100 * width))


class Lines:
    """The linetypes in use, each made on first use. `size` is that of the drawing, mm; `is_old`: R12 knows no
    weights, and no points in names. Patterns are in `units`.
    """

    def __init__(self, document: Any, size: float, is_old: bool = False, units: str = "mm") -> None:
        self._units = units
        self._is_old = is_old
        self._document = document
        self._size = size

    def attributes(self, style: Style) -> dict[str, Any]:
        """Returns the attributes of entities with lines of a style; none where it asks for nothing."""
        found: dict[str, Any] = {}
        if style.width is not None and not self._is_old:
            found["lineweight"] = weight(style.width)
        if (dashes := style.dashes(self._size)) is not None:
            found["linetype"] = self._linetype(dashes, is_named=bool(style.dash))
        return found

    def _linetype(self, dashes: tuple[float, ...], *, is_named: bool) -> str:
        """Returns the name of a pattern; the one that goes by the size of the drawing is just dashed."""
        name = "_".join((DASHED, *map(fixed, dashes))) if is_named else DASHED
        if self._is_old:
            name = name.replace(".", "_")
        if name not in self._document.linetypes:
            parts = [part / UNITS[self._units] for part in dashes]
            pattern = [-part if k % 2 else part for k, part in enumerate(parts)]
            said = f"dashes and gaps in {self._units}"
            self._document.linetypes.add(name, [sum(parts), *pattern], description=said)
        return name
