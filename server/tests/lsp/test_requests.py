"""Every request, on real programs, by a real client over standard input and output."""

from __future__ import annotations

import asyncio
import base64
import re
from itertools import pairwise

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from aidl_lang.common import resources
from server.tests.lsp.editor import TELEPHONE, Editor, edited, offset, place, stretch
from tests.compiled import compiled

pytestmark = pytest.mark.asyncio(loop_scope="session")
WHOLE = types.Range(types.Position(0, 0), types.Position(9999, 0))
UNSTABLE = """\
solid plate {
    param unused = 3mm
    body = rectangle(center: (0, 0), width: 40, height: 20)
}
"""


async def telephone(editor: Editor) -> str:
    """The telephone as it is on disk, solved."""
    uri, text = TELEPHONE.as_uri(), TELEPHONE.read_text("utf-8")
    if uri not in editor.texts:
        editor.open(TELEPHONE)
    elif editor.texts[uri] != text:
        editor.become(uri, text)
    await editor.status(uri)
    return uri


async def test_an_example_has_the_diagnostics_that_the_command_gives(editor: Editor) -> None:
    uri = editor.open(TELEPHONE)
    known = compiled(editor.texts[uri])
    found = await editor.found(uri)
    assert [(d.code, d.message.partition("\n")[0]) for d in found] == [
        (d.code, d.message) for d in known.diagnostics
    ]
    status = await editor.status(uri)
    assert (status["status"], status["degrees"]) == ("solved", known.model.degrees)
    editor.close(uri)


async def test_diagnostics_lead_to_their_pages_and_places(editor: Editor) -> None:
    uri = editor.open("untitled:broken", UNSTABLE)
    found = {d.code: d for d in await editor.found(uri)}
    assert found.keys() == {"W0201"}
    unused = found["W0201"]
    assert list(unused.tags) == [types.DiagnosticTag.Unnecessary]
    assert unused.severity == types.DiagnosticSeverity.Warning
    assert editor.texts[uri][offset(UNSTABLE, unused.range.start) :].startswith("unused")
    page = unused.code_description.href
    assert page.startswith("file:///")
    assert page.endswith("/docs/diagnostics/W0201.md")
    assert resources.page("W0201")


async def test_related_places_are_told(editor: Editor) -> None:
    uri = editor.open("untitled:twice", "solid a {\n  b = circle(radius: 3)\n  b = circle(radius: 4)\n}\n")
    (twice,) = [d for d in await editor.found(uri) if d.related_information]
    places = [(r.location.uri, r.location.range.start.line) for r in twice.related_information]
    assert (uri, 1) in places


async def test_fixes_mend_what_is_wrong(editor: Editor) -> None:
    uri = editor.open("untitled:mend", "solid a { b = circle(raduis: 3) }\n")
    found = await editor.found(uri)
    offered = await editor.query("codeAction", uri, range=WHOLE, context=types.CodeActionContext(found))
    fix = next(a for a in offered if a.kind == types.CodeActionKind.QuickFix)
    assert fix.is_preferred
    assert [d.code for d in fix.diagnostics] == ["E0324"]
    editor.apply(fix.edit)
    assert editor.texts[uri] == "solid a { b = circle(radius: 3) }\n"
    assert await editor.found(uri) == []


async def test_actions_are_worked_out_when_they_are_chosen(editor: Editor) -> None:
    uri = editor.open(
        "untitled:all", "solid a { b = circle(raduis: 3) c = circle(center: (9, 0), raduis: 2) }\n"
    )
    await editor.found(uri)
    only = types.CodeActionContext([], only=[types.CodeActionKind.SourceFixAll])
    (action,) = await editor.query("codeAction", uri, range=WHOLE, context=only)
    assert action.edit is None
    action = await editor.code_action_resolve_async(action)
    editor.apply(action.edit)
    assert editor.texts[uri].count("radius") == 2
    assert "raduis" not in editor.texts[uri]


async def test_solved_values_are_written_back(editor: Editor) -> None:
    uri = await telephone(editor)
    only = types.CodeActionContext([], only=[types.CodeActionKind.RefactorRewrite])
    at = types.Range(types.Position(1, 0), types.Position(1, 0))
    offered = await editor.query("codeAction", uri, range=at, context=only)
    action = next(a for a in offered if a.title == "Write solved values back as first guesses")
    editor.apply((await editor.code_action_resolve_async(action)).edit)
    assert "radius: guess(16)" in editor.texts[uri]
    assert (await editor.status(uri))["status"] == "solved"


async def test_fixes_are_applied_by_command(editor: Editor) -> None:
    uri = editor.open("untitled:command", "solid a { b = circle(raduis: 3) }\n")
    command = types.ExecuteCommandParams("aidl.applyFixes", arguments=[uri])
    assert await editor.workspace_execute_command_async(command)
    assert editor.texts[uri] == "solid a { b = circle(radius: 3) }\n"
    with pytest.raises(JsonRpcException, match="nothing to fix"):
        await editor.workspace_execute_command_async(command)
    for arguments in (None, [], [3], ["untitled:nothing"]):
        with pytest.raises(JsonRpcException, match="not open"):
            await editor.workspace_execute_command_async(
                types.ExecuteCommandParams("aidl.applyFixes", arguments=arguments)
            )


async def test_definitions_here_and_in_the_library(editor: Editor) -> None:
    uri = await telephone(editor)
    text = editor.texts[uri]
    found = await editor.query("definition", editor.at(uri, "0.7 * width", 6))
    start = text.index("width = 160mm")
    assert found == [types.Location(uri, stretch(text, start, start + 5))]
    (shape,) = await editor.query("definition", editor.at(uri, "trapezoid(", 3))
    assert "/stdlib/" in shape.uri


def widths(text: str) -> list[int]:
    """Where the param is named: names of members and of arguments, and words of comments, are others."""
    code = re.sub(r"//.*", lambda m: " " * len(m[0]), text)
    return [m.start() for m in re.finditer(r"(?<![.\w])width(?![\w:])", code)]


async def test_references_are_all_places_of_the_name(editor: Editor) -> None:
    uri = await telephone(editor)
    text = editor.texts[uri]
    wanted = widths(text)
    found = await editor.query(
        "references", editor.at(uri, "0.7 * width", 6), context=types.ReferenceContext(True)
    )
    assert [offset(text, each.range.start) for each in found if each.uri == uri] == wanted
    marked = await editor.query("documentHighlight", editor.at(uri, "0.7 * width", 6))
    assert [offset(text, each.range.start) for each in marked] == wanted
    kinds = [each.kind for each in marked]
    assert kinds[0] == types.DocumentHighlightKind.Write
    assert set(kinds[1:]) == {types.DocumentHighlightKind.Read}


async def test_renaming(editor: Editor) -> None:
    uri = await telephone(editor)
    wanted = editor.texts[uri]
    for start in reversed(widths(wanted)):
        wanted = f"{wanted[:start]}breadth{wanted[start + 5 :]}"
    where = editor.at(uri, "0.7 * width", 6)
    prepared = await editor.query("prepareRename", where)
    assert prepared.placeholder == "width"
    changes = await editor.query("rename", where, new_name="breadth")
    assert editor.apply(changes)
    assert editor.texts[uri] == wanted
    with pytest.raises(JsonRpcException, match="word of the language"):
        await editor.query("rename", editor.at(uri, "0.7 * breadth", 6), new_name="param")


async def test_outline_and_search(editor: Editor) -> None:
    uri = await telephone(editor)
    (root,) = await editor.query("documentSymbol", uri)
    assert root.name == "telephone"
    assert [each.name for each in root.children[:4]] == ["width", "base", "receiver", "dial_plate"]
    found = await editor.workspace_symbol_async(types.WorkspaceSymbolParams("dial_plate"))
    assert (found[0].name, found[0].container_name, found[0].location.uri) == ("dial_plate", "telephone", uri)


async def test_tokens_cover_the_words_and_differences_add_up(editor: Editor) -> None:
    uri = await telephone(editor)
    whole = await editor.query("semanticTokens/full", uri)
    words = decoded(editor.texts[uri], whole.data)
    assert ("param", "keyword") in words
    assert ("width", "variable") in words
    assert ("160mm", "number") in words
    assert ("trapezoid", "type") in words
    assert ("color", "decorator") in words
    editor.replace(uri, "param width", "/* x */ param width")
    changed = await editor.query("semanticTokens/full/delta", uri, previous_result_id=whole.result_id)
    (edit,) = changed.edits
    assert len(edit.data or []) < 15
    data = list(whole.data)
    data[edit.start : edit.start + edit.delete_count] = edit.data or []
    fresh = await editor.query("semanticTokens/full", uri)
    assert data == list(fresh.data)
    lines = await editor.query(
        "semanticTokens/range", uri, range=types.Range(types.Position(2, 0), types.Position(4, 0))
    )
    assert decoded(editor.texts[uri], lines.data) < decoded(editor.texts[uri], fresh.data)


TYPES = ["comment", "keyword", "string", "number", "operator", "decorator", "namespace", "type", "class"]
TYPES += ["function", "method", "parameter", "variable", "property", "enumMember"]


def decoded(text: str, data) -> set[tuple[str, str]]:
    found, line, character = set(), 0, 0
    for i in range(0, len(data), 5):
        lines, characters, length, kind, _ = data[i : i + 5]
        line, character = line + lines, (0 if lines else character) + characters
        units = text.split("\n")[line].encode("utf-16-le")
        found.add((units[2 * character : 2 * (character + length)].decode("utf-16-le"), TYPES[kind]))
    return found


async def test_folds_and_selections(editor: Editor) -> None:
    uri = await telephone(editor)
    text = editor.texts[uri]
    found = await editor.query("foldingRange", uri)
    lines = text.split("\n")
    base = next(f for f in found if "solid base" in lines[f.start_line])
    assert lines[base.end_line + 1].strip() == "}"
    (inner,) = await editor.query(
        "selectionRange", uri, positions=[editor.at(uri, "0.7 * width", 7)["position"]]
    )
    spans = []
    while inner is not None:
        spans.append((offset(text, inner.range.start), offset(text, inner.range.end)))
        inner = inner.parent
    assert text[slice(*spans[0])] == "width"
    assert text[slice(*spans[1])] == "0.7 * width"
    assert all(a[0] >= b[0] and a[1] <= b[1] for a, b in pairwise(spans))
    assert spans[-1] == (0, len(text))


async def test_formatting(editor: Editor) -> None:
    uri = await telephone(editor)
    good = editor.texts[uri]
    for old, new in (("    solid base {", "solid   base{"), ("radius: 28", "radius :28")):
        editor.replace(uri, old, new)
    options = types.FormattingOptions(4, True)
    line = editor.at(uri, "radius :28")["position"].line
    some = await editor.query(
        "rangeFormatting",
        uri,
        range=types.Range(types.Position(line, 0), types.Position(line, 9)),
        options=options,
    )
    partly = edited(editor.texts[uri], some)
    assert "radius: 28" in partly
    assert "solid   base{" in partly
    edits = await editor.query("formatting", uri, options=options)
    assert edited(editor.texts[uri], edits) == good


async def test_colours(editor: Editor) -> None:
    uri = await telephone(editor)
    text = editor.texts[uri]
    found = await editor.query("documentColor", uri)
    color = next(c for c in found if '"crimson"' in text[offset(text, c.range.start) :][:9])
    assert [round(255 * part) for part in (color.color.red, color.color.green, color.color.blue)] == [
        220,
        20,
        60,
    ]
    spelled = await editor.query(
        "colorPresentation", uri, color=types.Color(0.0, 1.0, 0.0, 1.0), range=color.range
    )
    assert '"lime"' in [each.label for each in spelled]


async def test_completion_knows_what_follows_a_dot(editor: Editor) -> None:
    uri = await telephone(editor)
    at = place(editor.texts[uri], editor.texts[uri].index("bottom_left + (16, 0)"))
    made = await editor.query("completion", uri, position=at)
    items = {item.label: item for item in made.items}
    assert {"bottom_left", "center"} <= items.keys()
    assert "solid" not in items
    assert items["bottom_left"].text_edit.range.start == at


async def test_completion_is_documented_when_it_is_looked_at(editor: Editor) -> None:
    uri = editor.open("untitled:writes", "solid a { b = trap }")
    made = await editor.query("completion", editor.at(uri, "trap", 4))
    item = next(item for item in made.items if item.label == "trapezoid")
    assert item.documentation is None
    item = await editor.completion_item_resolve_async(item)
    assert "trapezoid(" in item.documentation.value


async def test_signature_help_marks_the_argument(editor: Editor) -> None:
    uri = await telephone(editor)
    found = await editor.query("signatureHelp", editor.at(uri, "radius: 28", 9))
    chosen = found.signatures[found.active_signature]
    start, end = chosen.parameters[found.active_parameter].label
    assert chosen.label[start:end].startswith("radius")


async def test_hover_tells_the_solved_value(editor: Editor) -> None:
    uri = await telephone(editor)
    text = editor.texts[uri]
    found = await editor.query("hover", editor.at(uri, "width = 160", 2))
    assert "160 mm" in found.contents.value
    start = offset(text, found.range.start)
    assert text[start : offset(text, found.range.end)] == "width"


async def test_lenses_tell_what_is_free(editor: Editor) -> None:
    uri = await telephone(editor)
    found = await editor.query("codeLens", uri)
    titles = {
        editor.texts[uri].split("\n")[lens.range.start.line].strip(): lens.command.title for lens in found
    }
    degrees = (await editor.status(uri))["degrees"]
    assert f"solved, {degrees} degrees of freedom" in titles["assembly telephone {"]


RANGED = """\
solid plate {
    param width = 60mm in 40..120
    param height = 94mm in 20..200
    body = rectangle(center: origin, width: width, height: height)
    assert width < 100
}
"""


async def test_ends_of_params_are_tried_and_told_above_them(editor: Editor) -> None:
    uri = editor.open("untitled:ranged", RANGED)
    await editor.status(uri)

    async def lenses() -> dict[int, str]:
        found = await editor.query("codeLens", uri)
        return {e.range.start.line: e.command.title for e in found if e.command.command == "aidl.checkEnds"}

    assert await lenses() == {1: "try the ends of 2 params"}
    editor.refreshed.clear()
    command = types.ExecuteCommandParams("aidl.checkEnds", [uri])
    found = await editor.workspace_execute_command_async(command)
    assert (found["ok"], found["left"], [each["ok"] for each in found["tried"]]) == (
        False,
        0,
        [True, False, True, True],
    )
    assert (found["tried"][1]["works"], found["tried"][1]["beyond"]["value"]) == (99.99, 100.0)
    await editor.until(lambda: "lenses" in editor.refreshed)
    assert await lenses() == {
        1: "at `width = 120mm` the assert in line 5 fails (120 is not < 100); "
        "`width < 100` holds up to 99.99mm",
        2: "works from 20mm to 200mm, one kind throughout",
    }
    editor.replace(uri, "width < 100", "width < 100 + 50")
    await editor.status(uri)
    assert await lenses() == {1: "try the ends of 2 params"}
    editor.replace(uri, "width < 100 + 50", "width > 100")
    await editor.status(uri)
    assert await lenses() == {}
    with pytest.raises(JsonRpcException, match="there is nothing to try"):
        await editor.workspace_execute_command_async(command)
    editor.close(uri)
    with pytest.raises(JsonRpcException, match="this document is not open"):
        await editor.workspace_execute_command_async(command)


async def test_trying_the_ends_ends_when_the_text_changes(editor: Editor) -> None:
    uri = editor.open("untitled:ranged", RANGED)
    await editor.status(uri)
    command = types.ExecuteCommandParams("aidl.checkEnds", [uri])
    asked = asyncio.ensure_future(editor.workspace_execute_command_async(command))
    await asyncio.sleep(0.05)
    editor.replace(uri, "94mm", "95mm")
    with pytest.raises(JsonRpcException, match="the text has changed"):
        await asked


async def test_inlay_hints_are_the_solved_values(editor: Editor) -> None:
    uri = await telephone(editor)
    text = editor.texts[uri]
    found = await editor.query("inlayHint", uri, range=WHOLE)
    # The guess at the radius gives way to that of the other ear.
    ear = next(h for h in found if text[: offset(text, h.position)].endswith("guess(15"))
    assert re.fullmatch(r"→ 16(\.0*)? mm", ear.label)


async def test_preview_says_where_everything_is_written(editor: Editor) -> None:
    uri = await telephone(editor)
    text = editor.texts[uri]
    picture = await editor.ask("aidl/preview", uri=uri, show=[])
    assert (picture["status"], picture["stale"], picture["version"]) == (
        "solved",
        False,
        editor.versions[uri],
    )
    (number, circle) = next(
        (n, e) for n, e in enumerate(picture["elements"]) if e["path"].endswith("plate.plate")
    )
    start = circle["range"]["start"]
    assert text.split("\n")[start["line"]].strip().startswith("plate = circle")
    assert f'data-element="{number}"' in picture["svg"]
    knob = next(k for k in picture["knobs"] if k["name"] == "width")
    assert (knob["value"], knob["low"], knob["high"], knob["editable"]) == (160, 100, 240, True)

    await editor.ask("aidl/previewClose", uri=uri)


async def test_exports_are_those_of_the_command(editor: Editor) -> None:
    uri = await telephone(editor)
    known = compiled(editor.texts[uri])
    for form in ("svg", "dxf"):
        made = await editor.ask("aidl/export", uri=uri, format=form)
        assert made["name"] == f"telephone.{form}"
        assert base64.b64decode(made["data"]) == known.export(f".{form}")
    with pytest.raises(JsonRpcException, match="no format"):
        await editor.ask("aidl/export", uri=uri, format="gif")


async def test_nothing_is_answered_of_what_is_not_open(editor: Editor) -> None:
    nothing = "file:///nowhere/at_all.aidl"
    assert await editor.query("documentSymbol", nothing) is None
    assert await editor.query("formatting", nothing, options=types.FormattingOptions(4, True)) is None


async def test_the_client_is_asked_to_watch_files_and_for_settings(editor: Editor) -> None:
    assert [each.method for each in editor.registered] == [types.WORKSPACE_DID_CHANGE_WATCHED_FILES]
    uri = await telephone(editor)
    assert await editor.query("codeLens", uri)
    editor.refreshed.clear()
    editor.workspace_did_change_configuration(
        types.DidChangeConfigurationParams({"aidl": {"codeLens": {"enabled": False}}})
    )
    await editor.until(lambda: editor.refreshed)
    assert not await editor.query("codeLens", uri)
    editor.set_configuration({"codeLens": {"enabled": True}}, section="aidl")
    editor.workspace_did_change_configuration(types.DidChangeConfigurationParams(None))
    await editor.until(lambda: len(editor.refreshed) == 4)
    assert await editor.query("codeLens", uri)
