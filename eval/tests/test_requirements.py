"""Prompts with executable requirements: good programs meet all, and a mistake fails what it breaks."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from aidl_eval.requirements import (
    Prompt,
    PromptError,
    Result,
    Status,
    examine,
    load,
    read,
)
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
    source = SourceFile("program.aidl", text)
    return examine(prompt, source, compile(source))


def unmet(prompt: Prompt, text: str) -> dict[str, str]:
    """What is asked for and not met, with the reason."""
    return {r.text: r.detail for r in examined(prompt, text) if r.status is not Status.MET}


def test_prompts_are_those_of_the_experiment_in_their_order() -> None:
    asked = " ".join(ASKED.split()).split(", ")
    assert list(TEXTS.values()) == asked
    assert {name: prompt.text for name, prompt in prompts().items()} == TEXTS
    assert [prompt.text for prompt in load(ROOT / "eval/aidl_eval/prompts")] == asked


@pytest.mark.parametrize("name", NAMES)
def test_requirements_say_what_they_ask_for(name: str) -> None:
    prompt = prompts()[name]
    texts = [requirement.text for requirement in prompt.requirements]
    assert len(texts) >= 5
    assert len(set(texts)) == len(texts)


@pytest.mark.parametrize("name", NAMES)
def test_a_disc_is_none_of_them(name: str) -> None:
    prompt = prompts()[name]
    results = examined(prompt, "solid disc { rim = circle(radius: 5) }")
    assert [r.text for r in results] == [r.text for r in prompt.requirements]
    assert any(r.status is not Status.MET for r in results)


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


# --- Names that models choose ----------------------------------------------------------------------

WHEELS = read(
    SourceFile(
        "1-cart.aidl",
        """
        /// cart
        assembly cart {
            solid whole { todo }
            var pieces = 1
            param wheel_count = 2 in 1..4
            for i in 0..<wheel_count {
                @note("wheel, tyre / tire; not steering wheel") solid wheel[i] { todo }
            }
            @note("body, box; of plank") solid body { todo }
            param bell_count = 1 in 0..9
            for i in 0..<bell_count { @note("bell") solid bell[i] { todo } }
            assert len(wheel) == 2, "two wheels"
            for w in wheel { assert w.width == 10, "wheels of 10 mm" }
            assert area(body) == 200, "a body of 200 mm²"
            for b in bell { assert inside(b, body), "bells in the body" }
            assert pieces == 1, "one piece"
        }
        """,
    )
)
BODY = "body = rectangle(center: (0, 8), width: 40, height: 5)"
ROUND = "circle(center: ({}, 5), radius: 5)"
LEFT, RIGHT = ROUND.format(-10), ROUND.format(10)
CARTS = {
    "arrays": f"solid body {{ {BODY} }} for i in 0..1 {{ solid Wheels[i] {{ rim = {LEFT} }} }}"
    " constrain Wheels[1].center_x == body.center_x + 10",
    "places and camel case": f"solid cartBody {{ {BODY} }} solid frontWheel {{ r = {LEFT} }}"
    f" solid wheel_rear {{ r = {RIGHT} }} solid steering_wheel {{ r = circle(center: (0, 9), radius: 1) }}",
    "templates": f"solid body {{ {BODY} }} solid wheel(x = 0) {{ rim = circle(center: (x, 5), radius: 5) }}"
    " front = wheel(x: 10) rear = wheel(x: -10)",
    "a group": f"solid box {{ {BODY} }} assembly wheels {{ solid front {{ r = {LEFT} }}"
    f" solid rear {{ r = {RIGHT} }} }}",
    "geometry of a plural": f"solid box {{ {BODY} }} solid wheels {{ front = {LEFT} rear = {RIGHT} }}",
    "synonyms": f"solid box {{ {BODY} }} solid tyre {{ r = {LEFT} }} solid tire_2 {{ r = {RIGHT} }}",
    "geometry alone": f"solid all {{ {BODY} left_wheel = {LEFT} right_wheel = {RIGHT} }}",
    "parts of parts": f"solid all {{ {BODY} left_wheel_rim = {LEFT} right_wheel_rim = {RIGHT}"
    " left_wheel_hub = circle(center: (-10, 5), radius: 1)"
    " right_wheel_hub = circle(center: (10, 5), radius: 1) }",
    "what an outline is made of": f"solid all {{ {BODY} rear_wheel = {LEFT} front_wheel = {RIGHT}"
    " hub = circle(center: (10, 5), radius: 1) cart = cut(union(body, rear_wheel, front_wheel), hub) }",
    "what is put together with others": f"solid all {{ b = {BODY[7:]} rear_wheel = {LEFT}"
    f" front_wheel = {RIGHT} body = union(b, rear_wheel, front_wheel) }}",
    "what is cut out": "solid all { sheet = rectangle(center: origin, width: 90, height: 70)"
    f" wheel_1 = {LEFT} wheel_2 = {RIGHT} {BODY} rest = cut(sheet, wheel_1, wheel_2, body) }}",
    "copies of what is made of others": f"solid all {{ {BODY} wheel_rim = {LEFT}"
    " wheel_hub = circle(center: (-10, 5), radius: 1) half = cut(wheel_rim, wheel_hub)"
    " other = mirror(half, about: y_axis) cart = union(half, other) }",
    "an outline that has another's name": f"solid all {{ {BODY} wheel_outline = {LEFT}"
    " bore = circle(center: (-10, 5), radius: 1) rear = cut(wheel_outline, bore)"
    f" wheel = {RIGHT} ring_of_wheel = circle(center: (0, 8), radius: 9) }}",
    "halves": "solid back_body { b = rectangle(center: (-10, 8), width: 20, height: 5) }"
    " solid front_body { b = rectangle(center: (10, 8), width: 20, height: 5) }"
    f" solid wheels {{ front = {LEFT} rear = {RIGHT} }}",
    "what it is made of": "for i in 0..3 { solid plank[i] {"
    " b = rectangle(center: (10 * i - 15, 8), width: 10, height: 5) } }"
    f" solid wheels {{ front = {LEFT} rear = {RIGHT} }}",
    "a part that holds the others": f"solid body {{ {BODY} solid wheel_1 {{ r = {LEFT} }}"
    f" solid wheel_2 {{ r = {RIGHT} }} }}",
    "names of the prompt itself": f"param pieces = 7 fn area(x) = 3 fn len(x) = 9 let whole = 5"
    f" solid body {{ {BODY} }} solid wheel {{ rim = {LEFT} }} solid wheel_2 {{ rim = {RIGHT} }}",
}


@pytest.mark.parametrize("text", CARTS.values(), ids=CARTS.keys())
def test_roles_are_found_by_what_things_are_called(text: str) -> None:
    assert unmet(WHEELS, f"assembly cart {{ {text} }}") == {}


def test_what_fails_is_told_in_numbers_and_names() -> None:
    text = CARTS["synonyms"].replace("radius: 5", "radius: 6", 1)
    assert unmet(WHEELS, f"assembly cart {{ {text} }}") == {
        "wheels of 10 mm": "12 is not == 10 (wheel: cart.tyre, cart.tire_2)"
    }


def test_how_many_were_found_is_told() -> None:
    text = f"assembly cart {{ solid box {{ {BODY} }} solid wheel {{ rim = {LEFT} }} }}"
    assert unmet(WHEELS, text) == {"two wheels": "`len(wheel) == 2` is false (wheel: cart.wheel)"}


def test_a_role_that_is_not_there_cannot_be_measured() -> None:
    results = examined(WHEELS, f"assembly cart {{ solid box {{ {BODY} }} }}")
    assert [(r.status.value, r.detail) for r in results] == [
        ("unmeasurable", "no wheel was found"),
        ("unmeasurable", "no wheel was found"),
        ("met", ""),
        ("met", ""),  # a bell is not asked for
        ("met", ""),
    ]


def test_of_too_many_none_is_measured() -> None:
    found = unmet(
        WHEELS, f"assembly c {{ solid box {{ {BODY} }} for i in 0..5 {{ solid wheel[i] {{ r = {LEFT} }} }} }}"
    )
    assert found == {
        "two wheels": "6 of `wheel` were found, and 4 at most are looked at",
        "wheels of 10 mm": "6 of `wheel` were found, and 4 at most are looked at",
    }


def test_what_lies_apart_is_another_part() -> None:
    bodies = "for i in 0..1 { solid body[i] { b = rectangle(center: (50 * i, 8), width: 40, height: 5) } }"
    wheels = f"solid wheels {{ front = {LEFT} rear = {RIGHT} }}"
    assert unmet(WHEELS, f"assembly cart {{ {bodies} {wheels} }}") == {
        "one piece": "2 is not == 1",
    }


def test_what_is_inside_material_is_not_to_be_seen() -> None:
    sheet = "sheet = rectangle(center: (0, 5), width: 90, height: 70)"
    buried = {
        "two wheels": "`cart.wheel_1` is inside other material and is not to be seen",
        "wheels of 10 mm": "`cart.wheel_1` is inside other material and is not to be seen",
        "a body of 200 mm²": "`cart.body` is inside other material and is not to be seen",
        "bells in the body": "`cart.body` is inside other material and is not to be seen",
    }
    assert unmet(WHEELS, f"solid cart {{ {sheet} {BODY} wheel_1 = {LEFT} wheel_2 = {RIGHT} }}") == buried
    filled = f"patch = {sheet[8:]} rest = cut(sheet, body, wheel_1, wheel_2)"
    assert (
        unmet(WHEELS, f"solid cart {{ {sheet} {BODY} wheel_1 = {LEFT} wheel_2 = {RIGHT} {filled} }}")
        == buried
    )


def test_the_edges_of_a_shape_stand_for_what_is_between_them() -> None:
    text = """
        solid home {
            body = house(center: origin, width: 100, height: 120, roof_height: 45)
            chimney = rectangle(center: (28, 50), width: 12, height: 40)
            door = rectangle(center: (0, -42), width: 20, height: 36)
            front = cut(union(body, chimney), door)
        }"""
    assert unmet(prompts()["house"], text) == {}
    assert list(unmet(prompts()["house"], text.replace("(28, 50)", "(28, 150)"))) == [
        "the chimney stands on the roof",
        "the parts hold together",
    ]


def test_strokes_cover_no_area() -> None:
    found = unmet(WHEELS, f"assembly c {{ drawing body {{ {BODY} }} {CARTS['templates'].split('}', 1)[1]} }}")
    assert found["a body of 200 mm²"] == "`c.body` covers no area"


def test_a_program_that_is_wrong_or_not_solved_meets_nothing() -> None:
    wrong = {r.text for r in WHEELS.requirements}
    assert unmet(WHEELS, "assembly cart { solid box { b = } }") == dict.fromkeys(
        wrong, "the program is wrong, so nothing is drawn"
    )
    assert unmet(WHEELS, "solid a { c = circle(radius: 5) constrain { c.radius == 5 c.radius == 6 } }") == (
        dict.fromkeys(wrong, "the constraints were not solved, so nothing is in its place")
    )


def asking(measure: str, value: str) -> Prompt:
    return read(
        SourceFile("x.aidl", f'/// x\nassembly x {{ var {measure} = 1 assert {measure} == {value}, "it" }}')
    )


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
        ("/// a\nassembly a { solid lid { todo } }", "a.aidl: `lid` has no `@note` of the words it goes by"),
        (
            '/// a\nassembly a { @note("lid; nor cap") solid lid { todo } }',
            "a.aidl: in the `@note` of `lid`, `nor cap` is neither `not …` nor `of …`",
        ),
        (
            '/// a\nassembly a { @note("lid;") solid lid { todo } }',
            "a.aidl: in the `@note` of `lid`, `` is neither `not …` nor `of …`",
        ),
        (
            "/// a\nassembly a { param lid_count = 0 in 0..9 }",
            "a.aidl: `lid_count` counts no role, or is 0 as written",
        ),
        ("/// a\nassembly a {\nassert 1 == 1 }", "a.aidl:3: the assert does not say what it asks for"),
        ("/// a\nassembly a {\nassert lid.top >= 1 }", "a.aidl:3: there is no `lid` here"),
    ],
)
def test_a_file_that_is_no_prompt_says_why(text: str, message: str) -> None:
    with pytest.raises(PromptError) as caught:
        read(SourceFile("a.aidl", text))
    assert str(caught.value).startswith(message)


def test_an_array_of_what_has_no_name_is_no_endless_copy() -> None:
    text = """
        assembly cart {
            solid wheel {
                rim = circle(radius: 15)
                hole spokes { cut = polar_array(circle(radius: 2.5), n: 5, radius: 9) }
            }
        }"""
    assert unmet(WHEELS, text)["a body of 200 mm²"] == "no body was found"
