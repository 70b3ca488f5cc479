"""Drawings of other programs: the outlines in an SVG or a DXF file, under names, in millimetres with y up."""

from __future__ import annotations

from pathlib import PurePosixPath

WHOLE = "drawing"
"""The name of all that is in a file, beside those of its parts."""

SUFFIXES = (".svg", ".dxf")


def is_drawing(path: str) -> bool:
    """Tells by its name whether a file is read as a drawing."""
    return PurePosixPath(path).suffix.lower() in SUFFIXES
