"""A command in place of a server: it reads one JSON document and writes the reply."""

from __future__ import annotations

import codecs
import json
import os
import selectors
import shlex
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import IO

from aidl_lang.tools.llm.messages import Finish, Message, ProviderError, Reply, Sampling, Usage
from aidl_lang.tools.llm.providers import (
    DEFAULT_URL,
    EXEC,
    MAX_TEXT,
    Connection,
    Draft,
    count,
    dig,
    dollars,
    one_line,
    too_long,
)

_BLOCK = 65_536
_TAIL = 2_000
_LINES = 3
_OTHERS = tuple(f"{kind.upper()}_" for kind in DEFAULT_URL)
"""Beginnings of variables that are for other providers, as those of their keys."""


class Command:
    """`exec:COMMAND`, split as a shell would but not run by one. It is started anew for every reply."""

    takes_seeds = True
    takes_grammars = True

    def __init__(self, connection: Connection) -> None:
        self.name = connection.provider
        self._connection = connection
        try:
            self._command = shlex.split(connection.provider.removeprefix(EXEC))
        except ValueError as error:
            raise ProviderError("E0930", f"`{self.name}` cannot be split into words: {error}") from None
        if not self._command:
            raise ProviderError("E0930", "`exec:` names no command", "as in 'exec:python reply.py'")
        if os.name != "posix":
            raise ProviderError("E0936", "commands are run on Linux, macOS and other POSIX systems only")

    def close(self) -> None:
        """Nothing is kept between replies."""

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        asked = json.dumps(_document(messages, sampling, self._connection.model))
        # A file instead of a pipe: a command that does not read it holds nothing up.
        with tempfile.TemporaryFile() as file:
            file.write(asked.encode())
            file.seek(0)
            with self._running(file) as process:
                return self._receive(process, hear)

    @contextmanager
    def _running(self, asked: IO[bytes]) -> Iterator[subprocess.Popen[bytes]]:
        """Runs the process in a group of its own; kills the whole group if it does not end."""
        pipe = subprocess.PIPE
        try:
            process = subprocess.Popen(
                self._command,
                stdin=asked,
                stdout=pipe,
                stderr=pipe,
                start_new_session=True,
                env={name: value for name, value in os.environ.items() if not name.startswith(_OTHERS)},
            )
        except (OSError, ValueError) as error:
            raise ProviderError(
                "E0936",
                f"`{self._command[0]}` cannot be run: {getattr(error, 'strerror', None) or error}",
                "is the path right, and may it be executed? A script may want `python` or `sh` before it",
            ) from None
        with process:
            try:
                yield process
            except BaseException:
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
                raise

    def _receive(self, process: subprocess.Popen[bytes], hear: Callable[[str], None]) -> Reply:
        draft = Draft(_unless_json(hear), self._connection.model or self.name)
        decode = codecs.getincrementaldecoder("utf-8")().decode
        said_beside = b""
        try:
            for is_output, block in self._blocks(process):
                if is_output:
                    draft.say(decode(block))
                else:
                    said_beside = (said_beside + block)[-_TAIL:]
            draft.say(decode(b"", True))
            code = process.wait(self._connection.timeout)
        except UnicodeDecodeError:
            raise self._unusable("its output is not UTF-8 text", said_beside) from None
        except subprocess.TimeoutExpired:
            raise self._silence(said_beside) from None
        if code:
            raise ProviderError("E0936", f"`{self.name}` ended with {_ending(code)}", *_last(said_beside))
        if not draft.text.strip():
            raise self._unusable("it wrote nothing", said_beside)
        return self._finished(draft, hear)

    def _blocks(self, process: subprocess.Popen[bytes]) -> Iterator[tuple[bool, bytes]]:
        """Yields output until standard output is closed, with True for standard output."""
        total = 0
        with selectors.DefaultSelector() as pipes:
            for pipe in (process.stdout, process.stderr):
                assert pipe
                pipes.register(pipe, selectors.EVENT_READ, pipe is process.stdout)
            while any(key.data for key in pipes.get_map().values()):
                ready = pipes.select(self._connection.timeout)
                if not ready:
                    raise self._silence(b"")
                # Standard error first, so that what was said is known when the output ends.
                for key, _ in sorted(ready, key=lambda pair: bool(pair[0].data)):
                    block = os.read(key.fd, _BLOCK)
                    total += len(block)
                    if total > 4 * MAX_TEXT:
                        raise too_long()
                    if not block:
                        pipes.unregister(key.fileobj)
                    yield key.data, block
            yield from ((False, os.read(key.fd, _BLOCK)) for key, _ in pipes.select(0))

    def _finished(self, draft: Draft, hear: Callable[[str], None]) -> Reply:
        """Returns the reply as written, or the `text` of a JSON object."""
        document = _parsed(draft.text)
        if dig(document, "text") is None:
            if draft.text.lstrip().startswith("{"):
                hear(draft.text)
            return draft.reply(self._connection.price)
        whole = Draft(hear, one_line(dig(document, "model")) or draft.model)
        text, finish = dig(document, "text"), dig(document, "finish") or "complete"
        if not isinstance(text, str):
            raise self._unusable("`text` in its JSON is not a string", b"")
        if not isinstance(finish, str) or finish not in set(Finish):
            raise self._unusable(f"`finish` in its JSON is none of {', '.join(Finish)}", b"")
        whole.say(text)
        whole.finish = Finish(finish)
        usage = dig(document, "usage")
        whole.usage = Usage(
            count(dig(usage, "input")), count(dig(usage, "output")), dollars(dig(usage, "cost"))
        )
        return whole.reply(self._connection.price)

    def _unusable(self, why: str, said: bytes) -> ProviderError:
        return ProviderError("E0938", f"the reply of `{self.name}` cannot be used: {why}", *_last(said))

    def _silence(self, said: bytes) -> ProviderError:
        return ProviderError(
            "E0937",
            f"`{self.name}` was silent for {self._connection.timeout:g} seconds and was stopped",
            "--timeout SECONDS gives it longer",
            *_last(said),
        )


def _document(messages: Sequence[Message], sampling: Sampling, model: str) -> dict[str, object]:
    return {
        "messages": [
            {"role": said.role, "content": said.text, "images": [image.uri for image in said.images]}
            for said in messages
        ],
        "sampling": {
            "seed": sampling.seed,
            "temperature": sampling.temperature,
            "max_tokens": sampling.max_tokens,
            **sampling.extra,
        },
        "model": model,
    }


def _unless_json(hear: Callable[[str], None]) -> Callable[[str], None]:
    """Passes on text at once, unless it starts like JSON: then its text at the end."""
    first = ""

    def pass_on(piece: str) -> None:
        nonlocal first
        first = first or piece.lstrip()[:1]
        if first != "{":
            hear(piece)

    return pass_on


def _parsed(text: str) -> object:
    try:
        return json.loads(text)
    except (ValueError, RecursionError):  # a reply may be anything
        return None


def _ending(code: int) -> str:
    return f"exit code {code}" if code > 0 else signal.Signals(-code).name


def _last(said: bytes) -> list[str]:
    lines = [line for text in said.decode(errors="replace").splitlines() if (line := one_line(text))]
    return [f"it said: {line}" for line in lines[-_LINES:]]
