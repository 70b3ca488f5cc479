"""Characters of two units, line ends of two characters, and what else may stand in a text."""

# ruff: noqa: RUF001 (letters that look like others are what this is about)
from __future__ import annotations

import pytest
from lsprotocol import types

from tests.lsp.editor import CAPABILITIES, COMMAND, ENVIRONMENT, EXAMPLES, Editor, make, offset, place

pytestmark = pytest.mark.asyncio(loop_scope="module")
ROOM = EXAMPLES / "workshop"

ASTRAL = """\
/// 𝔸 part: 👩‍🔧 and 🇦🇶
solid größe { /* 🚀🚀 */ param 𝑏reite = 12mm in 1..90 /* 𝕊 */ let 名前 = 𝑏reite / 2
    @note("🚀") rechteck = rectangle(center: (0, 0), width: 𝑏reite, /* 🚀 */ height: 名前, hight: 3)
}
"""


@pytest.mark.parametrize("end", ["\n", "\r\n"])
async def test_places_behind_astral_characters(editor: Editor, end: str) -> None:
    text = ASTRAL.replace("\n", end)
    uri = editor.open(f"untitled:astral{len(end)}", text)
    (wrong,) = [d for d in await editor.found(uri) if d.code == "E0324"]
    start = offset(text, wrong.range.start)
    assert text[start:].startswith("hight")
    assert offset(text, wrong.range.end) == start + len("hight")

    places = [i for i in range(len(text)) if text.startswith("𝑏reite", i)]
    found = await editor.text_document_references_async(
        types.ReferenceParams(types.ReferenceContext(True), editor.document(uri), place(text, places[1]))
    )
    assert [offset(text, each.range.start) for each in found] == places
    assert [offset(text, each.range.end) for each in found] == [i + len("𝑏reite") for i in places]

    changes = await editor.text_document_rename_async(
        types.RenameParams(editor.document(uri), place(text, places[0] + 1), "w")
    )
    assert editor.apply(changes)
    assert editor.texts[uri] == text.replace("𝑏reite", "w")
    editor.close(uri)


async def test_edits_between_halves_and_behind_ends(editor: Editor) -> None:
    """A position in the middle of a character means its start, one behind a line its end."""
    uri = editor.open("untitled:halves", "// 🚀\nsolid a { b = circle(radius: 3) }\n")

    def change(version: int, line: int, start: int, stop: int, new: str) -> None:
        where = types.Range(types.Position(line, start), types.Position(line, stop))
        part = types.TextDocumentContentChangePartial(where, new)
        document = types.VersionedTextDocumentIdentifier(version, uri)
        editor.text_document_did_change(types.DidChangeTextDocumentParams(document, [part]))

    change(2, 0, 4, 5, "")  # from the start of the rocket to its end
    change(3, 0, 99, 99, " ok")
    change(4, 99, 0, 0, "// the end")
    change(5, 1, 0, 0, "")
    editor.texts[uri], editor.versions[uri] = "//  ok\nsolid a { b = circle(radius: 3) }\n// the end", 5
    assert await editor.found(uri) == []
    tokens = await editor.text_document_semantic_tokens_full_async(
        types.SemanticTokensParams(editor.document(uri))
    )
    assert list(tokens.data[:5]) == [0, 0, 6, 0, 0]
    assert list(tokens.data[-5:]) == [1, 0, 10, 0, 0]
    editor.close(uri)


@pytest.mark.parametrize(
    "text",
    [
        "\ufeffsolid a { b = circle(radius: 3) }\n",
        "solid a {\r b = circle(radius: 3)\r}\r",
        "// \u2028 \u0085 \x0b \x0c\nsolid a {\tb = circle(radius: 3) }",
        "solid a { b = circle(radius: 3) } // \ud83d",
    ],
    ids=["mark", "returns", "separators", "half"],
)
async def test_strange_characters_are_no_trouble(editor: Editor, text: str) -> None:
    uri = editor.open(f"untitled:strange{hash(text)}", text)
    assert await editor.found(uri) == []
    symbols = await editor.text_document_document_symbol_async(
        types.DocumentSymbolParams(editor.document(uri))
    )
    assert [each.name for each in symbols] == ["a"]
    line = symbols[0].selection_range.start.line
    assert line == text[: text.index("solid")].count("\n")
    editor.close(uri)


async def test_the_unit_of_positions_is_agreed_on() -> None:
    client = make()
    await client.start_io(*COMMAND, env=ENVIRONMENT)
    agreed = types.ClientCapabilities(
        general=types.GeneralClientCapabilities(position_encodings=[types.PositionEncodingKind.Utf8]),
        text_document=CAPABILITIES.text_document,
    )
    result = await client.initialize_session(
        types.InitializeParams(capabilities=agreed, root_uri=EXAMPLES.as_uri())
    )
    assert result.capabilities.position_encoding == "utf-8"
    text = "solid a { /* 🚀ü */ b = circle(raduis: 3) }"
    uri = client.open("untitled:units", text)
    (wrong,) = await client.found(uri)
    assert wrong.range.start == types.Position(0, len(text[: text.index("raduis")].encode()))
    await client.shutdown_session()
    await client.stop()
