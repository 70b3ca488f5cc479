"""The page of a study and what it asks for, behind the door of the preview."""

from __future__ import annotations

import html
import json
from collections.abc import Callable, Collection
from functools import cache
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route
from starlette.types import ASGIApp

from aidl_eval.judgements import rater_named
from aidl_eval.store import StoreError
from aidl_eval.study.session import Groups, RefusedError, Session
from aidl_server.preview.local import HEADERS, KINDS, PANE, STRICT, Guard, file_named

PAGE = Path(__file__).parent / "page"
CONNECTIONS = 64
POLICY = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:"
_OF_PANE = ("theme.css", "icon.svg")
_LONGEST = 4096
"""Most bytes of a question."""
_NO_RATER = "A name has 1 to 40 letters or digits; between them may be blanks, dots, hyphens and low lines."
_NO_QUESTION = "This is no question that the study knows."


def site(
    session: Session, token: str, addresses: Collection[str], tell: Callable[[StoreError], None]
) -> ASGIApp:
    """Returns the application. `tell` hears what went wrong with the folder: its words may name a language,
    so the page does not hear them.
    """
    routes = [
        Route("/{token}/", _index),
        Route("/{token}/page/{name}", _file),
        Route("/{token}/sheet", _sheet, methods=["POST"]),
        Route("/{token}/answer", _answer, methods=["POST"]),
    ]
    app = Starlette(routes=routes)
    app.state.session, app.state.tell = session, tell
    return Guard(app, addresses, token)


async def _index(request: Request) -> Response:
    text = (PAGE / "index.html").read_text("utf-8").replace("{{csp}}", html.escape(POLICY))
    headers = {**HEADERS, "Content-Security-Policy": f"{POLICY}; {STRICT}"}
    return Response(text, media_type="text/html", headers=headers)


@cache
def _files() -> dict[str, Path]:
    own = {file.name: file for file in PAGE.iterdir() if file.suffix in KINDS}
    return own | {name: PANE / name for name in _OF_PANE}


async def _file(request: Request) -> Response:
    return file_named(_files(), request.path_params["name"])


async def _sheet(request: Request) -> Response:
    return await _answered(request, lambda session, said: session.asked(_rater(said), _number(said)))


async def _answer(request: Request) -> Response:
    return await _answered(request, _kept)


def _kept(session: Session, said: dict[str, Any]) -> dict[str, Any]:
    rater, number, sheet = _rater(said), _number(said), said.get("id")
    if number is None or not isinstance(sheet, str) or "ranking" not in said:
        raise RefusedError(_NO_QUESTION)
    session.answer(rater, number, sheet, _ranking(said["ranking"]))
    return session.asked(rater, number + 1)


async def _answered(request: Request, act: Callable[[Session, dict[str, Any]], dict[str, Any]]) -> Response:
    """Returns what comes of a question: data, or a reason for the rater why not."""
    try:
        found = act(request.app.state.session, await _said(request))
    except RefusedError as reason:
        return JSONResponse({"reason": str(reason)}, 400, HEADERS)
    except StoreError as reason:
        request.app.state.tell(reason)
        words = "The study cannot go on: tell whoever runs it to look at its terminal."
        return JSONResponse({"reason": words}, 500, HEADERS)
    return JSONResponse(found, headers=HEADERS)


async def _said(request: Request) -> dict[str, Any]:
    """Returns the members of a question. Raises RefusedError."""
    if request.headers.get("content-type", "").partition(";")[0].strip().lower() != "application/json":
        raise RefusedError(_NO_QUESTION)
    body = b""
    async for part in request.stream():
        body += part
        if len(body) > _LONGEST:
            raise RefusedError(_NO_QUESTION)
    try:
        said = json.loads(body)
    except (ValueError, RecursionError):
        raise RefusedError(_NO_QUESTION) from None
    if not isinstance(said, dict):
        raise RefusedError(_NO_QUESTION)
    return said


def _rater(said: dict[str, Any]) -> str:
    rater = rater_named(said.get("rater"))
    if rater is None:
        raise RefusedError(_NO_RATER)
    return rater


def _number(said: dict[str, Any]) -> int | None:
    number = said.get("number")
    if number is not None and type(number) is not int:
        raise RefusedError(_NO_QUESTION)
    return number


def _ranking(said: object) -> Groups | None:
    if said is None:
        return None
    if not isinstance(said, list) or not all(
        isinstance(group, list) and group and all(type(place) is int for place in group) for group in said
    ):
        raise RefusedError(_NO_QUESTION)
    return tuple(map(tuple, said))
