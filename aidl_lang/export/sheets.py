"""Jobs for cutters: parts laid out on sheets, and what the cutter follows as marks of a picture."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import counted, fixed, listed, named, size_text
from aidl_lang.export.cuts import Outline, outlines
from aidl_lang.export.job import ON_SHEETS, ExportError, Job, Progress, require
from aidl_lang.export.marks import Area, Curves, Group, Ink, Mark
from aidl_lang.export.profiles import CUTS, FILL, Profile
from aidl_lang.export.unsaid import twice_compensated
from aidl_lang.geometry.arcs import WIDEST, Slit, as_arcs, has_slivers, without_slits
from aidl_lang.geometry.curves import union_bounds
from aidl_lang.geometry.drawing import SLIT, Drawing, Stroke
from aidl_lang.geometry.offsets import offset
from aidl_lang.geometry.parts import Size
from aidl_lang.geometry.region import Face, Loop, Region, region_bounds
from aidl_lang.geometry.sheets import NestingError, laid_out
from aidl_lang.geometry.solved import SolvedModel

# --- What a cutter follows, as marks of a picture: outlines and engraved areas in the order of a profile.


def followed_groups(model: SolvedModel, drawing: Drawing, profile: Profile) -> Iterator[Group]:
    """Yields a group for each run of outlines with one operation and one structure."""
    kinds = {s.path: s.kind for s in model.root.walk()}
    found = [outline for outline in outlines(model, drawing, profile) if outline.operation]
    used: dict[str, int] = {}

    def look(outline: Outline) -> tuple[str, str, str | None]:
        own = outline.style.layer
        return outline.path, outline.operation, profile.look(own, outline.operation).layer or own

    for (path, operation, layer), run in groupby(found, key=look):
        name = f"{path}:{operation}"
        used[name] = count = used.get(name, 0) + 1
        attributes = {"data-kind": kinds[path], "data-path": path, "data-operation": operation}
        if layer is not None:
            attributes["data-layer"] = layer
        yield Group(name if count == 1 else f"{name}-{count}", tuple(_marks(list(run), profile)), attributes)


def _marks(run: Sequence[Outline], profile: Profile) -> Iterator[Mark]:
    for area, bounding in groupby(run, key=lambda o: o.area):
        if area:
            first, *others = bounding
            face = Face(first.loop, tuple(outline.loop for outline in others))
            yield Area(face, profile.color(first), None, FILL)
            continue
        for outline in bounding:
            width = profile.look(outline.style.layer, outline.operation).width
            ink = Ink(profile.color(outline), width)
            role = "cut" if outline.operation in CUTS else outline.operation
            if outline.closed:
                yield Area(Face(outline.loop), None, ink, role)
            else:
                yield Curves(outline.pieces, ink, role)


# --- Jobs for cutters: outlines widened by the cut, parts laid out on sheets, one job for each sheet.

_SAME = 1e-6
"""Difference of widths, relative to the cut, that is none."""
MOST_PARTS = 5000
"""More parts are a mistake, and would take minutes to pack."""


def grown(job: Job, progress: Progress) -> tuple[Job, list[Diagnostic]]:
    """Returns the job with its outlines widened by half the cut, with notes. `progress` hears of it."""
    if not job.options.kerf:
        return job, []
    drawing, slits = _widened(job, job.options.kerf / 2, progress)
    notes = [*twice_compensated(job.model.root, job.options.kerf), *_slit_notes(job, slits)]
    return replace(job, drawing=drawing, whole=job), notes


def laid_on_sheets(job: Job, sheet: Size, spacing: float) -> tuple[list[Job], list[Diagnostic]]:
    """Returns a job for each sheet, with notes; raises ExportError if the parts cannot be laid out."""
    if unfit := sorted(job.options.show.difference(ON_SHEETS)):
        message = f"`--show {','.join(unfit)}` explains the assembled drawing and has no place on cut sheets"
        hint = "`--show names,numbers` writes the names and numbers of the parts on them"
        raise ExportError("E0924", message, hint)
    if min(sheet) <= 2 * spacing:
        message = f"a sheet of {size_text(sheet)} has no room within a spacing of {fixed(spacing)} mm"
        raise ExportError("E0924", message, "give a larger `--sheet` or a smaller `--spacing`")
    count = sum(body.style.quantity for body in job.drawing.bodies)
    if not count:
        message = "there is no part to lay on a sheet"
        raise ExportError("E0924", message, "only a `solid` is cut; a `drawing` is engraved on it")
    if count > MOST_PARTS:
        message = f"{count} parts are more than the {MOST_PARTS} that are laid on sheets"
        raise ExportError("E0924", message, "draw them in several programs")
    if job.options.nest is not None:
        require("spyrrow", "--nest", "nest")
    try:
        layout = laid_out(job.model.root, job.drawing, sheet, spacing, job.options.nest)
    except NestingError as reason:
        message = f"the parts could not be packed by their outlines: {reason}"
        hint = "leave `--nest` out: they are packed by their boxes then"
        raise ExportError("E0924", message, hint) from None
    if layout.oversize:
        raise _oversize(layout.oversize, sheet, spacing)
    notes = [_stray_note(job.model, layout.strays)] if layout.strays else []
    whole = job.whole or job
    return [replace(job, drawing=drawing, whole=whole) for drawing in layout.sheets], notes


def _oversize(parts: Sequence[tuple[str, Size]], sheet: Size, spacing: float) -> ExportError:
    path, size = max(parts, key=lambda part: max(part[1]))
    names = named([path for path, _ in parts])
    needed = tuple(side + 2 * spacing for side in size)
    if len(parts) == 1:
        message = f"{names} measures {size_text(size)} and does not fit on a sheet of {size_text(sheet)}"
    else:
        message = f"{names} do not fit on a sheet of {size_text(sheet)}; `{path}` measures {size_text(size)}"
    around = f" with {fixed(spacing)} mm around it" if spacing else ""
    return ExportError(
        "E0923",
        message,
        f"{'it' if len(parts) == 1 else f'`{path}`'} needs a sheet of at least {size_text(needed)}{around}",
        "to print it on small paper and join the pages, use `--tile a4` in place of `--sheet`",
    )


def _stray_note(model: SolvedModel, strays: Sequence[Stroke]) -> Diagnostic:
    spans = {g.path: g.span for s in model.root.walk() for geometry in s.drawn for g in geometry.walk()}
    names = list(dict.fromkeys(stroke.geometry for stroke in strays))
    return Diagnostic(
        "W0736",
        f"what of {named(names)} lies on no part is left off the sheets",
        spans.get(names[0]),
        hints=("a drawing inside a `solid` is laid out with it",),
    )


def _slit_notes(job: Job, slits: Mapping[str, Sequence[Slit]]) -> Iterator[Diagnostic]:
    """Yields a note on slits that become as wide as the cut, and were drawn in another width."""
    kerf = job.options.kerf
    others = {path: [s for s in own if abs(s.width - kerf) > _SAME * kerf] for path, own in slits.items()}
    for path, own in others.items():
        if own:
            structure, widths = job.model.root.find(path), sorted({fixed(round(s.width, 6)) for s in own})
            is_one = len(own) == 1
            yield Diagnostic(
                "N0757",
                f"{counted(len(own), 'slit')} of `{path}` {'is' if is_one else 'are'} cut in one pass: "
                f"{fixed(kerf)} mm wide, as the cut, and drawn {listed(widths)} mm wide",
                None if structure is None else structure.span,
                hints=(f"gaps wider than {fixed(WIDEST * kerf)} mm are cut along both sides",),
            )


def _widened(job: Job, by: float, progress: Progress) -> tuple[Drawing, dict[str, list[Slit]]]:
    """Returns the drawing with all material grown by half the width of the cut, and holes shrunk by as
    much, and the slits that are lines in it. Outlines with pieces too short to be cut are drawn anew.
    """
    drawing = job.drawing
    holes = {s.path for s in job.model.root.walk() if s.kind == "hole"}
    grown = dict.fromkeys(holes, -by) | {body.path: by for body in drawing.bodies}
    regions = {}
    filled = {body.path: without_slits(body.region, 2 * by) for body in drawing.bodies}
    for done, (path, region) in enumerate(drawing.regions.items()):
        progress(done, len(drawing.regions))
        region, _ = filled.get(path, (region, ()))
        regions[path] = offset(region, grown.get(path, 0.0))
    progress(len(drawing.regions), len(drawing.regions))
    bodies = []
    for body in drawing.bodies:
        region = regions[body.path]
        if len(region.loops) != len(filled[body.path][0].loops):
            message = f"holes or gaps of `{body.path}` are narrower than a cut of {fixed(2 * by)} mm"
            raise ExportError("E0924", message, "widen them, or give a smaller `--kerf`")
        region = _smoothed(region, job.options.tolerance)
        bodies.append(replace(body, region=region, box=region_bounds(region)))
    slits = {path: found for path, (_, found) in filled.items()}
    cuts = tuple(
        Stroke(path, path, (slit.way,), drawing.styles[path], SLIT)
        for path, found in slits.items()
        for slit in found
    )
    box = union_bounds([drawing.box, *(body.box for body in bodies)])
    strokes = drawing.strokes + cuts
    return replace(drawing, bodies=tuple(bodies), strokes=strokes, regions=regions, box=box), slits


def _smoothed(region: Region, tolerance: float) -> Region:
    """Returns the region with outlines that have no pieces too short to be cut."""
    faces = []
    for face in region.faces:
        outer, *holes = (_smooth(loop, tolerance) for loop in face.loops)
        faces.append(Face(outer, tuple(holes)))
    return Region(tuple(faces))


def _smooth(loop: Loop, tolerance: float) -> Loop:
    if not has_slivers(loop.pieces, tolerance):
        return loop
    return replace(loop, pieces=as_arcs(loop.pieces, closed=True, tolerance=tolerance))
