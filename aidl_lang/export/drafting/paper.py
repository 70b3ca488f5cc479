"""Paper, frames and scales of technical drawings: ISO 5457 and 5455, and what is usual beside them."""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.common.papers import PAPERS
from aidl_lang.common.records import record
from aidl_lang.geometry.evaluate import Bounds

SCALES = tuple(
    sorted(
        (
            *((factor * ten, 1) for ten in (1, 10) for factor in (2, 5)),
            (10, 1),
            (1, 1),
            *((1, factor * ten) for ten in (1, 10, 100, 1000) for factor in (2, 5, 10)),
        ),
        key=lambda scale: scale[1] / scale[0],
    )
)
"""The standard series, the largest first: millimetres on paper, and in the part."""

_SMALL = frozenset({"a5", "a4", "letter", "legal"})
_MARGIN = 10.0


@record()
class Standard:
    """The habits of a country: its paper from the smallest, the margin on which sheets are bound, where views
    from the side stand, and the language of the measure in the title block.
    """

    name: str
    papers: tuple[str, ...]
    binding: float
    is_first_angle: bool


STANDARDS = {
    "iso": Standard("iso", ("a4", "a3", "a2", "a1", "a0"), 20.0, True),
    "ansi": Standard("ansi", ("letter", "tabloid", "a2", "a1", "a0"), 10.0, False),
}


@record()
class Paper:
    """A sheet of paper as it lies before the reader."""

    name: str
    width: float
    height: float
    binding: float

    @property
    def label(self) -> str:
        return self.name.upper() if self.name[0] == "a" and len(self.name) == 2 else self.name.capitalize()

    @property
    def box(self) -> Bounds:
        return 0.0, 0.0, self.width, self.height

    @property
    def frame(self) -> Bounds:
        return self.binding, _MARGIN, self.width - _MARGIN, self.height - _MARGIN

    @property
    def digits(self) -> float:
        """Height of digits, mm: those of a small sheet are read from near."""
        return 2.5 if self.name in _SMALL else 3.5


def papers(standard: Standard, name: str | None, is_landscape: bool | None) -> Iterator[Paper]:
    """Yields the papers that may be taken, the smaller ones first."""
    for known in (name,) if name is not None else standard.papers:
        short, long = PAPERS[known]
        # A4 stands upright by habit, anything larger lies.
        ways = (False, True) if known in _SMALL else (True, False)
        for way in ways if is_landscape is None else (is_landscape,):
            width, height = (long, short) if way else (short, long)
            yield Paper(known, width, height, standard.binding)


def scale_text(scale: tuple[int, int]) -> str:
    return f"{scale[0]}:{scale[1]}"
