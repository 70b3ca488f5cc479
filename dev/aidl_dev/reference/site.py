"""The generated files of a checkout: the pages of `docs/reference`, the gallery, their pictures, the guide,
`llms.txt`.
"""

from __future__ import annotations

from pathlib import Path

from aidl_dev import write_changed
from aidl_dev.reference import coverage, gallery
from aidl_dev.reference.guide import GENERATED, guide
from aidl_dev.reference.llms import llms
from aidl_dev.reference.pages import MARK, pages, pictures
from aidl_lang.tools.reference.collect import reference

_FOLDER = "docs/reference"
COVERAGE = f"{_FOLDER}/coverage.md"


def texts(root: Path) -> dict[str, str]:
    """Returns every generated text by its path below the root of a checkout, except `COVERAGE`, which takes
    minutes.
    """
    found = {f"{_FOLDER}/{path}": text for path, text in pages(reference()).items()}
    found |= {path: guide(variant) for variant, path in GENERATED.items()}
    return {**found, gallery.PAGE: gallery.page(root), "llms.txt": llms(root)}


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
