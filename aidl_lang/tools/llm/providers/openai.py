"""Servers that speak OpenAI's chat protocol: OpenAI, OpenRouter, Ollama, vLLM, llama.cpp and others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import urlsplit

from aidl_lang.tools.llm.messages import Finish, Message, Sampling, Usage
from aidl_lang.tools.llm.providers.connection import Connection, Draft, count, dig, dollars, one_line, words
from aidl_lang.tools.llm.providers.server import Server

_FINISH = {"length": Finish.CUT, "content_filter": Finish.REFUSED}
_LIMITS = ("max_tokens", "max_completion_tokens")
_NEWER = ("api.openai.com", ".openai.azure.com")


class OpenAI(Server):
    """The limit on tokens has two names.

    Newer models of OpenAI refuse the old one, and many servers do not know the new one: the host decides, and
    the new one is used when a server asks for it.
    """

    kind = "openai"

    def __init__(self, connection: Connection) -> None:
        import openai

        from aidl_lang.tools.llm.providers import server

        client = openai.OpenAI(
            api_key=connection.key or "none", base_url=connection.base_url, **server.options(connection)
        )
        host = urlsplit(connection.base_url).hostname or ""
        self._limit = _LIMITS[host.endswith(_NEWER)]
        self._tells_usage = True
        super().__init__(openai, client, connection)

    def _send(self, messages: Sequence[Message], sampling: Sampling) -> Any:
        said = [{"role": message.role, "content": _content(message)} for message in messages]
        for _ in range(3):
            options = self._options(sampling)
            try:
                return self._client.chat.completions.create(
                    model=self._model, messages=said, stream=True, extra_body=dict(sampling.extra), **options
                )
            except (self._sdk.BadRequestError, self._sdk.UnprocessableEntityError) as error:
                if not self._adapt(self._words(error.body), options):
                    raise
        raise AssertionError("it adapts twice at most")

    def _options(self, sampling: Sampling) -> dict[str, object]:
        options: dict[str, object] = {
            "seed": sampling.seed,
            "temperature": sampling.temperature,
            self._limit: sampling.max_tokens,
            "stream_options": {"include_usage": True} if self._tells_usage else None,
        }
        return {name: value for name, value in options.items() if value is not None}

    def _adapt(self, said: str, sent: Mapping[str, object]) -> bool:
        """Drops what a server refused from further requests, if it is a matter of the protocol."""
        if "stream_options" in said and "stream_options" in sent:
            self._tells_usage = False
            return True
        if "max_tokens" in sent and "max_completion_tokens" in said:
            self._limit = "max_completion_tokens"
            return True
        return False

    def _read(self, document: object, draft: Draft) -> None:
        choice = dig(document, "choices", 0)
        said = dig(choice, "delta") or dig(choice, "message")
        draft.started |= isinstance(dig(document, "choices"), list)
        draft.model = one_line(dig(document, "model")) or draft.model
        draft.say(_text(dig(said, "content")))
        if refusal := words(dig(said, "refusal")):
            draft.say(refusal)
            draft.finish = Finish.REFUSED
        self._read_end(document, choice, draft)

    def _read_end(self, document: object, choice: object, draft: Draft) -> None:
        self._refuse_error(choice)
        reason = words(dig(choice, "finish_reason"))
        is_whole = dig(choice, "message") is not None
        if reason or is_whole:
            draft.finish = draft.finish or _FINISH.get(reason, Finish.COMPLETE)
        if usage := dig(document, "usage"):
            draft.usage = Usage(
                count(dig(usage, "prompt_tokens")),
                count(dig(usage, "completion_tokens")),
                dollars(dig(usage, "cost")),
            )


def _content(message: Message) -> str | list[dict[str, object]]:
    """Returns text alone as a string, which is all that some servers take."""
    if not message.images:
        return message.text
    pictures: list[dict[str, object]] = [
        {"type": "image_url", "image_url": {"url": image.uri}} for image in message.images
    ]
    return [*pictures, {"type": "text", "text": message.text}]


def _text(content: object) -> str:
    """Returns the text of a content that is a string, or a list of parts, of which some may be reasoning."""
    if isinstance(content, list):
        return "".join(words(dig(part, "text")) for part in content if dig(part, "type") == "text")
    return words(content)
