"""Providers: servers that speak OpenAI's protocol, Anthropic's, or a command; and constrained decoding."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Protocol

from aidl_lang.common.diagnostics import has_errors
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.tools.grammars import export
from aidl_lang.tools.llm.messages import Finish, Message, Provider, ProviderError, Reply, Sampling
from aidl_lang.tools.llm.providers.connection import ANTHROPIC, EXEC, Connection, Price, decide

__all__ = ["SERVERS", "Closable", "Connection", "Constrained", "Price", "connect", "members"]


class Closable(Provider, Protocol):
    def close(self) -> None:
        """Releases connections; without it they go with the object."""


def connect(said: Connection, environment: Mapping[str, str] = os.environ) -> Closable:
    """Returns the provider that options and environment name; raises ProviderError if they name none.

    Without a model a server of one's own is asked for its list, and its one model is taken; `name` tells it.
    """
    connection = decide(said, environment)
    if connection.provider.startswith(EXEC):
        from aidl_lang.tools.llm.providers.command import Command

        return Command(connection)
    try:
        from aidl_lang.tools.llm.providers.server import Anthropic, OpenAI

        return (Anthropic if connection.provider == ANTHROPIC else OpenAI)(connection)
    except ImportError as error:
        missing = f"the package `{error.name}` is not installed" if error.name else str(error)
        raise ProviderError("E0931", missing, "pip install 'aidl-lang[models]'") from None


# --- Constrained decoding: the grammar goes with each request, in the form that a kind of server reads.

_MEMBERS: dict[str, Callable[[str], dict[str, object]]] = {
    "llama.cpp": lambda grammar: {"grammar": grammar},
    "sglang": lambda grammar: {"ebnf": grammar},
    "vllm": lambda grammar: {"structured_outputs": {"grammar": grammar}},
}
_ENGINE = ":llguidance"
SERVERS = (*_MEMBERS, *(kind + _ENGINE for kind in _MEMBERS))
"""Kinds of servers: plain, and with llguidance as the engine that decodes."""

_REPLY = re.compile(r"(?:(?!```).)*^```aidl\r?\n(?P<program>.*)```\s*", re.M | re.S)


def members(server: str, fenced: bool = True) -> Mapping[str, object]:
    """Returns more members of a request to one of SERVERS; without `fenced` the reply is a bare program."""
    format = "llguidance" if server.endswith(_ENGINE) else "gbnf"
    return _MEMBERS[server.removesuffix(_ENGINE)](export(format, fenced))


class Constrained:
    """A provider whose server keeps the model to the grammar, free text first.

    Servers ignore members of a request that they do not know. So a complete reply is checked, and one that
    the grammar does not allow is an error.
    """

    def __init__(self, provider: Closable, server: str) -> None:
        """Raises ProviderError for a provider that takes no grammar."""
        if not provider.takes_grammars:
            raise ProviderError("E0950", f"{provider.name} takes no grammar", "leave --constrain out")
        self.name = f"{provider.name} (constrained: {server})"
        self.takes_seeds, self.takes_grammars = provider.takes_seeds, True
        self._provider = provider
        self._members = members(server)

    def close(self) -> None:
        self._provider.close()

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        asked = replace(sampling, extra={**sampling.extra, **self._members})
        reply = self._provider.reply(messages, asked, hear)
        if reply.finish is Finish.COMPLETE and not _keeps_to_the_grammar(reply.text):
            raise ProviderError(
                "E0951",
                f"the reply of {self._provider.name} does not keep to the grammar: "
                f"`{', '.join(self._members)}` in the request was not heeded",
                f"does --constrain name the kind of server that answers? It knows {', '.join(SERVERS)}",
                "without --constrain, mistakes of syntax are told to the model",
            )
        return reply


def _keeps_to_the_grammar(text: str) -> bool:
    """True for a reply of free text and one block, whose program has no errors of syntax."""
    found = _REPLY.fullmatch(text)
    return found is not None and not has_errors(parse(SourceFile("", found["program"])).diagnostics)
