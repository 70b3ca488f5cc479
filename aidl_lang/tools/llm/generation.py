"""The loop from a request to a right program: ask, check, answer, ask again."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, field
from functools import partial
from itertools import groupby
from typing import Any

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import counted, first_few, short, ticked
from aidl_lang.common.records import record
from aidl_lang.common.render import compact
from aidl_lang.geometry.freedom import report
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.llm.intent.placing import CONTACTS
from aidl_lang.tools.llm.messages import (
    ConversationOver,
    Finish,
    Image,
    Language,
    Message,
    Provider,
    ProviderError,
    Reply,
    Sampling,
    Usage,
    Verdict,
    find_program,
)

# --- Feedback to a model on its program: errors, fixes made, remaining motions.

STAGES = ("syntax", "types", "validity", "solve", "asserts", "contacts", "done")
"""The checks of a program, in order."""

_STAGE_OF = {
    "01": "syntax",
    "02": "types",
    "03": "types",
    "06": "solve",
    "E0604": "asserts",
    **dict.fromkeys(CONTACTS, "contacts"),
}
"""By code, or else by family; others fail `validity`."""
_MOST = 12
"""Most motions and boxes in the feedback."""


def stage_of(diagnostics: Iterable[Diagnostic]) -> str:
    """Returns the first stage that fails; remarks on parts that touch nothing fail `contacts`."""
    codes = (d.code for d in diagnostics if d.is_error or d.code in CONTACTS)
    failing = {_STAGE_OF.get(code) or _STAGE_OF.get(code[1:3], "validity") for code in codes}
    return next((stage for stage in STAGES if stage in failing), "done")


def errors(compiled: Compiled) -> str:
    """Describes the errors and, if the solver failed, the freedom that the rest leaves."""
    wrong = [d for d in compiled.diagnostics if d.is_error]
    stage = stage_of(wrong)
    count = counted(len(wrong), "error")
    blocks = [f"The program is wrong: {count}, the first of them in the check of {stage}.", compact(wrong)]
    if stage == "solve" and compiled.model is not None:
        degrees = "unknown" if compiled.model.degrees is None else compiled.model.degrees
        motions = report(compiled.model, _MOST)
        left = f"Degrees of freedom left beside these constraints: {degrees}"
        blocks.append("\n- ".join([left, *motions]))
    return "\n\n".join(blocks)


def remarks(compiled: Compiled, *, may_constrain: bool) -> str:
    """Returns warnings, and structures that nothing ties to the rest; "" if there are none."""
    warnings = [d for d in compiled.diagnostics if d.code.startswith("W")]
    floating = floats(compiled.model) if may_constrain and compiled.model is not None else ()
    blocks = [compact(warnings)] if warnings else []
    if floating:
        names = first_few(ticked(floating), _MOST, ", …")
        verb, stands = ("floats", "it stands") if len(floating) == 1 else ("float", "they stand")
        blocks.append(
            f"warning: {names} {verb}: no constraint speaks of where, so {stands} as first guessed. Say how "
            "parts lie to each other, as in `a.above(b, gap: 2)` or `centered_in(a, b)`"
        )
    return "\n\n".join(blocks)


def floats(model: SolvedModel) -> tuple[str, ...]:
    """Returns paths, without the root, of structures that no constraint places."""
    return tuple(path.removeprefix(f"{model.root.path}.") for path in model.mobility().floating)


def mended(before: str, after: str, titles: Sequence[str]) -> str:
    """Returns the changes made in the program before it was checked, as lines."""
    if before == after:
        return ""
    counts = ", ".join(
        f"{title} ({n} times)" if n > 1 else title
        for title, n in ((key, len(list(group))) for key, group in groupby(titles))
    )
    return (
        f"These fixes were made to your program already; keep them: {counts}. Lines count as after them.\n"
        + "\n".join(_changed(before.splitlines(), after.splitlines()))
    )


def _changed(before: Sequence[str], after: Sequence[str]) -> Iterator[str]:
    matcher = difflib.SequenceMatcher(None, before, after, autojunk=False)
    for kind, i, i_end, j, j_end in matcher.get_opcodes():
        if kind == "equal":
            continue
        yield from (f"  - {line.strip()}" for line in before[i:i_end])
        yield from (f"  + {number} | {after[number - 1].strip()}" for number in range(j + 1, j_end + 1))


def plan(model: SolvedModel) -> str:
    """Describes the state of a program to be continued: its structures with their boxes."""
    lines = ["So far it compiles. Boxes, in mm, in the frame of the root:"]
    structures = list(model.root.walk())
    lines += [f"- {_box(s)}" for s in structures[: 4 * _MOST]]
    if len(structures) > 4 * _MOST:
        lines.append(f"- and {len(structures) - 4 * _MOST} more")
    return "\n".join(lines)


def _box(structure: SolvedStructure) -> str:
    box = structure.box
    where = (
        f"x {short(box.left, 2)} to {short(box.right, 2)}, y {short(box.bottom, 2)} to {short(box.top, 2)}"
        if box
        else "no extent"
    )
    return f"{structure.kind} `{structure.path}`: {where}" + " (empty)" * structure.is_empty


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
    """The result of a task: the attempts, the verdict on the program kept (None without any program), the
    conversation as it was sent, and the reason why no further reply could be had.
    """

    task: Task
    attempts: tuple[Attempt, ...]
    verdict: Verdict | None
    messages: tuple[Message, ...]
    failure: Diagnostic | None = None

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
    """Runs the conversation. `hear` gets an attempt's text in pieces, `listen` the state after each."""
    settings, conversation = settings or Settings(), language.conversation(task.program)
    images = (task.image,) if task.image else ()
    messages = [Message("system", language.guide()), Message("user", _request(task, language), images)]
    attempts: list[Attempt] = []
    failure, number = None, 0
    try:
        while not attempts or attempts[-1].answer:
            step = len(attempts) + 1
            reply = provider.reply(messages, settings.sampling, partial(hear, step))
            messages.append(Message("assistant", reply.text.strip() or "(nothing)"))
            program, is_open = find_program(reply.text, language.fences, language.reads)
            verdict = None
            if program is None or (reply.finish is Finish.CUT and is_open):
                program, answer = None, _without_program(language.fences[0], reply, is_open)
            else:
                verdict = conversation.judge(program)
                answer = verdict.feedback
            number += not (verdict is not None and verdict.is_partial)
            is_last = number >= settings.attempts or step >= 2 * settings.attempts
            if reply.finish is Finish.REFUSED or is_last:
                answer = ""
            if answer:
                messages.append(Message("user", answer, verdict.images if verdict else ()))
            attempts.append(Attempt(step, reply, program, verdict, answer))
            listen(Generation(task, tuple(attempts), verdict, tuple(messages)))
    except ProviderError as reason:
        failure = reason.diagnostic
    except ConversationOver:
        pass  # what is there is all of it
    judged = [a.verdict for a in attempts if a.verdict is not None]
    best = min(reversed(judged), key=lambda verdict: verdict.weight, default=None)
    kept = conversation.finish(best) if best is not None else None
    return Generation(task, tuple(attempts), kept, tuple(messages), failure)


def _without_program(fence: str, reply: Reply, is_open: bool) -> str:
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


# --- A conversation as data: requests, replies and results.


def to_dict(generation: Generation, provider: str, language: str) -> dict[str, Any]:
    """Returns the conversation for JSON, pictures as data URIs, without keys and addresses of servers."""
    return {
        "aidl_transcript": 1,
        "provider": provider,
        "language": language,
        "request": generation.task.request,
        "before": generation.task.program,
        "messages": [_message(message) for message in generation.messages],
        "attempts": [_attempt(attempt) for attempt in generation.attempts],
        "result": generation.verdict and _verdict(generation.verdict),
        "failure": generation.failure.message if generation.failure else None,
        "usage": asdict(generation.usage),
    }


def _message(message: Message) -> dict[str, Any]:
    found: dict[str, Any] = {"role": message.role, "text": message.text}
    return found | ({"images": [image.uri for image in message.images]} if message.images else {})


def _attempt(attempt: Attempt) -> dict[str, Any]:
    return {
        "number": attempt.number,
        "model": attempt.reply.model,
        "finish": str(attempt.reply.finish),
        "usage": asdict(attempt.reply.usage),
        "program": attempt.program,
        "verdict": attempt.verdict and _verdict(attempt.verdict),
    }


def _verdict(verdict: Verdict) -> dict[str, Any]:
    return {
        "ok": verdict.ok,
        "stage": verdict.stage,
        "program": verdict.program,
        "fixes": list(verdict.fixes),
        "codes": list(verdict.codes),
        "partial": verdict.is_partial,
        "missing": list(verdict.missing),
        "numbers": dict(verdict.numbers),
    }
