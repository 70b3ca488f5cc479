"""Figures from records, against numbers worked out by hand, and how they are written."""

from __future__ import annotations

import csv
import io
import json

import pytest

from aidl_lang.tools.evaluation import table
from aidl_lang.tools.evaluation.clip import Scores
from aidl_lang.tools.evaluation.summary import Mean, Record, Share, Total, rows


def attempt(ok: bool | None) -> Record:
    return {"verdict": None if ok is None else {"ok": ok, "codes": []}}


def record(variant: str, run: int, verdicts: list[bool | None], **rest: object) -> Record:
    usage = {"input": 100 * run, "output": 10, "cost": None}
    return {
        "prompt": "gear",
        "variant": variant,
        "run": run,
        "ok": verdicts[-1] is True,
        "attempts": [attempt(ok) for ok in verdicts],
        "missing": [],
        "fixes": [],
        "usage": usage,
        **rest,
    }


RECORDS = [
    record(
        "full",
        1,
        [False, None, True],
        missing=["a constraint", "a hole"],
        fixes=["a comma"],
        numbers={"structures": 4, "constraints": 6, "detached": 1},
        requirements=[{"status": s} for s in ("met", "failed", "unmeasurable", "met")],
        edits={
            "knobs": 2,
            "edits": [{"outcome": "kept", "holds": True}, {"outcome": "changed"}, {"outcome": "kept"}],
        },
    ),
    record("full", 2, [True], numbers={"structures": 2, "constraints": 0, "degrees": 3, "detached": 0}),
    record("full", 3, [False, False]),
    {"prompt": "gear", "variant": "full", "run": 4, "failure": {"code": "E0933", "message": "no answer"}},
    record("openscad", 1, [True], numbers={"structures": 1, "detached": 2}),
]


@pytest.mark.parametrize(
    ("part", "count", "low", "high"),
    [  # from the published formula, and the tables of Brown, Cai and DasGupta (2001)
        (8, 10, 0.4902, 0.9433),
        (0, 5, 0.0, 0.4345),
        (5, 5, 0.5655, 1.0),
        (1, 2, 0.0945, 0.9055),
    ],
)
def test_intervals(part: int, count: int, low: float, high: float) -> None:
    assert Share(part, count).interval == pytest.approx((low, high), abs=5e-5)


def test_nothing_has_no_share() -> None:
    assert (Share(0, 0).value, Share(0, 0).interval) == (None, None)


def test_figures_of_a_variant() -> None:
    full, openscad = rows(RECORDS, Scores({"gear/full/2": 31.5}))
    assert (full.variant, full.jobs, full.broken_off) == ("full", 3, 1)
    assert full.figures == {
        "valid at first": Share(1, 3),
        "valid": Share(2, 3),
        "attempts": Mean(2, 2.0, 1.0),
        "fixes": Mean(3, pytest.approx(1 / 3), pytest.approx(2 / 9)),
        "intents lost": Mean(3, pytest.approx(2 / 3), pytest.approx(8 / 9)),
        "structures": Mean(2, 3.0, 1.0),
        "constraints": Mean(2, 3.0, 9.0),
        "degrees": Mean(1, 3.0, 0.0),
        "requirements": Share(2, 4),
        "geometry": Share(0, 0),
        "edits hold": Share(1, 3),
        "editability": Share(2, 3),
        "knobs": Mean(1, 2.0, 0.0),
        "detached": Mean(2, 0.5, 0.25),
        "tokens in": Mean(3, 200.0, pytest.approx(20000 / 3)),
        "tokens out": Mean(3, 10.0, 0.0),
        "cost": Total(0, None),
        "CLIP": Mean(1, 31.5, 0.0),
        "CLIP neutral": Mean(0),
    }
    assert openscad.figures["intents lost"] == openscad.figures["constraints"] == Mean(0)


def test_markdown() -> None:
    scores = Scores({}, "open_clip is not installed")
    text = table.markdown(rows(RECORDS, scores), rows(RECORDS, scores, per_prompt=True))
    lines = text.splitlines()
    assert "|  | full | openscad |" in lines
    assert "| conversations | 3, and 1 that broke off | 1 |" in lines
    assert "| valid | 67 % [21–94] (2/3) | 100 % [21–100] (1/1) |" in lines
    assert "| intents lost | 0.67 (3) | – |" in lines
    assert "| CLIP | not measured | not measured |" in lines
    assert "| gear | 2/3, 2/4, 2/3 | 1/1, –, – |" in lines
    assert text.count("CLIP was not measured: open_clip is not installed.") == 1


def test_csv_and_json_tell_the_same() -> None:
    variants, prompts = rows(RECORDS, Scores({})), rows(RECORDS, Scores({}), per_prompt=True)
    lines = list(csv.DictReader(io.StringIO(table.to_csv([*variants, *prompts]))))
    data = json.loads(table.to_json(variants, prompts))
    assert len(lines) == len(data["variants"]) + len(data["prompts"]) == 2 * 2 * 19
    valid = next(
        line
        for line in lines
        if (line["prompt"], line["variant"], line["figure"]) == ("gear", "full", "valid")
    )
    assert (valid["part"], valid["count"]) == ("2", "3")
    assert float(valid["low"]) == pytest.approx(0.2077, abs=5e-5)
    entry = next(e for e in data["prompts"] if (e["variant"], e["figure"]) == ("full", "valid"))
    assert [str(entry[name]) for name in ("value", "low", "high")] == [
        valid[name] for name in ("value", "low", "high")
    ]
