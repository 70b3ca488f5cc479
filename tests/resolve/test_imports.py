"""Imports over a world in memory."""

from __future__ import annotations

import pytest

from aidl_lang import parser
from aidl_lang.checking import library
from aidl_lang.checking.resolve import resolve
from aidl_lang.common.source import SourceFile
from tests.typecheck.checking import checked, messages, resolved

BOLTS = """
param clearance = 0.2
alias bore = drilled
hole drilled(size = 4) { rim = circle(radius: size / 2 + clearance) }
fn pitch(n) = 10 * n
"""
PLATE = "solid s {{ r = rectangle(width: 60, height: 20)\n {0} }}"


def test_all_definitions_of_a_file() -> None:
    text = 'import "bolts.aidl"\n' + PLATE.format("a = bore(size: 3) at (pitch(1) + clearance, 0)")
    assert messages(text, {"bolts.aidl": BOLTS}) == []


def test_a_namespace() -> None:
    text = 'import "bolts.aidl" as b\n' + PLATE.format("a = b.drilled(size: b.clearance)")
    assert messages(text, {"bolts.aidl": BOLTS}) == []
    assert messages(text.replace("b.clearance", "b.clearanse"), {"bolts.aidl": BOLTS}) == [
        "E0202 3: `b` has no `clearanse`; did you mean `clearance`?"
    ]
    assert messages(text.replace("b.drilled", "drilled"), {"bolts.aidl": BOLTS}) == [
        "E0203 3: there is no function, shape or constraint `drilled`"
    ]


def test_some_names() -> None:
    text = 'import drilled, pich from "bolts.aidl"\n' + PLATE.format("a = drilled()")
    assert messages(text, {"bolts.aidl": BOLTS}) == [
        "E0213 1: `bolts.aidl` has no `pich`; did you mean `pitch`?"
    ]


def test_own_definitions_hide_imported_ones() -> None:
    text = 'import "bolts.aidl"\nparam clearance = 5\n' + PLATE.format("c = circle(radius: clearance)")
    resolution = resolved(text, {"bolts.aidl": BOLTS})
    uses = [s for n, s in resolution.uses.items() if n.span.text == "clearance"]
    declared = [s.declarations[0].span.source.name for s in uses if s.name == "clearance"]
    assert declared == ["bolts.aidl", "bolts.aidl", "main.aidl", "main.aidl"]


def test_paths_are_relative_to_the_importer_and_stay_inside() -> None:
    files = {
        "parts/a.aidl": 'import "more/b.aidl"\nfn a(n) = b(n)',
        "parts/more/b.aidl": 'import "../../c.aidl"\nfn b(n) = c * n',
        "c.aidl": "let c = 3",
    }
    assert messages('import "parts/a.aidl"\n' + PLATE.format("c = circle(radius: a(2))"), files) == []
    for path in ("../c.aidl", "/etc/passwd", "parts/../../c.aidl", "C:/c.aidl"):
        assert messages(f'import "{path}"', files) == [f"E0212 1: `{path}` lies outside the project"]


def test_circles_are_told_with_their_chain() -> None:
    files = {"a.aidl": 'import "b.aidl"', "b.aidl": '\nimport "a.aidl"'}
    (found,) = checked('import "a.aidl"', files)[1]
    assert found.message == "files import each other in a circle: a.aidl → b.aidl → a.aidl"
    assert found.span is not None
    assert (found.span.source.name, found.span.line) == ("b.aidl", 2)
    assert messages('import "main.aidl"') == [
        "E0211 1: files import each other in a circle: main.aidl → main.aidl"
    ]


def test_errors_are_shown_in_the_file_they_are_in() -> None:
    (found,) = checked('import "a.aidl"', {"a.aidl": "\nfn f(n) = n + m"})[1]
    assert found.span is not None
    assert (found.code, found.span.source.name, found.span.line) == ("E0201", "a.aidl", 2)


def test_missing_files_and_no_world() -> None:
    assert messages('import "a.aidl"') == ["E0210 1: `a.aidl` cannot be imported: there is no such file"]
    module = parser.parse(SourceFile("<stdin>", 'import "a.aidl"')).module
    assert [d.code for d in resolve(module, None, library.load()).diagnostics] == ["E0210"]


@pytest.mark.parametrize(
    "name",
    [
        ".env",
        "a",
        "notes.txt",
        "a.AIDL",
        "a.aidl.txt",
        ".aidl",
        "a.aidl/.env",
        "a.aidl\x00.env",
        "a.aidl ",
        "b\\.env",
    ],
)
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
    found = messages("\n".join(f'import "{name}"' for name in many), many)
    assert found
    assert {m[:5] for m in found} == {"E0804"}
    deep = {f"f{i}.aidl": f'import "f{i + 1}.aidl"' for i in range(300)}
    assert [m[:5] for m in messages('import "f0.aidl"', deep)] == ["E0804"]
    huge = {"a.aidl": " " * 2_000_001}
    assert [m[:5] for m in messages('import "a.aidl"', huge)] == ["E0804"]


def test_a_file_imported_twice_is_one_file() -> None:
    files = {"a.aidl": 'import "c.aidl"', "b.aidl": 'import "c.aidl"', "c.aidl": "solid t(n = 1) {}"}
    text = 'import "a.aidl"\nimport "b.aidl"\nimport "c.aidl"\nassembly m { x = t() }'
    resolution = resolved(text, files)
    assert resolution.diagnostics == []
    assert len(resolution.modules) == 4
