"""Imports over a world in memory."""

from __future__ import annotations

import pytest

from aidl_lang import parser
from aidl_lang.checking import library
from aidl_lang.checking.resolve import resolve
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from aidl_lang.pipeline import check


def errors(text: str, files: dict[str, str]) -> list[Diagnostic]:
    return [d for d in check(SourceFile("main.aidl", text), MemoryWorld(files)) if d.is_error]


def test_own_definitions_hide_imported_ones() -> None:
    text = 'import "bolts.aidl"\nparam clearance = 5\n' + "solid s { c = circle(radius: clearance) }"
    bolts = MemoryWorld({"bolts.aidl": "param clearance = 0.2\nfn wide(n) = n + clearance\n"})
    resolution = resolve(parser.parse(SourceFile("main.aidl", text)).module, bolts, library.load())
    uses = [s for n, s in resolution.uses.items() if n.span.text == "clearance"]
    declared = [s.declarations[0].span.source.name for s in uses if s.name == "clearance"]
    assert declared == ["bolts.aidl", "bolts.aidl", "main.aidl", "main.aidl"]


def test_errors_are_shown_in_the_file_they_are_in() -> None:
    (found,) = errors('import "a.aidl"', {"a.aidl": "\nfn f(n) = n + m"})
    assert found.span is not None
    assert (found.code, found.span.source.name, found.span.line) == ("E0201", "a.aidl", 2)


OTHERS = [".env", "a", "a.AIDL", "a.aidl.txt", ".aidl", "a.aidl/.env", "a.aidl\x00.env", "a.aidl ", "b\\.env"]


@pytest.mark.parametrize("name", OTHERS)
def test_nothing_but_programs_is_read(name: str) -> None:
    class Untouched:
        def read(self, path: str) -> str:
            raise AssertionError(path)

    source = SourceFile("main.aidl", f'import "{name}"\nsolid s {{ c = circle(radius: 1) }}')
    (found,) = resolve(parser.parse(source).module, Untouched(), library.load()).diagnostics
    assert found.code == "E0210"
    assert found.message.endswith(" cannot be imported: its name does not end in `.aidl`")


def test_limits() -> None:
    many = {f"f{i}.aidl": f"let v{i} = {i}" for i in range(300)}
    assert {d.code for d in errors("\n".join(f'import "{name}"' for name in many), many)} == {"E0804"}
    deep = {f"f{i}.aidl": f'import "f{i + 1}.aidl"' for i in range(300)}
    assert [d.code for d in errors('import "f0.aidl"', deep)] == ["E0804"]
    huge = {"a.aidl": " " * 2_000_001}
    assert [d.code for d in errors('import "a.aidl"', huge)] == ["E0804"]
