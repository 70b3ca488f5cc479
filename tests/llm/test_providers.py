"""Servers as providers: what they are sent, what comes back, and how every failure is told."""

from __future__ import annotations

import argparse
import builtins
from collections.abc import Callable
from typing import Any

import pytest

from aidl_lang.tools.cli import options
from aidl_lang.tools.llm.messages import Finish, Image, Message, ProviderError, Sampling, Usage
from aidl_lang.tools.llm.providers import Connection, Price, connect
from tests.llm.scripted import Cut, Failed, Garbage, Hangs, Request, Says, Scripted, Step

Start = Callable[..., Scripted]

KINDS = ["openai", "anthropic"]
SAID = [Message("system", "the guide"), Message("user", "a telephone")]
PLAIN = Sampling()
PICTURE = Image("image/png", b"\x89PNG picture")


def ask(server: Scripted, kind: str = "openai", sampling: Sampling = PLAIN, **more: Any) -> Any:
    return server.provider(kind, **more).reply(SAID, sampling, lambda piece: None)


def failure(server: Scripted, kind: str = "openai", **more: Any) -> tuple[str, str, tuple[str, ...]]:
    with pytest.raises(ProviderError) as caught:
        ask(server, kind, **more)
    told = caught.value.diagnostic
    return told.code, told.message.replace(server.address, "SERVER"), told.hints


@pytest.mark.parametrize("kind", KINDS)
def test_reply_arrives_in_pieces(scripted: Start, kind: str) -> None:
    server = scripted([Says("solid plate {}\nünïcode ✓", size=4, reasoning="let me think")])
    heard: list[str] = []
    provider = server.provider(kind)
    reply = provider.reply(SAID, PLAIN, heard.append)
    assert reply.text == "".join(heard) == "solid plate {}\nünïcode ✓"
    assert len(heard) == 6
    assert (reply.usage, reply.finish, reply.model) == (
        Usage(100, 10, None),
        Finish.COMPLETE,
        "test-model",
    )
    assert provider.name == f"{kind}:test-model"


@pytest.mark.parametrize("kind", KINDS)
def test_messages_come_to_the_server_as_they_were(scripted: Start, kind: str) -> None:
    server = scripted(["yes"])
    said = [
        *SAID,
        Message("assistant", "solid a {}"),
        Message("user", "like this </svg>", (PICTURE, Image("image/jpeg", b"\xff\xd8"))),
    ]
    server.provider(kind).reply(said, PLAIN, lambda piece: None)
    assert server.requests[0].messages == said


def test_openai_request(scripted: Start) -> None:
    server = scripted(["yes"])
    ask(server, sampling=Sampling(7, 0.2, 500, {"grammar": "root ::= x"}), key="sk-mine")
    body = {**server.requests[0].body}
    del body["messages"]
    assert body == {
        "model": "test-model",
        "seed": 7,
        "temperature": 0.2,
        "max_tokens": 500,
        "grammar": "root ::= x",
        "stream": True,
        "stream_options": {"include_usage": True},
    }
    assert server.requests[0].headers["authorization"] == "Bearer sk-mine"


def test_anthropic_request(scripted: Start) -> None:
    server = scripted(["yes", "yes"])
    ask(server, "anthropic", Sampling(None, 0.2, None, {"top_k": 5}), key="sk-mine")
    ask(server, "anthropic", Sampling(max_tokens=500))
    body = server.requests[0].body
    assert (body["temperature"], body["top_k"], body["max_tokens"]) == (0.2, 5, 8192)
    assert body["system"] == [{"type": "text", "text": "the guide", "cache_control": {"type": "ephemeral"}}]
    assert server.requests[0].headers["authorization"] == "Bearer sk-mine"  # as the SDK sends it since 2.0
    assert server.requests[1].body["max_tokens"] == 500


def test_anthropic_has_no_seed(scripted: Start) -> None:
    server = scripted(["yes"])
    assert failure(server, "anthropic", sampling=Sampling(seed=1)) == (
        "E0935",
        "Anthropic's API takes no seed",
        ("leave --seed out",),
    )
    assert server.requests == []


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("stream", [True, False])
@pytest.mark.parametrize(
    ("told", "finish"),
    [
        ("stop", Finish.COMPLETE),
        ("length", Finish.CUT),
        ("content_filter", Finish.REFUSED),
        ("tool_use", Finish.COMPLETE),
    ],
)
def test_why_it_ended(scripted: Start, kind: str, stream: bool, told: str, finish: Finish) -> None:
    reply = ask(scripted([Says("half of", told, stream=stream)]), kind)
    assert (reply.text, reply.finish, reply.usage.input) == ("half of", finish, 100)


def test_refusal_of_openai_is_text(scripted: Start) -> None:
    body = '{"choices": [{"message": {"content": null, "refusal": "I will not"}, "finish_reason": "stop"}]}'
    reply = ask(scripted([Garbage(body, "application/json")]))
    assert (reply.text, reply.finish) == ("I will not", Finish.REFUSED)


def test_cost_is_what_the_server_says_else_by_the_price(scripted: Start) -> None:
    price = Price(2.5, 10)
    server = scripted([Says("a", cost=0.004), Says("b"), Says("c", usage=None)])
    costs = [ask(server, price=price).usage.cost for _ in range(3)]
    assert costs == [0.004, pytest.approx((100 * 2.5 + 10 * 10) / 1e6), None]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("clean", [False, True])
def test_reply_that_breaks_off_is_asked_for_again(scripted: Start, kind: str, clean: bool) -> None:
    server = scripted([Cut("half of", clean), "the whole"])
    heard: list[str] = []
    reply = server.provider(kind).reply(SAID, PLAIN, heard.append)
    assert (reply.text, heard) == ("the whole", ["half of", "the whole"])
    assert reply.usage == Usage(None, None, None)  # the broken one was paid for as well


@pytest.mark.parametrize("kind", KINDS)
def test_reply_that_always_breaks_off(scripted: Start, kind: str) -> None:
    server = scripted([Cut("half of")] * 3)
    assert failure(server, kind) == (
        "E0938",
        f"the reply of {kind}:test-model broke off, however often it was asked for",
        ("look at the server, and at what stands between you and it",),
    )


def test_models_are_named_when_one_is_not_there(scripted: Start) -> None:
    server = scripted([Failed(404)], models=["llama3.1:8b", "qwen3-coder:30b"])
    code, message, hints = failure(server, model="qwen3-coder")
    assert (code, message.partition(" (404)")[0]) == ("E0934", "there is no model `qwen3-coder`")
    assert hints == ("the server has qwen3-coder:30b, …",)


def test_address_that_is_wrong_is_told(scripted: Start) -> None:
    server = scripted([Failed(404)])
    assert failure(server, base_url=server.address + "/nowhere/else")[2] == (
        f"is {server.address}/nowhere/else right? Most base URLs end in /v1",
    )


def test_what_to_do_about_a_request_that_is_refused(scripted: Start) -> None:
    long = "This model's maximum context length is 4096 tokens"
    server = scripted([Failed(400, long), Failed(400, "no image input"), Failed(400, "bad temperature")])
    hints = [failure(server)[2] for _ in range(3)]
    assert hints[0] == (
        "guide and conversation are longer than the model reads: take one that reads more",
        "servers of your own: OLLAMA_CONTEXT_LENGTH=16384, llama-server -c, vllm --max-model-len",
    )
    assert hints[1:] == [
        ("take a model that sees pictures, or leave --image out",),
        ("leave --temperature out",),
    ]


def test_key_is_never_shown(scripted: Start) -> None:
    server = scripted([Failed(401, "there is no key sk-secret here")])
    assert failure(server, key="sk-secret")[1] == "the key was refused (401): there is no key … here"


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "garbage",
    [
        Garbage(),
        Garbage("", "text/event-stream"),
        Garbage("data: {oops\n\n", "text/event-stream"),
        Garbage("event: message_start\ndata: {oops\n\n", "text/event-stream"),
        Garbage("data: 3\n\n", "text/event-stream"),
        Garbage('event: message_start\ndata: "x"\n\n', "text/event-stream"),
        Garbage('data: {"choices": 5}\n\n', "text/event-stream"),
        Garbage("[1]", "application/json"),
        Garbage("[" * 100_000, "application/json"),
        Garbage("data: " + "[" * 100_000 + "\n\n", "text/event-stream"),
        Garbage("event: message_start\ndata: " + "[" * 100_000 + "\n\n", "text/event-stream"),
        Garbage("{}", "application/json"),
        Garbage("", "application/json"),
    ],
)
def test_what_is_not_the_protocol(scripted: Start, kind: str, garbage: Garbage) -> None:
    code, message, hints = failure(scripted([garbage]), kind)
    assert code == "E0938"
    assert message.endswith(f" sent no reply in the protocol of {kind} but {garbage.content_type}")
    assert hints == ("look at the base URL, and at what stands between you and the server",)


def test_parts_that_are_reasoning_are_not_the_text(scripted: Start) -> None:
    parts = '[{"type": "thinking", "thinking": "hm", "text": "hm"}, {"type": "text", "text": "yes"}]'
    body = f'{{"choices": [{{"message": {{"content": {parts}}}}}]}}'
    assert ask(scripted([Garbage(body, "application/json")])).text == "yes"


@pytest.mark.parametrize(
    ("kind", "garbage"),
    [
        ("openai", Garbage('data: {"error": {"message": "no memory"}}\n\n', "text/event-stream")),
        ("openai", Garbage('{"error": {"message": "no memory"}}', "application/json")),
        ("anthropic", Garbage('{"type": "error", "error": {"message": "no memory"}}', "application/json")),
        ("openai", Garbage('{"choices": [{"error": {"message": "no memory"}}]}', "application/json")),
        (
            "anthropic",
            Garbage('event: error\ndata: {"error": {"message": "no memory"}}\n\n', "text/event-stream"),
        ),
    ],
)
def test_error_in_place_of_a_reply(scripted: Start, kind: str, garbage: Garbage) -> None:
    code, message, _ = failure(scripted([garbage]), kind)
    assert code == "E0936"
    assert message.endswith(" fails: no memory")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("text", ["", "the first words"])
def test_silence_is_not_asked_again(scripted: Start, kind: str, text: str) -> None:
    server = scripted([Hangs(text), "too late"])
    code, message, hints = failure(server, kind, timeout=0.5)
    assert code == "E0937"
    assert message.endswith(" was silent for 0.5 seconds")
    assert hints == (
        "--timeout SECONDS gives it longer; a model in main memory may need minutes to read the guide",
    )
    assert len(server.requests) == 1


@pytest.mark.parametrize("kind", KINDS)
def test_long_waits_are_not_waited_for(kind: str, scripted: Start) -> None:
    server = scripted([Failed(429, "come back later", wait=("retry-after", "3600")), "too late"])
    assert failure(server, kind)[0] == "E0933"
    assert len(server.requests) == 1


@pytest.mark.parametrize("kind", KINDS)
def test_text_that_is_not_unicode(scripted: Start, kind: str) -> None:
    with pytest.raises(ProviderError) as caught:
        scripted([]).provider(kind).reply([Message("user", "\udcff")], PLAIN, lambda piece: None)
    assert caught.value.diagnostic.message == "the messages hold characters that are not Unicode text"


def test_what_a_server_refuses_is_left_out_and_remembered(scripted: Start) -> None:
    def picky(request: Request) -> Step:
        if "stream_options" in request.body:
            return Failed(422, "extra field: stream_options")
        if "max_tokens" in request.body:
            return Failed(400, "Unsupported parameter: 'max_tokens'. Use 'max_completion_tokens' instead.")
        return Says(str(request.body["max_completion_tokens"]))

    server = scripted([picky] * 4)
    provider = server.provider()
    replies = [provider.reply(SAID, Sampling(max_tokens=9), lambda piece: None) for _ in range(2)]
    assert [reply.text for reply in replies] == ["9", "9"]
    assert len(server.requests) == 4


def test_the_one_model_of_a_server_is_taken(scripted: Start) -> None:
    server = scripted(["yes"], models=["only-this"])
    assert server.provider(model="").name == "openai:only-this"


def test_credentials_in_an_address_are_not_told(scripted: Start) -> None:
    server = scripted([], models=["b", "a"])
    own = server.base_url.replace("http://", "http://me:secret@")
    with pytest.raises(ProviderError) as caught:
        server.provider(model="", base_url=own)
    assert caught.value.diagnostic.hints[1] == f"{own.replace('me:secret', '…')} has a, b"
    provider = connect(Connection("openai", "m", "http://me:secret@127.0.0.1:1/v1", retries=0), {})
    with pytest.raises(ProviderError) as caught:
        provider.reply(SAID, PLAIN, lambda piece: None)
    assert "http://…@127.0.0.1:1/v1" in caught.value.diagnostic.message
    assert "secret" not in str(caught.value.diagnostic)


def test_provider_by_environment(scripted: Start) -> None:
    server = scripted(["yes"])
    provider = connect(Connection(), {"OPENAI_BASE_URL": server.base_url, "AIDL_MODEL": "m"})
    assert provider.reply(SAID, PLAIN, lambda piece: None).model == "m"
    provider.close()
    for environment, name in (
        ({"OPENAI_API_KEY": "k", "AIDL_MODEL": "gpt"}, "openai:gpt"),
        ({"ANTHROPIC_API_KEY": "k", "AIDL_MODEL": "claude"}, "anthropic:claude"),
        ({"AIDL_PROVIDER": "exec:cat", "OPENAI_API_KEY": "k"}, "exec:cat"),
    ):
        provider = connect(Connection(), environment)
        assert provider.name == name
        provider.close()


CHOICES: list[tuple[Connection, dict[str, str], str, str]] = [
    (Connection("openai"), {"OPENAI_API_KEY": "k"}, "E0930", "no model is named"),
    (Connection("anthropic"), {"ANTHROPIC_API_KEY": "k"}, "E0930", "no model is named"),
    (Connection("openai", "m"), {"ANTHROPIC_API_KEY": "k"}, "E0932", "there is no key for openai"),
    (
        Connection(),
        {"OPENAI_API_KEY": "k", "ANTHROPIC_API_KEY": "k"},
        "E0930",
        "the environment speaks for two providers, openai and anthropic",
    ),
    (
        Connection("openai"),
        {"OPENAI_API_KEY": "k\n\x00é"},
        "E0932",
        "OPENAI_API_KEY holds characters that no key has",
    ),
    (Connection("exec:a"), {"AIDL_PRICE": "cheap"}, "E0930", "AIDL_PRICE is `cheap`"),
]


@pytest.mark.parametrize(("said", "environment", "code", "message"), CHOICES)
def test_choices_that_are_wrong(
    said: Connection, environment: dict[str, str], code: str, message: str
) -> None:
    with pytest.raises(ProviderError) as caught:
        connect(said, environment)
    assert (caught.value.diagnostic.code, caught.value.diagnostic.message) == (code, message)


@pytest.mark.parametrize("kind", KINDS)
def test_package_that_is_not_installed(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def refuse(name: str, *rest: Any) -> Any:
        if name == kind:
            raise ModuleNotFoundError(f"No module named '{name}'", name=name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(ProviderError) as caught:
        connect(Connection(kind, "m", "http://127.0.0.1:9/v1"), {})
    told = caught.value.diagnostic
    assert (told.code, told.message) == ("E0931", f"the package `{kind}` is not installed")
    assert told.hints == ("pip install 'aidl-lang[models]'",)


def test_options_become_connection_and_sampling(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("aidl_lang.tools.llm.providers.connect", lambda said: said)
    parser = argparse.ArgumentParser()
    options.add_provider(parser)
    who = "--provider openai --model m --base-url http://x/v1 --timeout 30 --price 2.5/10"
    drawn = "--seed 3 --temperature 0.5 --max-tokens 9"
    arguments = parser.parse_args(f"{who} {drawn}".split())
    said = Connection("openai", "m", "http://x/v1", timeout=30, price=Price(2.5, 10))
    assert options.provider(arguments) == said
    assert options.sampling(arguments) == Sampling(3, 0.5, 9)
    plain = parser.parse_args([])
    assert (options.provider(plain), options.sampling(plain)) == (Connection(), Sampling())
