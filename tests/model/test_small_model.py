"""All the way to a real model and back: protocol, streams, tokens, verdicts, grammars; not how good it is."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from aidl_lang.tools.cli import main
from aidl_lang.tools.grammars import export
from aidl_lang.tools.llm.aidl import Aidl
from aidl_lang.tools.llm.messages import Finish, Message, Reply, Sampling
from aidl_lang.tools.llm.providers import Connection, connect, members
from tests.grammars.engines import engine, syntax_errors
from tests.model.install import Installed

EXAMPLE = """solid washer {
    rim = circle(center: origin, radius: 10)
    hole bore { edge = circle(center: rim.center, radius: 5) }
}
"""
GUIDE = f"You write programs in the language AIDL. This is one:\n\n```aidl\n{EXAMPLE}```"
"""In place of the guide, whose 6,000 tokens would take this model minutes to read."""
SAID = [
    Message("system", GUIDE),
    Message("user", "Write a program that draws a plate with two holes."),
]
SEEDS = (1, 2, 3, 4)
TOKENS = 80


def ask(address: str, sampling: Sampling) -> tuple[Reply, list[str]]:
    """A reply, and the pieces that were heard of it."""
    heard: list[str] = []
    provider = connect(Connection("openai", base_url=address), {})
    try:
        return provider.reply(SAID, sampling, heard.append), heard
    finally:
        provider.close()


@pytest.fixture
def generate(address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """One attempt of the command in a folder of its own: its exit code and the transcript."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Aidl, "guide", lambda language: GUIDE)
    model = ["--base-url", address, "--seed", "1", "--max-tokens", str(TOKENS)]

    def run(*more: str) -> tuple[int, dict[str, Any]]:
        said = ["a plate with two holes", "-o", "plate.aidl", "--attempts", "1", *more]
        code = main(["generate", *said, *model])
        return code, json.loads(Path("plate.transcript.json").read_text("utf-8"))

    return run


def is_let_through(text: str, finish: Finish, fenced: bool) -> bool:
    """Whether another engine takes the reply, to its end if it came to one."""
    taken, of, is_whole = engine(fenced).takes(text)
    return is_whole if finish is Finish.COMPLETE else taken == of


# --- Without a grammar ----------------------------------------------------------------------------


def test_a_reply_arrives_in_pieces_and_its_tokens_are_counted(address: str) -> None:
    reply, heard = ask(address, Sampling(seed=1, temperature=0.8, max_tokens=30))
    assert "".join(heard) == reply.text
    assert len(heard) > 10
    assert reply.finish is Finish.CUT
    assert reply.usage.output == 30
    assert 80 < (reply.usage.input or 0) < 300
    assert reply.usage.cost is None


def test_a_seed_gives_the_same_reply_again(address: str) -> None:
    first, again, other = (
        ask(address, Sampling(seed=seed, temperature=0.8, max_tokens=30))[0].text for seed in (1, 1, 2)
    )
    assert first == again != other


def test_the_command(generate: Callable[..., Any]) -> None:
    code, transcript = generate()
    attempt = transcript["attempts"][0]
    assert code == (0 if transcript["result"] and transcript["result"]["ok"] else 1)
    assert transcript["provider"] == "openai:smollm2-135m"
    assert [message["role"] for message in transcript["messages"]] == ["system", "user", "assistant"]
    assert 80 < attempt["usage"]["input"] < 300
    assert 0 < attempt["usage"]["output"] <= TOKENS
    assert Path("plate.aidl").exists() == (attempt["program"] is not None)


# --- With one -------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_llama_cpp_keeps_to_the_grammar(address: str, seed: int) -> None:
    asked = Sampling(seed, 1.0, TOKENS, members("llama.cpp", fenced=False))
    reply, _ = ask(address, asked)
    assert is_let_through(reply.text, reply.finish, fenced=False)
    if reply.finish is Finish.COMPLETE:
        assert syntax_errors(reply.text) == []


def test_the_command_with_a_grammar(generate: Callable[..., Any]) -> None:
    code, transcript = generate("--constrain", "llama.cpp")
    attempt, said = transcript["attempts"][0], transcript["messages"][-1]["text"]
    assert code == (0 if transcript["result"] and transcript["result"]["ok"] else 1)
    assert transcript["provider"] == "openai:smollm2-135m (constrained: llama.cpp)"
    assert is_let_through(said, Finish(attempt["finish"]), fenced=True)
    if attempt["program"] is not None:
        assert syntax_errors(attempt["program"]) == []


def test_llguidance_keeps_the_same_model_to_the_grammar(installed: Installed) -> None:
    asked = {
        "model": str(installed.model),
        "grammar": export("llguidance"),
        "messages": [{"role": message.role, "content": message.text} for message in SAID],
        "seeds": list(SEEDS),
        "max_tokens": TOKENS,
    }
    done = subprocess.run(
        [installed.python, Path(__file__).with_name("decode.py")],
        env={"LLAMA_CPP_LIB_PATH": str(installed.libraries)},
        input=json.dumps(asked),
        capture_output=True,
        text=True,
        check=True,
    )
    replies = json.loads(done.stdout)
    assert len(replies) == len(SEEDS)
    for reply in replies:
        is_whole = reply["finish_reason"] == "stop"
        assert is_let_through(reply["text"], Finish.COMPLETE if is_whole else Finish.CUT, fenced=False)
        assert not (is_whole and syntax_errors(reply["text"]))
