"""Code actions: offered at a place, and worked out when chosen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from lsprotocol import types
from pygls.exceptions import JsonRpcContentModified, JsonRpcException, JsonRpcInvalidParams

from aidl_lang.common.diagnostics import Edit
from aidl_lang.tools.ide.actions import Action, actions
from aidl_lang.tools.ide.references import CannotError
from aidl_lang.tools.lsp import params as asking
from aidl_lang.tools.lsp.server import FAILED, Asked, Server

_KINDS = (
    types.CodeActionKind.QuickFix,
    types.CodeActionKind.RefactorExtract,
    types.CodeActionKind.RefactorRewrite,
    types.CodeActionKind.SourceFixAll,
)
_VERSIONED = "workspace.workspace_edit.document_changes"


def register_actions(server: Server) -> None:
    options = types.CodeActionOptions(code_action_kinds=_KINDS, resolve_provider=True)
    server.answers_to(types.TEXT_DOCUMENT_CODE_ACTION, options)(_offer)

    @server.feature(types.CODE_ACTION_RESOLVE)
    async def resolve(action: types.CodeAction) -> types.CodeAction:
        if action.data is None:
            return action
        given = asking.read(action.data, asking.ActionRequest)
        document = server.documents.get(given.uri)
        asked = await server.asked(document) if document is not None else None
        if asked is None or asked.known.version != given.version:
            raise JsonRpcContentModified("the text has changed")
        action.edit = await server.answers.ask(lambda: _worked_out(asked, given, action.title))
        return action

    @server.command("aidl.applyFixes")
    async def apply_fixes(*arguments: Any) -> bool:
        """Applies the fixes of a document, for clients that have commands and no code actions."""
        document = server.documents.get(arguments[0]) if arguments and isinstance(arguments[0], str) else None
        asked = await server.asked(document) if document is not None else None
        if asked is None:
            raise JsonRpcInvalidParams("this document is not open")
        changes = await server.answers.ask(lambda: _all_fixes(asked))
        params = types.ApplyWorkspaceEditParams(changes, "Apply all fixes")
        return (await server.workspace_apply_edit_async(params)).applied


def _all_fixes(asked: Asked) -> types.WorkspaceEdit:
    whole = len(asked.view.source.text)
    for action in actions(asked.view, 0, whole):
        if action.kind == types.CodeActionKind.SourceFixAll.value:
            return _made(asked, action)
    raise JsonRpcException("there is nothing to fix", FAILED)


def _made(asked: Asked, action: Action) -> types.WorkspaceEdit:
    """Returns the edits of an action. Raises JsonRpcException if it cannot be carried out."""
    try:
        return _edit(asked, action.make())
    except CannotError as reason:
        raise JsonRpcException(str(reason), FAILED) from None


def _offer(asked: Asked, params: types.CodeActionParams) -> list[types.CodeAction]:
    """Returns the actions at a range, without edits for a client that can ask for these later."""
    span = asked.convert.span(params.range)
    resolves = asked.can("text_document.code_action.resolve_support")
    made = []
    for action in actions(asked.view, span.start, span.end):
        if not _is_wanted(action.kind, params.context.only):
            continue
        offer = types.CodeAction(
            action.title,
            kind=action.kind,
            diagnostics=[d for d in params.context.diagnostics if _is_mended(d, action, asked)] or None,
            is_preferred=action.is_preferred or None,
        )
        if action.mends is not None or not resolves:
            try:
                offer.edit = _edit(asked, action.make())
            except CannotError:
                continue
        else:
            offer.data = {
                "uri": asked.uri,
                "version": asked.known.version,
                "start": span.start,
                "end": span.end,
                "kind": action.kind,
            }
        made.append(offer)
    return made


def _is_wanted(kind: str, only: Sequence[Any] | None) -> bool:
    """True for a kind asked for, or below one; for all kinds if none is named."""
    wanted = [str(getattr(each, "value", each)) for each in only or ()]
    return not wanted or any(kind == each or kind.startswith(f"{each}.") or not each for each in wanted)


def _is_mended(shown: types.Diagnostic, action: Action, asked: Asked) -> bool:
    """True if a diagnostic of the client's is the one that an action mends."""
    mends = action.mends
    if mends is None or mends.span is None or shown.code != mends.code:
        return False
    return shown.range == asked.convert.range(mends.span)


def _worked_out(asked: Asked, given: asking.ActionRequest, title: str) -> types.WorkspaceEdit:
    for action in actions(asked.view, given.start, given.end):
        if (action.title, action.kind) == (title, given.kind):
            return _made(asked, action)
    raise JsonRpcContentModified("the text has changed")


def _edit(asked: Asked, edits: Sequence[Edit]) -> types.WorkspaceEdit:
    return asked.convert.changes(asked.convert.by_file(edits), asked.can(_VERSIONED))
