"""Every program in the documentation compiles."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.checking import library
from aidl_lang.common.diagnostics import Severity
from aidl_lang.common.render import render
from aidl_lang.common.resources import derived
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from aidl_lang.export.job import Options
from aidl_lang.parser import DEFAULT_LIMITS, parse
from aidl_lang.syntax import tables
from tests.compiled import EXAMPLES, example
from tests.documents import ROOT, Block, beside, programs

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "eval").glob("*.md"))]
# Pages on diagnostics and those made from the library have tests of their own.
BLOCKS = [
    b
    for page in PAGES
    if page.parent.name not in ("diagnostics", "guides", "reference")
    for b in programs(page)
]


@pytest.mark.parametrize("block", [pytest.param(b, id=b.place) for b in BLOCKS if b.note in ("", "error")])
def test_program_in_documentation(block: Block) -> None:
    compiled = pipeline.compile(
        SourceFile(block.place, block.text), MemoryWorld(beside(programs(block.path)))
    )
    errors = "\n".join(render(d) for d in compiled.diagnostics if d.is_error)
    if block.note == "error":
        assert not compiled.ok, f"{block.place} is said to show a mistake, but compiles"
    else:
        assert compiled.ok, f"{block.place}: {compiled.status}\n{errors}"
        assert [render(d) for d in compiled.diagnostics if d.severity is Severity.WARNING] == []


@pytest.mark.parametrize("block", [pytest.param(b, id=b.place) for b in BLOCKS if b.note == "fragment"])
def test_fragment_in_documentation_is_read(block: Block) -> None:
    errors = [d for d in parse(SourceFile(block.place, block.text)).diagnostics if d.is_error]
    assert not errors, "\n".join(map(render, errors))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_example(path: Path) -> None:
    """What comes of it is what is kept of it, which `tests/golden` sees to."""
    kept = json.loads((ROOT / "tests" / "golden" / "expected" / path.stem / "solved.json").read_text("utf-8"))
    assert kept["status"] == "solved"
    assert [d["message"] for d in kept["diagnostics"] if d["severity"] != "note"] == []


@pytest.mark.parametrize(
    ("name", "options"), [("telephone", Options()), ("motor_bracket", Options(dimension=True))]
)
def test_the_pictures_of_the_readme_are_the_examples(name: str, options: Options) -> None:
    committed = ROOT / "docs" / "images" / f"{name}.svg"
    assert example(name).export(".svg", options) == committed.read_bytes(), "run `make accept`"


def test_sizes_on_the_page_of_measurements_are_those_of_today() -> None:
    """To a tenth: who adds much writes the page anew."""
    page = (ROOT / "docs" / "performance.md").read_text("utf-8")
    said = re.search(
        r"built: (\d+) definitions of (\d+) names, (\d+) kB of text.* into (\d+) kB of data", page
    )
    tables_said = re.search(r"The parser's tables, (\d+) kB", page)
    assert said
    assert tables_said
    known = library.load()
    sizes = [
        sum(len(overloads) for overloads in known.callables.values()),
        len(known.callables),
        sum(len(source.text.encode()) for source in known.sources) / 1000,
        *(len(derived(kept.DERIVED, kept._inputs, kept.built)) / 1000 for kept in (library, tables)),
    ]
    assert [*map(int, said.groups()), int(tables_said[1])] == pytest.approx(sizes, rel=0.1)


def test_the_limits_on_the_page_of_grammars_are_those_of_the_parser() -> None:
    page = (ROOT / "docs" / "grammars.md").read_text("utf-8")
    said = re.search(r"(\d+) levels of nesting \(a structure in a structure is (\w+)\), (\w+) million", page)
    assert said
    assert int(said[1]) == DEFAULT_LIMITS.max_nesting
    assert (said[3], DEFAULT_LIMITS.max_characters) == ("two", 2_000_000)
    assert said[2] == "two"

    def codes(structures: int) -> list[str]:
        text = "assembly a { " * structures + "}" * structures
        return [d.code for d in parse(SourceFile("deep.aidl", text)).diagnostics if d.is_error]

    most = DEFAULT_LIMITS.max_nesting // 2
    assert not codes(most - 1)
    assert codes(most + 2)


def test_the_page_on_the_solver_names_all_its_files() -> None:
    page = (ROOT / "docs" / "solver.md").read_text("utf-8")
    files = {path.name for path in (ROOT / "aidl_lang" / "solver").glob("*.py")} - {"__init__.py"}
    assert set(re.findall(r"`(\w+\.py)`", page)) == files


def test_blocks_have_known_notes() -> None:
    known = ("", "error", "fragment")
    assert [b.place for b in BLOCKS if b.note not in known and not b.file] == []
