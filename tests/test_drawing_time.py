"""What is done with a drawing has a limit of time, and each that goes over it says so in the same words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import TooLongError
from aidl_lang.common.running import OutOfTime
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from aidl_lang.export import FORMATS
from aidl_lang.export.job import ExportError
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.agents.calling import answer
from aidl_lang.tools.agents.tools import Tools
from aidl_lang.tools.cli import main
from aidl_server.ide.actions import extractions
from aidl_server.ide.dragging import drag, handles
from aidl_server.ide.preview import preview
from aidl_server.ide.references import CannotError
from aidl_server.ide.workspace import View, look, run

PLATES = """\
assembly plates {
    param wide = 20 in 10..30
    solid lower { body = rectangle(center: (0, 0), width: 20, height: 10) }
    solid upper { body = rectangle(center: (0, 40), width: wide, height: 10) }
}
"""
HINT = (
    "it has too many curves, or too many that cross: fewer copies, or a wider `pitch`, take less; "
    "the limit is a setting of the API"
)


@pytest.fixture
def hurried(monkeypatch: pytest.MonkeyPatch) -> None:
    """Programs compile as ever, and nothing may be done with their drawings."""
    plain = pipeline.compile

    def compile(*given: Any, **named: Any) -> Compiled:
        return replace(plain(*given, **named), limit=0.0)

    monkeypatch.setattr(pipeline, "compile", compile)


def view() -> View:
    return run(look(Path("plates.aidl").absolute(), PLATES, MemoryWorld({})))


def test_what_there_is_to_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    within = pipeline.within
    monkeypatch.setattr(pipeline, "within", lambda limit, doing: within(limit * (doing == "drawing"), doing))
    found = pipeline.compile(SourceFile("plates.aidl", PLATES))
    assert found.ok
    (told,) = found.diagnostics
    assert (told.code, told.message, told.hints) == (
        "E0805",
        "examining what this program says takes more than 0 seconds",
        (HINT,),
    )
    assert (found.errors, found.ok) == ([told], False)
    assert found.export(".svg")


MANY = """solid s {
    frame = rectangle(center: (0, 0), width: 90, height: 90)
    for i in 0..8 { c[i] = circle(center: (9 * i, 0), radius: 3) }
}"""


@pytest.mark.parametrize(
    ("text", "doing", "label"),
    [
        (PLATES, "_Reader.geometry", "it came as far as this"),
        (MANY, "draw", "most of its curves are made here"),
    ],
)
def test_the_place_is_named(text: str, doing: str, label: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def late(*_: object) -> None:
        raise OutOfTime

    monkeypatch.setattr(f"aidl_lang.geometry.picturing.{doing}", late)
    (told,) = pipeline.compile(SourceFile("part.aidl", text)).diagnostics
    assert told.span is not None
    assert (told.code, told.span.line, told.label) == ("E0805", 3, label)


@pytest.mark.parametrize(
    ("doing", "work"),
    [
        ("measuring", lambda made: made.surveyed()),
        ("measuring", lambda made: made.surveyed(["upper"])),
        ("measuring", lambda made: made.measured("upper")),
        ("comparing", lambda made: made.compared(made)),
    ],
)
@pytest.mark.usefixtures("hurried")
def test_measuring_and_comparing(doing: str, work: Callable[[Compiled], object]) -> None:
    made = pipeline.compile(SourceFile("plates.aidl", PLATES))
    assert made.ok
    with pytest.raises(
        TooLongError, match=f"^{doing} what this program says takes more than 0 seconds\\nhint: "
    ):
        work(made)


@pytest.mark.usefixtures("hurried")
@pytest.mark.parametrize("suffix", FORMATS)
def test_writing(suffix: str) -> None:
    made = pipeline.compile(SourceFile("plates.aidl", f"@thickness(3mm)\n{PLATES}"))
    with pytest.raises(ExportError) as refused:
        made.export(suffix)
    told = refused.value.diagnostic
    assert told.code == "E0955"
    assert told.message == f"writing the drawing as `{suffix}` takes more than 0 seconds"


@pytest.mark.parametrize(
    ("verb", "doing"),
    [(["measure", "plates.aidl"], "measuring"), (["diff", "plates.aidl", "--to", "wide=30"], "comparing")],
)
@pytest.mark.usefixtures("hurried")
def test_the_command_says_so(
    verb: list[str],
    doing: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("plates.aidl").write_text(PLATES)
    assert main(verb) == 1
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err == (
        f"error[E0805]: {doing} what this program says takes more than 0 seconds\n  = hint: {HINT}\n"
    )


def test_the_command_says_so_of_the_picture_of_two(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("plates.aidl").write_text(PLATES)
    monkeypatch.setattr("aidl_lang.tools.cli.measure.LONGEST", 0.0)
    assert main(["diff", "plates.aidl", "--to", "wide=30", "-o", "both.svg"]) == 1
    assert not Path("both.svg").exists()
    lead = "error[E0805]: drawing the differences in what this program says takes more than 0 seconds\n"
    assert capsys.readouterr().err.startswith(lead)


@pytest.mark.usefixtures("hurried")
def test_models_are_told() -> None:
    made = answer(Tools(), "measure", {"program": PLATES})
    assert made.is_error
    assert "measuring what this program says takes more than 0 seconds" in made.text
    edited = answer(Tools(), "edit_param", {"program": PLATES, "name": "wide", "value": 30})
    assert not edited.is_error
    told = "nothing can be compared: comparing what this program says takes more than 0 seconds"
    assert edited.data["changes"] == told


@pytest.mark.usefixtures("hurried")
def test_a_page_shows_a_problem_in_place_of_the_picture() -> None:
    made = preview(view(), ["names"])
    assert made.svg is None
    assert [(p.code, p.message) for p in made.problems if p.severity == "error"] == [
        ("E0805", "painting what this program says takes more than 0 seconds")
    ]


@pytest.mark.usefixtures("hurried")
def test_what_cannot_be_drawn_is_not_dragged() -> None:
    seen = view()
    handle = next(h for h in handles(seen) if h.moves == "guess")
    with pytest.raises(CannotError, match="drawing what this program says takes more than 0 seconds"):
        drag(seen, handle.id, (handle.at[0] + 5, handle.at[1]))


@pytest.mark.usefixtures("hurried")
def test_an_action_that_cannot_be_tried_is_refused() -> None:
    (extraction,) = extractions(view(), PLATES.index("lower"))
    with pytest.raises(CannotError, match=r"writing the drawing as `\.svg` takes more than 0 seconds"):
        extraction.make()
