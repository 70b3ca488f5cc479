"""The CLIP score: by open_clip where that is installed, and else not measured, with a reason."""

from __future__ import annotations

import io
import json
import math
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from aidl_eval import clip
from aidl_eval.store import Store

TINY = {
    "embed_dim": 16,
    "vision_cfg": {"image_size": 32, "layers": 1, "width": 32, "head_width": 16, "patch_size": 16},
    "text_cfg": {"context_length": 77, "vocab_size": 49408, "width": 16, "heads": 1, "layers": 1},
}


def png(color: str) -> bytes:
    data = io.BytesIO()
    Image.new("RGB", (40, 30), color).save(data, "PNG")
    return data.getvalue()


@pytest.fixture
def store(tmp_path: Path) -> Store:
    store = Store(tmp_path)
    for run, color in ((1, "red"), (2, "blue")):
        store.write(f"pictures/gear/full/{run}.png", png(color))
    return store


def record(run: int, ok: bool = True) -> dict[str, Any]:
    return {"prompt": "gear", "variant": "full", "run": run, "ok": ok, "text": "A gear."}


RECORDS = [record(1), record(2), record(3), record(1, ok=False)]


def test_without_the_package_or_the_file_the_reason_is_told(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(clip, "find_spec", lambda name: None)
    scores = clip.score_all(store, RECORDS)
    assert scores == clip.Scores({}, "open_clip is not installed (pip install 'aidl-eval[clip]')")
    monkeypatch.setattr(clip, "find_spec", lambda name: name)
    monkeypatch.setenv(clip.VARIABLE, "nowhere.pt")
    assert clip.score_all(store, RECORDS).reason == "there is no file of weights `nowhere.pt`"


def test_pictures_are_scored_once(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[bytes, str]] = []

    def score(picture: bytes, text: str) -> float:
        asked.append((picture, text))
        return float(len(asked))

    monkeypatch.setattr(clip, "load", lambda weights: score)
    assert clip.score_all(store, RECORDS).of == {"gear/full/1": 1.0, "gear/full/2": 2.0}
    assert asked == [(png("red"), "a 2D drawing of a gear"), (png("blue"), "a 2D drawing of a gear")]
    store.write("pictures/gear/full/2.png", png("green"))
    assert clip.score_all(store, RECORDS).of == {"gear/full/1": 1.0, "gear/full/2": 3.0}
    assert clip.score_all(store, RECORDS, "other.pt").of == {"gear/full/1": 4.0, "gear/full/2": 5.0}


def test_a_model_is_loaded_and_its_cosine_taken(
    store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    open_clip, torch = pytest.importorskip("open_clip"), pytest.importorskip("torch")
    (tmp_path / "tiny.json").write_text(json.dumps(TINY))
    monkeypatch.setattr(clip, "MODEL", "tiny")
    open_clip.add_model_config(tmp_path / "tiny.json")
    torch.manual_seed(1)
    model, _, prepare = open_clip.create_model_and_transforms("tiny")
    torch.save(model.state_dict(), tmp_path / "tiny.pt")
    found = clip.score_all(store, RECORDS, str(tmp_path / "tiny.pt")).of["gear/full/1"]
    with torch.no_grad():
        seen = model.eval().encode_image(prepare(Image.new("RGB", (40, 30), "red")).unsqueeze(0))[0].tolist()
        said = model.encode_text(open_clip.get_tokenizer("tiny")(["a 2D drawing of a gear"]))[0].tolist()
    dot = sum(a * b for a, b in zip(seen, said, strict=True))
    assert found == pytest.approx(100 * dot / (math.hypot(*seen) * math.hypot(*said)), abs=1e-3)
    (tmp_path / "wrong.pt").write_bytes(b"no weights")
    assert "tiny cannot be loaded from" in (
        clip.score_all(store, RECORDS, str(tmp_path / "wrong.pt")).reason or ""
    )
