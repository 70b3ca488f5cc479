"""Compiles programs in processes of their own: one that hangs, or eats all memory, is a result."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import dataclass, field, replace
from itertools import count
from typing import TypeAlias, TypeVar

from aidl_lang.common.processes import Guarded, Limit, limit_met
from aidl_lang.tools.llm.messages import Conversation, Language, Verdict

T = TypeVar("T")

_MEMORY = 4 << 30
"""Address space of a worker, bytes."""
_BROKEN, _LAST = "broken", 1_000_000
"""Stage and weight of a program that could not be judged: the worst of all."""


class Broken(Exception):  # noqa: N818 (what came of a program, no error of ours)
    """Raised if a task did not end well; the message tells how."""


class Worker:
    """A process for tasks, restarted after one breaks it."""

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._pool = Guarded(1, "aidl_eval.measures", _MEMORY)
        self._is_stopped = False

    def call(self, task: Callable[..., T], *arguments: object) -> T:
        """Returns the result of a task; it and its arguments can be pickled. Raises Broken; CancelledError if
        the worker is stopped.
        """
        if self._is_stopped:
            raise CancelledError
        try:
            return self._pool.submit(self._seconds, task, *arguments).result()
        except Exception as error:
            if self._is_stopped:
                raise CancelledError from error
            limit = limit_met(error)
            if limit is not None:
                raise Broken(_WHY[limit].format(self._seconds)) from error
            raise Broken(f"it ended in {type(error).__name__}: {str(error)[:200]}") from error

    def stop(self) -> None:
        self._is_stopped = True
        self._pool.close()


_WHY = {
    Limit.TIME: "it took longer than {:g} s",
    Limit.DEATH: "the process that ran it came to an end",
    Limit.MEMORY: f"it took more than {_MEMORY >> 30} GB of memory",
}


@dataclass(frozen=True)
class Remote:
    """A language whose programs are judged by a worker."""

    language: Language
    worker: Worker
    name: str
    suffix: str
    fences: tuple[str, ...]

    @classmethod
    def of(cls, language: Language, worker: Worker) -> Remote:
        return cls(language, worker, language.name, language.suffix, language.fences)

    def guide(self) -> str:
        return self.language.guide()

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
    number: int = field(default_factory=lambda: next(_numbers))

    def judge(self, program: str) -> Verdict:
        try:
            verdict = self.worker.call(_judge, self._state, program)
        except Broken as reason:
            return _unjudged(program, str(reason))
        self.programs.append(program)
        return verdict

    def finish(self, verdict: Verdict) -> Verdict:
        try:
            return verdict if verdict.stage == _BROKEN else self.worker.call(_finish, self._state, verdict)
        except Broken:
            return verdict

    @property
    def _state(self) -> _State:
        return self.number, self.language, self.before, tuple(self.programs)


def _unjudged(program: str, reason: str) -> Verdict:
    feedback = (
        f"The program could not be judged: {reason}. Say it in another way, smaller or simpler, without "
        "giving up what it is to show, and answer with the whole program in one block."
    )
    return Verdict(False, _BROKEN, feedback, program, codes=(_BROKEN,), weight=(_LAST,))


_State: TypeAlias = tuple[int, Language, str | None, tuple[str, ...]]
"""The number of a conversation, its language, the program that it is to change, and those judged so far."""

_open: dict[tuple[int, int], Conversation] = {}
"""The present conversation, by its number and that of the programs judged."""


def _resumed(state: _State) -> Conversation:
    """Returns the conversation of a state, which is the present one no more."""
    number, language, before, programs = state
    conversation = _open.pop((number, len(programs)), None)
    _open.clear()
    if conversation is None:
        conversation = language.conversation(before)
        for program in programs:
            conversation.judge(program)
    return conversation


def _judge(state: _State, program: str) -> Verdict:
    conversation = _resumed(state)
    verdict = conversation.judge(program)
    _open[state[0], len(state[-1]) + 1] = conversation
    return replace(verdict, compiled=None)


def _finish(state: _State, verdict: Verdict) -> Verdict:
    return replace(_resumed(state).finish(verdict), compiled=None)
