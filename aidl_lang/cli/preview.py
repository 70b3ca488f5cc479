"""`aidl preview`: a program drawn in the browser beside any editor, again on every save."""

from __future__ import annotations

import argparse
import os
import socket
import threading
import webbrowser
from importlib.util import find_spec
from ipaddress import ip_address
from pathlib import Path

from aidl_lang.cli import files
from aidl_lang.cli.options import add_program
from aidl_lang.cli.report import UseError, say

_NEEDED = ("starlette", "uvicorn", "websockets")
_LOCALHOST = "127.0.0.1"


def register(verbs: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = verbs.add_parser(
        "preview",
        help="show a program in the browser, and change it there",
        description=__doc__,
        epilog="Sliders and points that are dragged change the text of the file. Only this machine, and who "
        "has the address that is printed, can see it.",
    )
    add_program(parser)
    parser.add_argument(
        "--port", type=_port, default=0, metavar="N", help="the port (default: one that is free)"
    )
    parser.add_argument(
        "--host",
        type=_address,
        default=_LOCALHOST,
        metavar="ADDRESS",
        help=f"an address of this machine alone (default: {_LOCALHOST})",
    )
    parser.add_argument("--no-open", action="store_true", help="do not open the browser")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Runs until interrupted."""
    _require_packages()
    if arguments.file == files.STANDARD:
        raise UseError("E0902", "standard input cannot be watched", "name a file")
    files.read(arguments.file)
    listener = _listener(arguments.host, arguments.port)

    from aidl_lang.preview.serving import Served

    served = Served(Path(arguments.file).resolve(), _write, listener)
    say(f"{served.url}: {arguments.file}, stop with Ctrl-C")
    if not arguments.no_open:
        # Some browsers of terminals return only when they are closed.
        threading.Thread(target=webbrowser.open, args=(served.url,), daemon=True).start()
    served.run()
    return 0


def _write(path: Path, data: bytes) -> None:
    try:
        files.write(str(path), data)
    except UseError as reason:
        raise OSError(reason.diagnostic.message) from None


def _port(text: str) -> int:
    if not (text.isascii() and text.isdecimal()) or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"expected a port from 0 to 65535, not `{text}`")
    return int(text)


def _address(text: str) -> str:
    """An address that no other machine can reach."""
    if text.lower() == "localhost":
        return _LOCALHOST
    try:
        is_here = ip_address(text).is_loopback
    except ValueError:
        is_here = False
    if not is_here:
        raise argparse.ArgumentTypeError(
            f"expected an address of this machine alone, as {_LOCALHOST} or ::1, not `{text}`"
        )
    return text


def _require_packages() -> None:
    missing = [name for name in _NEEDED if find_spec(name) is None]
    if missing:
        names = ", ".join(f"`{name}`" for name in missing)
        raise UseError(
            "E0952", f"the preview needs {names}, not installed here", "pip install 'aidl-lang[editor]'"
        )


def _listener(host: str, port: int) -> socket.socket:
    listener = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
    if os.name == "posix":  # elsewhere this would let two servers have one port
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((host, port))
        listener.listen()  # so that the browser can connect at once
    except OSError as error:
        listener.close()
        why = (error.strerror or str(error)).lower()
        raise UseError(
            "E0953", f"port {port} cannot be served: {why}", "without `--port` a free one is taken"
        ) from None
    return listener
