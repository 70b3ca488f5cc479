"""Codes and their pages match, and the programs on each page show what it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.checking.subset import Variant
from aidl_lang.common import resources
from aidl_lang.common.render import render
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from tests.documents import ROOT, beside, blocks, programs

PAGES = ROOT / "docs" / "diagnostics"
CODES = [path.stem for path in sorted(PAGES.glob("*.md"))]
MISTAKE, MENDED = "The mistake", "Mended"


def codes_in_source() -> set[str]:
    """Codes written as string literals anywhere in the packages."""
    folders = (ROOT / "aidl_lang", ROOT / "eval" / "aidl_eval", ROOT / "server" / "aidl_server")
    texts = (path.read_text(encoding="utf-8") for folder in folders for path in folder.rglob("*.py"))
    return {code for text in texts for code in re.findall(r"""["']([EWN]\d{4})["']""", text)}


def test_every_code_has_a_page() -> None:
    assert sorted(codes_in_source() - set(CODES)) == []


def test_every_page_has_a_code() -> None:
    assert sorted(set(CODES) - codes_in_source()) == []


def test_every_code_is_told_by_a_test() -> None:
    """Most stand in a document of `tests/spec`, with their text."""
    folders = (ROOT / name for name in ("tests", "server/tests", "eval/tests", "web/tests"))
    files = [path for folder in folders for path in folder.rglob("*") if path.suffix in (".py", ".md")]
    told = "".join(path.read_text("utf-8") for path in files)
    assert [code for code in CODES if code not in told] == []


def test_pages_have_their_parts() -> None:
    for code in CODES:
        page = PAGES / f"{code}.md"
        assert re.match(rf"# {code}: \S.*\n", page.read_text(encoding="utf-8")), code
        assert resources.title(code)
        assert {block.heading for block in blocks(page)} >= {MISTAKE, MENDED}, code


@pytest.mark.parametrize("code", [code for code in CODES if programs(PAGES / f"{code}.md")])
def test_page_shows_the_mistake_and_mends_it(code: str) -> None:
    page = PAGES / f"{code}.md"
    mistake, mended = (_compile(page, heading) for heading in (MISTAKE, MENDED))
    assert code in mistake, f"the mistake gives {mistake}"
    assert code not in mended
    assert not any(c.startswith("E") for c in mended), f"the mended program gives {mended}"


def test_only_pages_about_use_do_without_programs() -> None:
    without = [code for code in CODES if not programs(PAGES / f"{code}.md")]
    said_by_verbs = "E08 E09 E0602 E0603 E0606 W0607 W072 N0731 W0733 W0736 N0741 N0742 N0754 N0755 N0756 "
    said_by_verbs += "W0757 N0757 W0758 N0759"
    assert [code for code in without if not code.startswith(tuple(said_by_verbs.split()))] == []


def _compile(page: Path, heading: str) -> list[str]:
    """The codes that the program under a heading gives, with the files that stand beside it."""
    found = [block for block in programs(page) if block.heading == heading]
    main = next(block for block in found if not block.file)
    settings = pipeline.Settings(variant=Variant(main.variant))
    compiled = pipeline.compile(
        SourceFile(main.place, main.text), MemoryWorld(beside(found)), settings=settings
    )
    print("\n".join(map(render, compiled.diagnostics)))
    return [d.code for d in compiled.diagnostics]
