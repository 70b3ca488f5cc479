"""What a language model is told holds nothing of the files beside its program."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.render import compact
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import FileError, MemoryWorld, ReadFailure
from aidl_lang.tools.agents.calling import answer
from aidl_lang.tools.agents.tools import Tools
from aidl_lang.tools.agents.workspace import Workspace
from aidl_lang.tools.cli import main
from aidl_lang.tools.discretion import Programs, Reader
from tests.llm.scripted import Scripted

SECRET = "hunter2correcthorse"
BODY = "solid plate {\n    outline = rectangle(width: 60, height: 40)\n}\n"
PLAIN = f"PASSWORD = {SECRET}\n[section]\ntoken: {SECRET}\n"
"""No AIDL, as files of settings are."""
LOOKS_LIKE = f"PASSWORD = {SECRET}\n"
"""AIDL as far as the grammar goes."""


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with files that are nobody's business, in and beside it."""
    root = tmp_path / "project"
    (root / "parts").mkdir(parents=True)
    for name in (".env", "secret.txt", "secret.AIDL", "secret.aidl", "parts/.aidl", "../outside.aidl"):
        (root / name).write_text(PLAIN)
    (root / "settings.aidl").write_text(LOOKS_LIKE)
    (root / "passes.aidl").write_text('import "secret.aidl"\nlet size = 3\n')
    (root / "link.aidl").symlink_to(root / ".env")
    (root / "away.aidl").symlink_to(tmp_path / "outside.aidl")
    (root / "folder").symlink_to(tmp_path)
    (root / "plate.aidl").write_text(BODY)
    (root / "bolts.aidl").write_text("hole bolt(size = 4) { rim = circle(radius: size / 2) }\n")
    monkeypatch.chdir(root)
    return root


PEEKING = [
    *(".env", "secret.txt", "secret.AIDL", "secret.aidl", "settings.aidl", "passes.aidl", "link.aidl"),
    *("away.aidl", "folder/outside.aidl", "parts/.aidl", "parts/../secret.aidl", "./link.aidl"),
    *("../outside.aidl", "{root}/secret.aidl", "/etc/passwd", "/proc/self/environ", "..\\outside.aidl"),
    *("secret.aidl\0", "PLATE.aidl", "plate.aidl/../.env"),
]


def _imports(name: str, root: Path) -> str:
    path = name.replace("{root}", str(root)).replace("\\", "\\\\")
    return f'import "{path}"\nimport PASSWORD, token from "{path}"\n{BODY}'


@pytest.mark.parametrize("name", PEEKING)
def test_a_conversation_holds_nothing_of_other_files(
    project: Path,
    monkeypatch: pytest.MonkeyPatch,
    scripted: Callable[..., Scripted],
    capfd: pytest.CaptureFixture[str],
    name: str,
) -> None:
    server = scripted([f"```aidl\n{_imports(name, project)}```"] * 2)
    for variable, value in server.environment.items():
        monkeypatch.setenv(variable, value)
    code = main(
        ["generate", "a hole", "--edit", "plate.aidl", "--attempts", "2", "--transcript", "said.json"]
    )
    assert code == 1
    said = (project / "said.json").read_text()
    assert SECRET not in said + str([request.texts for request in server.requests])
    assert "root:" not in said
    told = json.loads(said)["messages"][-2]["text"]
    assert "error E02" in told
    assert SECRET not in "".join(capfd.readouterr())


@pytest.mark.parametrize("name", PEEKING)
def test_a_tool_tells_nothing_of_other_files(project: Path, name: str) -> None:
    others = ("compile", "measure", "explain_conflict") if name == "secret.aidl" else ()
    for tool in ("check", *others):
        made = answer(Tools(Workspace(project)), tool, {"program": _imports(name, project)})
        assert SECRET not in made.text + json.dumps(made.data)
        assert "root:" not in made.text
        assert "E02" in made.text


# --- What is told of a mistake ---------------------------------------------------------------------


def _told(program: str, files: dict[str, str]) -> str:
    source = SourceFile("part.aidl", program)
    compiled = pipeline.compile(source, Programs(MemoryWorld(files)))
    return compact(Reader.of(source).compiled(compiled).diagnostics)


def test_a_file_with_slips_is_refused_as_a_whole() -> None:
    with pytest.raises(FileError) as caught:
        Programs(MemoryWorld({"a.aidl": PLAIN})).read("a.aidl")
    assert caught.value.reason is ReadFailure.NOT_A_PROGRAM
    assert _told(f'import "a.aidl"\n{BODY}', {"a.aidl": PLAIN}) == (
        "error E0210 line 1: `a.aidl` cannot be imported: it is no program without mistakes\n"
        '  1 | import "a.aidl"\n'
        "  hint: `aidl check a.aidl` tells what is wrong in it"
    )


def test_a_conflict_with_an_import_quotes_only_what_the_reader_wrote() -> None:
    files = {
        "a.aidl": "solid peg(n = 1) {\n    rim = circle(radius: guess(n))\n"
        "    constrain rim.radius == n * 2 + 1\n}\n"
    }
    program = 'import "a.aidl"\nassembly m {\n    x = peg(n: fixed(3))\n    constrain x.rim.radius == 4\n}\n'
    source = SourceFile("part.aidl", program)
    compiled = pipeline.compile(source, Programs(MemoryWorld(files)))
    seen = Reader.of(source).compiled(compiled)
    assert "n * 2 + 1" in compact(compiled.diagnostics)
    told = compact(seen.diagnostics).splitlines()
    assert told[0] == "error E0601 line 4: `…` and `x.rim.radius == 4` cannot hold together"
    assert "  hint: `a.aidl`, line 3, takes part in this" in told
    texts = [party.text for conflict in seen.conflicts() for party in conflict.parties]
    assert sorted(texts) == ["x.rim.radius == 4", "… (in `a.aidl`, line 3)"]
    assert seen.model is not None
    assert "n * 2 + 1" not in str([c.text for c in seen.model.constraints])


def test_what_is_wrong_elsewhere_is_told_where_the_reader_has_a_part_in_it() -> None:
    own, other = SourceFile("part.aidl", "a == 4\n"), SourceFile("a.aidl", "let b = 3\nb == c\n")
    here, there = Span(own, 0, 6), Span(other, 10, 16)
    found = Diagnostic(
        "E0601",
        "`b == c` and `a == 4` cannot hold together",
        there,
        "`3` would fit",
        (Label(here, "conflicts with `b == c`"),),
        ("write `c`", "give one up"),
        Fix("write `3`", (Edit(there, "3"),)),
    )
    assert Reader.of(own).diagnostics([found]) == [
        Diagnostic(
            "E0601",
            "`…` and `a == 4` cannot hold together (in `a.aidl`, line 2)",
            here,
            "conflicts with `…`",
            hints=("give one up",),
        )
    ]
