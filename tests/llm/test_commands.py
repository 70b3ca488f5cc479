"""Commands in place of a server: `exec:COMMAND`."""

from __future__ import annotations

import base64
import json
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from aidl_lang.tools.llm.messages import Finish, Image, Message, ProviderError, Reply, Sampling, Usage
from aidl_lang.tools.llm.providers import Closable, Connection, connect

Make = Callable[..., Closable]

PLAIN = Sampling()
SAID = [Message("system", "the guide"), Message("user", "a telephone", (Image("image/png", b"abc"),))]


@pytest.fixture
def command(tmp_path: Path) -> Make:
    """`command("print('a reply')")` is a provider that runs this as Python."""

    def make(program: str, **more: Any) -> Closable:
        script = tmp_path / "a reply.py"
        script.write_text(program, encoding="utf-8")
        return connect(Connection(f"exec:{sys.executable} '{script}'", **{"timeout": 20.0, **more}), {})

    return make


def ask(provider: Closable, sampling: Sampling = PLAIN) -> Reply:
    return provider.reply(SAID, sampling, lambda piece: None)


def failure(provider: Closable) -> tuple[str, str, tuple[str, ...]]:
    with pytest.raises(ProviderError) as caught:
        ask(provider)
    told = caught.value.diagnostic
    return told.code, told.message.replace(provider.name, "COMMAND"), told.hints


def test_what_a_command_reads(command: Make) -> None:
    provider = command("import sys; sys.stdout.write(sys.stdin.read())", model="m")
    reply = ask(provider, Sampling(7, 0.5, 9, {"top_k": 3}))
    assert json.loads(reply.text) == {
        "messages": [
            {"role": "system", "content": "the guide", "images": []},
            {
                "role": "user",
                "content": "a telephone",
                "images": ["data:image/png;base64," + base64.b64encode(b"abc").decode()],
            },
        ],
        "sampling": {"seed": 7, "temperature": 0.5, "max_tokens": 9, "top_k": 3},
        "model": "m",
    }
    assert (reply.finish, reply.usage) == (Finish.COMPLETE, Usage(None, None, None))


def test_text_is_heard_while_the_command_runs(command: Make, tmp_path: Path) -> None:
    waits = f"""
import os, sys, time
sys.stdout.write("ünï"); sys.stdout.flush()
while not os.path.exists({str(tmp_path / "heard")!r}): time.sleep(0.01)
sys.stdout.write("code")
"""
    heard: list[str] = []

    def hear(piece: str) -> None:
        heard.append(piece)
        (tmp_path / "heard").touch()

    reply = command(waits).reply(SAID, PLAIN, hear)
    assert (reply.text, heard) == ("ünïcode", ["ünï", "code"])


def test_command_may_tell_more_as_json(command: Make) -> None:
    told = {
        "text": "solid a {}",
        "usage": {"input": 100, "output": 10, "cost": 0.5},
        "finish": "cut",
        "model": "mine",
    }
    heard: list[str] = []
    reply = command(f"print('''{json.dumps(told)}''')").reply(SAID, PLAIN, heard.append)
    assert reply == Reply("solid a {}", Usage(100, 10, 0.5), Finish.CUT, "mine")
    assert heard == ["solid a {}"]


UNUSABLE = "the reply of `COMMAND` cannot be used: "
ENDLESS = "the reply has more than 1,000,000 characters"
ENDS = ("the model repeats itself: set --max-tokens, or take another model",)


@pytest.mark.parametrize(
    ("program", "message", "hints"),
    [
        (
            "sys.exit('no model\\x1b[2J here')",
            "`COMMAND` ended with exit code 1",
            ("it said: no model [2J here",),
        ),
        ("os.kill(os.getpid(), 15)", "`COMMAND` ended with SIGTERM", ()),
        ("print('  '); print('hm', file=sys.stderr)", f"{UNUSABLE}it wrote nothing", ("it said: hm",)),
        ("sys.stdout.buffer.write(b'solid \\xff')", f"{UNUSABLE}its output is not UTF-8 text", ()),
        ("sys.stdout.buffer.write('é'.encode()[:1])", f"{UNUSABLE}its output is not UTF-8 text", ()),
        ("\nwhile True: print('x' * 10000)", ENDLESS, ENDS),
        ("\nwhile True: print('x' * 10000, file=sys.stderr)", ENDLESS, ENDS),
        ("""print('{"text": 3}')""", f"{UNUSABLE}`text` in its JSON is not a string", ()),
        (
            """print('{"text": "a", "finish": "tired"}')""",
            f"{UNUSABLE}`finish` in its JSON is none of complete, cut, refused",
            (),
        ),
    ],
)
def test_failures(command: Make, program: str, message: str, hints: tuple[str, ...]) -> None:
    code = "E0936" if " ended with " in message else "E0938"
    assert failure(command(f"import os, sys; {program}")) == (code, message, hints)


def test_silent_command_is_killed_with_its_children(command: Make, tmp_path: Path) -> None:
    program = f"""
import subprocess, sys, time
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
open({str(tmp_path / "pid")!r}, "w").write(str(child.pid))
print("half of", flush=True)
time.sleep(600)
"""
    code, message, hints = failure(command(program, timeout=3))
    assert (code, message) == ("E0937", "`COMMAND` was silent for 3 seconds and was stopped")
    assert hints == ("--timeout SECONDS gives it longer",)
    assert _ends(int((tmp_path / "pid").read_text()))


def test_command_that_closes_its_output_and_stays(command: Make) -> None:
    program = "import os, time; print('a', flush=True); os.close(1); os.close(2); time.sleep(600)"
    assert failure(command(program, timeout=1.5))[0] == "E0937"


def test_command_is_killed_when_nobody_listens_any_more(command: Make, tmp_path: Path) -> None:
    program = f"""
import os, time
open({str(tmp_path / "pid")!r}, "w").write(str(os.getpid()))
print("a", flush=True)
time.sleep(600)
"""

    def hear(piece: str) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        command(program).reply(SAID, PLAIN, hear)
    assert _ends(int((tmp_path / "pid").read_text()))


def _ends(process: int) -> bool:
    """Whether a process is gone, or goes within ten seconds."""
    for _ in range(1000):
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return True
        if _is_zombie(process):
            return True
        time.sleep(0.01)
    return False


def _is_zombie(process: int) -> bool:
    """Killed, but not yet taken note of by whoever has inherited it."""
    stat = Path(f"/proc/{process}/stat")
    return stat.exists() and stat.read_text().rpartition(")")[2].split()[0] == "Z"


def test_a_command_does_not_get_the_keys_of_other_providers(
    command: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("OPENAI_API_KEY", "OPENAI_BASE_URL", "ANTHROPIC_API_KEY", "ANTHROPIC_AUTH_TOKEN", "MY_OWN"):
        monkeypatch.setenv(name, "secret")
    told = ask(command("import os; print(sorted(n for n in os.environ if os.environ[n] == 'secret'))")).text
    assert told.strip() == "['MY_OWN']"
