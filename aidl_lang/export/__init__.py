"""Writers, one file per format, behind one table from file suffix to writer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.util import find_spec

from aidl_lang.diagnostics import Diagnostic
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.solved import SolvedModel

SHOW = ("names", "points", "bbox", "constraints", "dof", "plan")


@dataclass(frozen=True)
class Options:
    """How to write. A format takes what concerns it.

    show       what explains the drawing on top of it, some of `SHOW`
    dimension  whether to draw dimensions
    cut        the outlines alone, as hairlines without fills: what a cutter follows
    pixels     larger side of a raster picture
    thickness  of bodies that have none of their own, mm, for solids
    timings    seconds per stage, for formats that carry them
    """

    show: frozenset[str] = field(default_factory=frozenset)
    dimension: bool = False
    cut: bool = False
    pixels: int = 1600
    thickness: float | None = None
    timings: Mapping[str, float] | None = None


@dataclass(frozen=True)
class Job:
    """What a writer may draw on."""

    model: SolvedModel
    drawing: Drawing
    diagnostics: tuple[Diagnostic, ...] = ()
    options: Options = field(default_factory=Options)


@dataclass(frozen=True)
class Exported:
    """The content of a file, that of further ones beside it, and what there is to say of them."""

    data: bytes
    further: tuple[bytes, ...] = ()
    notes: tuple[Diagnostic, ...] = ()


class ExportError(ValueError):
    """A drawing cannot be written in a format; the diagnostic says why, and what would help."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(message)
        self.diagnostic = Diagnostic(code, message, hints=hints)


@dataclass(frozen=True)
class Format:
    """A writer. `extra` names the optional extra of the package that brings the module it needs."""

    write: Callable[[Job], Exported]
    needs: str | None = None
    extra: str | None = None


def export(job: Job, suffix: str) -> Exported:
    """The drawing in the format of a file suffix (`.svg`).

    Raises KeyError for an unknown suffix, ExportError where the format cannot hold the drawing or a package
    for it is missing.
    """
    wanted = FORMATS[suffix]
    if wanted.needs is not None and find_spec(wanted.needs) is None:
        raise ExportError(
            "E0913",
            f"`{suffix}` needs a package that is not installed",
            f"pip install 'aidl-lang[{wanted.extra}]'",
        )
    return wanted.write(job)


def _svg(job: Job) -> Exported:
    from aidl_lang.export.picture import picture
    from aidl_lang.export.svg import to_svg

    return Exported(to_svg(picture(job)).encode())


def _json(job: Job) -> Exported:
    from aidl_lang.export.json import to_json

    return Exported(to_json(job.model, job.drawing, job.diagnostics, job.options.timings).encode())


FORMATS: dict[str, Format] = {
    ".svg": Format(_svg),
    ".json": Format(_json),
}
