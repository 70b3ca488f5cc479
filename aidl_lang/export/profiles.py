"""Profiles of workshops: how the files for a cutter say what is engraved, scored and cut, and in which order.

A machine is told by colours or by layers what to do with a line. A profile is the table of that: for each
operation its colour, the width of its lines and its layer, the same in every format.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING

from aidl_lang.common.colors import hexadecimal, rgb
from aidl_lang.common.names import fold
from aidl_lang.common.records import record

if TYPE_CHECKING:
    from aidl_lang.export.cuts import Outline

FILL, ENGRAVE, SCORE, INNER, OUTER = OPERATIONS = ("fill", "engrave", "score", "inner", "outer")
"""Areas that are engraved, lines that are engraved or scored, cuts inside parts, and those around them."""
CUT = "cut"
"""As the operation of a layer: the outlines of parts stay what they are, and lines are cut as inner ones."""
CUTS = (INNER, OUTER)
ON_PARTS = (FILL, ENGRAVE, SCORE)


@record()
class Look:
    """A colour, as `#rrggbb`; the width of lines, mm; the name of a layer, None for that of the program."""

    color: str
    width: float = 0.1
    layer: str | None = None


@record()
class Layer:
    """What is done with all that is on a layer, one of `OPERATIONS` or `CUT`, and its own look if it has
    one.
    """

    operation: str
    look: Look | None = None


_BY_NAME = {name: Layer(name) for name in (*OPERATIONS, CUT)}
"""Layers that are named after what is done with them."""


@record()
class Profile:
    """A table of operations.

    looks    by operation
    order    of the operations in the file
    layers   of the program, by their folded name
    letters  the operation for letters in drawings, `fill` or `engrave`
    keeps_colors  whether what is engraved keeps the colour that the program gives it
    """

    name: str
    looks: Mapping[str, Look]
    order: tuple[str, ...] = OPERATIONS
    layers: Mapping[str, Layer] = field(default_factory=lambda: _BY_NAME)
    letters: str = FILL
    keeps_colors: bool = False

    def knows(self, layer: str) -> bool:
        """Tells whether the profile says what becomes of a layer of the program."""
        return fold(layer) in self.layers

    def operation(self, layer: str | None, by_kind: str) -> str:
        """Returns what is done with a line on a layer, which is `by_kind` where the layer does not say."""
        found = self.layers.get(fold(layer)) if layer is not None else None
        if found is None:
            return by_kind
        if found.operation != CUT:
            return found.operation
        return by_kind if by_kind in CUTS else INNER

    def look(self, layer: str | None, operation: str) -> Look:
        found = self.layers.get(fold(layer)) if layer is not None else None
        return self.looks[operation] if found is None or found.look is None else found.look

    def color(self, outline: Outline) -> str:
        """Returns the colour of an outline."""
        if self.keeps_colors and outline.operation not in CUTS and outline.style.color is not None:
            return hexadecimal(rgb(outline.style.color))
        return self.look(outline.style.layer, outline.operation).color

    def with_layers(self, layers: Mapping[str, Layer]) -> Profile:
        return replace(self, layers={**self.layers, **{fold(name): of for name, of in layers.items()}})


def _looks(width: float, *looks: tuple[str, str]) -> dict[str, Look]:
    return {op: Look(color, width, layer) for op, (color, layer) in zip(OPERATIONS, looks, strict=True)}


_PLAIN_COLORS = ("#000000", "#0000ff", "#008000", "#ff0000", "#ff0000")
PLAIN = Profile(
    "plain",
    {op: Look(color) for op, color in zip(OPERATIONS, _PLAIN_COLORS, strict=True)},
    letters=ENGRAVE,
    keeps_colors=True,
)
"""Red to cut and blue to engrave, on the layers of the program; nothing but what is asked for is filled."""

PROFILES = {
    "plain": PLAIN,
    # Colours of the program's palette, from the front of it to the back as they are carried out.
    "lightburn": Profile(
        "lightburn",
        _looks(
            0.1,
            ("#000000", "C00-fill"),
            ("#0000ff", "C01-engrave"),
            ("#00e000", "C03-score"),
            ("#ff8000", "C05-inner"),
            ("#a00000", "C10-outer"),
        ),
    ),
    # Steps are listed by colour: these rise.
    "glowforge": Profile(
        "glowforge",
        _looks(
            0.1,
            ("#000000", "fill"),
            ("#0000ff", "engrave"),
            ("#00ff00", "score"),
            ("#ff0000", "inner"),
            ("#ff00ff", "outer"),
        ),
    ),
    "ponoko": Profile(
        "ponoko",
        _looks(
            0.01,
            ("#000000", "area-engraving"),
            ("#ff0000", "line-engraving"),
            ("#ff0000", "line-engraving"),
            ("#0000ff", "cutting"),
            ("#0000ff", "cutting"),
        ),
    ),
}
