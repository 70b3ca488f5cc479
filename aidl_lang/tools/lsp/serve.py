"""Runs the server: on the standard streams, or for one client on a socket."""

from __future__ import annotations

import asyncio
import logging
import os
import socket
import sys
import threading
import time
from collections.abc import Coroutine

from pygls.exceptions import JsonRpcException

from aidl_lang.pipeline import Settings as Limits
from aidl_lang.tools.lsp import wire
from aidl_lang.tools.lsp.lane import give_room
from aidl_lang.tools.lsp.requests.actions import register_actions
from aidl_lang.tools.lsp.requests.appearance import register_appearance
from aidl_lang.tools.lsp.requests.hints import register_hints
from aidl_lang.tools.lsp.requests.lifecycle import register_lifecycle
from aidl_lang.tools.lsp.requests.navigation import register_navigation
from aidl_lang.tools.lsp.requests.preview import register_preview
from aidl_lang.tools.lsp.requests.writing import register_writing
from aidl_lang.tools.lsp.running import LIMITS
from aidl_lang.tools.lsp.server import Server

_RECURSION = 20_000
_SWITCH = 0.0005
"""Seconds that a thread may run before others: the message thread must not wait for a working one."""
_LAST_SECONDS = 1.0
_LOST = 1
"""Exit code when the client disconnects without ending the session."""


def make(limits: Limits = LIMITS) -> Server:
    """Returns a server with all requests."""
    server = Server(limits)
    for register in (
        register_lifecycle,
        register_navigation,
        register_appearance,
        register_actions,
        register_hints,
        register_preview,
        register_writing,
    ):
        register(server)
    return server


def serve_standard_streams() -> int:
    """Returns the exit code when the client has ended the session."""
    incoming, outgoing = wire.claim_standard_streams()

    async def main() -> int:
        loop = asyncio.get_running_loop()
        reader = asyncio.StreamReader()
        output = wire.Output(outgoing, lost=lambda: loop.call_soon_threadsafe(reader.feed_eof))
        wire.read_into(reader, incoming, loop)
        try:
            return await _serve(reader, output)
        finally:
            output.close()

    return _run(main())


def serve_socket(listener: socket.socket) -> int:
    """Serves the first client that connects to a listening socket."""

    async def main() -> int:
        listener.setblocking(False)
        connection, _ = await asyncio.get_running_loop().sock_accept(listener)
        listener.close()
        reader, writer = await asyncio.open_connection(sock=connection)
        try:
            return await _serve(reader, writer)
        finally:
            writer.close()

    return _run(main())


async def _serve(reader: asyncio.StreamReader, writer: wire.Output | asyncio.StreamWriter) -> int:
    server = make()
    server.start()
    protocol = server.protocol
    protocol.set_writer(writer)
    try:
        async for body in wire.bodies(reader):
            protocol.receive(body)
            if protocol.exit_code is not None:
                return protocol.exit_code
            await asyncio.sleep(0)  # what came of earlier messages has its turn, too
        return _LOST
    finally:
        server.close()


def make_room() -> None:
    """Prepares the process for a server: programs may be nested, and whoever asks is answered at once."""
    give_room()
    sys.setrecursionlimit(max(sys.getrecursionlimit(), _RECURSION))
    sys.setswitchinterval(_SWITCH)
    logging.basicConfig(stream=sys.stderr, format="%(levelname)s %(name)s: %(message)s")
    logging.getLogger("pygls.protocol.json_rpc").addFilter(_is_news)


def _run(session: Coroutine[None, None, int]) -> int:
    make_room()
    code = asyncio.run(session)
    _end_threads(code)
    return code


def _end_threads(code: int) -> None:
    """Waits a little for cancelled work; some steps cannot be interrupted, and end with the process."""
    deadline = time.monotonic() + _LAST_SECONDS
    working = [t for t in threading.enumerate() if t is not threading.current_thread() and not t.daemon]
    for thread in working:
        thread.join(timeout=max(0.0, deadline - time.monotonic()))
    if any(thread.is_alive() for thread in working):
        logging.shutdown()
        os._exit(code)


def _is_news(record: logging.LogRecord) -> bool:
    """True for a log record worth a line: not for what the client is told as an answer."""
    error = record.exc_info[1] if record.exc_info else None
    return not isinstance(error, JsonRpcException) and not str(record.msg).startswith("Unable to deserialize")
