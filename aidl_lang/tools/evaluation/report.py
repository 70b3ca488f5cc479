"""Reports on the records of a folder: tables for readers and programs, and the gallery."""

from __future__ import annotations

from aidl_lang.tools.evaluation import gallery, table
from aidl_lang.tools.evaluation.clip import MODEL, score_all
from aidl_lang.tools.evaluation.store import Store
from aidl_lang.tools.evaluation.summary import rows


def report(store: Store, weights: str | None = None, model: str = MODEL) -> str:
    """Writes `evaluation.md`, `.csv`, `.json` and `index.html`, and returns the Markdown. Raises
    StoreError.
    """
    records = store.records()
    scores = score_all(store, records, weights, model)
    variants, prompts = rows(records, scores), rows(records, scores, per_prompt=True)
    text = table.markdown(variants, prompts)
    outputs = {
        "evaluation.md": text,
        "evaluation.csv": table.to_csv([*variants, *prompts]),
        "evaluation.json": table.to_json(variants, prompts),
        "index.html": gallery.page(store.folder, records, variants, scores),
    }
    for name, content in outputs.items():
        store.write(name, content.encode("utf-8", "backslashreplace"))
    return text
