"""All that a public name or a format needs: one test tells everything that is missing, with the command that
makes it or the file in which it is written.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from aidl_dev.highlighting import site as colours
from aidl_dev.reference import coverage, gallery, site
from aidl_dev.reference.pages import image
from aidl_lang.checking import builtins, library
from aidl_lang.export import FORMATS
from aidl_lang.tools.reference.collect import reference
from tests.checker import test_corpus as corpus
from tests.documents import ROOT
from tests.property import test_shapes as shapes

ENTRIES = list(reference().entries.values())

FOR_THE_LIBRARY = """
glyphs ink lettered traced traced_part where shown sizes convex_corners refuse channels outline_clearance
point_at way_between
"""
"""Builtins that only the library's own definitions use: they have no section in `stdlib/docs`."""


def test_every_public_name_has_all_that_it_needs() -> None:
    told = [*_undocumented(), *_stale(), *_untried(), *_unlisted()]
    if told:
        pytest.fail("\n".join(told), pytrace=False)


def _undocumented() -> Iterator[str]:
    for entry in ENTRIES:
        where = f"`{entry.name}`, {entry.where}"
        if not re.search(r"[.:)]$", entry.doc.line) or len(entry.doc.line) > 160:
            yield f"{where}: begins its `///` comment with a sentence of at most 160 letters, for lists"
        if not entry.doc.example:
            yield f"{where}: ends its `///` comment with a whole program that shows it"
        if "```" in entry.doc.text:
            yield f"{where}: has one example, after the text"
    sections = {name for name in builtins.SIGNATURES if reference().find(name)}
    for name in sorted(builtins.SIGNATURES.keys() - sections - {*FOR_THE_LIBRARY.split()}):
        yield f"`{name}` is built in: write a section in `stdlib/docs`"


def _stale() -> Iterator[str]:
    """What one command makes."""
    written = site.texts(ROOT)
    made = {**written, **colours.texts(ROOT)}
    stale = [path for path, text in made.items() if _read(path) != text]
    pictures = {f"docs/reference/{image(entry)}" for entry in ENTRIES if entry.doc.example}
    pictures |= set(gallery.image_paths(ROOT))
    stale += [path for path in pictures if not (ROOT / path).is_file()]
    stale += site.strays(ROOT, pictures | written.keys())
    page = _read(site.COVERAGE)
    if coverage.headings(page) != coverage.constraints() or coverage.header() not in page:
        stale.append(site.COVERAGE)
    if stale:
        yield f"run `make reference`, which writes {', '.join(sorted(stale))}"


def _untried() -> Iterator[str]:
    for name in sorted(corpus.unused()):
        yield f"`{name}` is stated neither in its example nor in `tests/checker/corpus`: both are judged"
    for name in sorted(corpus.unjudged()):
        yield f"`{name}` has no line in `tests/checker/relations.py`, which judges it from outside"
    for call in shapes.unmeasured():
        yield f"`{call}` has no area and perimeter in `tests/property/shapes.md`"

    for name in coverage.unshown(_read(site.COVERAGE)):
        yield f"`{name}(a, b)` takes nothing: say how it is called in `FORMS` of `{coverage.__name__}`"


def _unlisted() -> Iterator[str]:
    """The formats without a row in the table of formats."""
    page = _read("docs/cli.md")
    for suffix in FORMATS:
        if not re.search(rf"^\|[^|]*`{re.escape(suffix)}`", page, re.MULTILINE):
            yield f"`{suffix}` is a format: give it a row in the table of `docs/cli.md`"


def _read(path: str) -> str:
    return (ROOT / path).read_text("utf-8") if (ROOT / path).is_file() else ""


def test_no_name_takes_the_place_of_a_spelling_of_another() -> None:
    """`mesh` is a pattern and, of gears, `meshes`; `sine` of two lines is for the library, else a wave."""
    known = library.load()
    assert known.aliases.keys() & (known.callables.keys() | builtins.SIGNATURES.keys()) == {"mesh", "sine"}
