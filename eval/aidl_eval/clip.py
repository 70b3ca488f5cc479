"""The CLIP score of pictures: how near a picture and a text lie in a model that was trained on both.

The score is the cosine of their embeddings times 100, as in the literature; scores of other weights, picture
sizes or words do not compare. Weights do not come along. They are read from a file, or from the folder where
`huggingface_hub` keeps what was downloaded before; nothing is downloaded here.
"""

from __future__ import annotations

import io
import json
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from aidl_eval.plan import digest, key_of
from aidl_eval.store import Store, picture_path

MODEL = "ViT-B-32-quickgelu"
PRETRAINED = "openai"
VARIABLE = "AIDL_CLIP_WEIGHTS"

Scorer = Callable[[bytes, str], float]
"""A function from a PNG and a text to a score."""


@dataclass(frozen=True)
class Scores:
    """Scores by the key of the job; `reason` tells why there are none."""

    of: Mapping[str, float]
    reason: str | None = None


class Unavailable(Exception):  # noqa: N818 (that nothing is measured is no error)
    """Raised if there is no model to score with; the message gives the reason."""


def words(prompt: str) -> str:
    """Returns the text compared with a picture: “a 2D drawing of an old-school telephone”."""
    thing = re.sub(r"^(an?|the)\s+", "", prompt.strip().rstrip("."), flags=re.I)
    return f"a 2D drawing of {'an' if thing[:1].lower() in 'aeiou' else 'a'} {thing}"


def load(weights: str | None) -> Scorer:
    """Returns a model with the weights of a file, or with those of the cache. Raises Unavailable."""
    if find_spec("open_clip") is None:
        raise Unavailable("open_clip is not installed (pip install 'aidl-eval[clip]')")
    if weights is not None and not Path(weights).is_file():
        raise Unavailable(f"there is no file of weights `{weights}`")
    os.environ["HF_HUB_OFFLINE"] = "1"  # which huggingface_hub looks at when it is imported
    torch, open_clip, image = (import_module(name) for name in ("torch", "open_clip", "PIL.Image"))
    try:
        network, _, prepare = open_clip.create_model_and_transforms(MODEL, pretrained=weights or PRETRAINED)
        tokenize = open_clip.get_tokenizer(MODEL)
    except Exception as error:  # the loaders raise all sorts of things
        said = " ".join(str(error).split()).partition(". ")[0][:200]
        source = f"`{weights}`" if weights else f"the cache (name a file by {VARIABLE} or --clip-weights)"
        raise Unavailable(f"{MODEL} cannot be loaded from {source}: {said}") from error
    network.eval()

    def score(png: bytes, text: str) -> float:
        with torch.no_grad(), image.open(io.BytesIO(png)) as opened:
            seen = network.encode_image(prepare(opened.convert("RGB")).unsqueeze(0))
            said = network.encode_text(tokenize([text]))
            return float(100.0 * torch.nn.functional.cosine_similarity(seen, said)[0])

    return score


def score_all(store: Store, records: Sequence[Mapping[str, Any]], weights: str | None = None) -> Scores:
    """Returns the scores of all valid programs that were drawn, kept in `clip.json` by picture and text."""
    weights = weights or os.environ.get(VARIABLE)
    try:
        score = load(weights)
    except Unavailable as reason:
        return Scores({}, str(reason))
    name = f"{MODEL}, {Path(weights).name if weights else PRETRAINED}"
    kept = _kept(store.folder / "clip.json", name)
    found, now = dict[str, float](), dict[str, float]()
    for each in records:
        key = key_of(each)
        picture = store.folder / picture_path(key)
        if each.get("ok") and picture.is_file():
            png, text = picture.read_bytes(), words(each["text"])
            content = digest(f"{text}\n{png.hex()}")
            now[content] = found[key] = kept[content] if content in kept else score(png, text)
    store.write("clip.json", (json.dumps({"model": name, "scores": now}, indent=1) + "\n").encode())
    return Scores(found)


def _kept(path: Path, name: str) -> dict[str, float]:
    """Returns scores of an earlier call, if the same model gave them."""
    try:
        found = json.loads(path.read_bytes())
        return dict(found["scores"]) if found["model"] == name else {}
    except (OSError, ValueError, KeyError, TypeError):
        return {}  # they are computed again
