"""`aidl sheet`: the files it writes, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import pypdfium2

from tests.commands import Aidl


def test_a_pdf_beside_the_program(aidl: Aidl, folder: Path):
    done = aidl("sheet", "good.aidl")
    assert done.code == 0
    assert done.err.startswith("good.pdf: ")
    with pypdfium2.PdfDocument(folder / "good.pdf") as document:
        assert len(document) == 1
    assert aidl("sheet", "wrong.aidl").code == 1


def test_several_formats_on_the_paper_that_is_asked_for(aidl: Aidl, folder: Path):
    asked = ("--paper", "a3", "--portrait", "--scale", "1:2", "--date", "1 March", "--pixels", "400")
    assert aidl("sheet", "good.aidl", "-o", "a.svg", "-o", "a.png", *asked).code == 0
    drawn = (folder / "a.svg").read_text("utf-8")
    assert 'width="297mm"' in drawn
    assert 'height="420mm"' in drawn
    assert ">1 March<" in drawn
    assert ">1:2<" in drawn
    assert (folder / "a.png").read_bytes().startswith(b"\x89PNG")


def test_a_file_for_each_sheet(aidl: Aidl, folder: Path):
    (folder / "two.aidl").write_text(
        "assembly a { @detached solid s { c = circle(radius: 9) }\n"
        "@detached solid t { c = circle(center: fixed((40, 0)), radius: 4) } }"
    )
    assert aidl("sheet", "two.aidl", "-o", "two.svg").code == 0
    assert sorted(p.name for p in folder.glob("two*.svg")) == ["two-2.svg", "two-3.svg", "two.svg"]
