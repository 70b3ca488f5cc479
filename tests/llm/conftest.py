"""Language models by script instead of real ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from typing import Any

import pytest

from tests.llm.scripted import Scripted

VARIABLES = (
    "AIDL_MODEL",
    "AIDL_PRICE",
    "AIDL_PROVIDER",
    "ANTHROPIC_API_KEY",
    "ANTHROPIC_BASE_URL",
    "OPENAI_API_KEY",
    "OPENAI_BASE_URL",
)


@pytest.fixture(autouse=True)
def _nothing_in_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """No test may ask a real model, or send a key that belongs to somebody."""
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    for name in ("http_proxy", "https_proxy", "all_proxy"):
        monkeypatch.delenv(name, raising=False)
        monkeypatch.delenv(name.upper(), raising=False)


@pytest.fixture
def scripted() -> Iterator[Callable[..., Scripted]]:
    """`scripted(["a reply", Limited(), ...])` starts a server that is closed when the test ends."""
    with ExitStack() as servers:

        def start(steps: Sequence[Any], **more: Any) -> Scripted:
            return servers.enter_context(Scripted(steps, **more))

        yield start
