"""Reasons for which a request cannot be carried out."""

from __future__ import annotations

from aidl_lang.common.records import record


class CannotError(Exception):
    """Raised if a request cannot be carried out, with the reason for people."""


@record()
class Refusal:
    """The same as a value, for requests at every move of a mouse: most places cannot be dragged to."""

    reason: str
