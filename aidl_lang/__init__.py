"""AIDL: write what the parts are and how they relate; a solver finds the coordinates.

    import aidl_lang

    model = aidl_lang.compile("solid plate { outline = rectangle(width: 80, height: 50) }")
    print(model.status)
    model.save("plate.svg")

`check` finds what is wrong without solving, `diff` tells what differs between two models, `format` prints the
canonical form. `docs/python.md` shows all of it.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from errno import ENOENT
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from aidl_lang.common.diagnostics import AidlError, Diagnostic, Severity
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import PROGRAM, Reads
from aidl_lang.version import __version__

if TYPE_CHECKING:
    from build123d import Compound

    from aidl_lang.building.model import Knob
    from aidl_lang.common.world import World
    from aidl_lang.export.comparison import Comparison
    from aidl_lang.export.job import Options
    from aidl_lang.geometry.solved import Change, ConstraintReport, SolvedModel, SolvedStructure
    from aidl_lang.geometry.survey import Part
    from aidl_lang.pipeline import Compiled, Settings
    from aidl_lang.tools.sweeping.session import Sweep

__all__ = [
    "AidlError",
    "Diagnostic",
    "Model",
    "Saved",
    "Severity",
    "SourceFile",
    "Span",
    "__version__",
    "check",
    "compile",
    "diff",
    "format",
    "sweep",
]


class Saved(NamedTuple):
    """The files that were written, and what there is to tell about them."""

    paths: tuple[Path, ...]
    notes: tuple[Diagnostic, ...]


class Model:
    """A compiled program: its solved structures, how well each constraint holds, and its drawings.

    Models can be copied and pickled. A notebook shows the drawing, and what there is to tell of it.
    """

    def __init__(self, compiled: Compiled, reads: Reads | None = None) -> None:
        self._compiled = compiled
        self._reads = reads or Reads()

    @property
    def ok(self) -> bool:
        """True if the program is right and every constraint and assertion holds."""
        return self._compiled.ok

    @property
    def status(self) -> str:
        """`solved`, `partial`, `failed`, or `wrong` when the program could not be built."""
        return self._compiled.status

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """The errors, warnings and notes, in order of place."""
        return self._compiled.diagnostics

    @property
    def params(self) -> dict[str, Knob]:
        """The knobs of the program by path, each with its `value`, `range`, `step`, `unit` and `doc`."""
        return {knob.path: knob for knob in self._compiled.knobs}

    def with_params(
        self, by_path: Mapping[str, str | float | bool] | None = None, /, **params: str | float | bool
    ) -> Model:
        """Solves the same program anew with some knobs set, by name or by path (`{"lid.height": 12}`)."""
        from aidl_lang import pipeline

        return Model(pipeline.again(self._compiled, {**(by_path or {}), **params}), self._reads)

    @property
    def solved(self) -> SolvedModel:
        """The solved model in numbers. Raises AidlError when there is none."""
        if self._compiled.model is None:
            raise self._compiled.refused("the program is wrong, so nothing was solved")
        return self._compiled.model

    @property
    def constraints(self) -> tuple[ConstraintReport, ...]:
        """Every constraint with its residual, in order of writing."""
        return self.solved.constraints

    @property
    def changed(self) -> tuple[Change, ...]:
        """Kept sizes that had to change."""
        return self.solved.changed

    @property
    def timings(self) -> dict[str, float]:
        """Seconds per stage."""
        return self._compiled.timings

    def __getitem__(self, path: str) -> SolvedStructure:
        """Returns a structure by its path, without the root's name too. Raises an AidlError, a KeyError."""
        root = self.solved.root
        found = root.find(path) or root.find(f"{root.path}.{path}")
        if found is None:
            from aidl_lang.common.names import nearest
            from aidl_lang.geometry.survey import NothingThereError

            known = [structure.path for structure in root.walk()]
            raise NothingThereError(path, "", nearest(path, known), known)
        return found

    def measure(self, path: str | None = None, densities: Mapping[str, float] | None = None) -> Part:
        """Measures a structure, a geometry or the whole: area, inertia, walls, gaps, mass.

        `densities` adds to the known ones, in kg/m³. Raises AidlError if there is no area to measure (also a
        KeyError), if the program is wrong, and if measuring takes longer than its settings allow.
        """
        return self._compiled.measured(path, densities)

    def to_svg(self, show: frozenset[str] = frozenset()) -> str:
        """Returns the drawing as SVG; `show` adds overlays: names, points, bbox, constraints, dof, plan."""
        from aidl_lang.export.job import Options

        return self._compiled.export(".svg", Options(show)).decode()

    def to_json(self, *, timings: bool = False) -> str:
        """Returns the solved model as JSON (docs/json.md)."""
        from aidl_lang.export.job import Options

        options = Options(timings=self.timings if timings else None)
        return self._compiled.export(".json", options).decode()

    def export(self, suffix: str, options: Options | None = None, **asked: object) -> bytes:
        """Returns the drawing in the format of a file suffix (`.dxf`), with the options of `aidl compile` as
        keywords or as a whole.

        Raises AidlError for an unknown format or option, if the format cannot hold the drawing, and if there
        is more than one file to it, as of several sheets.
        """
        from aidl_lang.export import suffix_of
        from aidl_lang.tools.cli.options import read

        wanted = suffix_of("", suffix)
        made = self._compiled.exported(wanted, options or read(asked, self._compiled).options)
        if made.further:
            message = f"{len(made.further) + 1} files are no single content"
            raise AidlError(Diagnostic("E0914", message, hints=("`save` writes them beside each other",)))
        return made.data

    def save(self, path: str | Path, **options: object) -> Saved:
        """Writes the drawing in the format of the file's suffix, with the options of `aidl compile` as
        keywords: `save("plate.dxf", kerf=0.15)`, `save("plate.pdf", theme="blueprint", dimension=True)`.
        Further sheets and pages go into files beside it; with `{part}` in its name there is a file for each
        part: `save("parts/{part}.dxf")`. Returns what was written.

        Raises AidlError for an unknown format or option, if the format cannot hold the drawing, and for a
        model that is not `ok` unless `best_effort=True`; OSError if a file cannot be written.
        """
        from aidl_lang.common.world import replace
        from aidl_lang.export import suffix_of
        from aidl_lang.export.job import contents, is_pattern
        from aidl_lang.tools.cli.options import read

        asked = read(options, self._compiled)
        suffix = suffix_of(str(path), asked.format)
        if not (self.ok or asked.best_effort):
            raise self._compiled.refused(
                "the model is not ok, so nothing is written without `best_effort=True`"
            )
        is_one = not is_pattern(str(path))
        made, notes = contents(self._compiled.exporting(asked.options), str(path), suffix)
        if is_one and not (folder := Path(path).parent).is_dir():
            raise FileNotFoundError(ENOENT, "there is no such folder", str(folder))
        self._reads.require_unread(name for name, _ in made)
        for name, data in made:
            Path(name).parent.mkdir(parents=True, exist_ok=True)
            replace(Path(name), data)
        return Saved(tuple(Path(name) for name, _ in made), notes)

    def to_build123d(self, thickness: float | None = None) -> Compound:
        """Returns the shapes as build123d has them, under their dotted paths: Parts of what has a thickness
        (`thickness` is that of solids without one, mm), Sketches of what has none, Curves of strokes, and
        a joint at each named circle and point.

        Raises AidlError for a model that is not `ok` or makes no valid shape, and without build123d.
        """
        from aidl_lang.tools.cad import to_build123d

        return to_build123d(self._compiled, thickness)

    def _repr_svg_(self) -> str | None:
        return self.to_svg() if self._compiled.model is not None else None

    def _repr_html_(self) -> str | None:
        """Returns the drawing with what there is to tell of it; None, for the drawing alone, without that."""
        if not self.diagnostics:
            return None
        from base64 import b64encode
        from html import escape

        from aidl_lang.common.render import render

        told = escape("\n".join(map(render, self.diagnostics)))
        drawing = self._repr_svg_()
        data = b64encode((drawing or "").encode()).decode()
        picture = f'<img alt="the drawing" src="data:image/svg+xml;base64,{data}">' if drawing else ""
        return f"{picture}<pre>{told}</pre>"

    def __repr__(self) -> str:
        problems = len(self._compiled.errors)
        return f"<aidl_lang.Model {self.status}, {problems} error{'s' * (problems != 1)}>"


def _read(text_or_path: str | Path) -> tuple[SourceFile, World | None]:
    """Returns a program and what it can import. One line that ends in `.aidl` is the name of a program."""
    from aidl_lang.common.world import DiskWorld, KeptWorld

    if isinstance(text_or_path, str):
        if "\n" in text_or_path or not text_or_path.strip().lower().endswith(PROGRAM):
            return SourceFile("<text>", text_or_path), None
        text_or_path = Path(text_or_path.strip())
    if not isinstance(text_or_path, Path):
        raise TypeError(f"a program is a str, or a Path to it, not {type(text_or_path).__name__}")
    if "{" in (name := str(text_or_path)) and not os.path.exists(name):
        message = "this Path holds a program, not the name of a file"
        raise AidlError(Diagnostic("E0901", message, hints=("give the program itself as a str",)))
    from aidl_lang.tools.cli import files

    disk = DiskWorld(text_or_path.parent)
    text = files.decoded(disk.reads.contents(text_or_path), f"`{name}`")
    return SourceFile(name, text), KeptWorld(disk)


def check(text: str | Path, settings: Settings | None = None, *, range: bool = False) -> list[Diagnostic]:
    """Returns the diagnostics of a program, without solving it. What is read is as for `compile`. With
    `range`, after solving it, and a warning tells where something changes kind over the range of a param.
    """
    from aidl_lang import pipeline

    source, world = _read(text)
    if not range:
        return pipeline.check(source, world, settings or pipeline.Settings())
    from aidl_lang.tools.ranges import turned

    compiled = pipeline.compile(source, world, settings=settings or pipeline.Settings())
    return [*compiled.diagnostics, *turned(compiled)]


def compile(
    text_or_path: str | Path,
    params: Mapping[str, str | float | bool] | None = None,
    settings: Settings | None = None,
) -> Model:
    """Compiles and solves a program. A string is the program itself; a `Path` is read, and so is a string on
    one line that ends in `.aidl`.

    `params` sets knobs by path, as `{"width": 200}`. Never raises for what a program says. Raises OSError for
    a file that cannot be read, and AidlError for one that is no text.
    """
    from aidl_lang import pipeline
    from aidl_lang.common.world import reads_of

    source, world = _read(text_or_path)
    compiled = pipeline.compile(source, world, params, settings or pipeline.Settings())
    return Model(compiled, reads_of(world))


def sweep(
    text_or_path: str | Path,
    params: Mapping[str, object] | None = None,
    *,
    output: str | Path | Iterable[str | Path] = (),
    table: str | Path | None = None,
    random: int | None = None,
    seed: int = 1,
    on: str = "local",
    jobs: int | None = None,
    cache: str | Path | None = None,
    resume: bool = False,
    stop_on_error: bool = False,
    timings: bool = True,
    time_limit: float | None = None,
    settings: Settings | None = None,
    **options: object,
) -> Sweep:
    """Compiles many variants of a program side by side: `sweep("box.aidl", {"width": range(60, 201, 20)})`.

    The values of `params` make a grid; `table` is a CSV whose rows are variants, `random` draws so many.
    Iterate over the sweep for the results as they come; `output` and the other options are those of `aidl
    sweep`, as keywords. What is read is as for `compile`. Raises AidlError for values, outputs and engines
    that cannot be, and for a program that is wrong as written.
    """
    from aidl_lang.tools.cli.options import read
    from aidl_lang.tools.sweeping.session import Sweep

    asked = read(options)
    source, world = _read(text_or_path)
    names = [output] if isinstance(output, str | Path) else list(output)
    return Sweep.begun(
        source,
        world,
        params or {},
        asked,
        settings,
        outputs=[str(name) for name in names],
        table=table,
        drawn=None if random is None else (random, seed),
        on=(on, jobs),
        cache=str(cache or ""),
        resumes=resume,
        stops_on_error=stop_on_error,
        timings=timings,
        seconds=time_limit,
    )


def diff(before: Model, after: Model) -> Comparison:
    """Compares two models: what moved, turned, grew, appeared and vanished.

    `str` of the comparison is a text for a reader, `to_dict` the same as data. Raises AidlError if a program
    is wrong, or comparing takes longer than its settings allow.
    """
    return before._compiled.compared(after._compiled)


def format(text: str) -> str:
    """Returns the canonical form of a program. Raises AidlError, with all mistakes, if it does not parse."""
    from aidl_lang import pipeline

    printed, diagnostics = pipeline.formatted(SourceFile("<text>", text))
    if printed is None:
        raise AidlError(*(d for d in diagnostics if d.is_error))
    return printed
