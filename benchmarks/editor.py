"""What an editor waits for: from a key to new diagnostics and a new picture, over the language server.

    python benchmarks/editor.py [--edits N] [--pause SECONDS] [PROGRAM]

Prints Markdown. The server is a process of its own, as editors start it; the client writes each change to its
pipe and takes the time when the diagnostics of that version, and the picture of that version, have been read
from the other. Edits of several sorts take turns; those that break the program are taken back by the next.
The pause between edits is that of somebody who types: it ends what the server does when nobody waits.
"""

from __future__ import annotations

import argparse
import json
import os
import queue
import subprocess
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any, TypeAlias

ROOT = Path(__file__).resolve().parent.parent
TELEPHONE = ROOT / "examples" / "telephone.aidl"
GOAL = 50.0
"""Milliseconds to the picture."""
_SECONDS = 60.0
_WARM_UP = 20

Message: TypeAlias = dict[str, Any]


class Client:
    """Speaks the protocol over pipes; a thread notes when each message was read to its end."""

    def __init__(self, command: Sequence[str]) -> None:
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment
        )
        self._inbox: queue.Queue[tuple[float, int, Message]] = queue.Queue()
        self._asked = 0
        threading.Thread(target=self._read, daemon=True).start()

    def send(self, **message: Any) -> float:
        """The time at which the message was given to the pipe."""
        assert self.process.stdin is not None
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        now = time.perf_counter()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self.process.stdin.flush()
        return now

    def ask(self, method: str, params: Any) -> tuple[float, Message]:
        """Seconds until the answer, and the answer."""
        self._asked += 1
        began = self.send(id=self._asked, method=method, params=params)
        ended, _, answer = self.wait(lambda m: m.get("id") == self._asked and "method" not in m)
        if "error" in answer:
            raise SystemExit(f"{method}: {answer['error']['message']}")
        return ended - began, answer

    def wait(self, is_it: Callable[[Message], bool]) -> tuple[float, int, Message]:
        """When a message was read, its bytes, and the message; those before it are passed over."""
        while True:
            at, size, message = self._inbox.get(timeout=_SECONDS)
            if is_it(message):
                return at, size, message

    def _read(self) -> None:
        stream = self.process.stdout
        assert stream is not None
        while True:
            length = 0
            while line := stream.readline().strip():
                name, _, value = line.partition(b":")
                length = int(value) if name == b"Content-Length" else length
            if not length:
                return
            body = stream.read(length)
            self._inbox.put((time.perf_counter(), length, json.loads(body)))


@dataclass(frozen=True)
class Edit:
    """A change of one place, of some sort."""

    sort: str
    start: int
    end: int
    text: str


@dataclass
class Taken:
    """Milliseconds of each edit of a sort: until the diagnostics, until the picture, of the server's work."""

    diagnostics: list[float] = field(default_factory=list)
    picture: list[float] = field(default_factory=list)
    work: list[float] = field(default_factory=list)


def edits(text: str) -> Iterator[Edit]:
    """Without end: digits of a number, letters of a name and of a comment, and a line that is broken."""
    number = text.index("radius: 28") + len("radius: ")
    name = text.index("plate = circle") + len("plate")
    comment = text.index("mend it") + len("mend it")
    bracket = text.index(", height: 18)") + len(", height: 18")
    turn = 0
    while True:
        turn += 1
        yield Edit("a digit of a number", number + 1, number + 2, str(turn % 8 + 1))
        yield Edit("a space in a comment", comment, comment, " ")
        yield Edit("a space taken from a comment", comment, comment + 1, "")
        yield Edit("a letter of a name: it is missing elsewhere", name, name, "s")
        yield Edit("… and back", name, name + 1, "")
        yield Edit("a bracket: a line is broken", bracket, bracket + 1, "")
        yield Edit("… and mended", bracket, bracket, ")")


def main() -> None:
    options = argparse.ArgumentParser(description="Measure what an editor waits for.")
    options.add_argument("program", nargs="?", type=Path, default=TELEPHONE)
    options.add_argument("--edits", type=int, default=200, help="how many (default 200)")
    options.add_argument("--pause", type=float, default=0.1, help="seconds between them (default 0.1)")
    arguments = options.parse_args()
    text = arguments.program.read_text("utf-8")
    client = Client([sys.executable, "-m", "aidl_lang", "lsp"])
    uri = arguments.program.resolve().as_uri()
    greet(client, uri, text)
    taken, size = typed(client, uri, text, arguments.edits, arguments.pause)
    print_edits(taken, size)
    print_questions(client, uri, text)
    client.ask("shutdown", None)
    client.send(method="exit")
    client.process.wait(_SECONDS)


def greet(client: Client, uri: str, text: str) -> None:
    client.ask("initialize", {"processId": os.getpid(), "rootUri": None, "capabilities": {}})
    client.send(method="initialized", params={})
    document = {"uri": uri, "languageId": "aidl", "version": 1, "text": text}
    client.send(method="textDocument/didOpen", params={"textDocument": document})
    client.ask("aidl/preview", {"uri": uri, "show": []})


def typed(client: Client, uri: str, text: str, count: int, pause: float) -> tuple[dict[str, Taken], int]:
    """What each sort of edit took, and the bytes of the last picture."""
    taken: dict[str, Taken] = defaultdict(Taken)
    size = 0
    for version, edit in zip(range(2, 2 + _WARM_UP + count), edits(text), strict=False):
        worked = processor_time(client.process.pid)
        began = client.send(method="textDocument/didChange", params=change(uri, version, text, edit))
        text = text[: edit.start] + edit.text + text[edit.end :]
        said, _, _ = client.wait(is_about("textDocument/publishDiagnostics", version))
        seen, size, _ = client.wait(is_about("aidl/previewChanged", version))
        if version >= 2 + _WARM_UP:
            entry = taken[edit.sort]
            entry.diagnostics.append(1000 * (said - began))
            entry.picture.append(1000 * (seen - began))
            entry.work.append(1000 * (processor_time(client.process.pid) - worked))
        time.sleep(pause)
    return taken, size


def change(uri: str, version: int, text: str, edit: Edit) -> Message:
    where = {"start": place(text, edit.start), "end": place(text, edit.end)}
    document = {"uri": uri, "version": version}
    return {"textDocument": document, "contentChanges": [{"range": where, "text": edit.text}]}


def place(text: str, offset: int) -> Message:
    line = text.count("\n", 0, offset)
    return {"line": line, "character": offset - (text.rfind("\n", 0, offset) + 1)}


def is_about(method: str, version: int) -> Callable[[Message], bool]:
    return lambda m: m.get("method") == method and m["params"]["version"] == version


def processor_time(process: int) -> float:
    """Seconds that a process has worked so far, as Linux tells it in hundredths; elsewhere 0."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text("ascii").rpartition(")")[2].split()
    except FileNotFoundError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def print_edits(taken: dict[str, Taken], size: int) -> None:
    print(
        f"| ms from the key, {sum(len(t.picture) for t in taken.values())} edits "
        "| edits | to diagnostics | 95 % | to the picture | 95 % | of processor |"
    )
    print("|---|--:|--:|--:|--:|--:|--:|")
    whole = Taken()
    for sort, entry in taken.items():
        print_row(sort, entry)
        whole.diagnostics += entry.diagnostics
        whole.picture += entry.picture
        whole.work += entry.work
    print_row("all", whole)
    print(f"\nA picture is a message of {size / 1000:.0f} kB. The goal is {GOAL:.0f} ms to the picture.\n")


def print_row(name: str, entry: Taken) -> None:
    cells = [median(entry.diagnostics), high(entry.diagnostics), median(entry.picture), high(entry.picture)]
    cells.append(sum(entry.work) / len(entry.work))
    print(f"| {name} | {len(entry.picture)} | " + " | ".join(f"{cell:.1f}" for cell in cells) + " |")


def high(values: Sequence[float]) -> float:
    """The 95th percentile."""
    return sorted(values)[min(len(values) - 1, int(0.95 * len(values)))]


def print_questions(client: Client, uri: str, text: str) -> None:
    """Questions while nothing else is done."""
    document = {"uri": uri}
    inside = place(text, text.index("left_ear.center") + len("left_ear."))
    start = place(text, text.index("constrain {") + len("constrain {"))
    word = place(text, text.index("width: 0.85 * width") + len("width: 0.85 * w"))
    questions = {
        "completion behind a dot": (
            "textDocument/completion",
            {"textDocument": document, "position": inside},
        ),
        "completion of a constraint": (
            "textDocument/completion",
            {"textDocument": document, "position": start},
        ),
        "hover": ("textDocument/hover", {"textDocument": document, "position": word}),
        "semantic tokens": ("textDocument/semanticTokens/full", {"textDocument": document}),
        "outline": ("textDocument/documentSymbol", {"textDocument": document}),
        "code lenses": ("textDocument/codeLens", {"textDocument": document}),
    }
    print("| ms to the answer | median | 95 % |")
    print("|---|--:|--:|")
    for name, (method, params) in questions.items():
        times = [1000 * client.ask(method, params)[0] for _ in range(45)][5:]
        print(f"| {name} | {median(times):.1f} | {high(times):.1f} |")


if __name__ == "__main__":
    main()
