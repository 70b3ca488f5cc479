"""A conversation as data: requests, replies and results."""

from __future__ import annotations

from typing import Any

from aidl_lang.tools.llm.generation import Attempt, Generation
from aidl_lang.tools.llm.language import Verdict
from aidl_lang.tools.llm.messages import Message, Usage


def to_dict(generation: Generation, provider: str, language: str) -> dict[str, Any]:
    """Returns the whole conversation for JSON; pictures are data URIs, and no key or address of a server is
    in it.
    """
    return {
        "aidl_transcript": 1,
        "provider": provider,
        "language": language,
        "request": generation.task.request,
        "before": generation.task.program,
        "messages": [_message(message) for message in generation.messages],
        "attempts": [_attempt(attempt) for attempt in generation.attempts],
        "result": verdict_to_dict(generation.verdict) if generation.verdict else None,
        "failure": generation.failure.message if generation.failure else None,
        "usage": usage_to_dict(generation.usage),
    }


def _message(message: Message) -> dict[str, Any]:
    found: dict[str, Any] = {"role": message.role, "text": message.text}
    return found | ({"images": [image.uri for image in message.images]} if message.images else {})


def _attempt(attempt: Attempt) -> dict[str, Any]:
    return {
        "number": attempt.number,
        "model": attempt.reply.model,
        "finish": str(attempt.reply.finish),
        "usage": usage_to_dict(attempt.reply.usage),
        "program": attempt.program,
        "verdict": verdict_to_dict(attempt.verdict) if attempt.verdict else None,
    }


def verdict_to_dict(verdict: Verdict) -> dict[str, Any]:
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


def usage_to_dict(usage: Usage) -> dict[str, Any]:
    return {"input": usage.input, "output": usage.output, "cost": usage.cost}
