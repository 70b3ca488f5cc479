"""Messages of the protocol on standard input and output, or on a socket.

Two threads of their own read and write the pipes: neither a client that is slow to read nor one that writes
much keeps the server from working. Whatever else is printed in this process goes to standard error.
"""

from __future__ import annotations

import asyncio
import os
import re
import sys
import threading
from collections.abc import AsyncIterator, Callable
from queue import SimpleQueue

MOST_BYTES = 64_000_000
"""Most bytes of one message; a longer one is skipped."""
_CHUNK = 1 << 16
_LENGTH = re.compile(rb"content-length:[ \t]*(\d{1,18})\s*$", re.IGNORECASE)


async def bodies(reader: asyncio.StreamReader) -> AsyncIterator[bytes]:
    """Yields the contents of the messages, until the stream ends. Skips what is no message."""
    while (length := await _header(reader)) is not None:
        if length > MOST_BYTES:
            await _pass_over(reader, length)
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


async def _pass_over(reader: asyncio.StreamReader, length: int) -> None:
    while length > 0 and (data := await reader.read(min(length, _CHUNK))):
        length -= len(data)


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
                _write(self._descriptor, data)
        except OSError:
            self._lost()


def _write(descriptor: int, data: bytes) -> None:
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(descriptor, rest) :]


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
    """Returns descriptors of the former standard input and output. A stray `print` then goes to standard
    error, and nobody else reads what the client writes.
    """
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
