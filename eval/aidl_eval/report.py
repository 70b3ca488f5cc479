"""Reports on the records of a folder: tables for readers and programs, and the gallery."""

from __future__ import annotations

from aidl_eval import gallery, recordings, table
from aidl_eval.clip import MODEL, score_all
from aidl_eval.preference import study_of
from aidl_eval.store import Store
from aidl_eval.summary import WITHIN, pairs, rows


def report(store: Store, weights: str | None = None, model: str = MODEL) -> str:
    """Writes `evaluation.md`, `.csv`, `.json`, `index.html` and `recording.jsonl`, and returns the Markdown.
    Raises StoreError.
    """
    records = store.records()
    scores = score_all(store, records, weights, model)
    settings = store.settings()
    attempts = settings.get("attempts")
    limit = attempts if isinstance(attempts, int) else WITHIN[-1]
    study = study_of(store, records)
    variants, prompts = (rows(records, scores, each, limit, study) for each in (False, True))
    differences = pairs(variants, study=study)
    text = table.markdown(variants, prompts, differences, recordings.notes(records, settings), study)
    outputs = {
        "recording.jsonl": recordings.written(records, settings),
        "evaluation.md": text,
        "evaluation.csv": table.to_csv([*variants, *prompts], differences, study),
        "evaluation.json": table.to_json(variants, prompts, differences, study),
        "index.html": gallery.page(store.folder, records, variants, scores),
    }
    for name, content in outputs.items():
        encoding = "utf-8-sig" if name.endswith(".csv") else "utf-8"
        store.write(name, content.encode(encoding, "backslashreplace"))
    return text
