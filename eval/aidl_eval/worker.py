"""Compiles programs in processes of their own: one that hangs, or eats all memory, is a result."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import dataclass, field, replace
from itertools import count
from typing import Any, TypeAlias, TypeVar, cast

from aidl_eval.rendering import Wrapped
from aidl_lang.common.processes import Broke, Crew, Guarded, Limit
from aidl_lang.tools.llm.messages import Conversation, Language, Verdict

T = TypeVar("T")

_MEMORY = 4 << 30
"""Address space of a worker, bytes."""
_LAST = 1_000_000
"""Weight of a program that could not be judged: the worst of all."""


class Broken(Exception):  # noqa: N818 (what came of a program, no error of ours)
    """Raised if a task did not end well; the message tells how."""


class Worker:
    """A process for tasks, restarted after one breaks it. To be used by one thread."""

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._pool = Guarded(1, "aidl_eval.measures", _MEMORY)
        self._crew: Crew[str, Any] = Crew(self._pool)

    def call(self, task: Callable[..., T], *arguments: object) -> T:
        """Returns the result of a task; it and its arguments can be pickled. Raises Broken."""
        self._crew.give("it", self._seconds, task, *arguments)
        while not (came := self._crew.came()):
            pass  # it was begun once more
        ((_, found),) = came
        if not isinstance(found, Broke):
            return cast(T, found)
        if isinstance(found.error, CancelledError):
            raise found.error
        if found.limit is not None:
            raise Broken(_WHY[found.limit].format(self._seconds)) from found.error
        raise Broken(f"it ended in {type(found.error).__name__}: {str(found.error)[:200]}") from found.error

    def stop(self) -> None:
        self._pool.close()


_WHY = {
    Limit.TIME: "it took longer than {:g} s",
    Limit.DEATH: "the process that ran it came to an end",
    Limit.MEMORY: f"it took more than {_MEMORY >> 30} GB of memory",
}


@dataclass(frozen=True)
class Remote(Wrapped):
    """A language whose programs are judged by a worker."""

    worker: Worker

    def reads(self, text: str) -> bool:
        try:
            return self.worker.call(self.language.reads, text)
        except Broken:
            return False

    def conversation(self, before: str | None = None) -> RemoteConversation:
        return RemoteConversation(self.worker, self.language, before)


_numbers = count()


@dataclass
class RemoteConversation:
    """A conversation in a worker; after a crash, a new worker judges its earlier programs again."""

    worker: Worker
    language: Language
    before: str | None
    programs: list[str] = field(default_factory=list)
    verdicts: list[Verdict] = field(default_factory=list)
    number: int = field(default_factory=lambda: next(_numbers))

    def judge(self, program: str) -> Verdict:
        try:
            verdict = self._call(_judge, program)
        except Broken as reason:
            return _unjudged(program, str(reason))
        self.programs.append(program)
        self.verdicts.append(verdict)
        return verdict

    def finish(self, verdict: Verdict) -> Verdict:
        if verdict not in self.verdicts:  # it broke the worker
            return verdict
        try:
            return self._call(_finish, self.verdicts.index(verdict))
        except Broken:
            return verdict

    def _call(self, task: Callable[..., Verdict], argument: object) -> Verdict:
        state = (self.number, self.language, self.before, tuple(self.programs))
        return self.worker.call(task, state, argument)


def _unjudged(program: str, reason: str) -> Verdict:
    feedback = (
        f"The program could not be judged: {reason}. Say it in another way, smaller or simpler, without "
        "giving up what it is to show, and answer with the whole program in one block."
    )
    return Verdict(False, "broken", feedback, program, codes=("broken",), weight=(_LAST,))


@dataclass
class _Open:
    number: int
    conversation: Conversation
    verdicts: list[Verdict]


_open: list[_Open] = []
"""In a worker: the present conversation."""


_State: TypeAlias = tuple[int, Language, str | None, tuple[str, ...]]
"""The number of a conversation, its language, the program that it is to change, and those judged so far."""


def _resumed(state: _State) -> _Open:
    number, language, before, programs = state
    if not _open or _open[0].number != number or len(_open[0].verdicts) != len(programs):
        conversation = language.conversation(before)
        _open[:] = [_Open(number, conversation, [conversation.judge(program) for program in programs])]
    return _open[0]


def _judge(state: _State, program: str) -> Verdict:
    resumed = _resumed(state)
    try:
        verdict = resumed.conversation.judge(program)
    except BaseException:
        _open.clear()  # it may hold half of the program
        raise
    resumed.verdicts.append(verdict)
    return replace(verdict, compiled=None)


def _finish(state: _State, index: int) -> Verdict:
    resumed = _resumed(state)
    return replace(resumed.conversation.finish(resumed.verdicts[index]), compiled=None)
