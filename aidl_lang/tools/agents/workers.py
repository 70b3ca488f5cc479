"""Runs calls in processes of their own: a program that hangs, crashes or devours memory harms nothing
else.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.processes import Guarded, Limit, limit_met
from aidl_lang.common.render import compact
from aidl_lang.tools.agents.calling import Answer, answer
from aidl_lang.tools.agents.tools import Tools

SECONDS = 45.0
"""Most seconds of a call; clients wait for a minute."""
_WORKERS = 2


class Workers:
    """A few processes that answer calls one after the other; one that was ended is replaced."""

    def __init__(self, workshop: Tools, seconds: float = SECONDS) -> None:
        self.workshop, self.seconds = workshop, seconds
        self._pool = Guarded(_WORKERS, "aidl_lang.tools.agents.calling")

    async def answer(self, name: str, arguments: Mapping[str, object]) -> Answer:
        """Returns the answer of a tool. Cancelling this ends the process that works on it."""
        future = self._pool.submit(self.seconds, answer, self.workshop, name, arguments)
        try:
            return await asyncio.wrap_future(future)
        except Exception as error:
            if (limit := limit_met(error)) is None:
                raise
            return _given_up(_WHY[limit].format(self.seconds))

    def close(self) -> None:
        self._pool.close()


_WHY = {
    Limit.TIME: "took longer than {:g} s",
    Limit.DEATH: "ended the process that worked on it",
    Limit.MEMORY: "needs more memory than there is for it",
}


def _given_up(why: str) -> Answer:
    diagnostic = Diagnostic(
        "E0943",
        f"the call {why} and was given up",
        hints=("ask for less: fewer parts, smaller arrays, no outlines worked out of many others",),
    )
    return Answer(compact([diagnostic]), {}, is_error=True)
