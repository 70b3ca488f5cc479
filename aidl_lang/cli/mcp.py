"""`aidl mcp`: serve the tools to agents over the Model Context Protocol, on standard input and output."""

from __future__ import annotations

import argparse
import os
import socket
from importlib.util import find_spec
from pathlib import Path

from aidl_lang.cli.report import UseError, say

_HOST = "127.0.0.1"


def register(verbs: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = verbs.add_parser("mcp", help="serve the tools to agents", description=__doc__)
    parser.add_argument(
        "--root", metavar="DIR", help="let programs import files below this folder (default: no files at all)"
    )
    parser.add_argument(
        "--http",
        type=_port,
        metavar="PORT",
        help="serve over HTTP on this machine instead; 0 takes a port that is free",
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    _require_packages()
    root = _root(arguments.root)
    listener = None if arguments.http is None else _listener(arguments.http)

    from aidl_lang.agents.server import serve

    if listener is not None:
        say(f"http://{_HOST}:{listener.getsockname()[1]}/mcp: serving, stop with Ctrl-C")
    serve(root, listener)
    return 0


def _port(text: str) -> int:
    if not text.isdecimal() or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"expected a port from 0 to 65535, not `{text}`")
    return int(text)


def _require_packages() -> None:
    if find_spec("mcp") is None:
        raise UseError("E0942", "the server needs `mcp`, not installed here", "pip install 'aidl-lang[mcp]'")


def _root(name: str | None) -> Path | None:
    if name is not None and not Path(name).is_dir():
        raise UseError("E0942", f"there is no folder `{name}` to import from")
    return None if name is None else Path(name).resolve()


def _listener(port: int) -> socket.socket:
    listener = socket.socket()
    if os.name == "posix":  # elsewhere this would let two servers have one port
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((_HOST, port))
        listener.listen()  # so that who reads the address can connect at once
    except OSError as error:
        listener.close()
        why = (error.strerror or str(error)).lower()
        raise UseError(
            "E0942", f"port {port} cannot be served: {why}", "`--http 0` takes a port that is free"
        ) from None
    return listener
