"""The pictures of pages that are written by hand: a picture that follows a program is that of the
program (`python -m aidl_site.pictures ROOT`, a part of `make reference`).
"""

from __future__ import annotations

import os.path
import re
import sys
from pathlib import Path

from aidl_lang.tools.reference import picture_of

FOLDERS = ("docs", "docs/start", "docs/howto")
"""Folders whose pages are looked through."""
_SHOWN = re.compile(r"^```aidl\n(.*?)^```\n((?:\s*!\[[^\]]*\]\([^)]+\.svg\))+)", re.MULTILINE | re.DOTALL)
_PICTURE = re.compile(r"\(([^)]+\.svg)\)")
_DIMENSIONED = "-dimensioned"
"""What the name of a picture ends in that has dimensions."""


def pictures(root: Path) -> dict[str, bytes]:
    """Returns the drawings that follow a program on a page, by their paths below the root of a checkout.
    Raises ValueError if a program does not compile.
    """
    found = {}
    for folder in FOLDERS:
        for page in sorted((root / folder).glob("*.md")):
            for program, shown in _SHOWN.findall(page.read_text("utf-8")):
                for target in _PICTURE.findall(shown):
                    path = os.path.normpath(f"{folder}/{target}")
                    about, dimension = f"{path}, on {page.name}", _DIMENSIONED in path
                    found[path] = picture_of(about, program, dimension=dimension)
    return found


def write(root: Path) -> None:
    """Draws what has changed."""
    for path, data in pictures(root).items():
        file = root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        if not file.exists() or file.read_bytes() != data:
            file.write_bytes(data)


if __name__ == "__main__":
    try:
        write(Path(sys.argv[1]))
    except ValueError as reason:
        sys.exit(str(reason))
