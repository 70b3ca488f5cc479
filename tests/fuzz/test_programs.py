"""What broke something once: the programs of `programs/`, and larger ones that are written here."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.amount import large, tried
from tests.compiled import lighter
from tests.fuzz.judge import finding
from tests.fuzz.minimise import minimised
from tests.fuzz.sources import FOUND, program

WRITTEN = sorted(FOUND.glob("*.aidl"))


def _doubled(first: str, again: str, times: int, end: str) -> str:
    """Constants, each made of the one before it twice."""
    made = [f"let a{k} = " + again.format(a=f"a{k - 1}") for k in range(1, times)]
    return "\n".join([f"let a0 = {first}", *made, end.format(a=f"a{times - 1}")])


def _doubled_constraint(times: int) -> str:
    made = [f"constraint q{k}(a: box) {{ q{k - 1}(a), q{k - 1}(a) }}" for k in range(1, times)]
    use = f"solid s {{ r = circle(radius: 3) constrain q{times - 1}(r) }}"
    return "\n".join(["constraint q0(a: box) { a.left == 0 }", *made, use])


DEEP = 1050
"""Deeper than Python calls."""

LARGE = {
    "lists doubled": _doubled("[1, 2]", "{a} + {a}", 40, "solid s {{ r = circle(radius: len({a})) }}"),
    "lists in lists": _doubled("[1]", "[{a}, {a}]", 40, "solid s {{ r = circle(radius: len({a})) }}"),
    "lists in lists compared": _doubled("[1]", "[{a}, {a}]", 40, "assert {a} == {a}"),
    "lists in lists as text": _doubled("[1]", "[{a}, {a}]", 40, "@note(str({a})) solid s {{}}"),
    "lists one in the other": _doubled(
        "[1]", "[{a}]", max(large(3000), DEEP), "solid s {{ r = circle(radius: len({a})) }}"
    ),
    "records in records": _doubled("record(a: 1)", "record(a: {a}, b: {a})", 40, "assert {a}.a == 1"),
    "texts doubled": _doubled('"abcdefgh"', "{a} + {a}", 40, "solid s {{ t = text({a}, height: 5) }}"),
    "constants one from the other": _doubled(
        "1", "{a} + 1", large(9000), "solid s {{ r = circle(radius: {a}) }}"
    ),
    "constraints doubled": _doubled_constraint(24),
    "many errors": "\n".join(f"solid s{k} {{ r = nope{k}(radius: x{k}) }}" for k in range(large(4000))),
    "many names, much alike": "\n".join(
        [f"solid structure_number_{k} {{ r = circle(radius: 1) }}" for k in range(large(1500))]
        + [f"constrain structure_nmber_{k}.left == 0" for k in range(large(500))]
    ),
    "nested brackets": f"drawing d {{ for i in enumerate({'[' * 190}{']' * 190}) {{}} }}",
    "a long text": f'drawing s {{ t = text("{"Ag" * large(2000)}", height: 5) }}',
    "many labels": f"assembly a {{ for i in 0..<{large(1200)} "
    "{ solid s[i] at (9 * i, 0) { c = circle(radius: 3) } } }",
    "all boxes meet": f"solid s {{ for i in 0..{large(1600)} "
    "{ c[i] = circle(center: (i * 0.001, 0), radius: 20) } }",
    "all of many boxes meet": "solid s { for i in 0..5000 "
    "{ c[i] = circle(center: (i * 0.001, 0), radius: 20) } }",
}


DEAR = {
    "crowd_of_circles",
    "gear_of_12000_teeth",
    "hole_beside_a_loose_piece",
    "member_of_two_conflicts",
    "offset_of_800_circles",
    "path_of_4000_steps",
    "thick_spline_of_400_points",
}
"""What took long even when it no longer takes for ever; on every run `LARGE` shows that there are limits."""


@pytest.mark.parametrize("path", lighter(WRITTEN, DEAR))
def test_nothing_breaks_any_more(path: Path) -> None:
    assert finding(path.read_text("utf-8")) is None


QUICK = {"lists doubled", "texts doubled", "nested brackets", "many labels"}
"""Those tried on every run: of lists, texts, the parser and drawings."""


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(text, id=name, marks=[] if name in QUICK else [pytest.mark.slow])
        for name, text in LARGE.items()
    ],
)
def test_what_is_large_ends_too(text: str) -> None:
    assert finding(text) is None


@pytest.mark.parametrize(
    "seed", [pytest.param(n, marks=[pytest.mark.slow] if n == 2 else []) for n in range(tried(60))]
)
def test_whatever_is_written_ends_with_an_answer(seed: int) -> None:
    """Soups of tokens, programs with something changed, random calls and assemblies."""
    assert finding(program(seed)[1]) is None


def test_a_program_follows_from_its_seed() -> None:
    assert [program(seed) for seed in range(8)] == [program(seed) for seed in range(8)]


def test_what_breaks_is_made_small() -> None:
    text = "solid a {\n    b = circle(radius: 3)\n}\nsolid c { d = rectangle(width: 7, height: 2) }\n"
    assert minimised(text, lambda t: "width" in t and "}" in t, seconds=60.0) in ("width}", "}width")
