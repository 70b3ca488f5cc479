"""Whatever is thrown at it: no exception, no long wait, the same answer each time."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.amount import TRIES_ALL
from tests.compiled import EXAMPLES
from tests.typecheck.checking import checked


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_have_nothing_to_complain_about(path: Path) -> None:
    assert [d.message for d in checked(path.read_text(encoding="utf-8"))[1]] == []


@pytest.mark.parametrize("path", EXAMPLES[:3], ids=lambda path: path.stem)
def test_every_prefix_of_a_program_is_survived(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    for end in range(0, len(text), 37 if TRIES_ALL else 149):
        checked(text[:end])


@pytest.mark.parametrize(
    "text",
    [
        "solid s { let x = " + "(" * 90 + "1" + ")" * 90 + " }",
        "solid s { let x = " + "+".join("x1" for _ in range(90)) + " }",
        "solid s { let x = [" + ", ".join(f"({i}, {i})" for i in range(20_000)) + "] }",
        "solid s {\n" + "\n".join(f"let v{i} = v{i + 1}" for i in range(5_000)) + "\nlet v5000 = 1 }",
        "solid s {\n" + "\n".join(f"let v{i} = v{i + 1} + v{(i * 7) % 900}" for i in range(900)) + " }",
        "\n".join(f"solid s{i} {{ r = circle(radius: {i}) }}" for i in range(3_000)),
        "fn f(n) = f(n)\nfn g(n) = h(n)\nfn h(n) = g(n)\nsolid s { let x = f(1) + g(2) }",
        "shape f(n) { inner = f(n) }\nsolid s { a = f(1)\n let x = a.inner.inner.inner.n }",
        "solid t(n) { inner = t(n) }\nsolid s { a = t(1)\n let x = a.inner.inner.inner.n }",
        "alias circle = circle\nsolid s { a = circle(radius: 3) }",
        "solid s { s = s\n a = a.a\n hole s { s = s } }",
        "for i in 0..3 { for i in i { i[i] = i } }",
        "constrain constrain constrain { } = { }",
        "solid s { param p = p in p..p step p }",
    ],
    ids=range(14),
)  # fmt: skip
def test_hostile_programs(text: str) -> None:
    _, found = checked(text)
    assert all(d.code for d in found)


def test_the_same_program_gives_the_same_answer() -> None:
    text = "\n".join(
        f"solid s{i} {{ a = circle(center: s{i - 1}.a.center, radius: s{i - 1}.b + q) }}"
        for i in range(1, 20)
    )
    answers = {tuple(map(str, checked(text)[1])) for _ in range(3)}
    assert len(answers) == 1
