"""The standard library, parsed once."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang import parser
from aidl_lang.checking import library
from aidl_lang.checking.builtins import CUTS
from aidl_lang.checking.resolve import resolve
from aidl_lang.common import resources
from aidl_lang.common.source import SourceFile
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import load_tables
from aidl_lang.typecheck import check

SMALL = """
let half = 0.5
alias box = rectangle
shape rectangle(width: length, height: length) { edge = line((0, 0), (width, height * half)) }
shape rectangle(size: length) { inner = rectangle(width: size, height: size) }
constraint above(a: box, b: box, gap = 0) { a.bottom == b.top + gap }
solid washer(outer = 3) { rim = circle(radius: outer) }
"""


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A checkout in which nothing was made yet, with a small library."""
    load_tables()  # of the grammar, which is not in that checkout
    stdlib = tmp_path / "stdlib"
    stdlib.mkdir()
    (stdlib / "small.aidl").write_text(SMALL)
    real = resources.resource
    monkeypatch.setattr(resources, "resource", lambda name: stdlib if name == "stdlib" else real(name))
    monkeypatch.setattr(resources, "_CHECKOUT", tmp_path)
    return tmp_path


def fresh() -> library.Library:
    return library.load.__wrapped__()


def kept(checkout: Path) -> list[Path]:
    return sorted((checkout / "build" / "derived").glob("library-*"))


def test_the_library_itself_checks_clean() -> None:
    """As one program, since its files use each other."""
    text = "\n".join(source.text for source in library.load().sources)
    parsed = parser.parse(SourceFile("stdlib", text))
    program = check(resolve(parsed.module, None, library.from_modules([])))
    found = [*parsed.diagnostics, *program.diagnostics, *(v.diagnostic({}) for v in program.violations)]
    assert [(d.message, d.span and d.span.source.line(d.span.line)) for d in found] == []


def test_what_was_kept_is_what_was_parsed(checkout: Path) -> None:
    parsed, opened = library.from_modules(library._parse(library._sources())[0]), fresh()
    assert len(kept(checkout)) == 1
    assert list(parsed.callables) == list(opened.callables)
    assert (dict(parsed.aliases), list(parsed.constants)) == (dict(opened.aliases), list(opened.constants))
    for name, overloads in parsed.callables.items():
        for a, b in zip(overloads, opened.callables[name], strict=True):
            assert (a.name, a.parameters, a.kind) == (b.name, b.parameters, b.kind)
            assert a.node is not None
            assert b.node is not None
            assert ast.same(a.node, b.node)
            assert _places(a.node) == _places(b.node)
    for name, constant in parsed.constants.items():
        assert ast.same(opened.constants[name], constant)
    assert ast.same(parsed.modules[0], opened.modules[0])


def _places(node: ast.Node) -> list[tuple[str, int, int]]:
    return [(n.span.source.name, n.span.start, n.span.end) for n in ast.walk(node)]


def test_only_trees_become_data() -> None:
    with pytest.raises(TypeError, match="SourceFile is no part of a syntax tree"):
        ast.encoded((SourceFile("", ""),))


def test_what_is_wrong_in_the_library_is_told_and_not_kept(checkout: Path) -> None:
    (checkout / "stdlib" / "small.aidl").write_text(SMALL + "shape half_done(")
    for _ in range(2):
        opened = fresh()
        assert {d.span and d.span.source.name for d in opened.diagnostics} == {"stdlib/small.aidl"}
        assert "rectangle" in opened.callables
    assert kept(checkout) == []
    with pytest.raises(library.MistakenLibraryError):
        library.built()


def test_ready_made_cuts_are_those_with_an_outline_and_a_template() -> None:
    standard = library.load()
    kinds = {name: {s.kind for s in found} for name, found in standard.callables.items()}
    both = {name for name, sorts in kinds.items() if ast.Structure in sorts and len(sorts) > 1}
    assert both | {name for name, target in standard.aliases.items() if target in both} == CUTS
