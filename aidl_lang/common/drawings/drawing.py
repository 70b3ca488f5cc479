"""A drawing that was read: its outlines and their names."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from functools import cached_property

from aidl_lang.common.drawings import WHOLE
from aidl_lang.common.drawings.strokes import Stroke, box, has_length, numbers
from aidl_lang.common.font_files import Curve
from aidl_lang.common.records import record

MOST_CURVES = 30_000
MOST_NUMBERS = 7 * MOST_CURVES
"""Numbers in the outlines of a file: no curve takes more."""
FURTHEST = 1e8
"""Millimetres from the origin beyond which nothing is read: a hundred kilometres."""


_DIGITS = re.compile(r"\d+\.?\d*")


class DrawingError(Exception):
    """Raised for a file that cannot be read as a drawing: a diagnostic's code, message and hints."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hints = hints


@record()
class Engraving:
    """What files of AIDL say of an outline that is engraved and not cut: its layer and its colour, where it
    has them, and whether it is the border of an area.
    """

    layer: str | None = None
    color: str | None = None
    is_area: bool = False


@record(eq=False)
class Element:
    """One outline of a file, or some that belong together, contour by contour.

    names    those by which the file calls it, from the outermost group to its own
    is_winding  what it encloses goes by the non-zero rule; otherwise nested contours alternate
    engraving   None for what bounds material, as far as the file says
    """

    names: tuple[str, ...]
    strokes: tuple[Stroke, ...]
    is_winding: bool = False
    engraving: Engraving | None = None


@record(eq=False)
class Trace:
    """The outlines of a drawing, or of a part of it, as one thing that moves and turns as a whole.

    name  that of the part, for messages
    """

    name: str
    elements: tuple[Element, ...]

    @cached_property
    def strokes(self) -> tuple[Stroke, ...]:
        return tuple(stroke for element in self.elements for stroke in element.strokes)

    @cached_property
    def box(self) -> tuple[float, float, float, float]:
        return box(self.strokes)

    @cached_property
    def silhouette(self) -> tuple[Curve, ...]:
        """The corners and curves of which some point is the furthest in every direction."""
        from aidl_lang.common.drawings.strokes import as_curves
        from aidl_lang.common.lettering import silhouette_of

        return silhouette_of([curve for stroke in self.strokes for curve in as_curves(stroke)])


@record(eq=False)
class Remark:
    """A thing to be told of a drawing: the code of a diagnostic, its message and hints."""

    code: str
    message: str
    hints: tuple[str, ...] = ()


@record(eq=False)
class OutlineFile:
    """A drawing file that was read.

    parts  what can be named in it: name in AIDL → outlines
    """

    whole: Trace
    parts: Mapping[str, Trace]
    remarks: tuple[Remark, ...] = ()

    def trace(self, name: str) -> Trace:
        """Returns the outlines under a name."""
        return self.whole if name == WHOLE else self.parts[name]


@record(frozen=False)
class Collector:
    """The elements read so far, counted and checked.

    left_out  what was not read: how it is called → how many there were
    """

    what: str
    elements: list[Element] = field(default_factory=list)
    left_out: dict[str, int] = field(default_factory=dict)
    curves: int = 0
    numbers: int = 0

    def add(
        self,
        names: Sequence[str],
        strokes: Iterable[Stroke],
        *,
        is_winding: bool = False,
        engraving: Engraving | None = None,
    ) -> None:
        """Adds an element. Raises DrawingError for one that has no place on a plane, or one too many."""
        found = tuple(strokes)
        kept = tuple(stroke for stroke in found if has_length(stroke))
        self.curves += len(kept)
        self.check()
        for number in (n for stroke in found for n in numbers(stroke)):
            if not math.isfinite(number) or abs(number) > FURTHEST:
                named = f" in `{names[-1]}`" if names else ""
                raise DrawingError(
                    "E0364",
                    f"`{self.what}` reaches further than {FURTHEST / 1e6:g} km from its origin{named}",
                    "look whether a coordinate or a transform in it is what was meant",
                )
        if kept:
            self.elements.append(Element(tuple(names), kept, is_winding, engraving))

    def count_numbers(self, text: str) -> None:
        """Counts the numbers of an attribute before it is read. Raises DrawingError."""
        self.numbers += sum(1 for _ in _DIGITS.finditer(text))
        self.check()

    def check(self) -> None:
        if self.curves > MOST_CURVES or self.numbers > MOST_NUMBERS:
            raise DrawingError(
                "E0363",
                f"`{self.what}` has more than {MOST_CURVES:,} curves",
                "simplify it in the program that drew it, or export fewer of its layers",
            )

    def leave_out(self, kind: str, count: int = 1) -> None:
        self.left_out[kind] = self.left_out.get(kind, 0) + count
