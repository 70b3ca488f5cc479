"""The generated files of a checkout: the pages of `docs/reference`, the gallery, their pictures, the guide,
`llms.txt`, and the lists of formats in other pages.
"""

from __future__ import annotations

import re
from pathlib import Path

from aidl_dev import write_changed
from aidl_dev.reference import coverage, gallery
from aidl_dev.reference.guide import GENERATED, guide
from aidl_dev.reference.llms import llms
from aidl_dev.reference.pages import MARK, pages, pictures
from aidl_lang.export import FORMATS
from aidl_lang.tools.reference.collect import reference

_FOLDER = "docs/reference"
COVERAGE = f"{_FOLDER}/coverage.md"
_LISTING = ("docs/python.md", "docs/diagnostics/E0905.md", "docs/diagnostics/E0924.md")
"""Pages that show messages with a list of formats."""


def texts(root: Path) -> dict[str, str]:
    """Returns every generated text by its path below the root of a checkout, except `COVERAGE`, which takes
    minutes.
    """
    found = {f"{_FOLDER}/{path}": text for path, text in pages(reference()).items()}
    found |= {path: guide(variant) for variant, path in GENERATED.items()}
    found |= {path: _listed((root / path).read_text("utf-8")) for path in _LISTING}
    return {**found, gallery.PAGE: gallery.page(root), "llms.txt": llms(root)}


def _listed(page: str) -> str:
    """Returns a page with the formats that there are in the messages that it shows."""
    page = re.sub(r"(?<=formats: )[\w, ]+", ", ".join(sorted(suffix[1:] for suffix in FORMATS)), page)
    cut = ", ".join(sorted(suffix for suffix, made in FORMATS.items() if made.cuts))
    return re.sub(r"(?<=formats for it: )[\w., ]+", cut, page)


def drawn(root: Path) -> dict[str, bytes]:
    """Returns every generated picture by its path below the root."""
    found = {f"{_FOLDER}/{path}": data for path, data in pictures(reference()).items()}
    return found | gallery.pictures(root)


def strays(root: Path, known: set[str]) -> list[str]:
    """Returns pages and pictures that are no longer generated."""
    folder = root / _FOLDER
    files = [path for path in folder.glob("*.md") if path.read_text("utf-8").rstrip().endswith(MARK)]
    images = (*folder.glob("images/*"), *(root / gallery.IMAGES).glob("*"))
    found = (path.relative_to(root).as_posix() for path in (*files, *images))
    return sorted(path for path in found if path not in known)


def write(root: Path) -> None:
    """Updates the generated files. A file that is right already is not touched."""
    current = {path: text.encode() for path, text in texts(root).items()} | drawn(root)
    current[COVERAGE] = coverage.page().encode()
    write_changed(root, current)
    for stray in strays(root, set(current)):
        (root / stray).unlink()
