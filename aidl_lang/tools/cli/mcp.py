"""`aidl mcp`: serve the tools to agents over the Model Context Protocol, on standard input and output."""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from pathlib import Path

from aidl_lang.tools.cli import listening
from aidl_lang.tools.cli.report import UseError, say


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
    listener = None
    if arguments.http is not None:
        hint = "`--http 0` takes a port that is free"
        listener = listening.listener(listening.LOCALHOST, arguments.http, "E0942", hint)

    from aidl_lang.tools.agents.server import serve

    if listener is not None:
        say(f"http://{listening.LOCALHOST}:{listener.getsockname()[1]}/mcp: serving, stop with Ctrl-C")
    serve(root, listener)
    return 0


def _require_packages() -> None:
    if find_spec("mcp") is None:
        raise UseError("E0942", "the server needs `mcp`, not installed here", "pip install 'aidl-lang[mcp]'")


def _root(name: str | None) -> Path | None:
    if name is not None and not Path(name).is_dir():
        raise UseError("E0942", f"there is no folder `{name}` to import from")
    return None if name is None else Path(name).resolve()
