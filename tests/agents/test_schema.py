"""The schemas: valid, complete, in the forms that the APIs take, and true of what the tools return."""

from __future__ import annotations

import inspect
import json
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import jsonschema
import pytest

from aidl_lang.tools.agents.calling import answer, for_anthropic, for_mcp, for_openai
from aidl_lang.tools.agents.tools import Tools
from aidl_lang.tools.cli import main
from tests.agents.test_tools import CONFLICT, PLATE, TELEPHONE
from tests.documents import ROOT

NAMES = ["check", "compile", "guide", "search", "explain", "measure", "edit_param", "explain_conflict"]
VALIDATOR = jsonschema.Draft202012Validator
WRONG = "solid a { b = circle(raduis: w) }"


def objects(schema: Any) -> Iterator[dict[str, Any]]:
    """Every schema of an object in a schema."""
    if isinstance(schema, dict):
        if schema.get("type") == "object":
            yield schema
        for inner in schema.values():
            yield from objects(inner)
    elif isinstance(schema, list):
        for inner in schema:
            yield from objects(inner)


@pytest.mark.parametrize(
    ("style", "made"), [("openai", for_openai), ("anthropic", for_anthropic), ("mcp", for_mcp)]
)
def test_command_prints_the_tools(style: str, made: Any, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tool-schema", "--style", style]) == 0
    assert json.loads(capsys.readouterr().out) == made()


def test_schemas_are_valid_and_describe_every_parameter() -> None:
    inputs = {
        "openai": [(t["function"]["name"], t["function"], t["function"]["parameters"]) for t in for_openai()],
        "anthropic": [(t["name"], t, t["input_schema"]) for t in for_anthropic()],
        "mcp": [(t["name"], t, t["inputSchema"]) for t in for_mcp()],
    }
    for tools in inputs.values():
        assert [name for name, _, _ in tools] == NAMES
        for name, tool, schema in tools:
            VALIDATOR.check_schema(schema)
            assert len(tool["description"]) > 40
            assert "$ref" not in json.dumps(schema)
            given = inspect.signature(getattr(Tools, name)).parameters
            assert [p for p in given if p != "self"] == list(schema["properties"])
            assert all(len(p["description"]) > 15 for p in schema["properties"].values())
    for tool in for_mcp():
        VALIDATOR.check_schema(tool["outputSchema"])
        assert tool["outputSchema"]["type"] == "object"


def test_strict_form_is_what_strict_mode_takes() -> None:
    """Every object closed and all its members required; what may be left out may be null."""
    for tool in for_openai():
        function = tool["function"]
        assert (tool["type"], function["strict"]) == ("function", True)
        for schema in objects(function["parameters"]):
            assert schema["additionalProperties"] is False
            assert schema["required"] == list(schema["properties"])
            assert not any("default" in member for member in schema["properties"].values())
    compile = for_openai()[1]["function"]["parameters"]
    call = dict.fromkeys(compile["properties"]) | {
        "program": PLATE,
        "params": [{"name": "width", "value": 60}],
        "formats": [],
    }
    VALIDATOR(compile).validate(call)
    assert answer(Tools(), "compile", call).data["bodies"][0]["right"] == 30


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("check", {"program": WRONG}),
        ("check", {"program": PLATE}),
        ("compile", {"program": TELEPHONE, "formats": ["png", "model", "svg"], "dimensioned": True}),
        ("compile", {"program": WRONG, "files": {"x.aidl": ""}}),
        ("compile", {"program": CONFLICT, "formats": ["model"]}),
        ("compile", {"program": "solid a { b = circle(radius: 1e300) }", "params": {}}),
        ("guide", {}),
        ("guide", {"section": "Loops, lists, definitions", "variant": "no-hierarchy"}),
        ("search", {"query": "gear", "limit": 3}),
        ("explain", {"name": "W0701"}),
        ("measure", {"program": TELEPHONE, "path": "receiver", "params": {"width": 200}}),
        ("edit_param", {"program": PLATE, "name": "width", "value": 50}),
        ("explain_conflict", {"program": CONFLICT}),
        ("explain_conflict", {"program": PLATE}),
    ],
)
def test_calls_and_results_are_as_described(name: str, arguments: dict[str, Any]) -> None:
    tool = next(t for t in for_mcp() if t["name"] == name)
    VALIDATOR(tool["inputSchema"]).validate(arguments)
    made = answer(Tools(), name, arguments)
    assert not made.is_error, made.text
    VALIDATOR(tool["outputSchema"]).validate(json.loads(json.dumps(made.data, allow_nan=False)))


def test_schema_does_not_need_the_packages_of_the_server() -> None:
    code = (
        "import sys; from aidl_lang.tools.cli import main; main(['tool-schema']); "
        "print(*sys.modules, file=sys.stderr)"
    )
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True, cwd=ROOT
    )
    assert {"mcp", "pydantic", "multiprocessing", "starlette", "jsonschema"} & set(
        loaded.stderr.split()
    ) == set()
