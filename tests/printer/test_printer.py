"""Runs `canonical.md`: layout, comments, blank lines, one-line blocks, long lines."""

from __future__ import annotations

from pathlib import Path

import pytest

import aidl_lang
from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import format_module
from tests.documents import blocks

BLOCKS = list(blocks(Path(__file__).with_name("canonical.md")))


@pytest.mark.parametrize(("written", "canonical"), [*zip(BLOCKS[::2], BLOCKS[1::2], strict=True)])
def test_canonical_form(written, canonical) -> None:  # type: ignore[no-untyped-def]
    assert (written.language, canonical.language) == ("written", "canonical")
    assert aidl_lang.format(written.text) == canonical.text
    assert aidl_lang.format(canonical.text) == canonical.text


@pytest.mark.parametrize("width", [99, 100, 101])
def test_attributes_fill_a_line_to_its_end(width: int) -> None:
    name = "a" * (width - len('@color("red") solid  {'))
    gap = " " if width <= 100 else "\n"
    assert (
        aidl_lang.format(f'@color("red") solid {name} {{\n}}') == f'@color("red"){gap}solid {name} {{\n}}\n'
    )


@pytest.mark.parametrize("text", ["", "\n\n", "// only\n", "/* a\n   b */\n", "let a = 3\r\n\r\n"])
def test_ends_of_files_and_lines(text: str) -> None:
    plain = text.replace("\r", "").strip("\n")
    assert aidl_lang.format(text) == plain + ("\n" if plain else "")


def test_names_are_spelled_as_asked() -> None:
    module = parse(SourceFile("", "CenteredIn(hole_a, Plate)\nx = Circle(radius: 5)\n")).module
    other = {"CenteredIn": "centered_in", "Circle": "circle"}
    found = [node for node in ast.walk(module) if isinstance(node, ast.Identifier) and node.text in other]
    names = {node: other[node.text] for node in found}
    assert format_module(module, names) == "centered_in(hole_a, Plate)\nx = circle(radius: 5)\n"
