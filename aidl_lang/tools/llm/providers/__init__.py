"""Providers: servers that speak OpenAI's protocol, Anthropic's, or a command."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Protocol

from aidl_lang.tools.llm.messages import Provider, ProviderError
from aidl_lang.tools.llm.providers.connection import ANTHROPIC, EXEC, Connection, Price, decide

__all__ = ["Closable", "Connection", "Price", "connect"]


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
        if connection.provider == ANTHROPIC:
            from aidl_lang.tools.llm.providers.server import Anthropic

            return Anthropic(connection)
        from aidl_lang.tools.llm.providers.server import OpenAI

        return OpenAI(connection)
    except ImportError as error:
        missing = f"the package `{error.name}` is not installed" if error.name else str(error)
        raise ProviderError("E0931", missing, "pip install 'aidl-lang[models]'") from None
