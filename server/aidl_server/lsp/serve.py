"""Runs the server: on the standard streams, or for one client on a socket."""

from __future__ import annotations

import asyncio
import logging
import os
import re
import socket
import sys
import threading
import time
from collections.abc import AsyncIterator, Callable, Coroutine
from queue import SimpleQueue

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from aidl_lang.common.world import DATA, PROGRAM
from aidl_lang.pipeline import Settings as Limits
from aidl_server.lsp.documents import Settings, path_of
from aidl_server.lsp.navigation import register_appearance, register_navigation
from aidl_server.lsp.preview import register_preview
from aidl_server.lsp.running import LIMITS
from aidl_server.lsp.server import Apply, Server
from aidl_server.lsp.writing import register_actions, register_hints, register_writing

# --- Notifications of the client: folders, settings, files that have changed.

_SECTION = "aidl"
log = logging.getLogger(__name__)


def register_lifecycle(server: Server) -> None:
    @server.feature(types.INITIALIZE)
    def initialize(params: types.InitializeParams) -> None:
        _take_roots(server)
        _use(server, Settings.read(params.initialization_options))

    @server.feature(types.INITIALIZED)
    async def initialized(params: types.InitializedParams) -> None:
        server.runner.warm_up()
        await _watch_files(server)
        await _ask_settings(server)

    @server.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    def folders(params: types.DidChangeWorkspaceFoldersParams) -> None:
        _take_roots(server)

    @server.feature(types.WORKSPACE_DID_CHANGE_CONFIGURATION)
    async def configure(params: types.DidChangeConfigurationParams) -> None:
        if isinstance(params.settings, dict) and _SECTION in params.settings:
            _use_settings(server, Settings.read(params.settings[_SECTION]))
        else:
            await _ask_settings(server)

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def files(params: types.DidChangeWatchedFilesParams) -> None:
        for path in {path_of(change.uri) for change in params.changes}:
            if not server.documents.at(path):  # what is open says what the editor says
                server.runner.renew_dependents(path)


def _take_roots(server: Server) -> None:
    roots = [path_of(folder.uri) for folder in server.workspace.folders.values()]
    if not roots and server.workspace.root_uri is not None:
        roots = [path_of(server.workspace.root_uri)]
    server.open_files.roots = tuple(dict.fromkeys(roots))


async def _watch_files(server: Server) -> None:
    if not server.can("workspace.did_change_watched_files.dynamic_registration"):
        return
    suffixes = ",".join(suffix.removeprefix(".") for suffix in (PROGRAM, *DATA))
    watcher = types.FileSystemWatcher(f"**/*.{{{suffixes}}}")
    options = types.DidChangeWatchedFilesRegistrationOptions([watcher])
    registration = types.Registration("files", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)
    try:
        await server.client_register_capability_async(types.RegistrationParams([registration]))
    except JsonRpcException as reason:
        log.warning("the client does not watch files: %s", reason)


async def _ask_settings(server: Server) -> None:
    if not server.can("workspace.configuration"):
        return
    wanted = types.ConfigurationParams([types.ConfigurationItem(section=_SECTION)])
    try:
        said = await server.workspace_configuration_async(wanted)
    except JsonRpcException as reason:
        log.warning("the client tells no settings: %s", reason)
        return
    _use_settings(server, Settings.read(said[0] if said else None))


def _use_settings(server: Server, settings: Settings) -> None:
    if settings != server.settings:
        _use(server, settings)
        server.refresh_hints()


def _use(server: Server, settings: Settings) -> None:
    server.settings, server.runner.delay = settings, settings.delay


# --- Messages of the protocol on standard input and output, or on a socket.
#
# Two threads of their own read and write the pipes: neither a client that is slow to read nor one that
# writes much keeps the server from working. Whatever else is printed in this process goes to standard error.

MOST_BYTES = 64_000_000
"""Most bytes of one message; a longer one is skipped."""
_CHUNK = 1 << 16
_LENGTH = re.compile(rb"content-length:[ \t]*(\d{1,18})\s*$", re.IGNORECASE)


async def bodies(reader: asyncio.StreamReader) -> AsyncIterator[bytes]:
    """Yields the contents of the messages, until the stream ends. Skips what is no message."""
    while (length := await _header(reader)) is not None:
        if length > MOST_BYTES:
            while length > 0 and (data := await reader.read(min(length, _CHUNK))):
                length -= len(data)
            continue
        try:
            yield await reader.readexactly(length)
        except asyncio.IncompleteReadError:
            return


async def _header(reader: asyncio.StreamReader) -> int | None:
    """Returns the length of the next message; None at the end of the stream."""
    length = None
    while True:
        try:
            line = await reader.readline()
        except ValueError:  # longer than a line of a header can be
            length = None
            continue
        if not line:
            return None
        if (found := _LENGTH.search(line)) is not None:
            length = int(found[1])
        elif not line.strip() and length is not None:
            return length


class Output:
    """Writes to a pipe, in a thread of its own. `lost` is called there when nobody reads."""

    def __init__(self, descriptor: int, lost: Callable[[], object]) -> None:
        self._waiting: SimpleQueue[bytes | None] = SimpleQueue()
        self._descriptor, self._lost = descriptor, lost
        self._thread = threading.Thread(target=self._run, name="writer", daemon=True)
        self._thread.start()

    def write(self, data: bytes) -> None:
        self._waiting.put(data)

    def close(self) -> None:
        """Waits until everything is written, but not for a reader that has stopped reading."""
        self._waiting.put(None)
        self._thread.join(timeout=1.0)

    def _run(self) -> None:
        try:
            while (data := self._waiting.get()) is not None:
                rest = memoryview(data)
                while rest:
                    rest = rest[os.write(self._descriptor, rest) :]
        except OSError:
            self._lost()


def read_into(reader: asyncio.StreamReader, descriptor: int, loop: asyncio.AbstractEventLoop) -> None:
    """Starts a thread that passes on the data of a pipe, and its end."""

    def run() -> None:
        try:
            while data := os.read(descriptor, _CHUNK):
                loop.call_soon_threadsafe(reader.feed_data, data)
            loop.call_soon_threadsafe(reader.feed_eof)
        except (OSError, RuntimeError):  # the pipe is gone, or the loop is closed
            return

    threading.Thread(target=run, name="reader", daemon=True).start()


def claim_standard_streams() -> tuple[int, int]:
    """Returns descriptors of the former standard streams; a stray `print` then goes to standard error."""
    sys.stdout.flush()
    incoming, outgoing = os.dup(0), os.dup(1)
    if sys.platform == "win32":
        import msvcrt

        msvcrt.setmode(incoming, os.O_BINARY)
        msvcrt.setmode(outgoing, os.O_BINARY)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return incoming, outgoing


_STACK = 64 * 1024 * 1024
"""Stack of a thread, bytes: programs may be nested, and the interpreter follows them."""
_RECURSION = 20_000
_SWITCH = 0.0005
"""Seconds that a thread may run before others: the message thread must not wait for a working one."""
_LAST_SECONDS = 1.0
_LOST = 1
"""Exit code when the client disconnects without ending the session."""


def make(limits: Limits = LIMITS, apply: Apply | None = None) -> Server:
    server = Server(limits, apply)
    register_lifecycle(server)
    register_navigation(server)
    register_appearance(server)
    register_actions(server)
    register_hints(server)
    register_preview(server)
    register_writing(server)
    return server


def serve_standard_streams() -> int:
    """Returns the exit code when the client has ended the session."""
    return _run(serve_pipes(*claim_standard_streams()))


async def serve_pipes(incoming: int, outgoing: int) -> int:
    loop = asyncio.get_running_loop()
    reader = asyncio.StreamReader()
    output = Output(outgoing, lost=lambda: loop.call_soon_threadsafe(reader.feed_eof))
    read_into(reader, incoming, loop)
    try:
        return await _serve(reader, output)
    finally:
        output.close()


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


async def _serve(reader: asyncio.StreamReader, writer: Output | asyncio.StreamWriter) -> int:
    server = make()
    server.start()
    protocol = server.protocol
    protocol.set_writer(writer)
    try:
        async for body in bodies(reader):
            protocol.receive(body)
            if protocol.exit_code is not None:
                return protocol.exit_code
            await asyncio.sleep(0)  # what came of earlier messages has its turn, too
        return _LOST
    finally:
        server.close()


def make_room() -> None:
    """Prepares the process for a server: programs may be nested, and whoever asks is answered at once."""
    threading.stack_size(_STACK)
    sys.setrecursionlimit(max(sys.getrecursionlimit(), _RECURSION))
    sys.setswitchinterval(_SWITCH)
    logging.basicConfig(stream=sys.stderr, format="%(levelname)s %(name)s: %(message)s")
    logging.getLogger("pygls.protocol.json_rpc").addFilter(_is_news)


def _run(session: Coroutine[None, None, int]) -> int:
    make_room()
    code = asyncio.run(session)
    deadline = time.monotonic() + _LAST_SECONDS
    working = [t for t in threading.enumerate() if t is not threading.current_thread() and not t.daemon]
    for thread in working:
        thread.join(timeout=max(0.0, deadline - time.monotonic()))
    if any(thread.is_alive() for thread in working):
        logging.shutdown()
        os._exit(code)
    return code


def _is_news(record: logging.LogRecord) -> bool:
    """True for a log record worth a line: not for what the client is told as an answer."""
    error = record.exc_info[1] if record.exc_info else None
    return not isinstance(error, JsonRpcException) and not str(record.msg).startswith("Unable to deserialize")
