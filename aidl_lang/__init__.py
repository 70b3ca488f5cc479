"""AIDL: write what the parts are and how they relate; a solver finds the coordinates.

    import aidl_lang

    model = aidl_lang.compile("solid plate { outline = rectangle(width: 80, height: 50) }")
    print(model.status)
    model.save("plate.svg")

`check` finds what is wrong without solving, `diff` tells what differs between two models, `format` prints the
canonical form.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.diagnostics import Diagnostic, Severity
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.version import __version__

if TYPE_CHECKING:
    from aidl_lang.building.model import Knob
    from aidl_lang.export import Options
    from aidl_lang.export.comparison import Comparison
    from aidl_lang.geometry.solved import Change, ConstraintReport, SolvedModel, SolvedStructure
    from aidl_lang.geometry.survey import Part
    from aidl_lang.pipeline import Compiled, Settings

__all__ = [
    "Diagnostic",
    "Model",
    "Severity",
    "SourceFile",
    "Span",
    "__version__",
    "check",
    "compile",
    "diff",
    "format",
]


class Model:
    """A compiled program: its solved structures, how well each constraint holds, and its drawings."""

    def __init__(self, compiled: Compiled) -> None:
        self._compiled = compiled

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
        return self._compiled.diagnostics

    @property
    def params(self) -> tuple[Knob, ...]:
        """The knobs of the program with their ranges and values."""
        return self._compiled.knobs

    @property
    def solved(self) -> SolvedModel:
        """The solved model in numbers. Raises ValueError when there is none."""
        if self._compiled.model is None:
            raise ValueError("the program is wrong, so nothing was solved; see `diagnostics`")
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
        """Returns a structure by its dotted path, with or without the root's name. Raises KeyError."""
        root = self.solved.root
        found = root.find(path) or root.find(f"{root.path}.{path}")
        if found is None:
            raise KeyError(path)
        return found

    def measure(self, path: str | None = None, densities: Mapping[str, float] | None = None) -> Part:
        """Measures a structure, a geometry or the whole: area, inertia, walls, gaps, mass.

        `densities` adds to the known ones, in kg/m³. Raises KeyError if there is no area to measure, and
        ValueError if the program is wrong or measuring takes longer than its settings allow.
        """
        return self._compiled.measured(path, densities)

    def to_svg(self, show: frozenset[str] = frozenset()) -> str:
        """Returns the drawing as SVG; `show` adds overlays: names, points, bbox, constraints, dof, plan."""
        from aidl_lang.export import Options

        return self._compiled.export(".svg", Options(show)).decode()

    def to_json(self, *, timings: bool = False) -> str:
        """Returns the solved model as JSON (docs/json.md)."""
        from aidl_lang.export import Options

        options = Options(timings=self.timings if timings else None)
        return self._compiled.export(".json", options).decode()

    def export(self, suffix: str, options: Options | None = None) -> bytes:
        """Returns the drawing in the format of a file suffix (`.dxf`).

        Raises KeyError for an unknown suffix, and ValueError if the format cannot hold the drawing.
        """
        return self._compiled.export(suffix, options)

    def save(self, path: str | Path) -> None:
        """Writes the drawing in the format of the file's suffix; raises as `export` does."""
        path = Path(path)
        path.write_bytes(self.export(path.suffix))

    def _repr_svg_(self) -> str | None:
        return self.to_svg() if self._compiled.model is not None else None

    def __repr__(self) -> str:
        problems = sum(d.is_error for d in self.diagnostics)
        return f"<aidl_lang.Model {self.status}, {problems} error{'s' * (problems != 1)}>"


def _source(text_or_path: str | Path) -> tuple[SourceFile, Path | None]:
    if isinstance(text_or_path, Path):
        return SourceFile(str(text_or_path), text_or_path.read_text("utf-8")), text_or_path.parent
    return SourceFile("<text>", text_or_path), None


def check(text: str | Path, settings: Settings | None = None) -> list[Diagnostic]:
    """Returns the diagnostics of a program, without solving it. A `Path` is read, a string is the program
    itself.
    """
    from aidl_lang import pipeline
    from aidl_lang.common.world import DiskWorld

    source, root = _source(text)
    world = DiskWorld(root) if root is not None else None
    return pipeline.check(source, world, settings or pipeline.Settings())


def compile(
    text_or_path: str | Path,
    params: Mapping[str, str | float | bool] | None = None,
    settings: Settings | None = None,
) -> Model:
    """Compiles and solves a program. A `Path` is read, a string is the program itself.

    `params` sets knobs by path, as `{"width": 200}`. Never raises for what a program says.
    """
    from aidl_lang import pipeline
    from aidl_lang.common.world import DiskWorld

    source, root = _source(text_or_path)
    world = DiskWorld(root) if root is not None else None
    return Model(pipeline.compile(source, world, params, settings or pipeline.Settings()))


def diff(before: Model, after: Model) -> Comparison:
    """Compares two models: what moved, turned, grew, appeared and vanished.

    `str` of the comparison is a text for a reader, `to_dict` the same as data. Raises ValueError if a program
    is wrong, or comparing takes longer than its settings allow.
    """
    return before._compiled.compared(after._compiled)


def format(text: str) -> str:
    """Returns the canonical form of a program. Raises ValueError if it does not parse."""
    from aidl_lang import pipeline

    printed, diagnostics = pipeline.formatted(SourceFile("<text>", text))
    if printed is None:
        raise ValueError(next(d.message for d in diagnostics if d.is_error))
    return printed
