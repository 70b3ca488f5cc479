"""Data from outside, read strictly: each member by its kind, and no members but those."""

from __future__ import annotations

import datetime
from enum import StrEnum
from typing import Any, TypeVar

from cattrs import BaseValidationError, Converter, ForbiddenExtraKeysError, transform_error

T = TypeVar("T")
_WORDS = {int: "a whole number", float: "a number", str: "a text"}


class WrongError(ValueError):
    """Raised for data of another form; the message gives the member and the reason."""


def read(said: object, kind: type[T]) -> T:
    """Returns data as a value of a class. Raises WrongError."""
    if not isinstance(said, dict):
        raise WrongError("it is to be an object, as in {…}")
    try:
        return CONVERTER.structure(said, kind)
    except BaseValidationError as error:
        why, _, member = transform_error(error, "", _told)[0].rpartition(" @ ")
        raise WrongError(f"`{member.lstrip('.')}`: {why}" if member else why) from None


def _told(error: BaseException, _: type | None) -> str:
    match error:
        case KeyError():
            return "it is missing"
        case ForbiddenExtraKeysError(extra_fields=strange):
            return f"there is no member `{min(strange)[:60]}`"
        case AttributeError() | TypeError():
            return "it is to be an object, as in {…}"
    return str(error)[:200]


def _exactly(said: object, kind: type) -> Any:
    if issubclass(kind, StrEnum):
        return kind(str(said))
    if type(said) is not kind and not (kind is float and type(said) is int):
        raise ValueError(f"it is to be {_WORDS[kind]}")
    return said


CONVERTER = Converter(forbid_extra_keys=True)
CONVERTER.register_structure_hook(datetime.date, lambda said, _: datetime.date.fromisoformat(said))
for _kind in _WORDS:
    CONVERTER.register_structure_hook(_kind, _exactly)
