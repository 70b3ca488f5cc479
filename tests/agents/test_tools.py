"""What the tools say of programs whose answers are worked out by hand; numbers as people type them."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from PIL import Image

from aidl_lang.tools.agents.calling import Answer, answer
from aidl_lang.tools.agents.tools import Tools
from aidl_lang.tools.agents.workspace import LONGEST, Limits, Workspace, quantity
from tests.documents import ROOT
from tests.sweep.here import at_once as at_once

TELEPHONE = (ROOT / "examples" / "telephone.aidl").read_text("utf-8")
MODEL = jsonschema.Draft202012Validator(json.loads((ROOT / "docs" / "model.schema.json").read_text("utf-8")))
PLATE = """\
solid plate {
    /// How wide it is.
    param width = 4cm in 20..80
    param edge = "round" in ["round", "square"]
    param thin = true
    outline = rectangle(center: origin, width: width, height: 20)
    if thin and edge == "square" { tab = rectangle(center: fixed((0, 10)), width: 4, height: 4) }
    hole bore { rim = circle(center: fixed((10, 0)), radius: 5) }
}
"""
CONFLICT = """\
assembly pair {
    solid left { disk = circle(center: (0, 0), radius: guess(5)) }
    solid right { disk = circle(center: (20, 0), radius: guess(3)) }
    constrain left.disk.radius == 6
    constrain left.disk.radius + right.disk.radius == 12
    constrain right.disk.radius == 7
}
"""


def ask(name: str, workshop: Tools | None = None, /, **arguments: object) -> Answer:
    return answer(workshop or Tools(), name, arguments)


def refused(made: Answer) -> str:
    assert made.is_error
    return made.text


# --- check -----------------------------------------------------------------------------------------


def test_check_gives_places_reasons_and_replacements() -> None:
    program = "solid plate {\n    rim = circle(raduis: 3)\n}\n"
    made = ask("check", program=program)
    (finding,) = made.data["findings"]["listed"]
    assert (finding["code"], finding["severity"]) == ("E0324", "error")
    assert (finding["place"]["line"], finding["place"]["column"]) == (2, 18)
    (replacement,) = finding["fix"]["replacements"]
    assert (replacement["old"], replacement["new"]) == ("raduis", "radius")
    assert not made.data["ok"]
    assert made.data["fixed_program"] == program.replace("raduis", "radius")
    assert made.data["findings_after_fixes"] == {"listed": [], "left_out": 0}
    assert "line 2 becomes\n        rim = circle(radius: 3)" in made.text


# --- compile ---------------------------------------------------------------------------------------


def test_compile_draws_and_tells() -> None:
    made = ask("compile", program=TELEPHONE)
    assert (made.data["ok"], made.data["status"], made.data["degrees_of_freedom"]) == (True, "solved", 2)
    assert made.data["motions"] == []
    base, receiver, _ = made.data["bodies"]
    assert (base["path"], base["left"], base["right"], base["area"]) == ("telephone.base", -80, 80, 10880)
    assert receiver["bottom"] == pytest.approx(base["top"] + 2)
    contact = {(c["a"], c["b"]): c for c in made.data["contacts"]}["telephone.base", "telephone.receiver"]
    assert (contact["relation"], contact["gap"]) == ("apart", pytest.approx(2))
    (knob,) = made.data["params"]
    assert (knob["path"], knob["value"], knob["low"], knob["high"]) == ("width", 160, 100, 240)
    (picture,) = made.pictures
    with Image.open(io.BytesIO(picture)) as image:
        assert (image.format, max(image.size)) == ("PNG", 1000)


def test_model_is_valid_and_can_be_had_by_path() -> None:
    whole = ask("compile", program=TELEPHONE, formats=["model"])
    MODEL.validate(whole.data["model"])
    assert whole.data["shortened"] is None
    assert whole.pictures == ()
    part = ask("compile", program=TELEPHONE, formats=["model"], path="receiver").data["model"]
    MODEL.validate(part)
    assert part["root"]["path"] == "telephone.receiver"
    assert set(part["regions"]) == {"telephone.receiver"}
    assert {c["path"] for c in part["constraints"]} == {"telephone.receiver"}
    missing = ask("compile", program=TELEPHONE, formats=["model"], path="reciever")
    assert "did you mean `telephone.receiver`?" in refused(missing)


@pytest.mark.parametrize("most", [200, 8_000])
def test_model_is_shortened_with_a_word(most: int) -> None:
    workshop = Tools(Workspace(limits=Limits(text=most)))
    made = ask("compile", workshop, program=TELEPHONE, formats=["model"])
    MODEL.validate(made.data["model"])
    size = len(json.dumps(made.data["model"], ensure_ascii=False, separators=(",", ":")))
    assert size <= max(most, 4_000)
    assert made.data["shortened"].endswith("left out: ask for one structure by its `path`")
    assert made.data["shortened"] in made.text


def test_files_are_made_of_what_is_right() -> None:
    made = ask("compile", program=PLATE, formats=["svg", "pdf"])
    svg, pdf = made.data["exports"]
    assert (svg["format"], svg["encoding"]) == ("svg", "text")
    assert svg["content"] in made.text
    assert (pdf["format"], pdf["encoding"]) == ("pdf", "base64")
    assert base64.b64decode(pdf["content"]).startswith(b"%PDF")
    assert pdf["content"] not in made.text
    assert ask("compile", program=CONFLICT, formats=["svg"]).data["exports"] == []
    small = Tools(Workspace(limits=Limits(text=100)))
    assert "the svg file has" in ask("compile", small, program=PLATE, formats=["svg"]).text


def test_wrong_program_is_an_answer() -> None:
    made = ask("compile", program="solid a { b = circle(radius: w) }", formats=["png", "model", "svg"])
    assert (made.is_error, made.data["status"], made.data["model"]) == (False, "wrong", None)
    assert made.pictures == ()
    assert "E0201" in made.text


# --- Imports ---------------------------------------------------------------------------------------

IMPORTS = 'import "lib/bolt.aidl"\nsolid a { b = bolt() at (0, 0) }\n'
BOLT = "solid bolt() { rim = circle(radius: 3) }\n"


def test_nothing_is_read_from_disk_unless_it_is_allowed(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "bolt.aidl").write_text(BOLT)
    assert not ask("check", program=IMPORTS).data["ok"]
    assert ask("check", Tools(Workspace(tmp_path)), program=IMPORTS).data["ok"]


@pytest.mark.parametrize("name", ["../secret.aidl", "lib/../../secret.aidl", "link.aidl", "{}/secret.aidl"])
def test_nothing_outside_the_root_is_read(tmp_path: Path, name: str) -> None:
    root = tmp_path / "root"
    (root / "lib").mkdir(parents=True)
    (tmp_path / "secret.aidl").write_text(BOLT)
    (root / "link.aidl").symlink_to(tmp_path / "secret.aidl")
    program = IMPORTS.replace("lib/bolt.aidl", name.format(tmp_path))
    made = ask("check", Tools(Workspace(root)), program=program)
    assert "lies outside the project" in made.text
    assert not made.data["ok"]
    assert ask("check", Tools(Workspace(tmp_path)), program=IMPORTS.replace("lib/bolt", "secret")).data["ok"]


def test_names_of_files_cannot_leave_the_project() -> None:
    assert refused(ask("check", program=PLATE, files={"../x.aidl": BOLT})) == (
        "error E0944: the file name `../x.aidl` cannot be used: it lies outside the project\n"
        "  hint: name files as the program imports them, as `parts/bolt.aidl`"
    )


# --- measure, edit_param ---------------------------------------------------------------------------


def test_measure() -> None:
    made = ask("measure", program=PLATE, path="bore")
    (bore,) = made.data["parts"]
    assert (bore["path"], bore["kind"]) == ("plate.bore", "hole")
    assert bore["area"] == pytest.approx(25 * 3.14159265358979)
    assert made.data["whole"]["wall"]["length"] == pytest.approx(5)
    assert "error E0919: there is no `bor` in the drawing" in refused(
        ask("measure", program=PLATE, path="bor")
    )
    assert "E0601" in refused(ask("measure", program=CONFLICT))


@pytest.mark.parametrize(
    ("name", "value", "old", "new"),
    [
        ("width", 50, "4cm", "5cm"),
        ("plate.width", "1.5in", "4cm", "1.5in"),
        ("edge", "square", '"round"', '"square"'),
        ("thin", False, "true", "false"),
    ],
)
def test_edit_param_changes_nothing_else(name: str, value: object, old: str, new: str) -> None:
    made = ask("edit_param", program=PLATE, name=name, value=value)
    assert made.data["program"] == PLATE.replace(f"= {old}", f"= {new}")
    assert (made.data["replacement"]["old"], made.data["replacement"]["new"]) == (old, new)
    assert made.data["ok"]


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        (
            "width",
            90,
            "`width` is 90 as written, outside its range 20..80\n"
            "  hint: give a value in 20..80, or widen the range of the `param`",
        ),
        (
            "widht",
            50,
            "there is no param `widht`\n  hint: did you mean `width`?\n"
            "  hint: params of this program: `width`, `edge`, `thin`",
        ),
        ("thin", 3, "`3` does not fit: `thin` is true or false"),
        ("width", True, "`True` does not fit: `width` is a number"),
        ("edge", 3, "`3` does not fit: `edge` is a text"),
        (
            "width",
            "5cm + origin",
            "`5cm + origin` does not fit `width`: `+` does not work on a length and a point",
        ),
    ],
)
def test_edit_param_refuses(name: str, value: object, text: str) -> None:
    assert refused(ask("edit_param", program=PLATE, name=name, value=value)) == f"error E0945: {text}"


def test_edit_param_refuses_what_another_file_declares() -> None:
    library = "solid bolt() { param size = 3 in 1..5\n rim = circle(radius: size) }\n"
    made = ask("edit_param", program=IMPORTS, files={"lib/bolt.aidl": library}, name="b.size", value=2)
    assert "`b.size` is declared in `lib/bolt.aidl`" in refused(made)


# --- explain_conflict ------------------------------------------------------------------------------


def test_conflict_names_the_exact_numbers_behind_it() -> None:
    program = """solid plate {
    param length = 110mm in 80..160
    rim = rectangle(center: origin, width: length, height: 20)
    peg = circle(center: (0, 0), radius: fixed(3))
    constrain {
        peg.left == rim.left + 57
        peg.right == rim.right - 57
    }
}
"""
    made = ask("explain_conflict", program=program)
    (conflict,) = made.data["conflicts"]
    (given,) = conflict["givens"]
    assert (given["name"], given["place"]["line"], given["would_fit"]) == ("length", 2, "120mm would fit")
    assert given["remedy"]["title"] == "make `length` 120mm"
    assert given["solves"] is True
    assert "- line 2: exact `length`; 120mm would fit, and the program solves" in made.text


# --- Reading ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("query", "name"),
    [
        ("round the corners", "fillet"),
        ("wheel with teeth", "gear"),
        ("hole for a screw", "screw_hole"),
        ("color", "@color"),
        ("E0301", "E0301"),
        ("rectangel", "rectangle"),
        ("orthogonal", "perpendicular"),
        ("written size became another", "N0601"),
    ],
)
def test_search_finds(query: str, name: str) -> None:
    hits = ask("search", query=query, limit=5).data["hits"]
    assert name in [hit["name"] for hit in hits]
    assert all(hit["summary"] for hit in hits)


def test_explain_a_name_a_synonym_and_a_code() -> None:
    assert ask("explain", name="orthogonal").data["title"] == "perpendicular"
    assert "## Mended" in ask("explain", name="e0301").text
    assert refused(ask("explain", name="rectangl_shape_thing")).startswith("error E0912: there is no `rect")


def test_guide_by_sections() -> None:
    whole = ask("guide")
    assert "Constraints" in whole.data["sections"]
    section = ask("guide", section="constraints").text
    assert section.startswith("## Constraints\n")
    assert section in whole.text
    assert ask("guide", variant="no-constraints").text != whole.text
    assert "sections: `Structures`" in refused(ask("guide", section="nonsense"))


# --- Arguments and limits --------------------------------------------------------------------------

TEXT = "\n  hint: The text of the whole AIDL program."


@pytest.mark.parametrize(
    ("name", "arguments", "text"),
    [
        (
            "chek",
            {},
            "there is no tool `chek`\n  hint: did you mean `check`?\n  hint: tools: check, compile, guide, "
            "search, explain, measure, edit_param, explain_conflict",
        ),
        (
            "compile",
            {"program": "", "format": "png"},
            "`compile` has no parameter `format`\n  hint: did you mean `formats`?\n"
            "  hint: parameters: program, params, files, formats, path, dimensioned",
        ),
        ("check", {"program": None}, f"`check` needs `program`{TEXT}"),
        ("check", {"program": ["solid"]}, f'`program` of `check` takes a text, not `["solid"]`{TEXT}'),
        (
            "search",
            {"query": "x", "limit": 2.5},
            "`limit` of `search` takes a whole number, not `2.5`\n  hint: How many hits at most.",
        ),
        (
            "compile",
            {"program": "", "dimensioned": "yes"},
            '`dimensioned` of `compile` takes true or false, not `"yes"`\n'
            "  hint: Draw the dimensions of what is sized.",
        ),
    ],
)
def test_arguments_that_do_not_fit(name: str, arguments: Mapping[str, Any], text: str) -> None:
    assert refused(answer(Tools(), name, arguments)) == f"error E0944: {text}"


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf"), 10**310, [1], {}])
def test_params_that_are_no_numbers(value: object) -> None:
    text = refused(ask("compile", program=PLATE, params={"width": value}))
    assert "`params` of `compile` takes a number or a text or true or false, not `" in text
    text = refused(ask("edit_param", program=PLATE, name="width", value=value))
    assert "`value` of `edit_param` takes a number or a text or true or false, not `" in text


def test_text_with_half_a_character() -> None:
    assert "takes a text in Unicode" in refused(ask("check", program="// \ud800"))


def test_pairs_stand_for_a_mapping() -> None:
    pairs = [{"name": "width", "value": 60}]
    assert ask("compile", program=PLATE, params=pairs, files=[], formats=[]).data["bodies"][0]["right"] == 30
    assert "takes an object" in refused(ask("compile", program=PLATE, params=[{"name": "width"}]))


def test_size_of_programs_is_limited() -> None:
    assert refused(ask("check", program="// " + "x" * 400_000)) == (
        "error E0944: the program and its files have 400,003 characters, more than the 400,000 allowed\n"
        "  hint: say what repeats with `for` and with templates"
    )
    assert "101 files were given" in refused(
        ask("check", program="", files={f"{i}.aidl": "" for i in range(101)})
    )


@pytest.mark.parametrize(
    ("program", "code"),
    [
        ("fn f(x) = f(x + 1)\nsolid a { b = circle(radius: f(1)) }", "E0806"),
        ("solid a { " + "solid b { " * 3_000 + "}" * 3_001, "E0802"),
    ],
)
def test_programs_without_end(program: str, code: str) -> None:
    made = ask("compile", program=program)
    assert made.data["status"] == "wrong"
    assert code in [f["code"] for f in made.data["findings"]["listed"]]


@pytest.mark.usefixtures("at_once")
def test_check_with_ranges_tells_where_something_changes_kind() -> None:
    program = PLATE.replace("circle(center: fixed((10, 0))", "circle(center: fixed((width / 4, 3))")
    made = ask("check", program=program.replace("20..80", "14..80"), ranges=True)
    (finding,) = made.data["findings"]["listed"]
    assert (finding["code"], finding["place"]["line"]) == ("W0607", 3)
    assert "`plate.bore.rim` breaks through its edge" in finding["message"]
    steady = PLATE.replace("20..80", "35..80")
    assert "one kind over the range of each param" in ask("check", program=steady, ranges=True).text


@pytest.mark.parametrize(
    ("text", "value", "unit", "named"),
    [
        ("80", 80, "", None),
        ("80+20", 100, "", None),
        ("12cm", 120, "mm", "cm"),
        (" 12 cm ", 120, "mm", "cm"),
        ("1/2in", 12.7, "mm", "in"),
        ("3 1/2 in", 88.9, "mm", "in"),
        ("1in + 3mm", 28.4, "mm", None),
        ("80 + 20mm", 100, "mm", "mm"),
        ("1/4turn", 90, "deg", "turn"),
        ("45deg * 2", 90, "deg", "deg"),
        ("12,5", 12.5, "", None),
        ("\u22127.5", -7.5, "", None),
        ("2 * (3 + 4)", 14, "", None),
        ("sqrt(9) * 1mm", 3, "mm", "mm"),
    ],
)
def test_what_a_number_means(text: str, value: float, unit: str, named: str | None) -> None:
    found = quantity(text)
    assert not isinstance(found, str)
    assert (found.value, found.unit, found.named) == (pytest.approx(value), unit, named)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "that is not a number"),
        ("12.", "that is not a number"),
        ("true", "that is not a number"),
        ("5 // x", "that is not a number"),
        ("5\n6", "that is not a number"),
        ("1) solid x { c = circle(radius: 2) } param y = (2", "that is not a number"),
        ("1" * (LONGEST + 1), "that is not a number"),
        ("wide", "there is no `wide` here"),
        ("2mm * 3mm", "that is neither a length, an angle nor a plain number"),
        ("90deg + 1mm", "`+` does not join an angle and a length"),
        ("1/0", "divides by zero"),
        ("9^9^9^9", "leaves the range of numbers"),
    ],
)
def test_what_means_no_number(text: str, why: str) -> None:
    found = quantity(text)
    assert isinstance(found, str)
    assert why in found
