from __future__ import annotations

from collections.abc import AsyncIterator
from pathlib import Path

import pytest_lsp

from server.tests.lsp.editor import CONFIG, Editor, greet


@pytest_lsp.fixture(config=CONFIG, scope="session")
async def editor(client: Editor) -> AsyncIterator[None]:
    """One server for all tests: it takes seconds to start. Below its folder is no program to be searched."""
    await greet(client, Path(__file__).parent)
    yield
    await client.shutdown_session()
