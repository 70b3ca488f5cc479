from __future__ import annotations

from collections.abc import AsyncIterator

import pytest_lsp

from server.tests.lsp.editor import CONFIG, EXAMPLES, Editor, greet


@pytest_lsp.fixture(config=CONFIG, scope="session")
async def editor(client: Editor) -> AsyncIterator[None]:
    """One server for all tests: it takes seconds to start."""
    await greet(client, EXAMPLES)
    yield
    await client.shutdown_session()
