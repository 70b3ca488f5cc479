"""The kinds of files that a program may read beside itself, by their suffixes."""

from __future__ import annotations

from pathlib import PurePath

from aidl_lang.common import drawings, font_files

PROGRAM = ".aidl"
DATA = (*font_files.SUFFIXES, *drawings.SUFFIXES)
"""What is read as bytes: no message quotes it."""


def is_data(path: str | PurePath) -> bool:
    """Tells whether a file is a font or a drawing of another program."""
    return PurePath(path).suffix.lower() in DATA


def may_be_read(path: str | PurePath) -> bool:
    """Tells whether a program may read a file of this name."""
    return PurePath(path).suffix == PROGRAM or is_data(path)
