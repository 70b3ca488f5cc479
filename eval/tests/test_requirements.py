"""Prompts with executable requirements: good programs meet all, and a mistake fails what it breaks."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from aidl_eval.measures import drawn
from aidl_eval.requirements import Prompt, PromptError, Result, examine, load, read
from aidl_lang.common.source import SourceFile
from aidl_lang.pipeline import compile
from eval.tests.asked import NAMES, TEXTS, prompts
from tests.documents import ROOT

PROGRAMS = Path(__file__).parent / "programs"
ASKED = """
old-school telephone, lighthouse, teapot, bicycle, mailbox, table lamp, house with a chimney, coffee
mug, sailing boat, acoustic guitar, robot face, pair of scissors, wall clock, chess rook, panelled door
with a handle, tractor, gear with mounting holes, cabinet with drawers, fountain pen, steam locomotive,
windmill, film camera, office chair, claw hammer, sunglasses, castle, space rocket, birdhouse, floppy
disk, wall socket plate, game controller, umbrella, barbell, toaster, street lamp, padlock
"""


def good(name: str) -> str:
    path = PROGRAMS / f"{name}.aidl"
    return (path if path.exists() else ROOT / f"examples/{name}.aidl").read_text(encoding="utf-8")


def examined(prompt: Prompt, text: str) -> tuple[Result, ...]:
    return examine(prompt, drawn(compile(SourceFile("program.aidl", text))))


def unmet(prompt: Prompt, text: str) -> dict[str, str]:
    """What is asked for and not met, with the reason."""
    return {r.text: r.detail for r in examined(prompt, text) if not r.is_met}


def test_prompts_are_those_of_the_experiment_in_their_order() -> None:
    asked = " ".join(ASKED.split()).split(", ")
    assert list(TEXTS.values()) == asked
    assert {name: prompt.text for name, prompt in prompts().items()} == TEXTS
    assert [prompt.text for prompt in load(ROOT / "eval/aidl_eval/prompts")] == asked


@pytest.mark.parametrize("name", NAMES)
def test_requirements_say_what_they_ask_for(name: str) -> None:
    texts = prompts()[name].requirements
    assert len(texts) >= 2
    assert len(set(texts)) == len(texts)


@pytest.mark.parametrize("name", NAMES)
def test_a_disc_is_none_of_them(name: str) -> None:
    prompt = prompts()[name]
    results = examined(prompt, "solid disc { rim = circle(radius: 5) }")
    assert [r.text for r in results] == list(prompt.requirements)
    assert any(not r.is_met for r in results)


@pytest.mark.parametrize("name", NAMES)
def test_a_good_program_meets_all(name: str) -> None:
    assert unmet(prompts()[name], good(name)) == {}


MISTAKES = [
    pytest.param(name, mistake["right"], mistake["wrong"], mistake["fails"], id=f"{name}-{number}")
    for name, mistakes in tomllib.loads((Path(__file__).parent / "mistakes.toml").read_text("utf-8")).items()
    for number, mistake in enumerate(mistakes)
]


@pytest.mark.parametrize(("name", "right", "wrong", "expected"), MISTAKES)
def test_a_mistake_fails_what_it_breaks(name: str, right: str, wrong: str, expected: list[str]) -> None:
    text = good(name)
    assert text.count(right) == 1
    assert list(unmet(prompts()[name], text.replace(right, wrong))) == expected


def asking(measure: str, value: str) -> Prompt:
    text = f'/// x\nassembly x {{ var {measure} = 1 assert {measure} == {value}, "it" }}'
    return read(SourceFile("1-x.aidl", text))


def test_what_fails_is_told_in_numbers() -> None:
    assert unmet(asking("pieces", "2"), "solid s { a = square(size: 10) }") == {"it": "1 is not == 2"}


SQUARES = "a = square(size: 10) b = square(center: fixed(({}, 0)), size: 10)"
MEASURED = [
    ("pieces", "1", f"drawing t {{ d = circle(radius: 90) }} solid s {{ {SQUARES.format(10.4)} }}"),
    ("pieces", "2", f"solid s {{ {SQUARES.format(10.6)} }}"),  # 2 % of 20.6 mm are 0.41 mm
    # A right triangle has its centroid at a third of its base; its image there has 6 of its 9 mm².
    ("symmetry", "2 / 3", "solid s { t = right_triangle(width: 6, height: 3) }"),
    ("symmetry", "1", "solid s { t = star(outer_radius: 9, inner_radius: 4, points: 5, angle: 90deg) }"),
    ("teeth", "5", "solid s { t = star(outer_radius: 9, inner_radius: 4, points: 5) }"),
    ("openings", "2", "solid s { t = ring(outer_radius: 9, inner_radius: 8) u = square(size: 2)"
     " v = rectangle(center: (0, 0), width: 17, height: 1) }"),
    ("battlements", "2", "solid s { t = u_shape(width: 20, height: 20, thickness: 3) }"),
]  # fmt: skip


@pytest.mark.parametrize(("measure", "value", "text"), MEASURED)
def test_measures_of_a_whole_drawing(measure: str, value: str, text: str) -> None:
    assert unmet(asking(measure, value), text) == {}


@pytest.mark.parametrize("measure", ["symmetry", "teeth", "battlements"])
def test_an_empty_drawing_has_no_measures(measure: str) -> None:
    why = f"nothing is drawn of which `{measure} == 1` could be asked"
    assert unmet(asking(measure, "1"), "assembly a { }") == {"it": why}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("assembly a { }", "a.aidl: the comment before the root is to say what is asked for"),
        ("/// a\nassembly a {\nassert 1 == 1 }", "a.aidl:3: the assert does not say what it asks for"),
        ("/// a\nassembly a {\nassert lid.top >= 1 }", "a.aidl:3: there is no `lid` here"),
    ],
)
def test_a_file_that_is_no_prompt_says_why(text: str, message: str) -> None:
    with pytest.raises(PromptError) as caught:
        read(SourceFile("a.aidl", text))
    assert str(caught.value).startswith(message)
