"""The grammar on its way to a server, and replies that do not keep to it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from aidl_lang.tools.cli import main
from tests.llm.scripted import Failed

PROGRAM = "solid plate {\n    outline = rectangle(center: origin, width: 60, height: 40)\n}\n"
KNOWN = "llama.cpp, sglang, vllm, llama.cpp:llguidance, sglang:llguidance, vllm:llguidance"
REPLY = f"A plate is a rectangle.\n\n```aidl\n{PROGRAM}```"


def grammar(capsys: pytest.CaptureFixture[str], format: str = "gbnf") -> str:
    """What the command writes."""
    capsys.readouterr()
    assert main(["grammar", "--format", format, "--fenced"]) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize(
    ("server", "members"),
    [
        ("llama.cpp", lambda grammar: {"grammar": grammar}),
        ("sglang", lambda grammar: {"ebnf": grammar}),
        ("vllm", lambda grammar: {"structured_outputs": {"grammar": grammar}}),
    ],
)
def test_what_a_server_is_sent(
    generate: Callable[..., Any],
    capsys: pytest.CaptureFixture[str],
    server: str,
    members: Callable[[str], dict[str, Any]],
) -> None:
    _, plain = generate([REPLY])
    code, constrained = generate([REPLY], "--constrain", server, "-o", "plate.aidl")
    assert code == 0
    assert Path("plate.aidl").read_text("utf-8") == PROGRAM
    assert constrained.requests[0].body == plain.requests[0].body | members(grammar(capsys))
    _, other = generate([REPLY], "--constrain", f"{server}:llguidance")
    assert other.requests[0].body == plain.requests[0].body | members(grammar(capsys, "llguidance"))
    transcript = json.loads(Path("plate.transcript.json").read_text("utf-8"))
    assert transcript["provider"] == f"openai:test-model (constrained: {server})"


# --- Servers that do not ------------------------------------------------------------------------


@pytest.mark.parametrize(
    "reply",
    [
        f"{REPLY}\nAnd that is all.",
        "A plate is a rectangle.",
        PROGRAM,
        REPLY.replace("```aidl", "```"),
        REPLY.replace("(center", "(((center"),
        REPLY.removesuffix("```"),
        "",
    ],
)
def test_a_reply_that_does_not_keep_to_the_grammar(
    generate: Callable[..., Any], capsys: pytest.CaptureFixture[str], reply: str
) -> None:
    code, server = generate([reply, REPLY], "--constrain", "vllm", "-o", "plate.aidl")
    assert (code, len(server.requests), list(Path().iterdir())) == (2, 1, [])
    assert capsys.readouterr().err == (
        "error[E0951]: the reply of openai:test-model does not keep to the grammar: `structured_outputs` in "
        "the request was not heeded\n"
        f"  = hint: does --constrain name the kind of server that answers? It knows {KNOWN}\n"
        "  = hint: without --constrain, mistakes of syntax are told to the model\n"
    )


def test_a_server_that_refuses_it(generate: Callable[..., Any], capsys: pytest.CaptureFixture[str]) -> None:
    refusal = Failed(400, "Unrecognized request argument supplied: ebnf")
    code, _ = generate([refusal], "--constrain", "sglang")
    assert code == 2
    assert capsys.readouterr().err == (
        "error[E0935]: the request was refused (400): Unrecognized request argument supplied: ebnf\n"
        "  = hint: does --constrain name the kind of server that answers? Without it no grammar is sent\n"
    )


@pytest.mark.parametrize("verb", [["generate", "a plate"], ["eval", "--variants", "full"]])
def test_anthropic_takes_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], verb: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ANTHROPIC_API_KEY", "k")
    said = ["--provider", "anthropic", "--model", "m", "--constrain", "vllm"]
    assert main([*verb, *said]) == 2
    assert capsys.readouterr().err == (
        "error[E0950]: anthropic:m takes no grammar\n  = hint: leave --constrain out\n"
    )
