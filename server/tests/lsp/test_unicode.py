"""Characters of two units, line ends of two characters, and what else may stand in a text."""

# ruff: noqa: RUF001 (letters that look like others are what this is about)
from __future__ import annotations

import pytest
from lsprotocol import types

from server.tests.lsp.editor import Editor, offset, place

pytestmark = pytest.mark.asyncio(loop_scope="session")

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
    found = await editor.query(
        "references", uri, context=types.ReferenceContext(True), position=place(text, places[1])
    )
    assert [offset(text, each.range.start) for each in found] == places
    assert [offset(text, each.range.end) for each in found] == [i + len("𝑏reite") for i in places]

    changes = await editor.query("rename", uri, position=place(text, places[0] + 1), new_name="w")
    assert editor.apply(changes)
    assert editor.texts[uri] == text.replace("𝑏reite", "w")


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
    tokens = await editor.query("semanticTokens/full", uri)
    assert list(tokens.data[:5]) == [0, 0, 6, 0, 0]
    assert list(tokens.data[-5:]) == [1, 0, 10, 0, 0]


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
    symbols = await editor.query("documentSymbol", uri)
    assert [each.name for each in symbols] == ["a"]
    line = symbols[0].selection_range.start.line
    assert line == text[: text.index("solid")].count("\n")
