"""A drawing that was read, by the suffix of its name: its outlines, and their names made names of AIDL."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property, lru_cache
from pathlib import PurePosixPath

from aidl_lang.common.drawings import WHOLE
from aidl_lang.common.drawings.strokes import Stroke, box, has_length, numbers
from aidl_lang.common.font_files import Curve
from aidl_lang.common.names import fold
from aidl_lang.common.prose import counted, listed
from aidl_lang.common.records import record

# --- A drawing that was read: its outlines and their names.

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


# --- Reading of a drawing file, by the suffix of its name, and the names in it made names of AIDL.

MOST_NAMES = 250
_LONGEST_NAME = 60
_TAKEN = frozenset(
    fold(word)
    for word in (
        f"{WHOLE} art start center unit scale width height angle filled rotatable bb edge origin rotation "
        "self x_axis y_axis fillet chamfer left right top bottom center_x center_y top_left top_right "
        "bottom_left bottom_right top_center bottom_center left_center right_center "
        "alias and assert at constrain constraint construction else false fn for if import in let not or "
        "param prefer rotated shape step template todo true var weight fixed guess turned traced traced_part"
    ).split()
)
"""Names that mean something else in or about a drawing, and words that begin statements."""


@lru_cache(maxsize=8)
def outlines(path: str, data: bytes) -> OutlineFile:
    """Returns what is in a drawing file. Raises DrawingError."""
    name = PurePosixPath(path).name
    # Loaded when a program imports one: others need no reader.
    if path.lower().endswith(".svg"):
        from aidl_lang.common.drawings import svg

        found, remarks = svg.read(data, name)
    else:
        from aidl_lang.common.drawings import dxf

        found, remarks = dxf.read(data, name)
    if not found.elements:
        raise DrawingError("E0365", f"`{name}` has no outlines", *_left_out(found))
    elements = tuple(found.elements)
    parts, more = _parts(elements, "layer" if path.lower().endswith(".dxf") else "id")
    return OutlineFile(Trace(WHOLE, elements), parts, (*remarks, *_told(found, more)))


_PLURALS = {"hatch": "hatches", "mesh": "meshes", "hidden entity": "hidden entities"}


def _left_out(found: Collector) -> Iterator[str]:
    if found.left_out:
        counts = [counted(count, kind, _PLURALS.get(kind, "")) for kind, count in found.left_out.items()]
        yield f"left out: {listed(counts)}"


def _told(found: Collector, more: int) -> Iterator[Remark]:
    for text in _left_out(found):
        yield Remark(
            "N0751",
            f"`{found.what}` has more than outlines; {text}",
            ("only outlines are imported; in the program that drew it texts can be turned into paths",),
        )
    if more:
        yield Remark(
            "N0751",
            f"`{found.what}` has {more} names beyond the first {MOST_NAMES}, which cannot be used",
            ("give names to the groups or layers that are needed, and leave the rest without",),
        )


# --- Names -----------------------------------------------------------------------------------------


def _parts(elements: Iterable[Element], kind: str) -> tuple[dict[str, Trace], int]:
    """Returns what each name stands for, and how many names were too many. Equal names are one part."""
    members: dict[str, list[Element]] = {}
    for element in elements:
        for name in dict.fromkeys(element.names):
            members.setdefault(name, []).append(element)
    parts: dict[str, Trace] = {}
    taken = set(_TAKEN)
    for written, of in members.items():
        if len(parts) == MOST_NAMES:
            return parts, len(members) - MOST_NAMES
        name = _sanitised(written, kind)
        if any(fold(name) == fold(known) and part.elements == tuple(of) for known, part in parts.items()):
            continue  # the label of a group and its id
        name = _free(name, taken)
        taken.add(fold(name))
        parts[name] = Trace(name, tuple(of))
    return parts, 0


def _sanitised(written: str, kind: str) -> str:
    """Returns the name of AIDL that is most like one of a file."""
    name = re.sub(r"\W+", "_", written[:_LONGEST_NAME]).strip("_") or kind
    return f"{kind}_{name}" if name[0].isdigit() or not name[0].isidentifier() else name


def _free(name: str, taken: set[str]) -> str:
    """Returns a name that means nothing else yet, not even when it is spelled otherwise."""
    if fold(name) not in taken:
        return name
    candidates = (f"{name}_part", *(f"{name}_{k}" for k in range(2, MOST_NAMES + 3)))
    return next(c for c in candidates if fold(c) not in taken)
