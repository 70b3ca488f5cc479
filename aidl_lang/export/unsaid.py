"""What a drawing says of its looks and a file cannot hold."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import listed, ticked
from aidl_lang.common.records import record
from aidl_lang.export import Job
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from aidl_lang.geometry.styles import is_unlined


@record()
class _Limit:
    """Attributes that a file has no place for, by name or as written, and why."""

    names: Sequence[str]
    why: str


_UNLINED = "stroke(none)"
_OF_LINES = ("stroke", "dash", "edges", "halo")
_OF_CUTTERS = _Limit(
    ("stroke", "dash", "opacity", "edges", "halo"),
    "a cutter follows whole lines of one width, and fills nothing",
)
_OF_FORMATS = {
    ".step": _Limit(_OF_LINES, "STEP holds shapes with their colours, and its lines have no width"),
    ".stl": _Limit(("stroke", "dash", "opacity", "edges", "halo"), "STL holds bare shapes"),
    ".3mf": _Limit(_OF_LINES, "3MF holds solids with their colours, and draws no lines"),
    ".dxf": _Limit(("opacity", _UNLINED, "edges", "halo"), "DXF holds outlines, and nothing is filled"),
}
_OF_FORMATS[".stp"] = _OF_FORMATS[".step"]


def unsaid_notes(job: Job, suffix: str, *, cuts: bool) -> list[Diagnostic]:
    """Returns a note if the program states looks that such a file is without. `cuts`: a cutter may
    read the format.
    """
    limit = _OF_CUTTERS if cuts and job.options.for_cutter else _OF_FORMATS.get(suffix)
    stated = list(_stated(job.model.root, limit.names)) if limit is not None else []
    if limit is None or not stated:
        return []
    names = [name for name in limit.names if any(_states(holder, name) for holder in stated)]
    counts = "counts" if len(names) == 1 else "count"
    return [
        Diagnostic(
            "N0741",
            f"{listed(ticked(names, '@'))} {counts} for nothing in this file: {limit.why}",
            stated[0].span,
            "stated here" if len(stated) == 1 else f"stated here first, {len(stated)} times in all",
            hints=("pictures (.svg, .png, .pdf) are drawn so",),
        )
    ]


def _states(holder: SolvedStructure | SolvedGeometry, name: str) -> bool:
    return is_unlined(holder.attributes) if name == _UNLINED else name in holder.attributes


def _stated(root: SolvedStructure, names: Collection[str]) -> Iterator[SolvedStructure | SolvedGeometry]:
    """Yields the structures and the geometries in them that state one of some attributes."""
    for structure in root.walk():
        holders: tuple[SolvedStructure | SolvedGeometry, ...] = (structure, *structure.drawn)
        yield from (holder for holder in holders if any(_states(holder, name) for name in names))
