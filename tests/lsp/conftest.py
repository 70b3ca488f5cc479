from __future__ import annotations

from collections.abc import AsyncIterator

import pytest
import pytest_lsp

from tests.lsp.editor import CONFIG, EXAMPLES, Editor, greet


@pytest_lsp.fixture(config=CONFIG, scope="module")
async def editor(client: Editor, request: pytest.FixtureRequest) -> AsyncIterator[None]:
    """One server for the tests of a file, which cost a second to start, with the programs of its `ROOM`."""
    await greet(client, getattr(request.module, "ROOM", EXAMPLES))
    yield
    await client.shutdown_session()
