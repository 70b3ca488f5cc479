"""Writers, one file per format, behind one table from file suffix to writer."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import cached_property
from importlib import import_module
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, TypeVar

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.running import OutOfTime, limited_to, working
from aidl_lang.export.job import ON_SHEETS, Exported, ExportError, Job, Options, Progress, require

if TYPE_CHECKING:
    from aidl_lang.export.marks import Picture
    from aidl_lang.export.sheets import Item

T = TypeVar("T")


@record()
class Format:
    """A writer, which has the jobs of all sheets.

    label   describes the file in menus; a format without one is asked for by its suffix alone
    needs   the module that it needs, and the extra of the package that installs that
    lacks   the looks that it has no place for, and why; pictures and tables lack none
    cuts    whether it holds outlines for a cutter
    tiles   whether it is a picture, which can be printed over several pages
    inches  whether it may be in other units than mm
    """

    write: Callable[[Sequence[Job]], Exported]
    label: str = ""
    needs: tuple[str, str] | None = None
    lacks: tuple[str, str] = ("", "")
    cuts: bool = False
    tiles: bool = False
    inches: bool = False


class Exporter:
    """Writes a job in several formats. What the options do to the drawing first is worked out once for all of
    them; `progress` hears how many steps of that are done, and of how many.

    limit    seconds of the processor's time for each format
    audible  returns those of some notes that are to be told
    """

    def __init__(
        self,
        job: Job,
        progress: Progress = lambda done, count: None,
        limit: float = math.inf,
        audible: Callable[[Sequence[Diagnostic]], tuple[Diagnostic, ...]] = tuple,
    ) -> None:
        self._job, self._progress, self._limit, self._audible = job, progress, limit, audible

    def __call__(self, suffix: str) -> Exported:
        """Writes the drawing in the format of a file suffix (`.svg`). Raises as `export` does."""
        made = self._limited(suffix, self._whole)
        return replace(made, notes=self._audible(made.notes))

    def parts(self, suffix: str) -> list[tuple[Item, Exported]]:
        """Writes each different part by itself, flat, its corner at the origin; raises as `export`."""
        made = self._limited(suffix, self._parts)
        return [(item, replace(each, notes=self._audible(each.notes))) for item, each in made]

    def _limited(self, suffix: str, write: Callable[[str], T]) -> T:
        try:
            with working, limited_to(self._limit):
                return write(suffix)
        except OutOfTime:
            hint = "write a format that holds less: pictures without `--show`, outlines alone"
            message = f"writing the drawing as `{suffix}` takes more than {self._limit:g} seconds"
            raise ExportError("E0955", message, hint) from None

    def _whole(self, suffix: str) -> Exported:
        from aidl_lang.export.unsaid import notes_of

        wanted, job = FORMATS[suffix], self._job
        if wanted.needs is not None:
            require(wanted.needs[0], suffix, wanted.needs[1])
        _check(job.options, suffix, wanted)
        jobs, notes = [job], [] if suffix == ".json" else _emptiness(job)
        unsaid = notes_of(job, wanted.lacks, cuts=wanted.cuts)
        if job.options.sheet is not None or job.options.kerf:
            jobs, notes = self._prepared
        made = wanted.write(jobs)
        return replace(made, notes=(*notes, *_unlisted(job, suffix), *unsaid, *made.notes))

    def _parts(self, suffix: str) -> list[tuple[Item, Exported]]:
        from aidl_lang.export.sheets import jobs_of_parts

        if suffix in (".json", ".csv"):
            message = f"`{suffix}` tells of the whole, and is not written part by part"
            raise ExportError("E0926", message, "give it a name without `{part}`")
        _check(replace(self._job.options, sheet=None, nest=None, show=frozenset()), suffix, FORMATS[suffix])
        job, notes = self._grown
        made = []
        for item, alone in jobs_of_parts(job):
            written = Exporter(alone)._whole(suffix)
            made.append((item, replace(written, notes=(*notes, *written.notes))))
        return made

    @cached_property
    def _grown(self) -> tuple[Job, list[Diagnostic]]:
        from aidl_lang.export.sheets import grown

        return grown(self._job, self._progress)

    @cached_property
    def _prepared(self) -> tuple[list[Job], list[Diagnostic]]:
        from aidl_lang.export.sheets import laid_on_sheets

        job, notes = self._grown
        if job.options.sheet is None:
            return [job], notes
        jobs, more = laid_on_sheets(job, job.options.sheet, job.options.spacing)
        return jobs, notes + more


def export(job: Job, suffix: str) -> Exported:
    """Writes the drawing in the format of a file suffix (`.svg`).

    Raises KeyError for an unknown suffix, ExportError where the format cannot hold the drawing or a package
    for it is missing.
    """
    return Exporter(job)(suffix)


def require_sheets(options: Options) -> None:
    """Raises ExportError if something is to be shown of parts on sheets, and there are none."""
    asked = sorted(options.show.intersection(ON_SHEETS) - {"names"})
    if asked and options.sheet is None:
        message = f"`--show {','.join(asked)}` is about the parts on sheets, and there are none"
        hints = "lay them on sheets: `--sheet 600x400`", "the list alone is written by `-o cutlist.csv`"
        raise ExportError("E0924", message, *hints)


def _check(options: Options, suffix: str, wanted: Format) -> None:
    """Raises ExportError if the options ask a format for what it cannot have."""

    def refuse(option: str, is_asked: bool, ability: str) -> None:
        if is_asked and not getattr(wanted, ability):
            able = sorted(s for s, f in FORMATS.items() if getattr(f, ability))
            message = f"`{option}` has no meaning for `{suffix}`"
            raise ExportError("E0924", message, f"formats for it: {', '.join(able)}")

    refuse("--sheet", options.sheet is not None, "cuts")
    refuse("--kerf", options.kerf > 0, "cuts")
    refuse("--profile", options.profile is not None, "cuts")
    if options.nest is not None and options.sheet is None:
        message = "`--nest` packs parts on sheets, and there is none"
        raise ExportError("E0924", message, "give one: `--sheet 600x400`")
    require_sheets(options)
    refuse(f"--units {options.units}", options.units != "mm", "inches")
    refuse("--tile", options.tile is not None, "tiles")
    refuse("--theme", options.theme != "colour", "tiles")
    apart = "write it to a file of its own, without `--cut`, `--profile`, `--sheet` and `--kerf`"
    if options.theme not in ("colour", "cutter") and options.for_cutter:
        message = f"`--theme {options.theme}` colours a picture, and a cutter goes by colours of its own"
        raise ExportError("E0924", message, apart)
    if options.dimension and options.for_cutter and wanted.cuts:
        message = "`--dimension` explains the assembled drawing and has no place among what a cutter follows"
        raise ExportError("E0924", message, apart)


def suffix_of(
    name: str, fallback: str | None, known: Collection[str] = (), unknown: str = "there is no format `{}`"
) -> str:
    """Returns a file name's own suffix, else the format asked for (`svg`), of those that are `known`: all
    formats unless said. Raises ExportError, in words of its own where the format is `unknown`.
    """
    known = known or FORMATS
    own = PurePath(name).suffix.lower()
    said = f".{fallback.lower().lstrip('.')}" if fallback else ""
    for suffix in (own, said):
        if suffix in known:
            return suffix
    asked = (said or own).lstrip(".")
    message = unknown.format(asked) if asked else f"the name `{name}` does not tell a format"
    raise ExportError("E0905", message, f"formats: {', '.join(sorted(s.lstrip('.') for s in known))}")


def _emptiness(job: Job) -> list[Diagnostic]:
    drawing = job.drawing
    plans = [f"`{plan.path}`" for plan in drawing.plans[:3]]
    if drawing.bodies or drawing.strokes or (plans and "plan" in job.options.show):
        return []
    hints = (f"draw the parts of {', '.join(plans)}", "`--show plan` shows their boxes") if plans else ()
    return [Diagnostic("W0721", "nothing is drawn, so what is written is empty", hints=hints)]


def _unlisted(job: Job, suffix: str) -> list[Diagnostic]:
    if "list" not in job.options.show or suffix in (*PICTURES, ".csv"):
        return []
    hint = "write it beside: `-o cutlist.csv`, or `-o cutlist.pdf`"
    return [Diagnostic("N0755", f"the cut list is drawn in pictures, and `{suffix}` is none", hints=(hint,))]


def _pictures(suffix: str) -> Callable[[Sequence[Job]], Exported]:
    """Returns the writer of a format of pictures: their pages, and behind them those of the cut list."""

    def write(jobs: Sequence[Job]) -> Exported:
        from aidl_lang.export.picture import pages

        root = jobs[0].model.root
        drawn = [page for job in jobs for page in pages(job)]
        if "list" in jobs[0].options.show:
            from aidl_lang.export.sheets import pages as pages_of_list

            drawn += pages_of_list(jobs)
        return rendered(drawn, suffix, jobs[0].options, (root.doc or root.path).partition("\n")[0])

    return write


def _writer(module: str, name: str) -> Callable[[Any], Exported]:
    """Returns a writer by its module, which is loaded when it first writes."""
    return lambda given: getattr(import_module(f"aidl_lang.export.{module}"), name)(given)


def _each(module: str, name: str) -> Callable[[Sequence[Job]], Exported]:
    """Returns the writer of a format that has a file for each sheet."""

    def write(jobs: Sequence[Job]) -> Exported:
        first, *others = map(_writer(module, name), jobs)
        notes = tuple(note for made in (first, *others) for note in made.notes)
        return Exported(first.data, tuple(made.data for made in others), notes)

    return write


_ON_SOLIDS = "stroke dash shade color(…) edges halo shadow"
_STEP = _ON_SOLIDS, "STEP holds shapes with their colours, and its lines no width and no areas"
_STL = "stroke dash opacity shade color(…) edges halo shadow", "STL holds bare shapes"
_3MF = _ON_SOLIDS, "3MF holds solids with their colours, and draws nothing on them"
_DXF = "opacity shade stroke(none) edges halo shadow", "DXF holds outlines, and nothing is filled"

FORMATS: dict[str, Format] = {
    ".svg": Format(_pictures(".svg"), "SVG drawing", cuts=True, tiles=True, inches=True),
    ".pdf": Format(_pictures(".pdf"), "PDF, true to scale", cuts=True, tiles=True),
    ".png": Format(_pictures(".png"), "PNG picture", cuts=True, tiles=True),
    ".dxf": Format(_each("dxf", "to_dxf"), "DXF for cutters", lacks=_DXF, cuts=True, inches=True),
    ".csv": Format(_writer("sheets", "to_csv"), cuts=True),
    ".step": Format(_each("step", "to_step"), "STEP solid", ("OCP", "step"), _STEP),
    ".stp": Format(_each("step", "to_step"), needs=("OCP", "step"), lacks=_STEP),
    ".stl": Format(_each("mesh", "to_stl"), "STL mesh", lacks=_STL),
    ".3mf": Format(_each("mesh", "to_3mf"), "3MF for printers", ("lib3mf", "3mf"), _3MF),
    ".json": Format(_each("json", "to_json")),
}

OFFERED = {suffix[1:]: made.label for suffix, made in FORMATS.items() if made.label}
"""The formats that menus and tools offer, without the dot, with their labels."""


PICTURES = (".svg", ".png", ".pdf")


def render(picture: Picture, suffix: str, options: Options) -> bytes:
    """Writes a single picture in the format of a file suffix among `PICTURES`. Raises as `export` does."""
    return rendered([picture], suffix, options, "AIDL").data


def rendered(pages: Sequence[Picture], suffix: str, options: Options, title: str) -> Exported:
    """Writes pictures in a format among `PICTURES`: a PDF has a page for each, else there is a file for each.

    Raises as `export` does.
    """
    if suffix == ".svg":
        from aidl_lang.export.svg import to_svg

        data, *further = (to_svg(page, units=options.units).encode() for page in pages)
        return Exported(data, tuple(further))
    from aidl_lang.export.pdf import character_notes, to_pdf, to_png

    notes = character_notes(pages)
    if suffix == ".pdf":
        return Exported(to_pdf(pages, title), notes=notes)
    data, *further = (to_png(page, options.pixels) for page in pages)
    return Exported(data, tuple(further), notes)
