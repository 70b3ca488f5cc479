"""Terminal colours, and the rule when to use them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TextIO

from aidl_lang.common.diagnostics import Severity
from aidl_lang.common.records import record

_RESET = "\x1b[0m"
_SEVERITY = {Severity.ERROR: "\x1b[1;31m", Severity.WARNING: "\x1b[1;33m", Severity.NOTE: "\x1b[1;36m"}


@record()
class TerminalStyle:
    """A way to print: in terminal colours, or plain."""

    colour: bool = False

    def severity(self, text: str, severity: Severity) -> str:
        return self._paint(text, _SEVERITY[severity])

    def strong(self, text: str) -> str:
        return self._paint(text, "\x1b[1m")

    def gutter(self, text: str) -> str:
        return self._paint(text, "\x1b[1;34m")

    def added(self, text: str) -> str:
        return self._paint(text, "\x1b[32m")

    def removed(self, text: str) -> str:
        return self._paint(text, "\x1b[31m")

    def _paint(self, text: str, start: str) -> str:
        return f"{start}{text}{_RESET}" if self.colour and text else text


def wants_colour(stream: TextIO, environment: Mapping[str, str]) -> bool:
    """Tells whether to print in colour: on a terminal only; `NO_COLOR` and `FORCE_COLOR` overrule, in that
    order (no-color.org).
    """
    if environment.get("NO_COLOR"):
        return False
    if environment.get("FORCE_COLOR", "0") != "0":
        return True
    return stream.isatty() and environment.get("TERM") != "dumb"
