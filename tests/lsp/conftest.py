from __future__ import annotations

from collections.abc import AsyncIterator

import pytest_lsp

from tests.lsp.editor import CONFIG, EXAMPLES, Editor, greet


@pytest_lsp.fixture(config=CONFIG, scope="module")
async def editor(client: Editor) -> AsyncIterator[None]:
    """One server for the tests of a file, as they cost a second to start."""
    await greet(client, EXAMPLES)
    yield
    await client.shutdown_session()
