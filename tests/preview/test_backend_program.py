"""A program in its file: read, edited, exported; files that change, break and vanish."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.preview.program import Program

TEXT = "param width = 60mm in 20..100\nsolid a { body = rectangle(width: width, height: 20) }\n"


def write(path: Path, data: bytes) -> None:
    path.write_bytes(data)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "part.aidl"
    path.write_text(TEXT, "utf-8")
    return path


@pytest.fixture
def program(file: Path) -> Program:
    made = Program(file, write)
    assert made.refresh()
    return made


def test_a_text_is_run_once(program: Program, file: Path) -> None:
    assert not program.refresh()
    assert program.version == 1
    file.write_text(TEXT.replace("60mm", "70mm"), "utf-8")
    assert program.refresh()
    assert program.version == 2
    assert program.picture(program.current, ()).box == pytest.approx((-35, -10, 35, 10))


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_an_edit_changes_nothing_else(file: Path, mark: bytes, end: str) -> None:
    text = "// 😀 é\n" + TEXT
    file.write_bytes(mark + text.replace("\n", end).encode())
    program = Program(file, write)
    program.refresh()
    program.set_knob("width", 72.5)
    assert file.read_bytes() == mark + text.replace("60mm", "72.5mm").replace("\n", end).encode()
    assert program.refresh()
    assert pipeline.knobs(SourceFile("p", program.current.source.text))[0][0].value == 72.5


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_an_imported_file_is_edited(tmp_path: Path, end: str) -> None:
    other, main = tmp_path / "other.aidl", tmp_path / "part.aidl"
    text = "// 😀\nsolid bolt(n = 1) {\n param d = 6mm in 4..9\n rim = circle(diameter: n * d) }\n"
    other.write_bytes(text.replace("\n", end).encode())
    main.write_text('import bolt from "other.aidl"\nassembly a { b = bolt() }\n')
    program = Program(main, write)
    program.refresh()
    (knob,) = program.picture(program.current, ()).knobs
    before = other.read_bytes()
    program.set_knob(knob.path, 7)
    assert other.read_bytes() == before.replace(b"6mm", b"7mm")
    assert program.refresh()


def test_what_was_changed_meanwhile_is_not_overwritten(program: Program, file: Path) -> None:
    file.write_text("// new\n" + TEXT, "utf-8")
    with pytest.raises(CannotError, match="changed meanwhile"):
        program.set_knob("width", 30)
    assert file.read_text("utf-8") == "// new\n" + TEXT
    assert program.refresh()
    program.set_knob("width", 30)
    assert "30mm" in file.read_text("utf-8")


def test_the_library_is_not_edited(program: Program) -> None:
    library = program.current.program.library.sources[0]
    with pytest.raises(CannotError):
        program.edit([Edit(Span(library, 0, 1), "x")])


def test_a_file_that_cannot_be_written_says_so(file: Path) -> None:
    def refuse(path: Path, data: bytes) -> None:
        raise OSError(28, "No space left on device")

    program = Program(file, refuse)
    program.refresh()
    with pytest.raises(CannotError, match="no space left"):
        program.set_knob("width", 30)


@pytest.mark.parametrize("content", [b"\xff\xfe\x00", b"\xc3"])
def test_what_is_no_text_leaves_the_picture(program: Program, file: Path, content: bytes) -> None:
    before = program.current
    file.write_bytes(content)
    with pytest.raises(CannotError, match="UTF-8"):
        program.refresh()
    assert program.current is before
    file.unlink()
    with pytest.raises(CannotError, match="cannot be read"):
        program.refresh()
    file.write_text(TEXT, "utf-8")
    assert not program.refresh()


def test_a_broken_text_keeps_the_picture_as_stale(program: Program, file: Path) -> None:
    good = program.picture(program.current, ())
    file.write_text(TEXT.replace("height: 20", "height: "), "utf-8")
    assert program.refresh()
    stale = program.picture(program.current, ())
    assert (stale.stale, stale.svg) == (True, good.svg)
    message = json.loads(program.message(program.current, stale))
    assert message["source"]["text"] == file.read_text("utf-8")
    assert message["version"] == 2
    with pytest.raises(CannotError, match="does not draw"):
        program.export("svg", ())


def test_trying_writes_nothing(program: Program, file: Path) -> None:
    view = program.with_knob("width", 90)
    assert program.picture(view, (), is_tried=True).box[2] == pytest.approx(45)
    assert program.picture(program.current, ()).box[2] == pytest.approx(30)
    assert file.read_text("utf-8") == TEXT


def test_dragging_shows_and_writes_the_same(tmp_path: Path) -> None:
    file = tmp_path / "part.aidl"
    text = "drawing a {\n    one = line((0, 0), (30, 5))\n    two = line((30, 5), (60, 0))\n}\n"
    file.write_text(text, "utf-8")
    program = Program(file, write)
    program.refresh()
    made = program.completed(program.picture(program.current, ()))
    handle = next(h for h in made.handles if h.at == pytest.approx((60, 0)))
    shown = program.picture(program.dragged(handle.id, (70, 12)), (), is_tried=True)
    assert shown.tried
    assert {h.id for h in shown.handles} == {h.id for h in made.handles}
    assert next(h.at for h in shown.handles if h.id == handle.id) == pytest.approx((70, 12), abs=1e-3)
    assert file.read_text("utf-8") == text
    program.drop(handle.id, (70, 12))
    assert re.sub(r"\d+", "N", file.read_text("utf-8")) == re.sub(r"\d+", "N", text)
    assert "(70, 12)" in file.read_text("utf-8")
    program.refresh()
    after = program.completed(program.picture(program.current, ()))
    assert next(h.at for h in after.handles if h.id == handle.id) == pytest.approx((70, 12), abs=1e-6)


@pytest.mark.parametrize("to", [(1e300, 0.0), (float("nan"), 0.0), (float("inf"), 1.0)])
@pytest.mark.parametrize("handle", ["", "a.body", "no such", "a.body.top_right"])
def test_dragging_nowhere_is_refused(program: Program, handle: str, to: tuple[float, float]) -> None:
    with pytest.raises(CannotError, match=r"\w"):
        program.dragged(handle, to)


@pytest.mark.parametrize(
    ("name", "start"), [("svg", b"<?xml"), ("png", b"\x89PNG"), ("dxf", b"  0"), ("pdf", b"%PDF")]
)
def test_exports_are_the_files_of_the_command(program: Program, name: str, start: bytes) -> None:
    message = program.export(name, ("names", "dimensions"))
    assert message["name"] == f"part.{name}"
    assert base64.b64decode(message["data"]).startswith(start)


def test_what_cannot_be_exported_says_why(program: Program) -> None:
    with pytest.raises(CannotError, match="thick"):
        program.export("stl", ())
    with pytest.raises(CannotError, match="format"):
        program.export("../../etc/passwd", ())


def test_tokens_cover_the_text(program: Program) -> None:
    source = json.loads(program.message(program.current, program.picture(program.current, ())))["source"]
    lines = source["text"].split("\n")
    words = {(lines[line][at : at + length], kind) for line, at, length, kind in source["tokens"]}
    assert {("param", "keyword"), ("60mm", "number"), ("solid", "keyword"), ("rectangle", "type")} <= words
