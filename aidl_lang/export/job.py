"""What every writer works from: a job with its options; what it hands back, or why it cannot."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from importlib.util import find_spec
from pathlib import PurePath
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.records import record
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.solved import SolvedModel

if TYPE_CHECKING:
    from aidl_lang.export.cut_list import CutList
    from aidl_lang.export.profiles import Profile


DXF = ("arcs", "r12", "splines")
"""Outlines of lines and arcs, the same in the words of R12, or exact curves, as one entity each."""


UNITS: Mapping[str, float] = {"mm": 1.0, "in": 25.4}
"""Units that a file can be in, mm."""


SHOW = ("names", "points", "bbox", "constraints", "dof", "plan")
"""What explains a drawing on top of it."""


ON_SHEETS = ("names", "numbers", "list")
"""What is shown of parts laid on sheets: on them, and on pages of its own."""


Progress: TypeAlias = Callable[[int, int], None]


@record()
class Options:
    """The options of an export; each format reads those that concern it.

    show       what explains the drawing on top of it, some of `SHOW`, or of `ON_SHEETS` if there are sheets
    dimension  whether to draw dimensions
    cut        the outlines alone, as hairlines without fills: what a cutter follows
    pixels     larger side of a raster picture
    thickness  of bodies that have none of their own, mm, for solids
    timings    seconds per stage, for formats that carry them
    sheet      width and height in mm of the sheets that parts are laid on to be cut
    spacing    between parts on a sheet, and to its edge, mm
    nest       seconds for packing parts by their outlines; None packs them by their boxes
    kerf       width of the cut, mm: outlines grow by half of it
    tile       width and height in mm of the pages that a picture is printed over, 1:1
    overlap    of neighbouring pages, mm
    theme      the look of a picture as a whole, one of `themes.THEMES`
    units      of an SVG or a DXF, one of `UNITS`
    dxf        the kind of a DXF, one of `DXF`
    tolerance  how far the arcs may be from the curves that they stand for where only arcs are understood, mm
    profile    what colours, layers and widths tell a cutter, and in which order; `plain` unless said
    """

    show: frozenset[str] = field(default_factory=frozenset)
    dimension: bool = False
    cut: bool = False
    pixels: int = 1600
    thickness: float | None = None
    timings: Mapping[str, float] | None = None
    sheet: tuple[float, float] | None = None
    spacing: float = 3.0
    nest: float | None = None
    kerf: float = 0.0
    tile: tuple[float, float] | None = None
    overlap: float = 10.0
    theme: str = "colour"
    units: str = "mm"
    dxf: str = "arcs"
    tolerance: float = 0.01
    profile: Profile | None = None

    @property
    def for_cutter(self) -> bool:
        """True if only outlines are wanted."""
        asked = self.cut or self.profile is not None or self.theme == "cutter"
        return asked or self.sheet is not None or self.kerf > 0

    @property
    def followed(self) -> Profile | None:
        """The profile by which a cutter is told what to do; None if the file is for none."""
        if not self.for_cutter:
            return None
        from aidl_lang.export.profiles import PLAIN

        return self.profile or PLAIN


@record()
class Job:
    """The solved model, the drawing and the options that a writer works from.

    whole  the job that this one was made from, with all that is drawn as it is drawn
    is_flat  whether bodies lie on the ground wherever they stand in the model
    """

    model: SolvedModel
    drawing: Drawing
    diagnostics: Callable[[], Sequence[Diagnostic]] = tuple
    options: Options = field(default_factory=Options)
    whole: Job | None = None
    is_flat: bool = False

    @cached_property
    def cut_list(self) -> CutList:
        """The parts of the whole drawing, those that are equal together, each with its number."""
        from aidl_lang.export.cut_list import cut_list

        return cut_list(self) if self.whole is None else self.whole.cut_list


@record()
class Exported:
    """The content of a file, the contents of further files beside it, and diagnostics about them."""

    data: bytes
    further: tuple[bytes, ...] = ()
    notes: tuple[Diagnostic, ...] = ()


class ExportError(AidlError):
    """Raised if a format cannot hold a drawing; the diagnostic gives the reason and a remedy."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(Diagnostic(code, message, hints=hints))


def require(package: str, for_what: str, extra: str) -> None:
    """Raises ExportError if a package is not installed; the hint names the extra that installs it."""
    if find_spec(package) is None:
        message = f"`{for_what}` needs a package that is not installed"
        raise ExportError("E0913", message, f"pip install 'aidl-lang[{extra}]'")


def file_names(name: str, count: int) -> list[str]:
    """Returns the name of a file and those of further ones beside it: `part.svg`, `part-2.svg`, …"""
    path = PurePath(name)
    return [name, *(str(path.with_name(f"{path.stem}-{k}{path.suffix}")) for k in range(2, count + 1))]
