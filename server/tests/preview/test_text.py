"""The text of a program as pages change it: typed, saved, undone; never over what others wrote."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import SourceFile, Span
from aidl_server.ide.references import CannotError
from aidl_server.preview.files import PAUSE, Manuscript
from server.tests.preview.talking import TEXT, WORDS, Talk, serving, talking, write_bytes

SET = {"applied": True}


@pytest.fixture
def text(file: Path) -> Manuscript:
    made = Manuscript(file, write_bytes)
    made.read()
    return made


def put(text: Manuscript, old: str, new: str, label: str = "Set") -> None:
    """Changes the text as a slider does."""
    known = SourceFile("part.aidl", str(text.text))
    start = known.text.index(old)
    text.set(label, known, [Edit(Span(known, start, start + len(old)), new)], {})


def change(page: Talk, version: int, start: tuple[int, int], end: tuple[int, int], words: str) -> Any:
    places = {name: {"line": at[0], "character": at[1]} for name, at in (("start", start), ("end", end))}
    return page.answer("aidl/type", version=version, changes=[{**places, "text": words}])


# --- Pages


def test_a_page_that_is_behind_is_told_so(file: Path) -> None:
    with serving(file) as client, talking(client, file) as page:
        page.preview()
        assert page.answer("aidl/setKnob", path="width", value=70) == SET
        late = change(page, 1, (0, 0), (0, 0), "x")
        assert late == {"applied": False, "reason": "the text has changed meanwhile"}
        assert file.read_text("utf-8") == TEXT.replace("60mm", "70mm")


def test_undo_does_not_overwrite_what_others_wrote(file: Path) -> None:
    with serving(file) as client, talking(client, file) as page:
        page.preview()
        assert page.answer("aidl/setKnob", path="width", value=70) == SET
        theirs = "// theirs\n" + TEXT
        file.write_text(theirs, "utf-8")
        done = page.answer("aidl/undo")
        why = "there is nothing to undo: part.aidl was changed elsewhere meanwhile"
        assert done == {"applied": False, "reason": why}
        assert file.read_text("utf-8") == theirs
        while page.told(WORDS)["text"] != theirs:
            pass


def test_an_undone_change_of_an_imported_file(file: Path) -> None:
    other = file.with_name("other.aidl")
    other.write_text("solid bolt(n = 1) { param d = 6mm in 4..9\n rim = circle(diameter: n * d) }\n", "utf-8")
    file.write_text('import bolt from "other.aidl"\nassembly a { b = bolt() }\n', "utf-8")
    before = other.read_bytes()
    with serving(file) as client, talking(client, file) as page:
        (knob,) = page.preview()["knobs"]
        assert page.answer("aidl/setKnob", path=knob["path"], value=7) == SET
        after = other.read_bytes()
        assert page.answer("aidl/undo")["applied"]
        assert other.read_bytes() == before
        assert page.answer("aidl/redo")["applied"]
        assert other.read_bytes() == after
        other.write_bytes(b"// theirs\n" + after)
        refused = page.answer("aidl/undo")["reason"]
        assert refused == "other.aidl has changed meanwhile; nothing was written"
        assert other.read_bytes() == b"// theirs\n" + after


def test_a_draft_and_a_change_on_disk_are_both_kept(file: Path) -> None:
    with serving(file) as client, talking(client, file) as page:
        page.preview()
        change(page, 1, (0, 0), (0, 0), "// mine\n")
        theirs = "// theirs\n" + TEXT
        file.write_text(theirs, "utf-8")
        page.told(WORDS, contested=True)
        assert file.read_text("utf-8") == theirs
        refused = page.answer("aidl/save", anyway=False)
        assert refused["reason"] == "part.aidl has changed on disk, so your text was not saved over it"
        assert page.answer("aidl/setKnob", path="width", value=70) == SET
        assert page.answer("aidl/undo")["applied"]
        assert file.read_text("utf-8") == theirs
        assert page.answer("aidl/takeFile")["applied"]
        assert page.told(WORDS, text=theirs)["saved"]
        assert file.read_text("utf-8") == theirs


def test_what_is_no_change_is_refused(file: Path) -> None:
    def place(line: Any, character: int) -> dict[str, Any]:
        return {"line": line, "character": character}

    invalid: list[Any] = [
        *(None, {}, [1], [{}]),
        [{"start": place(0, 0), "end": place(0, 0), "text": 3}],
        [{"start": place(True, 0), "end": place(0, 0), "text": ""}],
        [{"start": place(1, 0), "end": place(0, 0), "text": ""}],
        [{"start": place(0, 0), "end": place(0, 5), "text": ""}] * 2,
    ]
    with serving(file) as client, talking(client, file) as page:
        page.preview()
        for changes in invalid:
            done = page.answer("aidl/type", version=1, changes=changes)
            assert done == {"applied": False, "reason": "this page sent no changes of a text"}
        assert page.preview()["version"] == 1


# --- The manuscript


def test_a_file_is_written_only_by_what_is_set(text: Manuscript, file: Path) -> None:
    put(text, "60mm", "70mm")
    assert file.read_text("utf-8") == text.text
    text.type(f"{text.text}// x\n", "1", 0)
    put(text, "70mm", "80mm")
    assert "70mm" in file.read_text("utf-8")
    assert not text.is_saved
    text.undo()
    text.undo()
    assert text.is_saved
    text.undo()
    assert file.read_text("utf-8") == TEXT


def test_what_is_typed_in_a_go_is_one_step(text: Manuscript) -> None:
    for k, (page, now) in enumerate([("1", 0.0), ("1", 0.5), ("1", 0.6 + PAUSE), ("2", 0.7 + PAUSE)]):
        text.type(f"{text.text}{k}", page, now)
    seen = []
    while text.undoes:
        text.undo()
        seen.append(str(text.text).removeprefix(TEXT))
    assert seen == ["012", "01", ""]
    for _ in range(3):
        text.redo()
    assert text.text == f"{TEXT}0123"


def test_a_write_between_two_looks_is_seen(text: Manuscript, file: Path) -> None:
    theirs = "// theirs\n" + TEXT
    file.write_text(theirs, "utf-8")
    with pytest.raises(CannotError, match="changed meanwhile"):
        put(text, "60mm", "70mm")
    assert file.read_text("utf-8") == theirs


def test_what_is_not_saved_is_kept_beside_the_file(text: Manuscript, file: Path) -> None:
    assert text.rescue() is None
    text.type("// mine\n", "1", 0)
    kept = text.rescue()
    assert kept == file.with_name("part.aidl.unsaved")
    assert kept.read_text("utf-8") == "// mine\n"
    assert file.read_text("utf-8") == TEXT
