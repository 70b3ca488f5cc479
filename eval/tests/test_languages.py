"""The same drawing in every language: it measures the same and looks the same, and so do its mistakes."""

from __future__ import annotations

import io
import os
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from aidl_eval import measures, pictures
from aidl_eval.plan import VARIANTS
from aidl_eval.regions import Regions
from aidl_eval.rendering import RenderedLanguage
from aidl_eval.requirements import examine
from aidl_eval.whole import MEASURES
from aidl_lang.common.source import SourceFile
from eval.tests import scripted
from eval.tests.asked import NAMES, prompts
from eval.tests.conftest import Evaluation, unedited

QUICK = ("house", "wall_socket_plate")
TOUCHING = {"steam_locomotive": ("openings", "fields", "teeth")}
"""What hangs on whether parts that just touch, touch to the last digit."""
PYTHONS = {name: value for name, value in os.environ.items() if name.endswith("_PYTHON")}
WRITTEN = tuple(variant for variant in scripted.WRITERS if variant != "full")


def missing(variant: str) -> str | None:
    language = VARIANTS[variant]
    return language.missing() if isinstance(language, RenderedLanguage) else None


def drawn(variant: str, program: str) -> Regions:
    language = VARIANTS[variant]
    if isinstance(language, RenderedLanguage):
        (rendered,) = language.run(program)
        assert rendered.errors == ()
        return rendered.regions
    compiled = measures.compiled(language, SourceFile("part.aidl", program))
    assert [d for d in compiled.diagnostics if d.is_error] == []
    return measures.drawn(compiled)


def pixels(found: Regions) -> NDArray[np.int64]:
    with Image.open(io.BytesIO(pictures.png(replace(found, lines=())))) as picture:
        return np.asarray(picture.convert("L")).astype(int)


def compare(variant: str, name: str) -> None:
    """Compares the drawing of a prompt in a language with that in AIDL, which has lines besides."""
    found, there = drawn(variant, scripted.WRITERS[variant](name)), scripted.regions(name)
    assert found.whole.area == pytest.approx(there.whole.area, rel=2e-3)
    skipped = TOUCHING.get(name, ())
    measures = {m: (taken(found), taken(there)) for m, taken in MEASURES.items() if m not in skipped}
    assert {
        m: mine for m, (mine, its) in measures.items() if mine != pytest.approx(its, rel=1e-3, abs=5e-3)
    } == {}
    prompt = prompts()[name]
    assert examine(prompt, found) == examine(prompt, there)
    mine, its = pixels(found), pixels(there)
    assert mine.shape == its.shape
    assert (np.abs(mine - its) > 100).mean() < 2e-3  # a pixel beside here and there


@pytest.mark.parametrize("variant", WRITTEN)
def test_a_drawing_is_the_same_in_every_language(variant: str) -> None:
    if reason := missing(variant):
        pytest.skip(reason)
    for name in QUICK:
        compare(variant, name)


@pytest.mark.slow
@pytest.mark.parametrize("variant", WRITTEN)
@pytest.mark.parametrize("name", [name for name in NAMES if name not in QUICK])
def test_every_drawing_is_the_same_in_every_language(variant: str, name: str) -> None:
    if reason := missing(variant):
        pytest.skip(reason)
    compare(variant, name)


# --- through the whole harness -----------------------------------------------------------------------

TOLD = {
    "openscad": ("error: files cannot be read", "error (line "),
    "build123d": ("PermissionError: `open` is not allowed", "NameError: name 'nowhere' is not defined"),
    "cadquery": ("PermissionError: `open` is not allowed", "NameError: name 'nowhere' is not defined"),
    "svg": ("error: entities and document types are not read", "error: it is not well-formed XML"),
    "paper": ("error E0986", "error E0201"),
}
"""What is said about the two mistakes of a language, beside that there is no program."""


def replay(evaluation: Evaluation, names: Sequence[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Replays the recording in all languages that run here, and looks at each conversation."""
    for variable, python in PYTHONS.items():
        monkeypatch.setenv(variable, python)
    variants = [variant for variant in scripted.WRITERS if not missing(variant)]
    place = evaluation.folder / "scripted.jsonl"
    place.write_text(scripted.recording(names, variants), encoding="utf-8")
    options = ("--replay", str(place), "--variants", *variants, "--jobs", "2", "--time-limit", "600")
    done = evaluation.called("eval", "--out", str(evaluation.out), *options)
    assert done.code == 0
    assert f"{scripted.NOTE}." in done.out
    for variant in variants:
        figures = evaluation.figures(variant)
        first = sum(len(scripted.replies(name, variant)) == 1 for name in names)
        assert (figures["valid at first"]["part"], figures["valid"]["part"]) == (first, len(names))
        assert figures["requirements"]["value"] == 1
        for name in names:
            came = evaluation.record(name, variant, 1)
            assert came["unmeasured"] == {}
            assert [a["verdict"] is not None and a["verdict"]["ok"] for a in came["attempts"]] == [
                *([False] if len(scripted.replies(name, variant)) > 1 else []),
                True,
            ]
            if len(came["attempts"]) > 1:
                said = (*TOLD.get(variant, ("error E0604", "error E0201")), "Your reply holds no program")
                assert said[scripted.mistake(name)] in came["attempts"][0]["answer"]


def test_a_recording_goes_through_the_whole_harness(
    evaluation: Evaluation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("eval.tests.test_languages.PYTHONS", {})  # they take seconds to load
    monkeypatch.setattr(measures, "edit", unedited)
    replay(evaluation, ("birdhouse",), monkeypatch)


@pytest.mark.slow
def test_all_prompts_in_all_languages_go_through_the_whole_harness(
    evaluation: Evaluation, monkeypatch: pytest.MonkeyPatch
) -> None:
    replay(evaluation, NAMES, monkeypatch)
