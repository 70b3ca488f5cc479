"""Writers, one file per format, behind one table from file suffix to writer."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from importlib import import_module
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import fixed, listed, named, ticked
from aidl_lang.common.records import record
from aidl_lang.export.job import ON_SHEETS, Exported, ExportError, Job, Options, Progress, require
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from aidl_lang.geometry.styles import is_filled, is_unlined

if TYPE_CHECKING:
    from aidl_lang.export.cut_list import Item
    from aidl_lang.export.marks import Picture

_OF_CUTTERS = ("--sheet", "--kerf", "--profile")
"""Options of formats that a cutter follows."""


@record()
class Format:
    """A writer. `extra` names the optional extra of the package that installs the module it needs.

    `label` describes the file in menus; a format without one is asked for by its suffix alone.
    `cuts` tells whether it holds outlines for a cutter, `tiles` whether it can be printed over several pages,
    `inches` whether it may be in other units than mm.
    `write` has the jobs of all sheets.
    """

    write: Callable[[Sequence[Job]], Exported]
    label: str = ""
    needs: str | None = None
    extra: str | None = None
    cuts: bool = False
    tiles: bool = False
    inches: bool = False


class Exporter:
    """Writes a job in several formats. What the options do to the drawing first is worked out once for all of
    them; `progress` hears how many steps of that are done, and of how many.
    """

    def __init__(self, job: Job, progress: Progress = lambda done, count: None) -> None:
        self._job, self._progress = job, progress

    def write(self, suffix: str) -> Exported:
        """Writes the drawing in the format of a file suffix (`.svg`). Raises as `export` does."""
        wanted, job = FORMATS[suffix], self._job
        if wanted.needs is not None and wanted.extra is not None:
            require(wanted.needs, suffix, wanted.extra)
        _check(job.options, suffix, wanted)
        jobs, notes = [job], [] if suffix == ".json" else _emptiness(job)
        unsaid = _unsaid(job, suffix, cuts=wanted.cuts)
        if job.options.sheet is not None or job.options.kerf:
            jobs, notes = self._prepared
        made = wanted.write(jobs)
        return replace(made, notes=(*notes, *_unlisted(job, suffix), *unsaid, *made.notes))

    def write_parts(self, suffix: str) -> list[tuple[Item, Exported]]:
        """Writes each different part by itself, flat, its corner at the origin; raises as `export`."""
        from aidl_lang.export.cut_list import jobs_of_parts

        if suffix in (".json", ".csv"):
            raise ExportError(
                "E0926",
                f"`{suffix}` tells of the whole, and is not written part by part",
                "give it a name without `{part}`",
            )
        _check(replace(self._job.options, sheet=None, nest=None, show=frozenset()), suffix, FORMATS[suffix])
        job, notes = self._grown if self._job.options.kerf else (self._job, [])
        made = []
        for item, alone in jobs_of_parts(job):
            written = Exporter(alone).write(suffix)
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
    return Exporter(job).write(suffix)


def require_sheets(options: Options) -> None:
    """Raises ExportError if something is to be shown of parts on sheets, and there are none."""
    asked = sorted(options.show.intersection(ON_SHEETS) - {"names"})
    if asked and options.sheet is None:
        raise ExportError(
            "E0924",
            f"`--show {','.join(asked)}` is about the parts on sheets, and there are none",
            "lay them on sheets: `--sheet 600x400`",
            "the list alone is written by `-o cutlist.csv`",
        )


def _check(options: Options, suffix: str, wanted: Format) -> None:
    """Raises ExportError if the options ask a format for what it cannot have."""
    _refuse(suffix, "--sheet", options.sheet is not None and not wanted.cuts)
    _refuse(suffix, "--kerf", options.kerf > 0 and not wanted.cuts)
    _refuse(suffix, "--profile", options.profile is not None and not wanted.cuts)
    if options.nest is not None and options.sheet is None:
        raise ExportError(
            "E0924", "`--nest` packs parts on sheets, and there is none", "give one: `--sheet 600x400`"
        )
    require_sheets(options)
    _refuse(suffix, f"--units {options.units}", options.units != "mm" and not wanted.inches)
    _refuse(suffix, "--tile", options.tile is not None and not wanted.tiles)
    _refuse(suffix, "--theme", options.theme != "colour" and suffix not in PICTURES)
    if options.theme not in ("colour", "cutter") and options.for_cutter:
        raise ExportError(
            "E0924",
            f"`--theme {options.theme}` colours a picture, and a cutter goes by colours of its own",
            "write it to a file of its own, without `--cut`, `--profile`, `--sheet` and `--kerf`",
        )
    if options.dimension and options.for_cutter and wanted.cuts:
        raise ExportError(
            "E0924",
            "`--dimension` explains the assembled drawing and has no place among what a cutter follows",
            "write it to a file of its own, without `--cut`, `--profile`, `--sheet` and `--kerf`",
        )


def suffix_of(name: str, fallback: str | None = None) -> str:
    """Returns a file name's own suffix, else the format asked for (`svg`). Raises ExportError if unknown."""
    own = PurePath(name).suffix.lower()
    said = f".{fallback.lower().lstrip('.')}" if fallback else ""
    for suffix in (own, said):
        if suffix in FORMATS:
            return suffix
    asked = (said or own).lstrip(".")
    message = f"there is no format `{asked}`" if asked else f"the name `{name}` does not tell a format"
    raise ExportError("E0905", message, f"formats: {', '.join(sorted(s.lstrip('.') for s in FORMATS))}")


def _emptiness(job: Job) -> list[Diagnostic]:
    drawing = job.drawing
    plans = [f"`{plan.path}`" for plan in drawing.plans[:3]]
    if drawing.bodies or drawing.strokes or (plans and "plan" in job.options.show):
        return []
    hints = (f"draw the parts of {', '.join(plans)}", "`--show plan` shows their boxes") if plans else ()
    return [Diagnostic("W0721", "nothing is drawn, so what is written is empty", hints=hints)]


def _unsaid(job: Job, suffix: str, *, cuts: bool) -> list[Diagnostic]:
    said = [*blind_notes(job, suffix), *followed_notes(job)] if cuts else []
    return unsaid_notes(job, suffix, cuts=cuts) + said


def _refuse(suffix: str, option: str, is_refused: bool) -> None:
    if is_refused:
        able = sorted(
            s
            for s, f in FORMATS.items()
            if (f.cuts if option in _OF_CUTTERS else f.inches if "units" in option else f.tiles)
        )
        raise ExportError(
            "E0924", f"`{option}` has no meaning for `{suffix}`", f"formats for it: {', '.join(able)}"
        )


def _files(parts: Sequence[Exported]) -> Exported:
    """Joins several contents to one file with the others beside it."""
    data, *further = (content for part in parts for content in (part.data, *part.further))
    return Exported(data, tuple(further), tuple(note for part in parts for note in part.notes))


def _pages_of_list(jobs: Sequence[Job]) -> list[Picture]:
    if "list" not in jobs[0].options.show:
        return []
    from aidl_lang.export.cut_list import pages

    return pages(jobs)


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
        drawn = [*(page for job in jobs for page in pages(job)), *_pages_of_list(jobs)]
        return rendered(drawn, suffix, jobs[0].options, (root.doc or root.path).partition("\n")[0])

    return write


def _json(jobs: Sequence[Job]) -> Exported:
    from aidl_lang.export.json import to_json

    (job,) = jobs
    return Exported(to_json(job.model, job.drawing, job.diagnostics(), job.options.timings).encode())


def _writer(module: str, name: str) -> Callable[[Any], Exported]:
    """Returns a writer by its module, which is loaded when it first writes."""
    return lambda given: getattr(import_module(f"aidl_lang.export.{module}"), name)(given)


def _each(module: str, name: str) -> Callable[[Sequence[Job]], Exported]:
    """Returns the writer of a format that has a file for each sheet."""
    return lambda jobs: _files([*map(_writer(module, name), jobs)])


FORMATS: dict[str, Format] = {
    ".svg": Format(_pictures(".svg"), "SVG drawing", cuts=True, tiles=True, inches=True),
    ".pdf": Format(_pictures(".pdf"), "PDF, true to scale", cuts=True, tiles=True),
    ".png": Format(_pictures(".png"), "PNG picture", cuts=True, tiles=True),
    ".dxf": Format(_each("dxf", "to_dxf"), "DXF for cutters", cuts=True, inches=True),
    ".csv": Format(_writer("cut_list", "to_csv"), cuts=True),
    ".step": Format(_each("step", "to_step"), "STEP solid", "OCP", "step"),
    ".stp": Format(_each("step", "to_step"), needs="OCP", extra="step"),
    ".stl": Format(_each("mesh", "to_stl"), "STL mesh"),
    ".3mf": Format(_each("mesh", "to_3mf"), "3MF for printers", "lib3mf", "3mf"),
    ".json": Format(_json),
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


# --- What a program says and a file cannot hold, or would hold twice.

_Holder = SolvedStructure | SolvedGeometry
_NAMED = 6
_UNLINED = "stroke(none)"
_AREA = "color(…)"
"""That of an area of a solid or a drawing, by itself."""
_WITHOUT: Mapping[str, str] = {
    "stroke": "cutter .step .stl .3mf",
    "dash": "cutter .step .stl .3mf",
    "opacity": "cutter .stl .dxf",
    "shade": "cutter .step .stl .3mf .dxf",
    _UNLINED: ".dxf",
    _AREA: ".step .stl .3mf",
    "edges": "cutter .step .stl .3mf .dxf",
    "halo": "cutter .step .stl .3mf .dxf",
}
"""By attribute, or one as written, the files that have no place for it; all others are drawn so."""
_WHY: Mapping[str, str] = {
    "cutter": "a cutter follows whole lines of one width, and fills nothing",
    ".step": "STEP holds shapes with their colours, and its lines no width and no areas",
    ".stl": "STL holds bare shapes",
    ".3mf": "3MF holds solids with their colours, and draws nothing on them",
    ".dxf": "DXF holds outlines, and nothing is filled",
}


def unsaid_notes(job: Job, suffix: str, *, cuts: bool) -> list[Diagnostic]:
    """Returns a note if a file has no place for stated looks; `cuts`: a cutter may read the format."""
    file = "cutter" if cuts and job.options.for_cutter else suffix.replace(".stp", ".step")
    lost = [name for name, files in _WITHOUT.items() if file in files.split()]
    stated = list(_stated(job.model.root, lost))
    if not stated:
        return []
    names, times = [n for n in lost if any(n == name for _, name in stated)], len({id(h) for h, _ in stated})
    counts = "counts" if len(names) == 1 else "count"
    return [
        Diagnostic(
            "N0741",
            f"{listed(ticked(names, '@'))} {counts} for nothing in this file: {_WHY[file]}",
            stated[0][0].span,
            "stated here" if times == 1 else f"stated here first, {times} times in all",
            hints=("pictures (.svg, .png, .pdf) are drawn so",),
        )
    ]


def blind_notes(job: Job, suffix: str) -> list[Diagnostic]:
    """Returns a note on holes that end in their solid, of which a cutter can engrave the outline alone."""
    depths = {path: s.depth for path, s in job.drawing.styles.items() if s.is_blind}
    blind = [path for path in job.drawing.regions if path in depths]
    if not blind or (job.options.followed is None and suffix != ".dxf"):
        return []
    structure = job.model.root.find(blind[0])
    is_one = len(blind) == 1
    deep = {fixed(depths[path][0]) for path in blind}
    return [
        Diagnostic(
            "N0756",
            f"{named(blind, _NAMED)} {'ends' if is_one else 'end'} in {'its' if is_one else 'their'} solid: "
            f"{'its outline is' if is_one else 'their outlines are'} engraved, and nothing is cut there",
            None if structure is None else structure.span,
            hints=(f"sink or mill there to the depth that is said: {listed(sorted(deep))} mm",),
        )
    ]


def followed_notes(job: Job) -> list[Diagnostic]:
    """Returns notes on layers that a cutter's profile does not know, and on areas that are none."""
    asked, profile = job.options.profile, job.options.followed
    if profile is None:
        return []
    from aidl_lang.export.cuts import unfilled
    from aidl_lang.export.profiles import PLAIN

    notes = []
    unknown = {
        str(s.attributes["layer"][0]): s.span
        for s in reversed(list(job.model.root.walk()))
        if "layer" in s.attributes and not profile.knows(str(s.attributes["layer"][0]))
    }
    if unknown and asked not in (None, PLAIN):
        names = list(unknown)[::-1]
        notes.append(
            Diagnostic(
                "N0754",
                f"the profile `{profile.name}` does not say what is done on the "
                f"{'layer' if len(names) == 1 else 'layers'} {named(names)}: "
                "parts are cut there and drawings engraved as elsewhere",
                unknown[names[0]],
                hints=(f'say it in a file for `--profile`: `[layers]` with `"{names[0]}" = "score"`',),
            )
        )
    for path in unfilled(job.drawing, profile):
        structure = job.model.root.find(path)
        notes.append(
            Diagnostic(
                "W0757",
                f"lines of `{path}` enclose nothing, so there they are engraved as lines and not as areas",
                None if structure is None else structure.span,
                hints=("close them: end each where the next one begins", "or put them on a layer for lines"),
            )
        )
    return notes


def _states(holder: _Holder, kind: str, name: str) -> bool:
    if name == _AREA:
        return isinstance(holder, SolvedGeometry) and "color" in holder.attributes and is_filled(holder, kind)
    return is_unlined(holder.attributes) if name == _UNLINED else name in holder.attributes


def _stated(root: SolvedStructure, names: Collection[str]) -> Iterator[tuple[_Holder, str]]:
    for structure in root.walk():
        holders: tuple[_Holder, ...] = (structure, *structure.drawn)
        yield from ((each, name) for each in holders for name in names if _states(each, structure.kind, name))


def twice_compensated(root: SolvedStructure, width: float) -> list[Diagnostic]:
    """Returns a note if a program makes up by itself for a cut that outlines are now widened by."""
    shapes = [
        shape
        for structure in root.walk()
        for geometry in structure.drawn
        for shape in geometry.walk()
        if not shape.construction and _own_kerf(shape.values)
    ]
    others = [structure for structure in root.walk() if _own_kerf(structure.params)]
    if not (shapes or others):
        return []
    # What is drawn is told before the param that it is drawn by.
    first = shapes[0] if shapes else others[0]
    own = fixed(_own_kerf(shapes[0].values if shapes else others[0].params))
    more = f" and {len(shapes) - 1} more" if len(shapes) > 1 else ""
    return [
        Diagnostic(
            "N0742",
            "the width of the cut is made up for twice: "
            f"by `--kerf` and by the `kerf` of `{first.path}`{more}",
            first.span,
            f"drawn for a cut of {own} mm, and grown for one of {fixed(width)} mm",
            hints=(
                "leave out `--kerf`: the program does it",
                "or have the program draw without it: with `-D kerf=0` if it is a `param`",
            ),
        )
    ]


def _own_kerf(values: Mapping[str, object]) -> float:
    own = values.get("kerf", 0.0)
    return own if isinstance(own, float | int) else 0.0
