"""The loop from a request to a right program: ask, check, answer, ask again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import field

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.tools.llm.language import Conversation, Language, Verdict
from aidl_lang.tools.llm.messages import (
    ConversationOver,
    Finish,
    Image,
    Message,
    Provider,
    ProviderError,
    Reply,
    Sampling,
    Usage,
)
from aidl_lang.tools.llm.replies import find_program


@record()
class Task:
    """A request. With a `program` it is a change to that."""

    request: str
    image: Image | None = None
    program: str | None = None


@record()
class Settings:
    """`attempts` bounds the replies; as many again may only fill in what an earlier one planned."""

    attempts: int = 5
    sampling: Sampling = field(default_factory=Sampling)


@record()
class Attempt:
    """One reply and its result. Without a verdict it held no program, or not the whole of one."""

    number: int
    reply: Reply
    program: str | None
    verdict: Verdict | None
    answer: str
    """The answer to the model; empty after the last one."""


@record()
class Generation:
    """The result of a task: the attempts, and the verdict on the program kept (None without any program)."""

    task: Task
    attempts: tuple[Attempt, ...]
    verdict: Verdict | None
    messages: tuple[Message, ...]
    """The conversation as it was sent."""

    failure: Diagnostic | None = None
    """The reason why no further reply could be had."""

    @property
    def ok(self) -> bool:
        return self.verdict is not None and self.verdict.ok

    @property
    def usage(self) -> Usage:
        return sum((attempt.reply.usage for attempt in self.attempts), Usage())


def generate(
    task: Task,
    provider: Provider,
    language: Language,
    settings: Settings | None = None,
    hear: Callable[[int, str], None] = lambda attempt, text: None,
    listen: Callable[[Generation], None] = lambda generation: None,
) -> Generation:
    """Runs the conversation. `hear` gets the text of an attempt piece by piece, `listen` the state after each
    attempt.
    """
    run = _Run(task, provider, language, settings or Settings(), hear)
    attempts: list[Attempt] = []
    failure = None
    try:
        for attempt in run.attempts():
            attempts.append(attempt)
            listen(Generation(task, tuple(attempts), attempt.verdict, tuple(run.messages)))
    except ProviderError as reason:
        failure = reason.diagnostic
    except ConversationOver:
        pass  # what is there is all of it
    judged = [a.verdict for a in attempts if a.verdict is not None]
    best = min(reversed(judged), key=lambda verdict: verdict.weight, default=None)
    verdict = run.conversation.finish(best) if best is not None else None
    return Generation(task, tuple(attempts), verdict, tuple(run.messages), failure)


class _Run:
    """One conversation under way."""

    def __init__(
        self,
        task: Task,
        provider: Provider,
        language: Language,
        settings: Settings,
        hear: Callable[[int, str], None],
    ) -> None:
        self.provider, self.language, self.settings, self.hear = provider, language, settings, hear
        self.conversation: Conversation = language.conversation(task.program)
        images = (task.image,) if task.image else ()
        self.messages = [
            Message("system", language.guide()),
            Message("user", _request(task, language), images),
        ]

    def attempts(self) -> Iterator[Attempt]:
        """Yields replies with the answers to them, until nothing is left to answer."""
        number = steps = 0
        while number < self.settings.attempts and steps < 2 * self.settings.attempts:
            attempt = self._attempt(steps + 1)
            steps += 1
            number += not (attempt.verdict is not None and attempt.verdict.is_partial)
            is_last = number == self.settings.attempts or steps == 2 * self.settings.attempts
            if attempt.reply.finish is Finish.REFUSED or is_last or not attempt.answer:
                yield Attempt(steps, attempt.reply, attempt.program, attempt.verdict, "")
                return
            images = attempt.verdict.images if attempt.verdict else ()
            self.messages.append(Message("user", attempt.answer, images))
            yield attempt

    def _attempt(self, number: int) -> Attempt:
        def hear(text: str) -> None:
            self.hear(number, text)

        reply = self.provider.reply(self.messages, self.settings.sampling, hear)
        self.messages.append(Message("assistant", reply.text.strip() or "(nothing)"))
        found = find_program(reply.text, self.language.fences, self.language.reads)
        if found.program is None or (reply.finish is Finish.CUT and found.is_open):
            return Attempt(number, reply, None, None, self._without_program(reply, found.is_open))
        verdict = self.conversation.judge(found.program)
        return Attempt(number, reply, found.program, verdict, verdict.feedback)

    def _without_program(self, reply: Reply, is_open: bool) -> str:
        fence = self.language.fences[0]
        if reply.finish is Finish.CUT:
            return (
                "Your reply was cut off at the limit on its length, before its program ended. Think less, or "
                f"write the program shorter, and answer with the whole of it in one ```{fence} block."
            )
        if is_open:
            return f"The last block is not closed. Answer with the whole program between ```{fence} and ```."
        return f"Your reply holds no program. End it with the whole program in one ```{fence} block."


def _request(task: Task, language: Language) -> str:
    fence = language.fences[0]
    picture = "The picture shows what is meant.\n\n" if task.image else ""
    if task.program is None:
        return (
            f"{picture}Write a program that draws this: {task.request}\n\nYou may think first. The last "
            f"```{fence} block is taken as the program. Name parts by what they are."
        )
    return (
        f"{picture}Here is a program:\n\n```{fence}\n{task.program.rstrip()}\n```\n\nChange this about it: "
        f"{task.request}\n\nChange nothing else, neither names nor order nor comments. Answer with the "
        f"whole changed program in one ```{fence} block."
    )
