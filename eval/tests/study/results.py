"""Folders of results as `aidl eval` writes them, with pictures that tests can tell apart by their width."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from PIL import Image
from PIL.PngImagePlugin import PngInfo

from aidl_eval.judgements import Answers
from aidl_eval.plan import VARIANTS
from aidl_eval.store import Store, picture_path

LANGUAGES = ("full", "openscad", "svg")
PROMPTS = ("lamp stand", "old key", "tall mug", "wide fork")
_USAGE = {"input": None, "output": None, "cost": None}


def width_of(language: str) -> int:
    return 40 + 8 * list(VARIANTS).index(language)


def record(prompt: str, variant: str, run: int, state: str) -> dict[str, Any]:
    """A record whose conversation came to a picture, to nothing, to a program that is not drawn, or broke."""
    of = {"prompt": prompt.replace(" ", "_"), "variant": variant, "run": run}
    if state == "broken":
        return {**of, "failure": {"code": "E0940", "message": "no answer"}}
    is_ok = state != "none"
    attempt = {
        "reply": "a program",
        "model": "fake",
        "finish": "complete",
        "usage": _USAGE,
        "seconds": 1.0,
        "date": "2026-01-31",
        "program": "a program",
        "verdict": {"ok": is_ok, "stage": "done", "codes": [], "fixes": [], "missing": [], "numbers": {}},
        "answer": None,
    }
    return {
        **of,
        "text": prompt,
        "request": prompt,
        "attempts": [attempt],
        "ok": is_ok,
        "program": f"{prompt} {variant} {run}" if is_ok else None,
        "missing": [],
        "fixes": [],
        "usage": _USAGE,
        "unmeasured": {"drawing": "it took too long"} if state == "slow" else {},
    }


def write(
    folder: Path,
    prompts: Sequence[str] = PROMPTS,
    languages: Sequence[str] = LANGUAGES,
    runs: int = 1,
    states: Mapping[tuple[str, str, int], str] | None = None,
) -> Store:
    """Writes a folder of results; `states` says which conversations came to something else than a picture."""
    for prompt in prompts:
        for language in languages:
            for run in range(1, runs + 1):
                state = (states or {}).get((prompt, language, run), "drawn")
                found = record(prompt, language, run, state)
                key = f"{found['prompt']}/{language}/{run}"
                for path in (f"records/{key}.json", picture_path(key)):
                    (folder / path).parent.mkdir(parents=True, exist_ok=True)
                (folder / f"records/{key}.json").write_text(json.dumps(found), "utf-8")
                if state != "drawn":
                    continue
                told = PngInfo()
                told.add_text("Software", language)
                image = Image.new("RGBA", (width_of(language), 64), (90, 90, 90, 128))
                image.save(folder / picture_path(key), pnginfo=told)
    return Store(folder)


def figures(folder: Path) -> list[dict[str, Any]]:
    """The lines of `evaluation.csv`, what is a number as one; without what is empty."""
    lines = csv.DictReader(io.StringIO((folder / "evaluation.csv").read_text("utf-8-sig")))
    words = ("prompt", "variant", "against", "figure", "reason")
    return [
        {n: t if n in words else float(t) for n, t in line.items() if t or n in words}
        for line in lines
        if not line["prompt"]
    ]


def lines(folder: Path) -> list[dict[str, Any]]:
    text = Answers(folder).path.read_text("utf-8")
    return [json.loads(line) for line in text.splitlines()]
