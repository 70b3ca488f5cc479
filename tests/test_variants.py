"""Subsets of the language: what each lacks is reported, what it has means the same as in the whole, and its
guide speaks of nothing else.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TypeAlias

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang import pipeline
from aidl_lang.checking import builtins
from aidl_lang.checking.subset import FORBIDDEN, Variant
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.render import render
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld, MemoryWorld
from aidl_lang.pipeline import Compiled
from aidl_lang.solver import Stages
from aidl_lang.tools.cli import main
from aidl_lang.tools.reference.collect import reference
from aidl_lang.tools.reference.pages import guide
from tests.amount import tries
from tests.documents import ROOT
from tests.property.programs import Part, Sketch, part, sketches

Told: TypeAlias = tuple[str, str, str, tuple[str, ...]]
"""Of a diagnostic: its code, the text of its place, its message and its hints."""

FLAT, WRITTEN = Variant.NO_HIERARCHY, Variant.NO_CONSTRAINTS
SUBSETS = (FLAT, WRITTEN)
CODES = {variant: {rule.code for rule in FORBIDDEN[variant].values()} for variant in Variant}

ONE = "`no-hierarchy` has one structure"
AS_WRITTEN = "`no-constraints` draws everything as it is written"
OTHER = "write its geometry and constraints straight into the first structure, under names of their own"
CUT = "cut it out: `body = cut(plate, bore)`"
LOOP = "repeat geometry in a loop, `for i in 0..3 { bore[i] = circle(…) }`; if it is a hole, " + CUT
WHERE = (
    "write where things are and how large: by numbers, `param`s, or parts of geometry above, as in "
    "`center: plate.top_left + (5, -5)`"
)
CAME_LATER = "draw with `line`, `arc`, `circle`, `rectangle` or `polygon`, cut with `hole`, and constrain"
STATED = f"{AS_WRITTEN} and has no constraints"


def compiled(text: str, variant: Variant, files: dict[str, str] | None = None) -> Compiled:
    chosen = pipeline.Settings.of(variant)
    return pipeline.compile(SourceFile("part.aidl", text), MemoryWorld(files or {}), settings=chosen)


def checked(text: str, variant: Variant, files: dict[str, str] | None = None) -> list[Diagnostic]:
    chosen = pipeline.Settings(variant=variant)
    return pipeline.check(SourceFile("part.aidl", text), MemoryWorld(files or {}), chosen)


def told(d: Diagnostic) -> Told:
    return d.code, d.span.text if d.span else "", d.message, d.hints


# --- What is forbidden ----------------------------------------------------------------------------

FOUND: dict[str, tuple[Variant, str, list[Told]]] = {
    "a shape that came after the paper": (
        Variant.PAPER,
        "solid a { s = star(outer_radius: 9, inner_radius: 4, points: 5) }",
        [
            (
                "E0986",
                "star",
                "`paper` has what the paper on AIDL describes, and `star` came later",
                (CAME_LATER,),
            )
        ],
    ),
    "hole": (
        FLAT,
        "solid plate {\n body = circle(radius: 9)\n hole bore { rim = circle(radius: 3) }\n}",
        [
            (
                "E0403",
                "bore",
                f"{ONE}, and `bore` is a hole of its own",
                (f"draw its outline in the one structure, and {CUT}",),
            )
        ],
    ),
    "child in an if": (
        FLAT,
        "assembly a {\n if true { solid plate { body = circle(radius: 9) } }\n}",
        [("E0403", "plate", f"{ONE}, and `plate` is another", (OTHER,))],
    ),
    "second root": (
        FLAT,
        "solid a { body = circle(radius: 9) }\nsolid b { body = circle(center: (30, 0), radius: 9) }",
        [("E0403", "b", f"{ONE}, and `b` is another", (OTHER,))],
    ),
    "beside the root": (
        FLAT,
        "let r = 9\nsolid a { body = circle(radius: r) }\n"
        "rim = circle(center: (30, 0), radius: 9)\nassert true",
        [
            (
                "E0403",
                "rim = circle(center: (30, 0), radius: 9)",
                f"{ONE}, and this stands outside `a`",
                ("write it inside `a`",),
            )
        ],
    ),
    "template": (
        FLAT,
        "solid a {\n solid peg(r = 4) { body = circle(radius: r) }\n"
        " p = peg(r: 5)\n q = linear_array(peg(), n: 2, pitch: 20)\n}",
        [("E0404", "peg", f"{ONE}, and the template `peg` makes more", (LOOP,))] * 3,
    ),
    "template of the library": (
        FLAT,
        'solid a {\n disc = circle(radius: 30)\n bolts = bolt_circle(count: 6, diameter: 44, size: "m4")\n}',
        [("E0404", "bolt_circle", f"{ONE}, and the template `bolt_circle` makes more", (LOOP,))],
    ),
    "shape": (
        FLAT,
        "solid a {\n shape eye(r: length) { rim = circle(radius: r) }\n e = eye(r: 4)\n}",
        [
            (
                "E0405",
                "eye",
                "in `no-hierarchy` all geometry is on one level, and the shape `eye` has parts of its own",
                (
                    "write its parts where it is used, or make it one `path` or `polygon`; "
                    "`fn` can work out points",
                ),
            )
        ],
    ),
    "constrain": (
        WRITTEN,
        "solid a {\n c = circle(radius: 9)\n constrain { c.radius == 8\n misspelt(c) }\n"
        " if true { constrain c.radius == 7 }\n}",
        [
            ("E0406", "constrain { c.radius == 8\n misspelt(c) }", STATED, (WHERE,)),
            ("E0406", "constrain c.radius == 7", STATED, (WHERE,)),
        ],
    ),
    "prefer and bare constraints": (
        WRITTEN,
        "solid a {\n c = circle(radius: 9)\n prefer c.radius == 8 weight 2\n c.radius <= 9\n fixed(c)\n"
        " horizontal(c, 5)\n c.centered_in(c)\n move(c, by: (2, 0))\n}",
        [
            ("E0406", text, STATED, (WHERE,))
            for text in (
                "prefer c.radius == 8 weight 2",
                "c.radius <= 9",
                "fixed(c)",
                "horizontal(c, 5)",
                "c.centered_in(c)",
            )
        ],
    ),
    "var": (
        WRITTEN,
        "solid a {\n var gap = 5\n c = circle(center: (gap, 0), radius: 9)\n}",
        [
            (
                "E0407",
                "gap",
                f"{AS_WRITTEN}, and `gap` is an unknown",
                ("name its value by `let`, or make it a `param`",),
            )
        ],
    ),
    "constraint": (
        WRITTEN,
        "solid a {\n constraint near(a: box, b: box) { a.left == b.right }\n c = circle(radius: 9)\n}",
        [
            (
                "E0408",
                "constraint near(a: box, b: box) { a.left == b.right }",
                f"{AS_WRITTEN}, and `near` defines a constraint",
                ("let a function work out what it ties, as in `fn top_of(a) = a.center + (0, 10)`",),
            )
        ],
    ),
    "relation": (
        WRITTEN,
        "solid a {\n c = circle(radius: 9)\n d = circle(radius: 3)\n"
        " assert d.inside(c)\n assert distance(c.center, d.center) <= 1\n}",
        [
            (
                "E0409",
                "inside",
                "`no-constraints` has no relations, and `inside` is one",
                ("compare coordinates or measures, as in `assert lid.bottom >= box.top`",),
            )
        ],
    ),
    "smooth": (
        WRITTEN,
        "solid a {\n p = path(from: (0, 0), line_to((20, 0)), arc_to((20, 10), radius: 6, smooth: true), "
        "line_to((0, 10), smooth: false), close())\n}",
        [
            (
                "E0409",
                "smooth: true",
                f"{AS_WRITTEN}, and `smooth: true` would move a step of the path",
                (
                    "give the points of a smooth outline, or use `tangent_arc_to` and `arc_by`, "
                    "which go on smoothly",
                ),
            )
        ],
    ),
}


@pytest.mark.parametrize(("variant", "text", "expected"), FOUND.values(), ids=FOUND)
def test_what_a_variant_lacks_is_reported(variant: Variant, text: str, expected: list[Told]) -> None:
    found = [d for d in checked(text, variant) if d.is_error]
    assert [told(d) for d in found] == expected
    assert not CODES[variant] & {d.code for d in checked(text, Variant.FULL)}
    other = FLAT if variant is WRITTEN else WRITTEN
    assert not CODES[variant] & {d.code for d in checked(text, other)}


# --- What is advised ------------------------------------------------------------------------------


def test_no_advice_to_constrain_where_nothing_is_constrained() -> None:
    text = "solid a {\n c = circle(radius: 9)\n hole b { d = circle(center: c.center, radius: 2) }\n}"
    (full,) = checked(text, Variant.FULL)
    (found,) = checked(text, WRITTEN)
    assert found.code == full.code == "E0401"
    assert full.fix is not None
    assert found.fix is None
    assert found.hints == (
        "name the value in the structure around both, as in `let middle = (10, 0)`, and use the name in both",
    )


# --- What is taken means the same -----------------------------------------------------------------


@cache
def corpus() -> dict[str, str]:
    """The examples, and every eighth program of the reference."""
    programs = {path.name: path.read_text("utf-8") for path in sorted((ROOT / "examples").glob("*.aidl"))}
    entries = [e for e in reference().entries.values() if e.doc.example]
    return programs | {entry.name: entry.doc.example for entry in entries[::8]}


@pytest.mark.parametrize("variant", SUBSETS)
def test_programs_are_taken_or_told_what_the_variant_lacks(variant: Variant) -> None:
    """A program that is right in the whole language is wrong for no other reason, and else draws the same."""
    taken = 0
    for name, text in corpus().items():
        found = compiled(text, variant)
        errors = {d.code for d in found.diagnostics if d.is_error}
        assert errors <= CODES[variant], f"{name}\n" + "\n".join(map(render, found.diagnostics))
        if not errors:
            taken += 1
            assert found.export(".json") == compiled(text, Variant.FULL).export(".json"), name
    assert 10 < taken < len(corpus())


@tries(25)
@given(sketches())
def test_without_constraints_everything_is_as_written(sketch: Sketch) -> None:
    bare = sketch.text([p.text(constraints=()) for p in sketch.parts], relations=())
    bare = bare.replace("constrain {\n\n}", "")
    found = compiled(bare, WRITTEN)
    assert found.ok, "\n".join(map(render, found.diagnostics))
    assert not any(stage.rows for _, stage in found.stages)
    assert found.export(".json") == compiled(bare, Variant.FULL).export(".json")
    stated = sum(bool(p.constraints) for p in sketch.parts) + 1
    assert [d.code for d in checked(sketch.text(), WRITTEN) if d.is_error] == ["E0406"] * stated


@tries(25)
@given(part("alone"), st.integers(1, 9))
def test_one_structure_is_the_same_with_and_without_hierarchy(single: Part, unit: int) -> None:
    text = f"param unit = {unit}\n{single.text()}"
    found, full = compiled(text, FLAT), compiled(text, Variant.FULL)
    assert not CODES[FLAT] & {d.code for d in found.diagnostics}
    assert found.status == full.status
    if found.ok:
        assert found.drawing == full.drawing
    nested = checked(f"assembly around {{\nparam unit = {unit}\n{single.text()}\n}}", FLAT)
    assert [d.code for d in nested if d.is_error] == ["E0403"]


# --- The paper's ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("statement", "place"),
    [
        ("s = star(outer_radius: 9, inner_radius: 4, points: 5)", "star"),
        ("p = path(from: (0, 0), line_to(1, 0), close())", "path"),
        ("a = circle(radius: 3) b = mirror(a, about: y_axis)", "mirror"),
        ("a = circle(radius: 3) assert a.radius == 3", "assert a.radius == 3"),
        ("a = circle(radius: 3) prefer a.radius == 4", "prefer a.radius == 4"),
        ("a = circle(radius: 3) b = circle(radius: 4) constrain row(a, b)", "row"),
        ('@color("red") solid b { a = circle(radius: 3) }', '@color("red")'),
        ("a = circle(radius: lerp(3, 4, 0.5))", "lerp"),
    ],
)
def test_what_came_after_the_paper_is_reported(statement: str, place: str) -> None:
    found = [d for d in checked(f"solid s {{ {statement} }}", Variant.PAPER) if d.is_error]
    assert {d.code for d in found} == {"E0986"}
    assert place in [d.span.text for d in found if d.span]
    word = {"assert": "assert", "prefer": "prefer", "@color": "@color"}
    name = next((w for start, w in word.items() if place.startswith(start)), place)
    message = f"`paper` has what the paper on AIDL describes, and `{name}` came later"
    first = next(d for d in found if d.span and d.span.text == place)
    assert (first.message, first.hints) == (message, (CAME_LATER,))


def test_what_the_paper_has_is_taken() -> None:
    text = """
        fn half(x) = x / 2
        constraint on(a: box, b: box) { a.bottom == b.top }
        assembly a {
            param w = 40
            solid b(x = 0) { r = rectangle(center: (x, 0), width: w, height: half(w)) }
            solid d {
                e = circle(center: (0, 50), radius: 5)
                hole f { g = circle(center: (0, 50), radius: 2) }
            }
            left = b(x: -30)
            constrain { on(d, left) d.center_x == left.center_x }
            constrain { abs(left.width) <= max(w, 3) concentric(d.e, d.f.g) }
        }
    """
    chosen = pipeline.Settings.of(Variant.PAPER)
    found = pipeline.compile(SourceFile("part.aidl", text), settings=chosen)
    assert found.ok, "\n".join(map(render, found.diagnostics))


MOVES_OR_GROWS = """
    assembly a {
        solid b { r = rectangle(center: origin, width: 40, height: 20) }
        constrain b.r.width == 50
    }
"""


@pytest.mark.parametrize(("stages", "changed"), [(Stages.FULL, 1), (Stages.PAPER, 1), (Stages.FLAT, 1)])
def test_other_stages_meet_the_same_constraints(stages: Stages, changed: int) -> None:
    settings = pipeline.Settings()
    settings = replace(settings, solving=replace(settings.solving, stages=stages))
    found = pipeline.compile(SourceFile("part.aidl", MOVES_OR_GROWS), settings=settings)
    assert found.ok
    assert found.model is not None
    assert len(found.model.changed) == changed
    assert found.drawing is not None
    assert found.drawing.box == pytest.approx((-25, -10, 25, 10))


# --- The guides -----------------------------------------------------------------------------------


def programs(variant: Variant) -> list[str]:
    return re.findall(r"```aidl\n(.*?)```", guide(variant), flags=re.DOTALL)


@pytest.mark.parametrize("variant", [*SUBSETS, Variant.PAPER])
def test_programs_of_a_guide_are_of_its_variant(variant: Variant) -> None:
    assert len(programs(variant)) >= 3
    for text in programs(variant):
        found = compiled(text, variant)
        assert found.ok, "\n".join(map(render, found.diagnostics))
        assert found.diagnostics == []


@pytest.mark.parametrize("variant", SUBSETS)
def test_guide_names_nothing_that_the_variant_refuses(variant: Variant) -> None:
    """Names of the library whose every form is refused are left out, and all others are there."""
    words = set(re.findall(r"@?\w+", guide(variant)))
    left_out = {e.name for e in reference().entries.values() if e.sort != "word" and e.name not in words}
    sorts = {reference().entries[name].sort for name in left_out}
    expected = {FLAT: {"template"}, WRITTEN: {"relation", "constraint", "builtin"}}
    assert sorts == expected[variant]
    marks = {name for name in left_out if name in builtins.SIGNATURES}
    assert marks == (set() if variant is FLAT else {"fixed", "guess", "nearest"})


# --- The command line -----------------------------------------------------------------------------

PROGRAM = "solid a {\n c = circle(radius: 9)\n constrain c.radius == 8\n}\n"


def test_verbs_take_a_variant(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "a.aidl"
    file.write_text(PROGRAM)
    assert main(["check", str(file), "--variant", "no-constraints"]) == 1
    assert STATED in capsys.readouterr().err
    assert main(["compile", str(file), "--variant", "no-constraints"]) == 1
    assert STATED in capsys.readouterr().err
    assert not file.with_suffix(".svg").exists()
    assert main(["compile", str(file), "--variant", "no-hierarchy"]) == 0
    assert file.with_suffix(".svg").exists()
    assert pipeline.check(SourceFile("a.aidl", PROGRAM), DiskWorld(tmp_path)) == []


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (
            ["check", "a.aidl", "--variant", "none"],
            "there is no `none`; there are full, no-hierarchy, no-constraints, paper",
        ),
        (["guide", "--full", "--variant", "no-hierarchy"], "not allowed with argument --full"),
    ],
)
def test_wrong_use_is_refused(
    arguments: list[str], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as reason:
        main(arguments)
    assert reason.value.code == 2
    assert expected in capsys.readouterr().err
