"""Several files: imports, what changes on disk, names in many of them, one file under several names."""

from __future__ import annotations

from pathlib import Path

import pytest
from lsprotocol import types

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from server.tests.lsp.editor import Editor

pytestmark = pytest.mark.asyncio(loop_scope="session")

SIZES = "let pitch = 12\nsolid bolt(size = 2) {\n    body = circle(center: (0, 0), radius: size)\n}\n"
ONE = 'import bolt from "sizes.aidl"\nassembly one {\n    a = bolt(size: 3)\n}\n'
TWO = """\
import "sizes.aidl" as s

assembly two {
    b = s.bolt(size: 4) at (20, 0)
    c = s.bolt(size: 5)
}
"""


def written(folder: Path, **files: str) -> list[Path]:
    paths = []
    for name, text in files.items():
        paths.append(folder / f"{name}.aidl")
        paths[-1].write_text(text, "utf-8")
    return paths


def files_changed(editor: Editor, *paths: Path) -> None:
    changes = [types.FileEvent(path.as_uri(), types.FileChangeType.Changed) for path in paths]
    editor.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes))


def join(editor: Editor, folder: Path) -> None:
    event = types.WorkspaceFoldersChangeEvent([types.WorkspaceFolder(folder.as_uri(), "more")], [])
    editor.workspace_did_change_workspace_folders(types.DidChangeWorkspaceFoldersParams(event))


async def is_diagnosed(editor: Editor, uri: str, wrong: bool) -> list[types.Diagnostic]:
    """Waits until errors, or none, are told of a file; the errors."""

    def told() -> list[list[types.Diagnostic]]:
        last = [each.diagnostics for each in editor.told if each.uri == uri][-1:]
        errors = [[d for d in each if d.severity == types.DiagnosticSeverity.Error] for each in last]
        return [each for each in errors if bool(each) == wrong]

    return (await editor.until(told))[0]


async def test_programs_follow_what_they_import(editor: Editor, tmp_path: Path) -> None:
    sizes, one = written(tmp_path, sizes=SIZES, one=ONE)
    uri = editor.open(one)
    await is_diagnosed(editor, uri, False)

    sizes.write_text(SIZES.replace("bolt(size", "screw(size"), "utf-8")
    files_changed(editor, sizes)
    found = await is_diagnosed(editor, uri, True)
    assert {d.range.start.line for d in found} <= {0, 2}

    library = editor.open(sizes, SIZES)  # what the editor has counts, not what is on disk
    await is_diagnosed(editor, uri, False)
    editor.replace(library, "radius: size", "radius: sise")
    assert [d.range.start.line for d in await is_diagnosed(editor, library, True)] == [2]
    editor.replace(library, "bolt", "screw")
    await is_diagnosed(editor, uri, True)
    editor.become(library, SIZES)
    await is_diagnosed(editor, uri, False)
    editor.close(library)  # and now what is on disk
    await is_diagnosed(editor, uri, True)


async def test_what_is_wrong_in_an_import_is_shown_there(editor: Editor, tmp_path: Path) -> None:
    sizes, one = written(tmp_path, sizes=SIZES.replace("radius: size", "radius: sise"), one=ONE)
    editor.open(one)
    assert [d.range.start.line for d in await is_diagnosed(editor, sizes.as_uri(), True)] == [2]
    sizes.write_text(SIZES, "utf-8")
    files_changed(editor, sizes)
    await is_diagnosed(editor, sizes.as_uri(), False)


async def test_a_missing_import_is_found_when_it_comes(editor: Editor, tmp_path: Path) -> None:
    (one,) = written(tmp_path, one=ONE)
    uri = editor.open(one)
    await is_diagnosed(editor, uri, True)
    files_changed(editor, *written(tmp_path, sizes=SIZES))
    await is_diagnosed(editor, uri, False)


async def test_links_and_definitions_lead_to_other_files(editor: Editor, tmp_path: Path) -> None:
    sizes, one = written(tmp_path, sizes=SIZES, one=ONE)
    uri = editor.open(one)
    (link,) = await editor.query("documentLink", uri)
    assert link.target == sizes.as_uri()
    assert (link.range.start.character, link.range.end.character) == (18, 28)
    (found,) = await editor.query("definition", editor.at(uri, "bolt(size: 3)", 2))
    assert (found.uri, found.range.start.line) == (sizes.as_uri(), 1)


async def test_renaming_a_parameter_that_three_files_name(editor: Editor, tmp_path: Path) -> None:
    files = {"sizes": SIZES, "one": ONE, "two": TWO}
    join(editor, tmp_path)
    uris = [editor.open(path) for path in written(tmp_path, **files)]
    for uri in uris:
        await editor.found(uri)
    before = {uri: drawn(editor, uri) for uri in uris[1:]}
    changes = await editor.query("rename", editor.at(uris[0], "size = 2"), new_name="thickness")
    assert editor.apply(changes)
    for uri, (name, text) in zip(uris, files.items(), strict=True):
        changed = text.replace("radius: size", "radius: thickness")
        changed = changed.replace("size:", "thickness:").replace("size = 2", "thickness = 2")
        assert editor.texts[uri] == changed, name
    assert {uri: drawn(editor, uri) for uri in uris[1:]} == before
    for uri in uris:
        await editor.found(uri)
        await is_diagnosed(editor, uri, False)


def drawn(editor: Editor, uri: str) -> bytes:
    beside = MemoryWorld({Path(other).name: text for other, text in editor.texts.items()})
    return pipeline.compile(SourceFile("a.aidl", editor.texts[uri]), beside).export(".svg")


async def test_references_in_files_that_are_not_open(editor: Editor, tmp_path: Path) -> None:
    sizes, *_ = written(tmp_path, sizes=SIZES, one=ONE, two=TWO)
    join(editor, tmp_path)
    uri = editor.open(sizes)
    found = await editor.query("references", editor.at(uri, "bolt("), context=types.ReferenceContext(False))
    lines = {(Path(each.uri).name, each.range.start.line) for each in found}
    assert lines == {("one.aidl", 0), ("one.aidl", 2), ("two.aidl", 3), ("two.aidl", 4)}


async def test_one_file_under_two_names(editor: Editor, tmp_path: Path) -> None:
    (one,) = written(tmp_path, **{"a b": "solid a { b = circle(radius: 3) }\n"})
    (tmp_path / "link.aidl").symlink_to(one)
    uri, twin = editor.open(one), editor.open(tmp_path / "link.aidl", "solid a { b = circle(raduis: 3) }\n")
    assert await editor.found(uri) == []
    assert [d.code for d in await editor.found(twin)] == ["E0324"]
    spelled = uri.replace("%20", " ")
    document = types.VersionedTextDocumentIdentifier(2, spelled)
    whole = types.TextDocumentContentChangeWholeDocument("solid a { b = circle(radius: 3, x: 1) }\n")
    editor.text_document_did_change(types.DidChangeTextDocumentParams(document, [whole]))
    editor.versions[uri] = 2
    assert await editor.found(uri) != []
    for each in (twin, uri):
        editor.close(each)
        await editor.until(lambda each=each: not [t for t in editor.told if t.uri == each][-1].diagnostics)


async def test_library_files_are_shown_and_not_run(editor: Editor) -> None:
    uri = editor.open(
        "untitled:asks", "solid a { b = trapezoid(center: (0, 0), bottom_width: 9, top_width: 3, height: 4) }"
    )
    (found,) = await editor.query("definition", editor.at(uri, "trapezoid"))
    library = editor.open(Path(found.uri.removeprefix("file://")))
    symbols = await editor.query("documentSymbol", library)
    assert "trapezoid" in [each.name for each in symbols]
    assert not [t for t in editor.told if t.uri == library]
