"""What is said where something that was asked for cannot be done."""

from __future__ import annotations

from aidl_lang.common.records import record


class CannotError(Exception):
    """Why what was asked for cannot be done, for people."""


@record()
class Refusal:
    """The same as a value, where it is asked at every move of a mouse: most places cannot be dragged to."""

    reason: str
