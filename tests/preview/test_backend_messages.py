from __future__ import annotations

import json

import pytest

from aidl_lang.tools.preview.messages import ApplyFix, Cancel, Drag, Export, Ready, SetKnob, Show, read


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"type": "ready"}, Ready()),
        ({"type": "cancel"}, Cancel()),
        ({"type": "knob", "path": "a.b", "value": 3, "final": False}, SetKnob("a.b", 3, False)),
        ({"type": "knob", "path": "a", "value": True, "final": True}, SetKnob("a", True, True)),
        ({"type": "knob", "path": "a", "value": "m5", "final": True}, SetKnob("a", "m5", True)),
        ({"type": "drag", "id": "p", "to": [1, -2.5], "final": True}, Drag("p", (1.0, -2.5), True)),
        ({"type": "fix", "problem": 2, "fix": 0}, ApplyFix(2, 0)),
        ({"type": "export", "format": "pdf"}, Export("pdf")),
        ({"type": "show", "layers": ["names", "names", "dof"]}, Show(frozenset({"names", "dof"}))),
    ],
)
def test_messages_are_read(data: object, message: object) -> None:
    assert read(json.dumps(data)) == message


@pytest.mark.parametrize(
    "text",
    [
        "",
        "null",
        "[]",
        "7",
        '"ready"',
        "{",
        "[" * 60_000,
        '{"a":' * 10_000,
        '{"type": "nothing"}',
        '{"type": ["ready"]}',
        '{"type": "hover", "element": 3}',
        '{"type": "goto", "element": 3}',
        '{"type": "knob", "path": "a", "value": 1}',
        '{"type": "knob", "path": "a", "value": null, "final": true}',
        '{"type": "knob", "path": "a", "value": {}, "final": true}',
        '{"type": "knob", "path": "a", "value": NaN, "final": true}',
        '{"type": "knob", "path": "a", "value": 1e999, "final": true}',
        '{"type": "knob", "path": "a", "value": ' + "9" * 4000 + ', "final": true}',
        '{"type": "knob", "path": "' + "a" * 2000 + '", "value": 1, "final": true}',
        '{"type": "drag", "id": "p", "to": [1], "final": true}',
        '{"type": "drag", "id": "p", "to": [1, "2"], "final": true}',
        '{"type": "drag", "id": "p", "to": [1, true], "final": true}',
        '{"type": "drag", "id": "p", "to": [Infinity, 1], "final": true}',
        '{"type": "fix", "problem": "0", "fix": 0}',
        '{"type": "show", "layers": "names"}',
        '{"type": "show", "layers": [1]}',
    ],
)
def test_anything_else_is_no_message(text: str) -> None:
    assert read(text) is None
