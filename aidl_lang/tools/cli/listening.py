"""Local ports that verbs serve on."""

from __future__ import annotations

import argparse
import os
import socket
from importlib.util import find_spec

from aidl_lang.common.prose import ticked
from aidl_lang.tools.cli.report import UseError

LOCALHOST = "127.0.0.1"


def port(text: str) -> int:
    """Parses the port of an option."""
    if not (text.isascii() and text.isdecimal()) or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"expected a port from 0 to 65535, not `{text}`")
    return int(text)


def address(text: str) -> str:
    """Parses the address of an option: one that no other machine can reach."""
    from ipaddress import ip_address

    if text.lower() == "localhost":
        return LOCALHOST
    try:
        is_here = ip_address(text).is_loopback
    except ValueError:
        is_here = False
    if not is_here:
        raise argparse.ArgumentTypeError(
            f"expected an address of this machine alone, as {LOCALHOST} or ::1, not `{text}`"
        )
    return text


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds where a page is served, and whether the browser is opened."""
    parser.add_argument(
        "--port", type=port, default=0, metavar="N", help="the port (default: one that is free)"
    )
    parser.add_argument(
        "--host",
        type=address,
        default=LOCALHOST,
        metavar="ADDRESS",
        help=f"an address of this machine alone (default: {LOCALHOST})",
    )
    parser.add_argument("--no-open", action="store_true", help="do not open the browser")


def require(what: str, *packages: str) -> None:
    """Raises UseError if what serves pages is not installed."""
    missing = [name for name in packages if find_spec(name) is None]
    if missing:
        message = f"{what} needs {', '.join(ticked(missing))}, not installed here"
        raise UseError("E0952", message, "pip install 'aidl-lang[editor]'")


def open_browser(url: str) -> None:
    """Opens the browser; some of those for terminals return only when they are closed."""
    import threading
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()


def listener(host: str, port: int, code: str, hint: str) -> socket.socket:
    """Returns a socket that accepts connections already. Raises UseError with a code if there can be none."""
    try:
        family, kind, protocol, _, at = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        found = socket.socket(family, kind, protocol)
    except OSError as error:
        raise _refused(host, port, error, code, hint) from None
    if os.name == "posix":  # elsewhere this would let two servers have one port
        found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        found.bind(at)
        found.listen()  # so that who reads the address can connect at once
    except OSError as error:
        found.close()
        raise _refused(host, port, error, code, hint) from None
    return found


def _refused(host: str, port: int, error: OSError, code: str, hint: str) -> UseError:
    where = f"port {port}" if host == LOCALHOST else f"{host}:{port}"
    return UseError(code, f"{where} cannot be served: {(error.strerror or str(error)).lower()}", hint)
