"""A real small language model on loopback, behind llama.cpp's own server.

The tests are there only when AIDL_TEST_MODEL names the folder that `install.py` has filled.
"""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import httpx2
import pytest

from tests.llm.conftest import _nothing_in_the_environment as _nothing_in_the_environment
from tests.model.install import Installed
from tests.sweep.cluster import free_port

FOLDER = os.environ.get("AIDL_TEST_MODEL", "")
collect_ignore_glob = [] if FOLDER else ["test_*.py"]

CONTEXT = 2048
THREADS = 1
"""More of them wait for each other as soon as anything else runs on the machine."""


@pytest.fixture(scope="session")
def installed() -> Installed:
    return Installed(Path(FOLDER))


@pytest.fixture(scope="session")
def address(installed: Installed, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The base URL of a server that has loaded the model."""
    port = free_port()
    log = tmp_path_factory.mktemp("server") / "log"
    command = [installed.server, "-m", installed.model, "--host", "127.0.0.1", "--port", port]
    options = ["-c", CONTEXT, "-np", 1, "-t", THREADS, "-a", "smollm2-135m", "--offline"]
    with log.open("w") as file:
        process = subprocess.Popen([*map(str, command + options)], stdout=file, stderr=file)
    try:
        for _ in range(600):
            if process.poll() is not None or _is_ready(port):
                break
            time.sleep(0.2)
        assert process.poll() is None, log.read_text()
        assert _is_ready(port), log.read_text()
        yield f"http://127.0.0.1:{port}/v1"
    finally:
        process.terminate()
        process.wait()


def _is_ready(port: int) -> bool:
    try:
        return httpx2.get(f"http://127.0.0.1:{port}/health").status_code == 200
    except httpx2.HTTPError:
        return False
