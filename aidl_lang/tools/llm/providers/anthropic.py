"""Anthropic's messages API."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from aidl_lang.tools.llm.messages import Finish, Message, ProviderError, Sampling, Usage
from aidl_lang.tools.llm.providers.connection import Connection, Draft, count, dig, one_line, words
from aidl_lang.tools.llm.providers.server import Server

MAX_TOKENS = 8192
"""The default limit: the API wants one, and every model allows at least this."""

_FINISH = {"max_tokens": Finish.CUT, "model_context_window_exceeded": Finish.CUT, "refusal": Finish.REFUSED}
_INPUT = ("input_tokens", "cache_read_input_tokens", "cache_creation_input_tokens")


class Anthropic(Server):
    """The system prompt, which is long and the same every time, is kept in Anthropic's cache.

    The input counted is all that was read, from the cache or not.
    """

    kind = "anthropic"
    takes_seeds = False
    takes_grammars = False

    def __init__(self, connection: Connection) -> None:
        import anthropic

        from aidl_lang.tools.llm.providers import server

        client = anthropic.Anthropic(
            api_key=connection.key or "none",
            base_url=connection.base_url.removesuffix("/v1"),
            **server.options(connection),
        )
        super().__init__(anthropic, client, connection)

    def _send(self, messages: Sequence[Message], sampling: Sampling) -> Any:
        if sampling.seed is not None:
            raise ProviderError("E0935", "Anthropic's API takes no seed", "leave --seed out")
        system = "\n\n".join(message.text for message in messages if message.role == "system")
        cached = {"type": "text", "text": system, "cache_control": {"type": "ephemeral"}}
        # Older models take a temperature; the SDK no longer knows of it, and newer ones refuse it.
        heat = {} if sampling.temperature is None else {"temperature": sampling.temperature}
        return self._client.messages.create(
            model=self._model,
            max_tokens=sampling.max_tokens or MAX_TOKENS,
            messages=[_turn(message) for message in messages if message.role != "system"],
            stream=True,
            extra_body={**heat, **sampling.extra},
            **({"system": [cached]} if system else {}),
        )

    def _read(self, document: object, draft: Draft) -> None:
        match dig(document, "type"):
            case "message":  # of a server that does not stream
                self._start(document, draft)
                parts = dig(document, "content")
                for part in parts if isinstance(parts, list) else ():
                    draft.say(words(dig(part, "text")))
                self._end(dig(document, "stop_reason") or "end_turn", draft)
            case "message_start":
                self._start(dig(document, "message"), draft)
            case "content_block_start":
                draft.say(words(dig(document, "content_block", "text")))
            case "content_block_delta":
                draft.say(words(dig(document, "delta", "text")))
            case "message_delta":
                self._count(dig(document, "usage"), draft)
                self._end(dig(document, "delta", "stop_reason"), draft)

    def _start(self, message: object, draft: Draft) -> None:
        draft.started = True
        draft.model = one_line(dig(message, "model")) or draft.model
        self._count(dig(message, "usage"), draft)

    @staticmethod
    def _end(reason: object, draft: Draft) -> None:
        if reason:
            draft.finish = _FINISH.get(words(reason), Finish.COMPLETE)

    @staticmethod
    def _count(usage: object, draft: Draft) -> None:
        """Adds the counts of an event, which are running totals of those that have changed."""
        read = [n for name in _INPUT if (n := count(dig(usage, name))) is not None]
        written = count(dig(usage, "output_tokens"))
        known = draft.usage
        draft.usage = Usage(
            sum(read) if read else known.input, known.output if written is None else written, None
        )


def _turn(message: Message) -> dict[str, object]:
    pictures: list[dict[str, object]] = [
        {"type": "image", "source": {"type": "base64", "media_type": image.media_type, "data": image.base64}}
        for image in message.images
    ]
    text = message.text if message.text.strip() else "(nothing)"  # the API refuses an empty text
    return {"role": message.role, "content": [*pictures, {"type": "text", "text": text}]}
