"""`aidl mcp`: serve the tools to agents over the Model Context Protocol, on standard input and output."""

from __future__ import annotations

import argparse
import os
import re
import secrets
from importlib.util import find_spec
from pathlib import Path

from aidl_lang.tools.cli import listening
from aidl_lang.tools.cli.report import UseError, say

_TOKEN = "AIDL_MCP_TOKEN"


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--root", metavar="DIR", help="let programs import files below this folder (default: no files at all)"
    )
    parser.add_argument(
        "--http",
        type=listening.port,
        metavar="PORT",
        help="serve over HTTP on this machine instead; 0 takes a port that is free",
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    _require_packages()
    root = _root(arguments.root)
    listener, path = None, f"/{_token()}/mcp"
    if arguments.http is not None:
        hint = "`--http 0` takes a port that is free"
        listener = listening.listener(listening.LOCALHOST, arguments.http, "E0942", hint)

    from aidl_lang.tools.agents.server import serve

    if listener is not None:
        say(f"serving at http://{listening.LOCALHOST}:{listener.getsockname()[1]}{path} until Ctrl-C")
    serve(root, listener, path)
    return 0


def _token() -> str:
    """Returns what stands in the address, so that nobody else on this machine knows it."""
    given = os.environ.get(_TOKEN)
    if given is None:
        return secrets.token_urlsafe(24)
    if not re.fullmatch(r"[A-Za-z0-9_-]{16,}", given):
        raise UseError("E0942", f"{_TOKEN} is no token", "it has 16 letters, digits, `-` and `_`, or more")
    return given


def _require_packages() -> None:
    if find_spec("mcp") is None:
        raise UseError("E0942", "the server needs `mcp`, not installed here", "pip install 'aidl-lang[mcp]'")


def _root(name: str | None) -> Path | None:
    if name is not None and not Path(name).is_dir():
        raise UseError("E0942", f"there is no folder `{name}` to import from")
    return None if name is None else Path(name).resolve()
