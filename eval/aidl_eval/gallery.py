"""What is reported on a folder of records: tables for readers and programs, and the gallery, all runs on one
page: pictures, programs, losses, requirements. It needs only the pictures beside it.

Programs and replies are strangers' text: everything is escaped, and the page allows no script but its own.
"""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from pathlib import Path
from string import Template
from typing import Any
from urllib.parse import quote

from aidl_eval import recordings, table
from aidl_eval.clip import Scores, score_all
from aidl_eval.judgements import study_of
from aidl_eval.plan import key_of
from aidl_eval.store import Store, picture_path
from aidl_eval.summary import pairs, rows
from aidl_lang.common.prose import counted

Record = Mapping[str, Any]

_NAMES = {"degrees": "degrees of freedom", "detached": "detached pieces"}
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
_LONGEST = 20_000
"""Most characters of a program or a reply that are shown."""
_PAGE, _STYLE, _SCRIPT = (
    Path(__file__).with_suffix(suffix).read_text("utf-8") for suffix in (".html", ".css", ".js")
)


def report(store: Store, weights: str | None = None) -> str:
    """Writes `evaluation.md`, `evaluation.csv`, `index.html` and `recording.jsonl`, and returns the Markdown.
    Raises StoreError.
    """
    records, settings = store.records(), store.settings()
    scores = score_all(store, records, weights)
    study = study_of(store, records)
    variants, prompts = (rows(records, scores, each, study) for each in (False, True))
    differences = pairs(variants)
    notes = [*recordings.notes(records, settings)]
    if scores.reason:
        notes.append(f"CLIP was not measured: {scores.reason}.")
    text = table.markdown(variants, differences, notes, study)
    outputs = {
        "recording.jsonl": recordings.written(records, settings),
        "evaluation.md": text,
        "evaluation.csv": table.to_csv([*variants, *prompts], differences, study),
        "index.html": page(store.folder, records, scores),
    }
    for name, content in outputs.items():
        encoding = "utf-8-sig" if name.endswith(".csv") else "utf-8"
        store.write(name, content.encode(encoding, "backslashreplace"))
    return text


def page(folder: Path, records: Sequence[Record], scores: Scores) -> str:
    """Returns the page to be written to `folder`, beside the pictures."""
    prompts, variants = (list(dict.fromkeys(r[name] for r in records)) for name in ("prompt", "variant"))
    sections = (_prompt(n, [r for r in records if r["prompt"] == n], folder, scores) for n in prompts)
    return Template(_PAGE).substitute(
        policy=_policy(),
        style=_STYLE,
        choices="\n".join((_choice("prompt", prompts), _choice("variant", variants))),
        sections="\n".join(sections),
        script=_SCRIPT,
    )


def _policy() -> str:
    allowed = base64.b64encode(hashlib.sha256(_SCRIPT.encode()).digest()).decode()
    return (
        f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{allowed}'; "
        "img-src 'self' file:; form-action 'none'; base-uri 'none'"
    )


def _text(value: object) -> str:
    """Returns text to show: escaped, of limited length, without characters that steer the reader's screen."""
    text = str(value)
    cut = f"{text[:_LONGEST]}\n… {len(text) - _LONGEST} more characters" if len(text) > _LONGEST else text
    return escape(_CONTROL.sub("\ufffd", cut))


def _choice(name: str, values: Iterable[str]) -> str:
    options = "".join(f"<option>{_text(value)}</option>" for value in values)
    return f'<label>{name} <select name="{name}"><option value="">all</option>{options}</select></label>'


def _prompt(name: str, records: Sequence[Record], folder: Path, scores: Scores) -> str:
    asked = next((r["text"] for r in records if "text" in r), "")
    cells = "\n".join(_cell(record, folder, scores) for record in records)
    head = f'<h2>{_text(name)}</h2><p class="asked">{_text(asked)}</p>'
    return f'<section>{head}<div class="cells">{cells}</div></section>'


def _cell(record: Record, folder: Path, scores: Scores) -> str:
    about = f'data-prompt="{_text(record["prompt"])}" data-variant="{_text(record["variant"])}"'
    head = f"<h3>{_text(record['variant'])} <small>run {_text(record['run'])}</small></h3>"
    if "failure" in record:
        body = f'<p class="none">broke off</p><p>{_text(record["failure"]["message"])}</p>'
    else:
        body = f"{_picture(record, folder)}{_facts(record, scores)}{''.join(_folded(record))}"
    return f"<article {about}>{head}{body}</article>"


def _picture(record: Record, folder: Path) -> str:
    path = picture_path(key_of(record))
    if record["ok"] and (folder / path).is_file():
        about = f"{record['prompt']}, {record['variant']}, run {record['run']}"
        return f'<img loading="lazy" src="{quote(path)}" alt="{_text(about)}">'
    return f'<p class="none">{"no picture" if record["ok"] else "not valid"}</p>'


def _facts(record: Record, scores: Scores) -> str:
    facts = [counted(len(record["attempts"]), "attempt")]
    facts += [f"{value:g} {_NAMES.get(name, name)}" for name, value in record.get("numbers", {}).items()]
    if edits := record.get("edits", {}).get("edits"):
        facts.append(f"{sum(e['holds'] for e in edits)}/{len(edits)} edits hold")
    if (score := scores.of.get(key_of(record))) is not None:
        facts.append(f"CLIP {score:.1f}")
    facts += [f"{what} not measured: {why}" for what, why in record.get("unmeasured", {}).items()]
    return f'<p class="facts">{_text(" · ".join(facts))}</p>'


def _folded(record: Record) -> Iterator[str]:
    """Yields the unfolding parts: requirements, losses, the program, and the attempts."""
    if results := record.get("requirements"):
        items = "".join(map(_requirement, results))
        met = sum(result["is_met"] for result in results)
        yield _details(f"{met}/{len(results)} requirements", f"<ul>{items}</ul>")
    if record["missing"]:
        items = "".join(f"<li>{_text(phrase)}</li>" for phrase in record["missing"])
        yield _details(f"{len(record['missing'])} lost", f"<ul>{items}</ul>", "lost")
    if record["program"] is not None:
        yield _details("program", f"<pre>{_text(record['program'])}</pre>")
    yield _details("attempts", "".join(_attempt(n, a) for n, a in enumerate(record["attempts"], 1)))


def _requirement(result: Record) -> str:
    kind, mark = ("met", "✓") if result["is_met"] else ("failed", "✗")
    detail = f"<br><small>{_text(result['detail'])}</small>" if result["detail"] else ""
    return f'<li class="{kind}"><b>{mark}</b> {_text(result["text"])}{detail}</li>'


def _attempt(number: int, attempt: Record) -> str:
    verdict = attempt["verdict"]
    codes = ", ".join(dict.fromkeys(verdict["codes"])) if verdict else ""
    came = "no program" if verdict is None else "valid" if verdict["ok"] else f"{verdict['stage']}: {codes}"
    answer = f"<h4>told</h4><pre>{_text(attempt['answer'])}</pre>" if attempt["answer"] else ""
    return _details(f"{number}: {came}", f"<pre>{_text(attempt['reply'])}</pre>{answer}")


def _details(summary: str, body: str, kind: str = "") -> str:
    return f'<details class="{kind}"><summary>{_text(summary)}</summary>{body}</details>'
