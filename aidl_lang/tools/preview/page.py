"""One open page: what it has asked for, what it types, and what waits to be sent to it."""

from __future__ import annotations

import asyncio
import json
import re
from collections import deque
from collections.abc import Mapping
from typing import Any, TypeAlias

from attrs import field, frozen
from lsprotocol.types import MessageType

from aidl_lang.tools.ide.references import CannotError
from aidl_lang.tools.ide.workspace import Positions

# --- One open page: what it has asked for, and what waits to be sent to it.

Json: TypeAlias = dict[str, Any]

MOST_UNTAKEN = 16
"""Messages waiting for a page above which it is not heard."""
TOO_MUCH = "this page asks for more than can be done at once: what it asked for last was left out"


@frozen(kw_only=True)
class Request:
    """A request of a page; `id` is its own."""

    id: int
    method: str
    params: dict[str, Any] = field(factory=dict)


class Page:
    """One open page. Messages wait until it takes them; of pictures only the newest, of equals one."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.version = 0
        """of the text that it has"""
        self.state: Json = {}
        """what it was told of the text beside its words"""
        self.orders: deque[Request] = deque()
        self.is_ordering = False
        """whether an order is under way"""
        self.attempt: Request | None = None
        """what is tried next"""
        self.is_trying = False
        self._is_held_up = False
        self._waiting: list[tuple[bool, str]] = []
        self._news = asyncio.Event()

    @property
    def is_behind(self) -> bool:
        """True if it asks for more than it takes."""
        return len(self._waiting) >= MOST_UNTAKEN

    def post(self, message: Json, *, is_picture: bool = False) -> None:
        text = json.dumps({"jsonrpc": "2.0", **message})
        if is_picture:
            self._waiting = [each for each in self._waiting if not each[0]]
        if (is_picture, text) not in self._waiting:
            self._waiting.append((is_picture, text))
        self._news.set()

    def tell(self, message: str) -> None:
        """Sends a message for people."""
        params = {"type": MessageType.Error.value, "message": message}
        self.post({"method": "window/showMessage", "params": params})

    def refuse(self, request: Request, code: int, message: str) -> None:
        self.post({"id": request.id, "error": {"code": code, "message": message}})

    def hold_up(self) -> None:
        """Tells it once that its requests are left out."""
        if not self._is_held_up:
            self._is_held_up = True
            self.tell(TOO_MUCH)

    async def next(self) -> str:
        """Returns the next message for it."""
        while not self._waiting:
            self._news.clear()
            await self._news.wait()
        self._is_held_up = False
        return self._waiting.pop(0)[1]


# --- What a page types, as changes of the text that it has.

_HALVES = re.compile("[\ud800-\udfff]")
_LINE_END = re.compile("\r\n|\n|\r")
_INVALID = "this page sent no changes of a text"


def typed(text: str, changes: Any) -> str:
    """Returns a text after changes counted in it, with its line ends. Raises CannotError for what is none."""
    if not isinstance(changes, list):
        raise CannotError(_INVALID)
    positions, found = Positions(text), _LINE_END.search(text)
    end = found[0] if found is not None else "\n"
    edits = sorted((_edit(positions, change) for change in changes), reverse=True)
    later = len(text)
    for start, stop, words in edits:
        if stop > later:
            raise CannotError(_INVALID)
        text = text[:start] + _LINE_END.sub(end, words) + text[stop:]
        later = start
    return text


def _edit(positions: Positions, change: Any) -> tuple[int, int, str]:
    """Returns the start, the end and the new words of a change."""
    if not isinstance(change, Mapping) or not isinstance(words := change.get("text"), str):
        raise CannotError(_INVALID)
    start, stop = (_offset(positions, change.get(name)) for name in ("start", "end"))
    if start > stop:
        raise CannotError(_INVALID)
    return start, stop, _HALVES.sub("\ufffd", words)


def _offset(positions: Positions, place: Any) -> int:
    if not isinstance(place, Mapping):
        raise CannotError(_INVALID)
    line, character = place.get("line"), place.get("character")
    if type(line) is not int or type(character) is not int:
        raise CannotError(_INVALID)
    return positions.offset(line, character)
