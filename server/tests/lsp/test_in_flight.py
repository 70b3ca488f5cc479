"""Texts that change while they are worked on, that are broken, or that take long."""

from __future__ import annotations

import asyncio
import random
from typing import Any

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from server.tests.lsp.editor import TELEPHONE, Editor, edited
from tests.compiled import compiled

pytestmark = pytest.mark.asyncio(loop_scope="session")

SLOW = """\
solid slow {
    for i in 0..100 {
        for j in 0..100 { dots[i * 101 + j] = rectangle(center: (3 * i, 3 * j), width: 1, height: 2) }
    }
}
"""
"""Takes ten seconds and more."""
SLOW_TO_TRY = """\
param count = 2 in 1..60
solid grid {
    for i in 0..count {
        for j in 0..count { dots[i * 61 + j] = rectangle(center: (3 * i, 3 * j), width: 1, height: 2) }
    }
}
"""
"""Takes a tenth of a second where `count` is 9."""


def said(diagnostics) -> list[tuple[str, str]]:
    return [(d.code, d.message.partition("\n")[0]) for d in diagnostics]


def wanted(text: str) -> list[tuple[str, str]]:
    return [(d.code, d.message) for d in compiled(text).diagnostics]


@pytest.mark.parametrize("seed", range(2))
async def test_after_many_quick_edits_the_diagnostics_are_those_of_the_text(
    editor: Editor, seed: int
) -> None:
    uri = editor.open(TELEPHONE)
    await editor.ask("aidl/preview", uri=uri, show=[])
    rng = random.Random(seed)
    good = editor.texts[uri]
    for _ in range(60):
        text = editor.texts[uri]
        start = rng.randrange(len(text) + 1)
        match rng.randrange(5):
            case 0:
                editor.change(uri, start, min(start + rng.randrange(4), len(text)), "")
            case 1:
                editor.change(uri, start, start, rng.choice('a1 {}()🚀\n"=.,é'))
            case 2:
                other = rng.randrange(len(good))
                editor.change(uri, start, start, good[other : other + rng.randrange(20)])
            case 3:
                editor.become(uri, good)
            case _:
                editor.replace(uri, text[start : start + 1], text[start : start + 1])
        if rng.random() < 0.1:
            await asyncio.sleep(0.01)
    if seed == 0:
        editor.become(uri, good)
    assert said(await editor.found(uri)) == wanted(editor.texts[uri])
    status = await editor.status(uri)
    picture = await editor.picture(uri)
    assert picture["status"] == status["status"]
    if seed == 0:
        assert (picture["status"], picture["stale"]) == ("solved", False)
    versions = [t.version for t in editor.told if t.uri == uri and t.version is not None]
    assert versions == sorted(versions)
    shown = [p["version"] for p in editor.pictures if p["uri"] == uri]
    assert shown == sorted(shown)
    assert not editor.messages
    await editor.ask("aidl/previewClose", uri=uri)


async def test_a_broken_program_completes_and_keeps_its_picture(editor: Editor) -> None:
    uri = editor.open(TELEPHONE)
    good = await editor.ask("aidl/preview", uri=uri, show=[])
    at = editor.texts[uri].index("equal(right_ear")
    editor.change(uri, at, at, "left_ear.\n            ")
    editor.replace(uri, "assembly telephone {", "assembly telephone { ((")
    found = await editor.found(uri)
    assert any(d.severity == types.DiagnosticSeverity.Error for d in found)
    stale = await editor.picture(uri)
    assert (stale["status"], stale["stale"]) == ("wrong", True)
    assert (stale["svg"] is not None, stale["box"]) == (True, good["box"])
    assert [p["code"] for p in stale["problems"]] == [d.code for d in found]

    made = await editor.query("completion", editor.at(uri, "left_ear.\n", 9))
    assert {"center", "radius"} <= {item.label for item in made.items}
    assert await editor.query("documentSymbol", uri)

    editor.become(uri, TELEPHONE.read_text("utf-8"))
    again = await editor.picture(uri)
    assert (again["status"], again["stale"], again["svg"]) == ("solved", False, good["svg"])


async def test_a_request_can_be_taken_back(editor: Editor) -> None:
    uri = editor.open("untitled:slow", SLOW)
    asked = asyncio.ensure_future(
        editor.protocol.send_request_async("aidl/preview", {"uri": uri, "show": []}, msg_id="taken-back")
    )
    await asyncio.sleep(0)  # in which it is sent
    editor.cancel_request(types.CancelParams("taken-back"))
    with pytest.raises(JsonRpcException) as refused:
        await asked
    assert refused.value.code == types.LSPErrorCodes.RequestCancelled.value


async def test_others_need_not_wait_for_a_slow_program(editor: Editor) -> None:
    slow = editor.open("untitled:slow", SLOW)
    assert await editor.found(slow) == []  # of what checking has found: the program is being run
    symbols = await editor.query("documentSymbol", slow)
    assert [each.name for each in symbols] == ["slow"]
    quick = editor.open("untitled:quick", "solid a { b = circle(raduis: 3) }")
    assert [d.code for d in await editor.found(quick)] == ["E0324"]
    assert not [s for s in editor.statuses if s["uri"] == slow]  # it went on waiting
    editor.replace(slow, "width: 1", "width: 1, breadth: 2")
    assert [d.code for d in await editor.found(slow)] == ["E0324"]
    editor.become(slow, "solid a { b = circle(radius: 3) }")
    assert (await editor.status(slow))["status"] == "solved"


async def test_closing_ends_what_is_done_for_a_text(editor: Editor) -> None:
    uri = editor.open("untitled:closing", SLOW)
    asked = asyncio.ensure_future(editor.ask("aidl/preview", uri=uri, show=[]))
    await editor.found(uri)  # of what was found without running it: by now it is being run
    editor.close(uri)
    assert await asked is None
    other = editor.open("untitled:after", "solid a { b = circle(radius: 3) }")
    assert await editor.found(other) == []
    assert not [s for s in editor.statuses if s["uri"] == uri]


async def test_only_the_newest_attempt_is_made(editor: Editor) -> None:
    uri = editor.open(TELEPHONE)
    await editor.found(uri)
    attempts = [
        asyncio.ensure_future(editor.ask("aidl/try", uri=uri, version=1, knobs={"width": 141 + n}))
        for n in range(20)
    ]
    made = await asyncio.gather(*attempts, return_exceptions=True)
    assert made[-1]["box"][2] - made[-1]["box"][0] == pytest.approx(160.0)
    others = [each for each in made[:-1] if isinstance(each, JsonRpcException)]
    assert others
    assert {each.code for each in others} == {types.LSPErrorCodes.RequestCancelled.value}
    assert (await editor.ask("aidl/preview", uri=uri, show=[]))["tried"] is False
    await editor.ask("aidl/previewClose", uri=uri)


async def test_an_attempt_is_given_up_where_its_viewer_edits(editor: Editor) -> None:
    uri = editor.open("untitled:outdated", SLOW_TO_TRY)
    await editor.found(uri)
    tries = {
        viewer: asyncio.ensure_future(editor.ask("aidl/try", uri=uri, viewer=viewer, knobs={"count": 9}))
        for viewer in ("one", "other")
    }
    refused = asyncio.ensure_future(
        editor.ask("aidl/setKnob", uri=uri, viewer="one", path="count", value=5000)
    )
    with pytest.raises(JsonRpcException) as given_up:
        await tries["one"]
    assert given_up.value.code == types.LSPErrorCodes.RequestCancelled.value
    assert (await tries["other"])["tried"]
    assert not (await refused)["applied"]


async def test_viewers_of_one_document_see_what_each_asked_for(editor: Editor) -> None:
    uri = editor.open("untitled:viewers", "solid a { b = circle(radius: 3) }\n")
    plain = await editor.ask("aidl/preview", uri=uri, viewer="plain")
    named = await editor.ask("aidl/preview", uri=uri, viewer="named", show=["names"])
    assert ("show-names" in plain["svg"], "show-names" in named["svg"]) == (False, True)
    await editor.ask("aidl/previewClose", uri=uri, viewer="nobody")
    version = editor.replace(uri, "3", "4")

    def told() -> dict[str, Any] | None:
        found = {p["viewer"]: p for p in editor.pictures if p["uri"] == uri and p["version"] == version}
        return found if found.keys() == {"plain", "named"} else None

    after = await editor.until(told)
    assert "show-names" in after["named"]["svg"]
    assert "show-names" not in after["plain"]["svg"]
    await editor.ask("aidl/previewClose", uri=uri, viewer="plain")
    version = editor.replace(uri, "4", "5")
    await editor.until(lambda: [p for p in editor.pictures if p["uri"] == uri and p["version"] == version])
    await editor.status(uri)
    assert {p["viewer"] for p in editor.pictures if p["uri"] == uri and p["version"] == version} == {"named"}


async def test_edits_of_the_text_as_it_is_follow_one_another(editor: Editor) -> None:
    uri = editor.open("untitled:edits", "param w = 10 in 1..99\nsolid a { b = circle(radius: w) }\n")
    await editor.found(uri)
    edits = [editor.ask("aidl/setKnob", uri=uri, path="w", value=value) for value in (20, 30, 40)]
    assert await asyncio.gather(*edits) == [{"applied": True}] * 3
    assert "param w = 40 in" in editor.texts[uri]
    assert editor.versions[uri] == 4


async def test_an_answer_that_edits_is_not_given_for_a_text_that_has_changed(editor: Editor) -> None:
    uri = editor.open("untitled:moving", "solid  a { b = circle(radius: 3) }\n")
    await editor.found(uri)
    answers = []
    for n in range(20):
        answers.append(
            asyncio.ensure_future(editor.query("formatting", uri, options=types.FormattingOptions(4, True)))
        )
        editor.replace(uri, "radius: ", f"radius: {n}")
    made = await asyncio.gather(*answers, return_exceptions=True)
    refused = [each for each in made if isinstance(each, JsonRpcException)]
    assert {each.code for each in refused} <= {types.LSPErrorCodes.ContentModified.value}
    text = editor.texts[uri]
    edits = await editor.query("formatting", uri, options=types.FormattingOptions(4, True))
    assert edited(text, edits) == pipeline.formatted(SourceFile("a", text))[0]


async def test_what_no_text_has_is_passed_over(editor: Editor) -> None:
    """Changes of what is not open, closing twice, ranges the wrong way round."""
    nothing = types.VersionedTextDocumentIdentifier(7, "untitled:nothing")
    whole = types.TextDocumentContentChangeWholeDocument("solid a { }")
    editor.text_document_did_change(types.DidChangeTextDocumentParams(nothing, [whole]))
    for _ in range(2):
        editor.text_document_did_close(types.DidCloseTextDocumentParams(nothing))
    uri = editor.open("untitled:backwards", "solid a { b = circle(radius: 3) }")
    where = types.Range(types.Position(0, 32), types.Position(0, 14))
    change = types.TextDocumentContentChangePartial(where, "square(side: 3) ")
    document = types.VersionedTextDocumentIdentifier(2, uri)
    editor.text_document_did_change(types.DidChangeTextDocumentParams(document, [change]))
    editor.texts[uri], editor.versions[uri] = "solid a { b = square(side: 3) }", 2
    assert await editor.found(uri) == []
    again = types.TextDocumentItem(uri, "aidl", 9, "solid a { b = circle(raduis: 3) }")
    editor.text_document_did_open(types.DidOpenTextDocumentParams(again))
    editor.versions[uri] = 9
    assert [d.code for d in await editor.found(uri)] == ["E0324"]
