"""A change touches the lines that it changes, and means what the model wrote."""

from __future__ import annotations

import difflib
import re
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.common.source import SourceFile
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.tools.llm.aidl import merge
from tests.amount import tries
from tests.compiled import EXAMPLES

TELEPHONE = (Path(__file__).parents[2] / "examples/telephone.aidl").read_text("utf-8")


def carelessly(text: str) -> str:
    """The program as a model may hand it back: without comments, and laid out in another way."""
    bare = re.sub(r"[ \t]*//[^\n]*", "", text)
    return re.sub(r"\n\s*\n", "\n", bare).replace("    ", "\t")


def changed(before: str, after: str) -> list[str]:
    lines = difflib.unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    return [line for line in lines if line[:1] in "+-" and line[:3] not in ("+++", "---")]


def tree(text: str) -> ast.Module:
    parsed = parse(SourceFile("part.aidl", text))
    assert not parsed.diagnostics
    return parsed.module


def test_a_comment_behind_a_changed_line_stays() -> None:
    after = carelessly(TELEPHONE).replace("guess(15)", "guess(14)")
    assert changed(TELEPHONE, merge(TELEPHONE, after)) == [
        "-        right_ear = circle(center: (55, 60), radius: guess(15))"
        "  // a little off: constraints mend it",
        "+        right_ear = circle(center: (55, 60), radius: guess(14))"
        "  // a little off: constraints mend it",
    ]


def test_what_does_not_parse_is_handed_on_as_it_is() -> None:
    assert merge(TELEPHONE, "solid a {") == "solid a {"
    assert merge("solid a {", TELEPHONE) == TELEPHONE


@tries(40)
@given(st.sampled_from(EXAMPLES), st.data())
def test_the_result_means_what_was_written(path: Path, data: st.DataObject) -> None:
    """Whatever lines a model leaves out or writes anew: if it parses, the result is the same program."""
    text = path.read_text("utf-8")
    lines = carelessly(text).splitlines()
    for _ in range(data.draw(st.integers(0, 3))):
        place = data.draw(st.integers(0, len(lines) - 1))
        lines[place] = data.draw(
            st.sampled_from(
                ["", re.sub(r"\d+", "7", lines[place]), f"{lines[place]} ; todo", lines[place] + lines[place]]
            )
        )
    after = "\n".join(lines)
    if not parse(SourceFile("part.aidl", after)).diagnostics:
        assert ast.same(tree(carelessly(merge(text, after))), tree(after))
