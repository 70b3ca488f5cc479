"""Drawings of other programs: the outlines in an SVG or a DXF file, under names, in millimetres with y up."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from pathlib import PurePosixPath

from aidl_lang.common.drawings.drawing import (
    Collector,
    DrawingError,
    Element,
    OutlineFile,
    Remark,
    Trace,
)
from aidl_lang.common.names import fold
from aidl_lang.common.prose import counted, listed
from aidl_lang.common.world import WHOLE

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
