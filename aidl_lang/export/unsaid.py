"""What a program says and a file cannot hold, or would hold twice."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import fixed, listed, named, ticked
from aidl_lang.common.source import Span
from aidl_lang.export.job import Job
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from aidl_lang.geometry.styles import is_filled, is_unlined

_Holder = SolvedStructure | SolvedGeometry
_NAMED = 6
_UNLINED = "stroke(none)"
_AREA = "color(…)"
"""That of an area of a solid or a drawing, by itself."""
_OF_CUTTERS = (
    "stroke dash opacity shade edges halo shadow",
    "a cutter follows whole lines of one width, and fills nothing",
)


def notes_of(job: Job, lacks: tuple[str, str], *, cuts: bool) -> list[Diagnostic]:
    """Returns what a file does not hold as it is said: the looks that its format lacks, and why; `cuts`: a
    cutter may read the format.
    """
    if not cuts:
        return list(_unsaid(job, *lacks))
    said = [*_blind(job), *_followed(job)] if job.options.followed is not None or lacks[0] else []
    return [*_unsaid(job, *(_OF_CUTTERS if job.options.for_cutter else lacks)), *said]


def _unsaid(job: Job, lacks: str, why: str) -> Iterator[Diagnostic]:
    """Yields a note if a file has no place for stated looks."""
    lost = lacks.split()
    if stated := list(_stated(job.model.root, lost)):
        names = [n for n in lost if any(n == name for _, name in stated)]
        times = len({id(holder) for holder, _ in stated})
        counts = "counts" if len(names) == 1 else "count"
        message = f"{listed(ticked(names, '@'))} {counts} for nothing in this file: {why}"
        label = "stated here" if times == 1 else f"stated here first, {times} times in all"
        hint = "pictures (.svg, .png, .pdf) are drawn so"
        yield Diagnostic("N0741", message, stated[0][0].span, label, hints=(hint,))


def _blind(job: Job) -> Iterator[Diagnostic]:
    """Yields a note on holes that end in their solid, of which a cutter can engrave the outline alone."""
    depths = {path: s.depth for path, s in job.drawing.styles.items() if s.is_blind}
    if blind := [path for path in job.drawing.regions if path in depths]:
        is_one = len(blind) == 1
        what = "ends in its solid: its outline is" if is_one else "end in their solid: their outlines are"
        deep = listed(sorted({fixed(depths[path][0]) for path in blind}))
        message = f"{named(blind, _NAMED)} {what} engraved, and nothing is cut there"
        hint = f"sink or mill there to the depth that is said: {deep} mm"
        yield Diagnostic("N0756", message, _span(job.model.root, blind[0]), hints=(hint,))


def _followed(job: Job) -> Iterator[Diagnostic]:
    """Yields notes on layers that a cutter's profile does not know, and on areas that are none."""
    asked, profile = job.options.profile, job.options.followed
    if profile is None:
        return
    from aidl_lang.export.cuts import unfilled
    from aidl_lang.export.profiles import PLAIN

    unknown = {
        str(s.attributes["layer"][0]): s.span
        for s in reversed(list(job.model.root.walk()))
        if "layer" in s.attributes and not profile.knows(str(s.attributes["layer"][0]))
    }
    if unknown and asked not in (None, PLAIN):
        names = list(unknown)[::-1]
        yield Diagnostic(
            "N0754",
            f"the profile `{profile.name}` does not say what is done on the "
            f"{'layer' if len(names) == 1 else 'layers'} {named(names)}: "
            "parts are cut there and drawings engraved as elsewhere",
            unknown[names[0]],
            hints=(f'say it in a file for `--profile`: `[layers]` with `"{names[0]}" = "score"`',),
        )
    for path in unfilled(job.drawing, profile):
        message = f"lines of `{path}` enclose nothing, so there they are engraved as lines and not as areas"
        hints = "close them: end each where the next one begins", "or put them on a layer for lines"
        yield Diagnostic("W0757", message, _span(job.model.root, path), hints=hints)


def _span(root: SolvedStructure, path: str) -> Span | None:
    structure = root.find(path)
    return None if structure is None else structure.span


def _states(holder: _Holder, kind: str, name: str) -> bool:
    if name == _AREA:
        return isinstance(holder, SolvedGeometry) and "color" in holder.attributes and is_filled(holder, kind)
    return is_unlined(holder.attributes) if name == _UNLINED else name in holder.attributes


def _stated(root: SolvedStructure, names: Collection[str]) -> Iterator[tuple[_Holder, str]]:
    for structure in root.walk():
        holders: tuple[_Holder, ...] = (structure, *structure.drawn)
        yield from ((each, name) for each in holders for name in names if _states(each, structure.kind, name))


def twice_compensated(root: SolvedStructure, width: float) -> Iterator[Diagnostic]:
    """Yields a note if a program makes up by itself for a cut that outlines are now widened by."""
    drawn = (shape for s in root.walk() for geometry in s.drawn for shape in geometry.walk())
    shapes = [shape for shape in drawn if not shape.construction and _own_kerf(shape.values)]
    # What is drawn is told before the param that it is drawn by.
    holders: list[_Holder] = [*shapes, *(s for s in root.walk() if _own_kerf(s.params))]
    if holders:
        first = holders[0]
        own = _own_kerf(first.params if isinstance(first, SolvedStructure) else first.values)
        more = f" and {len(shapes) - 1} more" if len(shapes) > 1 else ""
        twice = f"by `--kerf` and by the `kerf` of `{first.path}`{more}"
        label = f"drawn for a cut of {fixed(own)} mm, and grown for one of {fixed(width)} mm"
        without = "or have the program draw without it: with `-D kerf=0` if it is a `param`"
        yield Diagnostic(
            "N0742",
            f"the width of the cut is made up for twice: {twice}",
            first.span,
            label,
            hints=("leave out `--kerf`: the program does it", without),
        )


def _own_kerf(values: Mapping[str, object]) -> float:
    own = values.get("kerf", 0.0)
    return own if isinstance(own, float | int) else 0.0
