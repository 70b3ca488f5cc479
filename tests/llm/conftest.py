"""Language models by script instead of real ones."""

from __future__ import annotations

import os
import ssl
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from aidl_lang.tools.cli import main
from tests.llm.scripted import Scripted

OWNERS = ("AIDL_", "ANTHROPIC_", "OPENAI_")
PROXIES = {"http_proxy", "https_proxy", "all_proxy"}


@pytest.fixture(autouse=True)
def _nothing_in_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """No test may ask a real model, or send a key that belongs to somebody. No server here has a certificate
    to be compared with all that there are, which take long to load.
    """
    monkeypatch.setattr(ssl, "create_default_context", lambda **_: ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT))
    for name in list(os.environ):
        if name.startswith(OWNERS) or name.lower() in PROXIES:
            monkeypatch.delenv(name)


@pytest.fixture
def scripted() -> Iterator[Callable[..., Scripted]]:
    """`scripted(["a reply", Limited(), ...])` starts a server that is closed when the test ends."""
    with ExitStack() as servers:

        def start(steps: Sequence[Any], **more: Any) -> Scripted:
            return servers.enter_context(Scripted(steps, **more))

        yield start


@pytest.fixture
def generate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, scripted: Callable[..., Scripted]
) -> Callable[..., tuple[int, Scripted]]:
    """Runs the command in a folder of its own against a script: its exit code and the server."""
    monkeypatch.chdir(tmp_path)

    def run(steps: Sequence[Any], *arguments: str) -> tuple[int, Scripted]:
        server = scripted(steps)
        for name, value in server.environment.items():
            monkeypatch.setenv(name, value)
        return main(["generate", "a plate with a bore", *arguments]), server

    return run
