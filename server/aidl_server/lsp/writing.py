"""Help while writing: completion, signatures, hover, hints, lenses and code actions."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, TypeVar
from uuid import uuid4

from lsprotocol import types
from pygls.exceptions import JsonRpcContentModified, JsonRpcException, JsonRpcInvalidParams

from aidl_lang.common.running import Cancelled
from aidl_lang.tools.ends import described
from aidl_lang.tools.ranges import described as walked
from aidl_lang.tools.ranges import summary
from aidl_server.ide import lenses
from aidl_server.ide.actions import Action, actions
from aidl_server.ide.completion import MOST, Completion, complete
from aidl_server.ide.hover import hover
from aidl_server.ide.references import CannotError
from aidl_server.ide.signatures import OverloadHelp, signature_help
from aidl_server.ide.workspace import Positions
from aidl_server.lsp import documents
from aidl_server.lsp.running import FAILED, LIMITS
from aidl_server.lsp.server import Asked, Server

T = TypeVar("T")
CHECK_ENDS = "aidl.checkEnds"
_LONGEST = 120.0
"""Most seconds for all ends."""
_PAUSE = 0.2
"""Seconds between checks whether the text has changed."""
_NOTHING = "there is nothing to try: the program must work as written, and have a param with a range"
_TITLE = "Trying the ends of the params, and what lies between"


async def _check(server: Server, uri: object) -> dict[str, Any]:
    """Tries each param of a document at its ends; the document may not change meanwhile."""
    document, known = await _workable(server, uri)
    found = await _tried(server, document, known, lenses.tried)
    document.tried = known.version, found
    server.refresh_hints()
    sweep, walks = found.sweep, walked(document.uri, found.ranges)
    told = {"tried": described(sweep), "left": sweep.left, "seconds": sweep.seconds, "range": walks}
    return told | {"ok": sweep.ok and found.ranges.ok}


async def _walk(server: Server, given: documents.OfDocument) -> dict[str, Any]:
    """Walks each param of a document, unless that was done for the lenses."""
    document, known = await _workable(server, given.uri)
    found = _known(document, known)
    walks = found.ranges if found is not None else await _tried(server, document, known, lenses.between)
    return walked(document.uri, walks) | {"summary": summary(walks)}


def _known(document: documents.Document, known: documents.VersionedView) -> lenses.Found | None:
    """Returns what came of trying the params, of the version asked about only."""
    version, found = document.tried or (None, None)
    return found if version == known.version else None


async def _workable(server: Server, uri: object) -> tuple[documents.Document, documents.VersionedView]:
    """Returns a document as it was run, if its params can be tried."""
    document, known = await server.solved_text(uri, _LONGEST)
    if not lenses.can_be_tried(known.view):
        raise JsonRpcException(_NOTHING, FAILED)
    return document, known


async def _tried(
    server: Server,
    document: documents.Document,
    known: documents.VersionedView,
    function: Callable[..., T],
) -> T:
    """Returns what comes of trying. Raises JsonRpcContentModified if the text changes before."""
    loop = asyncio.get_running_loop()
    told = await _progress(server)

    def tell(done: int, count: int) -> None:
        loop.call_soon_threadsafe(told, done, count)

    work = partial(function, known.view, LIMITS, tell, _LONGEST)
    task = loop.create_task(server.sweeps.ask(work))
    try:
        while not task.done():
            await asyncio.wait([task], timeout=_PAUSE)
            if document.version != known.version or not document.is_open:
                raise JsonRpcContentModified("the text has changed")
        return task.result()
    except Cancelled:
        raise JsonRpcContentModified("the server is closing") from None
    finally:
        task.cancel()
        told(0, 0)


async def _progress(server: Server) -> Callable[[int, int], None]:
    """Returns a function that shows a client how many ends are done; `told(0, 0)` ends it."""
    if not server.can("window.work_done_progress"):
        return lambda done, count: None
    token = str(uuid4())
    await server.work_done_progress.create_async(token)
    server.work_done_progress.begin(token, types.WorkDoneProgressBegin(_TITLE, percentage=0))
    is_over = False

    def told(done: int, count: int) -> None:
        nonlocal is_over
        if is_over:
            return
        if is_over := not count:
            server.work_done_progress.end(token, types.WorkDoneProgressEnd())
            return
        share = 100 * done // count
        report = types.WorkDoneProgressReport(message=f"{done} of {count}", percentage=share)
        server.work_done_progress.report(token, report)

    return told


# --- Inlay hints and code lenses, which depend on the solution.

_PATIENCE = 0.5
"""Seconds to wait for the outcome; the client is told to ask again for a later one."""
_OPEN_PREVIEW = "aidl.openPreview"
"""A command of the client's; one without it shows the title all the same."""


def register_hints(server: Server) -> None:
    @server.command(CHECK_ENDS)
    async def check_ends(*arguments: Any) -> dict[str, Any]:
        """Try the ends of all params of a document, which is the argument."""
        return await _check(server, arguments[0] if arguments else None)

    @server.feature("aidl/ranges")
    async def walk(params: Any) -> dict[str, Any]:
        return await _walk(server, documents.read(params, documents.OfDocument))

    @server.answers_to(types.TEXT_DOCUMENT_CODE_LENS, types.CodeLensOptions(), patience=_PATIENCE)
    def lens(asked: Asked, params: types.CodeLensParams) -> list[types.CodeLens]:
        _note(asked)
        if not asked.settings.lenses:
            return []
        found = [(_OPEN_PREVIEW, each) for each in lenses.lenses(asked.view)]
        at_ends = lenses.end_lenses(asked.view, _known(asked.document, asked.known))
        found += [(CHECK_ENDS, each) for each in at_ends]
        return [
            types.CodeLens(asked.convert.range(span), types.Command(title, command, arguments=[asked.uri]))
            for command, (span, title) in found
        ]

    @server.answers_to(types.TEXT_DOCUMENT_INLAY_HINT, types.InlayHintOptions(), patience=_PATIENCE)
    def inlay(asked: Asked, params: types.InlayHintParams) -> list[types.InlayHint]:
        _note(asked)
        shows = {True: asked.settings.readings, False: asked.settings.solved_values}
        found = lenses.inlays(asked.view, asked.convert.span(params.range))
        return [_hint(each, asked) for each in found if shows[each.is_reading]]


def _note(asked: Asked) -> None:
    """Takes note of what the client is told, which asks again when there is more for the same text."""
    known = asked.known
    asked.document.hinted = known.version, known.serial if known.view.outcome is not None else None


def _hint(inlay: lenses.Inlay, asked: Asked) -> types.InlayHint:
    return types.InlayHint(
        asked.convert.position(asked.view.source, inlay.offset),
        inlay.text,
        text_edits=asked.convert.edits(inlay.edits) or None,
        tooltip=inlay.tooltip or None,
        padding_left=True,
    )


# --- Code actions: offered at a place, and worked out when chosen.

_KINDS = (
    types.CodeActionKind.QuickFix,
    types.CodeActionKind.RefactorExtract,
    types.CodeActionKind.RefactorRewrite,
    types.CodeActionKind.SourceFixAll,
)


def register_actions(server: Server) -> None:
    options = types.CodeActionOptions(code_action_kinds=_KINDS, resolve_provider=True)
    server.answers_to(types.TEXT_DOCUMENT_CODE_ACTION, options)(_offer)

    @server.feature(types.CODE_ACTION_RESOLVE)
    async def resolve(action: types.CodeAction) -> types.CodeAction:
        if action.data is None:
            return action
        given = documents.read(action.data, documents.ActionRequest)
        document = server.documents.get(given.uri)
        asked = await server.asked(document) if document is not None else None
        if asked is None or asked.known.version != given.version:
            raise JsonRpcContentModified("the text has changed")
        action.edit = await server.answers.ask(lambda: _worked_out(asked, given, action.title))
        return action

    @server.command("aidl.applyFixes")
    async def apply_fixes(*arguments: Any) -> bool:
        """Applies the fixes of a document, for clients that have commands and no code actions."""
        asked = await server.asked(server.document(arguments[0] if arguments else None))
        if asked is None:
            raise JsonRpcInvalidParams("this document is not open")
        changes = await server.answers.ask(lambda: _all_fixes(asked))
        params = types.ApplyWorkspaceEditParams(changes, "Apply all fixes")
        return (await server.workspace_apply_edit_async(params)).applied


def _all_fixes(asked: Asked) -> types.WorkspaceEdit:
    whole = len(asked.view.source.text)
    for action in actions(asked.view, 0, whole):
        if action.kind == types.CodeActionKind.SourceFixAll.value:
            return asked.convert.change(action.make())
    raise JsonRpcException("there is nothing to fix", FAILED)


def _offer(asked: Asked, params: types.CodeActionParams) -> list[types.CodeAction]:
    span = asked.convert.span(params.range)
    resolves = asked.can("text_document.code_action.resolve_support")
    made = []
    for action in actions(asked.view, span.start, span.end):
        if not _is_asked(action.kind, params.context.only):
            continue
        offer = types.CodeAction(
            action.title,
            kind=action.kind,
            diagnostics=[d for d in params.context.diagnostics if _is_mended(d, action, asked)] or None,
            is_preferred=action.is_preferred or None,
        )
        if action.mends is not None or not resolves:
            try:
                offer.edit = asked.convert.change(action.make())
            except CannotError:
                continue
        else:
            text = {"uri": asked.uri, "version": asked.known.version}
            offer.data = {**text, "start": span.start, "end": span.end, "kind": action.kind}
        made.append(offer)
    return made


def _is_asked(kind: str, only: Sequence[Any] | None) -> bool:
    """True for a kind asked for, or below one; for all kinds if none is named."""
    wanted = [str(getattr(each, "value", each)) for each in only or ()]
    return not wanted or any(kind == each or kind.startswith(f"{each}.") or not each for each in wanted)


def _is_mended(shown: types.Diagnostic, action: Action, asked: Asked) -> bool:
    """True if a diagnostic of the client's is the one that an action mends."""
    mends = action.mends
    if mends is None or mends.span is None or shown.code != mends.code:
        return False
    return shown.range == asked.convert.range(mends.span)


def _worked_out(asked: Asked, given: documents.ActionRequest, title: str) -> types.WorkspaceEdit:
    for action in actions(asked.view, given.start, given.end):
        if (action.title, action.kind) == (title, given.kind):
            return asked.convert.change(action.make())
    raise JsonRpcContentModified("the text has changed")


_MEANT = {
    "Keyword": ("keyword", "kind"),
    "Snippet": ("snippet",),
    "Unit": ("unit",),
    "Property": ("attribute", "argument"),
    "Color": ("color",),
    "TypeParameter": ("type",),
    "File": ("file",),
    "EnumMember": ("word",),
    "Constant": ("param", "let", "built-in name"),
    "Variable": ("var", "loop variable", "parameter"),
    "Field": ("geometry", "field"),
    "Class": ("structure",),
    "Method": ("method",),
    "Function": ("function",),
    "Struct": ("shape",),
    "Operator": ("constraint",),
    "Interface": ("template",),
    "Module": ("imported file",),
}
_KIND = {kind: types.CompletionItemKind[name] for name, kinds in _MEANT.items() for kind in kinds}


_HOVER_PATIENCE = 0.3
"""Seconds that a hover waits for solved values."""


def register_writing(server: Server) -> None:
    triggers = [".", "@", "(", '"']
    options = types.CompletionOptions(trigger_characters=triggers, resolve_provider=True)
    server.answers_to(types.TEXT_DOCUMENT_COMPLETION, options)(_complete)

    @server.feature(types.COMPLETION_ITEM_RESOLVE)
    async def resolve(item: types.CompletionItem) -> types.CompletionItem:
        if item.data is not None:
            given = documents.read(item.data, documents.EntryRequest)
            document = server.documents.get(given.uri)
            number, found = document.listed if document is not None else (0, [])
            if given.list == number and 0 <= given.entry < len(found):
                said = await server.answers.ask(lambda: found[given.entry].documentation)
                item.documentation = _markdown(said) if said else None
        return item

    @server.answers_to(types.TEXT_DOCUMENT_HOVER, patience=_HOVER_PATIENCE)
    def describe(asked: Asked, params: types.HoverParams) -> types.Hover | None:
        found = hover(asked.view, asked.convert.offset(params.position))
        return None if found is None else types.Hover(_markdown(found.text), asked.convert.range(found.span))

    helping = types.SignatureHelpOptions(trigger_characters=["(", ","], retrigger_characters=[")"])

    @server.answers_to(types.TEXT_DOCUMENT_SIGNATURE_HELP, helping)
    def help_call(asked: Asked, params: types.SignatureHelpParams) -> types.SignatureHelp | None:
        found = signature_help(asked.view, asked.convert.offset(params.position))
        if found is None:
            return None
        return types.SignatureHelp(
            [_overload(overload) for overload in found.overloads],
            active_signature=found.active,
            active_parameter=_active(found.overloads[found.active]),
        )


def _complete(asked: Asked, params: types.CompletionParams) -> types.CompletionList:
    """Lists completions, and keeps the list: the documentation of an entry is made on demand."""
    found = complete(asked.view, asked.convert.offset(params.position), asked.project.workspace.programs)
    number = asked.document.listed[0] + 1
    asked.document.listed = number, found
    snippets = asked.can("text_document.completion.completion_item.snippet_support")
    return types.CompletionList(
        is_incomplete=len(found) >= MOST,
        items=[
            _item(each, asked, snippets, {"uri": asked.uri, "list": number, "entry": index})
            for index, each in enumerate(found)
        ],
    )


def _item(each: Completion, asked: Asked, snippets: bool, data: dict[str, object]) -> types.CompletionItem:
    edit, snippet = asked.convert, types.InsertTextFormat.Snippet
    is_snippet = each.is_snippet and snippets
    return types.CompletionItem(
        label=each.label,
        kind=_KIND.get(each.kind, types.CompletionItemKind.Text),
        detail=each.detail or None,
        sort_text=f"{each.rank:04}",
        insert_text_format=snippet if is_snippet else types.InsertTextFormat.PlainText,
        text_edit=types.TextEdit(edit.range(each.span), each.text if is_snippet else each.plain),
        additional_text_edits=edit.edits(each.extra) or None,
        data=data,
    )


def _overload(overload: OverloadHelp) -> types.SignatureInformation:
    positions = Positions(overload.label)  # which are of UTF-16 here, whatever was agreed for texts
    parameters = []
    for parameter in overload.parameters:
        (_, start), (_, end) = map(positions.position, parameter.place)  # of the one line
        about = _markdown(parameter.about) if parameter.about else None
        parameters.append(types.ParameterInformation((start, end), about))
    about = _markdown(overload.about) if overload.about else None
    return types.SignatureInformation(overload.label, about, parameters, _active(overload))


def _active(overload: OverloadHelp) -> int:
    """Returns the current parameter; one past the last if there is none."""
    return len(overload.parameters) if overload.active is None else overload.active


def _markdown(text: str) -> types.MarkupContent:
    return types.MarkupContent(types.MarkupKind.Markdown, text)
