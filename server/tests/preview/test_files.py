"""A program in its file: edited, exported; files that change, break and vanish."""

from __future__ import annotations

import asyncio
import base64
import io
import os
import re
import zipfile
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import ezdxf
import ezdxf.bbox
import pytest

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import Reads
from aidl_lang.export import FORMATS, OFFERED
from aidl_server.ide.references import CannotError
from aidl_server.preview import files
from aidl_server.preview.host import Host
from server.tests.preview.talking import CHANGED, TEXT, serving, talking


@pytest.mark.parametrize(("mark", "end"), [(b"", "\n"), (b"\xef\xbb\xbf", "\r\n")])
def test_an_imported_file_is_edited(file: Path, mark: bytes, end: str) -> None:
    other = file.with_name("other.aidl")
    text = "// 😀\nsolid bolt(n = 1) {\n param d = 6mm in 4..9\n rim = circle(diameter: n * d) }\n"
    other.write_bytes(mark + text.replace("\n", end).encode())
    file.write_text('import bolt from "other.aidl"\nassembly a { b = bolt() }\n')
    with serving(file) as client, talking(client, file) as page:
        (knob,) = page.preview()["knobs"]
        before = other.read_bytes()
        assert page.answer("aidl/setKnob", path=knob["path"], value=7) == {"applied": True}
        assert other.read_bytes() == before.replace(b"6mm", b"7mm")
        while page.told(CHANGED)["box"][2] != pytest.approx(3.5):
            pass


def test_what_was_changed_meanwhile_is_not_overwritten(file: Path) -> None:
    known = SourceFile(file.name, TEXT)
    edit = Edit(Span(known, 0, 5), "PARAM")
    before, after = files.rewritten(file, known, [edit])
    assert (before, after[:11]) == (TEXT.encode(), b"PARAM width")
    file.write_text("// new\n" + TEXT, "utf-8")
    with pytest.raises(CannotError, match="changed meanwhile"):
        files.rewritten(file, known, [edit])
    assert file.read_text("utf-8") == "// new\n" + TEXT


def test_nothing_but_the_program_is_edited(file: Path) -> None:
    def refuse(path: Path, data: bytes) -> None:
        raise AssertionError(path)

    async def edited() -> list[str]:
        host = Host(file, refuse)
        await host.start()
        document = host.server.documents.get(host.uri)
        assert document is not None
        await document.until_solved(document.serial, 60)
        known = document.ran
        assert known is not None
        now = host.server.asked_now(document, known)
        stale = host.server.asked_now(document, replace(known, version=7))
        tried = (
            (now, known.view.program.library.sources[0]),
            (now, SourceFile("/etc/passwd", "")),
            (stale, known.view.source),
        )
        made = [await host._apply(each, [Edit(Span(at, 0, 0), "x")], "Change") for each, at in tried]
        host.close()
        return made

    foreign = "this cannot be changed from here"
    assert asyncio.run(edited()) == [foreign, foreign, "the text has changed meanwhile"]


def test_a_file_that_cannot_be_written_says_so(file: Path) -> None:
    def refuse(path: Path, data: bytes) -> None:
        raise OSError(28, "No space left on device")

    with serving(file, refuse) as client, talking(client, file) as page:
        page.preview()
        done = page.answer("aidl/setKnob", path="width", value=30)
    assert done == {"applied": False, "reason": "part.aidl was not written: no space left on device"}


def test_a_broken_text_keeps_the_picture_as_stale(file: Path) -> None:
    with serving(file) as client, talking(client, file) as page:
        good = page.preview()
        broken = TEXT.replace("height: 20", "height: ")
        file.write_text(broken, "utf-8")
        while not (stale := page.told(CHANGED))["stale"]:
            pass
        assert (stale["stale"], stale["svg"]) == (True, good["svg"])
        assert stale["version"] > good["version"]
        assert "does not draw" in page.answer("aidl/export", format="svg")["error"]["message"]


def test_dragging_shows_and_writes_the_same(file: Path) -> None:
    text = "drawing a {\n    one = line((0, 0), (30, 5))\n    two = line((30, 5), (60, 0))\n}\n"
    file.write_text(text, "utf-8")
    with serving(file) as client, talking(client, file) as page:
        made = page.preview()
        while not made["handles"]:
            made = page.told(CHANGED)
        handle = next(h["id"] for h in made["handles"] if h["at"] == pytest.approx([60, 0]))
        shown = page.answer("aidl/try", drag={"id": handle, "to": [70, 12]})
        assert shown["tried"]
        assert {h["id"] for h in shown["handles"]} == {h["id"] for h in made["handles"]}
        assert next(h["at"] for h in shown["handles"] if h["id"] == handle) == pytest.approx(
            [70, 12], abs=1e-3
        )
        assert file.read_text("utf-8") == text
        assert page.answer("aidl/drag", id=handle, to=[70, 12]) == {"applied": True}
        assert re.sub(r"\d+", "N", file.read_text("utf-8")) == re.sub(r"\d+", "N", text)
        assert "(70, 12)" in file.read_text("utf-8")
        while not (after := page.told(CHANGED, version=2))["handles"]:
            pass
        assert next(h["at"] for h in after["handles"] if h["id"] == handle) == pytest.approx(
            [70, 12], abs=1e-6
        )


def test_a_walk_of_the_params_holds_up_nothing_and_ends_when_the_text_changes(file: Path) -> None:
    text = """solid plate {
    param way = 0 in 0..40
    body = rectangle(width: 60, height: 50)
    hole bore { rim = circle(center: (way, 0), radius: 5) }
}
"""
    file.write_text(text, "utf-8")
    with serving(file) as client, talking(client, file) as page:
        page.preview()
        found = page.answer("aidl/ranges")
        (walk,) = found["walked"]
        assert (walk["param"], walk["turns"][0]["value"]) == ("way", pytest.approx(25, abs=0.05))
        assert "`plate.bore.rim` breaks through its edge" in walk["turns"][0]["message"]
        assert found["summary"].startswith("1 param walked from end to end, ")
        number = page.ask("aidl/ranges")
        again = page.ask("aidl/ranges")
        assert "asks for more than can be done at once" in page.answered(again)["error"]["message"]
        assert page.answer("aidl/try", knobs={"way": 3})["tried"]
        assert page.answer("aidl/setKnob", path="way", value=4) == {"applied": True}
        assert page.answered(number)["error"]["message"] == "the text has changed"


def test_the_dialog_for_exports_comes_from_one_table(file: Path) -> None:
    file.write_text(
        "assembly two { @thickness(3mm) solid a { r = square(size: 50) }\n"
        "@detached @thickness(5mm) solid b at (80, 0) { r = square(size: 50) } }\n",
        "utf-8",
    )
    with serving(file) as client, talking(client, file) as page:
        page.preview()
        offered = page.answer("aidl/exports")
        assert [f["name"] for f in offered["formats"]] == list(OFFERED)
        options = {o["name"]: o for o in offered["options"]}
        assert options["sheet"]["formats"] == [f for f in OFFERED if FORMATS[f".{f}"].cuts]
        assert {"kerf", "spacing", "nest", "tile", "theme"} <= options.keys()
        asked = {"format": "dxf", "options": {"sheet": "120x120", "kerf": "0.2mm", "spacing": ""}}
        made = page.answer("aidl/export", **asked)
        assert made["name"] == "part-dxf.zip"
        with zipfile.ZipFile(io.BytesIO(base64.b64decode(made["data"]))) as archive:
            assert archive.namelist() == ["part.dxf", "part-2.dxf"]  # one sheet for each thickness
            sides = [
                [box.size.x for box in [ezdxf.bbox.extents(ezdxf.read(io.StringIO(text)).modelspace())]]
                for text in (archive.read(name).decode() for name in archive.namelist())
            ]
        assert sides == [[pytest.approx(50.2)], [pytest.approx(50.2)]]
        for given, why in (
            ({"sheet": "big"}, "expected a size such as 600x400"),
            ({"nest": "hope"}, "packed by is one of boxes, outlines, not `hope`"),
            ({"colour": "red"}, "there is no option `colour`"),
            ({"nest": "outlines"}, "packs parts on sheets, and there is none"),
        ):
            refused = page.answer("aidl/export", format="dxf", options=given)
            assert why in refused["error"]["message"]


@pytest.mark.parametrize("order", ["aidl/setKnob", "aidl/undo", None])
def test_a_slow_file_holds_up_nobody(file: Path, order: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file that is only read to its end once another page was answered meanwhile: after an order, or after
    it was changed by others.
    """
    contents, asked, answered = Reads.contents, Event(), Event()

    def slow(self: Reads, path: Path, *more: Any, **named: Any) -> bytes:
        asked.set()
        assert answered.wait(60)
        return contents(self, path, *more, **named)

    with serving(file) as client, talking(client, file) as page, talking(client, file) as other:
        page.preview()
        assert page.answer("aidl/setKnob", path="width", value=80) == {"applied": True}
        while other.preview()["box"][2] != pytest.approx(40):
            pass
        monkeypatch.setattr(Reads, "contents", slow)
        asked.clear()
        if order is None:
            file.write_text(TEXT.replace("60mm", "50mm"), "utf-8")
        else:
            number = page.ask(order, path="width", value=50)
        assert asked.wait(60)
        try:
            assert other.preview()["box"][2] == pytest.approx(40)
        finally:
            answered.set()
        if order is not None:
            assert "error" not in page.answered(number)
        width = 60 if order == "aidl/undo" else 50
        while page.preview()["box"][2] != pytest.approx(width / 2):
            pass


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no such files")
def test_a_pipe_in_place_of_the_file_holds_up_nobody(file: Path) -> None:
    with serving(file) as client, talking(client, file) as page:
        page.preview()
        file.unlink()
        os.mkfifo(file)
        said = page.told("window/showMessage")["message"]
        assert said == "part.aidl cannot be read: it is no regular file"
        assert page.preview()["box"][2] == pytest.approx(30)
        file.unlink()
        file.write_text(TEXT.replace("60mm", "80mm"), "utf-8")
        while page.told(CHANGED)["box"][2] != pytest.approx(40):
            pass
