"""`aidl lsp`: serve editors over the Language Server Protocol, on standard input and output."""

from __future__ import annotations

import argparse
from importlib.util import find_spec

from aidl_lang.tools.cli import listening
from aidl_lang.tools.cli.report import UseError, say

_CODE = "E0954"


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--tcp",
        type=_address,
        metavar="HOST:PORT",
        help="wait for one client at this address instead; port 0 takes one that is free",
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Returns the exit code of the protocol: 0 if the client has shut the server down before its exit."""
    if find_spec("pygls") is None:
        raise UseError(
            _CODE, "the server needs `pygls`, not installed here", "pip install 'aidl-lang[editor]'"
        )
    listener = None
    if arguments.tcp is not None:
        host, port = arguments.tcp
        listener = listening.listener(host, port, _CODE, "port 0 takes one that is free")

    from aidl_lang.tools.lsp.serve import serve_socket, serve_standard_streams

    if listener is None:
        return serve_standard_streams()
    host, port = listener.getsockname()[:2]
    say(f"{host}:{port}: waiting for a client")
    return serve_socket(listener)


def _address(text: str) -> tuple[str, int]:
    host, colon, port = text.rpartition(":")
    if not (host and colon and port.isdecimal() and int(port) <= 65535):
        raise argparse.ArgumentTypeError(f"expected HOST:PORT, as in 127.0.0.1:0, not `{text}`")
    return host.strip("[]"), int(port)
