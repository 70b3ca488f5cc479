from __future__ import annotations

from collections.abc import AsyncIterator
from pathlib import Path

import pytest_asyncio
import pytest_lsp

from server.tests.lsp.editor import CONFIG, TELEPHONE, Editor, greet


@pytest_lsp.fixture(config=CONFIG, scope="session")
async def started(client: Editor) -> AsyncIterator[None]:
    """One server for all tests: it takes seconds to start. Below its folder is no program to be searched."""
    await greet(client, Path(__file__).parent)
    yield
    await client.shutdown_session()


@pytest_asyncio.fixture(loop_scope="session")
async def editor(started: Editor) -> AsyncIterator[Editor]:
    """What a test leaves open is closed, but for the telephone, at which many look."""
    yield started
    for uri in started.texts.keys() - {TELEPHONE.as_uri()}:
        started.close(uri)
