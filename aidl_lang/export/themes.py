"""The looks of a picture as a whole: as the author coloured it, white on blue, or black on white."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import singledispatch

from aidl_lang.common.records import record
from aidl_lang.export.marks import HALO, Area, Curves, Dot, Frame, Group, Ink, Mark, Picture, Text, polygon

AS_COLOURED, FOR_CUTTER = "colour", "cutter"


@record()
class Theme:
    """The colours that a picture is reduced to: of the paper, of what is filled, and of every line.

    Fills that show through, as light and shade do, are left out: of one colour they would be a veil over the
    lines below.
    """

    paper: str
    fill: str
    line: str


REDUCED = {
    "blueprint": Theme("#1d4b87", "#2a5a99", "#eaf2ff"),
    "ink": Theme("#ffffff", "#ffffff", "#000000"),
}
THEMES = (AS_COLOURED, *REDUCED, FOR_CUTTER)


def themed(picture: Picture, name: str) -> Picture:
    """Returns the picture in a theme; unchanged in those that keep its colours. Raises KeyError."""
    if name in (AS_COLOURED, FOR_CUTTER):
        return picture
    theme = REDUCED[name]
    left, bottom, right, top = picture.box
    sheet = polygon((left, bottom), (right, bottom), (right, top), (left, top))
    paper = Group("paper", (Area(sheet, theme.paper, None, "paper"),))
    groups = (replace(g, marks=tuple(_all_reduced(g.marks, theme))) for g in picture.groups)
    return replace(picture, groups=(paper, *groups))


def _all_reduced(marks: Iterable[Mark], theme: Theme) -> Iterator[Mark]:
    for mark in marks:
        reduced = _reduced(mark, theme)
        if not isinstance(reduced, Area) or reduced.fill or reduced.ink:
            yield reduced


@singledispatch
def _reduced(mark: Mark, theme: Theme) -> Mark:
    raise TypeError(mark)


@_reduced.register
def _(mark: Area, theme: Theme) -> Mark:
    if mark.role == HALO:
        return replace(mark, fill=theme.paper)
    if mark.is_sign:
        return replace(mark, fill=theme.line)
    ink = None if mark.ink is None else _ink(mark.ink, theme)
    fill = theme.fill if mark.fill and mark.opacity == 1.0 and not mark.fades else None
    return replace(mark, fill=fill, ink=ink, opacity=1.0, gradient=None)


@_reduced.register
def _(mark: Curves, theme: Theme) -> Mark:
    if mark.role == HALO:
        return replace(mark, ink=replace(mark.ink, color=theme.paper))
    return replace(mark, ink=_ink(mark.ink, theme))


@_reduced.register
def _(mark: Text, theme: Theme) -> Mark:
    return replace(mark, color=theme.line, halo=False)


@_reduced.register
def _(mark: Dot | Frame, theme: Theme) -> Mark:
    return replace(mark, color=theme.line)


def _ink(ink: Ink, theme: Theme) -> Ink:
    return replace(ink, color=theme.line)
