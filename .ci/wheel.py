"""Installs AIDL as a user does, and runs it: the package built from a clean copy of this checkout, in a
virtualenv of its own, with a home in which there is nothing.

    .venv/bin/python .ci/wheel.py [--keep FOLDER]

First without any extra, by pip; then by uv, which users have too and which takes a fifth of the time: with
each extra, from the source archive and with `aidl-server` beside it for one of them; with `aidl-eval`; with
the lowest versions that are allowed.
Every command must end with the code that is expected of it, say what is expected, and show no traceback; none
may write into the installation, or keep anything of AIDL's in the home. Prints the seconds of each, and those
of the processor.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
import urllib.request
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from uv import find_uv_bin

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from tests.llm.scripted import Scripted  # noqa: E402 - a server that speaks as models' do

EXTRAS = ("step", "build123d", "3mf", "nest", "models", "mcp", "editor", "parquet", "cluster", "pygments")
UV = (find_uv_bin(), "--quiet", "--system-certs")
IS_WINDOWS = os.name == "nt"
PATIENCE = 180
"""Seconds after which a command counts as hanging."""
Json = dict[str, Any]
SLIP = "solid plate {\n    rim = circle(raduis: 3)\n}\n"
CONFLICT = "drawing d { a = circle(radius: fixed(5)); constrain { a.center.x == 3; a.left == 3 } }\n"
PLATE = "solid plate {\n    rim = circle(radius: 3)\n}\n"


class FailedError(Exception):
    """Something that every user would meet."""


@dataclass
class Installation:
    """A virtualenv with AIDL in it, the folder that commands run in, and a home of their own."""

    folder: Path
    failures: list[str] = field(default_factory=list)
    seconds: list[tuple[str, float, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        for path in (self.home, self.work):
            path.mkdir(parents=True)
        subprocess.run([*UV, "venv", "--seed", "--python", sys.executable, self.folder / "venv"], check=True)

    @property
    def home(self) -> Path:
        return self.folder / "home"

    @property
    def work(self) -> Path:
        return self.folder / "work"

    @property
    def bin(self) -> Path:
        return self.folder / "venv" / ("Scripts" if IS_WINDOWS else "bin")

    @property
    def package(self) -> Path:
        packages = "Lib/site-packages" if IS_WINDOWS else "lib/python3*/site-packages"
        (found,) = (self.folder / "venv").glob(f"{packages}/aidl_lang")
        return found

    def pip(self, *packages: str | Path) -> None:
        quietly = ("--quiet", "--disable-pip-version-check")
        self._install((self.bin / "python", "-m", "pip", "install", "--no-compile", *quietly), packages)

    def uv(self, *packages: str | Path) -> None:
        self._install((*UV, "pip", "install", "--python", self.bin / "python"), packages)

    def _install(self, command: Sequence[str | Path], packages: Sequence[str | Path]) -> None:
        """Installs packages and compiles AIDL; what they need is compiled as it is used: all of it would
        take minutes.
        """
        with self._timed(" ".join(Path(part).name for part in (command[0], *packages))):
            subprocess.run([*command, *packages], check=True)
        subprocess.run([self.bin / "python", "-m", "compileall", "-q", self.package], check=True)

    def run(
        self,
        *arguments: str,
        code: int = 0,
        says: str = "",
        program: str = "aidl",
        environment: Mapping[str, str] = {},
    ) -> str:
        """What a command writes. Counts as a failure when it ends or reads otherwise than it should."""
        name = " ".join([program, *arguments])
        with self._timed(name):
            try:
                done = subprocess.run(
                    [self.bin / program, *arguments],
                    cwd=self.work,
                    env={**self.environment, **environment},
                    stdin=subprocess.DEVNULL,
                    capture_output=True,
                    text=True,
                    timeout=PATIENCE,
                )
            except subprocess.TimeoutExpired:
                self.failures.append(f"{name}: not done after {PATIENCE} s")
                return ""
        said = done.stdout + done.stderr
        if done.returncode != code or "Traceback" in said or not re.search(says, said):
            wanted = f"code {code}" + (f" and words like {says!r}" if says else "")
            self.failures.append(f"{name}: code {done.returncode}, not {wanted}; it says\n{said[-4_000:]}")
        return said

    @property
    def environment(self) -> dict[str, str]:
        """Nothing of whoever runs this: an empty home is an empty cache."""
        if IS_WINDOWS:
            kept = {
                name: os.environ[name] for name in ("SYSTEMROOT", "COMSPEC", "TEMP") if name in os.environ
            }
            return kept | {"PATH": str(self.bin), "USERPROFILE": str(self.home), "PYTHONUTF8": "1"}
        return {"PATH": f"{self.bin}:/usr/bin:/bin", "HOME": str(self.home), "LANG": "C.UTF-8"}

    @contextlib.contextmanager
    def serving(self, *arguments: str) -> Iterator[subprocess.Popen[str]]:
        """A command that runs until it is told to end."""
        name = " ".join(["aidl", *arguments])
        process = subprocess.Popen(
            [self.bin / "aidl", *arguments],
            cwd=self.work,
            env=self.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        watchdog = threading.Timer(PATIENCE, process.kill)
        watchdog.start()
        try:
            with self._timed(f"{name}, and a question"):
                yield process
        except (FailedError, OSError, ValueError) as reason:
            process.kill()
            self.failures.append(f"{name}: {reason}\n{process.communicate()[1][-4_000:]}")
        finally:
            watchdog.cancel()
            process.kill()
            process.wait()

    def leave(self, process: subprocess.Popen[str], code: int = 0) -> None:
        """Wait for a server that was told to end."""
        try:
            _, said = process.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            raise FailedError("it does not end") from None
        if process.returncode != code or "Traceback" in said:
            raise FailedError(f"it ended with code {process.returncode}, not {code}: {said[-4_000:]}")

    def expect(self, holds: bool, what: str) -> None:
        if not holds:
            self.failures.append(what)

    @contextlib.contextmanager
    def _timed(self, name: str) -> Iterator[None]:
        start, used = time.perf_counter(), _processor_time()
        try:
            yield
        finally:
            self.seconds.append((name, time.perf_counter() - start, _processor_time() - used))


def _processor_time() -> float:
    """Of all processes that were started and have ended; 0 where the system does not tell."""
    try:
        import resource
    except ImportError:
        return 0.0
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def clean_copy(folder: Path) -> Path:
    """What a clone would have if the checkout were committed as it stands."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--deduplicate"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout.decode()
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)
    return folder


def build(package: Path, into: Path, kind: str = "--wheel") -> Path:
    """Returns the archive that is built from a package's folder, into a folder of its own."""
    subprocess.run([*UV, "build", kind, package, "--out-dir", into], check=True)
    (archive,) = into.glob("aidl*")
    return archive


def state(package: Path) -> dict[str, tuple[int, int]]:
    """Sizes and times of all files but what Python compiles for itself."""
    files = (path for path in package.rglob("*") if path.is_file() and path.suffix != ".pyc")
    return {str(path): (path.stat().st_size, path.stat().st_mtime_ns) for path in files}


# --- What every installation does ------------------------------------------------------------------


def helps(here: Installation) -> None:
    """What loads none of the packages."""
    here.run("--version", says=r"aidl \d")
    for verb in re.findall(r"^    ([a-z]+(?:-[a-z]+)*)", here.run("--help"), re.M):
        if verb != "eval":
            here.run(verb, "--help", says=f"usage: aidl {verb}")
    here.run("eval", "--help", code=2, says="pip install aidl-eval")


def plainly(here: Installation) -> None:
    """What needs no extra."""
    aidl = here.run
    aidl("new", "part")
    for suffix in ("svg", "dxf", "pdf", "png", "json"):
        aidl("compile", "part.aidl", "-o", f"part.{suffix}", says="solved")
    aidl("compile", "part.aidl", "-o", "part.stl", "--thickness", "3", says="solved")
    for name in ("telephone.aidl", "motor_bracket.aidl"):
        shutil.copy(here.package / "_data" / "examples" / name, here.work)
        aidl("compile", name, says="solved")
    (here.work / "slip.aidl").write_text(SLIP)
    aidl("check", "slip.aidl", code=1, says="did you mean")
    aidl("check", "--fix", "slip.aidl")
    here.expect((here.work / "slip.aidl").read_text() == PLATE, "aidl check --fix does not mend `raduis`")
    aidl("fmt", "--check", "part.aidl")
    aidl("params", "telephone.aidl")
    outputs = ("-o", "v-{n}.svg", "-o", "table.csv", "-o", "sheet.html")
    aidl("sweep", "telephone.aidl", "-D", "width=150,170", *outputs, says="2 variants, 2 well, none failing")
    aidl("measure", "part.aidl", says="area")
    aidl("diff", "slip.aidl", "part.aidl")
    aidl("show", "part.aidl", "--protocol", "ascii")
    aidl("doc", says="rectangle")
    aidl("doc", "ring", "--picture", "ring.svg", says="ring")
    aidl("guide", says="AIDL")
    aidl("grammar", "--format", "gbnf", says="root ::=")
    aidl("explain", "E0901", says="E0901")
    aidl("tool-schema", says='"name"')
    written = "import aidl_lang; aidl_lang.compile(open('part.aidl').read()).save('again.svg')"
    here.run("-c", written, program="python")


def without_extras(here: Installation) -> None:
    """Whatever needs an extra tells which."""
    lacking = [
        ("step", "compile", "part.aidl", "-o", "part.step", "--thickness", "3"),
        ("3mf", "compile", "part.aidl", "-o", "part.3mf", "--thickness", "3"),
        ("models", "generate", "a plate", *_asking("openai", "http://127.0.0.1:9/v1")),
        ("parquet", "sweep", "telephone.aidl", "-D", "width=150", "-o", "table.parquet"),
        ("cluster", "sweep", "telephone.aidl", "-D", "width=150", "--on", "tcp://127.0.0.1:9"),
        ("mcp", "mcp"),
        ("editor", "lsp"),
        ("editor", "preview", "part.aidl", "--no-open"),
    ]
    for extra, *arguments in lacking:
        here.run(*arguments, code=2, says=rf"pip install 'aidl-lang\[{extra}\]'")


def _asking(protocol: str, url: str) -> tuple[str, ...]:
    return "--provider", protocol, "--base-url", url, "--model", "test-model"


# --- What the extras bring -------------------------------------------------------------------------


def with_extras(here: Installation) -> None:
    for suffix in ("step", "3mf"):
        here.run("compile", "part.aidl", "-o", f"part.{suffix}", "--thickness", "3", says="solved")
    handed = "import aidl_lang; print(aidl_lang.compile('part.aidl').to_build123d(3).volume > 9000)"
    here.run("-c", handed, program="python", says="True")
    here.run("compile", "part.aidl", "-o", "nested.dxf", "--sheet", "200x200", "--nest", says="solved")
    here.run(
        "sweep", "telephone.aidl", "-D", "width=150,170", "-o", "table.parquet", says="2 variants, 2 well"
    )
    here.run("sweep", "telephone.aidl", "-D", "width=150", "--on", "tcp://127.0.0.1:9", code=2, says="E0976")
    colours = here.run("-l", "aidl", "-f", "html", "part.aidl", program="pygmentize", says="<span class=")
    here.expect('class="err"' not in colours, "pygmentize finds errors in a new program")
    for protocol in ("openai", "anthropic"):
        generates(here, protocol)
    serves_agents(here)
    serves_editors(here)
    shows_a_preview(here)


def evaluates(here: Installation) -> None:
    """One reply to a prompt that comes along; the page of a study, of which there is too little."""
    here.run("eval", "--help", says="usage: aidl eval")
    if IS_WINDOWS:  # where no command gives replies
        return
    (here.work / "reply.md").write_text(f"```aidl\n{PLATE}```\n")
    asked = ("--prompts", "gear", "--variants", "full", "--runs", "1", "--provider", "exec:cat reply.md")
    here.run("eval", "--out", "results", *asked, says="1/1 gear, full, run 1: valid")
    here.run("eval", "study", "results", "--no-open", code=2, says="E0987")
    here.run("eval", "--solver", "part.aidl", says="no-pruning")


def generates(here: Installation, protocol: str) -> None:
    """Against a server that says one thing."""
    keys = {"ANTHROPIC_API_KEY": "none", "OPENAI_API_KEY": "none"}
    name = f"{protocol}.aidl"
    with Scripted([f"A plate:\n\n```aidl\n{PLATE}```\n"]) as server:
        url = server.address if protocol == "anthropic" else server.base_url
        here.run("generate", "a plate", "-o", name, *_asking(protocol, url), says="valid", environment=keys)
    written = here.work / name
    here.expect(written.exists() and written.read_text() == PLATE, f"no program was had by way of {protocol}")


def serves_agents(here: Installation) -> None:
    client = {"clientInfo": {"name": "ci", "version": "0"}, "capabilities": {}}
    calls: list[Json] = [
        {"id": 1, "method": "initialize", "params": {"protocolVersion": "2025-06-18", **client}},
        {"method": "notifications/initialized"},
        {"id": 2, "method": "tools/call", "params": {"name": "compile", "arguments": {"program": PLATE}}},
    ]
    with here.serving("mcp") as process:
        assert process.stdin is not None
        assert process.stdout is not None
        answer: Json = {}
        for call in calls:
            process.stdin.write(json.dumps({"jsonrpc": "2.0", **call}) + "\n")
            process.stdin.flush()
            while "id" in call and answer.get("id") != call["id"]:
                answer = json.loads(process.stdout.readline())
        if "solved" not in json.dumps(answer):
            raise FailedError(f"it does not draw: {answer}")
        here.leave(process)


def serves_editors(here: Installation) -> None:
    where = {"uri": (here.work / "slip.aidl").as_uri()}
    with here.serving("lsp") as process:
        client = Editor(process)
        client.ask("initialize", processId=None, rootUri=None, capabilities={})
        client.send("initialized")
        document = where | {"languageId": "aidl", "version": 1, "text": PLATE}
        client.send("textDocument/didOpen", textDocument=document)
        said = client.ask("textDocument/hover", textDocument=where, position={"line": 1, "character": 12})
        if "circle" not in json.dumps(said):
            raise FailedError("it knows nothing of `circle`")
        client.ask("shutdown")
        client.send("exit")
        here.leave(process)


class Editor:
    """The client's end of the Language Server Protocol."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        self.to, self.of, self.asked = process.stdin, process.stdout, 0

    def send(self, method: str, /, **params: object) -> None:
        self._write({"method": method, "params": params})

    def ask(self, method: str, /, **params: object) -> Json:
        """The answer; what else the server says meanwhile is passed over."""
        self.asked += 1
        self._write({"id": self.asked, "method": method, "params": params})
        while True:
            length = int(self.of.readline().partition(":")[2])
            while self.of.readline().strip():
                pass
            message: Json = json.loads(self.of.read(length))
            if message.get("id") == self.asked and "method" not in message:
                return message

    def _write(self, message: Json) -> None:
        text = json.dumps({"jsonrpc": "2.0", **message})
        self.to.write(f"Content-Length: {len(text)}\r\n\r\n{text}")
        self.to.flush()


def shows_a_preview(here: Installation) -> None:
    with here.serving("preview", "part.aidl", "--no-open") as process:
        assert process.stderr is not None
        told = process.stderr.readline()
        found = re.search(r"http://\S+/", told)
        if found is None:
            raise FailedError(f"it tells no address but {told!r}")
        scripts = re.findall(r'src="([^"]+\.js)"', fetched(found[0]))
        if not scripts:
            raise FailedError("its page has no script")
        for script in scripts:
            fetched(found[0] + script.removeprefix("./"))
        if not IS_WINDOWS:  # where an interrupt goes to all that share a console, this script among them
            process.send_signal(signal.SIGINT)
            here.leave(process, code=130)


def fetched(url: str) -> str:
    """From this machine, whatever proxies there are."""
    direct = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    with direct.open(url, timeout=PATIENCE) as response:
        return str(response.read(), "utf-8")


# --- All of it -------------------------------------------------------------------------------------


def with_lowest_versions(folder: Path, wheel: Path) -> Installation:
    """What needs no extra, with the oldest packages that are allowed."""
    here = Installation(folder)
    asked = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    here.uv(*(each.replace(">=", "==") for each in asked), wheel)
    plainly(here)
    (here.work / "conflict.aidl").write_text(CONFLICT)
    here.run("check", "conflict.aidl", code=1, says="cannot hold together")
    return here


def main() -> None:
    parser = argparse.ArgumentParser(description="Install AIDL as a user does, and run it.")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="work there, and leave it as it is")
    folder = parser.parse_args().keep
    # A shell lets what runs beside others ignore interrupts, and all that is started by it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with contextlib.ExitStack() as stack:
        if folder is None:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="aidl-wheel-")))
        here = installed_and_run(folder.resolve())
        (wheel,) = (folder / "wheel").glob("aidl*")
        lowest = with_lowest_versions(folder.resolve() / "lowest", wheel.resolve())
        here.seconds += [(f"{name}, lowest versions", wall, used) for name, wall, used in lowest.seconds]
        here.failures += [f"with the lowest versions: {failure}" for failure in lowest.failures]
    print("\n| command | seconds | of the processor |\n|---|--:|--:|")
    for name, seconds, used in here.seconds:
        print(f"| `{name}` | {seconds:.2f} | {used:.2f} |")
    for failure in here.failures:
        print(f"\nfailed: {failure}", file=sys.stderr)
    sys.exit(bool(here.failures))


def installed_and_run(folder: Path) -> Installation:
    here = Installation(folder)
    copy = clean_copy(folder / "copy")
    here.pip(build(copy, folder / "wheel"))
    before = state(here.package)
    helps(here)
    plainly(here)
    without_extras(here)
    builders = [path.name for path in here.package.parent.glob("hatchling*")]
    here.expect(not builders, f"what only a build needs is installed: {builders}")
    here.expect(state(here.package) == before, "a run writes into the installation")

    archive, server = build(copy, folder / "dist", "--sdist"), build(copy / "server", folder / "server")
    here.uv("--reinstall-package", "aidl-lang", server, f"{archive}[{','.join(EXTRAS)}]")
    rebuilt = state(here.package)
    missing = sorted(before.keys() - rebuilt.keys())
    here.expect(not missing, f"what is built from the source archive lacks {missing[:5]}")
    with_extras(here)
    here.expect(state(here.package) == rebuilt, "a run writes into the installation")
    here.uv(copy / "eval")
    evaluates(here)
    strays = [
        path.name for name in ("aidl_dev", "dev", "eval", "server") for path in here.package.parent.glob(name)
    ]
    here.expect(not strays, f"what is not the product's is installed: {strays}")
    kept = [str(path) for path in here.home.rglob("*aidl*")]
    here.expect(not kept, f"something is kept in the home: {kept[:5]}")
    return here


if __name__ == "__main__":
    main()
