"""What every writer works from: a job with its options; what it hands back, or why it cannot;
the names of files.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from importlib.util import find_spec
from pathlib import PurePath
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean, listed, ticked
from aidl_lang.common.records import record
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.solved import SolvedModel

if TYPE_CHECKING:
    from aidl_lang.export import Exporter
    from aidl_lang.export.profiles import Profile
    from aidl_lang.export.sheets import CutList, Item


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
        from aidl_lang.export.sheets import cut_list

        return cut_list(self) if self.whole is None else self.whole.cut_list


@record()
class Exported:
    """The content of a file, the contents of further files beside it, and diagnostics about them."""

    data: bytes
    further: tuple[bytes, ...] = ()
    notes: tuple[Diagnostic, ...] = ()

    def files(self, name: str) -> list[tuple[str, bytes]]:
        """Returns the contents by the names of their files."""
        contents = (self.data, *self.further)
        return list(zip(file_names(name, len(contents)), contents, strict=True))


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


# --- Names of files for single parts, made of a pattern such as `parts/{part}.dxf`.

WORDS = ("part", "number", "material", "quantity")
_TELLING = ("part", "number")
"""Of these, what is another for each item."""
_WORD = re.compile(r"\{([A-Za-z_]+)\}")
_REFUSED = re.compile(r"[^\w.+-]+")
"""What file systems do not take, or take for something else: all but letters, digits, `_`, `.`, `+`, `-`."""
_RESERVED = re.compile(r"(con|prn|aux|nul|conin\$|conout\$|com\d|lpt\d)(\..*)?", re.IGNORECASE)
"""Names that stand for devices on Windows, whatever their suffix."""
_LONGEST = 80
"""Characters of a name of a part."""


def is_pattern(name: str) -> bool:
    """Tells whether the name of an output is one for each part. Raises ExportError (E0926) for a word that
    stands for nothing, and if all parts would go into one file.
    """
    words = _WORD.findall(name)
    for word in words:
        if word not in WORDS:
            near = did_you_mean(_braced(nearest(word, WORDS)))
            hints = near or [f"there are {listed(ticked(_braced(WORDS)))}"]
            raise ExportError("E0926", f"`{{{word}}}` in `{name}` stands for nothing", *hints)
    if words and not set(words) & set(_TELLING):
        message = f"`{name}` is one name for several parts"
        raise ExportError("E0926", message, "name them apart: with `{part}`, or with `{number}`")
    return bool(words)


def _braced(words: Sequence[str]) -> list[str]:
    return [f"{{{word}}}" for word in words]


def contents(
    writing: Exporter, name: str, suffix: str
) -> tuple[list[tuple[str, bytes]], tuple[Diagnostic, ...]]:
    """Returns all files of an output by name, and diagnostics about them. Raises as `writing` does."""
    if not is_pattern(name):
        made = writing(suffix)
        return made.files(name), made.notes
    parts = writing.parts(suffix)
    items = [item for item, _ in parts]
    names, notes = names_of_parts(name, items)
    several = [
        f"`{PurePath(n).stem}` ×{i.quantity}" for n, i in zip(names, items, strict=True) if i.quantity > 1
    ]
    if several and "quantity" not in _WORD.findall(name):
        message = f"a file has one piece, and several are to be cut: {listed(several, 8)}"
        hint = "`{quantity}` in the name of an output says how many: `{number}-{part}-x{quantity}`"
        notes.append(Diagnostic("N0759", message, hints=(hint,)))
    files = []
    for own, (_, made) in zip(names, parts, strict=True):
        files += made.files(own)
        notes += made.notes
    return files, tuple(dict.fromkeys(notes))


def names_of_parts(pattern: str, items: Sequence[Item]) -> tuple[list[str], list[Diagnostic]]:
    """Returns a name for each item, no two of them alike, with a warning if some had to be told apart."""
    taken: set[str] = set()
    names, changed = [], []
    for item in items:
        wanted = PurePath(_filled(pattern, item))
        path, count = wanted, 1
        # Some file systems take capital and small letters for the same.
        while str(path).casefold() in taken:
            count += 1
            path = wanted.with_name(f"{wanted.stem}-{count}{wanted.suffix}")
        taken.add(str(path).casefold())
        names.append(str(path))
        if count > 1:
            changed.append(str(path))
    are = "is" if len(changed) == 1 else "are"
    message = f"`{pattern}` gives several parts one name: {listed(ticked(changed), 4)} {are} numbered"
    hint = "`{number}` tells them apart: `{number}-{part}`"
    return names, [Diagnostic("W0758", message, hints=(hint,))] if changed else []


def _filled(pattern: str, item: Item) -> str:
    values = {
        "part": _safe(item.name.replace(", ", "+")),
        "number": str(item.number),
        "material": _safe(item.material) if item.material else "no-material",
        "quantity": str(item.quantity),
    }
    return _WORD.sub(lambda found: values[found[1]], pattern)


def _safe(text: str) -> str:
    """Returns a text as a name that every file system takes for a plain file."""
    name = _REFUSED.sub("-", text)[:_LONGEST].strip("-. ") or "part"
    return f"{name}_" if _RESERVED.fullmatch(name) else name
