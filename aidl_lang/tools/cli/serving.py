"""`aidl preview`, `aidl lsp` and `aidl mcp`: verbs that serve, and their local ports."""

from __future__ import annotations

import argparse
import os
import re
import secrets
import socket
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, say
from aidl_lang.tools.cli.options import add_program, flag, value

LOCALHOST = "127.0.0.1"
_SERVER = "aidl_server"
"""A distribution of its own, which stands on this one; so it is known by its name alone."""


def port(text: str) -> int:
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
    value(parser, "--port", "N", "the port (default: one that is free)", port, 0)
    about = f"an address of this machine alone (default: {LOCALHOST})"
    value(parser, "--host", "ADDRESS", about, address, LOCALHOST)
    flag(parser, "--no-open", "do not open the browser")


def require(what: str, package: str, code: str = "E0952", extra: str = "editor") -> None:
    """Raises UseError if what serves is not installed."""
    if find_spec(package) is None:
        message = f"{what} needs `{package}`, not installed here"
        raise UseError(code, message, f"pip install 'aidl-lang[{extra}]'")


def open_browser(url: str) -> None:
    """Opens the browser; some of those for terminals return only when they are closed."""
    import threading
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()


def listen(host: str, port: int, code: str, hint: str) -> socket.socket:
    """Returns a socket that accepts connections already. Raises UseError with a code if there can be none."""
    try:
        family, *_, at = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        is_both = family is socket.AF_INET6 and socket.has_dualstack_ipv6()
        return socket.create_server(at, family=family, dualstack_ipv6=is_both)
    except OSError as error:
        where = f"port {port}" if host == LOCALHOST else f"{host}:{port}"
        why = (error.strerror or str(error)).partition(" (while")[0].lower()  # of which address is said
        raise UseError(code, f"{where} cannot be served: {why}", hint) from None


def register_preview(parser: argparse.ArgumentParser) -> None:
    """`aidl preview`: a program drawn in the browser beside any editor, again on every save."""
    parser.epilog = (
        "Sliders and points that are dragged change the text of the file. Only this machine, and who has the "
        "address that is printed, can see it."
    )
    add_program(parser)
    add_options(parser)


def run_preview(arguments: argparse.Namespace) -> int:
    require("the preview", _SERVER)
    files.require_watchable(arguments.file)
    listener = listen(arguments.host, arguments.port, "E0953", "without `--port` a free one is taken")
    import_module(f"{_SERVER}.command").preview(arguments, listener)
    return 0


_CODE = "E0954"


def register_lsp(parser: argparse.ArgumentParser) -> None:
    """`aidl lsp`: serve editors over the Language Server Protocol, on standard input and output."""
    about = "wait for one client at this address instead; port 0 takes one that is free"
    value(parser, "--tcp", "HOST:PORT", about, _address)


def run_lsp(arguments: argparse.Namespace) -> int:
    """Returns the exit code of the protocol: 0 if the client has shut the server down before its exit."""
    require("the server", _SERVER, code=_CODE)
    listener = None
    if arguments.tcp is not None:
        host, port = arguments.tcp
        listener = listen(host, port, _CODE, "port 0 takes one that is free")
    server = import_module(f"{_SERVER}.lsp.serve")
    if listener is None:
        return int(server.serve_standard_streams())
    host, port = listener.getsockname()[:2]
    say(f"{host}:{port}: waiting for a client")
    return int(server.serve_socket(listener))


def _address(text: str) -> tuple[str, int]:
    host, colon, port = text.rpartition(":")
    if not (host and colon and port.isdecimal() and int(port) <= 65535):
        raise argparse.ArgumentTypeError(f"expected HOST:PORT, as in 127.0.0.1:0, not `{text}`")
    return host.strip("[]"), int(port)


_TOKEN = "AIDL_MCP_TOKEN"


def register_mcp(parser: argparse.ArgumentParser) -> None:
    """`aidl mcp`: serve the tools to agents over the Model Context Protocol, on standard input and output."""
    value(parser, "--root", "DIR", "let programs import files below this folder (default: no files at all)")
    about = "serve over HTTP on this machine instead; 0 takes a port that is free"
    value(parser, "--http", "PORT", about, port)


def run_mcp(arguments: argparse.Namespace) -> int:
    require("the server", "mcp", code="E0942", extra="mcp")
    if arguments.root is not None and not Path(arguments.root).is_dir():
        raise UseError("E0942", f"there is no folder `{arguments.root}` to import from")
    root = None if arguments.root is None else Path(arguments.root).resolve()
    listener, path = None, f"/{_token()}/mcp"
    if arguments.http is not None:
        hint = "`--http 0` takes a port that is free"
        listener = listen(LOCALHOST, arguments.http, "E0942", hint)

    from aidl_lang.tools.agents.server import serve

    if listener is not None:
        say(f"serving at http://{LOCALHOST}:{listener.getsockname()[1]}{path} until Ctrl-C")
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
