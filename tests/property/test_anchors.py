"""What a call over equals places follows from what else is placed, not from the order of what is written."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

import aidl_lang
from tests.amount import tries

COUNT = 4


def _solved(lines: list[str], constraints: list[str]) -> dict[str, Any]:
    text = "drawing d {\n" + "\n".join(lines) + "\nconstrain {\n" + "\n".join(constraints) + "\n} }"
    compiled = aidl_lang.compile(text)
    assert compiled.status == "solved", [str(d) for d in compiled.diagnostics]
    found: dict[str, Any] = json.loads(compiled.to_json())
    return found


def _middles(solved: dict[str, Any]) -> dict[str, float]:
    geometry = solved["root"]["geometry"]
    return {name: shape["params"]["center"][0] for name, shape in geometry.items()}


@st.composite
def pictures(draw: st.DrawFn) -> tuple[list[str], list[str], dict[str, float]]:
    """Two mirrored rows of blocks between which one post stands, of which one block is tied to the post: the
    program with guesses off by up to a fifth, its constraints in any order, and the places meant.
    """
    widths = [draw(st.integers(4, 12)) for _ in range(COUNT)]
    gap = draw(st.integers(0, 5))
    tied = draw(st.integers(0, COUNT - 1))
    side = draw(st.sampled_from(["r", "l"]))
    start = draw(st.integers(10, 30))
    meant: dict[str, float] = {"post": 0.0}
    right = float(start)
    for i, width in enumerate(widths):
        meant[f"r{i}"], meant[f"l{i}"] = right + width / 2, -right - width / 2
        right += width + gap
    lines = ["post = rectangle(center: (0, 0), width: 6, height: 30)"]
    for name, x in meant.items():
        if name != "post":
            guess, width = x * (1 + draw(st.floats(-0.2, 0.2))), widths[int(name[1])]
            lines.append(f"{name} = rectangle(center: ({guess:.4f}, 0), width: {width}, height: 8)")
    far = meant[f"r{tied}"] - widths[tied] / 2 - 3
    constraints = [
        f"{side}{tied}.{'right_of' if side == 'r' else 'left_of'}(post, gap: {far})",
        f"row({', '.join(f'r{i}' for i in range(COUNT))}, gap: {gap})",
        *(f"symmetric(l{i}, r{i}, axis: y)" for i in range(COUNT)),
    ]
    return lines, draw(st.permutations(constraints)), meant


@tries(40)
@given(pictures())
def test_one_thing_that_is_placed_places_its_equals(
    picture: tuple[list[str], list[str], dict[str, float]],
) -> None:
    lines, constraints, meant = picture
    found = _middles(_solved(lines, constraints))
    assert {k: round(v, 6) for k, v in found.items()} == {k: round(v, 6) for k, v in meant.items()}


@tries(20)
@given(st.permutations(range(6)), st.lists(st.integers(-20, 20), min_size=7, max_size=7))
def test_the_order_of_constraints_decides_nothing(order: list[int], off: list[int]) -> None:
    """Where nothing is placed, one of the equals begins, always the same."""
    lines = [
        f"b{i} = rectangle(center: ({20 * i + off[i] / 5}, 0), width: {8 + i}, height: 8)" for i in range(7)
    ]
    constraints = [
        "row(b0, b1, b2, gap: 2)",
        "row(b2, b3, gap: 3)",
        "align_center_y([b0, b3, b5])",
        "row(b5, b6, gap: 1)",
        "symmetric(b4, b5, about: b3.center.x)",
        "align_bottom(b1, b4)",
    ]
    usual = _middles(_solved(lines, constraints))
    again = _middles(_solved(lines, [constraints[i] for i in order]))
    assert {k: round(v, 6) for k, v in usual.items()} == {k: round(v, 6) for k, v in again.items()}
