"""`aidl eval` over recorded replies: what is measured, kept and refused, and what the gallery shows."""

from __future__ import annotations

import io
import shutil
import signal
import subprocess
import time

import pytest
from PIL import Image

from eval.tests import scripted
from eval.tests.conftest import Evaluation

BIRDHOUSE = scripted.good("birdhouse")
WRONG = (
    "assembly birdhouse {\n    solid base { body = rectangle(center: origin, width: wdth, height: 50) }\n}\n"
)
NASTY = '</script></pre><img src=x onerror="alert(1)">\u202e'
FLAT = """\
/// </pre><b>bold</b>
param width = 100mm in 50..150
solid telephone {
    base = rectangle(center: origin, width: width, height: 50)
}
"""


def fenced(program: str, name: str = "aidl") -> str:
    return f"I think about it.\n\n```{name}\n{program}```\n"


def test_runs_are_measured(evaluation: Evaluation) -> None:
    evaluation.say("birdhouse", "full", 1, fenced(WRONG), fenced(BIRDHOUSE))
    evaluation.say("birdhouse", "full", 2, f"No. {NASTY}")
    evaluation.say("birdhouse", "no-hierarchy", 1, fenced(FLAT))
    evaluation.say("birdhouse", "no-hierarchy", 2, fenced(FLAT))
    done = evaluation(
        "--prompts", "birdhouse", "--variants", "full", "no-hierarchy", "--runs", "2", "--attempts", "2"
    )
    assert done.code == 0
    assert "4/4 birdhouse, " in done.err

    record = evaluation.record("birdhouse", "full", 1)
    assert [a["verdict"]["ok"] for a in record["attempts"]] == [False, True]
    assert record["attempts"][0]["verdict"]["codes"] == ["E0201"]
    assert "wdth" in record["attempts"][0]["answer"]
    assert "birdhouse" in record["request"]
    assert all(r["is_met"] for r in record["requirements"])
    assert len(record["requirements"]) >= 3
    assert {edit["knob"] for edit in record["edits"]["edits"]} == {"width"}
    with Image.open(evaluation.out / "pictures" / "birdhouse" / "full" / "1.png") as picture:
        assert max(picture.size) == 512
    assert evaluation.record("birdhouse", "full", 2)["program"] is None

    full, flat = evaluation.figures("full"), evaluation.figures("no-hierarchy")
    assert [full[n]["value"] for n in ("valid at first", "valid", "attempts")] == [0, 0.5, 2]
    assert flat["structures"]["value"] == 1
    assert flat["editability"]["value"] == 1
    assert flat["CLIP"]["count"] == 0
    assert done.out == (evaluation.out / "evaluation.md").read_text(encoding="utf-8")

    page = (evaluation.out / "index.html").read_text(encoding="utf-8")
    assert "<img src=x" not in page
    assert "<b>bold" not in page
    assert "&lt;/script&gt;&lt;/pre&gt;&lt;img src=x" in page
    assert "\u202e" not in page
    assert page.count("<script>") == page.count("</script>") == 1
    assert 'src="pictures/birdhouse/full/1.png"' in page
    assert page.count("<article ") == 4


def test_a_second_call_asks_only_for_what_is_missing(evaluation: Evaluation) -> None:
    evaluation.say("telephone", "full", 1, fenced(FLAT))
    chosen = ("--prompts", "telephone", "--variants", "full", "--runs")
    broken = evaluation(*chosen, "2")
    assert broken.code == 1
    assert "nothing is said of telephone, full, run 2" in broken.err
    assert "1 conversations are left to be had: the same command goes on with them" in broken.err
    assert evaluation.record("telephone", "full", 2)["failure"]["code"].startswith("E09")
    first = evaluation.contents()

    evaluation.model.said.clear()  # the first must not be asked for
    evaluation.say("telephone", "full", 2, fenced(FLAT))
    again = evaluation(*chosen, "2")
    assert again.code == 0
    assert "1/1 telephone, full, run 2: valid after" in again.err
    second = evaluation.contents()
    assert second["records/telephone/full/1.json"] == first["records/telephone/full/1.json"]

    third = evaluation(*chosen, "2")
    assert (third.code, "telephone, full" in third.err) == (0, False)
    reported = evaluation("--report", *chosen, "2")
    assert reported.code == 0
    assert evaluation.contents() == second


def test_other_settings_are_refused(evaluation: Evaluation) -> None:
    evaluation.say("telephone", "full", 1, fenced(FLAT))
    chosen = ("--prompts", "telephone", "--variants", "full", "--runs", "1")
    assert evaluation(*chosen).code == 0
    before = evaluation.contents()
    refused = evaluation(*chosen, "--attempts", "3")
    assert refused.code == 2
    assert refused.err == (
        f"error[E0946]: `{evaluation.out}` holds runs with other settings\n"
        "  = hint: attempts: `5` then, `3` now\n"
        "  = hint: give these runs a folder of their own with --out, or use the settings of those there\n"
    )
    assert evaluation.contents() == before


def test_a_damaged_record_is_refused(evaluation: Evaluation) -> None:
    place = evaluation.out / "records" / "gear" / "full" / "1.json"
    place.parent.mkdir(parents=True)
    for content in (
        "{",
        "[]",
        '{"prompt": "gear"}',
        '{"prompt": "key", "variant": "full", "run": 1, "failure": {}}',
    ):
        place.write_text(content)
        refused = evaluation("--report", "--prompts", "gear", "--variants", "full")
        assert refused.code == 2
        assert refused.err == (
            f"error[E0948]: `{place}` is no record of a run\n  = hint: remove it: the run is made again\n"
        )


def test_unknown_prompts_are_refused(evaluation: Evaluation) -> None:
    refused = evaluation("--prompts", "telefone")
    assert refused.code == 2
    assert refused.err == "error[E0947]: there is no prompt `telefone`\n  = hint: did you mean `telephone`?\n"
    empty = evaluation("--prompt-folder", str(evaluation.folder))
    assert empty.err == (
        f"error[E0947]: there are no prompts in `{evaluation.folder}`\n"
        "  = hint: a prompt is a file `NAME.aidl`\n"
    )


def test_without_openscad_its_variant_is_left_out(
    evaluation: Evaluation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(evaluation.folder))
    refused = evaluation("--variants", "openscad", "--runs", "1")
    assert refused.err == (
        "error[E0949]: `openscad` cannot be run: it is not installed\n"
        "  = hint: leave out `--variants openscad`\n"
    )
    skipped = evaluation("--report", "--runs", "1")
    assert "openscad is left out: it is not installed\n" in skipped.err
    assert skipped.code == 0


def test_a_model_that_cannot_be_reached_is_not_asked_for_ever(evaluation: Evaluation) -> None:
    given_up = evaluation("--variants", "full", "--runs", "1", "--provider", "exec:false", "--jobs", "1")
    assert given_up.code == 1
    assert given_up.err.count("broke off: ") == 5
    assert "conversations are left to be had" in given_up.err


def test_an_interrupt_leaves_what_is_done(evaluation: Evaluation) -> None:
    (evaluation.folder / "reply").write_text(fenced(FLAT))
    slow = evaluation.folder / "slow.sh"
    slow.write_text("[ -e begun ] && exec sleep 60\ntouch begun\nexec cat reply\n")
    chosen = ("--prompts", "telephone", "--variants", "full", "--runs", "2")
    command = evaluation.command(*chosen, "--jobs", "1", "--provider", f"exec:sh {slow}")
    running = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE)
    finished = evaluation.out / "records" / "telephone" / "full" / "1.json"
    for _ in range(1200):
        if finished.exists() or running.poll() is not None:
            break
        time.sleep(0.1)
    running.send_signal(signal.SIGINT)
    _, said = running.communicate()
    assert (running.returncode, b"Traceback" in said) == (130, False)
    assert evaluation.record("telephone", "full", 1)["ok"]
    assert not finished.with_name("2.json").exists()


@pytest.mark.skipif(shutil.which("openscad") is None, reason="openscad is not installed")
def test_openscad_runs_beside(evaluation: Evaluation) -> None:
    program = "width = 80;\nmodule base() { square([width, 40]); }\nbase();\ntranslate([0, 60]) circle(10);\n"
    evaluation.say("telephone", "openscad", 1, fenced("cube(3);", "openscad"), fenced(program, "openscad"))
    assert evaluation("--prompts", "telephone", "--variants", "openscad", "--runs", "1").code == 0
    record = evaluation.record("telephone", "openscad", 1)
    assert record["numbers"] == {"structures": 1, "detached": 1}
    assert not {r["text"]: r["is_met"] for r in record["requirements"]}["the parts hold together"]
    figures = evaluation.figures("openscad")
    counts = [figures[n]["count"] for n in ("intents lost", "constraints", "editability")]
    assert counts == [0, 0, 4]
    png = (evaluation.out / "pictures" / "telephone" / "openscad" / "1.png").read_bytes()
    with Image.open(io.BytesIO(png)) as picture:
        assert picture.size == (512, 404)  # 90 by 69.95 (the circle has 30 sides), margins of 3 % of 90
