"""What is said where something that was asked for cannot be done."""

from __future__ import annotations

from dataclasses import dataclass


class CannotError(Exception):
    """Why an edit that was asked for cannot be made."""


@dataclass(frozen=True)
class Refusal:
    """The same as a value, where it is asked at every move of a mouse: most places cannot be dragged to."""

    reason: str
