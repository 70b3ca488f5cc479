"""Subsets of the language: what each lacks is reported, what it has means the same as in the whole, and its
guide speaks of nothing else.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

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
from aidl_lang.tools.reference import guide
from aidl_lang.tools.reference.collect import reference
from tests.amount import some, tries
from tests.documents import ROOT, Block, blocks
from tests.property.programs import Part, Sketch, part, sketches

FLAT, WRITTEN = Variant.NO_HIERARCHY, Variant.NO_CONSTRAINTS
SUBSETS = (FLAT, WRITTEN)
CODES = {variant: {rule.code for rule in FORBIDDEN[variant].values()} for variant in Variant}

CAME_LATER = "draw with `line`, `arc`, `circle`, `rectangle` or `polygon`, cut with `hole`, and constrain"
STATED = "`no-constraints` draws everything as it is written and has no constraints"


def compiled(text: str, variant: Variant) -> Compiled:
    chosen = pipeline.Settings.of(variant)
    return pipeline.compile(SourceFile("part.aidl", text), MemoryWorld({}), settings=chosen)


def checked(text: str, variant: Variant) -> list[Diagnostic]:
    chosen = pipeline.Settings(variant=variant)
    return pipeline.check(SourceFile("part.aidl", text), MemoryWorld({}), chosen)


# --- What is forbidden ----------------------------------------------------------------------------


def pairs() -> list[tuple[Block, list[str]]]:
    """The programs of `variants.md`, each with the lines that are told of it."""
    found = list(blocks(Path(__file__).with_name("variants.md")))
    return [(shown, said.text.splitlines()) for shown, said in zip(found[::2], found[1::2], strict=True)]


def told(d: Diagnostic) -> Iterator[str]:
    yield f"error[{d.code}]: {d.message}"
    yield "at: " + (d.span.text.replace("\n", "\\n") if d.span else "")
    yield from (f"hint: {hint}" for hint in d.hints)


@pytest.mark.parametrize(("block", "expected"), pairs(), ids=lambda each: getattr(each, "heading", ""))
def test_what_a_variant_lacks_is_reported(block: Block, expected: list[str]) -> None:
    text, variant = block.text.removesuffix("\n"), Variant(block.variant)
    found = [d for d in checked(text, variant) if d.is_error]
    assert [line for d in found for line in told(d)] == expected
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
    for name, text in some([*corpus().items()], 8):
        found = compiled(text, variant)
        errors = {d.code for d in found.diagnostics if d.is_error}
        assert errors <= CODES[variant], f"{name}\n" + "\n".join(map(render, found.diagnostics))
        if not errors:
            taken += 1
            assert found.export(".json") == compiled(text, Variant.FULL).export(".json"), name
    assert 1 < taken < len(some([*corpus()], 8))


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


@pytest.mark.parametrize("stages", [Stages.FULL, Stages.PAPER, Stages.FLAT])
def test_other_stages_meet_the_same_constraints(stages: Stages) -> None:
    settings = pipeline.Settings()
    settings = replace(settings, solving=replace(settings.solving, stages=stages))
    found = pipeline.compile(SourceFile("part.aidl", MOVES_OR_GROWS), settings=settings)
    assert found.ok
    assert found.model is not None
    assert len(found.model.changed) == 1
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
