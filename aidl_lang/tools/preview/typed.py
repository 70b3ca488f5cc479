"""What a page types, as changes of the text that it has."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from aidl_lang.tools.ide.positions import Positions
from aidl_lang.tools.ide.refusing import CannotError

_HALVES = re.compile("[\ud800-\udfff]")
_LINE_END = re.compile("\r\n|\n|\r")
_INVALID = "this page sent no changes of a text"


def typed(text: str, changes: Any) -> str:
    """Returns a text after changes by line and character, all of them counted in the text before. Line ends
    become those that the text has. Raises CannotError for what is no such change.
    """
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
