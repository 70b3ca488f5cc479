"""Figures from records, against numbers worked out by hand, and how they are written."""

from __future__ import annotations

import csv
import io

import pytest

from aidl_eval import table
from aidl_eval.clip import Scores
from aidl_eval.statistics import Comparison
from aidl_eval.summary import Mean, Record, Share, pairs, rows


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
        requirements=[{"is_met": is_met} for is_met in (True, False, False, True)],
        edits={"knobs": 2, "edits": [{"holds": True}, {"holds": False}, {"holds": True}]},
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
        "attempts": Mean(2, 2.0, 2.0),
        "fixes": Mean(3, pytest.approx(1 / 3), pytest.approx(1 / 3)),
        "intents lost": Mean(3, pytest.approx(2 / 3), pytest.approx(4 / 3)),
        "structures": Mean(2, 3.0, 2.0),
        "constraints": Mean(2, 3.0, 18.0),
        "degrees": Mean(1, 3.0),
        "requirements": Share(2, 4),
        "editability": Share(2, 3),
        "knobs": Mean(1, 2.0),
        "detached": Mean(2, 0.5, 0.5),
        "tokens in": Mean(3, 200.0, 10000.0),
        "tokens out": Mean(3, 10.0, 0.0),
        "seconds": Mean(0),
        "cost": Mean(0),
        "CLIP": Mean(1, 31.5),
    }
    assert openscad.figures["intents lost"] == openscad.figures["constraints"] == Mean(0)


def test_markdown() -> None:
    text = table.markdown(rows(RECORDS, Scores({})), notes=["A note."])
    lines = text.splitlines()
    assert "|  | full | openscad |" in lines
    assert "| conversations | 3, and 1 that broke off | 1 |" in lines
    assert "| valid | 67 % [21–94] (2/3) | 100 % [21–100] (1/1) |" in lines
    assert "| intents lost | 0.67 ± 1.15 [0.00–2.00] (3) | – |" in lines
    assert "| CLIP | – | – |" in lines
    assert "A note." in lines


def test_csv() -> None:
    variants, prompts = rows(RECORDS, Scores({})), rows(RECORDS, Scores({}), per_prompt=True)
    lines = list(csv.DictReader(io.StringIO(table.to_csv([*variants, *prompts]))))
    assert len(lines) == 2 * 2 * len(variants[0].figures)
    found = {(line["prompt"], line["variant"], line["figure"]): line for line in lines}
    valid = found["gear", "full", "valid"]
    assert (valid["part"], valid["count"], valid["variance"]) == ("2", "3", "")
    assert float(valid["low"]) == pytest.approx(0.2077, abs=5e-5)
    assert found["", "full", "attempts"]["variance"] == "2"


def two_prompts() -> list[Record]:
    """OpenSCAD is valid at first of both prompts, AIDL of one; 2 of 4 and 3 of 3 requirements hold."""
    results = {"gear": (True, True, False, False), "door": (True,) * 3}
    found = []
    for prompt, found_met in results.items():
        asked = [{"is_met": is_met} for is_met in found_met]
        verdicts: list[bool | None] = [True] if prompt == "gear" else [False, True]
        found.append({**record("full", 1, verdicts, requirements=asked), "prompt": prompt})
        found.append({**record("openscad", 1, [True], requirements=asked[:1]), "prompt": prompt})
    return found


def test_pairs_of_languages() -> None:
    found = {pair.figure: pair for pair in pairs(rows(two_prompts(), Scores({})))}
    first = found["valid at first"]
    assert (first.first, first.second) == ("full", "openscad")
    assert first.comparison == Comparison(2, -0.5, (-1.0, 0.0), 1.0, 1.0)
    assert found["requirements"].comparison.difference == pytest.approx((0.5 + 1) / 2 - 1)
    assert "CLIP" not in found
    text = table.markdown(
        rows(two_prompts(), Scores({})), list(found.values()), ["Note on full: only tries."]
    )
    assert "| valid at first | full − openscad | -0.50 [-1.00 to 0.00] | 2 | 1.000 | 1.000 |" in text
    assert "Note on full: only tries." in text
    assert "| requirements | 71 % [50–100] (5/7) | 100 % [100–100] (2/2) |" in text
    lines = list(csv.DictReader(io.StringIO(table.to_csv([], list(found.values())))))
    line = next(line for line in lines if line["figure"] == "valid at first")
    assert [line[n] for n in ("variant", "against", "value", "count", "p", "p_holm")] == [
        "full",
        "openscad",
        "-0.5",
        "2",
        "1.0",
        "1.0",
    ]
