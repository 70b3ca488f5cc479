"""Recorded conversations: what is read and refused, and that they go through the whole harness."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from aidl_eval.openscad import OpenScad
from aidl_eval.recordings import RecordingError, load
from aidl_eval.summary import Share
from aidl_eval.table import shown
from aidl_lang.common.source import SourceFile
from aidl_lang.pipeline import compile
from aidl_lang.tools.llm.aidl import Aidl
from aidl_lang.tools.llm.messages import find_program
from eval.tests.conftest import Evaluation
from tests.commands import Result
from tests.documents import ROOT

TRIAL = ROOT / "eval" / "recordings" / "trial-0.1"
WRONG = "```aidl\nsolid key { body = circle(center: origin, radius: r) }\n```\n"
RIGHT = "```aidl\nsolid key { body = circle(center: origin, radius: 5) }\n```\n"
FORM = "a recording has one JSON object a line, in files `*.jsonl`; eval/README.md has its members"


def line(**other: object) -> str:
    said = {"aidl_recording": 1, "prompt": "key", "variant": "full", "run": 1, "replies": [RIGHT]}
    return json.dumps({**said, **other}) + "\n"


def test_a_recording_is_replayed(evaluation: Evaluation) -> None:
    place = evaluation.folder / "kept"
    place.mkdir()
    usage = {"input": 100, "output": 20, "cost": 0.5, "seconds": 3.5}
    first = line(
        model="m", date="2026-01-31", note="a note", guide="short", replies=[{"text": WRONG, **usage}, RIGHT]
    )
    (place / "a.jsonl").write_text(first)
    (place / "b.jsonl").write_text("\n" + line(run=2, replies=[WRONG]))
    done = _replay(evaluation, place)
    assert done.code == 0
    assert "2/2 key, full, run" in done.err
    record = evaluation.record("key", "full", 1)
    assert [a["verdict"]["ok"] for a in record["attempts"]] == [False, True]
    assert [(a["seconds"], a["date"], a["model"]) for a in record["attempts"]] == [
        (3.5, "2026-01-31", "m"),
        (None, "2026-01-31", "m"),
    ]
    assert record["attempts"][0]["usage"] == {"input": 100, "output": 20, "cost": 0.5}
    ended = evaluation.record("key", "full", 2)
    assert (ended["ok"], len(ended["attempts"])) == (False, 1)
    figures = evaluation.figures("full")
    assert [figures[n]["value"] for n in ("valid at first", "valid")] == [0, 0.5]
    assert "Note on full: a note." in done.out

    before = evaluation.contents()
    shutil.rmtree(evaluation.out)
    assert _replay(evaluation, place).code == 0
    assert evaluation.contents() == before

    written = evaluation.out.with_name("written.jsonl")
    written.write_bytes(before["recording.jsonl"])
    shutil.rmtree(evaluation.out)
    assert _replay(evaluation, written).code == 0  # what an evaluation writes gives the same records
    assert evaluation.contents()["records/key/full/1.json"] == before["records/key/full/1.json"]
    assert evaluation.contents()["recording.jsonl"] == before["recording.jsonl"]


def _replay(evaluation: Evaluation, place: Path, *options: str) -> Result:
    return evaluation.called("eval", "--out", str(evaluation.out), "--replay", str(place), *options)


def test_a_changed_recording_is_not_mixed_with_what_is_there(evaluation: Evaluation) -> None:
    place = evaluation.folder / "a.jsonl"
    place.write_text(line())
    assert _replay(evaluation, place).code == 0
    place.write_text(line(replies=[WRONG]))
    refused = _replay(evaluation, place)
    assert refused.code == 2
    assert "error[E0946]" in refused.err
    assert "recording of key/full/1: " in refused.err


@pytest.mark.parametrize(
    ("content", "why"),
    [
        ("{", "it is no JSON (Expecting property name enclosed in double quotes: line 1 column 2 (char 1))"),
        ("[]", "it is to be an object, as in {…}"),
        (line(aidl_recording=2), "`aidl_recording` is to be 1"),
        (line(prompt="../key"), "`prompt` is to be a name of letters, digits, `_` and `-`"),
        (line(run=0), "`run` is to be a whole number from 1 to 10000"),
        (line(run=1.5), "`run`: it is to be a whole number"),
        (line(run=True), "`run`: it is to be a whole number"),
        (line(replies=[]), "`replies` is to be a list with at least one reply"),
        (line(replies=[3]), "`replies[0]`: it is to be an object, as in {…}"),
        (line(replies=[{}]), "`replies[0].text`: it is missing"),
        (
            line(replies=[RIGHT, {"text": "", "finish": "bored"}]),
            "`replies[1].finish`: 'bored' is not a valid Finish",
        ),
        (line(date="yesterday"), "`date`: Invalid isoformat string: 'yesterday'"),
        (line(model=3), "`model`: it is to be a text"),
        (line(replies=[{"text": "", "cost": -1}]), None),
        (line(replies=[{"text": "", "cost": float("nan")}]), None),
        (line(reply=""), "there is no member `reply`"),
        (line(variant="fortran"), None),
        ("[" * 100_000, None),
    ],
)
def test_what_is_no_conversation_is_refused(tmp_path: Path, content: str, why: str | None) -> None:
    place = tmp_path / "a.jsonl"
    place.write_text("\n" + content)
    with pytest.raises(RecordingError) as refused:
        load(place)
    found = refused.value.diagnostic
    assert (found.code, found.hints) == ("E0993", (FORM,))
    assert found.message.startswith(f"`{place}:2` is no conversation: ")
    assert why is None or found.message == f"`{place}:2` is no conversation: {why}"


def test_the_same_conversation_twice_and_none(tmp_path: Path) -> None:
    place = tmp_path / "a.jsonl"
    place.write_text(line() * 2)
    with pytest.raises(RecordingError, match="the conversation `key/full/1` stands there twice"):
        load(tmp_path)
    place.write_bytes(b"\xff")
    with pytest.raises(RecordingError, match="is not UTF-8"):
        load(place)
    place.unlink()
    with pytest.raises(RecordingError, match="holds no conversation"):
        load(tmp_path)
    with pytest.raises(RecordingError, match="cannot be read: No such file"):
        load(tmp_path / "nothing")


def test_what_the_command_line_refuses(evaluation: Evaluation) -> None:
    def refused(*arguments: str) -> str:
        said = _replay(evaluation, place, *arguments).err
        return said.removeprefix("openscad is left out: it is not installed\n")

    place = evaluation.folder / "a.jsonl"
    place.write_text(line() + line(run=2, text="a key"))
    assert refused("--prompts", "kay") == (
        "error[E0994]: the recording has no prompt `kay`\n  = hint: did you mean `key`?\n"
    )
    assert refused("--variants", "no-hierarchy") == (
        "error[E0994]: the recording has no such conversations\n  = hint: its variants are full\n"
    )
    assert refused() == (
        "error[E0995]: the recording asks for `key` in two ways: `key` and `a key`\n"
        "  = hint: give one of them another name\n"
    )
    assert refused("--seed", "3") == (
        "error[E0996]: --seed is for a model, and --replay asks none\n  = hint: leave one of the two out\n"
    )
    assert not evaluation.out.exists()


def test_the_recording_of_version_0_1() -> None:
    """Its table in the documentation; of OpenSCAD only last programs were kept, all of them valid."""
    kept = load(TRIAL).values()
    assert len(kept) == 18
    assert sum(len(c.replies) for c in kept if c.variant == "full") == 24
    assert all(len(c.replies) == 1 for c in kept if c.variant == "openscad")
    language = Aidl()
    conversation = language.conversation()
    (replies,) = (c.replies for c in kept if (c.prompt, c.variant) == ("game_controller", "full"))
    programs = [find_program(reply.text, language.fences, language.reads)[0] for reply in replies[:3]]
    assert [conversation.judge(program or "").codes for program in programs[:2]] == [("E0518",)] * 2
    assert compile(SourceFile("game_controller.aidl", programs[2] or "")).ok
    page = (ROOT / "eval" / "README.md").read_text("utf-8")
    assert f"| valid at first | {shown(Share(8, 9))} | {shown(Share(9, 9))} |" in page


@pytest.mark.slow
@pytest.mark.skipif(OpenScad().missing() is not None, reason="openscad is not installed")
def test_the_table_of_version_0_1_is_what_its_command_gives(evaluation: Evaluation) -> None:
    assert _replay(evaluation, TRIAL, "--time-limit", "600").code == 0
    page = (ROOT / "eval" / "README.md").read_text("utf-8")
    text = (evaluation.out / "evaluation.md").read_text("utf-8")
    figures, pairs = (part.split("\n\n")[0] for part in text.split("\n|  | ")[1:3])
    assert "editability" in figures
    assert "full − openscad" in pairs
    assert figures in page
    assert pairs in page
