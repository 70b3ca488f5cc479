"""Completion, hover and signature help answer at any place of any text, whatever it says."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from aidl_server.ide.completion import complete
from aidl_server.ide.hover import hover
from aidl_server.ide.signatures import signature_help
from aidl_server.ide.workspace import View, Workspace, look, run
from server.tests.ide.conftest import seen, solved_at
from tests.amount import TRIES_ALL
from tests.compiled import FEW
from tests.fuzz.sources import mutant


def _ask(view: View, offset: int, files: Callable[[], list[Path]]) -> None:
    text = view.source.text
    found = complete(view, offset, files)
    for completion in found:
        assert 0 <= completion.span.start <= completion.span.end <= len(text)
    assert all(isinstance(c.documentation, str) for c in found[:2])
    said = hover(view, offset)
    assert said is None or said.text
    shown = signature_help(view, offset)
    if shown is not None:
        overload = shown.overloads[shown.active]
        assert overload.active is None or overload.active < len(overload.parameters)


@pytest.mark.parametrize("path", FEW)
def test_every_place_is_answered(path: Path) -> None:
    chance = random.Random(f"all of {path.stem}")
    text = path.read_text("utf-8")
    workspace = Workspace([path.parent])
    world = workspace.world(path)

    def views() -> Iterator[View]:
        yield solved_at(path)
        for number in range(5 if TRIES_ALL else 1):
            view = look(path, mutant(chance, [text]), world)
            yield view if number else run(view)
        yield look(path, "\ufeff" + text.replace("\n", "\r\n"), world)

    for number, view in enumerate(views()):
        for _ in range(3 if number else 12 if TRIES_ALL else 6):
            _ask(view, chance.randrange(-1, len(view.source.text) + 2), workspace.programs)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "\ufeff",
        ".",
        "@",
        "a.",
        "solid",
        "solid a {",
        "solid a { r = circle(center: (0, ",
        "solid a { constrain { for i in ",
        "constrain a.",
        'import "',
        "import x from ",
        "fn f(x: ",
        "let a = a\nlet b = a.",
        "solid a { b = b.c.",
        "fn f(x) = f(x)\nsolid a { r = circle(radius: f(3)) }",
        "(" * 60,
        "solid a { r = " + "[" * 40,
        "let a = " + "-" * 40 + "1",
        "\U0001d51b\U0001d51c = \U0001d51b.",
        "\r\n\t\r\n",
    ],
)
def test_every_place_of_odd_texts_is_answered(text: str) -> None:
    view = seen(text, solved=True)
    step = max(1, len(text) // 12)
    for offset in range(0, len(text) + 1, step):
        _ask(view, offset, list)
    _ask(view, len(text), list)
